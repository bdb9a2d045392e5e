//! Whole curves of load over approach with their derivatives, by interpolation in the contact radius. The interpolation is
//! derived here; it is not published elsewhere.

use std::f64::consts::PI;
use std::sync::Arc;

use super::adhesion::{Adhesion, Control};
use super::derivatives::{Held, Variable};
use super::equation::stack::IndentParameter;
use super::indenter::Indent;
use super::point::{IndentWarning, Point};
use crate::error::{Error, Result, finite};
use crate::numerics::roots::newton;
use crate::numerics::special::barycentric;

/// Last Chebyshev coefficients of the logarithms at which a table counts as resolved.
const RESOLVED: f64 = 1e-9;

/// Intervals of a table to begin with; they are doubled.
const FIRST: usize = 12;

/// Intervals at most; where these do not suffice, each point of the curve is solved for.
const MOST: usize = 96;

/// Approach, of the largest on the curve, below which points are solved for.
const SHALLOW: f64 = 1e-3;

/// Points of a curve at most that are solved for instead.
const FEW: usize = 6;

/// Load over approach. Where nothing touches, all but the approach is 0.
#[derive(Debug, Clone, PartialEq, Default)]
#[non_exhaustive]
pub struct Curve {
    /// Loads \[N\].
    pub load: Vec<f64>,
    /// Contact radii \[m\].
    pub radius: Vec<f64>,
    /// dP/dδ along the curve \[N/m\].
    pub slope: Vec<f64>,
    /// Derivatives of each load with respect to each parameter, at its approach.
    pub derivatives: Vec<Vec<f64>>,
    /// What makes its deepest point doubtful; empty as a rule.
    pub warnings: Vec<IndentWarning>,
}

/// What is tabulated at a radius: the logarithms of S, P_F, δ_H, and for adhesion within the contact δ_H − δ, each with its
/// slope over ln a; then the derivatives of all S, P_F, δ_H and δ_H − δ with respect to each parameter, relative to them.
type CurveRow = Vec<f64>;

/// A table on a range of radii, which does not pass a kink of the tip.
#[derive(Debug)]
struct CurveTable {
    low: f64,
    high: f64,
    /// Whether there are roots of the distance from the lower end: nodes are the squares of Chebyshev's then.
    has_root: bool,
    /// Rows at Chebyshev's points cos(πk/n).
    rows: Vec<CurveRow>,
}

impl CurveTable {
    /// ln a at the position from −1 to 1.
    fn place(&self, position: f64) -> f64 {
        let fraction = 0.5 * (1.0 + position);
        let fraction = if self.has_root { fraction * fraction } else { fraction };
        self.low + (self.high - self.low) * fraction
    }

