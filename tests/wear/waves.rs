//! Waves of pressure on layered bodies fade as they wear: p̂(s) = p̂(0) exp(−κs/c11), and in steps by the factor of each rule.
//!
//! `tests/data/wear/wave_decay.json`, whose c11 are of a boundary-value system of its own.

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use nacre::wear::{Wear, WearScheme, WearSession, WearState, WearSteps};
use nacre::{
    Contact, Elastic, Grid, HalfSpace, HeightMap, Layer, Method, Motion, Options, Result, Setup,
    influence::influence_coefficients,
};
use ndarray::Array2;
use serde_json::Value;

use crate::support::checks::{apart, largest};
use crate::support::reference::{list, number, read};

/// Mean pressure of the waves on stacks.
const SMALL: f64 = 1e-6;

/// All states of a history.
pub(crate) fn states<S: nacre::Surface>(mut session: WearSession<S>) -> Result<Vec<WearState>> {
    let mut states = Vec::new();
    while let Some(state) = session.advance(&mut |_| std::ops::ControlFlow::Continue(()))? {
        states.push(state);
    }
    Ok(states)
}

fn stack(layers: &Value) -> Result<HalfSpace> {
    let layers = layers.as_array().expect("a list of layers");
    let (base, coats) = layers.split_last().expect("a substrate");
    let material = |one: &Value| Elastic::new(number(one, "E"), number(one, "nu"));
    let coats: Result<Vec<Layer>> =
        coats.iter().map(|one| Layer::new(material(one)?, number(one, "h"))).collect();
    HalfSpace::new(material(base)?, coats?)
}

/// Factors by which a wave fades in `steps` equal steps to κs = 1, by both rules: Euler's first.
fn factors(body: &HalfSpace, wavenumber: f64, c11: f64, steps: usize) -> Result<[f64; 2]> {
    let length = TAU / wavenumber;
    let grid = Grid::new([4, 16], [length / 4.0, length])?.periodic([true; 2])?;
    let coefficients = influence_coefficients(body, &grid, Method::Spectral)?.into_shared();
    let setup = Setup::default().with_coefficients(coefficients);
    let plan = Arc::new(Contact::plan(body, grid, setup)?);
    let wave = Array2::from_shape_fn([4, 16], |(_, j)| (TAU * (j as f64 + 0.5) / 16.0).cos());
    // The wave of pressure is a fifth of the mean, and all of it is so small that no layer is through.
    let shape = HeightMap::new(&wave * (0.2 * SMALL * c11), grid.spacing())?;
    let motion = Motion::load(SMALL * grid.cell_area() * 64.0);
    let mut factors = [0.0; 2];
    for (factor, scheme) in factors.iter_mut().zip([WearScheme::Euler, WearScheme::Trapezoidal]) {
        let wear = Wear::sliding([vec![1.0], vec![0.0]], 1.0)
            .with_steps(WearSteps::Ends((1..=steps).map(|k| k as f64 / steps as f64).collect()))
            .with_scheme(scheme)
            .with_options(Options::default().with_tolerance(1e-13));
        let states =
            states(WearSession::new(Arc::clone(&plan), shape.clone(), motion, wear, false)?)?;
        let amplitude = |state: &WearState| (&state.solution.pressure * &wave).sum() / 32.0;
        near!(amplitude(&states[0]), 0.2 * SMALL, 1e-10);
        *factor = amplitude(&states[steps]) / amplitude(&states[0]);
    }
    Ok(factors)
}

#[test]
fn waves_on_stacks_fade_by_the_factors_of_both_rules() -> Result<()> {
    const STEPS: usize = 10;
    let reference = read("wear/wave_decay.json");
    let stacks = list(&reference, "stacks");
    for row in list(&reference, "rows") {
        let number = |key| number(row, key);
        let [c11, wavenumber] = ["c11", "wavenumber"].map(number);
        let body = stack(&stacks[number("stack") as usize])?;
        let [euler, trapezoidal] = factors(&body, wavenumber, c11, STEPS)?;
        // The wave itself is known to 1e-10 of its start.
        below!((euler - number("euler_10_steps_at_1")).abs(), 1e-10, row);
        let z = 0.5 / (STEPS as f64 * c11);
        below!((trapezoidal - ((1.0 - z) / (1.0 + z)).powi(STEPS as i32)).abs(), 1e-10, row);
    }
    Ok(())
}

