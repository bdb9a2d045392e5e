//! Rolling.

use nacre::friction::{Friction, FrictionOptions, Rolling, RollingDirection, TangentialMotion};
use nacre::{
    Contact, Cylinder, Elastic, Grid, HalfSpace, Layer, Motion, Paraboloid, Result, Setup,
};

#[test]
fn carter() -> Result<()> {
    let (g, nu, radius, friction, creep) = (1.0, 0.28, 500.0, 0.3, 0.00024);
    let steel = Elastic::new(2.0 * g * (1.0 + nu), nu)?;
    let modulus = g / (1.0 - nu);
    let load = std::f64::consts::PI * modulus / (4.0 * radius);
    for n in [50, 100, 200, 400] {
        let cells = n + 12;
        let grid = Grid::line(cells, 2.0 * cells as f64 / n as f64)?;
        let setup = Setup {
            counterbody: Some(steel.into()),
            threads: Some(1),
            ..Setup::default()
        };
        let contact = Contact::plan(steel, grid, setup)?;
        let shape = Cylinder::new(radius)?;
        for tolerance in [1e-6, 1e-8] {
            let rolling = Rolling {
                creepage: [Some(creep), None],
                ..Rolling::new(Motion::load(load), friction, RollingDirection::PlusY)
            };
            let options = FrictionOptions {
                tolerance,
                ..FrictionOptions::default()
            };
            let s = contact.roll(&shape, &rolling, &options)?;
            let r = &s.report;
            let loaded = Rolling {
                force: [Some(0.64 * friction * load), None],
                ..Rolling::new(Motion::load(load), friction, RollingDirection::PlusY)
            };
            let l = contact.roll(&shape, &loaded, &options)?;
            println!(
                "{n}: F {:?} conv {} viol {:.1e} {:?} | loaded {:?} conv {} {:?}",
                s.force()[1] / (friction * load),
                r.convolutions,
                r.violation,
                r.termination,
                l.motion,
                l.report.convolutions,
                l.report.termination
            );
        }
    }
    Ok(())
}

#[test]
fn kalker() -> Result<()> {
    for (e, h) in [
        (1.0, 0.5),
        (4.0, 0.5),
        (0.25, 0.2),
        (0.25, 0.05),
        (0.25, 1.0),
    ] {
        let nu = 0.3;
        let g = 1.0;
        let steel = Elastic::new(2.0 * g * (1.0 + nu), nu)?;
        for n in [32, 64, 128] {
            let cells = (n as f64 / 0.83) as usize / 2 * 2;
            let grid = Grid::new([cells; 2], [2.0 * cells as f64 / n as f64; 2])?;
            let body = if e == 1.0 {
                steel.into()
            } else {
                HalfSpace::new(
                    steel,
                    [Layer::new(Elastic::new(2.0 * g * (1.0 + nu) * e, nu)?, h)?],
                )?
            };
            let setup = Setup {
                counterbody: Some(body.clone().into()),
                threads: Some(1),
                ..Setup::default()
            };
            let contact = Contact::plan(body.clone(), grid, setup)?;
            let shape = Paraboloid::new(50.0, 50.0)?;
            // find approach for radius 1 by bisection
            let (mut lo, mut hi) = (0.2 / 50.0, 1.5 / 50.0);
            let mut load = 0.0;
            for _ in 0..20 {
                let mid = 0.5 * (lo + hi);
                let s =
                    contact.solve(&shape, &Motion::approach(mid), &nacre::Options::default())?;
                load = s.load();
                if s.contact_area() > std::f64::consts::PI {
                    hi = mid
                } else {
                    lo = mid
                }
            }
            let full = FrictionOptions {
                tolerance: 1e-7,
                ..FrictionOptions::default()
            };
            for direction in [RollingDirection::PlusX] {
                let mut line = format!("E {e} h {h} n {n}:");
                for (name, creepage, spin) in [
                    ("xi", [Some(1e-5), None], 0.0),
                    ("eta", [None, Some(1e-5)], 0.0),
                    ("phi", [None, None], 1e-5),
                ] {
                    let rolling = Rolling {
                        creepage,
                        spin,
                        ..Rolling::new(Motion::load(load), Friction::Uniform(1e4), direction)
                    };
                    let t = std::time::Instant::now();
                    let s = contact.roll(&shape, &rolling, &full)?;
                    let area = s.normal.contact_area() / std::f64::consts::PI;
                    let f = s.force().map(|f| f / (g * area * 1e-5));
                    line += &format!(
                        " {name} {:.4} {:.4} conv {} {:?} {:.3}s",
                        f[0],
                        f[1] / if name == "phi" { area.sqrt() } else { 1.0 },
                        s.report.convolutions,
                        s.report.termination,
                        t.elapsed().as_secs_f64()
                    );
                }
                println!("{line}");
            }
            // partial slip
            let mu = 0.3;
            for (name, creep, spin, force) in [
                ("xi", 0.5, 0.0, None),
                ("loaded", 0.0, 0.0, Some(0.75)),
                ("spin", 0.3, 0.5, None),
            ] {
                let unit = mu * load / (g * 3.0);
                let rolling = Rolling {
                    creepage: [(force.is_none()).then_some(creep * unit), None],
                    force: [force.map(|f| f * mu * load), None],
                    spin: spin * unit,
                    ..Rolling::new(Motion::load(load), mu, RollingDirection::PlusX)
                };
                let options = FrictionOptions {
                    tolerance: 1e-6,
                    ..FrictionOptions::default()
                };
                let s = contact.roll(&shape, &rolling, &options)?;
                println!(
                    "   slip {name} n {n}: F {:?} conv {} {:?} viol {:.1e}",
                    s.force().map(|f| f / (mu * load)),
                    s.report.convolutions,
                    s.report.termination,
                    s.report.violation
                );
            }
        }
    }
    Ok(())
}

#[test]
fn bentall_johnson() -> Result<()> {
    let aluminium = Elastic::new(2.0 * 23000.0 * 1.31, 0.31)?;
    let steel = Elastic::new(2.0 * 82000.0 * 1.28, 0.28)?;
    let modulus =
        1.0 / (1.0 / aluminium.plane_strain_modulus() + 1.0 / steel.plane_strain_modulus());
    let (a, radius) = (0.1, 25.0);
    let load = std::f64::consts::PI * modulus * a * a / (4.0 * radius);
    let n = 200;
    let cells = n + 20;
    let grid = Grid::line(cells, 2.0 * a * cells as f64 / n as f64)?;
    let setup = Setup {
        counterbody: Some(steel.into()),
        threads: Some(1),
        ..Setup::default()
    };
    let contact = Contact::plan(aluminium, grid, setup)?;
    for (mu, q) in [(0.05, 0.0), (0.05, 0.75), (0.05, -0.75), (10.0, 0.0)] {
        let rolling = Rolling {
            force: [Some(q * mu * load), None],
            ..Rolling::new(Motion::load(load), mu, RollingDirection::PlusY)
        };
        let s = contact.roll(
            &Cylinder::new(radius)?,
            &rolling,
            &FrictionOptions::default(),
        )?;
        println!(
            "mu {mu} q {q}: {:?} peak {} sweeps {} conv {} {:?} viol {:.1e} change {:.1e}",
            s.motion,
            s.normal.peak_pressure(),
            s.report.sweeps,
            s.report.convolutions,
            s.report.termination,
            s.report.violation,
            s.report.pressure_change
        );
    }
    Ok(())
}
