//! Histories, combinations of forces and motions, friction by cell, symmetries, full slip, and stresses below.

use nacre::friction::{FrictionOptions, FrictionSolution, Step};
use nacre::{
    Contact, Elastic, Error, Grid, HalfSpace, Member, Motion, Options, Paraboloid, Result,
    StressOptions, stress,
};
use ndarray::{Array2, Axis};

use crate::support::checks::apart;
use crate::support::pairs::{
    RADIUS, ball, coated, equal, load, material, pair, precise, slid, slide, slide_once,
    tractions_apart, unlike,
};
use crate::support::settings::{against, one_thread, plan};

const FRICTION: f64 = 0.3;

fn press(load: f64) -> Step {
    Step::press(Motion::load(load), FRICTION)
}

/// Every combination of prescribed and loaded motions: what is prescribed and given is met, and a step with the motions
/// found prescribed gives the same tractions.
#[test]
fn prescribed_and_loaded_motions_are_the_same_problem() -> Result<()> {
    let (contact, load) = (pair(0.3, 48)?, load(0.3));
    let unit = FRICTION * load;
    let options = precise(1e-11);
    let given = [
        ([Some(0.6), Some(-0.3)], Some(0.1)),
        ([Some(0.6), None], Some(0.1)),
        ([None, None], Some(0.3)),
        ([Some(0.5), Some(0.5)], None),
    ];
    for (force, torque) in given {
        let force = force.map(|force| force.map(|force: f64| force * unit));
        let torque = torque.map(|torque| torque * unit);
        let step = press(load).with_force(force).with_torque(torque);
        let loaded = slide(&contact, step, &options)?;
        for (force, found) in force.into_iter().zip(loaded.force()) {
            assert!(force.is_none_or(|force| (force - found).abs() < 1e-10 * unit));
        }
        assert!(torque.is_none_or(|torque| (torque - loaded.torque()).abs() < 1e-10 * unit));
        let (shift, twist) = slid(&loaded);
        let step = press(load).with_shift(shift.map(Some)).with_twist(Some(twist));
        let moved = slide(&contact, step, &options)?;
        let most = FRICTION * loaded.normal.peak_pressure();
        // The compliance's condition amplifies the tolerance.
        below!(tractions_apart(&loaded, &moved), 1e-7 * most);
    }
    Ok(())
}

/// A history that goes on from a solution is that without interruption, bit by bit.
#[test]
fn a_resumed_history_is_the_same() -> Result<()> {
    let grid = Grid::new([40, 40], [2.6, 2.6])?;
    let setup = one_thread(material(0.3)?);
    let contact = Contact::plan(coated(3.0, 0.2)?, grid, setup)?;
    let unit = FRICTION * load(0.3);
    let steps = [
        press(load(0.3)),
        Step::default().with_force([Some(0.7 * unit), None]),
        Step::default()
            .with_motion(Motion::load(1.2 * load(0.3)))
            .with_torque(0.1 * unit)
            .with_shift([None, Some(1e-3)])
            .with_force([Some(-0.2 * unit), None]),
        Step::default().with_friction(0.5),
    ];
    let options = FrictionOptions::default();
    let whole = contact.slide(&ball()?, &steps, &options, None)?;
    let begun = contact.slide(&ball()?, &steps[..2], &options, None)?;
    let rest = contact.slide(&ball()?, &steps[2..], &options, begun.last())?;
    // What has slipped belongs to its bodies.
    for body in [coated(3.0, 0.1)?, material(0.3)?.into()] {
        let other = Contact::plan(body, grid, one_thread(material(0.3)?))?;
        let refused = other.slide(&ball()?, &steps[2..], &options, begun.last());
        assert!(matches!(refused, Err(Error::Inconsistent(text)) if text.contains("body")));
    }
    assert!(whole.iter().all(|solution| solution.report.converged()));
    for (a, b) in whole.iter().zip(begun.iter().chain(&rest)) {
        assert_eq!(a.traction, b.traction);
        assert_eq!(a.motion, b.motion);
        assert_eq!(a.normal.pressure, b.normal.pressure);
    }
    Ok(())
}

