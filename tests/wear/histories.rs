//! Histories of wear: the worn volume, steps that are chosen, layers that are worn through, grids that grow, and what is refused.

use std::f64::consts::PI;
use std::ops::ControlFlow;
use std::sync::Arc;

use nacre::contact::choose_grid;
use nacre::influence::influence_coefficients;
use nacre::wear::{Slip, Thickness, Wear, WearScheme, WearSession, WearState, WearSteps};
use nacre::{
    Contact, Cylinder, Elastic, Grid, HalfSpace, Hardness, HeightMap, Layer, Member, Method,
    Motion, Options, Paraboloid, Result, Setup,
};
use ndarray::Array2;

use super::waves::states;
use crate::support::checks::{apart, largest};

const RADIUS: f64 = 1e3;

/// A coat three times stiffer than its body.
fn coated() -> Result<HalfSpace> {
    HalfSpace::new(Elastic::new(1.0, 0.3)?, [Layer::new(Elastic::new(3.0, 0.3)?, 1e-4)?])
}

fn line() -> Result<Arc<Contact>> {
    Ok(Arc::new(Contact::plan(coated()?, Grid::line(96, 3.0)?, Setup::default())?))
}

/// Half-width 1 of Hertz: W = π E*/4R.
fn load() -> Motion {
    Motion::load(PI / (4.0 * 0.91 * RADIUS))
}

fn ends(count: usize, end: f64) -> WearSteps {
    WearSteps::Ends((1..=count).map(|k| end * k as f64 / count as f64).collect())
}

fn run(plan: &Arc<Contact>, wear: Wear) -> Result<Vec<WearState>> {
    let cylinder = Cylinder::new(RADIUS)?;
    states(WearSession::new(Arc::clone(plan), cylinder, load(), wear, false)?)
}

/// Σ w dA = κ s W of each body, whatever the steps and the rule.
#[test]
fn worn_volumes_are_those_of_the_law() -> Result<()> {
    let plan = line()?;
    let force = load().load.unwrap_or(0.0);
    for scheme in [WearScheme::Euler, WearScheme::Trapezoidal] {
        // Steps of 1e9 are far beyond what elasticity gives; the first one ends where the coat is through.
        for (count, end) in [(1, 0.03), (7, 0.03), (1, 1e9), (3, 1e9)] {
            let steps = ends(count, end);
            let rates = [vec![1.0, 1.0], vec![0.25]];
            let states =
                run(&plan, Wear::sliding(rates, end).with_steps(steps).with_scheme(scheme))?;
            for state in &states[1..] {
                let due = force * state.distance;
                near!(state.depth[0].sum() * plan.grid().cell_area(), due, 1e-12, count);
                near!(state.depth[1].sum() * plan.grid().cell_area(), 0.25 * due, 1e-12, count);
            }
        }
    }
    Ok(())
}

/// A rate of 0 leaves every bit of the solve.
#[test]
fn without_wear_it_is_the_solve() -> Result<()> {
    let plan = line()?;
    let solution = plan.solve(&Cylinder::new(RADIUS)?, &load(), &Options::default())?;
    for state in run(&plan, Wear::sliding([vec![0.0], vec![0.0]], 1.0))? {
        assert_eq!(state.solution.pressure, solution.pressure);
        assert_eq!(state.solution.gap(), solution.gap());
        assert_eq!(state.solution.approach.to_bits(), solution.approach.to_bits());
    }
    Ok(())
}

/// The state after a step solves the plain contact of the worn shape: its gap is h + w + u − δ, 0 in contact.
#[test]
fn worn_contacts_are_contacts_of_the_worn_shape() -> Result<()> {
    let plan = line()?;
    let states = run(&plan, Wear::sliding([vec![1.0], vec![0.5]], 0.03).with_steps(ends(3, 0.03)))?;
    let state = &states[3];
    let solution = &state.solution;
    let worn = &state.depth[0] + &state.depth[1];
    let (y, deep) = (plan.grid().y(), largest(&solution.displacement));
    let due = Array2::from_shape_fn(worn.dim(), |(i, j)| {
        let shape = RADIUS - (RADIUS * RADIUS - y[j] * y[j]).sqrt();
        shape + worn[[i, j]] + solution.displacement[[i, j]] - solution.approach
    });
    // Heights of a circle of radius 1000 round at 1e-13.
    below!(apart(&solution.gap(), &due), 1e-12 + 1e-12 * deep);
    for (g, p) in due.iter().zip(&solution.pressure) {
        assert!(*g > -1e-7 * deep && (*p <= 0.0 || *g < 1e-6 * deep), "{g:e}");
    }
    Ok(())
}

