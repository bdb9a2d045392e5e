//! The tangent operator of a solved contact, K on the cells in contact with the columns of B, and its stiffness.

use std::ops::ControlFlow;
use std::sync::{Arc, OnceLock};

use ndarray::Array2;

use crate::compliance::convolution::{Convolution, Workspace};
use crate::compliance::influence::memory;
use crate::compliance::response::Body;
use crate::contact::options::Setup;
use crate::contact::plan::PlannedOperator;
use crate::contact::problem::patch::{block, copied};
use crate::contact::solution::Report;
use crate::contact::{Compliance, Solution};
use crate::error::Result;
use crate::model::grid::{Grid, Window, full_window, repeating};
use crate::numerics::linear_cg::{self, Watch};
use crate::numerics::parallel::{check_memory, dot};

/// Residual of a linear solve, relative to its right side, below which it is rounding.
const ROUNDING: f64 = 1e-15;

/// Part of a right side beside a span below which there is none, 100 times its rounding.
const NOTHING: f64 = 1e-13;

/// K on the contact, and the columns of B, centred and scaled: 1, (x − x0)/ℓx, (y − y0)/ℓy.
pub(crate) struct Tangent {
    /// The window of the grid's cells.
    pub(crate) window: Window,
    /// K on the whole window.
    pub(crate) convolution: Convolution,
    inverse: Convolution,
    pub(crate) contact: Vec<bool>,
    pub(crate) coordinates: [Vec<f64>; 2],
    /// (x0, y0)
    pub(crate) origin: [f64; 2],
    scale: [f64; 2],
    cell_area: f64,
    /// Displacement \[m/Pa\] by which K is raised, per sum of the pressure: that of a line contact's datum.
    pub(crate) raise: f64,
    /// Coefficients at the offsets of the window at least, and what the ends of bodies add to them.
    planned: Arc<PlannedOperator>,
    source: (Body, Setup, Grid),
    /// Coefficients of the whole grid, once they are needed.
    far: OnceLock<Arc<Array2<f64>>>,
}

impl Tangent {
    /// Plans the tangent of `solution` on the cells of `window`, which holds all that are in contact.
    ///
    /// # Errors
    /// Too little memory, and those of planning the contact.
    pub(crate) fn plan(solution: &Solution, window: Window) -> Result<Self> {
        let (report, grid) = (&solution.report, solution.grid());
        let [x, y] = &window;
        let shape = [x.len(), y.len()];
        check_memory(
            grid.shape(),
            2 * memory(grid) + 2 * Convolution::memory(shape) + (shape[0] * shape[1] * 80) as u64,
        )?;
        let setup = Setup {
            counterbody: report.counterbody.clone(),
            coefficients: solution.coefficients.clone(),
            threads: None,
        };
        let planned = match &solution.operator {
            Some(planned) => Arc::clone(planned),
            None => Arc::new(PlannedOperator::anew(&report.body, &setup, grid, shape)?),
        };
        let corner = block(&planned.coefficients, &full_window(shape)).to_owned();
        let within = planned.additions.iter().map(|addition| addition.on_rows(x.clone()));
        let repeats = repeating(grid, &window);
        let convolution =
            Convolution::plan_repeated(&corner, repeats, Arc::clone(&planned.threads))?;
        let mut convolution = convolution.plus(within.collect());
        let springs = solution.compliance.as_ref().map(|c| c.on(grid)).transpose()?;
        if let Some(springs) = &springs {
            convolution = convolution.on_springs(&copied(springs, &window));
        }
        let inverse = convolution.approximation(&corner, repeats).inverse;
        let contact = block(&solution.pressure, &window);
        let within = |axis: usize| grid.coordinates(axis).to_vec()[window[axis].clone()].to_vec();
        let coordinates = [within(0), within(1)];
        let middle = |line: &Vec<f64>| 0.5 * (line[0] + line[line.len() - 1]);
        let half = |axis: usize| 0.5 * shape[axis] as f64 * grid.spacing()[axis];
        Ok(Self {
            window: window.clone(),
            inverse,
            convolution,
            contact: contact.iter().map(|&p| p > 0.0).collect(),
            origin: [middle(&coordinates[0]), middle(&coordinates[1])],
            scale: [half(0), half(1)],
            coordinates,
            cell_area: grid.cell_area(),
            raise: planned.datum.raise() * grid.cell_area(),
            planned,
            source: (report.body.clone(), setup, *grid),
            far: OnceLock::new(),
        })
    }

