//! A plan of stress, and its evaluation at some depths.

use std::ops::ControlFlow;

use ndarray::{Array1, Array2, Array3, ArrayRef2};

use super::ends::{EndErrors, EndStress};
use super::field::Stress;
use super::half_space::{
    HalfSpacePart, HalfSpacePlan, Loading, Part, PlaneMemory, SurfaceLoad, checked_pressure,
    components, plane_arrays,
};
use super::options::{SlidingSense, StressOptions, StressProgress, WatchedStress};
use super::section::{Points, Span, place};
use super::subcell::{
    BodyPair, ByComponent, COMPONENTS_APART, CellPoint, EdgeFit, ErrorOf, LocalSteps, PointStress,
    STRESSES, StepErrors, SubcellStress, Tractions,
};
use crate::compliance::kernel::COMPONENTS;
use crate::compliance::response::interior::Place;
use crate::error::{Error, Result};
use crate::model::body::HalfSpace;
use crate::model::grid::{Grid, Window, full_window};
use crate::numerics::parallel::{Threads, check_memory, memory_of};
use crate::numerics::rounding;

/// Weights of the components σ_xx … σ_xz in each cell, in C order.
pub(crate) type Weights = [Vec<f64>; STRESSES];

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
/// let plan = solution.stress_plan(Member::Body, &StressOptions::default())?;
/// let axis = StressOptions::default().with_section(Section::Axis([0.0, 0.0]));
/// let sliding = StressOptions::default().with_friction(0.3).with_direction([1.0, 0.0]);
/// let below = plan.stress(&[1e-5, 2e-5, 4e-5], &axis)?;
/// let surface = plan.stress(&[0.0], &sliding)?;
/// assert!(below.zz().iter().all(|zz| *zz < 0.0));
/// assert_eq!(surface, solution.stress(&[0.0], Member::Body, &sliding)?);
/// # Ok::<(), nacre::Error>(())
/// ```
#[derive(Debug)]
pub struct StressPlan {
    pub(super) whole: HalfSpacePlan,
    pub(super) sliding: SlidingSense,
    /// The rows of the grid that the body has.
    span: Span,
    /// What adds to the stress of the whole half-space: ends of the body, tractions that are known.
    parts: Vec<Box<dyn Part>>,
    /// Known tractions along x and y on this body \[Pa\], in C order.
    pub(super) known: Option<[Vec<f64>; 2]>,
    /// Errors of what free ends add.
    ends: EndErrors,
}

/// The pressure that a plan is made for, and the body below it.
pub(super) struct PressureSource<'a> {
    pub(super) body: &'a HalfSpace,
    pub(super) grid: &'a Grid,
    pub(super) pressure: &'a ArrayRef2<f64>,
    /// The bodies of the contact that the pressure is of, which is then reconstructed within cells; none: it is uniform
    /// over each.
    pub(super) solved: Option<BodyPair<'a>>,
    pub(super) sliding: SlidingSense,
    /// Tractions along x and y on the body itself, where they are known.
    pub(super) tractions: Option<[&'a ArrayRef2<f64>; 2]>,
}

impl<'a> PressureSource<'a> {
    /// A pressure that is uniform over each cell, and whose shape is not known.
    pub(super) fn uniform(
        body: &'a HalfSpace,
        grid: &'a Grid,
        pressure: &'a ArrayRef2<f64>,
    ) -> Self {
        Self {
            body,
            grid,
            pressure,
            solved: None,
            sliding: SlidingSense {
                sign: 1.0,
                direction: grid.rolling_direction(),
                is_known: false,
            },
            tractions: None,
        }
    }

    /// Bytes that planning takes.
    fn memory(&self) -> u64 {
        HalfSpacePlan::memory(self.grid, self.solved.is_some())
    }

