//! The direction of friction: that in which the shape rolls, or one that is given.

use nacre::{
    Contact, Cylinder, Elastic, FlatPunch, Grid, HeightMap, Member, Motion, Options, Paraboloid,
    Result, Roller, Setup, Solution, Sphere, Stress, StressOptions, Surface, stress,
};
use ndarray::{Array2, array};

const DIRECTION: &str = "direction must be given where friction is above 0";

fn press(grid: Grid, shape: &dyn Surface) -> Result<Solution> {
    let contact = Contact::plan(Elastic::new(1.0, 0.3)?, grid, Setup::default())?;
    contact.solve(shape, &Motion::approach(1e-3), &Options::default())
}

/// Shear stresses σ_xz and σ_yz at the surface, where they are minus the traction.
fn tractions(solution: &Solution, direction: Option<[f64; 2]>) -> Result<[f64; 2]> {
    let options = StressOptions::default().with_friction(0.25).with_direction(direction);
    let field = solution.stress(&[0.0], Member::Body, &options)?;
    Ok([field.xz(), field.yz()].map(|shear| -shear.sum()))
}

fn cells() -> Result<Grid> {
    Grid::new([12, 10], [0.2, 0.2])
}

/// Rollers and cylinders roll across their axis, which lies along x; with roughness and moved, too. What
/// is at rest beside them does not matter.
#[test]
fn rollers_slide_across_their_axis() -> Result<()> {
    let rough = HeightMap::new(Array2::zeros((12, 10)), [0.2 / 12.0, 0.02])?;
    let roller = Roller::new(1.0, 0.1, 50.0)?;
    let shapes: [Box<dyn Surface>; 4] = [
        Box::new(roller.clone()),
        Box::new(Cylinder::new(1.0)?),
        Box::new(roller.clone().plus(rough)),
        Box::new(roller.shifted(0.01, 0.0)?),
    ];
    for shape in shapes {
        let solution = press(cells()?, &shape)?;
        assert_eq!(solution.report.rolling_direction, Some([0.0, 1.0]));
        let [x, y] = tractions(&solution, None)?;
        let pressed = 0.25 * solution.pressure.sum();
        assert!(x.abs() < 1e-12 * pressed, "{shape:?}: {x:e}");
        assert!((y / pressed - 1.0).abs() < 1e-12, "{shape:?}: {y:e}");
        let [x, _] = tractions(&solution, Some([2.0, 0.0]))?;
        assert!((x / pressed - 1.0).abs() < 1e-12, "{shape:?}: {x:e}");
    }
    Ok(())
}

/// In line contact the strips are endless along x, and friction acts across them, whatever the shape; also
/// under a pressure that is given.
#[test]
fn line_contacts_slide_across_the_strips() -> Result<()> {
    let grid = Grid::line(10, 0.2)?;
    let solution = press(grid, &Sphere::new(1.0)?)?;
    let [x, y] = tractions(&solution, None)?;
    assert!(x.abs() < f64::EPSILON && y > 0.0);
    let options = StressOptions::default().with_friction(0.5);
    let body = Elastic::new(1.0, 0.3)?.into();
    let field: Stress = stress(&body, &grid, &solution.pressure, &[0.0], &options)?;
    assert!((field.friction[1] - 0.5).abs() < f64::EPSILON);
    Ok(())
}

/// Below a body of revolution that is pressed on its axis all directions are alike: friction acts along x.
#[test]
fn bodies_of_revolution_slide_along_x() -> Result<()> {
    let shapes: [Box<dyn Surface>; 3] = [
        Box::new(Sphere::new(1.0)?),
        Box::new(Paraboloid::new(2.0, 1.0)?.with_counter_radii([None, Some(-2.0)])?),
        Box::new(FlatPunch::new(0.05)?),
    ];
    let contact = Contact::plan(Elastic::new(1.0, 0.3)?, cells()?, Setup::default())?;
    let tilted = Motion::approach(1e-3).with_tilt([Some(1e-3), None]);
    for shape in shapes {
        let solution = press(cells()?, &shape)?;
        assert_eq!(solution.report.rolling_direction, Some([1.0, 0.0]));
        let [none, along] = [None, Some([1.0, 0.0])].map(|given| tractions(&solution, given));
        assert_eq!(none?.map(f64::to_bits), along?.map(f64::to_bits));
        let solution = contact.solve(&shape, &tilted, &Options::default())?;
        assert_eq!(solution.report.rolling_direction, None);
    }
    Ok(())
}

/// Other shapes are asked for the direction, and a pressure whose shape is not known; without friction
/// they need none. Nor does a solution tell that was saved before reports had the direction.
#[test]
fn others_are_asked() -> Result<()> {
    let shapes: [Box<dyn Surface>; 3] = [
        Box::new(Sphere::new(1.0)?.shifted(0.01, 0.0)?),
        Box::new(Paraboloid::new(3.0, 1.0)?),
        Box::new(HeightMap::new(array![[0.0, 0.0], [0.0, 0.1]], [0.1, 0.1])?),
    ];
    let refused = |result: Result<[f64; 2]>| match result {
        Ok(found) => panic!("{found:?}"),
        Err(error) => assert!(error.to_string().starts_with(DIRECTION), "{error}"),
    };
    for shape in shapes {
        let solution = press(cells()?, &shape)?;
        assert_eq!(solution.report.rolling_direction, None);
        refused(tractions(&solution, None));
        assert!(tractions(&solution, Some([0.0, 1.0])).is_ok());
        let field = solution.stress(&[0.0], Member::Body, &StressOptions::default())?;
        assert!(field.friction.iter().all(|f| f.abs() < f64::EPSILON));
    }
    let mut solution = press(cells()?, &Roller::new(1.0, 0.1, 50.0)?)?;
    solution.report.rolling_direction = None;
    refused(tractions(&solution, None));
    Ok(())
}
