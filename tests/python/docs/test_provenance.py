"""The page of provenance has every file of reference numbers, and each says what it must."""

from __future__ import annotations

import importlib
from typing import Any

import pytest

from support import DATA, ROOT


@pytest.fixture
def provenance(monkeypatch: pytest.MonkeyPatch) -> Any:
    monkeypatch.syspath_prepend(str(ROOT / "docs" / "extensions"))
    return importlib.import_module("provenance")


def test_every_file_says_source_method_and_error(provenance: Any) -> None:
    assert len(provenance.files()) > 40
    for name, content in provenance.files().items():
        for key in ("source", "method", "error"):
            assert isinstance(content.get(key), str), f"{name} says no {key}"
            assert content[key], name


def test_every_file_is_read_by_a_test(provenance: Any) -> None:
    assert [name for name in provenance.files() if not provenance.readers(name)] == []


def test_the_table_has_a_row_of_five_cells_for_each_file(provenance: Any) -> None:
    rows = provenance.table().splitlines()[2:]
    assert len(rows) == len(provenance.files())
    assert all(row.replace("\\|", "").count("|") == 6 for row in rows)


def test_generators_that_are_named_exist(provenance: Any) -> None:
    for name, content in provenance.files().items():
        for word in content["method"].replace(",", " ").replace(";", " ").split():
            if word.startswith("make/"):
                assert (DATA / word.rstrip(":.")).exists(), f"{name}: {word}"
