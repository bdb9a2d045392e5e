//! A body on a grid, planned: coefficients, their transform, and the coarser grids.

use std::borrow::Cow;
use std::sync::{Arc, OnceLock};

use ndarray::{ArcArray2, Array2, ArrayRef2};

use crate::compliance::convolution::{Addition, Beside, Convolution};
use crate::compliance::datum::Datum;
use crate::compliance::ends::Ends;
use crate::compliance::influence::{Method, coefficients_on};
use crate::compliance::response::{Body, refuse_free};
use crate::compliance::traction::Tangential;
use crate::contact::cascade::discretisation::Unresolved;
use crate::contact::cascade::{Level, coarse_means, halved, next_coarser_grid};
use crate::contact::options::Setup;
use crate::error::{Error, Result, all_finite, refuse_if, same_shape};
use crate::model::grid::Grid;
use crate::numerics::parallel::{Threads, check_memory};

/// Arrays of a solve, as many as there are on one cell at the same time. Measured: 135 bytes a cell in all
/// where the contact fills the grid, 151 where it tilts as well, 67 where it fills a ninth.
const ARRAYS: u64 = 18;

/// Those of them whose memory the plan does not keep for later solves. Measured: 46 bytes a cell.
const OWN_ARRAYS: u64 = 7;

/// Arrays that a hardness adds. Measured: 40 bytes a cell.
const YIELDING_ARRAYS: u64 = 5;

/// Arrays that free ends add to the plan and to each workspace. Measured: 68 bytes a cell.
const ENDS_ARRAYS: u64 = 9;

/// A body on a grid, planned once: influence coefficients and their transform.
///
/// A plan and a solve take up to 170 bytes a cell, with a hardness 210; a grid that does not fit into memory is refused
/// before it starts. Between solves a plan keeps the memory that they worked in: up to 130 bytes a cell.
///
/// ```
/// use nacre::{Contact, Elastic, Grid, Motion, Options, Paraboloid, Setup};
///
/// // Hertz: δ = (9 W² / 16 R E*²)^{1/3}
/// let contact = Contact::plan(Elastic::new(1.0, 0.0)?, Grid::new([64, 64], [4.0, 4.0])?, Setup::default())?;
/// let solution = contact.solve(&Paraboloid::new(1e3, 1e3)?, &Motion::load(1e-3), &Options::default())?;
/// let hertz = (9.0 * 1e-6 / (16.0 * 1e3_f64)).powf(1.0 / 3.0);
/// assert!((solution.approach / hertz - 1.0).abs() < 2e-3);
/// # Ok::<(), nacre::Error>(())
/// ```
#[derive(Debug)]
pub struct Contact {
    pub(super) body: Body,
    pub(super) grid: Grid,
    pub(super) setup: Setup,
    /// The grid and all coarser ones, from the finest on.
    pub(super) levels: Vec<Level>,
    pub(super) operator: Arc<PlannedOperator>,
    pub(super) datum: Datum,
    pub(super) unresolved: Unresolved,
    pub(super) ends: Ends,
    /// Operators of tractions, made when friction first needs them.
    pub(super) tangential: OnceLock<Arc<Tangential>>,
    /// The same bodies on cells of twice the length, planned when rolling first needs them.
    pub(super) halved: OnceLock<Arc<Self>>,
}

