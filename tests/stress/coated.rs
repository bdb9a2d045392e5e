//! Stress below contacts on one coating, and below a loaded disc on several layers, against Hankel
//! and Fourier integrals of their exact pressures.

use crate::support::claims::claim;
use crate::support::reference::{cases, list, number};
use crate::support::stresses::on;
use nacre::{
    Contact, Elastic, Grid, HalfSpace, Interface, Layer, Member, Motion, Options, Paraboloid,
    Result, Section, Setup, Side, Solution, Stress, StressOptions, stress,
};
use ndarray::{Array1, Array2, Array3};
use serde_json::Value;

/// Poisson's ratio of every case of contact, and the radius of curvature in contact radii.
const NU: f64 = 0.3;
const RADIUS: f64 = 1e3;

fn coated(ratio: f64, thickness: f64) -> Result<HalfSpace> {
    let coating = Layer::new(Elastic::new(ratio, NU)?, thickness)?;
    HalfSpace::new(Elastic::new(1.0, NU)?, [coating])
}

/// Plane strain modulus E* of the substrate.
fn modulus() -> f64 {
    1.0 / (1.0 - NU * NU)
}

fn on_axis(solution: &Solution, point: &Value, thickness: f64) -> Result<Stress> {
    let options = StressOptions::default()
        .with_section(Section::Axis([0.0, 0.0]))
        .with_side(if number(point, "layer") > 0.0 { Side::Below } else { Side::Above });
    solution.stress(&[number(point, "z_over_h") * thickness], Member::Body, &options)
}

/// Largest value of |field|, and its position along `x`.
fn largest(field: &Array3<f64>, x: &Array1<f64>) -> (f64, f64) {
    let found = field
        .iter()
        .zip(x)
        .fold((0.0_f64, 0.0), |best, (v, x)| if v.abs() > best.0 { (v.abs(), *x) } else { best });
    (found.0, found.1.abs())
}

/// Value of a field at `at`, by interpolation of fourth order.
fn at(field: &Array3<f64>, x: &Array1<f64>, at: f64) -> f64 {
    let values: Vec<f64> = field.iter().copied().collect();
    let position = (at - x[0]) / (x[1] - x[0]);
    let first = (position as usize).saturating_sub(1).min(values.len() - 4);
    let t = position - first as f64;
    (0..4)
        .map(|a| {
            let others = (0..4).filter(|b| *b != a);
            let weight: f64 = others.map(|b| (t - b as f64) / (a as f64 - b as f64)).product();
            weight * values[first + a]
        })
        .sum()
}

/// Value of a field at `edge`, by the cubic through the four cells beyond it, where the field is
/// smooth.
fn outside(field: &Array3<f64>, x: &Array1<f64>, edge: f64) -> f64 {
    let first = x.iter().position(|x| *x > edge).unwrap_or(0);
    let places = x.iter().skip(first).take(4).copied().collect();
    let values = Array3::from_shape_fn((1, 4, 1), |(_, k, _)| field[[0, first + k, 0]]);
    at(&values, &places, edge)
}

