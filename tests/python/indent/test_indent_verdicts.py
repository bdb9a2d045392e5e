"""Errors of what a fit holds count, and verdicts of fits and indentations are levels of them."""

from __future__ import annotations

import ast
import dataclasses
import functools
import html
import json
import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import nacre
from bodies import STEEL, quiet
from nacre.indent import Fit, Indentation, IndentSolution, Tip, fit
from nacre.results.verdict import TEXTS, Verdict
from results import solved
from support import ROOT, Capture, command, written

YOUNG = "body.layers[0].material.young"
POISSON = "body.layers[0].material.poisson"
THICKNESS = "body.layers[0].thickness"
GLASS = nacre.Elastic(70e9, 0.22)
DEPTH = np.linspace(1e-8, 2e-7, 40)
HELD = {YOUNG: 3e9, THICKNESS: 1e-6, "body.substrate.young": 70e9, "tip.radius": 5e-6, POISSON: 0.3}


def film(young: float = 3e9, thickness: float = 1e-6) -> nacre.HalfSpace:
    return nacre.HalfSpace(GLASS, [nacre.Layer(nacre.Elastic(young, 0.3), thickness)])


def forces(thickness: float = 1e-6, radius: float = 5e-6) -> np.ndarray:
    indentation = Indentation(film(thickness=thickness), Tip.sphere(radius))
    return indentation.curve(approach=DEPTH).load


FORCES = forces()
NOISE = np.random.default_rng(5).standard_normal(DEPTH.size)


def fitted(force: np.ndarray, *free: str, **keywords: Any) -> Fit:
    keywords |= {"noise": "relative", "profile": False}
    found: Fit = quiet(fit, (DEPTH, force), film(), Tip.sphere(5e-6), free or [YOUNG], **keywords)
    return found


# Errors of what is held.

CUBIC = 1e-3
"""A central difference errs by a sixth of the third derivative times the square of the step of 1 %:
1e-4 for powers up to the third; of a Poisson's ratio the step is 0.002."""
NEGLECTED = 0.02
"""Residuals of 1 % times second derivatives, which Gauss and Newton leave out, over 40 points."""


@pytest.mark.parametrize("held", [THICKNESS, "body.substrate.young", "tip.radius", POISSON])
@pytest.mark.parametrize(("noise", "tolerance"), [(0.0, CUBIC), (0.01, NEGLECTED)])
def test_a_source_of_error_is_what_a_fit_with_another_number_gives(
    held: str, noise: float, tolerance: float
) -> None:
    value, force = HELD[held], FORCES * np.exp(noise * NOISE)
    error = 0.002 if held == POISSON else 0.01 * value
    nuisance = ["contact_point"] if held == "tip.radius" else []
    low, high = (
        fitted(force, nuisance=nuisance, known={held: (value + side * error, error)})
        for side in (-1, 1)
    )
    middle = fitted(force, nuisance=nuisance, known={held: (value, error)})
    change = 0.5 * (high.estimates[YOUNG] - low.estimates[YOUNG])
    assert middle.error_sources[YOUNG][held] == pytest.approx(abs(change), rel=tolerance)
    assert middle.error_sources[YOUNG]["noise"] == middle.standard_errors[YOUNG]


def test_the_whole_error_is_the_scatter_of_curves_of_other_bodies() -> None:
    count, spread = 40, 0.02  # so that residuals do not show what is wrong
    rng = np.random.default_rng(11)
    known = {"tip.radius": (5e-6, spread * 5e-6), THICKNESS: (1e-6, spread * 1e-6)}
    fits = []
    for _ in range(count):
        thickness, radius = np.exp(spread * rng.standard_normal(2)) * (1e-6, 5e-6)
        noise = np.exp(spread * rng.standard_normal(DEPTH.size))
        fits.append(fitted(forces(thickness, radius) * noise, known=known))
    scatter = np.std([found.estimates[YOUNG] for found in fits], ddof=1)
    whole = np.mean([found.uncertainty[YOUNG] for found in fits])
    # Three standard deviations of a standard deviation of as many numbers.
    assert scatter / whole == pytest.approx(1, abs=3 / math.sqrt(2 * (count - 1)))
    assert np.mean([found.standard_errors[YOUNG] for found in fits]) < 0.3 * scatter