/// Chosen steps against ten times as many: half-width and peak within 2e-3 of the start's, which is twice the tolerance of a step.
/// The edge of a worn contact lies on a cell's: those of the cylinder are so small that one of them is no more than that.
/// At a given load, the mean pressure p̄ and the half-width a change together, by W = 2a p̄ in line: relative to a, Euler's
/// half-widths err by what the pressure may err relative to p̄, which has fallen: 2e-3 of the first peak, and half of that for the
/// cells, of which they are whole numbers.
#[test]
fn chosen_steps_keep_their_error() -> Result<()> {
    let end = 0.1;
    let grid = Grid::new([64, 64], [4.0, 4.0])?;
    let line = Grid::line(2048, 4.0)?;
    let cylinder = Arc::new(Contact::plan(Elastic::new(1.0, 0.3)?, line, Setup::default())?);
    let ball = Arc::new(Contact::plan(Elastic::new(1.0, 0.3)?, grid, Setup::default())?);
    // Hertz's W of a contact radius of 1: 4 E*/3R.
    let cases = [(&cylinder, load()), (&ball, Motion::load(4.0 / (3.0 * 0.91 * RADIUS)))];
    for (plan, motion) in cases {
        for scheme in [WearScheme::Trapezoidal, WearScheme::Euler] {
            let shape = Paraboloid::new(RADIUS, RADIUS)?;
            let history =
                |wear| states(WearSession::new(Arc::clone(plan), shape, motion, wear, false)?);
            let wear = Wear::sliding([vec![1.0], vec![0.0]], end).with_scheme(scheme);
            let chosen = history(wear.clone())?;
            let steps = WearSteps::Ends(
                (chosen.windows(2))
                    .flat_map(|pair| {
                        let [from, to] = [pair[0].distance, pair[1].distance];
                        (1..=10).map(move |k| from + 0.1 * f64::from(k) * (to - from))
                    })
                    .collect(),
            );
            let fine = history(wear.with_steps(steps).with_scheme(WearScheme::Trapezoidal))?;
            let peak = chosen[0].solution.peak_pressure();
            for (k, state) in chosen.iter().enumerate() {
                let other = &fine[10 * k].solution;
                below!(
                    (state.solution.peak_pressure() - other.peak_pressure()).abs(),
                    2e-3 * peak,
                    k,
                    scheme
                );
                let [width, due] = [&state.solution, other].map(|s| s.contact_extent()[1][1]);
                let mean = motion.load.expect("given") / other.contact_area();
                let bar = if scheme == WearScheme::Euler { 3e-3 * peak / mean } else { 2e-3 };
                below!((width - due).abs(), bar * due, k, scheme);
            }
            let last = chosen.last().expect("a state");
            // The steps that are ten times shorter err by a hundredth of it, or a tenth, as the solves do.
            let due =
                apart(&last.solution.pressure, &fine.last().expect("a state").solution.pressure);
            below!(due, 1.1 * last.step_error * last.solution.peak_pressure(), scheme);
            near!(last.distance, end, 1e-15);
        }
    }
    Ok(())
}

/// In the long run wear alone makes the shape: a³ → 3 R κsW/2 of a cylinder, which falls from above, and the pressure is uniform.
#[test]
#[ignore = "slow"]
fn long_runs_end_on_their_closed_forms() -> Result<()> {
    let plan =
        Arc::new(Contact::plan(Elastic::new(1.0, 0.3)?, Grid::line(256, 12.0)?, Setup::default())?);
    let force = load().load.unwrap_or(0.0);
    let mut before = f64::INFINITY;
    // κs in units of what elasticity gives per pressure, 1/E*: 10 to 100 half-widths of Hertz.
    for distance in [10.0, 30.0, 100.0] {
        let wear = Wear::sliding([vec![1.0], vec![0.0]], distance).with_scheme(WearScheme::Euler);
        let states = run(&plan, wear)?;
        let solution = &states.last().expect("a state").solution;
        let half = 0.5 * solution.contact_area();
        let excess = half.powi(3) / (1.5 * RADIUS * distance * force) - 1.0;
        // Elasticity adds u/w to the depth, some 1/κsE*: a cell is 0.05 of 3 to 7.
        assert!(excess > -0.03 && excess < before, "{excess} {distance}");
        before = excess;
        let uniform = solution.load() / solution.contact_area();
        let middle = solution.pressure[[0, 128]];
        below!((middle / uniform - 1.0).abs(), 2.0 / distance, distance);
    }
    below!(before, 0.05);
    Ok(())
}

