//! Stress of solved contacts near their edge, where pressure falls as a square root: against Huber's
//! and McEwen's closed forms, and against solutions on finer cells.

use std::f64::consts::PI;

use crate::support::claims::claim;
use crate::support::huber::huber;
use crate::support::stresses::{displaced, sliding};
use nacre::{
    Contact, Elastic, FlatPunch, Grid, HalfSpace, Member, Motion, Options, Paraboloid, Result,
    Section, Setup, Solution, Stress, StressOptions, Surface, stress,
};

const NU: f64 = 0.3;

/// Radius of curvature, in half-widths of the contact.
const RADIUS: f64 = 1e3;

fn steel() -> Result<Elastic> {
    Elastic::new(1.0, NU)
}

fn press(grid: Grid, shape: &dyn Surface, load: f64) -> Result<Solution> {
    let contact = Contact::plan(steel()?, grid, Setup::default())?;
    contact.solve(shape, &Motion::load(load), &Options::default())
}

/// Hertz' contact of radius 1 on cells of 1/`count`, and its peak pressure.
fn sphere(count: usize) -> Result<(Solution, f64)> {
    let n = (count * 5 / 2) | 1;
    let grid = Grid::new([n, n], [n as f64 / count as f64; 2])?;
    let load = 4.0 * steel()?.plane_strain_modulus() / (3.0 * RADIUS);
    let shape = Paraboloid::new(RADIUS, RADIUS)?;
    Ok((press(grid, &shape, load)?, 1.5 * load / PI))
}

/// Hertz' line contact of half-width 1 on strips of 1/`count`, and its peak pressure.
fn cylinder(count: usize) -> Result<(Solution, f64)> {
    let n = (count * 5 / 2) | 1;
    let grid = Grid::line(n, n as f64 / count as f64)?;
    let load = PI * steel()?.plane_strain_modulus() / (4.0 * RADIUS);
    let shape = Paraboloid::new(1e9, RADIUS)?;
    Ok((press(grid, &shape, load)?, 2.0 * load / PI))
}

/// The stress of a contact and its friction does not depend on the unit of length: no rounding decides how many cells a load
/// is followed over. One cell more changes stresses of this contact by 9e-5 of the peak. The units are some of the 7 % at which
/// the length of three cells, over that of one, is above 3. Pressures of two solves differ by their tolerance.
#[test]
fn stresses_do_not_depend_on_the_size_of_a_cell() -> Result<()> {
    const TOLERANCE: f64 = 1e-12;
    let (n, width) = (64, 8.0);
    let solved = |unit: f64, plane: bool| -> Result<Solution> {
        let modulus = steel()?.plane_strain_modulus();
        let grid = match plane {
            true => Grid::new([n / 2, n / 2], [0.5 * width * unit; 2])?,
            false => Grid::line(n, width * unit)?,
        };
        let radius = RADIUS * unit;
        let (shape, load) = match plane {
            true => {
                (Paraboloid::new(radius, radius)?, 4.0 * modulus * unit.powi(2) / (3.0 * RADIUS))
            }
            false => (Paraboloid::new(1e9 * unit, radius)?, PI * modulus * unit / (4.0 * RADIUS)),
        };
        let contact = Contact::plan(steel()?, grid, Setup::default())?;
        let options = Options::default().with_tolerance(TOLERANCE);
        contact.solve(&shape, &Motion::load(load), &options)
    };
    let options = sliding(0.3, [0.0, 1.0]);
    for plane in [false, true] {
        // Half a cell and two cells deep.
        let stresses = |unit: f64| {
            let cell = width * unit / n as f64;
            solved(unit, plane)?.stress(&[0.5 * cell, 2.0 * cell], Member::Body, &options)
        };
        let first = stresses(1.0)?;
        let peak = steel()?.plane_strain_modulus() / (2.0 * RADIUS);
        let rounds = |unit: &f64| {
            let cell = width * unit / n as f64;
            3.0 * cell / cell > 3.0
        };
        let units: Vec<f64> = (1..100).map(|k| f64::from(k) / 7.0).filter(rounds).collect();
        assert!(units.len() > 3);
        for unit in &units[..3] {
            let other = stresses(*unit)?;
            for (one, other) in first.components.iter().zip(&other.components) {
                let change = (one - other).fold(0.0_f64, |most, change| most.max(change.abs()));
                assert!(change < 1e-8 * peak, "{plane} {unit}: {:.1e}", change / peak);
            }
        }
    }
    Ok(())
}