def test_a_known_value_is_that_of_the_parameter_and_its_error_is_kept(tmp_path: Path) -> None:
    known = {"tip.radius": (4e-6, 2e-8), THICKNESS: (1.1e-6, 0.0)}
    found = fitted(FORCES * np.exp(0.01 * NOISE), known=known)
    assert found.tip.numbers["radius"] == 4e-6
    assert found.body.layers[0].thickness == 1.1e-6
    assert found.known == known
    for path in (tmp_path / "fit.nc", tmp_path / "fit.csv"):
        found.save(path)
    assert nacre.load(tmp_path / "fit.nc") == found
    assert f"{found.uncertainty[YOUNG]}" in (tmp_path / "fit.csv").read_text()
    sources = found.error_sources[YOUNG]
    assert sources[THICKNESS] == 0
    assert found.uncertainty[YOUNG] == pytest.approx(math.hypot(*sources.values()))
    assert "Errors of 1 % are assumed of the modulus of the substrate:" in str(found)
    for pair in ([0.0, 1.0], [1.0, -1.0], [1.0, math.inf]):
        with pytest.raises(ValueError, match="Fit"):
            Fit.from_dict(found.to_dict() | {"known": {"tip.radius": pair}})
    old = found.to_dict()
    del old["known"]
    assert set(Fit.from_dict(old).error_sources[YOUNG]) == set(sources)


def test_one_per_cent_is_assumed_and_said() -> None:
    found = fitted(FORCES * np.exp(0.01 * NOISE))
    sources = found.error_sources[YOUNG]
    assert set(sources) == {"noise", THICKNESS, "body.substrate.young", "tip.radius"}
    assert sources["tip.radius"] == pytest.approx(
        0.01 * found.estimates[YOUNG] * abs(found.sensitivity[YOUNG]["tip.radius"])
    )
    assert "radius of the tip ± 1 %: " in found.verdict().words
    assert "Errors of 1 % are assumed of the thickness of the film" in found.verdict().lines[0]
    assert "such as Poisson's ratios, counts as exact" in found.verdict().lines[0]
    ratios = {POISSON: (0.3, 0.02), "body.substrate.poisson": (0.22, 0.01)}
    measured = fitted(FORCES * np.exp(0.01 * NOISE), known=ratios).verdict()
    assert "Poisson's ratio of the film ± 0.02: " in measured.words
    assert "What else is held counts as exact." in measured.lines[0]
    two = fitted(FORCES * np.exp(0.01 * NOISE), YOUNG, THICKNESS)
    assert set(two.error_sources) == set(two.uncertainty) == {YOUNG, THICKNESS}


def test_a_tip_without_numbers_has_an_area() -> None:
    radii = np.array([0, 1e-6, 2e-6, 4e-6])
    tip = Tip.profile(radii, radii**2 / 1e-5)
    force = Indentation(film(), tip).curve(approach=DEPTH).load * np.exp(0.01 * NOISE)
    found = quiet(
        fit, (DEPTH, force), film(), tip, [YOUNG], profile=False, known={"tip.area": (1.0, 0.02)}
    )
    assert found.error_sources[YOUNG]["tip.area"] == pytest.approx(
        0.02 * found.estimates[YOUNG] * abs(found.sensitivity[YOUNG]["tip.area"])
    )
    assert "area of the tip ± 2 %: " in found.verdict().words


@pytest.mark.parametrize(
    ("known", "message"),
    [
        ({"radius": (5e-6, 5e-8)}, "known must name parameters that are held, .*'tip.radius'"),
        ({YOUNG: (3e9, 1e7)}, "known must name parameters that are held"),
        ({"tip.area": (1.0, 0.01)}, "known must name parameters that are held"),
        ({"tip.radius": (5e-6, -5e-8)}, "standard error, not below 0"),
        ({"tip.radius": (5e-6, math.nan)}, "standard error, not below 0"),
        ({"tip.radius": (-5e-6, 5e-8)}, "radius must"),
        ({"tip.radius": 5e-8}, "known must hold pairs of value and error"),
        ({"tip.radius": (5e-6, 5e-8, 1.0)}, "known must hold pairs of value and error"),
    ],
)
def test_wrong_knowledge_is_refused(known: Any, message: str) -> None:
    with pytest.raises((TypeError, ValueError), match=message):
        fitted(FORCES, known=known)


