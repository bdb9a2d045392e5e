//! `nacre.LogarithmicProfile`.

use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;

use crate::model::surface::{FujiwaraKawase, LogarithmicProfile, Profile};
use crate::python::arguments::{Real, mapped, real};
use crate::python::value::{self, Arguments, Value, class};

class! {
    /// A logarithmic axial profile of a roller, straight over its middle where `flat_length` > 0.
    ///
    /// ``d(x) = A ln(1/(1 - f u**2))`` with ``u = (2|x| - flat_length)/(length - flat_length)``, +inf
    /// beyond ``|x| = length/2``.
    ///
    /// Parameters
    /// ----------
    /// amplitude : float
    ///     A [m], above 0.
    /// length : float
    ///     Whole length [m], above 0.
    /// flat_length : float, optional
    ///     Length of the straight part [m], at least 0 and below `length`.
    /// end_factor : float, optional
    ///     f, above 0 and at most 1; below 1 the drop at the ends is finite.
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     If an argument is out of range.
    ///
    /// Examples
    /// --------
    /// >>> profile = nacre.LogarithmicProfile.iso16281(diameter=10e-3, length=20e-3)
    /// >>> round(profile.amplitude * 1e6, 6)
    /// 3.5
    /// >>> roller = nacre.Roller(radius=5e-3, profile=profile)
    PyLogarithmicProfile(LogarithmicProfile) is "LogarithmicProfile" of "nacre";
    |of, py|
    arguments {
        /// Amplitude A [m].
        amplitude: f64 = of.amplitude();
        /// Whole length [m].
        length: f64 = of.length();
        /// Length of the straight part [m].
        flat_length: f64 = of.flat_length();
        /// End factor f.
        end_factor: f64 = of.end_factor();
    }
    attributes {}
    methods {
        #[new]
        #[pyo3(signature = (amplitude, length, flat_length=0.0, end_factor=1.0))]
        fn new(
            amplitude: Real,
            length: Real,
            #[pyo3(from_py_with = real)] flat_length: f64,
            #[pyo3(from_py_with = real)] end_factor: f64,
        ) -> PyResult<Self> {
            Ok(Self(LogarithmicProfile::new(amplitude.0, length.0, flat_length, end_factor)?))
        }

        /// Lundberg's profile: the pressure of this load is the same all along the roller.
        ///
        /// ``A = W/(pi L E*)``. Lundberg, Forsch. Ing.-Wes. 10 (1939) 201. No radius occurs in it: the profile
        /// is the same for any raceway.
        ///
        /// Parameters
        /// ----------
        /// length : float
        ///     Length L of the roller [m].
        /// load : float
        ///     Load W [N].
        /// contact_modulus : float
        ///     E* [Pa] of both bodies, as `nacre.hertz.contact_modulus` computes it.
        ///
        /// Returns
        /// -------
        /// LogarithmicProfile
        ///     The profile.
        ///
        /// Raises
        /// ------
        /// ValueError
        ///     If an argument is not finite and above 0.
        ///
        /// Examples
        /// --------
        /// >>> profile = nacre.LogarithmicProfile.lundberg(20e-3, load=20e3, contact_modulus=115e9)
        /// >>> round(profile.amplitude * 1e6, 4)
        /// 2.7679
        #[staticmethod]
        fn lundberg(length: Real, load: Real, contact_modulus: Real) -> PyResult<Self> {
            Ok(Self(LogarithmicProfile::lundberg(length.0, load.0, contact_modulus.0)?))
        }

        /// Johns and Gohar's profile: Lundberg's, with a finite drop at the ends.
        ///
        /// ``f = 1 - 0.3033 b/a`` with the Hertzian half-width b and the half-length a. Johns & Gohar,
        /// Tribol. Int. 14 (1981) 131.
        ///
        /// Parameters
        /// ----------
        /// length : float
        ///     Length of the roller [m].
        /// load : float
        ///     Load [N].
        /// contact_modulus : float
        ///     E* [Pa] of both bodies, as `nacre.hertz.contact_modulus` computes it.
        /// radius : float
        ///     Equivalent radius of roller and raceway [m], ``1/R = 1/R_1 + 1/R_2`` with R_2 below 0 for a
        ///     concave raceway; on a plane the roller's own.
        ///
        /// Returns
        /// -------
        /// LogarithmicProfile
        ///     The profile.
        ///
        /// Raises
        /// ------
        /// ValueError
        ///     If an argument is not finite and above 0.
        ///
        /// Examples
        /// --------
        /// >>> profile = nacre.LogarithmicProfile.johns_gohar(20e-3, 20e3, 115e9, radius=5e-3)
        /// >>> profile.end_factor < 1
        /// True
        #[staticmethod]
        fn johns_gohar(
            length: Real,
            load: Real,
            contact_modulus: Real,
            radius: Real,
        ) -> PyResult<Self> {
            Ok(Self(LogarithmicProfile::johns_gohar(length.0, load.0, contact_modulus.0, radius.0)?))
        }

        /// Fujiwara and Kawase's profile: Lundberg's with three design parameters.
        ///
        /// ``d(x) = A ln(1/(1 - (1 - exp(-z_m/A)) ((|x| - a)/(K_2 a) + 1)**2))`` for ``|x| >= a (1 - K_2)``,
        /// with ``A = K_1 W/(pi L E*)`` and the half-length a. The profile is straight in the middle, and its
        /// drop at the ends is z_m. With ``k1 = k2 = 1`` and a large z_m it is Lundberg's. Fujiwara & Kawase,
        /// NTN Technical Review 75 (2007) 140, where E' is 2 E*. No radius occurs in it.
        ///
        /// Parameters
        /// ----------
        /// length : float
        ///     Effective length L of the roller [m].
        /// load : float
        ///     Load W [N].
        /// contact_modulus : float
        ///     E* [Pa] of both bodies, as `nacre.hertz.contact_modulus` computes it.
        /// k1 : float
        ///     K_1, the ratio of the load for which the profile is made to `load`, above 0.
        /// k2 : float
        ///     K_2, the part of the half-length that is crowned, above 0 and at most 1.
        /// z_m : float
        ///     Drop at the ends [m], above 0.
        ///
        /// Returns
        /// -------
        /// LogarithmicProfile
        ///     The profile.
        ///
        /// Raises
        /// ------
        /// ValueError
        ///     If an argument is out of range.
        ///
        /// Examples
        /// --------
        /// >>> profile = nacre.LogarithmicProfile.fujiwara_kawase(
        /// ...     20e-3, load=20e3, contact_modulus=115e9, k1=1.5, k2=0.5, z_m=20e-6
        /// ... )
        /// >>> profile.flat_length, round(float(profile.drop_at(10e-3)) * 1e6, 6)
        /// (0.01, 20.0)
        #[staticmethod]
        fn fujiwara_kawase(
            length: Real,
            load: Real,
            contact_modulus: Real,
            k1: Real,
            k2: Real,
            z_m: Real,
        ) -> PyResult<Self> {
            let crown = FujiwaraKawase { k1: k1.0, k2: k2.0, z_m: z_m.0 };
            Ok(Self(LogarithmicProfile::fujiwara_kawase(length.0, load.0, contact_modulus.0, crown)?))
        }

        /// The profile of cylindrical rollers of ISO/TS 16281:2008, which DIN 26281 has too.
        ///
        /// ``0.00035 D ln(1/(1 - (2x/L)**2))`` for ``L <= 2.5 D``; for longer rollers
        /// ``0.0005 D ln(1/(1 - u**2))`` over the last 1.25 D at each end: section 5.2.3, equations
        /// (42) to (44), as programs quote them. Tapered rollers have 0.00045 D,
        /// `nacre.bearing.TaperedRoller`.
        ///
        /// Parameters
        /// ----------
        /// diameter : float
        ///     Diameter D of the roller itself [m], whatever the raceway.
        /// length : float
        ///     Effective length L [m].
        ///
        /// Returns
        /// -------
        /// LogarithmicProfile
        ///     The profile.
        ///
        /// Raises
        /// ------
        /// ValueError
        ///     If an argument is not finite and above 0.
        ///
        /// Examples
        /// --------
        /// >>> round(nacre.LogarithmicProfile.iso16281(diameter=10e-3, length=30e-3).flat_length, 9)
        /// 0.005
        #[staticmethod]
        fn iso16281(diameter: Real, length: Real) -> PyResult<Self> {
            Ok(Self(LogarithmicProfile::iso16281(diameter.0, length.0)?))
        }

        /// Drops at positions along the axis.
        ///
        /// Parameters
        /// ----------
        /// x : float or array_like
        ///     Positions from the middle [m], of any shape.
        ///
        /// Returns
        /// -------
        /// float or numpy.ndarray
        ///     Drops [m] in the shape of `x`; +inf beyond the ends.
        ///
        /// Raises
        /// ------
        /// TypeError
        ///     If the positions are not real numbers.
        ///
        /// Examples
        /// --------
        /// Roller and raceway with a profile each: the drops add.
        ///
        /// >>> roller = nacre.LogarithmicProfile.iso16281(diameter=10e-3, length=20e-3)
        /// >>> x = np.linspace(-9e-3, 9e-3, 91)
        /// >>> both = nacre.SampledProfile(x, roller.drop_at(x) + x**2 / (2 * 20.0))
        fn drop_at<'py>(&self, x: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
            let profile = Profile::from(self.0);
            mapped("x", x, |x| profile.drop(x))
        }
    }
}
