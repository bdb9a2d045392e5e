"""Thickness of the oil film in a rolling contact, by formulae of elastohydrodynamic lubrication.

With the entrainment speed u, the viscosity η₀ at ambient pressure, its coefficient α, the radius R
in the direction of rolling and ``E' = 2 E*`` of the substrates, ``U = η₀ u/(E' R)``, ``G = α E'``,
and ``W = F/(E' R²)``, or ``w/(E' R)`` of a load per length w. Films are ``h = H R``. All formulae
are fits to isothermal, smooth, fully flooded, bare contacts. Tags say how far they are checked:
seen in public programs, or derived here.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

import nacre._core as core
from nacre._tools.groups import with_units
from nacre._tools.notices import warn
from nacre._tools.units import symbol
from nacre.bearing.geometry import above
from nacre.contact.solution import Solution, check_unyielded
from nacre.hertz import contact_modulus
from nacre.results.quantities import Quantity, frozen, quantity
from nacre.results.rows import Row, remark
from nacre.results.shown import TableResult

SEPARATED = 3.0
"""Ratio λ of film and roughness from which surfaces count as separated: a convention."""
FITTED = {"U": (1.68e-12, 5.05e-11), "W": (1.1e-7, 1.3e-6), "G": (2310.0, 6790.0), "k": (1.0, 8.0)}
"""Ranges of the cases to which Hamrock and Dowson fitted (1977), as quoted.

Their abstract gives k and the orders of magnitude.
"""
THICKEST = 1e6
"""Largest G of any oil, roughly: with steel, of 4e-6 1/Pa."""
SLOWEST, FASTEST = 1e-20, 1e-2
"""Limits of U, far beyond which numbers overflow: fits have some 1e-11, soft bodies up to 1e-5."""
FLAT = 1e-9
"""Rise of a shape over the displacement below which it is rounding, of 1e-16 of both."""
COATED = (
    "the film is computed for bare substrates: layers no thicker than b/2, half of the half-width, "
    "change it by some -10 to +12 %, an estimate that nacre's tests do not check"
)


@frozen()
class Film(TableResult):
    """Oil film in a contact, after formulae for bare smooth bodies: a model.

    Examples
    --------
    >>> from nacre.bearing import film_thickness
    >>> steel = nacre.Elastic(young=206e9, poisson=0.3)
    >>> solution = nacre.solve(nacre.Sphere(10e-3), steel, steel, load=15.0)
    >>> film = film_thickness(solution, speed=1.0, viscosity=0.04, pressure_viscosity=20e-9)
    >>> film.regime, film.minimum < film.central
    ('piezoviscous-elastic', True)
    """

    _TITLE = "oil film in a contact"

    central: float = quantity("m", label="central film")
    """Central thickness of the film [m]."""
    minimum: float = quantity("m", label="smallest film")
    """Smallest thickness of the film [m]."""
    film_ratio: float = quantity(label="film ratio λ")
    """Smallest thickness over roughness: ratio λ; infinite where no roughness is given."""
    radius: float = quantity("m", label="radius")
    """Radius in the direction of rolling [m]."""
    load: float = quantity("N", "N/m", label="load")
    """Load, per length in line contact [N, N/m]; of rollers that of the heaviest section."""
    ellipticity: float = quantity(label="ellipticity")
    """Width across over along rolling: of the solved contact; infinite of line contacts."""
    viscosity_parameter: float = quantity(label="viscosity g_V")
    """Viscosity parameter g_V: Greenwood and Johnson's."""
    elasticity_parameter: float = quantity(label="elasticity g_E")
    """Elasticity parameter g_E: Greenwood and Johnson's."""
    regime: str
    """Regime: "piezoviscous-elastic", for which the formulae are, or another."""
    model: str
    """Model in words."""
    notes: tuple[str, ...]
    """What limits the validity. All but that about thin layers were issued as warnings, too."""

    def _si(self, row: Quantity) -> str:
        return row.si(line=math.isinf(self.ellipticity))

    def _rows(self) -> list[Row]:
        rows = [row for row in super()._rows() if math.isfinite(row.value)]
        return [*rows, remark("regime", self.regime)]


def _line(u: float, g: float, w: float) -> tuple[float, float]:
    """Return H_c (Dowson and Toyoda, 1979) and H_min (Dowson and Higginson), both seen."""
    return 3.06 * u**0.69 * g**0.56 * w**-0.10, 2.65 * u**0.70 * g**0.54 * w**-0.13


def _point(u: float, g: float, w: float, k: float) -> tuple[float, float]:
    """Return H_c (seen in programs) and H_min of Hamrock and Dowson (1977).

    J. Lubr. Technol. 99, 264, whose abstract has the latter.
    """
    central = 2.69 * u**0.67 * g**0.53 * w**-0.067 * (1 - 0.61 * math.exp(-0.73 * k))
    return central, 3.63 * u**0.68 * g**0.49 * w**-0.073 * (1 - math.exp(-0.68 * k))


