//! Pseudo-random numbers that are equal in every run.

use ndarray::Array2;

/// Pseudo-random number, uniform in \[0, 1): splitmix64, Steele et al. (2014), doi:10.1145/2660193.2660195.
pub(crate) fn uniform(shape: [usize; 2], seed: u64) -> Array2<f64> {
    let mut state = seed;
    Array2::from_shape_simple_fn(shape, || {
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (z ^ (z >> 31)) as f64 / 2.0_f64.powi(64)
    })
}
