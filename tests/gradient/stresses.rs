//! Derivatives of stresses equal differences of whole solves, whose stresses are those of uniform cells.

use nacre::gradient::{Measure, Output, StressOutput, StressPlace};
use nacre::{
    BodyParameter, Elastic, Grid, HalfSpace, Motion, Options, Paraboloid, Result, Section, Side,
    Solution, Stress, StressOptions, stress,
};
use ndarray::Array3;

use super::cases::linearised;
use super::kinks::refused;

use crate::support::settings::{plan, stack, tolerance};

const LOAD: f64 = 0.03;

/// Differences of solves of fourth order, and those of the kernels in a body's numbers.
const DIFFERENCE: f64 = 2e-6;

fn body() -> Result<HalfSpace> {
    stack(Elastic::new(1.0, 0.3)?, [[3.0, 0.25, 0.4]])
}

fn solve(body: &HalfSpace, load: f64) -> Result<Solution> {
    let grid = Grid::new([26, 24], [2.4, 2.4])?;
    let contact = plan(body, grid)?;
    let options = tolerance(1e-11);
    let ball = Paraboloid::new(9.0, 11.0)?;
    let motion = Motion::load(load).with_tilt([Some(0.002), None]);
    contact.solve(&ball, &motion, &options)
}

fn options(side: Side, section: Section, friction: f64) -> StressOptions {
    StressOptions::default()
        .with_side(side)
        .with_section(section)
        .with_friction(friction)
        .with_direction([1.0, 0.4])
}

fn field(body: &HalfSpace, load: f64, depth: f64, options: &StressOptions) -> Result<Stress> {
    let solution = solve(body, load)?;
    let plan = linearised(&solution, None)?;
    stress(body, solution.grid(), &plan.pressure(), &[depth], options)
}

fn richardson(step: f64, at: impl Fn(f64) -> Result<f64>) -> Result<f64> {
    let slope = |h: f64| -> Result<f64> { Ok((at(h)? - at(-h)?) / (2.0 * h)) };
    let (wide, narrow) = (slope(step)?, slope(0.5 * step)?);
    Ok(narrow + (narrow - wide) / 3.0)
}

fn gradient(output: StressOutput) -> Result<nacre::gradient::Gradient> {
    let solution = solve(&body()?, LOAD)?;
    let plan = linearised(&solution, None)?;
    let mut found = plan.gradients(&[Output::Stress(output)], None)?;
    Ok(found.remove(0))
}

#[test]
#[ignore = "slow"]
fn derivatives_of_stresses_at_points_equal_differences() -> Result<()> {
    let body = body()?;
    let at = [0.13, -0.21, 0.3];
    let axis = Section::Axis([at[0], at[1]]);
    let options = options(Side::Below, axis, 0.2);
    type Value = fn(&Stress) -> f64;
    let measures: [(Measure, Value); 5] = [
        (Measure::Component(0), |s| s.xx()[[0, 0, 0]]),
        (Measure::Component(5), |s| s.xz()[[0, 0, 0]]),
        (Measure::VonMises, |s| s.von_mises()[[0, 0, 0]]),
        (Measure::Principal(0), |s| s.principal()[0][[0, 0, 0]]),
        (Measure::MaxShear, |s| s.max_shear()[[0, 0, 0]]),
    ];
    for (measure, value) in measures {
        let output = StressOutput::new(measure, StressPlace::Point(at, Side::Below))
            .with_friction(0.2)
            .with_direction([1.0, 0.4]);
        let found = gradient(output)?;
        let exact = value(&field(&body, LOAD, at[2], &options)?);
        near!(found.value, exact, 1e-9, measure);
        let compare = |path: &str, theta: f64, expected: f64| {
            let slope = found.get(path).unwrap_or(f64::NAN);
            let error = (slope - expected).abs() * theta / exact.abs();
            below!(error, DIFFERENCE, measure, path);
        };
        let load = |step: f64| Ok(value(&field(&body, LOAD + step, at[2], &options)?));
        compare("load", LOAD, richardson(1e-4 * LOAD, load)?);
        for (one, path) in [
            (BodyParameter::Young(0), "body.layers[0].material.young"),
            (BodyParameter::Thickness(0), "body.layers[0].thickness"),
            (BodyParameter::Poisson(1), "body.substrate.poisson"),
        ] {
            let theta = body.value(one).unwrap_or(f64::NAN);
            let moved = |step: f64| {
                let body = body.with_value(one, theta + step)?;
                Ok(value(&field(&body, LOAD, at[2], &options)?))
            };
            compare(path, theta, richardson(2e-3 * theta, moved)?);
        }
        let friction = |step: f64| {
            let options = options.clone().with_friction(0.2 + step);
            Ok(value(&field(&body, LOAD, at[2], &options)?))
        };
        compare("friction", 0.2, richardson(1e-3, friction)?);
    }
    Ok(())
}

