//! One pass over several arrays at once, row by row, on the plan's threads.

use std::ops::Range;

use crate::parallel::{LEAF, Threads, each_chunk};

/// A row of the grid.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Row<'a> {
    pub(crate) number: usize,
    /// Its coordinate, in the scale of the freedoms.
    pub(crate) x: f64,
    /// Those of its cells.
    pub(crate) y: &'a [f64],
}

impl<'a> Row<'a> {
    /// What `window` has of this row, and of fields in it.
    pub(crate) fn part<const N: usize>(
        self,
        [rows, columns]: &[Range<usize>; 2],
        fields: [&'a [f64]; N],
    ) -> Option<(Self, [&'a [f64]; N])> {
        let part = |values: &'a [f64]| &values[columns.clone()];
        let y = part(self.y);
        rows.contains(&self.number)
            .then(|| (Self { y, ..self }, fields.map(part)))
    }
}

/// The rows of a grid, and the threads that go over them.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Passes<'a> {
    columns: &'a [Vec<f64>; 2],
    threads: &'a Threads,
    /// Rows that are not divided.
    leaf: usize,
    divided: bool,
}

/// Rows of the grid that one thread goes over.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Part<'a> {
    /// The number of the first.
    pub(crate) first: usize,
    x: &'a [f64],
    y: &'a [f64],
}

impl Part<'_> {
    /// From which of its own rows on, and up to which, they are of `rows`.
    pub(crate) fn within(&self, rows: &Range<usize>) -> [usize; 2] {
        [rows.start, rows.end].map(|row| row.saturating_sub(self.first).min(self.x.len()))
    }

    /// Calls `row` with each of its rows of all arrays, and joins what it returns.
    pub(crate) fn each<const M: usize, const N: usize, const S: usize>(
        &self,
        inputs: [&[f64]; M],
        mut outputs: [&mut [f64]; N],
        join: impl Fn([f64; S], [f64; S]) -> [f64; S],
        row: impl Fn(Row, [&[f64]; M], [&mut [f64]; N]) -> [f64; S],
    ) -> [f64; S] {
        let ny = self.y.len();
        let mut sums = [0.0; S];
        for (k, &x) in self.x.iter().enumerate() {
            let cells = k * ny..(k + 1) * ny;
            let here = Row {
                number: self.first + k,
                x,
                y: self.y,
            };
            let from = inputs.map(|input| &input[cells.clone()]);
            let to = outputs.each_mut().map(|output| &mut output[cells.clone()]);
            sums = join(sums, row(here, from, to));
        }
        sums
    }
}

/// What a pass writes: some rows of it, of `ny` cells.
pub(crate) trait Written: Send + Sized {
    /// The first so many, and the others.
    fn split(self, rows: usize, ny: usize) -> (Self, Self);
}

/// Fields.
impl<const N: usize> Written for [&mut [f64]; N] {
    fn split(self, rows: usize, ny: usize) -> (Self, Self) {
        let mut parts = self.map(|field| {
            let (near, far) = field.split_at_mut(rows * ny);
            [near, far]
        });
        let near = parts.each_mut().map(|[near, _]| std::mem::take(near));
        (near, parts.map(|[_, far]| far))
    }
}

/// a + b
pub(crate) fn add<const S: usize>(a: [f64; S], b: [f64; S]) -> [f64; S] {
    std::array::from_fn(|k| a[k] + b[k])
}

impl<'a> Passes<'a> {
    pub(crate) fn new(columns: &'a [Vec<f64>; 2], threads: &'a Threads) -> Self {
        let [nx, ny] = [columns[0].len(), columns[1].len()];
        let leaf = (LEAF / ny.max(1)).max(1);
        Self {
            columns,
            threads,
            leaf,
            divided: threads.divide(nx * ny),
        }
    }

    /// Cells in all.
    pub(crate) fn cells(&self) -> usize {
        self.columns[0].len() * self.columns[1].len()
    }

    /// Makes of each array as many zeros as there are cells, of several at once: to be handed memory by
    /// the system takes longer than to write it.
    pub(crate) fn zero(&self, arrays: &mut [&mut Vec<f64>]) {
        let zero = |array: &mut &mut Vec<f64>| {
            array.clear();
            array.resize(self.cells(), 0.0);
        };
        if self.divided {
            self.threads
                .run(|| each_chunk(arrays, 1, 0, &|_, arrays| arrays.iter_mut().for_each(zero)));
        } else {
            arrays.iter_mut().for_each(zero);
        }
    }

