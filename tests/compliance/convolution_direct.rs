//! DC-FFT equals the double sum, for any size and memory layout and to the same bits for any number
//! of threads.

use nacre::influence::{Method, influence_coefficients};
use nacre::{Convolution, Grid, Result};
use ndarray::{Array2, ArrayRef2, Axis, ShapeBuilder, Slice};
use proptest::prelude::*;

use crate::support::checks::{difference, seeded};
use crate::support::random::uniform;
use crate::support::settings::steel;

/// Error over the largest displacement.
const ROUNDING: f64 = 1e-12;

/// u[i, j] = Σ C[|i−k|, |j−l|] p[k, l]
fn double_sum(coefficients: &ArrayRef2<f64>, pressure: &ArrayRef2<f64>) -> Array2<f64> {
    Array2::from_shape_fn(pressure.raw_dim(), |(i, j)| {
        let terms = pressure.indexed_iter();
        terms.map(|((k, l), p)| coefficients[[i.abs_diff(k), j.abs_diff(l)]] * p).sum()
    })
}

/// Neither padding nor a symmetry of the kernel hides a misplaced element of random arrays.
fn check_random(shape: [usize; 2]) -> Result<f64> {
    let coefficients = uniform(shape, 1) - 0.5;
    let pressure = uniform(shape, 2) - 0.5;
    let found = Convolution::plan(&coefficients, Some(2))?.apply(&pressure)?;
    Ok(difference(&found, &double_sum(&coefficients, &pressure)))
}

#[test]
#[ignore = "slow"]
fn odd_even_prime_and_unequal_sizes_equal_the_double_sum() -> Result<()> {
    #[rustfmt::skip]
    let shapes = [
        [1, 1], [1, 2], [2, 1], [2, 2], [1, 17], [23, 1], [2, 3], [3, 2], [5, 5], [16, 16],
        [13, 7], [7, 31], [17, 32], [32, 17], [37, 41], [3, 101], [64, 48],
        // Large enough that threads share the work.
        [187, 176],
    ];
    for shape in shapes {
        below!(check_random(shape)?, ROUNDING, shape);
    }
    Ok(())
}

#[test]
fn displacement_of_a_half_space_equals_the_double_sum() -> Result<()> {
    let grid = Grid::new([29, 40], [2.9e-3, 8e-3])?;
    let steel = steel()?;
    let coefficients = influence_coefficients(steel, &grid, Method::Exact)?;
    let pressure = uniform([29, 40], 3) * 1e9;
    let found = Convolution::plan(&coefficients, None)?.apply(&pressure)?;
    let error = difference(&found, &double_sum(&coefficients, &pressure));
    below!(error, ROUNDING);
    Ok(())
}

#[test]
fn any_memory_layout_serves() -> Result<()> {
    let shape = [20, 31];
    let (coefficients, pressure) = (uniform(shape, 4), uniform(shape, 5));
    let expected = Convolution::plan(&coefficients, Some(1))?.apply(&pressure)?;

    let fortran = |array: &Array2<f64>| {
        let mut copy = Array2::zeros(shape.f());
        copy.assign(array);
        copy
    };
    let convolution = Convolution::plan(&fortran(&coefficients), Some(1))?;
    assert_eq!(convolution.apply(&fortran(&pressure))?, expected);

    // Every second row, columns backwards.
    let every_second = Slice::new(0, None, 2);
    let mut scattered = Array2::from_elem([40, 31], f64::NAN);
    let mut rows = scattered.slice_axis_mut(Axis(0), every_second);
    rows.invert_axis(Axis(1));
    rows.assign(&pressure);
    assert_eq!(convolution.apply(&rows)?, expected);

    let mut workspace = convolution.workspace();
    let mut displacement = fortran(&Array2::zeros(shape));
    convolution.apply_into(&rows, &mut displacement, &mut workspace)?;
    assert_eq!(displacement, expected);
    let mut holes = Array2::zeros([40, 31]);
    let mut target = holes.slice_axis_mut(Axis(0), every_second);
    convolution.apply_into(&rows, &mut target, &mut workspace)?;
    assert_eq!(target, expected);
    let between = holes.slice_axis(Axis(0), Slice::new(1, None, 2));
    assert!(between.iter().all(|x| x.abs() <= 0.0));
    Ok(())
}

#[test]
fn bits_do_not_depend_on_the_number_of_threads() -> Result<()> {
    let shape = [230, 150];
    let (coefficients, pressure) = (uniform(shape, 6), uniform(shape, 7));
    let apply = |threads: usize| -> Result<Vec<u64>> {
        let convolution = Convolution::plan(&coefficients, Some(threads))?;
        assert_eq!(convolution.threads(), threads);
        let displacement = convolution.apply(&pressure)?;
        Ok(displacement.iter().map(|u| u.to_bits()).collect())
    };
    let one = apply(1)?;
    for threads in [2, 3, 4] {
        assert!(apply(threads)? == one, "{threads} threads");
    }
    Ok(())
}

#[test]
fn workspace_carries_nothing_over() -> Result<()> {
    let shape = [24, 33];
    let convolution = Convolution::plan(&uniform(shape, 8), Some(2))?;
    let (first, second) = (uniform(shape, 9), uniform(shape, 10));
    let mut workspace = convolution.workspace();
    let mut displacement = Array2::from_elem(shape, f64::NAN);
    convolution.apply_into(&first, &mut displacement, &mut workspace)?;
    convolution.apply_into(&second, &mut displacement, &mut workspace)?;
    assert_eq!(displacement, convolution.apply(&second)?);
    Ok(())
}

proptest! {
    #![proptest_config(seeded(48))]

    #[test]
    fn any_size_equals_the_double_sum(nx in 1_usize..40, ny in 1_usize..40) {
        let error = check_random([nx, ny])?;
        prop_assert!(error < ROUNDING, "{}", error);
    }
}
