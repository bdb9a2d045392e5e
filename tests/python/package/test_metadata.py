"""What the project says of itself agrees in all places; README can be shown by package indexes."""

from __future__ import annotations

import importlib.util
import re
import shutil
from pathlib import Path
from typing import Any

import pytest

from support import ROOT, Capture

FILES = ("Cargo.toml", "pyproject.toml", "CITATION.cff", "CHANGELOG.md", "SECURITY.md", "README.md")


@pytest.fixture
def metadata() -> Any:
    spec = importlib.util.spec_from_file_location("metadata", ROOT / "tests" / "metadata.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture
def copy(tmp_path: Path) -> Path:
    for name in FILES:
        shutil.copy(ROOT / name, tmp_path / name)
    return tmp_path


def test_all_places_agree(metadata: Any) -> None:
    assert list(metadata.violations()) == []


@pytest.mark.parametrize(
    ("name", "old", "new", "message"),
    [
        (
            "Cargo.toml",
            'version = "0.2.0-dev"',
            'version = "0.2.0"',
            "version must be 0.2.0, got 0.1.0",
        ),
        (
            "Cargo.toml",
            'version = "0.2.0-dev"',
            'version = "0.1.0-dev"',
            "version must be after 0.1.0, got 0.1.0-dev",
        ),
        ("CITATION.cff", "version: 0.1.0", "version: 0.2.0", "version must be 0.1.0, got 0.2.0"),
        ("Cargo.toml", "The nacre developers", "A. Author", r"authors must be \['A. Author'\]"),
        ("Cargo.toml", ".invalid/", ".invalid/other/", "CITATION.cff: must name"),
        ("SECURITY.md", "project-url", "another", "SECURITY.md: must name"),
        ("pyproject.toml", "project-url", "another", "address of Repository must begin"),
        ("CITATION.cff", "The nacre developers", "Nobody", "CITATION.cff: authors must be"),
        ("CHANGELOG.md", "2026-11-25", "2027-01-02", "must be 2027-01-02"),
    ],
)
def test_what_disagrees_is_named(
    metadata: Any, copy: Path, name: str, old: str, new: str, message: str
) -> None:
    assert list(metadata.violations(copy)) == []
    text = (copy / name).read_text(encoding="utf-8")
    assert old in text
    (copy / name).write_text(text.replace(old, new, 1), encoding="utf-8")
    assert re.search(message, "\n".join(metadata.violations(copy)))


def test_the_placeholder_is_named_and_stops_a_release(metadata: Any, capsys: Capture) -> None:
    assert metadata.main([]) == 0
    out = capsys.readouterr().out
    placeholder = metadata.address() == metadata.PLACEHOLDER
    assert ("repository is the placeholder" in out) == placeholder
    assert metadata.main(["--release"]) == int(placeholder)


def test_readme_has_no_relative_link_where_an_index_shows_it(metadata: Any, copy: Path) -> None:
    text = (copy / "README.md").read_text(encoding="utf-8")
    relative = [path for _, path in metadata.LINK.findall(text)]
    assert len(relative) > 15
    assert [path for path in relative if not (ROOT / path).exists()] == []
    assert metadata.main(["--links", str(copy / "README.md")]) == 0
    text = (copy / "README.md").read_text(encoding="utf-8")
    assert metadata.LINK.findall(text) == []
    assert (
        f"![Time of a solve as a function of the number of cells]({metadata.address()}/raw/v"
        in text
    )


def test_readme_is_rendered_as_pypi_does(metadata: Any) -> None:
    pytest.importorskip("comrak", reason="readme-renderer[md] is not installed")
    from readme_renderer import markdown

    text = metadata.absolute((ROOT / "README.md").read_text("utf-8"), metadata.address(), "0.1.0")
    page = markdown.render(text)
    assert page
    addresses = re.findall(r'(?:href|src)="([^"]*)"', page)
    assert len(addresses) > 15
    assert [one for one in addresses if not one.startswith(("https://", "#"))] == []
