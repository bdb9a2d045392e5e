//! Arrays may have any order in memory: the same numbers follow, and the same errors.

use nacre::convolution::Convolution;
use nacre::friction::{FrictionOptions, Step};
use nacre::influence::{Method, influence_coefficients};
use nacre::{
    Algorithm, Contact, Grid, Hardness, HeightMap, Member, Motion, Options, Paraboloid, Result,
    Setup, Solution, StressOptions, Surface, stress,
};
use ndarray::{Array2, Axis, Slice};

use crate::support::checks::difference;
use crate::support::settings::{plan, steel};

/// The same array with columns first, with both axes backwards, and within a larger one.
fn layouts(array: &Array2<f64>) -> [Array2<f64>; 3] {
    let (rows, columns) = array.dim();
    let mut columns_first = Array2::zeros((columns, rows)).reversed_axes();
    columns_first.assign(array);
    let mut backwards = array.clone();
    backwards.invert_axis(Axis(0));
    backwards.invert_axis(Axis(1));
    backwards.assign(array);
    let mut apart = Array2::zeros((2 * rows, 3 * columns));
    apart.slice_axis_inplace(Axis(0), Slice::new(0, None, 2));
    apart.slice_axis_inplace(Axis(1), Slice::new(0, None, 3));
    apart.assign(array);
    let all = [columns_first, backwards, apart];
    for one in &all {
        let same = one.iter().zip(array).all(|(a, b)| a.to_bits() == b.to_bits()); // NaN, too
        assert!(same && !one.is_standard_layout());
    }
    all
}

/// Positive numbers without a symmetry.
fn map(shape: [usize; 2]) -> Array2<f64> {
    Array2::from_shape_fn(shape, |(i, j)| 1.0 + ((3 * i + 5 * j) % 17) as f64 / 16.0)
}

fn contact() -> Result<Contact> {
    plan(steel()?, Grid::new([12, 10], [3e-4, 3e-4])?)
}

fn solved(options: &Options) -> Result<Solution> {
    contact()?.solve(&Paraboloid::new(5e-3, 5e-3)?, &Motion::load(10.0), options)
}

#[test]
fn options_of_a_solve() -> Result<()> {
    let (map, hardness) = (map([12, 10]), |values| Some(Hardness::Cells(values)));
    let dent = 1e-9 * &map;
    for algorithm in [Algorithm::Cascade, Algorithm::PolonskyKeer] {
        let of = |initial: &Array2<f64>, limits: Array2<f64>, indentation: &Array2<f64>| {
            let (initial, indentation) = (Some(initial.clone()), Some(indentation.clone()));
            let hardness = hardness(limits);
            solved(
                &Options::default()
                    .with_algorithm(algorithm)
                    .with_initial(initial)
                    .with_hardness(hardness)
                    .with_indentation(indentation),
            )
        };
        let expected = of(&map, 7e8 * &map, &dent)?;
        // The hardness limits the pressure: the two calls differ.
        assert!(expected.plastic_work() > 0.0);
        for ((initial, limits), dent) in
            layouts(&map).iter().zip(layouts(&(7e8 * &map))).zip(layouts(&dent))
        {
            let solution = of(initial, limits, &dent)?;
            assert_eq!(solution.pressure, expected.pressure);
            assert_eq!(solution.indentation, expected.indentation);
        }
    }
    Ok(())
}

#[test]
fn wrong_values_are_refused() -> Result<()> {
    for (wrong, name) in
        [(-1.0, "hardness must be above 0"), (f64::NAN, "hardness must be above 0")]
    {
        let mut limits = map([12, 10]);
        limits[[7, 3]] = wrong;
        for limits in layouts(&limits) {
            let hardness = Some(Hardness::Cells(limits.clone()));
            let error = solved(&Options::default().with_hardness(hardness)).err();
            assert!(error.is_some_and(|error| error.to_string().starts_with(name)));
            for options in [
                Options::default().with_initial(limits.clone()),
                Options::default().with_indentation(limits.clone()),
            ] {
                assert!(solved(&options).is_err());
            }
        }
    }
    Ok(())
}

