"""Result of a fit of indentation curves."""

from __future__ import annotations

import math
import operator
import os
from collections.abc import Callable, Iterable, Sequence
from dataclasses import field
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, Self

import numpy as np
import numpy.typing as npt

import nacre._core as core
from nacre._tools.renamed import warn_of
from nacre._tools.units import written
from nacre.indent._addressed import System
from nacre.indent._model import NUISANCES, OF_FORCE, unit_of
from nacre.indent._reading import checked_tolerance
from nacre.indent._residuals import ROUNDING
from nacre.indent._verdict import UNFIT, fit_verdict
from nacre.indent.classical import Classical, classical
from nacre.indent.curves import Curve
from nacre.indent.solution import MODEL, holds
from nacre.results import display, files
from nacre.results.base import Result
from nacre.results.charts import Axis, Chart
from nacre.results.charts import Curve as Line
from nacre.results.quantities import frozen, quantity
from nacre.results.report import Rows, Table, input_rows, label_of, table
from nacre.results.rows import Row, remark
from nacre.results.shown import Printed, Shown
from nacre.results.values import decode, encode, refusing
from nacre.results.verdict import Verdict, asked

if TYPE_CHECKING:
    import xarray
    from matplotlib.axes import Axes

Array = npt.NDArray[np.float64]

ASSUMED = 0.01
"""Standard error that is assumed of moduli, thicknesses and tips that are held, as a share."""

MOST_RATES = 6
"""Most numbers on which a table says that an estimate depends."""


