//! Layers that get thinner as they wear, to first order in the depth.

use std::f64::consts::PI;
use std::ops::ControlFlow;
use std::sync::Arc;

use nacre::wear::{Thickness, Wear, WearSession, WearState, WearSteps};
use nacre::{
    Contact, Elastic, Grid, HalfSpace, Layer, Motion, Options, Paraboloid, Result, Setup, Solution,
};
use ndarray::Array2;

use super::histories::apart_within;
use super::waves::states;
use crate::support::checks::{apart, largest};

/// As blunt as the approach is shallow: a paraboloid of 2 half-widths wears by a part of the thickness within the grid.
const RADIUS: f64 = 2.0;
/// Half of the half-width 1 of the bare body.
const THICKNESS: f64 = 0.5;

fn coated(thickness: f64) -> Result<HalfSpace> {
    HalfSpace::new(Elastic::new(1.0, 0.3)?, [Layer::new(Elastic::new(3.0, 0.3)?, thickness)?])
}

/// Hertz's loads of a half-width of 1 on the bare body: π E*/4R and 4 E*/3R.
fn contacts() -> Result<[(Grid, Motion); 2]> {
    let modulus = 1.0 / 0.91;
    Ok([
        (Grid::line(128, 3.0)?, Motion::load(PI * modulus / (4.0 * RADIUS))),
        (Grid::new([48, 48], [3.0, 3.0])?, Motion::load(4.0 * modulus / (3.0 * RADIUS))),
    ])
}

/// The contact after even wear, and what its thickness costs.
fn even(
    (grid, motion): (Grid, Motion),
    depth: f64,
    thickness: Thickness,
) -> Result<(Solution, Option<f64>)> {
    let plan = Arc::new(Contact::plan(coated(THICKNESS)?, grid, Setup::default())?);
    let initial = [depth, 0.0].map(|depth| Array2::from_elem(grid.shape(), depth));
    let wear = Wear::sliding([vec![1.0], vec![0.0]], 0.0)
        .with_initial(initial)
        .with_steps(WearSteps::Ends(Vec::new()))
        .with_thickness(thickness);
    let shape = Paraboloid::new(RADIUS, RADIUS)?;
    let mut session = WearSession::new(plan, shape, motion, wear, false)?;
    let go_on = &mut |_: &nacre::Report| ControlFlow::Continue(());
    let state = session.advance(go_on)?.expect("the first state");
    assert!(session.advance(go_on)?.is_none());
    Ok((state.solution, session.thickness_error(go_on)?))
}

/// Of a coat that is evenly thinner by 5 to 40 %, the peak under a roller is within 0.3 % to first order; as thick as before it
/// errs by 1.7 to 11.4 %. Under a ball, it is 0.1 to 1.5 % and 3 to 24 %. The estimates are the errors within the contact.
#[test]
fn even_wear_is_a_thinner_coat() -> Result<()> {
    let frozen_errors = [(0.05, 0.017), (0.1, 0.033), (0.2, 0.064), (0.4, 0.114)];
    for (place, contact) in contacts()?.into_iter().enumerate() {
        for (part, due) in frozen_errors {
            let (grid, motion) = contact;
            let thin = coated(THICKNESS * (1.0 - part))?;
            let exact = Contact::plan(thin, grid, Setup::default())?.solve(
                &Paraboloid::new(RADIUS, RADIUS)?,
                &motion,
                &Options::default(),
            )?;
            let error =
                |solution: &Solution| solution.peak_pressure() / exact.peak_pressure() - 1.0;
            let [(frozen, of_frozen), (first, of_first)] =
                [Thickness::Frozen, Thickness::FirstOrder]
                    .map(|thickness| even(contact, THICKNESS * part, thickness))
                    .into_iter()
                    .collect::<Result<Vec<_>>>()?
                    .try_into()
                    .expect("two");
            if place == 0 {
                below!(error(&first).abs(), 0.003, part);
                // Two digits, of cells of another length.
                below!((error(&frozen) - due).abs(), 0.001, part);
            } else {
                // What is left is of second order.
                below!(error(&first).abs(), 0.4 * part.powi(2), part);
                assert!(error(&frozen) > 0.55 * part, "{part}");
            }
            for (solution, estimate) in [(frozen, of_frozen), (first, of_first)] {
                let due = apart_within(&solution.pressure, &exact.pressure);
                // Solves to 1e-8, of whose pressure the root counts.
                let peak = solution.peak_pressure().min(exact.peak_pressure());
                let rest = (estimate.expect("a layer wears") - due / peak).abs();
                below!(rest, 3e-4, part);
            }
        }
    }
    Ok(())
}

