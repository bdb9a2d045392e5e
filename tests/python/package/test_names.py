"""Public modules list their public names alone."""

from importlib import import_module

import pytest

import nacre

MODULES = sorted({*nacre._MODULES, "surfaces"} - {"jax", "torch"})  # these need more


@pytest.mark.parametrize("name", MODULES)
def test_all_decides_dir(name: str) -> None:
    module = import_module(f"nacre.{name}")
    assert dir(module) == sorted(module.__all__)
    assert all(getattr(module, name) is not None for name in dir(module))
