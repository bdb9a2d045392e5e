//! Rolling: Carter, Bentall and Johnson, Kalker's sign conventions, and the way to the steady state.

use nacre::friction::{
    FrictionOptions, FrictionSolution, Rolling, RollingDirection, Step, TangentialMotion,
};
use nacre::{Contact, Cylinder, Elastic, Grid, Motion, Result, Setup};

use crate::support::pairs::{RADIUS, ball, coated, creepage, equal, load, material, pair};

/// Two equal cylinders on `cells` across a contact of half width 1: data of an example of CONTACT's.
fn carter(cells: usize) -> Result<(Contact, Cylinder, f64)> {
    let (shear, nu, radius) = (1.0, 0.28, 500.0);
    let all = cells + 12;
    let grid = Grid::line(all, 2.0 * all as f64 / cells as f64)?;
    let contact = equal(material(nu)?, grid)?;
    let load = std::f64::consts::PI * shear / (1.0 - nu) / (4.0 * radius);
    Ok((contact, Cylinder::new(radius)?, load))
}

/// Force over μP of Carter's problem at the creepage of CONTACT's example, exactly 0.64; with the mean of Hertz's
/// pressure over cells, 50 cells have 0.64452, and the error falls in proportion to their size.
#[test]
fn carters_force() -> Result<()> {
    let friction = 0.3;
    let force = |cells: usize| -> Result<f64> {
        let (contact, shape, load) = carter(cells)?;
        let rolling = Rolling {
            creepage: [Some(0.00024), None],
            ..Rolling::new(Motion::load(load), friction, RollingDirection::PlusY)
        };
        let solution = contact.roll(&shape, &rolling, &FrictionOptions::default())?;
        assert!(solution.report.converged());
        let share = solution.force()[1] / (friction * load);
        // The other way round: the creepage of that force.
        let loaded = Rolling {
            creepage: [None, None],
            force: [Some(share * friction * load), None],
            ..rolling
        };
        let back = contact.roll(&shape, &loaded, &FrictionOptions::default())?;
        assert!((creepage(&back)[0] / 0.00024 - 1.0).abs() < 1e-6);
        Ok(share)
    };
    let [coarse, middle, fine] = [50, 200, 400].map(force);
    let coarse = coarse?;
    assert!((coarse - 0.6445).abs() < 3e-4, "{coarse}");
    let extrapolated = 2.0 * fine? - middle?;
    assert!((extrapolated - 0.64).abs() < 1e-4, "{extrapolated}");
    Ok(())
}

/// An aluminium cylinder on steel: free rolling, traction and braking creep as a dense program and CONTACT have it, after
/// Bentall and Johnson, Int. J. Mech. Sci. 9 (1967) 389, doi:10.1016/0020-7403(67)90043-4.
#[test]
fn bentall_and_johnson() -> Result<()> {
    let aluminium = Elastic::new(2.0 * 23000.0 * 1.31, 0.31)?;
    let steel = Elastic::new(2.0 * 82000.0 * 1.28, 0.28)?;
    let modulus =
        1.0 / (1.0 / aluminium.plane_strain_modulus() + 1.0 / steel.plane_strain_modulus());
    let (half, radius) = (0.1, 25.0);
    let load = std::f64::consts::PI * modulus * half * half / (4.0 * radius);
    let grid = Grid::line(220, 2.0 * half * 1.1)?;
    let setup = Setup {
        counterbody: Some(steel.into()),
        threads: Some(1),
        ..Setup::default()
    };
    let contact = Contact::plan(aluminium, grid, setup)?;
    for (friction, share, creep, peak, bar) in [
        (0.05, 0.0, 4.2945e-4, 103.63, 3e-3),
        (0.05, 0.75, 5.3924e-4, 103.28, 3e-3),
        (0.05, -0.75, 2.1088e-4, 103.22, 3e-3),
        // The edge cells decide here.
        (10.0, 0.0, 3.592e-4, 103.81, 2e-2),
    ] {
        let rolling = Rolling {
            force: [Some(share * friction * load), None],
            ..Rolling::new(Motion::load(load), friction, RollingDirection::PlusY)
        };
        let shape = Cylinder::new(radius)?;
        let solution = contact.roll(&shape, &rolling, &FrictionOptions::default())?;
        assert!(solution.report.converged());
        let found = creepage(&solution)[0];
        assert!(
            (found / creep - 1.0).abs() < bar,
            "{friction} {share}: {found:e}"
        );
        let pressure = solution.normal.peak_pressure();
        assert!((pressure / peak - 1.0).abs() < 1e-3, "{pressure}");
        assert!(solution.report.sweeps <= 8);
    }
    Ok(())
}

