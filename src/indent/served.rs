//! Contacts with a cohesive zone at many loads or approaches. Each one alone takes some twenty states of other radii; a table over
//! the radius, as that of whole curves, serves them all.

use std::sync::Arc;

use super::adhesion::{Adhesion, Branch, Control};
use super::equation::Parts;
use super::indenter::Indent;
use super::point::Point;
use super::table::{CurveTable, ValueTable, table_at};
use crate::error::Result;
use crate::numerics::roots;

/// Values at most that are solved for one by one: as many contacts take as long as a table of 97 rows.
const FEW: usize = 4;

/// Last Chebyshev coefficients at which a table counts as resolved. Where coefficients fall by a factor of 1.5 or more, those that
/// are missing add up to four times the last one. A change of the logarithm of the width moves the load by that on the zone, some one
/// to two times that of pull-off. Together that leaves 1e-9.
const RESOLVED: f64 = 1e-10;

impl Indent {
    /// This tip, prepared for [`Indent::at`] at many `values` of what is given. With the adhesion of Maugis and Dugdale a table of
    /// the radius then serves those on the stable branch: they have the value to 1e-9 of the larger of it and that of pull-off.
    /// All others are solved for one by one as before.
    pub fn serving(&self, control: Control, branch: Branch, values: &[f64]) -> Self {
        let table = match branch {
            Branch::Stable => self.value_table(control, values).ok().flatten(),
            Branch::Unstable => None,
        };
        Self { table: table.map(Arc::new), ..self.clone() }
    }

    /// The table of these values; none where they are few, or where it is not resolved or does not rise.
    fn value_table(&self, control: Control, values: &[f64]) -> Result<Option<ValueTable>> {
        if !matches!(self.adhesion, Adhesion::Maugis { .. }) || values.len() <= FEW {
            return Ok(None);
        }
        let last = self.pull_off(control)?;
        let least = control.of([last.approach, last.load]);
        let touching = values.iter().copied().filter(|value| *value >= least);
        let low = touching.clone().fold(f64::INFINITY, f64::min);
        let high = touching.fold(f64::NEG_INFINITY, f64::max);
        let low = self.at(control, low, Branch::Stable)?.radius;
        let high = self.at(control, high, Branch::Stable)?.radius;
        let unit = least.abs();
        let mut start = high.ln() - 3.0;
        let mut row = |log: f64| {
            let point = self.state_from(log.exp(), &mut start)?;
            Ok(vec![(point.value(control) / unit).asinh(), start])
        };
        let mut tables = Vec::new();
        for piece in self.pieces([low, high]) {
            let Some(table) = CurveTable::new(piece, (&[0, 1], RESOLVED), &mut row)? else {
                return Ok(None);
            };
            if !table.rows.is_sorted_by(|next, row| next[0] > row[0]) {
                return Ok(None);
            }
            tables.push(table);
        }
        Ok(Some(ValueTable { control, unit, tables }))
    }

    /// The contact at a `value` from the table; none without one, and beyond its ends.
    pub(super) fn tabulated(&self, control: Control, value: f64) -> Result<Option<Point>> {
        let (Some(table), Adhesion::Maugis { work, strength }) = (&self.table, self.adhesion)
        else {
            return Ok(None);
        };
        let (tables, due) = (&table.tables, (value / table.unit).asinh());
        let column = |log: f64, k: usize| {
            let own = table_at(tables, log);
            own.column(&own.weights(log), k)
        };
        let range = [tables[0].low, tables[tables.len() - 1].high];
        let log = match table.control == control {
            true => roots::bracketed(|log| Ok(column(log, 0) - due), range)?,
            false => None,
        };
        let Some(log) = log else {
            return Ok(None);
        };
        let a = log.exp();
        let outer = a + column(log, 1).exp();
        let parts = Parts::new(&self.stack, &self.tip, a, (4.0 * a).max(2.0 * outer))?;
        Ok(Some(Point::cohesive(Arc::new(parts), outer, [work, strength])))
    }
}
