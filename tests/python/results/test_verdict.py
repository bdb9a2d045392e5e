"""A verdict says whether a result holds, by which factor, and which limits are missing."""

from __future__ import annotations

import dataclasses
import functools
import json
import math
import pickle
import re
from pathlib import Path
from typing import Any

import pytest

import nacre
from bodies import STEEL, quiet
from nacre import fatigue
from nacre._tools.units import plain
from nacre.bearing import DeepGrooveBall
from nacre.results.verdict import (
    KINDS,
    TEXTS,
    Demand,
    Verdict,
    judged,
    reasons,
    verdict_on,
)
from results import solved
from support import command

DLC = nacre.Layer(nacre.Elastic(300e9, 0.25), 2e-6, name="DLC")
COATED = nacre.HalfSpace(STEEL, [DLC])
SENTENCE = re.compile(
    r"Safety factor (?P<factor>[\d. ]+)( ± (over )?[\d.]+ %)?(, too small|, may be below 1)?: "
    r"(?P<name>[^,]+), (?P<value>[\d.][\d. ]*) (?P<unit>[^ ,]+)( at [^,]+)?"
    r", limit (?P<limit>[\d. ]+) \S+ \(given\)\."
)
"""A sentence on a limit."""
HALF_DIGIT = 0.005
"""Largest rounding of three digits, relative: 1.005 is printed as 1 or 1.01."""


def number(text: str) -> float:
    return float(text.replace(" ", ""))


@functools.cache
def ball(body: Any = COATED, load: float = 5.0) -> nacre.Solution:
    solution: nacre.Solution = quiet(
        nacre.solve, nacre.Sphere(5e-3), body, load=load, max_cells=4096
    )
    return solution


@functools.cache
def summary(friction: float = 0.0) -> nacre.types.StressSummary:
    found: nacre.types.StressSummary = quiet(
        ball().stress_summary, friction=friction, direction=(0.0, 1.0)
    )
    return found


def limited(
    friction: float = 0.0, **factors: tuple[float | None, float | None]
) -> nacre.types.StressSummary:
    """Return a summary in which parts have safety factors of yield and of strength."""
    found = summary(friction)
    layers = [
        dataclasses.replace(layer, yield_safety_factor=pair[0], strength_safety_factor=pair[1])
        for layer, pair in zip(
            found.layers,
            (factors.get(name, (None, None)) for name in ("coat", "substrate")),
            strict=True,
        )
    ]
    return dataclasses.replace(found, layers=layers)


# Contacts.


@pytest.mark.parametrize("friction", [0.0, 0.1, 0.4])
@pytest.mark.parametrize("part", ["coat", "substrate"])
@pytest.mark.parametrize("kind", [0, 1])
@pytest.mark.parametrize("factor", [0.25, 2.0, 40.0])
def test_a_factor_is_the_ratio_of_the_printed_numbers(
    friction: float, part: str, kind: int, factor: float
) -> None:
    pair = (factor, None) if kind == 0 else (None, factor)
    found = limited(friction, **{part: pair})
    layer = found.layers[part == "substrate"]
    value, name = ((layer.von_mises, "von_mises"), (layer.tension, "tension"))[kind]
    verdict = found.verdict()
    (match,) = filter(None, map(SENTENCE.fullmatch, verdict.sentences))
    assert number(match["factor"]) == factor
    assert number(match["limit"]) / number(match["value"]) == pytest.approx(
        factor, rel=2.1 * HALF_DIGIT
    )
    places = ["of the substrate", "of DLC"]
    own, other = reversed(places) if part == "coat" else places
    assert match["name"] == f"{('von Mises stress', 'tension')[kind]} {own}"
    sizes = {"kPa": 1e3, "MPa": 1e6, "GPa": 1e9}
    assert sizes[match["unit"]] * number(match["value"]) == pytest.approx(value[0], rel=HALF_DIGIT)
    assert verdict.factor == pytest.approx(factor, rel=1e-12)
    assert verdict.decided_by == match["name"]
    assert verdict.uncertainty == pytest.approx(layer.uncertainty[name] / abs(value[0]), rel=1e-12)
    assert any(
        f" {other}: " in line and line.endswith("no limit is given.") for line in verdict.lines
    )