    /// A column of B.
    pub(crate) fn column(&self, freedom: usize) -> Vec<f64> {
        let [x, y] = &self.coordinates;
        let cells = x.iter().flat_map(|&x| y.iter().map(move |&y| [x, y]));
        let value = |at: [f64; 2]| match freedom {
            0 => 1.0,
            k => (at[k - 1] - self.origin[k - 1]) / self.scale[k - 1],
        };
        let inside = cells.zip(&self.contact);
        inside.map(|(at, &inside)| if inside { value(at) } else { 0.0 }).collect()
    }

    /// A⁻ᵀ `sums`, where (1, x, y) = (columns of B) A.
    pub(crate) fn to_scaled(&self, [one, x, y]: [f64; 3]) -> [f64; 3] {
        let ([x0, y0], [lx, ly]) = (self.origin, self.scale);
        [one, (x - x0 * one) / lx, (y - y0 * one) / ly]
    }

    /// A⁻¹ `factors`: factors of (1, x, y) from those of the columns of B.
    pub(crate) fn unscaled(&self, [one, x, y]: [f64; 3]) -> [f64; 3] {
        let ([x0, y0], [lx, ly]) = (self.origin, self.scale);
        let (x, y) = (x / lx, y / ly);
        [one - x0 * x - y0 * y, x, y]
    }

    /// Makes [`Tangent::entry`] hold for cells whose distance is below `offsets` along x and y.
    ///
    /// # Errors
    /// Errors of planning the contact.
    pub(crate) fn reach(&self, offsets: [usize; 2]) -> Result<()> {
        let near = &self.planned.coefficients;
        let is_near = offsets[0] <= near.nrows() && offsets[1] <= near.ncols();
        if !is_near && self.far.get().is_none() {
            let (body, setup, grid) = &self.source;
            let whole = PlannedOperator::anew(body, setup, grid, grid.shape())?;
            self.far.get_or_init(|| whole.coefficients);
        }
        Ok(())
    }

    /// Displacement of a cell of the grid under unit pressure on another, with the datum of the tangent. Cells farther apart
    /// than the window is wide need [`Tangent::reach`] first.
    pub(crate) fn entry(&self, cell: [usize; 2], loaded: [usize; 2]) -> f64 {
        let [i, j] = [0, 1].map(|axis| cell[axis].abs_diff(loaded[axis]));
        let added = self.planned.additions.iter();
        let added: f64 = added.map(|added| added.entry([cell[0], loaded[0]], j)).sum();
        self.far.get().unwrap_or(&self.planned.coefficients)[[i, j]] + added
    }

    /// `out` = `operator` `input` on the contact, 0 elsewhere.
    fn restricted(
        &self,
        operator: &Convolution,
        input: &[f64],
        out: &mut [f64],
        workspace: &mut Workspace,
    ) {
        operator.apply_slices(input, out, workspace);
        for (out, inside) in out.iter_mut().zip(&self.contact) {
            if !inside {
                *out = 0.0;
            }
        }
    }

    /// `out` = K `input` on the contact, 0 elsewhere.
    pub(crate) fn apply(&self, input: &[f64], out: &mut [f64]) {
        let mut workspace = self.convolution.workspace();
        self.restricted(&self.convolution, input, out, &mut workspace);
    }

    /// The field y without a part in `span`, which is orthonormal, for which `right` − K y lies in it, to a residual of
    /// `tolerance` relative to `right` beside the span. Without a span it is K_CC⁻¹ `right`.
    ///
    /// # Errors
    /// As [`linear_cg::solve`].
    pub(crate) fn solve_beside(
        &self,
        right: &[f64],
        span: &[&[f64]],
        tolerance: f64,
        watch: &mut Watch,
    ) -> Result<Vec<f64>> {
        let [mut first, mut second] = [self.convolution.workspace(), self.convolution.workspace()];
        let beside = |values: &mut [f64]| {
            for column in span {
                let factor = dot(column, values);
                for (v, q) in values.iter_mut().zip(*column) {
                    *v -= factor * q;
                }
            }
        };
        let mut residual = right.to_vec();
        beside(&mut residual);
        // What is left beside the span may be rounding.
        let relative =
            dot(&residual, &residual).sqrt() / dot(right, right).sqrt().max(f64::MIN_POSITIVE);
        if relative <= NOTHING {
            return Ok(vec![0.0; right.len()]);
        }
        let tolerance = tolerance.max(ROUNDING / relative);
        linear_cg::solve(
            &residual,
            |input, out| {
                self.restricted(&self.convolution, input, out, &mut first);
                beside(out);
            },
            |input, out| {
                self.restricted(&self.inverse, input, out, &mut second);
                beside(out);
            },
            tolerance,
            watch,
        )
    }
}

