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

use nacre::{
    Contact, Cylinder, Grid, Motion, Options, Paraboloid, Result, Setup, Solution, Surface, solve,
};

use crate::support::foundation::{Foundation, bessel_k};

/// So large that a circle is a parabola to (a/R)²/4 = 2.5e-9.
const RADIUS: f64 = 1e4;

/// Side of the grids: the contact has radius 1.
const WIDTH: f64 = 2.6;

const PASTERNAK: Foundation = Foundation {
    stiffness: 2.0,
    shear: 0.5,
};

const WINKLER: Foundation = Foundation {
    stiffness: 2.0,
    shear: 0.0,
};

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

/// A paraboloid on Pasternak's foundation.
fn point() -> Exact {
    let (
        Foundation {
            stiffness: k,
            shear,
        },
        length,
    ) = (PASTERNAK, PASTERNAK.length());
    let [k0, k1] = bessel_k(1.0 / length);
    let approach = 0.5 / RADIUS + length / RADIUS * k0 / k1;
    let pressure = |r: f64| k * (approach - 0.5 * r * r / RADIUS) + 2.0 * shear / RADIUS;
    Exact {
        approach,
        load: PI * (k * approach - 0.25 * k / RADIUS + 2.0 * shear / RADIUS),
        central: pressure(0.0),
        edge: pressure(1.0),
    }
}

/// A cylinder on Pasternak's foundation.
fn line() -> Exact {
    let (
        Foundation {
            stiffness: k,
            shear,
        },
        length,
    ) = (PASTERNAK, PASTERNAK.length());
    let approach = 0.5 / RADIUS + length / RADIUS;
    let pressure = |y: f64| k * (approach - 0.5 * y * y / RADIUS) + shear / RADIUS;
    Exact {
        approach,
        load: 2.0 * (k * approach - k / (6.0 * RADIUS) + shear / RADIUS),
        central: pressure(0.0),
        edge: pressure(1.0),
    }
}

fn press(body: Foundation, shape: &dyn Surface, grid: Grid, motion: &Motion) -> Result<Solution> {
    let options = Options {
        tolerance: 1e-10,
        ..Options::default()
    };
    let solution = Contact::plan(body, grid, Setup::default())?.solve(shape, motion, &options)?;
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
        .fold(0.0, |worst, (r, p)| {
            worst.max((p - exact(r)).abs() / exact(0.0))
        })
}

#[test]
fn paraboloid_on_pasternaks_foundation() -> Result<()> {
    let exact = point();
    let shape = Paraboloid::new(RADIUS, RADIUS)?;
    let pressure = |r: f64| exact.central + (exact.edge - exact.central) * r * r;
    for cells in [64, 128, 256] {
        let grid = Grid::new([cells, cells], [WIDTH; 2])?;
        let dx = WIDTH / cells as f64;
        let loaded = press(PASTERNAK, &shape, grid, &Motion::load(exact.load))?;
        let moved = press(PASTERNAK, &shape, grid, &Motion::approach(exact.approach))?;
        let approach = loaded.approach / exact.approach - 1.0;
        let load = moved.load() / exact.load - 1.0;
        let area = loaded.contact_area() / PI - 1.0;
        let inside = pressure_error(&loaded, 3.0 * dx, pressure);
        println!(
            "{cells}: approach {approach:.1e} load {load:.1e} area {area:.1e} pressure {inside:.1e}, \
             {} and {} iterations",
            loaded.report.iterations, moved.report.iterations
        );
        // The jump at the edge is a ring of cells that are in contact or not: the area is of first order,
        // and what follows from the whole pressure of second.
        assert!(area.abs() < 0.6 * dx, "{cells}: {area:e}");
        assert!(
            approach.abs().max(load.abs()) < 0.2 * dx * dx,
            "{cells}: {approach:e} {load:e}"
        );
        assert!(inside < NEAR_THE_EDGE, "{cells}: {inside:e}");
    }
    Ok(())
}