@pytest.mark.parametrize("side", [0.98, 1.02])
@pytest.mark.parametrize("bound", [1.0, 1.5])
@pytest.mark.parametrize("part", [0, "substrate"])
def test_limits_on_either_side_of_a_bound(side: float, bound: float, part: Any) -> None:
    # Errors of the von Mises stress are below 1 % here, so that 2 % from a bound is beyond them.
    layer = summary().layers[part == "substrate"]
    value, _ = layer.von_mises
    verdict = quiet(ball().verdict, yield_stress={part: side * bound * value})
    error = layer.uncertainty["von_mises"]
    assert verdict.factor == pytest.approx(side * bound, rel=1e-12)
    if abs(side * bound - 1) * value < error:
        assert (verdict.level, ", may be below 1: " in verdict.words) == ("fair", True)
    elif side * bound < 1:
        assert (verdict.level, ", too small: " in verdict.words) == ("bad", True)
    else:
        assert verdict.level == "fair"  # the other part and the interface have no limit
        assert SENTENCE.fullmatch(verdict.words)


KEEPS, MAY, FAILS, DOUBT = "", ", may be below 1", ", too small", "Cannot tell"


@pytest.mark.parametrize("at_least", [False, True])
@pytest.mark.parametrize(
    ("factor", "error", "level", "outcome"),
    [
        (0.5, None, "unknown", DOUBT),
        (1.0, None, "unknown", DOUBT),
        (1.5, None, "unknown", DOUBT),
        (0.5, 0.0, "bad", FAILS),
        (0.9, 0.0, "bad", FAILS),
        (0.999, 0.0, "bad", FAILS),
        (1.0, 0.0, "fair", KEEPS),
        (1.1, 0.0, "fair", KEEPS),
        (1.49, 0.0, "fair", KEEPS),
        (1.5, 0.0, "good", KEEPS),
        (1.51, 0.0, "good", KEEPS),
        (1.51, 0.001, "good", KEEPS),
        (1.51, 0.01, "fair", KEEPS),  # 1.51/1.01 and 1.51 × 0.99 are below 1.5
        (0.9, 0.05, "bad", FAILS),
        (1.1, 0.05, "fair", KEEPS),
        (2.77, 0.0002, "good", KEEPS),
        (0.98, 0.01, "bad", FAILS),
        (0.98, 0.03, "fair", MAY),
        (1.02, 0.01, "fair", KEEPS),
        (1.02, 0.03, "fair", MAY),
        (1.0, 1e-6, "fair", MAY),
        (1.49, 0.3, "fair", KEEPS),
        (1.6, 0.06, "good", KEEPS),
        (1.6, 0.3, "fair", KEEPS),
        (5.0, 3.9, "fair", KEEPS),
        (5.0, 4.1, "fair", MAY),
        (0.5, 0.49, "bad", FAILS),
        (0.5, 1.2, "fair", MAY),
    ],
)
def test_levels(
    factor: float, error: float | None, level: str, outcome: str, *, at_least: bool
) -> None:
    value = 800e6
    limit = value / factor if at_least else value * factor
    # An error is a share of the value below a limit, and of the limit that must be reached.
    size = value if not at_least else limit if factor < 1 or error in (3.9, 4.1) else value
    demand = Demand(
        "von Mises stress", "of the substrate", value, error and error * size, 41e-6, limit,
        at_least=at_least,
    )  # fmt: skip
    verdict = judged([demand])
    assert verdict.level == level
    assert verdict.factor == pytest.approx(factor)
    assert ("±" in str(verdict)) == bool(error)
    if outcome == DOUBT:
        assert verdict.words == "Cannot tell: the error of the value that decides is not known."
        assert verdict.lines[0].startswith("As it stands, safety factor ")
    else:
        assert verdict.words.partition(":")[0].endswith(outcome or "%" if error else outcome)
        assert (", too small" in verdict.words) == (outcome == FAILS)
        assert (", may be" in verdict.words) == (outcome == MAY)


