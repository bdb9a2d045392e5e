//! Elastic foundations, as a user gives them, have the coefficients of their point kernels.

use std::f64::consts::PI;

use nacre::influence::{CellInfluence, Method, influence_coefficients};
use nacre::response::{Asymptotes, Response, Sampled};
use nacre::{Elastic, Grid, HalfSpace, Result};

use crate::messages::message;
use crate::support::foundation::{Foundation, bessel_k};
use crate::support::settings::coated;

/// Error over the larger of the coefficient and 1e-3 of that of the loaded cell: the promise of the
/// exact method.
const EXACT: f64 = 1e-9;

fn pasternak(length: f64) -> Foundation {
    Foundation { stiffness: 3.0, shear: 3.0 * length * length }
}

const WINKLER: Foundation = Foundation { stiffness: 3.0, shear: 0.0 };

/// ∫ f over [a, b], by the tanh–sinh rule (Takahasi & Mori 1974).
fn integral(a: f64, b: f64, f: impl Fn(f64) -> f64) -> f64 {
    const STEP: f64 = 0.03;
    let sum: f64 = (-110..=110)
        .map(|k| {
            let t = STEP * f64::from(k);
            let angle = 0.5 * PI * t.sinh();
            let weight = 0.5 * PI * t.cosh() / angle.cosh().powi(2);
            weight * f(0.5 * (a + b) + 0.5 * (b - a) * angle.tanh())
        })
        .sum();
    0.5 * (b - a) * STEP * sum
}

/// Displacement at `at` under unit pressure on a cell: K0(r/ℓ)/2πG integrated over it, in polar
/// coordinates about each corner, with ∫₀ᴿ K0(r/ℓ) r dr = ℓ² − ℓR K1(R/ℓ).
fn cell(body: &Foundation, sides: [f64; 2], at: [f64; 2]) -> f64 {
    let length = body.length();
    let disc = |r: f64| length * length - length * r * bessel_k(r / length)[1];
    let corner = |x: f64, y: f64| {
        let wedge = |near: f64, far: f64| {
            let angle = far.atan2(near);
            integral(0.0, angle, |phi| disc(near / phi.cos()))
        };
        let (u, v) = (x.abs(), y.abs());
        x.signum() * y.signum() * (wedge(u, v) + wedge(v, u))
    };
    let [x, y] = at;
    let [a, b] = sides.map(|d| 0.5 * d);
    let sum =
        corner(x + a, y + b) - corner(x - a, y + b) - corner(x + a, y - b) + corner(x - a, y - b);
    sum / (2.0 * PI * body.shear)
}

#[test]
#[ignore = "slow"]
fn pasternak_has_the_integral_of_its_point_kernel() -> Result<()> {
    // Beyond ℓ = 100 the reference loses digits: ℓ² − ℓR K1 cancels.
    for length in [1e-2, 0.1, 1.0, 10.0, 100.0] {
        for sides in [[1.0, 1.0], [1.0, 1.7], [20.0, 1.0]] {
            let body = pasternak(length);
            let grid = Grid::new([24, 24], sides.map(|d| 24.0 * d))?;
            let coefficients = influence_coefficients(body, &grid, Method::Exact)?;
            let planned = CellInfluence::plan(body, sides, 1e3)?;
            let loaded = cell(&body, sides, [0.0, 0.0]);
            for [i, j] in [[0, 0], [1, 0], [0, 1], [1, 1], [2, 5], [0, 7], [23, 2]] {
                let at = [i as f64 * sides[0], j as f64 * sides[1]];
                let exact = cell(&body, sides, at);
                let scale = exact.abs().max(1e-3 * loaded);
                for found in [coefficients[[i, j]], planned.at(at)] {
                    below!((found - exact).abs() / scale, EXACT, length, at);
                }
            }
        }
    }
    Ok(())
}

#[test]
fn pasternak_strips_have_their_closed_form() -> Result<()> {
    // e^{−|y|/ℓ}/2√(kG), integrated over a strip.
    for length in [1e-2, 0.1, 1.0, 10.0, 1e3] {
        let body = pasternak(length);
        let strips = influence_coefficients(body, &Grid::line(40, 40.0)?, Method::Exact)?;
        let exact = |j: usize| {
            let (half, y) = (0.5 / length, j as f64 / length);
            let sum = match j {
                0 => -(-half).exp_m1(),
                _ => 0.5 * (half - y).exp() * -(-2.0 * half).exp_m1(),
            };
            sum / body.stiffness
        };
        for (j, c) in strips.iter().enumerate() {
            let scale = exact(j).max(1e-3 * exact(0));
            below!((c - exact(j)).abs() / scale, EXACT, length, j);
        }
    }
    Ok(())
}

