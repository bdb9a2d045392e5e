//! Assertions that tell both numbers and where they were found.

use nacre::Solution;
use ndarray::{Array, Dimension};
use proptest::prelude::ProptestConfig;
use proptest::test_runner::RngSeed;

/// Asserts that a number is below a limit. What else is given is printed where it is not.
macro_rules! below {
    ($value:expr, $limit:expr $(, $at:expr)* $(,)?) => {{
        let (value, limit) = ($value, $limit);
        assert!(
            value < limit,
            concat!("{} is {:e}, not below {:e}" $(, ", ", stringify!($at), " {:?}")*),
            stringify!($value), value, limit $(, $at)*
        );
    }};
}

/// Asserts that two numbers differ by no more than a part of the second.
macro_rules! near {
    ($found:expr, $due:expr, $part:expr $(, $at:expr)* $(,)?) => {{
        let found: f64 = *std::borrow::Borrow::<f64>::borrow(&$found);
        let due: f64 = *std::borrow::Borrow::<f64>::borrow(&$due);
        assert!(
            (found - due).abs() <= $part * due.abs(),
            concat!("{} is {:e}, due {:e}, {:.1e} apart" $(, ", ", stringify!($at), " {:?}")*),
            stringify!($found), found, due, found / due - 1.0 $(, $at)*
        );
    }};
}

/// Largest size of the elements; NaN where one of them is.
pub(crate) fn largest<D: Dimension>(values: &Array<f64, D>) -> f64 {
    values.fold(0.0, |most: f64, value| match value.abs() {
        size if most.is_nan() || size <= most => most,
        size => size,
    })
}

/// Largest |a − b|.
pub(crate) fn apart<D: Dimension>(a: &Array<f64, D>, b: &Array<f64, D>) -> f64 {
    largest(&(a - b))
}

/// Largest |a − b| over the largest |b|.
pub(crate) fn difference<D: Dimension>(a: &Array<f64, D>, b: &Array<f64, D>) -> f64 {
    apart(a, b) / largest(b)
}

/// Largest difference of two pressures over the peak of the second.
pub(crate) fn pressure_off(a: &Solution, b: &Solution) -> f64 {
    difference(&a.pressure, &b.pressure)
}

/// Random cases of proptest, this many, that are equal in every run.
pub(crate) fn seeded(cases: u32) -> ProptestConfig {
    ProptestConfig {
        cases,
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(1),
        ..ProptestConfig::default()
    }
}

/// Asserts that JSON gives a value back; without the feature `serde` nothing.
#[cfg(feature = "serde")]
pub(crate) fn kept<T>(value: &T)
where
    T: serde::Serialize + serde::de::DeserializeOwned + PartialEq + std::fmt::Debug,
{
    let text = serde_json::to_string(value).unwrap_or_default();
    assert_eq!(serde_json::from_str::<T>(&text).ok().as_ref(), Some(value), "{text}");
}
#[cfg(not(feature = "serde"))]
pub(crate) fn kept<T>(_: &T) {}
