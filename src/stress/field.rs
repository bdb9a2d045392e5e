//! Stress and displacement at some depths, as a value, and its invariants.

use std::fmt;

use ndarray::{Array1, Array3, Axis};

use super::options::Side;
use crate::error::{Error, Result, finite};
use crate::model::body::HalfSpace;
use crate::model::grid::Grid;

/// Stress at some depths. Arrays are (depths, nx, ny); on a section nx or ny is 1. Tension is
/// positive. Beyond a free end of the body, values are NaN; equal stresses have NaN at the same places.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Stress {
    /// Depths z \[m\].
    pub z: Array1<f64>,
    /// Coordinates x \[m\].
    pub x: Array1<f64>,
    /// Coordinates y \[m\].
    pub y: Array1<f64>,
    /// The body.
    pub body: HalfSpace,
    /// Side on which depths at an interface were evaluated.
    pub side: Side,
    /// μ times the unit vector of the traction that acts on the body.
    pub friction: [f64; 2],
    /// σ_xx, σ_yy, σ_zz, σ_xy, σ_yz, σ_xz \[Pa\], in this order; [`Stress::xx`] to [`Stress::xz`] name
    /// them.
    pub components: [Array3<f64>; 6],
    /// Estimated error of the components at each depth \[Pa\], due to the size of the cells; the errors of
    /// the pressure itself add to it. `None` where the pressure is not that of a solved contact, but
    /// given as uniform over cells.
    ///
    /// It belongs to the worst place of a depth, of those that were evaluated: at the edge of the contact as
    /// a rule. Where it is not small compared with the stress, the cells do not resolve the depth, or the
    /// layer: take smaller cells. Tractions at the surface are those of the cells.
    pub uncertainty: Option<Array1<f64>>,
    /// Displacements u_x, u_y, u_z \[m\], if they were asked for. In line contact they are relative to
    /// the substrate's surface at a distance of the grid's width, as all displacements there.
    pub displacement: Option<[Array3<f64>; 3]>,
}

impl PartialEq for Stress {
    fn eq(&self, other: &Self) -> bool {
        let same = |(a, b): (&f64, &f64)| a == b || a.is_nan() && b.is_nan();
        (&self.z, &self.x, &self.y) == (&other.z, &other.x, &other.y)
            && (&self.body, self.side, self.friction) == (&other.body, other.side, other.friction)
            && self.displacement.is_some() == other.displacement.is_some()
            && self.uncertainty.is_some() == other.uncertainty.is_some()
            && self.values().zip(other.values()).all(same)
    }
}

/// Estimated error over the largest stress of a depth above which a warning says so. The estimate is some
/// three times the error (`tests/stress/resolution.rs`).
const UNRESOLVED: f64 = 0.05;

/// A ratio in per cent, for messages.
pub(super) struct Percent(pub(super) f64);

impl fmt::Display for Percent {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            ratio if ratio < 1.0 => write!(f, "{:.0} %", 100.0 * ratio),
            _ => write!(f, "more than 100 %"),
        }
    }
}

/// Factor above which the size of the cells that are needed is not known to a factor of 2.
const KNOWN_TIMES: f64 = 10.0;

/// The cells that an error needs to fall by this factor, for messages. It falls as the steps of the pressure from cell to cell,
/// which are as long as cells where the pressure is smooth: on four soft and hard coatings, the size named is within a factor
/// of 2 of the one needed below [`KNOWN_TIMES`]; beyond, and for errors without a limit, no size is named.
pub(super) struct SmallerCells(pub(super) f64);

impl fmt::Display for SmallerCells {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0.ceil() {
            times if times < KNOWN_TIMES => write!(f, "cells {times} times smaller"),
            _ => write!(f, "much smaller cells"),
        }
    }
}

impl Stress {
    /// All values, in an order that coordinates and optional fields determine.
    fn values(&self) -> impl Iterator<Item = &f64> {
        let displacement = self.displacement.iter().flatten();
        let fields = self.components.iter().chain(displacement).flatten();
        fields.chain(self.uncertainty.iter().flatten())
    }

