"""Closed forms for the contact of curved bodies, after Hertz.

They hold for smooth homogeneous bodies, on a contact that is small compared with their radii.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Self, overload

import nacre._core as core
from nacre._tools.typing import Field, Matrix, Pair, Vector

Places = float | Vector | Matrix

__all__ = ["Ellipse", "Line", "Point", "contact_modulus", "equivalent_radius", "relative_radii"]
__dir__ = __all__.copy


def _or_straight(radius: float | None) -> float | None:
    """Return a radius, None where it is infinite."""
    return None if isinstance(radius, float) and math.isinf(radius) else radius


def equivalent_radius(radius: float | None, counter_radius: float | None = None) -> float:
    """Equivalent radius of two surfaces in contact, in one direction: ``1/R = 1/R_1 + 1/R_2``.

    Parameters
    ----------
    radius : float or None
        Radius R_1 [m]: above 0 where the surface is convex, below 0 where it is concave; None or
        infinite where it is straight.
    counter_radius : float, optional
        Radius R_2 of the other surface [m], likewise; below 0 for a raceway of an outer ring or a
        groove.

    Returns
    -------
    float
        Equivalent radius R [m].

    Raises
    ------
    ValueError
        If a radius is 0 or not a number, or 1/R is not above 0.

    Examples
    --------
    A roller of 5 mm on an inner ring of 20 mm and in an outer ring of 30 mm:

    >>> round(nacre.hertz.equivalent_radius(5e-3, 20e-3), 9)
    0.004
    >>> round(nacre.hertz.equivalent_radius(5e-3, -30e-3), 9)
    0.006
    """
    return core.equivalent_radius(radius, counter_radius)


def relative_radii(
    radii: tuple[float | None, float | None],
    counter_radii: tuple[float | None, float | None],
    angle: float,
) -> tuple[Pair, float]:
    """Principal relative radii of two surfaces at an angle, as of crossed cylinders.

    Johnson, Contact Mechanics (1985), eqs (4.4) and (4.5), doi:10.1017/CBO9781139171731.

    Parameters
    ----------
    radii : tuple of float or None
        Radii of one surface along its principal axes x and y [m]: above 0 where it is convex,
        below 0 where it is concave; None or infinite where it is straight.
    counter_radii : tuple of float or None
        Radii of the other surface along its own axes [m], likewise.
    angle : float
        Angle from the x axis of the one surface to that of the other [rad].

    Returns
    -------
    tuple of float
        Relative radii [m], the longer first: those of `nacre.Paraboloid` and `Ellipse`, whose x
        axis then lies along the longer radius.
    float
        Angle from the x axis of the one surface to that of the longer radius [rad], above -pi/2
        and at most pi/2.

    Raises
    ------
    TypeError
        If radii are not pairs of real numbers or None.
    ValueError
        If a radius is 0 or not a number, the angle is not finite, or the surfaces are not convex
        together in every direction, as parallel cylinders are not.

    Examples
    --------
    Two cylinders of 8 mm, crossed at 60 degrees:

    >>> radii, turn = nacre.hertz.relative_radii((None, 8e-3), (None, 8e-3), np.pi / 3)
    >>> [round(radius * 1e3, 6) for radius in radii], round(turn * 180 / np.pi, 6)
    ([16.0, 5.333333], 30.0)
    >>> crossed = nacre.Paraboloid(*radii)
    """
    return core.relative_radii(radii, counter_radii, angle)


def contact_modulus(body: core.Elastic, counterbody: core.Elastic | None = None) -> float:
    """Contact modulus of two bodies: ``1/E* = (1 - nu_1**2)/E_1 + (1 - nu_2**2)/E_2``.

    Parameters
    ----------
    body : Elastic
        Material of one body.
    counterbody : Elastic, optional
        Material of the other body; rigid by default.

    Returns
    -------
    float
        Contact modulus E* [Pa].

    Raises
    ------
    TypeError
        If an argument is not a material.

    Examples
    --------
    >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    >>> round(nacre.hertz.contact_modulus(steel, steel) / 1e9, 3)
    115.385
    """
    return core.contact_modulus(body, counterbody)


class _Hertzian:
    """A contact after Hertz: a frozen dataclass of its arguments, with what follows from them."""

    _contact: core.Hertz
    __match_args__: tuple[str, ...]

    def _keep(self, contact: core.Hertz, **fields: float | Pair | None) -> None:
        """Keep the contact, its arguments as floats, and what was found."""
        for name in self.__match_args__:
            argument = getattr(self, name)
            fields[name] = None if argument is None else float(argument)
        self.__dict__.update(fields, _contact=contact)

    def max_shear(self, poisson: float) -> Pair:
        """Largest shear stress below the middle of the contact, and its depth.

        Parameters
        ----------
        poisson : float
            Poisson's ratio of the body that is looked at.

        Returns
        -------
        tuple of float
            Half the difference of the principal stresses [Pa] and the depth [m].

        Raises
        ------
        ValueError
            Unless `poisson` is above -1 and at most 0.5.

        Examples
        --------
        >>> contact = nacre.hertz.Point(radius=5e-3, contact_modulus=115e9, load=10.0)
        >>> stress, depth = contact.max_shear(poisson=0.3)
        >>> round(stress / contact.peak_pressure, 3), round(depth / contact.contact_radius, 2)
        (0.31, 0.48)
        """
        return self._contact.max_shear(poisson)

    def __reduce__(self) -> tuple[type[Self], tuple[object, ...]]:
        """Return the class and the arguments that make the contact again."""
        return type(self), tuple(getattr(self, name) for name in self.__match_args__)


@dataclass(frozen=True)
class Point(_Hertzian):
    """Contact of two bodies that are round: a ball on a plane, on a ball or in a socket.

    Johnson, Contact Mechanics (1985), eqs (4.22)-(4.24), doi:10.1017/CBO9781139171731.

    Parameters
    ----------
    radius : float
        Equivalent radius R of both bodies [m]; see `equivalent_radius`.
    contact_modulus : float
        E* of both bodies [Pa]; see `contact_modulus`.
    load : float
        Force W [N].

    Raises
    ------
    ValueError
        If an argument is not finite and above 0.

    Examples
    --------
    >>> contact = nacre.hertz.Point(radius=5e-3, contact_modulus=115e9, load=10.0)
    >>> f"{contact.peak_pressure / 1e6:.1f} MPa, {contact.contact_radius * 1e6:.2f} um"
    '1007.8 MPa, 68.83 um'
    """

    radius: float
    """Equivalent radius [m]."""
    contact_modulus: float
    """Contact modulus E* [Pa]."""
    load: float
    """Force [N]."""
    contact_radius: float = field(init=False, repr=False, compare=False)
    """Radius of the contact ``a = (3 W R/4 E*)**(1/3)`` [m]."""
    peak_pressure: float = field(init=False, repr=False, compare=False)
    """Peak pressure ``p0 = 3 W/(2 pi a**2)`` [Pa]."""
    approach: float = field(init=False, repr=False, compare=False)
    """Approach ``a**2/R`` [m]."""

    def __post_init__(self) -> None:
        """Find what follows from the arguments."""
        contact = core.Hertz.point(self.radius, self.contact_modulus, self.load)
        radius, peak, approach = contact.numbers()
        self._keep(contact, contact_radius=radius, peak_pressure=peak, approach=approach)

    @overload
    def pressure(self, r: float) -> float: ...
    @overload
    def pressure(self, r: Vector | Matrix) -> Field: ...
    def pressure(self, r: Places) -> float | Field:
        """Pressure at distances from the axis.

        Parameters
        ----------
        r : float or array_like
            Distances [m], of any shape.

        Returns
        -------
        float or numpy.ndarray
            Pressures [Pa] in the shape of `r`.

        Raises
        ------
        TypeError
            If the distances are not real numbers.

        Examples
        --------
        >>> contact = nacre.hertz.Point(radius=5e-3, contact_modulus=115e9, load=10.0)
        >>> contact.pressure(0.0) == contact.peak_pressure
        True
        """
        pressure: float | Field = self._contact.pressure(["r"], [r])
        return pressure


@dataclass(frozen=True)
class Line(_Hertzian):
    """Contact of two parallel cylinders, per unit length: a roller on a plane or on a raceway.

    Johnson, Contact Mechanics (1985), eqs (4.43)-(4.45), doi:10.1017/CBO9781139171731. The approach
    of a line contact has no limit on a half-space, and is not among the attributes: it depends on a
    datum in each body. Two rollers approach by the sum of
    ``W' (1 - poisson**2)/(pi young) (2 log(4 radius/half_width) - 1)`` over both, with the radius
    of each, from axis to axis (section 5.6).

    Parameters
    ----------
    radius : float
        Equivalent radius R of both bodies [m]; see `equivalent_radius`.
    contact_modulus : float
        E* of both bodies [Pa]; see `contact_modulus`.
    line_load : float
        Force per unit length W' [N/m].

    Raises
    ------
    ValueError
        If an argument is not finite and above 0.

    Examples
    --------
    >>> contact = nacre.hertz.Line(radius=6e-3, contact_modulus=115e9, line_load=1e5)
    >>> f"{contact.peak_pressure / 1e6:.1f} MPa, {contact.half_width * 1e6:.2f} um"
    '781.1 MPa, 81.50 um'
    >>> stress, depth = contact.max_shear(poisson=0.3)
    >>> round(stress / contact.peak_pressure, 3), round(depth / contact.half_width, 3)
    (0.3, 0.786)
    """

    radius: float
    """Equivalent radius [m]."""
    contact_modulus: float
    """Contact modulus E* [Pa]."""
    line_load: float
    """Force per unit length [N/m]."""
    half_width: float = field(init=False, repr=False, compare=False)
    """Half-width of the contact ``b = (4 W' R/(pi E*))**(1/2)`` [m]."""
    peak_pressure: float = field(init=False, repr=False, compare=False)
    """Peak pressure ``p0 = 2 W'/(pi b)`` [Pa]."""

    def __post_init__(self) -> None:
        """Find what follows from the arguments."""
        contact = core.Hertz.line(self.radius, self.contact_modulus, self.line_load)
        half_width, peak = contact.numbers()
        self._keep(contact, half_width=half_width, peak_pressure=peak)

    @overload
    def pressure(self, y: float) -> float: ...
    @overload
    def pressure(self, y: Vector | Matrix) -> Field: ...
    def pressure(self, y: Places) -> float | Field:
        """Pressure at distances from the middle.

        Parameters
        ----------
        y : float or array_like
            Distances [m], of any shape.

        Returns
        -------
        float or numpy.ndarray
            Pressures [Pa] in the shape of `y`.

        Raises
        ------
        TypeError
            If the distances are not real numbers.

        Examples
        --------
        >>> contact = nacre.hertz.Line(radius=6e-3, contact_modulus=115e9, line_load=1e5)
        >>> contact.pressure(0.0) == contact.peak_pressure
        True
        """
        pressure: float | Field = self._contact.pressure(["y"], [y])
        return pressure


@dataclass(frozen=True)
class Ellipse(_Hertzian):
    """Contact of two bodies that are curved differently along x and y, as a ball in a groove.

    The radii are signed: above 0 where a surface is convex, below 0 where it is concave, None or
    infinite where it is straight. Johnson, Contact Mechanics (1985), eqs (4.25)-(4.32),
    doi:10.1017/CBO9781139171731.

    Parameters
    ----------
    radius_x, radius_y : float or None
        Radii of one body along x and y [m].
    contact_modulus : float
        E* of both bodies [Pa]; see `contact_modulus`.
    load : float
        Force W [N].
    counter_radius_x, counter_radius_y : float, optional
        Radii of the other body along x and y [m].

    Raises
    ------
    ValueError
        If modulus or load are not finite and above 0, or the bodies are not convex together in a
        direction.

    Examples
    --------
    A ball in the groove of an inner ring:

    >>> contact = nacre.hertz.Ellipse(
    ...     5e-3, 5e-3, contact_modulus=115.4e9, load=1e3,
    ...     counter_radius_x=-5.2e-3, counter_radius_y=20e-3,
    ... )
    >>> a, b = contact.semi_axes
    >>> round(a / b, 2)
    9.32
    >>> stress, depth = contact.max_shear(poisson=0.3)
    >>> round(stress / contact.peak_pressure, 2), round(depth / min(a, b), 2)
    (0.32, 0.77)
    """

    radius_x: float | None
    """Radius of the one body along x [m]; None where it is straight."""
    radius_y: float | None
    """Radius of the one body along y [m]; None where it is straight."""
    contact_modulus: float
    """Contact modulus E* [Pa]."""
    load: float
    """Force [N]."""
    counter_radius_x: float | None = None
    """Radius of the other body along x [m]; None where it is straight."""
    counter_radius_y: float | None = None
    """Radius of the other body along y [m]; None where it is straight."""
    semi_axes: Pair = field(init=False, repr=False, compare=False)
    """Semi-axes of the contact along x and y [m]."""
    peak_pressure: float = field(init=False, repr=False, compare=False)
    """Peak pressure ``p0 = 3 W/(2 pi a b)`` [Pa]."""
    approach: float = field(init=False, repr=False, compare=False)
    """Approach [m]."""

    def __post_init__(self) -> None:
        """Find what follows from the arguments."""
        for name in self.__match_args__:
            if "radius" in name:
                self.__dict__[name] = _or_straight(getattr(self, name))
        contact = core.Hertz.ellipse(*(getattr(self, name) for name in self.__match_args__))
        a, b, peak, approach = contact.numbers()
        self._keep(contact, semi_axes=(a, b), peak_pressure=peak, approach=approach)

    @overload
    def pressure(self, x: float, y: float) -> float: ...
    @overload
    def pressure(self, x: Vector | Matrix, y: Vector | Matrix) -> Field: ...
    def pressure(self, x: Places, y: Places) -> float | Field:
        """Pressure at points of the surface.

        Parameters
        ----------
        x, y : float or array_like
            Coordinates from the middle [m], of the same shape.

        Returns
        -------
        float or numpy.ndarray
            Pressures [Pa] in the shape of `x`.

        Raises
        ------
        TypeError
            If the coordinates are not real numbers.
        ValueError
            If they are not of the same shape.

        Examples
        --------
        >>> contact = nacre.hertz.Ellipse(1e-2, 5e-3, contact_modulus=115.4e9, load=10.0)
        >>> a, b = contact.semi_axes
        >>> contact.pressure([0.0, a, 0.0], [0.0, 0.0, b]) / contact.peak_pressure
        array([1., 0., 0.])
        """
        pressure: float | Field = self._contact.pressure(["x", "y"], [x, y])
        return pressure
