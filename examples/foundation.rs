//! How far does a ball sink into springs, and into the same springs joined by a shear layer?
//!
//! A body that nacre does not know is one `impl Response`: Winkler's foundation, p = k w, has a local
//! compliance and nothing else; Pasternak's, p = k w − G ∇²w, spreads a load over ℓ = √(G/k). Both have
//! closed forms for a paraboloid of radius R, which the numbers are compared with.

use std::f64::consts::PI;

use nacre::response::{Asymptotes, Response};
use nacre::{Contact, Grid, Motion, Options, Paraboloid, Result, Setup, Solution};

const RADIUS: f64 = 0.1;
const STIFFNESS: f64 = 1e12;

/// Contact radius, and the side of the grid.
const CONTACT: f64 = 1e-3;
const SIDE: f64 = 2.6e-3;

/// Springs of stiffness k \[Pa/m\] that do not know of each other.
#[derive(Debug)]
struct Winkler;

impl Response for Winkler {
    fn normal(&self, _: f64) -> f64 {
        0.0
    }

    fn asymptotes(&self) -> Asymptotes {
        Asymptotes { long: 0.0, constant: 0.0, short: 0.0 }
    }

    fn lengths(&self) -> Option<[f64; 2]> {
        None
    }

    fn local(&self) -> f64 {
        1.0 / STIFFNESS
    }
}

/// Springs joined by a layer that resists shear over the length ℓ \[m\].
#[derive(Debug)]
struct Pasternak {
    length: f64,
}

impl Response for Pasternak {
    fn normal(&self, alpha: f64) -> f64 {
        alpha / (STIFFNESS * (1.0 + (alpha * self.length).powi(2)))
    }

    fn asymptotes(&self) -> Asymptotes {
        Asymptotes { long: 0.0, constant: 1.0 / STIFFNESS, short: 0.0 }
    }

    fn lengths(&self) -> Option<[f64; 2]> {
        Some([self.length; 2])
    }
}

/// ∫₀^∞ e^{−x cosh t} cosh νt dt, by the trapezoidal rule.
fn bessel_k(nu: f64, x: f64) -> f64 {
    let term = |k: i32| {
        let t = 0.02 * f64::from(k);
        0.02 * (-x * t.cosh()).exp() * (nu * t).cosh()
    };
    0.5 * term(0) + (1..500).map(term).sum::<f64>()
}

fn press(body: impl Response + 'static, load: f64) -> Result<Solution> {
    let grid = Grid::new([256, 256], [SIDE; 2])?;
    let contact = Contact::plan(body, grid, Setup::default())?;
    let options = Options::default();
    let ball = Paraboloid::new(RADIUS, RADIUS)?;
    let solution = contact.solve(&ball, &Motion::load(load), &options)?;
    solution.require_converged(options.tolerance)
}

/// Approaches over their closed forms, on springs alone and joined over each of `lengths`; the force is
/// the one that makes a contact of radius [`CONTACT`].
pub(crate) fn approaches(lengths: &[f64]) -> Result<Vec<f64>> {
    println!("l/mm    force/N   approach/um   closed form   peak/MPa   closed form");
    let mut ratios = Vec::new();
    for &length in lengths {
        let ratio = CONTACT / length;
        let outside = if length > 0.0 {
            CONTACT * length / RADIUS * bessel_k(0.0, ratio) / bessel_k(1.0, ratio)
        } else {
            0.0
        };
        // δ = a²/2R + (aℓ/R) K0/K1, p = k (δ − r²/2R) + 2G/R, W = ∫ p dA
        let approach = 0.5 * CONTACT * CONTACT / RADIUS + outside;
        let peak = STIFFNESS * (approach + 2.0 * length * length / RADIUS);
        let area = PI * CONTACT * CONTACT;
        let load = area * (peak - 0.25 * STIFFNESS * CONTACT * CONTACT / RADIUS);
        let solution =
            if length > 0.0 { press(Pasternak { length }, load)? } else { press(Winkler, load)? };
        println!(
            "{:4.1}   {load:8.3}   {:11.4}   {:11.4}   {:8.3}   {:11.3}",
            1e3 * length,
            1e6 * solution.approach,
            1e6 * approach,
            1e-6 * solution.peak_pressure(),
            1e-6 * peak,
        );
        ratios.push(solution.approach / approach);
    }
    Ok(ratios)
}

pub(crate) fn main() -> Result<()> {
    approaches(&[0.0, 0.2e-3, 0.5e-3, 1e-3]).map(drop)
}
