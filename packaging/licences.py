"""Write LICENSE-THIRD-PARTY: the licences of all crates that the compiled module contains.

`python packaging/licences.py` needs Cargo, which fetches the sources of the crates, those for other
systems too. With `--check` nothing is written, and the exit status is 1 if the file is not what it
would be. A crate that may be used under one of several licences is used under the MIT licence.
"""

import json
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[1]
NOTICES = ROOT / "LICENSE-THIRD-PARTY"
HEAD = """\
The compiled module of nacre contains the crates below, of which some are for one operating system
only, and the standard library of Rust (MIT OR Apache-2.0, © the contributors of the Rust project),
which is used under the Apache License, Version 2.0, in the file LICENSE-APACHE.
"""
APACHE = """\
These crates come without the text of their licence. They are used under the Apache License,
Version 2.0, in the file LICENSE-APACHE.
"""
RULE = "-" * 80


def linked() -> Iterator[dict[str, Any]]:
    """Yield the crates that are linked into a wheel of any target, as Cargo describes them."""
    wheels = (ROOT / ".github" / "workflows" / "wheels.yml").read_text(encoding="utf-8")
    targets = ["wasm32-unknown-emscripten", *re.findall(r"\btarget: ([\w-]+)", wheels)]
    command = ["cargo", "metadata", "--format-version=1", "--locked", "--features=python"]
    command += [f"--filter-platform={target}" for target in dict.fromkeys(targets)]
    done = subprocess.run(command, cwd=ROOT, check=True, stdout=subprocess.PIPE)
    content = json.loads(done.stdout)
    crates = {crate["id"]: crate for crate in content["packages"]}
    needs = {node["id"]: node["deps"] for node in content["resolve"]["nodes"]}
    root = content["resolve"]["root"]
    known, waiting = {root}, [root]
    while waiting:
        for need in needs[waiting.pop()]:
            name = need["pkg"]
            is_macro = any("proc-macro" in target["kind"] for target in crates[name]["targets"])
            is_normal = any(kind["kind"] is None for kind in need["dep_kinds"])
            if is_normal and not is_macro and name not in known:
                known.add(name)
                waiting.append(name)
                yield crates[name]


def licence(crate: dict[str, Any]) -> str:
    """Return the text of the licence under which a crate is used; empty if it comes without."""
    files = sorted(Path(crate["manifest_path"]).parent.glob("[Ll][Ii][Cc][Ee][Nn][CcSs][Ee]*"))
    chosen = [file for file in files if "mit" in file.name.lower()] or files
    if not chosen and "Apache-2.0" not in crate["license"]:
        raise ValueError(f"{crate['name']} comes without its licence, {crate['license']}")
    return chosen[0].read_text(encoding="utf-8") if chosen else ""


def notices() -> str:
    """Return the file: each text once, below the crates that have it."""
    groups: dict[str, tuple[list[str], str]] = {}
    for crate in sorted(linked(), key=lambda crate: (crate["name"], crate["version"])):
        text = licence(crate) or APACHE
        names, _ = groups.setdefault(" ".join(text.split()), ([], text))
        names.append(f"{crate['name']} {crate['version']} ({crate['license']})\n")
    parts = [f"{RULE}\n{''.join(names)}{RULE}\n\n{text}" for names, text in groups.values()]
    lines = "\n".join([HEAD, *parts]).splitlines()
    return "".join(f"{line.rstrip()}\n" for line in lines)


def main(arguments: list[str]) -> int:
    """Run the command line; return the exit status."""
    text = notices()
    if arguments == ["--check"]:
        if NOTICES.read_text(encoding="utf-8") == text:
            return 0
        print(f"{NOTICES.name} is out of date: run python packaging/licences.py")
        return 1
    NOTICES.write_text(text, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
