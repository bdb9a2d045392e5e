"""Optimisation of a contact with exact derivatives: `nacre.design.optimise`."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

import nacre._core as core
from nacre._tools.extras import extra
from nacre._tools.notices import heard
from nacre._tools.progress import lasting
from nacre.contact.gradient import Output
from nacre.contact.solution import Solution
from nacre.design.parameters import Bounds, scales_of
from nacre.design.problem import Array, Build, Enough, Problem
from nacre.results import charts, display, files, report, tables
from nacre.results.report import Rows
from nacre.results.rows import remark
from nacre.results.shown import Printed, Shown

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    pass

Limits = Sequence[tuple[Output, float]]

RESTARTS = 3
"""Fresh starts where the last search ended, until one gains less than the tolerance."""


@dataclass(frozen=True, eq=False)
class Optimum(Shown):
    """What `nacre.design.optimise` found; `print` shows a report.

    Attributes
    ----------
    values : dict
        Parameters by name, at the best point that respects the limits.
    objective : float
        Objective there.
    limits : tuple
        Outputs that are limited, each with its limit and its value in each case.
    course : dict of numpy.ndarray
        Table with a row for the start and for each iteration: ``solves``, ``objective``, ``excess``
        (largest share by which a limit is exceeded, negative where none is), each parameter.
    solutions : list of Solution
        Solution of each case.
    solves : int
        Number of solves; each derivative of an output counts as one.
    termination : str
        ``"converged"``, ``"line search"`` (no step along the gradient improves, as where cells join
        and leave the contact), ``"infeasible"`` (no values were found that respect the limits; a
        warning says by how much) or ``"solve limit"``.
    warnings : list of str
        Warnings of the solutions and of the gradients at the optimum.
    """

    _TITLE = "optimum of a contact"

    values: dict[str, float]
    objective: float
    limits: tuple[tuple[object, float, tuple[float, ...]], ...]
    course: dict[str, Array]
    solutions: list[Solution]
    solves: int
    termination: str
    warnings: list[str]

    @property
    def excess(self) -> float:
        """Largest share by which a limit is exceeded; negative where none is."""
        return max((max(v) / limit - 1.0 for _, limit, v in self.limits), default=-math.inf)

    def _table(self) -> Printed:
        """Return the table of the objective and the parameters."""
        first = {name: column[0] for name, column in self.course.items()}
        optimum = {"objective": self.objective, **self.values}
        rows = []
        for name, value in optimum.items():
            start = first[name]
            change = f"{100 * (value / start - 1):+.1f} %" if start else ""
            rows.append([name, f"{start:.5g}", f"{value:.5g}", change])
        return Printed(("", "start", "optimum", "change"), rows, self._notes())

    def _notes(self) -> list[str]:
        """Return the limits with what they were given, and how the search ended."""
        notes = []
        for output, limit, reached in self.limits:
            share = 100 * max(reached) / limit
            notes.append(f"limit {limit:.5g} on {output}: {max(reached):.5g}, {share:.1f} % of it")
        iterations = len(self.course["objective"]) - 1
        return [*notes, f"{self.termination}: {iterations} iterations, {self.solves} solves"]

    def __str__(self) -> str:
        """Return a report."""
        printed = self._table()
        table = [
            f"{name:32}{start:>14}{optimum:>14}{change:>10}"
            for name, start, optimum, change in (printed.head, *printed.rows)
        ]
        return "\n".join([*table, *printed.notes, *(f"warning: {w}" for w in self.warnings)])

    def _notebook_picture(self) -> bytes | None:
        return display.drawn(self.plot)

    def _writers(self) -> dict[str, Callable[[Path], object]]:
        rows = self._course_rows()
        table: dict[str, Callable[[Path], object]] = {
            ".csv": lambda path: tables.write_rows(path, rows, source=tables.SOURCE)
        }
        return table | files.pictures(self.plot)

    def _course_rows(self) -> list[Sequence[object]]:
        """Return the table of all iterations, the heading first."""
        columns = (column.tolist() for column in self.course.values())
        return [[*self.course], *zip(*columns, strict=True)]

    def _inputs(self) -> Rows:
        return self._of_cases("_inputs")

    def _report_rows(self) -> Rows:
        return self._of_cases("_report_rows")

    def _of_cases(self, name: str) -> Rows:
        """Return rows of the solution of each case."""
        return [
            row._replace(key=f"cases[{k}].{row.key}", label=f"case {k}: {row.label}")
            for k, solution in enumerate(self.solutions)
            for row in getattr(solution, name)()
        ]

    def _charts(self) -> list[charts.Picture]:
        cases = (chart for solution in self.solutions for chart in solution._charts())
        return [self._course_chart(), *cases]

    def _course_chart(self) -> charts.Chart:
        """Return the chart of the objective, the limits and the parameters, over the solves."""
        table = self.course
        shares = {"objective": table["objective"] / table["objective"][0]}
        if np.isfinite(table["excess"]).all():
            shares["largest share of a limit"] = 1 + table["excess"]
        shares |= {name: table[name] / (table[name][0] or 1.0) for name in self.values}
        curves = [
            charts.Curve(table["solves"], values, name, "marked") for name, values in shares.items()
        ]
        is_log = all((values > 0).all() for values in shares.values())
        share = charts.Axis("share of the start", scale="log" if is_log else "linear")
        axes = charts.Axis("solves, of contacts and of derivatives"), share
        return charts.Chart("Objective and parameters over the solves.", curves, axes)

    def _tables(self) -> Sequence[report.Table]:
        printed = self._table()
        optimum = report.Table("Optimum", printed.head, printed.rows)
        return [optimum, report.table("Course", self._course_rows())]

    def _model(self) -> Rows:
        return [remark("minimised", note) for note in self._notes()]

    def plot(self, axes: Axes | None = None) -> Axes:
        """Draw the course; see `nacre.plot.course`."""
        from nacre.plot.optimise import course

        return course(self, axes)


def optimise(
    build: Build,
    start: Mapping[str, float],
    *,
    objective: Output,
    cases: Sequence[Mapping[str, object]],
    bounds: Bounds | None = None,
    constraints: Limits = (),
    across: float = 16.0,
    grid: core.Grid | Sequence[core.Grid] | None = None,
    tolerance: float = 1e-4,
    max_solves: int = 1000,
    progress: Callable[[dict[str, float]], object] | bool | None = None,
) -> Optimum:
    """Parameters of a contact that minimise an output; needs ``nacre-contact[design]``.

    SciPy minimises: L-BFGS-B without constraints, SLSQP with them. The derivatives are exact ones
    of the discrete contact, from `Solution.gradient`; those of shapes and bodies with respect to
    parameters of your own are differences of gaps and numbers, which need no solve. Positive
    parameters are varied by their logarithms, and others by shares of their start, or of the width
    between their bounds.

    Parameters
    ----------
    build : callable or mapping
        Function that takes the parameters by name and returns arguments of `nacre.solve`. Or those
        arguments, in which parameters are named by path: ``"body.layers[0].thickness"``.
    start : mapping
        Parameters by name, with the values to start from.
    objective : str, tuple or dict
        Output that is minimised, as in `Solution.gradient`. Take one that is smooth:
        ``("pressure_norm", 16)``, or a stress in a layer or at an interface.
    cases : sequence of mappings
        Further arguments of `nacre.solve`: loads, tilts. All are solved at each step.
    bounds : mapping, optional
        Least and greatest values by name; None where there is none. Without, a positive parameter
        stays within a factor of 100.
    constraints : sequence of pairs, optional
        Outputs with their upper limits, positive numbers, which hold in each case.
    across : float, optional
        Exponent of the power mean of the objective over the cases: 1 is the mean, and a large one
        nearly the largest. With the exponent of a ``pressure_norm``, it is the norm over the cells
        of all cases.
    grid : Grid or sequence of Grid, optional
        Cells. Of several grids, each begins where the last one ended. By default, grids are
        chosen for each case at the start, and again at the optimum of the first.
    tolerance : float, optional
        Relative change of the objective at which the search ends. Slopes feel the cells: below
        1e-5, a search may not end.
    max_solves : int, optional
        Number of solves after which the search ends; a derivative of an output counts as a solve.
    progress : callable or bool, optional
        Function that gets each row of the course; True, for a line of each on standard error; or
        False, for nothing. By default a terminal or a notebook shows a bar after two seconds.

    Returns
    -------
    Optimum
        The best point with its solutions, and the course.

    Raises
    ------
    ValueError
        If an argument, an output or a parameter cannot be used.
    TypeError
        If an argument is of the wrong kind.

    Examples
    --------
    A ball under a given load has the lower a peak, the larger it is:

    >>> from nacre import design
    >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    >>> best = design.optimise(
    ...     {"shape": nacre.Sphere(5e-3), "body": steel},
    ...     {"shape.radius": 5e-3},
    ...     objective="peak_pressure",
    ...     cases=[{"load": 10.0}],
    ...     bounds={"shape.radius": (1e-3, 8e-3)},
    ...     grid=nacre.Grid((32, 32), (3e-4, 3e-4)),
    ... )
    >>> best.values
    {'shape.radius': 0.008}
    """
    with extra("design"):
        import scipy.optimize  # noqa: F401
    if not tolerance > 0:
        raise ValueError(f"tolerance must be above 0, got {tolerance!r}")
    scales = scales_of(start, bounds or {})
    problem = Problem(build, scales, objective, _cases(cases), _limits(constraints), across)
    problem.most, problem.tolerance = core.integer("max_solves", max_solves), tolerance
    if not isinstance(grid, core.Grid | Sequence | None) or grid == ():
        raise TypeError(f"grid must be a Grid or a sequence of them, got {grid!r}")
    grids: Sequence[core.Grid | None] = (
        [grid] if isinstance(grid, core.Grid) else grid or [None, None]
    )
    x = np.array([scale.x(start[scale.name]) for scale in scales])
    course = _Course(problem, progress)
    termination = "converged"
    quiet = (lambda _: None) if isinstance(progress, bool) else progress
    with lasting("optimum", quiet) as course.tell, heard():  # the optimum has them
        try:
            for stage in grids:
                problem.begin(x, stage)
                if not course.rows:
                    course.add(x)
                x, termination = _search(problem, x, course)
        except Enough:
            termination = "solve limit"
    return _optimum(problem, course, termination)


@dataclass
class _Course:
    """Rows of the course of a search, which are shown as they come."""

    problem: Problem
    progress: Callable[[dict[str, float]], object] | bool | None
    tell: Callable[[str], object] | None = None
    rows: list[dict[str, float]] = field(default_factory=list)

    def add(self, x: Array) -> None:
        """Add a row for a point, unless it is the last one's."""
        point = self.problem.at(x)
        row = {"solves": float(self.problem.solves), "objective": point.value * self.problem.unit}
        row |= {"excess": -float(point.slack.min(initial=math.inf)), **self.problem.by_name(x)}
        if self.rows and row == self.rows[-1]:
            return
        self.rows.append(row)
        if self.progress is True:
            text = ", ".join(f"{name} {value:.5g}" for name, value in row.items())
            print(f"nacre.design.optimise: {text}", file=sys.stderr, flush=True)
        elif callable(self.progress):
            self.progress(row)
        elif self.tell is not None:
            self.tell(f"{self.problem.solves} solves, objective {row['objective']:.5g}")


