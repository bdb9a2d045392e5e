//! Discrete convolution by FFT (DC-FFT): displacement from pressure, exact for any pressure on the
//! grid, with no periodic images.
//!
//! Liu, Wang & Liu, Wear 243 (2000) 101.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

use ndarray::{Array2, ArrayRef2};

use crate::error::{Error, Result};
use crate::fft::{EvenSpectrum, PaddedTransform, Workspace as FftWorkspace};
use crate::parallel::Threads;
use crate::parallel::{Lease, Pool};

mod parts;

/// Influence coefficients, transformed once to be applied often.
///
/// ```text
/// u[i, j] = Σ_kl C[|i−k|, |j−l|] p[k, l]
/// ```
///
/// ```
/// use ndarray::array;
/// let coefficients = array![[1.0, 0.5], [0.25, 0.125]];
/// let convolution = nacre::Convolution::plan(&coefficients, Some(1))?;
/// let u = convolution.apply(&array![[1.0, 0.0], [0.0, 0.0]])?;
/// assert!((&u - &coefficients).iter().all(|d| d.abs() < 1e-15));
/// # Ok::<(), nacre::Error>(())
/// ```
#[derive(Debug)]
pub struct Convolution {
    shape: [usize; 2],
    self_influence: f64,
    transform: PaddedTransform,
    spectrum: Arc<EvenSpectrum>,
    threads: Arc<Threads>,
    /// Shared with its parts, as is the clock.
    idle: Pool<FftWorkspace>,
    clock: Arc<Clock>,
}

/// Time that was spent [ns].
#[derive(Debug, Default)]
struct Clock(AtomicU64);

impl Clock {
    fn during<R>(&self, work: impl FnOnce() -> R) -> R {
        let start = Instant::now();
        let result = work();
        self.add(start, 1);
        result
    }

    /// Work that as many threads as `among` do at once, each on a part.
    fn during_part(&self, among: usize, work: impl FnOnce()) {
        let start = Instant::now();
        work();
        self.add(start, among as u64);
    }

    fn add(&self, start: Instant, among: u64) {
        let spent = start.elapsed().as_nanos() as u64 / among;
        self.0.fetch_add(spent, Ordering::Relaxed);
    }
}

/// Memory for one application at a time, of a convolution or a part of it. When dropped, it is kept
/// for the next.
#[derive(Debug)]
pub struct Workspace(Lease<FftWorkspace>);

impl Convolution {
    /// Plans the convolution with `coefficients` (nx, ny), those of offsets ≥ 0, on `threads`
    /// threads (all of the machine's where `None`).
    ///
    /// # Errors
    /// Where a coefficient is not finite, the shape is empty, or `threads` is 0.
    pub fn plan(coefficients: &ArrayRef2<f64>, threads: Option<usize>) -> Result<Self> {
        Self::plan_on(coefficients, Arc::new(Threads::new(threads)?))
    }

    pub(crate) fn plan_on(coefficients: &ArrayRef2<f64>, threads: Arc<Threads>) -> Result<Self> {
        let shape = [coefficients.nrows(), coefficients.ncols()];
        if coefficients.is_empty() {
            return Err(Error::Shape {
                name: "coefficients",
                expected: [1, 1],
                found: shape,
            });
        }
        if let Some((index, _)) = coefficients.indexed_iter().find(|(_, c)| !c.is_finite()) {
            return Err(Error::NonFinite {
                name: "coefficients",
                index: [index.0, index.1],
            });
        }
        let transform = PaddedTransform::plan(shape, &threads);
        Ok(Self::with(
            coefficients,
            transform,
            &threads,
            Pool::default(),
            Arc::default(),
        ))
    }

    fn with(
        coefficients: &ArrayRef2<f64>,
        transform: PaddedTransform,
        threads: &Arc<Threads>,
        idle: Pool<FftWorkspace>,
        clock: Arc<Clock>,
    ) -> Self {
        let mut workspace = lease(&idle, &transform);
        let spectrum =
            clock.during(|| transform.even_spectrum(coefficients, &mut workspace.0, threads));
        Self {
            shape: [coefficients.nrows(), coefficients.ncols()],
            self_influence: coefficients[[0, 0]],
            transform,
            spectrum: Arc::new(spectrum),
            threads: Arc::clone(threads),
            idle,
            clock,
        }
    }

    /// The same convolution on other threads; it shares the spectrum.
    pub(crate) fn on_threads(&self, threads: &Arc<Threads>) -> Self {
        Self {
            transform: self.transform.on_threads(threads),
            spectrum: Arc::clone(&self.spectrum),
            threads: Arc::clone(threads),
            idle: Pool::default(),
            clock: Arc::default(),
            ..*self
        }
    }

    /// The same convolution with threads, memory and clock of `whole`, as its parts have them.
    pub(crate) fn beside(&self, whole: &Self) -> Self {
        Self {
            idle: whole.idle.clone(),
            clock: Arc::clone(&whole.clock),
            ..self.on_threads(&whole.threads)
        }
    }