    /// The plan; none where `progress` stops it. `progress` is asked, with 0, while the pressure is
    /// reconstructed within cells, and while ends are planned; the rest is quick.
    pub(super) fn plan(
        &self,
        threads: Option<usize>,
        progress: &mut StressProgress,
    ) -> Result<Option<StressPlan>> {
        let Self { body, grid, .. } = *self;
        self.check_ends()?;
        let pressure = checked_pressure(body, grid, self.pressure)?;
        check_memory(grid.shape(), self.memory())?;
        let threads = Threads::new(threads)?;
        let known = self.tractions.map(|both| both.map(|q| q.mapv(|q| self.sliding.sign * q)));
        let by_cell =
            known.as_ref().map(|both| both.each_ref().map(|q| q.iter().copied().collect()));
        let loads = (&pressure[..], by_cell.as_ref());
        let within = |pair| SubcellStress::plan((body, pair), grid, loads, &threads, progress);
        let subcell = match self.solved.as_ref().map(within) {
            Some(ControlFlow::Break(())) => return Ok(None),
            Some(ControlFlow::Continue(subcell)) => Some(subcell),
            None => None,
        };
        let whole = HalfSpacePlan::new(
            body,
            (grid, &full_window(grid.shape())),
            pressure,
            subcell,
            threads,
        );
        let span = Span::of(body, grid);
        let Some(EndStress { mut parts, errors }) = EndStress::plan(&whole, &span, progress)?
        else {
            return Ok(None);
        };
        for (axis, traction) in known.iter().flatten().enumerate() {
            if traction.iter().any(|q| *q != 0.0) {
                let plan = HalfSpacePlan::uniform(
                    body,
                    (grid, &full_window(grid.shape())),
                    traction,
                    &whole.threads,
                )?;
                let load = SurfaceLoad { factor: 1.0, axis: Some(axis) };
                parts.push(Box::new(HalfSpacePart::new(plan, load)));
            }
        }
        Ok(Some(StressPlan {
            whole,
            sliding: self.sliding,
            span,
            parts,
            known: by_cell,
            ends: errors,
        }))
    }

    /// [`PressureSource::plan`], of which a stop is an error.
    pub(super) fn planned(&self, mut watched_options: WatchedStress) -> Result<StressPlan> {
        let threads = watched_options.options().threads;
        let plan = self.plan(threads, &mut |fraction| watched_options.tell(fraction))?;
        plan.ok_or(Error::Stopped)
    }

    /// What `evaluate`, which takes so many bytes, makes of a plan for this call; none where planning is stopped.
    pub(super) fn once<T>(
        &self,
        mut watched_options: WatchedStress,
        memory: u64,
        evaluate: impl FnOnce(&StressPlan, &mut StressProgress) -> T,
    ) -> Result<Option<T>> {
        check_memory(self.grid.shape(), memory + self.memory())?;
        let threads = watched_options.options().threads;
        let mut progress = |fraction| watched_options.tell(fraction);
        let plan = self.plan(threads, &mut progress)?;
        Ok(plan.map(|plan| evaluate(&plan, &mut progress)))
    }

    /// Refuses what stresses near free ends are not known for, and a pressure beyond an end.
    fn check_ends(&self) -> Result<()> {
        if self.body.ends() == [None; 2] {
            return Ok(());
        }
        if self.grid.is_line() || self.grid.is_periodic() != [false; 2] {
            return Err(Error::Inconsistent(
                "stresses of a body with free ends need a grid that has cells along x and is not periodic",
            ));
        }
        let Span { rows, .. } = Span::of(self.body, self.grid);
        let lines = self.pressure.rows().into_iter().enumerate();
        for (_, pressure) in lines.filter(|(i, _)| !rows.contains(i)) {
            if pressure.iter().any(|p| *p != 0.0) {
                return Err(Error::Inconsistent(
                    "pressure must be 0 beyond the free ends of the body",
                ));
            }
        }
        Ok(())
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
        let options = StressOptions::default().with_threads(threads);
        PressureSource::uniform(body, grid, pressure).planned((&options).into())
    }

