"""Recompute reference numbers, all or those of the generators named; compare them with the files.

python tests/data/make [--write] [GENERATOR ...]; without --write, the files stay as they are.
"""

import importlib
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).parent


def generators():
    """Names of the modules that fill a file."""
    texts = {path.stem: path.read_text(encoding="utf-8") for path in sorted(HERE.glob("*.py"))}
    return [name for name, text in texts.items() if "\ndef fill(" in text]


def main():
    words = sys.argv[1:]
    options = [word for word in words if word.startswith("-")]
    names = [word for word in words if word not in options] or generators()
    if unknown := sorted(set(names) - set(generators())):
        sys.exit(f"no such generator: {', '.join(unknown)}")
    sys.path.insert(0, str(HERE))
    seconds = {name: importlib.import_module(name).SECONDS for name in names}
    total = sum(seconds.values()) / 60
    print(f"{len(names)} generators, about {total:.0f} minutes")
    failed = []
    for name in sorted(names, key=seconds.get):
        if subprocess.run(
            [sys.executable, str(HERE / f"{name}.py"), *options], check=False
        ).returncode:
            failed.append(name)
    if failed:
        sys.exit(f"failed, or off by more than the stated error: {', '.join(failed)}")


if __name__ == "__main__":
    main()