impl Contact {
    /// Plans contacts of `body` on `grid`.
    ///
    /// # Errors
    /// Given coefficients that do not suit the grid, no threads, or too little memory.
    pub fn plan(body: impl Into<Body>, grid: Grid, setup: Setup) -> Result<Self> {
        let body = body.into();
        if grid.is_periodic() != [true; 2] {
            for body in bodies(&body, &setup) {
                refuse_free(&**body, "bodies on a grid that is not periodic along x and along y")?;
            }
        }
        let ends = Ends::of(&bodies(&body, &setup));
        check_memory(grid.shape(), Self::memory(&grid, &ends))?;
        ends.check(&grid)?;
        refuse_if(
            ends.any() && grid.is_periodic()[0],
            "bodies must extend along x where the grid is periodic along x: leave out their ends",
        )?;
        let threads = Arc::new(Threads::new(setup.threads)?);
        let additions = ends.additions(&grid, &grid, &threads)?;
        let (coefficients, datum) = operator(&body, &setup, &grid, &additions, &threads)?;
        let convolution =
            Convolution::plan_repeated(&coefficients, grid.is_periodic(), Arc::clone(&threads))?;
        let both = bodies(&body, &setup);
        let operator = PlannedOperator {
            coefficients: Arc::new(coefficients),
            datum,
            additions,
            threads: Arc::clone(&threads),
        };
        let convolution = convolution.plus(operator.additions.clone());
        let mut levels = vec![Level::new(grid, &operator.coefficients, convolution, &both)];
        let mut finer = grid;
        while let Some(coarse) = next_coarser_grid(&finer)? {
            let coefficients = total_coefficients(&body, &setup, &coarse, &threads)?;
            let coefficients = datum.moved(coefficients, &coarse);
            let convolution = levels[0].convolution.companion(&coefficients, coarse.is_periodic());
            let convolution = convolution.plus(ends.additions(&coarse, &grid, &threads)?);
            levels.push(Level::new(coarse, &Arc::new(coefficients), convolution, &both));
            finer = coarse;
        }
        let unresolved = Unresolved::new(&both, &grid);
        Ok(Self {
            body,
            grid,
            setup,
            levels,
            operator: Arc::new(operator),
            datum,
            unresolved,
            ends,
            tangential: OnceLock::new(),
            halved: OnceLock::new(),
        })
    }

    /// The body that shapes are pressed into.
    pub fn body(&self) -> &Body {
        &self.body
    }

    /// The setup that was planned: counterbody, given coefficients and threads.
    pub fn setup(&self) -> &Setup {
        &self.setup
    }

    /// The grid.
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// The convolution with the influence coefficients of both bodies together. In a line contact whose
    /// coefficients are not positive definite with the datum of [`Grid::line`], it has a farther datum, which
    /// raises the displacement everywhere by the same; solutions have the datum of the grid.
    pub fn convolution(&self) -> &Convolution {
        &self.levels[0].convolution
    }

    /// The operators of tractions, made when they are first needed.
    ///
    /// # Errors
    /// Bodies without layers and substrate, and such with free ends.
    pub(crate) fn tangential(&self) -> Result<Arc<Tangential>> {
        if let Some(known) = self.tangential.get() {
            return Ok(Arc::clone(known));
        }
        refuse_if(self.ends.any(), crate::compliance::traction::FRICTION_NEEDS_ENDLESS_BODIES)?;
        refuse_if(
            self.grid.is_periodic() != [false; 2],
            "friction needs a grid that is not periodic: give a wider grid",
        )?;
        let counterbody = self.setup.counterbody.as_ref();
        let threads = Arc::new(Threads::new(Some(self.convolution().threads()))?);
        let new = Tangential::plan(&self.body, counterbody, &self.grid, &threads)?;
        Ok(Arc::clone(self.tangential.get_or_init(|| Arc::new(new))))
    }

    /// The same bodies on cells of twice the length, planned when they are first needed.
    ///
    /// # Errors
    /// As [`Contact::plan`].
    pub(crate) fn halved(&self) -> Result<Arc<Self>> {
        if let Some(known) = self.halved.get() {
            return Ok(Arc::clone(known));
        }
        let grid = self.grid.coarser([!self.grid.is_line(), true])?;
        let threads = Some(self.convolution().threads());
        let setup = Setup { threads, coefficients: None, ..self.setup.clone() };
        let new = Self::plan(self.body.clone(), grid, setup)?;
        Ok(Arc::clone(self.halved.get_or_init(|| Arc::new(new))))
    }

    /// This plan on other threads; all large arrays are shared.
    pub(super) fn on_threads(&self, threads: &Arc<Threads>) -> Self {
        let mut levels: Vec<Level> = Vec::new();
        for level in &self.levels {
            let convolution = match levels.first() {
                None => level.convolution.on_threads(threads),
                Some(finest) => level.convolution.sharing_with(&finest.convolution),
            };
            levels.push(level.with(convolution));
        }
        let operator = Arc::new(PlannedOperator {
            coefficients: Arc::clone(&self.operator.coefficients),
            additions: self.operator.additions.clone(),
            threads: Arc::clone(threads),
            ..*self.operator
        });
        Self { operator, ..self.with_levels(levels) }
    }

