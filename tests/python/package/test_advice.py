"""Every advice names what exists: arguments, keys, functions; on the page none of these."""

from __future__ import annotations

import ast
import inspect
import re
import warnings
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path
from typing import Any

import pytest

import nacre
from nacre.app.answer import COARSE, answer
from nacre.app.cards import cards
from nacre.case.reference import schema

PACKAGE = Path(nacre.__file__).parent
SOURCES = Path(__file__).parents[3] / "src"
MODULES = ("bearing", "fatigue", "indent", "rough", "friction", "hertz", "types", "case", "design")
OTHERS = {"jax_enable_x64", "f_c"}
"""A setting of another library, and a symbol."""


def texts_of_python(path: Path) -> Iterator[str]:
    """Yield the texts of a module with spaces in them, without its docstrings."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    nodes = [*ast.walk(tree)]
    bodies = [body for node in nodes if isinstance(body := getattr(node, "body", None), list)]
    docs = {id(line.value) for body in bodies for line in body if isinstance(line, ast.Expr)}
    for node in nodes:
        if isinstance(node, ast.JoinedStr):
            parts = (part.value if isinstance(part, ast.Constant) else "{}" for part in node.values)
            yield "".join(map(str, parts))
        elif (
            isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in docs
        ):
            yield node.value


def texts_of_rust(path: Path) -> Iterator[str]:
    """Yield the texts of a Rust file, without its comments and tests."""
    code = re.sub(r"^\s*//.*$", "", path.read_text(encoding="utf-8"), flags=re.MULTILINE)
    for text in re.findall(r'"((?:[^"\\\n]|\\.|\\\n)*)"', code.partition("#[cfg(test)]")[0]):
        yield re.sub(r"\{\w+(:[^}]*)?\}", "{}", re.sub(r"\\\n\s*", "", text))


def messages() -> Iterator[str]:
    """Yield all texts that may be sentences, without markup and quoted values."""
    for path in PACKAGE.rglob("*.py"):
        yield from texts_of_python(path)
    for path in SOURCES.rglob("*.rs"):
        yield from texts_of_rust(path)


def names_in(thing: Any, seen: set[int]) -> Iterator[str]:
    """Yield the names of a public callable's parameters and members, and of theirs."""
    if id(thing) in seen:
        return
    seen.add(id(thing))
    try:
        yield from inspect.signature(thing).parameters
    except (TypeError, ValueError):
        pass
    for name, member in inspect.getmembers(thing) if inspect.isclass(thing) else ():
        if not name.startswith("_"):
            yield name
            yield from names_in(member, seen)


def known() -> set[str]:
    """Return the names of public functions, their arguments, members, and keys of case files."""
    modules = [nacre, *(import_module(f"nacre.{name}") for name in MODULES)]
    names = {key for table in schema()["$defs"].values() for key in table.get("properties", {})}
    seen: set[int] = set()
    for module in modules:
        for name, thing in vars(module).items():
            if not name.startswith("_") and callable(thing):
                names |= {name, *names_in(thing, seen)}
    return names


def test_every_name_in_a_message_exists() -> None:
    names = known() | OTHERS
    unknown: dict[str, str] = {}
    for text in messages():
        words = re.sub(r"\"[^\"]*\"|\{[^}]*\}", "", text)
        if " " not in words.strip() or "<" in words or "='" in words or "charset" in words:
            continue  # no sentence, or markup
        arguments = re.findall(r"(?<![\w.])([a-z]\w*)=(?!=)", words)
        compounds = re.findall(r"(?<![\w./`'])([a-z]+(?:_[a-z0-9]+)+)\b", words)
        unknown |= {name: text for name in (*arguments, *compounds) if name not in names}
    assert unknown == {}


@pytest.mark.slow
@pytest.mark.parametrize("name", [name for name in cards() if name != "roller"])
def test_the_page_names_no_argument(name: str) -> None:
    card = cards()[name]
    empty = {field.path: "" for field in card.by_path.values() if field.may_be_empty}
    for values in ({}, empty):
        for stage in ("draft", "stress"):
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", nacre.NacreWarning)
                parts = answer(card.case(values), stage)["parts"]
            verdict = parts.get("verdict", {"words": "", "lines": []})
            for text in (verdict["words"], *verdict["lines"], *parts["warnings"]):
                # The factor of ISO 281 is a symbol.
                assert not re.search(r"\w+=|\w_\w", text.replace("a_ISO", "")), text
                assert not COARSE.search(text), text
