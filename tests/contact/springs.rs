//! Springs between the surfaces, of a compliance of each cell: uniform they are a body's local compliance, and the solution,
//! its stiffness and its derivatives hold with them.

use nacre::gradient::{LinearOptions, Linearisation, Output};
use nacre::response::{Asymptotes, Response};
use nacre::{
    Algorithm, Compliance, Elastic, Error, Grid, HalfSpace, Hardness, Motion, Options, Result,
    Solution, Solver, Sphere, Surface,
};
use ndarray::Array2;

use super::stiffness::assert_stiffness_with;
use crate::support::checks::{apart, largest};
use crate::support::contacts::Random;
use crate::support::random::uniform;
use crate::support::settings::{converged, plan, stack, tolerance};

/// A body of one layer.
fn coated() -> Result<HalfSpace> {
    stack(Elastic::new(1.0, 0.25)?, [[4.0, 0.3, 0.1]])
}

/// A body on which springs lie.
#[derive(Debug)]
struct OnSprings(HalfSpace, f64);

impl Response for OnSprings {
    fn normal(&self, wavenumber: f64) -> f64 {
        self.0.normal(wavenumber)
    }
    fn asymptotes(&self) -> Asymptotes {
        self.0.asymptotes()
    }
    fn lengths(&self) -> Option<[f64; 2]> {
        self.0.lengths()
    }
    fn local(&self) -> f64 {
        self.1
    }
}

/// Options with springs of these compliances.
fn on(compliance: Compliance, limit: f64) -> Options {
    tolerance(limit).with_compliance(compliance)
}

fn grid() -> Result<Grid> {
    Grid::new([60, 45], [2.4, 2.0])
}

/// Compliances of one half of the grid between one and twenty times what a cell of the body gives, and none of the other.
fn uneven(grid: &Grid) -> Array2<f64> {
    let (random, x) = (uniform(grid.shape(), 7), grid.x());
    Array2::from_shape_fn(grid.shape(), |(i, j)| {
        if x[i] < 0.3 { (random[[i, j]] * 3.0).exp() * grid.spacing()[0] } else { 0.0 }
    })
}

/// The same contact, with springs of the cells and with those of the body: to the tolerance of both.
#[test]
fn uniform_springs_are_a_local_compliance() -> Result<()> {
    const TOLERANCE: f64 = 1e-11;
    let sphere = Sphere::new(50.0)?;
    for (grid, motion) in [
        (grid()?, Motion::load(0.02).with_eccentricity([Some(0.05), None])),
        (grid()?.periodic([true; 2])?, Motion::load(0.02)),
        (Grid::line(96, 2.0)?, Motion::load(0.01)),
    ] {
        for c in [0.01, 0.3, 10.0] {
            let springs = plan(coated()?, grid)?;
            let options = on(Compliance::Uniform(c), TOLERANCE);
            let one = converged(&springs, &sphere, &motion, &options)?;
            let body = plan(nacre::Body::new(OnSprings(coated()?, c)), grid)?;
            let other = converged(&body, &sphere, &motion, &tolerance(TOLERANCE))?;
            // A residual of 1e-11 leaves pressures whose energy differs by so much: its root, at most.
            below!(apart(&one.pressure, &other.pressure), 3e-6 * largest(&other.pressure), c);
            near!(one.approach, other.approach, 1e-9, c);
            let whole = &one.displacement + &(&one.pressure * c);
            below!(apart(&whole, &other.displacement), 3e-6 * largest(&other.displacement), c);
            let deep = largest(&other.displacement);
            below!(apart(&one.gap(), &other.gap()), 3e-6 * deep, c);
        }
    }
    Ok(())
}

/// Both algorithms find one pressure; the displacement is that of the bodies; in contact the gap is 0, and elsewhere above.
#[test]
fn springs_of_each_cell_satisfy_the_contact() -> Result<()> {
    const TOLERANCE: f64 = 1e-10;
    let grid = grid()?;
    let contact = plan(coated()?, grid)?;
    let (sphere, motion) = (Sphere::new(50.0)?, Motion::load(0.02));
    let springs = uneven(&grid);
    let options = on(Compliance::Cells(springs.clone()), TOLERANCE);
    let solution = converged(&contact, &sphere, &motion, &options)?;
    let displacement = contact.convolution().apply(&solution.pressure)?;
    below!(apart(&solution.displacement, &displacement), 1e-13 * largest(&displacement));
    let (x, y) = (grid.x(), grid.y());
    let whole = &displacement + &(&springs * &solution.pressure);
    let gap = Array2::from_shape_fn(springs.dim(), |(i, j)| {
        sphere.gap(x[i], y[j]) + whole[[i, j]] - solution.approach
    });
    let deep = largest(&whole);
    below!(apart(&solution.gap(), &gap), 1e-13 * deep);
    for (g, p) in gap.iter().zip(&solution.pressure) {
        assert!(*g > -1e-9 * deep && (*p <= 0.0 || *g < 1e-6 * deep), "{g:e} {p:e}");
    }
    let reference = options.with_algorithm(Algorithm::PolonskyKeer);
    let other = converged(&contact, &sphere, &motion, &reference)?;
    below!(apart(&solution.pressure, &other.pressure), 1e-5 * largest(&other.pressure));
    assert_eq!(solution.report.solver, Some(Solver::Preconditioned));
    Ok(())
}

