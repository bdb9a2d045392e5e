//! Values of arrays in C order, whatever the order in memory.

use std::borrow::Cow;

use ndarray::{Array2, ArrayRef2};

/// The values of an array in C order, copied where its memory has another.
pub(crate) fn slice(array: &ArrayRef2<f64>) -> Cow<'_, [f64]> {
    match array.as_slice() {
        Some(values) => values.into(),
        None => array.iter().copied().collect(),
    }
}

/// The values of an array in C order, to be written; its memory has that order afterwards.
pub(crate) fn slice_mut(array: &mut Array2<f64>) -> &mut [f64] {
    if !array.is_standard_layout() {
        *array = array.as_standard_layout().into_owned();
    }
    array.as_slice_mut().expect("a standard layout is a slice")
}

#[cfg(test)]
mod tests {
    use ndarray::{Array2, Axis};

    use super::{slice, slice_mut};

    #[test]
    fn values_are_in_c_order_from_every_layout() {
        let rows_first = Array2::from_shape_fn((3, 4), |(i, j)| (4 * i + j) as f64);
        let mut columns_first = Array2::zeros((4, 3)).reversed_axes();
        columns_first.assign(&rows_first);
        let mut reversed = rows_first.clone();
        reversed.invert_axis(Axis(1));
        reversed.assign(&rows_first);
        let expected: Vec<f64> = (0..12).map(f64::from).collect();
        for mut array in [rows_first, columns_first, reversed] {
            assert_eq!(*slice(&array), expected[..]);
            assert_eq!(*slice_mut(&mut array), expected[..]);
            slice_mut(&mut array)[5] = -1.0;
            assert!((array[[1, 1]] + 1.0).abs() < f64::EPSILON, "{array}");
        }
    }
}
