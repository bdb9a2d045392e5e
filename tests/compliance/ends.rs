//! The quarter space: reference values, exact statements, symmetry.

use nacre::ends::QuarterSpace;
use nacre::{Elastic, Result};

use crate::support::reference::{cases, number};

/// The displacement of rectangles near an end and on it, relative to the reference, whose error is 2e-6 at most:
/// Nyström's method for each wavenumber and a cosine integral.
#[test]
fn rectangles_agree_with_the_reference() -> Result<()> {
    let (mut count, mut worst) = (0, 0.0_f64);
    for row in cases("quarter_space_rectangle.json") {
        let [d, length, half_width, x, y] =
            ["d", "length", "half_width", "x", "y"].map(|key| number(&row, key));
        for (poisson, expected) in row["u_quarter"].as_object().expect("by ν") {
            let poisson: f64 = poisson.parse().expect("a number");
            // (1 − ν²)/E = 1
            let material = Elastic::new(1.0 - poisson * poisson, poisson)?;
            let body = QuarterSpace::new(material, d, [length, half_width])?;
            let ratio = body.displacement([x, y])? / expected.as_f64().expect("a number");
            println!(
                "{d} {length} {half_width} {x} {y} {poisson}: {:e}",
                ratio - 1.0
            );
            worst = worst.max((ratio - 1.0).abs());
            count += 1;
        }
    }
    assert!(count > 50 && worst < 5e-6, "{count} {worst:e}");
    Ok(())
}
