//! Bodies, settings and solves that differ from the defaults in one or two things.

use nacre::influence::{Method, influence_coefficients};
use nacre::{
    Algorithm, Body, Contact, Elastic, Grid, HalfSpace, Layer, Motion, Options, Result, Setup,
    Solution, Substrate, Surface,
};

pub(crate) fn steel() -> Result<Elastic> {
    Elastic::new(210e9, 0.3)
}

/// A layer of `ratio` times the modulus of its substrate, and of the same Poisson's ratio.
pub(crate) fn coated(substrate: Elastic, ratio: f64, thickness: f64) -> Result<HalfSpace> {
    let coat = Elastic::new(ratio * substrate.young(), substrate.poisson())?;
    HalfSpace::new(substrate, [Layer::new(coat, thickness)?])
}

/// Layers of these moduli, Poisson's ratios and thicknesses.
pub(crate) fn stack(
    substrate: impl Into<Substrate>,
    layers: impl IntoIterator<Item = [f64; 3]>,
) -> Result<HalfSpace> {
    let layer = |[young, poisson, h]: [f64; 3]| Layer::new(Elastic::new(young, poisson)?, h);
    let layers: Result<Vec<Layer>> = layers.into_iter().map(layer).collect();
    HalfSpace::new(substrate, layers?)
}

/// Options with this tolerance.
pub(crate) fn tolerance(tolerance: f64) -> Options {
    Options::default().with_tolerance(tolerance)
}

/// Options with this algorithm and tolerance.
pub(crate) fn by(algorithm: Algorithm, tolerance: f64) -> Options {
    Options::default().with_algorithm(algorithm).with_tolerance(tolerance)
}

/// A plan on so many threads.
pub(crate) fn threads(threads: usize) -> Setup {
    Setup::default().with_threads(threads)
}

/// A contact of one body whose coefficients are made by this method.
pub(crate) fn converted(
    body: impl Into<Body> + Clone,
    grid: Grid,
    method: Method,
) -> Result<Contact> {
    let coefficients = influence_coefficients(body.clone(), &grid, method)?.into_shared();
    Contact::plan(body, grid, Setup::default().with_coefficients(coefficients))
}

/// A plan against another body.
pub(crate) fn against(counterbody: impl Into<Body>) -> Setup {
    Setup::default().with_counterbody(counterbody)
}

/// A plan against another body, on one thread.
pub(crate) fn one_thread(counterbody: impl Into<Body>) -> Setup {
    against(counterbody).with_threads(1)
}

/// A contact of one body with all defaults.
pub(crate) fn plan(body: impl Into<Body>, grid: Grid) -> Result<Contact> {
    Contact::plan(body, grid, Setup::default())
}

/// A solution that is converged.
pub(crate) fn converged(
    contact: &Contact,
    shape: &dyn Surface,
    motion: &Motion,
    options: &Options,
) -> Result<Solution> {
    let solution = contact.solve(shape, motion, options)?;
    solution.require_converged(options.tolerance)
}

/// A solution that is converged to the default tolerance.
pub(crate) fn pressed(contact: &Contact, shape: &dyn Surface, motion: &Motion) -> Result<Solution> {
    converged(contact, shape, motion, &Options::default())
}
