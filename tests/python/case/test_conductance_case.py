"""The table `[conductance]` of case files: units, layers, verdict, files, studies and the page."""

from __future__ import annotations

import copy
import json
import math
import tomllib
from pathlib import Path
from typing import Any

import pytest
import xarray

import nacre
from nacre._tools.units import number_in
from nacre.app.answer import answer
from nacre.app.cards import cards
from nacre.case import Case, CaseError, templates, toml
from nacre.case.results import results_of
from support import Capture, command

RELAY: dict[str, Any] = tomllib.loads(templates.texts()["relay"])
RELAY["grid"] = {"shape": [64, 64], "size": ["0.06 mm", "0.06 mm"]}
HEAT = {"conductivity": "46 W/(m K)", "counter_conductivity": 20.0}


def relay(**conductance: Any) -> dict[str, Any]:
    """Return the data of the relay on a grid of its own, with other keys of the table."""
    data = copy.deepcopy(RELAY)
    data["conductance"] |= conductance
    return data


def heated(**keys: Any) -> dict[str, Any]:
    """Return the data of the relay that conducts heat."""
    return copy.deepcopy(RELAY) | {"conductance": HEAT | keys}


def through(data: dict[str, Any]) -> nacre.types.Conductance:
    """Return the conductance of a case."""
    case = Case(data)
    conductance: nacre.types.Conductance = results_of(case, case.arguments())["conductance"]
    return conductance


def solved(data: dict[str, Any], folder: Path, capsys: Capture, *options: object) -> Any:
    """Return what the command prints of a case, as JSON."""
    path = folder / "case.toml"
    path.write_text(toml.text(data), encoding="utf-8")
    assert command("solve", path, "--json", *options) == 0
    return json.loads(capsys.readouterr().out)


IN_SI = {
    "units": "SI",
    "materials": {
        name: {"young": entry["young"] * 1e6, "poisson": entry["poisson"]}
        for name, entry in RELAY["materials"].items()
    },
    "shape": {"kind": "sphere", "radius": 1e-3},
}


def in_metres(data: dict[str, Any]) -> dict[str, Any]:
    """Return the relay with its numbers in SI; texts with units stay."""
    data = copy.deepcopy(data) | IN_SI
    for body in ("body", "counterbody"):
        for layer in data[body]["layers"]:
            layer["thickness"] = layer["thickness"] * 1e-3
    return data


@pytest.mark.parametrize(
    ("data", "size"),
    [
        (relay(film="2e-6 Ω mm²"), 1.0),
        (heated(film="2e-7 m² K/W"), 1e-3),  # K/mW
    ],
)
def test_units_of_the_file_change_no_resistance(data: dict[str, Any], size: float) -> None:
    # Scaled by powers of ten, numbers differ by rounding in the solve, whose tolerance is 1e-8.
    in_mm, in_si = through(data), through(in_metres(data))
    assert in_mm.resistance == pytest.approx(in_si.resistance * size, rel=1e-6)
    assert in_mm.uncertainty == pytest.approx(in_si.uncertainty * size, rel=1e-6)


@pytest.mark.parametrize(
    ("unit", "text", "number"),
    [
        ("W/m/K", "46 W/(m K)", 46.0),
        ("mW/mm/K", "46 W/(m K)", 46.0),
        ("W/m/K", "0.5 kW/m/K", 500.0),
        ("S/mm", "14 MS/m", 14e3),
        ("S/m", "14 MS/m", 14e6),
        ("S/m", "14 m/(Ω mm²)", 14e6),
        ("Ω", "2 mΩ", 2e-3),
        ("Ω", "2 m\N{OHM SIGN}", 2e-3),
        ("Ω", "2 kohm", 2e3),
        ("Ω", "3 V/A", 3.0),
        ("K/mW", "2 K/W", 2e-3),
        ("Ω m²", "3 Ω mm²", 3e-6),
        ("mm² K/mW", "1e-6 m² K/W", 1e-3),
    ],
)
def test_units_of_heat_and_current_are_read(unit: str, text: str, number: float) -> None:
    assert number_in(unit, text) == pytest.approx(number, rel=1e-15)


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (relay(conductivity="46 W/(m K)"), r"conductance\.conductivity: .* in S/mm .*'46 W/"),
        (heated(conductivity="14 MS/m"), r"conductance\.conductivity: .* in mW/mm/K .*'14 MS/m'"),
        (relay(required_resistance="5 K/W"), r"required_resistance: .* in Ω "),
        (heated(required_resistance="5 mΩ"), r"required_resistance: .* in K/mW "),
        (heated(film="1 K/W"), r"conductance\.film: .* in mm² K/mW "),
        (relay(conductivity={"gold": 1e4, "silver": 1.0}), r"conductivity: .* got 'silver'"),
        (relay(conductivity={"gold": 1e4}), r"must hold a conductivity for .*substrate"),
        (relay(conductivity="22 nΩ m"), r"conductance\.conductivity: .* in S/mm "),
        (relay(conductivity=2.2e-5), r"conductivity must be a conductivity in S/m, .*resistivity"),
        (relay(film=-1.0), r"conductance: film must be finite and at least 0, got -1"),
        (heated(kind="optical"), r'kind: must be "thermal" or "electrical", got'),
        (relay(required_resistance=0.0), r"required_resistance must be above 0 and finite, got 0"),
        (relay(counter_film=1.0), r"counter_film: there is no such key; the keys here are"),
        (
            copy.deepcopy(RELAY) | {"conductance": {"conductivity": 46.0}},
            r"conductance\.counter_conductivity: this key is missing",
        ),
    ],
)
def test_mistakes_are_refused_with_their_key(data: dict[str, Any], message: str) -> None:
    with pytest.raises(CaseError, match=message):
        through(data)