/// A coat is through at the same place and distance, to 1 %, with ten times as many steps; and below it the other rate holds.
#[test]
fn coats_are_through_where_finer_steps_say() -> Result<()> {
    let plan = line()?;
    let rates = [vec![1.0, 30.0], vec![0.0]];
    let wear = |steps| Wear::sliding(rates.clone(), 1.0).with_steps(steps).with_until_through(true);
    let auto = run(&plan, wear(WearSteps::Auto { end: 1.0, tolerance: 1e-3 }))?;
    let through = auto.last().expect("a state").through[0];
    let fine = run(&plan, wear(ends((10.0 * auto.len() as f64 / through.distance) as usize, 1.0)))?;
    let due = fine.last().expect("a state").through[0];
    near!(through.distance, due.distance, 0.01);
    assert_eq!((through.layer, through.member), (0, Member::Body));
    below!(
        (through.position[1].abs() - due.position[1].abs()).abs(),
        1.01 * plan.grid().spacing()[1]
    );
    let state = auto.last().expect("a state");
    near!(largest(&state.depth[0]), 1e-4, 1e-5);
    // Given steps are divided at the same moment, and the history goes on with both rates.
    let beyond = wear(WearSteps::Ends(Vec::new()))
        .with_steps(ends(6, 2.0 * due.distance))
        .with_until_through(false);
    let states = run(&plan, beyond)?;
    let event = states.iter().find(|state| !state.through.is_empty()).expect("it is through");
    near!(event.distance, due.distance, 0.02);
    let last = states.last().expect("a state");
    let distances: Vec<f64> = states.iter().map(|state| state.distance / due.distance).collect();
    assert_eq!(states.len(), 8, "{distances:?}");
    let volume = last.depth[0].sum() * plan.grid().cell_area();
    let force = load().load.unwrap_or(0.0);
    assert!(volume > 1.2 * force * last.distance, "the substrate wears faster: {volume}");
    Ok(())
}

/// The roller turns to its worn side: under a force off its middle, the tilt is found and force and moment hold.
#[test]
fn moments_hold_while_it_wears() -> Result<()> {
    let plan = line()?;
    let motion = load().with_eccentricity([None, Some(0.1)]);
    let wear = Wear::sliding([vec![1.0], vec![0.0]], 0.1).with_steps(ends(5, 0.1));
    let shape = Cylinder::new(RADIUS)?;
    for state in states(WearSession::new(Arc::clone(&plan), shape, motion, wear, false)?)? {
        near!(state.solution.eccentricity()[1], 0.1, 1e-9);
    }
    Ok(())
}

/// An automatic grid grows with the contact; the volume is kept to rounding.
#[test]
fn grids_grow_with_the_contact() -> Result<()> {
    let (body, shape) = (Elastic::new(1.0, 0.3)?.into(), Paraboloid::new(RADIUS, RADIUS)?);
    let motion = Motion::load(4.0 / (3.0 * 0.91 * RADIUS));
    let options = Options::default().with_cells(4096);
    let grid = choose_grid(&shape, &body, &Setup::default(), &motion, &options)?;
    let plan = Arc::new(Contact::plan(body, grid, Setup::default())?);
    let wear = Wear::sliding([vec![1.0], vec![0.0]], 16.0).with_steps(ends(8, 16.0));
    let wear = wear.with_scheme(WearScheme::Euler);
    let states = states(WearSession::new(plan, shape, motion, wear, true)?)?;
    let last = states.last().expect("a state");
    assert!(last.regrids > 0 && last.solution.grid().size()[0] > 1.4 * grid.size()[0]);
    let volume = last.depth[0].sum() * last.solution.grid().cell_area();
    near!(volume, 16.0 * motion.load.unwrap_or(0.0), 1e-12);
    Ok(())
}

