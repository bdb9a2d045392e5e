"""A virtual environment of its own, with nacre's wheel and the other programs.

It needs the standard library alone: it runs before anything is installed.
"""

from __future__ import annotations

import json
import subprocess
import sys
import venv
from pathlib import Path

PEERS = {"Tamaas": "tamaas", "ContactMechanics": "ContactMechanics", "ASPHER": "aspher"}
NEEDS = {"ASPHER": "it is compiled: it needs a C++17 compiler, and Eigen 3.4 or a network"}


def prepare(folder: Path, wheels: Path) -> Path:
    """Return the Python of the environment in `folder`, made and filled where it is not yet.

    Raises
    ------
    SystemExit
        Where nacre, SciPy or matplotlib cannot be installed.
    """
    python = folder / "bin" / "python"
    if not python.exists():
        venv.create(folder, with_pip=True)
    found = sorted(wheels.glob("nacre_contact-*.whl"), key=lambda wheel: wheel.stat().st_mtime)
    if not found:
        raise SystemExit(f"peers: no wheel of nacre in {wheels}; make peers builds it")
    wanted = ["scipy", "matplotlib", str(found[-1])]
    if problem := pip(python, *wanted) or pip(python, "--force-reinstall", "--no-deps", wanted[-1]):
        raise SystemExit(f"peers: {problem}")
    for program, package in PEERS.items():
        if installed(python, package):
            continue
        print(f"installing {program}", flush=True)
        if problem := pip(python, package):
            reason = f" ({NEEDS[program]})" if program in NEEDS else ""
            print(f"{program} cannot be installed here{reason}: {problem}", flush=True)
    return python


def installed(python: Path, package: str) -> bool:
    """Whether the environment has a package."""
    command = [str(python), "-m", "pip", "show", "--quiet", package]
    return subprocess.run(command, capture_output=True).returncode == 0


def pip(python: Path, *wanted: str) -> str:
    """Install; return the last line of the complaint, nothing where there is none."""
    command = [str(python), "-m", "pip", "install", "--quiet", *wanted]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode == 0:
        return ""
    errors = [line for line in done.stderr.splitlines() if "error" in line.lower()]
    return (errors or done.stderr.splitlines() or ["pip failed"])[-1].strip()


def convolution_binary(target: Path) -> Path | None:
    """Build `benches/convolution.rs`; None where Cargo is not there."""
    command = ["cargo", "bench", "--bench", "convolution", "--no-run", "--message-format=json"]
    command += ["--target-dir", str(target)]
    try:
        done = subprocess.run(command, stdout=subprocess.PIPE, text=True)
    except FileNotFoundError:
        print("no cargo: nacre's convolution is not timed by itself", file=sys.stderr)
        return None
    lines = (json.loads(line) for line in done.stdout.splitlines())
    built = [line["executable"] for line in lines if line.get("executable")]
    return Path(built[-1]) if built else None
