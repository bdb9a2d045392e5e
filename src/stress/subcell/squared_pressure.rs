//! The square of the pressure near an edge, as a polynomial.

/// Terms of a polynomial of third degree in two variables.
pub(super) const TERMS: usize = 10;

/// The square of the pressure near a cell: a polynomial in the distances u, v from the cell's centre,
/// in cells.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct SquaredPressure(pub(super) [f64; TERMS]);

impl SquaredPressure {
    /// Value at (u, v); negative beyond the edge.
    pub(super) fn at(&self, u: f64, v: f64) -> f64 {
        let [c, cu, cv, cuu, cuv, cvv, cuuu, cuuv, cuvv, cvvv] = self.0;
        let along = cu + u * (cuu + u * cuuu);
        let across = cv + v * (cvv + v * cvvv);
        c + u * along + v * across + u * v * (cuv + u * cuuv + v * cuvv)
    }

    /// Slopes along u and v.
    pub(super) fn gradient(&self, [u, v]: [f64; 2]) -> [f64; 2] {
        let [_, cu, cv, cuu, cuv, cvv, cuuu, cuuv, cuvv, cvvv] = self.0;
        let along = cu + u * (2.0 * cuu + 3.0 * u * cuuu) + v * (cuv + 2.0 * u * cuuv + v * cuvv);
        let across = cv + v * (2.0 * cvv + 3.0 * v * cvvv) + u * (cuv + u * cuuv + 2.0 * v * cuvv);
        [along, across]
    }

    /// The polynomial plus a constant, which shifts the edge.
    pub(super) fn raised(mut self, by: f64) -> Self {
        self.0[0] += by;
        self
    }

    /// Slope towards the inside at the edge nearest to the cell's centre, and its change per length, with cells of these sides: if
    /// the slope changes evenly on the way.
    pub(super) fn slope_at_edge(&self, sides: [f64; 2]) -> [f64; 2] {
        let [value, cu, cv, cuu, cuv, cvv, ..] = self.0;
        let [su, sv] = [cu / sides[0], cv / sides[1]];
        let square = su * su + sv * sv;
        let [along, across] = [su / sides[0], sv / sides[1]];
        let bend = along * along * cuu + across * across * cvv + along * across * cuv;
        let curvature = 2.0 * bend / square;
        [(square - 2.0 * value * curvature).max(0.0).sqrt(), curvature]
    }

    /// Change from the centre to a corner of a rectangle of half sides (a, b), at the slope of the
    /// cell's centre.
    pub(super) fn variation(&self, [a, b]: [f64; 2]) -> f64 {
        self.0[1].abs() * a + self.0[2].abs() * b
    }

    /// Distance of the cell's centre from the edge in cells, positive inside, at the slope there.
    pub(super) fn offset(&self) -> f64 {
        self.at(0.0, 0.0) / self.slope()
    }

    /// Magnitude of the gradient at the cell's centre.
    pub(super) fn slope(&self) -> f64 {
        self.0[1].hypot(self.0[2])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Slopes equal differences of fourth order, which are exact for cubics.
    #[test]
    fn slopes_are_those_of_the_polynomial() {
        let polynomial =
            SquaredPressure([0.3, -1.1, 0.7, 0.45, -0.8, 0.25, 0.13, -0.21, 0.34, -0.17]);
        for [u, v] in [[0.0, 0.0], [0.4, -0.3], [-1.2, 0.8]] {
            let slope =
                |f: &dyn Fn(f64) -> f64| (8.0 * (f(0.5) - f(-0.5)) - f(1.0) + f(-1.0)) / 6.0;
            let [along, across] = polynomial.gradient([u, v]);
            assert!((along - slope(&|h| polynomial.at(u + h, v))).abs() < 1e-13);
            assert!((across - slope(&|h| polynomial.at(u, v + h))).abs() < 1e-13);
        }
    }
}
