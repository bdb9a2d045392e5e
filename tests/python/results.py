"""Results of every kind, each solved once."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any, Literal

import numpy as np

import nacre
from bodies import BALL, HELD, ROD, STEEL, quiet
from nacre import fatigue
from nacre.indent import Adhesion, Curve, Fit, Indentation, OliverPharr, Tip, fit, oliver_pharr
from nacre.results.quantities import AXIS, frozen, quantity
from nacre.results.shown import TableResult

DLC = nacre.Elastic(420e9, 0.25)
LAYERED = nacre.HalfSpace(STEEL, [nacre.Layer(DLC, 4e-5, "frictionless"), nacre.Layer(STEEL, 1e-5)])
COATED = nacre.HalfSpace(STEEL, [nacre.Layer(DLC, 2e-5)])
GRID = nacre.Grid((40, 31), (3e-4, 2e-4), (1e-5, -2e-6))
CELLS = nacre.Grid((40, 36), (2.4e-4, 2.2e-4), (1e-6, -2e-6))
CONTACT = nacre.Contact(STEEL, CELLS, STEEL)
LINE = nacre.Contact(STEEL, nacre.Grid.line(64, 2e-4), STEEL)
FILM = nacre.HalfSpace(
    nacre.Elastic(70e9, 0.22), [nacre.Layer(nacre.Elastic(3e9, 0.4), 1e-6, name="film")]
)
ROUND = Tip.sphere(5e-6)


def fitted() -> Fit:
    depth = np.linspace(10e-9, 300e-9, 12)
    noise = np.exp(0.01 * np.random.default_rng(3).standard_normal((2, depth.size)))
    load = Indentation(FILM, ROUND).curve(approach=depth).load
    curves = [Curve(depth, load * part, name=f"A{k}") for k, part in enumerate(noise)]
    free, nuisance = ["body.layers[0].material.young"], ["contact_point"]
    return fit(curves, FILM, ROUND, free, nuisance=nuisance, profile=False)


def unloaded() -> OliverPharr:
    depth = np.linspace(500e-9, 302e-9, 50)
    noise = 1e-5 * np.random.default_rng(3).standard_normal(depth.size)
    force = 10e-3 * ((depth - 300e-9) / 200e-9) ** 1.35 + noise
    return oliver_pharr(Curve(depth, force), Tip.berkovich())


NORMAL: dict[str, Callable[[], nacre.Solution]] = {
    "both coated, tilted": lambda: nacre.solve(
        BALL, LAYERED, LAYERED, grid=GRID, load=10.0, eccentricity=(1e-6, None), tilt=(None, 1e-4)
    ),
    "yielded": lambda: nacre.solve(
        BALL, STEEL, grid=nacre.Grid((20, 20), (2e-4, 2e-4)), load=10.0, hardness=1e9
    ),
    "springs": lambda: nacre.solve(
        BALL,
        LAYERED,
        grid=GRID,
        load=10.0,
        compliance=np.linspace(0.0, 1e-15, 40 * 31).reshape(40, 31),
    ),
    "infinite gaps": lambda: nacre.solve(nacre.FlatPunch(5e-5), STEEL, grid=GRID, load=10.0),
    "nothing touches": lambda: nacre.solve(BALL, STEEL, grid=GRID, approach=-1e-6),
    "line": lambda: nacre.solve(ROD, LAYERED, grid=nacre.Grid.line(64, 2e-4, 1e-6), load=1e4),
    "not converged": lambda: nacre.solve(
        BALL, LAYERED, grid=GRID, load=10.0, max_iterations=2, check=False
    ),
    "given coefficients": lambda: nacre.Contact(
        LAYERED, GRID, coefficients=nacre.influence_coefficients(LAYERED, GRID, "image", 8)
    ).solve(BALL, approach=1e-7, tolerance=1e-5),
}
FRICTIONS = np.linspace(0.1, 0.5, 40 * 36).reshape(40, 36)
FRICTION: dict[str, Callable[[], nacre.types.FrictionSolution]] = {
    "slid": lambda: CONTACT.slide(BALL, **HELD, force=(2.0, 1.0), torque=1e-5),
    "cells, coupled": lambda: nacre.Contact(COATED, CELLS, STEEL).slide(
        BALL, load=10.0, friction=FRICTIONS, shift=(1e-7, None)
    ),
    "rolled": lambda: CONTACT.roll(BALL, **HELD, creepage=(1e-3, 2e-4), spin=3.0, direction="-x"),
    "given coefficients, slid": lambda: nacre.Contact(
        COATED, CELLS, coefficients=nacre.influence_coefficients(COATED, CELLS, "image")
    ).slide(BALL, load=10.0, friction=0.3, force=(1.0, None)),
    "line slid": lambda: LINE.slide(ROD, load=1e4, friction=0.3, force=(None, 1e3)),
    "line rolled": lambda: LINE.roll(ROD, load=1e4, friction=0.3, creepage=(1e-4, None)),
    "apart": lambda: CONTACT.slide(BALL, approach=-1e-6, friction=0.3),
    "not converged in friction": lambda: CONTACT.slide(
        BALL, **HELD, force=(2.0, None), max_convolutions=2, check=False
    ),
}


def indented(**given: Any) -> Callable[[], nacre.indent.IndentSolution]:
    asked: dict[str, Any] = {"body": FILM, "tip": ROUND} | given
    return lambda: nacre.indent.solve(**asked)


RADII = np.linspace(0, 4e-6, 5)
INDENT: dict[str, Callable[[], nacre.indent.IndentSolution]] = {
    "one": indented(load=1e-3),
    "row": indented(approach=[1e-9, 1e-8, 1e-7]),
    "plane": indented(radius=[[1e-7, 2e-7], [3e-7, 4e-7]]),
    "sticky": indented(load=[1e-4, 1e-3], adhesion=Adhesion.jkr(0.05), control="approach"),
    "maugis": indented(
        load=1e-3, adhesion=Adhesion.maugis(0.05, 1e7), counterbody=nacre.Elastic(70e9, 0.22)
    ),
    "sharp": indented(load=[1e-3], tip=Tip.cone(slope=0.3)),
    "rough": indented(load=1e-4, tip=Tip.profile(RADII, np.arange(5.0) ** 2 / 1e7)),
}


@frozen()
class Tried(TableResult):
    """A result that no Rust knows: everything follows from its fields and quantities."""

    _TITLE = "a result that is tried"

    force: tuple[float, float] = quantity("N", "N/m", AXIS, "force")
    """A force [N]."""
    shift: float = quantity("m", label="shift")
    """A length [m]."""
    steps: int
    axis: Literal["x", "y"] | None
    names: tuple[str, ...]
    is_line: bool


LINED = nacre.solve(
    ROD, nacre.HalfSpace(STEEL, [nacre.Layer(DLC, 1e-5)]), grid=nacre.Grid.line(64, 2e-4), load=1e4
)
LISTED: dict[str, Callable[[], Any]] = {
    "creep coefficients": lambda: nacre.creep_coefficients(STEEL, STEEL, (1e-3, 2e-3), cells=8),
    "fatigue": lambda: fatigue.assess(
        LINED,
        criteria=[fatigue.DangVan(520e6, 330e6)],
        shear_yield=6e8,
        depths=[0.0, 1e-5, 4e-5],
    ),
    "shakedown map": lambda: fatigue.shakedown_map(
        LINE.solve(ROD, load=1e4), friction=[0.0, 0.1], depths=[0.0, 1e-5]
    ),
    "unloading": unloaded,
    "conductance": lambda: LINED.conductance(conductivity=[9.0, 46.0], counter_conductivity=20.0),
    "tried": lambda: Tried((1.0, -2.0), 1e-9 / 3, 3, "x", ("a", "b"), False),
}
WEAR: dict[str, Callable[[], nacre.types.WearHistory]] = {
    "worn": lambda: CONTACT.wear(BALL, load=10.0, rate=1e-15, sliding=10.0, steps=2),
    "line worn": lambda: nacre.wear(
        ROD,
        COATED,
        load=1e4,
        grid=nacre.Grid.line(64, 2e-4),
        counter_rate=1e-16,
        rate={0: 1e-15, "substrate": 1e-14},
        sliding=1e3,
        steps=3,
    ),
}
FITS: dict[str, Callable[[], Fit]] = {"fit": fitted}


RESULTS: dict[str, Callable[[], Any]] = {
    **{**NORMAL, **FRICTION, **WEAR},
    **{**INDENT, **FITS, **LISTED},
}


@functools.cache
def solved(kind: str) -> Any:
    """Return the result of a kind; what it warns of is saved with it."""
    return quiet(RESULTS[kind])
