//! Scalars made of a stress, and their derivatives with respect to its components.

use super::output::Measure;
use crate::stress::Tensor;

/// Distance of principal stresses, relative to the largest, below which they are repeated.
const REPEATED: f64 = 1e-9;

/// A measure, its derivatives with respect to σ_xx, σ_yy, σ_zz, σ_xy, σ_yz, σ_xz, and whether a principal stress that it
/// takes is repeated.
pub(super) struct Measured {
    pub(super) value: f64,
    pub(super) slopes: [f64; 6],
    pub(super) is_repeated: bool,
}

impl Measured {
    fn smooth(value: f64, slopes: [f64; 6]) -> Self {
        Self {
            value,
            slopes,
            is_repeated: false,
        }
    }
}

/// The measure of a stress with these components.
pub(super) fn measured(measure: Measure, s: [f64; 6]) -> Measured {
    let [xx, yy, zz, xy, yz, xz] = s;
    match measure {
        Measure::Component(k) => {
            let mut slopes = [0.0; 6];
            slopes[k] = 1.0;
            Measured::smooth(s[k], slopes)
        }
        Measure::PlaneShear => {
            let value = yz.hypot(xz);
            let over = |t: f64| if value > 0.0 { t / value } else { 0.0 };
            Measured::smooth(value, [0.0, 0.0, 0.0, 0.0, over(yz), over(xz)])
        }
        Measure::VonMises => {
            let mean = (xx + yy + zz) / 3.0;
            let deviator = [xx - mean, yy - mean, zz - mean];
            let square: f64 =
                deviator.iter().map(|d| d * d).sum::<f64>() + 2.0 * (xy * xy + yz * yz + xz * xz);
            let value = (1.5 * square).sqrt();
            let over = |t: f64| if value > 0.0 { 1.5 * t / value } else { 0.0 };
            let [a, b, c] = deviator.map(over);
            Measured::smooth(
                value,
                [a, b, c, over(2.0 * xy), over(2.0 * yz), over(2.0 * xz)],
            )
        }
        Measure::Principal(k) => {
            let values = Tensor::new(s).principal();
            let near = (0..3).filter(|&j| j != k).any(|j| are_equal(values, k, j));
            Measured {
                value: values[k],
                slopes: dyad(s, values, k),
                is_repeated: near,
            }
        }
        Measure::MaxShear => {
            let values = Tensor::new(s).principal();
            let (first, last) = (dyad(s, values, 0), dyad(s, values, 2));
            Measured {
                value: 0.5 * (values[0] - values[2]),
                slopes: std::array::from_fn(|k| 0.5 * (first[k] - last[k])),
                is_repeated: are_equal(values, 0, 1) || are_equal(values, 1, 2),
            }
        }
    }
}

fn are_equal(values: [f64; 3], i: usize, j: usize) -> bool {
    let size = values.iter().fold(0.0, |a: f64, v| a.max(v.abs()));
    (values[i] - values[j]).abs() <= REPEATED * size
}

/// ∂σ_k/∂σ = n nᵀ of the direction n, from the adjugate of σ − σ_k; shear components count twice.
fn dyad([xx, yy, zz, xy, yz, xz]: [f64; 6], values: [f64; 3], k: usize) -> [f64; 6] {
    let [a, b, c] = [xx, yy, zz].map(|s| s - values[k]);
    let adjugate = [
        b * c - yz * yz,
        a * c - xz * xz,
        a * b - xy * xy,
        xz * yz - xy * c,
        xy * xz - a * yz,
        xy * yz - b * xz,
    ];
    let trace = adjugate[0] + adjugate[1] + adjugate[2];
    let over = |t: f64| if trace == 0.0 { 0.0 } else { t / trace };
    let [a, b, c, d, e, f] = adjugate.map(over);
    [a, b, c, 2.0 * d, 2.0 * e, 2.0 * f]
}
