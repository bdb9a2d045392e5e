//! Stress under the tractions of a contact.

use nacre::friction::{FrictionOptions, FrictionSolution, Step};
use nacre::{Contact, Grid, Member, Motion, Result, Setup, StressOptions, stress};

use crate::support::pairs::{ball, coated, load, material, pair};

const FRICTION: f64 = 0.3;

fn slid(contact: &Contact, step: Step) -> Result<FrictionSolution> {
    let options = FrictionOptions::default();
    let solutions = contact.slide(&ball()?, &[step], &options, None)?;
    Ok(solutions.into_iter().next().expect("one step"))
}

/// At the surface, shear stress is what the traction demands, −q on the body and on the counterbody, whose z axis points
/// the other way.
#[test]
fn shear_at_the_surface_is_the_traction() -> Result<()> {
    let setup = Setup {
        counterbody: Some(material(0.2)?.into()),
        threads: Some(1),
        ..Setup::default()
    };
    let contact = Contact::plan(coated(3.0, 0.2)?, Grid::new([32, 32], [2.6, 2.6])?, setup)?;
    let force = [0.6, -0.3].map(|share| Some(share * FRICTION * load(0.3)));
    let step = Step {
        force,
        torque: Some(0.1 * FRICTION * load(0.3)),
        ..Step::press(Motion::load(load(0.3)), FRICTION)
    };
    let solution = slid(&contact, step)?;
    let most = solution.normal.peak_pressure();
    for (member, sign) in [(Member::Body, -1.0), (Member::Counterbody, 1.0)] {
        let field = solution.stress(&[0.0], member, &StressOptions::default())?;
        for ((i, j), q) in solution.traction[0].indexed_iter() {
            let across = solution.traction[1][[i, j]];
            assert!((field.xz()[[0, i, j]] - sign * q).abs() < 1e-10 * most);
            assert!((field.yz()[[0, i, j]] - sign * across).abs() < 1e-10 * most);
        }
    }
    Ok(())
}

/// With ν = 0, gross slip has the traction μp along the shift: its stress is that of `friction` in the evaluation of
/// stress.
#[test]
fn gross_slip_is_friction_of_the_stress_call() -> Result<()> {
    let contact = pair(0.0, 32)?;
    let step = Step {
        shift: [Some(10.0 * FRICTION * load(0.0)), None],
        ..Step::press(Motion::load(load(0.0)), FRICTION)
    };
    let solution = slid(&contact, step)?;
    assert!(solution.report.full_slip);
    let (body, depths) = (material(0.0)?.into(), [0.0, 0.2, 1.0]);
    let without = StressOptions::default();
    let with = StressOptions {
        friction: FRICTION,
        direction: Some([1.0, 0.0]),
        ..StressOptions::default()
    };
    let pressure = &solution.normal.pressure;
    let called = stress(&body, contact.grid(), pressure, &depths, &with)?;
    let pressed = stress(&body, contact.grid(), pressure, &depths, &without)?;
    let true_one = solution.stress(&depths, Member::Body, &without)?;
    let normal = solution.normal.stress(&depths, Member::Body, &without)?;
    let most = solution.normal.peak_pressure();
    for component in 0..6 {
        let due = &called.components[component] - &pressed.components[component];
        let found = &true_one.components[component] - &normal.components[component];
        for (a, b) in due.iter().zip(&found) {
            assert!((a - b).abs() < 1e-10 * most, "{component}: {a} {b}");
        }
    }
    assert!(called.xz().iter().any(|s| s.abs() > 0.2 * most));
    Ok(())
}