@pytest.mark.parametrize("gold", ["gold", "0", "layers[0]", "plating"])
def test_layers_have_their_number_name_or_material(gold: str) -> None:
    data, usual = relay(), through(relay())
    data["body"]["layers"][0]["name"] = "plating"
    data["conductance"]["conductivity"] = {gold: 45.5e3, "1": 14.3e3, "substrate": "11.1 MS/m"}
    assert through(data).resistance == pytest.approx(usual.resistance, rel=1e-12)


def test_a_case_is_the_call(tmp_path: Path, capsys: Capture) -> None:
    case = Case(relay())
    plating = [45.5e3, 14.3e3, 11.1e3]
    expected = nacre.solve(**case.arguments()).conductance(
        conductivity=plating, counter_conductivity=plating, kind="electrical"
    )
    numbers = solved(relay(), tmp_path, capsys)
    assert numbers["conductance"]["resistance"] == expected.resistance
    assert numbers["conductance"]["uncertainty"] == expected.uncertainty
    assert numbers["conductance"]["conductance"] == 1 / expected.resistance
    assert "flux" not in numbers["conductance"]


@pytest.mark.parametrize(("required", "level"), [(5e-3, "good"), (1e-3, "bad"), (None, "unknown")])
def test_the_verdict_compares_with_the_required_resistance(
    required: float | None, level: str, tmp_path: Path, capsys: Capture
) -> None:
    data = relay(required_resistance=required)
    if required is None:
        del data["conductance"]["required_resistance"]
    verdict = solved(data, tmp_path, capsys)["verdict"]["conductance"]
    assert verdict["level"] == level


def test_the_report_has_the_resistance_and_its_inputs(tmp_path: Path, capsys: Capture) -> None:
    solved(relay(film=0.0), tmp_path, capsys, "--save", tmp_path / "a.html")
    report = (tmp_path / "a.html").read_text(encoding="utf-8")
    for text in ("conductance of a contact", "mΩ", "14300 S/mm", "Flux density along x"):
        assert text in report


def test_plating_lowers_the_resistance_of_the_template(tmp_path: Path, capsys: Capture) -> None:
    """The gold-plated contact is below Holm's constriction of bronze, and above that of gold."""
    case = Case(tomllib.loads(templates.texts()["relay"]))
    results = results_of(case, case.arguments())
    conductance, contact = results["conductance"], results["solution"]
    radius = math.sqrt(contact.contact_area / math.pi)
    assert 1 / (2 * 45.5e3 * radius) < conductance.resistance < 1 / (2 * 11.1e3 * radius)
    # By 23 to 16 % between 0.2 and 1 N, of cells of a fifth of this size: 2.05 mΩ.
    assert conductance.resistance == pytest.approx(2.05e-3, abs=conductance.uncertainty * 2)


def test_wear_and_friction_have_the_conductance_of_their_contact(
    tmp_path: Path, capsys: Capture
) -> None:
    data = relay()
    usual = through(data).resistance
    slid = data | {"slide": {"friction": 0.3, "force": {"x": 0.1, "y": 0.0}}}
    assert solved(slid, tmp_path, capsys)["conductance"]["resistance"] == pytest.approx(usual)
    # The ball wears to a wider spot, which conducts better.
    rate = {"wear": {"rate": 1e-8, "counter_rate": 0.0, "sliding": 20.0}}
    worn = solved(data | rate, tmp_path, capsys)
    assert worn["conductance"]["resistance"] < 0.95 * usual
    assert worn["verdict"]["conductance"]["level"] == "good"


