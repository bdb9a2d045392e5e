"""A keyword that nobody knows is reported with the name of the function that was called."""

from __future__ import annotations

import functools
import inspect
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

import nacre
from bodies import quiet
from nacre import bearing, design, fatigue, friction, indent, plot, rough
from nacre._tools.groups import grouped

MODULES = (nacre, bearing, design, fatigue, friction, indent, plot, rough, nacre.types)
STEEL, BALL = nacre.Elastic(210e9, 0.3), nacre.Sphere(5e-3)
GRID = nacre.Grid((16, 16), (3e-4, 3e-4))
COATED = nacre.HalfSpace(STEEL, [nacre.Layer(nacre.Elastic(300e9, 0.2), 2e-5)])
WRONG: dict[str, Any] = {"misspelt": 1}


def public() -> Iterator[tuple[str, Callable[..., object]]]:
    """Yield all public functions, and the methods of public classes that Python defines."""
    seen = set()
    for module in MODULES:
        for name in getattr(module, "__all__", dir(module)):
            thing = getattr(module, name, None)
            if name.startswith("_") or id(thing) in seen:
                continue
            seen.add(id(thing))
            if inspect.isfunction(thing):
                yield name, thing
            elif inspect.isclass(thing):
                for method in dir(thing):
                    function = getattr(thing, method)
                    if not method.startswith("_") and inspect.isfunction(function):
                        yield f"{name}.{method}", function


def takes_groups(function: Callable[..., object]) -> bool:
    """Return whether a function takes keywords that its signature does not write out."""
    written = inspect.unwrap(function).__code__
    return bool(written.co_flags & inspect.CO_VARKEYWORDS)


PUBLIC = dict(public())
GROUPED = {name for name, function in PUBLIC.items() if takes_groups(function)}


@functools.cache
def solved(what: str = "solution") -> Any:
    """Return a result."""
    if what == "coated":
        return quiet(nacre.solve, BALL, COATED, load=10.0, grid=GRID)
    if what == "slid":
        pull: dict[str, Any] = {"load": 10.0, "friction": 0.3, "force": (1.0, 0.0)}
        return quiet(nacre.slide, BALL, STEEL, STEEL, grid=GRID, **pull)
    if what == "pair":
        ball = bearing.AngularContactBall(
            count=12, diameter=11.1e-3, pitch_diameter=46e-3, contact_angle=0.4
        )
        pair = bearing.Pair(ball, ball, arrangement="O", distance=0.03)
        return quiet(pair.solve, force=(400.0, 0.0, 150.0), model="iso16281")
    return quiet(nacre.solve, BALL, STEEL, load=10.0, grid=GRID)


