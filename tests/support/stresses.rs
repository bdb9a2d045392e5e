//! Options and fields of stresses.

use nacre::{Section, Stress, StressOptions};
use ndarray::Array3;

/// Friction along a direction.
pub(crate) fn sliding(friction: f64, direction: [f64; 2]) -> StressOptions {
    StressOptions::default().with_friction(friction).with_direction(direction)
}

/// A section.
pub(crate) fn on(section: Section) -> StressOptions {
    StressOptions::default().with_section(section)
}

/// These options, and the displacements.
pub(crate) fn displaced(options: StressOptions) -> StressOptions {
    options.with_displacement(true)
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
