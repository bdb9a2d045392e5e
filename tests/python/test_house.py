"""The rules of `tests/house.py` fire on small trees that break them, and on nothing else."""

import importlib.util
import sys
from pathlib import Path

import pytest

SCRIPT = Path(__file__).parents[1] / "house.py"
spec = importlib.util.spec_from_file_location("house", SCRIPT)
assert spec is not None
assert spec.loader is not None
house = importlib.util.module_from_spec(spec)
spec.loader.exec_module(house)


def told(root: Path, files: dict[str, str], longer: tuple[str, ...] = ()) -> list[tuple[str, str]]:
    """Return path and message of each violation in a tree of these files."""
    for name, text in files.items():
        path = root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
    return [(found.path, found.message) for found in house.violations(root, longer)]


@pytest.mark.parametrize(
    ("name", "text", "opening"),
    [
        ("src/fft.rs", "/// Of each thread one.\nstruct S;\n", "Of"),
        ("src/fft.rs", "//! The same for kernels.\n", "The same"),
        ("src/fft.rs", "    /// Those of the first rows,\n    /// and others.\n", "Those"),
        ("tests/a.rs", "/// That of this thread.\nfn f() {}\n", "That of"),
        ("python/nacre/a.py", '"""Of a module."""\n', "Of"),
        ("tests/python/a.py", 'def f():\n    """Those of a function."""\n', "Those"),
        ("benches/peers/a.py", 'SIDE = 2.0\n"""Of the domain."""\n', "Of"),
        ("python/nacre/_core.pyi", 'class A:\n    """The same class."""\n', "The same"),
    ],
)
def test_a_first_sentence_names_the_thing(
    tmp_path: Path, name: str, text: str, opening: str
) -> None:
    assert told(tmp_path, {name: text}) == [(name, f'the first sentence begins with "{opening}"')]


def test_other_sentences_may_begin_as_they_like(tmp_path: Path) -> None:
    text = "/// Offsets.\n///\n/// Of each kernel.\nstruct S;\n// The same.\n"
    assert told(tmp_path, {"src/fft.rs": text, "python/nacre/a.py": "# Of a module.\n"}) == []


CIRCLES = {
    "siblings": {
        "src/fft.rs": "mod a;\nmod b;\n",
        "src/fft/a.rs": "use super::b::B;\npub struct A(B);\n",
        "src/fft/b.rs": "use crate::fft::a::A;\npub struct B(Box<A>);\n",
    },
    "through a re-export": {
        "src/fft.rs": "mod a;\nmod b;\npub use a::A;\n",
        "src/fft/a.rs": "use super::b::{self, C as D};\npub struct A(D, b::B);\n",
        "src/fft/b.rs": "use super::*;\npub struct B(Box<A>);\npub struct C;\n",
    },
    "by a path alone": {
        "src/fft.rs": "mod a;\nmod b;\n",
        "src/fft/a.rs": "pub fn f() { crate::fft::b::g() }\n",
        "src/fft/b.rs": "pub fn g() { super::a::f() }\n",
    },
    "by a module": {
        "src/fft.rs": "mod a;\nmod b;\n",
        "src/fft/a.rs": "use super::b;\npub fn f() { b::g() }\n",
        "src/fft/b.rs": "mod inline {\n    use super::super::a::f;\n}\npub fn g() {}\n",
    },
    "three files": {
        "src/fft.rs": "mod a;\nmod b;\nmod c;\n",
        "src/fft/a.rs": "use super::b::B;\npub struct A(B);\n",
        "src/fft/b.rs": "use super::c::C;\npub struct B(C);\n",
        "src/fft/c.rs": "use super::a::A;\npub struct C(Box<A>);\n",
    },
    "parent and child": {
        "src/fft.rs": "mod a;\nuse a::A;\npub struct B(A);\n",
        "src/fft/a.rs": "use super::B;\npub struct A(Box<B>);\n",
    },
    "parent that uses what it re-exports": {
        "src/fft.rs": "mod a;\npub use a::A;\npub struct B(A);\n",
        "src/fft/a.rs": "use super::B;\npub struct A(Box<B>);\n",
    },
    "modules of Python": {
        "python/nacre/a.py": "from nacre.b import f\n",
        "python/nacre/b.py": "def f():\n    import nacre.a\n",
    },
    "a package of Python": {
        "python/nacre/__init__.py": "from nacre.b import f\n",
        "python/nacre/b.py": "import nacre\n",
    },
}


@pytest.mark.parametrize("files", CIRCLES.values(), ids=CIRCLES)
def test_files_do_not_import_each_other(tmp_path: Path, files: dict[str, str]) -> None:
    ((_, message),) = told(tmp_path, files)
    assert message.startswith("files import each other: ")
    in_circle = [name for name in files if len(files) == 2 or name != "src/fft.rs"]
    assert set(message.removeprefix("files import each other: ").split(" → ")) == set(in_circle)