/// Errors of one case of the sphere on a square of n cells: stress on the axis, interface shear and
/// its place, surface tension beyond 1.05 a, and the cusp at a.
fn sphere_errors(case: &Value, n: usize) -> Result<[f64; 5]> {
    let thickness = number(case, "h_over_aH");
    let a = number(case, "a_over_aH");
    let body = coated(number(case, "E1_over_E2"), thickness)?;
    let load = 4.0 * modulus() / (3.0 * RADIUS);
    let hertz = 1.5 * load / std::f64::consts::PI;
    let grid = Grid::new([n, n], [3.4 * a, 3.4 * a])?;
    let contact = Contact::plan(&body, grid, Setup::default())?;
    let shape = Paraboloid::new(RADIUS, RADIUS)?;
    let solution = contact.solve(&shape, &Motion::load(load), &Options::default())?;
    let mut errors = [0.0_f64; 5];
    for point in list(case, "axis") {
        let field = on_axis(&solution, point, thickness)?;
        let mises = field.von_mises();
        for (values, name) in [(field.zz(), "szz"), (field.xx(), "srr"), (&mises, "vm")] {
            let error = (values[[0, 0, 0]] / hertz - number(point, name)).abs();
            errors[0] = errors[0].max(error / number(case, "p0_over_pH"));
        }
    }
    let section = on(Section::Y(0.0));
    let interface = solution.stress(&[thickness], Member::Body, &section)?;
    let (shear, place) = largest(interface.xz(), &interface.x);
    errors[1] = (shear / hertz / number(case, "interface_shear_max_over_pH") - 1.0).abs();
    errors[2] = (place - number(case, "interface_shear_at_r_over_aH")).abs();
    let surface = solution.stress(&[0.0], Member::Body, &section)?;
    let radial = surface.xx();
    let reference = &case["surface"];
    let exact = list(reference, "srr_over_pH").iter().filter_map(Value::as_f64);
    let radii = list(reference, "r_over_a").iter().filter_map(Value::as_f64);
    for (r, exact) in radii.zip(exact) {
        if (1.05..1.6).contains(&r) {
            let error = at(radial, &surface.x, r * a) / hertz - exact;
            errors[3] = errors[3].max(error.abs() / number(case, "p0_over_pH"));
        }
    }
    let cusp = outside(radial, &surface.x, a) / hertz;
    errors[4] = (cusp / number(case, "srr_at_edge_over_pH") - 1.0).abs();
    Ok(errors)
}

/// A sphere on a coating, on 65 and 257 cells over 3.4 contact radii. Inside, errors are of second
/// order in the cell. The tension has a cusp at the edge of the contact; it errs there by the place
/// of the edge, some thousandths of a cell, or 1e-4 of the peak pressure. On a coating of four
/// times the substrate's modulus that is half a per cent of the tension.
#[test]
#[ignore = "slow"]
fn sphere_on_a_coating() -> Result<()> {
    for case in cases("stress_sphere.json") {
        let (coarse, fine) = (sphere_errors(&case, 65)?, sphere_errors(&case, 257)?);
        claim("coated-sphere-axis", fine[0]);
        claim("coated-sphere-interface", fine[1]);
        claim("coated-sphere-tension", fine[3]);
        claim("coated-sphere-cusp", fine[4]);
        // The largest interface shear is found at a cell.
        assert!(fine[2] < 3.4 / 257.0, "{case}: {fine:?}");
        for (k, falls) in [(0, 0.1), (3, 0.05)] {
            assert!(fine[k] < falls * coarse[k], "{case}: {coarse:?} {fine:?}");
        }
        assert!(coarse[4] < 2e-2, "{case}: {coarse:?}");
    }
    Ok(())
}

/// Stress on the axis and shear at the interface below a cylinder, on 151 and 601 strips over 3.2
/// half-widths.
#[test]
#[ignore = "slow"]
fn cylinder_on_a_coating() -> Result<()> {
    for case in cases("stress_line.json") {
        let thickness = number(&case, "h_over_bH");
        let body = coated(number(&case, "E1_over_E2"), thickness)?;
        let load = std::f64::consts::PI * modulus() / (4.0 * RADIUS);
        let hertz = 2.0 * load / std::f64::consts::PI;
        let solved = |n: usize| -> Result<[f64; 3]> {
            let grid = Grid::line(n, 3.2 * number(&case, "b_over_bH"))?;
            let contact = Contact::plan(&body, grid, Setup::default())?;
            let shape = Paraboloid::new(1e9, RADIUS)?;
            let solution = contact.solve(&shape, &Motion::load(load), &Options::default())?;
            let mut errors = [0.0_f64; 3];
            for point in list(&case, "axis") {
                let field = on_axis(&solution, point, thickness)?;
                let mises = field.von_mises();
                for (values, name) in [(field.zz(), "szz"), (field.yy(), "sxx"), (&mises, "vm")] {
                    let error = (values[[0, 0, 0]] / hertz - number(point, name)).abs();
                    errors[0] = errors[0].max(error);
                }
            }
            let interface =
                solution.stress(&[thickness], Member::Body, &StressOptions::default())?;
            let (shear, place) = largest(interface.yz(), &interface.y);
            errors[1] = (shear / hertz / number(&case, "interface_shear_max_over_pH") - 1.0).abs();
            errors[2] = (place - number(&case, "at_x_over_bH")).abs();
            Ok(errors)
        };
        let (coarse, fine) = (solved(151)?, solved(601)?);
        claim("coated-cylinder-axis", fine[0]);
        claim("coated-cylinder-interface", fine[1]);
        assert!(fine[2] < 3.2 / 601.0, "{case}: {fine:?}");
        assert!(fine[0] < 0.1 * coarse[0], "{case}: {coarse:?} {fine:?}");
    }
    Ok(())
}

