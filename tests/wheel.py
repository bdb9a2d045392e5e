"""Check wheels: `python tests/wheel.py WHEEL...` prints what is wrong, and exits with 1 if any is.

The compiled module must not name a home folder. It names the sources of other crates, and
`--remap-path-prefix` replaces Cargo's folder there. The licences of nacre and of those crates must
be in the wheel.
"""

import os
import re
import sys
from collections.abc import Iterator
from pathlib import Path
from zipfile import ZipFile

ROOT = Path(__file__).parents[1]
HOMES = rb"/root|/home/[^/\0]+|/Users/[^/\0]+|[A-Z]:\\Users\\[^\\\0]+"
"""Home folders of those who build, in containers and on the machines of workflows too."""


def violations(path: Path) -> Iterator[str]:
    """Yield what is wrong with a wheel."""
    own = re.escape(os.fsencode(Path.home()))
    folder = re.compile(rb"(?:%s|%s)[/\\][ -~]{0,60}" % (HOMES, own))
    with ZipFile(path) as wheel:
        modules = [name for name in wheel.namelist() if name.endswith((".so", ".pyd"))]
        if len(modules) != 1:
            yield f"{path.name}: must have one compiled module, got {modules}"
        for name in modules:
            for found in sorted(set(folder.findall(wheel.read(name))))[:3]:
                yield f"{path.name}: {name} names a home folder, {os.fsdecode(found)}"
        licences = {
            Path(name).name: wheel.read(name)
            for name in wheel.namelist()
            if ".dist-info/licenses/" in name
        }
        for licence in sorted(ROOT.glob("LICENSE-*")):
            if licences.get(licence.name) != licence.read_bytes():
                yield f"{path.name}: must have {licence.name}"


def main(arguments: list[str]) -> int:
    """Run the command line; return the exit status."""
    wrong = [text for path in map(Path, arguments) for text in violations(path)]
    print(*wrong, sep="\n", end="\n" if wrong else "")
    return int(bool(wrong))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
