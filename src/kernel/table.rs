//! Tables of several functions of the squared distance at once.

use std::f64::consts::PI;

use rayon::prelude::*;

use crate::influence::powers_of_lagrange;

/// N functions of s = r² ≥ 0, smooth in ln(s + shift): polynomials over the pieces of octaves of
/// v = (s + shift)/unit ≥ 1 that are numbered by the first `BITS` bits of the mantissa. They have
/// `TERMS` terms, a multiple of four.
#[derive(Debug)]
pub(crate) struct Table<const N: usize, const TERMS: usize, const BITS: u32> {
    shift: f64,
    inverse_unit: f64,
    last: f64,
    /// Powers of the position in the piece, from −1 to 1.
    pieces: Vec<[[f64; N]; TERMS]>,
}

/// Of few pieces, for functions that are costly: a singularity at v ≤ 0 leaves a relative error of
/// 1e-10.
pub(crate) type Coarse<const N: usize> = Table<N, 8, 2>;

/// Of few terms, for many arguments; the relative error is the same.
pub(crate) type Fine<const N: usize> = Table<N, 4, 7>;

impl<const N: usize, const TERMS: usize, const BITS: u32> Table<N, TERMS, BITS> {
    /// Of `f`, which is given four distances r in `range` at a time, on the threads of the caller.
    pub(crate) fn new(
        range: [f64; 2],
        shift: f64,
        f: impl Fn([f64; 4]) -> [[f64; N]; 4] + Sync,
    ) -> Self {
        let unit = range[0] * range[0] + shift;
        let last = (range[1] * range[1] + shift) / unit;
        let piece = |v: f64| (v.to_bits() >> (52 - BITS)) as usize;
        let nodes: [f64; TERMS] =
            std::array::from_fn(|k| (PI * (k as f64 + 0.5) / TERMS as f64).cos());
        let powers = powers_of_lagrange(&nodes);
        let pieces = (piece(1.0)..=piece(last))
            .into_par_iter()
            .map(|piece| {
                let bits = (piece as u64) << (52 - BITS);
                let (start, end) = (
                    f64::from_bits(bits),
                    f64::from_bits(bits + (1 << (52 - BITS))),
                );
                let distance = |node: f64| {
                    let v = start + 0.5 * (1.0 + node) * (end - start);
                    (v * unit - shift).max(0.0).sqrt()
                };
                let (fours, _) = nodes.as_chunks::<4>();
                let values = fours.iter().flat_map(|four| f(four.map(distance)));
                let mut polynomials = [[0.0; N]; TERMS];
                for (values, lagrange) in values.zip(&powers) {
                    for (polynomial, l) in polynomials.iter_mut().zip(lagrange) {
                        for (c, value) in polynomial.iter_mut().zip(&values) {
                            *c += value * l;
                        }
                    }
                }
                polynomials
            })
            .collect();
        Self {
            shift,
            inverse_unit: 1.0 / unit,
            last,
            pieces,
        }
    }

    /// The functions at s, or at the nearer end of the table.
    #[inline]
    pub(crate) fn at(&self, s: f64) -> [f64; N] {
        let v = ((s + self.shift) * self.inverse_unit).clamp(1.0, self.last);
        let bits = v.to_bits();
        let first = (1.0_f64.to_bits() >> (52 - BITS)) as usize;
        let polynomials = &self.pieces[(bits >> (52 - BITS)) as usize - first];
        // The bits that are left are the position in the piece, from 1 to 2 under this exponent.
        let left = (bits << BITS) & ((1 << 52) - 1);
        let position = 2.0 * f64::from_bits(1.0_f64.to_bits() | left) - 3.0;
        let mut sums = polynomials[TERMS - 1];
        for coefficients in polynomials[..TERMS - 1].iter().rev() {
            for (sum, c) in sums.iter_mut().zip(coefficients) {
                *sum = *sum * position + c;
            }
        }
        sums
    }
}