/// Largest errors, over the peak pressure, of a contact of half-width 1: everywhere, and farther
/// than three cells from the edge.
fn errors(field: &Stress, peak: f64, cell: f64, exact: impl Fn(f64, f64) -> [f64; 6]) -> [f64; 2] {
    let mut worst = [0.0_f64; 2];
    for (i, &x) in field.x.iter().enumerate() {
        for (j, &y) in field.y.iter().enumerate() {
            let far = (x.hypot(y) - 1.0).abs() > 3.0 * cell;
            for (component, exact) in field.components.iter().zip(exact(x, y)) {
                let error = (component[[0, i, j]] / peak - exact).abs();
                worst[0] = worst[0].max(error);
                if far {
                    worst[1] = worst[1].max(error);
                }
            }
        }
    }
    worst
}

/// Largest errors below a sphere, at a depth in cells.
fn sphere_errors(count: usize, depth: f64) -> Result<[f64; 2]> {
    let (solution, peak) = sphere(count)?;
    let cell = 1.0 / count as f64;
    let z = depth * cell;
    let field = solution.stress(&[z], Member::Body, &StressOptions::default())?;
    Ok(errors(&field, peak, cell, |x, y| huber(NU, x, y, z)))
}

/// Stresses xx, yy, zz, xy, yz, xz below a cylinder: McEwen (1949), after Johnson, Contact
/// Mechanics, eqs (4.49), doi:10.1017/CBO9781139171731.
fn mcewen(y: f64, z: f64) -> [f64; 6] {
    let s = 1.0 - y * y + z * z;
    let root = (s * s + 4.0 * y * y * z * z).sqrt();
    let m = (0.5 * (root + s)).sqrt();
    let n = (0.5 * (root - s)).max(0.0).sqrt().copysign(y);
    let part = (z * z + n * n) / (m * m + n * n);
    let yy = -(m * (1.0 + part) - 2.0 * z);
    let zz = -m * (1.0 - part);
    let yz = -n * (m * m - z * z) / (m * m + n * n);
    [NU * (yy + zz), yy, zz, 0.0, yz, 0.0]
}

/// Below Hertz' point contact, pressure within cells hides the staircase of the solver's contact.
/// An error in the place of the edge remains, and the pressure errs by its root. Uniform cells miss
/// 4e-3 one cell deep, and 2.4e-3 a tenth of a cell deep farther than three cells from the edge.
///
/// Measured: 7.1e-4 one cell deep, less below; at 0.1 of a cell 1.2e-3, and 3.3e-4 farther off.
/// Bars are 1.4 to 1.7 times that. The place of the edge errs by some thousandths of a cell: from
/// 32 cells to 128 errors should halve at least, as the root of the cell. They fall to 0.34 and
/// 0.46; the bar is 0.6.
#[test]
#[ignore = "slow"]
fn hertz_point_contact() -> Result<()> {
    for depth in [1.0, 1.4, 1.6, 2.0, 4.0, 8.0] {
        let [everywhere, _] = sphere_errors(128, depth)?;
        claim("hertz-stress", everywhere);
    }
    for depth in [0.1, 0.3, 0.6] {
        let [everywhere, far] = sphere_errors(128, depth)?;
        claim("hertz-stress-shallow", everywhere);
        claim("hertz-stress-off-edge", far);
    }
    let (coarse, fine) = (sphere_errors(32, 1.0)?, sphere_errors(128, 1.0)?);
    assert!(fine[0] < 0.6 * coarse[0], "{coarse:?} {fine:?}");
    let (coarse, fine) = (sphere_errors(32, 0.1)?, sphere_errors(128, 0.1)?);
    assert!(fine[0] < 0.6 * coarse[0], "{coarse:?} {fine:?}");
    Ok(())
}

