//! The quarter space, reduced to the half-space.
//!
//! A body x ≥ 0, z ≥ 0 with a free face x = 0 is loaded by a pressure p(x) cos ky on z = 0. Its surface is
//! displaced as that of a half-space under an even pressure P(|x|), which exceeds p by what it takes to keep
//! the face free: with T f the normal stress on one face from an even pressure f on the other,
//!
//! ```text
//! P = p + T²P        u = (1−ν)/πG ∫ [K0(k|x−x′|) + K0(k(x+x′))] P(x′) dx′
//! T(z,x) = −(2/π) { k z x²/R² [2 K1(kR)/R + k K0(kR)] − (1−2ν) k² ∫_z^∞ K0(k√(x²+t²)) dt }        R² = x² + z²
//! ```
//!
//! after Hetényi, J. Appl. Mech. 37 (1970) 289, doi:10.1115/1.3408508, who iterates; that one linear equation
//! remains, and T in closed form, were derived here. With lengths in units of 1/k, one equation serves all k. It
//! is solved by Nyström's method on panels that are uniform in ln x.

use std::collections::HashMap;
use std::f64::consts::FRAC_2_PI;
use std::sync::{Arc, LazyLock, Mutex, OnceLock, PoisonError};

use ndarray::{Array1, Array2, Axis};
use spec_math::cephes64::{k0, k1};

use super::VANISHED;
use crate::numerics::dense::Factors;
use crate::numerics::quadrature::Rule;

/// Matrices that all materials share.
#[derive(Debug)]
struct Universal {
    /// T at ν = ½, and its derivative by 1 − 2ν, times the weights of the points.
    traction: [Array2<f64>; 2],
    /// The integral of even K0 over P given at the points.
    displacement: Array2<f64>,
}

static UNIVERSAL: LazyLock<Universal> = LazyLock::new(Universal::new);

impl Universal {
    fn new() -> Self {
        let mesh = &*MESH;
        let (points, weights) = (&mesh.points, &mesh.weights);
        let n = points.len();
        let direct = Array2::from_shape_fn((n, n), |(i, j)| {
            let (z, x) = (points[i], points[j]);
            let r = z.hypot(x);
            -FRAC_2_PI * z * (x / r).powi(2) * (2.0 * k1(r) / r + k0(r)) * weights[j]
        });
        let mut integral = Array2::zeros((n, n));
        // Between neighbouring points the integrand is nearly straight.
        let rule = Rule::gauss_legendre(6);
        for j in 0..n {
            let (mut sum, mut above) = (0.0, ENDS[1]);
            for i in (0..n).rev() {
                let (middle, half) = (0.5 * (above + points[i]), 0.5 * (above - points[i]));
                sum += rule.around(middle, half, |t| k0(points[j].hypot(t)));
                above = points[i];
                integral[[i, j]] = FRAC_2_PI * sum * weights[j];
            }
        }
        let mut displacement = Array2::zeros((n, n));
        for (i, mut row) in displacement.axis_iter_mut(Axis(0)).enumerate() {
            let own = i / POINTS;
            for panel in 0..PANELS {
                let columns = panel * POINTS..(panel + 1) * POINTS;
                if panel.abs_diff(own) > 1 {
                    for j in columns {
                        row[j] = even(points[i], points[j]) * weights[j];
                    }
                } else {
                    let near = near_panel(mesh, points[i], panel);
                    columns.zip(near).for_each(|(j, value)| row[j] = value);
                }
            }
        }
        Self { traction: [direct, integral], displacement }
    }
}

/// K0 of the source at x′ and of its mirror image.
fn even(x: f64, source: f64) -> f64 {
    k0((x - source).abs().max(f64::MIN_POSITIVE)) + k0(x + source)
}

/// Integrals of [`even`] times each Lagrange polynomial of a panel in which, or next to which, ξ lies: on
/// intervals that halve towards ξ.
fn near_panel(mesh: &Mesh, xi: f64, panel: usize) -> [f64; POINTS] {
    // The last interval is 3e-5 of the panel, and its quadrature errs by a hundredth of that.
    const HALVINGS: i32 = 15;
    let ([low, high], at) = (edges(panel), xi.ln());
    let rule = Rule::gauss_legendre(POINTS);
    let mut cuts = vec![low, high];
    for halving in 0..=HALVINGS {
        let distance = step() * f64::from(-halving).exp2();
        cuts.extend([at - distance, at + distance]);
    }
    cuts.push(at);
    cuts.retain(|cut| *cut >= low && *cut <= high);
    cuts.sort_by(f64::total_cmp);
    let mut sums = [0.0; POINTS];
    for pair in cuts.windows(2) {
        let (middle, half) = (0.5 * (pair[0] + pair[1]), 0.5 * (pair[1] - pair[0]));
        for (u, w) in rule.nodes(middle, half) {
            let weight = w * u.exp() * even(xi, u.exp());
            let polynomials = mesh.lagrange((2.0 * u - low - high) / (high - low));
            sums.iter_mut().zip(polynomials).for_each(|(sum, l)| *sum += weight * l);
        }
    }
    sums
}

