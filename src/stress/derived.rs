//! Invariants of the stress: von Mises' stress, principal stresses, the largest shear stress.

use ndarray::Array3;

use super::field::Stress;

/// Stress at one point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Tensor {
    pub(super) xx: f64,
    pub(super) yy: f64,
    pub(super) zz: f64,
    pub(super) xy: f64,
    pub(super) yz: f64,
    pub(super) xz: f64,
}

/// A value and its position.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Peak {
    /// The value \[Pa\].
    pub value: f64,
    /// x, y, z \[m\].
    pub position: [f64; 3],
    /// Estimated error of the value \[Pa\], due to the size of the cells: [`Stress::uncertainty`] at this
    /// depth.
    pub uncertainty: Option<f64>,
}

impl Tensor {
    /// The tensor from its components in the order of [`Stress::components`].
    pub(crate) fn new([xx, yy, zz, xy, yz, xz]: [f64; 6]) -> Self {
        Self {
            xx,
            yy,
            zz,
            xy,
            yz,
            xz,
        }
    }

    fn matrix(&self) -> [[f64; 3]; 3] {
        let [xz, yz] = [self.xz, self.yz];
        [
            [self.xx, self.xy, xz],
            [self.xy, self.yy, yz],
            [xz, yz, self.zz],
        ]
    }

    /// Von Mises' equivalent stress,
    /// √{½ [(σxx−σyy)² + (σyy−σzz)² + (σzz−σxx)²] + 3 (σxy² + σyz² + σxz²)}.
    pub(super) fn von_mises(&self) -> f64 {
        let [[xx, xy, xz], [_, yy, yz], [_, _, zz]] = self.matrix();
        let normal = (xx - yy).powi(2) + (yy - zz).powi(2) + (zz - xx).powi(2);
        (0.5 * normal + 3.0 * (xy * xy + yz * yz + xz * xz)).sqrt()
    }

    /// Mean of the normal stresses.
    pub(super) fn mean(&self) -> f64 {
        (self.xx + self.yy + self.zz) / 3.0
    }

    /// Principal stresses, the largest first, by Jacobi's rotations, which lose no digits where two
    /// are equal: Golub & Van Loan, Matrix Computations, 4th ed. (2013), §8.5.
    pub(crate) fn principal(&self) -> [f64; 3] {
        let mut a = self.matrix();
        // Entries off the diagonal fall quadratically: three sweeps are usual.
        for _ in 0..8 {
            let off = a[0][1].abs() + a[0][2].abs() + a[1][2].abs();
            let on = a[0][0].abs() + a[1][1].abs() + a[2][2].abs();
            if off <= f64::EPSILON * f64::EPSILON * on {
                break;
            }
            for (p, q) in [(0, 1), (0, 2), (1, 2)] {
                rotate(&mut a, p, q);
            }
        }
        let mut values = [a[0][0], a[1][1], a[2][2]];
        values.sort_by(|a, b| b.total_cmp(a));
        values
    }
}

/// Applies the rotation in the plane (p, q) that makes `a[p][q]` zero.
fn rotate(a: &mut [[f64; 3]; 3], p: usize, q: usize) {
    let shear = a[p][q];
    if shear == 0.0 {
        return;
    }
    let tau = (a[q][q] - a[p][p]) / (2.0 * shear);
    let tan = tau.signum() / (tau.abs() + tau.hypot(1.0));
    let cos = 1.0 / tan.hypot(1.0);
    let sin = tan * cos;
    a[p][p] -= tan * shear;
    a[q][q] += tan * shear;
    (a[p][q], a[q][p]) = (0.0, 0.0);
    let r = 3 - p - q;
    let (rp, rq) = (a[r][p], a[r][q]);
    a[r][p] = cos * rp - sin * rq;
    a[r][q] = sin * rp + cos * rq;
    (a[p][r], a[q][r]) = (a[r][p], a[r][q]);
}

impl Stress {
    /// Von Mises' equivalent stress \[Pa\].
    pub fn von_mises(&self) -> Array3<f64> {
        self.map(|tensor| tensor.von_mises())
    }

