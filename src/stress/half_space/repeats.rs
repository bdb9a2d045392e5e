//! Coefficients of stress on grids that repeat: sums over the images of a cell.
//!
//! The mean over a period is that of a uniform load with which the body does not stretch along the periods: under the
//! pressure p, σ_zz = −p and σ_xx = σ_yy = −ν p/(1 − ν) in every layer. Where one direction is open, it is that of a
//! strip.
//!
//! Sums over the images of a plate with a free base diverge. It is the same plate on a rigid base, and waves of the
//! difference: derived here.

use std::f64::consts::PI;
use std::ops::Range;

use ndarray::Array2;
use rayon::prelude::*;

use crate::compliance::images::CellImages;
use crate::compliance::influence::PlateWaves;
use crate::compliance::kernel::loads::{COMPONENTS, EXCHANGED, Radial};
use crate::compliance::kernel::plane::{CellPlan, CellSource, ComponentsAt, FAR, Kernel};
use crate::compliance::kernel::strip::LinePlan;
use crate::compliance::response::interior::{Column, Place};
use crate::compliance::response::is_free;
use crate::model::body::{HalfSpace, Layer, Substrate};
use crate::model::grid::Grid;
use crate::model::material::Elastic;
use crate::numerics::fft::Keep;

/// Distance of the end of the sums, in longest lengths of what is summed: 1e-7 of the coefficient of the loaded cell is
/// left.
const STRESS_RINGS: f64 = 8.0;

/// Rows of coefficients that one thread makes at a time.
const ROWS_TOGETHER: usize = 8;

/// What a plan on a grid that repeats has besides the kernels of its cells.
#[derive(Debug)]
pub(in crate::stress) struct Repeats {
    images: CellImages,
    /// Kernels of the rectangle of all images that are summed.
    block: CellPlan,
    block_half: [f64; 2],
    /// Strips along the direction that is open, where there is one.
    strips: Option<LinePlan>,
    /// The direction that is open.
    open: usize,
    /// Waves on a plate with a free base.
    plate: Option<PlateWaves>,
    body: HalfSpace,
    grid: Grid,
}

/// Gives the coefficients of some rows to its second argument.
pub(super) type RowSource<'a> = dyn Fn(Range<usize>, &mut Keep) + Sync + 'a;

/// A load whose coefficients are summed: pressure, or traction along an axis.
pub(super) type Axis = Option<usize>;

impl Repeats {
    /// The plan for `grid`; none where it does not repeat. On the threads of the caller.
    pub(in crate::stress) fn plan(body: &HalfSpace, grid: &Grid) -> Option<Self> {
        let periodic = grid.is_periodic();
        if periodic == [false; 2] {
            return None;
        }
        let images = CellImages::plan(grid, STRESS_RINGS);
        let sides = images.block_sides();
        // From one end of the rectangle to places beyond the other.
        let reach = images.block_reach() + sides[0].hypot(sides[1]);
        let open = usize::from(periodic[0]);
        // A line grid of the cells along the open direction, which is valid where the grid is.
        let line = Grid::line(grid.shape()[open], grid.size()[open]);
        let strips = line.ok().filter(|_| periodic != [true; 2]);
        Some(Self {
            block: CellPlan::new(&body.with_rigid_base(), sides, 1.0, reach),
            plate: is_free(body).then(|| PlateWaves::new(body, grid).ok()).flatten(),
            block_half: sides.map(|side| 0.5 * side),
            strips: strips.map(|line| LinePlan::new(body, &line, 1.0)),
            open,
            body: body.clone(),
            grid: *grid,
            images,
        })
    }