def test_the_sentence_has_value_error_place_and_limit() -> None:
    demand = Demand("von Mises stress", "of the substrate", 795e6, 0.0002 * 795e6, 41e-6, 2200e6)
    assert judged([demand]).words == (
        "Safety factor 2.77 ± 0.02 %: von Mises stress of the substrate, 795 MPa at 41 µm, limit "
        "2200 MPa (given)."
    )
    shallow = demand._replace(depth=0.0, limit=0.9996 * 795e6, error=0.0, origin="card 440C")
    assert judged([shallow]).words == (
        "Safety factor 0.999, too small: von Mises stress of the substrate, 795 MPa at the "
        "surface, limit 794.7 MPa (card 440C)."
    )


@pytest.mark.parametrize(
    ("rows", "decides"),
    [
        ([(3.0, 0.0), (2.0, 0.0)], 1),
        ([(0.9, 0.0), (0.8, 0.0)], 1),
        # What fails decides before what may fail, and that before what holds.
        ([(0.9, 0.5), (0.95, 0.01)], 1),
        ([(1.6, 0.01), (2.0, 1.1)], 1),
        ([(0.5, 0.0), (1.1, 0.5), (4.0, 0.0)], 0),
    ],
)
def test_the_worst_part_decides(rows: list[tuple[float, float]], decides: int) -> None:
    demands = [
        Demand("tension", f"of layer {k}", 1e8, error * 1e8, 0.0, factor * 1e8)
        for k, (factor, error) in enumerate(rows)
    ]
    verdict = judged(demands)
    assert verdict.decided_by == f"tension of layer {decides}"
    assert (verdict.factor, verdict.uncertainty) == pytest.approx(rows[decides])
    assert len(verdict.sentences) == len(rows)


def test_the_number_asked_for_leads_unless_something_fails() -> None:
    life = Demand(
        "life", "", 2e4, 0.0, None, 1e4, unit="h", at_least=True, sentence="Lives.", leads=True
    )
    stress = Demand("pressure", "", 1e9, 0.0, None, 1.6e9)
    assert judged([stress, life]).words == "Lives."
    assert judged([stress, life]).decided_by == "pressure"
    failing = judged([life, stress._replace(limit=0.9e9)])
    assert failing.words.startswith("Safety factor 0.9, too small: pressure")
    assert failing.lines == ("Lives.",)
    open_life = life._replace(limit=None)
    unasked = judged([stress, open_life], unasked="Give a required life to judge it.")
    assert (unasked.level, unasked.words) == ("unknown", "Lives.")
    assert unasked.lines[-1] == "Give a required life to judge it."


ENOUGH = Demand("stress", "of the coating", 1e8, 1e5, 0.0, 3e8)
"""A demand that is kept with its margin."""


@pytest.mark.parametrize(
    ("demands", "keywords", "level"),
    [
        ([ENOUGH], {}, "good"),
        ([], {}, "unknown"),
        ([ENOUGH._replace(limit=None)], {}, "unknown"),
        ([ENOUGH, ENOUGH._replace(limit=None)], {}, "fair"),
        ([ENOUGH, ENOUGH._replace(error=None, limit=9e8)], {}, "fair"),
        ([ENOUGH._replace(error=None), ENOUGH._replace(limit=9e8)], {}, "unknown"),
        ([ENOUGH], {"doubts": ["of a doubt"]}, "unknown"),
        ([ENOUGH], {"cautions": ["of a caution"]}, "fair"),
        ([ENOUGH], {"unasked": "Give a limit."}, "unknown"),
        ([ENOUGH], {"notes": ["A note."]}, "good"),
        ([ENOUGH], {"doubts": ["of a doubt"], "cautions": ["of a caution"]}, "unknown"),
        *(
            ([ENOUGH._replace(limit=0.5e8)], keywords, "bad")
            for keywords in (
                {},
                {"doubts": ["of a doubt"]},
                {"cautions": ["of a caution"]},
                {"unasked": "Give a limit."},
            )
        ),
        ([ENOUGH._replace(limit=1.2e8)], {"cautions": ["of a caution"]}, "fair"),
        ([ENOUGH._replace(limit=0.5e8), ENOUGH._replace(limit=None)], {}, "bad"),
        ([ENOUGH._replace(limit=0.5e8), ENOUGH._replace(error=None)], {}, "bad"),
    ],
)
def test_limits_errors_doubts_and_cautions(
    demands: list[Demand], keywords: dict[str, Any], level: str
) -> None:
    verdict = judged(demands, **keywords)
    assert verdict.level == level
    for name, start in (("doubts", "Cannot tell: "), ("cautions", "With care: ")):
        for reason in keywords.get(name, ()):
            assert f"{start}{reason}." in verdict.sentences
            assert verdict.doubts is not None
            assert reason in verdict.doubts
    assert Verdict.from_dict(json.loads(json.dumps(verdict.to_dict()))) == verdict