    /// A stress field from coordinates and fields of shape (depths, nx, ny).
    ///
    /// # Errors
    /// A field whose shape is not that of its coordinates, and a coordinate that is not finite.
    pub fn from_fields(
        [z, x, y]: [Array1<f64>; 3],
        body: HalfSpace,
        side: Side,
        friction: [f64; 2],
        components: [Array3<f64>; 6],
        displacement: Option<[Array3<f64>; 3]>,
        uncertainty: Option<Array1<f64>>,
    ) -> Result<Self> {
        let shape = (z.len(), x.len(), y.len());
        let mut fields = components.iter().chain(displacement.iter().flatten());
        if fields.any(|field| field.dim() != shape) {
            return Err(Error::Inconsistent(
                "every component must have shape (len(z), len(x), len(y))",
            ));
        }
        if uncertainty.as_ref().is_some_and(|errors| errors.len() != z.len()) {
            return Err(Error::Inconsistent("uncertainty must have a value for each depth"));
        }
        for coordinate in [&z, &x, &y].into_iter().flatten() {
            finite("coordinates of a stress", *coordinate)?;
        }
        Ok(Self { z, x, y, body, side, friction, components, uncertainty, displacement })
    }

    /// Warnings about what the cells do not resolve, the depth at which the estimated error is largest
    /// compared with the largest stress there, if it is above a twentieth of it; and about friction at free ends.
    pub fn warnings(&self) -> Vec<String> {
        let errors = self.uncertainty.iter().flatten();
        let ratio = |(k, error): (usize, &f64)| {
            let largest = |field: &Array3<f64>| {
                let here = field.index_axis(Axis(0), k);
                here.fold(0.0_f64, |m, s| m.max(s.abs()))
            };
            let largest = self.components.iter().map(largest).fold(0.0, f64::max);
            (k, error / largest)
        };
        let worst = errors
            .enumerate()
            .map(ratio)
            .filter(|(_, ratio)| *ratio > UNRESOLVED)
            .max_by(|a, b| a.1.total_cmp(&b.1));
        let message = |(k, ratio): (usize, f64)| {
            let place = match self.z[k] {
                0.0 => "at the surface".to_owned(),
                depth => format!("at depth {depth:e}"),
            };
            format!(
                "{place} the stress is uncertain by {} of the largest there, due to the size of the cells: \
                 take {}",
                Percent(ratio),
                SmallerCells(ratio / UNRESOLVED)
            )
        };
        let slides = self.friction.iter().any(|part| *part != 0.0);
        let ends = (slides && self.body.ends() != [None; 2]).then(|| {
            "the stress of the friction is that of a body that extends past its free ends"
                .to_owned()
        });
        worst.map(message).into_iter().chain(ends).collect()
    }

    /// Normal stress σ_xx \[Pa\].
    pub fn xx(&self) -> &Array3<f64> {
        &self.components[0]
    }

    /// Normal stress σ_yy \[Pa\].
    pub fn yy(&self) -> &Array3<f64> {
        &self.components[1]
    }

    /// Normal stress σ_zz, minus the pressure at the surface \[Pa\].
    pub fn zz(&self) -> &Array3<f64> {
        &self.components[2]
    }

    /// Shear stress σ_xy, in the plane of the surface \[Pa\].
    pub fn xy(&self) -> &Array3<f64> {
        &self.components[3]
    }

    /// Shear stress σ_yz, along y on planes z = const \[Pa\].
    pub fn yz(&self) -> &Array3<f64> {
        &self.components[4]
    }

    /// Shear stress σ_xz, along x on planes z = const \[Pa\].
    pub fn xz(&self) -> &Array3<f64> {
        &self.components[5]
    }

    /// Displacement u_x along x \[m\], if it was asked for.
    pub fn ux(&self) -> Option<&Array3<f64>> {
        self.displacement.as_ref().map(|fields| &fields[0])
    }

    /// Displacement u_y along y \[m\], if it was asked for.
    pub fn uy(&self) -> Option<&Array3<f64>> {
        self.displacement.as_ref().map(|fields| &fields[1])
    }