/// A kernel as a sum of products, Σ_r f_r(ξ) g_r(ξ′): ξ is where it acts, ξ′ where the pressure is.
#[derive(Debug)]
pub(super) struct KernelProducts {
    pub(super) targets: Modes,
    pub(super) sources: Modes,
}

/// What a free face adds to the mirror image, for one Poisson's ratio: the displacement at ξ = kx under a unit
/// line load at ξ′ is
///
/// ```text
/// (1−ν)/πG [K0(|ξ−ξ′|) + K0(ξ+ξ′) + Σ_r φ_r(ξ) φ_r(ξ′)]
/// ```
///
/// The sum is symmetric and positive, and has some forty terms.
#[derive(Debug)]
pub(super) struct Reduction {
    /// φ
    pub(super) displacement: Modes,
    /// Excess of P over p on the surface, times 1/k.
    pub(super) surface: EndKernel,
    /// Q on the face, times 1/k.
    pub(super) face: EndKernel,
}

/// A kernel, and its sum of products, which stresses alone need.
#[derive(Debug)]
pub(super) struct EndKernel {
    values: Array2<f64>,
    products: OnceLock<KernelProducts>,
}

impl EndKernel {
    fn new(values: Array2<f64>) -> Self {
        Self { values, products: OnceLock::new() }
    }

    pub(super) fn products(&self) -> &KernelProducts {
        self.products.get_or_init(|| products(self.values.clone()))
    }
}

/// Terms of the sum that are left out, relative to its largest value.
const NEGLIGIBLE_TERM: f64 = 1e-11;

/// Reductions that are kept.
const KEPT: usize = 32;

impl Reduction {
    /// The reduction for a Poisson's ratio. It is kept for later use.
    pub(super) fn of(poisson: f64) -> Arc<Self> {
        static KNOWN: LazyLock<Mutex<HashMap<u64, Arc<Reduction>>>> = LazyLock::new(Mutex::default);
        let mut known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(reduction) = known.get(&poisson.to_bits()) {
            return Arc::clone(reduction);
        }
        if known.len() >= KEPT {
            known.clear();
        }
        let new = Arc::new(Self::new(poisson));
        known.insert(poisson.to_bits(), Arc::clone(&new));
        new
    }

    fn new(poisson: f64) -> Self {
        let mesh = &*MESH;
        let Universal { traction: [direct, integral], displacement } = &*UNIVERSAL;
        let traction = direct + &(integral * (1.0 - 2.0 * poisson));
        let squared = traction.dot(&traction);
        let identity = Array2::<f64>::eye(squared.nrows());
        let factors = Factors::new(identity - &squared);
        let kernel = |mut product: Array2<f64>| {
            for (mut column, weight) in product.axis_iter_mut(Axis(1)).zip(&mesh.weights) {
                column /= *weight;
            }
            product
        };
        // P − p = (1 − T²)⁻¹ T² p,  Q = (1 − T²)⁻¹ T p
        let excess = factors.solve(squared);
        let face = kernel(factors.solve(traction));
        let response = kernel(displacement.dot(&excess));
        // The response is symmetric. The lowest end of the mesh disturbs it least where the source is the farther one.
        let response =
            Array2::from_shape_fn(response.dim(), |(i, j)| response[[i.min(j), i.max(j)]]);
        Self {
            displacement: Modes::new(square_root(response)),
            surface: EndKernel::new(kernel(excess)),
            face: EndKernel::new(face),
        }
    }
}