/// Below a line contact there is no staircase, and the edge is known better. Measured at 0.1, 1 and
/// 3 cells: 5.0e-4, 4.0e-4 and 5.4e-5 everywhere, 1.1e-4, 2.3e-5 and 2.3e-5 farther from the edge;
/// bars are 1.2 to 1.8 times that. Errors fall as the root of the cell, to 0.51 to 0.53 from 32
/// cells to 128; the bar is 0.6.
#[test]
fn hertz_line_contact() -> Result<()> {
    let errors = |count: usize, depth: f64| -> Result<[f64; 2]> {
        let (solution, peak) = cylinder(count)?;
        let cell = 1.0 / count as f64;
        let z = depth * cell;
        let field = solution.stress(&[z], Member::Body, &StressOptions::default())?;
        Ok(errors(&field, peak, cell, |_, y| mcewen(y, z)))
    };
    for (depth, everywhere, far) in [(0.1, 6e-4, 2e-4), (1.0, 5e-4, 3e-5), (3.0, 1e-4, 3e-5)] {
        let (coarse, fine) = (errors(32, depth)?, errors(128, depth)?);
        claim("cylinder-stress", fine[0]);
        assert!(fine[0] < everywhere && fine[1] < far, "{depth}: {coarse:?} {fine:?}");
        assert!(fine[0] < 0.6 * coarse[0], "{depth}: {coarse:?} {fine:?}");
    }
    Ok(())
}

/// Sliding along y, σ_yy at the surface is −2 μ p0 (y − √(y² − 1)) from friction, compression at
/// the leading side and tension at the trailing one: Johnson, §7.2. An edge that errs by e cells
/// changes it by 2 μ p0 √(2 e dx): 1e-2 for a hundredth of a cell. Measured: 7.2e-3.
#[test]
fn surface_of_a_sliding_cylinder() -> Result<()> {
    const FRICTION: f64 = 0.4;
    let (solution, peak) = cylinder(128)?;
    let options = sliding(FRICTION, [0.0, 1.0]);
    let field = solution.stress(&[0.0], Member::Body, &options)?;
    let mut worst = 0.0_f64;
    for (j, &y) in field.y.iter().enumerate() {
        let pressure = (1.0 - y * y).max(0.0).sqrt();
        let beyond = (y * y - 1.0).max(0.0).sqrt().copysign(y);
        let exact = -pressure - 2.0 * FRICTION * (y - beyond);
        worst = worst.max((field.yy()[[0, 0, j]] / peak - exact).abs());
    }
    claim("sliding-cylinder", worst);
    Ok(())
}

/// Behind a sliding sphere the tension is (1 − 2ν)/3 + μ π (4 + ν)/8 of p0: Hamilton, Proc. Instn
/// Mech. Engrs 197C (1983) 53, doi:10.1243/PIME_PROC_1983_197_076_02. A cell's centre lies at the
/// very edge. Measured: 7e-3 less, which the place of the edge explains, as below the cylinder; the
/// bar is 1.4 times that. The tension is found in the cell at the edge, or in the one beside it.
#[test]
#[ignore = "slow"]
fn summary_has_the_tension_behind_a_sliding_sphere() -> Result<()> {
    const FRICTION: f64 = 0.5;
    let (solution, peak) = sphere(128)?;
    let options = sliding(FRICTION, [1.0, 0.0]);
    let strengths = nacre::stress::Strengths::default();
    let summary = solution.stress_summary(Member::Body, &strengths, &options)?;
    let tension = summary.layers[0].tension;
    let exact = (1.0 - 2.0 * NU) / 3.0 + FRICTION * PI * (4.0 + NU) / 8.0;
    claim("sliding-sphere", tension.value / peak / exact - 1.0);
    assert!((tension.position[0] + 1.0).abs() < 1.5 / 128.0);
    assert!(tension.position[2].abs() < f64::EPSILON);
    Ok(())
}

