"""The licences of the linked crates are in the distribution, and no home folder is."""

from __future__ import annotations

import importlib.util
import re
import tomllib
import zipfile
from pathlib import Path
from types import ModuleType

import pytest

from support import ROOT

CRATE = re.compile(r"^([\w-]+) (\d\S*) \((.+)\)$", re.MULTILINE)
RULE = "-" * 80
NOTICES = (ROOT / "LICENSE-THIRD-PARTY").read_text(encoding="utf-8")
GRANTS = (
    "Permission is hereby granted, free of charge,",
    "Redistribution and use in source and binary forms",
    "They are used under the Apache License, Version 2.0, in the file LICENSE-APACHE.",
)
"""Words of the MIT licence, of the BSD licences, and for crates that come without a text."""


def script(path: str) -> ModuleType:
    spec = importlib.util.spec_from_file_location(Path(path).stem, ROOT / path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_each_crate_has_its_version_its_licence_and_a_text() -> None:
    locked = tomllib.loads((ROOT / "Cargo.lock").read_text(encoding="utf-8"))["package"]
    versions = {(crate["name"], crate["version"]) for crate in locked}
    named = [(name, version) for name, version, _ in CRATE.findall(NOTICES)]
    assert named
    assert len(set(named)) == len(named)
    assert [crate for crate in named if crate not in versions] == []
    _, *parts = NOTICES.split(RULE)
    for names, text in zip(parts[::2], parts[1::2], strict=True):
        words = " ".join(text.split())
        (grant,) = (grant for grant in GRANTS if grant in words)
        for _, _, licence in CRATE.findall(names):
            family = ("MIT", "BSD", "Apache-2.0")[GRANTS.index(grant)]
            assert family in licence, names


def test_each_crate_that_nacre_names_is_there() -> None:
    """Of those that they need in turn, `python packaging/licences.py --check` asks Cargo."""
    cargo = tomllib.loads((ROOT / "Cargo.toml").read_text(encoding="utf-8"))
    named = {name for name, _, _ in CRATE.findall(NOTICES)}
    assert set(cargo["dependencies"]) <= named
    tests = set(cargo["dev-dependencies"]) - set(cargo["dependencies"])
    assert not (tests | {"nacre-contact", "serde_derive", "syn"}) & named


@pytest.mark.parametrize(
    ("files", "expression", "text"),
    [
        ({"LICENSE-APACHE": "a", "LICENSE-MIT.md": "b"}, "MIT OR Apache-2.0", "b"),
        ({"license-apache-2.0": "a", "license-mit": "b"}, "MIT OR Apache-2.0", "b"),
        ({"LICENSE": "a", "README.md": "b"}, "BSD-2-Clause", "a"),
        ({}, "Zlib OR Apache-2.0", ""),
        ({}, "MIT", None),
    ],
)
def test_the_text_of_a_crate_is_its_own(
    tmp_path: Path, files: dict[str, str], expression: str, text: str | None
) -> None:
    for name, content in files.items():
        (tmp_path / name).write_text(content)
    crate = {"name": "a", "license": expression, "manifest_path": str(tmp_path / "Cargo.toml")}
    licence = script("packaging/licences.py").licence
    if text is None:
        with pytest.raises(ValueError, match="a comes without its licence, MIT"):
            licence(crate)
    else:
        assert licence(crate) == text


HOMES = {
    "/home/ann/.cargo/registry/src/a/b.rs": True,
    "/Users/ann/.cargo/registry/src/a/b.rs": True,
    "/root/.cargo/registry/src/a/b.rs": True,
    r"C:\Users\ann\.cargo\registry\src\a\b.rs": True,
    f"{Path.home()}/a.rs": True,
    "cargo/registry/src/a/b.rs": False,
    "/rustc/59807616/library/std/src/io.rs": False,
}


@pytest.mark.parametrize("path", HOMES)
def test_a_home_folder_in_the_module_is_found(path: str, tmp_path: Path) -> None:
    wheel = tmp_path / "a.whl"
    licences = {file.name: file.read_bytes() for file in ROOT.glob("LICENSE-*")}
    assert len(licences) == 3
    with zipfile.ZipFile(wheel, "w") as archive:
        archive.writestr("nacre/_core.abi3.so", b"\x7fELF\0" + path.encode() + b"\0")
        for name, content in licences.items():
            archive.writestr(f"nacre_contact-0.1.0.dist-info/licenses/{name}", content)
    violations = list(script("tests/wheel.py").violations(wheel))
    assert len(violations) == int(HOMES[path])
    assert not violations or f"names a home folder, {path}" in violations[0]


@pytest.mark.parametrize("missing", sorted(file.name for file in ROOT.glob("LICENSE-*")))
def test_a_wheel_without_a_licence_or_a_module_is_refused(missing: str, tmp_path: Path) -> None:
    wheel = tmp_path / "a.whl"
    with zipfile.ZipFile(wheel, "w") as archive:
        for file in ROOT.glob("LICENSE-*"):
            content = file.read_bytes() if file.name != missing else b"another"
            archive.writestr(f"nacre_contact-0.1.0.dist-info/licenses/{file.name}", content)
    assert list(script("tests/wheel.py").violations(wheel)) == [
        "a.whl: must have one compiled module, got []",
        f"a.whl: must have {missing}",
    ]
