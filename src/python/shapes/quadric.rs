//! `nacre.Sphere`, `nacre.Paraboloid`, `nacre.Cylinder` and `nacre.FlatPunch`.

use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;

use super::shape_class;
use crate::model::surface::{Cylinder, FlatPunch, Paraboloid, Sphere};
use crate::python::arguments::Real;

/// A radius, infinite where there is none, as in data.
fn or_flat(radius: Option<Real>) -> f64 {
    radius.map_or(f64::INFINITY, |radius| radius.0)
}

shape_class! {
    /// A sphere: ``h = R - sqrt(R**2 - r**2)``, +inf beyond R.
    ///
    /// On a counterpart that is curved itself, such as a groove or a socket, the gap has that of the
    /// counterpart added, a piece of a torus with the radii ``R_x`` and ``R_y``:
    /// ``d = R_x - sqrt(R_x**2 - x**2)`` for y = 0, ``R_y - sqrt((R_y - d)**2 - y**2)`` elsewhere.
    ///
    /// Parameters
    /// ----------
    /// radius : float
    ///     Radius [m], above 0.
    /// counter_radius_x, counter_radius_y : float, optional
    ///     Radii of the counterpart along x and y [m]: above 0 where it is convex, below 0 where it is concave
    ///     (a raceway, a groove, a socket), which must be wider than the sphere. Straight where infinite, and by default.
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     If the radius is not finite and above 0, or a concave counterpart is not wider.
    ///
    /// Examples
    /// --------
    /// >>> nacre.Sphere(radius=5e-3)
    /// Sphere(radius=0.005)
    ///
    /// A ball in the groove of an inner ring, which is concave across x and convex along y:
    ///
    /// >>> ball = nacre.Sphere(5e-3, counter_radius_x=-5.2e-3, counter_radius_y=20e-3)
    /// >>> round(ball.equivalent_radius_x, 9), round(ball.equivalent_radius_y, 9)
    /// (0.13, 0.004)
    PySphere(Sphere) is "Sphere";
    |of, py|
    arguments {
        /// Radius [m].
        radius(Real): f64 = of.radius();
        /// Radius of the counterpart along x [m], below 0 where it is concave; None where it is straight.
        counter_radius_x(Option<Real> = None): Option<f64> = of.counter_radii()[0];
        /// Radius of the counterpart along y [m], below 0 where it is concave; None where it is straight.
        counter_radius_y(Option<Real> = None): Option<f64> = of.counter_radii()[1];
    }
    attributes {
        /// Equivalent radius along x [m], ``1/(1/R + 1/R_x)``.
        equivalent_radius_x: f64 = of.equivalent_radii()[0];
        /// Equivalent radius along y [m], ``1/(1/R + 1/R_y)``.
        equivalent_radius_y: f64 = of.equivalent_radii()[1];
    }
    make {
        let counter = [counter_radius_x, counter_radius_y].map(|radius| radius.map(|r| r.0));
        Sphere::new(radius.0)?.with_counter_radii(counter)?
    }
}

