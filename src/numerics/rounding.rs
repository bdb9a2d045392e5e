//! Whole numbers from ratios that carry rounding, such as the number of cells in a length.

/// Largest rounding of a ratio, as a part of it or of 1: far above that of a few products and quotients, and far below what a
/// fraction of a cell means.
const ROUNDING: f64 = 1e-9;

/// The smallest whole number that is not below a ratio by more than rounding.
pub(crate) fn ceil(ratio: f64) -> f64 {
    (ratio - ROUNDING * ratio.abs().max(1.0)).ceil()
}

/// The largest whole number that is not above a ratio by more than rounding.
pub(crate) fn floor(ratio: f64) -> f64 {
    -ceil(-ratio)
}

/// The whole number nearest to a ratio; the larger one of two at the same distance to rounding.
pub(crate) fn round(ratio: f64) -> f64 {
    floor(ratio + 0.5)
}

/// Number of cells of the side `cell` that hold a length.
pub(crate) fn cells_within(length: f64, cell: f64) -> usize {
    ceil(length / cell) as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of a thousand cell sizes, 7 % have (3 d)/d above 3.
    #[test]
    fn three_cells_are_three_cells_long() {
        let sides = (0..1000).map(|k| 1e-6 * 1.01_f64.powi(k));
        let plain = |side: &f64| (3.0 * side / side).ceil() > 3.0 || (side * 7.0 / side) < 7.0;
        assert!(sides.clone().any(|side| plain(&side)));
        for side in sides {
            assert_eq!(cells_within(3.0 * side, side), 3);
            assert_eq!(cells_within(3.001 * side, side), 4);
            assert_eq!(floor(7.0 * side / side).to_bits(), 7.0_f64.to_bits());
            assert_eq!(floor(6.999 * side / side).to_bits(), 6.0_f64.to_bits());
        }
        assert_eq!(cells_within(1e-17, 1.0), 0);
        for half in [2.5, 2.5 * (1.0 - f64::EPSILON)] {
            assert_eq!(round(half).to_bits(), 3.0_f64.to_bits());
        }
        assert_eq!(round(2.499).to_bits(), 2.0_f64.to_bits());
        assert_eq!(floor(-1e-17).abs().to_bits(), 0.0_f64.to_bits());
    }
}
