//! The linearisation of a contact: adjoint solves for outputs, tangent solves for directions.

use std::ops::ControlFlow;

use ndarray::{Array2, ArrayRef2};

use super::parameter::{Parameter, Slope, all, named};
use super::seed::{Direction, Gradient, Output, Seed, offsets};
use super::state::{Linearised, Saddle};
use super::stress::StressSeed;
use crate::contact::Solution;
use crate::error::{Error, Result, fraction, same_shape};
use crate::model::surface::Surface;
use crate::numerics::parallel::dot;

/// Margin below which a contact is next to one of other cells: 100 times what is left of the polished residual.
const MARGIN: f64 = 1e-10;

/// How linear systems are solved.
#[derive(Clone, Copy)]
#[non_exhaustive]
pub struct LinearOptions<'a> {
    /// Residual of the linear systems, relative to their right sides. Default: 1e-9.
    pub tolerance: f64,
    /// Asked before each iteration whether to continue; a break ends the work with [`Error::Stopped`]. Default: `None`.
    pub watch: Option<&'a dyn Fn() -> ControlFlow<()>>,
}

impl Default for LinearOptions<'_> {
    fn default() -> Self {
        Self { tolerance: 1e-9, watch: None }
    }
}

impl<'a> LinearOptions<'a> {
    /// This, with another [`tolerance`](field@Self::tolerance).
    #[must_use]
    pub fn with_tolerance(mut self, tolerance: f64) -> Self {
        self.tolerance = tolerance;
        self
    }

    /// This, asking `watch` before each iteration.
    #[must_use]
    pub fn with_watch(mut self, watch: &'a dyn Fn() -> ControlFlow<()>) -> Self {
        self.watch = Some(watch);
        self
    }
}

impl std::fmt::Debug for LinearOptions<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "LinearOptions(tolerance {:e})", self.tolerance)
    }
}

impl LinearOptions<'_> {
    fn go_on(&self) -> Result<()> {
        match self.watch.is_some_and(|watch| watch().is_break()) {
            true => Err(Error::Stopped),
            false => Ok(()),
        }
    }
}

/// A contact linearised at its solution: what all outputs and parameters share.
pub struct Linearisation<'a> {
    pub(super) solution: &'a Solution,
    pub(super) shape: Option<&'a dyn Surface>,
    pub(super) state: Linearised,
    parameters: Vec<Parameter>,
    options: LinearOptions<'a>,
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
        Linearisation::plan(self, shape, &LinearOptions::default())?.gradient(output, None)
    }
}

impl<'a> Linearisation<'a> {
    /// Linearises `solution`. Parameters of the shape need the `shape` that it was solved with.
    ///
    /// # Errors
    /// [`Error::NotDifferentiable`] for a solution without a derivative; too little memory.
    pub fn plan(
        solution: &'a Solution,
        shape: Option<&'a dyn Surface>,
        options: &LinearOptions<'a>,
    ) -> Result<Self> {
        fraction("tolerance", options.tolerance)?;
        let state = Linearised::new(solution, options.watch)?;
        Ok(Self {
            parameters: all(solution, shape),
            margin: state.margin(),
            options: *options,
            solution,
            shape,
            state,
        })
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
        let parameters = match wrt {
            None => self.parameters.clone(),
            Some(paths) => {
                // Only stresses depend on friction, each by itself.
                let slides = outputs.iter().any(|output| matches!(output, Output::Stress(_)));
                let others = paths.iter().filter(|path| !(slides && **path == "friction"));
                named(self.solution, &self.parameters, &others.copied().collect::<Vec<_>>())?
            }
        };
        let mut seeds = Vec::new();
        let mut stresses = Vec::new();
        for output in outputs {
            self.options.go_on()?;
            let (seed, stress) = self.seed(output)?;
            seeds.push(seed);
            stresses.push(stress);
        }
        let adjoint = |seed: &Seed| self.saddle(&seed.pressure, seed.motion);
        let adjoints: Vec<Saddle> = seeds.iter().map(adjoint).collect::<Result<_>>()?;
        let mut gradients: Vec<Gradient> = (outputs.iter().zip(&seeds).zip(&adjoints))
            .map(|((output, seed), adjoint)| self.gradient_of(output, seed, adjoint))
            .collect();
        let cells = seeds.iter().flat_map(|seed| &seed.displaced);
        let cells: Vec<_> = cells.copied().collect();
        for parameter in &parameters {
            let slope = self.slope(parameter, &cells)?;
            let parts = seeds.iter().zip(&adjoints).zip(&stresses);
            for (gradient, ((seed, adjoint), stress)) in gradients.iter_mut().zip(parts) {
                let mut value = self.derivative(seed, adjoint, &slope, parameter);
                if let Some(stress) = stress {
                    self.options.go_on()?;
                    value += stress.direct(self.solution, parameter)?;
                }
                gradient.values.push((parameter.clone(), value));
            }
        }
        for (gradient, stress) in gradients.iter_mut().zip(&stresses) {
            if let Some(stress) = stress
                && stress.slides(self.solution)
                && wrt.is_none_or(|paths| paths.contains(&"friction"))
            {
                let value = stress.direct(self.solution, &Parameter::Friction)?;
                gradient.values.push((Parameter::Friction, value));
            }
        }
        Ok(gradients)
    }

