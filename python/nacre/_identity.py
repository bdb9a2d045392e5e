"""Keys of the cases of a study, the same in any process and on any day.

A function is identified by its code and by everything that the code reaches by name: globals,
closures, defaults, bound objects, and the functions and classes among them. An object is identified
by what pickle would write of it. A library is identified by its name and version.
"""

from __future__ import annotations

import builtins
import copyreg
import dis
import functools
import hashlib
import importlib
import importlib.util
import json
import site
import sys
import sysconfig
import types
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from nacre._core import __version__
from nacre.values import encode

ATOMS = (type(None), bool, int, float, complex, str, type(...), type(NotImplemented))
UNSEEN = frozenset({"__import__", "eval", "exec", "globals", "input", "open"})
"""Builtins that reach values which the code does not name."""
LIMIT = 1_000_000
"""Largest number of values that are compared for one function: some seconds of work."""


class Identity(NamedTuple):
    """Identity of the outputs of a study."""

    data: dict[str, Any]
    """Plain data that differs between outputs."""
    unknown: list[str]
    """Descriptions of what the data cannot tell apart."""


def identified(
    outputs: Mapping[str, Any], stress: Mapping[str, Any], version: str | int | None = None
) -> Identity:
    """Return the identity of outputs, of the arguments of their stresses, and of their version."""
    unknown: list[str] = []

    def of(value: Any, place: str) -> Any:
        walk = _Walk()
        try:
            return walk.of(value, place)
        except RecursionError:
            walk.unknown.append(f"{place} (nested too deeply)")
            return None
        finally:
            unknown.extend(walk.unknown)

    kept = {name: o if isinstance(o, str) else of(o, name) for name, o in outputs.items()}
    data: dict[str, Any] = {"outputs": kept}
    if stress:
        data["stress"] = of(dict(stress), "stress")
    if version is not None:
        data["version"] = version
    return Identity(data, unknown)


def key_of(arguments: Mapping[str, Any], identity: Identity) -> str:
    """Return a key that differs between cases, and between the outputs that are kept."""
    # Threads change no bit of a solution.
    asked = {name: value for name, value in arguments.items() if name != "threads"}
    what = {"nacre": __version__, "solve": encode(asked, digest=True), **identity.data}
    return hashlib.sha256(json.dumps(what, sort_keys=True).encode()).hexdigest()


def code_of(value: Any) -> Any:
    """Return plain data for what a function does: its byte code, and the values that it uses."""
    return _Walk().of(value, "value")


