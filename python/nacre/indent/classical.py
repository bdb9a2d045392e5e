"""What customary formulae make of an indentation curve, and their bias."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

import nacre._core as core
from nacre.indent._segments import OUTLIER, noise_of
from nacre.indent.curves import Curve
from nacre.indent.solution import Indentation
from nacre.indent.unloading import EPSILON, section

__all__ = ["Classical", "classical", "gao_weights", "tabor_parameter"]

Array = npt.NDArray[np.float64]

UPPER = 0.4
"""Share of the largest depth from which on points count for the slope at the largest force."""
FALLEN, BORNE = 0.02, 5.0
"""Share of the largest force that counts as none, beside the noise, and how many times that an
elastic body bears where an unloading curve has it: 10 % of the force of a cone are at 0.3 of its
depth, where an error of the body's moduli or of a thickness changes this by less than twice."""
STIFFER = 10.0
"""Ratio of base to layer from which a base counts as rigid for Dimitriadis' series."""


def tabor_parameter(
    radius: float,
    modulus: float,
    work: float,
    *,
    distance: float | None = None,
    strength: float | None = None,
) -> float:
    """Tabor's parameter μ, which says which model of adhesion holds: JKR or DMT.

    ``μ = (R w² / (E*² z0³))**(1/3)`` is the neck of the surfaces over the reach of their
    attraction: JKR above some 5, DMT below some 0.1, Maugis's model in between (Johnson and
    Greenwood, 1997, doi:10.1006/jcis.1997.4984).

    Parameters
    ----------
    radius : float
        Radius of the sphere, or the equivalent radius of two [m].
    modulus : float
        E* of both bodies [Pa]; where a coating is thick compared with the contact, that of the
        coating.
    work : float
        Work of adhesion [J/m²].
    distance : float, optional
        Equilibrium distance z0 of the surfaces [m], some 0.2 to 0.4 nm.
    strength : float, optional
        In place of it, the largest attraction σ0 [Pa], as of `Adhesion.maugis`: that of the
        Lennard-Jones law, ``z0 = 16 w / (9 sqrt(3) σ0)``.

    Returns
    -------
    float
        Tabor's parameter. Maugis's λ is 1.157 times it.

    Raises
    ------
    ValueError
        If a number is not above 0, or not exactly one of distance and strength is given.

    Examples
    --------
    >>> round(nacre.indent.tabor_parameter(10e-6, 1e6, 0.05, distance=0.3e-9), 1)
    974.7
    """
    ranges = {"distance": distance, "strength": strength}
    choice = {name: value for name, value in ranges.items() if value is not None}
    if len(choice) != 1:
        raise ValueError(f"exactly one of distance and strength must be given, got {ranges}")
    numbers = {"radius": radius, "modulus": modulus, "work": work, **choice}
    for name, value in numbers.items():
        numbers[name] = core.real(name, value)
        if not 0 < numbers[name] < math.inf:
            raise ValueError(f"{name} must be positive and finite, got {value!r}")
    radius, modulus, work, _ = numbers.values()
    if "strength" in numbers:
        distance = 16 * work / (9 * math.sqrt(3) * numbers["strength"])
    else:
        distance = numbers["distance"]
    return float((radius * work**2 / (modulus**2 * distance**3)) ** (1 / 3))


class Classical(NamedTuple):
    """An estimate of a reduced modulus by a customary formula."""

    method: str
    """Name of the formula."""
    modulus: float
    """Reduced modulus of the layer at the surface, as the formula has it [Pa]."""
    bias: float
    """Relative difference from the reduced modulus of that layer in the body."""
    source: str
    """Author, year and equation."""