/// The largest tension behind a sliding cylinder is 2 μ p0, at the edge itself (Johnson, §7.2). Between centres of strips
/// σ_yy falls by μ p0 √(2 d/b) and more: strips alone miss 16 % on 64 across the contact. Measured with the edge: 0.02 to 0.16 %, wherever
/// it lies in its strip. The edge itself is known to
/// 2e-4 of the half-width, and the estimated error covers the true one.
#[test]
fn tension_at_the_edge_of_a_sliding_cylinder() -> Result<()> {
    const FRICTION: f64 = 0.4;
    let load = PI * steel()?.plane_strain_modulus() / (4.0 * RADIUS);
    let peak = 2.0 * load / PI;
    for half in [24, 32, 64, 128] {
        for shift in [0.0, 0.3] {
            let n = half * 5 / 2;
            let grid = Grid::line(n, n as f64 / half as f64)?;
            let grid = grid.centered_at([0.0, shift / half as f64])?;
            let solution = press(grid, &Paraboloid::new(1e9, RADIUS)?, load)?;
            let options = sliding(FRICTION, [0.0, 1.0]);
            let strengths = nacre::stress::Strengths::default();
            let summary = solution.stress_summary(Member::Body, &strengths, &options)?;
            let tension = summary.layers[0].tension;
            let error = tension.value / (2.0 * FRICTION * peak) - 1.0;
            claim("sliding-cylinder-edge", error);
            let estimate = tension.uncertainty.unwrap_or(0.0) / (2.0 * FRICTION * peak);
            assert!(error.abs() < estimate, "{half} {shift}: {error:.1e} {estimate:.1e}");
            assert!((tension.position[1] + 1.0).abs() < 2e-3 && tension.position[2] == 0.0);
            let plan = solution.stress_plan(Member::Body, &options)?;
            let edge = plan.edge();
            assert!(edge.len() == 2 && (edge[0][1] - tension.position[1]).abs() < f64::EPSILON);
            // The point itself has the value, and so has the leading edge, as compression. Pressure that is left there,
            // up to 6e-4, adds itself or the square of its shear.
            let at = |point| options.clone().with_section(Section::Axis(point));
            let trailing = plan.stress(&[0.0], &at(edge[0]))?.yy()[[0, 0, 0]];
            assert!((trailing - tension.value).abs() < 1e-6 * peak);
            let leading = plan.stress(&[0.0], &at(edge[1]))?.yy()[[0, 0, 0]];
            assert!((leading / (-2.0 * FRICTION * peak) - 1.0).abs() < 0.01, "{leading}");
        }
    }
    Ok(())
}

/// Points between the strips' centres, in and beside the contact: McEwen's and Johnson's closed forms. An edge that errs by
/// 2e-4 b leaves 2 μ √(4e-4) of the peak at the worst place, beside the edge.
#[test]
fn points_between_strips() -> Result<()> {
    const FRICTION: f64 = 0.3;
    let (solution, peak) = cylinder(32)?;
    let options = sliding(FRICTION, [0.0, 1.0]);
    for y in [-1.2, -1.05, -1.01, -0.99, -0.931, -0.5, 0.017, 0.33, 0.97, 1.004, 1.21] {
        let at = options.clone().with_section(Section::Axis([0.0, y]));
        let field = solution.stress(&[0.0, 0.01], Member::Body, &at)?;
        let pressure = (1.0_f64 - y * y).max(0.0).sqrt();
        let beyond = (y * y - 1.0).max(0.0).sqrt().copysign(y);
        let exact = -pressure - 2.0 * FRICTION * (y - beyond);
        let error = field.yy()[[0, 0, 0]] / peak - exact;
        assert!(error.abs() < 0.012, "{y}: {error:.1e}");
        let alone = at.with_friction(0.0);
        let field = solution.stress(&[0.01], Member::Body, &alone)?;
        for (component, exact) in field.components.iter().zip(mcewen(y, 0.01)) {
            assert!((component[[0, 0, 0]] / peak - exact).abs() < 3e-3, "{y}");
        }
    }
    Ok(())
}

