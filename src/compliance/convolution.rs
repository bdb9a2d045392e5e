//! Discrete convolution by FFT (DC-FFT): displacement from pressure, exact up to rounding for any
//! pressure on the grid, without periodic images.
//!
//! Liu, Wang & Liu, Wear 243 (2000) 101, doi:10.1016/S0043-1648(00)00427-0.

use std::fmt;
use std::ops::Range;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use ndarray::{Array2, ArrayRef2};

use crate::error::{Error, Result, all_finite, same_shape};
use crate::model::grid::Window;
use crate::numerics::clock::Stopwatch;
use crate::numerics::fft::{EvenSpectrum, PaddedTransform, TransformMemory};
use crate::numerics::layout::slice;
use crate::numerics::parallel::{Lease, Pool, Threads, check_memory, memory_of};

mod addition;
mod periodic;

use addition::AdditionMemory;
pub(crate) use addition::{Addition, RowWeights, length, pair};
pub(crate) use periodic::{Approximation, MARGIN};

/// The convolution of a pressure with influence coefficients, planned once and applied many times.
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
    additions: Vec<Addition>,
    /// c of each cell in C order, where c p is added to the displacement.
    springs: Option<Arc<[f64]>>,
    /// s of each cell, by which input and output are multiplied.
    scale: Option<Arc<[f64]>>,
    /// Operators that are no convolutions.
    beside: Vec<Arc<dyn Beside>>,
    /// Memory that is not in use, shared with companions of this convolution.
    idle: Pool<ConvolutionMemory>,
    /// Time spent by this convolution and its companions.
    clock: Arc<Clock>,
}

/// A symmetric operator beside a convolution, which is none itself: what it adds to the displacement.
pub(crate) trait Beside: fmt::Debug + Send + Sync {
    /// Adds the displacement under a `pressure` that is zero outside the rows `occupied`.
    fn add(
        &self,
        pressure: &[f64],
        occupied: Range<usize>,
        displacement: &mut [f64],
        threads: &Threads,
    );

    /// The operator on a `window` of its cells.
    fn on_window(&self, window: &Window, threads: &Threads) -> Arc<dyn Beside>;

    /// What it adds to the displacement of `cell` under unit pressure on the cell `loaded`.
    fn entry(&self, cell: [usize; 2], loaded: [usize; 2]) -> f64;

    /// Cost of an application, as that of [`Convolution::work`].
    fn work(&self) -> f64;
}

/// Sum of the time spent in convolutions \[ns\].
#[derive(Debug, Default)]
struct Clock(AtomicU64);

impl Clock {
    fn during<R>(&self, work: impl FnOnce() -> R) -> R {
        let start = Stopwatch::start();
        let result = work();
        self.0.fetch_add(start.elapsed().as_nanos() as u64, Ordering::Relaxed);
        result
    }
}

/// Memory for one application of a convolution at a time. When it is dropped, the convolution keeps the
/// memory for the next workspace.
#[derive(Debug)]
pub struct Workspace(Lease<ConvolutionMemory>);

/// Memory of the transforms, and of each operator that is added.
#[derive(Debug, Default)]
struct ConvolutionMemory {
    fft: TransformMemory,
    added: Vec<AdditionMemory>,
    scaled: Vec<f64>,
}

impl Convolution {
    /// Plans the convolution with `coefficients` (nx, ny), given at offsets ≥ 0, on `threads`
    /// threads; `None` stands for all threads of the machine, or fewer where `NACRE_NUM_THREADS` is set.
    ///
    /// # Errors
    /// Where a coefficient is not finite, the shape is empty, `threads` is 0, or there is too little memory.
    pub fn plan(coefficients: &ArrayRef2<f64>, threads: Option<usize>) -> Result<Self> {
        Self::plan_on(coefficients, Arc::new(Threads::new(threads)?))
    }

    pub(crate) fn plan_on(coefficients: &ArrayRef2<f64>, threads: Arc<Threads>) -> Result<Self> {
        Self::plan_repeated(coefficients, [false; 2], threads)
    }

