//! Convolution in three stages. The solver can compute the rows of the input within the first stage, and
//! use the rows of the output within the third, while they are in the caches.

use std::ops::Range;

use super::{Convolution, Memory, Workspace};
use crate::numerics::fft::{HalfSpectra, Scratches};
use crate::numerics::parallel::Written;

impl Convolution {
    /// First stage, row by row: a receiver of input rows, and the memory for their half spectra.
    pub(crate) fn inwards<'a>(
        &'a self,
        workspace: &'a mut Workspace,
    ) -> (Inwards<'a>, HalfSpectra<'a>) {
        let memory = &mut workspace.0.fft;
        self.transform.reserve(memory);
        let (rows, scratches) = self.transform.half_spectra(memory);
        let inwards = Inwards { convolution: self, scratches };
        (inwards, rows)
    }

    /// First stage, for all rows of an input that is zero outside the rows `occupied`; only these are
    /// read.
    pub(crate) fn rows_in(&self, input: &[f64], occupied: Range<usize>, workspace: &mut Workspace) {
        let memory = &mut workspace.0.fft;
        self.transform.reserve(memory);
        let input = (input, occupied);
        let work = || self.transform.rows_in(input, memory, &self.threads);
        self.clock.during(work);
    }

    /// Second stage, after the first stage of an `input` that is zero outside the rows `occupied`. Returns the
    /// third stage, which can compute any rows of the output.
    pub(crate) fn outwards<'a>(
        &'a self,
        input: &[f64],
        occupied: Range<usize>,
        workspace: &'a mut Workspace,
    ) -> Outwards<'a> {
        let memory = &mut *workspace.0;
        self.clock.during(|| {
            self.respond(input, occupied.clone(), &mut memory.added);
            let (spectrum, threads) = (&self.spectrum, &self.threads);
            self.transform.columns_through(spectrum, occupied, &mut memory.fft, threads);
        });
        Outwards { convolution: self, memory }
    }
}

/// Rows of fields, together with the half spectra of the same rows.
impl<const N: usize> Written for ([&mut [f64]; N], HalfSpectra<'_>) {
    fn split(self, rows: usize, ny: usize) -> (Self, Self) {
        let (fields, halves) = (self.0.split(rows, ny), self.1.split(rows));
        ((fields.0, halves.0), (fields.1, halves.1))
    }
}

/// Receiver of the rows of the input of a convolution.
pub(crate) struct Inwards<'a> {
    convolution: &'a Convolution,
    scratches: &'a Scratches,
}

impl Inwards<'_> {
    /// Transforms consecutive rows of the input into their half spectra `halves`.
    pub(crate) fn rows(&self, values: &[f64], halves: HalfSpectra) {
        let Convolution { transform, clock, .. } = self.convolution;
        clock.during_part(transform.scratches(), || {
            transform.some_rows_in(values, halves, self.scratches);
        });
    }
}

/// Source of the rows of the output of a convolution.
pub(crate) struct Outwards<'a> {
    convolution: &'a Convolution,
    memory: &'a Memory,
}

impl Outwards<'_> {
    /// Computes rows of the output into `values`, from row `first` on and as many as fit.
    pub(crate) fn rows(&self, first: usize, values: &mut [f64]) {
        let Convolution { transform, clock, .. } = self.convolution;
        clock.during_part(transform.scratches(), || {
            transform.rows_out(first, values, &self.memory.fft);
            self.convolution.add_rows(first, values, &self.memory.added);
        });
    }
}

#[cfg(test)]
mod tests {
    use ndarray::Array2;

    use crate::compliance::convolution::Convolution;
    use crate::error::Result;

    fn field([nx, ny]: [usize; 2]) -> Array2<f64> {
        Array2::from_shape_fn((nx, ny), |(i, j)| ((7 * i + 3 * j + i * j) % 11) as f64 - 4.0)
    }

    /// Stages give the bits of `apply`, with groups of rows of any size, on two threads, and where only
    /// some rows are occupied.
    #[test]
    fn stages_give_the_bits_of_a_whole_application() -> Result<()> {
        for shape in [[1, 9], [7, 1], [23, 18], [150, 130], [230, 150]] {
            let convolution = Convolution::plan(&field(shape), Some(2))?;
            let mut workspace = convolution.workspace();
            let [nx, ny] = shape;
            let occupied = nx / 3..nx - nx / 4;
            let mut input = field(shape);
            for (i, mut row) in input.rows_mut().into_iter().enumerate() {
                if !occupied.contains(&i) {
                    row.fill(0.0);
                }
            }
            let alone = Convolution::plan(&field(shape), Some(1))?;
            let at_once = alone.apply(&input)?.into_raw_vec_and_offset().0;
            let input = input.into_raw_vec_and_offset().0;
            let mut of_occupied = vec![f64::NAN; nx * ny];
            convolution.rows_in(&input, occupied.clone(), &mut workspace);
            let outwards = convolution.outwards(&input, occupied, &mut workspace);
            outwards.rows(0, &mut of_occupied);
            let mut in_parts = vec![f64::NAN; nx * ny];
            for length in [1, 3, 8, 11] {
                let (inwards, mut halves) = convolution.inwards(&mut workspace);
                for part in input.chunks(length * ny) {
                    let (here, rest) = halves.split(part.len() / ny);
                    inwards.rows(part, here);
                    halves = rest;
                }
                let outwards = convolution.outwards(&input, 0..nx, &mut workspace);
                for (k, part) in in_parts.chunks_mut(length * ny).enumerate() {
                    outwards.rows(k * length, part);
                }
                for values in [&of_occupied, &in_parts] {
                    let same = |(a, b): (&f64, &f64)| a.to_bits() == b.to_bits();
                    assert!(values.iter().zip(&at_once).all(same), "{shape:?} {length}");
                }
                in_parts.fill(f64::NAN);
            }
        }
        Ok(())
    }
}