class _Walk:
    """Walk through all that a value uses; each object is visited once."""

    def __init__(self) -> None:
        self.unknown: list[str] = []
        self._count = 0
        # The objects are held, so that no other one gets the same id.
        self._met: dict[int, tuple[int, object]] = {}

    def of(self, value: Any, place: str) -> Any:
        """Return a short text that differs between values; `place` names the value."""
        self._count += 1
        if self._count > LIMIT:
            if self._count == LIMIT + 1:
                self.unknown.append(f"{place} (more than {LIMIT} values)")
            return None
        if type(value) in ATOMS:
            return f"{type(value).__name__} {value!r}"
        if not isinstance(value, tuple | frozenset | bytes | np.ndarray | types.CodeType):
            if id(value) in self._met:
                return f"met {self._met[id(value)][0]}"
            self._met[id(value)] = len(self._met), value
        return _digest(self._parts(value, place))

    def _parts(self, value: Any, place: str) -> list[Any]:
        kind = type(value)
        if kind in (tuple, list):
            return [kind.__name__, *(self.of(v, f"{place}[{k}]") for k, v in enumerate(value))]
        if kind in (dict, types.MappingProxyType):
            return ["dict", *sorted(self._pairs(value.items(), place))]
        if kind in (set, frozenset):
            return ["set", *sorted(self._alone(one, place) for one in value)]
        if kind in (bytes, bytearray):
            return [kind.__name__, hashlib.sha256(value).hexdigest()]
        if kind is np.ndarray and not value.dtype.hasobject:
            content = hashlib.sha256(value.tobytes()).hexdigest()
            return ["array", str(value.dtype.descr), list(value.shape), content]
        if kind is types.CodeType:
            return self._code(value, place)
        if kind is types.FunctionType:
            return self._function(value, place)
        if kind is types.MethodType:
            return ["method", self.of(value.__func__, place), self.of(value.__self__, place)]
        if kind is types.BuiltinFunctionType and not isinstance(value.__self__, types.ModuleType):
            return ["method", value.__qualname__, self.of(value.__self__, place)]
        if kind is types.ModuleType:
            return self._module(value, frozenset(), place)
        if isinstance(value, type):
            return self._class(value, place)
        if kind.__module__.partition(".")[0] == "nacre":
            try:
                return ["nacre", encode(value, digest=True)]
            except TypeError:
                pass  # such as a Contact, which is an object like others
        return self._object(value, place)

    def _alone(self, value: Any, place: str) -> str:
        """Return the text for an item of a set, whose order differs between processes."""
        walk = _Walk()
        walk._count = self._count
        text = _digest(walk.of(value, place))
        self._count = walk._count
        self.unknown += walk.unknown
        return text

    def _pairs(self, items: Iterable[tuple[Any, Any]], place: str) -> list[list[Any]]:
        return [[self.of(k, place), self.of(v, f"{place}[{k!r:.40}]")] for k, v in items]

    def _code(self, code: types.CodeType, place: str) -> list[Any]:
        shape = [code.co_argcount, code.co_posonlyargcount, code.co_kwonlyargcount, code.co_flags]
        text = [hashlib.sha256(b).hexdigest() for b in (code.co_code, code.co_exceptiontable)]
        constants = [self.of(constant, place) for constant in code.co_consts]
        return ["code", shape, text, constants, list(code.co_names), list(code.co_freevars)]

    def _function(self, function: types.FunctionType, place: str) -> list[Any]:
        names = _Names.of(function.__code__)
        home = str(function.__globals__.get("__name__", ""))
        kept: list[Any] = [function.__defaults__, function.__kwdefaults__]
        kept.append({k: v for k, v in vars(function).items() if k != "__wrapped__"})
        parts = [self.of(value, place) for value in kept]
        for name, cell in zip(
            function.__code__.co_freevars, function.__closure__ or (), strict=True
        ):
            try:
                content = cell.cell_contents
            except ValueError:
                parts.append("empty")
            else:
                parts.append(self._used(content, names.attributes, f"{place}.{name}"))
        if _is_library(home):
            return ["function", home, function.__qualname__, _version(home), *parts]
        for name in sorted(names.loaded):
            if name in function.__globals__:
                value = function.__globals__[name]
                parts.append([name, self._used(value, names.attributes, f"{place}.{name}")])
            elif name in UNSEEN and hasattr(builtins, name):
                self.unknown.append(f"{place} (calls {name})")
        package = function.__globals__.get("__package__") or ""
        for level, name in sorted(names.imported):
            try:
                whole = importlib.util.resolve_name("." * level + name, package)
                module = importlib.import_module(whole)  # as the function does
            except Exception:
                self.unknown.append(f"{place}.{name} (cannot be imported)")
            else:
                parts.append([name, self._used(module, names.attributes, f"{place}.{name}")])
        return ["function", self.of(function.__code__, place), *parts]

    def _used(self, value: Any, attributes: frozenset[str], place: str) -> Any:
        """Return the text for a value that code reaches by name, and `attributes` through it."""
        if isinstance(value, types.ModuleType):
            return self._module(value, attributes, place)
        return self.of(value, place)

    def _module(
        self,
        module: types.ModuleType,
        attributes: frozenset[str],
        place: str,
        outer: tuple[str, ...] = (),
    ) -> list[Any]:
        name = module.__name__
        if _is_library(name) or name in outer:
            return ["module", name, _version(name)]
        if not attributes:
            self.unknown.append(f"{place} (the module {name})")
        parts = []
        for attribute in sorted(attributes & vars(module).keys()):
            value, inner = vars(module)[attribute], f"{place}.{attribute}"
            if isinstance(value, types.ModuleType):
                part: Any = self._module(value, attributes, inner, (*outer, name))
            else:
                part = self.of(value, inner)
            parts.append([attribute, part])
        return ["module", name, *parts]

    def _class(self, kind: type, place: str) -> list[Any]:
        name = [kind.__module__, kind.__qualname__]
        if _is_library(kind.__module__):
            return ["class", *name, _version(kind.__module__)]
        parts: list[Any] = [self.of(base, place) for base in (*kind.__bases__, type(kind))]
        for key, value in sorted(vars(kind).items()):
            item = value
            if isinstance(item, staticmethod | classmethod):
                item = item.__func__
            elif isinstance(item, property):
                item = [item.fget, item.fset, item.fdel]
            elif isinstance(item, functools.cached_property):
                item = item.func
            elif isinstance(item, types.MemberDescriptorType | types.GetSetDescriptorType):
                item = "slot"
            special = key.startswith("__") and key.endswith("__")
            if key == "_abc_impl" or (special and not isinstance(item, types.FunctionType)):
                continue  # the language's own: documentation, line numbers, caches
            parts.append([key, type(value).__name__, self.of(item, f"{place}.{key}")])
        return ["class", *name, *parts]

    def _object(self, value: Any, place: str) -> list[Any]:
        kind = type(value)
        try:
            reducer = copyreg.dispatch_table.get(kind)
            reduced = value.__reduce_ex__(4) if reducer is None else reducer(value)
        except Exception:
            self.unknown.append(f"{place} (a {kind.__qualname__})")
            return ["unknown", kind.__module__, kind.__qualname__]
        if isinstance(reduced, str):  # the name of a global
            if (inner := getattr(value, "__dict__", {}).get("__wrapped__")) is not None:
                return ["wrapped", kind.__qualname__, self.of(inner, place)]
            home = str(getattr(value, "__module__", None) or kind.__module__)
            if not _is_library(home):
                self.unknown.append(f"{place} (a {kind.__qualname__})")
            return ["named", home, reduced, _version(home)]
        whole: list[Any] = [*reduced, None, None, None]  # the last three may be left out
        parts = [self.of(one, place) for one in whole[:3]]
        items, pairs = whole[3:5]
        parts.append([self.of(one, place) for one in items or ()])
        return ["object", *parts, self._pairs(pairs or (), place)]


