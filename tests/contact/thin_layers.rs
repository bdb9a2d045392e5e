//! Layers far thinner than a cell have the same effect on grids that are two and four times finer.

use nacre::{Cylinder, Grid, HalfSpace, Motion, Paraboloid, Result, Surface, hertz};

use crate::support::settings::{self, converged, plan, steel, tolerance};

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

/// A coat of this part of a cell.
fn coated(ratio: f64, part: f64) -> Result<HalfSpace> {
    settings::coated(steel()?, ratio, CELL / part)
}

/// Peak pressure under a sphere, or a cylinder of infinite length.
fn peak(body: &HalfSpace, refinement: usize, is_line: bool) -> Result<f64> {
    let (modulus, cells) = (steel()?.plane_strain_modulus(), CELLS * refinement);
    let side = CELLS as f64 * CELL;
    let (shape, grid, load): (Box<dyn Surface>, _, _) = if is_line {
        let load = std::f64::consts::PI * modulus * HALF_WIDTH.powi(2) / (4.0 * RADIUS);
        (Box::new(Cylinder::new(RADIUS)?), Grid::line(cells, side)?, load)
    } else {
        let load = 4.0 * modulus * HALF_WIDTH.powi(3) / (3.0 * RADIUS);
        let shape = Paraboloid::new(RADIUS, RADIUS)?;
        (Box::new(shape), Grid::new([cells; 2], [side; 2])?, load)
    };
    let (contact, motion) = (plan(body, grid)?, Motion::load(load));
    Ok(converged(&contact, &*shape, &motion, &tolerance(CONVERGED))?.peak_pressure())
}

#[test]
#[ignore = "slow"]
fn a_tenth_and_a_hundredth_of_a_cell() -> Result<()> {
    for is_line in [false, true] {
        for (ratio, part) in [(2.0, 10.0), (2.0, 100.0), (10.0, 10.0), (10.0, 100.0)] {
            let body = coated(ratio, part)?;
            let coarse = peak(&body, 1, is_line)?;
            for finer in [2, 4] {
                // The finest grid below a sphere is used where the effect of the layer is largest.
                if finer == 2 || is_line || (ratio > 2.0 && part < 100.0) {
                    let fine = peak(&body, finer, is_line)?;
                    near!(coarse, fine, DISCRETISATION, is_line, ratio, part, finer);
                }
            }
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
    let uncoated = peak(&steel()?.into(), 1, false)?;
    let effect = |part: f64| -> Result<f64> {
        Ok((peak(&coated(10.0, part)?, 1, false)? - uncoated) / bare.peak_pressure)
    };
    let (tenth, hundredth) = (effect(10.0)?, effect(100.0)?);
    assert!(hundredth > 1e-4 && (tenth / hundredth / 10.0 - 1.0).abs() < 0.1);
    Ok(())
}
