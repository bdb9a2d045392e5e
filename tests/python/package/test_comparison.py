"""The comparison of arrays that all tests use is as strict as it says."""

from __future__ import annotations

from typing import Any

import pytest

from support import assert_close

FORCE = (1e3, 2.0, 0.0)


@pytest.mark.parametrize(
    ("found", "options"),
    [
        ((1e3, 2.0, 1e-10), {"rtol": 1e-8}),  # rounding of the third
        ((1e3, 2.0, 1e-10), {"rtol": 1e-2, "each": True}),
        ((1e3, 2.0, 1e-3), {"rtol": 0.0, "atol": 1e-2}),
    ],
)
def test_zeros_of_symmetry_are_rounding(found: Any, options: dict[str, Any]) -> None:
    assert_close(found, FORCE, **options)
    with pytest.raises(AssertionError):
        assert_close((1e3, 2.02, 0.0), FORCE, **options | {"rtol": min(options["rtol"], 5e-3)})


def test_zeros_alone_have_no_scale() -> None:
    with pytest.raises(AssertionError, match="atol= says what is zero"):
        assert_close((0.0, 1e-20), (0.0, 0.0))
    assert_close((0.0, 1e-20), (0.0, 0.0), atol=1e-15)


def test_numbers_without_a_bound_of_their_own_are_not_all_alike() -> None:
    assert pytest.approx(1e-13, rel=1e-6) != 2e-13
