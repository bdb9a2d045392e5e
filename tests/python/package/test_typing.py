"""A user's program, typed strictly, passes; a wrong one is found."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest
from mypy import api

PROGRAM = """
import numpy as np
import numpy.typing as npt
import xarray
from matplotlib.axes import Axes

import nacre
from nacre import design, plot

def case(thickness: float, young: float) -> dict[str, object]:
    coating = nacre.Layer(nacre.Elastic(young, 0.3), thickness)
    body = nacre.HalfSpace(nacre.Elastic(210e9, 0.3), layers=[coating])
    return {"shape": nacre.Sphere(5e-3), "body": body, "load": 10.0}

def mean_pressure(solution: nacre.Solution) -> float:
    return solution.load / solution.contact_area

steel = nacre.Elastic(young=210e9, poisson=0.3)
roller = nacre.Roller(radius=5e-3, flat_length=19.13e-3, crown_radius=7.5)
solution = nacre.solve(roller, steel, load=1e3, eccentricity=(2.87e-3, None))
pressure: npt.NDArray[np.float64] = solution.pressure
axes: dict[str, Axes] = solution.plot()
section: Axes = solution.plot_section("y", at=1e-3, axes=axes["y"])
dataset: xarray.Dataset = solution.to_xarray()
again: nacre.Solution = nacre.load(solution.save("roller.nc"))
rough = nacre.Sphere(5e-3) + nacre.HeightMap.read("surface.xyz", unit="nm", detrend="plane")
study: xarray.Dataset = nacre.sweep(
    case, {"thickness": [1e-6, 2e-6], "young": [1e11]}, outputs=["tilt", mean_pressure]
)
curve = plot.curve(design.load_curve(rough, steel, [1.0, 2.0]), "stiffness")
nacre.plot.compare({"a": solution, "b": again})
steps = [{"shift": (shift, None)} for shift in (1e-6, -1e-6)]
loop: nacre.types.History = nacre.slide(roller, steel, load=10.0, friction=0.3, steps=steps)
contact = nacre.Contact(steel, solution.grid)
rolling: nacre.types.FrictionSolution = contact.roll(roller, load=10.0, friction=0.3, spin=1.0)
"""

WRONG = {
    "solution.plot()": "solution.plot(3)",
    'detrend="plane"': 'detrend="sphere"',
    "solution.save(": "solution.save(1, ",
    "nacre.Solution = nacre.load": "float = nacre.load",
    "nacre.types.History = nacre.slide": "nacre.types.FrictionSolution = nacre.slide",
    "friction=0.3, spin=1.0": "friction=0.3, cells=2",
    "friction=0.3, steps": "frictoin=0.3, steps",
}


def checked(program: str, folder: Path, config: pytest.Config) -> tuple[str, int]:
    path = folder / "program.py"
    path.write_text(program)
    assert config.cache is not None
    cache = config.cache.mkdir("mypy")  # of this and of later runs
    limit = sys.getrecursionlimit()
    out, err, code = api.run(["--strict", "--config-file=", f"--cache-dir={cache}", str(path)])
    sys.setrecursionlimit(limit)  # mypy raises it, and other tests go down to it
    assert err == ""
    return out, code


def test_a_program_that_is_right_passes_mypy_strict(
    tmp_path: Path, pytestconfig: pytest.Config
) -> None:
    assert checked(PROGRAM, tmp_path, pytestconfig) == (
        "Success: no issues found in 1 source file\n",
        0,
    )


@pytest.mark.parametrize("right", WRONG)
def test_a_program_that_is_wrong_does_not(
    right: str, tmp_path: Path, pytestconfig: pytest.Config
) -> None:
    assert right in PROGRAM
    out, code = checked(PROGRAM.replace(right, WRONG[right]), tmp_path, pytestconfig)
    assert code == 1
    assert "program.py:" in out
    assert ": error: " in out
