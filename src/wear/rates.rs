//! Wear rates over the depth of a body: those of its layers and of its substrate.

use crate::compliance::response::Body;
use crate::error::{Error, Result, not_negative};

/// Part of a layer's depth that is left where it counts as through: far below what its thickness is known to.
pub(super) const THROUGH: f64 = 1e-5;

/// Rates of the layers of one body.
#[derive(Debug, Clone)]
pub(super) struct Rates {
    /// Depths \[m\] at which the layers end.
    pub(super) bottoms: Vec<f64>,
    /// κ of the layers, and of what is below them.
    rates: Vec<f64>,
}

impl Rates {
    /// Rates of a `body`; one stands for all of its layers.
    ///
    /// # Errors
    /// A rate that is negative or not finite, and another number of rates than of layers with the substrate.
    pub(super) fn new(name: &'static str, rates: &[f64], body: Option<&Body>) -> Result<Self> {
        for rate in rates {
            not_negative(name, *rate)?;
        }
        let layers = body.and_then(|body| body.half_space()).map_or(&[][..], |body| body.layers());
        let mut depth = 0.0;
        let bottoms: Vec<f64> = (layers.iter())
            .map(|layer| {
                depth += layer.thickness();
                depth
            })
            .collect();
        let rates = match rates {
            [one] => vec![*one; bottoms.len() + 1],
            _ => rates.to_vec(),
        };
        if rates.len() != bottoms.len() + 1 {
            return Err(Error::Parameter {
                name,
                requirement: "as many as layers, and one for the substrate",
                value: rates.len() as f64,
            });
        }
        Ok(Self { bottoms, rates })
    }

    /// Whether nothing wears.
    pub(super) fn vanish(&self) -> bool {
        self.rates.iter().all(|rate| *rate <= 0.0)
    }

    /// κ where it is the same at all depths.
    pub(super) fn uniform(&self) -> Option<f64> {
        let first = *self.rates.first()?;
        self.rates.iter().all(|rate| (rate - first).abs() <= 0.0).then_some(first)
    }

    /// κ of a layer, or of the substrate.
    pub(super) fn of(&self, layer: usize) -> f64 {
        self.rates[layer]
    }

    /// Number of layers that are through at a depth.
    fn layers_through(&self, depth: f64) -> usize {
        self.bottoms.iter().take_while(|bottom| depth >= **bottom * (1.0 - THROUGH)).count()
    }

    /// κ at a depth.
    pub(super) fn at(&self, depth: f64) -> f64 {
        self.rates[self.layers_through(depth)]
    }

    /// Mean κ of the wear from a depth on by Σ v p Δs = `work` \[N/m\]: of one layer, or of several, if all below the layer number
    /// `last` wore at its rate.
    pub(super) fn mean_above(&self, last: usize, depth: f64, work: f64) -> f64 {
        let (mut layer, mut at, mut left) = (self.layers_through(depth).min(last), depth, work);
        while layer < last && at + self.rates[layer] * left > self.bottoms[layer] {
            left -= (self.bottoms[layer] - at) / self.rates[layer];
            at = self.bottoms[layer];
            layer += 1;
        }
        if at > depth && work > 0.0 {
            (at - depth + self.rates[layer] * left) / work
        } else {
            self.rates[layer]
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Rates;

    /// Through a layer of 2 at a rate of 0.5, then at 3: work 4 removes the layer, and each further unit 3.
    #[test]
    fn rates_change_within_a_step() {
        let rates = Rates { bottoms: vec![2.0], rates: vec![0.5, 3.0] };
        for (work, removed) in [(1.0, 0.5), (4.0, 2.0), (5.0, 5.0), (6.0, 8.0)] {
            assert!((rates.mean_above(1, 0.0, work) * work - removed).abs() < 1e-14, "{work}");
        }
        // By the first rate alone, it is passed as far.
        assert!((rates.mean_above(0, 0.0, 6.0) - 0.5).abs() < 1e-15);
        assert!((rates.at(1.9) - 0.5).abs() < 1e-15 && (rates.at(2.0) - 3.0).abs() < 1e-15);
    }
}
