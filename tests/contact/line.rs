//! Line contact equals the plane-strain solution of a cylinder on a coated half-space, and is the
//! limit of three-dimensional contact.

use std::f64::consts::PI;

use nacre::influence::{Method, influence_coefficients};
use nacre::{
    Algorithm, Contact, Cylinder, Error, FlatPunch, Grid, HalfSpace, Motion, Options, Result,
    Setup, Solution, Substrate, hertz,
};

use crate::support::claims::claim;
use crate::support::random::uniform;
use crate::support::reference::{cases, list, number};
use crate::support::settings::{self, by, converged, plan, stack, steel, tolerance};

/// Error of the peak pressure, extrapolated from 256 and 512 cells with an error of second order.
const EXTRAPOLATED: f64 = 1e-4;

/// Error of the half-width, from p² near the edge, and of the peak on 512 cells: dx/b = 1/85 of a bare
/// body, (dx/b)² = 1.4e-4; dx/b = 1/43 where b is smallest.
const ON_THE_GRID: f64 = 1e-3;

/// Error of the pressure, relative to the peak, inside three quarters of the half-width, interpolated linearly
/// between cells of b/43 or less.
const PROFILE: f64 = 1e-3;

/// Rounding between two computations of one closed form.
const ROUNDING: f64 = 1e-10;

/// Half-width on the bare substrate, and a radius so large that a circle is a parabola to
/// (b/R)²/4 = 2.5e-9.
const HALF_WIDTH: f64 = 1e-4;
const RADIUS: f64 = 1.0;

/// Width of the grid relative to [`HALF_WIDTH`].
const WIDTH: f64 = 6.0;

/// Error of sums over rows of 3000 cells: beyond their ends, (h/X)² = 2e-5 of a tail of (y/X)²/4 is
/// neglected.
const STRIPS: f64 = 1e-7;

/// Load per length at which a bare half-width is [`HALF_WIDTH`].
fn line_load() -> Result<f64> {
    Ok(PI * steel()?.plane_strain_modulus() * HALF_WIDTH.powi(2) / (4.0 * RADIUS))
}

fn bare() -> Result<hertz::Line> {
    hertz::Line::new(RADIUS, steel()?.plane_strain_modulus(), line_load()?)
}

fn coated(ratio: f64, thickness: f64) -> Result<HalfSpace> {
    settings::coated(steel()?, ratio, thickness)
}

/// How far the approach moves where the datum is twice as far away: 2W'/πE* ln 2.
fn datum() -> Result<f64> {
    Ok(2.0 * line_load()? / (PI * steel()?.plane_strain_modulus()) * 2.0_f64.ln())
}

fn press(body: &HalfSpace, grid: Grid, load: f64) -> Result<Solution> {
    let (contact, motion) = (plan(body, grid)?, Motion::load(load));
    converged(&contact, &Cylinder::new(RADIUS)?, &motion, &tolerance(1e-11))
}

fn line(body: &HalfSpace, cells: usize, width: f64) -> Result<Solution> {
    press(body, Grid::line(cells, width * HALF_WIDTH)?, line_load()?)
}

fn half_width(solution: &Solution) -> f64 {
    let [low, high] = solution.contact_extent()[1];
    0.5 * (high - low)
}

/// Pressure at `y`, linear between cells.
fn pressure_at(solution: &Solution, y: f64) -> f64 {
    let (centres, spacing) = (solution.grid().y(), solution.grid().spacing()[1]);
    let position = (y - centres[0]) / spacing;
    let below = position as usize;
    let t = position - below as f64;
    (1.0 - t) * solution.pressure[[0, below]] + t * solution.pressure[[0, below + 1]]
}

