//! The end of fretting: where a zone sticks and the rest wears until it carries nothing.
//!
//! `tests/data/wear/fretting_limit.json`, closed forms.

use std::f64::consts::PI;
use std::ops::ControlFlow;
use std::sync::Arc;

use nacre::friction::{FrictionOptions, Rolling, RollingDirection, Step};
use nacre::wear::{Idle, Slip, Wear, WearScheme, WearSession, WearState, WearSteps};
use nacre::{Contact, Elastic, Grid, Motion, Paraboloid, Result, Setup};
use ndarray::Array2;

use super::waves::states;
use crate::support::reference::{list, number, read};

/// So large that a circle is a parabola. Pressures, loads and depths of the reference are divided by it.
const RADIUS: f64 = 1e3;

/// Cells by which constant pressures on cells act as a narrower zone at a straight edge of infinite pressure: 1/4 − Σ k bₖ, with
/// the Fourier coefficients bₖ of the logarithm of the cells' compliance times 2 |sin(θ/2)|, by Wiener and Hopf.
const STRAIGHT_EDGE: f64 = 0.1747;

/// The same of the steps of a circle of square cells, of equal area: of dense solves on six grids and four radii.
const ROUND_EDGE: f64 = 0.12;

/// The worn contact on a grid, where cells within `stick` do not slip.
fn worn(grid: Grid, stick: f64, motion: Motion) -> Result<WearState> {
    let (x, y) = (grid.x(), grid.y());
    let slip = Array2::from_shape_fn(grid.shape(), |(i, j)| {
        let along = if grid.is_line() { 0.0 } else { x[i] };
        f64::from(along.hypot(y[j]) > stick)
    });
    let plan = Arc::new(Contact::plan(Elastic::new(1.0, 0.0)?, grid, Setup::default())?);
    // What is left of the pressure outside is a part 1/κΔs each time.
    let ends = [1.0, 1e2, 1e4, 1e9];
    let wear = Wear::sliding([vec![1.0], vec![0.0]], 1e9)
        .with_slip(Slip::Cells(slip))
        .with_steps(WearSteps::Ends(ends.to_vec()))
        .with_scheme(WearScheme::Euler);
    let shape = Paraboloid::new(RADIUS, RADIUS)?;
    let mut states = states(WearSession::new(plan, shape, motion, wear, false)?)?;
    Ok(states.pop().expect("a state"))
}

#[test]
fn cylinders_end_on_their_stick_zone() -> Result<()> {
    let rows = read("wear/fretting_limit.json");
    for row in list(&rows, "rows").iter().filter(|row| row["shape"] == "cylinder") {
        let number = |key| number(row, key);
        // As many cells in half of the zone as let the grid hold all that wears.
        let cells = (127.0 * number("c") / number("outer")).floor();
        let grid = Grid::line(256, 256.0 * number("c") / (cells - STRAIGHT_EDGE))?;
        let stick = cells * grid.spacing()[1];
        let state = worn(grid, stick, Motion::load(number("load") / RADIUS))?;
        let pressure = &state.solution.pressure;
        let (middle, peak) = (pressure[[0, 128]], state.solution.peak_pressure());
        near!(middle * RADIUS, number("p_centre"), 0.01, row);
        near!(state.depth[0].sum() * grid.cell_area() * RADIUS, number("worn"), 0.01, row);
        let y = grid.y();
        for ((_, j), p) in pressure.indexed_iter() {
            assert!(y[j].abs() < stick || *p < 1e-8 * peak, "{p:e}");
        }
        // What is worn off closes the gap: as much as the pressure in it is known to.
        for (depth, gap) in state.depth[0].iter().zip(state.solution.gap()) {
            assert!(*depth <= 0.0 || gap.abs() < 1e-6 / RADIUS, "{gap:e}");
        }
    }
    Ok(())
}

/// A grid of 128² cells that holds all that wears, and the radius of a circle of cells on it which acts as one of radius `c`.
fn round(c: f64, outer: f64) -> Result<(Grid, f64)> {
    for wider in 0..200 {
        let size = outer * (2.05 + 0.002 * f64::from(wider));
        let grid = Grid::new([128, 128], [size, size])?;
        let (x, y, spacing) = (grid.x(), grid.y(), grid.spacing()[0]);
        let stick = c + ROUND_EDGE * spacing;
        let pairs = x.iter().flat_map(|x| y.iter().map(move |y| x.hypot(*y)));
        let area = pairs.filter(|r| *r <= stick).count() as f64 * grid.cell_area();
        if ((area / PI).sqrt() - stick).abs() < 0.01 * spacing {
            return Ok((grid, stick));
        }
    }
    unreachable!("some circle of cells has the area")
}

#[test]
#[ignore = "slow"]
fn balls_end_on_their_stick_zone() -> Result<()> {
    let rows = read("wear/fretting_limit.json");
    for row in list(&rows, "rows").iter().filter(|row| row["shape"] == "ball") {
        let number = |key| number(row, key);
        if (number("approach") - 1.0).abs() > 1e-9 {
            continue;
        }
        let (grid, stick) = round(number("c"), number("outer"))?;
        let state = worn(grid, stick, Motion::approach(1.0 / RADIUS))?;
        let (middle, area) = (state.solution.pressure[[64, 64]], grid.cell_area());
        near!(middle * RADIUS, number("p_centre"), 0.012, row);
        near!(state.depth[0].sum() * area * RADIUS, number("worn"), 0.02, row);
    }
    Ok(())
}

