//! Sums of any number of shapes are flat lists.

use approx::assert_relative_eq;
use nacre::{
    Contact, Cylinder, Elastic, Error, Grid, HeightMap, Motion, Options, Paraboloid, Result, Setup,
    Sphere, Superposition, Surface,
};
use ndarray::Array2;

/// Rounding of a sum of n terms: √n ε, and n ε at most.
const MANY: usize = 100_000;

#[test]
fn a_hundred_thousand_shapes_are_one() -> Result<()> {
    let shapes = vec![Paraboloid::new(1e5, 2e5)?; MANY];
    let sum = Superposition::new(shapes)?;
    let one = Paraboloid::new(1e5 / MANY as f64, 2e5 / MANY as f64)?;
    let grid = Grid::new([8, 8], [1e-3, 1e-3])?;
    let rounding = MANY as f64 * f64::EPSILON;
    for (found, exact) in sum.gaps(&grid)?.iter().zip(&one.gaps(&grid)?) {
        near!(*found, *exact, rounding);
    }
    let contact = plan(Elastic::new(1e9, 0.3)?, grid)?;
    let press = |shape: &dyn Surface| contact.solve(shape, &Motion::load(1.0), &Options::default());
    let (many, single) = (press(&sum)?, press(&one)?);
    near!(many.approach, single.approach, 1e-6);
    Ok(())
}

#[test]
fn a_superposition_is_the_sum_of_its_shapes() -> Result<()> {
    let map = HeightMap::new(
        Array2::from_shape_fn((6, 5), |(i, j)| (i * j) as f64 * 1e-9),
        [1e-4; 2],
    )?;
    let sphere = Sphere::new(1e-2)?.shifted(1e-4, 0.0)?;
    let pair = sphere.clone().plus(map.clone());
    let list: Vec<Box<dyn Surface>> = vec![Box::new(sphere), Box::new(map.clone())];
    let list = Superposition::new(list)?;
    let grid = map.grid().ok_or(Error::Inconsistent("a map has a grid"))?;
    assert_eq!(list.gaps(&grid)?, pair.gaps(&grid)?);
    assert_eq!(list.extent(), pair.extent());
    assert_eq!(
        list.radii().map(f64::to_bits),
        pair.radii().map(f64::to_bits)
    );
    assert_eq!(list.grid(), pair.grid());
    let roller = || Cylinder::new(1e-2);
    let rolls =
        |shapes: Vec<Box<dyn Surface>>| Superposition::new(shapes).map(|s| s.rolling_direction());
    assert!(
        rolls(vec![
            Box::new(map.clone()),
            Box::new(roller()?),
            Box::new(roller()?)
        ])?
        .is_some()
    );
    assert!(rolls(vec![Box::new(map.clone())])?.is_none());
    assert_relative_eq!(list.gap(1e-4, 2e-4), pair.gap(1e-4, 2e-4));
    let none = Superposition::<Sphere>::new([]);
    assert!(none.is_err_and(|error| error.to_string().contains("at least one shape")));
    Ok(())
}