/// Largest difference of two pressures, over the cells that are in contact with all their neighbours, and of their peaks.
pub(crate) fn apart_within(one: &Array2<f64>, other: &Array2<f64>) -> f64 {
    let (nx, ny) = one.dim();
    let carries = |i: usize, j: usize| one[[i, j]] > 0.0 && other[[i, j]] > 0.0;
    let around = |i: usize, n: usize| (i.max(1) - 1)..=(i + 1).min(n - 1);
    let within = one
        .indexed_iter()
        .filter(|((i, j), _)| around(*i, nx).all(|i| around(*j, ny).all(|j| carries(i, j))));
    let peaks = (largest(one) - largest(other)).abs();
    within.fold(peaks, |most, (at, p)| most.max((p - other[at]).abs()))
}

/// Thinner layers change the pressure; the estimate is that of the contact with a coat that is thinner by the depth.
#[test]
fn frozen_thickness_has_its_estimate() -> Result<()> {
    let plan = line()?;
    let even = Array2::from_elem([1, 96], 2e-5);
    // Of the coat, the pressure feels 1e-5: solves must be finer.
    let options = Options::default().with_tolerance(1e-14);
    let wear = Wear::sliding([vec![1.0], vec![0.0]], 0.0)
        .with_initial([even, Array2::zeros([1, 96])])
        .with_steps(WearSteps::Ends(Vec::new()))
        .with_options(options.clone());
    let mut session =
        WearSession::new(Arc::clone(&plan), Cylinder::new(RADIUS)?, load(), wear, false)?;
    let go_on = &mut |_: &nacre::Report| ControlFlow::Continue(());
    let state = session.advance(go_on)?.expect("the first state");
    let error = session.thickness_error(go_on)?.expect("a layer wears");
    let thin =
        HalfSpace::new(Elastic::new(1.0, 0.3)?, [Layer::new(Elastic::new(3.0, 0.3)?, 8e-5)?])?;
    let thin = Contact::plan(thin, *plan.grid(), Setup::default())?;
    let exact = thin.solve(&Cylinder::new(RADIUS)?, &load(), &options)?;
    let due = apart_within(&state.solution.pressure, &exact.pressure);
    near!(error, due / exact.peak_pressure().min(state.solution.peak_pressure()), 0.01);
    Ok(())
}

/// Given coefficients change by what exact ones do: those that are exact have the estimate of the bodies, to what a solve to 1e-8
/// leaves of the pressure.
#[test]
fn given_coefficients_have_the_estimate_of_the_thickness() -> Result<()> {
    let grid = Grid::line(96, 3.0)?;
    let exact = influence_coefficients(coated()?, &grid, Method::Exact)?;
    for thickness in [Thickness::Frozen, Thickness::FirstOrder] {
        let mut errors = [0.0; 2];
        for (error, coefficients) in
            errors.iter_mut().zip([None, Some(exact.clone().into_shared())])
        {
            let setup = Setup::default().with_coefficients(coefficients);
            let plan = Arc::new(Contact::plan(coated()?, grid, setup)?);
            let even = Array2::from_elem([1, 96], 3e-5);
            let wear = Wear::sliding([vec![1.0], vec![0.0]], 0.0)
                .with_initial([even, Array2::zeros([1, 96])])
                .with_steps(WearSteps::Ends(Vec::new()))
                .with_thickness(thickness);
            let mut session = WearSession::new(plan, Cylinder::new(RADIUS)?, load(), wear, false)?;
            let go_on = &mut |_: &nacre::Report| ControlFlow::Continue(());
            session.advance(go_on)?.expect("the first state");
            *error = session.thickness_error(go_on)?.expect("a layer wears");
        }
        near!(errors[1], errors[0], 1e-6, thickness);
    }
    Ok(())
}