    /// Displacement u_z into the body \[m\], if it was asked for.
    pub fn uz(&self) -> Option<&Array3<f64>> {
        self.displacement.as_ref().map(|fields| &fields[2])
    }
}

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
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
#[non_exhaustive]
pub struct Peak {
    /// The value \[Pa\].
    pub value: f64,
    /// x, y, z \[m\].
    #[cfg_attr(feature = "serde", serde(rename = "at"))]
    pub position: [f64; 3],
    /// Estimated error of the value \[Pa\], due to the size of the cells: the largest sum of a value and its error
    /// ([`Stress::uncertainty`]), over all places that were evaluated, less this value.
    pub uncertainty: Option<f64>,
}

/// The largest of many values, and the largest that one of them may be.
#[derive(Debug, Clone, Copy)]
pub(super) struct Extreme {
    pub(super) value: f64,
    pub(super) position: [f64; 3],
    /// The largest sum of a value and its error; none where errors are not known.
    pub(super) bound: Option<Bound>,
}

/// The largest sum of a value and its error, and its place.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bound {
    pub(super) value: f64,
    pub(super) position: [f64; 3],
}

impl Extreme {
    /// The extreme of no values.
    pub(super) const NONE: Self =
        Self { value: f64::NEG_INFINITY, position: [0.0; 3], bound: None };

    /// The extreme of one value with this error.
    pub(super) fn of(value: f64, position: [f64; 3], error: Option<f64>) -> Self {
        Self { value, position, bound: error.map(|error| Bound { value: value + error, position }) }
    }

    /// The extreme of the values of both.
    pub(super) fn with(self, other: Self) -> Self {
        let largest = if other.value > self.value { other } else { self };
        Self { bound: self.larger_bound(other), ..largest }
    }

    /// This extreme, with a bound that is at least by this part of it larger.
    pub(super) fn uncertain_by(self, part: f64) -> Self {
        let least = Self::of(self.value, self.position, Some(part * self.value.abs()));
        if self.bound.is_some() { self.bounded_by(least) } else { self }
    }

    /// This extreme, with the larger bound of both.
    pub(super) fn bounded_by(self, other: Self) -> Self {
        Self { bound: self.larger_bound(other), ..self }
    }

    fn larger_bound(self, other: Self) -> Option<Bound> {
        match (self.bound, other.bound) {
            (Some(a), Some(b)) if b.value > a.value => Some(b),
            (a, b) => a.or(b),
        }
    }

    /// The value with its error.
    pub(super) fn peak(self) -> Peak {
        let Self { value, position, bound } = self;
        Peak { value, position, uncertainty: bound.map(|bound| bound.value - value) }
    }

    /// The peak of a value that is the smallest of many, of which this is the largest of the negatives.
    pub(super) fn negative_peak(self) -> Peak {
        Peak { value: -self.value, ..self.peak() }
    }
}

impl Tensor {
    /// The tensor from its components in the order of [`Stress::components`].
    pub(crate) fn new([xx, yy, zz, xy, yz, xz]: [f64; 6]) -> Self {
        Self { xx, yy, zz, xy, yz, xz }
    }

    fn matrix(&self) -> [[f64; 3]; 3] {
        let [xz, yz] = [self.xz, self.yz];
        [[self.xx, self.xy, xz], [self.xy, self.yy, yz], [xz, yz, self.zz]]
    }

    /// Von Mises' equivalent stress,
    /// √{½ [(σxx−σyy)² + (σyy−σzz)² + (σzz−σxx)²] + 3 (σxy² + σyz² + σxz²)}.
    pub(super) fn von_mises(&self) -> f64 {
        let [[xx, xy, xz], [_, yy, yz], [_, _, zz]] = self.matrix();
        let normal = (xx - yy).powi(2) + (yy - zz).powi(2) + (zz - xx).powi(2);
        (0.5 * normal + 3.0 * (xy * xy + yz * yz + xz * xz)).sqrt()
    }

    pub(super) fn mean(&self) -> f64 {
        (self.xx + self.yy + self.zz) / 3.0
    }

