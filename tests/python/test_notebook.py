"""Pictures in a notebook, run by a kernel of its own as Jupyter runs it."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import nbformat
from nbclient import NotebookClient

from support import Patch

FIRST = """\
import nacre
steel = nacre.Elastic(young=210e9, poisson=0.3)
solution = nacre.solve(nacre.Sphere(5e-3), steel, load=10.0)
axes = solution.plot()
"""
CELLS = (
    FIRST,
    "axes = solution.plot_section('x')",
    "axes = solution.plot_3d()",
    "from nacre import plot; axes = plot.stress_section(solution, rows=8)",
)


def images(outputs: list[dict[str, Any]]) -> int:
    return sum("image/png" in output.get("data", {}) for output in outputs)


def executed(folder: Path, *sources: str) -> Any:
    v4 = nbformat.v4
    notebook = v4.new_notebook(cells=[v4.new_code_cell(source) for source in sources])  # type: ignore[no-untyped-call]
    resources = {"metadata": {"path": str(folder)}}
    return NotebookClient(notebook, timeout=120, resources=resources).execute().cells


def test_every_cell_of_a_notebook_shows_its_picture(tmp_path: Path, monkeypatch: Patch) -> None:
    monkeypatch.delenv("MPLBACKEND", raising=False)
    cells = executed(tmp_path, *CELLS)
    shown = [images(cell["outputs"]) for cell in cells]
    assert shown == [1] * len(CELLS), json.dumps(cells[-1]["outputs"])[:500]


def test_a_study_shows_nothing_in_a_notebook_without_widgets(tmp_path: Path) -> None:
    study = f"""{FIRST}
import matplotlib.pyplot as plt; plt.close()
import sys; sys.modules["ipywidgets"] = None  # as if it were not installed
loads = lambda load: {{"shape": nacre.Sphere(5e-3), "body": steel, "load": load}}
study = nacre.sweep(loads, {{"load": [10.0, 20.0]}})
nacre.display_units("N-m-Pa")
"""
    (cell,) = executed(tmp_path, study)
    assert [output["output_type"] for output in cell["outputs"]] == ["execute_result"], cell
    assert cell["outputs"][0]["data"] == {"text/plain": "numbers are in N, m, Pa"}
