//! The linearisation of a contact: adjoint solves for outputs, tangent solves for directions.

use std::ops::ControlFlow;

use ndarray::{Array2, ArrayRef2};

use super::output::{Direction, Gradient, Output};
use super::parameter::{Parameter, Slope, all, named};
use super::seed::{Seed, offsets};
use super::state::{Saddle, State};
use super::stress::StressSeed;
use crate::contact::Solution;
use crate::error::{Error, Result, require};
use crate::model::surface::Surface;
use crate::numerics::parallel::dot;

/// Margin below which a contact is next to one of other cells: 100 times what is left of the polished residual.
const MARGIN: f64 = 1e-10;

/// How linear systems are solved.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LinearOptions {
    /// Residual of the linear systems, relative to their right sides. Default: 1e-9.
    pub tolerance: f64,
}

impl Default for LinearOptions {
    fn default() -> Self {
        Self { tolerance: 1e-9 }
    }
}

/// Asked before each iteration of a linear solve whether to go on.
type Watch<'a> = dyn FnMut() -> ControlFlow<()> + 'a;

/// A contact linearised at its solution: what all outputs and parameters share.
pub struct Linearisation<'a> {
    pub(super) solution: &'a Solution,
    pub(super) shape: Option<&'a dyn Surface>,
    pub(super) state: State,
    parameters: Vec<Parameter>,
    tolerance: f64,
    margin: f64,
}

impl std::fmt::Debug for Linearisation<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Linearisation({} parameters)", self.parameters.len())
    }
}

impl Solution {
    /// Derivatives of `output` with respect to all parameters of the contact, and to those of `shape` if that is given,
    /// which must be the one that the contact was solved with.
    ///
    /// # Errors
    /// [`Error::NotDifferentiable`] for an output or a solution without a derivative.
    pub fn gradient(&self, output: &Output, shape: Option<&dyn Surface>) -> Result<Gradient> {
        let linearisation = Linearisation::plan(self, shape, &LinearOptions::default())?;
        let mut found = linearisation.gradients(std::slice::from_ref(output), None)?;
        found.pop().ok_or(STOPPED)
    }
}

/// The error of a solve that was stopped though nobody asked.
const STOPPED: Error = Error::Inconsistent("the linear solve was stopped before it was complete");

impl<'a> Linearisation<'a> {
    /// Linearises `solution`. Parameters of the shape need the `shape` that it was solved with.
    ///
    /// # Errors
    /// [`Error::NotDifferentiable`] for a solution without a derivative; too little memory.
    pub fn plan(
        solution: &'a Solution,
        shape: Option<&'a dyn Surface>,
        options: &LinearOptions,
    ) -> Result<Self> {
        let never = &mut || ControlFlow::Continue(());
        Self::plan_watched(solution, shape, options, never)?.ok_or(STOPPED)
    }

    /// [`Linearisation::plan`] that asks `watch` before each iteration whether to go on; `None` where it breaks.
    ///
    /// # Errors
    /// As [`Linearisation::plan`].
    pub fn plan_watched(
        solution: &'a Solution,
        shape: Option<&'a dyn Surface>,
        options: &LinearOptions,
        watch: &mut Watch,
    ) -> Result<Option<Self>> {
        require(
            "tolerance",
            options.tolerance,
            options.tolerance > 0.0 && options.tolerance < 1.0,
            "above 0 and below 1",
        )?;
        let Some(state) = State::new(solution, watch)? else {
            return Ok(None);
        };
        Ok(Some(Self {
            parameters: all(solution, shape),
            margin: state.margin(),
            tolerance: options.tolerance,
            solution,
            shape,
            state,
        }))
    }

    /// All parameters with respect to which outputs have derivatives.
    pub fn parameters(&self) -> &[Parameter] {
        &self.parameters
    }

    /// The pressure, exact on the cells in contact.
    pub fn pressure(&self) -> Array2<f64> {
        self.spread(&self.state.pressure)
    }

    /// Derivatives of `outputs` with respect to the parameters with the paths `wrt`; `None` stands for all.
    ///
    /// # Errors
    /// [`Error::NotDifferentiable`] for outputs and parameters without a derivative; bad points.
    pub fn gradients(&self, outputs: &[Output], wrt: Option<&[&str]>) -> Result<Vec<Gradient>> {
        let never = &mut || ControlFlow::Continue(());
        self.gradients_watched(outputs, wrt, never)?.ok_or(STOPPED)
    }

