"""Halve and double each constant of the solver that was found by trial: docs/constants.csv.

A copy of the crate under target/constants is built anew for each value, and solves the corpus of
benches/constants.rs, without link-time optimisation: counts do not depend on it. It takes an hour.
"""

from __future__ import annotations

import csv
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

CONSTANTS = {
    "compliance/convolution/periodic": ["MARGIN"],
    "contact/automatic": ["NO_USE", "GIVEN_UP"],
    "contact/automatic/search": [
        *("FRAME_MARGIN", "COARSE_CELLS", "FRAME_TOLERANCE", "ASPECT_RATIO", "LONG_CONTACT"),
    ],
    "contact/cascade": ["COARSE_TOLERANCE", "GOOD_START", "RETRIES", "COARSEST_CELLS"],
    "contact/problem/patch": ["WINDOW_MARGIN", "LARGEST_PART"],
    "contact/solver/active_set": ["LARGEST_CONTACT", "RENEWALS"],
    "contact/solver/preconditioned": ["PATIENCE", "HALVING"],
    "friction/newton": ["MOST_INNER", "PATIENCE", "DAMPING", "GIVING_UP", "RESTART"],
    "friction/session": ["LOOSE", "START", "LOOSER"],
}
"""Constants by the module of src/ that has them."""
COPIED = ("Cargo.toml", "Cargo.lock", "README.md", "src", "benches")
ROOT = Path(__file__).resolve().parents[1]
FAST = {"LTO": "off", "CODEGEN_UNITS": "16", "INCREMENTAL": "true"}


def main() -> None:
    """Write the table and print it."""
    copy = ROOT / os.environ.get("CARGO_TARGET_DIR", "target") / "constants"
    for name in COPIED:
        part = ROOT / name
        if part.is_dir():
            shutil.copytree(part, copy / name, copy_function=shutil.copy, dirs_exist_ok=True)
        else:
            copy.mkdir(parents=True, exist_ok=True)
            shutil.copy(part, copy / name)
    before = work(copy)
    print("convolutions, cells of chosen grids, not converged:", *before, flush=True)
    rows = [["constant", "value", "halved", "doubled"]]
    for module, names in CONSTANTS.items():
        for name in names:
            file = copy / "src" / f"{module}.rs"
            source = file.read_text()
            pattern = rf"(const {name}: \w+ = )([^;]+)"
            declaration = re.search(pattern, source)
            if declaration is None:
                sys.exit(f"{file.relative_to(copy)} has no constant {name}")
            value = declaration[2]
            two = "2.0" if "." in value or "e" in value else "2"
            changes = []
            for operation in "/*":
                changed = f"{declaration[1]}({value}) {operation} {two}"
                file.write_text(source.replace(declaration[0], changed, 1))
                changes.append(compared(work(copy), before))
            file.write_text(source)
            rows.append([f"{module}: {name}", value, *changes])
            print(*rows[-1], sep=", ", flush=True)
    with (ROOT / "docs" / "constants.csv").open("w", newline="") as table:
        csv.writer(table, lineterminator="\n").writerows(rows)


def work(crate: Path) -> tuple[float, int, int]:
    """Return convolutions, cells of chosen grids, and contacts that did not converge."""
    settings = {f"CARGO_PROFILE_BENCH_{name}": value for name, value in FAST.items()}
    command = ["cargo", "bench", "--quiet", "--bench", "constants"]
    environment = os.environ | settings | {"CARGO_TARGET_DIR": str(crate / "target")}
    done = subprocess.run(command, cwd=crate, env=environment, stdout=subprocess.PIPE, text=True)
    if done.returncode:
        sys.exit(f"{' '.join(command)} has ended with {done.returncode}")
    convolutions, cells, failed = done.stdout.split()
    return float(convolutions), int(cells), int(failed)


def compared(after: tuple[float, int, int], before: tuple[float, int, int]) -> str:
    """Return the work relative to that before, in words."""
    change = after[0] / before[0] - 1
    words = f"{100 * change:+.1f} %" if abs(change) >= 5e-4 else "–"
    if after[1] != before[1]:
        words += f", cells {100 * (after[1] / before[1] - 1):+.1f} %"
    if after[2]:
        words += f", {after[2]} not converged"
    return words


if __name__ == "__main__":
    main()
