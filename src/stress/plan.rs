//! The plan of a stress field: the body that goes on, and what its free ends add.

use std::ops::ControlFlow;

use ndarray::{Array1, ArrayRef2};

use super::ends::{EndPlanes, EndPoints, EndStress};
use super::half_space::{
    HalfSpacePlan, PlaneEvaluator, PointEvaluator, Source, SurfaceLoad, TractionPlanes,
    TractionPoints, Tractions,
};
use super::options::StressProgress;
use super::section::Span;
use crate::compliance::kernel::COMPONENTS;
use crate::compliance::response::interior::Place;
use crate::error::{Error, Result};
use crate::model::body::HalfSpace;
use crate::model::grid::{Grid, Window};

/// Stress below a pressure, planned once and evaluated any number of times.
///
/// A plan owns all costly parts that do not depend on depths or options: the pressure within cells, the
/// spectrum of the layered body and the transforms of the loads. Kernels of traction are planned at the
/// first evaluation with friction. Results have the same bits as those of
/// [`Solution::stress`](crate::Solution::stress) and [`stress`](crate::stress()), which plan for one
/// call. Threads can share a plan.
///
/// ```
/// use nacre::{Elastic, Member, Motion, Section, Sphere, StressOptions, solve};
/// let steel = Elastic::new(210e9, 0.3)?;
/// let solution = solve(&Sphere::new(5e-3)?, &steel, &Motion::load(10.0))?;
/// let plan = solution.stress_plan(Member::Body, None)?;
/// let axis = StressOptions { section: Section::Axis([0.0, 0.0]), ..StressOptions::default() };
/// let sliding = StressOptions { friction: 0.3, direction: Some([1.0, 0.0]), ..StressOptions::default() };
/// let below = plan.stress(&[1e-5, 2e-5, 4e-5], &axis)?;
/// let surface = plan.stress(&[0.0], &sliding)?;
/// assert!(below.zz().iter().all(|zz| *zz < 0.0));
/// assert_eq!(surface, solution.stress(&[0.0], Member::Body, &sliding)?);
/// # Ok::<(), nacre::Error>(())
/// ```
#[derive(Debug)]
pub struct StressPlan {
    pub(super) whole: HalfSpacePlan,
    /// The rows of the grid that the body has.
    span: Span,
    /// Present where the body has free ends, and bears pressure.
    ends: Option<EndStress>,
    /// Present where tractions are known.
    tractions: Option<Tractions>,
}

impl Source<'_> {
    /// The plan with the ends of the body; none where `progress` stops it.
    pub(super) fn complete(
        &self,
        threads: Option<usize>,
        progress: &mut StressProgress,
    ) -> Result<Option<StressPlan>> {
        self.check_ends()?;
        let Some(whole) = self.plan(threads, progress)? else {
            return Ok(None);
        };
        let span = Span::of(self.body, self.grid);
        let ControlFlow::Continue(ends) = EndStress::plan(&whole, &span, progress)? else {
            return Ok(None);
        };
        let (sign, count) = (self.sliding.sign, &whole.threads);
        let planned = |tractions| Tractions::plan(self.body, self.grid, tractions, sign, count);
        let tractions = self.tractions.map(planned).transpose()?;
        Ok(Some(StressPlan {
            whole,
            span,
            ends,
            tractions,
        }))
    }

    /// [`Source::complete`] without a callback.
    pub(super) fn complete_unwatched(&self, threads: Option<usize>) -> Result<StressPlan> {
        let mut progress = |_| ControlFlow::Continue(());
        let stopped = Error::Inconsistent("the stress plan was stopped before it was complete");
        self.complete(threads, &mut progress)?.ok_or(stopped)
    }
}

impl StressPlan {
    /// A plan for `body` under `pressure` (nx, ny) \[Pa\] on `grid`, uniform over each cell. Beyond the free ends of the
    /// body, stresses are NaN. The plan works on `threads` threads; none: all of the machine's.
    ///
    /// [`Solution::stress_plan`](crate::Solution::stress_plan) makes that of a solved contact.
    ///
    /// # Errors
    /// A pressure of another shape than the grid's, not finite, or beyond a free end; free ends on a line or periodic
    /// grid; no threads; too little memory.
    pub fn plan(
        body: &HalfSpace,
        grid: &Grid,
        pressure: &ArrayRef2<f64>,
        threads: Option<usize>,
    ) -> Result<Self> {
        Source::uniform(body, grid, pressure).complete_unwatched(threads)
    }

    /// Estimated errors \[Pa\] of the stress at `places` in the cells of `window`: from the size of the cells, and of
    /// what free ends add. None where neither is known.
    pub(super) fn uncertainties(
        &self,
        places: &[Place],
        friction: [f64; 2],
        window: &Window,
    ) -> Option<Array1<f64>> {
        let cells = self.whole.uncertainties(places, friction, window);
        let Some(ends) = &self.ends else {
            return cells;
        };
        let ends = places.iter().map(|place| ends.uncertainty(place.depth));
        let ends: Array1<f64> = ends.collect();
        Some(cells.map_or(ends.clone(), |cells| cells + &ends))
    }

