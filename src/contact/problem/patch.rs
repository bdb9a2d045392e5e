//! Pressures in a window of a grid.

use ndarray::{Array2, ArrayRef2, ArrayView2, Axis, Slice};

use crate::model::grid::{Window, full_window};
use crate::numerics::parallel::each_row;

/// Cells around the contact that a window holds. Chosen by trial: 2, 3 and 12 take the same time on 52 contacts.
const WINDOW_MARGIN: usize = 6;

/// Part of the grid above which a window saves less than its planning costs. Chosen by trial: with 0.3 automatic grids take 29 %
/// more convolutions, with 0.9 rough contacts take up to 36 % more.
const LARGEST_PART: f64 = 0.6;

/// A pressure that is zero outside a window.
#[derive(Debug, Clone)]
pub(crate) struct Patch {
    pub(crate) window: Window,
    pub(crate) values: Vec<f64>,
}

/// `cells` and a margin around them; the whole grid where a window would cover most of it.
pub(crate) fn widened(cells: &Window, shape: [usize; 2]) -> Window {
    let window = [0, 1].map(|k| {
        cells[k].start.saturating_sub(WINDOW_MARGIN)..(cells[k].end + WINDOW_MARGIN).min(shape[k])
    });
    let share = (window[0].len() * window[1].len()) as f64 / (shape[0] * shape[1]) as f64;
    if share > LARGEST_PART { full_window(shape) } else { window }
}

/// The smallest window that holds both.
pub(crate) fn enclosing(a: &Window, b: &Window) -> Window {
    [0, 1].map(|k| a[k].start.min(b[k].start)..a[k].end.max(b[k].end))
}

/// The cells of a window of an array.
pub(crate) fn block<'a>(array: &'a ArrayRef2<f64>, [x, y]: &Window) -> ArrayView2<'a, f64> {
    let mut view = array.view();
    view.slice_axis_inplace(Axis(0), Slice::from(x.clone()));
    view.slice_axis_inplace(Axis(1), Slice::from(y.clone()));
    view
}

/// Values of a window in C order, each row written by `fill`.
fn window_values([x, y]: &Window, fill: impl Fn(usize, &mut [f64]) + Sync) -> Vec<f64> {
    let mut values = vec![0.0; x.len() * y.len()];
    each_row(&mut values, y.len(), |k, row| fill(x.start + k, row));
    values
}

/// Rows of a window of the values of a grid of `columns` columns.
pub(crate) fn rows<'a>(
    values: &'a [f64],
    columns: usize,
    [x, y]: &Window,
) -> impl Iterator<Item = &'a [f64]> {
    let rows = values.chunks_exact(columns).skip(x.start).take(x.len());
    let y = y.clone();
    rows.map(move |row| &row[y.clone()])
}

/// Values of a window of an array in C order.
pub(crate) fn copied(array: &ArrayRef2<f64>, window: &Window) -> Vec<f64> {
    block(array, window).iter().copied().collect()
}

/// The smallest window that holds all cells for which `member` is true; `None` where there is no such cell.
pub(crate) fn bounds(window: &Window, member: impl Fn(usize, usize) -> bool) -> Option<Window> {
    let mut hull: Option<Window> = None;
    for i in window[0].clone() {
        let row = window[1].clone();
        let Some(first) = row.clone().find(|&j| member(i, j)) else {
            continue;
        };
        let last = row.rev().find(|&j| member(i, j)).unwrap_or(first);
        let line = [i..i + 1, first..last + 1];
        hull = Some(hull.map_or(line.clone(), |hull| enclosing(&hull, &line)));
    }
    hull
}

impl Patch {
    /// The pressure of a whole grid.
    pub(crate) fn of_grid(pressure: &Array2<f64>) -> Self {
        let window = [0..pressure.nrows(), 0..pressure.ncols()];
        Self { window, values: pressure.iter().copied().collect() }
    }

    /// Pressure of a cell of the grid.
    pub(crate) fn at(&self, i: usize, j: usize) -> f64 {
        let [x, y] = &self.window;
        if x.contains(&i) && y.contains(&j) {
            self.values[(i - x.start) * y.len() + j - y.start]
        } else {
            0.0
        }
    }

    /// The smallest window around its contact.
    pub(crate) fn contact(&self) -> Option<Window> {
        bounds(&self.window, |i, j| self.at(i, j) > 0.0)
    }

    /// This pressure in another window.
    pub(crate) fn moved(&self, window: Window) -> Self {
        let values = window_values(&window, |i, row| {
            for (value, j) in row.iter_mut().zip(window[1].clone()) {
                *value = self.at(i, j);
            }
        });
        Self { window, values }
    }

    /// Writes the pressure into the values of a grid of `columns` columns.
    pub(crate) fn paste(&self, values: &mut [f64], columns: usize) {
        let [x, y] = &self.window;
        let rows = &mut values[x.start * columns..x.end * columns];
        each_row(rows, columns, |k, row| {
            row[y.clone()].copy_from_slice(&self.values[k * y.len()..][..y.len()]);
        });
    }

