//! Derivatives equal central differences of whole solves, for steps within which the contact stays.

use nacre::gradient::{Output, Parameter};
use nacre::{Axis, Elastic, Grid, Member, Motion, Result, Solution, Surface};
use ndarray::Array2;

use super::cases::{Case, linearised};

use crate::support::settings::stack;

/// Differences of solves at two steps, by Richardson; compact contacts.
const COMPACT: f64 = 1e-6;

/// Cases compared, whose contacts must be the same at all four solves.
const CASES: u64 = 24;

fn outputs(case: &Case) -> Vec<Output> {
    let mut outputs = vec![
        Output::Approach,
        Output::Load,
        Output::PressureNorm(8.0),
        Output::ParticipationArea,
        Output::Pressure([0.05, 0.03]),
        Output::Displacement([0.3, -0.2]),
        Output::Gap([0.9, -0.8]),
    ];
    if !case.grid.is_line() {
        outputs.push(Output::Tilt(Axis::X));
        outputs.push(Output::Moment(Axis::Y));
    }
    outputs
}

/// The case with a parameter moved by a step; `None` for a parameter of the shape, which is tested by itself.
fn moved(case: &Case, parameter: &Parameter, step: f64) -> Option<Case> {
    let shape: Box<dyn Surface> = Box::new(Shared(case.shape.gaps(&case.grid).ok()?));
    let mut next = Case {
        body: case.body.clone(),
        counterbody: case.counterbody.clone(),
        grid: case.grid,
        shape,
        motion: case.motion,
    };
    let add = |value: &mut Option<f64>| *value = Some(value.unwrap_or(0.0) + step);
    match parameter {
        Parameter::Body(member, one, _) => {
            let body = match member {
                Member::Body => &mut next.body,
                Member::Counterbody => next.counterbody.as_mut()?,
            };
            *body = body.with_value(*one, body.value(*one)? + step).ok()?;
        }
        Parameter::Load => add(&mut next.motion.load),
        Parameter::Approach => add(&mut next.motion.approach),
        Parameter::Eccentricity(axis) => add(&mut next.motion.eccentricity[axis.index()]),
        Parameter::Moment(axis) => add(&mut next.motion.moment[axis.index()]),
        Parameter::Tilt(axis) => add(&mut next.motion.tilt[axis.index()]),
        _ => return None,
    }
    Some(next)
}

/// Gaps at the cells of one grid.
#[derive(Debug)]
struct Shared(Array2<f64>);

impl Surface for Shared {
    fn gap(&self, _: f64, _: f64) -> f64 {
        f64::NAN
    }
    fn gaps(&self, _: &Grid) -> Result<Array2<f64>> {
        Ok(self.0.clone())
    }
}

fn values(case: &Case, outputs: &[Output]) -> Result<(Vec<f64>, usize)> {
    let solution = case.solve(1e-11)?;
    let plan = linearised(&solution, None)?;
    let found = plan.gradients(outputs, Some(&[]))?;
    let cells = plan.pressure().iter().filter(|p| **p > 0.0).count();
    Ok((found.iter().map(|one| one.value).collect(), cells))
}

/// Compares the derivatives of a case with differences, less a part of each output that rounding of the solves leaves.
/// Counts the numbers compared and the parameters left out; `None` where the case has no solution.
fn compare(case: &Case, outputs: &[Output], rounding: f64) -> Result<Option<[usize; 2]>> {
    let Ok(solution) = case.solve(1e-11) else {
        return Ok(None);
    };
    let plan = linearised(&solution, None)?;
    let gradients = plan.gradients(outputs, None)?;
    let [mut compared, mut left] = [0, 0];
    for (k, parameter) in plan.parameters().iter().enumerate() {
        let path = parameter.to_string();
        let theta = value_of(case, parameter);
        let step = (0.25 * plan.valid_step(&path)?).min(1e-3 * theta.abs().max(1e-2));
        let mut at = Vec::new();
        for factor in [1.0, -1.0, 0.5, -0.5] {
            let case = moved(case, parameter, factor * step);
            at.extend(case.and_then(|case| values(&case, outputs).ok()));
        }
        // Poisson's ratio of 0.5 has no neighbour, and second orders may move a cell.
        if at.len() < 4 || at.iter().any(|(_, cells)| *cells != at[0].1) {
            left += 1;
            continue;
        }
        for (j, gradient) in gradients.iter().enumerate() {
            let (value, found) = (gradient.value.abs(), gradient.values[k].1);
            // The gap of a cell in contact stays 0.
            if matches!(outputs[j], Output::Gap(_)) && value < 1e-12 {
                below!(found.abs(), 1e-9);
                continue;
            }
            let [wide, narrow] = [(0, 1, 2.0), (2, 3, 1.0)]
                .map(|(a, b, width)| (at[a].0[j] - at[b].0[j]) / (width * step));
            let difference = narrow + (narrow - wide) / 3.0;
            let scale = found.abs().max(1e-3 * value / theta.abs().max(1e-2));
            // A tilt that symmetry keeps at 0 has a derivative of 0 and no scale.
            let error = (difference - found).abs() - rounding * value / step;
            assert!(
                error <= COMPACT * scale,
                "{path} {:?}: {found:e}, not {difference:e}, step {step:e}",
                outputs[j]
            );
            compared += 1;
        }
    }
    Ok(Some([compared, left]))
}