    /// [`Linearisation::gradients`] of one output.
    ///
    /// # Errors
    /// As [`Linearisation::gradients`].
    pub fn gradient(&self, output: &Output, wrt: Option<&[&str]>) -> Result<Gradient> {
        let mut gradients = self.gradients(std::slice::from_ref(output), wrt)?;
        Ok(gradients.remove(0))
    }

    fn saddle(&self, right: &[f64], balance: [f64; 3]) -> Result<Saddle> {
        let LinearOptions { tolerance, watch } = self.options;
        self.state.saddle(right, balance, tolerance, watch)
    }

    /// How the equations depend on `parameter`, also at `cells` outside of the window.
    fn slope(&self, parameter: &Parameter, cells: &[([usize; 2], f64)]) -> Result<Slope> {
        self.options.go_on()?;
        let reach = offsets(&self.state.tangent.window, cells);
        Slope::new(self.solution, self.shape, &self.state, parameter, reach)
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
            Parameter::Tilt(axis) => seed.prescribed[axis.index() + 1],
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
        let parameters = named(self.solution, &self.parameters, &paths)?;
        for (parameter, (_, rate)) in parameters.iter().zip(direction) {
            let slope = self.slope(parameter, &[])?;
            add(&slope, *rate);
            match parameter {
                Parameter::Approach => prescribed[0] += rate,
                Parameter::Tilt(axis) => prescribed[axis.index() + 1] += rate,
                _ => {}
            }
        }
        if let Some(gap) = gap {
            same_shape("gap", gap, self.solution.grid().shape())?;
            // Cells that cannot touch have no gap to change.
            let finite = gap.mapv(|g| if g.is_finite() { g } else { 0.0 });
            add(&Slope::of_gap(state, finite), 1.0);
        }
        let right: Vec<f64> = state.masked(&field).iter().map(|b| -b).collect();
        let balance = target.map(|f| -f);
        let tangent = self.saddle(&right, balance)?;
        let valid_step = self.valid(&tangent, &field);
        let motion = [0, 1, 2].map(|k| tangent.chi[k] + prescribed[k]);
        Ok(Direction {
            pressure: self.spread(&tangent.psi),
            approach: motion[0],
            tilt: [motion[1], motion[2]],
            valid_step,
        })
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
        self.gradient(&Output::Weighted(cotangent.clone()), wrt)
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
        let [x, y] = &self.state.tangent.window;
        let mut array = Array2::zeros((nx, ny));
        for (i, row) in x.clone().zip(values.chunks_exact(y.len())) {
            for (j, value) in y.clone().zip(row) {
                array[[i, j]] = *value;
            }
        }
        array
    }
}
