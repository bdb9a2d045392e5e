//! Outline of a contact on its cells: how wide it and its spots are, and whether the shape's own edge bounds
//! it.

use ndarray::Array2;

use crate::contact::problem::patch::rows;
use crate::model::grid::Window;
use crate::numerics::parallel::{Lanes, ONE, all, sum, update_with_largest, where_positive};

/// Outline of the cells in contact.
pub(super) struct Outline {
    /// Lines of cells across x and across y: whether each of them has a cell in contact.
    pub(super) lines: [Vec<bool>; 2],
    /// Mean width of the contact along x and along y, in cells; 0 where nothing touches.
    ///
    /// A run is a row of neighbouring cells in contact along the axis, as long as it can be. The mean of
    /// the lengths n of all runs is weighted by their pressures, Σ n Σp / Σ Σp, so that small spots count
    /// only as much as they carry. A round contact whose pressure is Hertz's has 0.88 of its diameter,
    /// a rough one the width of its spots.
    pub(super) widths: [f64; 2],
    /// Whether a cell in contact lies beside one that cannot touch.
    pub(super) is_cut: bool,
}

/// 1 where the shape cannot touch, 0 elsewhere.
fn beyond(gap: Lanes) -> Lanes {
    gap.simd_ge(all(f64::INFINITY)) & ONE
}

impl Outline {
    /// Outline of a pressure that is zero outside `window`. The `gap` is infinite where the shape cannot
    /// touch.
    pub(super) fn of(pressure: &Array2<f64>, gap: &Array2<f64>, window: &Window) -> Self {
        let shape = [pressure.nrows(), pressure.ncols()];
        let mut lines = shape.map(|n| vec![false; n]);
        let (mut carried, mut along_x, mut along_y) = (0.0, 0.0, 0.0);
        let mut is_cut = false;
        let columns = window[1].len();
        // Runs along x that have begun: cells and sum of pressures in each column, and the largest pressure.
        let (mut cells, mut begun) = (vec![0.0; columns], vec![0.0; columns]);
        let mut highest = vec![0.0; columns];
        let mut gap_before: &[f64] = &vec![0.0; columns];
        let contact = window[0].clone().zip(rows(pressure, window));
        for ((i, row), gap) in contact.zip(rows(gap, window)) {
            let mut start = 0;
            for run in row.chunk_by(|a, b| (*a > 0.0) == (*b > 0.0)) {
                let end = start + run.len();
                if run[0] > 0.0 {
                    let [force] = sum([run], |[p]| [p]);
                    carried += force;
                    along_y += force * run.len() as f64;
                    lines[0][i] = true;
                    let beside = [start.checked_sub(1), Some(end)];
                    let mut gaps = beside.into_iter().filter_map(|j| gap.get(j?));
                    is_cut |= gaps.any(|h| h.is_infinite());
                }
                start = end;
            }
            let ([cut], [ended]) = update_with_largest(
                [row, gap, gap_before],
                [&mut cells, &mut begun, &mut highest],
                |[p, h, before], [n, force, highest]| {
                    let inside = |value| where_positive(p, value);
                    let edges = inside(beyond(before)) + where_positive(n, beyond(h));
                    let product = n * force;
                    let new = [inside(n + ONE), inside(force + p), highest.fast_max(p)];
                    (new, [edges], [product - inside(product)])
                },
            );
            is_cut |= cut > 0.0;
            along_x += ended;
            gap_before = gap;
        }
        let [last] = sum([&cells, &begun], |[n, force]| [n * force]);
        along_x += last;
        for (line, p) in lines[1][window[1].clone()].iter_mut().zip(highest) {
            *line = p > 0.0;
        }
        let mean = |weighted: f64| {
            if carried > 0.0 { weighted / carried } else { 0.0 }
        };
        Self { lines, widths: [mean(along_x), mean(along_y)], is_cut }
    }
}

#[cfg(test)]
mod tests {
    use ndarray::Array2;

    use super::Outline;
    use crate::model::grid::full_window;

    /// Outline of the contact with these pressures, in a window of the whole grid.
    fn outline(pressure: &Array2<f64>, gap: &Array2<f64>) -> Outline {
        let shape = [pressure.nrows(), pressure.ncols()];
        Outline::of(pressure, gap, &full_window(shape))
    }

    fn assert_widths(pressure: &Array2<f64>, expected: [f64; 2]) {
        let gap = Array2::zeros(pressure.dim());
        let found = outline(pressure, &gap);
        for (found, expected) in found.widths.iter().zip(expected) {
            assert!((found - expected).abs() < 1e-12 * (1.0 + expected), "{found} {expected}");
        }
        assert!(!found.is_cut);
    }

    #[test]
    fn widths_are_means_over_runs_weighted_by_pressure() {
        let mut pressure = Array2::zeros([12, 17]);
        assert_widths(&pressure, [0.0; 2]);
        for (i, j) in (2..7).flat_map(|i| (3..6).map(move |j| (i, j))) {
            pressure[[i, j]] = 2.0;
        }
        assert_widths(&pressure, [5.0, 3.0]);
        // A single cell that carries as much as the rectangle.
        pressure[[9, 10]] = 30.0;
        assert_widths(&pressure, [3.0, 2.0]);
        // Up to the edges of the grid.
        assert_widths(&Array2::from_elem([5, 6], 0.5), [5.0, 6.0]);
        assert_widths(&Array2::from_elem([1, 6], 0.5), [1.0, 6.0]);
    }

    /// Hertz's pressure: ∫ 2a(1−η²)^½ (1−η²) dη / ∫ (1−η²) dη = 9π/32 of the diameter.
    #[test]
    fn a_round_contact_is_nearly_as_wide_as_its_diameter() {
        let radius = 40.0_f64;
        let pressure = Array2::from_shape_fn([96, 96], |(i, j)| {
            let r2 = (i as f64 - 47.5).powi(2) + (j as f64 - 47.5).powi(2);
            (1.0 - r2 / radius.powi(2)).max(0.0).sqrt()
        });
        let found = outline(&pressure, &Array2::zeros([96, 96]));
        for width in found.widths {
            let expected = 9.0 * std::f64::consts::PI / 32.0 * 2.0 * radius;
            // The staircase of cells.
            assert!((width / expected - 1.0).abs() < 5e-3, "{width} {expected}");
        }
        let touching = |lines: &[bool]| lines.iter().filter(|touches| **touches).count();
        assert_eq!(found.lines.map(|lines| touching(&lines)), [80, 80]);
    }

    /// A contact of one cell beside one that cannot touch, on each of its four sides; at its corner that
    /// is no edge.
    #[test]
    fn cells_beside_those_that_cannot_touch_are_found() {
        let mut pressure = Array2::zeros([7, 9]);
        pressure[[3, 4]] = 1.0;
        for (i, j, cut) in [
            (2, 4, true),
            (4, 4, true),
            (3, 3, true),
            (3, 5, true),
            (2, 3, false),
            (4, 5, false),
            (5, 4, false),
            (3, 2, false),
        ] {
            let mut gap = Array2::zeros([7, 9]);
            gap[[i, j]] = f64::INFINITY;
            assert_eq!(outline(&pressure, &gap).is_cut, cut, "{i} {j}");
        }
    }
}
