//! Random contacts against properties that every contact has. `make fuzz` tries many more of them.

use nacre::influence::{Method, influence_coefficients};
use nacre::{
    Algorithm, Contact, Convolution, Cylinder, Elastic, Error, FlatPunch, Grid, HalfSpace,
    HeightMap, Motion, Paraboloid, Result, Solution, Substrate, Surface,
};
use ndarray::{Array2, Axis};
use proptest::prelude::*;
use proptest::test_runner::{RngSeed, TestCaseError, TestCaseResult};

use crate::support::checks::{apart, largest, pressure_off, seeded};
use crate::support::random::uniform;
use crate::support::settings::{by, stack, threads};

/// Tolerance of the iterations.
const TIGHT: f64 = 1e-12;

/// Difference of pressures, relative to the peak, between two solutions of one contact: the tolerance times
/// the condition of the stiffest contacts here, a hundred for the coat times some ten thousand for the cells.
const SAME: f64 = 1e-6;

/// A layer: modulus relative to the substrate's, Poisson's ratio, thickness in cells.
type Coat = (f64, f64, f64);

/// Numbers from which a contact is made. Lengths are in cells, moduli in those of the substrate.
#[derive(Debug, Clone)]
struct Case {
    cells: [usize; 2],
    line: bool,
    /// Side of a cell along y, relative to the one along x.
    oblong: f64,
    center: [f64; 2],
    poisson: f64,
    coats: Vec<Coat>,
    rigid_base: bool,
    shape: Kind,
    /// Half-width of the contact of a bare body, relative to half the grid's shorter side.
    width: f64,
    loaded: bool,
    /// Tilts relative to the slope of the shape at the edge of the contact.
    tilt: [Option<f64>; 2],
    /// Points of the load relative to half the width of the contact.
    eccentricity: [Option<f64>; 2],
}

#[derive(Debug, Clone, Copy)]
enum Kind {
    /// Ratio of the radii.
    Paraboloid(f64),
    Cylinder,
    /// Radius relative to half the grid's shorter side.
    Punch(f64),
    /// Two paraboloids side by side would be a minimum; their sum is one, off the middle by this.
    Shifted(f64),
}

fn powers(low: f64, high: f64) -> impl Strategy<Value = f64> {
    (low..high).prop_map(|power| 10.0_f64.powf(power))
}

fn coat() -> impl Strategy<Value = Coat> {
    (powers(-2.0, 2.0), 0.0..0.5, powers(-1.0, 1.3))
}

fn kind() -> impl Strategy<Value = Kind> {
    prop_oneof![
        powers(-0.7, 0.7).prop_map(Kind::Paraboloid),
        Just(Kind::Cylinder),
        (0.2..0.8).prop_map(Kind::Punch),
        (-0.5..0.5).prop_map(Kind::Shifted),
    ]
}

fn case() -> impl Strategy<Value = Case> {
    let side = || 4..34_usize;
    let maybe = || prop::option::weighted(0.3, -0.3..0.3);
    (
        ([side(), side()], prop::bool::weighted(0.2), powers(-0.5, 0.5)),
        ([-3.0..3.0, -3.0..3.0], 0.0..0.5),
        (prop::collection::vec(coat(), 0..3), prop::bool::weighted(0.15)),
        (kind(), 0.1..0.9, any::<bool>()),
        ([maybe(), maybe()], [maybe(), maybe()]),
    )
        .prop_map(
            |(grid, (center, poisson), (coats, rigid), (shape, width, loaded), (t, e))| Case {
                cells: grid.0,
                line: grid.1,
                oblong: grid.2,
                center,
                poisson,
                rigid_base: rigid && !coats.is_empty(),
                coats,
                shape,
                width,
                loaded,
                tilt: t,
                eccentricity: e,
            },
        )
}

/// A contact that is ready to be solved: lengths in `length`, moduli in `modulus`.
struct Problem {
    body: HalfSpace,
    grid: Grid,
    shape: Box<dyn Surface>,
    motion: Motion,
}

