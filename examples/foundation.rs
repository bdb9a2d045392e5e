//! How does a body that is not a half-space take part in a contact?
//!
//! Pasternak's foundation is a membrane under the tension G on springs of the stiffness k per unit
//! area. A body implements `Response`: its normal compliance as a function of the wavenumber.

use nacre::response::Asymptotes;
use nacre::{Contact, Grid, Motion, Options, Response, Result, Setup, Sphere};

#[derive(Debug)]
struct Pasternak {
    stiffness: f64,
    tension: f64,
}

impl Response for Pasternak {
    fn normal(&self, wavenumber: f64) -> f64 {
        wavenumber / (self.stiffness + self.tension * wavenumber.powi(2))
    }

    fn asymptotes(&self) -> Asymptotes {
        let constant = 1.0 / self.stiffness;
        Asymptotes {
            long: 0.0,
            constant,
            short: 0.0,
        }
    }

    fn lengths(&self) -> Option<[f64; 2]> {
        Some([(self.tension / self.stiffness).sqrt(); 2])
    }
}

/// Peak pressure and approach of a sphere pressed on the foundation.
pub(crate) fn pressed() -> Result<(f64, f64)> {
    let foundation = Pasternak {
        stiffness: 1e12,
        tension: 4e4,
    };
    let grid = Grid::new([128, 128], [4e-3, 4e-3])?;
    let contact = Contact::plan(foundation, grid, Setup::default())?;
    let solution = contact.solve(
        &Sphere::new(50e-3)?,
        &Motion::load(10.0),
        &Options::default(),
    )?;
    println!(
        "peak {:.3e} Pa, approach {:.3e} m",
        solution.peak_pressure(),
        solution.approach
    );
    Ok((solution.peak_pressure(), solution.approach))
}

pub(crate) fn main() -> Result<()> {
    pressed().map(drop)
}
