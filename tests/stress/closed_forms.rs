//! Stress in a bare half-space, under pressure that is uniform over cells, against closed forms: a
//! uniformly loaded rectangle, Hertz contacts, sliding line contact. On a coated one, equilibrium
//! and Hooke's law.

use std::f64::consts::PI;

use crate::support::claims::claim;
use crate::support::huber::huber;
use crate::support::stresses::{displaced, on, sliding};
use nacre::stress::Strengths;
use nacre::{Elastic, Grid, HalfSpace, Layer, Result, Section, StressOptions, StressPlan, stress};
use ndarray::{Array2, Array3};

const NU: f64 = 0.3;

fn steel() -> Result<HalfSpace> {
    Ok(Elastic::new(1.0, NU)?.into())
}

/// Stresses xx, yy, zz, xy, yz, xz and displacements ux, uy, uz of a unit force into the body, for
/// E = 1: Boussinesq, after Johnson, Contact Mechanics (1985), eqs (3.18), (3.19),
/// doi:10.1017/CBO9781139171731.
fn boussinesq(x: f64, y: f64, z: f64) -> [f64; 9] {
    let r2 = x * x + y * y;
    let root = (r2 + z * z).sqrt();
    let lean = root + z;
    let far = 1.0 - 2.0 * NU;
    let radial = far / (root * lean) - 3.0 * r2 * z / root.powi(5);
    let hoop = far * (z / root.powi(3) - 1.0 / (root * lean));
    let (c2, s2, cs) = (x * x / r2, y * y / r2, x * y / r2);
    let shear = -3.0 * z * z / root.powi(5);
    let u = (1.0 + NU) / root;
    let outward = u * (z / (root * root) - far / lean);
    [
        radial * c2 + hoop * s2,
        radial * s2 + hoop * c2,
        -3.0 * z.powi(3) / root.powi(5),
        (radial - hoop) * cs,
        shear * y,
        shear * x,
        outward * x,
        outward * y,
        u * (2.0 * (1.0 - NU) + z * z / (root * root)),
    ]
    .map(|v| v / (2.0 * PI))
}

/// Stresses and displacements of a unit force along x, in the order of [`boussinesq`]: Cerruti,
/// after Johnson, eqs (3.75), (3.76).
fn cerruti(x: f64, y: f64, z: f64) -> [f64; 9] {
    let root = (x * x + y * y + z * z).sqrt();
    let lean = root + z;
    let far = 1.0 - 2.0 * NU;
    let (r3, r5) = (root.powi(3), root.powi(5));
    let common = 1.0 / (r3 * lean.powi(2)) + 2.0 / (root.powi(2) * lean.powi(3));
    let square = 1.0 / (root * lean.powi(2));
    // 1/4πG = (1 + ν)/2π.
    let g = 1.0 + NU;
    [
        -3.0 * x.powi(3) / r5 + far * x * (1.0 / r3 - 3.0 * square + x * x * common),
        -3.0 * x * y * y / r5 + far * x * (1.0 / r3 - square + y * y * common),
        -3.0 * x * z * z / r5,
        -3.0 * x * x * y / r5 + far * y * (x * x * common - square),
        -3.0 * x * y * z / r5,
        -3.0 * x * x * z / r5,
        g * (1.0 / root + x * x / r3 + far * (1.0 / lean - x * x * square)),
        g * (x * y / r3 - far * x * y * square),
        g * (x * z / r3 + far * x / (root * lean)),
    ]
    .map(|v| v / (2.0 * PI))
}

