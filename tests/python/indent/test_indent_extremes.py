"""Every number of nacre.indent at the ends of the machine: a right answer, or an error by name."""

from __future__ import annotations

import os
import sys
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import nacre
from nacre.indent import Adhesion, Indentation, Tip, charts, slope_of
from support import python

EXTREMES = [
    *(0.0, -1.0, 5e-324, -5e-324, 1e-300, 1e-160, 1e-30, 1e30, 1e160, 1e300, -1e300),
    *(float("inf"), float("-inf"), float("nan"), 10**400, -(10**400)),
]
BASE = nacre.Elastic(70e9, 0.22)
BODY = nacre.HalfSpace(BASE, [nacre.Layer(nacre.Elastic(3e9, 0.4), 1e-6)])
TIPS = {
    "sphere": Tip.sphere(5e-6),
    "cone": Tip.cone(slope=0.3),
    "power": Tip.power(1e-2, 1.5),
    "rounded_cone": Tip.rounded_cone(1e-6, slope=0.3),
    "rounded_punch": Tip.rounded_punch(1e-6, 5e-6),
    "flat_cone": Tip.flat_cone(1e-6, slope=0.3),
    "flat_punch": Tip.flat_punch(1e-6),
    "profile": Tip.profile(np.linspace(0, 2e-5, 9), np.linspace(0, 2e-5, 9) ** 2 / 1e-5),
}
ADHESIONS = {
    "jkr": Adhesion.jkr(0.05),
    "dmt": Adhesion.dmt(0.05),
    "maugis": Adhesion.maugis(0.05, 1e7),
}


def stated(state: Any) -> list[Any]:
    """Return what a state says, with its fields."""
    r = [0.3e-7, 2e-6]
    return [state.load, state.approach, state.radius, state.stiffness, state.pressure(r)]


def used(tip: Tip) -> list[Any]:
    """Return what a tip says, in use where it can be used at all."""
    made = Indentation(BASE, tip)
    try:
        return [tip.gap(1e-7), *stated(made.at(load=1e-6))]
    except ValueError as error:
        # A tip of any size is a tip; that a load is beyond it is said of the load.
        if not str(error).startswith(("load must be ", "the contact of this tip")):
            raise
        return []


def adhering(adhesion: Adhesion, tip: Tip = TIPS["sphere"]) -> list[Any]:
    last = Indentation(BASE, tip, adhesion=adhesion).pull_off()
    return [last.load, last.approach, last.radius]