    /// [`Linearisation::gradients`] that asks `watch` before each iteration whether to go on; `None` where it breaks.
    ///
    /// # Errors
    /// As [`Linearisation::gradients`].
    pub fn gradients_watched(
        &self,
        outputs: &[Output],
        wrt: Option<&[&str]>,
        watch: &mut Watch,
    ) -> Result<Option<Vec<Gradient>>> {
        let parameters = match wrt {
            None => self.parameters.clone(),
            Some(paths) => {
                // Only stresses depend on friction, each by itself.
                let slides = outputs.iter().any(|one| matches!(one, Output::Stress(_)));
                let others = paths
                    .iter()
                    .filter(|path| !(slides && **path == "friction"));
                named(&self.parameters, &others.copied().collect::<Vec<_>>())?
            }
        };
        let mut seeds = Vec::new();
        let mut stresses = Vec::new();
        for output in outputs {
            if watch().is_break() {
                return Ok(None);
            }
            let (seed, stress) = self.seed(output)?;
            seeds.push(seed);
            stresses.push(stress);
        }
        let mut adjoints = Vec::new();
        for seed in &seeds {
            let state = &self.state;
            match state.saddle(&seed.pressure, seed.motion, self.tolerance, watch)? {
                Some(adjoint) => adjoints.push(adjoint),
                None => return Ok(None),
            }
        }
        let mut found: Vec<Gradient> = (outputs.iter().zip(&seeds).zip(&adjoints))
            .map(|((output, seed), adjoint)| self.gradient_of(output, seed, adjoint))
            .collect();
        let cells: Vec<_> = seeds
            .iter()
            .flat_map(|seed| &seed.displaced)
            .copied()
            .collect();
        let reach = offsets(self.state.tangent.window(), &cells);
        let contact = (self.solution, self.shape);
        for parameter in &parameters {
            let Some(slope) = Slope::new(contact, &self.state, parameter, reach, watch)? else {
                return Ok(None);
            };
            let parts = seeds.iter().zip(&adjoints).zip(&stresses);
            for (gradient, ((seed, adjoint), stress)) in found.iter_mut().zip(parts) {
                let mut value = self.derivative(seed, adjoint, &slope, parameter);
                if let Some(stress) = stress {
                    if watch().is_break() {
                        return Ok(None);
                    }
                    value += stress.direct(self.solution, parameter)?;
                }
                gradient.values.push((parameter.clone(), value));
            }
        }
        for (gradient, stress) in found.iter_mut().zip(&stresses) {
            if let Some(stress) = stress
                && stress.slides(self.solution)
                && wrt.is_none_or(|paths| paths.contains(&"friction"))
            {
                let value = stress.direct(self.solution, &Parameter::Friction)?;
                gradient.values.push((Parameter::Friction, value));
            }
        }
        Ok(Some(found))
    }

    /// The seed of an output, and what a stress needs beside.
    fn seed(&self, output: &Output) -> Result<(Seed, Option<StressSeed>)> {
        let Output::Stress(stress) = output else {
            return Ok((Seed::of(self.solution, &self.state, output)?, None));
        };
        let (seed, source) = StressSeed::new(self.solution, &self.state, stress, self.pressure())?;
        Ok((seed, Some(source)))
    }

    /// dJ/dθ = ∂J/∂θ − ψᵀ b − χᵀ Ḟ/dA
    fn derivative(
        &self,
        seed: &Seed,
        adjoint: &Saddle,
        slope: &Slope,
        parameter: &Parameter,
    ) -> f64 {
        let mut value = -dot(&adjoint.psi, &slope.field);
        for (chi, target) in adjoint.chi.iter().zip(slope.target) {
            value -= chi * target;
        }
        value += match parameter {
            Parameter::Approach => seed.prescribed[0],
            Parameter::Tilt(axis) => seed.prescribed[axis + 1],
            _ => {
                let at = |cell: [usize; 2]| slope.at(self.solution, &self.state, cell);
                let part = usize::from(seed.is_gap);
                let cells = seed.displaced.iter();
                cells.map(|(cell, weight)| weight * at(*cell)[part]).sum()
            }
        };
        value
    }

    fn gradient_of(&self, output: &Output, seed: &Seed, adjoint: &Saddle) -> Gradient {
        let negative: Vec<f64> = adjoint.psi.iter().map(|psi| -psi).collect();
        let mut gap = self.spread(&negative);
        if seed.is_gap {
            for (cell, weight) in &seed.displaced {
                gap[*cell] += weight;
            }
        }
        let mut warnings: Vec<String> = seed.warning.iter().cloned().collect();
        if self.margin < MARGIN {
            warnings.push(format!(
                "a cell is about to join or to leave the contact (margin {:.1e}): derivatives differ on both sides",
                self.margin
            ));
        }
        Gradient {
            output: output.clone(),
            value: seed.value,
            values: Vec::new(),
            gap,
            margin: self.margin,
            warnings,
        }
    }

    /// Change of the solution per unit of step along `direction`, a list of paths and rates, and along `gap`, the rate of the
    /// undeformed gap.
    ///
    /// # Errors
    /// [`Error::NotDifferentiable`] for parameters without a derivative; a gap of another shape than the grid's.
    pub fn jvp(
        &self,
        direction: &[(&str, f64)],
        gap: Option<&ArrayRef2<f64>>,
    ) -> Result<Direction> {
        let never = &mut || ControlFlow::Continue(());
        self.jvp_watched(direction, gap, never)?.ok_or(STOPPED)
    }

