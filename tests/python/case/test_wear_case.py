"""Case files of wear give the bits of the call, go on from files, and name wrong keys."""

from __future__ import annotations

import inspect
import json
import re
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import nacre
from nacre.app.answer import answer
from nacre.app.cards import own_card
from nacre.case import Case, CaseError, templates
from nacre.case.reference import schema
from support import Capture, assert_close, command, written

STEEL, DLC = nacre.Elastic(210e9, 0.3), nacre.Elastic(300e9, 0.2)
BODY = nacre.HalfSpace(STEEL, [nacre.Layer(DLC, 2e-6)])
GRID = nacre.Grid.line(64, 8e-4)
DATA: dict[str, Any] = {
    "materials": {
        "steel": {"young": 210e9, "poisson": 0.3},
        "dlc": {"young": 300e9, "poisson": 0.2},
    },
    "shape": {"kind": "cylinder", "radius": 10e-3},
    "body": {"substrate": "steel", "layers": [{"material": "dlc", "thickness": 2e-6}]},
    "grid": {"cells": 64, "width": 8e-4},
    "solve": {"load": 1e5},
    "wear": {"rate": {"dlc": 1e-17, "substrate": 1e-15}, "sliding": 100.0, "steps": 2},
}
RATES: dict[str | int, float] = {0: 1e-17, "substrate": 1e-15}
BALL: dict[str, Any] = {
    "shape": {"kind": "sphere", "radius": 5e-3},
    "body": {"substrate": {"young": 210e9, "poisson": 0.3}},
    "counterbody": {"substrate": {"young": 210e9, "poisson": 0.3}},
    "grid": {"shape": [24, 24], "size": [3e-4, 3e-4]},
    "solve": {"load": 10},
}
CYCLE = {"friction": 0.6, "steps": [{"force": {"x": 3}}, {"force": {"x": -3}}]}
ROLL = {"friction": 0.3, "creepage": {"along": 1e-3}, "direction": "+x"}


def case(**tables: Any) -> Case:
    """Return the case with other keys in some of its tables."""
    return Case({**DATA, **{name: {**DATA.get(name, {}), **keys} for name, keys in tables.items()}})


def toml(**keys: Any) -> str:
    """Return the template with other keys of wear."""
    lines = "\n".join(f"{name} = {json.dumps(value)}" for name, value in keys.items())
    text = templates.texts()["wear"].replace("cells = 129", "cells = 65")
    text = re.sub(r"\nrequired_distance.*", "", text)
    return re.sub(r"sliding.*\n.*", lines, text) if keys else text


def worn(solved: Case) -> nacre.types.WearHistory:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", nacre.NacreWarning)
        return nacre.wear(**solved.arguments())


def same(one: nacre.types.WearHistory, other: nacre.types.WearHistory) -> bool:
    """Return whether all is the same to the bit, but for the time that it took."""
    fields = (
        ((a.solution.pressure, b.solution.pressure), (a.depth, b.depth))
        for a, b in zip(one, other, strict=True)
    )
    return one.events == other.events and all(
        a.tobytes() == b.tobytes() for pairs in fields for a, b in pairs
    )


def test_a_case_and_the_call_give_the_same_bits() -> None:
    due = nacre.wear(
        nacre.Cylinder(10e-3), BODY, load=1e5, grid=GRID, rate=RATES, sliding=100.0, steps=2
    )
    assert same(worn(case()), due)
    assert case().kind == "wear"


@pytest.mark.parametrize("key", ["0", "top", "dlc"])
def test_rates_go_by_number_name_or_material(key: str) -> None:
    body = {"layers": [{"material": "dlc", "thickness": 2e-6, "name": "top"}]}
    rate = {key: 1e-17, "steel": 1e-15}
    assert case(body=body, wear={"rate": rate}).arguments()["rate"] == RATES
    sides = {"body": body, "counterbody": DATA["body"] | body, "wear": {"counter_rate": rate}}
    assert case(**sides).arguments()["counter_rate"] == RATES
    assert case(wear={"rate": 1e-17}).arguments()["rate"] == 1e-17