/// φ with Σ_r φ_r φ_r equal to a `response` that is symmetric and positive: its Cholesky factor, with the largest
/// remaining pivot first.
fn square_root(mut response: Array2<f64>) -> Array2<f64> {
    let (first, n) = (first_reliable(), response.nrows());
    let largest = response[[first, first]];
    let mut modes: Vec<Array1<f64>> = Vec::new();
    loop {
        let pivot = (first..n).max_by(|&a, &b| response[[a, a]].total_cmp(&response[[b, b]]));
        let pivot = pivot.unwrap_or(first);
        let size = response[[pivot, pivot]];
        if size <= NEGLIGIBLE_TERM * largest || modes.len() == n {
            break;
        }
        let mut mode = response.column(pivot).to_owned() / size.sqrt();
        mode.iter_mut().take(first).for_each(|value| *value = 0.0);
        for i in first..n {
            for j in first..n {
                response[[i, j]] -= mode[i] * mode[j];
            }
        }
        modes.push(mode);
    }
    Array2::from_shape_fn((n, modes.len()), |(i, r)| modes[r][i])
}

/// A `kernel` as a sum of products, with the largest remaining entry as the next pivot.
fn products(mut kernel: Array2<f64>) -> KernelProducts {
    let (first, n) = (first_reliable(), kernel.nrows());
    let (mut targets, mut sources) = (Vec::new(), Vec::new());
    // Entries are weighted by ξ′, over which the kernel is integrated.
    let weight = |j: usize| MESH.points[j];
    let mut largest = None;
    while targets.len() < n {
        let entries = (first..n).flat_map(|i| (first..n).map(move |j| [i, j]));
        let size = |at: &[usize; 2]| (kernel[*at] * weight(at[1])).abs();
        let Some(pivot) = entries.max_by(|a, b| size(a).total_cmp(&size(b))) else {
            break;
        };
        let most = *largest.get_or_insert(size(&pivot));
        if size(&pivot) <= NEGLIGIBLE_TERM * most {
            break;
        }
        let target = kernel.column(pivot[1]).to_owned() / kernel[pivot];
        let source = kernel.row(pivot[0]).to_owned();
        for i in first..n {
            kernel.row_mut(i).scaled_add(-target[i], &source);
        }
        targets.push(target);
        sources.push(source);
    }
    let columns = |functions: Vec<Array1<f64>>| {
        let values = Array2::from_shape_fn((n, functions.len()), |(i, r)| functions[r][i]);
        Modes::new(values)
    };
    KernelProducts { targets: columns(targets), sources: columns(sources) }
}

/// Points of a panel.
pub(super) const POINTS: usize = 10;

/// Ends of the panels, kx. Below the lowest, P is taken as constant; above the highest, all kernels are below
/// 1e-19.
pub(super) const ENDS: [f64; 2] = [1e-11, VANISHED];

/// Panels from the lowest end to the highest, each longer than the one before by a factor of 2.5. With
/// 12 points and a factor of 2.3 displacements change by 1e-9 of the largest.
pub(super) const PANELS: usize = 32;

/// kx from which on the solution is independent of the lowest end, to 1e-9; smaller ones are taken as equal to it.
const RELIABLE: f64 = 1e-9;

/// Points along ln kx, and integrals over them.
#[derive(Debug)]
pub(super) struct Mesh {
    pub(super) points: Vec<f64>,
    pub(super) weights: Vec<f64>,
    /// Barycentric weights of a panel's points, and the points on (−1, 1).
    barycentric: Vec<f64>,
    local: Vec<f64>,
}

pub(super) fn step() -> f64 {
    (ENDS[1] / ENDS[0]).ln() / PANELS as f64
}

/// The mesh of all materials.
pub(super) static MESH: LazyLock<Mesh> = LazyLock::new(Mesh::new);

impl Mesh {
    fn new() -> Self {
        let rule = Rule::gauss_legendre(POINTS);
        let mut unit: Vec<(f64, f64)> = rule.nodes(0.0, 1.0).collect();
        unit.sort_by(|a, b| a.0.total_cmp(&b.0));
        let local: Vec<f64> = unit.iter().map(|(t, _)| *t).collect();
        let barycentric = local.iter().enumerate().map(|(q, t)| {
            let others = local.iter().enumerate().filter(|(other, _)| *other != q);
            1.0 / others.map(|(_, other)| t - other).product::<f64>()
        });
        let (mut points, mut weights) = (Vec::new(), Vec::new());
        for panel in 0..PANELS {
            let [low, high] = edges(panel);
            for (t, w) in &unit {
                let u = 0.5 * (low + high + t * (high - low));
                points.push(u.exp());
                weights.push(0.5 * w * (high - low) * u.exp());
            }
        }
        Self { barycentric: barycentric.collect(), points, weights, local }
    }

    /// Panel of kx = ξ, and the weights with which its points interpolate to ξ.
    fn interpolation(&self, xi: f64) -> (usize, [f64; POINTS]) {
        let place = (xi.max(RELIABLE) / ENDS[0]).ln() / step();
        let panel = (place as usize).min(PANELS - 1);
        (panel, self.lagrange(2.0 * (place - panel as f64) - 1.0))
    }

