"""``make peers``: prepares an environment of its own, and goes on in it."""

from __future__ import annotations

import argparse
import os
from pathlib import Path

from peers.install import convolution_binary, prepare

ROOT = Path(__file__).parents[2]


def main() -> None:
    """Prepare, then become `peers.run`."""
    parser = argparse.ArgumentParser(prog="python -m peers", description=__doc__)
    parser.add_argument("--target", type=Path, default=ROOT / "target", help="Cargo's folder")
    options, rest = parser.parse_known_args()
    target = options.target.resolve()
    # The environment is made anew from a Python that may itself be that of another one.
    for variable in ("VIRTUAL_ENV", "PYTHONHOME"):
        os.environ.pop(variable, None)
    python = prepare(target / "peers" / "venv", target / "wheels")
    arguments = [str(python), "-m", "peers.run", "--work", str(target / "peers")]
    if (binary := convolution_binary(target)) is not None:
        arguments += ["--convolution", str(binary)]
    os.environ["PYTHONPATH"] = str(ROOT / "benches")
    os.execv(python, [*arguments, *rest])


if __name__ == "__main__":
    main()
