//! Roots of functions of one variable.

use crate::error::Result;

/// Steps at most; bisection alone needs some 60.
const STEPS: usize = 200;

/// The root of `f` between `low` and `high`, where its signs differ, to rounding: `f` gives its value and its slope. Newton's
/// step where it stays inside the bracket and halves it in the long run, else bisection (Press et al., Numerical Recipes,
/// 3rd ed., §9.4).
///
/// # Errors
/// Errors of `f`.
pub(crate) fn newton(
    mut f: impl FnMut(f64) -> Result<[f64; 2]>,
    [mut low, mut high]: [f64; 2],
    start: f64,
) -> Result<f64> {
    let rising = f(high)?[0] >= 0.0;
    let mut x = start.clamp(low.min(high), low.max(high));
    let mut step = (high - low).abs();
    for _ in 0..STEPS {
        let [value, slope] = f(x)?;
        if value.abs() <= 0.0 {
            return Ok(x);
        }
        match (value > 0.0) == rising {
            true => high = x,
            false => low = x,
        }
        let next = x - value / slope;
        let inside = next.is_finite() && (next - low) * (next - high) < 0.0;
        let last = step;
        let next = match inside && (next - x).abs() <= 0.7 * last {
            true => next,
            false => 0.5 * (low + high),
        };
        step = (next - x).abs();
        if step <= 2.0 * f64::EPSILON * x.abs().max(next.abs()).max(1.0) {
            return Ok(next);
        }
        x = next;
    }
    Ok(x)
}

/// The root of `f` between `low` and `high`, to rounding, without slopes; `None` where its signs do not differ there.
/// Chandrupatla, Adv. Eng. Softw. 28 (1997) 145, doi:10.1016/S0965-9978(96)00051-8.
///
/// # Errors
/// Errors of `f`.
pub(crate) fn bracketed(
    mut f: impl FnMut(f64) -> Result<f64>,
    [low, high]: [f64; 2],
) -> Result<Option<f64>> {
    let (mut b, mut a) = (low, high);
    let (mut fb, mut fa) = (f(b)?, f(a)?);
    if fa * fb > 0.0 || fa.is_nan() || fb.is_nan() {
        return Ok(None);
    }
    let mut t = 0.5;
    let (mut c, mut fc);
    for _ in 0..STEPS {
        let x = a + t * (b - a);
        let fx = f(x)?;
        // The bracket is x and the end of the other sign; c is the end that is left out.
        if (fx > 0.0) == (fa > 0.0) {
            (c, fc) = (a, fa);
        } else {
            (c, fc) = (b, fb);
            (b, fb) = (a, fa);
        }
        (a, fa) = (x, fx);
        let best = if fa.abs() < fb.abs() { a } else { b };
        let tolerance = 2.0 * f64::EPSILON * best.abs().max(1.0) / (b - a).abs();
        if tolerance > 0.5 || fa.abs() <= 0.0 || fb.abs() <= 0.0 {
            return Ok(Some(best));
        }
        let (xi, phi) = ((a - b) / (c - b), (fa - fb) / (fc - fb));
        let inverse = phi * phi < xi && (1.0 - phi) * (1.0 - phi) < 1.0 - xi;
        t = match inverse {
            true => {
                fa / (fb - fa) * fc / (fb - fc)
                    + (c - a) / (b - a) * fa / (fc - fa) * fb / (fc - fb)
            }
            false => 0.5,
        };
        t = t.clamp(tolerance, 1.0 - tolerance);
    }
    Ok(Some(a))
}

#[cfg(test)]
mod tests {
    use super::{bracketed, newton};

    /// Both find roots of steep, flat and kinked functions to rounding.
    #[test]
    fn roots_to_rounding() {
        for root in [0.3_f64, 1.7, 2.9] {
            let cube = |x: f64| Ok([x.powi(3) - root.powi(3), 3.0 * x * x]);
            let zero = newton(cube, [0.1, 3.0], 2.0).expect("a root");
            assert!((zero - root).abs() < 1e-14, "{zero} {root}");
            let zero = bracketed(|x| Ok((x - root).cbrt()), [0.0, 3.0]).expect("no error");
            let zero = zero.expect("a root");
            assert!((zero - root).abs() < 1e-13, "{zero} {root}");
            let falling = |x: f64| Ok(root.exp() - x.exp());
            let zero = bracketed(falling, [-4.0, 3.0]).expect("no error");
            let zero = zero.expect("a root");
            assert!((zero - root).abs() < 1e-13, "{zero} {root}");
        }
        assert_eq!(bracketed(|x| Ok(x + 1.0), [0.0, 3.0]).expect("no error"), None);
    }
}
