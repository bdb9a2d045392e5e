"""The script that counts work, and what it calls a rise: benches/counts.py."""

from __future__ import annotations

import csv
import importlib
from pathlib import Path
from typing import Any

import pytest

import counts
from counts import Work
from support import ROOT

BEFORE = {"solve/line": Work(10_000_000, 12.0), "plan/line": Work(5_000_000, None)}


def with_rise(part: float, name: str) -> dict[str, Work]:
    changed = {
        "instructions": Work(round((1 + part) * 10_000_000), 12.0),
        "convolutions": Work(10_000_000, (1 + part) * 12.0),
    }
    return BEFORE | {"solve/line": changed[name]}


@pytest.mark.parametrize("name", ["instructions", "convolutions"])
def test_a_rise_of_three_percent_fails_and_of_one_passes(name: str) -> None:
    for part in (-0.03, 0.0, 0.01):
        assert counts.compared(BEFORE, with_rise(part, name))[1] == []
    lines, wrong = counts.compared(BEFORE, with_rise(0.03, name))
    assert len(lines) == 2
    assert len(wrong) == 1
    assert wrong[0].startswith(f"solve/line: {name} ")
    assert "+3.00 %" in wrong[0]


def test_cases_of_the_table_and_of_the_program_are_the_same() -> None:
    fewer = {"solve/line": BEFORE["solve/line"]}
    assert counts.compared(fewer, BEFORE)[1] == ["plan/line: not in both"]
    assert counts.compared(BEFORE, fewer)[1] == ["plan/line: not in both"]


def test_instructions_that_are_not_known_are_not_compared() -> None:
    more = {case: Work(None, work.convolutions) for case, work in BEFORE.items()}
    assert counts.compared(BEFORE, more)[1] == []
    assert counts.compared(more, BEFORE)[1] == []


def test_a_run_replaces_the_version_that_is_not_released(tmp_path: Path) -> None:
    rows = counts.replaced([], "0.1.0", "2026-11-25", "rustc 1", BEFORE)
    rows = counts.replaced(
        rows, counts.NEXT, "2026-11-28", "rustc 1", with_rise(0.01, "instructions")
    )
    rows = counts.replaced(
        rows, counts.NEXT, "2026-11-29", "rustc 1", with_rise(0.1, "instructions")
    )
    assert [row["release"] for row in rows] == ["0.1.0"] * 2 + [counts.NEXT] * 2
    with (tmp_path / "counts.csv").open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, counts.COLUMNS)
        writer.writeheader()
        writer.writerows(rows)
    read = counts.read(tmp_path / "counts.csv")
    assert read == rows
    assert counts.recorded(read) == ("rustc 1", with_rise(0.1, "instructions"))
    rows = counts.replaced(rows, "0.2.0", "2026-11-30", "rustc 1", BEFORE)
    assert [row["release"] for row in rows] == ["0.1.0"] * 2 + ["0.2.0"] * 2


def test_the_release_is_that_on_top_of_the_changelog() -> None:
    assert counts.release("# Changelog\n\n## [0.2.0]\n\n## [0.1.0]\n") == "0.2.0"
    assert counts.release("# Changelog\n\n## [Unreleased]\n\n## [0.1.0]\n") == counts.NEXT


@pytest.fixture
def machine(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> dict[str, Any]:
    """Stand in for a machine whose compiler, Valgrind and counts can be changed."""
    state: dict[str, Any] = {
        "compiler": "1.95.0",
        "valgrind": True,
        "rise": 1.0,
        "convolutions": 12,
    }

    def run(*command: str | Path) -> tuple[str, str]:
        words = [str(word) for word in command]
        if words[-1] == "--version":
            return f"{words[0]} {state['compiler']}\n", ""
        if words[-1] == "processor":
            return "x86_64 avx\n", ""
        if len(words) == 1:
            return "solve/line\n", ""
        if words[0] == "valgrind":
            total = 1_000_000 + (words[-1] != "prepare") * round(1e7 * state["rise"])
            return "", f"==7== I   refs:      {total:,}\n"
        return f"{state['convolutions']}\n", ""

    monkeypatch.setattr(counts, "run", run)
    monkeypatch.setattr(counts, "build", lambda: tmp_path / "program")
    monkeypatch.setattr(counts, "TABLE", tmp_path / "counts.csv")
    monkeypatch.setattr("shutil.which", lambda _: state["valgrind"] or None)
    return state


def test_what_was_counted_passes_until_it_rises(machine: dict[str, Any]) -> None:
    counts.main([])
    assert counts.recorded(counts.read(counts.TABLE))[1] == {"solve/line": Work(10_000_000, 12.0)}
    counts.main(["--compare"])
    machine["rise"] = 1.01
    counts.main(["--compare"])
    machine["rise"] = 1.03
    with pytest.raises(SystemExit, match=r"solve/line: instructions 1.03e\+07 \(\+3.00 %\)"):
        counts.main(["--compare"])
    counts.main([])
    counts.main(["--compare"])


@pytest.mark.parametrize("other", [{"valgrind": False}, {"compiler": "1.96.0"}])
def test_other_tools_compare_convolutions_alone(
    machine: dict[str, Any], other: dict[str, Any], capsys: pytest.CaptureFixture[str]
) -> None:
    counts.main([])
    capsys.readouterr()
    machine |= other | {"rise": 1.5}
    counts.main(["--compare"])
    assert capsys.readouterr().out.startswith("instructions are not compared: the table is of ")
    machine["convolutions"] = 13
    with pytest.raises(SystemExit, match="convolutions 13"):
        counts.main(["--compare"])


def test_the_table_needs_valgrind(machine: dict[str, Any]) -> None:
    machine["valgrind"] = False
    with pytest.raises(SystemExit, match="needs Valgrind"):
        counts.main([])
    assert not counts.TABLE.exists()


def test_the_page_shows_changes_between_releases(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(ROOT / "docs" / "extensions"))
    table = importlib.import_module("work_counts").table
    rows = counts.replaced([], "0.1.0", "2026-11-25", "rustc 1", BEFORE)
    more = with_rise(0.05, "instructions")
    assert table(counts.replaced(rows, "0.2.0", "2026-11-28", "rustc 1", more)).splitlines()[
        2:
    ] == [
        "| `solve/line` | 10 | 10.5, +5.0 % | 12 |",
        "| `plan/line` | 5 | 5, +0.0 % |  |",
    ]
    other_tools = table(counts.replaced(rows, "0.2.0", "2026-11-28", "rustc 2", more))
    assert "| `solve/line` | 10 | 10.5 | 12 |" in other_tools
