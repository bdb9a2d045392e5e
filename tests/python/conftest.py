"""Fixtures of all tests."""

import json
import os
import signal
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

os.environ.setdefault("MPLBACKEND", "agg")  # pictures are drawn without a screen
os.environ["COLUMNS"] = "1000"  # what commands print is compared with what Python prints
SLOW = """
docs examples functions fuzz fuzz_contacts fuzz_ends fuzz_files fuzz_fits fuzz_indent
indent_extremes indent_fit indent_residuals notebook optimise paper peers rough stress_ends
studies typing
""".split()
"""Files of which `make quick` runs the tests marked quick alone: random cases, examples, long fits.
"""
# Jobs that shells start in the background ignore Ctrl-C, and so do their processes.
signal.signal(signal.SIGINT, signal.default_int_handler)
# That of pytest, 1e-12, is more than many areas and works in SI units: a test says its own.
type(pytest.approx(0.0)).DEFAULT_ABSOLUTE_TOLERANCE = 0.0  # type: ignore[attr-defined]
CLAIMS = Path(__file__).parents[2] / "docs" / "claims.json"


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    for item in items:
        is_slow = item.path.stem.removeprefix("test_") in SLOW
        if is_slow and not item.get_closest_marker("quick"):
            item.add_marker(pytest.mark.slow)


@pytest.fixture(autouse=True)
def _nothing_is_left_behind() -> Iterator[None]:
    environment = dict(os.environ)
    yield
    if dict(os.environ) != environment:  # pools of processes set OMP_NUM_THREADS
        os.environ.clear()
        os.environ.update(environment)
    if pyplot := sys.modules.get("matplotlib.pyplot"):
        pyplot.close("all")


@pytest.fixture(scope="session")
def claim() -> Callable[[str, float], None]:
    """Assert that an error is below the bar of its claim in docs/claims.json.

    With NACRE_CLAIMS=FILE the error is appended to the file.
    """
    bars = {row["name"]: row["bar"] for row in json.loads(CLAIMS.read_text(encoding="utf-8"))}

    def check(name: str, error: float) -> None:
        if path := os.environ.get("NACRE_CLAIMS"):
            with open(path, "a", encoding="utf-8") as file:
                file.write(f"{name} {abs(error):e}\n")
        assert abs(error) <= bars[name], f"{name}: {error:.2e}, the bar is {bars[name]:g}"

    return check
