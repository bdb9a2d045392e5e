//! One evaluation at some depths: its arguments, checked before any work, and its result.

use std::ops::ControlFlow;

use ndarray::{Array1, Array2, Array3};

use super::field::Stress;
use super::friction::Sliding;
use super::half_space::{PlaneEvaluator, Source, components};
use super::options::{StressOptions, StressProgress};
use super::plan::{PlaneStress, PointStress, StressPlan};
use super::section::{Points, place};
use super::subcell::STRESSES;
use crate::compliance::response::interior::Place;
use crate::error::{Error, Result};
use crate::model::body::HalfSpace;
use crate::model::grid::Grid;
use crate::numerics::parallel::check_memory;

/// Weights of the components σ_xx … σ_xz in each cell, in C order.
pub(crate) type Weights = [Vec<f64>; STRESSES];

impl StressPlan {
    /// Stress at `depths`.
    ///
    /// # Errors
    /// Bad depths or options, or too little memory for the result.
    pub fn stress(&self, depths: &[f64], options: &StressOptions) -> Result<Stress> {
        let mut progress = |_| ControlFlow::Continue(());
        self.stress_watched(depths, options, &mut progress)
    }

    /// [`StressPlan::stress`] with a callback: `progress` is told the fraction done. When it breaks, the
    /// result holds the depths finished so far.
    ///
    /// # Errors
    /// As [`StressPlan::stress`].
    pub fn stress_watched(
        &self,
        depths: &[f64],
        options: &StressOptions,
        progress: &mut StressProgress,
    ) -> Result<Stress> {
        let (body, grid) = (&self.whole.body, &self.whole.grid);
        let request = Request::checked(body, grid, &self.whole.sliding, depths, options)?;
        check_memory(grid.shape(), request.memory())?;
        Ok(request.evaluate(self, progress))
    }

    /// Σ_c Σ_k K_c[k − i] w_c[k] in the cells i that the plan's pressure loads: the derivative with respect to the pressure
    /// of each cell of Σ w σ at depth `z`, of which [`StressPlan::stress`] gives σ. Other cells hold no meaning.
    ///
    /// A kernel is even or odd along x and y, so that its transpose is itself with a sign for each odd direction.
    ///
    /// # Errors
    /// As [`StressPlan::stress`]; a body with free ends, whose stress is no convolution.
    pub(crate) fn transposed(
        &self,
        z: f64,
        weights: &Weights,
        options: &StressOptions,
    ) -> Result<Array2<f64>> {
        if self.has_ends() || self.whole.solved.is_some() {
            return Err(Error::Inconsistent(
                "derivatives of stresses need a body without free ends, under a pressure that is uniform over cells",
            ));
        }
        let place = place(&self.whole.body, z, options.side)?;
        let friction = self.whole.sliding.traction(&self.whole.body, options)?;
        let mut evaluator = PlaneEvaluator::new(&self.whole, friction, false);
        let mut sums = Array2::zeros(self.whole.grid.shape());
        evaluator.transposed(&place, weights, &mut sums);
        Ok(sums)
    }
}

/// Stress at `depths` by a plan that is made for this call. Bad options are refused before planning.
pub(super) fn stress_once(
    source: &Source,
    depths: &[f64],
    options: &StressOptions,
    progress: &mut StressProgress,
) -> Result<Stress> {
    let (body, grid) = (source.body, source.grid);
    let request = Request::checked(body, grid, &source.sliding, depths, options)?;
    check_memory(grid.shape(), request.memory() + source.memory())?;
    Ok(match source.complete(options.threads, progress)? {
        Some(plan) => request.evaluate(&plan, progress),
        // Stopped while planning: no depth is done.
        None => request.result(zeros(request.components(), 0), 0, None),
    })
}

/// Arguments of one evaluation, checked.
struct Request<'a> {
    body: &'a HalfSpace,
    grid: &'a Grid,
    depths: &'a [f64],
    options: &'a StressOptions,
    places: Vec<Place>,
    points: Points,
    /// Residual stress of each layer and of the substrate.
    residual: Vec<f64>,
    /// μ times the unit vector of the traction on the body.
    friction: [f64; 2],
}

impl<'a> Request<'a> {
    fn checked(
        body: &'a HalfSpace,
        grid: &'a Grid,
        sliding: &Sliding,
        depths: &'a [f64],
        options: &'a StressOptions,
    ) -> Result<Self> {
        let places = depths.iter().map(|&z| place(body, z, options.side));
        Ok(Self {
            body,
            grid,
            depths,
            options,
            places: places.collect::<Result<_>>()?,
            points: Points::new(body, grid, options.section)?,
            residual: options.residual_by_layer(body)?,
            friction: sliding.traction(body, options)?,
        })
    }

    fn components(&self) -> usize {
        components(self.options.displacement)
    }

    /// Bytes that the evaluation and its result take.
    fn memory(&self) -> u64 {
        let result = 8 * self.places.len() * self.points.count() * self.components();
        if self.is_point() {
            return result as u64 + PointStress::memory(self.grid);
        }
        let slides = self.options.friction != 0.0;
        result as u64 + PlaneStress::memory(self.grid, slides, self.options.displacement)
    }

    /// Whether a plane has a single point, which is interpolated from cells.
    fn is_point(&self) -> bool {
        self.points.count() == 1 && self.points.face().is_none()
    }