/// A quadratic form of the columns of B.
type Form = [[f64; 3]; 3];

/// Residual of the linear systems. The error of the stiffness is its square.
const TOLERANCE: f64 = 1e-9;

impl Solution {
    /// The exact tangent of (Σ p dA, Σ p x dA, Σ p y dA) with respect to (δ, s_x, s_y), of the
    /// discrete contact: symmetric, in N/m, N and N m.
    ///
    /// In a line contact δ is counted from the datum of [`Grid::line`](crate::Grid::line): below a stiff layer
    /// that is wider than the grid, δ may fall as the load grows. There is no tilt along directions in which the grid
    /// repeats: rows and columns of these are 0.
    ///
    /// The second row is the couple about y in which force at positive x is positive. While the
    /// contact C stays, K p = δ + s_x x + s_y y − h on it, so that the tangent is
    /// dA Bᵀ K_CC⁻¹ B, where B = (1, x, y) on C. All zero where nothing touches.
    ///
    /// `watch` is asked before each iteration whether to continue.
    ///
    /// # Errors
    /// Too little memory, [`Error::NotConverged`](crate::Error::NotConverged), or
    /// [`Error::Stopped`](crate::Error::Stopped) where `watch` breaks.
    ///
    /// ```
    /// use nacre::{Contact, Elastic, FlatPunch, Grid, Motion, Options, Setup};
    /// // A rigid flat punch of radius a on a half-space: dW/dδ = 2 E* a.
    /// let contact = Contact::plan(Elastic::new(1.0, 0.0)?, Grid::new([64, 64], [2.5, 2.5])?, Setup::default())?;
    /// let solution = contact.solve(&FlatPunch::new(1.0)?, &Motion::load(1.0), &Options::default())?;
    /// let [[normal, coupled, _], ..] = solution.stiffness(None)?;
    /// assert!((normal / 2.0 - 1.0).abs() < 0.02 && coupled.abs() < 1e-9);
    /// # Ok::<(), nacre::Error>(())
    /// ```
    pub fn stiffness(&self, watch: Option<&mut Watch>) -> Result<[[f64; 3]; 3]> {
        let go_on = &mut || ControlFlow::Continue(());
        let watch: &mut Watch = match watch {
            Some(watch) => watch,
            None => go_on,
        };
        let Some(window) = self.cells_in_contact() else {
            return Ok([[0.0; 3]; 3]);
        };
        let tangent = Tangent::plan(self, window)?;
        let (stiffness, _) = tangent.quadratic_form(3, watch)?;
        let mut stiffness = tangent.about_origin(stiffness);
        for axis in (0..2).filter(|&axis| self.grid().is_periodic()[axis]) {
            stiffness[axis + 1] = [0.0; 3];
            stiffness.iter_mut().for_each(|row| row[axis + 1] = 0.0);
        }
        Ok(stiffness)
    }
}

impl Solution {
    /// Sum over the cells in contact of the field q \[1/Pa\] with K q = 1 there, times the area of a cell, and the field: K of
    /// these bodies, with a diagonal of `springs`. For conductors it is their conductance.
    ///
    /// # Errors
    /// As [`Solution::stiffness`].
    pub(crate) fn unit_flux(
        &self,
        body: Body,
        counterbody: Option<Body>,
        springs: Option<Compliance>,
        watch: Option<&mut Watch>,
    ) -> Result<(f64, Array2<f64>)> {
        let go_on = &mut || ControlFlow::Continue(());
        let watch: &mut Watch = watch.unwrap_or(go_on);
        let mut field = Array2::zeros(self.grid().shape());
        let Some(window) = self.cells_in_contact() else { return Ok((0.0, field)) };
        let report = Report { body, counterbody, ..self.report.clone() };
        let (operator, coefficients) = (None, None);
        let on = Self { report, operator, coefficients, compliance: springs, ..self.clone() };
        let tangent = Tangent::plan(&on, window.clone())?;
        let (sum, mut fields) = tangent.quadratic_form(1, watch)?;
        let flux = fields.remove(0);
        let [x, y] = window;
        let cells = x.flat_map(|i| y.clone().map(move |j| [i, j]));
        cells.zip(flux).for_each(|(cell, q)| field[cell] = q);
        Ok((sum[0][0] * self.grid().cell_area(), field))
    }
}