    /// Principal stresses \[Pa\], the largest first.
    pub fn principal(&self) -> [Array3<f64>; 3] {
        let mut all = [0, 1, 2].map(|_| Array3::zeros(self.components[0].raw_dim()));
        let [first, second, third] = &mut all;
        let tensors = self.tensors();
        for (((a, b), c), tensor) in first
            .iter_mut()
            .zip(second.iter_mut())
            .zip(third.iter_mut())
            .zip(tensors)
        {
            [*a, *b, *c] = tensor.principal();
        }
        all
    }

    /// Tresca's equivalent stress \[Pa\]: the largest principal stress minus the smallest.
    pub fn tresca(&self) -> Array3<f64> {
        self.map(|tensor| {
            let [first, _, last] = tensor.principal();
            first - last
        })
    }

    /// Largest shear stress on any plane \[Pa\]: half of Tresca's stress.
    pub fn max_shear(&self) -> Array3<f64> {
        0.5 * self.tresca()
    }

    /// The largest of `values` (depths, nx, ny) and its position; none if there are no values in the body.
    pub fn peak(&self, values: &Array3<f64>) -> Option<Peak> {
        let found = values
            .indexed_iter()
            .filter(|(_, value)| !value.is_nan())
            .reduce(|best, next| if next.1 > best.1 { next } else { best });
        found.map(|((k, i, j), &value)| Peak {
            value,
            position: [self.x[i], self.y[j], self.z[k]],
            uncertainty: self.uncertainty.as_ref().map(|errors| errors[k]),
        })
    }

    fn tensors(&self) -> impl Iterator<Item = Tensor> + '_ {
        let [xx, yy, zz, xy, yz, xz] = &self.components;
        let normal = xx.iter().zip(yy).zip(zz);
        let shear = xy.iter().zip(yz).zip(xz);
        normal
            .zip(shear)
            .map(|(((xx, yy), zz), ((xy, yz), xz))| Tensor::new([*xx, *yy, *zz, *xy, *yz, *xz]))
    }

    fn map(&self, f: impl Fn(&Tensor) -> f64) -> Array3<f64> {
        let mut values = Array3::zeros(self.components[0].raw_dim());
        values
            .iter_mut()
            .zip(self.tensors())
            .for_each(|(value, tensor)| *value = f(&tensor));
        values
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Uniaxial stress, equibiaxial stress, pure shear, and a tensor turned by known angles.
    #[test]
    fn invariants_of_known_states() {
        const ROUNDING: f64 = 1e-15;
        let von_mises = |components| Tensor::new(components).von_mises();
        let principal = |components| Tensor::new(components).principal();
        assert!((von_mises([3.0, 0.0, 0.0, 0.0, 0.0, 0.0]) - 3.0).abs() < 3.0 * ROUNDING);
        let shear = von_mises([0.0, 0.0, 0.0, 0.0, 2.0, 0.0]);
        assert!((shear / (2.0 * 3.0_f64.sqrt()) - 1.0).abs() < 2.0 * ROUNDING);
        let [a, b, c] = principal([1.0, 1.0, -4.0, 0.0, 0.0, 0.0]);
        assert!((a - 1.0).abs() + (b - 1.0).abs() + (c + 4.0).abs() < 10.0 * ROUNDING);
        let [a, b, c] = principal([0.0, 0.0, 0.0, 0.0, 2.0, 0.0]);
        assert!((a - 2.0).abs() + b.abs() + (c + 2.0).abs() < 10.0 * ROUNDING);
        // diag(5, 2, 2) turned about two axes: the double value keeps its digits.
        let (s, t): (f64, f64) = (0.3, 1.1);
        let n = [s.cos() * t.cos(), s.sin() * t.cos(), t.sin()];
        let of = |i: usize, j: usize| 3.0 * n[i] * n[j] + if i == j { 2.0 } else { 0.0 };
        let turned = [of(0, 0), of(1, 1), of(2, 2), of(0, 1), of(1, 2), of(0, 2)];
        for (value, exact) in principal(turned).into_iter().zip([5.0, 2.0, 2.0]) {
            assert!((value - exact).abs() < 10.0 * ROUNDING, "{value} {exact}");
        }
        assert!((von_mises(turned) - 3.0).abs() < 10.0 * ROUNDING);
    }
}