/// Behind a sliding sphere, with 48 and 64 cells across the contact and friction askew to the grid: Hamilton's tension
/// (see above). Measured: at most 0.28 % less.
#[test]
#[ignore = "slow"]
fn tension_at_the_edge_of_a_sliding_sphere() -> Result<()> {
    const FRICTION: f64 = 0.5;
    let exact = (1.0 - 2.0 * NU) / 3.0 + FRICTION * PI * (4.0 + NU) / 8.0;
    for (half, direction) in [(24, [1.0, 0.0]), (24, [3.0, 4.0]), (32, [-3.0, 4.0])] {
        let (solution, peak) = sphere(half)?;
        let strengths = nacre::stress::Strengths::default();
        let options = sliding(FRICTION, direction);
        let summary = solution.stress_summary(Member::Body, &strengths, &options)?;
        let tension = summary.layers[0].tension;
        claim("sliding-sphere-edge", tension.value / peak / exact - 1.0);
        let [x, y, z] = tension.position;
        assert!((x.hypot(y) - 1.0).abs() < 3e-3 && z == 0.0, "{x} {y}");
    }
    Ok(())
}

/// The largest shear stress of Hertz' contact lies on its axis, at the corner of four cells here, and the largest value is that
/// of a centre of a cell beside it: too small by what the estimated error must say. Johnson, Contact Mechanics (1985), eq.
/// 3.45, doi:10.1017/CBO9781139171731.
#[test]
fn extremes_between_cells_are_within_their_error() -> Result<()> {
    let on_axis = |s: f64| 0.5 * ((1.0 + NU) * (s * (1.0 / s).atan() - 1.0) + 1.5 / (1.0 + s * s));
    let exact = (1..2000).map(|k| on_axis(f64::from(k) * 1e-3)).fold(0.0, f64::max);
    for count in [5, 8, 16] {
        let n = 2 * (count * 5 / 4);
        let grid = Grid::new([n, n], [n as f64 / count as f64; 2])?;
        let load = 4.0 * steel()?.plane_strain_modulus() / (3.0 * RADIUS);
        let solution = press(grid, &Paraboloid::new(RADIUS, RADIUS)?, load)?;
        let strengths = nacre::stress::Strengths::default();
        let options = StressOptions::default();
        let shear = solution.stress_summary(Member::Body, &strengths, &options)?.layers[0].shear;
        let (value, error) = (shear.value / (1.5 * load / PI), shear.uncertainty.unwrap_or(0.0));
        let (missing, error) = (exact - value, error / (1.5 * load / PI));
        assert!((0.0..=error).contains(&missing), "{count}: {missing:.1e} {error:.1e}");
    }
    Ok(())
}

/// A coating that equals its substrate changes nothing, and at the edge of a punch, where pressure has no end, no point is
/// added.
#[test]
#[ignore = "slow"]
fn equal_coatings_and_punches_at_the_edge() -> Result<()> {
    let options = sliding(0.4, [0.0, 1.0]);
    let strengths = nacre::stress::Strengths::default();
    let (bare, peak) = cylinder(32)?;
    let coating = nacre::Layer::new(steel()?, 0.2)?;
    let body = HalfSpace::new(steel()?, [coating])?;
    let contact = Contact::plan(&body, *bare.grid(), Setup::default())?;
    let load = PI * steel()?.plane_strain_modulus() / (4.0 * RADIUS);
    let shape = Paraboloid::new(1e9, RADIUS)?;
    let coated = contact.solve(&shape, &Motion::load(load), &Options::default())?;
    let tension = |solution: &Solution| -> Result<f64> {
        let summary = solution.stress_summary(Member::Body, &strengths, &options)?;
        Ok(summary.layers[0].tension.value)
    };
    assert!((tension(&bare)? - tension(&coated)?).abs() < 1e-6 * peak);
    let punch = press(Grid::new([64, 64], [3.0, 3.0])?, &FlatPunch::new(1.0)?, 1e-3)?;
    assert!(punch.stress_plan(Member::Body, &options)?.edge().is_empty());
    Ok(())
}