    /// [`Linearisation::jvp`] that asks `watch` before each iteration whether to go on; `None` where it breaks.
    ///
    /// # Errors
    /// As [`Linearisation::jvp`].
    pub fn jvp_watched(
        &self,
        direction: &[(&str, f64)],
        gap: Option<&ArrayRef2<f64>>,
        watch: &mut Watch,
    ) -> Result<Option<Direction>> {
        let state = &self.state;
        let mut field = vec![0.0; state.pressure.len()];
        let mut target = [0.0; 3];
        let mut prescribed = [0.0; 3];
        let mut add = |slope: &Slope, rate: f64| {
            for (sum, b) in field.iter_mut().zip(&slope.field) {
                *sum += rate * b;
            }
            for (sum, f) in target.iter_mut().zip(slope.target) {
                *sum += rate * f;
            }
        };
        let paths: Vec<&str> = direction.iter().map(|(path, _)| *path).collect();
        let parameters = named(&self.parameters, &paths)?;
        for (parameter, (_, rate)) in parameters.iter().zip(direction) {
            let contact = (self.solution, self.shape);
            let reach = offsets(state.tangent.window(), &[]);
            let Some(slope) = Slope::new(contact, state, parameter, reach, watch)? else {
                return Ok(None);
            };
            add(&slope, *rate);
            match parameter {
                Parameter::Approach => prescribed[0] += rate,
                Parameter::Tilt(axis) => prescribed[axis + 1] += rate,
                _ => {}
            }
        }
        if let Some(gap) = gap {
            let found = [gap.nrows(), gap.ncols()];
            if found != self.solution.grid().shape() {
                return Err(Error::Shape {
                    name: "gap",
                    expected: self.solution.grid().shape(),
                    found,
                });
            }
            // Cells that cannot touch have no gap to change.
            let finite = gap.mapv(|g| if g.is_finite() { g } else { 0.0 });
            add(&Slope::of_gap(state, &finite), 1.0);
        }
        let right: Vec<f64> = state.masked(&field).iter().map(|b| -b).collect();
        let balance = target.map(|f| -f);
        let Some(tangent) = state.saddle(&right, balance, self.tolerance, watch)? else {
            return Ok(None);
        };
        let valid_step = self.valid(&tangent, &field);
        let motion = [0, 1, 2].map(|k| tangent.chi[k] + prescribed[k]);
        Ok(Some(Direction {
            pressure: self.spread(&tangent.psi),
            approach: motion[0],
            tilt: [motion[1], motion[2]],
            valid_step,
        }))
    }

    /// Largest change of the parameter `path`, of either sign, for which the contact stays to first order: no pressure in it,
    /// and no gap up to two cells around it, changes its sign.
    ///
    /// # Errors
    /// [`Error::NotDifferentiable`] for a parameter without a derivative.
    pub fn valid_step(&self, path: &str) -> Result<f64> {
        Ok(self.jvp(&[(path, 1.0)], None)?.valid_step)
    }

    /// Derivatives of Σ `cotangent` p, the product of a cotangent of the pressure with its Jacobian.
    ///
    /// # Errors
    /// A cotangent of another shape than the grid's, and those of [`Linearisation::gradients`].
    pub fn vjp(&self, cotangent: &Array2<f64>, wrt: Option<&[&str]>) -> Result<Gradient> {
        let output = Output::Weighted(cotangent.clone());
        let mut found = self.gradients(&[output], wrt)?;
        found.pop().ok_or(STOPPED)
    }

    /// The largest step along a tangent for which pressures and gaps keep their signs; `field` is b.
    fn valid(&self, tangent: &Saddle, field: &[f64]) -> f64 {
        let state = &self.state;
        let displaced = state.displaced(&tangent.psi);
        let moved = state.moved(tangent.chi);
        let mut least = f64::INFINITY;
        for k in 0..field.len() {
            let (value, rate) = if state.tangent.contact[k] {
                (state.pressure[k], tangent.psi[k])
            } else {
                (state.gap[k], displaced[k] + field[k] - moved[k])
            };
            if rate.is_finite() && rate != 0.0 {
                least = least.min(value.abs() / rate.abs());
            }
        }
        least
    }

    /// An array of the grid with `values` in the window, and 0 outside.
    fn spread(&self, values: &[f64]) -> Array2<f64> {
        let [nx, ny] = self.solution.grid().shape();
        let [x, y] = self.state.tangent.window();
        let mut array = Array2::zeros((nx, ny));
        for (i, row) in x.clone().zip(values.chunks_exact(y.len())) {
            for (j, value) in y.clone().zip(row) {
                array[[i, j]] = *value;
            }
        }
        array
    }
}
