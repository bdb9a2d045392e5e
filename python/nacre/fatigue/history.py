"""Stresses that the points of a body see, one after the other, when a contact rolls over them."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

import nacre._core as core
from nacre._tools.notices import heard
from nacre._tools.rounding import ceil, floor
from nacre._tools.typing import Direction, Member, Pair, Side, components
from nacre.contact.friction import FrictionSolution
from nacre.contact.solution import Solution
from nacre.contact.stresses import (
    Stress,
    StressFields,
    StressOptions,
    StressPlan,
    caution_of,
    doubt_of,
)

Array = npt.NDArray[np.float64]

NAMES = ("xx", "yy", "zz", "xy", "yz", "xz")
"""Components of a state, in their order."""
NEAR = 5.0
"""Half-widths of the contact up to which a history has the spacing of the grid."""
COARSER = 4
"""Factor from one level to the next, of the width and of the cells."""
FAR = 3
"""Number of levels beyond: up to 5 · 4³ = 320 half-widths, far behind the tension near 2 z/μ."""
DENSE = 1 / 20
"""Largest distance of states, in half-widths of the contact up to `NEAR` of them, and as a part of
the distance from it further away."""
ROWS = 16
"""Smallest number of rows along x that cells beyond are merged to."""
PARTS = np.arange(1, 8) / 8
"""Places at which cubic curves divide intervals, where the centre of a ball counts.