const CONVERSIONS: [Method; 3] = [
    Method::Plain { refinement: 2 },
    Method::Difference { refinement: 2 },
    Method::Image { refinement: 2 },
];

#[test]
fn conversions_take_a_foundation_whose_limits_are_zero() -> Result<()> {
    // What the spectra lose beyond the Nyquist frequency: 2 % and 5 % at the loaded cell.
    let body = pasternak(8.0);
    let grid = Grid::new([64, 64], [64.0, 64.0])?;
    let exact = influence_coefficients(body, &grid, Method::Exact)?;
    for method in CONVERSIONS {
        let found = influence_coefficients(body, &grid, method)?;
        near!(found[[0, 0]], exact[[0, 0]], 0.06, method);
    }
    Ok(())
}

#[test]
fn local_compliance_moves_the_loaded_cell_alone() -> Result<()> {
    let rectangles = Grid::new([6, 5], [3.0, 4.0])?;
    let converted = CONVERSIONS.map(|method| (rectangles, method));
    let exact = [rectangles, Grid::line(7, 2.0)?].map(|grid| (grid, Method::Exact));
    for (grid, method) in converted.into_iter().chain(exact) {
        let of = |body: nacre::Body| influence_coefficients(&body, &grid, method);
        let springs = of(nacre::Body::new(WINKLER))?;
        let added = of(Sprung::body(0.25)?)? - of(Sprung::body(0.0)?)?;
        for (found, local, rounding) in [(springs, 1.0 / 3.0, 1e-16), (added, 0.25, 1e-15)] {
            for (index, c) in found.indexed_iter() {
                let exact = if index == (0, 0) { local } else { 0.0 };
                below!((c - exact).abs(), rounding, method, index, c);
            }
        }
    }
    Ok(())
}

#[test]
fn local_compliance_acts_inside_the_cell_and_by_half_on_its_rim() -> Result<()> {
    let cell = CellInfluence::plan(WINKLER, [1.0, 2.0], 10.0)?;
    for (at, share) in [
        ([0.0, 0.0], 1.0),
        ([-0.4, 0.9], 1.0),
        ([0.5, 0.0], 0.5),
        ([0.5, -1.0], 0.25),
        ([0.6, 0.0], 0.0),
        ([0.0, 1.1], 0.0),
    ] {
        let value = cell.at(at);
        below!((value - share / 3.0).abs(), 1e-16, at, value);
    }
    Ok(())
}

/// A coated half-space under springs.
#[derive(Debug, Clone)]
struct Sprung {
    below: HalfSpace,
    local: f64,
}

impl Sprung {
    fn body(local: f64) -> Result<nacre::Body> {
        let below = coated(Elastic::new(1.0, 0.3)?, 4.0, 0.5)?;
        Ok(nacre::Body::new(Self { below, local }))
    }
}

impl Response for Sprung {
    fn normal(&self, alpha: f64) -> f64 {
        self.below.normal(alpha)
    }
    fn asymptotes(&self) -> Asymptotes {
        self.below.asymptotes()
    }
    fn lengths(&self) -> Option<[f64; 2]> {
        self.below.lengths()
    }
    fn local(&self) -> f64 {
        self.local
    }
}

/// The samples of a body's response.
fn samples(body: &dyn Response) -> Vec<f64> {
    Sampled::wavenumbers().map(|alpha| body.normal(alpha) / alpha + body.local()).collect()
}

#[test]
fn samples_have_the_coefficients_of_their_body() -> Result<()> {
    let soft = coated(Elastic::new(1.0, 0.3)?, 0.1, 0.05)?;
    let rigid = HalfSpace::new(nacre::Substrate::Rigid, soft.layers().to_vec())?;
    let bodies: [nacre::Body; 6] = [
        pasternak(0.3).into(),
        WINKLER.into(),
        Elastic::new(1.0, 0.3)?.into(),
        coated(Elastic::new(1.0, 0.3)?, 4.0, 0.5)?.into(),
        soft.into(),
        rigid.into(),
    ];
    for body in bodies {
        let sampled = nacre::Body::from(Sampled::new(samples(&*body), 0.0)?);
        assert_eq!(sampled, Sampled::new(samples(&*body), 0.0)?.into());
        for grid in [Grid::new([24, 20], [24.0, 30.0])?, Grid::line(24, 30.0)?] {
            let [found, exact] =
                [&sampled, &body].map(|body| influence_coefficients(body, &grid, Method::Exact));
            let (found, exact) = (found?, exact?);
            let largest = exact[[0, 0]];
            for (index, c) in found.indexed_iter() {
                below!((c - exact[index]).abs() / largest, EXACT, body, index);
            }
        }
    }
    Ok(())
}

