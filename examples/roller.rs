//! How much does a roller tilt, and its pressure rise, when the force acts off its centre?
//!
//! The roller of Spinu et al. has a coating twice as stiff as the substrate and is free to tilt along
//! its axis. The contact is planned once and solved for each position of the force.

use nacre::{Contact, Elastic, Grid, HalfSpace, Layer, Motion, Options, Result, Roller, Setup};

const HALF_FLAT: f64 = 19.13e-3 / 2.0;

/// Peak pressures for the force at each fraction of the half length.
pub(crate) fn peaks(fractions: &[f64]) -> Result<Vec<f64>> {
    let steel = Elastic::new(210e9, 0.3)?;
    let coating = Layer::new(Elastic::new(420e9, 0.3)?, 40e-6)?;
    let roller = Roller::new(5e-3, 2.0 * HALF_FLAT, 7.5)?;
    let grid = Grid::new([384, 48], [32e-3, 0.1e-3])?;
    let contact = Contact::plan(&HalfSpace::new(steel, [coating])?, grid, Setup::default())?;

    println!("e/L   tilt/1e-5   peak/MPa   contact from/mm   to/mm");
    let mut peaks = Vec::new();
    for fraction in fractions {
        let eccentricity = [Some(fraction * HALF_FLAT), None];
        let motion = Motion::load(1e3).with_eccentricity(eccentricity);
        let options = Options::default();
        let solution = contact.solve(&roller, &motion, &options)?;
        let solution = solution.require_converged(options.tolerance)?;
        let [from, to] = solution.contact_extent()[0].map(|x| x * 1e3);
        let (tilt, peak) = (solution.tilt[0] * 1e5, solution.peak_pressure());
        println!("{fraction:3.1}   {tilt:9.3}   {:8.0}   {from:15.2}   {to:5.2}", peak / 1e6);
        peaks.push(peak);
    }
    Ok(peaks)
}

pub(crate) fn main() -> Result<()> {
    peaks(&[0.0, 0.1, 0.2, 0.3]).map(drop)
}