impl Tangent {
    /// Bᵀ K⁻¹ B of the first `count` columns of B, with the datum of the contact, and these columns of K⁻¹ B.
    fn quadratic_form(&self, count: usize, watch: &mut Watch) -> Result<(Form, Vec<Vec<f64>>)> {
        let columns: Vec<_> = (0..count).map(|freedom| self.column(freedom)).collect();
        let fields: Result<Vec<_>> =
            columns.iter().map(|b| self.solve_beside(b, &[], TOLERANCE, watch)).collect();
        let fields = fields?;
        // bᵢᵀxⱼ + xᵢᵀ(bⱼ − K xⱼ): symmetric, and in error by the square of the residual alone.
        let mut form = [[0.0; 3]; 3];
        for (j, (b, x)) in columns.iter().zip(&fields).enumerate() {
            let mut residual = vec![0.0; b.len()];
            self.apply(x, &mut residual);
            residual.iter_mut().zip(b).for_each(|(r, b)| *r = b - *r);
            for (i, (b, y)) in columns.iter().zip(&fields).enumerate() {
                form[i][j] = dot(b, x) + dot(y, &residual);
            }
        }
        self.lower_datum(&mut form);
        Ok((form, fields))
    }

    /// Turns the tangent for K into that for K − s 1ᵀ1, by the formula of Sherman & Morrison.
    fn lower_datum(&self, stiffness: &mut [[f64; 3]; 3]) {
        let column = stiffness.map(|row| row[0]);
        let factor = self.raise / (1.0 - self.raise * column[0]);
        for (row, a) in stiffness.iter_mut().zip(column) {
            for (entry, b) in row.iter_mut().zip(column) {
                *entry += factor * a * b;
            }
        }
    }

    /// Aᵀ S A dA, where (1, x, y) = (columns of B) A.
    fn about_origin(&self, scaled: [[f64; 3]; 3]) -> [[f64; 3]; 3] {
        let ([x, y], [lx, ly]) = (self.origin, self.scale);
        let columns = [[1.0, 0.0, 0.0], [x, lx, 0.0], [y, 0.0, ly]];
        let form = |a: [f64; 3], b: [f64; 3]| -> f64 {
            let row = |i: usize| (0..3).map(|j| scaled[i][j] * b[j]).sum::<f64>();
            (0..3).map(|i| a[i] * row(i)).sum::<f64>() * self.cell_area
        };
        columns.map(|a| columns.map(|b| form(a, b)))
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use crate::contact::{Contact, Motion, Options, Setup, Solution};
    use crate::error::Result;
    use crate::model::grid::Grid;
    use crate::model::material::Elastic;
    use crate::model::surface::Paraboloid;

    use super::Tangent;

    /// The tangent has the coefficients and the threads of the plan that solved the contact. A solution from a file is planned
    /// anew; of a bare body, whose coefficients do not depend on the grid, its stiffness is the same to the bit.
    #[test]
    fn the_tangent_has_the_plan_of_the_solution() -> Result<()> {
        let grid = Grid::new([32, 24], [4.0, 3.0])?;
        let setup = Setup { threads: Some(1), ..Setup::default() };
        let contact = Contact::plan(Elastic::new(1.0, 0.3)?, grid, setup)?;
        let shape = Paraboloid::new(1e3, 1e3)?;
        let solution = contact.solve(&shape, &Motion::load(1e-3), &Options::default())?;
        let window = solution.cells_in_contact().expect("a contact");
        let tangent = Tangent::plan(&solution, window)?;
        assert_eq!(tangent.convolution.threads(), 1);
        assert!(Arc::ptr_eq(&tangent.planned, &contact.operator));
        let fields = [solution.pressure.clone(), solution.gap(), solution.displacement.clone()];
        let (approach, tilt) = (solution.approach, solution.tilt);
        let copy = Solution::from_fields(fields, approach, tilt, solution.report.clone())?;
        assert_eq!(copy.stiffness(None)?, solution.stiffness(None)?);
        Ok(())
    }
}