    /// Calls both, at once where that pays and this is one of the threads.
    pub(crate) fn both<A: Send, B: Send>(
        &self,
        first: impl FnOnce() -> A + Send,
        second: impl FnOnce() -> B + Send,
    ) -> (A, B) {
        if self.divided {
            self.threads.both(first, second)
        } else {
            (first(), second())
        }
    }

    /// Calls `row` with each row of all arrays, and joins what it returns, in an order that does not
    /// depend on the number of threads.
    pub(crate) fn each<const M: usize, const N: usize, const S: usize>(
        &self,
        inputs: [&[f64]; M],
        outputs: [&mut [f64]; N],
        join: impl Fn([f64; S], [f64; S]) -> [f64; S] + Sync,
        row: impl Fn(Row, [&[f64]; M], [&mut [f64]; N]) -> [f64; S] + Sync,
    ) -> [f64; S] {
        self.parts(inputs, outputs, &join, |part, inputs, outputs| {
            part.each(inputs, outputs, &join, &row)
        })
    }

    /// The same with all rows of a part at once: what is done with them beside finds them in the caches.
    pub(crate) fn parts<const M: usize, W: Written, const S: usize>(
        &self,
        inputs: [&[f64]; M],
        outputs: W,
        join: impl Fn([f64; S], [f64; S]) -> [f64; S] + Sync,
        part: impl Fn(Part, [&[f64]; M], W) -> [f64; S] + Sync,
    ) -> [f64; S] {
        let rows = 0..self.columns[0].len();
        if self.divided {
            self.threads
                .run(|| self.divide(rows, inputs, outputs, &join, &part))
        } else {
            self.divide(rows, inputs, outputs, &join, &part)
        }
    }

    fn divide<const M: usize, W: Written, const S: usize>(
        &self,
        rows: Range<usize>,
        inputs: [&[f64]; M],
        outputs: W,
        join: &(impl Fn([f64; S], [f64; S]) -> [f64; S] + Sync),
        part: &(impl Fn(Part, [&[f64]; M], W) -> [f64; S] + Sync),
    ) -> [f64; S] {
        let [x, y] = self.columns;
        if rows.len() <= self.leaf {
            let here = Part {
                first: rows.start,
                x: &x[rows],
                y,
            };
            return part(here, inputs, outputs);
        }
        let first = rows.len().div_ceil(2).next_multiple_of(self.leaf);
        let middle = rows.start + first;
        let near = inputs.map(|input| &input[..first * y.len()]);
        let far = inputs.map(|input| &input[first * y.len()..]);
        let (here, there) = outputs.split(first, y.len());
        let (a, b) = self.both(
            || self.divide(rows.start..middle, near, here, join, part),
            || self.divide(middle..rows.end, far, there, join, part),
        );
        join(a, b)
    }
}

#[cfg(test)]
mod tests {
    use super::{Passes, add};
    use crate::error::Result;
    use crate::parallel::Threads;
    use crate::parallel::{all, update};

    /// On any number of threads each cell is seen once, and sums are the same to the bit.
    #[test]
    fn threads_change_nothing() -> Result<()> {
        for [nx, ny] in [[1, 7], [3, 40_000], [331, 257], [700, 100]] {
            let line = |n: usize| (0..n).map(|k| (k as f64 + 0.3).sin()).collect::<Vec<f64>>();
            let columns = [line(nx), line(ny)];
            let values = line(nx * ny);
            let mut bits = Vec::new();
            for threads in [1, 2, 5] {
                let threads = Threads::new(Some(threads))?;
                let passes = Passes::new(&columns, &threads);
                let mut out = vec![0.0; nx * ny];
                let sums = passes.each([&values], [&mut out], add, |row, [v], [out]| {
                    update([v, row.y], [out], |[v, y], [old]| {
                        ([old + v * all(row.x)], [v * all(row.x) * y])
                    })
                });
                for (k, (out, v)) in out.iter().zip(&values).enumerate() {
                    assert_eq!(out.to_bits(), (0.0 + v * columns[0][k / ny]).to_bits());
                }
                let terms: Vec<f64> = (0..nx * ny)
                    .map(|k| values[k] * columns[0][k / ny] * columns[1][k % ny])
                    .collect();
                let direct: f64 = terms.iter().sum();
                let size: f64 = terms.iter().map(|term| term.abs()).sum();
                // Higham, Accuracy and Stability of Numerical Algorithms (2002), eq. (4.4).
                assert!((sums[0] - direct).abs() < f64::EPSILON * (nx * ny) as f64 * size);
                bits.push(sums[0].to_bits());
            }
            assert!(bits.iter().all(|b| *b == bits[0]));
        }
        Ok(())
    }
}
