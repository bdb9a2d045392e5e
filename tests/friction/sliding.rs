//! Partial slip under a force.

use nacre::friction::{FrictionOptions, FrictionSolution, Step, TangentialMotion};
use nacre::{
    Contact, Elastic, FlatPunch, Grid, HalfSpace, Layer, Motion, Paraboloid, Result, Setup,
};

fn pair(nu: f64, cells: usize, width: f64) -> Result<Contact> {
    let steel = Elastic::new(2.0 * (1.0 + nu), nu)?;
    let setup = Setup {
        counterbody: Some(steel.into()),
        threads: Some(1),
        ..Setup::default()
    };
    Contact::plan(steel, Grid::new([cells, cells], [width, width])?, setup)
}

fn shift(solution: &FrictionSolution) -> [f64; 2] {
    match solution.motion {
        TangentialMotion::Slide { shift, .. } => shift,
        TangentialMotion::Roll { .. } => [f64::NAN; 2],
    }
}

const RADIUS: f64 = 50.0;

/// Load at which the radius of the contact is 1.
fn load(nu: f64) -> f64 {
    4.0 / 3.0 / (1.0 - nu) / RADIUS
}

#[test]
fn loops() -> Result<()> {
    for nu in [0.0, 0.42] {
        let cells = 128;
        let contact = pair(nu, cells, 2.0 / 0.83)?;
        let (friction, load, ratio) = (0.4, load(nu), 0.875);
        let most = ratio * friction * load;
        let legs = 14;
        let mut steps = vec![Step {
            force: [Some(most), None],
            ..Step::press(Motion::load(load), friction)
        }];
        let force = |q: f64| Step {
            force: [Some(q), None],
            ..Step::default()
        };
        for k in 1..=legs {
            steps.push(force(most * (1.0 - 2.0 * k as f64 / legs as f64)));
        }
        for k in 1..=legs {
            steps.push(force(-most * (1.0 - 2.0 * k as f64 / legs as f64)));
        }
        let shape = Paraboloid::new(RADIUS, RADIUS)?;
        let t = std::time::Instant::now();
        let options = FrictionOptions {
            tolerance: 1e-8,
            ..FrictionOptions::default()
        };
        let solutions = contact.slide(&shape, &steps, &options, None)?;
        println!(
            "time {:?} conv {:?}",
            t.elapsed(),
            solutions
                .iter()
                .map(|s| s.report.convolutions)
                .collect::<Vec<_>>()
        );
        let loss: f64 = solutions[1..].iter().map(|s| s.dissipated()).sum();
        let x: f64 = ratio;
        let a_sum = 2.0 * (2.0 - nu);
        let closed = 9.0 * friction * friction * load * load * a_sum / 10.0
            * (1.0 - (1.0 - x).powf(5.0 / 3.0) - 5.0 * x / 6.0 * (1.0 + (1.0 - x).powf(2.0 / 3.0)));
        println!(
            "nu {nu} loss/closed {} all conv {}",
            loss / closed,
            solutions.iter().all(|s| s.report.converged())
        );
        // energies
        let mut worst = 0.0_f64;
        for pair in solutions.windows(2) {
            let (old, new) = (&pair[0], &pair[1]);
            let d = new.dissipated();
            let dq = [0, 1].map(|k| &new.traction[k] - &old.traction[k]);
            let du = [0, 1].map(|k| &new.displacement[k] - &old.displacement[k]);
            let cross =
                0.5 * (&dq[0] * &du[0] + &dq[1] * &du[1]).sum() * contact.grid().cell_area();
            let work = new.force()[0] * (shift(new)[0] - shift(old)[0]);
            let rest = work - (new.tangential_energy() - old.tangential_energy()) - d - cross;
            worst = worst.max(rest.abs() / d);
        }
        println!("energy identity {worst:e}");
    }
    Ok(())
}