/// Tractions at the surface are those of the solution's pressure, and displacements those of its
/// cells.
#[test]
fn surface_keeps_the_pressure_and_displacement_of_the_solution() -> Result<()> {
    // Influence coefficients keep 1e-9, and those of stress 1e-9 of the largest.
    const COEFFICIENTS: f64 = 3e-9;
    let (solution, _) = sphere(32)?;
    let options = displaced(sliding(0.25, [3.0, 4.0]));
    let field = solution.stress(&[0.0], Member::Body, &options)?;
    let alone = options.with_friction(0.0);
    let alone = solution.stress(&[0.0], Member::Body, &alone)?;
    let Some(displacement) = &alone.displacement else { panic!("asked for") };
    let largest = solution.displacement.fold(0.0_f64, |m, u| m.max(*u));
    for ((i, j), p) in solution.pressure.indexed_iter() {
        for (k, factor) in [(2, 1.0), (4, 0.2), (5, 0.15)] {
            let traction = field.components[k][[0, i, j]];
            assert!((traction + factor * p).abs() <= f64::EPSILON * p);
        }
        let u = displacement[2][[0, i, j]];
        assert!((u - solution.displacement[[i, j]]).abs() < COEFFICIENTS * largest);
    }
    Ok(())
}

/// A shape and waves of many lengths on it, the shortest over eight coarse cells.
#[derive(Debug)]
struct Rough {
    radius: f64,
    waves: Vec<[f64; 4]>,
}

impl Rough {
    fn new(radius: f64, amplitude: f64) -> Self {
        let phases = crate::support::random::uniform([12, 25], 5);
        let mut waves = Vec::new();
        for m in 0..12_u8 {
            for n in -12..=12_i8 {
                let (m, n) = (f64::from(m), f64::from(n));
                let length = m.hypot(n);
                if (1.0..12.0).contains(&length) {
                    let phase = 2.0 * PI * phases[[m as usize, (n + 12.0) as usize]];
                    waves.push([m, n, amplitude * length.powf(-1.8), phase]);
                }
            }
        }
        Self { radius, waves }
    }
}

impl Surface for Rough {
    fn gap(&self, x: f64, y: f64) -> f64 {
        let wave =
            |[m, n, height, phase]: &[f64; 4]| height * (2.0 * (m * x + n * y) + phase).cos();
        let waves: f64 = self.waves.iter().map(wave).sum();
        (x * x + y * y) / (2.0 * self.radius) + waves
    }
}

/// Root of the mean square error over the peak pressure, against cells a third as long: of stresses
/// with uniform cells, and of the solution's.
fn against_finer(coarse: Grid, shape: &dyn Surface, load: f64, depth: f64) -> Result<[f64; 2]> {
    let fine = Grid::new(coarse.shape().map(|n| 3 * n), coarse.size())?;
    let (coarse, fine) = (press(coarse, shape, load)?, press(fine, shape, load)?);
    let options = sliding(0.5, [1.0, 0.0]);
    let [dx, dy] = coarse.grid().spacing();
    let z = [depth * dx.min(dy)];
    let body: HalfSpace = steel()?.into();
    let uniform = stress(&body, coarse.grid(), &coarse.pressure, &z, &options)?;
    let solved = coarse.stress(&z, Member::Body, &options)?;
    let reference = fine.stress(&z, Member::Body, &options)?;
    let error = |field: &Stress| {
        let (mut sum, mut count) = (0.0, 0);
        for (field, fine) in field.components.iter().zip(&reference.components) {
            for ((_, i, j), value) in field.indexed_iter() {
                sum += (value - fine[[0, 3 * i + 1, 3 * j + 1]]).powi(2);
                count += 1;
            }
        }
        (sum / f64::from(count)).sqrt() / coarse.peak_pressure()
    };
    Ok([error(&uniform), error(&solved)])
}