    /// This plan on springs of these compliances (nx, ny), with so many `grids` from the finest on; all large arrays, threads
    /// and memory are shared.
    pub(crate) fn on_springs(&self, springs: &Array2<f64>, grids: usize) -> Self {
        let finest = self.convolution();
        let mut springs = Cow::Borrowed(springs);
        let mut levels = Vec::new();
        for (number, level) in self.levels.iter().take(grids).enumerate() {
            if number > 0 {
                let halved = halved(self.levels[number - 1].grid());
                springs = Cow::Owned(coarse_means(&springs, halved));
            }
            levels.push(level.on_springs(&springs, finest));
        }
        self.with_levels(levels)
    }

    /// This plan with operators beside its convolution, without coarser grids: for solves from a given pressure. The stiffness
    /// of its solutions lacks the operators.
    pub(crate) fn with_beside(&self, beside: Vec<Arc<dyn Beside>>) -> Self {
        let (finest, level) = (self.convolution(), &self.levels[0]);
        let convolution = finest.sharing_with(finest).with_beside(beside);
        self.with_levels(vec![level.with(convolution)])
    }

    /// This plan with other levels of the same grids, from the finest on.
    pub(super) fn with_levels(&self, levels: Vec<Level>) -> Self {
        Self {
            body: self.body.clone(),
            grid: self.grid,
            setup: self.setup.clone(),
            levels,
            operator: Arc::clone(&self.operator),
            unresolved: self.unresolved,
            datum: self.datum,
            ends: self.ends.clone(),
            tangential: self.tangential.clone(),
            halved: OnceLock::new(),
        }
    }

    /// The influence coefficients that were given, changed by what exact ones change from the plan's bodies to `body` and
    /// the counterbody of a `setup`; `None` where none were given.
    ///
    /// # Errors
    /// As [`Contact::plan`].
    pub(crate) fn given_coefficients_of(
        &self,
        body: &Body,
        setup: &Setup,
    ) -> Result<Option<ArcArray2<f64>>> {
        let Some(given) = &self.setup.coefficients else { return Ok(None) };
        let exact = |body: &Body, setup: &Setup| {
            total_coefficients(body, setup, &self.grid, self.convolution().own_threads())
        };
        let change = exact(body, setup)? - &exact(&self.body, &self.setup)?;
        Ok(Some((change + given).into_shared()))
    }

    /// Calls `work`, a whole solve, on the plan's threads.
    pub(crate) fn run<R: Send>(&self, work: impl FnOnce() -> R + Send) -> R {
        let [nx, ny] = self.grid.shape();
        self.convolution().own_threads().run_inside(nx * ny, work)
    }

    /// Bytes that a plan with its coefficients, and the arrays of one solve take between free `ends`.
    fn memory(grid: &Grid, ends: &Ends) -> u64 {
        let of_ends = if ends.any() { ENDS_ARRAYS } else { 0 };
        Convolution::memory(grid.shape()) + array(grid) * (ARRAYS + of_ends)
    }

    /// Bytes of this plan and the arrays of one solve.
    pub(super) fn own_memory(&self) -> u64 {
        Self::memory(&self.grid, &self.ends)
    }

    /// Checks that there is memory for a solve, of surfaces that yield where they have a hardness. What the plan keeps was
    /// checked with it.
    ///
    /// # Errors
    /// Too little memory.
    pub(super) fn check_memory_of_solve(&self, yields: bool) -> Result<()> {
        let of_hardness = if yields { YIELDING_ARRAYS } else { 0 };
        check_memory(self.grid.shape(), array(&self.grid) * (OWN_ARRAYS + of_hardness))
    }
}

/// What a contact was solved with: its solutions share it, and files do not have it.
#[derive(Debug)]
pub(super) struct PlannedOperator {
    /// Coefficients of both bodies together, with the datum.
    pub(super) coefficients: Arc<Array2<f64>>,
    pub(super) datum: Datum,
    /// What free ends of bodies add.
    pub(super) additions: Vec<Addition>,
    pub(super) threads: Arc<Threads>,
}

