"""Largest stresses of coats below balls, lines, ellipses and rollers, of stacks and of both bodies.

References are those of programs that share nothing with nacre (coat_stresses.json of balls,
coat_shapes.json) and, for ellipses and rollers, finer cells (coat_ellipses.json). Errors are those
of the grids that nacre chooses and of line grids of 64 to 128 cells anywhere below the contact,
over the value or a fifth of the peak pressure, the larger.
"""

import functools
import json
from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import numpy as np
import pytest

import nacre
from bodies import quiet
from support import DATA

Case = dict[str, Any]

MEDIAN, USUAL, LARGEST = 0.002, 0.01, 0.02
"""Error of half of the extremes, of 95 %, with which a coat is designed, and of all."""
KNOWN = 0.03
"""Stated error of most extremes, 85 % of each family."""
SMALL = 0.2
"""Part of the peak pressure below which a stress need not be known more exactly."""
OF_REFERENCE = 5e-4
"""Error of the programs, whose largest values are those of sampled places and depths."""
CLAIMS = {
    "balls": ("coats-balls", "coats-balls-stated"),
    "lines": ("coats-lines", "coats-lines-stated"),
    "layers": ("coats-layers", "coats-layers-stated"),
    "counterbodies": ("coats-counterbodies", "coats-counterbodies-stated"),
    "rigid-bases": (None, None),
    "ellipses": ("coats-ellipses", "coats-ellipses-stated"),
    "rollers": ("coats-rollers", "coats-rollers-stated"),
}
"""Names of the claims of the largest error, and of stated over true ones, of each family."""
THREADS = 2
BALLS = 12
"""Balls of those that tests/stress/coats.rs tries."""


class Extreme(NamedTuple):
    """Errors of one extreme over its scale, and where it is."""

    where: str
    error: float
    stated: float
    of_reference: float

    @property
    def is_within(self) -> bool:
        """Whether the true error is at most the stated one and that of the reference."""
        return self.error <= self.stated + self.of_reference


def read(name: str) -> dict[str, list[Case]]:
    content: dict[str, list[Case]] = json.loads((DATA / name).read_text(encoding="utf-8"))
    return content


def ball(case: Case) -> Case:
    """Return a case of coat_stresses.json in the form of the other files."""
    names = {name: case[f"coat_{name}"] for name in ("tension", "von_mises")}
    values = names | {"interface_shear": case["interface_shear"]}
    known = {name: value for name, value in values.items() if value is not None}
    layers, extremes = [[case["thickness"], *case["coat"]]], {"body 0": known}
    return case | {"family": "balls", "contact": "ball", "layers": layers, "extremes": extremes}


def cases(family: str) -> list[Case]:
    """Return the contacts of a family."""
    if family == "balls":
        return [ball(case) for case in read("coat_stresses.json")["random"][:BALLS]]
    names = ("coat_shapes.json", "coat_ellipses.json")
    return [case for name in names for case in read(name)["cases"] if case["family"] == family]


def coated(layers: list[list[float]], substrate: list[float] | None) -> nacre.HalfSpace:
    base = nacre.RIGID if substrate is None else nacre.Elastic(*substrate)
    rows = [nacre.Layer(nacre.Elastic(young, nu), h) for h, young, nu in layers]
    return nacre.HalfSpace(base, rows)


def solved(case: Case, random: np.random.Generator) -> tuple[nacre.Solution, tuple[float, float]]:
    """Return the solution, and the direction in which the counterbody slides."""
    steel = [210e9, 0.3]
    body = coated(case["layers"], case.get("substrate", steel))
    counterbody = None if case.get("counter") is None else coated(case["counter"], steel)
    options: Any = {"load": case["load"], "threads": THREADS}
    if case.get("contact") == "line":
        cells, width = int(random.integers(64, 129)), random.uniform(2.6, 3.4) * case["half_width"]
        grid = nacre.Grid.line(cells, width, random.uniform(-0.5, 0.5) * width / cells)
        options["grid"] = grid
        return nacre.solve(nacre.Cylinder(case["radius"]), body, counterbody, **options), (0, 1)
    if case.get("contact") == "ball":
        return nacre.solve(nacre.Sphere(case["radius"]), body, counterbody, **options), (1, 0)
    kind = nacre.Paraboloid if case["family"] == "ellipses" else nacre.Roller
    angle = np.radians(case["angle"])
    return nacre.solve(kind(**case["shape"]), body, **options), (np.cos(angle), np.sin(angle))