def test_without_a_limit_nothing_is_judged_and_each_part_says_what_it_needs() -> None:
    verdict = summary(0.1).verdict()
    assert (verdict.level, verdict.factor, verdict.decided_by) == ("unknown", None, None)
    coat, substrate = summary(0.1).layers
    tension, mises = (f"{plain(v / 1e6, 3)} MPa" for v in (coat.tension[0], substrate.von_mises[0]))
    share = 100 * coat.uncertainty["tension"] / coat.tension[0]
    assert verdict.words == (
        f"Tension of DLC: {tension} ± {share:.2g} % at the surface; no limit is given."
    )
    assert f"Von Mises stress of the substrate: {mises} ± " in verdict.lines[0]
    assert any(line.startswith("Shear below DLC: ") for line in verdict.lines)
    assert verdict.lines[-1].startswith("Give a yield stress")
    assert verdict.question is None


def test_of_many_parts_without_a_limit_the_largest_are_named() -> None:
    demands = [Demand("tension", f"of layer {k}", k * 1e6, None, 0.0) for k in range(1, 21)]
    (words,) = judged(demands).sentences
    assert words == (
        "Tension of layer 20: 20 MPa at the surface, the largest of 20; no limit is given."
    )


def test_every_kind_of_warning_has_its_level() -> None:
    source = (Path(__file__).parents[3] / "src/contact/solution/warnings.rs").read_text("utf-8")
    source = source[source.index("pub fn kind") : source.index("pub(crate) fn is_singular")]
    kinds = set(re.findall(r'Self::\w+(?: \{ \.\. \})? => "([a-z ]+)"', source))
    kinds |= {"high pressure", "thick layer", "odd modulus"}  # which Python warns of
    assert kinds | {"very large contact"} == set(KINDS)  # large ones by their size


@pytest.mark.parametrize(("load", "level"), [(0.1, "good"), (60.0, "fair"), (600.0, "unknown")])
def test_large_contacts_are_judged_by_their_size(load: float, level: str) -> None:
    solution = quiet(nacre.solve, nacre.Sphere(1e-4), STEEL, load=load, max_cells=4096)
    (low, high), _ = solution.contact_extent
    assert ((high - low) / 2e-4 > 0.5) == (level == "unknown")
    verdict = quiet(solution.verdict, yield_stress={"substrate": 200e9})
    assert (verdict.level, verdict.inside_model) == (level, level == "good")


@pytest.mark.parametrize("warning", [*KINDS, *TEXTS])
def test_a_warning_leaves_its_level_at_most(warning: str) -> None:
    level, reason, leaves_model = KINDS.get(warning) or TEXTS[warning]
    notices = [warning if warning in KINDS else f"something {warning} here"]
    keywords: dict[str, Any] = {
        "doubts": reasons(notices, "unknown"), "cautions": reasons(notices, "fair")
    }  # fmt: skip
    verdict = judged([ENOUGH], **keywords)
    assert verdict.level == ("good" if level == "any" else level)
    assert (reason in str(verdict)) == (level != "any")
    assert verdict.doubts == (None if level == "any" else (reason,))
    assert verdict.inside_model == (level == "any" or not leaves_model)
    assert judged([ENOUGH._replace(limit=0.5e8)], **keywords).level == "bad"


