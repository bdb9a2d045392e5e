//! Contacts on elastic foundations, as a user gives them, equal their closed forms.
//!
//! On Pasternak's foundation p = k w − G ∇²w, ℓ = √(G/k), a paraboloid of radius R touches for r < a:
//! there w = δ − r²/2R and p = k(δ − r²/2R) + 2G/R; outside w = C K0(r/ℓ). w and w' are continuous at
//! a, since nothing loads the edge, so that
//!
//! ```text
//! δ = a²/2R + (aℓ/R) K0(a/ℓ)/K1(a/ℓ)        W = π a² [kδ − k a²/4R + 2G/R]
//! ```
//!
//! and the pressure jumps at the edge. For an endless cylinder p = k(δ − y²/2R) + G/R, w ~ e^{−y/ℓ}
//! outside, δ = a²/2R + aℓ/R, and W = 2a [kδ − k a²/6R + G/R]. Without G, p = k(δ − r²/2R) and
//! W = πkRδ². Derived here; the foundations are described by Kerr, J. Appl. Mech. 31 (1964) 491.

use std::f64::consts::PI;

use nacre::{Cylinder, Grid, Motion, Paraboloid, Result, Solution, Surface, solve};

use crate::support::foundation::{Foundation, bessel_k};
use crate::support::settings::{plan, tolerance};

/// So large that a circle is a parabola to (a/R)²/4 = 2.5e-9.
const RADIUS: f64 = 1e4;

/// Side of the grids: the contact has radius 1.
const WIDTH: f64 = 2.6;

const PASTERNAK: Foundation = Foundation { stiffness: 2.0, shear: 0.5 };

const WINKLER: Foundation = Foundation { stiffness: 2.0, shear: 0.0 };

/// Error of the pressure three cells inside the edge, over that at the centre. The jump at the edge
/// leaves an overshoot that falls from cell to cell, and not with their size.
const NEAR_THE_EDGE: f64 = 2e-3;

/// A contact of radius or half-width 1.
struct Exact {
    approach: f64,
    load: f64,
    central: f64,
    edge: f64,
}

/// A paraboloid on Pasternak's foundation, or a cylinder.
fn exact(is_line: bool) -> Exact {
    let (k, shear, length) = (PASTERNAK.stiffness, PASTERNAK.shear, PASTERNAK.length());
    let [k0, k1] = bessel_k(1.0 / length);
    // Beside a line w falls as an exponential, whose K0/K1 is 1, and the curvature is half as large.
    let (ratio, curvature) = if is_line { (1.0, 1.0) } else { (k0 / k1, 2.0) };
    let approach = 0.5 / RADIUS + length / RADIUS * ratio;
    let pressure = |r: f64| k * (approach - 0.5 * r * r / RADIUS) + curvature * shear / RADIUS;
    // The area, and the mean of r²/2 over it.
    let (area, mean) = if is_line { (2.0, 1.0 / 6.0) } else { (PI, 0.25) };
    Exact {
        approach,
        load: area * (k * (approach - mean / RADIUS) + curvature * shear / RADIUS),
        central: pressure(0.0),
        edge: pressure(1.0),
    }
}

fn press(body: Foundation, shape: &dyn Surface, grid: Grid, motion: &Motion) -> Result<Solution> {
    let options = tolerance(1e-10);
    let solution = plan(body, grid)?.solve(shape, motion, &options)?;
    solution.require_converged(options.tolerance)
}

/// Largest error of the pressure, over that at the centre, in cells whose centre is at least `margin`
/// inside the contact.
fn pressure_error(solution: &Solution, margin: f64, exact: impl Fn(f64) -> f64) -> f64 {
    let (x, y) = (solution.grid().x(), solution.grid().y());
    let inside = solution.pressure.indexed_iter().map(|((i, j), p)| {
        let along = if solution.grid().is_line() { 0.0 } else { x[i] };
        (along.hypot(y[j]), p)
    });
    inside
        .filter(|(r, _)| *r < 1.0 - margin)
        .fold(0.0, |worst, (r, p)| worst.max((p - exact(r)).abs() / exact(0.0)))
}

