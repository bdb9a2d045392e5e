"""Contacts of an optimisation, as functions of what SciPy varies."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

import nacre._core as core
from nacre._tools.paths import DIFFERENTIABLE, numbers, put
from nacre.contact import Contact, solve
from nacre.contact.gradient import Output
from nacre.contact.solution import Solution
from nacre.design.parameters import Scale
from nacre.studies import ARGUMENTS

Build = Mapping[str, object] | Callable[..., Mapping[str, object]]
Array = npt.NDArray[np.float64]

STEP = 1e-4
"""Step of the differences of shapes and arguments, which need no solve: error 1e-8 to 1e-9."""
ACCURATE = 1e-9
"""Tolerance of solves: errors of a solution enter its gradients linearly."""


class Enough(Exception):
    """No more solves are allowed."""


@dataclass
class Point:
    """Evaluation: the objective in its unit, the shares left below the limits, and slopes."""

    x: Array
    value: float
    slope: Array
    slack: Array
    d_slack: Array
    outputs: Array
    solutions: list[Solution]
    warnings: list[str]


@dataclass
class Problem:
    """Contacts as functions of what SciPy varies: each point is solved once."""

    build: Build
    scales: list[Scale]
    objective: Output
    cases: Sequence[Mapping[str, object]]
    limits: list[tuple[Output, float]]
    across: float
    most: float = math.inf
    tolerance: float = 1e-4
    unit: float = 0.0
    solves: int = 0
    grids: list[core.Grid] = field(default_factory=list)
    evaluations: dict[bytes, Point] = field(default_factory=dict)
    plans: dict[int, tuple[Contact, dict[str, object]]] = field(default_factory=dict)

    def by_name(self, x: Array) -> dict[str, float]:
        """Return the parameters by name at a point of the optimiser."""
        pairs = zip(self.scales, x, strict=True)
        return {scale.name: scale.rounded(float(v)) for scale, v in pairs}

    def arguments(self, x: Array, case: Mapping[str, object]) -> dict[str, Any]:
        """Return arguments of a solve."""
        parameters = self.by_name(x)
        if callable(self.build):
            keywords = {**self.build(**parameters), **case}
        else:
            keywords = {**self.build, **case}
            for path, value in parameters.items():
                put(keywords, path, value)
        if unknown := set(keywords) - ARGUMENTS | {"shape", "body"} - set(keywords):
            raise TypeError(f"build and cases must give arguments of nacre.solve, see {unknown}")
        return keywords

    def begin(self, x: Array, grid: core.Grid | None) -> None:
        """Take new cells, chosen for each case where none are given."""
        case_arguments = [self.arguments(x, case) for case in self.cases]
        self.evaluations, self.plans = {}, {}
        self.grids = [
            grid or g["grid"] for g in case_arguments if grid or g.get("grid") is not None
        ]
        if len(self.grids) < len(case_arguments):
            self.grids = [solve(**arguments).report.grid for arguments in case_arguments]
            self.solves += len(case_arguments)

    def best(self) -> Point:
        """Return the best point on these cells: within the limits if there is one."""
        points = list(self.evaluations.values())
        lacking = [max(-float(p.slack.min(initial=0.0)), self.tolerance) for p in points]
        return min(zip(lacking, points, strict=True), key=lambda pair: (pair[0], pair[1].value))[1]

    def scaled_objective(self, x: Array, factor: float) -> tuple[float, Array]:
        """Return the objective and its slope, times a factor."""
        point = self.at(x)
        return factor * point.value, factor * point.slope

    def at(self, x: Array) -> Point:
        """Return the evaluation at a point."""
        key = np.asarray(x, dtype=np.float64).tobytes()
        if key not in self.evaluations:
            cost = len(self.cases) * (2 + len(self.limits))
            if self.evaluations and self.solves + cost > self.most:
                raise Enough
            try:
                self.evaluations[key] = self.evaluate(np.array(x, dtype=np.float64))
            except Exception as error:
                place_text = ", ".join(f"{k} = {v:.6g}" for k, v in self.by_name(x).items())
                error.add_note(f"in nacre.design.optimise, at {place_text}")
                raise
        return self.evaluations[key]

    def evaluate(self, x: Array) -> Point:
        """Solve all cases, and their derivatives."""
        last = next(reversed(self.evaluations.values())).solutions if self.evaluations else None
        targets = [self.objective, *(output for output, _ in self.limits)]
        outputs = np.zeros((len(self.cases), len(targets)))
        slopes = np.zeros((len(self.cases), len(targets), len(x)))
        solutions, warning_texts = [], []
        for k, (case, grid) in enumerate(zip(self.cases, self.grids, strict=True)):
            keywords = self.arguments(x, case)
            changes = self.changes(x, case, grid)
            solution = self.solve_case(k, keywords, last[k] if last else None)
            paths = {path for change, _ in changes for path in change}
            gradients = solution.gradient(targets, sorted(paths))
            self.solves += 1 + len(targets)
            for j, gradient in enumerate(gradients):
                outputs[k, j] = gradient.value
                touched = gradient.gap != 0
                for i, (change, gap) in enumerate(changes):
                    slopes[k, j, i] = sum(gradient[path] * rate for path, rate in change.items())
                    slopes[k, j, i] += gradient.gap[touched] @ gap[touched]
                warning_texts += gradient.warnings
            solutions.append(solution)
        values = outputs[:, 0]
        if self.across != 1 and not np.all(values > 0):
            raise ValueError(f"across must be 1 where the objective is not positive, got {values}")
        size = np.abs(values).max()
        mean = size * float(np.mean((values / size) ** self.across)) ** (1 / self.across)
        shares = (values / mean) ** (self.across - 1) / len(values)
        self.unit = self.unit or abs(mean) or 1.0
        tops = np.array([limit for _, limit in self.limits])
        slack = (1 - outputs[:, 1:] / tops).ravel()
        d_slack = (-slopes[:, 1:] / tops[:, None]).reshape(-1, len(x))
        rates = shares @ slopes[:, 0] / self.unit
        return Point(x, mean / self.unit, rates, slack, d_slack, outputs, solutions, warning_texts)

    def solve_case(self, k: int, keywords: dict[str, Any], last: Solution | None) -> Solution:
        """Solve a case, with the plan of an equal body and from the last solution."""
        keywords = {"tolerance": ACCURATE, **keywords, "grid": self.grids[k]}
        names = ("body", "counterbody", "grid", "threads")
        plan_keywords = {name: keywords.pop(name) for name in names if name in keywords}
        plan = next((p for p, settings in self.plans.values() if settings == plan_keywords), None)
        plan = plan or Contact(**plan_keywords)
        keywords.pop("max_cells", None)  # of the grid, which is chosen by now
        self.plans[k] = plan, plan_keywords
        return plan.solve(keywords.pop("shape"), **({"initial": last} | keywords))

    def changes(
        self, x: Array, case: Mapping[str, object], grid: core.Grid
    ) -> list[tuple[dict[str, float], Array]]:
        """Return the derivatives of arguments by path, and of gaps, along each parameter."""
        derivatives = []
        for i, scale in enumerate(self.scales):
            up = scale.high is None or x[i] + STEP <= scale.high
            down = scale.low is None or x[i] - STEP >= scale.low
            steps = {(True, True): (1, -1), (True, False): (0, 1, 2), (False, True): (0, -1, -2)}
            weights = {2: (0.5, -0.5), 3: (-1.5, 2.0, -0.5)}
            points = steps.get((up, down), (1, -1))
            sign = points[1] if len(points) == 3 else 1
            values: dict[str, list[float]] = {}
            gap = np.zeros(grid.shape)
            edges = set()
            for step, weight in zip(points, weights[len(points)], strict=True):
                keywords = self.arguments(x + step * STEP * np.eye(len(x))[i], case)
                differentiable = {
                    name: keywords[name] for name in DIFFERENTIABLE if name in keywords
                }
                for path, value in numbers(differentiable).items():
                    values.setdefault(path, []).append(value)
                with np.errstate(invalid="ignore"):
                    gap += sign * weight / STEP * keywords["shape"].gaps(grid)
                shape = keywords["shape"]
                edge = "radius" if isinstance(shape, core.FlatPunch) else "length"
                edges.add(getattr(shape, edge, None))
            if len(edges) > 1:
                raise ValueError(
                    f"{scale.name} must not move the edge of the shape (its {edge}): which cells "
                    f"can touch has no derivative; vary a profile instead"
                )
            factors = sign / STEP * np.array(weights[len(points)])
            # What stays has no rate, not even one of rounding, for which a derivative is asked.
            moving = {path: v for path, v in values.items() if len(set(v)) > 1}
            derivatives.append(({path: float(factors @ v) for path, v in moving.items()}, gap))
        return derivatives
