//! Strains of the surface along itself under pressure: what changes in an elastic contact as its top layer gets thinner.
//!
//! A wave of pressure strains the surface along its wave vector alone, by e = −α c12 per unit pressure
//! ([`crate::compliance::response`]), so that with its direction φ
//!
//! ```text
//! ê_xx = e cos²φ p̂      ê_xy = e cos φ sin φ p̂      ê_yy = e sin²φ p̂
//! ```
//!
//! Waves that are short compared with the thickness strain it as a half-space of its material, by e∞ = −(1−2ν)/2G: half of
//! that is an even strain e∞ p/2 of each cell. The rest, with cos 2φ and sin 2φ, has the same mean square as the pressure, and where
//! wear is even it cancels a part c p² of the energy of the pressure, c = (1−2ν)²/4G. Uniform pressures on cells would lose some
//! of it at short waves, and worn layers all of their stiffness. So both are those of the pressure L p of the waves that cells
//! resolve,
//!
//! ```text
//! L(m, n) = [1 − sin⁸(m dx/2)] [1 − sin⁸(n dy/2)]
//! ```
//!
//! All else is that at the centres of cells under uniform pressures on cells:
//! exact, from the stresses there ([`crate::compliance::kernel`]) by Hooke's law, e_ij = \[(1+ν) s_ij − ν s_kk δ_ij\]/E with
//! s_ij = σ_ij + ν p δ_ij/(1−ν). On grids that repeat along x and y, all is that of the waves of the grid. Derived for nacre. As matrices,
//! all three are symmetric.

use std::f64::consts::{PI, TAU};
use std::sync::{Arc, Mutex, PoisonError};

use ndarray::{Array2, Array3, Axis, Slice};
use rayon::prelude::*;

use crate::compliance::kernel::COMPONENTS;
use crate::compliance::kernel::loads::{ODD, PressureStress};
use crate::compliance::kernel::plane::{CellPlan, CellSource, Kernel};
use crate::compliance::kernel::rectangle::under_pressure;
use crate::compliance::kernel::strip::LinePlan;
use crate::compliance::response::alpha_compliance;
use crate::compliance::response::interior::Place;
use crate::error::Result;
use crate::model::body::HalfSpace;
use crate::model::grid::Grid;
use crate::model::material::Elastic;
use crate::numerics::fft::{
    PaddedTransform, ParitySpectrum, Term, TransformMemory, fast_length, inverse_even, inverse_odd,
};
use crate::numerics::layout::slice_mut;
use crate::numerics::parallel::{Threads, check_memory};
use crate::numerics::recent::Recent;

/// Numbers of σ_xx, σ_xy and σ_yy among the components, in the order of the strains.
const STRESSES: [usize; 3] = [0, 3, 1];

/// Whether each strain is odd in x and in y.
const PARITIES: [[bool; 2]; 3] = [[false; 2], [true; 2], [false; 2]];

/// Mesh of the waves, in sides of the grid: images change the strain by 9.5 times the fourth power of the distance over theirs, at
/// the distance of a side by 0.2 %.
const MESH: usize = 8;

/// Weights of the cell itself and of those that are 1, 2, … cells away in the pressure that cells resolve: those of
/// 1 − sin⁸(m/2), along each direction.
const RESOLVED: [f64; 5] = [186.0 / 256.0, 56.0 / 256.0, -28.0 / 256.0, 8.0 / 256.0, -1.0 / 256.0];

const REACH: isize = RESOLVED.len() as isize;

/// Rows of coefficients that are computed together.
const ROWS: usize = 8;

/// Strains of the surface of a body on a grid under pressure, planned once: xx, xy and yy, or yy alone in a line contact.
#[derive(Debug)]
pub(crate) struct SurfaceStrain {
    /// \[1/Pa\] at offsets (i, j) ≥ 0 from a cell under a unit pressure.
    coefficients: Vec<Array2<f64>>,
    shape: [usize; 2],
    repeats: bool,
    /// Windows that were used last.
    windows: Recent<[usize; 2], StrainWindow>,
    /// Shared by all windows.
    memory: Arc<Mutex<TransformMemory>>,
}

