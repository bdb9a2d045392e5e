"""Summaries of fatigue and maps of shakedown: printed, saved, drawn, in cases and in studies."""

from __future__ import annotations

import functools
import json
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import pytest

import nacre
from bodies import BALL, DLC, ROD, STEEL, quiet
from nacre import fatigue, plot
from nacre.case import Case, CaseError
from nacre.fatigue.history import Rolling
from nacre.fatigue.summary import ROUNDS
from support import Capture, assert_close, command, written

GRID = nacre.Grid.line(64, 1.5e-4)
COAT = nacre.HalfSpace(STEEL, [nacre.Layer(DLC, 15e-6, name="DLC")])
LIMITS = fatigue.DangVan(bending=520e6, torsion=330e6)
SOLUTION = nacre.solve(ROD, COAT, load=1e5, grid=GRID)
DEPTHS = [0.0, 1e-5, COAT.interfaces[0], 3e-5]


def assessed(**given: Any) -> fatigue.FatigueSummary:
    asked: dict[str, Any] = {
        "criteria": [LIMITS],
        "shear_yield": {"substrate": 600e6},
        "depths": DEPTHS,
    }
    found: fatigue.FatigueSummary = quiet(fatigue.assess, SOLUTION, **asked | given)
    return found


def test_what_a_summary_holds() -> None:
    summary = assessed()
    coat, substrate = summary.layers
    np.testing.assert_array_equal(summary.depths, [0, 1e-5, 15e-6, 15e-6, 3e-5])
    assert (coat.name, coat.depths) == ("DLC", (0.0, COAT.interfaces[0]))
    assert substrate.depths[1] == np.inf
    assert coat.safety_factors == {}
    factors = substrate.safety_factors
    assert factors["shakedown"] == 600e6 / substrate.shakedown[0]
    assert factors["first_yield"] == 600e6 / substrate.first_yield[0]
    assert factors["DangVan"] == LIMITS.limit / substrate.criteria["DangVan"][0]
    assert summary.shear_yield is summary.profiles["shakedown"]
    assert substrate.shakedown[0] == summary.shear_yield[3:].max()
    (face,) = summary.interfaces
    ys = SOLUTION.stress(COAT.interfaces[0]).yz
    assert face.shear_range == pytest.approx(np.ptp(ys), rel=1e-12)


def test_shear_yield_may_be_a_number_a_sequence_or_a_dict() -> None:
    one = assessed(shear_yield=500e6)
    assert all("shakedown" in layer.safety_factors for layer in one.layers)
    assert assessed(shear_yield=[500e6, 500e6]) == one
    assert assessed(shear_yield={"DLC": 500e6, "substrate": 500e6}) == one
    assert "shakedown" not in assessed(shear_yield=[500e6]).layers[1].safety_factors
    assert assessed(shear_yield=None).layers[1].safety_factors.keys() == {"DangVan"}


def test_doubled_stresses_halve_the_factors() -> None:
    """In a half-space under uniform pressures twice as high: moduli and load twice as large."""
    double = nacre.HalfSpace(
        nacre.Elastic(2 * STEEL.young, 0.3), [nacre.Layer(nacre.Elastic(840e9, 0.3), 15e-6)]
    )
    twice = quiet(
        fatigue.assess,
        nacre.solve(ROD, double, load=2e5, grid=GRID),
        shear_yield={"substrate": 600e6},
        depths=DEPTHS,
    )
    for name, values in assessed(criteria=()).profiles.items():
        assert_close(twice.profiles[name], 2 * values, rtol=1e-9)


def test_tables(tmp_path: Path) -> None:
    summary = assessed()
    text = str(summary)
    for said in (
        "layers[0] DLC",
        "the substrate",
        "Dang Van",
        "interfaces[0]",
        "without hardening",
    ):
        assert said in text
        assert said in summary._repr_html_()
    assert "estimate" not in text
    with nacre.display_units("N-mm-MPa"):
        assert "MPa" in str(summary)
    rows = summary._file_rows()
    path = summary.save(tmp_path / "summary.csv")
    assert len(path.read_text(encoding="utf-8").splitlines()) == len(rows) + 4  # comments
    frame = summary.to_xarray()[["quantity", "value", "safety_factor"]].to_dataframe()
    assert len(frame) == len(rows) - 1 == 10
    assert "FatigueSummary of 2 layers" in repr(summary)
    assert "DLC" in repr(summary.layers[0])
    assert "shear range" in repr(summary.interfaces[0])


