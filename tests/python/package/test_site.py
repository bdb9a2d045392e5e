"""The site keeps the documentation of each release beside the newest state."""

import re
import runpy
from pathlib import Path

import pytest

from support import ROOT

place = runpy.run_path(str(ROOT / "packaging" / "site.py"))["place"]


def built(folder: Path, text: str) -> Path:
    folder.mkdir(exist_ok=True)
    (folder / "index.html").write_text(text, encoding="utf-8")
    return folder


def linked(page: Path) -> list[str]:
    """Return the versions to which a page links, all of which must be there."""
    found = re.findall(r'href="([^"]+)/index\.html"', page.read_text(encoding="utf-8"))
    assert all((page.parent / name / "index.html").is_file() for name in found)
    return found


def test_a_version_replaces_itself_and_no_other(tmp_path: Path) -> None:
    site = tmp_path / "site"
    site.mkdir()
    place(built(tmp_path / "docs", "first"), site, "dev")
    assert linked(site / "index.html") == ["dev"]
    for version in ("0.2.0", "0.10.0", "0.9.1"):
        place(built(tmp_path / "docs", version), site, version)
    old = built(tmp_path / "docs", "next")
    (site / "dev" / "gone.html").touch()
    place(old, site, "dev")
    assert (site / "dev" / "index.html").read_text(encoding="utf-8") == "next"
    assert not (site / "dev" / "gone.html").exists()
    assert (site / "0.9.1" / "index.html").read_text(encoding="utf-8") == "0.9.1"
    assert linked(site / "index.html") == ["0.10.0"]
    assert linked(site / "versions.html") == ["dev", "0.10.0", "0.9.1", "0.2.0"]


@pytest.mark.parametrize("version", ["0.2", "v0.2.0", "0.2.0-dev", "../docs", ""])
def test_other_names_are_refused(version: str, tmp_path: Path) -> None:
    with pytest.raises(ValueError, match=re.escape(f"got {version!r}")):
        place(built(tmp_path / "docs", ""), tmp_path, version)
    assert (tmp_path / "docs" / "index.html").is_file()
