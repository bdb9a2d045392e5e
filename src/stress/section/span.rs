//! The part of a grid below which a body with free ends has material.

use std::ops::Range;

use crate::error::{Error, Result};
use crate::model::body::HalfSpace;
use crate::model::grid::Grid;
use crate::stress::half_space::Source;

/// Rows of a grid that a body has, and its end faces.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::stress) struct Span {
    /// Rows with their centres in the body, or on a face.
    pub(in crate::stress) rows: Range<usize>,
    /// The row behind each end face that lies between two rows, or on the border of the grid.
    pub(in crate::stress) faces: [Option<usize>; 2],
    /// Where the body is, in rows: 0 is the centre of the first.
    reach: [f64; 2],
    /// Number of the grid's columns.
    columns: usize,
}

/// Distance in cells that is rounding.
const ROUNDING: f64 = 1e-6;

impl Span {
    pub(in crate::stress) fn of(body: &HalfSpace, grid: &Grid) -> Self {
        let [nx, columns] = grid.shape();
        let first = grid.x()[0];
        let at = |x: f64| (x - first) / grid.spacing()[0];
        let [low, high] = body.ends();
        let reach = [
            low.map_or(f64::NEG_INFINITY, at) - ROUNDING,
            high.map_or(f64::INFINITY, at) + ROUNDING,
        ];
        let row = |k: f64| k.clamp(0.0, nx as f64) as usize;
        let start = row(reach[0].ceil());
        let face = |end: Option<f64>| {
            let behind = at(end?) + 0.5;
            let row = behind.round();
            let is_there = (behind - row).abs() < ROUNDING && (0.0..=nx as f64).contains(&row);
            is_there.then_some(row as usize)
        };
        Self {
            rows: start..row(reach[1].floor() + 1.0).max(start),
            faces: body.ends().map(face),
            reach,
            columns,
        }
    }

    /// Whether the body is at the place `at`, in rows.
    pub(in crate::stress) fn has(&self, at: f64) -> bool {
        (self.reach[0]..=self.reach[1]).contains(&at)
    }

    /// Makes the values of a `plane` NaN where there is no body.
    pub(in crate::stress) fn blank(&self, plane: &mut [f64]) {
        let cells = self.rows.start * self.columns..self.rows.end * self.columns;
        plane[..cells.start].fill(f64::NAN);
        plane[cells.end..].fill(f64::NAN);
    }
}

impl Source<'_> {
    /// Refuses what stresses near free ends are not known for, and a pressure beyond an end.
    pub(in crate::stress) fn check_ends(&self) -> Result<()> {
        if self.body.ends() == [None; 2] {
            return Ok(());
        }
        if self.grid.is_line() || self.grid.is_periodic() != [false; 2] {
            return Err(Error::Inconsistent(
                "stresses of a body with free ends need a grid that has cells along x and is not periodic",
            ));
        }
        let Span { rows, .. } = Span::of(self.body, self.grid);
        let lines = self.pressure.rows().into_iter().enumerate();
        for (_, pressure) in lines.filter(|(i, _)| !rows.contains(i)) {
            if pressure.iter().any(|p| *p != 0.0) {
                return Err(Error::Inconsistent(
                    "pressure must be 0 beyond the free ends of the body",
                ));
            }
        }
        Ok(())
    }
}