def test_maps(tmp_path: Path) -> None:
    found = quiet(fatigue.shakedown_map, SOLUTION, friction=[0.0, 0.2], depths=DEPTHS)
    assert found.names == ("layers[0] DLC", "the substrate")
    assert "coefficient" in found.plot().get_xlabel()
    assert "friction" in str(found)
    assert "friction" in found._repr_html_()
    text = found.save(tmp_path / "map.csv").read_text(encoding="utf-8").splitlines()
    assert len([line for line in text if not line.startswith("#")]) == 1 + 4
    assert found.to_xarray().limits.sel(layer="the substrate").dims == ("friction",)
    plt.close("all")


@pytest.mark.parametrize("kind", ["summary", "map", "layer", "interface"])
def test_states_come_back(kind: str, tmp_path: Path) -> None:
    summary = assessed()
    made: Any = {
        "summary": summary,
        "map": quiet(fatigue.shakedown_map, SOLUTION, friction=[0.0, 0.2], depths=DEPTHS),
        "layer": summary.layers[-1],
        "interface": summary.interfaces[0],
    }[kind]
    state = json.loads(json.dumps(made.to_dict()))
    assert type(made).from_dict(state) == made
    if kind in ("summary", "map"):
        back = nacre.load(made.save(tmp_path / "it.nc"))
        assert back == made
        assert str(back) == str(made)
        with pytest.raises(ValueError, match=r"must end in \.nc, \.csv, .*, \.html"):
            made.save(tmp_path / "it.vtr")
    key = next(name for name in state if name not in ("format", "nacre", "kind"))
    with pytest.raises(ValueError, match=f'the key "{key}" is missing'):
        type(made).from_dict({name: value for name, value in state.items() if name != key})


def test_pictures_show_the_numbers() -> None:
    summary = assessed(depths=None)
    axes = plot.fatigue_depth(summary)
    x, y = np.asarray(axes.lines[0].get_xydata()).T
    assert_close(x, summary.depths * 1e6)
    assert_close(y, summary.shear_yield / 1e6)
    found = quiet(fatigue.shakedown_map, SOLUTION, friction=[0.2, 0.0], depths=DEPTHS)
    drawn = plot.shakedown_map(found, label="coated")
    curves = [part for pair in zip(found.limits, found.first_yield, strict=True) for part in pair]
    for line, numbers in zip(drawn.lines, curves, strict=True):  # of the coat, of the substrate
        x, y = np.asarray(line.get_xydata()).T
        np.testing.assert_array_equal(x, [0.0, 0.2])
        np.testing.assert_array_equal(y, numbers[::-1])
    assert drawn.lines[0].get_label() == "coated, layers[0] DLC"
    plot.shakedown_map(found, label="again", axes=drawn)
    assert len({line.get_color() for line in drawn.lines}) == 4
    plt.close("all")


TEXT = """
units = "N-mm-MPa"
[materials]
steel = { young = 210e3, poisson = 0.3, shear_yield = 600 }
dlc = { young = 420e3, poisson = 0.3 }
[shape]
kind = "cylinder"
radius = 5
[body]
substrate = "steel"
layers = [{ material = "dlc", thickness = 15e-3, name = "DLC" }]
[grid]
cells = 64
width = 0.15
[solve]
load = 100
[fatigue]
friction = 0.05
criteria = [{ kind = "dang_van", bending = 520, torsion = 330 }]
[sweep]
outputs = ["shakedown_safety_factor", "fatigue_safety_factor", "shakedown"]
parameters."solve.load" = [100]
"""


@functools.cache
def expected() -> fatigue.FatigueSummary:
    steel, dlc = nacre.Elastic(210e3, 0.3), nacre.Elastic(420e3, 0.3)
    body = nacre.HalfSpace(steel, [nacre.Layer(dlc, 15e-3, name="DLC")])
    solution = nacre.solve(nacre.Cylinder(5.0), body, load=100.0, grid=nacre.Grid.line(64, 0.15))
    found: fatigue.FatigueSummary = quiet(
        fatigue.assess,
        solution,
        friction=0.05,
        criteria=[fatigue.DangVan(520.0, 330.0)],
        shear_yield=[None, 600.0],
    )
    return found


def test_cases_ask_for_fatigue(tmp_path: Path, capsys: Capture) -> None:
    path, summary = written(tmp_path, TEXT), expected()
    assert command("solve", path) == 0
    with nacre.display_units("N-mm-MPa"):
        assert capsys.readouterr().out.startswith(f"{summary}\n\n")
    assert command("solve", path, "--json") == 0
    found = json.loads(capsys.readouterr().out)["fatigue"]
    assert found["layers"][1]["depths"] == [15e-3, None]
    assert found["layers"][1]["safety_factors"] == summary.layers[1].safety_factors
    assert fatigue.FatigueSummary.from_dict(found) == summary