#[test]
#[ignore = "slow"]
fn coated_cylinders_equal_the_reference() -> Result<()> {
    let scale = bare()?.peak_pressure;
    let rows = cases("line_coated.json");
    assert_eq!(rows.len(), 25);
    for row in &rows {
        let [ratio, h] = ["modulus_ratio", "h"].map(|key| number(row, key));
        let body = coated(ratio, h * HALF_WIDTH)?;
        let (coarse, fine) = (line(&body, 256, WIDTH)?, line(&body, 512, WIDTH)?);
        let exact = number(row, "peak") * scale;
        claim("coated-cylinder-peak", coarse.peak_pressure() / exact - 1.0);
        let extrapolated = (4.0 * fine.peak_pressure() - coarse.peak_pressure()) / 3.0;
        near!(extrapolated, exact, EXTRAPOLATED, ratio, h);
        near!(fine.peak_pressure(), exact, ON_THE_GRID, ratio, h);
        // Under a thin hard coating, the error on 512 cells is larger: 1.5e-3.
        let edge = match ratio > 3.0 && h < 0.3 {
            true => half_width(&line(&body, 1024, WIDTH)?),
            false => half_width(&fine),
        };
        let width = number(row, "half_width") * HALF_WIDTH;
        near!(edge, width, ON_THE_GRID, ratio, h);
        for (k, p) in list(row, "pressure").iter().enumerate().skip(1) {
            let due = p.as_f64().expect("a number") * scale;
            let error = pressure_at(&fine, 0.25 * k as f64 * width) - due;
            below!(error.abs() / exact, PROFILE, ratio, h, k);
        }
    }
    Ok(())
}

#[test]
fn bare_cylinder_equals_hertz() -> Result<()> {
    let (exact, modulus) = (bare()?, steel()?.plane_strain_modulus());
    // The number of cells is odd, so that one is on the axis; the grid is not centred at the axis.
    for (cells, width, center) in [(511, 6.0, 0.0), (400, 4.0, 0.3)] {
        let grid = Grid::line(cells, width * HALF_WIDTH)?;
        let grid = grid.centered_at([0.0, center * HALF_WIDTH])?;
        let solution = press(&steel()?.into(), grid, line_load()?)?;
        near!(solution.peak_pressure(), exact.peak_pressure, ON_THE_GRID);
        near!(half_width(&solution), exact.half_width, ON_THE_GRID);
        for (y, p) in solution.grid().y().iter().zip(&solution.pressure) {
            // Hertz: p0 √(1 − y²/b²). The edge lies inside a cell.
            let beyond = (y.abs() / HALF_WIDTH - 1.0).abs();
            let tolerance = if beyond > 0.1 { 2e-3 } else { 0.1 };
            let hertz = (1.0 - (y / HALF_WIDTH).powi(2)).max(0.0).sqrt();
            let error = p / exact.peak_pressure - hertz;
            below!(error.abs(), tolerance, y / HALF_WIDTH);
        }
        // u(0) = 2W'/πE* (ln 2ℓ/b + ½), from −2W'/πE* ln r/ℓ per line load and Hertz's pressure.
        let unit = 2.0 * line_load()? / (PI * modulus);
        let approach = unit * ((2.0 * width).ln() + 0.5);
        near!(solution.approach, approach, 1e-4);
    }
    Ok(())
}

#[test]
fn force_is_per_length() -> Result<()> {
    let solution = line(&coated(2.0, HALF_WIDTH)?, 200, WIDTH)?;
    assert_eq!(solution.pressure.dim(), (1, 200));
    near!(solution.load(), line_load()?, ROUNDING);
    near!(solution.line_load()[0], line_load()?, ROUNDING);
    Ok(())
}

#[test]
fn thin_layer_on_a_rigid_base_is_a_winkler_foundation() -> Result<()> {
    // p = M (δ − y²/2R)/h with M = E (1−ν)/((1+ν)(1−2ν)), from which a³ = 3 W' R h/2M and p0 = 3W'/4a.
    // A layer of a/100 spreads the pressure at the edges over its thickness.
    let load = line_load()?;
    let oedometer = 210e9 * 0.7 / (1.3 * 0.4);
    let h = 0.9e-3 * HALF_WIDTH;
    let body = stack(Substrate::Rigid, [[210e9, 0.3, h]])?;
    let a = (1.5 * load * RADIUS * h / oedometer).cbrt();
    below!(h / a, 0.01);
    let solve = |cells: usize, width: f64| press(&body, Grid::line(cells, width * a)?, load);
    let solution = solve(600, 3.0)?;
    near!(solution.peak_pressure(), 0.75 * load / a, 0.01);
    near!(half_width(&solution), a, 0.01);
    near!(solution.approach, a * a / (2.0 * RADIUS), 0.02);
    // A rigid base does not move, so that there is no datum.
    near!(solve(1200, 6.0)?.approach, solution.approach, 1e-6);
    Ok(())
}