def test_a_study_has_the_resistance_with_its_error_and_unit(
    tmp_path: Path, capsys: Capture
) -> None:
    data = relay()
    data["sweep"] = {
        "parameters": {"solve.load": [0.2, 0.5]},
        "outputs": ["resistance", "conductance"],
        "store": "study.nc",
    }
    path = tmp_path / "case.toml"
    path.write_text(toml.text(data), encoding="utf-8")
    assert command("sweep", path) == 0
    capsys.readouterr()
    study = xarray.load_dataset(tmp_path / "study.nc", engine="h5netcdf")
    alone = through(relay())
    assert study.resistance.values[1] == alone.resistance
    assert study.resistance_discretisation.values[1] == pytest.approx(alone.uncertainty)
    assert study.conductance.values[1] == alone.conductance
    share = study.resistance_discretisation / study.resistance
    assert (study.conductance_discretisation / study.conductance).values == pytest.approx(share)
    units = [study[name].attrs["units"] for name in ("resistance", "conductance")]
    assert units == ["Ω", "S"]


STEEL = nacre.Elastic(young=210e9, poisson=0.3)
BALL: dict[str, Any] = {
    "shape": nacre.Sphere(5e-3),
    "body": STEEL,
    "counterbody": STEEL,
    "max_cells": 4096,
}
EQUAL: dict[str, Any] = {"conductivity": 46.0, "counter_conductivity": 46.0}


@pytest.mark.filterwarnings("ignore::nacre.NacreWarning")  # of few cells
def test_studies_of_wear_have_the_resistance_at_the_end() -> None:
    case = BALL | {"load": 10.0, "rate": 1e-14, "steps": 2}
    study = nacre.sweep(
        case, {"sliding": [1.0, 20.0]}, outputs=["resistance", "life"], conductance=EQUAL
    )
    for sliding, resistance in zip([1.0, 20.0], study.resistance.values, strict=True):
        history = nacre.wear(**case, sliding=sliding)
        last = history.states[-1].solution.conductance(**EQUAL)
        assert resistance == pytest.approx(last.resistance, rel=1e-12)
    assert study.resistance.attrs["units"] == "K/W"
    assert study.resistance.values[1] < study.resistance.values[0]


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({}, "conductance must be given for the outputs resistance, conductance"),
        ({"conductance": EQUAL | {"layer": 1}}, r"arguments of Solution.conductance, got \['layer"),
    ],
)
def test_a_study_of_resistances_needs_conductivities(options: dict[str, Any], message: str) -> None:
    with pytest.raises(TypeError, match=message):
        nacre.sweep(BALL, {"load": [1.0]}, outputs=["resistance"], **options)


def test_other_outputs_solve_no_conductance() -> None:
    wrong = {"conductivity": -1.0, "counter_conductivity": 1.0}
    study = nacre.sweep(BALL, {"load": [1.0]}, outputs=["approach"], conductance=wrong)
    assert (study.error == "").all()


@pytest.mark.parametrize("grid", [None, nacre.Grid.line(65, 2e-4), "periodic"])
def test_a_study_has_the_unit_of_its_grid(grid: Any) -> None:
    shape: nacre.types.Shape = nacre.Sphere(5e-3)
    load, unit = 1.0, "K/W"
    if grid == "periodic":
        grid, unit = nacre.Grid((64, 64), (3e-4, 3e-4), periodic=(True, True)), "m² K/W"
    elif grid is not None:
        shape, load, unit = nacre.Cylinder(5e-3), 1e4, "m K/W"
    case = {"shape": shape, "body": STEEL, "counterbody": STEEL, "grid": grid}
    case = {name: value for name, value in case.items() if value is not None}
    study = nacre.sweep(case, {"load": [load]}, outputs=["resistance"], conductance=EQUAL)
    assert study.resistance.attrs["units"] == unit
    assert study.resistance.values > 0


@pytest.mark.parametrize("threads", [2, 3])
def test_threads_change_no_bit_of_a_resistance(threads: int) -> None:
    data, more = relay(), relay()
    data["solve"]["threads"], more["solve"]["threads"] = 1, threads
    assert through(more) == through(data)


def test_the_page_has_the_resistance_of_the_command_line(tmp_path: Path, capsys: Capture) -> None:
    card = cards()["relay"]
    case = card.case({"solve.load": "0.7", "conductance.film": "1e-7"})
    parts = answer(case, "stress")["parts"]
    numbers = solved(case.data, tmp_path, capsys)
    assert parts["verdict"] == numbers["verdict"]["conductance"]
    shown = f"{numbers['conductance']['resistance'] * 1e3:.4g} mΩ ± "
    assert shown in parts["rows"]


def test_a_finer_page_judges_the_resistance_alone() -> None:
    case = cards()["relay"].case({"solve.load": "50"})
    verdict = answer(case, "finer")["parts"]["verdict"]
    assert verdict["level"] == "good"
    assert verdict["decided_by"] == "resistance"
