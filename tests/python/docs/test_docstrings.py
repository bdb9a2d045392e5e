"""Every public name has a NumPy-style docstring, whose examples are true."""

import ast
import dataclasses
import doctest
import importlib
import importlib.util
import inspect
import itertools
import pkgutil
import re
from dataclasses import is_dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import nacre
import nacre.bearing

FATIGUE = ("assess", "shakedown", "shakedown_map")
FLAGS = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE


def public_objects() -> dict[str, Any]:
    """Return classes and functions, methods and attributes, by their full names."""
    found: dict[str, Any] = {}
    named = {name: getattr(nacre, name) for name in nacre.__all__ if not name.startswith("__")}
    named |= {f"types.{name}": getattr(nacre.types, name) for name in nacre.types.__all__}
    named |= {f"hertz.{name}": getattr(nacre.hertz, name) for name in nacre.hertz.__all__}
    named |= {f"fatigue.{name}": getattr(nacre.fatigue, name) for name in FATIGUE}
    for name, thing in named.items():
        found[name] = thing
        if isinstance(thing, type) and not issubclass(thing, BaseException):
            fields = {one.name for one in dataclasses.fields(thing)} if is_dataclass(thing) else {}
            members = sorted(m for m in vars(thing) if not m.startswith("_") and m not in fields)
            found |= {f"{name}.{member}": getattr(thing, member) for member in members}
    return found


def parameters(thing: Any) -> list[inspect.Parameter]:
    """Return what a caller gives: nothing for the classes whose instances nacre makes."""
    if any(thing is getattr(nacre.types, name) for name in nacre.types.__all__):
        return []
    try:
        signature = inspect.signature(thing)
    except (TypeError, ValueError):
        return []
    return [p for name, p in signature.parameters.items() if name != "self"]


def sections(docstring: str) -> dict[str, str]:
    """Return the text below each underlined heading."""
    parts = re.split(r"^(\w[\w ]*)\n-{3,}\n", inspect.cleandoc(docstring), flags=re.MULTILINE)
    return dict(zip(parts[1::2], parts[2::2], strict=True))


def documented(section: str) -> list[str]:
    """Return the names in `a, b : type` lines."""
    lines = re.findall(r"^(\w+(?:, \w+)*) : \S", section, flags=re.MULTILINE)
    return [name for line in lines for name in line.split(", ")]


OBJECTS = public_objects()
CALLED = {name: thing for name, thing in OBJECTS.items() if callable(thing) and parameters(thing)}
CLASSES = {
    name: thing
    for name, thing in OBJECTS.items()
    if isinstance(thing, type) and not issubclass(thing, BaseException)
}


@pytest.mark.parametrize("name", OBJECTS)
def test_it_is_documented(name: str) -> None:
    """One line says what it is; there is an example, and all that a caller gives."""
    thing = OBJECTS[name]
    docstring = thing.__doc__
    assert docstring
    first, _, rest = inspect.cleandoc(docstring).partition("\n")
    assert first.endswith((".", ":"))
    assert rest == "" or rest.startswith("\n")
    told = sections(docstring)
    if name in CALLED | CLASSES:
        assert ">>> " in told.get("Examples", "")
    if name in CALLED:
        assert documented(told.get("Parameters", "")) == [p.name for p in parameters(thing)]
        assert [p.name for p in parameters(thing) if p.default is ...] == []  # can be read
        assert re.search(r"^(Value|Type)Error$", told["Raises"], re.M)
        assert isinstance(thing, type) or told["Returns"].strip()


@pytest.mark.parametrize("name", [name for name, thing in CLASSES.items() if is_dataclass(thing)])
def test_every_field_of_a_dataclass_is_documented(name: str) -> None:
    kind: Any = CLASSES[name]
    module: Any = ast.parse(inspect.getsource(kind))
    body: list[Any] = module.body[0].body
    told = {
        field.target.id: text.value.value
        for field, text in itertools.pairwise(body)
        if (type(field), type(text)) == (ast.AnnAssign, ast.Expr)
    }
    for name in (field.name for field in dataclasses.fields(kind) if field.name[0] != "_"):
        assert told[name].split("\n")[0].endswith((".", ":"))


def with_examples() -> list[str]:
    everything = {"nacre": nacre} | OBJECTS
    return [name for name, thing in everything.items() if ">>> " in (thing.__doc__ or "")]


@pytest.mark.slow
@pytest.mark.parametrize("name", with_examples())
def test_its_examples_are_true(name: str) -> None:
    docstring = nacre.__doc__ if name == "nacre" else OBJECTS[name].__doc__
    assert docstring
    examples = doctest.DocTestParser().get_doctest(
        docstring, {"nacre": nacre, "np": np}, name, None, 0
    )
    said: list[str] = []
    result = doctest.DocTestRunner(optionflags=FLAGS).run(examples, out=said.append)
    assert result.attempted > 0
    assert result.failed == 0, "".join(said)


def modules_with_examples() -> list[str]:
    """Return the names of the modules with examples; PyTorch is tested elsewhere."""
    names = []
    for module in pkgutil.walk_packages(nacre.__path__, "nacre."):
        spec = importlib.util.find_spec(module.name)
        assert spec is not None
        is_python = (spec.origin or "").endswith(".py")
        if is_python and ">>> " in Path(spec.origin or "").read_text(encoding="utf-8"):
            names.append(module.name)
    return [name for name in names if name != "nacre.torch"]


class Finder(doctest.DocTestFinder):
    """Finder of examples, also of functions of the module that users know by another name."""

    def _from_module(self, module: Any, object: Any) -> bool:
        if inspect.isfunction(object) and inspect.unwrap(object).__globals__ is vars(module):
            return True
        return bool(super()._from_module(module, object))  # type: ignore[misc]


@pytest.mark.slow
@pytest.mark.parametrize("name", modules_with_examples())
def test_the_examples_of_a_module_are_true(name: str) -> None:
    module = importlib.import_module(name)
    names = {**vars(module), "nacre": nacre, "np": np}
    runner = doctest.DocTestRunner(optionflags=FLAGS)
    for example in Finder().find(module, name, globs=names):
        runner.run(example)
    assert runner.tries > 0
    assert runner.failures == 0
