//! `nacre.Roller`.

use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;

use super::{profiles, shape_class};
use crate::error::Error;
use crate::model::surface::{CrownedProfile, Profile, Roller};
use crate::python::arguments::Real;

shape_class! {
    /// A roller, axis along x, with an axial profile d(x): ``h = R - sqrt((R - d)**2 - y**2)``.
    ///
    /// Crowned: ``d(x) = 0`` for ``|x| <= L = flat_length/2``, beyond it
    /// ``d = R_a - sqrt(R_a**2 - (|x| - L)**2)`` with ``R_a = crown_radius``. Spinu et al., The normal
    /// contact of finite length coated cylinders, eq. (3). Any other profile is averaged over each cell,
    /// so that the ends do not depend on where a cell's centre falls. On a raceway of radius ``R_2`` the gap
    /// has ``R_2 - sqrt(R_2**2 - y**2)`` added; the drop of a crowned raceway adds to that of the profile.
    ///
    /// Parameters
    /// ----------
    /// radius : float
    ///     Radius R [m], above 0.
    /// flat_length : float, optional
    ///     Length of the straight part [m], at least 0.
    /// crown_radius : float, optional
    ///     Radius R_a of the rounded ends [m], above 0.
    /// length : float, optional
    ///     Whole length [m], at least `flat_length`: the gap is +inf beyond its ends.
    /// profile : LogarithmicProfile, SampledProfile or tuple of array_like, optional
    ///     Another axial profile, in place of `flat_length` and `crown_radius`. ``(positions, drops)`` are two
    ///     arrays: places along the axis [m], and how far the surface has dropped there [m].
    /// counter_radius : float, optional
    ///     Radius R_2 of the raceway along y [m]: above 0 where it is convex, as of an inner ring, below 0
    ///     where it is concave, as of an outer ring, which must be wider than the roller. A plane where it is
    ///     infinite, and by default.
    /// apex : float, optional
    ///     Coordinate x [m] of the apex that a tapered roller and its raceway share; x is along the line of
    ///     contact, and both radii are those at x = 0 in the section normal to it. Cylinders by default.
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     If a length is out of range, there is neither a crown nor a profile, or both, a concave raceway
    ///     is not wider than the roller, or the apex is at 0.
    ///
    /// Examples
    /// --------
    /// >>> nacre.Roller(radius=5e-3, flat_length=19.13e-3, crown_radius=7.5)
    /// Roller(radius=0.005, flat_length=0.01913, crown_radius=7.5)
    /// >>> nacre.Roller(radius=5e-3, flat_length=8e-3, crown_radius=7.5, length=10e-3).ends
    /// (-0.005, 0.005)
    /// >>> outer = nacre.Roller(radius=5e-3, flat_length=8e-3, crown_radius=7.5, counter_radius=-30e-3)
    /// >>> round(outer.equivalent_radius, 9)
    /// 0.006
    PyRoller(Roller) is "Roller";
    |of, py|
    arguments {
        /// Radius [m].
        radius(Real): f64 = of.radius();
        /// Length of the straight part of a crowned roller [m].
        flat_length(Option<Real> = None): Option<f64> = crown(of).map(CrownedProfile::flat_length);
        /// Radius of the ends of a crowned roller [m].
        crown_radius(Option<Real> = None): Option<f64> = crown(of).map(CrownedProfile::crown_radius);
        /// Whole length [m] of a roller that is cut off; None for an endless one.
        length(Option<Real> = None): Option<f64> = of.length();
        /// Axial profile; None for a crowned roller.
        profile(Option<&Bound<'_, PyAny>> = None): Option<Bound<'py, PyAny>> = profiles::to_python(py, of.profile())?;
        /// Radius of the raceway along y [m], below 0 where it is concave; None for a plane.
        counter_radius(Option<Real> = None): Option<f64> = of.counter_radius();
        /// Coordinate x of the apex of a tapered roller [m]; None of a cylindrical one.
        apex(Option<Real> = None): Option<f64> = of.apex();
    }
    attributes {
        /// Coordinates x of both ends [m], which `HalfSpace` takes as those of the roller's body.
        ///
        /// They are half of ``length`` on either side, or the ends of a profile; None where a crown ends the
        /// roller.
        ends: (Option<f64>, Option<f64>) = of.ends().into();
        /// Equivalent radius of roller and raceway [m], ``1/(1/radius + 1/counter_radius)``.
        equivalent_radius: f64 = of.equivalent_radius();
    }
    make {
        let mut roller = match (flat_length, crown_radius, profile) {
            (Some(flat_length), Some(crown_radius), None) => {
                Roller::new(radius.0, flat_length.0, crown_radius.0)?
            }
            (None, None, Some(profile)) => {
                Roller::with_profile(radius.0, profiles::profile(profile)?)?
            }
            _ => {
                return Err(Error::Inconsistent(
                    "either flat_length and crown_radius or profile must be given",
                )
                .into());
            }
        };
        if let Some(length) = length {
            roller = roller.with_length(length.0)?;
        }
        if let Some(counter_radius) = counter_radius {
            roller = roller.with_counter_radius(counter_radius.0)?;
        }
        if let Some(apex) = apex {
            roller = roller.with_apex(apex.0)?;
        }
        roller
    }
}

fn crown(roller: &Roller) -> Option<&CrownedProfile> {
    match roller.profile() {
        Profile::Crowned(crown) => Some(crown),
        Profile::Logarithmic(_) | Profile::Sampled(_) => None,
    }
}