/// An elliptical contact of oblong cells, 36 and 17 to its half-widths. Measured: 0.26, 0.06, 0.15
/// and 0.34 of the errors with uniform cells; the bar is 1.2 times the largest.
#[test]
#[ignore = "slow"]
fn smooth_contacts_gain() -> Result<()> {
    let grid = Grid::new([96, 64], [5.0, 2.6])?;
    let shape = Paraboloid::new(3e3, 1e3)?;
    for depth in [0.0, 0.3, 1.0, 3.0] {
        let [uniform, solved] = against_finer(grid, &shape, 2.5e-3, depth)?;
        claim("oblong", solved / uniform);
    }
    Ok(())
}

/// Cells 12 times as long as wide and 4 times as long as wide give the same stress from pressure
/// within cells: three short ones make a long one, and along them nothing changes. Either knows the
/// edge within a hundredth of a cell, and pressure there errs by the root of that: √(2 · 0.01 ·
/// 0.04) of the peak, over a half-width of 0.7.
#[test]
fn long_cells_are_evaluated() -> Result<()> {
    let coating = nacre::Layer::new(Elastic::new(3.0, NU)?, 0.4)?;
    let body = HalfSpace::new(steel()?, [coating])?;
    let shape = Paraboloid::new(1e6, 1e3)?;
    let solved = |n: usize| -> Result<Vec<ndarray::Array3<f64>>> {
        let grid = Grid::new([n, 65], [12.96, 2.6])?;
        let contact = Contact::plan(&body, grid, Setup::default())?;
        let solution = contact.solve(&shape, &Motion::load(1e-2), &Options::default())?;
        let options = sliding(0.3, [1.0, 0.0]);
        let depths = [0.0, 0.02];
        let field = solution.stress(&depths, Member::Body, &options)?;
        let uniform = stress(&body, &grid, &solution.pressure, &depths, &options)?;
        let peak = solution.peak_pressure();
        let both = field.components.iter().zip(&uniform.components);
        let added: Vec<_> = both.map(|(a, b)| (a - b) / peak).collect();
        Ok(added)
    };
    let (long, short) = (solved(27)?, solved(81)?);
    for (long, short) in long.iter().zip(&short) {
        for k in 0..2 {
            for j in 0..65 {
                let error = long[[k, 13, j]] - short[[k, 40, j]];
                assert!(error.abs() < 3.4e-2, "{k} {j}: {error:.1e}");
            }
        }
    }
    Ok(())
}

/// Sharp and rough contacts keep uniform cells near their edges. Slopes of the interior end there,
/// and with them their shares, each 1/24 of the change of pressure from cell to cell: 1e-4 of the
/// peak on average.
#[test]
#[ignore = "slow"]
fn sharp_and_rough_contacts_do_not_lose() -> Result<()> {
    let grid = Grid::new([64, 63], [3.0, 2.9])?;
    let shapes: [(&str, Box<dyn Surface>, f64); 4] = [
        ("punch", Box::new(FlatPunch::new(1.0)?), 2.5e-3),
        ("rough sphere", Box::new(Rough::new(1e3, 4e-6)), 1.4e-3),
        ("rougher sphere", Box::new(Rough::new(1e3, 2e-5)), 1.4e-3),
        ("rough plane", Box::new(Rough::new(1e9, 2e-4)), 3e-3),
    ];
    for (name, shape, load) in shapes {
        for depth in [0.0, 0.3, 1.0, 3.0, 8.0] {
            println!("{name} {depth}");
            let [uniform, solved] = against_finer(grid, shape.as_ref(), load, depth)?;
            claim("sharp-or-rough", (solved - uniform).max(0.0));
        }
    }
    Ok(())
}