    /// The kernel of the rectangle of all images, for the load L.
    pub(super) fn block_kernel<const N: usize, L: Radial<N>>(
        &self,
        place: &Place,
    ) -> Kernel<'_, N> {
        Kernel::new::<L>(&self.block, place)
    }

    /// Largest distance at which the cells' kernels are evaluated.
    pub(in crate::stress) fn reach(&self) -> f64 {
        self.images.reach()
    }

    /// Numbers of offsets of the cells that are summed one by one.
    pub(super) fn extents(&self) -> [usize; 2] {
        [0, 1].map(|k| match self.grid.is_periodic()[k] {
            true => *self.images.near(k).end() as usize * self.grid.shape()[k] + 1,
            false => self.grid.shape()[k],
        })
    }

    /// Arrays of the coefficients of C components at all offsets. `source` has those of one cell alone, at offsets up to
    /// [`Repeats::extents`], `block` those of the rectangle of half sides `half`.
    pub(super) fn coefficients<M: ComponentsAt, P: ComponentsAt, const C: usize>(
        &self,
        source: &CellSource<M, P, C>,
        block: impl Fn([f64; 2], [f64; 2]) -> [f64; COMPONENTS] + Sync,
        (place, axis): (&Place, Axis),
    ) -> Vec<Array2<f64>> {
        let far = self.images.far(
            |[x, y]| mean_of_cell(source, x, y),
            |at| {
                let values = block(at, self.block_half);
                std::array::from_fn(|k| values[k])
            },
        );
        let uniform = self.uniform(place, axis);
        let base = self.of_free_base(place, source.odd);
        let kept = self.images.kept();
        let starts: Vec<usize> = (0..kept[0]).step_by(ROWS_TOGETHER).collect();
        let near: Vec<Vec<f64>> = starts
            .par_iter()
            .map(|start| self.near_rows(source, *start..(start + ROWS_TOGETHER).min(kept[0])))
            .collect();
        (0..C)
            .map(|component| {
                let sum = Array2::from_shape_fn((kept[0], kept[1]), |(i, j)| {
                    let (block, row) = (i / ROWS_TOGETHER, i % ROWS_TOGETHER);
                    let rows = near[block].len() / (C * kept[1]);
                    let base = base.as_ref().map_or(0.0, |base| base[component][[i, j]]);
                    near[block][(component * rows + row) * kept[1] + j]
                        + far[component][[i, j]]
                        + base
                });
                let mut whole = self.images.whole(&sum, source.odd[component]);
                let means: Vec<f64> = uniform.iter().map(|values| values[component]).collect();
                self.images.with_mean(&mut whole, &means);
                whole
            })
            .collect()
    }

    /// Sums over the near images of some rows, component by component.
    fn near_rows<M: ComponentsAt, P: ComponentsAt, const C: usize>(
        &self,
        source: &CellSource<M, P, C>,
        rows: Range<usize>,
    ) -> Vec<f64> {
        let (kept, [nx, ny]) = (self.images.kept(), self.grid.shape());
        let mut sums = vec![0.0; C * rows.len() * kept[1]];
        for k in self.images.near(0) {
            // Rows of offsets |i − k nx| from the cell, in rising order.
            let shift = k.unsigned_abs() as usize * nx;
            let behind = k > 0;
            let range = match behind {
                true => shift + 1 - rows.end..shift + 1 - rows.start,
                false => rows.start + shift..rows.end + shift,
            };
            let mut keep = |row: usize, component: usize, values: &[f64]| {
                let i = if behind { shift - row } else { row - shift };
                let [odd_x, odd_y] = source.odd[component];
                let along = if behind && odd_x { -1.0 } else { 1.0 };
                let start = (component * rows.len() + i - rows.start) * kept[1];
                let sums = &mut sums[start..start + kept[1]];
                for l in self.images.near(1) {
                    let across = if l > 0 && odd_y { -1.0 } else { 1.0 };
                    for (j, sum) in sums.iter_mut().enumerate() {
                        let offset = j as i64 - l * ny as i64;
                        *sum += along * across * values[offset.unsigned_abs() as usize];
                    }
                }
            };
            source.rows(range, &mut keep);
        }
        sums
    }

    /// What a free base adds to the coefficients of C components under pressure, without their means.
    ///
    /// ```text
    /// p = cos mx cos ny:   σ_xx = (c² σ_LL + s² σ_TT) cos mx cos ny      σ_xy = −cs (σ_LL − σ_TT) sin mx sin ny
    ///                      σ_xz = c τ sin mx cos ny     u_x = −c V/α sin mx cos ny     c = m/α, s = n/α
    /// ```
    fn of_free_base<const C: usize>(
        &self,
        place: &Place,
        odd: [[bool; 2]; C],
    ) -> Option<[Array2<f64>; C]> {
        let (plate, rigid_base) = (self.plate.as_ref()?, self.body.with_rigid_base());
        let response = |[m, n]: [f64; 2]| {
            let alpha = m.hypot(n);
            let at = |body: &HalfSpace| Column::new(body, alpha).at(body, place).pressure;
            let (free, fixed) = (at(&self.body), at(&rigid_base));
            let ((a, b), (c, d)) =
                (free.lateral_stress(place.material), fixed.lateral_stress(place.material));
            let (along, across) = (a - c, b - d);
            let (p, tau) = (free.p - fixed.p, free.tau - fixed.tau);
            let (w, v) = ((free.w - fixed.w) / alpha, (free.v - fixed.v) / alpha);
            let (c, s) = (m / alpha, n / alpha);
            let all = [
                c * c * along + s * s * across,
                s * s * along + c * c * across,
                -p,
                -c * s * (along - across),
                s * tau,
                c * tau,
                -c * v,
                -s * v,
                w,
            ];
            std::array::from_fn::<f64, C, _>(|k| all[k])
        };
        let (shape, [columns, rows]) = (self.grid.shape(), self.images.kept());
        let spectrum: Vec<[f64; C]> = (0..columns * rows)
            .into_par_iter()
            .map(|number| match number {
                0 => [0.0; C],
                _ => plate.sum([number / rows, number % rows], response),
            })
            .collect();
        // (wave, offset): half a period of either stands for the whole.
        let waves = |axis: usize, odd: bool| {
            let (kept, n) = (self.images.kept()[axis], shape[axis]);
            Array2::from_shape_fn((kept, kept), |(k, i)| {
                let phase = 2.0 * PI * (k * i % n) as f64 / n as f64;
                let twice = if k == 0 || 2 * k == n { 1.0 } else { 2.0 };
                twice / n as f64 * if odd { phase.sin() } else { phase.cos() }
            })
        };
        Some(std::array::from_fn(|component| {
            let [odd_x, odd_y] = odd[component];
            let amplitudes =
                Array2::from_shape_fn((columns, rows), |(k, l)| spectrum[k * rows + l][component]);
            waves(0, odd_x).t().dot(&amplitudes).dot(&waves(1, odd_y))
        }))
    }

    /// Components under a unit load on all cells, where both directions repeat; otherwise those at each offset along
    /// the open direction, of a strip under a unit load.
    fn uniform(&self, place: &Place, axis: Axis) -> Vec<[f64; COMPONENTS]> {
        let Some(strips) = &self.strips else {
            return vec![everywhere(&self.body, place, axis)];
        };
        // Strips are endless along x: where y repeats, x and y are exchanged.
        let exchanged = self.open == 0;
        let values =
            strips.coefficients(place, axis.map(|axis| if exchanged { 1 - axis } else { axis }));
        let turned = |values: [f64; COMPONENTS]| match exchanged {
            true => EXCHANGED.map(|k| values[k]),
            false => values,
        };
        values.into_iter().map(turned).collect()
    }
}