/// Errors against exp(−κs/c11) fall as the first and the second power of the steps' length.
#[test]
fn orders_of_the_rules_are_one_and_two() -> Result<()> {
    let body: HalfSpace = Elastic::new(1.0, 0.3)?.into();
    let (wavenumber, c11) = (1.0, 1.82);
    let exact = (-1.0_f64 / c11).exp();
    let errors = |steps| {
        Ok::<_, nacre::Error>(factors(&body, wavenumber, c11, steps)?.map(|f| (f - exact).abs()))
    };
    let ([a, b], [c, d]) = (errors(8)?, errors(16)?);
    // The next power is a tenth of it: 1/(8 c11).
    near!((a / c).log2(), 1.0, 0.05);
    near!((b / d).log2(), 2.0, 0.01);
    Ok(())
}

/// The stated error of the pressure holds, and is at most 20 times the true one: of a wave that fades by exp(−κs/c11), between a
/// hundredth of the amplitude and e⁻³ of it.
#[test]
fn stated_errors_are_those_of_waves() -> Result<()> {
    let body: HalfSpace = Elastic::new(1.0, 0.3)?.into();
    let grid = Grid::new([4, 16], [PI, TAU])?.periodic([true; 2])?;
    let coefficients = influence_coefficients(&body, &grid, Method::Spectral)?.into_shared();
    let setup = Setup::default().with_coefficients(coefficients);
    let plan = Arc::new(Contact::plan(&body, grid, setup)?);
    let wave = Array2::from_shape_fn([4, 16], |(_, j)| (TAU * (j as f64 + 0.5) / 16.0).cos());
    let c11 = 1.82;
    let shape = HeightMap::new(&wave * (0.2 * c11), grid.spacing())?;
    let motion = Motion::load(grid.cell_area() * 64.0);
    for scheme in [WearScheme::Euler, WearScheme::Trapezoidal] {
        for end in [0.1, 1.0, 3.0] {
            for count in [0, 1, 2, 3, 5, 8, 20] {
                let distance = end * c11;
                let mut wear = Wear::sliding([vec![1.0], vec![0.0]], distance);
                (wear.scheme, wear.options.tolerance) = (scheme, 1e-13);
                if count > 0 {
                    let part = |k: i32| distance * f64::from(k) / f64::from(count);
                    wear.steps = WearSteps::Ends((1..=count).map(part).collect());
                }
                let session =
                    WearSession::new(Arc::clone(&plan), shape.clone(), motion, wear, false)?;
                let states = states(session)?;
                let last = states.last().expect("a state");
                let due = &wave * (0.2 * (-end).exp()) + 1.0;
                let error = apart(&last.solution.pressure, &due) / largest(&due);
                let stated = last.step_error;
                assert!(error < stated, "{scheme:?} {end} {count}: {error:e} {stated:e}");
                assert!(stated < 20.0 * error, "{scheme:?} {end} {count}: {error:e} {stated:e}");
            }
        }
    }
    Ok(())
}

/// Explicit steps blow up beyond 2 λ/κ, where λ is the compliance of the shortest wave. Of 100 times that, Euler's step leaves
/// 1/201 of the wave, and the trapezoidal rule turns it round: the state says that it rings.
#[test]
fn no_step_is_too_long() -> Result<()> {
    let body: HalfSpace = Elastic::new(1.0, 0.3)?.into();
    let (wavenumber, c11) = (PI * 8.0, 1.82 / (PI * 8.0));
    let length = TAU / wavenumber;
    let grid = Grid::new([4, 16], [length / 4.0, length])?.periodic([true; 2])?;
    let coefficients = influence_coefficients(&body, &grid, Method::Spectral)?.into_shared();
    let setup = Setup::default().with_coefficients(coefficients);
    let plan = Arc::new(Contact::plan(&body, grid, setup)?);
    let wave = Array2::from_shape_fn([4, 16], |(_, j)| (TAU * (j as f64 + 0.5) / 16.0).cos());
    let shape = HeightMap::new(&wave * (0.2 * c11), grid.spacing())?;
    let motion = Motion::load(grid.cell_area() * 64.0);
    let step = 100.0 * 2.0 * c11;
    for scheme in [WearScheme::Euler, WearScheme::Trapezoidal] {
        let wear = Wear::sliding([vec![1.0], vec![0.0]], 4.0 * step)
            .with_steps(WearSteps::Ends((1..=4).map(|k| f64::from(k) * step).collect()))
            .with_scheme(scheme)
            .with_options(Options::default().with_tolerance(1e-13));
        let states =
            states(WearSession::new(Arc::clone(&plan), shape.clone(), motion, wear, false)?)?;
        let amplitude = |k: usize| (&states[k].solution.pressure * &wave).sum() / 32.0;
        let factor = if scheme == WearScheme::Euler { 1.0 / 201.0 } else { -99.0 / 101.0 };
        below!((amplitude(1) - 0.2 * factor).abs(), 1e-10);
        assert_eq!(states[3].rings, scheme == WearScheme::Trapezoidal);
        assert!(states.iter().all(|state| state.solution.pressure.iter().all(|p| *p < 1.5)));
    }
    Ok(())
}
