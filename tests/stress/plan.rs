//! A plan gives the bits of separate calls, for any options, in any order and from several threads, and
//! needs nothing of what it was made from.

use std::ops::ControlFlow;
use std::thread;

use nacre::stress::{Strengths, StressSummary};
use nacre::{
    Contact, Elastic, Grid, HalfSpace, Interface, Layer, Member, Motion, Options, Paraboloid,
    Result, Section, Setup, Solution, Stress, StressOptions, StressPlan, stress,
};
use ndarray::Array2;

use crate::support::stresses::{bits, displaced, sliding};

/// At the surface and at a tenth of a cell pressure within cells is felt, deeper it is not.
const DEPTHS: [f64; 3] = [0.0, 0.004, 0.3];

fn coated() -> Result<HalfSpace> {
    let coating = Layer::new(Elastic::new(4.0, 0.25)?, 0.2)?;
    HalfSpace::new(Elastic::new(1.0, 0.3)?, [coating])
}

fn grid() -> Result<Grid> {
    Grid::new([63, 58], [3.0, 2.6])
}

/// A coated body under a homogeneous one.
fn solution() -> Result<Solution> {
    let setup = Setup::default().with_counterbody(HalfSpace::from(Elastic::new(2.0, 0.3)?));
    let contact = Contact::plan(coated()?, grid()?, setup)?;
    contact.solve(&Paraboloid::new(1.2e3, 1e3)?, &Motion::load(1e-3), &Options::default())
}

/// Options that need different kernels, fields and sections.
fn options() -> [StressOptions; 4] {
    let frictionless = StressOptions::default();
    let sliding = displaced(sliding(0.3, [1.0, -2.0]));
    let along = StressOptions::default()
        .with_friction(0.1)
        .with_direction([1.0, 0.0])
        .with_section(Section::X(0.1));
    let residual = StressOptions::default()
        .with_residual(vec![-0.2, 0.1])
        .with_section(Section::Axis([0.02, 0.0]))
        .with_displacement(true);
    [frictionless, sliding, along, residual]
}

fn on_threads(count: usize) -> StressOptions {
    StressOptions::default().with_threads(count)
}

fn assert_same(field: &Stress, expected: &Stress, options: &StressOptions) {
    assert!(field == expected && bits(field) == bits(expected), "{options:?}");
}

fn summary(plan: &StressPlan, options: &StressOptions) -> Result<StressSummary> {
    plan.summary(&Strengths::default(), options)
}

/// Friction comes between frictionless evaluations, so that what it plans is seen to change nothing.
#[test]
#[ignore = "slow"]
fn a_plan_gives_the_bits_of_separate_calls() -> Result<()> {
    let solution = solution()?;
    for member in [Member::Body, Member::Counterbody] {
        let plan = solution.stress_plan(member, &on_threads(2))?;
        assert_eq!(plan.body(), solution.member(member)?);
        for options in options().iter().chain(&options()) {
            // A homogeneous body has no second layer for a residual stress.
            let mut options = options.clone();
            options.residual.truncate(plan.body().layers().len() + 1);
            let separate = solution.stress(&DEPTHS, member, &options)?;
            assert_same(&plan.stress(&DEPTHS, &options)?, &separate, &options);
        }
        let sliding = &options()[1];
        let separate = solution.stress_summary(member, &Strengths::default(), sliding)?;
        assert_eq!(summary(&plan, sliding)?, separate);
    }
    Ok(())
}

/// At a point nothing but the sum over the loaded cells is evaluated: at cell centres what a plane gives there, to the
/// rounding of 3654 cells. Between centres stresses are those of the point (`tests/stress/edge.rs`), and displacements are
/// interpolated. At the border of the grid, in and beside the contact, where pressure within cells is felt.
#[test]
#[ignore = "slow"]
fn a_point_has_the_stress_of_its_plane() -> Result<()> {
    const ROUNDING: f64 = 1e-12;
    let solution = solution()?;
    let peak = solution.peak_pressure();
    let [x, y] = [solution.grid().x(), solution.grid().y()];
    let [dx, dy] = solution.grid().spacing();
    for options in options() {
        let plane = options.clone().with_section(Section::Plane);
        let plane = solution.stress(&DEPTHS, Member::Body, &plane)?;
        for [i, j, along, across] in [[31, 29, 0, 0], [12, 28, 1, 1], [0, 57, 0, 0], [50, 20, 1, 0]]
        {
            let [u, v] = [along, across].map(|part| 0.25 * part as f64);
            let point = options.clone().with_section(Section::Axis([x[i] + u * dx, y[j] + v * dy]));
            let point = solution.stress(&DEPTHS, Member::Body, &point)?;
            let stresses = if along + across == 0 { 6 } else { 0 };
            let pairs = point.components.iter().zip(&plane.components).take(stresses);
            let moved = [&point, &plane].map(|field| field.displacement.iter().flatten());
            let [a, b] = moved;
            for (found, plane) in pairs.chain(a.zip(b)) {
                for k in 0..DEPTHS.len() {
                    let at = |a: usize, b: usize| plane[[k, i + a * along, j + b * across]];
                    let row = |a: usize| at(a, 0) + v * (at(a, 1) - at(a, 0));
                    let expected = row(0) + u * (row(1) - row(0));
                    let error = found[[k, 0, 0]] - expected;
                    assert!(error.abs() < ROUNDING * peak, "{i} {j} {k}: {error:e}");
                }
            }
        }
    }
    Ok(())
}

