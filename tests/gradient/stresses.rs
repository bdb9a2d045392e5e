//! Derivatives of stresses equal differences of whole solves, whose stresses are those of uniform cells.

use nacre::gradient::{LinearOptions, Linearisation, Measure, Output, StressOutput, StressPlace};
use nacre::{
    BodyParameter, Contact, Elastic, Grid, HalfSpace, Layer, Member, Motion, Options, Paraboloid,
    Result, Section, Setup, Side, Solution, Stress, StressOptions, stress,
};
use ndarray::Array3;

const LOAD: f64 = 0.03;

/// Differences of solves of fourth order, and those of the kernels in a body's numbers.
const DIFFERENCE: f64 = 2e-6;

fn body() -> Result<HalfSpace> {
    let coat = Layer::new(Elastic::new(3.0, 0.25)?, 0.4)?;
    HalfSpace::new(Elastic::new(1.0, 0.3)?, [coat])
}

fn solve(body: &HalfSpace, load: f64) -> Result<Solution> {
    let grid = Grid::new([26, 24], [2.4, 2.4])?;
    let contact = Contact::plan(body, grid, Setup::default())?;
    let options = Options {
        tolerance: 1e-11,
        ..Options::default()
    };
    let ball = Paraboloid::new(9.0, 11.0)?;
    contact.solve(
        &ball,
        &Motion {
            tilt: [Some(0.002), None],
            ..Motion::load(load)
        },
        &options,
    )
}

fn options(side: Side, section: Section, friction: f64) -> StressOptions {
    StressOptions {
        side,
        section,
        friction,
        direction: Some([1.0, 0.4]),
        ..StressOptions::default()
    }
}

fn field(body: &HalfSpace, load: f64, depth: f64, options: &StressOptions) -> Result<Stress> {
    let solution = solve(body, load)?;
    let plan = Linearisation::plan(
        &solution,
        None,
        &LinearOptions {
            tolerance: 1e-12,
            watch: None,
        },
    )?;
    stress(body, solution.grid(), &plan.pressure(), &[depth], options)
}

fn richardson(step: f64, at: impl Fn(f64) -> Result<f64>) -> Result<f64> {
    let slope = |h: f64| -> Result<f64> { Ok((at(h)? - at(-h)?) / (2.0 * h)) };
    let (wide, narrow) = (slope(step)?, slope(0.5 * step)?);
    Ok(narrow + (narrow - wide) / 3.0)
}

fn gradient(output: StressOutput) -> Result<nacre::gradient::Gradient> {
    let solution = solve(&body()?, LOAD)?;
    let plan = Linearisation::plan(
        &solution,
        None,
        &LinearOptions {
            tolerance: 1e-12,
            watch: None,
        },
    )?;
    let mut found = plan.gradients(&[Output::Stress(output)], None)?;
    Ok(found.remove(0))
}

#[test]
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
    let mut worst = 0.0_f64;
    for (measure, value) in measures {
        let output = StressOutput {
            friction: 0.2,
            direction: Some([1.0, 0.4]),
            ..StressOutput::new(measure, StressPlace::Point(at, Side::Below))
        };
        let found = gradient(output)?;
        let exact = value(&field(&body, LOAD, at[2], &options)?);
        assert!((found.value / exact - 1.0).abs() < 1e-9, "{measure:?}");
        let mut compare = |path: &str, theta: f64, expected: f64| {
            let slope = found.get(path).unwrap_or(f64::NAN);
            let error = (slope - expected).abs() * theta / exact.abs();
            println!("{measure:?} {path}: {slope:.8e} {expected:.8e} {error:.1e}");
            worst = worst.max(error);
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
            let options = StressOptions {
                friction: 0.2 + step,
                ..options.clone()
            };
            Ok(value(&field(&body, LOAD, at[2], &options)?))
        };
        compare("friction", 0.2, richardson(1e-3, friction)?);
    }
    assert!(worst < DIFFERENCE, "{worst:e}");
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
fn derivatives_of_soft_maxima_equal_differences() -> Result<()> {
    const SHARPNESS: f64 = 40.0;
    let body = body()?;
    let layer = StressPlace::Layer {
        layer: 0,
        depths: 3,
        sharpness: SHARPNESS,
    };
    let interface = StressPlace::Interface {
        interface: 0,
        side: Side::Below,
        sharpness: SHARPNESS,
    };
    let shear = |s: &Stress| {
        let mut found = s.xz().clone();
        found.zip_mut_with(s.yz(), |a, b| *a = a.hypot(*b));
        found
    };
    type Planes<'a> = &'a dyn Fn(&HalfSpace) -> Vec<(f64, Side)>;
    let three: Planes = &|body| {
        let h = body.thickness();
        vec![(0.0, Side::Below), (0.5 * h, Side::Below), (h, Side::Above)]
    };
    let one: Planes = &|body| vec![(body.thickness(), Side::Below)];
    let mut worst = 0.0_f64;
    for (measure, place, planes) in [
        (Measure::VonMises, layer, three),
        (Measure::PlaneShear, interface, one),
    ] {
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
        assert!((found.value / soft(&here, SHARPNESS) - 1.0).abs() < 1e-9);
        let load = |step: f64| Ok(soft(&values(&body, LOAD + step)?, SHARPNESS));
        let expected = richardson(1e-4 * LOAD, load)?;
        let slope = found.get("load").unwrap_or(f64::NAN);
        worst = worst.max((slope - expected).abs() * LOAD / found.value);
        let h = body.thickness();
        let thickness = |step: f64| {
            let body = body.with_value(BodyParameter::Thickness(0), h + step)?;
            Ok(soft(&values(&body, LOAD)?, SHARPNESS))
        };
        let expected = richardson(2e-3 * h, thickness)?;
        let slope = found.get("body.layers[0].thickness").unwrap_or(f64::NAN);
        println!("{measure:?}: {slope:e} {expected:e}");
        worst = worst.max((slope - expected).abs() * h / found.value);
    }
    println!("largest difference {worst:.1e}");
    assert!(worst < DIFFERENCE, "{worst:e}");
    Ok(())
}

#[test]
fn a_repeated_principal_stress_is_refused() -> Result<()> {
    let grid = Grid::new([25, 25], [2.4, 2.4])?;
    let contact = Contact::plan(Elastic::new(1.0, 0.3)?, grid, Setup::default())?;
    let ball = Paraboloid::new(10.0, 10.0)?;
    let solution = contact.solve(&ball, &Motion::load(LOAD), &Options::default())?;
    let at = StressPlace::Point([0.0, 0.0, 0.3], Side::Below);
    let refused = solution.gradient(
        &Output::Stress(StressOutput::new(Measure::Principal(0), at)),
        None,
    );
    let message = refused.map_or_else(|error| error.to_string(), |found| panic!("{found:?}"));
    assert!(message.contains("von Mises"), "{message}");
    let smooth = StressOutput {
        member: Member::Body,
        ..StressOutput::new(Measure::VonMises, at)
    };
    assert!(solution.gradient(&Output::Stress(smooth), None)?.value > 0.0);
    Ok(())
}
