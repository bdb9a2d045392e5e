"""A quantity is one attribute: everything else follows from what is declared there."""

from __future__ import annotations

import csv
import importlib
import json
import re
from collections.abc import Iterator
from pathlib import Path

import xarray

from nacre.results import quantities
from nacre.results.quantities import Quantity
from nacre.results.values import LATE, RESULTS
from support import python

TRIED = """
import json

import nacre, nacre.plot
from nacre.cli import main
from nacre.results.quantities import CELLS, derived

@property
@derived("J", "J/m", label="tried")
def dummy(solution):
    "A quantity that is tried [J]; [J/m] in line contact."
    return 2e-3

@property
@derived("Pa", dims=CELLS, follows=True)
def dummy_field(solution):
    "A field that is tried, ``(nx, ny)`` [Pa]."
    return 3 * solution.pressure

nacre.Solution.dummy, nacre.Solution.dummy_field = dummy, dummy_field
ball, steel = nacre.Sphere(5e-3), nacre.Elastic(210e9, 0.3)
solution = nacre.solve(ball, steel, load=5.0)
solution.save("a.nc")
solution.save("a.csv", whole=True)
solution.save("a.vtr")
assert nacre.load("a.nc") == solution
study = nacre.sweep({"shape": ball, "body": steel}, {"load": [4.0, 5.0]}, outputs=["dummy"])
axes = nacre.plot.curve(study, "dummy")
print(json.dumps({"text": str(solution), "html": solution._repr_html_(), "unit": study.dummy.units,
                  "values": study.dummy.values.tolist(), "label": axes.get_ylabel()}))
main(["solve", "case.toml", "--json"])
"""

CASE = """
[solve]
load = 5.0
[shape]
kind = "sphere"
radius = 5e-3
[body.substrate]
young = 210e9
poisson = 0.3
"""


def test_an_attribute_is_in_every_place(tmp_path: Path) -> None:
    (tmp_path / "case.toml").write_text(CASE)
    done = python("-c", TRIED, folder=tmp_path)
    assert done.stderr == ""
    told, _, as_json = done.stdout.partition("\n")
    found = json.loads(told)
    assert "tried          2 mJ" in found["text"]
    assert ">tried</td>" in found["html"]
    assert (found["unit"], found["values"]) == ("J", [2e-3, 2e-3])
    assert found["label"] == "dummy [mJ]"
    assert json.loads(as_json)["dummy"] == 2e-3
    with xarray.open_dataset(tmp_path / "a.nc") as dataset:
        assert dataset.attrs["dummy"] == 2e-3
        assert dataset.dummy_field.attrs == {"units": "Pa", "long_name": "a field that is tried"}
        assert (dataset.dummy_field == 3 * dataset.pressure).all()
    lines = (tmp_path / "a.csv").read_text().splitlines()
    assert "# dummy [J]: 0.002" in lines
    rows = list(csv.DictReader(line for line in lines if line[0] != "#"))
    assert float(rows[-1]["dummy field [Pa]"]) == 3 * float(rows[-1]["pressure [Pa]"])
    assert b"dummy_field" in (tmp_path / "a.vtr").read_bytes()


def declarations() -> Iterator[tuple[type, Quantity]]:
    for module in LATE:
        importlib.import_module(module)
    for kind in RESULTS.values():
        for row in kind._QUANTITIES:
            yield kind, row


def test_the_docstring_of_a_quantity_has_its_words_and_its_unit() -> None:
    seen = set()
    for kind, row in declarations():
        assert row.owner is not None
        name = (row.path or row.name).rpartition(".")[2]
        docstring = quantities._docstrings(row.owner)[name]
        units = [unit.replace("^2", "²") for unit in re.findall(r"\[([^]]+)\]", docstring)]
        if row.name != "residual":  # it is a force for absolute noise alone
            assert not units or {row.unit, row.line} & {*units[0].split(", ")}, (kind, row)
        assert units or not row.unit, (kind, row)
        assert not re.search(r"[\[`]|\.$", row.words), row.words
        seen.add(row.words)
    assert {"slopes of the inner ring", "E/(1 − ν²) of the sample", "x of the cell centre"} <= seen