    /// Whether the largest principal stress may be larger than `least`, given von Mises' stress; never false where it is.
    ///
    /// It is at most the mean plus ⅔ of von Mises' stress, and it is less than t where t I − σ is positive definite: where its
    /// leading minors are positive.
    pub(super) fn may_pull(&self, least: f64, mises: f64) -> bool {
        let mean = self.mean();
        if mean + 0.67 * mises <= least {
            return false;
        }
        let t = least - MINORS * (mean.abs() + mises);
        let Self { xy, yz, xz, .. } = *self;
        let [a, b, c] = [t - self.xx, t - self.yy, t - self.zz];
        let plane = a * b - xy * xy;
        let whole = c * plane - a * yz * yz - b * xz * xz - 2.0 * xy * yz * xz;
        !(mises.is_nan() || a > 0.0 && plane > 0.0 && whole > 0.0)
    }

    /// Whether the largest shear stress may be larger than `least`, given von Mises' stress; never false where it is.
    ///
    /// ```text
    /// τ = √J₂ cos φ     |sin 3φ| = √(27/4) |J₃| J₂^(−3/2)     |φ| ≤ π/6
    /// τ > u √J₂  ⟺  sin² 3φ < (1 − u²) (4u² − 1)²             ½√3 ≤ u ≤ 1
    /// ```
    pub(super) fn may_shear(&self, least: f64, mises: f64) -> bool {
        if 0.58 * mises <= least {
            return false;
        }
        let per_root = 3.0_f64.sqrt() / mises;
        let u = least * per_root - MINORS;
        let square = u * u;
        if u < 0.0 || square <= 0.75 {
            return !mises.is_nan();
        }
        let mean = self.mean();
        let [a, b, c] = [self.xx, self.yy, self.zz].map(|s| (s - mean) * per_root);
        let [d, e, f] = [self.xy, self.yz, self.xz].map(|s| s * per_root);
        let third = a * (b * c - e * e) - d * (d * c - e * f) + f * (d * e - b * f);
        let limit = (1.0 - square) * (4.0 * square - 1.0).powi(2);
        6.75 * third * third <= limit
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

/// Part of the stress by which limits of principal stresses are too wide: the square of it, which minors are where two principal
/// stresses are equal, is far above their rounding.
const MINORS: f64 = 1e-5;

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
        for (((a, b), c), tensor) in
            first.iter_mut().zip(second.iter_mut()).zip(third.iter_mut()).zip(tensors)
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
        let of_value = |((k, i, j), value): ((usize, usize, usize), &f64)| {
            let error = self.uncertainty.as_ref().map(|errors| errors[k]);
            Extreme::of(*value, [self.x[i], self.y[j], self.z[k]], error)
        };
        let known = values.indexed_iter().filter(|(_, value)| !value.is_nan());
        Some(known.map(of_value).reduce(Extreme::with)?.peak())
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
        values.iter_mut().zip(self.tensors()).for_each(|(value, tensor)| *value = f(&tensor));
        values
    }
}

/// The largest value found so far, and its cell.
#[derive(Debug, Clone, Copy)]
pub(super) struct Largest {
    pub(super) value: f64,
    pub(super) cell: usize,
}

impl Largest {
    pub(super) const NONE: Self = Self { value: f64::NEG_INFINITY, cell: 0 };

    pub(super) fn offer(&mut self, value: f64, cell: usize) {
        if value > self.value {
            *self = Self { value, cell };
        }
    }

    /// Twice what parabolas through the value of this cell and its neighbours along each axis rise above it: the value between
    /// centres of cells is larger by about once that. `of` has the values of cells that count.
    pub(super) fn between(&self, grid: &Grid, of: impl Fn(usize) -> Option<f64>) -> f64 {
        let Some(here) = of(self.cell) else { return 0.0 };
        let (shape, periodic) = (grid.shape(), grid.is_periodic());
        let at = [self.cell / shape[1], self.cell % shape[1]];
        let beside = |axis: usize, step: usize| {
            let count = shape[axis];
            let moved = at[axis] + step;
            let wraps = (moved >= count) == (step == 1);
            let mut cell = at;
            cell[axis] = moved % count;
            if wraps && !periodic[axis] { None } else { of(cell[0] * shape[1] + cell[1]) }
        };
        let gain = |axis: usize| {
            let (before, after) = (beside(axis, shape[axis] - 1)?, beside(axis, 1)?);
            let curvature = (2.0 * here - before - after).max(0.0);
            // The vertex is at most half a cell away, unless cells that do not count have larger values.
            let slope = (0.5 * (after - before)).abs().min(0.5 * curvature);
            (curvature > 0.0).then(|| slope * slope / curvature)
        };
        [0, 1].into_iter().filter_map(gain).sum()
    }
}