/// Under even pressure p, a layer of thickness h is through after h/κp more, whatever wears below it, or does not.
#[test]
fn layers_are_through_where_even_pressure_says() -> Result<()> {
    let grid = Grid::new([2, 8], [0.5, 2.0])?.periodic([true; 2])?;
    let layer = |thickness| Layer::new(Elastic::new(3.0, 0.3)?, thickness);
    let body = HalfSpace::new(Elastic::new(1.0, 0.3)?, [layer(2e-4)?, layer(1e-4)?])?;
    let plan = Arc::new(Contact::plan(body, grid, Setup::default())?);
    let flat = HeightMap::new(Array2::zeros([2, 8]), grid.spacing())?;
    let pressure = 1e-3;
    // 2e-4/(1 · 1e-3) = 0.2, and 1e-4/(0.5 · 1e-3) = 0.2 after it; the stop layer never.
    for (rates, due) in [
        (vec![1.0, 0.5, 0.0], vec![0.2, 0.4]),
        (vec![1.0, 0.5, 10.0], vec![0.2, 0.4]),
        (vec![1.0, 0.0, 1.0], vec![0.2]),
        (vec![0.0, 0.5, 1.0], vec![]),
    ] {
        for scheme in [WearScheme::Euler, WearScheme::Trapezoidal] {
            let auto = WearSteps::Auto { end: 0.7, tolerance: 1e-3 };
            for steps in [ends(1, 0.7), ends(5, 0.7), auto] {
                let rates = [rates.clone(), vec![0.0]];
                let wear = Wear::sliding(rates, 0.7).with_steps(steps).with_scheme(scheme);
                let motion = Motion::load(pressure);
                let session =
                    WearSession::new(Arc::clone(&plan), flat.clone(), motion, wear, false)?;
                let states = states(session)?;
                let events: Vec<_> = states.iter().flat_map(|state| &state.through).collect();
                assert_eq!(events.len(), due.len());
                for (event, due) in events.iter().zip(&due) {
                    // A layer counts as through 1e-5 before.
                    near!(event.distance, *due, 1e-5);
                    below!((event.distance - due).abs(), event.error);
                    below!(event.error, 1e-4 * due);
                }
            }
        }
    }
    Ok(())
}

/// A depth that is given beyond a layer is an event at once, and the end of a history until then; a history that goes on knows it.
#[test]
fn layers_below_which_a_history_begins_are_through_at_once() -> Result<()> {
    let plan = line()?;
    for (goes_on, count, through) in [(false, 1, 1), (true, 2, 0)] {
        let initial = Some([Array2::from_elem([1, 96], 1.5e-4), Array2::zeros([1, 96])]);
        let wear = Wear::sliding([vec![1.0], vec![0.0]], 1e-3)
            .with_initial(initial)
            .with_goes_on(goes_on)
            .with_until_through(true)
            .with_steps(ends(1, 1e-3));
        let states = run(&plan, wear)?;
        assert_eq!((states.len(), states[0].through.len()), (count, through));
        assert!(states[0].through.iter().all(|event| event.distance <= 0.0 && event.layer == 0));
    }
    Ok(())
}

/// At a given approach, wear takes the load away, and steps get longer: the error counts relative to the largest pressure.
#[test]
fn histories_at_an_approach_end() -> Result<()> {
    let grid = Grid::new([16, 16], [4.0, 4.0])?;
    let plan = Arc::new(Contact::plan(Elastic::new(1.0, 0.3)?, grid, Setup::default())?);
    let motion = Motion::approach(1.0 / RADIUS);
    for scheme in [WearScheme::Euler, WearScheme::Trapezoidal] {
        let wear = Wear::sliding([vec![1.0], vec![0.0]], 1e12).with_scheme(scheme);
        let shape = Paraboloid::new(RADIUS, RADIUS)?;
        let states = states(WearSession::new(Arc::clone(&plan), shape, motion, wear, false)?)?;
        let last = states.last().expect("a state");
        near!(last.distance, 1e12, 1e-15);
        assert!(states.len() < 200, "{}", states.len());
        below!(last.solution.load(), 1e-6 * states[0].solution.load());
        // What the ball overlaps is worn off: π δ² R, on cells of a quarter.
        let volume = last.depth[0].sum() * grid.cell_area();
        near!(volume, PI / RADIUS, 0.02);
    }
    Ok(())
}