@pytest.mark.parametrize(
    ("own", "keywords"),
    [
        ({"slide": CYCLE, "wear": {"cycles": 10}}, {"cycles": 10}),
        ({"roll": ROLL, "wear": {"passes": 10}}, {"passes": 10}),
    ],
)
def test_cycles_and_passes_are_those_of_slide_and_roll(
    own: dict[str, Any], keywords: dict[str, Any]
) -> None:
    own = {**own, "wear": {**own["wear"], "rate": 1e-15, "steps": 1}}
    steps = [{"force": (one, None)} for one in (3, -3)]
    motion: dict[str, Any] = {"slide": {"friction": 0.6, "steps": steps}}
    if "passes" in keywords:
        motion = {"roll": {"friction": 0.3, "creepage": (1e-3, None), "direction": "+x"}}
    due = nacre.wear(
        *(nacre.Sphere(5e-3), STEEL, STEEL),
        **{**keywords, **motion, "rate": 1e-15, "steps": 1},
        grid=nacre.Grid((24, 24), (3e-4, 3e-4)),
        load=10,
    )
    assert same(worn(Case({**BALL, **own})), due)


def test_every_keyword_of_wear_is_a_key_unless_it_is_an_array_or_stands_elsewhere() -> None:
    tables = schema()["$defs"]
    keys = {*tables["Wear"]["properties"], *tables["Solve"]["properties"]}
    elsewhere = {"shape", "body", "counterbody", "grid", "slide", "roll"}
    known = {*inspect.signature(nacre.wear).parameters} - elsewhere
    assert known - keys == {"slip", "initial", "progress"}


@pytest.mark.parametrize(
    ("tables", "message"),
    [
        ({"wear": {"rate": {"tin": 1e-17}}}, "wear.rate: must have keys among 0, dlc, substrate,"),
        ({"wear": {"rate": {"dlc": "low"}}}, "wear.rate.dlc: must be a finite number, got 'low'"),
        ({"wear": {"rate": "low"}}, "wear.rate: must be a finite number, or a table of them"),
        ({"wear": {"rates": 1.0}}, "wear.rates: there is no such key; the keys here are rate,"),
        ({"wear": {"counter_rate": {"steel": 1e-17}}}, "wear.counter_rate: must be a number, as"),
        ({"wear": {"steps": 0}}, 'wear.steps: must be "auto", an integer above 0, or a list'),
        ({"wear": {"until": "worn"}}, 'wear.until: must be "through", got'),
        ({"wear": {"store": "../worn.nc"}}, "wear.store: must be in the folder of the case"),
        *(
            ({"wear": {"store": name}}, "wear.store: must be a name that Windows allows for a file")
            for name in ("NUL.nc", "below\\con", "com1.a.nc", "a:worn.nc", "worn.nc:stream")
        ),
        ({"solve": {"hardness": 1e9}}, "solve.hardness: must not be given beside the table wear"),
        ({"slide": {"friction": 0.1}, "roll": ROLL}, "roll: must not be given beside the table"),
    ],
)
def test_wrong_keys_are_named_with_their_path(tables: dict[str, Any], message: str) -> None:
    with pytest.raises(CaseError, match=f"^case: {re.escape(message)}"):
        case(**tables).arguments()


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        ({"sliding": -1.0}, "wear: sliding must be finite and at least 0, got -1"),
        ({"cycles": 3}, "wear: slide must be given with cycles, and cycles with slide"),
        ({"scheme": "euler"}, "wear: one of sliding, cycles and passes must be given, got none"),
    ],
)
def test_what_wear_refuses_is_a_line_that_names_its_table(
    keys: dict[str, Any], message: str, tmp_path: Path, capsys: Capture
) -> None:
    path = written(tmp_path, toml(**keys))
    assert command("solve", path) == 2
    assert capsys.readouterr().err == f"nacre: {path}: {message}\n"


