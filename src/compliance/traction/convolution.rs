//! Tractions to displacements, and the preconditioner of their inverse.

use std::f64::consts::PI;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use ndarray::{Array2, Axis, Slice};

use super::{TractionCoefficients, of_pair};
use crate::compliance::convolution::MARGIN;
use crate::compliance::datum::Datum;
use crate::compliance::response::{Body, Compliance, alpha_compliance};
use crate::error::Result;
use crate::model::grid::Grid;
use crate::numerics::fft::{PaddedTransform, ParitySpectrum, Term, TransformMemory};
use crate::numerics::parallel::Threads;
use crate::numerics::recent::Recent;

/// Tangential behaviour of two bodies on a grid, planned once.
#[derive(Debug)]
pub(crate) struct Tangential {
    grid: Grid,
    bodies: Vec<Body>,
    /// Coefficients, with the data.
    coefficients: TractionCoefficients,
    /// The data of line contact for tractions along x and along y.
    data: [Datum; 2],
    threads: Arc<Threads>,
    /// Windows that were used last.
    windows: Recent<[usize; 2], TangentialWindow>,
}

impl Tangential {
    pub(crate) fn plan(
        body: &Body,
        counterbody: Option<&Body>,
        grid: &Grid,
        threads: &Arc<Threads>,
    ) -> Result<Self> {
        let mut coefficients = of_pair(body, counterbody, grid, threads)?;
        let bodies: Vec<Body> = std::iter::once(body).chain(counterbody).cloned().collect();
        let long = bodies.iter().filter_map(|body| body.half_space());
        let long = long.map(|body| Compliance::of_substrate(body.substrate()));
        let [x, y] = long.fold([0.0; 2], |[x, y], long| [x + long.ct, y + long.c22]);
        let homogeneous = bodies.iter().all(|body| body.lengths().is_none());
        let datum = |compliance: f64, along: &mut Array2<f64>| -> Result<Datum> {
            let datum = Datum::of_compliance(compliance, homogeneous, grid, (along, &[]), threads)?;
            *along = datum.moved(std::mem::take(along), grid);
            Ok(datum)
        };
        Ok(Self {
            grid: *grid,
            bodies,
            data: [datum(x, &mut coefficients.xx)?, datum(y, &mut coefficients.yy)?],
            coefficients,
            threads: Arc::clone(threads),
            windows: Recent::default(),
        })
    }

    /// By how much the data of line contact raise displacements and shifts under these forces.
    pub(crate) fn raised(&self, forces: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|axis| self.data[axis].raise() * forces[axis])
    }

    /// An error where the `motion` along an axis, a shift or a creepage, cannot be prescribed.
    ///
    /// # Errors
    /// [`Error::TangentialDatum`] where the operator is not positive definite with the datum of the grid.
    pub(crate) fn check_prescribed(&self, motion: &'static str, axis: usize) -> Result<()> {
        self.data[axis].check_motion(motion)
    }

    /// Whether tractions move the surfaces apart, and pressure moves them along each other.
    pub(crate) fn is_coupled(&self) -> bool {
        let TractionCoefficients { zx, zy, .. } = &self.coefficients;
        zx.iter().chain(zy).any(|c| *c != 0.0)
    }

    /// The operators on a window of `shape` cells.
    pub(crate) fn window(&self, shape: [usize; 2]) -> Arc<TangentialWindow> {
        self.windows.get_or_make(shape, || self.planned(shape))
    }

    fn planned(&self, shape: [usize; 2]) -> TangentialWindow {
        let threads = &self.threads;
        let transform = PaddedTransform::plan(shape, threads);
        let periodic =
            PaddedTransform::plan_margin(shape, MARGIN, [self.grid.is_line(), false], threads);
        let mut workspace = transform.workspace();
        periodic.reserve(&mut workspace);
        let mut spectrum = |on: &PaddedTransform, all: &Array2<f64>, odd: [bool; 2]| {
            let rows = all.slice_axis(Axis(0), Slice::from(..shape[0]));
            let part = rows.slice_axis(Axis(1), Slice::from(..shape[1]));
            on.parity_spectrum(&part, odd, &mut workspace, threads)
        };
        let TractionCoefficients { xx, xy, yy, zx, zy } = &self.coefficients;
        let mut both = |on: &PaddedTransform| {
            let kernels = [(xx, [false, false]), (xy, [true, true]), (yy, [false, false])];
            kernels.map(|(all, odd)| spectrum(on, all, odd))
        };
        let [inverted, [along, cross, across]] = [&periodic, &transform].map(&mut both);
        let inverse = periodic.inverse_spectra(inverted, self.inverse(&periodic, shape));
        let coupling = self.is_coupled().then(|| {
            [(zx, [true, false]), (zy, [false, true])]
                .map(|(all, odd)| spectrum(&transform, all, odd))
        });
        TangentialWindow {
            shape,
            xx: along,
            xy: cross,
            yy: across,
            own: [xx[[0, 0]], yy[[0, 0]]],
            ahead: self.ahead(),
            coupling,
            inverse,
            workspace: Mutex::new(workspace),
            transform,
            periodic,
            threads: Arc::clone(threads),
        }
    }

    /// α c11, α c22 and α c_t of the bodies together, for waves of the wavenumber `alpha`.
    pub(crate) fn waves(&self, alpha: f64) -> [f64; 3] {
        let half_spaces = self.bodies.iter().filter_map(|body| body.half_space());
        half_spaces
            .map(|body| alpha_compliance(body, alpha))
            .fold([0.0; 3], |[n, l, t], compliance| {
                [n + compliance.c11, l + compliance.c22, t + compliance.ct]
            })
    }

    /// Coefficients of a loaded cell less those of its neighbour along x, and along y, for tractions along both.
    fn ahead(&self) -> [[f64; 2]; 2] {
        let [nx, ny] = self.grid.shape();
        let [next_x, next_y] = [[1.min(nx - 1), 0], [0, 1.min(ny - 1)]];
        [next_x, next_y].map(|next| {
            let TractionCoefficients { xx, yy, .. } = &self.coefficients;
            [xx, yy].map(|c| c[[0, 0]] - c[next])
        })
    }

    /// Spectra of the inverse on the whole plane: α/(α c22) along the wave vector and α/(α c_t) across it, periodic.
    fn inverse(&self, periodic: &PaddedTransform, shape: [usize; 2]) -> [ParitySpectrum; 3] {
        let [dx, dy] = self.grid.spacing();
        let longest = (shape[0] as f64 * dx).max(shape[1] as f64 * dy);
        let least = PI / (2.0 * longest);
        let line = self.grid.is_line();
        periodic.spectra_of([[false, false], [true, true], [false, false]], |m, n| {
            let (m, n) = if line { (0.0, n / dy) } else { (m / dx, n / dy) };
            let alpha = m.hypot(n).max(least);
            let [_, along, across] = self.waves(alpha);
            let (along, across) = (alpha / along, alpha / across);
            let (c, s) = match m.hypot(n) {
                length if length > 0.0 => (m / length, n / length),
                _ => (0.5_f64.sqrt(), 0.5_f64.sqrt()),
            };
            // Two odd directions have the factor i² = −1.
            [
                c * c * along + s * s * across,
                -c * s * (along - across),
                s * s * along + c * c * across,
            ]
        })
    }
}