impl SurfaceStrain {
    /// Plans the strains of `body` on a `grid` that repeats along both directions or along neither.
    ///
    /// # Errors
    /// Too little memory.
    pub(crate) fn plan(body: &HalfSpace, grid: &Grid, threads: &Threads) -> Result<Self> {
        let [repeats, along_y] = grid.is_periodic();
        debug_assert_eq!(repeats, along_y);
        let [nx, ny] = grid.shape();
        check_memory(grid.shape(), (8 * PARITIES.len() * nx * ny) as u64)?;
        let mut coefficients = match (repeats, grid.is_line()) {
            (true, _) => of_waves(body, grid, threads).to_vec(),
            (false, true) => vec![of_strips(body, grid)],
            (false, false) => of_cells(body, grid, threads).to_vec(),
        };
        if grid.is_line() {
            coefficients.drain(..coefficients.len() - 1);
        }
        Ok(Self {
            coefficients,
            shape: grid.shape(),
            repeats,
            windows: Recent::default(),
            memory: Arc::default(),
        })
    }

    /// Strains of a cell under a unit pressure on another, so many cells from it.
    pub(crate) fn entry(&self, [i, j]: [isize; 2]) -> Vec<f64> {
        let turned = (i < 0) != (j < 0);
        (self.coefficients.iter().zip(self.parities()))
            .map(|(all, [odd, _])| {
                let value = all[[i.unsigned_abs(), j.unsigned_abs()]];
                if *odd && turned { -value } else { value }
            })
            .collect()
    }

    /// Whether strains are those along y alone.
    pub(crate) fn is_line(&self) -> bool {
        self.coefficients.len() == 1
    }

    /// Weight of the pressure of a cell in what is resolved of another, so many cells from it.
    pub(crate) fn resolved(&self, offset: [isize; 2]) -> f64 {
        (0..2)
            .map(|k| {
                let reached = (1 - REACH..REACH).filter(|by| match self.repeats {
                    true => (offset[k] - by) % self.shape[k] as isize == 0,
                    false => offset[k] == *by,
                });
                reached.map(|by| RESOLVED[by.unsigned_abs()]).sum::<f64>()
            })
            .product()
    }

    fn parities(&self) -> &'static [[bool; 2]] {
        &PARITIES[PARITIES.len() - self.coefficients.len()..]
    }

    /// Whether strains repeat, so that windows are those of all cells.
    pub(crate) fn repeats(&self) -> bool {
        self.repeats
    }

    /// The operators on a window of `shape` cells.
    pub(crate) fn window(&self, shape: [usize; 2], threads: &Threads) -> Arc<StrainWindow> {
        self.windows.get_or_make(shape, || self.planned(shape, threads))
    }

    fn planned(&self, shape: [usize; 2], threads: &Threads) -> StrainWindow {
        let repeats = self.repeats;
        let transform = PaddedTransform::plan_repeated(shape, [repeats; 2], threads);
        let mut memory = self.memory.lock().unwrap_or_else(PoisonError::into_inner);
        transform.reserve(&mut memory);
        let spectra = (self.coefficients.iter().zip(self.parities()))
            .map(|(all, odd)| {
                let rows = all.slice_axis(Axis(0), Slice::from(..shape[0]));
                let part = rows.slice_axis(Axis(1), Slice::from(..shape[1]));
                transform.parity_spectrum(&part, *odd, &mut memory, threads)
            })
            .collect();
        StrainWindow { shape, repeats, transform, spectra, memory: Arc::clone(&self.memory) }
    }
}