NO_CIRCLES = {
    "parent that re-exports": {
        "src/fft.rs": "mod a;\npub(crate) use a::A;\npub struct B;\nimpl B { fn A() {} }\n",
        "src/fft/a.rs": "use super::B;\npub struct A(B);\n",
    },
    "parent that exports to Python": {
        "src/python.rs": "mod a;\npub struct B;\nmod core {\n    #[pymodule_export]\n"
        "    use super::a::A;\n}\n",
        "src/python/a.rs": "use super::B;\npub struct A(B);\n",
    },
    "unit tests": {
        "src/fft.rs": "mod a;\nmod b;\n",
        "src/fft/a.rs": "use super::b::B;\npub struct A(B);\n",
        "src/fft/b.rs": "pub struct B;\n#[cfg(test)]\nmod tests {\n    use crate::fft::a::A;\n}\n",
    },
    "comments and strings": {
        "src/fft.rs": "mod a;\nmod b;\n",
        "src/fft/a.rs": "use super::b::B;\npub struct A(B);\n",
        "src/fft/b.rs": "/// See [`crate::fft::a::A`].\npub struct B;\n"
        'const C: &str = "use super::a::A;";\nconst D: char = \'"\';\n// use super::a::A;\n',
    },
    "a module beside its items": {
        "src/fft.rs": "mod a;\nmod b;\nmod c;\n",
        "src/fft/a.rs": "use super::b;\npub struct A(b::C);\n",
        "src/fft/b.rs": "use super::a::A;\npub use super::c::C;\npub struct B(A);\n",
        "src/fft/c.rs": "pub struct C;\n",
    },
    "types alone": {
        "python/nacre/a.py": "from nacre.b import f\n",
        "python/nacre/b.py": "from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n"
        "    from nacre.a import g\n",
    },
    "a package above": {
        "python/nacre/__init__.py": "from nacre.b import f\n",
        "python/nacre/b.py": "from nacre._core import g\nfrom nacre.c import h\n",
        "python/nacre/c.py": "import numpy\n",
    },
}


@pytest.mark.parametrize("files", NO_CIRCLES.values(), ids=NO_CIRCLES)
def test_what_is_no_circle_is_not_told(tmp_path: Path, files: dict[str, str]) -> None:
    assert told(tmp_path, files) == []


def test_modules_import_from_earlier_ones_only(tmp_path: Path) -> None:
    files = {
        "src/lib.rs": "mod grid;\nmod stress;\npub use grid::Grid;\npub use stress::Stress;\n",
        "src/grid.rs": "use crate::{Stress, stress};\npub struct Grid(stress::Stress);\n",
        "src/stress.rs": "pub struct Stress;\n",
    }
    message = "grid imports from stress, which comes later"
    assert told(tmp_path, files) == [("src/grid.rs", message), ("src/grid.rs", message)]


def test_each_module_has_a_place_in_the_chain(tmp_path: Path) -> None:
    message = "the module utils is not in the chain of tests/house.py"
    assert told(tmp_path, {"src/utils.rs": ""}) == [("src/utils.rs", message)]


def test_folders_have_few_files(tmp_path: Path) -> None:
    files = {f"src/fft/{letter}.rs": "" for letter in "abcdefghijklm"}
    assert told(tmp_path, files) == [("src/fft", "13 files in a folder, at most 12")]


def test_the_folder_src_may_have_more(tmp_path: Path) -> None:
    assert told(tmp_path, {f"src/{module}.rs": "" for module in house.CHAIN}) == []


@pytest.mark.parametrize("name", ["src/fft.rs", "python/nacre/a.py"])
def test_files_are_short(tmp_path: Path, name: str) -> None:
    long = {name: "\n" * 451}
    assert told(tmp_path, long) == [(name, "451 lines in a file, at most 450")]
    assert told(tmp_path, long, (name,)) == []
    assert told(tmp_path, {name: "\n" * 450}) == []


def test_an_exception_is_needed(tmp_path: Path) -> None:
    message = "LONGER: src/fft.rs needs no exception any more"
    expected = [("tests/house.py", message)]
    assert told(tmp_path, {"src/fft.rs": "\n" * 450}, ("src/fft.rs",)) == expected


def test_it_prints_violations_and_fails(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    told(tmp_path, {"src/fft.rs": "\n//! Of FFTs.\n"})
    monkeypatch.setattr(sys, "argv", ["house.py", str(tmp_path)])
    assert house.main() == 1
    assert 'src/fft.rs:2: the first sentence begins with "Of"\n' in capsys.readouterr().out