/// The operators on a window.
pub(crate) struct TangentialWindow {
    pub(crate) shape: [usize; 2],
    /// Displacements of a loaded cell along x and y per unit of its own traction.
    pub(crate) own: [f64; 2],
    /// As [`Tangential::ahead`] says, by the axis of the neighbour.
    pub(crate) ahead: [[f64; 2]; 2],
    transform: PaddedTransform,
    xx: ParitySpectrum,
    xy: ParitySpectrum,
    yy: ParitySpectrum,
    coupling: Option<[ParitySpectrum; 2]>,
    periodic: PaddedTransform,
    inverse: [ParitySpectrum; 3],
    workspace: Mutex<TransformMemory>,
    threads: Arc<Threads>,
}

impl std::fmt::Debug for TangentialWindow {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "TangentialWindow({:?})", self.shape)
    }
}

impl TangentialWindow {
    fn memory(&self) -> MutexGuard<'_, TransformMemory> {
        self.workspace.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Cells of the window.
    pub(crate) fn cells(&self) -> usize {
        self.shape[0] * self.shape[1]
    }

    /// u = K q. Fields of both components follow each other.
    pub(crate) fn displace(&self, q: &[f64], u: &mut [f64]) {
        let kernels = [&self.xx, &self.xy, &self.yy];
        self.both(&self.transform, kernels, q, u);
    }

    /// An approximate inverse of [`TangentialWindow::displace`], symmetric and positive.
    pub(crate) fn precondition(&self, u: &[f64], q: &mut [f64]) {
        self.both(&self.periodic, self.inverse.each_ref(), u, q);
    }

    fn both(
        &self,
        transform: &PaddedTransform,
        [xx, xy, yy]: [&ParitySpectrum; 3],
        input: &[f64],
        output: &mut [f64],
    ) {
        let term = |output, input, spectrum| Term { output, input, spectrum, sign: 1.0 };
        let terms = [term(0, 0, xx), term(0, 1, xy), term(1, 0, xy), term(1, 1, yy)];
        // Antiplane shear of a line contact is apart.
        let terms = if self.shape[0] == 1 { &[terms[0], terms[3]][..] } else { &terms };
        let (x, y) = input.split_at(self.cells());
        let (to_x, to_y) = output.split_at_mut(self.cells());
        let mut memory = self.memory();
        transform.reserve(&mut memory);
        transform.convolve_tensor(terms, &[x, y], &mut [to_x, to_y], &mut memory, &self.threads);
    }

    /// u_z of both bodies together, which opens the gap, under tractions.
    pub(crate) fn lift(&self, q: &[f64]) -> Vec<f64> {
        let mut lifted = vec![0.0; self.cells()];
        if let Some([zx, zy]) = &self.coupling {
            let term = |input, spectrum| Term { output: 0, input, spectrum, sign: 1.0 };
            let (x, y) = q.split_at(self.cells());
            self.transform.convolve_tensor(
                &[term(0, zx), term(1, zy)],
                &[x, y],
                &mut [&mut lifted],
                &mut self.memory(),
                &self.threads,
            );
        }
        lifted
    }

    /// Displacement along x and y under a pressure.
    pub(crate) fn spread(&self, pressure: &[f64]) -> Vec<f64> {
        let mut spread = vec![0.0; 2 * self.cells()];
        if let Some([zx, zy]) = &self.coupling {
            let term = |output, spectrum| Term { output, input: 0, spectrum, sign: -1.0 };
            let (x, y) = spread.split_at_mut(self.cells());
            self.transform.convolve_tensor(
                &[term(0, zx), term(1, zy)],
                &[pressure],
                &mut [x, y],
                &mut self.memory(),
                &self.threads,
            );
        }
        spread
    }
}