/// The operators on a window.
pub(crate) struct StrainWindow {
    shape: [usize; 2],
    repeats: bool,
    transform: PaddedTransform,
    spectra: Vec<ParitySpectrum>,
    memory: Arc<Mutex<TransformMemory>>,
}

impl std::fmt::Debug for StrainWindow {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "StrainWindow({:?})", self.shape)
    }
}

impl StrainWindow {
    /// Number of strains: xx, xy and yy, or yy alone.
    pub(crate) fn strains(&self) -> usize {
        self.spectra.len()
    }

    /// L p of a field that is 0 outside the window.
    pub(crate) fn resolve(&self, values: &mut [f64]) {
        let [nx, ny] = self.shape;
        let mut line = Vec::new();
        for row in values.chunks_exact_mut(ny) {
            line.clear();
            let places = 1 - REACH..ny as isize + REACH - 1;
            line.extend(places.map(|k| self.inside(k, ny).map_or(0.0, |k| row[k])));
            row.fill(0.0);
            for (first, by) in (1 - REACH..REACH).enumerate() {
                add(row, RESOLVED[by.unsigned_abs()], &line[first..]);
            }
        }
        let before = values.to_vec();
        for (i, row) in values.chunks_exact_mut(ny).enumerate() {
            row.fill(0.0);
            for by in 1 - REACH..REACH {
                let Some(k) = self.inside(i as isize + by, nx) else { continue };
                add(row, RESOLVED[by.unsigned_abs()], &before[k * ny..]);
            }
        }
    }

    /// The place among `n`, in the first period where they repeat; `None` beyond.
    fn inside(&self, place: isize, n: usize) -> Option<usize> {
        match self.repeats {
            true => Some(place.rem_euclid(n as isize) as usize),
            false => usize::try_from(place).ok().filter(|place| *place < n),
        }
    }

    /// Cost of [`StrainWindow::strain`], or of its adjoint, in the unit of convolutions, which have two transforms.
    pub(crate) fn work(&self) -> f64 {
        0.5 * (1 + self.strains()) as f64 * self.transform.work()
    }

    /// E p: strains under a pressure, one field after the other.
    pub(crate) fn strain(&self, pressure: &[f64], strains: &mut [f64], threads: &Threads) {
        let terms = self.spectra.iter().enumerate();
        let terms = terms.map(|(output, spectrum)| Term { output, input: 0, spectrum, sign: 1.0 });
        let mut outputs: Vec<&mut [f64]> = strains.chunks_exact_mut(pressure.len()).collect();
        self.convolve(&terms.collect::<Vec<_>>(), &[pressure], &mut outputs, threads);
    }

    /// Eᵀ t of a symmetric tensor t: in each cell, e_ij t_ij summed over all cells, where it is under a unit pressure.
    pub(crate) fn adjoint(&self, tensor: &[f64], sums: &mut [f64], threads: &Threads) {
        let terms = self.spectra.iter().enumerate().map(|(input, spectrum)| {
            // Both elements xy and yx.
            let sign = if self.strains() == 3 && input == 1 { 2.0 } else { 1.0 };
            Term { output: 0, input, spectrum, sign }
        });
        let inputs: Vec<&[f64]> = tensor.chunks_exact(sums.len()).collect();
        self.convolve(&terms.collect::<Vec<_>>(), &inputs, &mut [sums], threads);
    }

    fn convolve(
        &self,
        terms: &[Term],
        inputs: &[&[f64]],
        outputs: &mut [&mut [f64]],
        threads: &Threads,
    ) {
        let mut memory = self.memory.lock().unwrap_or_else(PoisonError::into_inner);
        self.transform.reserve(&mut memory);
        self.transform.convolve_tensor(terms, inputs, outputs, &mut memory, threads);
    }
}

/// Adds a `weight` times `more` to `sum`, which may be shorter.
fn add(sum: &mut [f64], weight: f64, more: &[f64]) {
    sum.iter_mut().zip(more).for_each(|(sum, more)| *sum += weight * more);
}