@frozen(eq=False)
class Fit(Shown, Result):
    """Estimates of `fit`, how sure they are, and whether the data tell them at all."""

    estimates: dict[str, float]
    """Value of each parameter, nuisances after the free ones; in natural units."""
    standard_errors: dict[str, float]
    """Standard errors; those of logarithms are these over the estimates."""
    covariance: Array
    """Covariance of the parameters in their order."""
    correlation: Array
    """Correlation of the parameters, of the logarithms where these are fitted."""
    intervals: dict[str, tuple[float, float]]
    """Intervals of 95 %: by profile likelihood of free parameters, linear of nuisances."""
    reasons: dict[str, str]
    """Why a parameter is not identifiable, for those that are not."""
    sensitivity: dict[str, dict[str, float]]
    """Change of each free parameter over that of each number that the fit holds, the other free
    parameters following. Numbers change by their logarithms, but Poisson's ratios by themselves,
    and contact point, drift and compliance by what shifts the deepest point by the range of depth.
    """

    _TITLE = "fit of indentation curves"
    residuals: list[Array] = quantity(name="residual")
    """Residual: of each curve, F − P [N] for absolute noise, else ln(F/P), or for mixed noise the
    difference of arsinh(F/c), which is ln(F/P) far above the floor c."""
    loads: list[Array] = quantity("N", name="load")
    """Load of the model [N]: P at the points of each curve."""
    approaches: list[Array] = quantity("m", name="approach")
    """Depth without nuisances [m]: the true one of the points of each curve."""
    chi2: float
    """Sum of the squares of weighted residuals, with priors."""
    dof: int
    """Degrees of freedom."""
    sigma: float
    """Standard deviation of the noise, given or estimated: a force [N] for absolute noise, else a
    share of √(F² + c²)."""
    is_sigma_known: bool
    """Whether the noise was given."""
    noise: Literal["relative", "absolute", "mixed"]
    """Kind of noise, given or the likeliest."""
    floor: float
    """Force c over the largest one of a curve below which noise ceases to fall with the force: 0
    for relative noise, infinite for absolute."""
    condition: float
    """Condition number of the Jacobian with columns of unit length: a symptom only."""
    is_profiled: bool
    """Whether intervals are profiled, and other starts were tried."""
    free: tuple[str, ...]
    """Free parameters of the indentation."""
    curves: list[Curve]
    """Curves as given."""
    body: core.HalfSpace
    """Body with the estimates."""
    tip: core.Tip
    """Tip with the estimates; an area is not part of it."""
    counterbody: core.HalfSpace | None
    """Counterbody with the estimates."""
    adhesion: core.Adhesion | None
    """Adhesion with the estimates."""
    evaluations: int
    """How often the curves were computed."""
    warnings: tuple[str, ...] = ()
    """How the residuals show that the model does not describe the data, and what to free, with
    errors and intervals wider and linear; what makes the contacts doubtful. Each was also issued as
    a `NacreWarning`."""
    known: dict[str, tuple[float, float]] = field(default_factory=dict)
    """Value and standard error of what is held, as far as they were given."""

    tolerance: float | None = None
    """Largest standard error that the verdict tolerates, as a part of each free parameter."""

    _LATER = ("known", "tolerance")

    @property
    def error_sources(self) -> dict[str, dict[str, float]]:
        """Standard error of each free parameter by its source: "noise", and each number held.

        Errors of numbers that are held are those of `known`, and 1 % of every other modulus,
        thickness and number of the tip but an exponent. NaN where a slope is not known.
        """
        held = System.of(self.body, self.tip, self.counterbody, self.adhesion).held(self.free)
        shares = {path: ASSUMED for path in held if path not in self.known and _is_assumed(path)}
        for path, (value, error) in self.known.items():
            shares[path] = error if path.endswith(".poisson") else error / value
        sources = {}
        for name in self.free:
            rate = 1.0 if name.endswith(".poisson") else self.estimates[name]
            slopes = self.sensitivity.get(name, {})
            moves = {p: abs(slopes.get(p, math.nan) * rate) * share for p, share in shares.items()}
            sources[name] = {"noise": self.standard_errors[name]} | moves
        return sources

    def _held_share(self, path: str) -> str:
        """Return the error that counts of a number that is held, as a share of it, in words."""
        value, error = self.known.get(path, (1.0, ASSUMED))
        return f"{error:.2g}" if path.endswith(".poisson") else display.share(error, value)

    @property
    def uncertainty(self) -> dict[str, float]:
        """Standard error of each free parameter: of the noise, and of what is held, together."""
        return {name: math.hypot(*by.values()) for name, by in self.error_sources.items()}

    @property
    def identifiable(self) -> dict[str, bool]:
        """Whether the data tell each free parameter."""
        return {name: name not in self.reasons for name in self.free}

    @property
    def is_identifiable(self) -> bool:
        """Whether the data tell all free parameters; deprecated for `identifiable`."""
        warn_of("is_identifiable", "all(fit.identifiable.values())")
        return not self.reasons

    @asked
    def verdict(self, tolerance: float | None = None) -> Verdict:
        """Verdict: each free parameter with its `uncertainty`, the least certain one first.

        Parameters
        ----------
        tolerance : float, optional
            Largest standard error of each free parameter that is tolerated, as a part of it, such
            as 0.05. Without, the verdict is unknown.

        Returns
        -------
        Verdict
            Good where all errors are two thirds of the tolerance at most; bad where one is above
            it. A parameter that is not identifiable, though it was asked for, has no smaller error
            than the interval that does not close, and breaks any tolerance. Where the model does
            not describe the data, errors are wider, and what keeps the tolerance is unknown.

        Raises
        ------
        ValueError
            If the tolerance is not above 0 and finite.
        """
        return fit_verdict(self, checked_tolerance(tolerance) or self.tolerance)

    def classical(self, curve: int = 0) -> list[Classical]:
        """Return what customary formulae would have said, with their bias against the fit.

        Parameters
        ----------
        curve : int
            Number of the curve.

        Returns
        -------
        list of Classical
            A row for each formula that applies to the tip and the body.
        """
        curve = core.integer("curve", curve)
        clean = Curve(self.approaches[curve], self.curves[curve].force)
        return classical(clean, self.body, self.tip)

    def plot(self, axes: Axes | None = None, *, curve: int = 0) -> Axes:
        """Draw the data and the model; without axes, the residuals below, in a new figure."""
        from nacre.plot import indent

        return indent.fit_plot(self, axes, curve=curve)

    def report(self, path: str | os.PathLike[str]) -> None:
        """Write a page; deprecated for `save`."""
        warn_of("report(path)", "save(path)")
        self.save(path)

    def _writers(self) -> dict[str, Callable[[Path], object]]:
        """Return the writers by endings; pictures are a page with curves, residuals and table."""
        from nacre.plot import indent

        return super()._writers() | files.pictures(lambda: indent.fit_page(self))

    @property
    def _parameter_units(self) -> list[str]:
        """SI units of the estimates."""
        return [unit_of(name) for name in self.estimates]

    def _title(self) -> str:
        names = ", ".join(curve.name for curve in self.curves if curve.name)
        return f"{self._TITLE}: {names}" if names else self._TITLE

    def _inputs(self) -> Rows:
        inputs = {name: getattr(self, name) for name in ("body", "tip", "counterbody", "adhesion")}
        inputs["counterbody"] = self.counterbody or "rigid"
        for number, curve in enumerate(self.curves):
            measured = {"name": curve.name, "depth": curve.depth, "force": curve.force}
            inputs |= {f"curves[{number}].{name}": value for name, value in measured.items()}
        units = {row.name: row.unit for row in self._QUANTITIES}
        rows = input_rows(inputs, units)
        return [remark("bodies and tip", "with the estimates in place"), *rows]

    def _report_rows(self) -> Rows:
        rows = []
        errors = self.standard_errors | self.uncertainty
        for name, value, error, interval, whole, verdict in self._table().rows:
            text = f"{value} ± {whole or error}; noise ± {error}, 95 %: {interval} {verdict}"
            text, estimate, deviation = text.rstrip(), self.estimates[name], errors[name]
            rows.append(Row(name, label_of(name), text, estimate, unit_of(name), deviation))
        return rows

    def _tables(self) -> Sequence[Table]:
        names, printed = list(self.estimates), self._table()
        correlations = zip(names, self.correlation.tolist(), strict=True)
        rows = [["", *names], *([name, *row] for name, row in correlations)]
        return [Table("Estimates", printed.head, printed.rows), table("Correlation", rows)]

    def _model(self) -> Rows:
        notes = [note for note in self._table().notes if not note.startswith("warning: ")]
        return [*(remark(*words) for words in MODEL), *(remark("fit", note) for note in notes)]

    def _notebook_picture(self) -> bytes | None:
        return display.drawn(self.plot)

    def _charts(self) -> list[Chart]:
        """Return the charts of a report: force and residuals over depth."""
        forces, residuals = [], []
        for number, curve in enumerate(self.curves):
            name, order = curve.name or f"curve {number}", np.argsort(curve.depth, kind="stable")
            model = self.loads[number][order]
            forces.append(Line(curve.depth[order], model, f"model of {name}"))
            forces.append(Line(curve.depth, curve.force, name, "points"))  # on top of the line
            residuals.append(Line(curve.depth, self.residuals[number], name, "points"))
        rest = Axis("residual", "N") if self.noise == "absolute" else Axis("residual, share")
        depth = Axis("depth", "m")
        return [
            Chart("Measured force over depth.", forces, (depth, Axis("force", "N"))),
            Chart("Residuals over depth.", residuals, (depth, rest)),
        ]

    def __eq__(self, other: object) -> bool:
        """Return whether all is equal, to the bit."""
        if not isinstance(other, Fit):
            return NotImplemented
        # Texts tell NaN from other numbers, and equal NaN.
        return str(self._state()) == str(other._state())

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        """Return a line with the estimates."""
        estimates_text = ", ".join(f"{name} {self._value(name)}" for name in self.free)
        verdict = "not identifiable" if self.reasons else "identifiable"
        return f"<Fit of {estimates_text}: {verdict}>"

    def _table(self) -> Printed:
        """Return the table of the estimates."""
        rows, totals = [], self.uncertainty
        for name in self.estimates:
            low, high = (self._with_unit(name, end) for end in self.intervals[name])
            error = self._with_unit(name, self.standard_errors[name], 2)
            whole = self._with_unit(name, totals[name], 2) if name in totals else ""
            verdict = "" if name not in self.reasons else "NOT IDENTIFIABLE"
            rows.append([name, self._value(name), error, f"{low} to {high}", whole, verdict])
        lines = [f"{name} is not identifiable: {text}" for name, text in self.reasons.items()]
        if self.noise == "absolute":
            noise = written(self.sigma, "N", 3)
        else:
            noise = f"{100 * self.sigma:.3g} % of the force"
        if self.noise == "mixed":
            noise += f", of at least {100 * self.floor:.2g} % of the largest"
        points = sum(map(len, self.curves))
        lines.append(
            f"noise {noise} ({'given' if self.is_sigma_known else 'estimated'}), "
            f"χ² {self.chi2 if self.is_sigma_known else self.dof:.4g} at {self.dof} degrees of "
            f"freedom, {points} points, condition {self.condition:.3g}"
        )
        lines += [f"warning: {text}" for text in self.warnings]
        lines += self._sensitivities()
        if self.sigma < ROUNDING * (1 if self.noise != "absolute" else self.curves[0].force.max()):
            lines.append(
                "residuals are rounding errors: the intervals do not apply to a measurement"
            )
        if UNFIT in self.reasons.values():
            lines.append("intervals are linear, and widened by what the residuals show")
        elif not self.is_profiled:
            lines.append("intervals are linear, and no other start was tried: profile=False")
        head = ("parameter", "estimate", "± noise", "95 % of noise", "± in all", "")
        return Printed(head, rows, lines)

    def _sensitivities(self) -> list[str]:
        """Return lines on numbers of which 1 % matters beside the intervals, most first."""
        lines = []
        for name, rates in self.sensitivity.items():
            low, high = self.intervals[name]
            relative = 1.0 if name.endswith(".poisson") else self.estimates[name] or 1.0
            half = (high - low) / 2 / relative
            most = sorted(rates, key=lambda fixed: -abs(rates[fixed]))
            effects = [f"{rates[fixed]:+.2g} % for {_step(fixed)}" for fixed in most]
            effects = effects[: sum(0.01 * abs(rate) > 0.5 * half for rate in rates.values())]
            if effects:
                lines.append(
                    f"{name} holds for what is given: it changes by "
                    f"{', '.join(effects[:MOST_RATES])}"
                )
        return lines

    def _value(self, name: str) -> str:
        return self._with_unit(name, self.estimates[name])

    def _with_unit(self, name: str, value: float, digits: int = 4) -> str:
        if not math.isfinite(value):
            return f"{value}"
        return written(value, unit_of(name), digits)

    def to_xarray(self) -> xarray.Dataset:
        """Return the parameters and the points with units; needs ``nacre-contact[files]``."""
        from nacre.indent._files import estimates

        return estimates(self)

    def _file_rows(self) -> Iterable[list[object]]:
        from nacre.indent._files import parameter_rows

        return parameter_rows(self)

    def _state(self) -> dict[str, object]:
        curves = [
            {"depth": c.depth, "force": c.force, "time": c.time, "name": c.name}
            for c in self.curves
        ]
        names = [name for name in self._names() if name != "curves"]
        return {name: encode(getattr(self, name)) for name in names} | {"curves": encode(curves)}

    @classmethod
    def _restored(cls, state: dict[str, Any]) -> Self:
        with refusing("Fit"):
            for name in ("body", "tip", "counterbody", "adhesion"):
                state[name] = decode(state[name])
            pairs = (state["known"] or {}).items()
            state["tolerance"] = checked_tolerance(state["tolerance"])
            state["known"] = {key: (float(value), float(error)) for key, (value, error) in pairs}
            for name in ("estimates", "standard_errors"):
                state[name] = {key: float(value) for key, value in state[name].items()}
            for name in ("chi2", "sigma", "floor", "condition"):
                state[name] = float(state[name])
            state["sensitivity"] = {
                name: {fixed: float(rate) for fixed, rate in rates.items()}
                for name, rates in state["sensitivity"].items()
            }
            for name in ("dof", "evaluations"):
                state[name] = operator.index(state[name])
            state["curves"] = [
                Curve(c["depth"], c["force"], time=c["time"], name=c["name"])
                for c in state["curves"]
            ]
            for name in ("covariance", "correlation"):
                state[name] = np.array(state[name], dtype=np.float64)
            for name in ("residuals", "loads", "approaches"):
                state[name] = [np.array(part, dtype=np.float64) for part in state[name]]
            state["intervals"] = {
                key: (float(low), float(high)) for key, (low, high) in state["intervals"].items()
            }
            for name in ("free", "warnings"):
                state[name] = tuple(state[name])
            fit = cls(**state)
            if not fit._fits_together():
                raise TypeError("its parts do not fit together")
        return fit

    def _fits_together(self) -> bool:
        """Return whether the parts have the same parameters and points, and the right kinds."""
        names, points = self.estimates.keys(), [curve.depth.shape for curve in self.curves]
        return (
            names == self.standard_errors.keys() == self.intervals.keys()
            and names >= {*self.free, *self.reasons}
            and all(isinstance(text, str) for text in (*self.reasons.values(), *self.warnings))
            and self.covariance.shape == self.correlation.shape == (len(names), len(names))
            and all(
                [part.shape for part in parts] == points
                for parts in (self.residuals, self.loads, self.approaches)
            )
            and self.noise in ("relative", "absolute", "mixed")
            and {*self.sensitivity} <= names
            and max(abs(self.dof), abs(self.evaluations)) < 1 << 53
            and all(
                math.isfinite(value) and 0 <= error < math.inf and (value or ".poisson" in path)
                for path, (value, error) in self.known.items()
            )
            and isinstance(self.is_sigma_known, bool)
            and isinstance(self.is_profiled, bool)
            and holds(self.body, self.tip, self.counterbody, self.adhesion)
        )


def _is_assumed(path: str) -> bool:
    """Return whether an error of what is held is assumed where none is given."""
    last = path.rpartition(".")[2]
    return last in ("young", "thickness") or (path.startswith("tip.") and last != "exponent")


def _step(parameter: str) -> str:
    """Return in words what a hundredth of the unit of a sensitivity is."""
    if parameter.endswith(".poisson"):
        return f"0.01 of {parameter}"
    if parameter.rpartition(".")[2] in OF_FORCE:
        return f"{parameter} of 1 % of the force"
    if parameter.rpartition(".")[2] in NUISANCES:
        return f"{parameter} of 1 % of the depth"
    return f"1 % of {parameter}"
