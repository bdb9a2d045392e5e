"""The programs of the documentation run as they stand, and print what it says they print."""

import contextlib
import doctest
import re
import runpy
import shlex
import tomllib
from importlib.util import find_spec
from pathlib import Path
from typing import Any, NamedTuple

import pytest

import nacre
import nacre.bearing
import nacre.design
import nacre.plot
import nacre.rough
from support import ROOT, command, printed, python

DOCS = ROOT / "docs"
NAMES: dict[str, Any] = runpy.run_path(str(DOCS / "extensions" / "names.py"))
MODULES = (
    *(nacre.bearing, nacre.design, nacre.friction, nacre.hertz, nacre.indent, nacre.plot),
    *(nacre.rough, nacre.types, nacre.verify),
)
PAGES = [DOCS / "start.md", *sorted(DOCS.glob("howto/*.md")), *sorted(DOCS.glob("limits/*.md"))]
FENCE = re.compile(
    r"^```(?:\{code-block\} )?(\w+)\n(?::caption: (\S+)\n\n)?(.*?)^```$", re.MULTILINE | re.DOTALL
)
FLAGS = doctest.ELLIPSIS
SEPARATOR = "~~~ next block ~~~"


class Block(NamedTuple):
    """A fenced block of a page: its language, the file that it stands for, and what is in it."""

    language: str
    caption: str | None
    text: str


def blocks(page: Path) -> list[Block]:
    found = FENCE.findall(page.read_text(encoding="utf-8"))
    return [Block(language, caption or None, text) for language, caption, text in found]


def programs() -> list[Path]:
    return [page for page in PAGES if any(block.language == "python" for block in blocks(page))]


def test_the_pages_are_there() -> None:
    expected = {"start", "roller", "raceway", "surface", "coating", "both"}
    assert {page.stem for page in programs()} >= expected


@pytest.mark.parametrize("page", programs(), ids=lambda page: page.stem)
def test_what_a_page_prints_is_what_it_says(page: Path, tmp_path: Path) -> None:
    program, expected = [], []
    for block in blocks(page):
        if "import jax\n" in block.text:
            pytest.importorskip("jax")
        if "import torch\n" in block.text and find_spec("torch") is None:
            continue  # Large: `make torch` has it.
        if block.language == "python":
            program.append(f"{block.text}\nprint({SEPARATOR!r})\n")
            expected.append("")
        elif block.language == "text":
            expected[-1] = block.text
    # In a file, so that other processes can be started from it.
    lines = "".join(program).replace("\n", "\n    ")
    text = f"def main():\n    {lines}\n\nif __name__ == '__main__':\n    main()\n"
    (tmp_path / "page.py").write_text(text, encoding="utf-8")
    if "import jax\n" in text or "Executor" in text:  # which have a state, or start processes
        done = python("-W", "error", "page.py", folder=tmp_path)
        assert done.returncode == 0, done.stderr
        output = done.stdout
    else:
        output = printed(tmp_path / "page.py", tmp_path)
    parts = [part.removeprefix("\n") for part in output.split(SEPARATOR)]
    checker = doctest.OutputChecker()
    for got, wanted in zip(parts, expected, strict=False):
        assert checker.check_output(wanted, got, FLAGS), f"said:\n{wanted}\nprinted:\n{got}"
    assert len(parts) == len(expected) + 1


@pytest.mark.parametrize(
    ("page", "files"),
    [
        ("start.md", {"roller.nc", "roller.png", "rollers.nc"}),
        ("howto/bearing.md", {"bearing.nc", "bearing.png", "tilts.nc"}),
        ("howto/indentation.md", {"film.nc", "film.csv", "films.nc"}),
    ],
)
def test_the_commands_of_a_page_run(page: str, files: set[str], tmp_path: Path) -> None:
    found = blocks(DOCS / page)
    for block in found:
        if block.caption:
            (tmp_path / block.caption).write_text(block.text, encoding="utf-8")
    lines = [line for block in found if block.language == "sh" for line in block.text.splitlines()]
    assert len(lines) >= 2
    with contextlib.chdir(tmp_path):
        for line in lines:
            program, *arguments = shlex.split(line)
            assert program == "nacre"
            assert command(*arguments) == 0
    assert {path.name for path in tmp_path.iterdir()} >= files