/// Strains xx, xy and yy of stresses xx, xy and yy under a `pressure` on the same cell.
fn of_stresses(material: Elastic, pressure: f64, [xx, xy, yy]: [f64; 3]) -> [f64; 3] {
    let (young, nu) = (material.young(), material.poisson());
    let [xx, yy] = [xx, yy].map(|stress| stress + nu * pressure / (1.0 - nu));
    [(xx - nu * yy) / young, (1.0 + nu) * xy / young, (yy - nu * xx) / young]
}

fn of_cells(body: &HalfSpace, grid: &Grid, threads: &Threads) -> [Array2<f64>; 3] {
    let ([nx, ny], spacing, place) = (grid.shape(), grid.spacing(), Place::surface(body));
    let [lx, ly] = grid.size();
    // One per cent more than the diagonal, for rounding.
    let plan = threads.run(|| CellPlan::new(body, spacing, 1.0, 1.01 * lx.hypot(ly)));
    let kernel = threads.run(|| Kernel::new::<PressureStress>(&plan, &place));
    let half = spacing.map(|d| 0.5 * d);
    let first = |values: [f64; COMPONENTS]| {
        let mut ordered = [0.0; COMPONENTS];
        ordered[..3].copy_from_slice(&STRESSES.map(|k| values[k]));
        ordered
    };
    let source = CellSource {
        between: false,
        offsets: [nx, ny],
        spacing,
        depth: 0.0,
        odd: STRESSES.map(|k| ODD[k]),
        mean: |x: f64, y: f64| first(kernel.at::<PressureStress>([x, y], half)),
        point: |x: f64, y: f64| first(kernel.far::<PressureStress>(x, y)),
    };
    let mut rows = Array3::zeros((nx, 3, ny));
    threads.run(|| {
        let chunks = rows.axis_chunks_iter_mut(Axis(0), ROWS).into_par_iter().enumerate();
        chunks.for_each(|(chunk, mut part)| {
            let first = chunk * ROWS;
            source.rows(first..first + part.len_of(Axis(0)), &mut |i, k, row| {
                let mut components = part.index_axis_mut(Axis(0), i - first);
                components.row_mut(k).iter_mut().zip(row).for_each(|(to, from)| *to = *from);
            });
        });
    });
    let mut strains = of_resolved_waves(place.material, grid, threads);
    for i in 0..nx {
        for j in 0..ny {
            // Those of waves hold the homogeneous half-space, under the same pressure.
            let at = [i as f64 * spacing[0], j as f64 * spacing[1]];
            let homogeneous = first(under_pressure(place.material, half, at, 0.0));
            let stresses = [0, 1, 2].map(|k| rows[[i, k, j]] - homogeneous[k]);
            let values = of_stresses(place.material, 0.0, stresses);
            strains.iter_mut().zip(values).for_each(|(field, value)| field[[i, j]] += value);
        }
    }
    // What is odd vanishes on its axis, where rounding leaves a rest.
    (0..2).for_each(|axis| strains[1].index_axis_mut(Axis(axis), 0).fill(0.0));
    strains
}

/// The strain along y: in plane strain there is no other.
fn of_strips(body: &HalfSpace, grid: &Grid) -> Array2<f64> {
    let place = Place::surface(body);
    let values = LinePlan::new(body, grid, 1.0).coefficients(&place, None);
    let (nu, modulus) = (place.material.poisson(), place.material.plane_strain_modulus());
    Array2::from_shape_fn(grid.shape(), |(_, j)| {
        let pressure = if j == 0 { 1.0 } else { 0.0 };
        (values[j][STRESSES[2]] + nu * pressure / (1.0 - nu)) / modulus
    })
}

/// e∞: strain of short waves on a material, per unit pressure.
fn short_waves(material: Elastic) -> f64 {
    -(1.0 - 2.0 * material.poisson()) / (2.0 * material.shear())
}

