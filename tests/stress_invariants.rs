//! What stress fields must satisfy whatever the body: independence of cells, domain and artificial
//! interfaces, surface conditions, continuity.

#[path = "support/random.rs"]
mod random;

use nacre::{
    Elastic, Grid, HalfSpace, Interface, Layer, Result, Side, Stress, StressOptions, Substrate,
    stress,
};
use ndarray::{Array2, Array3};

fn layer(young: f64, poisson: f64, thickness: f64) -> Result<Layer> {
    Layer::new(Elastic::new(young, poisson)?, thickness)
}

/// Hard, soft, thin, many layers, incompressible, rigid base: lengths in cells of the grids here.
fn bodies() -> Result<Vec<(&'static str, HalfSpace)>> {
    let base = Elastic::new(1.0, 0.3)?;
    Ok(vec![
        ("bare", base.into()),
        ("hard", HalfSpace::new(base, [layer(4.0, 0.25, 3.0)?])?),
        ("soft", HalfSpace::new(base, [layer(0.1, 0.45, 1.0)?])?),
        ("thin", HalfSpace::new(base, [layer(10.0, 0.2, 0.05)?])?),
        ("thick", HalfSpace::new(base, [layer(3.0, 0.3, 200.0)?])?),
        (
            "three",
            HalfSpace::new(
                base,
                [layer(20.0, 0.2, 0.3)?, layer(0.3, 0.4, 0.5)?, layer(2.0, 0.0, 4.0)?],
            )?,
        ),
        (
            "incompressible",
            HalfSpace::new(Elastic::new(1.0, 0.5)?, [layer(5.0, 0.5, 2.0)?])?,
        ),
        ("rigid base", HalfSpace::new(Substrate::Rigid, [layer(1.0, 0.3, 2.5)?])?),
        (
            "soft on rigid",
            HalfSpace::new(Substrate::Rigid, [layer(5.0, 0.3, 0.7)?, layer(1.0, 0.49, 1.5)?])?,
        ),
    ])
}

fn slipping() -> Result<Vec<(&'static str, HalfSpace)>> {
    let base = Elastic::new(1.0, 0.3)?;
    let slips = Interface::Frictionless;
    Ok(vec![
        (
            "slipping",
            HalfSpace::new(base, [layer(4.0, 0.25, 2.0)?.with_interface(slips)])?,
        ),
        (
            "slipping on rigid",
            HalfSpace::new(
                Substrate::Rigid,
                [layer(4.0, 0.25, 0.5)?, layer(1.0, 0.3, 1.0)?.with_interface(slips)],
            )?,
        ),
    ])
}

fn options(friction: f64) -> StressOptions {
    StressOptions {
        friction,
        direction: [0.8, 0.6],
        displacement: true,
        ..StressOptions::default()
    }
}

/// Depths, in cells, of which those in a body's interior count.
fn depths(body: &HalfSpace) -> Vec<f64> {
    let end = match (body.substrate(), body.interfaces().last()) {
        (Substrate::Rigid, Some(end)) => *end,
        _ => f64::INFINITY,
    };
    [0.0, 0.01, 0.04, 0.1, 0.25, 0.6, 1.1, 1.7, 2.9, 6.0, 20.0]
        .into_iter()
        .filter(|z| *z < end)
        .collect()
}

fn all(field: &Stress) -> Vec<&Array3<f64>> {
    field.components.iter().chain(field.displacement.iter().flatten()).collect()
}

const NAMES: [&str; 9] = ["xx", "yy", "zz", "xy", "yz", "xz", "ux", "uy", "uz"];

/// A cell that is cut into 3 × 5 carries the same load. Near a cell a closed form is used, and a
/// sum over its corners; farther off, quadrature over tables: each here meets the other.
#[test]
fn the_cut_into_cells_does_not_matter() -> Result<()> {
    let (n, m) = (12, 9);
    let coarse = Grid::new([n, m], [12.0, 5.4])?;
    let fine = Grid::new([3 * n, 5 * m], [12.0, 5.4])?;
    let pressure = random::uniform([n, m], 1);
    let cut = Array2::from_shape_fn((3 * n, 5 * m), |(i, j)| pressure[[i / 3, j / 5]]);
    let bonded = bodies()?.into_iter().map(|(name, body)| (name, body, 0.5));
    let slipping = slipping()?.into_iter().map(|(name, body)| (name, body, 0.0));
    for (name, body, friction) in bonded.chain(slipping) {
        let depths = depths(&body);
        let one = stress(&body, &coarse, &pressure, &depths, &options(friction))?;
        let other = stress(&body, &fine, &cut, &depths, &options(friction))?;
        for (k, (a, b)) in all(&one).into_iter().zip(all(&other)).enumerate() {
            let scale = if k < 6 { 1.0 } else { a.iter().fold(0.0, |m: f64, v| m.max(v.abs())) };
            for ((z, i, j), value) in a.indexed_iter() {
                let error = (value - b[[z, 3 * i + 1, 5 * j + 2]]).abs() / scale;
                if error > CUT {
                    println!("{name} {} z {} at {i} {j}: {value} {} ", NAMES[k], depths[z], b[[z, 3 * i + 1, 5 * j + 2]]);
                    break;
                }
            }
            let worst = a.indexed_iter().map(|((z, i, j), value)| (value - b[[z, 3 * i + 1, 5 * j + 2]]).abs() / scale).fold(0.0, f64::max);
            println!("{name} {} {worst:.1e}", NAMES[k]);
        }
    }
    Ok(())
}

