//! Options and fields of stresses.

use nacre::{Section, Stress, StressOptions};
use ndarray::Array3;

/// Friction along a direction.
pub(crate) fn sliding(friction: f64, direction: [f64; 2]) -> StressOptions {
    StressOptions { friction, direction: Some(direction), ..StressOptions::default() }
}

/// A section.
pub(crate) fn on(section: Section) -> StressOptions {
    StressOptions { section, ..StressOptions::default() }
}

/// These options, and the displacements.
pub(crate) fn displaced(options: StressOptions) -> StressOptions {
    StressOptions { displacement: true, ..options }
}

/// The six components, and the displacements where they are known.
pub(crate) fn fields(stress: &Stress) -> Vec<&Array3<f64>> {
    let displacement = stress.displacement.iter().flatten();
    stress.components.iter().chain(displacement).collect()
}

/// The bits of all fields.
pub(crate) fn bits(stress: &Stress) -> Vec<u64> {
    let values = fields(stress).into_iter().flatten();
    values.map(|value| value.to_bits()).collect()
}

/// Largest magnitude.
pub(crate) fn largest(field: &Array3<f64>) -> f64 {
    field.iter().fold(0.0, |most: f64, value| most.max(value.abs()))
}