# Levels of fits.


def sure(share: float, **fields: Any) -> Fit:
    """Return a fit whose modulus has this error, all of it noise of a known size."""
    found: Fit = solved("fit")
    held = found.error_sources[YOUNG]
    return dataclasses.replace(
        found,
        free=(YOUNG,),
        estimates=found.estimates | {YOUNG: 5e9},
        standard_errors=found.standard_errors | {YOUNG: share * 5e9},
        known={path: (1.0, 0.0) for path in held if path != "noise"},
        is_sigma_known=True,
        reasons={},
        **fields,
    )


BOUNDS = [(0.9, "bad"), (1.1, "fair"), (1.49, "fair"), (1.51, "good")]
"""Tolerance over error, and the level."""
WARNED = [
    ("the model does not describe the data: residuals are 3 %", "unknown"),
    ("depth or force may be in a wrong unit: a force of 1 N", "unknown"),
    ("force falls from index 3 on: unloading is mixed in", "unknown"),
    ("the contact is too deep for its radius: its slope is 0.7", "unknown"),
    ("depths are in random order; np.argsort orders them", None),
]


@pytest.mark.parametrize(("share", "level"), BOUNDS)
def test_a_tolerance_of_a_fit_decides(share: float, level: str) -> None:
    verdict = sure(0.02).verdict(tolerance=0.02 * share)
    assert verdict.level == level
    assert verdict.factor == pytest.approx(share)
    assert verdict.decided_by == "modulus of film"
    assert verdict.words == (
        f"Modulus of film 5 GPa ± 2 % (noise 2 %), ± {2 * share:.3g} % tolerated."
    )
    assert not any("Give a tolerance" in line for line in verdict.lines)


@pytest.mark.parametrize(("share", "level"), [*BOUNDS, (None, "unknown")])
@pytest.mark.parametrize(("warning", "most"), WARNED)
def test_a_warning_of_a_fit_leaves_its_level_at_most(
    share: float | None, level: str, warning: str, most: str | None
) -> None:
    tolerance = None if share is None else 0.02 * share
    verdict = sure(0.02, warnings=(warning,)).verdict(tolerance=tolerance)
    assert verdict.level == (level if most is None or level == "bad" else most)
    reason = next(doubt.reason for words, doubt in TEXTS.items() if words in warning)
    assert (verdict.doubts == (reason,)) == (most is not None)
    assert verdict.inside_model == ("too deep" not in warning and "describe" not in warning)


def test_a_fit_is_judged_only_where_a_tolerance_is_given() -> None:
    verdict = sure(0.0001).verdict()
    assert (verdict.level, verdict.factor, verdict.decided_by) == ("unknown", None, None)
    assert verdict.words == "Modulus of film 5 GPa ± 0.01 % (noise 0.01 %)."
    assert verdict.lines[-1] == "Give a tolerance to judge it."
    for wrong in (0.0, -1.0, math.inf, math.nan):
        with pytest.raises(ValueError, match="tolerance must be above 0"):
            sure(0.02).verdict(tolerance=wrong)


def test_a_parameter_that_the_curves_do_not_tell_breaks_any_tolerance() -> None:
    reason = f"its 95 % interval does not close; it trades with {YOUNG}"
    found = dataclasses.replace(sure(0.02), reasons={YOUNG: reason})
    assert found.verdict().level == "unknown"
    verdict = found.verdict(tolerance=10.0)
    assert (verdict.level, verdict.factor) == ("bad", 0.0)
    assert verdict.words == (
        "Modulus of film 5 GPa, not identified: its 95 % interval does not close; it trades with "
        "the modulus of film."
    )


def test_an_error_that_is_not_known_is_not_judged() -> None:
    blind = dataclasses.replace(sure(0.02), sensitivity={})
    assert math.isnan(blind.uncertainty[YOUNG])
    verdict = blind.verdict(tolerance=0.5)
    assert verdict.level == "unknown"
    assert verdict.words == "Cannot tell: the effect of errors of the fixed numbers is not known."
    assert "Modulus of film 5 GPa (noise 2 %)" in verdict.lines[0]