def calls() -> dict[str, tuple[str, Callable[[Any], Any]]]:
    """Return functions of one number by their names, each with the name of the number."""
    found: dict[str, tuple[str, Callable[[Any], Any]]] = {
        "slope_of": ("half_angle", slope_of),
        "cone": ("slope", lambda x: used(Tip.cone(slope=x))),
        "cone angle": ("half_angle|slope", lambda x: used(Tip.cone(half_angle=x))),
        "sphere": ("radius", lambda x: used(Tip.sphere(x))),
        "paraboloid": ("radius", lambda x: used(Tip.paraboloid(x))),
        "flat_punch": ("radius", lambda x: used(Tip.flat_punch(x))),
        "factor": ("factor", lambda x: used(Tip.power(x, 2.0))),
        "exponent": ("exponent", lambda x: used(Tip.power(1e-3, x))),
        "berkovich": ("radius", lambda x: used(Tip.berkovich(x))),
        "rounded_cone": ("radius", lambda x: used(Tip.rounded_cone(x, slope=0.3))),
        "rounded_cone slope": ("slope", lambda x: used(Tip.rounded_cone(1e-6, slope=x))),
        "rounded_punch": ("radius", lambda x: used(Tip.rounded_punch(1e-6, x))),
        "rounded_punch flat": ("flat", lambda x: used(Tip.rounded_punch(x, 1e-6))),
        "flat_cone": ("flat", lambda x: used(Tip.flat_cone(x, slope=0.3))),
        "flat_cone slope": ("slope", lambda x: used(Tip.flat_cone(1e-6, slope=x))),
        "area depth": ("depth|area function", lambda x: used(Tip.area_function([24.5], x))),
        "jkr": ("work|minimum", lambda x: adhering(Adhesion.jkr(x))),
        "dmt": ("work", lambda x: adhering(Adhesion.dmt(x))),
        "maugis work": ("work|kind", lambda x: adhering(Adhesion.maugis(x, 1e7))),
        "maugis strength": ("strength|kind", lambda x: adhering(Adhesion.maugis(0.05, x))),
        "control": ("force|minimum", Indentation(BASE, TIPS["sphere"]).work_from_pull_off),
        # Without a limit within 0.001 to 3 there is NaN, as stated.
        "bulk_limit": ("must", lambda x: [len(charts.bulk_limit([x]))]),
        "pull_off_over_thickness": (
            "thickness",
            lambda x: charts.pull_off_over_thickness(4.0, [x]),
        ),
    }
    for name, tip in TIPS.items():
        # Others could grow up to 1024 thicknesses, where a contact takes seconds.
        is_small = name in ("sphere", "profile", "flat_punch")
        for body in (BASE, BODY) if is_small else (BASE,):
            test = Indentation(body, tip)
            kind = f"{name} on {'bare' if body is BASE else 'coated'}"
            for given in ("load", "approach", "radius"):
                if given == "radius" and name == "flat_punch":
                    continue
                call = lambda x, t=test, g=given: stated(t.at(**{g: x}))  # noqa: E731
                found[f"{kind} at {given}"] = (given, call)
            curve = lambda x, t=test: t.curve(approach=[x, 1e-9]).load  # noqa: E731
            found[f"{kind} curve"] = ("approach", curve)
        found[f"gap of {name}"] = ("r", tip.gap)
    for name, adhesion in ADHESIONS.items():
        test = Indentation(BASE, TIPS["sphere"], adhesion=adhesion)
        for given in ("load", "approach", "radius"):
            call = lambda x, t=test, g=given: stated(t.at(**{g: x}))  # noqa: E731
            found[f"{name} at {given}"] = (f"{given}|zone", call)
    state = Indentation(BODY, TIPS["sphere"]).at(load=1e-4)
    for name in ("pressure", "displacement", "gap"):
        found[f"{name} of a state"] = ("r", getattr(state, name))
    found["stress at r"] = ("r", lambda x: list(state.stress(x, 1e-6).values()))
    found["stress at z"] = ("z", lambda x: list(state.stress(0.0, x).values()))
    return found


def tried(name: str) -> list[str]:
    """Return what is wrong with the answers of a function."""
    said, call = calls()[name]
    wrong = []
    for value in EXTREMES:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", nacre.NacreWarning)
            try:
                answer = call(value)
            except (ValueError, TypeError) as error:
                text = str(error)
                # pyo3 and NumPy name integers that are no floats.
                whole = isinstance(value, int)
                if not whole and not any(word in text for word in said.split("|")):
                    wrong.append(f"{value!r}: {text}")
                continue
            except BaseException as error:
                wrong.append(f"{value!r}: {error!r}")
                continue
        parts = [np.ravel(part) for part in (answer if isinstance(answer, list) else [answer])]
        flat = np.concatenate([*parts, [0.0]])
        if np.isnan(flat).any():
            wrong.append(f"{value!r}: {flat}")
    return wrong


NAMES = list(calls())


@pytest.mark.parametrize("part", range(8))
def test_no_number_hangs_panics_or_makes_nan(part: int) -> None:
    names = NAMES[part::8]
    # Each part takes some seconds, and a hang much longer.
    code = "import sys; from test_indent_extremes import tried\n" + (
        "for name in sys.argv[1:]:\n    print(name, flush=True)\n"
        "    for wrong in tried(name): print('WRONG', name, wrong, flush=True)\n"
    )
    # `support` stands in another folder than this file.
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(sys.path)}
    ran = python("-c", code, *names, folder=Path(__file__).parent, env=environment)
    wrong = [line for line in ran.stdout.splitlines() if line.startswith("WRONG")]
    assert ran.returncode == 0, ran.stderr[-2000:] + ran.stdout[-300:]
    assert not wrong, "\n".join(wrong)