def _isoviscous(elastic: float, k: float) -> float:
    """Return the smallest film of a constant viscosity over that unit in which `elastic` is g_E.

    Lines: ``H W/U`` of rigid bodies is Martin's 4.895 (derived), of elastic ones Herrebrugh's
    ``3.10 g_E^0.8``, which agrees with Moes' asymptote to 0.3 %. Points: ``H (W/U)²`` of Hamrock
    and Dowson (1979), seen, whose rigid one takes ``R_y/R_x = (k/1.03)^(1/0.64)``, and from
    Kapitza's solution ``φ = 1/(1 + 2 R_x/(3 R_y))`` (derived).
    """
    if math.isinf(k):
        soft: float = 3.10 * elastic**0.8
        return max(4.895, soft)
    ratio = (k / 1.03) ** (1 / 0.64)
    spread = (0.131 * math.atan(ratio / 2) + 1.683) / (1 + 2 / (3 * ratio))
    soft = 8.70 * elastic**0.67 * (1 - 0.85 * math.exp(-0.31 * k))
    rigid: float = 128 * ratio * spread**2
    return max(rigid, soft)


def _viscosity_regime(
    u: float, g: float, w: float, k: float, minimum: float
) -> tuple[float, float, bool]:
    """Return g_V and g_E, and whether the pressure thickens the oil of a film H_min."""
    if math.isinf(k):
        viscous, elastic, unit = g * w**1.5 / u**0.5, w / u**0.5, w / u
    else:
        viscous, elastic, unit = g * w**3 / u**2, w ** (8 / 3) / u**2, (w / u) ** 2
    return viscous, elastic, minimum * unit >= _isoviscous(elastic, k)


def _excesses(parameters: dict[str, float]) -> list[str]:
    """Return which parameters are out of the range of Hamrock and Dowson's fit, in words."""
    return [
        f"{name} = {parameters[name]:.3g} is out of {low:g} to {high:g}"
        for name, (low, high) in FITTED.items()
        if not 0.99 * low <= parameters[name] <= 1.01 * high  # k is right to a part of a cell
    ]


def _doubts(
    regime: str, viscous: float, elastic: float, excesses: list[str], ratio: float, coated: bool
) -> Iterator[str]:
    """Yield where a film is out of what its formula was made for."""
    if regime != "piezoviscous-elastic":
        yield (
            f"the regime is {regime}, and the formula is for the piezoviscous-elastic one "
            f"(g_V = {viscous:.3g}, g_E = {elastic:.3g})"
        )
    if excesses:
        yield f"Hamrock and Dowson's fit is extrapolated: {', '.join(excesses)}"
    if ratio < SEPARATED:
        yield f"λ = {ratio:.3g} is below {SEPARATED:g}: asperities touch through the film"
    if coated:
        yield (
            "layers are thicker than half of the half-width b: how they move the film is not known"
        )


def _check_contact(solution: Solution) -> None:
    """Raise an error unless bodies touch, elastically, on a grid that is not periodic."""
    if any(solution.grid.periodic):
        raise ValueError("solution must be one on a grid that is not periodic")
    if not solution.load > 0:
        raise ValueError(f"solution must be one in contact, got a load of {solution.load:g}")
    check_unyielded(solution)


def _coat_thickness(solution: Solution) -> float:
    """Return the thickness of the layers of a body, the larger one of both; 0 without layers."""
    bodies = (solution.report.body, solution.report.counterbody)
    return float(max([0.0, *(z for body in bodies for z in getattr(body, "interfaces", ()))]))


def _curvature(solution: Solution, section: int) -> float:
    """Return the curvature 1/R of the undeformed shape along y, where a section is in contact.

    The gap is shape + displacement + indentation − approach, so that the fields contain it.
    """
    inside = solution.in_contact[section]
    if inside.sum() < 4:
        raise ValueError("radius must be given: the contact has less than 4 cells along y")
    shape = (solution.gap - solution.displacement - solution.indentation)[section, inside]
    y = solution.y[inside]
    scale = np.ptp(y)
    rise = np.polyfit((y - y.mean()) / scale, shape, 2)[0]
    if not rise > FLAT * np.abs(solution.displacement).max():
        raise ValueError("radius must be given: the shape is not convex along y")
    return float(2 * rise / scale**2)


def _modulus(solution: Solution) -> float:
    """Return E' = 2 E* of the substrates."""
    members = (solution.report.body, solution.report.counterbody)
    bases = [getattr(body, "substrate", None) for body in members if body is not None]
    elastic = [base for base in bases if isinstance(base, core.Elastic)]
    if not elastic or any(base is None or isinstance(base, core.Free) for base in bases):
        raise ValueError("solution must be one of bodies whose substrates have a modulus E*")
    return 2 * contact_modulus(*elastic)


def is_line(solution: Solution) -> bool:
    """Return whether a contact is one of a roller, or of strips."""
    return solution.grid.is_line or solution.report.rolling_direction == (0.0, 1.0)