/// Components at (x, y) from a cell under a unit load: means, or differences where the cell is far.
fn mean_of_cell<M: ComponentsAt, P: ComponentsAt, const C: usize>(
    source: &CellSource<M, P, C>,
    x: f64,
    y: f64,
) -> [f64; C] {
    let [dx, dy] = source.spacing;
    let values = if x.hypot(y).hypot(source.depth) < (FAR + 1.0) * dx.max(dy) {
        (source.mean)(x, y)
    } else {
        let point = |x: f64, y: f64| (source.point)(x, y);
        let here = point(x, y);
        let around = [point(x - dx, y), point(x + dx, y), point(x, y - dy), point(x, y + dy)];
        std::array::from_fn(|k| {
            let sum: f64 = around.iter().map(|values| values[k]).sum();
            dx * dy * (here[k] + (sum - 4.0 * here[k]) / 24.0)
        })
    };
    std::array::from_fn(|k| values[k])
}

/// Components at `place` under a unit load everywhere. The displacement is counted from the mean of the surface, or
/// from the rigid base.
fn everywhere(body: &HalfSpace, place: &Place, axis: Axis) -> [f64; COMPONENTS] {
    let compliance = |material: Elastic| match axis {
        None => (1.0 - 2.0 * material.poisson()) / (2.0 - 2.0 * material.poisson()),
        Some(_) => 1.0,
    } / material.shear();
    let moved = |count: usize| -> f64 {
        let layers = body.layers().iter().take(count);
        let of = |layer: &Layer| {
            let springs = layer.interface().compliances()[usize::from(axis.is_some())];
            layer.thickness() * compliance(layer.material()) + springs
        };
        layers.map(of).sum()
    };
    let above = moved(place.layer) + place.below_top * compliance(place.material);
    let whole = match body.substrate() {
        Substrate::Rigid => moved(body.layers().len()),
        Substrate::Elastic(_) | Substrate::Free => 0.0,
    };
    let mut values = [0.0; COMPONENTS];
    match axis {
        None => {
            let nu = place.material.poisson();
            let side = -nu / (1.0 - nu);
            [values[0], values[1], values[2], values[8]] = [side, side, -1.0, whole - above];
        }
        Some(axis) => {
            values[if axis == 0 { 5 } else { 4 }] = -1.0;
            values[6 + axis] = whole - above;
        }
    }
    values
}

