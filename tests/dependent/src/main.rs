//! Solves a coated sphere with nacre as a dependency, without Python.

use nacre::contact::solve_with;
use nacre::{Elastic, HalfSpace, Layer, Motion, Options, Setup, Sphere, hertz};

fn main() -> nacre::Result<()> {
    let steel = Elastic::new(210e9, 0.3)?;
    let coating = Elastic::new(420e9, 0.3)?;
    let body = HalfSpace::new(steel, [Layer::new(coating, 40e-6)?])?;
    let options = Options::default().with_tolerance(1e-10);
    let (sphere, motion) = (Sphere::new(5e-3)?, Motion::load(100.0));
    let solution = solve_with(&sphere, &body.into(), &Setup::default(), &motion, &options)?;
    assert!(solution.report.residual <= 1e-10, "{:e}", solution.report.residual);

    // The peak lies between those on half-spaces of steel and of the coating.
    let bare = hertz::Point::new(5e-3, steel.plane_strain_modulus(), 100.0)?;
    let thick = hertz::Point::new(5e-3, coating.plane_strain_modulus(), 100.0)?;
    let peak = solution.peak_pressure();
    assert!(peak > bare.peak_pressure && peak < thick.peak_pressure, "{peak:e}");
    assert!(solution.approach < bare.approach && solution.approach > thick.approach);
    assert!((solution.load() / 100.0 - 1.0).abs() < 1e-12);
    println!("peak pressure {:.1} MPa, approach {:.4} um", peak / 1e6, solution.approach * 1e6);
    Ok(())
}