/// The state after a step solves the contact of the worn shape on layers that are thinner by its own depth: the same state as a
/// start has the same pressure. Frozen layers do not.
#[test]
fn steps_end_on_contacts_of_their_own_thickness() -> Result<()> {
    let end = 0.3 * THICKNESS;
    for (grid, motion) in contacts()? {
        let plan = Arc::new(Contact::plan(coated(THICKNESS)?, grid, Setup::default())?);
        let shape = Paraboloid::new(RADIUS, RADIUS)?;
        let options = Options::default().with_tolerance(1e-10);
        let run = |wear: Wear| -> Result<Vec<WearState>> {
            let wear = wear.with_thickness(Thickness::FirstOrder).with_options(options.clone());
            states(WearSession::new(Arc::clone(&plan), shape, motion, wear, false)?)
        };
        // Pressures are some 0.3: the coat loses a third of its thickness.
        let distance = end / 0.3;
        let steps = (1..=4).map(|k| distance * f64::from(k) / 4.0).collect();
        let wear = Wear::sliding([vec![1.0], vec![0.0]], distance);
        let history = run(wear.clone().with_steps(WearSteps::Ends(steps)))?;
        let last = history.last().expect("a state");
        assert!((0.1..0.6).contains(&(largest(&last.depth[0]) / THICKNESS)));
        let again =
            run(wear.with_initial(last.depth.clone()).with_steps(WearSteps::Ends(Vec::new())))?;
        let peak = last.solution.peak_pressure();
        // The depth in the contact lags by up to 1e-4 of the thickness; a solve's error is the root of its tolerance.
        below!(apart(&last.solution.pressure, &again[0].solution.pressure), 2e-4 * peak);
        let dented = options.clone().with_indentation(last.depth[0].clone());
        let frozen = plan.solve(&shape, &motion, &dented)?;
        assert!(apart(&last.solution.pressure, &frozen.pressure) > 2e-3 * peak);
    }
    Ok(())
}

#[test]
fn what_has_no_thinner_layers_is_refused() -> Result<()> {
    let wear = || Wear::sliding([vec![1.0], vec![0.0]], 1.0).with_thickness(Thickness::FirstOrder);
    let message = |body: HalfSpace, grid: Grid| -> Result<String> {
        let plan = Arc::new(Contact::plan(body, grid, Setup::default())?);
        let shape = Paraboloid::new(RADIUS, RADIUS)?;
        let session = WearSession::new(plan, shape, Motion::load(0.1), wear(), false);
        Ok(session.err().map_or_else(String::new, |error| error.to_string()))
    };
    let grid = Grid::new([16, 16], [3.0, 3.0])?;
    let ended = coated(THICKNESS)?.with_ends([None, Some(1.125)])?;
    assert!(
        message(ended, grid)?
            .starts_with("thickness must be \"frozen\" for layered bodies with free ends")
    );
    let half = grid.periodic([true, false])?;
    assert!(
        message(coated(THICKNESS)?, half)?
            .starts_with("thickness must be \"frozen\" on a grid that is periodic")
    );
    Ok(())
}

/// Depths that the pressure expected at the end of a step gives are those of its end to a ten-thousandth of the thickness, but in
/// cells that have just come into contact: a step is solved once.
#[test]
fn steps_of_thinner_layers_are_solved_once() -> Result<()> {
    let (grid, motion) = contacts()?[1];
    let plan = Arc::new(Contact::plan(coated(THICKNESS)?, grid, Setup::default())?);
    // A tenth of the coat where the pressure is largest, in twenty steps.
    let end = 0.1 * THICKNESS;
    let wear = Wear::sliding([vec![1.0], vec![0.0]], end)
        .with_steps(WearSteps::Ends((1..=20).map(|k| end * f64::from(k) / 20.0).collect()))
        .with_thickness(Thickness::FirstOrder);
    let shape = Paraboloid::new(RADIUS, RADIUS)?;
    let mut session = WearSession::new(plan, shape, motion, wear, false)?;
    let mut solves = Vec::new();
    loop {
        let mut count = 0;
        let state = session.advance(&mut |report: &nacre::Report| {
            count += usize::from(report.iterations == 0);
            ControlFlow::Continue(())
        })?;
        if state.is_none() {
            break;
        }
        solves.push(count);
    }
    // Before the second step, nothing tells how the pressure changes. Two halves tell the error of each.
    assert_eq!(solves[3..], [3; 18], "{solves:?}");
    Ok(())
}