#[test]
fn cylinder_on_pasternaks_foundation() -> Result<()> {
    let exact = line();
    let shape = Cylinder::new(RADIUS)?;
    let pressure = |y: f64| exact.central + (exact.edge - exact.central) * y * y;
    for cells in [64, 128, 256, 512, 1024] {
        let grid = Grid::line(cells, WIDTH)?;
        let dx = WIDTH / cells as f64;
        let loaded = press(PASTERNAK, &shape, grid, &Motion::load(exact.load))?;
        let moved = press(PASTERNAK, &shape, grid, &Motion::approach(exact.approach))?;
        let approach = loaded.approach / exact.approach - 1.0;
        let load = moved.load() / exact.load - 1.0;
        let width = 0.5 * loaded.contact_area() - 1.0;
        let inside = pressure_error(&loaded, 3.0 * dx, pressure);
        println!(
            "{cells}: approach {approach:.1e} load {load:.1e} width {width:.1e} pressure {inside:.1e}"
        );
        assert!(width.abs() < dx, "{cells}: {width:e}");
        assert!(
            approach.abs().max(load.abs()) < 0.2 * dx * dx,
            "{cells}: {approach:e} {load:e}"
        );
        assert!(inside < NEAR_THE_EDGE, "{cells}: {inside:e}");
        // The displacement vanishes far away by itself: there is no datum, and the grid's width is free.
        let wide = Grid::line(2 * cells, 2.0 * WIDTH)?;
        let wider = press(PASTERNAK, &shape, wide, &Motion::load(exact.load))?;
        let change = wider.approach / loaded.approach - 1.0;
        assert!(change.abs() < 1e-9, "{cells}: {change:e}");
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
    let shapes: [(&dyn Surface, f64, Grid); 2] = [
        (
            &Paraboloid::new(RADIUS, RADIUS)?,
            ball,
            Grid::new([200, 160], [WIDTH; 2])?,
        ),
        (&Cylinder::new(RADIUS)?, cylinder, Grid::line(200, WIDTH)?),
    ];
    for (shape, load, grid) in shapes {
        let loaded = press(WINKLER, shape, grid, &Motion::load(load))?;
        let moved = press(WINKLER, shape, grid, &Motion::approach(approach))?;
        let inside = pressure_error(&moved, 0.0, |r| k * approach * (1.0 - r * r));
        let found = [loaded.approach / approach - 1.0, moved.load() / load - 1.0];
        println!(
            "approach {:.1e} load {:.1e} pressure {inside:.1e}, {} iterations",
            found[0], found[1], loaded.report.iterations
        );
        assert!(found.iter().all(|error| error.abs() < 1e-4), "{found:?}");
        assert!(inside < 1e-8, "{inside:e}");
    }
    Ok(())
}

#[test]
fn a_grid_is_found_on_foundations() -> Result<()> {
    // 64 cells across the contact.
    let shape = Paraboloid::new(RADIUS, RADIUS)?;
    let exact = point();
    let found = solve(&shape, PASTERNAK, &Motion::load(exact.load))?;
    assert!((found.approach / exact.approach - 1.0).abs() < 3e-4);
    for load in [1e-9, 1e-3, 1e3] {
        let approach = (load / (PI * WINKLER.stiffness * RADIUS)).sqrt();
        let found = solve(&shape, WINKLER, &Motion::load(load))?;
        assert!((found.approach / approach - 1.0).abs() < 3e-4, "{load}");
        // Nothing but the size of the contact against ℓ changes.
        let found = solve(&shape, PASTERNAK, &Motion::load(load))?;
        let [[low, high], _] = found.contact_extent();
        let cells = (high - low) / found.grid().spacing()[0];
        // Cells are halved where the shear layer's steep pressure at the rim asks for it.
        let halved = (cells / 69.0).log2().round();
        assert!((0.0..4.0).contains(&halved), "{load}: {cells}");
        assert!(
            (60.0..80.0).contains(&(cells / halved.exp2())),
            "{load}: {cells}"
        );
    }
    Ok(())
}