    /// Stress at `depths`. A callback of [`StressOptions::watched`] is told the fraction done; when it breaks, the
    /// result holds the depths finished so far.
    ///
    /// # Errors
    /// Bad depths or options, or too little memory for the result.
    pub fn stress<'a>(
        &self,
        depths: &[f64],
        options: impl Into<WatchedStress<'a>>,
    ) -> Result<Stress> {
        let mut watched_options = options.into();
        let (body, grid) = (&self.whole.body, &self.whole.grid);
        let request =
            Request::checked(body, grid, &self.sliding, depths, watched_options.options())?;
        check_memory(grid.shape(), request.memory())?;
        Ok(request.evaluate(self, &mut |fraction| watched_options.tell(fraction)))
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
        if self.ends.any_counted() || self.whole.solved.is_some() {
            return Err(Error::Inconsistent(
                "derivatives of stresses need a body without free ends, under a pressure that is uniform over cells",
            ));
        }
        let place = place(&self.whole.body, z, options.side)?;
        let friction = self.sliding.traction(&self.whole.body, options)?;
        let loading = Loading::new(friction, false);
        Ok(self.whole.transposed(&loading, &place, weights))
    }

    /// Estimated errors \[Pa\] of the stress at `places` in the cells of `window`: from the size of the cells, and of
    /// what free ends add. None where neither is known. Known tractions are uniform over cells unless they are taken
    /// `within` them.
    pub(super) fn uncertainties(
        &self,
        places: &[Place],
        friction: [f64; 2],
        window: &Window,
        within: bool,
    ) -> Option<Array1<f64>> {
        let steps = self.whole.steps(window);
        let errors = |place| Some(self.errors(place, friction, within)?.at(&steps, ErrorOf::Any));
        places.iter().map(errors).collect()
    }

    /// Estimated errors of the stress at `place` by the steps of the pressure, of which [`StressPlan::steps_by_cell`] has those
    /// of each cell; see [`StressPlan::uncertainties`].
    pub(super) fn errors(
        &self,
        place: &Place,
        friction: [f64; 2],
        within: bool,
    ) -> Option<StepErrors> {
        let errors = self.whole.errors(place, (self.largest_friction(friction), within));
        match self.ends.at(place) {
            None => errors,
            Some(of_ends) => Some(errors.unwrap_or_default().plus([of_ends; COMPONENTS_APART])),
        }
    }

    /// Errors of extremes at `place` due to the width of the contact in cells.
    pub(super) fn width_errors(&self, place: &Place, friction: [f64; 2]) -> ByComponent {
        self.whole.width_errors(place, self.largest_friction(friction))
    }

    /// The largest ratios of known tractions to the pressure, or this friction where they are in proportion to it.
    fn largest_friction(&self, friction: [f64; 2]) -> [f64; 2] {
        self.known.as_ref().map_or(friction, |known| self.largest_ratios(known))
    }

    /// Estimated errors of extremes at `place`, with what lies between the centres of cells and the width of `contact`: in cells
    /// that feel no edges but those whose larger values are found at `points`, and in all others.
    pub(super) fn errors_of_extremes(
        &self,
        place: &Place,
        friction: [f64; 2],
        (points, contact): (bool, &Self),
    ) -> Option<[StepErrors; 2]> {
        let errors =
            self.errors(place, friction, false)?.plus(contact.width_errors(place, friction));
        let is_shallow = self.is_within_a_cell(place);
        let elsewhere = if is_shallow { errors.without_points() } else { errors };
        Some([if points { errors.beside_points() } else { elsewhere }, elsewhere])
    }

    /// Largest errors of extremes at `place` where values between the centres of cells near an edge are not looked at.
    pub(super) fn errors_between(&self, place: &Place, friction: [f64; 2]) -> Option<StepErrors> {
        Some(self.errors(place, friction, false)?.without_points())
    }

    /// Whether a place is less than a cell deep.
    pub(super) fn is_within_a_cell(&self, place: &Place) -> bool {
        let grid = &self.whole.grid;
        let [dx, dy] = grid.spacing();
        place.depth < if grid.is_line() { dy } else { dx.max(dy) }
    }

    /// Whether each cell feels a stretch of a located edge that has none of these `points`.
    pub(super) fn feels_lost_edge(&self, points: &[CellPoint]) -> Vec<bool> {
        let solved = self.whole.solved.as_ref();
        solved.map_or_else(Vec::new, |solved| solved.subcell.feels_lost_edge(points))
    }

    /// Estimated errors \[Pa\] of the extremes of a section at `depths`, where points of the edge are evaluated, too: those that
    /// [`StressPlan::summary`] counts. 0 where they are not known.
    ///
    /// # Errors
    /// Bad depths or options.
    pub fn extreme_errors(&self, depths: &[f64], options: &StressOptions) -> Result<Vec<f64>> {
        let (body, grid) = (&self.whole.body, &self.whole.grid);
        let friction = self.sliding.traction(body, options)?;
        let window = Points::new(body, grid, options.section)?.window();
        let (points, steps, [_, ny]) =
            (self.edge_points_on_body(), self.whole.steps(&window), grid.shape());
        let lost = self.feels_lost_edge(&points);
        let is_lost = window[0]
            .clone()
            .any(|i| window[1].clone().any(|j| lost.get(i * ny + j).copied().unwrap_or_default()));
        let error = |depth: &f64| {
            let place = place(body, *depth, options.side)?;
            let points = place.layer == 0 && !points.is_empty();
            let errors = self.errors_of_extremes(&place, friction, (points, self));
            Ok(errors.map_or(0.0, |errors| errors[usize::from(is_lost)].at(&steps, ErrorOf::Any)))
        };
        depths.iter().map(error).collect()
    }

    /// Largest steps of the pressure that are felt in each cell; no cells where the pressure is given as uniform over them.
    pub(super) fn steps_by_cell(&self) -> Vec<LocalSteps> {
        self.whole.steps_by_cell()
    }

    /// Largest ratios of known tractions along x and along y to the pressure: the coefficient of friction where cells slip.
    fn largest_ratios(&self, known: &[Vec<f64>; 2]) -> [f64; 2] {
        known.each_ref().map(|tractions| {
            let loaded = tractions.iter().zip(&self.whole.pressure).filter(|(_, p)| **p > 0.0);
            loaded.map(|(q, p)| (q / p).abs()).fold(0.0, f64::max)
        })
    }

    /// Points (x, y) of the smooth edge of a solved contact, at most one in a cell, in the order of the grid. There
    /// the stress that friction and pressure make at the surface has a kink, and its largest values:
    /// [`Section::Axis`](crate::Section::Axis) gives them. Empty where the edge is not known within cells: sharp edges, rough
    /// surfaces, contacts of few cells, springs at the surface, pressures that were given, and periodic grids.
    pub fn edge(&self) -> Vec<[f64; 2]> {
        self.edge_points_on_body().iter().map(|point| self.position(point)).collect()
    }

    /// Coordinates x and y of a point.
    pub(super) fn position(&self, point: &CellPoint) -> [f64; 2] {
        let (grid, spacing) = (&self.whole.grid, self.whole.grid.spacing());
        [0, 1].map(|axis| {
            grid.coordinate(axis, point.cell[axis]) + point.within[axis] * spacing[axis]
        })
    }

    /// Numbers of the `points` of the edge that are nearest to places a `step` away from one of them, to both sides along
    /// the edge.
    pub(super) fn along_edge(&self, points: &[CellPoint], from: usize, step: f64) -> Vec<usize> {
        let Some(solved) = &self.whole.solved else { return Vec::new() };
        if self.whole.grid.is_line() {
            return Vec::new();
        }
        let Some([nx, ny]) = solved.subcell.inward(&points[from]) else { return Vec::new() };
        let [x, y] = self.position(&points[from]);
        let nearest = |[x, y]: [f64; 2]| {
            let far = |k: &usize| {
                let at = self.position(&points[*k]);
                (at[0] - x).hypot(at[1] - y)
            };
            (0..points.len()).min_by(|a, b| far(a).total_cmp(&far(b)))
        };
        let places = [step, -step].map(|step| [x + step * ny, y - step * nx]);
        places.into_iter().filter_map(nearest).filter(|k| *k != from).collect()
    }

    /// Largest turn of the edge from one of its `points` over the longer side of a cell, to both sides: the length of the change
    /// of its normal, which is the angle where that is small, and at most 2.
    pub(super) fn turn_of_edge(&self, points: &[CellPoint], from: usize) -> f64 {
        let Some(solved) = &self.whole.solved else { return 0.0 };
        let inward = |k: usize| solved.subcell.inward(&points[k]).unwrap_or_default();
        let [nx, ny] = inward(from);
        let [dx, dy] = self.whole.grid.spacing();
        let beside = self.along_edge(points, from, dx.max(dy)).into_iter().map(inward);
        beside.map(|[x, y]| (x - nx).hypot(y - ny)).fold(0.0, f64::max)
    }

    /// A point at this distance from one of the edge, towards the inside; none beyond the grid.
    pub(super) fn inside_of(&self, point: &CellPoint, by: f64) -> Option<CellPoint> {
        let inward = self.whole.solved.as_ref()?.subcell.inward(point)?;
        let (grid, mut moved) = (&self.whole.grid, *point);
        for (axis, part) in inward.into_iter().enumerate() {
            let at = point.within[axis] + by * part / grid.spacing()[axis];
            let cells = rounding::round(at);
            moved.cell[axis] = point.cell[axis].checked_add_signed(cells as isize)?;
            moved.within[axis] = at - cells;
        }
        (0..2).all(|axis| moved.cell[axis] < grid.shape()[axis]).then_some(moved)
    }

    /// Points of the edge that the body has.
    pub(super) fn edge_points_on_body(&self) -> Vec<CellPoint> {
        let solved = self.whole.solved.as_ref();
        let mut points = solved.map_or_else(Vec::new, |solved| solved.subcell.edge());
        points.retain(|point| {
            let row = point.cell[0];
            self.span.rows.contains(&row) && self.span.has(row as f64 + point.within[0])
        });
        points
    }

    /// The body.
    pub fn body(&self) -> &HalfSpace {
        &self.whole.body
    }
}