impl Case {
    fn build(&self, length: f64, modulus: f64) -> Result<Problem> {
        let sides = [length, length * self.oblong];
        let [nx, ny] = self.cells;
        let grid = if self.line {
            Grid::line(ny, ny as f64 * sides[1])?
        } else {
            Grid::new([nx, ny], [nx as f64 * sides[0], ny as f64 * sides[1]])?
        };
        let mut center = self.center.map(|c| c * length);
        if self.line {
            center[0] = 0.0;
        }
        let grid = grid.centered_at(center)?;

        let material = Elastic::new(modulus, self.poisson)?;
        let coat =
            |&(young, poisson, thickness): &Coat| [young * modulus, poisson, thickness * length];
        let substrate = match self.rigid_base {
            true => Substrate::Rigid,
            false => Substrate::from(material),
        };
        let body = stack(substrate, self.coats.iter().map(coat))?;

        let shorter = match self.line {
            true => grid.size()[1],
            false => grid.size()[0].min(grid.size()[1]),
        };
        let half = 0.5 * self.width * shorter;
        // A radius at which slopes are small; the contact of a bare half-space has δ = a²/R.
        let radius = 50.0 * shorter;
        let depth = half * half / radius;
        let [x, y] = grid.center();
        let shape: Box<dyn Surface> = match self.shape {
            Kind::Paraboloid(ratio) if !self.line => {
                Box::new(Paraboloid::new(radius, ratio * radius)?.shifted(x, y)?)
            }
            Kind::Punch(part) if !self.line => {
                // At least one cell's centre lies under the punch.
                let [dx, dy] = grid.spacing();
                let radius = (0.5 * part * shorter).max(0.75 * dx.hypot(dy));
                Box::new(FlatPunch::new(radius)?.shifted(x, y)?)
            }
            Kind::Shifted(by) if !self.line => {
                let by = by * half;
                let first = Paraboloid::new(radius, radius)?.shifted(x + by, y)?;
                Box::new(first.plus(Paraboloid::new(2.0 * radius, radius)?.shifted(x, y - by)?))
            }
            _ => Box::new(Cylinder::new(radius)?.shifted(0.0, y)?),
        };
        let plane_strain = modulus / (1.0 - self.poisson * self.poisson);
        let mut motion = if self.loaded {
            let wide = if self.line { 1.0 } else { half };
            Motion::load(plane_strain * depth * wide)
        } else {
            Motion::approach(depth)
        };
        for axis in if self.line { 1..2 } else { 0..2 } {
            if let (Some(e), true) = (self.eccentricity[axis], self.loaded) {
                motion.eccentricity[axis] = Some(grid.center()[axis] + e * half);
            } else if let Some(tilt) = self.tilt[axis] {
                motion.tilt[axis] = Some(tilt * half / radius);
            }
        }
        Ok(Problem { body, grid, shape, motion })
    }
}

fn broken(what: impl std::fmt::Display) -> TestCaseError {
    TestCaseError::fail(what.to_string())
}

impl Problem {
    fn solve(&self, algorithm: Algorithm) -> std::result::Result<Option<Solution>, TestCaseError> {
        let contact = Contact::plan(&self.body, self.grid, threads(1)).map_err(broken)?;
        match contact.solve(&*self.shape, &self.motion, &by(algorithm, TIGHT)) {
            Ok(solution) if solution.report.converged() => Ok(Some(solution)),
            // The reference goes round in circles on some contacts of a few cells, and says so.
            Ok(_) if algorithm == Algorithm::PolonskyKeer => Ok(None),
            Ok(solution) => Err(broken(format!("{:?}", solution.report))),
            // A load beside everything that can touch; an approach relative to a datum that a thick hard coat
            // moves as well.
            Err(Error::Moment { .. } | Error::LoadPoint { .. } | Error::Datum { .. }) => Ok(None),
            Err(error) => Err(broken(error)),
        }
    }
}

