//! Contacts of bodies with free ends.

use nacre::{
    Contact, Elastic, Grid, HalfSpace, Motion, Options, Result, Setup, Solution, Surface, Warning,
};

use crate::support::reference::{cases, list, number};

/// A straight roller with sharp ends whose half-width and pressure of Hertz's line are 1 at the load π/2 per length.
#[derive(Debug)]
struct Straight {
    half_length: f64,
}

impl Surface for Straight {
    fn gap(&self, x: f64, y: f64) -> f64 {
        if x.abs() <= self.half_length {
            2.0 * y * y
        } else {
            f64::INFINITY
        }
    }

    fn extent(&self) -> [nacre::surface::Extent; 2] {
        let ends = [-self.half_length, self.half_length];
        [
            nacre::surface::Extent::CutOff(ends),
            nacre::surface::Extent::Rising,
        ]
    }
}

/// Bodies with (1 − ν²)/E = 1.
fn unit(poisson: f64) -> Result<Elastic> {
    Elastic::new(1.0 - poisson * poisson, poisson)
}

/// The straight roller of length 20, on `cells` along the whole length and across ±1.5.
fn straight(bodies: [&HalfSpace; 2], cells: [usize; 2]) -> Result<Solution> {
    let half_length = 10.0;
    let setup = Setup {
        counterbody: Some(bodies[1].into()),
        ..Setup::default()
    };
    let grid = Grid::new(cells, [2.0 * half_length, 3.0])?;
    let contact = Contact::plan(bodies[0], grid, setup)?;
    let motion = Motion::load(20.0 * std::f64::consts::FRAC_PI_2);
    let options = Options::default();
    contact
        .solve(&Straight { half_length }, &motion, &options)?
        .require_converged(options.tolerance)
}

/// Pressure on the axis at a distance from the end, by linear interpolation between cells.
fn on_axis(solution: &Solution, distance: f64) -> f64 {
    let ([nx, ny], spacing) = (solution.grid().shape(), solution.grid().spacing());
    let at = distance / spacing[0] - 0.5;
    let low = (at.max(0.0) as usize).min(nx - 2);
    let row =
        |i: usize| 0.5 * (solution.pressure[[i, ny / 2 - 1]] + solution.pressure[[i, ny / 2]]);
    row(low) + (at - low as f64) * (row(low + 1) - row(low))
}

#[test]
fn sharp_roller_on_a_wide_race() -> Result<()> {
    for case in cases("finite_roller.json") {
        println!("{}", case["case"]);
        let poisson = number(&case, "nu");
        let ends = [Some(-10.0), Some(10.0)];
        let free = HalfSpace::from(unit(poisson)?).with_ends(ends)?;
        let whole = HalfSpace::from(unit(poisson)?);
        for cells in [[200, 32], [400, 64], [800, 96]] {
            for bodies in [[&whole, &whole], [&whole, &free], [&free, &free]] {
                let start = std::time::Instant::now();
                let solution = straight(bodies, cells)?;
                let seconds = start.elapsed().as_secs_f64();
                let at: Vec<String> = list(&case, "x_over_b")
                    .iter()
                    .map(|x| format!("{:.4}", on_axis(&solution, x.as_f64().unwrap_or(0.0))))
                    .collect();
                println!(
                    "{cells:?} {at:?} {:.4} {} it {seconds:.2} s, {:.2} {:?}",
                    solution.approach,
                    solution.report.iterations,
                    solution.report.seconds,
                    solution.report.warnings
                );
            }
        }
        println!("{:?} {:?}", case["p_axis"], case["approach"]);
    }
    let _ = Warning::FreeEnd;
    Ok(())
}