def extremes(case: Case, random: np.random.Generator) -> Iterator[Extreme]:
    """Yield the errors of all layers and interfaces of a contact."""
    solution, direction = quiet(solved, case, random)
    sliding = {"friction": case["friction"], "direction": direction} if case["friction"] else {}
    summaries: dict[str, nacre.types.StressSummary] = {}
    for part, values in case["extremes"].items():
        member, number = part.split()
        if member not in summaries:
            summaries[member] = quiet(
                solution.stress_summary, body=member, threads=THREADS, **sliding
            )
        summary = summaries[member]
        layer, interface = summary.layers[int(number)], summary.interfaces[int(number)]
        found = {
            "tension": (layer.tension[0], layer.uncertainty["tension"]),
            "von_mises": (layer.von_mises[0], layer.uncertainty["von_mises"]),
            "interface_shear": (interface.shear[0], interface.uncertainty["shear"]),
        }
        for name, exact in values.items():
            value, stated = found[name]
            scale = max(exact, SMALL * case["p0"])
            known = case["errors"][part][name] / scale if "errors" in case else OF_REFERENCE
            where = f"{case['family']} {case['id']} {part} {name} friction {case['friction']}"
            yield Extreme(where, abs(value - exact) / scale, stated / scale, known)


def lines_of(found: list[Extreme]) -> str:
    return "\n".join(
        f"{each.where}: {each.error:.4f}, stated {each.stated:.4f}, "
        f"reference {each.of_reference:.4f}"
        for each in sorted(found, key=lambda each: -each.error)
    )


@functools.cache
def tried(family: str) -> list[Extreme]:
    """Return the errors of a family, and print what they amount to."""
    random = np.random.default_rng(7)
    found = [each for case in cases(family) for each in extremes(case, random)]
    errors = np.array([each.error for each in found])
    stated = np.array([each.stated for each in found])
    print(
        f"{family}: {len(found)} extremes, error {np.median(errors):.1e} median, "
        f"{errors.max():.4f} largest, {np.mean(errors <= USUAL):.1%} within 1 %; stated: "
        f"{np.mean([each.is_within for each in found]):.1%} hold, "
        f"{np.median(stated / errors):.1f} times the error in the median, "
        f"{np.mean(stated <= KNOWN):.0%} within 3 %"
    )
    return found


ON_RIGID_BASE = pytest.mark.xfail(
    strict=True,
    reason="the tension of a thin layer on a rigid base falls to half within a hundredth of a "
    "half-width from the edge: on 64 to 128 cells it is off by 4 % of the peak pressure",
)


FAMILIES = [
    pytest.param(name, marks=ON_RIGID_BASE if name == "rigid-bases" else ()) for name in CLAIMS
]


@pytest.mark.slow
@pytest.mark.parametrize("family", FAMILIES)
def test_errors_are_small(family: str, claim: Callable[[str, float], None]) -> None:
    found = tried(family)
    above = [each for each in found if each.error > USUAL]
    assert len(above) <= 0.05 * len(found), lines_of(above)
    largest = max(each.error for each in found)
    assert largest <= LARGEST, lines_of(above)
    assert np.median([each.error for each in found]) <= MEDIAN
    assert np.mean([each.stated <= KNOWN for each in found]) >= 0.85
    if name := CLAIMS[family][0]:
        claim(name, largest)


@pytest.mark.slow
def test_stated_errors_hold(claim: Callable[[str, float], None]) -> None:
    """Those that do not are tensions half a cell outside the edge of lines, off by up to 1.5 %."""
    beyond = {family: [each for each in tried(family) if not each.is_within] for family in CLAIMS}
    for family, missed in beyond.items():
        assert len(missed) <= 0.04 * len(tried(family)), lines_of(missed)
    together = [each for missed in beyond.values() for each in missed]
    assert len(together) <= 0.01 * sum(len(tried(family)) for family in CLAIMS), lines_of(together)
    for family, (_, name) in CLAIMS.items():
        if name:
            claim(name, float(np.median([each.stated / each.error for each in tried(family)])))