def test_the_command_prints_the_history_in_the_units_of_the_case(
    tmp_path: Path, capsys: Capture
) -> None:
    path = written(tmp_path, toml())
    history = worn(Case.read(path))
    with nacre.display_units("N-mm-MPa"):
        due = str(history)
    assert command("solve", path) == 0
    assert capsys.readouterr().out == f"{due}\n"
    life = history.life
    assert life is not None
    assert f"Worn through after {life.distance / 1e3:.4g} m ± " in due
    assert " at y = 0 mm." in due
    assert ", 0 µm² of the counterbody" in due


def test_json_holds_the_numbers_of_all_states_exactly(tmp_path: Path, capsys: Capture) -> None:
    path = written(tmp_path, toml())
    history = worn(Case.read(path))
    assert command("solve", path, "--json") == 0
    found = json.loads(capsys.readouterr().out)
    for name in ("distance", "volume", "deepest", "peak_pressure", "contact_area", "load"):
        assert found[name] == getattr(history, name).tolist()
    assert history.life is not None
    assert found["life"] == history.life.distance
    assert found["events"][0]["layer"] == "layers[0]"
    assert (found["unit"], found["units"]) == ("m", "N-mm-MPa")
    assert found["verdict"]["wear"]["level"] == "unknown"


def test_files_of_all_endings_are_saved(tmp_path: Path, capsys: Capture) -> None:
    path = written(tmp_path, toml(sliding=1e5, steps=2))
    names = ("a.nc", "a.csv", "a.png", "a.html", "a.gif", "a.vtr")
    options = [word for name in names for word in ("--save", tmp_path / name)]
    assert command("solve", path, *options) == 0
    capsys.readouterr()
    due = worn(Case.read(path))
    loaded = nacre.load(tmp_path / "a.nc")
    assert isinstance(loaded, nacre.types.WearHistory)
    assert same(loaded, due)
    heads, *rows = (tmp_path / "a.csv").read_text(encoding="utf-8-sig").splitlines()[-4:]
    assert heads.startswith("step,distance [mm],volume body [mm²]")
    assert [float(row.split(",")[1]) for row in rows] == [0.0, 5e4, 1e5]
    page = (tmp_path / "a.html").read_text(encoding="utf-8")
    assert "<td>sliding</td><td>100 m</td>" in page
    assert "mm²/N</td>" in page
    assert "<td>load</td><td>100 N/mm</td>" in page
    assert all((tmp_path / name).stat().st_size > 100 for name in names)
    assert command("solve", path, "--save", tmp_path / "a.txt") == 2
    assert "must end in .csv, .gif, .html, .mp4, .nc" in " ".join(capsys.readouterr().err.split())


def test_a_store_in_the_folder_of_the_case_is_gone_on_from(tmp_path: Path, capsys: Capture) -> None:
    path = written(tmp_path, toml(sliding=1e5, steps=4, store="worn.nc"))
    stored = Case.read(path)
    stopped = nacre.wear(**stored.arguments(), progress=lambda state: state.distance < 4e4)
    assert len(stopped) == 3
    assert command("solve", path) == 0
    capsys.readouterr()
    whole = nacre.load(tmp_path / "worn.nc")
    assert isinstance(whole, nacre.types.WearHistory)
    assert whole.distance.tolist() == [0.0, 25e3, 50e3, 75e3, 100e3]
    assert whole.states[1] == stopped.states[1]


def test_the_command_goes_on_from_a_saved_history(tmp_path: Path, capsys: Capture) -> None:
    path = written(tmp_path, toml(sliding=5e4, steps=1))
    assert command("solve", path, "--save", tmp_path / "a.nc") == 0
    assert command("solve", path, "--initial", tmp_path / "a.nc", "--json") == 0
    out = capsys.readouterr().out
    found = json.loads(out[out.index("{") :])
    assert found["distance"] == [0.0, 5e4, 1e5]


def test_stresses_and_fatigue_are_those_of_the_last_contact() -> None:
    from nacre.case.results import results_of

    asked = case(stress={"friction": 0.1}, fatigue={})
    results = results_of(asked, asked.arguments())
    last = results["wear"].states[-1].solution
    assert results["stress"] == last.stress_summary(**(asked.stress() or {}))
    assert results["fatigue"] == nacre.fatigue.assess(last, **(asked.fatigue() or {}))