def test_lines_of_code_fit_their_boxes() -> None:
    for page in [*DOCS.glob("*.md"), *DOCS.glob("*/*.md")]:
        for block in blocks(page):
            if block.language in ("python", "rust", "sh", "toml"):
                assert max(map(len, block.text.splitlines()), default=0) <= 80, (page, block.text)
    for program in DOCS.glob("gallery/*/*.py"):
        code = program.read_text(encoding="utf-8").rpartition('"""\n\n')[2]
        lines = [line for line in code.splitlines() if not line.startswith("#")]
        assert max(map(len, lines)) <= 80, program


def test_the_front_page_is_readme() -> None:
    page, other = ((DOCS / name).read_text(encoding="utf-8") for name in ("index.md", "when.md"))
    sections = re.findall(r"```\{readme\} (\w+)\n```\n", page + other)
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    marked = re.findall(r"<!-- begin: (\w+) -->", readme)
    assert sections == marked == ["introduction", "use", "contents", "purpose"]
    section = runpy.run_path(str(DOCS / "extensions" / "readme.py"))["section"]
    for name in sections:
        for link in re.findall(r"\]\(([^):#]+)[^):]*\)", section(name)):
            assert (DOCS / link).exists(), link
    assert "| draw the pressure | `solution.plot()` |" in section("use")
    assert "The following features build on this core:" in section("contents")
    assert "The following features build on this core:" not in page


def test_the_list_of_pages_says_what_each_is_for() -> None:
    index = (DOCS / "howto" / "index.md").read_text(encoding="utf-8")
    card = r":link: (\w+)\n:link-type: doc\n(?::img-top: \S+\n)?[A-Z][^\n]+\.\n:::"
    entries = re.findall(card, index)
    pages = {page.stem for page in DOCS.glob("howto/*.md")} - {"index"}
    assert sorted(entries) == sorted(pages)


def test_the_reference_opens_with_a_line_on_every_name() -> None:
    missing = [name for name in NAMES["names"]() if not NAMES["sentence"](name)]
    values = {"nacre.RIGID", "nacre.FREE", "nacre.materials", "nacre.plot.STYLE"}
    assert {name for name in missing if not name.startswith(("nacre.torch", "nacre.jax"))} == values
    assert len(NAMES["table"]().splitlines()) == 2 + len(NAMES["names"]()) > 150


def test_all_installs_what_readme_says() -> None:
    extras = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"][
        "optional-dependencies"
    ]
    (everything,) = extras.pop("all")
    left = extras.keys() - set(everything.partition("[")[2].rstrip("]").split(","))
    assert left == {"view", "jax", "torch"}
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    words = "The extras `view` (PyVista), `jax` and `torch` are large; `all` does not include them."
    assert words in " ".join(readme.split())


def test_every_public_name_is_in_the_reference() -> None:
    text = "\n".join(NAMES["reference"](page.stem) for page in (DOCS / "api").glob("*.rst"))
    listed = set(re.findall(r"^\.\. (?:auto|py:)\w+:: ([\w.]+)$", text, flags=re.MULTILINE))
    public = {f"nacre.{name}" for name in nacre.__all__ if not name.startswith("__")} | {
        f"{module.__name__}.{name}"
        for module in MODULES
        for name in module.__all__
        if name not in nacre.__all__
    }
    assert public - listed == set()


def test_every_figure_of_the_paper_has_a_page() -> None:
    pages = {page.stem for page in (DOCS / "gallery" / "paper").glob("*.py")}
    assert pages == {f"figure_{number}" for number in range(1, 7)}
