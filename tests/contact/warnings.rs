//! Warnings stand where they must, and not elsewhere.

use nacre::contact::solve_with;
use nacre::{
    Axis, Elastic, FlatPunch, Grid, HeightMap, Motion, Options, Paraboloid, Result, Roller, Setup,
    Sphere, Surface, Warning,
};
use ndarray::Array2;

use crate::support::settings::{plan, pressed};

/// Cells along a side of the grid, of unit length.
const CELLS: usize = 96;

fn grid() -> Result<Grid> {
    Grid::new([CELLS; 2], [CELLS as f64; 2])
}

fn warnings(shape: &dyn Surface, motion: &Motion) -> Result<Vec<Warning>> {
    let contact = plan(Elastic::new(1.0, 0.0)?, grid()?)?;
    Ok(pressed(&contact, shape, motion)?.report.warnings)
}

fn kinds(shape: &dyn Surface, motion: &Motion) -> Result<Vec<&'static str>> {
    Ok(warnings(shape, motion)?.iter().map(Warning::kind).collect())
}

/// A map of heights as a function of x and y, with samples in the cells of [`grid`].
fn map(height: impl Fn(f64, f64) -> f64) -> Result<HeightMap> {
    let (x, y) = (grid()?.x(), grid()?.y());
    let heights = Array2::from_shape_fn([CELLS; 2], |(i, j)| height(x[i], y[j]));
    HeightMap::new(heights, [1.0; 2])
}

/// Radius of a sphere, and its load for a contact of a radius of 20 cells.
const RADIUS: f64 = 1e4;
const LOAD: f64 = 4.0 / 3.0 * 8e3 / RADIUS;

/// A crown without end carries any load; where that lies on it alone, far from the middle, the length of the roller is missing.
/// The roller of Spinu et al. touches its crown up to 12.7 mm with a flat part of 9.565 mm, and is right.
#[test]
#[ignore = "slow"]
fn a_roller_on_an_endless_crown_is_warned_of() -> Result<()> {
    let steel = Elastic::new(210e9, 0.3)?;
    let options = Options::default().with_tolerance(1e-5).with_cells(1 << 16);
    let kinds = |shape: &dyn Surface, at: f64| -> Result<Vec<&'static str>> {
        let motion = Motion::load(1e3).with_eccentricity([Some(at), None]);
        let solution = solve_with(shape, &steel.into(), &Setup::default(), &motion, &options)?;
        Ok(solution.report.warnings.iter().map(Warning::kind).collect())
    };
    let spinu = Roller::new(5e-3, 19.13e-3, 7.5)?;
    let crowned = Roller::new(5e-3, 0.0, 1.0)?;
    for (shape, at, warns) in [
        (&spinu as &dyn Surface, 2.87e-3, false),
        (&spinu, -2.87e-3, false),
        (&spinu, 0.1, true),
        (&spinu, -0.1, true),
        (&spinu, 0.03, true),
        (&crowned, 1e-3, false),
        (&crowned, 0.03, true),
        (&spinu.clone().shifted(0.1, 0.0)?, 0.1, false),
        (&spinu.clone().shifted(0.1, 0.0)?, 0.0, true),
        // A length ends the crown, and here the contact.
        (&spinu.clone().with_length(0.3)?, 0.1, false),
    ] {
        let found = kinds(shape, at)?;
        assert_eq!(found.contains(&"endless crown"), warns, "{shape:?}, {at}: {found:?}");
    }
    let motion = Motion::load(1e3).with_eccentricity([Some(0.1), None]);
    let solution = solve_with(&spinu, &steel.into(), &Setup::default(), &motion, &options)?;
    let text: Vec<String> = solution.report.warnings.iter().map(Warning::to_string).collect();
    assert!(text.iter().any(|text| text.contains("length") && text.contains("1.000e-1")));
    Ok(())
}

/// The width of the whole contact says nothing about that of its asperities.
#[test]
fn asperities_of_a_few_cells_are_warned_of() -> Result<()> {
    let waves = |length: f64, amplitude: f64| {
        let k = std::f64::consts::TAU / length;
        let heights = map(move |x, y| amplitude * (k * x).cos() * (k * y).cos())?;
        warnings(&Sphere::new(RADIUS)?.plus(heights), &Motion::load(LOAD))
    };
    // Asperities of single cells, and of a few.
    for amplitude in [0.3, 0.01] {
        let found = waves(8.0, amplitude)?;
        let [Warning::CoarseSpots { cells, .. }] = found[..] else {
            panic!("{found:?}");
        };
        assert!((1.0..5.0).contains(&cells), "{cells}");
        assert!(found[0].to_string().contains("cells wide along"));
    }
    // Waves that are flattened by the load, and a single resolved asperity.
    assert_eq!(waves(8.0, 1e-4)?, []);
    assert_eq!(waves(200.0, 0.01)?, []);
    Ok(())
}

