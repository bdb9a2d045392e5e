//! Tables over the logarithm of the contact radius. The interpolation is derived here; it is not published elsewhere.

use std::f64::consts::PI;

use super::adhesion::Control;
use crate::error::Result;
use crate::numerics::special::barycentric;

/// Intervals of a table to begin with; they are doubled.
const FIRST: usize = 12;

/// Intervals at most; where these do not suffice, each point of the curve is solved for.
const MOST: usize = 96;

/// What is tabulated at a radius.
pub(super) type CurveRow = Vec<f64>;

/// Bounds of ln a, and whether there are roots of the distance from the lower one.
pub(super) type CurvePiece = ([f64; 2], bool);

/// A table on a range of radii, which does not pass a kink of the tip.
#[derive(Debug)]
pub(super) struct CurveTable {
    pub(super) low: f64,
    pub(super) high: f64,
    /// Whether there are roots of the distance from the lower end: nodes are the squares of Chebyshev's then.
    has_root: bool,
    /// Rows at Chebyshev's points cos(πk/n).
    pub(super) rows: Vec<CurveRow>,
}

impl CurveTable {
    /// ln a at the position from −1 to 1.
    fn place(&self, position: f64) -> f64 {
        let fraction = 0.5 * (1.0 + position);
        let fraction = if self.has_root { fraction * fraction } else { fraction };
        self.low + (self.high - self.low) * fraction
    }

    /// The table of `row` from ln a = `low` to `high`; none where the columns that are `checked` do not count as `resolved`.
    pub(super) fn new(
        ([low, high], has_root): CurvePiece,
        (checked, resolved): (&[usize], f64),
        mut row: impl FnMut(f64) -> Result<CurveRow>,
    ) -> Result<Option<Self>> {
        let mut table = Self { low, high, has_root, rows: Vec::new() };
        for k in 0..=FIRST {
            table.rows.push(row(table.place(chebyshev(k, FIRST)))?);
        }
        loop {
            if checked.iter().all(|column| table.tail(*column) < resolved) {
                return Ok(Some(table));
            }
            let n = 2 * (table.rows.len() - 1);
            if n > MOST {
                return Ok(None);
            }
            let mut rows = Vec::with_capacity(n + 1);
            for (k, old) in std::mem::take(&mut table.rows).into_iter().enumerate() {
                if k > 0 {
                    rows.push(row(table.place(chebyshev(2 * k - 1, n)))?);
                }
                rows.push(old);
            }
            table.rows = rows;
        }
    }

    /// Size of the last three Chebyshev coefficients of a column.
    fn tail(&self, column: usize) -> f64 {
        let n = self.rows.len() - 1;
        let coefficient = |j: usize| {
            let term = |(k, row): (usize, &CurveRow)| {
                let end = if k == 0 || k == n { 0.5 } else { 1.0 };
                end * row[column] * (PI * (j * k) as f64 / n as f64).cos()
            };
            2.0 / n as f64 * self.rows.iter().enumerate().map(term).sum::<f64>()
        };
        (n - 2..=n).map(|j| coefficient(j).abs()).fold(0.0, f64::max)
    }

    /// Barycentric weights of the rows at ln a, normed.
    pub(super) fn weights(&self, log: f64) -> Vec<f64> {
        let fraction = ((log - self.low) / (self.high - self.low)).clamp(0.0, 1.0);
        let fraction = if self.has_root { fraction.sqrt() } else { fraction };
        let n = self.rows.len() - 1;
        let node = |k: usize| {
            let end = if k == 0 || k == n { 0.5 } else { 1.0 };
            let sign = if k.is_multiple_of(2) { 1.0 } else { -1.0 };
            [chebyshev(k, n), sign * end]
        };
        let nodes: Vec<[f64; 2]> = (0..=n).map(node).collect();
        barycentric(&nodes, 2.0 * fraction - 1.0)
    }

    pub(super) fn column(&self, weights: &[f64], column: usize) -> f64 {
        weights.iter().zip(&self.rows).map(|(w, row)| w * row[column]).sum()
    }
}

/// The table that holds ln a, of those in ascending radius.
pub(super) fn table_at(tables: &[CurveTable], log: f64) -> &CurveTable {
    let table = tables.iter().find(|table| log <= table.high);
    table.unwrap_or(&tables[tables.len() - 1])
}

/// Chebyshev's point k of 0 … n, from 1 down to −1.
fn chebyshev(k: usize, n: usize) -> f64 {
    (PI * k as f64 / n as f64).cos()
}

/// Load or approach, and the width of the cohesive zone, over the contact radius.
#[derive(Debug)]
pub(super) struct ValueTable {
    pub(super) control: Control,
    /// Size of the value at pull-off.
    pub(super) unit: f64,
    /// Rows of arsinh (value/unit), whose error is that of the value in its own size or that of pull-off, and of ln (c − a).
    pub(super) tables: Vec<CurveTable>,
}
