//! A contact next to one of other cells is told, others are not; what has no derivative is refused with a reason.

use nacre::gradient::{LinearOptions, Linearisation, Output};
use nacre::{
    Contact, Elastic, FlatPunch, Grid, Hardness, Motion, Options, Paraboloid, Result, Setup,
    Solution,
};

use super::cases::{Case, Numbers};

const OPTIONS: LinearOptions = LinearOptions {
    tolerance: 1e-9,
    watch: None,
};

fn cells(solution: &Solution) -> Result<usize> {
    let plan = Linearisation::plan(solution, None, &OPTIONS)?;
    Ok(plan.pressure().iter().filter(|p| **p > 0.0).count())
}

/// Loads at which a cell joins the contact, by bisection.
#[test]
fn fifty_kinks_are_told() -> Result<()> {
    let contact = Contact::plan(
        Elastic::new(1.0, 0.3)?,
        Grid::new([16, 16], [2.4, 2.4])?,
        Setup::default(),
    )?;
    let options = Options {
        tolerance: 1e-12,
        ..Options::default()
    };
    for number in 0..50 {
        let numbers = &mut Numbers::new(7000 + number);
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
        assert!(
            gradient
                .warnings
                .iter()
                .any(|warning| warning.contains("margin")),
            "{number}: margin {:e}",
            gradient.margin
        );
    }
    Ok(())
}

/// Fewer than one per cent of contacts are told to be next to another.
#[test]
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
    println!("{told} of {seen}");
    assert!(told < 2 && seen > 195, "{told} of {seen}");
    Ok(())
}

fn message<T: std::fmt::Debug>(found: Result<T>) -> String {
    found.map_or_else(|error| error.to_string(), |value| panic!("{value:?}"))
}

#[test]
fn refusals_name_the_smooth_alternative() -> Result<()> {
    let grid = Grid::new([24, 24], [2.4, 2.4])?;
    let contact = Contact::plan(Elastic::new(1.0, 0.3)?, grid, Setup::default())?;
    let ball = Paraboloid::new(10.0, 10.0)?;
    let solution = contact.solve(&ball, &Motion::load(0.02), &Options::default())?;
    let refused = |output: &Output| message(solution.gradient(output, Some(&ball)));
    assert!(refused(&Output::ContactArea).contains("participation area"));
    assert!(refused(&Output::ContactExtent).contains("area estimate"));
    // The load is centred on an even number of cells: four have the largest pressure.
    assert!(refused(&Output::CellPeak).contains("located peak"));
    assert!(refused(&Output::Pressure([9.0, 0.0])).contains("x must be on the grid"));
    let plan = Linearisation::plan(&solution, Some(&ball), &OPTIONS)?;
    let unknown = |path: &str| message(plan.gradients(&[Output::Approach], Some(&[path])));
    assert!(unknown("shape.length").contains("cells join and leave"));
    assert!(unknown("body.layers[0].thickness").contains("not a number of a stack"));
    assert!(unknown("eccentricity[0]").contains("not a number of this contact"));

    let punch = FlatPunch::new(0.5)?;
    let flat = contact.solve(&punch, &Motion::load(0.02), &Options::default())?;
    let plan = Linearisation::plan(&flat, Some(&punch), &OPTIONS)?;
    let radius = message(plan.gradients(&[Output::Approach], Some(&["shape.radius"])));
    assert!(radius.contains("gradient.gap"), "{radius}");
    // The contact of a flat punch is fixed: dδ/dW is exact, and δ is in proportion to W.
    let gradient = &plan.gradients(&[Output::Approach], None)?[0];
    let slope = gradient.get("load").unwrap_or(f64::NAN);
    assert!((slope * 0.02 / gradient.value - 1.0).abs() < 1e-9);

    let few = Options {
        max_iterations: Some(2),
        ..Options::default()
    };
    let unfinished = contact.solve(&ball, &Motion::load(0.02), &few)?;
    assert!(message(unfinished.gradient(&Output::Approach, None)).contains("did not converge"));
    let hard = Options {
        hardness: Some(Hardness::Uniform(0.03)),
        ..Options::default()
    };
    let dented = contact.solve(&ball, &Motion::load(0.02), &hard)?;
    assert!(message(dented.gradient(&Output::Approach, None)).contains("history of loads"));
    let apart = contact.solve(&ball, &Motion::approach(-0.1), &Options::default())?;
    assert!(message(apart.gradient(&Output::Load, None)).contains("nothing touches"));
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
    let contact = Contact::plan(Elastic::new(1.0, 0.3)?, grid, Setup::default())?;
    let ball = Paraboloid::new(radius, radius)?;
    let solution = contact.solve(&ball, &Motion::load(load), &Options::default())?;
    let plan = Linearisation::plan(&solution, Some(&ball), &OPTIONS)?;
    let outputs = [Output::AreaEstimate, Output::ParticipationArea];
    let found = plan.gradients(&outputs, Some(&["load"]))?;
    let area = std::f64::consts::PI * a * a;
    for (gradient, [part, value, slope]) in found
        .iter()
        .zip([[1.0, 0.01, 0.05], [8.0 / 9.0, 1e-3, 2e-3]])
    {
        assert!(
            (gradient.value / (part * area) - 1.0).abs() < value,
            "{}",
            gradient.value / area
        );
        let relative = gradient.values[0].1 * load / gradient.value;
        assert!((relative - 2.0 / 3.0).abs() < slope, "{relative}");
    }
    assert!(
        found[0]
            .warnings
            .iter()
            .any(|warning| warning.contains("estimate"))
    );
    assert!(found[1].warnings.is_empty());
    Ok(())
}
