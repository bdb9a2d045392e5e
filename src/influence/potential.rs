//! The potential of a uniformly loaded rectangle.

use crate::kernel::quadrature::Rules;

/// Rectangles dx × dy, at any offset and depth.
#[derive(Debug)]
pub(super) struct Rectangle {
    dx: f64,
    dy: f64,
    rules: Rules,
}

impl Rectangle {
    pub(super) fn new([dx, dy]: [f64; 2]) -> Self {
        Self {
            dx,
            dy,
            rules: Rules::new(),
        }
    }

    /// ∬ 1/√(r² + d²) over the rectangle, seen from (x, y) relative to its centre.
    ///
    /// Near the rectangle by the sum over its corners of
    ///
    /// ```text
    /// F(x, y) = x asinh(y/√(x²+d²)) + y asinh(x/√(y²+d²)) − d atan(xy/(d√(x²+y²+d²)))
    /// ```
    ///
    /// (Love, Phil. Trans. R. Soc. A 228 (1929) 377, for d = 0). Farther off, where that sum
    /// cancels, by Gauss quadrature over the shorter side, or over both.
    pub(super) fn potential(&self, x: f64, y: f64, d: f64) -> f64 {
        // Long side along x.
        let (x, y, a, b) = if self.dx >= self.dy {
            (x.abs(), y.abs(), 0.5 * self.dx, 0.5 * self.dy)
        } else {
            (y.abs(), x.abs(), 0.5 * self.dy, 0.5 * self.dx)
        };
        let distance = (x - a).max(0.0).hypot((y - b).max(0.0)).hypot(d);
        let d2 = d * d;
        let Some(across) = self.rules.at(distance / b) else {
            return corner(x + a, y + b, d) - corner(x - a, y + b, d) - corner(x + a, y - b, d)
                + corner(x - a, y - b, d);
        };
        match self.rules.at(distance / a) {
            Some(along) => across.around(y, b, |y| {
                let s2 = y * y + d2;
                along.around(x, a, |x| 1.0 / (x * x + s2).sqrt())
            }),
            None => across.around(y, b, |y| segment(x - a, x + a, y * y + d2)),
        }
    }
}

/// ∫ dx/√(x² + s²) = 2 atanh(ℓ/(r1 + r2)), which does not cancel.
fn segment(x1: f64, x2: f64, s2: f64) -> f64 {
    let (r1, r2) = ((x1 * x1 + s2).sqrt(), (x2 * x2 + s2).sqrt());
    2.0 * ((x2 - x1) / (r1 + r2)).atanh()
}

fn corner(x: f64, y: f64, d: f64) -> f64 {
    if d > 0.0 {
        let image = d * (x * y / (d * x.hypot(y).hypot(d))).atan();
        x * (y / x.hypot(d)).asinh() + y * (x / y.hypot(d)).asinh() - image
    } else {
        let term = |x: f64, y: f64| {
            if x == 0.0 {
                0.0
            } else {
                x * (y / x.abs()).asinh()
            }
        };
        term(x, y) + term(y, x)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Both evaluations where each is good: 2 to 30 half-sides off the closed form loses at most
    /// (r/b)² = 1e3 of its 1e-16.
    #[test]
    fn quadrature_continues_the_closed_form() {
        for (dx, dy) in [(1.0, 1.0), (1.0, 0.3), (0.02, 1.0), (1.0, 1e-3)] {
            let cell = Rectangle::new([dx, dy]);
            let (a, b) = (0.5 * dx, 0.5 * dy);
            for d in [0.0, 0.4, 3.0] {
                for (i, j) in [
                    (1.3, 0.0),
                    (0.0, 1.4),
                    (1.2, 1.2),
                    (1.6, 0.4),
                    (3.0, 4.0),
                    (0.2, 9.0),
                ] {
                    let (x, y) = (i * dx, j * dy);
                    let closed =
                        corner(x + a, y + b, d) - corner(x - a, y + b, d) - corner(x + a, y - b, d)
                            + corner(x - a, y - b, d);
                    let value = cell.potential(x, y, d);
                    let lost = 1e3_f64.max(d * d / (dx * dy)).max(dx / dy);
                    assert!(
                        (value / closed - 1.0).abs() < 1e-14 * lost,
                        "{dx} {dy} {d} {i} {j}: {value} {closed}"
                    );
                }
            }
        }
    }

    #[test]
    fn far_potential_is_that_of_a_point() {
        let cell = Rectangle::new([1.0, 2.0]);
        // Quadrupole: 1/24 [dx² (3x²/r² − 1) + dy² (3y²/r² − 1)]/r²
        let (x, y): (f64, f64) = (3e3, 4e3);
        let quadrupole = ((3.0 * 0.36 - 1.0) + 4.0 * (3.0 * 0.64 - 1.0)) / 24.0 / 25e6;
        let value = cell.potential(x, y, 0.0);
        assert!((value / (2.0 / 5e3) / (1.0 + quadrupole) - 1.0).abs() < 1e-14);
    }
}