def classical(curve: Curve, body: core.HalfSpace | core.Elastic, tip: core.Tip) -> list[Classical]:
    """Return what customary formulae say of a curve, against a body that is known.

    Parameters
    ----------
    curve : Curve
        Elastic curve whose zero is the contact.
    body : HalfSpace or Elastic
        Body, such as that of a fit. Formulae that correct for the substrate take its constants and
        the thickness of the first layer from here.
    tip : Tip
        Rigid tip.

    Returns
    -------
    list of Classical
        Estimates of the reduced modulus E* = E/(1 − ν²) of the layer at the surface.

    Raises
    ------
    ValueError
        If the curve has no contact, or its force falls to zero where the body would bear some: it
        is the unloading of an indent that yielded, see `oliver_pharr`.

    Notes
    -----
    Formulae without a correction: Hertz' or Sneddon's law of a bare body at the largest depth and
    by least squares; Oliver and Pharr, J. Mater. Res. 7 (1992) 1564-1583,
    doi:10.1557/JMR.1992.1564, S = 2 a E* with the area at the depth of contact δ − 0.75 P/S. With a
    correction for the substrate: Gao, Chiu and Lee, Int. J. Solids Struct. 29 (1992) 2471-2492,
    whose functions weigh shear moduli and Poisson's ratios, exactly to first order in the
    difference of the materials; Dimitriadis et al., Biophys. J. 82 (2002) 2798-2810,
    doi:10.1016/S0006-3495(02)75620-8, eq. (12), the series for a sphere on a thin incompressible
    layer bonded to a rigid base.

    Examples
    --------
    >>> steel, tip = nacre.Elastic(210e9, 0.3), nacre.indent.Tip.paraboloid(10e-6)
    >>> depth = np.linspace(1e-9, 100e-9, 50)
    >>> made = nacre.indent.Indentation(steel, tip).curve(approach=depth)
    >>> from nacre.indent.classical import classical
    >>> rows = classical(nacre.indent.Curve(depth, made.load), steel, tip)
    >>> [(row.method, abs(round(row.bias, 2))) for row in rows]
    [('Hertz, largest depth', 0.0), ('Hertz, least squares', 0.0), ('Oliver and Pharr', 0.0)]
    """
    if isinstance(body, core.Elastic):
        body = core.HalfSpace(body)
    top = body.layers[0].material if body.layers else body.substrate
    if not isinstance(top, core.Elastic):
        raise ValueError("body must have an elastic surface, got a rigid one")
    true = top.plane_strain_modulus
    touching = (curve.depth > 0) & (curve.force > 0)
    if touching.sum() < 3:
        raise ValueError(f"curve must have three points in contact, got {int(touching.sum())}")
    order = np.argsort(curve.depth[touching], kind="stable")
    depth, force = curve.depth[touching][order], curve.force[touching][order]
    _refuse_unloading(depth, force, body, tip)
    unit = Indentation(core.HalfSpace(core.Elastic(1.0, 0.0)), tip)
    bare = np.asarray(unit.curve(approach=depth).load)
    law = {"cone": "Sneddon", "power": "Sneddon", "flat_punch": "Sneddon"}.get(tip.kind, "Hertz")
    rows: list[tuple[str, float, str]] = [
        (f"{law}, largest depth", float(force[-1] / bare[-1]), "Hertz 1882, Sneddon 1965"),
        (f"{law}, least squares", float(force @ bare / (bare @ bare)), "Hertz 1882, Sneddon 1965"),
    ]
    estimate = _apparent(depth, force, tip)
    if estimate is not None:
        apparent, radius = estimate
        rows.append(("Oliver and Pharr", apparent, "Oliver, Pharr 1992"))
        rows += _layer_modulus(body, top, apparent, radius)
    if series := _dimitriadis(body, top, depth, force, tip):
        rows.append(("Dimitriadis", series, "Dimitriadis et al. 2002, eq. (12)"))
    return [Classical(name, value, value / true - 1, source) for name, value, source in rows]


def _refuse_unloading(depth: Array, force: Array, body: core.HalfSpace, tip: core.Tip) -> None:
    """Refuse a curve whose force falls to zero at a depth at which the body would bear some."""
    noise = noise_of(force) if force.size > 3 else 0.0
    low = max(FALLEN, OUTLIER * noise / float(force.max())) * float(force.max())
    small = np.flatnonzero(force <= low)
    if not small.size:
        return
    zero = float(depth[small[-1]])
    elastic = Indentation(body, tip).curve(approach=[zero, float(depth[-1])]).load
    if elastic[0] > BORNE * low / float(force.max()) * elastic[1]:
        raise ValueError(
            f"curve must be elastic, with its zero at the contact: its force falls to "
            f"{force[small[-1]]:.3g} at the depth {zero:.4g} of {depth[-1]:.4g}, so that it is the "
            "unloading curve of an indent that yielded, for which oliver_pharr(curve, tip) is, or "
            "its zero is another, see contact_point"
        )


