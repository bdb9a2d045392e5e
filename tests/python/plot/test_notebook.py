"""Pictures in a notebook, run by a kernel of its own as Jupyter runs it."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import nbformat
from nbclient import NotebookClient

from support import HANG, Patch

CELLS = (
    """\
import nacre
steel = nacre.Elastic(young=210e9, poisson=0.3)
solution = nacre.solve(nacre.Sphere(5e-3), steel, load=10.0)
axes = solution.plot()
""",
    "axes = solution.plot_section('x')",
    "axes = solution.plot_3d()",
    "from nacre import plot; axes = plot.stress_section(solution, rows=8)",
)


STUDY = """\
import sys; sys.modules["ipywidgets"] = None  # as if it were not installed
loads = lambda load: {"shape": nacre.Sphere(5e-3), "body": steel, "load": load}
study = nacre.sweep(loads, {"load": [10.0, 20.0]})
nacre.display_units("N-m-Pa")
"""


def images(outputs: list[dict[str, Any]]) -> int:
    return sum("image/png" in output.get("data", {}) for output in outputs)


def executed(folder: Path, *sources: str) -> Any:
    v4 = nbformat.v4
    notebook = v4.new_notebook(cells=[v4.new_code_cell(source) for source in sources])  # type: ignore[no-untyped-call]
    resources = {"metadata": {"path": str(folder)}}
    return NotebookClient(notebook, timeout=HANG, resources=resources).execute().cells


def test_each_cell_shows_its_picture_and_a_study_nothing_without_widgets(
    tmp_path: Path, monkeypatch: Patch
) -> None:
    monkeypatch.delenv("MPLBACKEND", raising=False)
    *pictures, study = executed(tmp_path, *CELLS, STUDY)
    shown = [images(cell["outputs"]) for cell in pictures]
    assert shown == [1] * len(CELLS), json.dumps(pictures[-1]["outputs"])[:500]
    assert [output["output_type"] for output in study["outputs"]] == ["execute_result"], study
    assert study["outputs"][0]["data"] == {"text/plain": "numbers are in N, m, Pa"}
