"""Maps of shakedown: the limit of a contact over friction."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING, Self

import numpy as np
import numpy.typing as npt

import nacre._core as core
from nacre._tools.notices import warn
from nacre._tools.progress import lasting
from nacre._tools.typing import ByLayer, Direction, Member, Real
from nacre._tools.units import written
from nacre.contact.friction import FrictionSolution
from nacre.contact.solution import Solution
from nacre.fatigue.criteria import Rule
from nacre.fatigue.summary import (
    ESTIMATE,
    PLASTICITY,
    Row,
    assessment_of,
    checked_depths,
    flag,
    in_region,
    numbers,
    read_fields,
    rule_of,
    unresolved,
    word,
)
from nacre.results import display, files
from nacre.results.base import Result, Warned
from nacre.results.charts import Axis, Chart, Curve
from nacre.results.quantities import frozen, quantity
from nacre.results.report import Rows, Table, table
from nacre.results.rows import remark
from nacre.results.shown import Printed, Shown

if TYPE_CHECKING:
    import xarray
    from matplotlib.axes import Axes

Array = npt.NDArray[np.float64]


@frozen(eq=False)
class ShakedownMap(Shown, Warned, Result):
    """Shakedown limits of the layers of a contact over the coefficient of friction.

    Printing it shows a table, and so does a notebook. `shakedown_map` makes it.

    Examples
    --------
    >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    >>> grid = nacre.Grid.line(96, 3e-4)
    >>> solution = nacre.solve(nacre.Cylinder(5e-3), steel, load=1e5, grid=grid)
    >>> shakedown_map = nacre.fatigue.shakedown_map(solution, friction=[0.0, 0.2])
    >>> shakedown_map.limits.round(1)
    array([[4. , 3.2]])
    """

    friction: Array = quantity()
    """Coefficient of friction ``(nf,)``."""
    limits: Array = quantity()
    """Peak pressure over shear yield stress, for shakedown ``(layers, nf)``."""
    first_yield: Array = quantity()
    """Peak pressure over shear yield stress, at first yield ``(layers, nf)``."""
    depths: Array = quantity("m")
    """Depth that decides the shakedown ``(layers, nf)`` [m]."""
    _TITLE = "shakedown map"

    names: tuple[str, ...] = quantity(name="layer")
    """Layer: names from the surface down."""
    rule: Rule
    """Condition of yield."""
    peak_pressure: float
    """Largest pressure of the contact [Pa]."""
    is_estimate: bool
    """Whether the limits are estimates, as in point contacts and rollers."""
    warnings: tuple[str, ...] = ()
    """Warnings, each also issued as `NacreWarning`; none in files of earlier versions."""

    _LATER = ("warnings",)

    def _state(self) -> dict[str, object]:
        return {
            name: value.tolist() if isinstance(value, np.ndarray) else value
            for name, value in super()._state().items()
        }

    @classmethod
    def _restored(cls, state: dict[str, object]) -> Self:
        def plane(rows: Iterable[Iterable[float]]) -> Array:
            return np.array([numbers(row) for row in rows])

        return cls(
            **read_fields(
                cls.__name__,
                state,
                friction=numbers,
                limits=plane,
                first_yield=plane,
                depths=plane,
                names=lambda names: tuple(word(name) for name in names),
                rule=rule_of,
                peak_pressure=float,
                is_estimate=flag,
                warnings=lambda texts: tuple(word(text) for text in texts or ()),
            )
        )

    def __eq__(self, other: object) -> bool:
        """Return whether all fields are equal."""
        if not isinstance(other, ShakedownMap):
            return NotImplemented
        return self._state() == other._state()

    def plot(self, axes: Axes | None = None) -> Axes:
        """Draw the limits over friction; needs ``nacre-contact[plot]``.

        Parameters
        ----------
        axes : matplotlib.axes.Axes, optional
            Axes to draw into, such as those of another map; a new figure by default.

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
        >>> grid = nacre.Grid.line(96, 3e-4)
        >>> solution = nacre.solve(nacre.Cylinder(5e-3), steel, load=1e5, grid=grid)
        >>> nacre.fatigue.shakedown_map(solution, friction=[0.0, 0.2]).plot().get_xlabel()
        'coefficient of friction'
        """
        from nacre.plot import fatigue

        return fatigue.shakedown_map(self, axes=axes)

    def to_xarray(self) -> xarray.Dataset:
        """Dataset of the limits over layer and friction; needs ``nacre-contact[files]``.

        Returns
        -------
        xarray.Dataset
            Limits, first yield and depths; ``to_dataframe()`` is the table for pandas.
        """
        table = [(row, row.unit) for row in self._QUANTITIES]
        fields = ("limits", "first_yield", "depths")
        variables = {name: (("layer", "friction"), getattr(self, name)) for name in fields}
        places = {"layer": list(self.names), "friction": self.friction}
        return files.dataset("shakedown map", table, variables, places, self.to_dict())

    def _file_rows(self) -> Iterable[Iterable[object]]:
        yield ["layer", "friction", "limits", "first_yield", "depths"]
        for layer, name in enumerate(self.names):
            columns = (row[layer].tolist() for row in (self.limits, self.first_yield, self.depths))
            yield from ([name, *row] for row in zip(self.friction.tolist(), *columns, strict=True))

    def _inputs(self) -> Rows:
        return [remark("rule", self.rule)]

    def _report_rows(self) -> Rows:
        return [display.numbered("peak_pressure", "peak pressure", self.peak_pressure, "Pa")]

    def _charts(self, label: str = "") -> list[Chart]:
        """Return the chart of the limits over friction; words may stand before names of layers."""
        order, curves = np.argsort(self.friction), []
        for k, name in enumerate(self.names):
            words = f"{label}, {name}" if label else name
            curves += [
                Curve(self.friction[order], self.limits[k][order], words, "solid"),
                Curve(self.friction[order], self.first_yield[k][order], look="thin"),
            ]
        axes = Axis("coefficient of friction"), Axis("peak pressure / shear yield stress")
        title = "shakedown limits; thin: first yield"
        return [Chart(f"{title[:1].upper()}{title[1:]}.", curves, axes, title=title)]

    def _tables(self) -> Sequence[Table]:
        return [table("Limits", self._file_rows(), self._QUANTITIES)]

    def _model(self) -> Rows:
        return [remark("theory", note) for note in self._table().notes]

    def _notebook_picture(self) -> bytes | None:
        return display.drawn(self.plot)

    def _table(self) -> Printed:
        """Return the table of the limits over friction."""
        head = ["friction", *(f"{name}: limit, first yield, z" for name in self.names)]
        rows = []
        for k, friction in enumerate(self.friction):
            cells = [
                f"{self.limits[i, k]:.4g}, {self.first_yield[i, k]:.4g}, "
                f"{written(float(self.depths[i, k]), 'm', 3)}"
                for i in range(len(self.names))
            ]
            rows.append([f"{friction:g}", *cells])
        plane = ", Tresca in the plane of rolling" if self.rule == "in_plane_tresca" else ""
        units = "limits are peak pressure over yield stress in shear"
        estimate = [ESTIMATE] if self.is_estimate else []
        return Printed(head, rows, [units, PLASTICITY + plane, *estimate])

    def __repr__(self) -> str:
        """Return how much the map holds."""
        return f"<ShakedownMap of {len(self.names)} layers at {self.friction.size} frictions>"


def shakedown_map(
    solution: Solution,
    *,
    friction: Sequence[float] | Real,
    direction: Direction | None = None,
    residual: ByLayer | None = None,
    body: Member = "body",
    x: float | None = None,
    depths: Sequence[float] | Real | None = None,
    rule: Rule = "von_mises",
    threads: int | None = None,
    progress: Callable[[float], object] | None = None,
) -> ShakedownMap:
    """Shakedown limits of the layers of a contact over the coefficient of friction.

    Parameters
    ----------
    solution : Solution
        Solved contact without friction, not periodic.
    friction : array_like
        Coefficients of friction, at least one.
    direction, residual, body, x, depths, rule, threads, progress : optional
        As in `assess`.

    Returns
    -------
    ShakedownMap
        Limits by layers; printing it shows a table.

    Raises
    ------
    ValueError
        If an argument is out of range, the contact is periodic, nothing touches, or the surfaces
        have yielded.

    Notes
    -----
    A limit is the peak pressure of this contact over the yield stress in shear that the layer
    needs. A limit in units of another pressure is that pressure over the same yield stress:
    ``limits * pressure / peak_pressure``.

    Examples
    --------
    >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    >>> grid = nacre.Grid.line(96, 3e-4)
    >>> solution = nacre.solve(nacre.Cylinder(5e-3), steel, load=1e5, grid=grid)
    >>> print(nacre.fatigue.shakedown_map(solution, friction=[0.0, 0.2]))
    friction  the substrate: limit, first yield, z
    ...
    """
    if isinstance(solution, FrictionSolution):
        raise ValueError(
            "solution must be one without friction, got a FrictionSolution: nacre.fatigue.assess "
            "takes it"
        )
    coefficients = _coefficients(friction)
    assessment = assessment_of(solution, (), rule, residual, body, direction, x, threads)
    ordered_depths = checked_depths(depths, assessment.rolling.body)
    regions = [
        region
        for region in assessment.regions()
        if ordered_depths is None or in_region(region, ordered_depths).size
    ]
    names = tuple(
        "the substrate"
        if region.bottom == np.inf
        else display.layer_name(region.layer, region.name)
        for region in regions
    )
    warning_texts: list[str] = []
    shape = (len(regions), coefficients.size)
    limits, first, deciding = np.zeros(shape), np.zeros(shape), np.zeros(shape)
    peak = assessment.rolling.peak_pressure
    with lasting("shakedown", progress) as tell:
        for i, region in enumerate(regions):
            if tell is not None:
                tell(i / len(regions))
            doubts: dict[str, None] = {}
            for k, rows in enumerate(
                assessment.evaluate(region, ordered_depths, coefficients.tolist())
            ):
                best = _deciding(rows)
                limits[i, k] = peak / best["shakedown"].values["shakedown"]
                first[i, k] = peak / best["first_yield"].values["first_yield"]
                deciding[i, k] = best["shakedown"].z
                doubts |= dict.fromkeys(unresolved(names[i], best))
            warning_texts += doubts
        if tell is not None:
            tell(1.0)
    for text in warning_texts:
        warn(text)
    is_estimate = assessment.rolling.x is not None
    return ShakedownMap(
        coefficients, limits, first, deciding, names, rule, peak, is_estimate, tuple(warning_texts)
    )


def _coefficients(friction: Sequence[float] | Real) -> Array:
    """Return coefficients of friction as an array, checked."""
    coefficients = core.real_array("friction", friction)
    if coefficients.ndim != 1 or not coefficients.size:
        raise ValueError(f"friction must be a sequence of numbers, got {friction!r}")
    if not np.isfinite(coefficients).all() or coefficients.min() < 0:
        raise ValueError(f"friction must be finite and at least 0, got {friction!r}")
    return coefficients


def _deciding(rows: Sequence[Row]) -> dict[str, Row]:
    """Return the depths that need the largest yield stresses, by the names of the values."""
    return {
        name: max(rows, key=lambda row: row.values[name]) for name in ("shakedown", "first_yield")
    }
