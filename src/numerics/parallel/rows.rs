//! Passes over several arrays at once, row by row, on a plan's threads.
//!
//! Blocks of rows are divided among threads by halves; what they return is joined in an order that does
//! not depend on the number of threads.

use std::ops::Range;

use super::{LEAF, Threads};

/// Result of a pass: its parts are joined in a fixed order.
pub(crate) trait Total: Send {
    /// The result for no cells.
    const ZERO: Self;

    /// The result for the cells of both.
    fn joined(self, other: Self) -> Self;
}

impl Total for () {
    const ZERO: Self = ();

    fn joined(self, (): Self) -> Self {}
}

impl Total for f64 {
    const ZERO: Self = 0.0;

    fn joined(self, other: Self) -> Self {
        self + other
    }
}

impl<T: Total, const N: usize> Total for [T; N] {
    const ZERO: Self = [T::ZERO; N];

    fn joined(self, other: Self) -> Self {
        let mut others = other.into_iter();
        self.map(|value| match others.next() {
            Some(other) => value.joined(other),
            None => value,
        })
    }
}

impl<A: Total, B: Total> Total for (A, B) {
    const ZERO: Self = (A::ZERO, B::ZERO);

    fn joined(self, other: Self) -> Self {
        (self.0.joined(other.0), self.1.joined(other.1))
    }
}

/// One row of a grid.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Row<'a> {
    /// Number of the row in the grid.
    pub(crate) number: usize,
    /// Coordinate of the row.
    pub(crate) x: f64,
    /// Coordinates of its cells.
    pub(crate) y: &'a [f64],
}

impl<'a> Row<'a> {
    /// The cells of this row, and of `fields` along it, that lie in `window`; `None` outside its rows.
    pub(crate) fn within<const N: usize>(
        self,
        [rows, columns]: &[Range<usize>; 2],
        fields: [&'a [f64]; N],
    ) -> Option<(Self, [&'a [f64]; N])> {
        let cells = |values: &'a [f64]| &values[columns.clone()];
        let y = cells(self.y);
        rows.contains(&self.number).then(|| (Self { y, ..self }, fields.map(cells)))
    }
}

/// The rows of a grid, and the threads that go over them.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Rows<'a> {
    coordinates: &'a [Vec<f64>; 2],
    threads: &'a Threads,
    /// Number of rows that are no longer divided.
    leaf: usize,
    /// Whether the grid is large enough for more than one thread.
    divided: bool,
}

impl<'a> Rows<'a> {
    /// The rows of a grid whose lines of cells have these `coordinates`, along x and along y.
    pub(crate) fn new(coordinates: &'a [Vec<f64>; 2], threads: &'a Threads) -> Self {
        let [nx, ny] = [coordinates[0].len(), coordinates[1].len()];
        Self {
            coordinates,
            threads,
            leaf: (LEAF / ny.max(1)).max(1),
            divided: threads.divide(nx * ny),
        }
    }

    /// Calls both; at the same time where the grid is large enough and this is one of the threads.
    pub(crate) fn both<A: Send, B: Send>(
        &self,
        first: impl FnOnce() -> A + Send,
        second: impl FnOnce() -> B + Send,
    ) -> (A, B) {
        if self.divided { self.threads.both(first, second) } else { (first(), second()) }
    }

    /// Calls `row` with each row of all arrays, and joins what it returns.
    pub(crate) fn each<const M: usize, const N: usize, T: Total>(
        &self,
        inputs: [&[f64]; M],
        outputs: [&mut [f64]; N],
        row: impl Fn(Row, [&[f64]; M], [&mut [f64]; N]) -> T + Sync,
    ) -> T {
        let rows = 0..self.coordinates[0].len();
        if self.divided {
            self.threads.run(|| self.divide(rows, inputs, outputs, &row))
        } else {
            self.divide(rows, inputs, outputs, &row)
        }
    }

    fn divide<const M: usize, const N: usize, T: Total>(
        &self,
        rows: Range<usize>,
        inputs: [&[f64]; M],
        mut outputs: [&mut [f64]; N],
        row: &(impl Fn(Row, [&[f64]; M], [&mut [f64]; N]) -> T + Sync),
    ) -> T {
        let [x, y] = self.coordinates;
        let ny = y.len();
        if rows.len() <= self.leaf {
            let mut total = T::ZERO;
            for (k, number) in rows.enumerate() {
                let cells = k * ny..(k + 1) * ny;
                let from = inputs.map(|input| &input[cells.clone()]);
                let to = outputs.each_mut().map(|output| &mut output[cells.clone()]);
                total = total.joined(row(Row { number, x: x[number], y }, from, to));
            }
            return total;
        }
        let first = rows.len().div_ceil(2).next_multiple_of(self.leaf);
        let middle = rows.start + first;
        let [near, far] = [inputs.map(|i| &i[..first * ny]), inputs.map(|i| &i[first * ny..])];
        let mut halves = outputs.map(|output| {
            let (here, there) = output.split_at_mut(first * ny);
            [here, there]
        });
        let here = halves.each_mut().map(|[here, _]| std::mem::take(here));
        let there = halves.map(|[_, there]| there);
        let (a, b) = self.both(
            || self.divide(rows.start..middle, near, here, row),
            || self.divide(middle..rows.end, far, there, row),
        );
        a.joined(b)
    }
}

#[cfg(test)]
mod tests {
    use super::Rows;
    use crate::error::Result;
    use crate::numerics::parallel::{Threads, all, update};

    /// On any number of threads each cell is seen once, and sums are the same to the bit.
    #[test]
    fn threads_change_nothing() -> Result<()> {
        for [nx, ny] in [[1, 7], [3, 40_000], [331, 257], [700, 100]] {
            let line = |n: usize| (0..n).map(|k| (k as f64 + 0.3).sin()).collect::<Vec<f64>>();
            let coordinates = [line(nx), line(ny)];
            let values = line(nx * ny);
            let mut bits = Vec::new();
            for threads in [1, 2, 5] {
                let threads = Threads::new(Some(threads))?;
                let rows = Rows::new(&coordinates, &threads);
                let mut out = vec![0.0; nx * ny];
                let [sum] = rows.each([&values], [&mut out], |row, [v], [out]| {
                    update([v, row.y], [out], |[v, y], [old]| {
                        ([old + v * all(row.x)], [v * all(row.x) * y])
                    })
                });
                for (k, (out, v)) in out.iter().zip(&values).enumerate() {
                    assert_eq!(out.to_bits(), (0.0 + v * coordinates[0][k / ny]).to_bits());
                }
                let terms: Vec<f64> = (0..nx * ny)
                    .map(|k| values[k] * coordinates[0][k / ny] * coordinates[1][k % ny])
                    .collect();
                let direct: f64 = terms.iter().sum();
                let size: f64 = terms.iter().map(|term| term.abs()).sum();
                // Higham, Accuracy and Stability of Numerical Algorithms (2002), eq. (4.4).
                assert!((sum - direct).abs() < f64::EPSILON * (nx * ny) as f64 * size);
                bits.push(sum.to_bits());
            }
            assert!(bits.iter().all(|b| *b == bits[0]));
        }
        Ok(())
    }
}