    /// Lagrange's polynomials of a panel's points at t on (−1, 1).
    pub(super) fn lagrange(&self, t: f64) -> [f64; POINTS] {
        if let Some(at) = self.local.iter().position(|x| (x - t).abs() < 1e-15) {
            return std::array::from_fn(|q| if q == at { 1.0 } else { 0.0 });
        }
        let terms: [f64; POINTS] =
            std::array::from_fn(|q| self.barycentric[q] / (t - self.local[q]));
        let sum: f64 = terms.iter().sum();
        terms.map(|term| term / sum)
    }
}

/// Ends of a panel, ln kx.
pub(super) fn edges(panel: usize) -> [f64; 2] {
    [panel, panel + 1].map(|k| ENDS[0].ln() + step() * k as f64)
}

/// Functions of ξ = kx, given at the points of the mesh.
#[derive(Debug)]
pub(super) struct Modes {
    /// Values: (points, functions).
    values: Array2<f64>,
    /// Integrals from 0 to each point, over ξ.
    means: Array2<f64>,
}

impl Modes {
    pub(super) fn new(values: Array2<f64>) -> Self {
        Self { means: means(&values), values }
    }

    pub(super) fn count(&self) -> usize {
        self.values.ncols()
    }

    /// The functions at ξ.
    pub(super) fn at(&self, xi: f64) -> Array1<f64> {
        let mut values = Array1::zeros(self.count());
        self.add(xi, 1.0, &mut values);
        values
    }

    /// `factor` times the integrals of the functions between two ξ.
    pub(super) fn integrals(&self, [low, high]: [f64; 2], factor: f64) -> Array1<f64> {
        let mut integrals = Array1::zeros(self.count());
        self.add_integrals(high, factor, &mut integrals);
        self.add_integrals(low, -factor, &mut integrals);
        integrals
    }

    /// Adds `factor` times the functions at ξ to `sums`.
    pub(super) fn add(&self, xi: f64, factor: f64, sums: &mut Array1<f64>) {
        interpolate(&self.values, xi, factor, sums);
    }

    /// Adds `factor` times the integrals of the functions from 0 to ξ to `sums`.
    fn add_integrals(&self, xi: f64, factor: f64, sums: &mut Array1<f64>) {
        let xi = xi.min(VANISHED);
        interpolate(&self.means, xi, factor * xi, sums);
    }
}

fn interpolate(values: &Array2<f64>, xi: f64, factor: f64, sums: &mut Array1<f64>) {
    if xi > VANISHED {
        return;
    }
    let (panel, weights) = MESH.interpolation(xi);
    for (q, weight) in weights.into_iter().enumerate() {
        sums.scaled_add(factor * weight, &values.row(panel * POINTS + q));
    }
}

/// First point of the first panel with a point that counts.
pub(super) fn first_reliable() -> usize {
    let first = MESH.points.iter().position(|xi| *xi >= RELIABLE);
    first.unwrap_or(0) / POINTS * POINTS
}

/// Integral of each φ from 0 to each point ξ, over ξ. Below the points that count, φ is constant.
fn means(modes: &Array2<f64>) -> Array2<f64> {
    let mesh = &*MESH;
    let mut means = Array2::zeros(modes.dim());
    let first = mesh.points.iter().position(|xi| *xi >= RELIABLE).unwrap_or(0) / POINTS;
    let start = edges(first)[0].exp();
    let rule = Rule::gauss_legendre(POINTS);
    let mut sum = modes.row(first * POINTS).to_owned() * start;
    for panel in first..PANELS {
        let [low, high] = edges(panel);
        let part = |from: f64, to: f64, sum: &mut Array1<f64>| {
            for (u, w) in rule.nodes(0.5 * (from + to), 0.5 * (to - from)) {
                let polynomials = mesh.lagrange((2.0 * u - low - high) / (high - low));
                for (q, l) in polynomials.into_iter().enumerate() {
                    sum.scaled_add(l * w * u.exp(), &modes.row(panel * POINTS + q));
                }
            }
        };
        let mut from = low;
        for q in 0..POINTS {
            let point = mesh.points[panel * POINTS + q];
            part(from, point.ln(), &mut sum);
            from = point.ln();
            means.row_mut(panel * POINTS + q).assign(&(&sum / point));
        }
        part(from, high, &mut sum);
    }
    means
}
