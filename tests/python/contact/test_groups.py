"""Groups of keywords: the compiled module reads each field, and overloads have each keyword."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from dataclasses import fields
from typing import Any, get_overloads, get_type_hints

import pytest

import nacre
from nacre import _core as core
from nacre.contact import Contact, stresses
from nacre.contact import arguments as groups


class Group:
    """Stands for a group of keywords: it has what the group has, and says what was read."""

    def __init__(self, kind: type, missing: str | None = None) -> None:
        self.kind, self.missing, self.read = kind, missing, list[str]()

    def __getattr__(self, name: str) -> Any:
        self.read.append(name)
        if name == self.missing or name not in [field.name for field in fields(self.kind)]:
            raise AttributeError(name)
        return Group(groups.Motion) if name == "motion" else None


def solve(motion: Any = None, options: Any = None, on: Any = None) -> Any:
    kinds = (groups.Motion, groups.SolveOptions, groups.Setup)
    parts = [part or Group(kind) for part, kind in zip((motion, options, on), kinds, strict=True)]
    return core.solve(None, *parts)  # type: ignore[arg-type]


def slide(step: Any = None, options: Any = None) -> Any:
    step, options = step or Group(groups.FrictionStep), options or Group(groups.FrictionOptions)
    return core.slide(None, step, None, options, Group(groups.Setup))  # type: ignore[arg-type]


def roll(rolling: Any) -> Any:
    options, setup = Group(groups.FrictionOptions), Group(groups.Setup)
    return core.roll(None, rolling, options, setup)  # type: ignore[arg-type]


def stress(fields: Any = None, options: Any = None) -> Any:
    steel, grid = nacre.Elastic(210e9, 0.3), nacre.Grid(shape=(8, 8), size=(1e-3, 1e-3))
    fields = fields or Group(stresses.StressFields)
    options = options or Group(stresses.StressOptions)
    return core.stress_under(steel, grid, [[1.0] * 8] * 8, 0.0, fields, options)


def stress_summary(limits: Any) -> Any:
    solution = nacre.solve(
        nacre.Sphere(5e-3),
        nacre.Elastic(210e9, 0.3),
        load=10.0,
        grid=nacre.Grid((32, 32), (2e-4,) * 2),
    )
    options: Any = Group(stresses.StressOptions)
    return core.stress_summary(solution._solved, limits, options)


CALLS: list[tuple[type, Callable[[Any], Any]]] = [
    (groups.Motion, lambda motion: solve(motion=motion)),
    (groups.SolveOptions, lambda options: solve(options=options)),
    (groups.Setup, lambda setup: solve(on=setup)),
    (groups.FrictionStep, lambda step: slide(step=step)),
    (groups.FrictionOptions, lambda options: slide(options=options)),
    (groups.Rolling, roll),
    (stresses.StressFields, lambda fields: stress(fields=fields)),
    (stresses.StressOptions, lambda options: stress(options=options)),
    (stresses.StressLimits, stress_summary),
]


@pytest.mark.parametrize(("kind", "call"), CALLS, ids=lambda value: getattr(value, "__name__", ""))
def test_the_compiled_module_reads_each_field_and_misses_none(
    kind: type, call: Callable[[Any], Any]
) -> None:
    names = [field.name for field in fields(kind)]
    group = Group(kind)
    with pytest.raises((TypeError, ValueError)):
        call(group)  # all fields are None
    assert sorted(set(group.read)) == sorted(names)
    for name in names:
        with pytest.raises((AttributeError, TypeError), match=name):
            call(Group(kind, missing=name))


@pytest.mark.parametrize(
    "function",
    [nacre.slide, nacre.roll, Contact.slide, Contact.roll],
    ids=lambda function: str(function.__qualname__),
)
def test_overloads_have_the_keywords_of_their_function(function: Callable[..., Any]) -> None:
    names = {*inspect.signature(function).parameters}
    overloads = get_overloads(function)
    assert len(overloads) == 2
    for overload in overloads:
        *own, keywords = inspect.signature(overload).parameters
        packed = get_type_hints(overload)[keywords].__args__[0]
        assert {*own, *get_type_hints(packed)} == names
