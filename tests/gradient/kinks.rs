//! A contact next to one of other cells is told, others are not; what has no derivative is refused with a reason.

use nacre::gradient::{LinearOptions, Linearisation, Output};
use nacre::influence::Method;
use nacre::{Elastic, FlatPunch, Grid, Hardness, Motion, Options, Paraboloid, Result, Solution};

use super::cases::Case;

use crate::support::contacts::Random;
use crate::support::settings::{converted, plan, tolerance};

fn cells(solution: &Solution) -> Result<usize> {
    let plan = Linearisation::plan(solution, None, &LinearOptions::default())?;
    Ok(plan.pressure().iter().filter(|p| **p > 0.0).count())
}

/// Loads at which a cell joins the contact, by bisection.
#[test]
#[ignore = "slow"]
fn fifty_kinks_are_told() -> Result<()> {
    let contact = plan(Elastic::new(1.0, 0.3)?, Grid::new([16, 16], [2.4, 2.4])?)?;
    let options = tolerance(1e-12);
    for number in 0..50 {
        let numbers = &mut Random::new(7000 + number);
        let shape = Paraboloid::new(numbers.between(8.0, 12.0), numbers.between(8.0, 12.0))?;
        let solve = |load: f64| contact.solve(&shape, &Motion::load(load), &options);
        let (mut low, mut high) = (0.01, 0.04);
        let few = cells(&solve(low)?)?;
        assert!(cells(&solve(high)?)? > few);
        while high / low - 1.0 > 1e-14 {
            let middle = 0.5 * (low + high);
            if middle <= low || middle >= high {
                break;
            }
            match cells(&solve(middle)?)? > few {
                true => high = middle,
                false => low = middle,
            }
        }
        let gradient = solve(high)?.gradient(&Output::Approach, None)?;
        let told = gradient.warnings.iter().any(|text| text.contains("margin"));
        assert!(told, "{number}: margin {:e}", gradient.margin);
    }
    Ok(())
}

/// Fewer than one per cent of contacts are told to be next to another.
#[test]
#[ignore = "slow"]
fn random_contacts_are_not_told() -> Result<()> {
    let (mut told, mut seen) = (0, 0);
    for number in 0..200 {
        let Ok(solution) = Case::new(number)?.solve(1e-8) else {
            continue;
        };
        let gradient = solution.gradient(&Output::Approach, None)?;
        told += usize::from(!gradient.warnings.is_empty());
        seen += 1;
    }
    assert!(told < 2 && seen > 195, "{told} of {seen}");
    Ok(())
}

/// Asserts that something is refused in these words.
pub(crate) fn refused<T: std::fmt::Debug>(found: Result<T>, words: &str) {
    let message = found.map_or_else(|error| error.to_string(), |value| panic!("{value:?}"));
    assert!(message.contains(words), "{message}");
}

#[test]
fn refusals_name_the_smooth_alternative() -> Result<()> {
    let contact = plan(Elastic::new(1.0, 0.3)?, Grid::new([24, 24], [2.4, 2.4])?)?;
    let (ball, load) = (Paraboloid::new(10.0, 10.0)?, Motion::load(0.02));
    let solution = contact.solve(&ball, &load, &Options::default())?;
    for (output, words) in [
        (Output::ContactArea, "participation area"),
        (Output::ContactExtent, "area estimate"),
        // The load is centred on an even number of cells: four have the largest pressure.
        (Output::CellPeak, "located peak"),
        (Output::Pressure([9.0, 0.0]), "x must be on the grid"),
    ] {
        refused(solution.gradient(&output, Some(&ball)), words);
    }
    let round = Linearisation::plan(&solution, Some(&ball), &LinearOptions::default())?;
    let punch = FlatPunch::new(0.5)?;
    let flat = contact.solve(&punch, &load, &Options::default())?;
    let flat = Linearisation::plan(&flat, Some(&punch), &LinearOptions::default())?;
    for (plan, path, words) in [
        (&round, "shape.length", "cells join and leave"),
        (&round, "body.layers[0].thickness", "not a number of a stack"),
        (&round, "eccentricity[0]", "not a number of this contact"),
        (&flat, "shape.radius", "gradient.gap"),
    ] {
        refused(plan.gradients(&[Output::Approach], Some(&[path])), words);
    }
    // Coefficients that are given do not follow from the body; other derivatives are those of the same contact.
    let (body, grid) = (Elastic::new(1.0, 0.3)?, *solution.grid());
    let given = converted(body, grid, Method::Exact)?;
    let given = given.solve(&ball, &load, &Options::default())?;
    let given = Linearisation::plan(&given, Some(&ball), &LinearOptions::default())?;
    let of_body = Some(&["body.substrate.young"][..]);
    refused(
        given.gradients(&[Output::Approach], of_body),
        "body.substrate.young has no derivative: the contact was given influence coefficients",
    );
    let slopes = |plan: &Linearisation<'_>| -> Result<f64> {
        let gradient = &plan.gradients(&[Output::Approach], Some(&["load"]))?[0];
        Ok(gradient.get("load").unwrap_or(f64::NAN))
    };
    near!(slopes(&given)?, slopes(&round)?, 1e-9 * slopes(&round)?.abs());

    // The contact of a flat punch is fixed: dδ/dW is exact, and δ is in proportion to W.
    let gradient = &flat.gradients(&[Output::Approach], None)?[0];
    let slope = gradient.get("load").unwrap_or(f64::NAN);
    near!(slope * 0.02, gradient.value, 1e-9);

    let few = Options::default().with_max_iterations(2);
    let hard = Options::default().with_hardness(Hardness::Uniform(0.03));
    let apart = Motion::approach(-0.1);
    for (motion, options, output, words) in [
        (load, few, Output::Approach, "did not converge"),
        (load, hard, Output::Approach, "history of loads"),
        (apart, Options::default(), Output::Load, "nothing touches"),
    ] {
        refused(contact.solve(&ball, &motion, &options)?.gradient(&output, None), words);
    }
    Ok(())
}

/// The estimate of the area is within some per cent of Hertz' πa² and its derivative, and says that it is an estimate;
/// the participation area is (8/9) πa².
#[test]
fn areas_are_those_of_hertz() -> Result<()> {
    let (radius, load) = (10.0, 0.03);
    let modulus = Elastic::new(1.0, 0.3)?.plane_strain_modulus();
    let a = (0.75 * load * radius / modulus).cbrt();
    let grid = Grid::new([144, 144], [2.4 * a, 2.4 * a])?;
    let contact = plan(Elastic::new(1.0, 0.3)?, grid)?;
    let ball = Paraboloid::new(radius, radius)?;
    let solution = contact.solve(&ball, &Motion::load(load), &Options::default())?;
    let plan = Linearisation::plan(&solution, Some(&ball), &LinearOptions::default())?;
    let outputs = [Output::AreaEstimate, Output::ParticipationArea];
    let found = plan.gradients(&outputs, Some(&["load"]))?;
    let area = std::f64::consts::PI * a * a;
    let bars = [[1.0, 0.01, 0.05], [8.0 / 9.0, 1e-3, 2e-3]];
    for (gradient, [part, value, slope]) in found.iter().zip(bars) {
        near!(gradient.value, part * area, value, gradient.value / area);
        let relative = gradient.values[0].1 * load / gradient.value;
        below!((relative - 2.0 / 3.0).abs(), slope, relative);
    }
    let warned = |text: &String| text.contains("estimate");
    assert!(found[0].warnings.iter().any(warned) && found[1].warnings.is_empty());
    Ok(())
}
