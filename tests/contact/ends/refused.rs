//! Ends that cannot be, and ends for which there is only a model.

use std::ops::ControlFlow;

use nacre::contact::{Report, solve_watched};
use nacre::{
    Body, Contact, Elastic, Error, Grid, HalfSpace, HeightMap, Layer, Motion, Options, Result,
    Roller, Setup, Substrate, Surface, Warning,
};
use ndarray::Array2;

use super::{BOTH, LOAD, straight, unit};
use crate::support::messages::message;

/// A coat warns of its model.
#[test]
fn coated_ends_are_warned_of() -> Result<()> {
    let coat = Layer::new(Elastic::new(2.0, 0.3)?, 0.2)?;
    let coated = HalfSpace::new(Elastic::new(1.0, 0.3)?, [coat])?.with_ends(BOTH)?;
    let solution = straight([&coated, &unit(0.3, BOTH)?], &Motion::load(LOAD))?;
    assert_eq!(solution.report.warnings, [Warning::CoatedEnd]);
    assert_eq!(
        solution.report.free_ends().and_then(|ends| ends.error),
        Some(0.04)
    );
    Ok(())
}

#[test]
fn senseless_ends_are_refused() -> Result<()> {
    let steel = || Elastic::new(210e9, 0.3).map(HalfSpace::from);
    let crossed = message(steel()?.with_ends([Some(1.0), Some(-1.0)]));
    assert!(
        crossed.contains("ends") && crossed.contains("ascending"),
        "{crossed}"
    );
    assert!(message(steel()?.with_ends([Some(f64::NAN), None])).contains("finite"));
    let coat = Layer::new(Elastic::new(1.0, 0.3)?, 1.0)?;
    let rigid = HalfSpace::new(Substrate::Rigid, [coat])?.with_ends([Some(0.0), None]);
    assert!(message(rigid).contains("rigid substrate"));

    let grid = Grid::new([8, 8], [8.0, 8.0])?;
    let at = |low: f64, high: f64| -> Result<Contact> {
        Contact::plan(
            steel()?.with_ends([Some(low), Some(high)])?,
            grid,
            Setup::default(),
        )
    };
    let off = message(at(-1.3, 3.0));
    assert!(
        off.contains("-1.3e0 between the edges -2e0 and -1e0"),
        "{off}"
    );
    assert!(message(at(0.0, 1.0)).contains("two rows"));
    assert!(at(0.0, 2.0).is_ok() && at(-40.3, 17.7).is_ok());
    let line = Contact::plan(
        steel()?.with_ends([Some(0.0), None])?,
        Grid::line(8, 8.0)?,
        Setup::default(),
    );
    assert!(message(line).contains("line contact"));

    // The roller's material ends within the roller.
    let setup = Setup {
        counterbody: Some(steel()?.with_ends([Some(-4e-3), Some(5e-3)])?.into()),
        ..Setup::default()
    };
    let roller = Roller::new(5e-3, 6e-3, 2.0)?.with_length(10e-3)?;
    let motion = Motion::load(10.0);
    let contact = Contact::plan(steel()?, Grid::new([20, 8], [10e-3, 1e-3])?, setup.clone())?;
    let short = contact.solve(&roller, &motion, &Options::default());
    assert!(
        matches!(short, Err(Error::EndWithinShape { .. })),
        "{short:?}"
    );
    let mut go_on = |_: &Report| ControlFlow::Continue(());
    let body = Body::from(&steel()?);
    let options = Options::default();
    let short = solve_watched(&roller, &body, &setup, &motion, &options, &mut go_on);
    assert!(matches!(short, Err(Error::EndWithinShape { .. })));
    let map = HeightMap::new(Array2::zeros((8, 8)), [1e-4, 1e-4])?;
    let within = Contact::plan(
        steel()?.with_ends([Some(-0.23e-4), None])?,
        map.grid().expect("a map has a grid"),
        Setup::default(),
    );
    assert!(matches!(within, Err(Error::EndOffGrid { .. })));
    Ok(())
}
