//! Tables of functions of the squared distance.

use std::f64::consts::PI;

use rayon::prelude::*;

/// N functions of s = r² ≥ 0, smooth in ln(s + shift): polynomials over the pieces of octaves of
/// v = (s + shift)/unit ≥ 1 that are numbered by the first `BITS` bits of the mantissa. They have
/// `TERMS` terms, a multiple of four.
#[derive(Debug)]
pub(crate) struct Table<const N: usize, const TERMS: usize, const BITS: u32> {
    shift: f64,
    inverse_unit: f64,
    last: f64,
    /// Coefficients by powers of the position in the piece, from −1 to 1.
    pieces: Vec<[[f64; N]; TERMS]>,
}

/// A table of four pieces an octave, for functions that are costly: a singularity at v ≤ 0 leaves a
/// relative error of 1e-10.
pub(crate) type FewPieces<const N: usize> = Table<N, 8, 2>;

/// A table of four terms, for many arguments, with a relative error of 1e-10, too.
pub(crate) type FewTerms<const N: usize> = Table<N, 4, 7>;

/// A table of eight pieces an octave, with a relative error of 1e-13.
pub(crate) type Precise<const N: usize> = Table<N, 8, 3>;

impl<const N: usize, const TERMS: usize, const BITS: u32> Table<N, TERMS, BITS> {
    /// The table of `f`, which is given four distances r in `range` at a time, on the threads of the
    /// caller.
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
                let (start, end) =
                    (f64::from_bits(bits), f64::from_bits(bits + (1 << (52 - BITS))));
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
        Self { shift, inverse_unit: 1.0 / unit, last, pieces }
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

/// Coefficients by powers of the Lagrange polynomials of `nodes`.
fn powers_of_lagrange<const NODES: usize>(nodes: &[f64; NODES]) -> [[f64; NODES]; NODES] {
    std::array::from_fn(|k| {
        let mut polynomial = [0.0; NODES];
        polynomial[0] = 1.0;
        for (degree, (_, node)) in nodes.iter().enumerate().filter(|(j, _)| *j != k).enumerate() {
            let norm = 1.0 / (nodes[k] - node);
            for power in (0..=degree + 1).rev() {
                let below = if power > 0 { polynomial[power - 1] } else { 0.0 };
                polynomial[power] = (below - node * polynomial[power]) * norm;
            }
        }
        polynomial
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_hold_what_they_say() {
        let range = [0.3, 500.0];
        let f = |r: [f64; 4]| r.map(|r| [1.0 / r.hypot(0.2), (1.0 + r).ln() / r]);
        let few_pieces = FewPieces::new(range, 0.04, f);
        let few_terms = FewTerms::new(range, 0.04, f);
        let precise = Precise::new(range, 0.04, f);
        for k in 0..1000 {
            let r = range[0] * (range[1] / range[0]).powf(f64::from(k) / 999.0);
            let [exact, ..] = f([r; 4]);
            let approximations = [few_pieces.at(r * r), few_terms.at(r * r), precise.at(r * r)];
            for (values, error) in approximations.iter().zip([1e-9, 1e-9, 1e-12]) {
                for (value, exact) in values.iter().zip(&exact) {
                    assert!((value / exact - 1.0).abs() < error, "{r}: {value} {exact}");
                }
            }
        }
    }
}