/// Gives the coefficients of arrays to whoever asks for rows.
pub(super) fn rows_of<'a>(arrays: &'a [Array2<f64>], columns: usize) -> Box<RowSource<'a>> {
    Box::new(move |rows: Range<usize>, keep: &mut Keep| {
        for i in rows {
            for (k, array) in arrays.iter().enumerate() {
                let row: Vec<f64> = array.row(i).iter().take(columns).copied().collect();
                keep(i, k, &row);
            }
        }
    })
}

/// Sums over images against waves in the layered body.
#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;
    use crate::compliance::response::interior::{Column, InPlane};
    use crate::error::Result;
    use crate::model::body::{Interface, Spring};
    use crate::stress::section::place;
    use crate::stress::{Side, Stress, StressOptions, stress};

    const CELLS: [usize; 2] = [24, 15];

    /// Bare, under a thin hard and a thick soft layer, two layers of which one slips, a layer on springs, one on a rigid
    /// base, and a plate; thicknesses in cells.
    fn bodies() -> Result<Vec<HalfSpace>> {
        let (soft, hard) = (Elastic::new(1.0, 0.3)?, Elastic::new(5.0, 0.2)?);
        let springs = Interface::Spring(Spring::new(Some(0.5), Some(0.2))?);
        let slipping = Layer::new(soft, 2.0)?.with_interface(Interface::Frictionless);
        Ok(vec![
            soft.into(),
            HalfSpace::new(soft, [Layer::new(hard, 0.4)?])?,
            HalfSpace::new(hard, [Layer::new(soft, 30.0)?])?,
            HalfSpace::new(soft, [Layer::new(hard, 1.0)?, slipping])?,
            HalfSpace::new(hard, [Layer::new(soft, 2.0)?.with_interface(springs)])?,
            HalfSpace::new(Substrate::Rigid, [Layer::new(soft, 3.0)?])?,
            HalfSpace::new(Substrate::Free, [Layer::new(soft, 3.0)?])?,
        ])
    }

    /// Fields of pressures that are uniform over cells, 1 + cos(2πk x/L) cos(2πl y/L) at their centres.
    fn waves(body: &HalfSpace, depth: f64, waves: [usize; 2]) -> Result<(Stress, Grid)> {
        let size = CELLS.map(|n| n as f64);
        let grid = Grid::new(CELLS, size)?.periodic([true; 2])?;
        let phase =
            |k: usize, i: usize| 2.0 * PI * (waves[k] * (2 * i + 1)) as f64 / (2 * CELLS[k]) as f64;
        let pressure =
            Array2::from_shape_fn(CELLS, |(i, j)| 1.0 + phase(0, i).cos() * phase(1, j).cos());
        let options = StressOptions { displacement: true, ..StressOptions::default() };
        Ok((stress(body, &grid, &pressure, &[depth], &options)?, grid))
    }

    /// Amplitudes of all waves that look like this one at the centres of the cells, with their wavenumbers.
    fn aliases(wave: usize, cells: usize) -> Vec<(f64, f64)> {
        (-400..=400_i64)
            .map(|alias| {
                let number = wave as f64 + (alias * cells as i64) as f64;
                let at = PI * number / cells as f64;
                let mean = if at.abs() < 1e-12 { 1.0 } else { at.sin() / at };
                let sign = if alias % 2 == 0 { 1.0 } else { -1.0 };
                (sign * mean, 2.0 * PI * number / cells as f64)
            })
            .collect()
    }

    fn state(body: &HalfSpace, place: &Place, alpha: f64) -> InPlane {
        Column::new(body, alpha).at(body, place).pressure
    }

    /// Waves along x have the stress and displacement of the layered body, Σ over all that look alike; the mean has
    /// none along the surface. Sums over images err by 1e-7 of the coefficient of the loaded cell, which is at most the
    /// pressure; the sums of aliases end where e^{−αz} is 1e-12.
    #[test]
    #[ignore = "slow"]
    fn waves_along_one_direction_are_those_of_the_body() -> Result<()> {
        for (number, body) in bodies()?.iter().enumerate() {
            let deepest = match body.substrate() {
                Substrate::Rigid | Substrate::Free => 2.9,
                Substrate::Elastic(_) => 6.0,
            };
            for depth in [0.3, 1.7, deepest] {
                let (field, _) = waves(body, depth, [3, 0])?;
                let place = place(body, depth, Side::Below)?;
                let nu = place.material.poisson();
                let i = 4;
                let x = i as f64 + 0.5;
                let mut due = [0.0; 5];
                for (amplitude, q) in aliases(3, CELLS[0]) {
                    let alpha = q.abs();
                    if alpha * depth > 40.0 {
                        continue;
                    }
                    let state = state(body, &place, alpha);
                    let (along, across) = state.lateral_stress(place.material);
                    let (sin, cos) = (alpha * x).sin_cos();
                    due[0] += amplitude * along * cos;
                    due[1] += amplitude * across * cos;
                    due[2] -= amplitude * state.p * cos;
                    due[3] += amplitude * state.tau * sin;
                    due[4] += amplitude * state.w / alpha * cos;
                }
                let mean = [-nu / (1.0 - nu), -nu / (1.0 - nu), -1.0, 0.0];
                let stresses = [field.xx(), field.yy(), field.zz(), field.xz()];
                for ((stress, due), mean) in stresses.iter().zip(due).zip(mean) {
                    for j in [0, 7] {
                        let error = stress[[0, i, j]] - due - mean;
                        assert!(error.abs() < 1e-6, "body {number}, z {depth}: {error:e}");
                    }
                }
                // Shears across the wave are none.
                assert!(field.yz().iter().chain(field.xy()).all(|s| s.abs() < 1e-6));
                let uz = field.uz().expect("it was asked for");
                let waves = uz[[0, i, 0]] - uz[[0, i + 4, 0]];
                // Half a wave further the sign has changed; the mean drops out.
                assert!((waves - 2.0 * due[4]).abs() < 2e-6, "{number} {waves:e} {:e}", due[4]);
            }
        }
        Ok(())
    }

    /// Crossed waves are those of the body, too: σ_zz.
    #[test]
    #[ignore = "slow"]
    fn crossed_waves_are_those_of_the_body() -> Result<()> {
        for body in &bodies()? {
            let depth = 1.3;
            let (field, _) = waves(body, depth, [2, 4])?;
            let place = place(body, depth, Side::Below)?;
            let (i, j) = (5, 6);
            let mut due = -1.0;
            for (a, qx) in aliases(2, CELLS[0]).into_iter().filter(|(_, q)| q.abs() < 25.0) {
                for (b, qy) in aliases(4, CELLS[1]).into_iter().filter(|(_, q)| q.abs() < 25.0) {
                    let state = state(body, &place, qx.hypot(qy));
                    let [x, y] = [qx * (i as f64 + 0.5), qy * (j as f64 + 0.5)];
                    due -= a * b * state.p * x.cos() * y.cos();
                }
            }
            let error = field.zz()[[0, i, j]] - due;
            assert!(error.abs() < 1e-6, "{error:e}");
        }
        Ok(())
    }
}