#[test]
fn endless_strips_are_rows_of_rectangles() -> Result<()> {
    // The differences C(0) − C(j), which do not contain the datum, are sums of three-dimensional
    // coefficients along x. Cells beyond X = (n − ½) dx are replaced by point loads on the substrate: A
    // dy/π ∫_X^∞ (1/x − 1/√(x² + y²)) dx = A dy/π ln [(1 + √(1 + y²/X²))/2], A = 2/E*.
    let (dy, n, ny) = (HALF_WIDTH / 8.0, 1500, 12);
    for (ratio, thickness, aspect) in
        [(1.0, 1.0, 1.0), (4.0, 2.0, 1.5), (0.25, 0.1, 0.7), (10.0, 6.0, 1.0)]
    {
        let (body, dx) = (coated(ratio, thickness * dy)?, aspect * dy);
        let flat = Grid::new([n, ny], [n as f64 * dx, ny as f64 * dy])?;
        let cells = influence_coefficients(&body, &flat, Method::Exact)?;
        let line = Grid::line(ny, ny as f64 * dy)?;
        let strips = influence_coefficients(&body, &line, Method::Exact)?;
        let row = |j: usize| cells[[0, j]] + 2.0 * cells.column(j).iter().skip(1).sum::<f64>();
        let reach = (n as f64 - 0.5) * dx;
        for j in 1..ny {
            let y = j as f64 * dy;
            let far = 2.0 / steel()?.plane_strain_modulus() * dy / PI
                * (0.5 + 0.5 * (1.0 + (y / reach).powi(2)).sqrt()).ln();
            let sum = row(0) - row(j) + far;
            let strip = strips[[0, 0]] - strips[[0, j]];
            near!(sum, strip, STRIPS, ratio, thickness, j);
        }
    }
    Ok(())
}

#[test]
fn the_middle_of_a_long_cylinder_is_in_plane_strain() -> Result<()> {
    // The roller is 60 half-widths long. Its middle differs by the strain along the axis, (b/L)² ≈ 3e-4.
    let body = coated(2.0, HALF_WIDTH)?;
    let grid = Grid::new([64, 128], [60.0 * HALF_WIDTH, 4.0 * HALF_WIDTH])?;
    let long = press(&body, grid, 60.0 * HALF_WIDTH * line_load()?)?;
    let middle = long.line_load()[32];
    let strip = press(&body, Grid::line(128, 4.0 * HALF_WIDTH)?, middle)?;
    below!(apart(long.pressure.row(32), &strip), 1e-3);
    Ok(())
}

/// Largest difference of two pressures, relative to the peak of the second.
fn apart<'a>(a: impl IntoIterator<Item = &'a f64>, b: &'a Solution) -> f64 {
    let differences = a.into_iter().zip(&b.pressure).map(|(a, b)| (a - b).abs());
    differences.fold(0.0, f64::max) / b.peak_pressure()
}

/// A grid twice as wide with the same cells has the same pressures, and a datum that is farther away. At a distance of 3
/// half-widths the surface of these layers moves less than that of the bare substrate, so that some influence
/// coefficients are negative.
#[test]
fn the_datum_moves_the_approach_alone() -> Result<()> {
    for (ratio, thickness, cells) in [(4.0, 0.5, 300), (8.0, 4.0, 256)] {
        let body = coated(ratio, thickness * HALF_WIDTH)?;
        let strip = Grid::line(cells, 3.0 * HALF_WIDTH)?;
        let coefficients = influence_coefficients(&body, &strip, Method::Exact)?;
        assert!(coefficients.iter().any(|&c| c < 0.0));
        let (near, far) = (line(&body, cells, 3.0)?, line(&body, 2 * cells, 6.0)?);
        // Both were solved to 1e-11; errors of the pressure are some thousand times larger.
        below!(apart(far.pressure.iter().skip(cells / 2), &near), 1e-7);
        near!(far.approach - near.approach, datum()?, 1e-7);
        let inside = far.displacement.iter().skip(cells / 2);
        for (far, near) in inside.zip(&near.displacement) {
            near!(far - near, datum()?, 1e-7);
        }
    }
    Ok(())
}

