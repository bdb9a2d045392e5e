//! Histories, combinations of forces and motions, friction by cell, symmetries, and full slip.

use nacre::friction::{FrictionOptions, FrictionSolution, Step};
use nacre::{Contact, Elastic, Error, Grid, HalfSpace, Motion, Options, Paraboloid, Result, Setup};
use ndarray::Array2;

use crate::support::pairs::{RADIUS, ball, coated, equal, load, material, pair, slid};

const FRICTION: f64 = 0.3;

fn press(load: f64) -> Step {
    Step::press(Motion::load(load), FRICTION)
}

fn precise() -> FrictionOptions {
    FrictionOptions {
        tolerance: 1e-12,
        ..FrictionOptions::default()
    }
}

/// Every combination of prescribed and loaded motions: what is prescribed and given is met, and a step with the motions
/// found prescribed gives the same tractions.
#[test]
fn prescribed_and_loaded_motions_are_the_same_problem() -> Result<()> {
    let (contact, load) = (pair(0.3, 48)?, load(0.3));
    let unit = FRICTION * load;
    let options = FrictionOptions {
        tolerance: 1e-11,
        ..FrictionOptions::default()
    };
    let given = [
        ([Some(0.6), Some(-0.3)], Some(0.1)),
        ([Some(0.6), None], Some(0.1)),
        ([None, None], Some(0.3)),
        ([Some(0.5), Some(0.5)], None),
    ];
    for (force, torque) in given {
        let force = force.map(|force| force.map(|force: f64| force * unit));
        let torque = torque.map(|torque| torque * unit);
        let step = Step {
            force,
            torque,
            ..press(load)
        };
        let loaded = &contact.slide(&ball()?, &[step], &options, None)?[0];
        assert!(loaded.report.converged());
        for (force, found) in force.into_iter().zip(loaded.force()) {
            assert!(force.is_none_or(|force| (force - found).abs() < 1e-10 * unit));
        }
        assert!(torque.is_none_or(|torque| (torque - loaded.torque()).abs() < 1e-10 * unit));
        let (shift, twist) = slid(loaded);
        let step = Step {
            shift: shift.map(Some),
            twist: Some(twist),
            ..press(load)
        };
        let moved = &contact.slide(&ball()?, &[step], &options, None)?[0];
        let most = FRICTION * loaded.normal.peak_pressure();
        for (a, b) in loaded
            .traction
            .iter()
            .flatten()
            .zip(moved.traction.iter().flatten())
        {
            // The compliance's condition amplifies the tolerance.
            assert!((a - b).abs() < 1e-7 * most, "{a} {b}");
        }
    }
    Ok(())
}

/// A history that goes on from a solution is that without interruption, bit by bit.
#[test]
fn a_resumed_history_is_the_same() -> Result<()> {
    let grid = Grid::new([40, 40], [2.6, 2.6])?;
    let setup = Setup {
        counterbody: Some(material(0.3)?.into()),
        threads: Some(1),
        ..Setup::default()
    };
    let contact = Contact::plan(coated(3.0, 0.2)?, grid, setup)?;
    let unit = FRICTION * load(0.3);
    let steps = [
        press(load(0.3)),
        Step {
            force: [Some(0.7 * unit), None],
            ..Step::default()
        },
        Step {
            motion: Some(Motion::load(1.2 * load(0.3))),
            torque: Some(0.1 * unit),
            shift: [None, Some(1e-3)],
            force: [Some(-0.2 * unit), None],
            ..Step::default()
        },
        Step {
            friction: Some(0.5.into()),
            ..Step::default()
        },
    ];
    let options = FrictionOptions::default();
    let whole = contact.slide(&ball()?, &steps, &options, None)?;
    let begun = contact.slide(&ball()?, &steps[..2], &options, None)?;
    let rest = contact.slide(&ball()?, &steps[2..], &options, begun.last())?;
    assert!(whole.iter().all(|solution| solution.report.converged()));
    for (a, b) in whole.iter().zip(begun.iter().chain(&rest)) {
        assert_eq!(a.traction, b.traction);
        assert_eq!(a.motion, b.motion);
        assert_eq!(a.normal.pressure, b.normal.pressure);
    }
    Ok(())
}

/// Halves with different friction: each cell within its own bound, and slipping cells on it.
#[test]
fn friction_may_differ_from_cell_to_cell() -> Result<()> {
    let (contact, load) = (pair(0.3, 48)?, load(0.3));
    let cells = Array2::from_shape_fn((48, 48), |(i, _)| if i < 24 { 0.1 } else { 0.4 });
    let step = Step {
        force: [Some(0.2 * load), None],
        ..Step::press(Motion::load(load), cells.clone())
    };
    let solution = &contact.slide(&ball()?, &[step], &FrictionOptions::default(), None)?[0];
    assert!(solution.report.converged());
    let (size, stick) = (solution.traction_size(), solution.stick());
    let mut slipping = [0; 2];
    for (at, p) in solution
        .normal
        .pressure
        .indexed_iter()
        .filter(|(_, p)| **p > 0.0)
    {
        let bound = cells[at] * p;
        assert!(size[at] <= bound * (1.0 + 1e-12));
        if !stick[at] {
            slipping[usize::from(at.0 >= 24)] += 1;
            assert!((size[at] / bound - 1.0).abs() < 1e-9);
        }
    }
    assert!(slipping[0] > slipping[1] && slipping[1] > 0, "{slipping:?}");
    Ok(())
}