def test_the_least_certain_parameter_decides() -> None:
    found = dataclasses.replace(sure(0.001), free=(YOUNG, THICKNESS))
    found = dataclasses.replace(
        found,
        estimates=found.estimates | {THICKNESS: 1e-6},
        standard_errors=found.standard_errors | {THICKNESS: 1e-7},
        sensitivity=dict.fromkeys((YOUNG, THICKNESS), dict.fromkeys(found.known, 0.0)),
        known={path: pair for path, pair in found.known.items() if path != THICKNESS},
    )
    verdict = found.verdict(tolerance=0.05)
    assert (verdict.level, verdict.decided_by) == ("bad", "thickness of film")
    assert verdict.words.startswith("Thickness of film 1 µm ± 10 % (noise 10 %)")
    assert verdict.lines[0].startswith("Modulus of film 5 GPa ± 0.1 %")


def test_an_error_whose_noise_is_estimated_is_known_to_a_part_of_itself() -> None:
    found = dataclasses.replace(sure(0.02), is_sigma_known=False, dof=8)
    # 1/√(2 · 8) = 25 %: what is 20 % above the tolerance may be below.
    assert found.verdict(tolerance=0.02 / 1.2).level == "fair"
    assert found.verdict(tolerance=0.02 / 1.4).level == "bad"
    assert found.verdict(tolerance=0.02 * 1.25 * 1.51).level == "good"


# Levels of indentations.


@functools.cache
def indented() -> IndentSolution:
    body = nacre.HalfSpace(STEEL, [nacre.Layer(nacre.Elastic(3e9, 0.4), 1e-6)])
    return nacre.indent.solve(body, Tip.sphere(5e-6), load=1e-5)


@functools.cache
def error_of_reading() -> float:
    verdict = indented().verdict(tolerance=1.0)
    assert verdict.factor is not None
    return 1 / verdict.factor


@pytest.mark.parametrize(("share", "level"), BOUNDS)
def test_a_tolerance_of_an_indentation_decides(share: float, level: str) -> None:
    verdict = indented().verdict(tolerance=share * error_of_reading())
    assert verdict.level == level
    assert verdict.factor == pytest.approx(share)
    assert verdict.decided_by == "modulus of the film"
    words = "The substrate shows" if level == "bad" else "The film is read"
    assert verdict.words.startswith(f"{words}: as a bare film, this curve gives ")
    kept = dataclasses.replace(indented(), tolerance=share * error_of_reading())
    assert kept.verdict() == verdict
    assert IndentSolution.from_dict(kept.to_dict()) == kept
    assert IndentSolution.from_dict(kept.to_dict()).verdict() == verdict
    assert Verdict.from_dict(json.loads(json.dumps(verdict.to_dict()))) == verdict


@pytest.mark.parametrize(("share", "level"), BOUNDS)
def test_a_steep_contact_is_in_doubt(share: float, level: str) -> None:
    steep = dataclasses.replace(
        indented(),
        warnings=("the contact is too deep for its radius: its slope is 0.7",),
        tolerance=share * error_of_reading(),
    )
    verdict = steep.verdict()
    assert verdict.level == ("bad" if level == "bad" else "unknown")
    assert not verdict.inside_model


def test_an_indentation_is_judged_only_where_a_tolerance_is_given() -> None:
    verdict = indented().verdict()
    assert (verdict.level, verdict.factor, verdict.question) == ("unknown", None, None)
    assert verdict.lines[-1] == "Give a tolerance to judge it."
    for wrong in (0.0, math.inf):
        with pytest.raises(ValueError, match="tolerance must be above 0"):
            indented().verdict(tolerance=wrong)
        with pytest.raises(ValueError, match="tolerance must be above 0"):
            nacre.indent.solve(film(), Tip.sphere(5e-6), load=1e-3, tolerance=wrong)


def test_what_has_no_reading_is_unknown() -> None:
    bare = nacre.indent.solve(STEEL, Tip.sphere(5e-6), load=1e-3, tolerance=0.1)
    assert bare.verdict().level == "unknown"
    assert str(bare).startswith("load")  # nobody asks for a film
    # As a bare film, the soft one would touch this short tip beyond its end.
    radii = [0.0, 2e-7, 4e-7]
    tip = Tip.profile(radii, [r**2 / 1e-5 for r in radii])
    stiff = nacre.HalfSpace(nacre.Elastic(1e9, 0.3), [nacre.Layer(STEEL, 1e-8)])
    deep = nacre.indent.solve(stiff, tip, radius=3.9e-7, tolerance=0.1)
    assert deep.verdict().level == "unknown"
    assert str(deep).startswith("Cannot tell: ")


