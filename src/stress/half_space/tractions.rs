//! Stress under given tractions, beside that under the pressure.

use std::ops::ControlFlow;

use ndarray::{Array2, ArrayRef2};

use super::coefficients::SurfaceLoad;
use super::plan::{HalfSpacePlan, Source};
use super::plane::PlaneEvaluator;
use super::points::PointEvaluator;
use crate::compliance::response::interior::Place;
use crate::error::Result;
use crate::model::body::HalfSpace;
use crate::model::grid::Grid;
use crate::numerics::parallel::Threads;
use crate::stress::options::StressProgress;

/// Tractions along x and along y, uniform over each cell.
#[derive(Debug)]
pub(in crate::stress) struct Tractions(Vec<(HalfSpacePlan, SurfaceLoad)>);

impl Tractions {
    /// Plans both tractions, times `sign`; those that are 0 need nothing.
    pub(in crate::stress) fn plan(
        body: &HalfSpace,
        grid: &Grid,
        tractions: [&ArrayRef2<f64>; 2],
        sign: f64,
        threads: &Threads,
    ) -> Result<Self> {
        let mut plans = Vec::new();
        for (axis, traction) in tractions.into_iter().enumerate() {
            if traction.iter().any(|q| *q != 0.0) {
                let traction: Array2<f64> = traction.mapv(|q| sign * q);
                let plan = Source::uniform(body, grid, &traction);
                let load = SurfaceLoad {
                    factor: 1.0,
                    axis: Some(axis),
                };
                plans.push((plan.plan_unwatched(Some(threads.count()))?, load));
            }
        }
        Ok(Self(plans))
    }
}

/// The stress of tractions on whole planes.
#[derive(Debug)]
pub(in crate::stress) struct TractionPlanes<'a> {
    evaluators: Vec<PlaneEvaluator<'a>>,
    fields: Vec<Vec<f64>>,
}

impl<'a> TractionPlanes<'a> {
    pub(in crate::stress) fn new(tractions: &'a Tractions, displacement: bool) -> Self {
        let plans = tractions.0.iter();
        let evaluator = |(plan, load): &'a (HalfSpacePlan, SurfaceLoad)| {
            PlaneEvaluator::under(plan, vec![*load], displacement)
        };
        Self {
            evaluators: plans.map(evaluator).collect(),
            fields: Vec::new(),
        }
    }

    /// Adds the components at `place` to `outputs`, planes of the grid's cells.
    pub(in crate::stress) fn add(
        &mut self,
        place: &Place,
        outputs: &mut [&mut [f64]],
        progress: &mut StressProgress,
    ) -> ControlFlow<()> {
        self.fields.resize_with(outputs.len(), Vec::new);
        for evaluator in &mut self.evaluators {
            let mut fields: Vec<&mut [f64]> = Vec::new();
            for (field, output) in self.fields.iter_mut().zip(&*outputs) {
                field.resize(output.len(), 0.0);
                fields.push(field);
            }
            evaluator.evaluate(place, &mut fields, progress)?;
            for (output, field) in outputs.iter_mut().zip(&self.fields) {
                let values = output.iter_mut().zip(field);
                values.for_each(|(output, value)| *output += value);
            }
        }
        ControlFlow::Continue(())
    }
}

/// The stress of tractions in some cells.
#[derive(Debug)]
pub(in crate::stress) struct TractionPoints<'a>(Vec<PointEvaluator<'a>>);

impl<'a> TractionPoints<'a> {
    pub(in crate::stress) fn new(
        tractions: &'a Tractions,
        displacement: bool,
        cells: &[[usize; 2]],
    ) -> Self {
        let evaluator = |(plan, load): &'a (HalfSpacePlan, SurfaceLoad)| {
            PointEvaluator::under(plan, vec![*load], displacement, cells.to_vec())
        };
        Self(tractions.0.iter().map(evaluator).collect())
    }

    /// Adds the components at `place` to those of the cells.
    pub(in crate::stress) fn add<const N: usize>(
        &self,
        place: &Place,
        sums: &mut [[f64; N]],
        progress: &mut StressProgress,
    ) -> ControlFlow<()> {
        for evaluator in &self.0 {
            let found = evaluator.evaluate(place, progress)?;
            for (sums, found) in sums.iter_mut().zip(found) {
                let values = sums.iter_mut().zip(found);
                values.for_each(|(sum, value)| *sum += value);
            }
        }
        ControlFlow::Continue(())
    }
}