#[test]
#[ignore = "slow"]
fn derivatives_equal_differences_of_solves() -> Result<()> {
    let (mut compared, mut left) = (0, 0);
    for number in 0..CASES {
        let case = Case::new(number)?;
        if let Some([more, fewer]) = compare(&case, &outputs(&case), 3e-13)? {
            (compared, left) = (compared + more, left + fewer);
        }
    }
    assert!(compared > 800 && left * 4 < compared, "{compared} {left}");
    Ok(())
}

fn value_of(case: &Case, parameter: &Parameter) -> f64 {
    let motion: Motion = case.motion;
    let found = match parameter {
        Parameter::Body(Member::Body, one, _) => case.body.value(*one),
        Parameter::Body(Member::Counterbody, one, _) => {
            case.counterbody.as_ref().and_then(|body| body.value(*one))
        }
        Parameter::Load => motion.load,
        Parameter::Approach => motion.approach,
        Parameter::Eccentricity(axis) => motion.eccentricity[axis.index()],
        Parameter::Moment(axis) => motion.moment[axis.index()],
        Parameter::Tilt(axis) => motion.tilt[axis.index()],
        _ => None,
    };
    found.unwrap_or(0.0)
}

/// A solution that was written and read again has the same derivatives.
#[test]
fn a_solution_from_its_fields_has_the_same_derivatives() -> Result<()> {
    let case = Case::new(2)?;
    let solution = case.solve(1e-10)?;
    let fields = [&solution.pressure, &solution.gap(), &solution.displacement].map(Clone::clone);
    let (approach, tilt) = (solution.approach, solution.tilt);
    let again = Solution::from_fields(fields, approach, tilt, solution.report.clone())?;
    let one = solution.gradient(&Output::LocatedPeak, None)?;
    let other = again.gradient(&Output::LocatedPeak, None)?;
    for ((parameter, a), (_, b)) in one.values.iter().zip(&other.values) {
        assert!((a - b).abs() <= 1e-9 * a.abs(), "{parameter}: {a} {b}");
    }
    Ok(())
}

/// Grids that repeat along one direction or both: derivatives of a coated body in contact with a wavy surface.
#[test]
#[ignore = "slow"]
fn derivatives_on_periodic_grids_equal_differences() -> Result<()> {
    for periodic in [[true, true], [true, false], [false, true]] {
        let grid = Grid::new([20, 22], [2.0, 2.2])?.periodic(periodic)?;
        let (x, y) = (grid.x(), grid.y());
        let gaps = Array2::from_shape_fn((20, 22), |(i, j)| {
            // The longest wave where the grid repeats, a parabola where it does not.
            let along = |at: f64, size: f64, repeats: bool| match repeats {
                true => 0.02 * (1.0 - (std::f64::consts::TAU * (at - 0.03) / size).cos()),
                false => 0.1 * (at - 0.05) * (at - 0.05),
            };
            along(x[i], 2.0, periodic[0]) + along(y[j], 2.2, periodic[1])
        });
        let case = Case {
            body: stack(Elastic::new(1.0, 0.3)?, [[3.0, 0.25, 0.3]])?,
            counterbody: None,
            grid,
            shape: Box::new(Shared(gaps)),
            motion: Motion::load(0.02),
        };
        let outputs =
            [Output::Approach, Output::PressureNorm(8.0), Output::Displacement([0.7, -0.8])];
        let counts = compare(&case, &outputs, 0.0)?;
        let all = counts.is_some_and(|[compared, left]| compared > 0 && left == 0);
        assert!(all, "{counts:?}");
    }
    Ok(())
}