def test_a_yield_stress_of_a_coat_does_not_silence_its_tension() -> None:
    limits = {"DLC": 50e9, "substrate": 6e9}
    verdict = quiet(ball().verdict, yield_stress=limits, residual={"DLC": 5e9})
    assert verdict.level == "fair"
    assert re.search("Tension of DLC: 5.* no limit is given", str(verdict))
    bonded = quiet(
        ball().verdict,
        yield_stress=limits,
        strength={"DLC": 20e9},
        residual={"DLC": 5e9},
        bond_strength=(5e9, 5e9),
    )
    assert bonded.level == "good"
    assert "no limit" not in str(bonded)


@pytest.mark.parametrize("key", [0, "DLC", "interfaces[0]"])
def test_an_interface_has_limits(key: Any) -> None:
    def verdict_of(shear: float) -> Verdict:
        bonds = {key: (shear, 1e12)}
        found = quiet(ball().stress_summary, strength={"DLC": 2e11}, bond_strength=bonds)
        assert nacre.types.StressSummary.from_dict(found.to_dict()) == found
        result: Verdict = found.verdict()
        return result

    shear, _ = summary().interfaces[0].shear
    failing = verdict_of(0.5 * shear)
    assert (failing.level, failing.decided_by) == ("bad", "shear below DLC")
    assert failing.factor == pytest.approx(0.5)
    assert verdict_of(100 * shear).level != "bad"


def test_strengths_of_bonds_are_checked() -> None:
    wrongs: Any = ((1e9, -1e9), (1e9,), {"TiN": (1e9, 1e9)}, 1e9, {1: (1e9, 1e9)})
    for wrong in wrongs:
        with pytest.raises(ValueError, match="bond_strength must be"):
            ball().verdict(bond_strength=wrong)


def test_nothing_is_loaded() -> None:
    grid = nacre.Grid((8, 8), (1e-4, 1e-4))
    apart = nacre.solve(nacre.Sphere(5e-3), STEEL, grid=grid, approach=-1e-6)
    verdict = quiet(apart.verdict, yield_stress={"substrate": 1e9})
    assert (verdict.level, verdict.words) == ("unknown", "Cannot tell: nothing is loaded.")


def singular() -> nacre.Solution:
    grid = nacre.Grid((32, 32), (3e-3, 3e-3))
    solution: nacre.Solution = quiet(nacre.solve, nacre.FlatPunch(1e-3), STEEL, grid=grid, load=1e2)
    return solution


def test_where_the_pressure_has_no_limit_nothing_holds() -> None:
    verdict = quiet(singular().verdict, yield_stress={"substrate": 100e9})
    assert verdict.level == "unknown"
    assert verdict.words.startswith("Cannot tell: the pressure at an edge has no limit")
    assert verdict.lines[0].startswith("As it stands, ")
    assert not verdict.inside_model
    failing = quiet(singular().verdict, yield_stress={"substrate": 1e6})
    assert failing.level == "bad"
    assert "no limit" in failing.lines[0]


def test_what_has_not_converged_or_is_unfinished_holds_nowhere() -> None:
    found = quiet(solved("not converged").stress_summary, yield_stress={"substrate": 100e9})
    assert found.verdict().level == "unknown"
    assert "not converged" in found.verdict().words
    assert nacre.types.StressSummary.from_dict(found.to_dict()) == found
    stopped = dataclasses.replace(limited(substrate=(2.0, None)), finished=False)
    assert stopped.verdict().level == "unknown"
    assert stopped.verdict().words.startswith("Cannot tell: stopped before")


def test_with_friction_a_solution_has_a_verdict_of_its_summary() -> None:
    slid = solved("slid")
    found = quiet(slid.verdict, yield_stress={"substrate": 2e9})
    assert found == quiet(slid.stress_summary, yield_stress={"substrate": 2e9}).verdict()
    assert found.factor is not None