    /// Plans the convolution of pressures that repeat along directions that are `periodic`, with coefficients of the
    /// period, C\[n − i\] = C\[i\].
    pub(crate) fn plan_repeated(
        coefficients: &ArrayRef2<f64>,
        periodic: [bool; 2],
        threads: Arc<Threads>,
    ) -> Result<Self> {
        let shape = [coefficients.nrows(), coefficients.ncols()];
        if coefficients.is_empty() {
            return Err(Error::Shape { name: "coefficients", expected: [1, 1], found: shape });
        }
        all_finite("coefficients", coefficients)?;
        check_memory(shape, Self::memory(shape))?;
        let transform = PaddedTransform::plan_repeated(shape, periodic, &threads);
        Ok(Self::with(coefficients, transform, &threads, Pool::default(), Arc::default()))
    }

    fn with(
        coefficients: &ArrayRef2<f64>,
        transform: PaddedTransform,
        threads: &Arc<Threads>,
        idle: Pool<ConvolutionMemory>,
        clock: Arc<Clock>,
    ) -> Self {
        let mut workspace = idle.lease();
        transform.reserve(&mut workspace.fft);
        let spectrum =
            clock.during(|| transform.even_spectrum(coefficients, &mut workspace.fft, threads));
        drop(workspace);
        Self {
            shape: [coefficients.nrows(), coefficients.ncols()],
            self_influence: coefficients[[0, 0]],
            transform,
            spectrum: Arc::new(spectrum),
            threads: Arc::clone(threads),
            additions: Vec::new(),
            springs: None,
            scale: None,
            beside: Vec::new(),
            idle,
            clock,
        }
    }

    /// This convolution on other threads, with the same spectrum.
    pub(crate) fn on_threads(&self, threads: &Arc<Threads>) -> Self {
        Self {
            transform: self.transform.on_threads(threads),
            spectrum: Arc::clone(&self.spectrum),
            threads: Arc::clone(threads),
            additions: self.additions.clone(),
            springs: self.springs.clone(),
            scale: self.scale.clone(),
            beside: self.beside.clone(),
            idle: Pool::default(),
            clock: Arc::default(),
            ..*self
        }
    }

    /// This convolution with the threads, the memory and the clock of `other`.
    pub(crate) fn sharing_with(&self, other: &Self) -> Self {
        Self {
            idle: other.idle.clone(),
            clock: Arc::clone(&other.clock),
            ..self.on_threads(&other.threads)
        }
    }

    /// A convolution with other `coefficients`, which repeats along directions that are `periodic`, and shares threads, memory and clock with this one.
    /// Windows and coarser grids have such companions.
    pub(crate) fn companion(&self, coefficients: &ArrayRef2<f64>, periodic: [bool; 2]) -> Self {
        let shape = [coefficients.nrows(), coefficients.ncols()];
        let transform = PaddedTransform::plan_repeated(shape, periodic, &self.threads);
        Self::with(
            coefficients,
            transform,
            &self.threads,
            self.idle.clone(),
            Arc::clone(&self.clock),
        )
    }

    /// This convolution plus `additions`, each for as many rows as the convolution has, and no shorter ones.
    pub(crate) fn plus(self, additions: Vec<Addition>) -> Self {
        Self { additions, ..self }
    }

    /// This convolution with springs, whose compliances (nx, ny) \[m/Pa\] are those of the cells in C order.
    pub(crate) fn on_springs(self, springs: &[f64]) -> Self {
        Self { springs: Some(springs.into()), ..self }
    }

    /// This convolution with operators beside it, on the same cells.
    pub(crate) fn with_beside(self, beside: Vec<Arc<dyn Beside>>) -> Self {
        Self { beside, ..self }
    }

    /// The mean compliance of the springs \[m/Pa\].
    pub(crate) fn mean_spring(&self) -> f64 {
        let springs = self.springs.as_ref();
        springs.map_or(0.0, |springs| springs.iter().sum::<f64>() / springs.len() as f64)
    }

    /// What all but the coefficients contributes to the displacement of `cell` under unit pressure on the cell `loaded`.
    pub(crate) fn added(&self, cell: [usize; 2], loaded: [usize; 2]) -> f64 {
        let distance = cell[1].abs_diff(loaded[1]);
        let additions = self.additions.iter();
        let added: f64 = additions.map(|added| added.entry([cell[0], loaded[0]], distance)).sum();
        let beside: f64 = self.beside.iter().map(|beside| beside.entry(cell, loaded)).sum();
        let own = self.springs.as_ref().filter(|_| cell == loaded);
        added + beside + own.map_or(0.0, |springs| springs[cell[0] * self.shape[1] + cell[1]])
    }