/// A plan under one friction, with the memory that all its planes use.
#[derive(Debug)]
pub(super) struct Evaluation<'a> {
    plan: &'a StressPlan,
    loading: Loading,
    displacement: bool,
    /// Whether stresses without what pressure within cells adds are kept.
    pub(super) keeps_smooth: bool,
    whole: Option<PlaneMemory>,
    parts: Vec<Option<PlaneMemory>>,
}

impl<'a> Evaluation<'a> {
    pub(super) fn new(plan: &'a StressPlan, friction: [f64; 2], displacement: bool) -> Self {
        Self {
            plan,
            loading: Loading::new(friction, displacement),
            displacement,
            keeps_smooth: false,
            whole: None,
            parts: plan.parts.iter().map(|_| None).collect(),
        }
    }

    /// Writes the components at `place` to `outputs`, whole planes of (nx, ny) cells. `progress` is told
    /// the fraction of this plane that is done; where it breaks, `outputs` are incomplete.
    pub(super) fn plane(
        &mut self,
        place: &Place,
        outputs: &mut [&mut [f64]],
        progress: &mut StressProgress,
    ) -> ControlFlow<()> {
        let (plan, loading) = (self.plan, &self.loading);
        let memory = || plan.whole.plane_memory(loading);
        let memory = self.whole.get_or_insert_with(memory);
        memory.keep_within_cells(self.keeps_smooth);
        plan.whole.plane(loading, place, memory, outputs, progress)?;
        for (part, memory) in plan.parts.iter().zip(&mut self.parts) {
            part.plane(place, self.displacement, memory, outputs, progress)?;
        }
        outputs.iter_mut().for_each(|output| plan.span.blank(output));
        ControlFlow::Continue(())
    }