/// Rolling towards −x, +y and −y is rolling towards +x by mirror and exchange, with spin, both creepages and coupling.
#[test]
fn directions_are_equal() -> Result<()> {
    let setup = Setup {
        counterbody: Some(material(0.2)?.into()),
        threads: Some(1),
        ..Setup::default()
    };
    let n = 32;
    let contact = Contact::plan(coated(3.0, 0.2)?, Grid::new([n, n], [2.8, 2.8])?, setup)?;
    let options = FrictionOptions {
        tolerance: 1e-12,
        ..FrictionOptions::default()
    };
    let unit = 0.3 * load(0.3);
    let roll = |direction| {
        let rolling = Rolling {
            creepage: [Some(0.2 * unit), Some(-0.1 * unit)],
            spin: 0.1 * unit,
            ..Rolling::new(Motion::load(load(0.3)), 0.3, direction)
        };
        contact.roll(&ball()?, &rolling, &options)
    };
    let ahead = roll(RollingDirection::PlusX)?;
    assert!(ahead.report.converged() && !ahead.report.full_slip);
    let most = 0.3 * ahead.normal.peak_pressure();
    // A turn by 90° takes (x, y) to (−y, x), cell (i, j) to (n − 1 − j, i), and (q_x, q_y) to (−q_y, q_x).
    let mut turned = ahead;
    for direction in [
        RollingDirection::PlusY,
        RollingDirection::MinusX,
        RollingDirection::MinusY,
    ] {
        let next = roll(direction)?;
        for ((i, j), qx) in turned.traction[0].indexed_iter() {
            let (k, l) = (n - 1 - j, i);
            let qy = turned.traction[1][[i, j]];
            assert!(
                (next.traction[1][[k, l]] - qx).abs() < 1e-10 * most,
                "{direction:?} {i} {j}"
            );
            assert!(
                (next.traction[0][[k, l]] + qy).abs() < 1e-10 * most,
                "{direction:?} {i} {j}"
            );
        }
        turned = next;
    }
    Ok(())
}

