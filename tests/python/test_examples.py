"""Each example answers its question, and README's Python runs."""

import ast
import re
import subprocess
import sys
from pathlib import Path

import pytest

import nacre

ROOT = Path(__file__).parents[2]
EXAMPLES = sorted((ROOT / "examples").glob("*.py"))


def run(*arguments: str, folder: Path) -> str:
    """Return what a Python process printed, in a folder of its own and with warnings as errors."""
    command = [sys.executable, "-W", "error", *arguments]
    done = subprocess.run(command, capture_output=True, text=True, cwd=folder, timeout=60)
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_there_are_examples() -> None:
    assert len(EXAMPLES) >= 3


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.stem)
def test_an_example_runs_and_prints_numbers(example: Path, tmp_path: Path) -> None:
    printed = run(str(example), folder=tmp_path)
    assert len(re.findall(r"\d+\.\d+", printed)) >= 3
    assert "nan" not in printed.lower()


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.stem)
def test_an_example_begins_with_its_question(example: Path) -> None:
    docstring = ast.get_docstring(ast.parse(example.read_text(encoding="utf-8")))
    assert docstring
    assert docstring.splitlines()[0].endswith("?")


def test_the_python_of_the_readme_runs(tmp_path: Path) -> None:
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    blocks = re.findall(r"^```python\n(.*?)^```", readme, flags=re.MULTILINE | re.DOTALL)
    assert len(blocks) == 1
    assert run("-c", blocks[0], folder=tmp_path).strip()


def test_the_case_file_is_solved_and_studied(tmp_path: Path) -> None:
    case = str(ROOT / "examples" / "roller.toml")
    steel, dlc = nacre.Elastic(210e9, 0.3), nacre.Elastic(420e9, 0.3)
    body = nacre.HalfSpace(steel, layers=[nacre.Layer(dlc, 40e-6)])
    roller = nacre.Roller(5e-3, 19.13e-3, 7.5)
    solution = nacre.solve(roller, body, load=1e3, eccentricity=(2.87e-3, None))
    assert run("-m", "nacre.cli", "solve", case, folder=tmp_path) == f"{solution}\n"
    assert "4 cases, 0 failed" in run("-m", "nacre.cli", "sweep", case, folder=tmp_path)