/// Largest |a − b| relative to the largest |b|; 0 where both are zero.
fn difference(a: &Array2<f64>, b: &Array2<f64>) -> f64 {
    apart(a, b) / largest(b).max(f64::MIN_POSITIVE)
}

fn expect(found: f64, limit: f64, what: &str) -> TestCaseResult {
    // Not `found > limit`, which a NaN passes.
    if found <= limit { Ok(()) } else { Err(broken(format!("{what}: {found:e} > {limit:e}"))) }
}

/// Twenty cases that are equal in every run, or as many others as the environment variable `NACRE_FUZZ` says.
fn fuzzed() -> ProptestConfig {
    let asked = std::env::var("NACRE_FUZZ").ok();
    match asked.and_then(|cases| cases.parse().ok()) {
        Some(cases) => {
            ProptestConfig { rng_seed: RngSeed::Random, max_shrink_iters: 200, ..seeded(cases) }
        }
        None => seeded(20),
    }
}

/// An array with its rows in the opposite order.
fn mirrored(values: &Array2<f64>) -> Array2<f64> {
    let mut view = values.view();
    view.invert_axis(Axis(0));
    view.as_standard_layout().to_owned()
}

proptest! {
    #![proptest_config(fuzzed())]

    /// Balance and complementarity, computed here from the pressure alone.
    #[test]
    fn a_solution_is_one(case in case()) {
        let problem = case.build(1.0, 1.0).map_err(broken)?;
        let Some(s) = problem.solve(Algorithm::Cascade)? else { return Ok(()) };
        prop_assert!(s.pressure.iter().all(|p| *p >= 0.0 && p.is_finite()));
        let grid = &problem.grid;
        let c = influence_coefficients(&problem.body, grid, Method::Exact).map_err(broken)?;
        let u = Convolution::plan(&c, Some(1)).and_then(|k| k.apply(&s.pressure)).map_err(broken)?;
        let gaps = problem.shape.gaps(grid).map_err(broken)?;
        let (x, y) = (grid.x(), grid.y());
        let g = Array2::from_shape_fn(u.dim(), |(i, j)| {
            gaps[[i, j]] + u[[i, j]] - s.approach - s.tilt[0] * x[i] - s.tilt[1] * y[j]
        });
        let area = grid.cell_area();
        let load = area * s.pressure.sum();
        if let Some(asked) = problem.motion.load {
            expect((load / asked - 1.0).abs(), 1e-10, "force")?;
        }
        for (axis, coordinates) in [(0, &x), (1, &y)] {
            if let Some(e) = problem.motion.eccentricity[axis] {
                let lines = s.pressure.sum_axis(Axis(1 - axis));
                let moment = area * (&lines * coordinates).sum();
                let lever = e.abs() + grid.size()[axis];
                expect((moment - load * e).abs(), 1e-10 * load * lever, "moment")?;
            }
        }
        let touching = || g.iter().zip(&u).zip(&s.pressure).filter(|((g, _), _)| g.is_finite());
        let scale = touching().fold(0.0_f64, |scale, ((_, u), _)| scale.max(u.abs()));
        let overlap = touching().fold(0.0_f64, |deep, ((g, _), _)| deep.max(-g));
        expect(overlap, 1e-9 * scale, "overlap")?;
        let work: f64 = touching().map(|((_, u), p)| (p * u).abs()).sum();
        let mismatch: f64 = touching().map(|((g, _), p)| p * g.abs()).sum();
        expect(mismatch, 1e-9 * work, "complementarity")?;
    }

    /// The reference algorithm of Polonsky and Keer finds the same contact.
    #[test]
    fn the_reference_agrees(case in case()) {
        let problem = case.build(1.0, 1.0).map_err(broken)?;
        let Some(a) = problem.solve(Algorithm::Cascade)? else { return Ok(()) };
        let Some(b) = problem.solve(Algorithm::PolonskyKeer)? else { return Ok(()) };
        expect(pressure_off(&a, &b), SAME, "pressure")?;
        let depth = problem.grid.size()[1].abs();
        let slope = (a.approach - b.approach).abs() / b.approach.abs().max(1e-12 * depth);
        expect(slope, SAME, "approach")?;
    }

    /// Lengths and moduli in other units give the same contact.
    #[test]
    fn units_do_not_matter(case in case(), length in powers(-7.0, 3.0), modulus in powers(-3.0, 12.0)) {
        let Some(a) = case.build(1.0, 1.0).map_err(broken)?.solve(Algorithm::Cascade)? else {
            return Ok(());
        };
        let scaled = case.build(length, modulus).map_err(broken)?.solve(Algorithm::Cascade)?;
        let Some(b) = scaled else {
            return Err(broken("in other units the moment cannot be carried"));
        };
        expect(difference(&(&b.pressure / modulus), &a.pressure), SAME, "pressure")?;
        expect((b.approach / length - a.approach).abs(), SAME * a.approach.abs(), "approach")?;
    }

    /// The mirrored and the transposed surface has the mirrored and the transposed pressure.
    #[test]
    fn directions_do_not_matter(case in case(), roughness in powers(-3.0, 0.0)) {
        let square = Case { line: false, oblong: 1.0, center: [0.0; 2], ..case };
        let problem = square.build(1.0, 1.0).map_err(broken)?;
        let gaps = problem.shape.gaps(&problem.grid).map_err(broken)?;
        let depth = problem.motion.approach.unwrap_or(1e-2) * roughness;
        let noise = uniform(square.cells, u64::from(square.cells[0] as u32));
        let heights = depth * noise - gaps.mapv(|gap| if gap.is_finite() { gap } else { 1e3 });
        let load = Motion::load(problem.motion.load.unwrap_or(1.0));
        let solve = |heights: Array2<f64>| -> std::result::Result<Array2<f64>, TestCaseError> {
            let map = HeightMap::new(heights, [1.0, 1.0]).map_err(broken)?;
            let grid = map.grid().ok_or_else(|| broken("a map has a grid"))?;
            let Problem { body, .. } = square.build(1.0, 1.0).map_err(broken)?;
            let problem = Problem { body, grid, shape: Box::new(map), motion: load };
            match problem.solve(Algorithm::Cascade)? {
                Some(solution) => Ok(solution.pressure),
                None => Err(broken("a centred load must be carried")),
            }
        };
        let known = solve(heights.clone())?;
        let other = solve(mirrored(&heights))?;
        expect(difference(&mirrored(&other), &known), SAME, "mirror")?;
        let transposed = solve(heights.t().as_standard_layout().to_owned())?;
        expect(difference(&transposed.t().to_owned(), &known), SAME, "transposition")?;
    }

    /// Pressing deeper and tilting further does work: Δδ ΔF + Δs · ΔM ≥ 0, since K is positive definite.
    #[test]
    fn pressing_further_does_work(case in case(), deeper in 0.01..1.0, turn in -0.2..0.2) {
        let case = Case { loaded: false, line: false, ..case };
        let mut problem = case.build(1.0, 1.0).map_err(broken)?;
        let Some(a) = problem.solve(Algorithm::Cascade)? else { return Ok(()) };
        let approach = problem.motion.approach.unwrap_or_default();
        let lever = problem.grid.size()[0];
        problem.motion.approach = Some(approach * (1.0 + deeper));
        let tilt = problem.motion.tilt[0].unwrap_or_default() + turn * approach / lever;
        problem.motion.tilt[0] = Some(tilt);
        let Some(b) = problem.solve(Algorithm::Cascade)? else { return Ok(()) };
        let work = (b.approach - a.approach) * (b.load() - a.load())
            + (b.tilt[0] - a.tilt[0]) * (b.moment()[0] - a.moment()[0])
            + (b.tilt[1] - a.tilt[1]) * (b.moment()[1] - a.moment()[1]);
        expect(-work, 1e-9 * b.approach * b.load(), "work")?;
    }
}