SWEEP = """
[sweep]
store = "study.nc"
parameters."body.layers[0].thickness" = [1e-3, 2e-3]
parameters."solve.load" = [50, 100]
parameters."wear.rate.dlc" = [1e-11, 2e-11]
"""


def test_a_study_has_the_lives_of_its_cases_and_is_resumed(tmp_path: Path, capsys: Capture) -> None:
    path = written(tmp_path, toml() + SWEEP)
    assert command("sweep", path, "--json") == 0
    found = json.loads(capsys.readouterr().out)
    lives = np.array(found["data_vars"]["life"]["data"])
    assert found["data_vars"]["life"]["attrs"]["units"] == "mm"
    assert found["data_vars"]["worn_volume"]["attrs"]["units"] == "mm²"
    assert found["coords"]["wear.rate.dlc"]["attrs"]["units"] == "mm²/N"
    one = case_of(path, {"solve.load": 50, "wear.rate.dlc": 2e-11})
    assert one.life is not None
    assert lives[1, 0, 1] == one.life.distance
    # A contact sees the product of rate and distance alone. Coats are through to 1e-6 of their
    # thickness, twice, to whose power of 3/2 the distance grows.
    # A layer is through to 1e-5 of its thickness.
    assert_close(lives[..., 0], 2 * lives[..., 1], rtol=2e-5, each=True)
    assert (np.diff(lives, axis=0) > 0).all()
    assert (np.diff(lives, axis=1) < 0).all()
    journal = (tmp_path / "study.journal").read_bytes()
    assert command("sweep", path) == 0
    assert "8 cases, 0 failed" in capsys.readouterr().out
    assert (tmp_path / "study.journal").read_bytes() == journal


def case_of(path: Path, values: dict[str, float]) -> nacre.types.WearHistory:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", nacre.NacreWarning)
        return nacre.wear(**Case.read(path)(**values))


def test_a_study_has_a_store_of_its_own() -> None:
    sweep = {"parameters": {"solve.load": [1e5]}}
    with pytest.raises(CaseError, match=r"wear.store: must not be given beside a study"):
        case(wear={"store": "worn.nc"}, sweep=sweep).study()
    with pytest.raises(CaseError, match="sweep: outputs must be numbers of a history of wear"):
        case(sweep={**sweep, "outputs": ["von_mises"]}).study()


def test_the_page_takes_a_case_of_wear(tmp_path: Path) -> None:
    path = written(tmp_path, toml(sliding=1e5, store="worn.nc"))
    card = own_card(path)
    assert "store" not in card.base["wear"]
    by_path = card.by_path
    assert by_path["wear.rate.dlc"].unit == "mm²/N"
    assert by_path["wear.sliding"].unit == "mm"
    changed = card.case({"wear.rate.dlc": "2e-11", "wear.sliding": "2e5"})
    draft, full = (answer(changed, stage) for stage in ("draft", "full"))
    assert (draft["next"], full["next"]) == ("full", None)
    history = worn(changed)
    parts = full["parts"]
    assert float(parts["peak"][1].split()[0]) == pytest.approx(history.peak_pressure[-1], rel=1e-4)
    assert parts["verdict"]["level"] == "unknown"
    assert "No layer is worn through after 200 m" in parts["verdict"]["words"]
    assert "worn volume" in parts["rows"]
    assert {"picture-1", "picture-2"} <= parts.keys()
    assert not (tmp_path / "worn.nc").exists()
    refused = answer(card.case({"wear.rate.dlc": "-1"}), "full")
    assert "rate must be finite and at least 0" in refused["error"]


def test_the_page_refuses_histories_of_many_steps(tmp_path: Path) -> None:
    with pytest.raises(CaseError, match="steps must be at most 200 on the page, got 500"):
        own_card(written(tmp_path, toml(sliding=1e5, steps=500)))