/// Single cells that touch beside a contact of 40 cells carry little of the load.
#[test]
fn specks_beside_a_resolved_contact_are_not_warned_of() -> Result<()> {
    let at = |x: f64| x.rem_euclid(9.0) < 1.0;
    let shape = map(|x, y| {
        // The specks outside the contact alone.
        let is_speck = at(x) && at(y) && x.hypot(y) > 22.0;
        (if is_speck { 0.01 } else { 0.0 }) - (x * x + y * y) / (2.0 * RADIUS)
    })?;
    let contact = plan(Elastic::new(1.0, 0.0)?, grid()?)?;
    let solution = contact.solve(&shape, &Motion::load(LOAD), &Options::default())?;
    let touching = |i: usize, j: usize| solution.pressure[[i, j]] > 0.0;
    let lonely = (1..CELLS - 1).flat_map(|i| (1..CELLS - 1).map(move |j| (i, j)));
    let lonely =
        lonely.filter(|&(i, j)| touching(i, j) && !touching(i - 1, j) && !touching(i, j - 1));
    assert!(lonely.count() > 8);
    assert_eq!(solution.report.warnings, []);
    Ok(())
}

/// Round contacts of eight cells and more are not warned of.
#[test]
fn resolved_contacts_are_not_warned_of() -> Result<()> {
    for radius in [4.5_f64, 6.0, 10.0, 30.0] {
        for shift in [0.0, 0.25, 0.5] {
            let sphere = Sphere::new(RADIUS)?.shifted(shift, 0.3 * shift)?;
            let load = 4.0 / 3.0 * radius.powi(3) / RADIUS;
            let found = kinds(&sphere, &Motion::load(load))?;
            assert_eq!(found, [""; 0], "{radius} {shift}");
        }
    }
    Ok(())
}

/// The edge of a punch, also where only a part of it away from both axes is reached, and that of a sum.
#[test]
fn edges_of_punches_are_sharp() -> Result<()> {
    let punch = || FlatPunch::new(30.3);
    let tilted = Motion::approach(-0.6).with_tilt([Some(3e-2), Some(3e-2)]);
    assert_eq!(kinds(&punch()?, &Motion::load(1.0))?, ["sharp edge"]);
    assert_eq!(kinds(&punch()?, &tilted)?, ["sharp edge"]);
    let sum = punch()?.plus(Paraboloid::new(RADIUS, RADIUS)?);
    assert_eq!(kinds(&sum, &Motion::load(LOAD))?, [""; 0]);
    assert_eq!(kinds(&sum, &Motion::load(LOAD * 10.0))?, ["sharp edge"]);
    let roller = Roller::new(RADIUS, 60.0, 1e6)?.with_length(60.0)?;
    assert_eq!(kinds(&roller, &Motion::load(5e-2))?, ["sharp end"]);
    // A punch as wide as the grid.
    let wide = FlatPunch::new(40.0)?.shifted(8.2, 0.0)?;
    assert_eq!(kinds(&wide, &Motion::load(1.0))?, ["sharp edge"]);
    Ok(())
}

/// A map ends where it was not measured further.
#[test]
fn the_rim_of_a_measured_map_is_named() -> Result<()> {
    let hill = |at: f64| map(move |x, y| -((x - at).powi(2) + y * y) / (2.0 * RADIUS));
    assert_eq!(kinds(&hill(0.0)?, &Motion::load(LOAD))?, [""; 0]);
    let found = warnings(&hill(40.0)?, &Motion::load(LOAD))?;
    assert_eq!(found, [Warning::MapRim { axis: Axis::X }]);
    let text = found[0].to_string();
    assert!(text.contains("rim of the measured map along x"), "{text}");
    let flat = Paraboloid::new(1e6, 1e6)?;
    let moved = hill(-40.0)?.shifted(10.0, 0.0)?.plus(flat);
    assert_eq!(kinds(&moved, &Motion::load(LOAD))?, ["map rim"]);
    // The grid cuts a map that goes on.
    let moved = hill(0.0)?.shifted(30.0, 0.0)?;
    assert_eq!(kinds(&moved, &Motion::load(LOAD))?, ["grid edge"]);
    Ok(())
}