/// An approach is refused where the datum lies too near, and the width in the message suffices. There it
/// finds the load that it belongs to.
#[test]
fn an_approach_is_refused_where_it_would_fall_with_the_load() -> Result<()> {
    let shape = Cylinder::new(RADIUS)?;
    for (ratio, thickness) in [(8.0, 4.0), (60.0, 3.0), (1e4, 8.0)] {
        let body = coated(ratio, thickness * HALF_WIDTH)?;
        let plan = |width| Contact::plan(&body, Grid::line(200, width)?, Setup::default());
        let narrow = plan(2.5 * HALF_WIDTH)?;
        let refused = narrow.solve(&shape, &Motion::approach(1e-9), &Options::default());
        let Err(Error::Datum { width, needed }) = refused else {
            panic!("E1/E2 {ratio}: not refused");
        };
        assert!((width / (2.5 * HALF_WIDTH) - 1.0).abs() < 1e-12 && needed > width);
        let wide = plan(needed)?;
        let options = tolerance(1e-11);
        let loaded = wide.solve(&shape, &Motion::load(line_load()?), &options)?;
        let moved = wide.solve(&shape, &Motion::approach(loaded.approach), &options)?;
        assert!(moved.report.converged(), "{ratio}");
        near!(moved.load(), line_load()?, 1e-7);

        // A punch does not change its contact: approach and load are proportional.
        let punch = FlatPunch::new(HALF_WIDTH)?;
        for (contact, rises) in [(&narrow, false), (&wide, true)] {
            let pressed = contact.solve(&punch, &Motion::load(1.0), &options)?;
            let [[stiffness, ..], ..] = pressed.stiffness(None)?;
            near!(stiffness * pressed.approach, 1.0, 1e-6);
            assert_eq!(stiffness > 0.0, rises, "{ratio}");
        }
    }
    Ok(())
}

/// Random hard layers, E1/E2 up to 100, of 0.1 to 10 half-widths on grids of 2.5 to 20: the default and the
/// reference algorithm agree, and a grid twice as wide changes nothing.
#[test]
#[ignore = "slow"]
fn hard_layers_on_grids_of_any_width() -> Result<()> {
    let random = uniform([24, 4], 22);
    let mut datum_moved = 0;
    for row in random.rows() {
        let between = |k: usize, low: f64, high: f64| low * (high / low).powf(row[k]);
        let (ratio, thickness) = (between(0, 1.0, 100.0), between(1, 0.1, 10.0));
        let (width, cells) = (between(2, 2.5, 20.0), 2 * between(3, 20.0, 80.0) as usize);
        let name = format!("E1/E2 {ratio:.1}, h/b {thickness:.2}, width {width:.1}");
        let body = coated(ratio, thickness * HALF_WIDTH)?;
        let grid = Grid::line(cells, width * HALF_WIDTH)?;
        let contact = Contact::plan(&body, grid, Setup::default())?;
        let [found, reference] = [Algorithm::Cascade, Algorithm::PolonskyKeer].map(|algorithm| {
            let (shape, motion) = (Cylinder::new(RADIUS)?, Motion::load(line_load()?));
            converged(&contact, &shape, &motion, &by(algorithm, 1e-10))
        });
        let (found, reference) = (found?, reference?);
        below!(apart(&found.pressure, &reference), 1e-6, name);
        // Where the contact ends on the grid.
        if found.pressure[[0, 0]] <= 0.0 {
            let wide = line(&body, 2 * cells, 2.0 * width)?;
            let inside = wide.pressure.iter().skip(cells / 2);
            below!(apart(inside, &found), 1e-6, name);
        }
        let (shape, motion) = (Cylinder::new(RADIUS)?, Motion::approach(0.0));
        let prescribed = contact.solve(&shape, &motion, &Options::default());
        datum_moved += usize::from(matches!(prescribed, Err(Error::Datum { .. })));
    }
    assert!((4..20).contains(&datum_moved), "{datum_moved}");
    Ok(())
}
