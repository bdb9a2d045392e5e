"""Each example answers its question, and README's Python runs."""

import ast
import re
from pathlib import Path

import pytest

import nacre
from bodies import coated
from support import ROOT, Capture, command, printed

EXAMPLES = sorted((ROOT / "examples").glob("*.py"))

RECIPES = sorted((ROOT / "examples" / "recipes").glob("*.py"))


def test_there_are_examples() -> None:
    assert len(EXAMPLES) >= 3


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.stem)
def test_an_example_asks_a_question_and_answers_it_with_numbers(
    example: Path, tmp_path: Path
) -> None:
    docstring = ast.get_docstring(ast.parse(example.read_text(encoding="utf-8")))
    assert docstring
    assert docstring.splitlines()[0].endswith("?")
    output = printed(example, tmp_path)
    assert len(re.findall(r"\d+\.\d+", output)) >= 3
    assert "nan" not in output.lower()


@pytest.mark.parametrize("recipe", RECIPES, ids=lambda path: path.stem)
def test_a_recipe_says_its_task_and_checks_its_digits(recipe: Path, tmp_path: Path) -> None:
    tree = ast.parse(recipe.read_text(encoding="utf-8"))
    task = (ast.get_docstring(tree) or "").splitlines()
    assert len(task) == 1
    assert any(isinstance(node, ast.Assert) for node in tree.body)
    imported = {
        (node.module or "" if isinstance(node, ast.ImportFrom) else node.names[0].name)
        for node in tree.body
        if isinstance(node, ast.Import | ast.ImportFrom)
    }
    assert {name.partition(".")[0] for name in imported} <= {"math", "nacre", "numpy"}
    assert re.search(r"\d+\.?\d*", printed(recipe, tmp_path))


def test_the_page_shows_all_recipes() -> None:
    page = (ROOT / "docs" / "howto" / "recipes.md").read_text(encoding="utf-8")
    shown = re.findall(r"literalinclude\} \.\./\.\./examples/recipes/(\w+)\.py", page)
    assert sorted(shown) == [path.stem for path in RECIPES]
    assert len(shown) == 10


def test_the_python_of_the_readme_runs(tmp_path: Path) -> None:
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    blocks = re.findall(r"^```python\n(.*?)^```", readme, flags=re.MULTILINE | re.DOTALL)
    assert len(blocks) == 1
    (tmp_path / "readme.py").write_text(blocks[0], encoding="utf-8")
    assert printed(tmp_path / "readme.py", tmp_path).strip()


def test_the_case_file_is_solved_and_studied(capsys: Capture) -> None:
    case = ROOT / "examples" / "roller.toml"
    roller = nacre.Roller(5e-3, 19.13e-3, 7.5, length=30e-3)
    solution = nacre.solve(roller, coated(420e9, 40e-6), load=1e3, eccentricity=(2.87e-3, None))
    assert command("solve", case) == 0
    assert capsys.readouterr().out == f"{solution}\n"
    assert command("sweep", case) == 0
    assert "4 cases, 0 failed" in capsys.readouterr().out