CONTACT = nacre.Contact(STEEL, GRID, STEEL)
ROLLER = bearing.CylindricalRoller(count=16, diameter=11e-3, pitch_diameter=65.5e-3, length=12e-3)
TAPERED = bearing.TaperedRoller(
    count=16, diameter=11e-3, pitch_diameter=65.5e-3, length=12e-3, contact_angle=0.25
)
SPHERICAL = bearing.SphericalRoller(
    count=16,
    diameter=11e-3,
    pitch_diameter=65.5e-3,
    length=10e-3,
    contact_angle=0.2,
    profile_radius=35e-3,
)
GROOVE = bearing.DeepGrooveBall(count=9, diameter=9.525e-3, pitch_diameter=46e-3)
ANGULAR = bearing.AngularContactBall(
    count=12, diameter=11.1e-3, pitch_diameter=46e-3, contact_angle=0.4
)
RATE: dict[str, Any] = {"rate": 1e-16}
CATALOGUE: dict[str, Any] = {"bore": 0.03, "outside_diameter": 0.062, "capacity": 19.5e3}
CALLS: dict[str, Callable[[], object]] = {
    "solve": lambda: nacre.solve(BALL, STEEL, load=10.0, **WRONG),
    "slide": lambda: nacre.slide(BALL, STEEL, load=10.0, **WRONG),
    "roll": lambda: nacre.roll(BALL, STEEL, load=10.0, **WRONG),
    "wear": lambda: nacre.wear(BALL, STEEL, load=10.0, **RATE, **WRONG),
    "Contact.solve": lambda: CONTACT.solve(BALL, load=10.0, **WRONG),
    "Contact.solve_many": lambda: CONTACT.solve_many([], **WRONG),
    "Contact.slide": lambda: CONTACT.slide(BALL, load=10.0, **WRONG),
    "Contact.roll": lambda: CONTACT.roll(BALL, load=10.0, **WRONG),
    "Contact.wear": lambda: CONTACT.wear(BALL, load=10.0, **RATE, **WRONG),
    "Solution.save": lambda: solved().save(Path("x.vtr"), **WRONG),
    "CylindricalRoller.solve": lambda: ROLLER.solve(force=(1e3, 0.0, None), **WRONG),
    "TaperedRoller.solve": lambda: TAPERED.solve(force=(1e3, 0.0, None), **WRONG),
    "SphericalRoller.solve": lambda: SPHERICAL.solve(force=(1e3, 0.0, None), **WRONG),
    "DeepGrooveBall.solve": lambda: GROOVE.solve(force=(1e3, 0.0, None), **WRONG),
    "AngularContactBall.solve": lambda: ANGULAR.solve(force=(1e3, 0.0, None), **WRONG),
    "Pair.solve": lambda: solved("pair").pair.solve(force=(1e3, 0.0, 1e2), **WRONG),
    "PairSolution.life": lambda: solved("pair").life(**WRONG),
    "estimated_balls": lambda: bearing.estimated_balls(
        **CATALOGUE, static_capacity=11.3e3, **WRONG
    ),
    "rough.load_curve": lambda: rough.load_curve(BALL, STEEL, [1e6], grid=GRID, **WRONG),
    "random_surface": lambda: rough.random_surface(
        (8, 8), (1e-4, 1e-4), hurst=0.8, shortest=3e-5, longest=1e-4, **WRONG
    ),
    "friction.creep_curve": lambda: friction.creep_curve(
        BALL, STEEL, STEEL, creepages=[1e-4], load=10.0, grid=GRID, friction=0.3, **WRONG
    ),
    "coating_chart": lambda: design.coating_chart(
        BALL, STEEL, thickness=[1e-6], young=[3e11], load=10.0, **WRONG
    ),
    "force_table": lambda: design.force_table(BALL, STEEL, [1e-6], **WRONG),
    "design.load_curve": lambda: design.load_curve(BALL, STEEL, [10.0], **WRONG),
    "tilt_curve": lambda: design.tilt_curve(BALL, STEEL, [1e-6], load=10.0, **WRONG),
    "section": lambda: plot.section(solved(), **WRONG),
    "stress_depth": lambda: plot.stress_depth(solved(), **WRONG),
    "stress_section": lambda: plot.stress_section(solved(), **WRONG),
    "interface_map": lambda: plot.interface_map(solved("coated"), **WRONG),
    "loop": lambda: plot.loop([solved("slid")], **WRONG),
}
"""Functions with groups of keywords, called with one that nobody knows."""


@pytest.mark.parametrize("name", CALLS)
def test_an_unknown_keyword_is_reported_by_who_was_called(name: str) -> None:
    called = name.rpartition(".")[2] if name.split(".")[0].islower() else name
    with pytest.raises(TypeError, match=rf"^{called}(\(\) got .*| has no argument )'?misspelt"):
        CALLS[name]()


STUDIES = {"curve", "distribution", "load_curve", "creep_curve"}
"""Functions that draw a table, whose keywords are those of a line, as `section` has them."""


def test_all_functions_with_groups_of_keywords_are_called() -> None:
    called = {name.rpartition(".")[2] if name.split(".")[0].islower() else name for name in CALLS}
    assert called | STUDIES >= GROUPED
    assert len(GROUPED) > 20


WRITTEN = sorted(set(PUBLIC) - GROUPED)


@pytest.mark.parametrize("name", WRITTEN)
def test_functions_that_write_their_keywords_out_have_their_own_name(name: str) -> None:
    with pytest.raises(TypeError, match=rf"^(\w+\.)?{name.rpartition('.')[2]}\(\) got .*misspelt"):
        PUBLIC[name](**WRONG)


@pytest.mark.parametrize("name", ["HeightMap", "SampledProfile"])
def test_readers_have_the_name_of_their_class(name: str) -> None:
    with pytest.raises(TypeError, match=rf"^{name}\.read\(\) got"):
        getattr(nacre, name).read("x.csv", **WRONG)


@pytest.mark.parametrize("name", ["DangVan", "Crossland", "Findley", "Matake"])
def test_criteria_have_their_own_names(name: str) -> None:
    with pytest.raises(TypeError, match=rf"^{name}\.__init__\(\) got"):
        getattr(fatigue, name)(bending=1.0, torsion=0.7, **WRONG)


@pytest.mark.parametrize("name", ["stress", "stress_summary"])
def test_methods_of_solutions_have_the_class_of_the_solution(name: str) -> None:
    for result in (solved(), solved("slid")):
        with pytest.raises(TypeError, match=rf"^{type(result).__name__}\.{name}\(\) got"):
            getattr(result, name)(**WRONG)


def test_other_errors_pass() -> None:
    @grouped()
    def fails() -> None:
        raise TypeError("f() got an unexpected keyword argument 'inner'")

    with pytest.raises(TypeError, match=r"^f\(\) got .*'inner'"):
        fails()
    with pytest.raises(TypeError, match="z"):
        solved().stress(body="body")