#[test]
fn stiffness_with_springs_is_that_of_differences() -> Result<()> {
    let grid = grid()?;
    let options = on(Compliance::Cells(uneven(&grid)), 1e-13);
    let contact = plan(coated()?, grid)?;
    assert_stiffness_with(&contact, &Sphere::new(50.0)?, [0.01, 1e-3, -2e-3], 2e-6, 1e-6, &options)
}

/// Adjoint and tangent agree as sums, for all parameters and for a change of the gap; and the value of a gap counts the spring.
#[test]
fn derivatives_with_springs_pass_the_dot_test() -> Result<()> {
    const EXACT: f64 = 1e-9;
    let grid = grid()?;
    let contact = plan(coated()?, grid)?;
    let (sphere, motion) = (Sphere::new(50.0)?, Motion::load(0.02));
    let options = on(Compliance::Cells(uneven(&grid)), 1e-10);
    let solution = converged(&contact, &sphere, &motion, &options)?;
    let linear = LinearOptions::default().with_tolerance(1e-12);
    let linearised = Linearisation::plan(&solution, Some(&sphere), &linear)?;
    let numbers = &mut Random::new(5);
    let mut random = || Array2::from_shape_simple_fn(grid.shape(), || numbers.between(-1.0, 1.0));
    let (weights, gap) = (random(), random());
    let sized = |field: &Array2<f64>| (field * &weights).mapv(f64::abs).sum();
    let gradient = linearised.vjp(&weights, None)?;
    for (parameter, value) in &gradient.values {
        let tangent = linearised.jvp(&[(&parameter.to_string(), 1.0)], None)?;
        let dot = (&tangent.pressure * &weights).sum();
        let scale = sized(&tangent.pressure) + 1e-3 * sized(&solution.pressure);
        below!((dot - value).abs(), EXACT * scale, parameter);
    }
    let tangent = linearised.jvp(&[], Some(&gap))?;
    let dot = (&tangent.pressure * &weights).sum();
    below!(((&gradient.gap * &gap).sum() - dot).abs(), EXACT * sized(&tangent.pressure));
    // In contact a gap is 0, whatever the spring.
    let at = Output::Gap([0.02, 0.0]);
    let value = linearised.gradients(&[at], Some(&[]))?[0].value;
    below!(value.abs(), 1e-9 * solution.approach);
    Ok(())
}

/// With a hardness both bounds hold; springs of none at all change no bit.
#[test]
fn springs_go_with_hardness_and_none_change_nothing() -> Result<()> {
    let grid = grid()?;
    let contact = plan(coated()?, grid)?;
    let (sphere, motion) = (Sphere::new(50.0)?, Motion::load(0.02));
    let plain = converged(&contact, &sphere, &motion, &tolerance(1e-8))?;
    let none = on(Compliance::Cells(Array2::zeros(grid.shape())), 1e-8);
    let same: Solution = converged(&contact, &sphere, &motion, &none)?;
    assert_eq!(plain.pressure, same.pressure);
    let limit = 0.7 * plain.peak_pressure();
    let options = on(Compliance::Uniform(0.01), 1e-9).with_hardness(Hardness::Uniform(limit));
    let dented = converged(&contact, &sphere, &motion, &options)?;
    let dent = dented.indentation.as_ref().expect("cells yield");
    let (x, y) = (grid.x(), grid.y());
    for ((i, j), p) in dented.pressure.indexed_iter() {
        let whole = dented.displacement[[i, j]] + 0.01 * p - dented.approach;
        let gap = sphere.gap(x[i], y[j]) + whole + dent[[i, j]];
        assert!(gap > -1e-8 * dented.approach && *p <= limit);
        assert!(*p <= 0.0 || gap < 1e-6 * dented.approach, "{gap:e}");
    }
    Ok(())
}

#[test]
fn wrong_compliances_are_refused() -> Result<()> {
    let contact = plan(coated()?, Grid::new([8, 8], [2.0, 2.0])?)?;
    let sphere = Sphere::new(50.0)?;
    let message = |compliance: Compliance| {
        let refused = contact.solve(&sphere, &Motion::load(0.02), &on(compliance, 1e-8));
        refused.expect_err("it must be refused").to_string()
    };
    let negative = message(Compliance::Uniform(-1.0));
    assert_eq!(negative, "compliance must be finite and at least 0, got -1");
    let mut cells = Array2::zeros([8, 8]);
    cells[[2, 3]] = f64::NAN;
    let not_finite = message(Compliance::Cells(cells.clone()));
    assert!(not_finite.starts_with("compliance"), "{not_finite}");
    cells[[2, 3]] = -2.0;
    let below_zero = message(Compliance::Cells(cells));
    assert!(below_zero.starts_with("compliance") && below_zero.contains("-2"), "{below_zero}");
    let other = message(Compliance::Cells(Array2::zeros([8, 4])));
    assert!(other.contains("compliance") && other.contains("[8, 4]"), "{other}");
    let options = on(Compliance::Cells(Array2::zeros([8, 8])), 1e-8);
    let motion = Motion::load(0.02);
    let chosen = nacre::Setup::default();
    let body = coated()?.into();
    let error = nacre::contact::solve_with(&sphere, &body, &chosen, &motion, &options);
    assert!(matches!(error, Err(Error::Inconsistent(_))));
    Ok(())
}