def _search(problem: Problem, x: Array, course: _Course) -> tuple[Array, str]:
    """Return where SciPy ends on these cells, and how; it starts afresh while that gains."""
    from scipy.optimize import minimize

    box = [(scale.low, scale.high) for scale in problem.scales]
    sides = np.array(box, dtype=np.float64).T  # None becomes NaN
    sides = np.where(np.isnan(sides), [[-np.inf], [np.inf]], sides)
    options: dict[str, object] = {"method": "SLSQP" if problem.limits else "L-BFGS-B"}
    if problem.limits:
        slack = {"fun": lambda x: problem.at(x).slack, "jac": lambda x: problem.at(x).d_slack}
        options["constraints"] = [{"type": "ineq", **slack}]
    least = problem.tolerance / 10
    for _ in range(1 + RESTARTS):
        before = problem.at(x).value
        # The first step of both methods is the slope: it is made as long as 1.
        slope = problem.at(x).slope
        steepest = float(np.abs(np.clip(x - slope, *sides) - x).max())
        factor = max(1.0, 1.0 / max(steepest, least))
        ends = {"ftol": least}
        ends |= {"ftol": factor * least} if problem.limits else {"gtol": factor * least}
        minimum = minimize(
            lambda x, factor=factor: problem.scaled_objective(x, factor),
            x,
            jac=True,
            bounds=box,
            callback=course.add,
            options=ends,
            **options,
        )
        x = problem.best().x
        if before - problem.at(x).value < problem.tolerance:
            break
    return x, "converged" if minimum.success else "line search"


