//! Outputs that have derivatives.

use ndarray::Array2;

use super::parameter::Parameter;
use crate::stress::{Member, Side};

/// A number that a solved contact gives, and that has a derivative.
#[derive(Debug, Clone, PartialEq)]
pub enum Output {
    /// Approach of the origin \[m\].
    Approach,
    /// Slope along x or y.
    Tilt(usize),
    /// Load Σ p dA \[N\].
    Load,
    /// First moment Σ p x dA or Σ p y dA \[N m\].
    Moment(usize),
    /// (Σ pʳ dA)^{1/r}, a smooth stand-in for the peak pressure where r is 8 to 30.
    PressureNorm(f64),
    /// Peak of parabolas through the cell of the largest pressure and its neighbours along x and y \[Pa\].
    LocatedPeak,
    /// Largest pressure of a cell \[Pa\]; refused where two cells tie.
    CellPeak,
    /// Pressure at (x, y) \[Pa\], bilinear between cell centres.
    Pressure([f64; 2]),
    /// Displacement of both bodies together at (x, y) \[m\], bilinear between cell centres.
    Displacement([f64; 2]),
    /// Gap at (x, y) \[m\], bilinear between cell centres.
    Gap([f64; 2]),
    /// W²/Σ p² dA \[m²\], a smooth measure of the area: (8/9) π a² for Hertz' contact.
    ParticipationArea,
    /// Level-set estimate of the contact area \[m²\], in error by 1 to 2 % of its derivative from 50 cells a radius on.
    AreaEstimate,
    /// Area of the cells in contact, which has no derivative: refused.
    ContactArea,
    /// Ends of the contact, which have no derivative: refused.
    ContactExtent,
    /// Σ w p with given weights (nx, ny).
    Weighted(Array2<f64>),
    /// A stress.
    Stress(StressOutput),
}

/// A stress under the pressure as uniform over each cell, which is what [`stress`](crate::stress()) computes.
#[derive(Debug, Clone, PartialEq)]
pub struct StressOutput {
    /// The body.
    pub member: Member,
    /// What of the stress is taken.
    pub measure: Measure,
    /// Where.
    pub place: StressPlace,
    /// Coefficient of friction. Default: 0.
    pub friction: f64,
    /// Direction of the traction on the body; the counterbody gets the opposite. Default: that in which the shape rolls.
    pub direction: Option<[f64; 2]>,
}

impl StressOutput {
    /// `measure` of the stress in the body at `place`, without friction.
    pub fn new(measure: Measure, place: StressPlace) -> Self {
        Self { member: Member::Body, measure, place, friction: 0.0, direction: None }
    }
}

/// A scalar made of a stress.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Measure {
    /// σ_xx, σ_yy, σ_zz, σ_xy, σ_yz, σ_xz, by number.
    Component(usize),
    /// Von Mises' equivalent stress.
    VonMises,
    /// A principal stress, 0 the largest; refused where it is repeated.
    Principal(usize),
    /// Half the difference of the largest and the smallest principal stress.
    MaxShear,
    /// Traction √(σ_xz² + σ_yz²) along the plane z = const, which an interface bears.
    PlaneShear,
}

/// Where a stress is taken.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum StressPlace {
    /// The point (x, y, z), bilinear between cell centres, above or below an interface.
    Point([f64; 3], Side),
    /// Soft maximum over all cells at evenly spaced depths in a layer, both its faces among them.
    Layer {
        /// Number of the layer, from the surface down.
        layer: usize,
        /// Number of depths, 2 or more.
        depths: usize,
        /// β times about the largest value, see [`StressPlace::sharpness`].
        sharpness: f64,
    },
    /// Soft maximum over all cells at an interface.
    Interface {
        /// Number of the interface, that below the layer of this number.
        interface: usize,
        /// Side of the interface.
        side: Side,
        /// β times about the largest value, see [`StressPlace::sharpness`].
        sharpness: f64,
    },
}

impl StressPlace {
    /// Sharpness β s of a soft maximum (1/β) ln mean e^{βσ}, where s, the mean of order 32, is somewhat below the largest |σ|.
    /// The soft maximum is below the largest of N values by ln N/β at most.
    pub fn sharpness(&self) -> Option<f64> {
        match *self {
            Self::Point(..) => None,
            Self::Layer { sharpness, .. } | Self::Interface { sharpness, .. } => Some(sharpness),
        }
    }
}

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
        values.find(|(parameter, _)| parameter.to_string() == path).map(|(_, value)| *value)
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