    /// The `fields` of the plane that was evaluated last, without what pressure within cells adds.
    pub(super) fn smooth(&self, fields: &[Vec<f64>; STRESSES]) -> Option<[Vec<f64>; STRESSES]> {
        let within = self.whole.as_ref()?.within_cells()?;
        Some(std::array::from_fn(|k| {
            fields[k].iter().zip(&within[k]).map(|(field, within)| field - within).collect()
        }))
    }

    /// Components at `place` in each of the `cells`; with displacements, nine. `progress` is told 0.
    fn points(
        &self,
        place: &Place,
        cells: &[[usize; 2]],
        progress: &mut StressProgress,
    ) -> ControlFlow<(), Vec<[f64; COMPONENTS]>> {
        let plan = self.plan;
        let mut sums = plan.whole.points(&self.loading, place, cells, progress)?;
        for part in &plan.parts {
            part.points(place, self.displacement, cells, &mut sums, progress)?;
        }
        for (sums, [i, _]) in sums.iter_mut().zip(cells) {
            if !plan.span.rows.contains(i) {
                *sums = [f64::NAN; COMPONENTS];
            }
        }
        ControlFlow::Continue(sums)
    }

    /// Stresses at `place` below a point of a solved contact, of which `at` gives those of the whole half-space with its
    /// tractions. What free ends add is interpolated between the centres of cells; a body with known tractions has none.
    pub(super) fn at_point(
        &self,
        place: &Place,
        at: &PointStress,
        (point, fit): (&CellPoint, EdgeFit),
        progress: &mut StressProgress,
    ) -> ControlFlow<(), [f64; STRESSES]> {
        progress(0.0)?;
        let plan = self.plan;
        let beyond = at.beyond(point);
        let mut sum = plan.whole.threads.run(|| at.at(point, fit, beyond));
        if plan.known.is_some() || beyond.is_some() {
            return ControlFlow::Continue(sum);
        }
        let around = plan.span.around(point, plan.whole.grid.shape());
        for part in &plan.parts {
            for (cell, weight) in &around {
                let mut components = [[0.0; COMPONENTS]];
                part.points(place, false, &[*cell], &mut components, progress)?;
                sum.iter_mut().zip(components[0]).for_each(|(sum, value)| *sum += weight * value);
            }
        }
        ControlFlow::Continue(sum)
    }