impl PlannedOperator {
    /// The operator of a solution from a file, with coefficients at least at the offsets of `near` cells of its `grid`.
    ///
    /// # Errors
    /// As [`Contact::plan`].
    pub(super) fn anew(body: &Body, setup: &Setup, grid: &Grid, near: [usize; 2]) -> Result<Self> {
        let threads = Arc::new(Threads::new(setup.threads)?);
        let additions = Ends::of(&bodies(body, setup)).additions(grid, grid, &threads)?;
        let near = if setup.coefficients.is_some() { *grid } else { grid.of_offsets(near) };
        let (coefficients, datum) = operator(body, setup, &near, &additions, &threads)?;
        Ok(Self { coefficients: Arc::new(coefficients), datum, additions, threads })
    }
}

/// Bytes of an array of the cells of `grid`.
fn array(grid: &Grid) -> u64 {
    let [nx, ny] = grid.shape();
    8 * nx as u64 * ny as u64
}

/// The two bodies, or the one that is not rigid.
pub(super) fn bodies<'a>(body: &'a Body, setup: &'a Setup) -> Vec<&'a Body> {
    [Some(body), setup.counterbody.as_ref()].into_iter().flatten().collect()
}

/// Coefficients of body and counterbody together with which a contact on `grid` is solved beside the `additions` of
/// free ends, and their datum.
///
/// # Errors
/// [`Error::Indefinite`] where the coefficients show that they are not positive definite.
fn operator(
    body: &Body,
    setup: &Setup,
    grid: &Grid,
    additions: &[Addition],
    threads: &Arc<Threads>,
) -> Result<(Array2<f64>, Datum)> {
    let coefficients = match &setup.coefficients {
        Some(coefficients) => {
            check_coefficients(coefficients, grid)?;
            coefficients.to_owned()
        }
        None => total_coefficients(body, setup, grid, threads)?,
    };
    let datum = Datum::find(&bodies(body, setup), grid, (&coefficients, additions), threads)?;
    let coefficients = datum.moved(coefficients, grid);
    // No coefficient of a positive definite operator is larger than that of the loaded cell.
    let own = coefficients[[0, 0]];
    let larger = |c: &f64| c.abs() > own;
    if setup.coefficients.is_some() && (own <= 0.0 || coefficients.iter().any(larger)) {
        return Err(Error::Indefinite);
    }
    Ok((coefficients, datum))
}

/// Largest difference between given coefficients that are the same on a grid that repeats, relative to that of the loaded
/// cell: rounding.
const UNEVEN: f64 = 1e-9;

/// Checks given coefficients.
///
/// # Errors
/// Another shape than the grid, a coefficient that is not finite, and coefficients that do not repeat where the grid does.
pub(super) fn check_coefficients(coefficients: &ArrayRef2<f64>, grid: &Grid) -> Result<()> {
    same_shape("coefficients", coefficients, grid.shape())?;
    all_finite("coefficients", coefficients)?;
    let ([nx, ny], [along_x, along_y]) = (grid.shape(), grid.is_periodic());
    let image = |i: usize, n: usize, repeats: bool| if repeats { (n - i) % n } else { i };
    let uneven = |((i, j), c): ((usize, usize), &f64)| {
        let same = coefficients[[image(i, nx, along_x), image(j, ny, along_y)]];
        (c - same).abs() > UNEVEN * coefficients[[0, 0]].abs()
    };
    refuse_if(
        coefficients.indexed_iter().any(uneven),
        "coefficients must be the same at the offsets d and n - d along a direction in which a grid of n cells repeats",
    )
}

/// Exact influence coefficients of body and counterbody together.
fn total_coefficients(
    body: &Body,
    setup: &Setup,
    grid: &Grid,
    threads: &Threads,
) -> Result<Array2<f64>> {
    let mut coefficients = coefficients_on(&**body, grid, Method::Exact, threads)?;
    if let Some(counterbody) = &setup.counterbody {
        coefficients += &coefficients_on(&**counterbody, grid, Method::Exact, threads)?;
    }
    Ok(coefficients)
}
