"""Check what the project says of itself in several places, and make links of README absolute.

`python tests/metadata.py` prints what disagrees, and exits with 1 if anything does. `repository` in
Cargo.toml is the address of the project; as long as it is the placeholder, this is said, and is an
error with `--release`. `--links README.md` rewrites the file for package indexes, whose pages have
no files beside them.
"""

import re
import sys
import tomllib
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).parents[1]
PLACEHOLDER = "https://project-url.invalid/nacre"
"""Address until there is one; .invalid never becomes a domain (RFC 2606)."""
LINK = re.compile(r"(!\[[^\]]*\]|\])\((?!https?://|#)([^)\s]+)\)")
"""The end of a link, which may be around a picture, or a picture; with the path."""


def address(root: Path = ROOT) -> str:
    """Return the address of the project, PROJECT_URL."""
    return str(package(root)["repository"])


def package(root: Path) -> dict[str, str | list[str]]:
    """Return the table of the package in Cargo.toml."""
    content = tomllib.loads((root / "Cargo.toml").read_text(encoding="utf-8"))
    return dict(content["package"])


def absolute(text: str, url: str, version: str) -> str:
    """Return Markdown whose relative links and pictures lead to files of a version."""

    def replaced(match: re.Match[str]) -> str:
        before, path = match.groups()
        kind = "raw" if before.startswith("!") else "blob"
        return f"{before}({url}/{kind}/v{version}/{path})"

    return LINK.sub(replaced, text)


def violations(root: Path = ROOT) -> Iterator[str]:
    """Yield what disagrees."""
    cargo, url = package(root), address(root)
    project = tomllib.loads((root / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    citation = (root / "CITATION.cff").read_text(encoding="utf-8")
    changes = (root / "CHANGELOG.md").read_text(encoding="utf-8")
    version = str(cargo["version"])

    for name, stated in project["urls"].items():
        if not stated.startswith(url):
            yield f"pyproject.toml: the address of {name} must begin with {url}, got {stated}"
    for name, text in (
        ("CITATION.cff", citation),
        ("SECURITY.md", (root / "SECURITY.md").read_text(encoding="utf-8")),
        *(
            (str(p.relative_to(root)), p.read_text("utf-8"))
            for p in root.glob("packaging/**/*.y*ml")
        ),
    ):
        if url not in text:
            yield f"{name}: must name {url}, which Cargo.toml does"

    def cited(key: str) -> str | None:
        match = re.search(rf"^{key}: (.+)$", citation, flags=re.MULTILINE)
        return match[1] if match else None

    released = re.findall(r"^## \[(\d[^\]]*)\]", changes, flags=re.MULTILINE)
    if version.endswith("-dev"):  # the state after a release, which is the one to cite
        if version.removesuffix("-dev") in released:
            yield f"Cargo.toml: version must be after {released[0]}, got {version}"
        version = released[0]
    if cited("version") != version:
        yield f"CITATION.cff: version must be {version}, got {cited('version')}"
    dated = re.search(rf"^## \[{re.escape(version)}\] - (\S+)$", changes, flags=re.MULTILINE)
    if cited("date-released") != (dated[1] if dated else None):
        yield f"CITATION.cff: date-released must be {dated and dated[1]}, that of CHANGELOG.md"
    authors = [str(one["name"]) for one in project["authors"]]
    if authors != cargo["authors"]:
        yield f"pyproject.toml: authors must be {cargo['authors']}, got {authors}"
    before = citation.partition("references:")[0]
    names = re.findall(r"^  - name: (.+)$", before, flags=re.MULTILINE)
    if names != authors:
        yield f"CITATION.cff: authors must be {authors}, got {names}"


def main(arguments: list[str]) -> int:
    """Run the command line; return the exit status."""
    if arguments[:1] == ["--links"]:
        for path in map(Path, arguments[1:]):
            text = path.read_text(encoding="utf-8")
            version = str(package(ROOT)["version"])
            path.write_text(absolute(text, address(), version), encoding="utf-8")
        return 0
    wrong = list(violations())
    if address() == PLACEHOLDER:
        note = f"Cargo.toml: repository is the placeholder {PLACEHOLDER}: replace it everywhere"
        if arguments == ["--release"]:
            wrong.append(note)
        else:
            print(f"note: {note} before a release")
    print(*wrong, sep="\n", end="\n" if wrong else "")
    return int(bool(wrong))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
