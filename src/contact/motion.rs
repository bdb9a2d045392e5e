//! What is asked of the rigid motion of the body that is pressed on.

/// Prescribed and loaded degrees of freedom of the rigid motion (δ, s_x, s_y) in
/// g = h + u − δ − s_x x − s_y y.
///
/// Each of the three is prescribed or loaded. Exactly one of `load` and `approach` is given; along x and
/// along y at most one of `eccentricity` (which needs a load), `moment` and `tilt`. A direction without
/// any of them has a tilt of 0. Lengths and moments are about the origin x = y = 0.
///
/// ```
/// use nacre::Motion;
/// // Free to tilt along x only, under a force at x = 2.87 mm.
/// let motion = Motion { eccentricity: [Some(2.87e-3), None], ..Motion::load(1e3) };
/// assert_eq!(motion.load, Some(1e3));
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
pub struct Motion {
    /// Force Σ p dA \[N\], above 0.
    pub load: Option<f64>,
    /// Approach δ \[m\] of the origin, from the datum h = 0.
    pub approach: Option<f64>,
    /// Point (e_x, e_y) at which the load acts \[m\]: Σ p x dA = W e_x, along y alike.
    pub eccentricity: [Option<f64>; 2],
    /// First moments of the pressure \[N m\]: Σ p x dA = M_x, along y alike.
    pub moment: [Option<f64>; 2],
    /// Slopes s_x, s_y.
    pub tilt: [Option<f64>; 2],
}

impl Motion {
    /// A force `load` \[N\], with both tilts locked at 0.
    pub fn load(load: f64) -> Self {
        Self {
            load: Some(load),
            ..Self::default()
        }
    }

    /// This motion, with what it leaves open as in one `before`: load or approach, and on each axis the eccentricity,
    /// moment or tilt.
    pub(crate) fn after(mut self, before: &Self) -> Self {
        if self.load.is_none() && self.approach.is_none() {
            (self.load, self.approach) = (before.load, before.approach);
        }
        for axis in 0..2 {
            let given = [self.eccentricity[axis], self.moment[axis], self.tilt[axis]];
            if given == [None; 3] {
                self.eccentricity[axis] = before.eccentricity[axis];
                self.moment[axis] = before.moment[axis];
                self.tilt[axis] = before.tilt[axis];
            }
        }
        self
    }

    /// A prescribed `approach` \[m\], with both tilts locked at 0.
    pub fn approach(approach: f64) -> Self {
        Self {
            approach: Some(approach),
            ..Self::default()
        }
    }
}