#[test]
fn friction_on_the_counterbody_is_opposite() -> Result<()> {
    let plan = solution()?.stress_plan(Member::Counterbody, &StressOptions::default())?;
    let options = sliding(0.5, [0.0, 2.0]);
    // Signed zeros are equal; halves are exact.
    let [x, y] = plan.stress(&[0.1], &options)?.friction;
    assert!(x.abs() < f64::EPSILON && (y + 0.5).abs() < f64::EPSILON);
    Ok(())
}

/// The body, the pressure and the solution are dropped before the plan is evaluated: it holds its own
/// reconstruction and cannot make another.
#[test]
fn a_plan_outlives_what_it_was_made_from() -> Result<()> {
    let options = &options()[1];
    let (plan, expected) = {
        let solution = solution()?;
        let expected = solution.stress(&DEPTHS, Member::Body, options)?;
        (solution.stress_plan(Member::Body, options)?, expected)
    };
    assert_same(&plan.stress(&DEPTHS, options)?, &expected, options);
    let (plan, expected) = {
        let (body, grid) = (coated()?, grid()?);
        let pressure = Array2::from_shape_fn((63, 58), |(i, j)| f64::from((i * j % 7) as u8));
        let expected = stress(&body, &grid, &pressure, &DEPTHS, options)?;
        (StressPlan::plan(&body, &grid, &pressure, None)?, expected)
    };
    assert_same(&plan.stress(&DEPTHS, options)?, &expected, options);
    Ok(())
}

/// One plan, shared by threads that ask for different options at once: the first evaluation with
/// friction plans its part while others run.
#[test]
fn threads_share_a_plan() -> Result<()> {
    let plan = &solution()?.stress_plan(Member::Body, &on_threads(2))?;
    let evaluate = |options: StressOptions| plan.stress(&DEPTHS, &options);
    let fields: Vec<_> = thread::scope(|scope| {
        let calls = options().map(|options| scope.spawn(move || evaluate(options)));
        calls.into_iter().map(thread::ScopedJoinHandle::join).collect()
    });
    for (field, options) in fields.into_iter().zip(options()) {
        let Ok(field) = field else { panic!("an evaluation panicked") };
        assert_same(&field?, &plan.stress(&DEPTHS, &options)?, &options);
    }
    Ok(())
}

/// A plan does not reconstruct the pressure again: the first thing that an evaluation reports is its
/// first plane. A break leaves the depths finished before.
#[test]
fn an_evaluation_goes_straight_to_its_planes() -> Result<()> {
    let plan = solution()?.stress_plan(Member::Body, &StressOptions::default())?;
    let options = StressOptions::default();
    let mut told = Vec::new();
    let mut progress = |part: f64| {
        told.push(part);
        ControlFlow::Continue(())
    };
    plan.stress(&DEPTHS, options.watched(&mut progress))?;
    // Six components by three at a time on three planes, and the end.
    assert_eq!(told.len(), 2 * DEPTHS.len() + 1);
    assert!(told.is_sorted());
    let mut stop = |part: f64| match part {
        part if part < 0.5 => ControlFlow::Continue(()),
        _ => ControlFlow::Break(()),
    };
    let field = plan.stress(&DEPTHS, options.watched(&mut stop))?;
    assert_eq!(field.components[0].dim(), (1, 63, 58));
    assert_eq!(field.z.as_slice(), Some(&DEPTHS[..1]));
    Ok(())
}

#[test]
fn planning_stops_when_told() -> Result<()> {
    let mut stop = |part: f64| {
        assert!(part.abs() < f64::EPSILON);
        ControlFlow::Break(())
    };
    let options = StressOptions::default();
    let stopped = solution()?.stress_plan(Member::Body, options.watched(&mut stop));
    assert!(matches!(stopped, Err(nacre::Error::Stopped)));
    Ok(())
}

/// A plan of a body with a frictionless layer is made, and refuses friction.
#[test]
fn bad_input_is_refused() -> Result<()> {
    let grid = Grid::new([4, 4], [1.0, 1.0])?;
    let body: HalfSpace = Elastic::new(1.0, 0.3)?.into();
    assert!(StressPlan::plan(&body, &grid, &Array2::zeros((4, 3)), None).is_err());
    assert!(StressPlan::plan(&body, &grid, &Array2::from_elem((4, 4), f64::NAN), None).is_err());
    assert!(StressPlan::plan(&body, &grid, &Array2::zeros((4, 4)), Some(0)).is_err());
    let layer = Layer::new(Elastic::new(4.0, 0.25)?, 0.2)?.with_interface(Interface::Frictionless);
    let slipping = HalfSpace::new(Elastic::new(1.0, 0.3)?, [layer])?;
    let plan = StressPlan::plan(&slipping, &grid, &Array2::zeros((4, 4)), None)?;
    let sliding = StressOptions::default().with_friction(0.1);
    assert!(plan.stress(&[0.0], &sliding).is_err());
    assert!(summary(&plan, &sliding).is_err());
    assert!(plan.stress(&[-1.0], &StressOptions::default()).is_err());
    Ok(())
}