/// With coupling, the energy of the normal contact and what the tractions add are all of it: on the contact the normal
/// displacement is δ − h, by the pressure and by the tractions.
#[test]
fn the_energy_of_coupled_contacts_is_that_of_all_displacements() -> Result<()> {
    let contact = unlike(40, 2.6)?;
    let step = press(load(0.3)).with_force([Some(0.5 * FRICTION * load(0.3)), None]);
    let solution = slide(&contact, step, &precise(1e-10))?;
    assert!(solution.report.coupled);
    let (grid, normal) = (contact.grid(), &solution.normal);
    let (x, y) = (grid.x(), grid.y());
    let sunk = |i: usize, j: usize| normal.approach - 0.5 * (x[i].powi(2) + y[j].powi(2)) / RADIUS;
    let twice: f64 = normal.pressure.indexed_iter().map(|((i, j), p)| p * sunk(i, j)).sum();
    let [along, across] = [0, 1].map(|k| (&solution.traction[k] * &solution.displacement[k]).sum());
    let due = 0.5 * grid.cell_area() * (twice + along + across);
    let pressed = 0.5 * grid.cell_area() * (&normal.pressure * &normal.displacement).sum();
    near!(pressed + solution.tangential_energy(), due, 1e-8);
    // Without the coupling it would be another number by more than a hundredth.
    assert!(solution.report.coupling_energy.abs() > 1e-2 * solution.tangential_energy().abs());
    Ok(())
}

/// Halves with different friction: each cell within its own bound, and slipping cells on it.
#[test]
fn friction_may_differ_from_cell_to_cell() -> Result<()> {
    let (contact, load) = (pair(0.3, 48)?, load(0.3));
    let cells = Array2::from_shape_fn((48, 48), |(i, _)| if i < 24 { 0.1 } else { 0.4 });
    let step = Step::press(Motion::load(load), cells.clone()).with_force([Some(0.2 * load), None]);
    let solution = slide(&contact, step, &FrictionOptions::default())?;
    let (size, stick) = (solution.traction_size(), solution.stick());
    let mut slipping = [0; 2];
    let pressure = solution.normal.pressure.indexed_iter();
    for (at, p) in pressure.filter(|(_, p)| **p > 0.0) {
        let bound = cells[at] * p;
        assert!(size[at] <= bound * (1.0 + 1e-12));
        if !stick[at] {
            slipping[usize::from(at.0 >= 24)] += 1;
            near!(size[at], bound, 1e-9);
        }
    }
    assert!(slipping[0] > slipping[1] && slipping[1] > 0, "{slipping:?}");
    Ok(())
}

/// Cells without friction: none of them bears a traction, and their pressure still moves the surfaces of the others where
/// bodies differ. The certificate, with the operator of the whole grid, shows it.
#[test]
fn cells_may_have_no_friction() -> Result<()> {
    let contact = unlike(40, 2.6)?;
    let cells = Array2::from_shape_fn((40, 40), |(_, j)| if j < 20 { 0.0 } else { FRICTION });
    let step = Step::press(Motion::load(load(0.3)), cells)
        .with_force([Some(0.3 * FRICTION * load(0.3)), None]);
    let solution = slide(&contact, step, &FrictionOptions::default())?;
    assert!(solution.report.converged() && solution.report.violation < 1.001e-8);
    for ((_, j), q) in solution.traction_size().indexed_iter() {
        assert!(j >= 20 || *q <= 0.0);
    }
    Ok(())
}

/// Pulls along +x, −x, +y, −y are one by mirror and exchange, with layers and coupling.
#[test]
fn directions_are_equal() -> Result<()> {
    let contact = unlike(40, 2.6)?;
    let force = 0.7 * FRICTION * load(0.3);
    let pulled = |force: [f64; 2]| {
        let step = press(load(0.3)).with_force(force.map(Some));
        slide(&contact, step, &precise(1e-12))
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
            below!((a - b).abs(), 1e-10 * most, i, j, a, b);
        }
    }
    Ok(())
}

