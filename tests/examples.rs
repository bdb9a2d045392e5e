//! The examples run, and show what they say.

#[path = "../examples/roller.rs"]
mod roller;

#[test]
fn roller_has_more_pressure_as_the_force_moves_off_its_centre() -> nacre::Result<()> {
    roller::main()?;
    let found = roller::peaks(&[0.0, -0.3, 0.3])?;
    // E1/E2 = 2: above the 822 and 985 MPa of the bare roller, and the same at either end.
    assert!(found[0] > 900e6 && found[1] > 1.15 * found[0], "{found:?}");
    assert!((found[2] / found[1] - 1.0).abs() < 1e-8, "{found:?}");
    Ok(())
}
