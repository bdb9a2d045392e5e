//! Layers far thinner than a cell have the same effect on grids that are two and four times finer.

use nacre::{
    Contact, Cylinder, Elastic, Grid, HalfSpace, Layer, Motion, Options, Paraboloid, Result, Setup,
    Surface, hertz,
};

/// Error of the peak pressure on 200 cells across the contact, compared with finer grids: the peak is
/// read half a cell diagonal off the axis, (dx/a)²/4 = 2.5e-5, and the discretisation has an error of
/// the same size.
const DISCRETISATION: f64 = 2e-4;

/// Residual at which the error of the pressure is 1e-5.
const CONVERGED: f64 = 1e-6;

/// Half-width of the contact on the bare substrate, which is 1 mm wide.
const HALF_WIDTH: f64 = 0.5e-3;
const RADIUS: f64 = 50e-3;

/// Number of cells along the side of the coarsest grid, and side of a cell, for 200 cells across the contact.
const CELLS: usize = 216;
const CELL: f64 = HALF_WIDTH / 100.0;

fn steel() -> Result<Elastic> {
    Elastic::new(210e9, 0.3)
}

fn coated(modulus_ratio: f64, part: f64) -> Result<HalfSpace> {
    let coating = Elastic::new(modulus_ratio * 210e9, 0.3)?;
    HalfSpace::new(steel()?, [Layer::new(coating, CELL / part)?])
}

fn peak(body: &HalfSpace, grid: Grid, shape: &dyn Surface, load: f64) -> Result<f64> {
    let contact = Contact::plan(body, grid, Setup::default())?;
    let options = Options {
        tolerance: CONVERGED,
        ..Options::default()
    };
    let solution = contact.solve(shape, &Motion::load(load), &options)?;
    Ok(solution
        .require_converged(options.tolerance)?
        .peak_pressure())
}

/// Peak pressure under a sphere.
fn sphere(body: &HalfSpace, refinement: usize) -> Result<f64> {
    let load = 4.0 * steel()?.plane_strain_modulus() * HALF_WIDTH.powi(3) / (3.0 * RADIUS);
    let grid = Grid::new([CELLS * refinement; 2], [CELLS as f64 * CELL; 2])?;
    peak(body, grid, &Paraboloid::new(RADIUS, RADIUS)?, load)
}

/// Peak pressure under a cylinder of infinite length.
fn cylinder(body: &HalfSpace, refinement: usize) -> Result<f64> {
    let modulus = steel()?.plane_strain_modulus();
    let load = std::f64::consts::PI * modulus * HALF_WIDTH.powi(2) / (4.0 * RADIUS);
    let grid = Grid::line(CELLS * refinement, CELLS as f64 * CELL)?;
    peak(body, grid, &Cylinder::new(RADIUS)?, load)
}

fn check(name: &str, coarse: f64, fine: f64, refinement: usize) {
    let error = coarse / fine - 1.0;
    println!("{name}: against {refinement} times finer {error:.1e}");
    assert!(
        error.abs() < DISCRETISATION,
        "{name}, {refinement}: {error:e}"
    );
}

#[test]
fn a_tenth_and_a_hundredth_of_a_cell_under_a_sphere() -> Result<()> {
    for ratio in [2.0, 10.0] {
        for part in [10.0, 100.0] {
            let (name, body) = (
                format!("sphere, E1/E2 {ratio}, h = dx/{part}"),
                coated(ratio, part)?,
            );
            let coarse = sphere(&body, 1)?;
            check(&name, coarse, sphere(&body, 2)?, 2);
            // The finest grid is used where the effect of the layer is largest.
            if ratio > 2.0 && part < 100.0 {
                check(&name, coarse, sphere(&body, 4)?, 4);
            }
        }
    }
    Ok(())
}

#[test]
fn a_tenth_and_a_hundredth_of_a_cell_under_a_cylinder() -> Result<()> {
    for ratio in [2.0, 10.0] {
        for part in [10.0, 100.0] {
            let (name, body) = (
                format!("cylinder, E1/E2 {ratio}, h = dx/{part}"),
                coated(ratio, part)?,
            );
            let coarse = cylinder(&body, 1)?;
            check(&name, coarse, cylinder(&body, 2)?, 2);
            check(&name, coarse, cylinder(&body, 4)?, 4);
        }
    }
    Ok(())
}

#[test]
fn the_thin_layer_is_not_lost() -> Result<()> {
    // A stiff layer raises the peak of a point contact in
    // proportion to its thickness h, while h is small compared with the contact.
    let load = 4.0 * steel()?.plane_strain_modulus() * HALF_WIDTH.powi(3) / (3.0 * RADIUS);
    let bare = hertz::Point::new(RADIUS, steel()?.plane_strain_modulus(), load)?;
    let uncoated = sphere(&steel()?.into(), 1)?;
    let effect = |part: f64| -> Result<f64> {
        Ok((sphere(&coated(10.0, part)?, 1)? - uncoated) / bare.peak_pressure)
    };
    let (tenth, hundredth) = (effect(10.0)?, effect(100.0)?);
    println!("rise of the peak: {tenth:.2e}, {hundredth:.2e}");
    assert!(hundredth > 1e-4 && (tenth / hundredth / 10.0 - 1.0).abs() < 0.1);
    Ok(())
}