    /// Linear interpolation between cell centres to a finer grid of `shape`, in a window around the contact.
    /// The finer grid has twice as many cells in the directions of `halved`.
    pub(crate) fn interpolated(&self, shape: [usize; 2], halved: [bool; 2]) -> Self {
        let contact = self.contact().unwrap_or([0..0, 0..0]);
        let fine = [0, 1].map(|k| {
            let factor = if halved[k] { 2 } else { 1 };
            factor * contact[k].start..(factor * contact[k].end).min(shape[k])
        });
        let window = widened(&fine, shape);
        let taps = |k: usize, i: usize| -> [(usize, f64); 2] {
            if !halved[k] {
                return [(i, 1.0), (i, 0.0)];
            }
            let (near, last) = (i / 2, shape[k].div_ceil(2) - 1);
            let next =
                if i.is_multiple_of(2) { near.saturating_sub(1) } else { (near + 1).min(last) };
            [(near, 0.75), (next, 0.25)]
        };
        let [x, y] = &self.window;
        let line = |i: usize| {
            let inside = x.contains(&i);
            inside.then(|| &self.values[(i - x.start) * y.len()..][..y.len()])
        };
        let value = |line: Option<&[f64]>, j: usize| match line {
            Some(line) if y.contains(&j) => line[j - y.start],
            _ => 0.0,
        };
        let columns: Vec<_> = window[1].clone().map(|j| taps(1, j)).collect();
        let values = window_values(&window, |i, row| {
            let [(near, wide), (next, narrow)] = taps(0, i).map(|(i, weight)| (line(i), weight));
            for (fine, [(j, a), (k, b)]) in row.iter_mut().zip(&columns) {
                let here = value(near, *j);
                // Interpolation would widen the contact by half a cell on every side.
                if here > 0.0 {
                    *fine = wide * (a * here + b * value(near, *k))
                        + narrow * (a * value(next, *j) + b * value(next, *k));
                }
            }
        });
        Self { window, values }
    }
}

#[cfg(test)]
mod tests {
    use ndarray::Array2;

    use super::{Patch, WINDOW_MARGIN};

    /// A linear field on the coarse grid of a fine one of `shape` is the same linear field on the fine grid, but
    /// for the outermost cells of a halved direction, which lie beyond all coarse centres.
    #[test]
    fn linear_fields_are_reproduced() {
        for (shape, halved) in [
            ([24_usize, 30], [true, true]),
            ([25, 31], [true, true]),
            ([24, 15], [true, false]),
            ([9, 30], [false, true]),
            ([9, 15], [false, false]),
        ] {
            // A coordinate in fine cells.
            let centre = |k: usize, i: usize| {
                if halved[k] { 2.0 * i as f64 + 0.5 } else { i as f64 }
            };
            let field = |x: f64, y: f64| 2.0 + 0.25 * x - 0.05 * y;
            let coarse = [0, 1].map(|k| if halved[k] { shape[k].div_ceil(2) } else { shape[k] });
            let values = Array2::from_shape_fn(coarse, |(i, j)| field(centre(0, i), centre(1, j)));
            let fine = Patch::of_grid(&values).interpolated(shape, halved);
            assert_eq!(fine.window, shape.map(|n| 0..n));
            let inside = |k: usize, i: usize| {
                !halved[k] || (0.5..=centre(k, coarse[k] - 1)).contains(&(i as f64))
            };
            for i in (0..shape[0]).filter(|&i| inside(0, i)) {
                for j in (0..shape[1]).filter(|&j| inside(1, j)) {
                    let apart = fine.at(i, j) - field(i as f64, j as f64);
                    assert!(apart.abs() < 1e-14, "{halved:?} {i} {j}: {apart:e}");
                }
            }
        }
    }

    /// One coarse cell becomes the cells within it alone, with 3/4 of its pressure for each halved direction, in a
    /// window of [`WINDOW_MARGIN`] more cells on every side.
    #[test]
    fn a_contact_is_not_widened() {
        for halved in [[true, true], [true, false], [false, true]] {
            let shape = halved.map(|halved| if halved { 96 } else { 48 });
            let mut values = Array2::zeros([48, 48]);
            values[[20, 30]] = 16.0;
            let fine = Patch::of_grid(&values).interpolated(shape, halved);
            let contact = [0, 1].map(|k| if halved[k] { 2 } else { 1 } * [20, 30][k]);
            let contact = [0, 1].map(|k| contact[k]..contact[k] + if halved[k] { 2 } else { 1 });
            assert_eq!(fine.contact(), Some(contact.clone()));
            assert_eq!(
                fine.window,
                contact.clone().map(|c| c.start - WINDOW_MARGIN..c.end + WINDOW_MARGIN)
            );
            let expected = if halved == [true; 2] { 9.0_f64 } else { 12.0 };
            for i in contact[0].clone() {
                for j in contact[1].clone() {
                    assert_eq!(fine.at(i, j).to_bits(), expected.to_bits());
                }
            }
        }
    }

    /// A pressure in a window alone, which ends with the grid, gives what it gives on the whole grid.
    #[test]
    fn windows_change_nothing() {
        let values = Array2::from_shape_fn([40, 33], |(i, j)| {
            if i > 33 && (5..12).contains(&j) { (i + 3 * j) as f64 } else { 0.0 }
        });
        let whole = Patch::of_grid(&values);
        let part = whole.moved([31..40, 3..15]);
        let [a, b] = [&whole, &part].map(|p| p.interpolated([79, 66], [true, true]));
        assert_eq!(a.window, [62..79, 4..30]);
        assert_eq!((a.window, a.values), (b.window, b.values));
    }
}
