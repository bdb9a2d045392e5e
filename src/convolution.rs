//! Discrete convolution by FFT (DC-FFT): displacement from pressure, exact for any pressure on the
//! grid, with no periodic images.
//!
//! Liu, Wang & Liu, Wear 243 (2000) 101.

use std::ops::Range;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

use ndarray::{Array2, ArrayRef2};

use crate::error::{Error, Result};
use crate::fft::{
    EvenSpectrum, HalfSpectra, PaddedTransform, Scratches, Workspace as FftWorkspace,
};
use crate::pool::{Lease, Pool};
use crate::threads::Threads;

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

    /// The first of the three parts of an application: what takes its rows, as they are made, and where
    /// they go.
    pub(crate) fn inwards<'a>(
        &'a self,
        workspace: &'a mut Workspace,
    ) -> (Inwards<'a>, HalfSpectra<'a>) {
        self.transform.fit(&mut workspace.0);
        let (rows, scratches) = self.transform.half_spectra(&mut workspace.0);
        let inwards = Inwards {
            convolution: self,
            scratches,
        };
        (inwards, rows)
    }

    /// The first part, of rows that are there.
    pub(crate) fn rows_in(&self, input: &[f64], workspace: &mut Workspace) {
        let input = (input, 0..self.shape[0]);
        self.some_rows_in(input, workspace);
    }

    fn some_rows_in(&self, input: (&[f64], Range<usize>), workspace: &mut Workspace) {
        let memory = &mut workspace.0;
        self.transform.fit(memory);
        let work = || self.transform.rows_in(input, memory, &self.threads);
        self.clock.during(work);
    }

    /// The second part, after all rows are in; returns the last, which gives them.
    pub(crate) fn outwards<'a>(&'a self, workspace: &'a mut Workspace) -> Outwards<'a> {
        self.some_outwards(0..self.shape[0], workspace)
    }

    fn some_outwards<'a>(
        &'a self,
        rows: Range<usize>,
        workspace: &'a mut Workspace,
    ) -> Outwards<'a> {
        let (transform, memory) = (&self.transform, &mut *workspace.0);
        self.clock
            .during(|| transform.columns_through(&self.spectrum, rows, memory, &self.threads));
        Outwards {
            convolution: self,
            memory,
        }
    }

    /// Both, of an input that is zero but in the rows of `occupied`, which alone are read.
    pub(crate) fn through<'a>(
        &'a self,
        input: &[f64],
        occupied: Range<usize>,
        workspace: &'a mut Workspace,
    ) -> Outwards<'a> {
        self.some_rows_in((input, occupied.clone()), workspace);
        self.some_outwards(occupied, workspace)
    }
}

/// Takes the rows of what a convolution is applied to.
pub(crate) struct Inwards<'a> {
    convolution: &'a Convolution,
    scratches: &'a Scratches,
}

impl Inwards<'_> {
    /// Takes some rows, of which these are the `halves`.
    pub(crate) fn rows(&self, values: &[f64], halves: HalfSpectra) {
        let Convolution {
            transform, clock, ..
        } = self.convolution;
        clock.during_part(transform.scratches(), || {
            transform.some_rows_in(values, halves, self.scratches);
        });
    }
}

/// Gives the rows of what a convolution made.
pub(crate) struct Outwards<'a> {
    convolution: &'a Convolution,
    memory: &'a FftWorkspace,
}

impl Outwards<'_> {
    /// Those from `first` on, as many as `values` have room for.
    pub(crate) fn rows(&self, first: usize, values: &mut [f64]) {
        let Convolution {
            transform, clock, ..
        } = self.convolution;
        clock.during_part(transform.scratches(), || {
            transform.rows_out(first, values, self.memory);
        });
    }
}

/// Idle memory, large enough for `transform`.
fn lease(idle: &Pool<FftWorkspace>, transform: &PaddedTransform) -> Workspace {
    let mut memory = idle.lease();
    transform.fit(&mut memory);
    Workspace(memory)
}

#[cfg(test)]
mod tests {
    use ndarray::Array2;

    use super::Convolution;
    use crate::error::Result;

    fn field([nx, ny]: [usize; 2]) -> Array2<f64> {
        Array2::from_shape_fn((nx, ny), |(i, j)| {
            ((7 * i + 3 * j + i * j) % 11) as f64 - 4.0
        })
    }

    /// In parts of any size, and where only some rows are occupied: the same bits as at once.
    #[test]
    fn rows_in_parts_give_the_same_bits() -> Result<()> {
        for shape in [[1, 9], [7, 1], [23, 18], [150, 130]] {
            let convolution = Convolution::plan(&field(shape), Some(2))?;
            let mut workspace = convolution.workspace();
            let [nx, ny] = shape;
            let occupied = nx / 3..nx - nx / 4;
            let mut input = field(shape);
            for (i, mut row) in input.rows_mut().into_iter().enumerate() {
                if !occupied.contains(&i) {
                    row.fill(0.0);
                }
            }
            let at_once = convolution.apply(&input)?.into_raw_vec_and_offset().0;
            let input = input.into_raw_vec_and_offset().0;
            let mut of_occupied = vec![f64::NAN; nx * ny];
            let outwards = convolution.through(&input, occupied, &mut workspace);
            outwards.rows(0, &mut of_occupied);
            let mut in_parts = vec![f64::NAN; nx * ny];
            for length in [1, 3, 8, 11] {
                let (inwards, mut halves) = convolution.inwards(&mut workspace);
                for part in input.chunks(length * ny) {
                    let (here, rest) = halves.split(part.len() / ny);
                    inwards.rows(part, here);
                    halves = rest;
                }
                let outwards = convolution.outwards(&mut workspace);
                for (k, part) in in_parts.chunks_mut(length * ny).enumerate() {
                    outwards.rows(k * length, part);
                }
                for values in [&of_occupied, &in_parts] {
                    let same = |(a, b): (&f64, &f64)| a.to_bits() == b.to_bits();
                    assert!(values.iter().zip(&at_once).all(same), "{shape:?} {length}");
                }
                in_parts.fill(f64::NAN);
            }
        }
        Ok(())
    }
}