    /// Convolution with part of the coefficients of this one, for a part of its grid.
    pub(crate) fn part(&self, coefficients: &ArrayRef2<f64>) -> Self {
        let shape = [coefficients.nrows(), coefficients.ncols()];
        let transform = PaddedTransform::plan(shape, &self.threads);
        Self::with(
            coefficients,
            transform,
            &self.threads,
            self.idle.clone(),
            Arc::clone(&self.clock),
        )
    }

    /// The periodic convolution with `coefficients`, on a mesh that is not padded, at a fifth of the
    /// cost; and its inverse, symmetric and positive definite.
    pub(crate) fn periodic(&self, coefficients: &ArrayRef2<f64>) -> [Self; 2] {
        // Exact coefficients have a positive transform, of which the smallest is above this.
        const FLOOR: f64 = 1e-6;
        let shape = [coefficients.nrows(), coefficients.ncols()];
        let transform = PaddedTransform::plan_periodic(shape, &self.threads);
        let idle = self.idle.clone();
        let periodic = Self::with(
            coefficients,
            transform,
            &self.threads,
            idle,
            Arc::clone(&self.clock),
        );
        let inverse = || (periodic.transform).inverse_spectrum(&periodic.spectrum, FLOOR);
        let inverse = periodic.clock.during(inverse);
        let inverse = Self {
            spectrum: Arc::new(inverse),
            transform: periodic.transform.clone(),
            threads: Arc::clone(&self.threads),
            idle: periodic.idle.clone(),
            clock: Arc::clone(&periodic.clock),
            ..periodic
        };
        [periodic, inverse]
    }

    /// Points of the padded mesh, times their logarithm: what an application costs.
    pub(crate) fn work(&self) -> f64 {
        self.transform.work()
    }

    /// Bytes that a plan of `shape` and its workspace hold.
    pub(crate) fn memory(shape: [usize; 2]) -> u64 {
        PaddedTransform::memory(shape)
    }

    /// Shape (nx, ny) of what it is applied to.
    pub fn shape(&self) -> [usize; 2] {
        self.shape
    }

    /// The coefficient of the loaded cell itself.
    pub(crate) fn self_influence(&self) -> f64 {
        self.self_influence
    }

    /// Those that it uses.
    pub(crate) fn own_threads(&self) -> &Threads {
        &self.threads
    }

    /// Threads that it uses.
    pub fn threads(&self) -> usize {
        self.threads.count()
    }

    /// Time that it took so far, with that of parts of it that solves make \[s\]: kernels, transforms
    /// and products. Of several at once it is the sum.
    pub fn seconds(&self) -> f64 {
        1e-9 * self.clock.0.load(Ordering::Relaxed) as f64
    }

    /// Memory for [`Convolution::apply_into`].
    pub fn workspace(&self) -> Workspace {
        lease(&self.idle, &self.transform)
    }

    /// Displacement (nx, ny) \[m\] under `pressure` (nx, ny) \[Pa\].
    ///
    /// # Errors
    /// Where the shape is another.
    pub fn apply(&self, pressure: &ArrayRef2<f64>) -> Result<Array2<f64>> {
        let mut displacement = Array2::zeros(self.shape);
        self.apply_into(pressure, &mut displacement, &mut self.workspace())?;
        Ok(displacement)
    }

    /// [`Convolution::apply`] into `displacement`. Allocates nothing where both arrays are in C
    /// order.
    ///
    /// # Errors
    /// Where a shape is another.
    pub fn apply_into(
        &self,
        pressure: &ArrayRef2<f64>,
        displacement: &mut ArrayRef2<f64>,
        workspace: &mut Workspace,
    ) -> Result<()> {
        for (name, found) in [
            ("pressure", pressure.dim()),
            ("displacement", displacement.dim()),
        ] {
            if [found.0, found.1] != self.shape {
                let found = [found.0, found.1];
                return Err(Error::Shape {
                    name,
                    expected: self.shape,
                    found,
                });
            }
        }
        let standard = pressure.as_standard_layout();
        let input = standard.as_slice().unwrap_or(&[]);
        if let Some(output) = displacement.as_slice_mut() {
            self.apply_slices(input, output, workspace);
        } else {
            let mut output = vec![0.0; input.len()];
            self.apply_slices(input, &mut output, workspace);
            displacement
                .iter_mut()
                .zip(output)
                .for_each(|(d, o)| *d = o);
        }
        Ok(())
    }

    /// The same on slices in C order, which the solver uses.
    pub(crate) fn apply_slices(
        &self,
        input: &[f64],
        output: &mut [f64],
        workspace: &mut Workspace,
    ) {
        let memory = &mut workspace.0;
        self.transform.fit(memory);
        self.clock.during(|| {
            self.transform
                .convolve_into(&self.spectrum, input, output, memory, &self.threads);
        });
    }
}

/// Idle memory, large enough for `transform`.
fn lease(idle: &Pool<FftWorkspace>, transform: &PaddedTransform) -> Workspace {
    let mut memory = idle.lease();
    transform.fit(&mut memory);
    Workspace(memory)
}