/// Cells without friction: none of them bears a traction, and their pressure still moves the surfaces of the others where
/// bodies differ. The certificate, with the operator of the whole grid, shows it.
#[test]
fn cells_may_have_no_friction() -> Result<()> {
    let grid = Grid::new([40, 40], [2.6, 2.6])?;
    let setup = Setup {
        counterbody: Some(material(0.2)?.into()),
        threads: Some(1),
        ..Setup::default()
    };
    let contact = Contact::plan(coated(3.0, 0.2)?, grid, setup)?;
    let cells = Array2::from_shape_fn((40, 40), |(_, j)| if j < 20 { 0.0 } else { FRICTION });
    let step = Step {
        force: [Some(0.3 * FRICTION * load(0.3)), None],
        ..Step::press(Motion::load(load(0.3)), cells)
    };
    let solution = &contact.slide(&ball()?, &[step], &FrictionOptions::default(), None)?[0];
    assert!(solution.report.converged() && solution.report.violation < 1.001e-8);
    for ((_, j), q) in solution.traction_size().indexed_iter() {
        assert!(j >= 20 || *q <= 0.0);
    }
    Ok(())
}

/// Pulls along +x, −x, +y, −y are one by mirror and exchange, with layers and coupling.
#[test]
fn directions_are_equal() -> Result<()> {
    let grid = Grid::new([40, 40], [2.6, 2.6])?;
    let setup = Setup {
        counterbody: Some(material(0.2)?.into()),
        threads: Some(1),
        ..Setup::default()
    };
    let contact = Contact::plan(coated(3.0, 0.2)?, grid, setup)?;
    let force = 0.7 * FRICTION * load(0.3);
    let pulled = |force: [f64; 2]| -> Result<FrictionSolution> {
        let step = Step {
            force: force.map(Some),
            ..press(load(0.3))
        };
        let solutions = contact.slide(&ball()?, &[step], &precise(), None)?;
        Ok(solutions.into_iter().next().expect("one step"))
    };
    let [right, left, up] = [[force, 0.0], [-force, 0.0], [0.0, force]].map(pulled);
    let (right, left, up) = (right?, left?, up?);
    let most = FRICTION * right.normal.peak_pressure();
    let n = 39;
    for ((i, j), q) in right.traction[0].indexed_iter() {
        let same = [
            (-left.traction[0][[n - i, j]], *q),
            (up.traction[1][[j, i]], *q),
            (left.traction[1][[n - i, j]], right.traction[1][[i, j]]),
            (up.traction[0][[j, i]], right.traction[1][[i, j]]),
        ];
        for (a, b) in same {
            assert!((a - b).abs() < 1e-10 * most, "{i} {j}: {a} {b}");
        }
    }
    Ok(())
}

/// The body and the counterbody exchanged, seen from the other side, give the same pressure and tractions.
#[test]
fn bodies_may_be_exchanged() -> Result<()> {
    let solve = |exchanged: bool| -> Result<FrictionSolution> {
        let grid = Grid::new([32, 32], [2.6, 2.6])?;
        let (a, b) = (coated(3.0, 0.2)?, material(0.2)?.into());
        let (body, counter) = if exchanged { (b, a) } else { (a, b) };
        let setup = Setup {
            counterbody: Some(counter.into()),
            threads: Some(1),
            ..Setup::default()
        };
        let contact = Contact::plan(body, grid, setup)?;
        // Turned about the x axis, the other body lies below: y and z change sign, and so does the motion over it.
        let force = 0.7 * FRICTION * load(0.3);
        let force = if exchanged {
            [-force, 0.0]
        } else {
            [force, 0.0]
        };
        let step = Step {
            force: force.map(Some),
            ..press(load(0.3))
        };
        let solutions = contact.slide(&ball()?, &[step], &precise(), None)?;
        Ok(solutions.into_iter().next().expect("one step"))
    };
    let (one, other) = (solve(false)?, solve(true)?);
    let most = FRICTION * one.normal.peak_pressure();
    for ((i, j), q) in one.traction[0].indexed_iter() {
        assert!((q + other.traction[0][[i, 31 - j]]).abs() < 1e-9 * most);
    }
    assert!((slid(&one).0[0] + slid(&other).0[0]).abs() < 1e-9 * slid(&one).0[0]);
    Ok(())
}