#[test]
fn convolutions() -> Result<()> {
    let grid = Grid::new([12, 10], [3e-4, 3e-4])?;
    let coefficients = influence_coefficients(steel()?, &grid, Method::Exact)?;
    let (pressure, convolution) = (map([12, 10]), Convolution::plan(&coefficients, None)?);
    let expected = convolution.apply(&pressure)?;
    for (pressure, coefficients) in layouts(&pressure).iter().zip(layouts(&coefficients)) {
        assert_eq!(convolution.apply(pressure)?, expected);
        assert_eq!(Convolution::plan(&coefficients, None)?.apply(pressure)?, expected);
        for mut displacement in layouts(&expected) {
            displacement.fill(0.0);
            convolution.apply_into(pressure, &mut displacement, &mut convolution.workspace())?;
            assert_eq!(displacement, expected);
        }
        let setup = Setup::default().with_coefficients(coefficients.into_shared());
        let contact = Contact::plan(steel()?, grid, setup)?;
        let shape = Paraboloid::new(5e-3, 5e-3)?;
        let solution = contact.solve(&shape, &Motion::load(10.0), &Options::default())?;
        assert_eq!(solution.pressure, solved(&Options::default())?.pressure);
    }
    Ok(())
}

#[test]
fn surfaces_and_friction() -> Result<()> {
    let (map, grid) = (map([12, 10]), Grid::new([12, 10], [3e-4, 3e-4])?);
    let gaps = |heights: &Array2<f64>| HeightMap::new(heights.clone(), [2.5e-5, 3e-5])?.gaps(&grid);
    let slid = |friction: &Array2<f64>| -> Result<Array2<f64>> {
        let step = Step::press(Motion::load(10.0), friction.clone());
        let step = step.with_force([Some(1.0), None]);
        let options = FrictionOptions::default().with_tolerance(1e-4);
        let steps = contact()?.slide(&Paraboloid::new(5e-3, 5e-3)?, &[step], &options, None)?;
        Ok(steps[0].traction[0].clone())
    };
    let stresses = |pressure: &Array2<f64>| {
        let body = steel()?.into();
        stress(&body, &grid, pressure, &[1e-5], &StressOptions::default())
    };
    for other in layouts(&map) {
        assert_eq!(gaps(&other)?, gaps(&map)?);
        assert_eq!(slid(&other)?, slid(&map)?);
        assert_eq!(stresses(&other)?, stresses(&map)?);
    }
    Ok(())
}

/// A surface whose gaps have their columns first.
#[derive(Debug)]
struct ColumnsFirst(Paraboloid);

impl Surface for ColumnsFirst {
    fn gap(&self, x: f64, y: f64) -> f64 {
        self.0.gap(x, y)
    }

    fn gaps(&self, grid: &Grid) -> Result<Array2<f64>> {
        let [columns_first, ..] = layouts(&self.0.gaps(grid)?);
        Ok(columns_first)
    }
}

#[test]
fn fields_that_a_user_replaces() -> Result<()> {
    let solution = solved(&Options::default())?;
    let shape = ColumnsFirst(Paraboloid::new(5e-3, 5e-3)?);
    let options = Options::default();
    let again = contact()?.solve(&shape, &Motion::load(10.0), &options)?;
    assert_eq!(again.pressure, solution.pressure);
    for (pressure, displacement) in
        layouts(&solution.pressure).into_iter().zip(layouts(&solution.displacement))
    {
        let mut other = solution.clone();
        (other.pressure, other.displacement) = (pressure, displacement);
        assert_eq!(other.gap(), solution.gap());
        // Sums are taken as the numbers lie.
        below!(difference(&other.line_load(), &solution.line_load()), 1e-14);
        assert_eq!(other.contact_extent(), solution.contact_extent());
        assert_eq!(other.stiffness(None)?, solution.stiffness(None)?);
        let depths = [1e-5];
        let stresses = |of: &Solution| of.stress(&depths, Member::Body, &StressOptions::default());
        assert_eq!(stresses(&other)?, stresses(&solution)?);
    }
    Ok(())
}