/// Rolling on from no traction, cell by cell, until the steady state is reached; in the plane it takes longer.
#[test]
fn transient_rolling_tends_to_the_steady_state() -> Result<()> {
    let options = FrictionOptions {
        tolerance: 1e-9,
        ..FrictionOptions::default()
    };
    let end = |contact: &Contact, shape: &dyn nacre::Surface, rolling: &Rolling, cells: usize| {
        let all = vec![rolling.clone(); cells];
        let mut solutions = contact.roll_transient(shape, &all, &options, None)?;
        Ok::<FrictionSolution, nacre::Error>(solutions.pop().expect("steps"))
    };
    let (contact, shape, line_load) = carter(30)?;
    let rolling = Rolling {
        force: [Some(0.6 * 0.3 * line_load), None],
        ..Rolling::new(Motion::load(line_load), 0.3, RollingDirection::PlusY)
    };
    let steady = contact.roll(&shape, &rolling, &options)?;
    let reached = end(&contact, &shape, &rolling, 450)?;
    let most = 0.3 * steady.normal.peak_pressure();
    let same = |steady: &FrictionSolution, reached: &FrictionSolution, most: f64| {
        let pairs = steady.traction.iter().flatten();
        pairs
            .zip(reached.traction.iter().flatten())
            .map(|(a, b)| (a - b).abs() / most)
            .fold(0.0, f64::max)
    };
    assert!(
        same(&steady, &reached, most) < 1e-5,
        "{}",
        same(&steady, &reached, most)
    );
    assert!((creepage(&reached)[0] / creepage(&steady)[0] - 1.0).abs() < 1e-5);

    let contact = pair(0.3, 24)?;
    let rolling = Rolling {
        force: [Some(0.6 * 0.3 * load(0.3)), None],
        spin: 0.1 * 0.3 * load(0.3),
        ..Rolling::new(Motion::load(load(0.3)), 0.3, RollingDirection::PlusX)
    };
    let steady = contact.roll(&ball()?, &rolling, &options)?;
    let most = 0.3 * steady.normal.peak_pressure();
    let reached = end(&contact, &ball()?, &rolling, 160)?;
    assert!(
        same(&steady, &reached, most) < 1e-5,
        "{}",
        same(&steady, &reached, most)
    );
    Ok(())
}

/// Work of creepages and spin is dissipated, but for what leaves with the trailing edge: none where it slips. With ν = 0
/// and partial slip, from Carter's law.
#[test]
fn power_is_dissipated() -> Result<()> {
    let (contact, shape, load) = carter(200)?;
    let rolling = Rolling {
        creepage: [Some(0.00024), None],
        ..Rolling::new(Motion::load(load), 0.3, RollingDirection::PlusY)
    };
    let solution = contact.roll(&shape, &rolling, &FrictionOptions::default())?;
    let power = solution.force()[1] * 0.00024;
    // First order in the cells.
    assert!((solution.dissipated() / power - 1.0).abs() < 0.02);
    Ok(())
}

/// A contact that is pressed and pulled, then rolls: the history of sliding is where transient rolling begins.
#[test]
fn rolling_begins_where_sliding_ended() -> Result<()> {
    let contact = pair(0.3, 24)?;
    let force = 0.5 * 0.3 * load(0.3);
    let pulled = Step {
        force: [Some(force), None],
        ..Step::press(Motion::load(load(0.3)), 0.3)
    };
    let options = FrictionOptions::default();
    let solutions = contact.slide(&ball()?, &[pulled], &options, None)?;
    let rolling = Rolling {
        force: [Some(force), None],
        ..Rolling::new(Motion::load(load(0.3)), 0.3, RollingDirection::PlusX)
    };
    let rolled = contact.roll_transient(&ball()?, &[rolling], &options, solutions.last())?;
    let (first, next) = (&solutions[0], &rolled[0]);
    assert!(next.report.converged());
    assert!((next.force()[0] / force - 1.0).abs() < 1e-7);
    assert!(matches!(next.motion, TangentialMotion::Roll { .. }));
    // One cell of 24 changes the tractions a little, and not none.
    let most = 0.3 * first.normal.peak_pressure();
    let changes = first.traction[0]
        .iter()
        .zip(&next.traction[0])
        .map(|(a, b)| (a - b).abs());
    let change = changes.fold(0.0, f64::max) / most;
    assert!(change > 0.01 && change < 0.9, "{change}");
    Ok(())
}

/// The contact of `pairs` is that of Hertz.
#[test]
fn a_ball_has_hertzs_contact() -> Result<()> {
    let solution = pair(0.3, 64)?.solve(
        &ball()?,
        &Motion::load(load(0.3)),
        &nacre::Options::default(),
    )?;
    let radius = (solution.contact_area() / std::f64::consts::PI).sqrt();
    assert!((radius - 1.0).abs() < 0.02 && RADIUS > 20.0 * radius);
    Ok(())
}
