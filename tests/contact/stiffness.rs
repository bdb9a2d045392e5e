//! The tangent stiffness is symmetric and equals central differences and closed forms.

use nacre::{
    Contact, Elastic, FlatPunch, Grid, HalfSpace, Motion, Options, Paraboloid, Result, Roller,
    Solution, Sphere, Surface,
};

use crate::support::settings::{converged, plan, stack, tolerance};

/// Step of the differences: so small that no cell joins or leaves the contact, and large compared with
/// the error of the solutions, 1e-13/2e-6.
const STEP: f64 = 2e-6;
const SYMMETRY: f64 = 1e-10;
const DIFFERENCES: f64 = 1e-6;

/// The solution of a tilted contact at a given approach.
fn moved(
    contact: &Contact,
    shape: &dyn Surface,
    at: [f64; 3],
    options: &Options,
) -> Result<Solution> {
    let motion = Motion::approach(at[0]).with_tilt([Some(at[1]), Some(at[2])]);
    converged(contact, shape, &motion, options)
}

/// Force and moments (Σ p dA, Σ p x dA, Σ p y dA).
fn loads(solution: &Solution) -> [f64; 3] {
    let [mx, my] = solution.moment();
    [solution.load(), mx, my]
}

/// Asserts that the stiffness is symmetric and equals central differences, each entry relative to the geometric mean of
/// its diagonals; the contact is tilted, so that no entry is zero by symmetry.
pub(crate) fn assert_stiffness(
    contact: &Contact,
    shape: &dyn Surface,
    at: [f64; 3],
    step: f64,
    bar: f64,
) -> Result<()> {
    assert_stiffness_with(contact, shape, at, step, bar, &tolerance(1e-13))
}

/// [`assert_stiffness`] with other options.
pub(crate) fn assert_stiffness_with(
    contact: &Contact,
    shape: &dyn Surface,
    at: [f64; 3],
    step: f64,
    bar: f64,
    options: &Options,
) -> Result<()> {
    let stiffness = moved(contact, shape, at, options)?.stiffness(None)?;
    // All steps cause equal displacements at the rim.
    let half = 0.5 * contact.grid().size()[0];
    for freedom in 0..3 {
        let step = step * at[0] / if freedom == 0 { 1.0 } else { half };
        let loads = |sign: f64| {
            let mut to = at;
            to[freedom] += sign * step;
            Ok::<_, nacre::Error>(loads(&moved(contact, shape, to, options)?))
        };
        let (more, less) = (loads(1.0)?, loads(-1.0)?);
        for row in 0..3 {
            let slope = (more[row] - less[row]) / (2.0 * step);
            let scale = (stiffness[row][row] * stiffness[freedom][freedom]).sqrt();
            let (entry, transposed) = (stiffness[row][freedom], stiffness[freedom][row]);
            below!((entry - slope).abs(), bar * scale, row, freedom);
            assert!((entry - transposed).abs() <= SYMMETRY * scale);
        }
    }
    Ok(())
}

fn coated() -> Result<HalfSpace> {
    stack(Elastic::new(1.0, 0.25)?, [[4.0, 0.3, 0.1]])
}

#[test]
#[ignore = "slow"]
fn stiffness_is_that_of_central_differences() -> Result<()> {
    let bare: HalfSpace = Elastic::new(1.0, 0.3)?.into();
    let grid = Grid::new([60, 45], [2.4, 2.0])?;
    let shapes: [(&dyn Surface, [f64; 3]); 3] = [
        (&Sphere::new(50.0)?, [0.01, 1e-3, -2e-3]),
        (&Paraboloid::new(60.0, 25.0)?, [0.01, -1e-3, 3e-3]),
        (&FlatPunch::new(0.7)?, [0.01, 1e-3, 2e-3]),
    ];
    for body in [bare, coated()?] {
        for (shape, at) in shapes {
            assert_stiffness(&plan(&body, grid)?, shape, at, STEP, DIFFERENCES)?;
        }
    }
    let roller = Roller::new(5.0, 8.0, 100.0)?;
    let contact = plan(coated()?, Grid::new([96, 48], [16.0, 1.2])?)?;
    assert_stiffness(&contact, &roller, [0.02, 5e-4, 0.0], STEP, DIFFERENCES)
}

#[test]
fn flat_punch_has_the_stiffness_of_its_closed_form() -> Result<()> {
    // W = 2 E* a δ; M = 4/3 E* a³ s (Johnson, Contact Mechanics, eqs 3.36 and 5.46 f.). The radius
    // of a punch of cells is right to a fraction of a cell, and is taken from their area π a².
    let body: HalfSpace = Elastic::new(1.0, 0.0)?.into();
    let radius: f64 = 1.0;
    let mut errors = Vec::new();
    for cells in [64, 128] {
        let grid = Grid::new([cells, cells], [2.2, 2.2])?;
        let contact = plan(&body, grid)?;
        let punch = FlatPunch::new(radius)?;
        let solution = contact.solve(&punch, &Motion::load(1.0), &Options::default())?;
        let stiffness = solution.stiffness(None)?;
        let normal = stiffness[0][0] / (2.0 * radius) - 1.0;
        let tilt = stiffness[1][1] / (4.0 / 3.0 * radius.powi(3)) - 1.0;
        errors.push([normal, tilt]);
        near!(stiffness[1][1], stiffness[2][2], 1e-9);
        for (row, column) in [(0, 1), (0, 2), (1, 2)] {
            // No coupling at the middle.
            below!(stiffness[row][column].abs(), 1e-9, row, column);
        }
    }
    // Cells of uniform pressure represent a 1/√ singularity at the edge to first order: half a cell of radius.
    for (error, cell) in errors.iter().zip([2.2 / 64.0, 2.2 / 128.0]) {
        below!(error[0].abs(), 0.5 * cell / radius, errors);
        below!(error[1].abs(), 1.5 * cell / radius, errors);
    }
    Ok(())
}

#[test]
fn nothing_touching_has_no_stiffness() -> Result<()> {
    let body: HalfSpace = Elastic::new(1.0, 0.0)?.into();
    let grid = Grid::new([16, 16], [1.0, 1.0])?;
    let contact = plan(&body, grid)?;
    let motion = Motion::approach(-1.0);
    let solution = contact.solve(&Sphere::new(5.0)?, &motion, &Options::default())?;
    let stiffness = solution.stiffness(None)?;
    assert!(stiffness.as_flattened().iter().all(|&s| s == 0.0));
    Ok(())
}

#[test]
fn motion_found_under_load_gives_the_load_back() -> Result<()> {
    let grid = Grid::new([60, 45], [2.4, 2.0])?;
    let contact = plan(&coated()?, grid)?;
    let sphere = Sphere::new(50.0)?;
    let loaded = Motion::load(0.02).with_eccentricity([Some(0.2), Some(-0.1)]);
    let options = tolerance(1e-12);
    let solution = contact.solve(&sphere, &loaded, &options)?;
    let [sx, sy] = solution.tilt;
    let [load, mx, my] =
        loads(&moved(&contact, &sphere, [solution.approach, sx, sy], &tolerance(1e-13))?);
    near!(load, 0.02, GIVEN_BACK);
    let half = [1.2, 1.0];
    assert!((mx - 0.2 * 0.02).abs() < GIVEN_BACK * 0.02 * half[0]);
    assert!((my + 0.1 * 0.02).abs() < GIVEN_BACK * 0.02 * half[1]);
    Ok(())
}

const GIVEN_BACK: f64 = 1e-8;