/// Errors of a contact on cells of side `dx`. The jump at the edge is a ring of cells that are in contact or not: the area
/// is of first order, and what follows from the whole pressure of second.
fn check(shape: &dyn Surface, grid: Grid, area: f64, rim: f64) -> Result<()> {
    let (exact, dx) = (exact(grid.is_line()), grid.spacing()[1]);
    let pressure = |r: f64| exact.central + (exact.edge - exact.central) * r * r;
    let loaded = press(PASTERNAK, shape, grid, &Motion::load(exact.load))?;
    let moved = press(PASTERNAK, shape, grid, &Motion::approach(exact.approach))?;
    near!(loaded.contact_area(), area, rim * dx, grid);
    near!(loaded.approach, exact.approach, 0.2 * dx * dx, grid);
    near!(moved.load(), exact.load, 0.2 * dx * dx, grid);
    let inside = pressure_error(&loaded, 3.0 * dx, pressure);
    below!(inside, NEAR_THE_EDGE, grid);
    Ok(())
}

#[test]
#[ignore = "slow"]
fn shapes_on_pasternaks_foundation() -> Result<()> {
    let shape = Paraboloid::new(RADIUS, RADIUS)?;
    for cells in [64, 128, 256] {
        check(&shape, Grid::new([cells, cells], [WIDTH; 2])?, PI, 0.6)?;
    }
    let shape = Cylinder::new(RADIUS)?;
    let motion = Motion::load(exact(true).load);
    for cells in [64, 128, 256, 512, 1024] {
        let grid = Grid::line(cells, WIDTH)?;
        check(&shape, grid, 2.0, 1.0)?;
        // The displacement vanishes far away by itself: there is no datum, and the grid's width is free.
        let wide = Grid::line(2 * cells, 2.0 * WIDTH)?;
        let [near, far] = [grid, wide].map(|grid| press(PASTERNAK, &shape, grid, &motion));
        near!(far?.approach, near?.approach, 1e-9, cells);
    }
    Ok(())
}

#[test]
fn shapes_on_winklers_foundation() -> Result<()> {
    // The contact's radius is 1; cells are in contact or not, and the pressure is 0 at the edge.
    let approach = 0.5 / RADIUS;
    let k = WINKLER.stiffness;
    let ball = PI * k * RADIUS * approach * approach;
    // ∫ k (δ − y²/2R) dy
    let cylinder = 4.0 / 3.0 * k * approach;
    let (paraboloid, plane) = (Paraboloid::new(RADIUS, RADIUS)?, [200, 160]);
    let shapes: [(&dyn Surface, f64, Grid); 2] = [
        (&paraboloid, ball, Grid::new(plane, [WIDTH; 2])?),
        (&Cylinder::new(RADIUS)?, cylinder, Grid::line(200, WIDTH)?),
    ];
    for (shape, load, grid) in shapes {
        let loaded = press(WINKLER, shape, grid, &Motion::load(load))?;
        let moved = press(WINKLER, shape, grid, &Motion::approach(approach))?;
        let inside = pressure_error(&moved, 0.0, |r| k * approach * (1.0 - r * r));
        near!(loaded.approach, approach, 1e-4);
        near!(moved.load(), load, 1e-4);
        below!(inside, 1e-8);
    }
    Ok(())
}

#[test]
fn a_grid_is_found_on_foundations() -> Result<()> {
    // 64 cells across the contact.
    let shape = Paraboloid::new(RADIUS, RADIUS)?;
    let exact = exact(false);
    let found = solve(&shape, PASTERNAK, &Motion::load(exact.load))?;
    near!(found.approach, exact.approach, 3e-4);
    for load in [1e-9, 1e-3, 1e3] {
        let approach = (load / (PI * WINKLER.stiffness * RADIUS)).sqrt();
        let found = solve(&shape, WINKLER, &Motion::load(load))?;
        near!(found.approach, approach, 3e-4, load);
        // Nothing but the size of the contact against ℓ changes.
        let found = solve(&shape, PASTERNAK, &Motion::load(load))?;
        let [[low, high], _] = found.contact_extent();
        let cells = (high - low) / found.grid().spacing()[0];
        // Cells are halved where the shear layer's steep pressure at the rim asks for it.
        let halved = (cells / 69.0).log2().round();
        assert!((0.0..4.0).contains(&halved), "{load}: {cells}");
        let whole = cells / halved.exp2();
        assert!((60.0..80.0).contains(&whole), "{load}: {cells}");
    }
    Ok(())
}