def test_studies_keep_factors(tmp_path: Path) -> None:
    summary = expected()
    case = Case.read(written(tmp_path, TEXT))
    study = quiet(nacre.sweep, case, **case.study())
    factors = summary.layers[1].safety_factors
    assert study.shakedown_safety_factor.item() == factors["shakedown"]
    assert study.fatigue_safety_factor.item() == factors["DangVan"]
    assert study.shakedown.item() == max(layer.shakedown[0] for layer in summary.layers)


def test_studies_without_limits_have_no_factors() -> None:
    arguments = {"shape": ROD, "body": STEEL, "load": 1e5, "grid": GRID}
    study = quiet(
        nacre.sweep,
        arguments,
        {"load": [1e5]},
        outputs=["fatigue_safety_factor", "substrate_shakedown", "interface_shear_range"],
    )
    assert np.isnan(study.fatigue_safety_factor.item())
    assert np.isnan(study.interface_shear_range.item())
    assert study.substrate_shakedown.item() > 0
    assert study.substrate_shakedown.attrs["units"] == "Pa"
    with pytest.raises(TypeError, match="fatigue must hold arguments of assess"):
        nacre.sweep(arguments, {"load": [1e5]}, outputs=["shakedown"], fatigue={"nonsense": 1})


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('"dang_van"', '"dang"', "fatigue.criteria"),
        ("torsion = 330", "torsion = 100", "torsion must be at least half of bending"),
        (", torsion = 330", "", "torsion"),
        ("friction = 0.05", 'rule = "tresca"', "fatigue.rule"),
        ("friction = 0.05", "nonsense = 1", "fatigue.nonsense"),
    ],
)
def test_wrong_tables_are_named(old: str, new: str, message: str, tmp_path: Path) -> None:
    with pytest.raises(CaseError, match=message):
        Case.read(written(tmp_path, TEXT.replace(old, new))).fatigue()


PERIODIC = nacre.Grid((16, 16), (1e-4, 1e-4), periodic=(True, True))
DENT = nacre.Grid((20, 20), (2e-4, 2e-4))


def dented() -> nacre.Solution:
    return quiet(nacre.solve, BALL, STEEL, grid=DENT, load=10.0, hardness=1e9)  # type: ignore[no-any-return]


WRONG: dict[str, tuple[Any, type[Exception], str]] = {
    "criterion": (lambda: assessed(criteria=["DangVan"]), TypeError, "criteria must hold DangVan"),
    "criteria": (lambda: assessed(criteria=LIMITS), TypeError, "criteria must be a sequence"),
    "twice": (lambda: assessed(criteria=[LIMITS] * 2), ValueError, "of different kinds"),
    "shear yield": (
        lambda: assessed(shear_yield=-1.0),
        ValueError,
        "shear_yield must be .*above 0",
    ),
    "layer": (lambda: assessed(shear_yield={"TiN": 1.0}), ValueError, "keys of shear_yield"),
    "friction": (lambda: assessed(friction=-0.1), ValueError, "friction must be .*at least 0"),
    "NaN": (lambda: assessed(friction=np.nan), ValueError, "friction must be a number, finite"),
    "depth": (lambda: assessed(depths=[-1.0]), ValueError, "depths must be finite and at least 0"),
    "no depth": (lambda: assessed(depths=[]), ValueError, "depths must be .*one or more"),
    "rule": (lambda: assessed(rule="tresca"), ValueError, "rule must be 'von_mises'"),
    "body": (lambda: assessed(body="counterbody"), ValueError, "rigid"),
    "residual": (lambda: assessed(residual=[np.inf]), ValueError, "residual must be finite"),
    "solution": (lambda: fatigue.assess(STEEL), TypeError, "solution must be a Solution"),  # type: ignore[arg-type]
    "nothing": (
        lambda: fatigue.assess(nacre.solve(ROD, STEEL, grid=GRID, approach=-1e-6)),
        ValueError,
        "solution must be in contact",
    ),
    "periodic": (
        lambda: fatigue.assess(nacre.solve(BALL, STEEL, grid=PERIODIC, load=1.0)),
        ValueError,
        "solution must not be periodic",
    ),
    "yielded": (
        lambda: fatigue.assess(dented()),
        ValueError,
        "solution must be one whose surfaces have not yielded",
    ),
    "yielded before": (
        lambda: fatigue.assess(nacre.solve(BALL, STEEL, load=1.0, initial=dented())),
        ValueError,
        "solution must be one whose surfaces have not yielded",
    ),
    "yielded map": (
        lambda: fatigue.shakedown_map(dented(), friction=[0.1]),
        ValueError,
        "solution must be one whose surfaces have not yielded",
    ),
    "map": (
        lambda: fatigue.shakedown_map(SOLUTION, friction=[]),
        ValueError,
        "friction must be a sequence",
    ),
    "map friction": (
        lambda: fatigue.shakedown_map(SOLUTION, friction=[-0.1]),
        ValueError,
        "friction must be finite and at least 0",
    ),
}