#[test]
fn values_that_are_no_response_are_refused() {
    let told = |values: Vec<f64>| message(Sampled::new(values, 0.0));
    let of = |f: fn(f64) -> f64| Sampled::wavenumbers().map(f).collect::<Vec<_>>();
    assert_eq!(told(vec![1.0; 3]), "values: expected shape [37121, 1], got [3, 1]");
    let wrong = "the function of the wavenumber must be finite and at least 0 everywhere, and above 0 somewhere, got";
    assert!(told(of(|_| f64::NAN)).starts_with(&format!("{wrong} NaN at 6.47")));
    assert_eq!(told(of(|_| 0.0)), format!("{wrong} 0 at 1"));
    assert!(told(of(|alpha| 1.0 / alpha.sqrt())).contains("must settle before 1.545"));
    assert!(told(of(|alpha| 1.0 / alpha.powi(2))).contains("must settle before 6.47"));
    assert!(told(of(|alpha| 1.0 + 1.0 / alpha)).contains("give the constant as local"));
    assert_eq!(
        message(Sampled::new(of(|_| 1.0), -1.0)),
        "local must be finite and at least 0, got -1"
    );
}

/// A response that says of itself whatever it is told to.
#[derive(Debug, Clone, Copy)]
struct Told {
    asymptotes: [f64; 3],
    lengths: Option<[f64; 2]>,
    local: f64,
    normal: f64,
}

impl Response for Told {
    fn normal(&self, _: f64) -> f64 {
        self.normal
    }
    fn asymptotes(&self) -> Asymptotes {
        let [long, constant, short] = self.asymptotes;
        Asymptotes { long, constant, short }
    }
    fn lengths(&self) -> Option<[f64; 2]> {
        self.lengths
    }
    fn local(&self) -> f64 {
        self.local
    }
}

#[test]
fn a_response_that_contradicts_itself_is_refused() -> Result<()> {
    let told = |asymptotes, lengths, local, normal| Told { asymptotes, lengths, local, normal };
    let grid = Grid::new([4, 4], [1.0, 1.0])?;
    let sound = told([1.0, 0.0, 1.0], None, 0.0, 1.0);
    assert!(influence_coefficients(sound, &grid, Method::Exact).is_ok());
    let with = |asymptotes| told(asymptotes, None, 0.0, 1.0);
    let between = |lengths, normal| told([1.0, 0.0, 1.0], Some(lengths), 0.0, normal);
    #[rustfmt::skip]
    let cases = [
        (with([f64::NAN, 0.0, 1.0]), "asymptotes().long must be finite and at least 0, got NaN"),
        (with([1.0, 0.0, -1.0]), "asymptotes().short must be finite and at least 0, got -1"),
        (with([1.0, f64::INFINITY, 1.0]), "asymptotes().constant must be finite, got inf"),
        (Told { local: -0.5, ..sound }, "local() must be finite and at least 0, got -0.5"),
        (with([1.0, 0.0, 2.0]), "lengths() must be given for a body whose asymptotes() differ or have a constant"),
        (between([0.0, 1.0], 1.0), "lengths()[0] must be finite and above 0, got 0"),
        (between([2.0, 1.0], 1.0), "lengths()[1] must be finite and at least lengths()[0], got 1"),
        (between([1.0, 2.0], f64::NAN), "normal(1 / lengths()[0]) must be finite and at least 0, got NaN"),
        (between([1.0, 2.0], 3.0), "normal(α) of the body must reach asymptotes().long for wavelengths above and \
             asymptotes().short for wavelengths below its lengths()"),
    ];
    for (body, expected) in cases {
        let coefficients = influence_coefficients(body, &grid, Method::Exact);
        assert_eq!(message(coefficients), expected);
        let cell = CellInfluence::plan(body, [1.0, 1.0], 2.0);
        assert_eq!(message(cell), expected);
    }
    Ok(())
}
