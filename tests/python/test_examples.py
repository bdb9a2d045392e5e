"""Each example answers its question, and README's Python runs."""

import ast
import re
from pathlib import Path

import pytest

import nacre
from bodies import coated
from support import ROOT, python

EXAMPLES = sorted((ROOT / "examples").glob("*.py"))


def run(*arguments: str, folder: Path) -> str:
    """Return what a Python process printed, in a folder of its own and with warnings as errors."""
    done = python("-W", "error", *arguments, folder=folder)
    assert done.returncode == 0, done.stderr
    return str(done.stdout)


def test_there_are_examples() -> None:
    assert len(EXAMPLES) >= 3


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.stem)
def test_an_example_asks_a_question_and_answers_it_with_numbers(
    example: Path, tmp_path: Path
) -> None:
    docstring = ast.get_docstring(ast.parse(example.read_text(encoding="utf-8")))
    assert docstring
    assert docstring.splitlines()[0].endswith("?")
    printed = run(str(example), folder=tmp_path)
    assert len(re.findall(r"\d+\.\d+", printed)) >= 3
    assert "nan" not in printed.lower()


def test_the_python_of_the_readme_runs(tmp_path: Path) -> None:
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    blocks = re.findall(r"^```python\n(.*?)^```", readme, flags=re.MULTILINE | re.DOTALL)
    assert len(blocks) == 1
    assert run("-c", blocks[0], folder=tmp_path).strip()


def test_the_case_file_is_solved_and_studied(tmp_path: Path) -> None:
    case = str(ROOT / "examples" / "roller.toml")
    roller = nacre.Roller(5e-3, 19.13e-3, 7.5)
    solution = nacre.solve(roller, coated(420e9, 40e-6), load=1e3, eccentricity=(2.87e-3, None))
    assert run("-m", "nacre.cli", "solve", case, folder=tmp_path) == f"{solution}\n"
    assert "4 cases, 0 failed" in run("-m", "nacre.cli", "sweep", case, folder=tmp_path)