@pytest.mark.parametrize("name", WRONG)
def test_wrong_input_is_named(name: str) -> None:
    call, kind, message = WRONG[name]
    with pytest.raises(kind, match=message):
        quiet(call)


def test_a_hardness_that_is_not_reached_is_none() -> None:
    hard = nacre.solve(ROD, COAT, load=1e5, grid=GRID, hardness=1e12)
    assert quiet(fatigue.assess, hard, depths=DEPTHS) == assessed(criteria=[], shear_yield=None)


@pytest.mark.slow
def test_a_map_has_the_bits_of_single_frictions_and_shares_their_stresses(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    frictions = [0.0, 0.15, 0.5]
    calls: list[int] = []
    evaluate = Rolling.stress

    def counted(self: Rolling, depths: Any, *rest: Any) -> Any:
        calls.append(len(depths))
        return evaluate(self, depths, *rest)

    monkeypatch.setattr(Rolling, "stress", counted)
    whole = quiet(fatigue.shakedown_map, SOLUTION, friction=frictions)
    # The depths of a layer, and its refinements, in one go each: surface, inside, lower face.
    assert len(calls) <= len(whole.names) * (3 + ROUNDS)
    for k, friction in enumerate(frictions):
        one = quiet(fatigue.shakedown_map, SOLUTION, friction=[friction])
        for name in ("limits", "first_yield", "depths"):
            np.testing.assert_array_equal(getattr(whole, name)[:, k], getattr(one, name)[:, 0])
        summary = quiet(fatigue.assess, SOLUTION, friction=friction)
        needs = [layer.shakedown[0] for layer in summary.layers]
        np.testing.assert_array_equal(whole.limits[:, k], whole.peak_pressure / np.array(needs))


def test_a_map_keeps_what_the_cells_do_not_resolve() -> None:
    coarse = quiet(nacre.solve, ROD, COAT, load=2e4, grid=nacre.Grid.line(24, 3e-4))
    shallow = [1e-7, 1e-6]
    with pytest.warns(nacre.NacreWarning, match="uncertain due to the size of the cells") as caught:
        found = fatigue.shakedown_map(coarse, friction=[0.1, 0.3], depths=shallow)
    assert {*found.report.warnings} == {str(one.message) for one in caught}
    assert fatigue.ShakedownMap.from_dict(found.to_dict()) == found
    assert "warning: in layers[0] DLC" in str(found)


def test_a_rigid_base_has_layers_alone() -> None:
    rubber = nacre.HalfSpace(nacre.RIGID, [nacre.Layer(nacre.Elastic(5e6, 0.45), 1e-3)])
    solution = quiet(
        nacre.solve, nacre.Cylinder(0.1), rubber, load=100.0, grid=nacre.Grid.line(64, 4e-3)
    )
    summary = quiet(fatigue.assess, solution, criteria=[LIMITS])
    (layer,) = summary.layers
    assert layer.safety_factors == {}
    assert summary.depths[-1] == 1e-3
    with pytest.raises(ValueError, match="below the rigid base"):
        fatigue.assess(solution, depths=[2e-3])


def test_limits_of_criteria_are_those_of_the_substrate() -> None:
    """520 MPa is above the modulus of a soft coat, and belongs to the steel below."""
    soft = nacre.HalfSpace(STEEL, [nacre.Layer(nacre.Elastic(100e6, 0.4), 15e-6)])
    solution = quiet(nacre.solve, ROD, soft, load=1e4, grid=GRID)
    coat, substrate = quiet(fatigue.assess, solution, criteria=[LIMITS], depths=[0.0, 3e-5]).layers
    assert coat.safety_factors == {}
    assert [*substrate.safety_factors] == ["DangVan"]
    with pytest.raises(ValueError, match=r"bending must be in the units .*2\.1e\+11; got 520"):
        fatigue.assess(solution, criteria=[fatigue.DangVan(520.0, 330.0)])