/// While friction is solved, `progress` is asked at each iteration whether to go on, and told of the contact before.
#[test]
fn friction_stops_where_it_is_told_to() -> Result<()> {
    let ball = Paraboloid::new(RADIUS, RADIUS)?;
    let motion = Motion::load(4.0 / (3.0 * RADIUS));
    let steel = Elastic::new(1.0, 0.0)?;
    let setup = Setup::default().with_counterbody(steel);
    let plan = Arc::new(Contact::plan(steel, Grid::new([32, 32], [4.0, 4.0])?, setup)?);
    let options = FrictionOptions::default();
    let pull = |part: f64| {
        Step::press(motion, 0.3).with_force([Some(0.15 * part * motion.load.unwrap_or(0.0)), None])
    };
    let rolling =
        Rolling::new(motion, 0.3, RollingDirection::PlusX).with_creepage([Some(1e-4), None]);
    for slip in
        [Slip::Cycle(vec![pull(1.0), pull(-1.0)], options), Slip::Pass(Box::new(rolling), options)]
    {
        let wear = Wear::sliding([vec![1e-3], vec![0.0]], 1.0)
            .with_slip(slip)
            .with_steps(WearSteps::Ends(vec![1.0]));
        let mut session = WearSession::new(Arc::clone(&plan), ball, motion, wear, false)?;
        let first = session.advance(&mut |_| ControlFlow::Continue(()))?.expect("a state");
        let mut calls = 0;
        let stopped = session.advance(&mut |report| {
            assert_eq!(*report, first.solution.report);
            calls += 1;
            if calls < 3 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
        })?;
        assert!(stopped.is_none());
        assert_eq!(calls, 3);
    }
    Ok(())
}

/// A cylinder between equal bodies, of half-width 1, and its load.
fn pair() -> Result<(Arc<Contact>, Motion)> {
    let steel = Elastic::new(1.0, 0.0)?;
    let setup = Setup::default().with_counterbody(steel);
    let plan = Arc::new(Contact::plan(steel, Grid::line(64, 3.0)?, setup)?);
    Ok((plan, Motion::load(PI / (8.0 * RADIUS))))
}

/// The first of the steps that are chosen wears a fiftieth of the approach, whatever a cell slips in a cycle or a pass: the deepest
/// cell is not that of the largest work alone, and a step that errs too much is cut to a fifth.
#[test]
fn chosen_steps_begin_with_the_slip_that_there_is() -> Result<()> {
    let (plan, motion) = pair()?;
    let load = motion.load.unwrap_or(0.0);
    let options = FrictionOptions::default();
    let pull = |part: f64| Step::press(motion, 0.6).with_force([None, Some(0.3 * part * load)]);
    let rolling =
        Rolling::new(motion, 0.3, RollingDirection::PlusY).with_creepage([Some(1e-4), None]);
    for slip in
        [Slip::Cycle(vec![pull(1.0), pull(-1.0)], options), Slip::Pass(Box::new(rolling), options)]
    {
        let wear = Wear::sliding([vec![1e-6], vec![0.0]], 1e30).with_slip(slip);
        let shape = Paraboloid::new(RADIUS, RADIUS)?;
        let mut session = WearSession::new(Arc::clone(&plan), shape, motion, wear, false)?;
        let go_on = &mut |_: &nacre::Report| ControlFlow::Continue(());
        let first = session.advance(go_on)?.expect("a state");
        let next = session.advance(go_on)?.expect("a step");
        let deepest = next.depth[0].fold(0.0_f64, |most, depth| most.max(*depth));
        let part = deepest / first.solution.displacement.fold(0.0_f64, |most, u| most.max(u.abs()));
        assert!(part > 0.2 * 0.02 && part < 1.5 * 0.02, "{part:e}");
    }
    Ok(())
}

/// A path that does not lead back slips the first time alone, and a small force on coarse cells nowhere; a cycle that slips wears.
#[test]
fn cycles_say_why_they_wear_nothing() -> Result<()> {
    let (plan, motion) = pair()?;
    let load = motion.load.unwrap_or(0.0);
    let press = Step::press(motion, 0.6);
    let pull = |part: f64| press.clone().with_force([None, Some(part * load)]);
    let push = |shift: f64| press.clone().with_shift([None, Some(shift)]);
    for (steps, due) in [
        (vec![pull(0.3), pull(-0.3)], None),
        (vec![pull(0.3)], Some(Idle::DoesNotReturn)),
        (vec![push(1.0)], Some(Idle::DoesNotReturn)),
        // The outermost cells carry a hundredth of the load and more.
        (vec![pull(1e-6), pull(-1e-6)], Some(Idle::Sticks)),
    ] {
        let wear = Wear::sliding([vec![1e-3], vec![0.0]], 1.0)
            .with_slip(Slip::Cycle(steps, FrictionOptions::default()))
            .with_steps(WearSteps::Ends(vec![1.0]));
        let shape = Paraboloid::new(RADIUS, RADIUS)?;
        let session = WearSession::new(Arc::clone(&plan), shape, motion, wear, false)?;
        let states = states(session)?;
        assert_eq!(states[1].idle, due);
        assert_eq!(states[0].idle, None);
    }
    Ok(())
}
