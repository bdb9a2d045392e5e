"""What README and the page on accuracy claim is what tests assert: docs/claims.json."""

from __future__ import annotations

import csv
import json
import re
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).parents[3]
CLAIMS: list[dict[str, Any]] = json.loads((ROOT / "docs/claims.json").read_text(encoding="utf-8"))


@pytest.mark.parametrize("row", CLAIMS, ids=lambda row: row["name"])
def test_its_test_asserts_a_bar_within_twice_the_figure(row: dict[str, Any]) -> None:
    assert row["figure"] <= row["bar"] <= 2 * row["figure"]
    assert row["reference"]
    text = (ROOT / row["test"]).read_text(encoding="utf-8")
    assert f'"{row["name"]}"' in text
    assert "claim(" in text


def test_readme_shows_the_figures() -> None:
    """The table was written by docs/extensions/claims.py."""
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    table = readme.split("| problem | error | reference |\n|---|---|---|\n")[1].split("\n\n")[0]
    lines = table.splitlines()
    shown = [row for row in CLAIMS if row.get("readme")]
    assert len(lines) == len(shown) >= 5
    for line, row in zip(lines, shown, strict=True):
        problem, error, reference = (cell.strip() for cell in line.strip("|").split("|"))
        assert (problem, reference) == (row["problem"], row["reference"])
        assert float(error.split()[0]) == pytest.approx(row["figure"], rel=0.01)


def test_the_page_shows_every_section_and_states_no_other_error() -> None:
    page = (ROOT / "docs/accuracy.md").read_text(encoding="utf-8")
    assert re.findall(r"\{claims\} (\w+)", page) == list(
        dict.fromkeys(row["section"] for row in CLAIMS)
    )
    # Tables are made from the claims; the prose states the tolerance of solves alone.
    assert set(re.findall(r"\d(?:\.\d+)?e-\d+", page)) <= {"1e-8"}


def test_sliding_against_a_rigid_counterbody_takes_several_times_as_many_convolutions() -> None:
    """As the pages on speed and friction say of the table of counted work."""
    with (ROOT / "benches/counts.csv").open(encoding="utf-8") as file:
        rows = [row for row in csv.DictReader(file) if row["convolutions"]]
    newest = {row["case"]: float(row["convolutions"]) for row in rows}
    assert 2 < newest["slide/rigid"] / newest["slide/equal"] < 10
    for page in ("speed", "theory/friction"):
        text = (ROOT / f"docs/{page}.md").read_text(encoding="utf-8")
        assert "several times as many" in " ".join(text.split())
