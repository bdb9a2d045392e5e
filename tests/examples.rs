//! The Rust examples run, and their numbers are right.

#[path = "../examples/foundation.rs"]
mod foundation;
#[path = "../examples/roller.rs"]
mod roller;

#[test]
#[ignore = "slow"]
fn roller_has_more_pressure_as_the_force_moves_off_its_centre() -> nacre::Result<()> {
    roller::main()?;
    let found = roller::peaks(&[0.0, -0.3, 0.3])?;
    // E1/E2 = 2: above the 822 and 985 MPa of the bare roller. Loads at ±0.3 give equal peaks.
    assert!(found[0] > 900e6 && found[1] > 1.15 * found[0], "{found:?}");
    assert!((found[2] / found[1] - 1.0).abs() < 1e-8, "{found:?}");
    Ok(())
}

#[test]
#[ignore = "slow"]
fn foundations_carry_a_ball_as_their_closed_forms_say() -> nacre::Result<()> {
    foundation::main()?;
    let ratios = foundation::approaches(&[0.0, 0.3e-3])?;
    assert!(ratios.iter().all(|r| (r - 1.0).abs() < 1e-4), "{ratios:?}");
    Ok(())
}