    fn evaluate(&self, plan: &StressPlan, progress: &mut StressProgress) -> Stress {
        let mut fields = zeros(self.components(), self.places.len() * self.points.count());
        if self.points.are_beyond {
            fields.iter_mut().for_each(|field| field.fill(f64::NAN));
            let unknown = Array1::from_elem(self.places.len(), f64::NAN);
            return self.result(fields, self.places.len(), Some(unknown));
        }
        let done = self.fill(plan, &mut fields, progress);
        let window = self.points.window();
        let uncertainty = plan.uncertainties(&self.places[..done], self.friction, &window);
        self.result(fields, done, uncertainty)
    }

    /// Evaluates one place after another into `fields`; returns how many were finished.
    fn fill(
        &self,
        plan: &StressPlan,
        fields: &mut [Vec<f64>],
        progress: &mut StressProgress,
    ) -> usize {
        let count = self.points.count();
        if self.is_point() {
            return self.fill_point(plan, fields, progress);
        }
        // Whole planes are evaluated in place, lines by way of a plane.
        let mut planes = match self.points.are_all_cells() {
            true => Vec::new(),
            false => zeros(fields.len(), self.points.of_plane()),
        };
        let mut evaluator = PlaneStress::new(plan, self.friction, self.options.displacement);
        for (done, place) in self.places.iter().enumerate() {
            let total = self.places.len() as f64;
            let mut progress = |part: f64| progress((done as f64 + part) / total);
            let mut here: Vec<&mut [f64]> = fields
                .iter_mut()
                .map(|field| &mut field[done * count..(done + 1) * count])
                .collect();
            let flow = if planes.is_empty() {
                evaluator.evaluate(place, &mut here, &mut progress)
            } else {
                self.fill_planes(&mut evaluator, place, &mut planes, &mut progress)
            };
            if flow.is_break() {
                return done;
            }
            for (plane, here) in planes.iter().zip(&mut here) {
                self.points.interpolate(plane, here);
            }
            self.add_residual(place, &mut here);
        }
        // All is done: a break has nothing left to stop.
        let _ = progress(1.0);
        self.places.len()
    }

    /// Evaluates what points at `place` are interpolated from: the cells of planes and, behind them, a face.
    fn fill_planes(
        &self,
        evaluator: &mut PlaneStress,
        place: &Place,
        planes: &mut [Vec<f64>],
        progress: &mut StressProgress,
    ) -> ControlFlow<()> {
        let [nx, ny] = self.grid.shape();
        if !self.points.are_on_face() {
            let outputs = planes.iter_mut().map(|plane| &mut plane[..nx * ny]);
            evaluator.evaluate(place, &mut outputs.collect::<Vec<_>>(), progress)?;
        }
        if let Some((end, row)) = self.points.face() {
            let lines = evaluator.on_face(place, (end, row), progress)?;
            for (plane, line) in planes.iter_mut().zip(lines) {
                plane[(nx + end) * ny..][..ny].copy_from_slice(&line);
            }
        }
        ControlFlow::Continue(())
    }

    /// [`Request::fill`] where a plane has a single point, which needs no other cells than those that it
    /// is interpolated from.
    fn fill_point(
        &self,
        plan: &StressPlan,
        fields: &mut [Vec<f64>],
        progress: &mut StressProgress,
    ) -> usize {
        let (cells, weights): (Vec<_>, Vec<_>) = self.points.weighted_cells().into_iter().unzip();
        let evaluator = PointStress::new(plan, self.friction, self.options.displacement, cells);
        for (done, place) in self.places.iter().enumerate() {
            let total = self.places.len() as f64;
            let mut progress = |part: f64| progress((done as f64 + part) / total);
            let ControlFlow::Continue(found) = evaluator.evaluate(place, &mut progress) else {
                return done;
            };
            for (k, field) in fields.iter_mut().enumerate() {
                let parts = found.iter().zip(&weights);
                field[done] = parts
                    .map(|(components, weight)| weight * components[k])
                    .sum();
            }
            let mut here: Vec<&mut [f64]> = fields
                .iter_mut()
                .map(|field| &mut field[done..=done])
                .collect();
            self.add_residual(place, &mut here);
        }
        let _ = progress(1.0);
        self.places.len()
    }

    /// Adds the residual stress of the layer at `place`.
    fn add_residual(&self, place: &Place, here: &mut [&mut [f64]]) {
        let residual = self.residual[place.layer];
        if residual != 0.0 {
            for in_plane in &mut here[..2] {
                in_plane.iter_mut().for_each(|s| *s += residual);
            }
        }
    }

    /// The result of the first `done` places.
    fn result(
        &self,
        fields: Vec<Vec<f64>>,
        done: usize,
        uncertainty: Option<Array1<f64>>,
    ) -> Stress {
        let [ox, oy] = self.points.shape;
        let mut arrays = fields.into_iter().map(|mut values| {
            values.truncate(done * self.points.count());
            Array3::from_shape_vec((done, ox, oy), values).unwrap_or_default()
        });
        let mut next = || arrays.next().unwrap_or_default();
        Stress {
            z: self.depths[..done].to_vec().into(),
            x: self.points.x.clone(),
            y: self.points.y.clone(),
            body: self.body.clone(),
            side: self.options.side,
            friction: self.friction,
            components: std::array::from_fn(|_| next()),
            uncertainty,
            displacement: self
                .options
                .displacement
                .then(|| std::array::from_fn(|_| next())),
        }
    }
}

/// `fields` arrays of zeros. Each is allocated by itself: a copy would touch its memory here, on one
/// thread.
fn zeros(fields: usize, length: usize) -> Vec<Vec<f64>> {
    (0..fields).map(|_| vec![0.0; length]).collect()
}