    /// What gives stresses at `place` of the whole half-space below any point of a solved contact.
    pub(super) fn point_stress(&self, place: &Place) -> Option<PointStress<'a>> {
        let sliding = Tractions::Sliding(self.loading.friction());
        let tractions = self.plan.known.as_ref().map_or(sliding, Tractions::Known);
        self.plan.whole.point_stress(place, tractions)
    }

    /// The components at `place` on the face of an end that lies between the rows `row` − 1 and `row`, for each of them
    /// along y. The pressure is uniform over cells there.
    fn on_face(
        &self,
        place: &Place,
        (end, row): (usize, usize),
        progress: &mut StressProgress,
    ) -> ControlFlow<(), Vec<Vec<f64>>> {
        let mut lines = self.plan.whole.line(&self.loading, (place, row), progress)?;
        for part in &self.plan.parts {
            part.on_face(place, self.displacement, (end, row), &mut lines, progress)?;
        }
        ControlFlow::Continue(lines)
    }
}

/// Stress at `depths` by a plan that is made for this call. Bad options are refused before planning.
pub(super) fn stress_once(
    source: &PressureSource,
    depths: &[f64],
    watched_options: WatchedStress,
) -> Result<Stress> {
    let (body, grid, sliding) = (source.body, source.grid, &source.sliding);
    let request = Request::checked(body, grid, sliding, depths, watched_options.options())?;
    let evaluate =
        |plan: &StressPlan, progress: &mut StressProgress| request.evaluate(plan, progress);
    // Stopped while planning, no depth is done.
    let none = || request.result(zeros(request.components(), 0), 0, None);
    Ok(source.once(watched_options, request.memory(), evaluate)?.unwrap_or_else(none))
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
        sliding: &SlidingSense,
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
        let result = (8 * self.places.len() * self.points.count() * self.components()) as u64;
        if self.is_point() {
            // Sums of one row of coefficients for each cell.
            return result + (8 * 4 * COMPONENTS * self.grid.shape()[0]) as u64;
        }
        let arrays = plane_arrays(self.options.friction != 0.0, self.options.displacement);
        result + memory_of(self.grid.shape(), arrays)
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
        let within = self.is_point() && self.known_point(plan).is_some();
        let uncertainty = plan.uncertainties(&self.places[..done], self.friction, &window, within);
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
        // Whole planes and single points are evaluated in place, lines by way of a plane.
        let in_place = self.points.are_all_cells() || self.is_point();
        let mut planes = match in_place {
            true => Vec::new(),
            false => zeros(fields.len(), self.points.of_plane()),
        };
        let mut evaluation = Evaluation::new(plan, self.friction, self.options.displacement);
        for (done, place) in self.places.iter().enumerate() {
            let total = self.places.len() as f64;
            let mut progress = |fraction: f64| progress((done as f64 + fraction) / total);
            let mut here: Vec<&mut [f64]> = fields
                .iter_mut()
                .map(|field| &mut field[done * count..(done + 1) * count])
                .collect();
            let flow = if self.is_point() {
                self.fill_point(&evaluation, place, &mut here, &mut progress)
            } else if in_place {
                evaluation.plane(place, &mut here, &mut progress)
            } else {
                self.fill_planes(&mut evaluation, place, &mut planes, &mut progress)
            };
            if flow.is_break() {
                return done;
            }
            for (plane, here) in planes.iter().zip(&mut here) {
                self.points.interpolate(plane, here);
            }
            let residual = self.residual[place.layer];
            for in_plane in &mut here[..2] {
                if residual != 0.0 {
                    in_plane.iter_mut().for_each(|s| *s += residual);
                }
            }
        }
        // All is done: a break has nothing left to stop.
        let _ = progress(1.0);
        self.places.len()
    }

    /// Evaluates what points at `place` are interpolated from: the cells of planes and, behind them, a face.
    fn fill_planes(
        &self,
        evaluation: &mut Evaluation,
        place: &Place,
        planes: &mut [Vec<f64>],
        progress: &mut StressProgress,
    ) -> ControlFlow<()> {
        let [nx, ny] = self.grid.shape();
        if !self.points.are_on_face() {
            let outputs = planes.iter_mut().map(|plane| &mut plane[..nx * ny]);
            evaluation.plane(place, &mut outputs.collect::<Vec<_>>(), progress)?;
        }
        if let Some((end, row)) = self.points.face() {
            let lines = evaluation.on_face(place, (end, row), progress)?;
            for (plane, line) in planes.iter_mut().zip(lines) {
                plane[(nx + end) * ny..][..ny].copy_from_slice(&line);
            }
        }
        ControlFlow::Continue(())
    }

    /// Evaluates a single point, which needs no other cells than those that it is interpolated from.
    ///
    /// In a solved contact stresses are those at the point itself: between centres they may have a kink at the edge.
    fn fill_point(
        &self,
        evaluation: &Evaluation,
        place: &Place,
        here: &mut [&mut [f64]],
        progress: &mut StressProgress,
    ) -> ControlFlow<()> {
        let (cells, weights): (Vec<_>, Vec<_>) = self.points.weighted_cells().into_iter().unzip();
        let cell_components = evaluation.points(place, &cells, progress)?;
        for (k, value) in here.iter_mut().enumerate() {
            let parts = cell_components.iter().zip(&weights);
            value[0] = parts.map(|(components, weight)| weight * components[k]).sum();
        }
        if let Some(point) = self.known_point(evaluation.plan)
            && let Some(at) = evaluation.point_stress(place)
        {
            let components = evaluation.at_point(place, &at, (&point, EdgeFit::Best), progress)?;
            here.iter_mut().zip(components).for_each(|(value, component)| value[0] = component);
        }
        ControlFlow::Continue(())
    }

    /// The single point, where it lies between centres and the pressure around it is known within cells.
    fn known_point(&self, plan: &StressPlan) -> Option<CellPoint> {
        let solved = plan.whole.solved.as_ref()?;
        self.points.between().filter(|point| solved.subcell.has_point(point))
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
            displacement: self.options.displacement.then(|| std::array::from_fn(|_| next())),
        }
    }
}

/// `fields` arrays of zeros. Each is allocated by itself: a copy would touch its memory here, on one
/// thread.
fn zeros(fields: usize, length: usize) -> Vec<Vec<f64>> {
    (0..fields).map(|_| vec![0.0; length]).collect()
}