# Words are the same everywhere.


def test_a_print_a_report_and_files_of_a_fit_begin_with_the_same_sentence(tmp_path: Path) -> None:
    found = fitted(FORCES * np.exp(0.01 * NOISE))
    words = found.verdict().words
    assert str(found).splitlines()[0] == words
    assert f"<p>{html.escape(words)}" in found._repr_html_()
    assert html.escape(words) in found.save(tmp_path / "a.html").read_text("utf-8")
    assert f"# verdict: {words}" in found.save(tmp_path / "a.csv").read_text("utf-8")
    assert found.verdict().to_dict()["words"] == words


@pytest.mark.parametrize("line", ["", "tolerance = 0.1\n", "tolerance = 3.0\n"])
def test_a_case_prints_writes_and_judges_the_same(
    line: str, tmp_path: Path, capsys: Capture
) -> None:
    text = (ROOT / "examples" / "indent.toml").read_text("utf-8")
    path = written(tmp_path, text.replace("[indent]\n", f"[indent]\n{line}"))
    report = tmp_path / "a.html"
    assert command("solve", path, "--save", report) == 0
    first = capsys.readouterr().out.splitlines()[0]
    assert command("solve", path, "--json") == 0
    numbers = json.loads(capsys.readouterr().out)
    verdict = numbers["verdict"]["indent"]
    assert verdict["words"] == first
    assert html.escape(first) in report.read_text("utf-8")
    asked = numbers["tolerance"]
    assert verdict["level"] == {None: "unknown", 0.1: "bad", 3.0: "good"}[asked]
    assert (asked is None) == ("Give a tolerance to judge it." in verdict["lines"])


# Every warning has its row.

PASSED_ON = {"text", "message", "sentence", "note"}
"""Variables in which warnings stand that were made elsewhere: by these functions."""
MAKERS = {"_sentence", "_notes", "suspicious_units"}


def warnings_in_source() -> Iterator[str]:
    """Yield the literal text of every warning of the package's indentations."""
    for path in sorted(Path(nacre.indent.__file__).parent.glob("*.py")):
        tree = ast.parse(path.read_text("utf-8"))
        for node in ast.walk(tree):
            if isinstance(node, ast.Call) and ast.unparse(node.func) in ("warn", "_warn"):
                text = node.args[0]
                if isinstance(text, ast.Name):
                    assert text.id in PASSED_ON, (path, text.id)
                elif "{sentence}" not in ast.unparse(text):
                    yield literal(text)
            if isinstance(node, ast.FunctionDef) and node.name in MAKERS:
                # The verdict's sentences have the same name, and are no warnings.
                if path.name != "_verdict.py":
                    yield from made_by(node)
    source = (ROOT / "src/indent/point.rs").read_text("utf-8")
    display = source[source.index("impl fmt::Display for IndentWarning") :].split("\n}\n")[0]
    assert display.count("Self::") == display.count("write!(") == source.count('=> "steep"')
    yield display


def made_by(function: ast.FunctionDef) -> Iterator[str]:
    """Yield texts that a function returns or adds to a list."""
    for node in ast.walk(function):
        if isinstance(node, ast.Return) and isinstance(node.value, ast.JoinedStr):
            yield literal(node.value)
        elif isinstance(node, ast.Call) and ast.unparse(node.func) == "notes.append":
            yield literal(node.args[0])


def literal(node: ast.expr) -> str:
    """Return a text without what is put into it."""
    parts = node.values if isinstance(node, ast.JoinedStr) else [node]
    return "".join(str(part.value) for part in parts if isinstance(part, ast.Constant))


def test_every_warning_has_its_row() -> None:
    texts = [*warnings_in_source(), nacre.indent.unloading.ON_FILMS]
    assert len(texts) == 10
    for text in texts:
        rows = [words for words in TEXTS if words in " ".join(text.split())]
        assert len(rows) == 1, text
