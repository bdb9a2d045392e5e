"""Heat and current through a solved contact: resistance, its error, and where the flux is."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
import numpy.typing as npt

import nacre._core as core
from nacre._tools.paths import by_layer
from nacre._tools.typing import Field, among
from nacre._tools.units import system
from nacre.cards import materials
from nacre.contact.layers import layer_numbers
from nacre.results import display, values
from nacre.results.base import same
from nacre.results.charts import Axis, Chart, Curve
from nacre.results.quantities import CELLS, Quantity, derived, frozen, quantity
from nacre.results.rows import Row, remark
from nacre.results.shown import TableResult
from nacre.results.verdict import Demand, Verdict, asked, judged, reasons

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from nacre.contact.solution import Solution

Kind = Literal["thermal", "electrical"]
KINDS = ("thermal", "electrical")
Conductivity = float | str
"""A number, or the name of a card of `nacre.materials`."""
Conductivities = Conductivity | Mapping[int | str, Conductivity] | Sequence[Conductivity]
UNITS = {"thermal": ("K/W", "W/K", "W/m/K"), "electrical": ("Ω", "S", "S/m")}
"""SI units of resistance, conductance and conductivity."""


def units_of(kind: str, *, line: bool = False, per_area: bool = False) -> dict[str, str]:
    """Return the SI units of a conductance and of its keywords, by name.

    >>> units_of("electrical", line=True)["resistance"]
    'Ω m'
    """
    resistance, conductance, conductivity = UNITS[kind]
    ohm = kind == "electrical"

    def over(length: str) -> str:
        return " ".join((resistance, length) if ohm else (length, resistance)).strip()

    length = "m" if line else "m²" if per_area else ""
    return {
        **dict.fromkeys(
            ("resistance", "uncertainty", "layer_resistance", "required_resistance"), over(length)
        ),
        "conductance": f"{conductance}/{length}".rstrip("/"),
        **dict.fromkeys(("conductivity", "counter_conductivity"), conductivity),
        "film": over("m²"),
    }


LEAST = {"thermal": 1e-3, "electrical": 1.0}
"""Conductivity below which a number is taken for a resistivity: evacuated powders have 1e-3
W/(m K), and carbon, the poorest conductor of contacts, 1e4 S/m."""
UNASKED = "No resistance is required."


@frozen(eq=False)
class Conductance(TableResult):
    """Resistance of a contact to heat or current, from `Solution.conductance`.

    Examples
    --------
    >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    >>> solution = nacre.solve(nacre.Sphere(5e-3), steel, steel, load=10.0)
    >>> heat = solution.conductance(conductivity=46.0, counter_conductivity=46.0)
    >>> print(heat)
    Resistance 158 K/W ± ... %.
    No resistance is required.
    <BLANKLINE>
    resistance   157.6 K/W ± ... %
    conductance  6.345 mW/K
    """

    _TITLE = "conductance of a contact"

    resistance: float = quantity("K/W", label="resistance")
    """Resistance between the bodies far from the contact [K/W, Ω].

    Per length of a line contact, counted from the datum of `Grid.line`, it is in m K/W or Ω m; of a
    contact that repeats, times the area of a period, in m² K/W or Ω m².
    """
    uncertainty: float = quantity("K/W")
    """Estimated error of the resistance by the size of the cells [K/W, Ω]."""
    flux: Field = quantity(dims=CELLS)
    """Share of the flux that passes each cell ``(nx, ny)``; their sum is 1."""
    conduction: Kind
    """Whether heat or current is conducted: "thermal" or "electrical"."""
    grid: core.Grid
    """Grid of the contact."""
    notes: tuple[str, ...]
    """What limits the validity: warnings of the contact."""
    layer_resistance: float | None = quantity("K/W", label="of the layers")
    """Resistance of the layers under the mean flux [K/W, Ω].

    It is times an area, in m² K/W or Ω m², and not part of `resistance`. None unless the contact
    repeats and has layers.
    """
    required_resistance: float | None = None
    """Largest resistance, in the unit of `resistance`, which the verdict compares with."""

    def __post_init__(self) -> None:
        """Raise a `ValueError` if the required resistance is not above 0 and finite."""
        _check_required(self.required_resistance)

    __hash__ = None  # type: ignore[assignment]

    def __eq__(self, other: object) -> bool:
        """Return whether all fields are equal, to the bit."""
        if not isinstance(other, Conductance):
            return NotImplemented
        return same(self._state(), other._state())

    @classmethod
    def _checked(cls, state: dict[str, object]) -> dict[str, Any]:
        grid = values.decode(state.pop("grid"))
        if not isinstance(grid, core.Grid):
            raise ValueError(f"{cls.__name__}: grid must be a Grid, got {grid!r}")
        try:
            flux = np.asarray(state.pop("flux"), dtype=float)
        except (TypeError, ValueError) as error:
            raise ValueError(f"{cls.__name__}: flux must be an array of numbers") from error
        if flux.shape != grid.shape:
            raise ValueError(f"flux must have the shape of the grid, got {flux.shape} on {grid!r}")
        return super()._checked(state) | {"grid": grid, "flux": flux}

    @property
    @derived("W/K", label="conductance")
    def conductance(self) -> float:
        """Inverse of the resistance [W/K, S]."""
        return 1 / self.resistance

    @property
    def per_area(self) -> bool:
        """Whether the contact repeats, so that its resistance is times an area."""
        return any(self.grid.periodic)

    def _si_units(self) -> dict[str, str]:
        return units_of(self.conduction, line=self.grid.is_line, per_area=self.per_area)

    def _si(self, row: Quantity) -> str:
        return self._si_units().get(row.name, "")

    def _rows(self) -> list[Row]:
        rows = super()._rows()
        error = display.plus_minus(self.uncertainty, self.resistance)
        return [
            row._replace(text=f"{row.text}{error}", error=self.uncertainty)
            if row.key == "resistance"
            else row
            for row in rows
        ]

    def _remarks(self) -> list[Row]:
        if not self.grid.is_line:
            return []
        return [remark("datum", "as for the approach, see `Grid.line`")]

    def _charts(self) -> list[Chart]:
        i, j = np.unravel_index(int(self.flux.argmax()), self.flux.shape)
        is_line, cells = self.grid.is_line, np.count_nonzero(self.flux)
        name, at = ("y", self.grid.y) if is_line else ("x", self.grid.x)
        density = cells * (self.flux[i] if is_line else self.flux[:, j])
        axes = (Axis(name, "m"), Axis("flux density over its mean"))
        caption = f"Flux density along {name} through the largest value."
        return [Chart(caption, [Curve(at, density)], axes)]

    def _file_rows(self) -> list[tuple[object, ...]]:
        names = ("resistance", "uncertainty", "conductance")
        rows = [row for row in self._known if row.name in names]
        heads = [f"{row.name} [{system().unit(self._si(row))[1]}]" for row in rows]
        return [tuple(heads), tuple(row.of(self) for row in rows)]

    @asked
    def verdict(self, *, required_resistance: float | None = None) -> Verdict:
        """Whether the resistance is at most that required.

        Parameters
        ----------
        required_resistance : float, optional
            Largest resistance, in the unit of `resistance`; by default that of the result.

        Returns
        -------
        nacre.types.Verdict
            Level, and sentences with the number that decides and its error.

        Raises
        ------
        ValueError
            If it is not above 0 and finite.

        Examples
        --------
        >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
        >>> solution = nacre.solve(nacre.Sphere(5e-3), steel, steel, load=10.0)
        >>> heat = solution.conductance(conductivity=46.0, counter_conductivity=46.0)
        >>> print(heat.verdict(required_resistance=200.0))
        Resistance 158 K/W ± ... %, 200 K/W at most required.
        """
        unit = self._si_units()["resistance"]
        limit = self.required_resistance if required_resistance is None else required_resistance
        _check_required(limit)
        value = display.number(self.resistance, unit, 3)
        share = display.plus_minus(self.uncertainty, self.resistance)
        needed = "" if limit is None else f", {display.number(limit, unit, 3)} at most required"
        demand = Demand(
            "resistance",
            "",
            self.resistance,
            self.uncertainty,
            limit=limit,
            unit=unit,
            sentence=f"Resistance {value}{share}{needed}.",
            leads=True,
        )
        return judged(
            [demand],
            doubts=reasons(self.notes, "unknown") if limit else (),
            cautions=reasons(self.notes, "fair") if limit else (),
            unasked=None if limit else UNASKED,
        )

    def plot(self, axes: Axes | None = None) -> Axes:
        """Draw the flux density along x, or y in line contact, through its largest value.

        Parameters
        ----------
        axes : matplotlib.axes.Axes, optional
            Axes to draw on; new ones by default.

        Returns
        -------
        matplotlib.axes.Axes
            The axes.

        Raises
        ------
        TypeError
            If `axes` are no axes of Matplotlib.

        Examples
        --------
        >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
        >>> solution = nacre.solve(nacre.Sphere(5e-3), steel, steel, load=10.0)
        >>> heat = solution.conductance(conductivity=46.0, counter_conductivity=46.0)
        >>> heat.plot().get_ylabel()
        'flux density over its mean'
        """
        from nacre.plot.drawer import draw

        return draw(self._charts()[0], axes, (0.6, 0.45))


def _check_required(limit: float | None) -> None:
    """Raise a `ValueError` if a required resistance is not above 0 and finite."""
    if limit is not None and not 0 < core.real("required_resistance", limit) < math.inf:
        raise ValueError(f"required_resistance must be above 0 and finite, got {limit!r}")


def conductance_of(
    solution: Solution,
    conductivity: Conductivities,
    counter_conductivity: Conductivities | None,
    film: npt.ArrayLike,
    kind: Kind,
) -> Conductance:
    """Return the conductance of a solved contact."""
    if not among(kind, KINDS):
        raise ValueError(f"kind must be one of {KINDS}, got {kind!r}")
    report = solution.report
    if counter_conductivity is None:
        raise ValueError(
            "counter_conductivity must be given; inf is a counterbody at one temperature or "
            "voltage throughout"
        )
    bodies = report.body, report.counterbody
    conductivities = [
        conductivities_of("conductivity", conductivity, bodies[0], kind),
        conductivities_of("counter_conductivity", counter_conductivity, bodies[1], kind),
    ]
    films = core.real_array("film", film)
    if films.ndim and films.shape != solution.grid.shape:
        raise ValueError(
            f"film must be a number or of shape {solution.grid.shape}, got shape {films.shape}"
        )
    if not (np.isfinite(films).all() and (films >= 0).all()):
        raise ValueError(
            f"film must be finite and at least 0, got {films.min():g} to {films.max():g}"
        )
    resistance, uncertainty, flux = solution._solved.conductance(conductivities, films)
    notes = tuple(dict.fromkeys(report.warning_kinds))
    layers = None
    if any(solution.grid.periodic):
        layers = sum(map(_layer_resistance, bodies, conductivities)) or None
    return Conductance(resistance, uncertainty, flux, kind, solution.grid, notes, layers)


def _layer_resistance(body: Any, conductivities: list[float]) -> float:
    """Return the resistance per area of the layers of a body, each thickness over conductivity."""
    layers = body.layers if isinstance(body, core.HalfSpace) else ()
    each = conductivities * len(layers) if len(conductivities) == 1 else conductivities
    return sum(layer.thickness / value for layer, value in zip(layers, each, strict=False))


def conductivities_of(name: str, given: Conductivities, body: Any, kind: Kind) -> list[float]:
    """Return the conductivities of the layers of a body and of its substrate, or one for all."""
    numbers: Any
    if isinstance(given, Mapping):
        numbers = {key: _number(name, value, kind) for key, value in by_layer(given).items()}
    elif isinstance(given, list | tuple | np.ndarray) and np.ndim(given) == 1:
        numbers = [_number(name, value, kind) for value in given]
    else:
        numbers = _number(name, given, kind)
    conductivities = layer_numbers(name, numbers, body, "conductivity")
    if math.inf in conductivities[:-1]:
        raise ValueError(f"{name} of layers must be finite, got {given!r}")
    for value in conductivities:
        size, unit = system().unit(UNITS[kind][2])
        if not value > 0:
            raise ValueError(f"{name} must be above 0, got {value:g}")
        if value * size < LEAST[kind]:
            raise ValueError(
                f"{name} must be a conductivity in {unit}, got {value:g}: is it a resistivity? "
                "give its inverse"
            )
    return conductivities


def _number(name: str, given: object, kind: Kind) -> float:
    """Return a conductivity, which a name takes from its card."""
    if not isinstance(given, str):
        return core.real(name, given)
    if kind == "electrical":
        raise ValueError(
            f"{name} must be a number: cards have thermal conductivities only, got {given!r}"
        )
    numbers = materials[given].numbers
    if "conductivity" not in numbers:
        known = [card for card in materials if "conductivity" in materials[card].numbers]
        raise ValueError(
            f"{name} must name a card with a conductivity ({', '.join(known)}), got {given!r}"
        )
    return numbers["conductivity"].value / system().unit("W/m/K")[0]