/// Shift far beyond the elastic one: all cells slip along it at their bound, and the report says so.
#[test]
fn gross_slip_is_named() -> Result<()> {
    let (contact, load) = (pair(0.3, 40)?, load(0.3));
    let far = 10.0 * FRICTION * load;
    let step = Step {
        shift: [Some(far), None],
        ..press(load)
    };
    let solution = &contact.slide(&ball()?, &[step], &FrictionOptions::default(), None)?[0];
    assert!(solution.report.full_slip && solution.report.converged());
    assert!(solution.stick().iter().all(|stick| !stick));
    let found = solution.force();
    // Tractions turn a little towards their own displacement.
    assert!((found[0] / (FRICTION * load) - 1.0).abs() < 1e-3);
    let half = FRICTION * solution.normal.load();
    assert!((solution.dissipated() / (half * far) - 1.0).abs() < 0.1);
    for force in [1.0, 1.5] {
        let step = Step {
            force: [Some(force * FRICTION * load), None],
            ..press(load)
        };
        let refused = contact.slide(&ball()?, &[step], &FrictionOptions::default(), None);
        assert!(
            matches!(refused, Err(Error::FullSlip { .. })),
            "{refused:?}"
        );
    }
    Ok(())
}

/// Two equal bodies are not coupled, so that the pressure is that without friction; different ones are.
#[test]
fn coupling_is_there_where_bodies_differ() -> Result<()> {
    let grid = || Grid::new([32, 32], [2.6, 2.6]);
    let step = || Step {
        force: [Some(0.5 * FRICTION * load(0.3)), None],
        ..press(load(0.3))
    };
    let equal = equal(coated(3.0, 0.2)?, grid()?)?;
    let solution = &equal.slide(&ball()?, &[step()], &FrictionOptions::default(), None)?[0];
    assert!(!solution.report.coupled);
    let normal = equal.solve(&ball()?, &Motion::load(load(0.3)), &Options::default())?;
    assert_eq!(normal.pressure, solution.normal.pressure);
    let alone = Contact::plan(coated(3.0, 0.2)?, grid()?, Setup::default())?;
    for coupling in [true, false] {
        let options = FrictionOptions {
            coupling,
            ..FrictionOptions::default()
        };
        let solution = &alone.slide(&ball()?, &[step()], &options, None)?[0];
        assert!(solution.report.converged());
        assert_eq!(solution.report.coupled, coupling);
        // Without coupling, pressure alone does not rub.
        let pressed = &alone.slide(&ball()?, &[press(load(0.3))], &options, None)?[0];
        let rubbed = pressed.traction.iter().flatten().any(|q| *q != 0.0);
        assert_eq!(rubbed, coupling);
    }
    Ok(())
}

/// A ball tilted over touches away from the origin: the torque is about the origin, and a force through the middle of the
/// contact has that torque.
#[test]
fn torque_is_about_the_origin() -> Result<()> {
    let contact = equal(material(0.0)?, Grid::new([80, 80], [5.2, 5.2])?)?;
    let force = 0.5 * FRICTION * load(0.0);
    let motion = Motion {
        tilt: [Some(0.65 / RADIUS), None],
        ..Motion::load(load(0.0))
    };
    let step = Step {
        force: [None, Some(force)],
        ..Step::press(motion, FRICTION)
    };
    let solution = &contact.slide(&ball()?, &[step], &precise(), None)?[0];
    let pressure = &solution.normal.pressure;
    let moment: f64 = pressure
        .indexed_iter()
        .map(|((i, _), p)| contact.grid().x()[i] * p)
        .sum();
    let arm = moment / pressure.sum();
    assert!((arm.abs() - 0.65).abs() < 0.01);
    assert!((solution.torque() / (force * arm) - 1.0).abs() < 1e-9);
    Ok(())
}

/// Different bodies with little friction slip nearly everywhere, and a shift along both axes and a twist are found for forces
/// and a torque: each holds to the tolerance.
#[test]
fn little_friction_under_forces_and_a_torque() -> Result<()> {
    let setup = Setup {
        counterbody: Some(HalfSpace::from(Elastic::new(1e3, 0.3)?).into()),
        ..Setup::default()
    };
    let contact = Contact::plan(
        Elastic::new(1.0, 0.3)?,
        Grid::new([48, 48], [3.0, 3.0])?,
        setup,
    )?;
    let (shape, load) = (Paraboloid::new(RADIUS, RADIUS)?, 4.0 / 3.0 / 0.91 / RADIUS);
    for friction in [0.01, 0.05, 0.1] {
        for [along, across, turning] in [
            [0.3, 0.3, 0.2],
            [0.0, 0.0, 0.0],
            [0.1, -0.5, 0.1],
            [0.02, 0.0, -0.3],
        ] {
            let bears = friction * load;
            let (force, torque) = (
                [along * bears, across * bears],
                turning * bears * 3.0 * std::f64::consts::PI / 16.0,
            );
            let step = Step {
                force: force.map(Some),
                torque: Some(torque),
                ..Step::press(Motion::load(load), friction)
            };
            let found = contact.slide(&shape, &[step], &FrictionOptions::default(), None)?;
            let report = &found[0].report;
            assert!(
                report.converged(),
                "{friction} {force:?} {torque}: {report:?}"
            );
            let error = |found: f64, due: f64| (found - due).abs();
            let [x, y] = found[0].force();
            assert!(error(x, force[0]).max(error(y, force[1])) < 1e-7 * bears);
            assert!(error(found[0].torque(), torque) < 1e-7 * bears);
        }
    }
    Ok(())
}