/// Discs on pavements: KENPAVE's and AMADEUS' cases, and Burmister's.
#[test]
#[ignore = "slow"]
fn disc_on_layers() -> Result<()> {
    const CUT: usize = 16;
    for case in cases("stress_disc.json") {
        let layers = list(&case, "layers");
        let value = |layer: &Value, k: usize| layer[k].as_f64().unwrap_or(f64::NAN);
        let material = |layer: &Value| Elastic::new(value(layer, 1), value(layer, 2));
        let slips = |k: usize| list(&case, "slip").iter().any(|s| s.as_u64() == Some(k as u64));
        let coatings = layers[..layers.len() - 1]
            .iter()
            .enumerate()
            .map(|(k, layer)| {
                let made = Layer::new(material(layer)?, value(layer, 0))?;
                let interface = if slips(k) { Interface::Frictionless } else { Interface::Bonded };
                Ok(made.with_interface(interface))
            })
            .collect::<Result<Vec<_>>>()?;
        let body = HalfSpace::new(material(&layers[layers.len() - 1])?, coatings)?;
        let radius = number(&case, "load_radius");
        let rows = list(&case, "rows");
        let reach = rows.iter().map(|row| number(row, "r")).fold(radius, f64::max);
        let d = radius / 64.0;
        let n = 2 * (1.06 * reach / d) as usize + 1;
        let grid = Grid::new([n, n], [n as f64 * d; 2])?;
        let (x, y) = (grid.x(), grid.y());
        let within = |k: usize| ((k as f64 + 0.5) / CUT as f64 - 0.5) * d;
        let pressure = Array2::from_shape_fn((n, n), |(i, j)| {
            let mut inside = 0;
            for a in 0..CUT {
                for b in 0..CUT {
                    let r = (x[i] + within(a)).hypot(y[j] + within(b));
                    inside += usize::from(r < radius);
                }
            }
            inside as f64 / (CUT * CUT) as f64
        });
        let deepest = rows.iter().map(|row| number(row, "uz")).fold(0.0_f64, f64::max);
        let mut worst = 0.0_f64;
        for row in rows {
            let options = StressOptions::default()
                .with_section(Section::Y(0.0))
                .with_side(if number(row, "side") < 0.0 { Side::Above } else { Side::Below })
                .with_displacement(true);
            let field = stress(&body, &grid, &pressure, &[number(row, "z")], &options)?;
            let Some(displacement) = &field.displacement else { panic!("asked for") };
            for (values, name, scale) in [
                (field.zz(), "szz", 1.0),
                (field.xz(), "srz", 1.0),
                (field.xx(), "srr", 1.0),
                (field.yy(), "stt", 1.0),
                (&displacement[2], "uz", deepest),
                (&displacement[0], "ur", deepest),
            ] {
                let error = at(values, &field.x, number(row, "r")) - number(row, name);
                worst = worst.max(error.abs() / scale);
            }
        }
        // Fractions of 1/256 of a cell at the rim, and interpolation of fourth order.
        assert!(worst < 1e-4, "{}: {worst:.1e}", case["name"]);
    }
    Ok(())
}