/// (1/β) ln mean e^{βσ}, with β the sharpness over the mean of order 32.
fn soft(values: &[Array3<f64>], sharpness: f64) -> f64 {
    let all = || values.iter().flatten();
    let count = all().count() as f64;
    let size = (all().map(|v| v.powi(32)).sum::<f64>() / count).powf(1.0 / 32.0);
    let beta = sharpness / size;
    (all().map(|v| (beta * v).exp()).sum::<f64>() / count).ln() / beta
}

#[test]
#[ignore = "slow"]
fn derivatives_of_soft_maxima_equal_differences() -> Result<()> {
    const SHARPNESS: f64 = 40.0;
    let body = body()?;
    let layer = StressPlace::Layer { layer: 0, depths: 3, sharpness: SHARPNESS };
    let interface =
        StressPlace::Interface { interface: 0, side: Side::Below, sharpness: SHARPNESS };
    let shear = |s: &Stress| (s.xz() * s.xz() + s.yz() * s.yz()).sqrt();
    type Planes<'a> = &'a dyn Fn(&HalfSpace) -> Vec<(f64, Side)>;
    let three: Planes = &|body| {
        let h = body.thickness();
        vec![(0.0, Side::Below), (0.5 * h, Side::Below), (h, Side::Above)]
    };
    let one: Planes = &|body| vec![(body.thickness(), Side::Below)];
    for (measure, place, planes) in
        [(Measure::VonMises, layer, three), (Measure::PlaneShear, interface, one)]
    {
        let found = gradient(StressOutput::new(measure, place))?;
        let values = |body: &HalfSpace, load: f64| -> Result<Vec<Array3<f64>>> {
            let fields = planes(body).into_iter().map(|(z, side)| {
                let field = field(body, load, z, &options(side, Section::Plane, 0.0))?;
                Ok(match measure {
                    Measure::VonMises => field.von_mises(),
                    _ => shear(&field),
                })
            });
            fields.collect()
        };
        let here = values(&body, LOAD)?;
        near!(found.value, soft(&here, SHARPNESS), 1e-9);
        let compare = |path: &str, theta: f64, expected: f64| {
            let slope = found.get(path).unwrap_or(f64::NAN);
            let error = (slope - expected).abs() * theta / found.value;
            below!(error, DIFFERENCE, path);
        };
        let load = |step: f64| Ok(soft(&values(&body, LOAD + step)?, SHARPNESS));
        compare("load", LOAD, richardson(1e-4 * LOAD, load)?);
        let h = body.thickness();
        let thickness = |step: f64| {
            let body = body.with_value(BodyParameter::Thickness(0), h + step)?;
            Ok(soft(&values(&body, LOAD)?, SHARPNESS))
        };
        compare("body.layers[0].thickness", h, richardson(2e-3 * h, thickness)?);
    }
    Ok(())
}

#[test]
fn a_repeated_principal_stress_is_refused() -> Result<()> {
    let grid = Grid::new([25, 25], [2.4, 2.4])?;
    let contact = plan(Elastic::new(1.0, 0.3)?, grid)?;
    let ball = Paraboloid::new(10.0, 10.0)?;
    let solution = contact.solve(&ball, &Motion::load(LOAD), &Options::default())?;
    let at = StressPlace::Point([0.0, 0.0, 0.3], Side::Below);
    let of = |measure| solution.gradient(&Output::Stress(StressOutput::new(measure, at)), None);
    refused(of(Measure::Principal(0)), "von Mises");
    assert!(of(Measure::VonMises)?.value > 0.0);
    Ok(())
}