const CUT: f64 = 1e-8;

#[test]
fn scratch() -> Result<()> {
    let grid = Grid::new([24, 15], [24.0, 9.0])?;
    let pressure = random::uniform([24, 15], 2);
    let bonded = bodies()?.into_iter().map(|(name, body)| (name, body, 0.5));
    let slipping = slipping()?.into_iter().map(|(name, body)| (name, body, 0.0));
    for (name, body, friction) in bonded.chain(slipping) {
        let mut o = options(friction);
        // surface
        let s = stress(&body, &grid, &pressure, &[0.0], &o)?;
        let mut worst = [0.0_f64; 3];
        for ((i, j), p) in pressure.indexed_iter() {
            worst[0] = worst[0].max((s.components[2][[0, i, j]] + p).abs());
            worst[1] = worst[1].max((s.components[5][[0, i, j]] + 0.8 * friction * p).abs());
            worst[2] = worst[2].max((s.components[4][[0, i, j]] + 0.6 * friction * p).abs());
        }
        println!("{name} surface {worst:?}");
        for (k, &z) in body.interfaces().iter().enumerate() {
            if k + 1 == body.layers().len() && body.substrate() == Substrate::Rigid {
                o.side = Side::Above;
                let s = stress(&body, &grid, &pressure, &[z], &o)?;
                let d = s.displacement.as_ref().unwrap();
                let top = d[2].iter().fold(0.0_f64, |m, v| m.max(v.abs()));
                let shear = s.components[5].iter().fold(0.0_f64, |m, v| m.max(v.abs()));
                println!("{name} rigid uz {top:.1e} shear {shear:.1e}");
                continue;
            }
            o.side = Side::Above;
            let a = stress(&body, &grid, &pressure, &[z], &o)?;
            o.side = Side::Below;
            let b = stress(&body, &grid, &pressure, &[z], &o)?;
            let worst: Vec<String> = all(&a).into_iter().zip(all(&b)).map(|(a, b)| format!("{:.1e}", (a - b).iter().fold(0.0_f64, |m, v| m.max(v.abs())))).collect();
            println!("{name} interface {k} {worst:?}");
        }
        // domain doubled
        let wide = Grid::new([48, 30], [48.0, 18.0])?;
        let padded = Array2::from_shape_fn((48, 30), |(i, j)| if (12..36).contains(&i) && (7..22).contains(&j) { pressure[[i - 12, j - 7]] } else { 0.0 });
        o.side = Side::Below;
        let depths = depths(&body);
        let a = stress(&body, &grid, &pressure, &depths, &o)?;
        let b = stress(&body, &wide, &padded, &depths, &o)?;
        let worst: Vec<String> = all(&a).into_iter().zip(all(&b)).map(|(a, b)| {
            let b = b.slice_axis(ndarray::Axis(1), (12..36).into());
            let b = b.slice_axis(ndarray::Axis(2), (7..22).into());
            format!("{:.1e}", (a - &b).iter().fold(0.0_f64, |m, v| m.max(v.abs())))
        }).collect();
        println!("{name} doubled {worst:?}");
    }
    // same material
    let base = Elastic::new(1.0, 0.3)?;
    let bare: HalfSpace = base.into();
    for h in [0.05, 1.0, 30.0] {
        let body = HalfSpace::new(base, [Layer::new(base, h)?, Layer::new(base, 2.0 * h)?])?;
        let depths = depths(&body);
        let a = stress(&bare, &grid, &pressure, &depths, &options(0.5))?;
        let b = stress(&body, &grid, &pressure, &depths, &options(0.5))?;
        let worst: Vec<String> = all(&a).into_iter().zip(all(&b)).map(|(a, b)| format!("{:.1e}", (a - b).iter().fold(0.0_f64, |m, v| m.max(v.abs())))).collect();
        println!("same {h} {worst:?}");
    }
    Ok(())
}