    /// [`Convolution::companion`] for a `window`, with the part of the additions, the springs and the operators beside there.
    pub(crate) fn on_window(&self, coefficients: &ArrayRef2<f64>, window: &Window) -> Self {
        let additions = self.additions.iter();
        let additions = additions.map(|a| a.on_rows(window[0].clone())).collect();
        let springs =
            self.springs.as_deref().map(|springs| copied_slice(springs, self.shape[1], window));
        let beside =
            self.beside.iter().map(|beside| beside.on_window(window, &self.threads)).collect();
        let within = self.companion(coefficients, [false; 2]).plus(additions);
        Self { springs: springs.map(Into::into), beside, ..within }
    }

    /// Cost of an application, in arbitrary units: points of the padded mesh times their logarithm.
    pub(crate) fn work(&self) -> f64 {
        self.transform.work() + self.beside.iter().map(|beside| beside.work()).sum::<f64>()
    }

    /// Bytes of a plan for data of `shape`, with one workspace.
    pub(crate) fn memory(shape: [usize; 2]) -> u64 {
        // Half spectra of the rows, of complex numbers, and a quarter of the kernel's.
        memory_of(shape, 3)
    }

    /// Shape (nx, ny) of pressure and displacement.
    pub fn shape(&self) -> [usize; 2] {
        self.shape
    }

    /// Displacement of a loaded cell per unit of its own pressure.
    pub(crate) fn self_influence(&self) -> f64 {
        self.self_influence + self.mean_spring()
    }

    pub(crate) fn own_threads(&self) -> &Threads {
        &self.threads
    }

    /// Number of threads that apply this convolution.
    pub fn threads(&self) -> usize {
        self.threads.count()
    }

    /// Time spent so far in this convolution, and in those that solves derive from it, on planning
    /// spectra, transforms and products \[s\]. Times of concurrent applications are added.
    pub fn seconds(&self) -> f64 {
        1e-9 * self.clock.0.load(Ordering::Relaxed) as f64
    }

    /// Memory for [`Convolution::apply_into`].
    pub fn workspace(&self) -> Workspace {
        Workspace(self.idle.lease())
    }

    /// Displacement (nx, ny) \[m\] under `pressure` (nx, ny) \[Pa\].
    ///
    /// # Errors
    /// As [`Convolution::apply_into`].
    pub fn apply(&self, pressure: &ArrayRef2<f64>) -> Result<Array2<f64>> {
        check_memory(self.shape, memory_of(self.shape, 1))?;
        let mut displacement = Array2::zeros(self.shape);
        self.apply_into(pressure, &mut displacement, &mut self.workspace())?;
        Ok(displacement)
    }

    /// Writes the displacement under `pressure` into `displacement`, as [`Convolution::apply`] computes
    /// it. Where both arrays are in C order, memory is allocated at the first use of the workspace only.
    ///
    /// # Errors
    /// Where an array does not have the shape of the convolution, a pressure is not finite, or there is too little memory.
    pub fn apply_into(
        &self,
        pressure: &ArrayRef2<f64>,
        displacement: &mut ArrayRef2<f64>,
        workspace: &mut Workspace,
    ) -> Result<()> {
        same_shape("pressure", pressure, self.shape)?;
        same_shape("displacement", displacement, self.shape)?;
        all_finite("pressure", pressure)?;
        if let missing @ 1.. = self.transform.missing(&workspace.0.fft) {
            check_memory(self.shape, missing)?;
        }
        let input = slice(pressure);
        if let Some(output) = displacement.as_slice_mut() {
            self.apply_slices(&input, output, workspace);
        } else {
            let mut output = vec![0.0; input.len()];
            self.apply_slices(&input, &mut output, workspace);
            displacement.iter_mut().zip(output).for_each(|(d, o)| *d = o);
        }
        match displacement.iter().all(|d| d.is_finite()) {
            true => Ok(()),
            false => Err(Error::Inconsistent(
                "pressure must be in units in which its products with the coefficients do not overflow",
            )),
        }
    }