/// A ball that is worn flat carries F/2πRh everywhere, h = √(κsF/πR): no ring of new cells carries more.
#[test]
#[ignore = "slow"]
fn worn_balls_have_even_pressure() -> Result<()> {
    let grid = Grid::new([40, 40], [14.0, 14.0])?;
    let plan = Arc::new(Contact::plan(Elastic::new(1.0, 0.3)?, grid, Setup::default())?);
    let force = 4.0 / (3.0 * 0.91 * RADIUS);
    let distance = 500.0;
    let shape = Paraboloid::new(RADIUS, RADIUS)?;
    let wear = Wear::sliding([vec![1.0], vec![0.0]], distance);
    let states = states(WearSession::new(plan, shape, Motion::load(force), wear, false)?)?;
    assert!(states.len() < 100, "{}", states.len());
    for state in states.iter().filter(|state| state.distance > 0.1 * distance) {
        let even = (force / (4.0 * PI * RADIUS * state.distance)).sqrt();
        // Elasticity adds 1/κsE*, some 2 %, and a cell of 40 is 5 % of the area.
        near!(state.solution.peak_pressure(), even, 0.1, state.distance);
    }
    Ok(())
}

/// The work of a state is that of all solves of its step.
#[test]
fn states_count_the_convolutions_of_their_step() -> Result<()> {
    let plan = line()?;
    let wear = Wear::sliding([vec![1.0], vec![0.0]], 0.01).with_steps(ends(2, 0.01));
    let mut session = WearSession::new(plan, Cylinder::new(RADIUS)?, load(), wear, false)?;
    session.advance(&mut |_| ControlFlow::Continue(()))?;
    let mut told: Vec<f64> = Vec::new();
    let state = session.advance(&mut |report: &nacre::Report| {
        if report.iterations == 0 {
            told.push(0.0);
        }
        if let Some(last) = told.last_mut() {
            *last = report.convolutions;
        }
        ControlFlow::Continue(())
    })?;
    let count = state.expect("a step").solution.report.convolutions;
    // The step and its halves; after the last iteration of a solve come four convolutions at most.
    assert_eq!(told.len(), 3);
    let told: f64 = told.iter().sum();
    assert!(count >= told && count <= told + 12.0, "{count} {told}");
    Ok(())
}

#[test]
fn wrong_input_is_refused() -> Result<()> {
    let plan = line()?;
    let message = |wear: Wear| {
        let session =
            WearSession::new(Arc::clone(&plan), Cylinder::new(RADIUS)?, load(), wear, false);
        Ok::<_, nacre::Error>(session.err().map_or_else(String::new, |error| error.to_string()))
    };
    let plain = || Wear::sliding([vec![1.0], vec![0.0]], 1.0);
    let shape = plan.grid().shape();
    let one = |value: f64| Array2::from_elem(shape, value);
    for (wear, due) in [
        (Wear::sliding([vec![-1.0], vec![0.0]], 1.0), "rate must be finite and at least 0, got -1"),
        (
            Wear::sliding([vec![1.0; 3], vec![0.0]], 1.0),
            "rate must be as many as layers, and one for the substrate, got 3",
        ),
        (
            Wear::sliding([vec![1.0], vec![f64::NAN]], 1.0),
            "counter_rate must be finite and at least 0, got NaN",
        ),
        (
            Wear::sliding([vec![1.0], vec![0.0]], -2.0),
            "sliding must be finite and at least 0, got -2",
        ),
        (plain().with_slip(Slip::Cells(one(0.0))), "slip must be above 0 somewhere"),
        (plain().with_slip(Slip::Cells(one(-1.0))), "slip must"),
        (
            plain().with_slip(Slip::Cells(Array2::zeros([2, 2]))),
            "slip: expected shape [1, 96], got [2, 2]",
        ),
        (
            plain().with_steps(WearSteps::Ends(vec![1.0, 0.5])),
            "steps must be finite, above 0 and increasing, got 0.5",
        ),
        (plain().with_steps(WearSteps::Auto { end: 1.0, tolerance: 2.0 }), "step_tolerance must"),
        (plain().with_initial([one(-1.0), one(0.0)]), "initial must"),
        (
            plain().with_options(Options::default().with_hardness(Hardness::Uniform(1.0))),
            "wear has neither hardness nor compliance: leave them out",
        ),
    ] {
        let found = message(wear)?;
        assert!(found.starts_with(due), "{found:?}, due {due:?}");
    }
    Ok(())
}