def _optimum(problem: Problem, course: _Course, termination: str) -> Optimum:
    """Return the best point of a search, with what is to be said of it."""
    point = problem.best()
    values = problem.by_name(point.x)
    table = {name: np.array([row[name] for row in course.rows]) for name in course.rows[0]}
    reached = point.outputs[:, 1:].T.tolist()
    limits = [(*pair, tuple(r)) for pair, r in zip(problem.limits, reached, strict=True)]
    slopes = dict(zip(values, point.slope, strict=True))
    warning_lines = [line for solution in point.solutions for line in solution.report.warnings]
    warning_lines = list(dict.fromkeys([*warning_lines, *point.warnings]))
    warning_lines += [
        f"{s.name} does not change the objective there"
        for s in problem.scales
        if not slopes[s.name]
    ]
    excess = -float(point.slack.min(initial=math.inf))
    if excess > problem.tolerance:
        termination = "infeasible" if termination == "line search" else termination
        warning_lines += [f"a limit is exceeded: the output is {1 + excess:.3g} times as large"]
    best = values, point.value * problem.unit, tuple(limits), table
    return Optimum(*best, point.solutions, problem.solves, termination, warning_lines)


def _cases(cases: object) -> list[dict[str, object]]:
    if isinstance(cases, Mapping | str) or not isinstance(cases, Sequence) or not cases:
        raise TypeError(f"cases must be a sequence of one mapping or more, got {cases!r}")
    return [dict(case) for case in cases]


def _limits(constraints: Limits) -> list[tuple[Output, float]]:
    for pair in constraints:
        if not isinstance(pair, tuple | list) or len(pair) != 2:
            raise TypeError(f"constraints must be pairs of an output and its limit, got {pair!r}")
        if not 0 < core.real(f"the limit of {pair[0]!r}", pair[1]) < math.inf:
            raise ValueError(f"the limit of {pair[0]!r} must be positive, got {pair[1]!r}")
    return [(output, core.real("limit", limit)) for output, limit in constraints]