@with_units(speed="m/s", viscosity="Pa s", pressure_viscosity="1/Pa", roughness="m", radius="m")
def film_thickness(
    solution: Solution,
    *,
    speed: float,
    viscosity: float,
    pressure_viscosity: float,
    roughness: float | None = None,
    radius: float | None = None,
) -> Film:
    """Central and smallest thickness of the oil film in a solved contact that rolls along y.

    Line contacts and rollers take the formulae of Dowson and Toyoda, and of Dowson and Higginson,
    with the load per length of the heaviest section; others those of Hamrock and Dowson, with the
    ellipticity of the solved contact. Moduli are those of the substrates, whatever lies on them.

    Parameters
    ----------
    solution : Solution
        Solved contact.
    speed : float
        Entrainment speed, the mean of the speeds of both surfaces [m/s].
    viscosity : float
        Dynamic viscosity at ambient pressure and the temperature of the inlet [Pa s].
    pressure_viscosity : float
        Pressure-viscosity coefficient α [1/Pa], of oils some 2e-8.
    roughness : float, optional
        Rms roughness of both surfaces together, ``sqrt(Rq1² + Rq2²)`` [m].
    radius : float, optional
        Equivalent radius in the direction of rolling [m]; by default that of a parabola through
        the undeformed shape in the heaviest section of the contact.

    Returns
    -------
    Film
        Film, its regime, and what limits its validity. Warnings say where the contact is in
        another regime or out of the range of the fit, λ is below 3, or layers are thick.

    Raises
    ------
    TypeError
        If solution is no Solution, or another argument no number.
    ValueError
        If an argument is not finite and above 0, the pressure-viscosity coefficient is that of no
        oil, nothing touches, the surfaces have yielded, the grid is periodic, a body has no
        modulus, or the radius cannot be found.

    Examples
    --------
    >>> from nacre.bearing import film_thickness
    >>> steel = nacre.Elastic(young=206e9, poisson=0.3)
    >>> grid = nacre.Grid.line(96, 4e-4)
    >>> solution = nacre.solve(nacre.Cylinder(5e-3), steel, steel, grid=grid, load=1e5)
    >>> film = film_thickness(solution, speed=2.0, viscosity=0.02, pressure_viscosity=20e-9)
    >>> round(film.central * 1e9), round(film.radius * 1e3, 3)
    (266, 5.0)
    """
    if not isinstance(solution, Solution):
        raise TypeError(f"solution must be a Solution, got {solution!r}")
    speed = above("speed", speed)
    viscosity = above("viscosity", viscosity)
    pressure_viscosity = above("pressure_viscosity", pressure_viscosity)
    roughness = None if roughness is None else above("roughness", roughness)
    radius = None if radius is None else above("radius", radius)
    _check_contact(solution)
    modulus = _modulus(solution)
    if pressure_viscosity * modulus > THICKEST:
        raise ValueError(
            f"pressure_viscosity must be at most {THICKEST / modulus:.3g} 1/{symbol('Pa')} between "
            f"these bodies, of oils it is some 2e-8 1/Pa, got {pressure_viscosity!r}"
        )
    section = int(np.argmax(solution.line_load))
    if radius is None:
        radius = 1 / _curvature(solution, section)
    line = is_line(solution)
    across, along = (high - low for low, high in solution.contact_extent)
    k = math.inf if line else across / along
    load = float(solution.line_load[section]) if line else solution.load
    u, g = viscosity * speed / (modulus * radius), pressure_viscosity * modulus
    if not SLOWEST < u < FASTEST:
        raise ValueError(
            f"speed times viscosity must be between {SLOWEST:g} and {FASTEST:g} of the modulus "
            f"times the radius, of oils it is some 1e-11, got {u:.3g}"
        )
    w = load / (modulus * radius ** (1 if line else 2))
    central, minimum = _line(u, g, w) if line else _point(u, g, w, k)
    flat = central <= (along / (2 * radius)) ** 2  # thinner than b²/R, by which bodies flatten
    viscous, elastic, thickens = _viscosity_regime(u, g, w, k, minimum)
    regime = f"{'piezoviscous' if thickens else 'isoviscous'}-{'elastic' if flat else 'rigid'}"
    ratio = math.inf if roughness is None else minimum * radius / roughness
    coat = _coat_thickness(solution)
    excesses = [] if line else _excesses({"U": u, "W": w, "G": g, "k": k})
    notes = list(_doubts(regime, viscous, elastic, excesses, ratio, coat > along / 4))
    for text in notes:
        warn(text)
    if 0 < coat <= along / 4:
        notes.append(COATED)
    names = "Dowson and Toyoda; Dowson and Higginson" if line else "Hamrock and Dowson"
    model = f"{names}, a model: smooth, isothermal, flooded, bare"
    films = central * radius, minimum * radius, ratio, radius
    return Film(*films, load, k, viscous, elastic, regime, model, tuple(notes))