class _Names(NamedTuple):
    """Names that code uses, the code inside it included."""

    loaded: frozenset[str]
    attributes: frozenset[str]
    imported: frozenset[tuple[int, str]]

    @classmethod
    def of(cls, code: types.CodeType) -> _Names:
        loaded, attributes, imported = set(), set(), set()
        whole = [one for one in dis.get_instructions(code) if one.opname != "EXTENDED_ARG"]
        for number, one in enumerate(whole):
            if one.opname in ("LOAD_GLOBAL", "LOAD_NAME", "LOAD_FROM_DICT_OR_GLOBALS"):
                loaded.add(one.argval)
            elif one.opname in ("LOAD_ATTR", "LOAD_METHOD", "IMPORT_FROM"):
                attributes.add(one.argval)
            elif one.opname == "IMPORT_NAME":
                # The level of a relative import is pushed first, then the list of names.
                imported.add((int(whole[number - 2].argval), one.argval))
                attributes |= set(one.argval.split("."))
        for constant in code.co_consts:
            if isinstance(constant, types.CodeType):
                inside = cls.of(constant)
                loaded |= inside.loaded
                attributes |= inside.attributes
                imported |= inside.imported
        return cls(frozenset(loaded), frozenset(attributes), frozenset(imported))


def _digest(parts: Any) -> str:
    return hashlib.sha256(json.dumps(parts, sort_keys=True).encode()).hexdigest()


@functools.cache
def _folders() -> tuple[Path, ...]:
    """Return the folders in which libraries are installed."""
    named = [sysconfig.get_path(name) for name in ("purelib", "platlib")]
    named += [*site.getsitepackages(), site.getusersitepackages()]
    return tuple(Path(folder).resolve() for folder in named if folder)


def _is_library(name: str) -> bool:
    """Return whether a module belongs to a library, whose version tells what it does."""
    root = name.partition(".")[0]
    if root == "__main__":
        return False  # also where a tool for notebooks runs it
    if root == "nacre" or root in sys.stdlib_module_names:
        return True
    module = sys.modules.get(root)
    places = [getattr(module, "__file__", None), *getattr(module, "__path__", [])]
    return any(
        Path(place).resolve().is_relative_to(folder)
        for place in places
        if place
        for folder in _folders()
    )


def _version(name: str) -> str | None:
    """Return the version of the library to which a module belongs."""
    found = getattr(sys.modules.get(name.partition(".")[0]), "__version__", None)
    return found if isinstance(found, str) else None