/// L of waves (m, n) \[rad per cell\].
fn resolved(m: f64, n: f64) -> f64 {
    [m, n].map(|k| 1.0 - (0.5 * k).sin().powi(8)).iter().product()
}

/// Strains of a homogeneous half-space: e∞ p/2 in each cell, and what is resolved of the rest.
fn of_resolved_waves(material: Elastic, grid: &Grid, threads: &Threads) -> [Array2<f64>; 3] {
    let (shape, [dx, dy]) = (grid.shape(), grid.spacing());
    let mesh = shape.map(|n| 2 * fast_length(MESH * n / 2));
    let wave = |k: [usize; 2]| [0, 1].map(|axis| TAU * k[axis] as f64 / mesh[axis] as f64);
    let half = 0.5 * short_waves(material);
    let even = inverse_even(
        shape,
        mesh,
        |k, l| {
            let [m, n] = wave([k, l]);
            let [x, y] = [m / dx, n / dy];
            let cosine = match x.hypot(y) {
                alpha if alpha > 0.0 => (x * x - y * y) / (alpha * alpha),
                _ => mean_cosine([0, 1].map(|axis| PI / (mesh[axis] as f64 * [dx, dy][axis]))),
            };
            half * resolved(m, n) * cosine
        },
        threads,
    );
    let odd = inverse_odd(
        shape,
        mesh,
        |k, l| {
            let [m, n] = wave([k, l]);
            let [x, y] = [m / dx, n / dy];
            let square = x * x + y * y;
            if square > 0.0 { half * resolved(m, n) * 2.0 * x * y / square } else { 0.0 }
        },
        threads,
    );
    let mut strains = [even.clone(), odd, -even];
    strains[0][[0, 0]] += half;
    strains[2][[0, 0]] += half;
    strains
}

/// Mean of cos 2φ over the waves |m| < a, |n| < b: 2⟨cos²φ⟩ − 1 with ⟨cos²φ⟩ = \[a² atan(b/a) + ab − b² atan(a/b)\]/2ab.
fn mean_cosine([a, b]: [f64; 2]) -> f64 {
    (a * a * b.atan2(a) + a * b - b * b * a.atan2(b)) / (a * b) - 1.0
}

/// The response to a unit pressure on one cell that holds the waves of a grid which repeats alike. A uniform pressure strains
/// nothing.
fn of_waves(body: &HalfSpace, grid: &Grid, threads: &Threads) -> [Array2<f64>; 3] {
    let (shape, [dx, dy]) = (grid.shape(), grid.spacing());
    let short = short_waves(body.surface_material());
    let transform = PaddedTransform::plan_repeated(shape, [true; 2], threads);
    let spectra = transform.spectra_of(PARITIES, |m, n| {
        let [x, y] = [m / dx, n / dy];
        let alpha = x.hypot(y);
        if alpha <= 0.0 {
            return [0.0; 3];
        }
        let (c, s) = (x / alpha, y / alpha);
        let e = -alpha_compliance(body, alpha).c12;
        let turned = e - short * (1.0 - resolved(m, n));
        let cosine = 0.5 * turned * (c * c - s * s);
        // Two odd directions have the factor i² = −1.
        [0.5 * e + cosine, -turned * c * s, 0.5 * e - cosine]
    });
    let mut unit = Array2::zeros(shape);
    unit[[0, 0]] = 1.0;
    let mut strains = [0, 1, 2].map(|_| Array2::zeros(shape));
    let terms: Vec<Term> = (spectra.iter().enumerate())
        .map(|(output, spectrum)| Term { output, input: 0, spectrum, sign: 1.0 })
        .collect();
    let mut outputs = strains.each_mut().map(slice_mut);
    let mut memory = transform.workspace();
    transform.convolve_tensor(&terms, &[slice_mut(&mut unit)], &mut outputs, &mut memory, threads);
    strains
}