def _apparent(depth: Array, force: Array, tip: core.Tip) -> tuple[float, float] | None:
    """Return reduced modulus and contact radius at the largest depth.

    The slope is that of a parabola of the logarithms, whose points are the deeper ones. None where
    the depth of contact is not positive.
    """
    reach = float(depth[-1])
    upper = depth >= min(UPPER * reach, float(np.sort(depth)[-3]))
    _, tilt, there = np.polyfit(np.log(depth[upper] / reach), np.log(force[upper]), 2)
    load = math.exp(there)
    slope = float(tilt) * load / reach
    if slope <= 0:
        return None
    contact = reach - EPSILON * load / slope
    radius = _radius(tip, contact)
    if radius is None:
        return None
    return slope / (2 * radius), radius


def _radius(tip: core.Tip, depth: float) -> float | None:
    """Return the radius of the tip's section at a depth from its apex."""
    if depth <= 0 and tip.kind != "flat_punch":
        return None
    if tip.kind in ("paraboloid", "sphere"):
        # The customary form for spheres is that of a paraboloid.
        return math.sqrt(2 * float(tip.numbers["radius"]) * depth)
    return section(tip, depth)


def _layer_modulus(
    body: core.HalfSpace, top: core.Elastic, apparent: float, radius: float
) -> list[tuple[str, float, str]]:
    """Return the modulus of the layer by a correction of an apparent modulus for the substrate."""
    base = body.substrate
    if len(body.layers) != 1 or not isinstance(base, core.Elastic):
        return []
    shear, lateral = gao_weights(body.layers[0].thickness / radius, top.poisson)
    poisson = 1 - base.poisson + (base.poisson - top.poisson) * lateral
    mixed = 0.5 * apparent * poisson
    modulus = 2 * (base.shear + (mixed - base.shear) / shear) / (1 - top.poisson)
    # A negative value means that the correction has no solution.
    return [("Gao", modulus if modulus > 0 else math.nan, "Gao, Chiu, Lee 1992")]


def gao_weights(ratio: float, poisson: float) -> tuple[float, float]:
    """Return Gao's functions I0 (of the shear modulus) and I1 (of Poisson's ratio) at h/a.

    ``I0 = 2/π atan ξ + [(1 − 2ν) ξ ln(1 + 1/ξ²) − ξ/(1 + ξ²)]/(2π (1 − ν))``,
    ``I1 = 2/π atan ξ + ξ/π ln(1 + 1/ξ²)``.
    """
    log = ratio * math.log1p(1 / ratio**2)
    poisson_term = (1 - 2 * poisson) * log - ratio / (1 + ratio**2)
    base = 2 / math.pi * math.atan(ratio)
    return base + poisson_term / (2 * math.pi * (1 - poisson)), base + log / math.pi


def _dimitriadis(
    body: core.HalfSpace, top: core.Elastic, depth: Array, force: Array, tip: core.Tip
) -> float | None:
    """Return the reduced modulus of a thin layer on a rigid base, by least squares."""
    if tip.kind not in ("paraboloid", "sphere") or len(body.layers) != 1:
        return None
    base = body.substrate
    if isinstance(base, core.Elastic) and base.young < STIFFER * top.young:
        return None
    radius = float(tip.numbers["radius"])
    x = np.sqrt(radius * depth) / body.layers[0].thickness
    series = 1 + 1.133 * x + 1.283 * x**2 + 0.769 * x**3 + 0.0975 * x**4
    shape = 4 / 3 * math.sqrt(radius) * depth**1.5 * series
    return float(force @ shape / (shape @ shape))
