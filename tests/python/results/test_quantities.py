"""A quantity is one attribute and one row of the table: everything else follows from it."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import xarray

import nacre.results.quantities
from support import python

TRIED = """
import dataclasses, importlib.util, json, sys

spec = importlib.util.spec_from_file_location("nacre.results.quantities", sys.argv[1])
table = sys.modules[spec.name] = importlib.util.module_from_spec(spec)
spec.loader.exec_module(table)
row = table.Quantity("dummy", "a quantity that is tried", "J", "J/m", label="tried")
field = table.Quantity("dummy_field", "a field that is tried", "Pa", dims=table.CELLS, follows=True)
table.CONTACT = (*table.CONTACT, row, field)

import nacre, nacre.plot
from nacre.cli import main

nacre.Solution.dummy = property(lambda solution: 2e-3)
nacre.Solution.dummy_field = property(lambda solution: 3 * solution.pressure)
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


def test_a_row_of_the_table_is_in_every_place(tmp_path: Path) -> None:
    (tmp_path / "case.toml").write_text(CASE)
    done = python("-c", TRIED, nacre.results.quantities.__file__, folder=tmp_path)
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
