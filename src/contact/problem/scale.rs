//! The local displacement of a contact, to which residual and overlap are compared.
//!
//! On a substrate that is much softer than its coat, the coat sinks in as a whole. This part of the
//! displacement does not change over the contact, and says nothing about how well the surfaces fit. The
//! local displacement is of the size of the part that does: of contacts of radius a with mean pressure p,
//! it is a multiple of p a D(1/a), where D(α) = α û/p̂ is the response of both bodies together. The estimate
//! is nacre's own.

use std::f64::consts::PI;

use crate::compliance::response::Body;
use crate::model::grid::Grid;

/// Local displacements of contacts of any number of cells.
#[derive(Debug, Clone)]
pub(crate) struct LocalDisplacement {
    /// Displacement per mean pressure \[m/Pa\] of contacts of 1, 2, 4, … cells.
    per_pressure: Vec<f64>,
}

/// Multiple of p a D(1/a) that counts as the local displacement. The largest displacement of a bare body is
/// less: 1.2 p a D under a sphere, 0.8 under a punch, 4 in a line contact on a grid of 160 half-widths.
/// Under a point contact on a coat 100 times harder than the substrate, it is 8 at most.
const MULTIPLE: f64 = 10.0;

impl LocalDisplacement {
    /// Tabulates the local displacements of `bodies` on the cells of `grid`.
    pub(crate) fn new(bodies: &[&Body], grid: &Grid) -> Self {
        let response = |alpha: f64| -> f64 {
            let of = |body: &&Body| body.normal(alpha) + alpha * body.local();
            bodies.iter().map(of).sum()
        };
        let [nx, ny] = grid.shape();
        let doublings = (nx * ny).ilog2() + 1;
        // Cells of a contact may lie apart: it is as soft as the softest contact of fewer cells.
        let mut softest = 0.0_f64;
        let per_pressure = (0..=doublings).map(|k| {
            let cells = f64::from(k).exp2();
            let radius = if grid.is_line() {
                0.5 * cells * grid.spacing()[1]
            } else {
                (cells * grid.cell_area() / PI).sqrt()
            };
            softest = softest.max(MULTIPLE * radius * response(1.0 / radius));
            softest
        });
        Self { per_pressure: per_pressure.collect() }
    }

    /// Local displacement \[m\] under a pressure with this `sum` over `cells` cells; 0 without cells.
    pub(crate) fn under(&self, sum: f64, cells: f64) -> f64 {
        if cells < 1.0 {
            return 0.0;
        }
        let doublings = cells.log2();
        let below = doublings as usize;
        let at = |k: usize| self.per_pressure.get(k).or(self.per_pressure.last());
        let [near, far] = [below, below + 1].map(|k| at(k).copied().unwrap_or(0.0));
        (near + (doublings - below as f64) * (far - near)) * sum / cells
    }
}

#[cfg(test)]
mod tests {
    use super::{LocalDisplacement, MULTIPLE};
    use crate::compliance::response::Body;
    use crate::error::Result;
    use crate::model::body::{HalfSpace, Layer};
    use crate::model::grid::Grid;
    use crate::model::material::Elastic;

    /// A bare body of E* = 1 has D = 2, so that the local displacement of a disc of radius a under a force F is
    /// 20 F/πa, and that of a strip under a line load F 10 F. Between powers of two, the table is linear in
    /// ln n, which misses n by up to 6 %.
    #[test]
    fn bare_bodies() -> Result<()> {
        let body = Body::from(Elastic::new(1.0, 0.0)?);
        for (grid, line) in
            [(Grid::new([64, 32], [4.0, 1.0])?, false), (Grid::line(64, 4.0)?, true)]
        {
            let local = LocalDisplacement::new(&[&body], &grid);
            for cells in [1.0, 3.0, 16.0, 37.0] {
                let area = cells * grid.cell_area();
                let radius = (area / std::f64::consts::PI).sqrt();
                let force = 0.7 * area;
                let expected = if line {
                    MULTIPLE * force
                } else {
                    2.0 * MULTIPLE * force / (std::f64::consts::PI * radius)
                };
                let found = local.under(0.7 * cells, cells);
                assert!((found / expected - 1.0).abs() < 0.07, "{found} {expected}");
            }
            assert!(local.under(0.0, 0.0).abs() <= 0.0);
        }
        Ok(())
    }

    /// On a substrate 1e12 times softer than the coat, a contact much smaller than the thickness has the
    /// local displacement of the coat.
    #[test]
    fn the_far_displacement_is_left_out() -> Result<()> {
        let (soft, hard) = (Elastic::new(1e-12, 0.3)?, Elastic::new(1.0, 0.3)?);
        let coated = Body::from(HalfSpace::new(soft, [Layer::new(hard, 100.0)?])?);
        let grid = Grid::new([8, 8], [8.0, 8.0])?;
        let [coat, bare] =
            [&coated, &Body::from(hard)].map(|body| LocalDisplacement::new(&[body], &grid));
        let ratio = coat.under(4.0, 4.0) / bare.under(4.0, 4.0);
        assert!((ratio - 1.0).abs() < 1e-3, "{ratio}");
        Ok(())
    }
}