    /// Applies the convolution to slices in C order.
    pub(crate) fn apply_slices(
        &self,
        input: &[f64],
        output: &mut [f64],
        workspace: &mut Workspace,
    ) {
        self.apply_rows(0..self.shape[0], input, output, workspace);
    }

    /// [`Convolution::apply_slices`] for an `input` that is zero outside the rows `occupied`; only these are read.
    pub(crate) fn apply_rows(
        &self,
        occupied: Range<usize>,
        input: &[f64],
        output: &mut [f64],
        workspace: &mut Workspace,
    ) {
        let memory = &mut *workspace.0;
        self.transform.reserve(&mut memory.fft);
        self.clock.during(|| {
            let cells = occupied.start * self.shape[1]..occupied.end * self.shape[1];
            let input = match &self.scale {
                Some(scale) => {
                    memory.scaled.clear();
                    memory.scaled.resize(input.len(), 0.0);
                    let scaled = memory.scaled[cells.clone()].iter_mut();
                    let products = input[cells.clone()].iter().zip(&scale[cells.clone()]);
                    scaled.zip(products).for_each(|(out, (p, s))| *out = p * s);
                    &memory.scaled
                }
                None => input,
            };
            let (transform, input_rows) = (&self.transform, (input, occupied.clone()));
            transform.convolve_into(
                &self.spectrum,
                input_rows,
                output,
                &mut memory.fft,
                &self.threads,
            );
            memory
                .added
                .resize_with(self.additions.len().max(memory.added.len()), Default::default);
            for (addition, memory) in self.additions.iter().zip(&mut memory.added) {
                addition.respond(input, occupied.clone(), memory, &self.threads);
            }
            for (addition, memory) in self.additions.iter().zip(&memory.added) {
                addition.add_rows(0, self.shape[1], output, memory);
            }
            if let Some(springs) = &self.springs {
                let products = input[cells.clone()].iter().zip(&springs[cells.clone()]);
                output[cells].iter_mut().zip(products).for_each(|(u, (p, c))| *u += p * c);
            }
            for beside in &self.beside {
                beside.add(input, occupied.clone(), output, &self.threads);
            }
            if let Some(scale) = &self.scale {
                output.iter_mut().zip(scale.iter()).for_each(|(u, s)| *u *= s);
            }
        });
    }
}

/// The values in a window of rows of so many `columns`.
fn copied_slice(values: &[f64], columns: usize, window: &Window) -> Vec<f64> {
    let rows = window[0].clone().map(|i| i * columns);
    rows.flat_map(|at| &values[at + window[1].start..at + window[1].end]).copied().collect()
}

#[cfg(test)]
mod tests {
    use crate::compliance::convolution::Convolution;
    use crate::error::Result;
    use ndarray::Array2;

    fn field([nx, ny]: [usize; 2]) -> Array2<f64> {
        Array2::from_shape_fn((nx, ny), |(i, j)| ((7 * i + 3 * j + i * j) % 11) as f64 - 4.0)
    }

    /// An input of which only some rows are occupied has the bits of a whole application, on two threads and on one.
    #[test]
    fn occupied_rows_give_the_bits_of_all() -> Result<()> {
        for shape in [[1, 9], [7, 1], [23, 18], [150, 130], [230, 150]] {
            let convolution = Convolution::plan(&field(shape), Some(2))?;
            let [nx, ny] = shape;
            let occupied = nx / 3..nx - nx / 4;
            let mut input = field(shape);
            for (i, mut row) in input.rows_mut().into_iter().enumerate() {
                if !occupied.contains(&i) {
                    row.fill(0.0);
                }
            }
            let alone = Convolution::plan(&field(shape), Some(1))?;
            let whole = alone.apply(&input)?.into_raw_vec_and_offset().0;
            let input = input.into_raw_vec_and_offset().0;
            let mut u = vec![f64::NAN; nx * ny];
            convolution.apply_rows(occupied, &input, &mut u, &mut convolution.workspace());
            let same = |(a, b): (&f64, &f64)| a.to_bits() == b.to_bits();
            assert!(u.iter().zip(&whole).all(same), "{shape:?}");
        }
        Ok(())
    }
}