SYSTEMS = {"SI": (1.0, 1.0), "N-mm-MPa": (1e3, 1.0), "mN-µm-GPa": (1e6, 1e3)}
"""Numbers of a metre and of a newton in systems of units."""
SYSTEMS |= {"lbf-in-psi": (1 / 0.0254, 1 / 4.4482216152605)}


@pytest.mark.parametrize("units", SYSTEMS)
def test_numbers_are_in_the_units_that_are_set(units: str) -> None:
    metre, newton = SYSTEMS[units]
    pascal = newton / metre**2
    grid = nacre.Grid((32, 32), (2.4e-4 * metre, 2.4e-4 * metre))
    steel = nacre.Elastic(210e9 * pascal, 0.3)
    body = nacre.HalfSpace(steel, [nacre.Layer(steel, 2e-6 * metre)])
    solution = nacre.solve(nacre.Sphere(5e-3 * metre), body, grid=grid, load=5.0 * newton)
    with nacre.display_units(units):
        verdict = quiet(solution.verdict, yield_stress={"substrate": 2.2e9 * pascal})
    match = SENTENCE.fullmatch(verdict.words)
    assert match
    assert match["unit"] == {"lbf-in-psi": "psi", "mN-µm-GPa": "GPa"}.get(units, "MPa")
    assert number(match["limit"]) / number(match["value"]) == pytest.approx(
        verdict.factor, rel=2.1 * HALF_DIGIT
    )
    assert not re.search(r"\de[+-]?\d", str(verdict))


@pytest.mark.parametrize(
    ("value", "text"),
    [
        *((1.28e9, "1 280 000 000"), (14203, "14 200"), (9996, "10 000"), (9994, "9990")),
        *((1.2345e-7, "0.000000123"), (5.0, "5"), (0.0, "0"), (1739.0, "1740")),
    ],
)
def test_numbers_have_no_exponent(value: float, text: str) -> None:
    assert plain(value, 3) == text


def test_a_verdict_is_plain_data() -> None:
    verdict = limited(coat=(None, 3.0), substrate=(2.0, None)).verdict()
    assert pickle.loads(pickle.dumps(verdict)) == verdict
    assert Verdict.from_dict(json.loads(json.dumps(verdict.to_dict()))) == verdict
    assert repr(verdict) == f"<Verdict: fair. {verdict.words}>"
    with pytest.raises(ValueError, match='"level" does not fit'):
        Verdict.from_dict(verdict.to_dict() | {"level": "great"})


# Shakedown and fatigue.


SMALL = dict.fromkeys(("shakedown", "first_yield", "DangVan"), 1e3)
"""Errors of a kilopascal."""


def assessed(*, bare: bool = True, **factors: float) -> nacre.types.FatigueSummary:
    found = solved("fatigue")
    (coat, substrate) = found.layers
    layers = [dataclasses.replace(coat, safety_factors={})] if bare is False else []
    layers.append(dataclasses.replace(substrate, safety_factors=factors, uncertainty=SMALL))
    interfaces = [] if bare else found.interfaces
    result: nacre.types.FatigueSummary = dataclasses.replace(
        found, layers=layers, interfaces=interfaces, doubt=None, caution=None
    )
    return result