/// The largest value of cells so far, and the largest sum of a value and its error.
#[derive(Debug, Clone, Copy)]
pub(super) struct LargestWithError {
    pub(super) value: Largest,
    pub(super) bound: Largest,
}

impl LargestWithError {
    pub(super) const NONE: Self = Self { value: Largest::NONE, bound: Largest::NONE };

    /// What is exceeded by all that are as large as these.
    pub(super) fn or_equal(self) -> Self {
        let below = |Largest { value, cell }: Largest| Largest { value: value.next_down(), cell };
        Self { value: below(self.value), bound: below(self.bound) }
    }

    pub(super) fn offer(&mut self, value: f64, error: f64, cell: usize) {
        self.value.offer(value, cell);
        self.bound.offer(value + error, cell);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A smaller value with a larger error decides how far the extreme may be, whatever the order.
    #[test]
    fn the_error_of_an_extreme_is_that_of_the_largest_bound() {
        let sure = Extreme::of(10.0, [0.0; 3], Some(0.5));
        let unsure = Extreme::of(9.0, [1.0, 2.0, 3.0], Some(4.0));
        for extreme in [sure.with(unsure), unsure.with(sure), sure.bounded_by(unsure)] {
            let Peak { value, position, uncertainty } = extreme.peak();
            assert_eq!((value, position, uncertainty), (10.0, [0.0; 3], Some(3.0)));
            assert_eq!(extreme.bound.map(|bound| bound.position), Some([1.0, 2.0, 3.0]));
            let Peak { value, uncertainty, .. } = extreme.negative_peak();
            assert_eq!((value, uncertainty), (-10.0, Some(3.0)));
        }
    }

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

    /// No stress is ruled out whose largest principal or shear stress is above a limit, and hardly any other: where two or three
    /// principal stresses are equal, in all directions, and of any size.
    #[test]
    fn what_rules_out_stresses_keeps_the_largest() {
        const ABOVE: f64 = 1e-4;
        // Where all three are equal, von Mises' stress is a rounding of the mean.
        const ROUNDING: f64 = 1e-14;
        let turned = |[p, q, r]: [f64; 3], (s, t): (f64, f64)| {
            let first = [s.cos() * t.cos(), s.sin() * t.cos(), t.sin()];
            let second = [-s.sin(), s.cos(), 0.0];
            let of = |i: usize, j: usize| {
                let both = p * first[i] * first[j] + q * second[i] * second[j];
                let third = |i: usize| {
                    let [k, l] = [(i + 1) % 3, (i + 2) % 3];
                    first[k] * second[l] - first[l] * second[k]
                };
                both + r * third(i) * third(j)
            };
            Tensor::new([of(0, 0), of(1, 1), of(2, 2), of(0, 1), of(1, 2), of(0, 2)])
        };
        let levels = [-4.0, -1.0, -1.0 + 1e-9, 0.0, 0.3, 2.0];
        for number in 0..levels.len().pow(3) {
            let value = |k: u32| levels[number / levels.len().pow(k) % levels.len()];
            for turn in 0..20 {
                for size in [1e-80, 1.0, 1e80] {
                    let principal = [0, 1, 2].map(|k| size * value(k));
                    let tensor = turned(principal, (0.37 * turn as f64, 0.21 * turn as f64));
                    let ([first, _, last], mises) = (tensor.principal(), tensor.von_mises());
                    let (shear, above) = (0.5 * (first - last), ABOVE * 4.0 * size);
                    let below = ROUNDING * 4.0 * size;
                    assert!(tensor.may_pull(first - below, mises), "{tensor:?}");
                    assert!(tensor.may_shear(shear - below, mises), "{tensor:?}");
                    assert!(!tensor.may_pull(first + above, mises), "{tensor:?}");
                    assert!(!tensor.may_shear(shear + above, mises), "{tensor:?}");
                }
            }
        }
    }
}