#[test]
fn many() -> Result<()> {
    let nu = 0.3;
    let contact = pair(nu, 128, 2.0 / 0.83)?;
    let shape = Paraboloid::new(RADIUS, RADIUS)?;
    let (friction, load) = (0.3, load(nu));
    let options = FrictionOptions::default();
    let base = Step::press(Motion::load(load), friction);
    let unit = friction * load; // shift scale
    for (name, step) in [
        (
            "shift",
            Step {
                shift: [Some(0.5 * unit), None],
                ..base.clone()
            },
        ),
        (
            "shift gross",
            Step {
                shift: [Some(5.0 * unit), None],
                ..base.clone()
            },
        ),
        (
            "twist",
            Step {
                twist: Some(0.5 * unit),
                ..base.clone()
            },
        ),
        (
            "torque",
            Step {
                torque: Some(0.3 * unit),
                ..base.clone()
            },
        ),
        (
            "force both",
            Step {
                force: [Some(0.6 * unit), Some(-0.3 * unit)],
                ..base.clone()
            },
        ),
        (
            "force + torque",
            Step {
                force: [Some(0.6 * unit), Some(-0.3 * unit)],
                torque: Some(0.1 * unit),
                ..base.clone()
            },
        ),
        (
            "force 0.999",
            Step {
                force: [Some(0.999 * unit), None],
                ..base.clone()
            },
        ),
        (
            "shift + force",
            Step {
                shift: [Some(0.5 * unit), None],
                force: [None, Some(0.3 * unit)],
                ..base.clone()
            },
        ),
    ] {
        let s = contact.slide(&shape, &[step], &options, None)?;
        let r = &s[0].report;
        println!(
            "{name}: {:?} conv {} viol {:.1e} imb {:.1e} full {} motion {:?} force {:?} torque {}",
            r.termination,
            r.convolutions,
            r.violation,
            r.imbalance,
            r.full_slip,
            s[0].motion,
            s[0].force().map(|f| f / unit),
            s[0].torque() / unit
        );
    }
    Ok(())
}

#[test]
fn stiffness() -> Result<()> {
    use crate::support::reference::{cases, number};
    for case in cases("friction/stick_stiffness.json") {
        if case.get("layers").is_some() {
            continue;
        }
        let (e, h) = (number(&case, "E1_over_E2"), number(&case, "h_over_a"));
        let soft = Elastic::new(2.6, 0.3)?;
        for cells in [32, 64, 128] {
            // cells across the diameter
            let n = cells + 8;
            let width = 2.0 * n as f64 / cells as f64;
            let found = [Some(h), None].map(|h| -> Result<[f64; 2]> {
                // radius of equal area
                let grid = Grid::new([n, n], [width, width])?;
                let area: f64 = {
                    let x = grid.x();
                    let mut c = 0.0;
                    for a in &x {
                        for b in &x {
                            if a.hypot(*b) < 1.0 {
                                c += grid.cell_area();
                            }
                        }
                    }
                    c
                };
                let radius = (area / std::f64::consts::PI).sqrt();
                let body = match h {
                    Some(h) => HalfSpace::new(
                        soft,
                        [Layer::new(Elastic::new(2.6 * e, 0.3)?, h * radius)?],
                    )?,
                    None => soft.into(),
                };
                let setup = Setup {
                    counterbody: Some(body.clone().into()),
                    threads: Some(1),
                    ..Setup::default()
                };
                let contact = Contact::plan(body, grid, setup)?;
                let shape = FlatPunch::new(1.0)?;
                let step = Step {
                    force: [Some(1e-4), None],
                    torque: Some(1e-4),
                    ..Step::press(Motion::load(1.0), 1e3)
                };
                let s = &contact.slide(&shape, &[step], &FrictionOptions::default(), None)?[0];
                let TangentialMotion::Slide { shift, twist } = s.motion else {
                    panic!()
                };
                if cells == 128 {
                    println!(
                        "   conv {} {:?}",
                        s.report.convolutions, s.report.termination
                    );
                }
                Ok([
                    1e-4 / shift[0] / (8.0 * radius / 1.7) * 2.0,
                    1e-4 / twist / (16.0 * radius.powi(3) / 3.0) * 2.0,
                ])
            });
            let [Ok(coated), Ok(bare)] = found else {
                panic!()
            };
            println!(
                "E {e} h {h} n {cells}: trans {:.6} {:.6} ref {:.6}; torsion {:.6} {:.6} ref {:.6}",
                coated[0],
                coated[0] / bare[0],
                number(&case, "stiffness_over_bare"),
                coated[1],
                coated[1] / bare[1],
                number(&case, "torsion_over_bare")
            );
        }
    }
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
        for [along, across, turning] in [[0.3, 0.3, 0.2], [0.0, 0.0, 0.0], [0.1, -0.5, 0.1], [0.02, 0.0, -0.3]]
        {
            let bears = friction * load;
            let (force, torque) = ([along * bears, across * bears], turning * bears * 3.0 * PI / 16.0);
            let step = Step {
                force: force.map(Some),
                torque: Some(torque),
                ..Step::press(Motion::load(load), friction)
            };
            let found = contact.slide(&shape, &[step], &FrictionOptions::default(), None)?;
            let report = &found[0].report;
            assert!(report.converged(), "{friction} {force:?} {torque}: {report:?}");
            let error = |found: f64, due: f64| (found - due).abs();
            let [x, y] = found[0].force();
            assert!(error(x, force[0]).max(error(y, force[1])) < 1e-7 * bears);
            assert!(error(found[0].torque(), torque) < 1e-7 * bears);
        }
    }
    Ok(())
}