@pytest.mark.parametrize(
    ("shakedown", "first", "criterion", "level", "words", "yields"),
    [
        (4.8, 3.9, None, "good", "shear yield stress for shakedown", "never yields"),
        (1.2, 0.9, None, "fair", "shear yield stress for shakedown", "yields at first"),
        (0.8, 0.6, None, "bad", "shear yield stress for shakedown", None),
        (4.8, 3.9, 1.3, "fair", "equivalent stress of Dang Van", "never yields"),
        (4.8, 3.9, 0.7, "bad", "equivalent stress of Dang Van", "never yields"),
        (1.6, 1.1, 2.0, "good", "shear yield stress for shakedown", "never yields"),
    ],
)
def test_shakedown_and_criteria_decide(
    shakedown: float, first: float, criterion: float | None, level: str, words: str, yields: Any
) -> None:
    factors: dict[str, Any] = {"shakedown": shakedown, "first_yield": first}
    factors |= {} if criterion is None else {"DangVan": criterion}
    verdict = assessed(**factors).verdict()
    least = min(shakedown, criterion or math.inf)
    assert verdict.level == level
    assert verdict.factor == pytest.approx(least)
    assert verdict.words.startswith(f"Safety factor {least:g} ")
    assert f": {words} of the substrate, " in verdict.words
    line = f"The substrate shakes down and {yields} (safety factor {first:g})."
    assert (line in verdict.lines) == (yields is not None)
    coated = assessed(bare=False, **factors).verdict()
    assert any("for shakedown of the coating: " in sentence for sentence in coated.lines)
    assert coated.level == ("bad" if level == "bad" else "fair")
    for match in filter(None, map(SENTENCE.fullmatch, verdict.sentences)):
        assert number(match["limit"]) / number(match["value"]) == pytest.approx(
            number(match["factor"]), rel=3 * HALF_DIGIT
        )


def test_the_factor_of_an_assessment_is_that_of_its_limit() -> None:
    found = solved("fatigue")
    needed = found.layers[-1].shakedown[0]
    shaken = found.layers[-1].safety_factors["shakedown"]
    assert shaken == pytest.approx(6e8 / needed, rel=1e-12)
    assert 0 <= found.layers[-1].uncertainty["shakedown"] < 0.25 * needed
    assert f"limit {plain(6e8 / 1e6, 3)} MPa (given)." in str(found.verdict())
    assert fatigue.FatigueSummary.from_dict(found.to_dict()) == found


def test_a_verdict_that_is_not_called_answers_with_a_warning() -> None:
    found = limited(substrate=(2.0, None))
    with pytest.warns(DeprecationWarning, match=r"write verdict\(\)\.level"):
        level = found.verdict.level  # type: ignore[attr-defined]
    assert level == found.verdict().level
    assert str(found.verdict) == str(found.verdict())
    assert verdict_on(found) == found.verdict()
    assert verdict_on(ball()) is None  # its stresses have to be computed


# Prints and files.


def printed() -> dict[str, Any]:
    bearing = DeepGrooveBall(count=7, diameter=11.5e-3, pitch_diameter=43.5e-3)
    borne = bearing.solve(force=(1000.0, 0.0, None), model="iso16281")
    return {
        "summary": limited(substrate=(2.0, None)),
        "assessment": solved("fatigue"),
        "bearing": borne,
        "life": borne.life(),
        "fit": solved("fit"),
    }


@pytest.mark.parametrize("name", ["summary", "assessment", "bearing", "life", "fit"])
def test_a_print_and_a_file_begin_with_the_verdict(name: str, tmp_path: Path) -> None:
    result = printed()[name]
    sentences = result.verdict().sentences
    assert str(result).startswith("\n".join(sentences) + "\n\n")
    assert result._repr_html_().count("<p>") >= len(sentences)
    assert "verdict" not in result.to_dict()
    file = quiet(result.save, tmp_path / "a.csv")
    assert f"# verdict: {' '.join(sentences)}" in file.read_text(encoding="utf-8")


CASE = """
[solve]
load = 5.0
max_cells = 4096
[body.substrate]
young = 210e9
poisson = 0.3
yield_stress = 2.2e9
[shape]
kind = "sphere"
radius = 5e-3
[stress]
"""


def test_the_command_prints_the_verdict(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "case.toml"
    path.write_text(CASE, encoding="utf-8")
    assert command("solve", path) == 0
    assert capsys.readouterr().out.startswith("Safety factor ")
    assert command("solve", path, "--json") == 0
    verdict = json.loads(capsys.readouterr().out)["verdict"]["stress"]
    assert verdict["level"] == "good"
    assert verdict["words"].startswith("Safety factor ")
    assert set(verdict) >= {"level", "question", "decided_by", "doubts", "inside_model"}