shape_class! {
    /// An elliptic paraboloid: ``h = x**2/(2 R_x) + y**2/(2 R_y)``.
    ///
    /// On a counterpart that is curved itself, R_x and R_y are the equivalent radii of both:
    /// ``1/R = 1/radius + 1/counter_radius``.
    ///
    /// Parameters
    /// ----------
    /// radius_x, radius_y : float
    ///     Radii of curvature at the apex [m], above 0; infinite where the shape is straight. A shape that is straight in
    ///     a direction needs a grid.
    /// counter_radius_x, counter_radius_y : float, optional
    ///     Radii of the counterpart along x and y [m]: above 0 where it is convex, below 0 where it is concave
    ///     (a raceway, a groove), which must be wider than the paraboloid. Straight where infinite, and by default.
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     If a radius is not above 0, or a concave counterpart is not wider.
    ///
    /// Examples
    /// --------
    /// >>> nacre.Paraboloid(5e-3, 5e-3)
    /// Paraboloid(radius_x=0.005, radius_y=0.005)
    PyParaboloid(Paraboloid) is "Paraboloid";
    |of, py|
    arguments {
        /// Radius of curvature along x [m]; inf where the shape is straight.
        radius_x(Option<Real>): f64 = of.radius_x();
        /// Radius of curvature along y [m]; inf where the shape is straight.
        radius_y(Option<Real>): f64 = of.radius_y();
        /// Radius of the counterpart along x [m], below 0 where it is concave; None where it is straight.
        counter_radius_x(Option<Real> = None): Option<f64> = of.counter_radii()[0];
        /// Radius of the counterpart along y [m], below 0 where it is concave; None where it is straight.
        counter_radius_y(Option<Real> = None): Option<f64> = of.counter_radii()[1];
    }
    attributes {
        /// Equivalent radius along x [m], ``1/(1/radius_x + 1/counter_radius_x)``.
        equivalent_radius_x: f64 = of.equivalent_radii()[0];
        /// Equivalent radius along y [m], ``1/(1/radius_y + 1/counter_radius_y)``.
        equivalent_radius_y: f64 = of.equivalent_radii()[1];
    }
    make {
        let counter = [counter_radius_x, counter_radius_y].map(|radius| radius.map(|r| r.0));
        let [radius_x, radius_y] = [radius_x, radius_y].map(or_flat);
        Paraboloid::new(radius_x, radius_y)?.with_counter_radii(counter)?
    }
}

shape_class! {
    /// An endless cylinder, axis along x: ``h = R - sqrt(R**2 - y**2)``, +inf beyond R.
    ///
    /// The contact is as long as the grid, which must be given. On a raceway of radius ``R_2`` the gap has
    /// ``R_2 - sqrt(R_2**2 - y**2)`` added.
    ///
    /// Parameters
    /// ----------
    /// radius : float
    ///     Radius [m], above 0; infinite for a plane.
    /// counter_radius : float, optional
    ///     Radius R_2 of the raceway along y [m]: above 0 where it is convex, as of an inner ring, below 0
    ///     where it is concave, as of an outer ring, which must be wider than the cylinder. A plane where it is
    ///     infinite, and by default.
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     If the radius is not above 0, or a concave raceway is not wider.
    ///
    /// Examples
    /// --------
    /// >>> nacre.Cylinder(radius=5e-3)
    /// Cylinder(radius=0.005)
    PyCylinder(Cylinder) is "Cylinder";
    |of, py|
    arguments {
        /// Radius [m]; inf for a plane.
        radius(Option<Real>): f64 = of.radius();
        /// Radius of the raceway along y [m], below 0 where it is concave; None for a plane.
        counter_radius(Option<Real> = None): Option<f64> = of.counter_radius();
    }
    attributes {
        /// Equivalent radius [m], ``1/(1/radius + 1/counter_radius)``.
        equivalent_radius: f64 = of.equivalent_radius();
    }
    make {
        let cylinder = Cylinder::new(or_flat(radius))?;
        match counter_radius {
            Some(counter_radius) => cylinder.with_counter_radius(counter_radius.0)?,
            None => cylinder,
        }
    }
}

shape_class! {
    /// A flat circular punch: ``h = 0`` for ``r <= a``, +inf beyond.
    ///
    /// Parameters
    /// ----------
    /// radius : float
    ///     Radius a [m], above 0.
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     If the radius is not finite and above 0.
    ///
    /// Examples
    /// --------
    /// >>> nacre.FlatPunch(radius=1e-3)
    /// FlatPunch(radius=0.001)
    PyFlatPunch(FlatPunch) is "FlatPunch";
    |of, py|
    arguments {
        /// Radius [m].
        radius(Real): f64 = of.radius();
    }
    attributes {}
    make {
        FlatPunch::new(radius.0)?
    }
}