    /// The table of `row` from ln a = `low` to `high`; none where it is not resolved.
    fn new(
        [low, high]: [f64; 2],
        has_root: bool,
        logs: usize,
        row: impl Fn(f64) -> Result<CurveRow>,
    ) -> Result<Option<Self>> {
        let mut table = Self { low, high, has_root, rows: Vec::new() };
        for k in 0..=FIRST {
            table.rows.push(row(table.place(chebyshev(k, FIRST)))?);
        }
        loop {
            if (0..logs).all(|column| table.tail(2 * column) < RESOLVED) {
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
    fn weights(&self, log: f64) -> Vec<f64> {
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

    fn column(&self, weights: &[f64], column: usize) -> f64 {
        weights.iter().zip(&self.rows).map(|(w, row)| w * row[column]).sum()
    }
}

/// Chebyshev's point k of 0 … n, from 1 down to −1.
fn chebyshev(k: usize, n: usize) -> f64 {
    (PI * k as f64 / n as f64).cos()
}

/// One point of a curve: load, radius, slope, derivatives.
type CurvePoint = (f64, f64, f64, Vec<f64>);

impl Indent {
    /// Load at each of the approaches \[m\], with its derivative with respect to each of `parameters`. A table of the radius serves
    /// all points, with an error of 1e-9.
    ///
    /// # Errors
    /// As [`Indent::at_approach`] for the largest approach, approaches that are not finite, and the adhesion of Maugis and Dugdale.
    pub fn curve(&self, approaches: &[f64], parameters: &[IndentParameter]) -> Result<Curve> {
        if matches!(self.adhesion(), Adhesion::Maugis { .. }) {
            return Err(Error::Adhesion(
                "curves of the adhesion of Maugis and Dugdale are not tabulated: take states by radius",
            ));
        }
        for approach in approaches {
            finite("approach", *approach)?;
        }
        let is_adhering = self.adheres_within();
        let least = match is_adhering {
            true => self.pull_off(Control::Approach)?.approach,
            // Smaller contacts than those that are computed carry nothing that is seen beside the others.
            false => match self.tip().range()[0] > 0.0 {
                true => 0.0,
                false => self.tip().transform(self.range()[0])[0] * (1.0 + 1e-6),
            },
        };
        let touches = |approach: f64| match is_adhering {
            true => approach >= least,
            false => approach > least,
        };
        let most = approaches.iter().fold(f64::NEG_INFINITY, |m, a| m.max(*a));
        let nothing: CurvePoint = (0.0, 0.0, 0.0, vec![0.0; parameters.len()]);
        let mut entries = vec![nothing; approaches.len()];
        let is_shallow = |approach: f64| !is_adhering && approach < SHALLOW * most;
        let deep: Vec<f64> =
            approaches.iter().copied().filter(|a| touches(*a) && !is_shallow(*a)).collect();
        let tables = match deep.len() > FEW && self.tip().fixed_radius().is_none() {
            true => self.tables(&deep, parameters)?,
            false => None,
        };
        for (entry, approach) in entries.iter_mut().zip(approaches) {
            if !touches(*approach) {
                continue;
            }
            *entry = match &tables {
                Some(tables) if !is_shallow(*approach) => {
                    self.interpolated(tables, *approach, parameters)?
                }
                _ => self.solved(*approach, parameters)?,
            };
        }
        let mut curve = Curve::default();
        for (load, radius, slope, derivatives) in entries {
            curve.load.push(load);
            curve.radius.push(radius);
            curve.slope.push(slope);
            curve.derivatives.push(derivatives);
        }
        let widest = curve.radius.iter().fold(0.0_f64, |most, a| most.max(*a));
        if widest > 0.0 {
            curve.warnings = IndentWarning::of(self.tip(), widest, most);
        }
        Ok(curve)
    }

    /// Whether adhesion acts within the contact.
    fn adheres_within(&self) -> bool {
        matches!(self.adhesion(), Adhesion::Jkr { .. })
    }

    /// A point that is solved for.
    fn solved(&self, approach: f64, parameters: &[IndentParameter]) -> Result<CurvePoint> {
        let point = self.at_approach(approach)?;
        let rate = |parameter: &IndentParameter| {
            let variable = Variable::Parameter(*parameter);
            Ok(point.derivative(variable, Held::Approach)?.load)
        };
        let rates: Vec<f64> = parameters.iter().map(rate).collect::<Result<_>>()?;
        let slope = match self.tip().fixed_radius() {
            Some(_) => point.stiffness,
            None => {
                let [approach, load] = point.along();
                load / approach
            }
        };
        Ok((point.load, point.radius, slope, rates))
    }

    /// Tables for approaches in ascending radius; none where they are not resolved.
    fn tables(
        &self,
        approaches: &[f64],
        parameters: &[IndentParameter],
    ) -> Result<Option<Vec<CurveTable>>> {
        let is_adhering = self.adheres_within();
        let low = approaches.iter().copied().fold(f64::INFINITY, f64::min);
        let high = approaches.iter().copied().fold(0.0, f64::max);
        let low = match is_adhering {
            true => self.pull_off(Control::Approach)?.radius,
            false => self.at_approach(low)?.radius,
        };
        let high = self.at_approach(high)?.radius;
        let mut ends = vec![low.ln() - 1e-9];
        let mut roots = vec![false];
        for kink in &self.tip().kinks {
            if *kink > low && *kink < high {
                ends.push(kink.ln());
                roots.push(true);
            } else if *kink <= low && (low / kink).ln() < 0.2 && ends.len() == 1 {
                // The root is near.
                ends[0] = kink.ln().max(self.tip().range()[0].ln() + 1e-9);
                roots[0] = true;
            }
        }
        ends.push(high.ln() + 1e-9);
        let mut tables = Vec::new();
        for (pair, has_root) in ends.windows(2).zip(roots) {
            let row = |log: f64| self.row(log.exp(), parameters);
            let logs = if is_adhering { 4 } else { 3 };
            match CurveTable::new([pair[0], pair[1]], has_root, logs, row) {
                Ok(Some(table)) => tables.push(table),
                // A contact of the table is no disc: each approach is then solved for, and has its own contact or error.
                Ok(None) | Err(Error::Ring | Error::Inconsistent(_)) => return Ok(None),
                Err(error) => return Err(error),
            }
        }
        Ok(Some(tables))
    }

    /// CurveRow of a table at the radius `a`: per quantity its logarithm, the derivative of that with respect to ln a, and one with respect
    /// to each parameter.
    fn row(&self, a: f64, parameters: &[IndentParameter]) -> Result<CurveRow> {
        let bare = Self::new(self.stack(), self.tip());
        let point = bare.state(a)?;
        let is_adhering = self.adheres_within();
        if !is_adhering {
            point.check_disc()?;
        }
        let profile = point.stiffness * point.approach - point.load;
        let [widening, _] = point.along();
        let own = |parameter: &IndentParameter| -> Result<[f64; 3]> {
            if *parameter == IndentParameter::Work {
                return Ok([0.0; 3]);
            }
            let change = point.derivative(Variable::Parameter(*parameter), Held::Radius)?;
            let of_profile =
                change.stiffness * point.approach + point.stiffness * change.approach - change.load;
            Ok([
                change.stiffness / point.stiffness,
                of_profile / profile,
                change.approach / point.approach,
            ])
        };
        let rates: Vec<[f64; 3]> = parameters.iter().map(own).collect::<Result<_>>()?;
        let slope = point.stiffness_slope * a;
        let values = [
            (point.stiffness, slope / point.stiffness),
            (profile, slope * point.approach / profile),
            (point.approach, widening * a / point.approach),
        ];
        let mut row = Vec::with_capacity(4 * (2 + parameters.len()));
        let mut logs = Vec::new();
        for (k, (value, slope)) in values.into_iter().enumerate() {
            logs.push([value.ln(), slope]);
            row.extend(rates.iter().map(|rates| rates[k]));
        }
        if is_adhering {
            let parts = Arc::clone(&point.parts);
            let edge = self.adhesion().edge(self.stack().surface_modulus(), a);
            let apart = -edge / parts.edge[0];
            let adhering = Point::new(parts, self.adhesion(), point.approach - apart);
            adhering.check_disc()?;
            let [along, _] = adhering.along();
            logs.push([apart.ln(), (widening - along) * a / apart]);
            for (parameter, rates) in parameters.iter().zip(&rates) {
                let variable = Variable::Parameter(*parameter);
                let change = adhering.derivative(variable, Held::Radius)?;
                row.push((rates[2] * point.approach - change.approach) / apart);
            }
        }
        let mut ordered: CurveRow = logs.into_flattened();
        ordered.extend(row);
        Ok(ordered)
    }

    /// A point from the tables.
    fn interpolated(
        &self,
        tables: &[CurveTable],
        approach: f64,
        parameters: &[IndentParameter],
    ) -> Result<CurvePoint> {
        let is_adhering = self.adheres_within();
        let logs = if is_adhering { 4 } else { 3 };
        let table_at = |log: f64| {
            let table = tables.iter().find(|table| log <= table.high);
            table.unwrap_or(&tables[tables.len() - 1])
        };
        let at = |log: f64| -> [f64; 2] {
            let table = table_at(log);
            let weights = table.weights(log);
            let column = |k| table.column(&weights, k);
            let (value, slope) = (column(4).exp(), column(5));
            let mut imbalance = [value - approach, value * slope];
            if is_adhering {
                let (apart, slope) = (column(6).exp(), column(7));
                imbalance[0] -= apart;
                imbalance[1] -= apart * slope;
            }
            imbalance
        };
        let (low, high) = (tables[0].low, tables[tables.len() - 1].high);
        let log = newton(|log| Ok(at(log)), [low, high], high)?;
        let (table, a) = (table_at(log), log.exp());
        let weights = table.weights(log);
        let column = |k| table.column(&weights, k);
        let [stiffness, profile, hertzian] = [0, 2, 4].map(|k| column(k).exp());
        let load = stiffness * approach - profile;
        let outside = self.adhesion().outside(self.tip());
        // P' = S δ' − S' (δ_H − δ) along the curve, per ln a.
        let widening = hertzian * column(5);
        let (mut along, mut load_slope) = (widening, stiffness * widening);
        let mut apart = 0.0;
        if is_adhering {
            apart = column(6).exp();
            along -= apart * column(7);
            load_slope = stiffness * along - stiffness * column(1) * apart;
        }
        let count = parameters.len();
        let rate = |quantity: usize, k: usize| column(2 * logs + quantity * count + k);
        let rates = parameters.iter().enumerate().map(|(k, parameter)| {
            let of_stiffness = stiffness * rate(0, k);
            let of_profile = profile * rate(1, k);
            let mut of_approach = hertzian * rate(2, k);
            if is_adhering {
                of_approach -= apart * rate(3, k);
            }
            // At fixed radius δ changes; the radius then moves so that it does not.
            let at_radius = of_stiffness * approach + stiffness * of_approach - of_profile;
            at_radius
                - load_slope / along * of_approach
                - self.adhesion().outside_rate(self.tip(), *parameter)
        });
        Ok((load - outside, a, load_slope / along, rates.collect()))
    }
}
