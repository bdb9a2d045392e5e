//! A gradient, and a direction, as values.

use ndarray::Array2;

use super::output::Output;
use super::parameter::Parameter;

/// Derivatives of one output.
#[derive(Debug, Clone, PartialEq)]
pub struct Gradient {
    /// The output.
    pub output: Output,
    /// Value of the output at the polished solution.
    pub value: f64,
    /// Derivative with respect to each parameter, per unit of the parameter.
    pub values: Vec<(Parameter, f64)>,
    /// Derivative with respect to the undeformed gap of each cell (nx, ny); heights count −gap.
    pub gap: Array2<f64>,
    /// Smaller of the least pressure in contact, relative to the peak, and the least gap outside, relative to the largest
    /// displacement: how far the contact is from one of other cells, where derivatives jump.
    pub margin: f64,
    /// What makes the derivatives doubtful.
    pub warnings: Vec<String>,
}

impl Gradient {
    /// Derivative with respect to the parameter of this path.
    pub fn get(&self, path: &str) -> Option<f64> {
        let mut values = self.values.iter();
        values
            .find(|(parameter, _)| parameter.to_string() == path)
            .map(|(_, value)| *value)
    }
}

/// Change of a solution along a direction of parameters, while the contact stays.
#[derive(Debug, Clone, PartialEq)]
pub struct Direction {
    /// ṗ (nx, ny); 0 outside the contact.
    pub pressure: Array2<f64>,
    /// Change of the approach.
    pub approach: f64,
    /// Change of the tilts.
    pub tilt: [f64; 2],
    /// Largest step along the direction, of either sign, for which no pressure and no gap of the cells around the contact
    /// changes its sign to first order.
    pub valid_step: f64,
}