Its error is one of the step, 1/32 half-width at least with 64 cells across; an eighth of it is
below 3e-3 of the stress.
"""
LEVEL = 1e-3
"""Part of the largest line load by which that of neighbouring rows may be less to count as equal:
the top of a parabola a thirtieth of its half-width wide."""


class Level(NamedTuple):
    """A grid beyond that of the contact, and plans of the stress under its loads."""

    grid: core.Grid
    pressure: core.StressPlan
    tractions: list[tuple[core.StressPlan, Pair]]
    """Tractions as pressures, whose friction acts along these directions."""
    used: npt.NDArray[np.intp]
    """Numbers of the cells along y that belong to the history."""


class States(NamedTuple):
    """Histories at some depths, all with the same places along y."""

    y: Array
    """Places ``(times,)``; the last one is infinitely far away."""
    normal: Array
    """Stresses ``(depths, times, 6)`` of the contact as it was solved."""
    tangential: Array
    """What the traction ``pressure`` along the direction of friction adds."""
    edges: tuple[float, ...] = ()
    """Places among them where the stress is not smooth: edges of the contact, at the surface."""

    def only(self, depths: list[int]) -> States:
        """Return the histories at the depths of these numbers."""
        return States(self.y, self.normal[depths], self.tangential[depths], self.edges)

    def at(self, friction: float) -> Array:
        """Return the states with a coefficient of friction."""
        return self.normal + friction * self.tangential if friction else self.normal


class Rolling:
    """A body of a solved contact that rolls along y, in the section ``x``."""

    def __init__(
        self,
        solution: Solution | FrictionSolution,
        body: Member,
        direction: Direction | None,
        x: float | None,
        threads: int | None,
    ) -> None:
        normal = solution.normal if isinstance(solution, FrictionSolution) else solution
        self.grid: core.Grid = normal.grid
        if any(self.grid.periodic):
            raise ValueError(
                "solution must not be periodic: its bodies are never free of stress, got a grid "
                f"with periodic = {self.grid.periodic}"
            )
        if not normal.pressure.any():
            raise ValueError("solution must be in contact, got one whose pressure is 0 everywhere")
        self.plan: StressPlan = solution.stress_plan(body, threads)
        self.body = self.plan.body
        self.doubt, self.caution = doubt_of(solution), caution_of(solution)
        tractions = solution.traction if isinstance(solution, FrictionSolution) else None
        self.has_tractions = tractions is not None
        self.sign = -1.0 if body == "counterbody" else 1.0
        self.threads = None if threads is None else core.integer("threads", threads)
        rolls = (0.0, 1.0)
        x_part, y_part = (
            rolls if direction is None else core.vector("direction", 2, components(direction))
        )
        self.direction = core.real("direction", x_part), core.real("direction", y_part)
        self.along = self.sign * self.direction[0], self.sign * self.direction[1]
        """Direction of the friction on the body."""
        self.pressure = np.asarray(normal.pressure)
        self.peak_pressure = normal.peak_pressure
        self.tractions = None if tractions is None else np.asarray(tractions)
        if x is not None and self.grid.is_line:
            raise ValueError(f"x must be None in line contacts: sections are alike, got {x!r}")
        section = self._section() if x is None else core.real("x", x)
        self.x = None if self.grid.is_line else section
        row = 0 if self.x is None else int(np.argmin(np.abs(self.grid.x - self.x)))
        inside = np.flatnonzero(self.pressure[row])
        if not inside.size:
            raise ValueError(f"x must be in the contact, whose row there has no pressure, got {x}")
        self.half_width = 0.5 * inside.size * self.grid.spacing[1]
        self.levels = self._levels()

    def _section(self) -> float:
        """Return the middle of the rows with the largest line load."""
        loads = self.pressure.sum(axis=1)
        best = int(loads.argmax())
        equal = loads >= (1.0 - LEVEL) * loads[best]
        first = best - int(np.argmin(np.r_[equal[best::-1], False])) + 1
        last = best + int(np.argmin(np.r_[equal[best:], False])) - 1
        return float(self.grid.x[first : last + 1].mean())

    def _levels(self) -> list[Level]:
        """Return grids beyond that of the contact, each four times as wide as the one before.

        The loads are merged to their cells, over which they are uniform.
        """
        (nx, ny), (_, step) = self.grid.shape, self.grid.spacing
        merged = [self.pressure, *(() if self.tractions is None else self.tractions)]
        reach = 2 * NEAR * self.half_width / step
        # A multiple of 4², of which a quarter is put into the middle of the next one.
        count = 16 * int(ceil(max(reach, ny) / 16))
        before = (count - ny) // 2
        middle = self.grid.center[1] + (count / 2 - before - ny / 2) * step
        sides = ((0, 0), (before, count - ny - before))
        merged = [np.pad(load, sides) for load in merged]
        covered = np.array([-0.5, 0.5]) * self.grid.size[1] + self.grid.center[1]
        across = 1
        ways = self.along, (self.sign, 0.0), (0.0, self.sign)
        levels: list[Level] = []
        for level in range(1 + FAR):
            if level:
                step *= COARSER
                rows = COARSER if nx % COARSER == 0 and nx // COARSER >= ROWS else 1
                across, nx = across * rows, nx // rows
                sides = ((0, 0), ((count - count // COARSER) // 2,) * 2)
                averages = [
                    load.reshape(nx, rows, count // COARSER, COARSER).mean(axis=(1, 3))
                    for load in merged
                ]
                merged = [np.pad(average, sides) for average in averages]
            if self.grid.is_line:
                grid = core.Grid.line(count, count * step, middle)
            else:
                size, place = (self.grid.size[0], count * step), (self.grid.center[0], middle)
                grid = core.Grid((nx, count), size, place)
            y = grid.y
            used = (y < covered[0] - 1e-9 * step) | (y > covered[1] + 1e-9 * step)
            inner = (
                self.half_width if not level else NEAR * self.half_width * COARSER ** (level - 1)
            )
            used &= np.arange(count) % max(1, int(floor(DENSE * inner / step))) == 0
            if used.any():
                plans = [
                    (core.StressPlan(self.body, grid, load, self.threads), way)
                    for load, way in zip(merged, ways, strict=False)
                    if load.any()
                ]
                levels.append(Level(grid, plans[0][0], plans[1:], np.flatnonzero(used)))
            covered = middle + np.array([-0.5, 0.5]) * count * step
        return levels

    def stress(self, depths: Sequence[float], side: Side, friction: bool) -> tuple[States, Array]:
        """Return the history along y at some depths, and errors of its extremes.

        These are ``(depths, 2)``, without friction and what a coefficient of 1 adds: an upper bound
        up to it, as errors are the largest of sums in proportion to it.

        The pressure within cells counts on the grid of the contact; further away it is uniform
        over cells, which are ever wider.

        With `friction`, the part of the tractions is there.
        """
        slides = (0.0, 1.0) if friction and not self.has_tractions else (0.0,)
        own = [self._contact_stress(depths, side, slide, self.x) for slide in slides]
        ys, blocks = [self.grid.y], [[self._array(field) for field in own]]
        for level in self.levels:
            ys.append(level.grid.y[level.used])
            blocks.append(
                [self._far_states(level, depths, side, slide)[:, level.used] for slide in slides]
            )
        y = np.concatenate(ys)
        order = np.argsort(y, kind="stable")
        stresses = [np.concatenate(row, axis=1)[:, order] for row in zip(*blocks, strict=True)]
        added = (
            stresses[1] - stresses[0] if len(stresses) == 2 else np.zeros((len(depths), y.size, 6))
        )
        states = States(y[order], stresses[0], added)
        fields = StressFields(side, self.x, None, displacement=False)
        errors = np.zeros((len(depths), 2))
        for k, slide in enumerate(slides):
            options = StressOptions("body", slide, self.direction, None, None, None)
            errors[:, k] = self.plan._plan.extreme_errors(depths, fields, options)
        if len(slides) == 2:
            errors[:, 1] -= errors[:, 0]
        if list(depths) == [0.0]:
            states = self._with_edge_states(states, slides)
        return self._with_unloaded_state(states), errors

    def _contact_stress(
        self,
        depths: Sequence[float],
        side: Side,
        slide: float,
        x: float | None,
        y: float | None = None,
    ) -> Stress:
        with heard():
            return self.plan.stress(
                depths, side=side, x=x, y=y, friction=slide, direction=self.direction
            )

    @staticmethod
    def _array(field: Stress) -> Array:
        """Return the states ``(depths, y, 6)``."""
        return np.stack([field.components[name][:, 0, :] for name in NAMES], axis=-1)

    def _far_states(self, level: Level, depths: Sequence[float], side: Side, slide: float) -> Array:
        """Return the states on a wider grid, whose loads are uniform over cells."""

        def stress(plan: core.StressPlan, friction: float, way: Pair) -> Array:
            fields = StressFields(side, self.x, None, displacement=False)
            options = StressOptions("body", friction, way, None, None, None)
            return self._array(Stress(**core.stress(plan, depths, fields, options)))

        total = stress(level.pressure, slide, self.along)
        for plan, way in level.tractions:
            # A traction alone: with the pressure of its size, less that pressure.
            total += stress(plan, 1.0, way) - stress(plan, 0.0, way)
        return total

    def _with_edge_states(self, states: States, slides: Sequence[float]) -> States:
        """Return the states at the surface with those at the edges of the contact.

        With friction, yy has a peak there of the square root of the distance, which cells cut off.
        """
        points = self.plan.edge
        if self.x is not None:
            points = points[np.abs(points[:, 0] - self.x) <= self.grid.spacing[0]]
        if not len(points):
            return states
        ends = points[[points[:, 1].argmin(), points[:, 1].argmax()]]
        if np.diff(ends[:, 1])[0] < self.grid.spacing[1]:
            ends = ends[:1]  # the other end has no point
        # Beside the edge tractions are means over cells, and the other stresses those of points.
        apart = np.abs(states.y[:, None] - ends[:, 1]).min(axis=1)
        inside = apart >= self.grid.spacing[1]
        states = States(states.y[inside], states.normal[:, inside], states.tangential[:, inside])
        for x, y in ends.tolist():
            own, *slid = (
                self._array(self._contact_stress([0.0], "below", slide, x, y)) for slide in slides
            )
            at = int(np.searchsorted(states.y, y))
            added = slid[0] - own if slid else np.zeros_like(own)
            states = States(
                np.insert(states.y, at, y),
                np.insert(states.normal, [at], own, axis=1),
                np.insert(states.tangential, [at], added, axis=1),
                (*states.edges, y),
            )
        return states

    def _with_unloaded_state(self, states: States) -> States:
        """Return the states with the stress-free one, infinitely far away."""
        none = np.zeros((len(states.normal), 1, 6))
        return States(
            np.append(states.y, np.inf),
            np.concatenate([states.normal, none], axis=1),
            np.concatenate([states.tangential, none], axis=1),
            states.edges,
        )


def _lagrange(nodes: Array, at: object) -> Array:
    """Return the weights of the polynomial through nodes, along the last axis."""
    at = np.asarray(at)
    weights = [
        np.prod(
            [
                (at - nodes[..., m]) / (nodes[..., k] - nodes[..., m])
                for m in range(nodes.shape[-1])
                if m != k
            ],
            axis=0,
        )
        for k in range(nodes.shape[-1])
    ]
    return np.stack(weights, axis=-1)


def refined(history: States, states: Array) -> tuple[Array, Array]:
    """Return places and states with those between them, on cubic curves through four neighbours.

    Curves do not go past the edges of the contact. The last state is kept as it is.
    """
    y, inner = history.y[:-1], states[:, :-1]
    cuts = [0, *sorted(int(np.searchsorted(y, edge)) for edge in history.edges), y.size - 1]
    places, pieces = [y], [inner]
    for first, last in pairwise(cuts):
        count = last - first + 1
        if count < 4:
            continue
        starts = first + np.clip(np.arange(count - 1) - 1, 0, count - 4)
        neighbours = starts[:, None] + np.arange(4)
        at = y[first:last, None] + np.diff(y[first : last + 1])[:, None] * PARTS
        weights = _lagrange(y[neighbours][:, None, :], at)
        between = np.einsum("ipk,dikc->dipc", weights, inner[:, neighbours])
        places.append(at.ravel())
        pieces.append(between.reshape(len(states), -1, 6))
    y = np.concatenate([*places, history.y[-1:]])
    return y, np.concatenate([*pieces, states[:, -1:]], axis=1)