/// The body and the counterbody exchanged, seen from the other side, give the same pressure and tractions.
#[test]
fn bodies_may_be_exchanged() -> Result<()> {
    let solve = |exchanged: bool| -> Result<FrictionSolution> {
        let (a, b) = (coated(3.0, 0.2)?, material(0.2)?.into());
        // Turned about the x axis, the other body lies below: y and z change sign, and so does the motion over it.
        let (body, counter, sign) = if exchanged { (b, a, -1.0) } else { (a, b, 1.0) };
        let grid = Grid::new([32, 32], [2.6, 2.6])?;
        let contact = Contact::plan(body, grid, one_thread(counter))?;
        let force = [Some(sign * 0.7 * FRICTION * load(0.3)), Some(0.0)];
        slide(&contact, press(load(0.3)).with_force(force), &precise(1e-12))
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
    let step = press(load).with_shift([Some(far), None]);
    let solution = slide(&contact, step, &FrictionOptions::default())?;
    assert!(solution.report.full_slip && solution.report.converged());
    assert!(solution.stick().iter().all(|stick| !stick));
    // Tractions turn a little towards their own displacement.
    near!(solution.force()[0], FRICTION * load, 1e-3);
    let work = FRICTION * solution.normal.load() * far;
    near!(solution.dissipated(), work, 0.1);
    for force in [1.0, 1.5] {
        let step = press(load).with_force([Some(force * FRICTION * load), None]);
        let refused = contact.slide(&ball()?, &[step], &FrictionOptions::default(), None);
        let named = matches!(refused, Err(Error::FullSlip { .. }));
        assert!(named, "{refused:?}");
    }
    Ok(())
}

/// Two equal bodies are not coupled, so that the pressure is that without friction; different ones are.
#[test]
fn coupling_is_there_where_bodies_differ() -> Result<()> {
    let grid = || Grid::new([32, 32], [2.6, 2.6]);
    let step = || press(load(0.3)).with_force([Some(0.5 * FRICTION * load(0.3)), None]);
    let equal = equal(coated(3.0, 0.2)?, grid()?)?;
    let solution = slide(&equal, step(), &FrictionOptions::default())?;
    assert!(!solution.report.coupled);
    let normal = equal.solve(&ball()?, &Motion::load(load(0.3)), &Options::default())?;
    assert_eq!(normal.pressure, solution.normal.pressure);
    let alone = plan(coated(3.0, 0.2)?, grid()?)?;
    for coupling in [true, false] {
        let options = FrictionOptions::default().with_coupling(coupling);
        let solution = slide(&alone, step(), &options)?;
        assert_eq!(solution.report.coupled, coupling);
        // Without coupling, pressure alone does not rub.
        let pressed = slide(&alone, press(load(0.3)), &options)?;
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
    let motion = Motion::load(load(0.0)).with_tilt([Some(0.65 / RADIUS), None]);
    let step = Step::press(motion, FRICTION).with_force([None, Some(force)]);
    let solution = slide(&contact, step, &precise(1e-12))?;
    let arm = solution.normal.moment()[0] / solution.normal.load();
    assert!((arm.abs() - 0.65).abs() < 0.01);
    near!(solution.torque(), force * arm, 1e-9);
    Ok(())
}

/// Different bodies with little friction slip nearly everywhere, and a shift along both axes and a twist are found for forces
/// and a torque: each holds to the tolerance.
#[test]
fn little_friction_under_forces_and_a_torque() -> Result<()> {
    let setup = against(HalfSpace::from(Elastic::new(1e3, 0.3)?));
    let grid = Grid::new([48, 48], [3.0, 3.0])?;
    let contact = Contact::plan(Elastic::new(1.0, 0.3)?, grid, setup)?;
    let load = 4.0 / 3.0 / 0.91 / RADIUS;
    for friction in [0.01, 0.05, 0.1] {
        for [along, across, turning] in
            [[0.3, 0.3, 0.2], [0.0, 0.0, 0.0], [0.1, -0.5, 0.1], [0.02, 0.0, -0.3]]
        {
            let bears = friction * load;
            let force = [along * bears, across * bears];
            let torque = turning * bears * 3.0 * std::f64::consts::PI / 16.0;
            let step = Step::press(Motion::load(load), friction)
                .with_force(force.map(Some))
                .with_torque(Some(torque));
            let found = slide(&contact, step, &FrictionOptions::default())?;
            let [x, y] = found.force();
            for (found, due) in [(x, force[0]), (y, force[1]), (found.torque(), torque)] {
                below!((found - due).abs(), 1e-7 * bears, friction, force, torque);
            }
        }
    }
    Ok(())
}

/// Where friction is large and bodies differ, pressure and tractions change each other by more than they are: they settle
/// all the same.
#[test]
#[ignore = "slow"]
fn pressure_and_tractions_settle_under_large_friction() -> Result<()> {
    for poisson in [0.0, 0.2] {
        let contact = plan(Elastic::new(1.0, poisson)?, Grid::new([24, 24], [3.0, 3.0])?)?;
        let load =
            contact.solve(&ball()?, &Motion::approach(0.7 / RADIUS), &Options::default())?.load();
        for friction in [1.0, 3.0, 5.0] {
            for share in [0.1, 0.4, 0.8] {
                let force = share * friction * load;
                let step = Step::press(Motion::load(load), friction)
                    .with_force([Some(0.6 * force), Some(0.8 * force)]);
                let solution = slide(&contact, step, &precise(1e-7))?;
                below!(solution.report.pressure_change, 1e-7, friction, share);
            }
        }
    }
    Ok(())
}

/// Thin stiff coats in long contacts, where short waves of traction displace hardly anything.
#[test]
fn long_contacts_of_stiff_coats() -> Result<()> {
    for (cells, ratio, thickness, friction) in
        [(24, 10.0, 0.03, 0.27), (40, 25.0, 0.02, 0.4), (32, 6.0, 0.05, 0.7)]
    {
        let body = coated(ratio, thickness)?;
        let contact = plan(body, Grid::new([cells, cells], [3.0, 39.0])?)?;
        let shape = Paraboloid::new(RADIUS, 169.0 * RADIUS)?;
        let pressed =
            contact.solve(&shape, &Motion::approach(0.8 / RADIUS), &Options::default())?;
        for angle in [0.5_f64, 1.5, 4.0] {
            let force = 0.3 * friction * pressed.load();
            let step = Step::press(Motion::load(pressed.load()), friction)
                .with_force([Some(force * angle.cos()), Some(force * angle.sin())]);
            slide_once(&contact, &shape, step, &precise(1e-7))?;
        }
    }
    Ok(())
}

/// A force and a torque that friction carries alone, and not together, are refused; the largest part of both that it
/// carries is said, and 99 % of it are carried.
#[test]
fn a_force_and_a_torque_may_be_too_much_together() -> Result<()> {
    let (contact, load) = (pair(0.3, 32)?, load(0.3));
    let bears = FRICTION * load;
    let step = |part: f64| {
        press(load)
            .with_force([Some(0.8 * part * bears), Some(0.0)])
            .with_torque(Some(0.5 * part * bears))
    };
    let refused = contact.slide(&ball()?, &[step(1.0)], &FrictionOptions::default(), None);
    let Err(Error::FullSlip { value, bears: most, .. }) = refused else {
        panic!("{refused:?}");
    };
    assert!(most > 0.5 * value && most < value, "{most} {value}");
    let solution = slide(&contact, step(0.99 * most / value), &precise(1e-6))?;
    assert!(!solution.report.full_slip);
    Ok(())
}

/// At the surface, shear stress is what the traction demands, −q on the body and on the counterbody, whose z axis points
/// the other way.
#[test]
fn shear_at_the_surface_is_the_traction() -> Result<()> {
    let contact = unlike(32, 2.6)?;
    let force = [0.6, -0.3].map(|share| Some(share * FRICTION * load(0.3)));
    let step = Step::press(Motion::load(load(0.3)), FRICTION)
        .with_force(force)
        .with_torque(Some(0.1 * FRICTION * load(0.3)));
    let solution = slide(&contact, step, &FrictionOptions::default())?;
    let most = solution.normal.peak_pressure();
    for (member, sign) in [(Member::Body, -1.0), (Member::Counterbody, 1.0)] {
        let field = solution.stress(&[0.0], member, &StressOptions::default())?;
        for (shear, traction) in [field.xz(), field.yz()].into_iter().zip(&solution.traction) {
            let surface = shear.index_axis(Axis(0), 0).to_owned();
            below!(apart(&surface, &(sign * traction)), 1e-10 * most, member);
        }
    }
    Ok(())
}

/// With ν = 0, gross slip has the traction μp along the shift: its stress is that of `friction` in the evaluation of
/// stress.
#[test]
fn gross_slip_is_friction_of_the_stress_call() -> Result<()> {
    let contact = pair(0.0, 32)?;
    let step = Step::press(Motion::load(load(0.0)), FRICTION)
        .with_shift([Some(10.0 * FRICTION * load(0.0)), None]);
    let solution = slide(&contact, step, &FrictionOptions::default())?;
    assert!(solution.report.full_slip);
    let (body, depths) = (material(0.0)?.into(), [0.0, 0.2, 1.0]);
    let without = StressOptions::default();
    let with = StressOptions::default().with_friction(FRICTION).with_direction([1.0, 0.0]);
    let pressure = &solution.normal.pressure;
    let called = stress(&body, contact.grid(), pressure, &depths, &with)?;
    let pressed = stress(&body, contact.grid(), pressure, &depths, &without)?;
    let true_one = solution.stress(&depths, Member::Body, &without)?;
    let normal = solution.normal.stress(&depths, Member::Body, &without)?;
    let most = solution.normal.peak_pressure();
    for component in 0..6 {
        let due = &called.components[component] - &pressed.components[component];
        let found = &true_one.components[component] - &normal.components[component];
        below!(apart(&due, &found), 1e-10 * most, component);
    }
    assert!(called.xz().iter().any(|s| s.abs() > 0.2 * most));
    Ok(())
}