    /// Whether the body has free ends whose stress is added.
    pub(super) fn has_ends(&self) -> bool {
        self.ends.is_some()
    }

    /// The body.
    pub fn body(&self) -> &HalfSpace {
        &self.whole.body
    }
}

/// A plan under one friction, on whole planes, with the memory that all planes use.
#[derive(Debug)]
pub(super) struct PlaneStress<'a> {
    plan: &'a StressPlan,
    friction: [f64; 2],
    displacement: bool,
    whole: PlaneEvaluator<'a>,
    ends: Option<EndPlanes<'a>>,
    tractions: Option<TractionPlanes<'a>>,
}

impl<'a> PlaneStress<'a> {
    pub(super) fn new(plan: &'a StressPlan, friction: [f64; 2], displacement: bool) -> Self {
        let (ends, tractions) = (plan.ends.as_ref(), plan.tractions.as_ref());
        Self {
            plan,
            friction,
            displacement,
            whole: PlaneEvaluator::new(&plan.whole, friction, displacement),
            ends: ends.map(|ends| EndPlanes::new(ends, displacement)),
            tractions: tractions.map(|tractions| TractionPlanes::new(tractions, displacement)),
        }
    }

    /// Bytes that it takes.
    pub(super) fn memory(grid: &Grid, slides: bool, displacement: bool) -> u64 {
        PlaneEvaluator::memory(grid, slides, displacement)
    }

    /// Writes the components at `place` to `outputs`, whole planes of (nx, ny) cells. `progress` is told
    /// the fraction of this plane that is done; where it breaks, `outputs` are incomplete.
    pub(super) fn evaluate(
        &mut self,
        place: &Place,
        outputs: &mut [&mut [f64]],
        progress: &mut StressProgress,
    ) -> ControlFlow<()> {
        self.whole.evaluate(place, outputs, progress)?;
        if let Some(ends) = &mut self.ends {
            ends.add(place, outputs, progress)?;
        }
        if let Some(tractions) = &mut self.tractions {
            tractions.add(place, outputs, progress)?;
        }
        let span = &self.plan.span;
        outputs.iter_mut().for_each(|output| span.blank(output));
        ControlFlow::Continue(())
    }

    /// The components at `place` on the face of an end that lies between the rows `row` − 1 and `row`, for each of them
    /// along y. The pressure is uniform over cells there; tractions are known for bodies that go on alone.
    pub(super) fn on_face(
        &self,
        place: &Place,
        (end, row): (usize, usize),
        progress: &mut StressProgress,
    ) -> ControlFlow<(), Vec<Vec<f64>>> {
        let (plan, displacement) = (self.plan, self.displacement);
        let loads = SurfaceLoad::all(self.friction);
        let at = (place, row);
        let mut lines = PlaneEvaluator::between(&plan.whole, loads, displacement, at, progress)?;
        if let Some(ends) = &plan.ends {
            ends.add_on_face(place, (end, row), displacement, &mut lines, progress)?;
        }
        ControlFlow::Continue(lines)
    }
}

/// A plan under one friction, in some cells.
#[derive(Debug)]
pub(super) struct PointStress<'a> {
    span: &'a Span,
    cells: Vec<[usize; 2]>,
    whole: PointEvaluator<'a>,
    ends: Option<EndPoints<'a>>,
    tractions: Option<TractionPoints<'a>>,
}

impl<'a> PointStress<'a> {
    pub(super) fn new(
        plan: &'a StressPlan,
        friction: [f64; 2],
        displacement: bool,
        cells: Vec<[usize; 2]>,
    ) -> Self {
        let (ends, tractions) = (plan.ends.as_ref(), plan.tractions.as_ref());
        Self {
            ends: ends.map(|ends| EndPoints::new(ends, displacement, &cells)),
            tractions: tractions
                .map(|tractions| TractionPoints::new(tractions, displacement, &cells)),
            whole: PointEvaluator::new(&plan.whole, friction, displacement, cells.clone()),
            span: &plan.span,
            cells,
        }
    }

    /// Bytes that it takes.
    pub(super) fn memory(grid: &Grid) -> u64 {
        PointEvaluator::memory(grid)
    }

    /// Components at `place` in each of the cells; with displacements, nine. `progress` is told 0.
    pub(super) fn evaluate(
        &self,
        place: &Place,
        progress: &mut StressProgress,
    ) -> ControlFlow<(), Vec<[f64; COMPONENTS]>> {
        let mut sums = self.whole.evaluate(place, progress)?;
        if let Some(ends) = &self.ends {
            ends.add(place, &mut sums, progress)?;
        }
        if let Some(tractions) = &self.tractions {
            tractions.add(place, &mut sums, progress)?;
        }
        for (sums, [i, _]) in sums.iter_mut().zip(&self.cells) {
            if !self.span.rows.contains(i) {
                *sums = [f64::NAN; COMPONENTS];
            }
        }
        ControlFlow::Continue(sums)
    }
}