/// Nodes and weights of Gauss' quadrature with five points on [−1, 1].
const GAUSS: [(f64, f64); 5] = [
    (0.0, 0.568_888_888_888_888_9),
    (0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
    (-0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
    (0.906_179_845_938_664, 0.236_926_885_056_189_1),
    (-0.906_179_845_938_664, 0.236_926_885_056_189_1),
];

/// Integral of f over the rectangle of half sides a, b around (x, y), which is quartered until its
/// distance is twice its width.
fn integral(
    f: &impl Fn(f64, f64) -> [f64; 9],
    [x, y]: [f64; 2],
    [a, b]: [f64; 2],
    z: f64,
) -> [f64; 9] {
    let outside = (x.abs() - a).max(0.0).hypot((y.abs() - b).max(0.0)).hypot(z);
    let mut sum = [0.0; 9];
    let mut add = |weight: f64, values: [f64; 9]| {
        sum.iter_mut().zip(values).for_each(|(s, v)| *s += weight * v);
    };
    if outside < 3.0 * a.max(b) {
        for (sx, sy) in [(-0.5, -0.5), (-0.5, 0.5), (0.5, -0.5), (0.5, 0.5)] {
            add(1.0, integral(f, [x + sx * a, y + sy * b], [0.5 * a, 0.5 * b], z));
        }
        return sum;
    }
    for (u, wu) in GAUSS {
        for (v, wv) in GAUSS {
            add(a * b * wu * wv, f(x + a * u, y + b * v));
        }
    }
    sum
}

const NAMES: [&str; 9] = ["xx", "yy", "zz", "xy", "yz", "xz", "ux", "uy", "uz"];

/// Stress of a rectangle of whole cells against the integral of point forces. The quadrature here
/// keeps some 1e-7 (five points, a panel half as wide as its distance); the code under test uses
/// closed forms or keeps as much.
#[test]
fn a_uniform_rectangle_is_an_integral_of_point_loads() -> Result<()> {
    let grid = Grid::new([16, 12], [16.0, 9.0])?;
    let (x, y) = (grid.x(), grid.y());
    let half = [3.0, 1.5];
    let pressure = Array2::from_shape_fn((16, 12), |(i, j)| {
        f64::from(u8::from(x[i].abs() < half[0] && y[j].abs() < half[1]))
    });
    let depths = [0.075, 0.1, 0.3, 1.0, 2.5, 8.0];
    let pressed = displaced(StressOptions::default());
    let sliding = pressed.clone().with_friction(1.0).with_direction([1.0, 0.0]);
    let pressed = stress(&steel()?, &grid, &pressure, &depths, &pressed)?;
    let sliding = stress(&steel()?, &grid, &pressure, &depths, &sliding)?;
    let value = |field: &nacre::Stress, k: usize, at: [usize; 3]| match &field.displacement {
        Some(u) if k > 5 => u[k - 6][at],
        _ => field.components[k][at],
    };
    for (d, &z) in depths.iter().enumerate() {
        for i in [0, 4, 5, 7, 8, 10, 11, 15] {
            for j in [0, 3, 4, 5, 6, 8] {
                let at = [x[i], y[j]];
                // Seen from the point, the load lies at −(x, y); the kernels look back.
                let normal = integral(&|x, y| boussinesq(x, y, z), at, half, z);
                let lateral = integral(&|x, y| cerruti(x, y, z), at, half, z);
                for k in 0..9 {
                    let (p, q) = (value(&pressed, k, [d, i, j]), value(&sliding, k, [d, i, j]));
                    for (name, value, exact) in [("p", p, normal[k]), ("q", q - p, lateral[k])] {
                        println!("{name} {} at {at:?}, {z}: {value} {exact}", NAMES[k]);
                        claim("rectangle", (value - exact) / exact.abs().max(1.0));
                    }
                }
            }
        }
    }
    Ok(())
}

/// Mean of √(1 − r²) over each cell.
fn hertz_pressure(grid: &Grid) -> Array2<f64> {
    const CUT: usize = 12;
    let (x, y) = (grid.x(), grid.y());
    let [dx, dy] = grid.spacing();
    let within = |k: usize, d: f64| ((k as f64 + 0.5) / CUT as f64 - 0.5) * d;
    Array2::from_shape_fn((x.len(), y.len()), |(i, j)| {
        let mut sum = 0.0;
        for a in 0..CUT {
            for b in 0..CUT {
                let (x, y) = (x[i] + within(a, dx), y[j] + within(b, dy));
                sum += (1.0 - x * x - y * y).max(0.0).sqrt();
            }
        }
        sum / (CUT * CUT) as f64
    })
}

/// Largest errors below Hertz' pressure on cells of 1/`count`, at depths in cells: everywhere,
/// farther than three cells from the edge, and on the axis.
fn hertz_errors(count: usize, depth: f64) -> Result<[f64; 3]> {
    let n = (count * 5 / 2) | 1;
    let dx = 1.0 / count as f64;
    let grid = Grid::new([n, n], [n as f64 * dx; 2])?;
    let (x, y) = (grid.x(), grid.y());
    let z = depth * dx;
    let field = stress(&steel()?, &grid, &hertz_pressure(&grid), &[z], &StressOptions::default())?;
    let mut worst = [0.0_f64; 3];
    for i in 0..n {
        for j in 0..n {
            let exact = huber(NU, x[i], y[j], z);
            for (k, exact) in exact.into_iter().enumerate() {
                let error = (field.components[k][[0, i, j]] - exact).abs();
                worst[0] = worst[0].max(error);
                if (x[i].hypot(y[j]) - 1.0).abs() > 3.0 * dx {
                    worst[1] = worst[1].max(error);
                }
                if i == n / 2 && j == n / 2 {
                    worst[2] = worst[2].max(error);
                }
            }
        }
    }
    Ok(worst)
}

/// Hertz' pressure with uniform cells. At its edge it rises as √s: cells miss a stress of order √dx
/// there, down to a depth of some cells. Inside, cells are steps of dx p', which are seen at a
/// tenth of a cell deep and have gone one cell deep.
#[test]
fn hertz_point_contact_converges() -> Result<()> {
    let (coarse, fine) = (hertz_errors(32, 1.0)?, hertz_errors(128, 1.0)?);
    claim("uniform-cells", fine[0]);
    claim("uniform-cells-off-edge", fine[1]);
    claim("uniform-cells-axis", fine[2]);
    assert!(
        fine[0] < 0.6 * coarse[0] && fine[1] < 0.7 * coarse[1] && fine[2] < coarse[2] / 8.0,
        "{coarse:?} {fine:?}"
    );
    let (coarse, fine) = (hertz_errors(32, 0.1)?, hertz_errors(128, 0.1)?);
    assert!(fine[1] < 3e-3 && fine[1] < 0.6 * coarse[1], "{coarse:?} {fine:?}");
    assert!(fine[2] < 2e-5, "{fine:?}");
    // Ten cells deep only the error of second order is left.
    let (coarse, fine) = (hertz_errors(32, 10.0)?, hertz_errors(128, 40.0)?);
    assert!(fine[0] < 5e-5 && fine[0] < coarse[0] / 10.0, "{coarse:?} {fine:?}");
    Ok(())
}

/// Largest shear stress: 0.31002 p0 at 0.4809 a for ν = 0.3 below a sphere, and 0.30028 p0 at
/// 0.7862 b below a cylinder: Johnson, §3.4 and §4.2(c).
#[test]
fn largest_shear_below_hertz_contacts() -> Result<()> {
    // 201 cells: second order, 1e-4; depths are sampled every 1e-3.
    let depths: Vec<f64> = (0..61).map(|k| 0.45 + 0.001 * f64::from(k)).collect();
    let grid = Grid::new([161, 161], [2.5, 2.5])?;
    let axis = on(Section::Axis([0.0, 0.0]));
    let field = stress(&steel()?, &grid, &hertz_pressure(&grid), &depths, &axis)?;
    let shear = field.max_shear();
    let Some(peak) = field.peak(&shear) else { panic!("no depths") };
    claim("largest-shear", peak.value - 0.310_02);
    claim("largest-shear-depth", peak.position[2] - 0.4809);

    let depths: Vec<f64> = (0..61).map(|k| 0.756 + 0.001 * f64::from(k)).collect();
    let grid = Grid::line(201, 2.5)?;
    let y = grid.y();
    let pressure = Array2::from_shape_fn((1, 201), |(_, j)| (1.0 - y[j] * y[j]).max(0.0).sqrt());
    let field = stress(&steel()?, &grid, &pressure, &depths, &axis)?;
    let shear = field.max_shear();
    let Some(peak) = field.peak(&shear) else { panic!("no depths") };
    claim("largest-shear", peak.value - 0.300_28);
    claim("largest-shear-depth", peak.position[2] - 0.7862);
    Ok(())
}

/// The peak of a summary, of which most cells need no principal stresses.
#[test]
fn a_summary_has_the_largest_shear_below_a_line_contact() -> Result<()> {
    let grid = Grid::line(201, 2.5)?;
    let y = grid.y();
    let pressure = Array2::from_shape_fn((1, 201), |(_, j)| (1.0 - y[j] * y[j]).max(0.0).sqrt());
    let plan = StressPlan::plan(&steel()?, &grid, &pressure, None)?;
    let peak = plan.summary(&Strengths::default(), &StressOptions::default())?.layers[0].shear;
    assert!((peak.value / 0.300_28 - 1.0).abs() < 2e-3, "{peak:?}");
    assert!((peak.position[2] - 0.7862).abs() < 0.03, "{peak:?}");
    Ok(())
}

/// Sliding along y, the surface is in tension 2 μ p0 at the trailing edge: Johnson, §7.2. The cells
/// next to it miss an order of √dx.
#[test]
fn tension_at_the_trailing_edge_of_a_sliding_line_contact() -> Result<()> {
    let error = |n: usize| -> Result<f64> {
        let grid = Grid::line(n, 2.5)?;
        let y = grid.y();
        let pressure = Array2::from_shape_fn((1, n), |(_, j)| (1.0 - y[j] * y[j]).max(0.0).sqrt());
        let options = sliding(0.4, [0.0, 1.0]);
        let field = stress(&steel()?, &grid, &pressure, &[0.0], &options)?;
        let largest = field.yy().fold(0.0_f64, |m, v| m.max(*v));
        Ok((largest / 0.8 - 1.0).abs())
    };
    let errors = [error(500)?, error(2000)?, error(8000)?];
    assert!(errors[1] < 0.7 * errors[0] && errors[2] < 0.7 * errors[1], "{errors:?}");
    assert!(errors[2] < 0.02, "{errors:?}");
    Ok(())
}

/// Central differences of a field, at spacing d along each axis of (z, x, y).
fn gradient(field: &Array3<f64>, axis: usize, d: f64, [k, i, j]: [usize; 3]) -> f64 {
    let mut ends = [[k, i, j]; 2];
    ends[0][axis] -= 1;
    ends[1][axis] += 1;
    (field[ends[1]] - field[ends[0]]) / (2.0 * d)
}

/// Equilibrium ∂σ_ij/∂x_j = 0, and Hooke's law from the displacement, on a sliding coated body, in
/// the coating and in the substrate. Differences err in second order.
#[test]
fn equilibrium_and_hookes_law_hold() -> Result<()> {
    let (hard, soft) = (Elastic::new(4.0, 0.2)?, Elastic::new(1.0, 0.35)?);
    let body = HalfSpace::new(soft, [Layer::new(hard, 0.8)?])?;
    let residuals = |n: usize| -> Result<[f64; 2]> {
        let grid = Grid::new([n, n], [2.5, 2.5])?;
        let d = grid.spacing()[0];
        let pressure = hertz_pressure(&grid);
        let options = displaced(sliding(0.3, [1.0, 2.0]));
        let mut worst = [0.0_f64; 2];
        for (depth, material) in [(0.5, hard), (1.2, soft)] {
            let depths = [depth - d, depth, depth + d];
            let field = stress(&body, &grid, &pressure, &depths, &options)?;
            let [xx, yy, zz, xy, yz, xz] = &field.components;
            let Some([ux, uy, uz]) = &field.displacement else { panic!("asked for") };
            let g = material.shear();
            let nu = material.poisson();
            for i in (n / 4..3 * n / 4).step_by(3) {
                for j in (n / 4..3 * n / 4).step_by(3) {
                    let at = [1, i, j];
                    let by = |f: &Array3<f64>, axis: usize| gradient(f, axis, d, at);
                    for [x, y, z] in [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]] {
                        let sum: f64 = by(x, 1) + by(y, 2) + by(z, 0);
                        worst[0] = worst[0].max(sum.abs());
                    }
                    let strain = [by(ux, 1), by(uy, 2), by(uz, 0)];
                    let volume: f64 = strain.iter().sum();
                    let normal = strain.map(|e| 2.0 * g * (e + nu / (1.0 - 2.0 * nu) * volume));
                    let shear = [
                        g * (by(ux, 2) + by(uy, 1)),
                        g * (by(uy, 0) + by(uz, 2)),
                        g * (by(ux, 0) + by(uz, 1)),
                    ];
                    let hooke = normal.into_iter().chain(shear);
                    for (stress, hooke) in field.components.iter().zip(hooke) {
                        worst[1] = worst[1].max((stress[at] - hooke).abs());
                    }
                }
            }
        }
        Ok(worst)
    };
    let (coarse, fine) = (residuals(40)?, residuals(80)?);
    for k in 0..2 {
        let ratio = coarse[k] / fine[k];
        assert!((3.5..4.6).contains(&ratio), "{coarse:?} {fine:?}");
    }
    // Largest violations of equilibrium, over p0/a, and of Hooke's law, over p0.
    assert!(fine[0] < 1e-2 && fine[1] < 1e-2, "{fine:?}");
    Ok(())
}
