"""Check the modules of `src/`: their order, no circle of files, and their table, for `make check`.

`python tests/house.py [ROOT]` prints what is wrong, and exits with 1 if anything is. A file needs
each item that it imports or names by a path. An item counts where it is defined: re-exports are
followed, so that a module which only declares its children and re-exports their items is in no
circle with them. Unit tests do not count; inherent methods, which need no import, are not seen.
"""

import re
import sys
from collections.abc import Iterator
from graphlib import CycleError, TopologicalSorter
from pathlib import Path
from typing import NamedTuple

CHAIN = [
    *("builders", "error", "numerics", "model", "compliance", "contact"),
    *("conductance", "stress", "fatigue", "friction", "wear", "indent", "gradient", "python"),
]
"""Modules; each imports only from those before it."""

# Comments, strings and characters of Rust; a lifetime is not a character.
QUIET = re.compile(
    r'//[^\n]*|/\*.*?\*/|r(#*)".*?"\1|"(?:\\.|[^"\\])*"|\'(?:\\[^\'\n]+|[^\'\\\n])\'', re.DOTALL
)
TESTS = re.compile(r"#\[cfg\(test\)\]\s*(?:mod\s+(\w+)\s*;|mod\s+\w+\s*\{.*?^\})", re.DOTALL | re.M)
INLINE = re.compile(r"^(?:pub\(\w+\) )?mod \w+ \{(.*?)^\}", re.DOTALL | re.MULTILINE)
USE = re.compile(r"(\bpub(?:\s*\([^)]*\))?\s+|#\[pymodule_export\]\s*)?\buse\s+([^;]+);")
GROUP = re.compile(r"([\w:]*)\{([^{}]*)\}")
NAMED = re.compile(r"(?<![\w:$])(?:\w+::)+\w+")
ITEM = r"\b(?:fn|struct|enum|trait|type|const|static|union|macro_rules!)\s+"

Names = tuple[str, ...]


class Import(NamedTuple):
    """A name that a `use` brings in."""

    name: str
    path: Names
    public: bool


class File:
    """A file of the crate: its imports, and its text without those and without unit tests."""

    def __init__(self, text: str) -> None:
        text = QUIET.sub("", text)
        self.tests = [match[1] for match in TESTS.finditer(text) if match[1]]
        text = INLINE.sub(lambda match: match[1].replace("super::", "self::"), TESTS.sub("", text))
        self.imports = [
            Import(alias or path.split("::")[-1], tuple(path.split("::")), bool(match[1]))
            for match in USE.finditer(text)
            for path, _, alias in (one.partition(" as ") for one in expanded(match[2]))
        ]
        self.body = re.sub(r"\bpub\s*\([^)]*\)", "", USE.sub("", text))

    def defines(self, name: str) -> bool:
        """Return whether an item of this name is defined here."""
        return re.search(rf"{ITEM}{re.escape(name)}\b", self.body) is not None

    def uses(self, name: str, after: str = r"\b") -> bool:
        """Return whether the text has this name, outside of a path."""
        return (
            re.search(rf"(?<!fn )(?<!mod )(?<![.\w:]){re.escape(name)}{after}", self.body)
            is not None
        )


def expanded(use: str) -> list[str]:
    """Return the paths of a `use` tree."""
    use = re.sub(r"\s*(::|[{},])\s*", r"\1", " ".join(use.split()))
    while group := GROUP.search(use):
        inner = ",".join(group[1] + one for one in group[2].split(",") if one)
        use = use[: group.start()] + inner + use[group.end() :]
    return [one.replace("::self", "") for one in use.split(",") if one]


class Crate:
    """The files of a crate by module."""

    def __init__(self, src: Path) -> None:
        modules = {path.relative_to(src).with_suffix("").parts: path for path in src.rglob("*.rs")}
        self.paths = {() if name == ("lib",) else name: path for name, path in modules.items()}
        self.files = {name: File(path.read_text("utf-8")) for name, path in self.paths.items()}
        for name, file in list(self.files.items()):
            for test in file.tests:
                self.files.pop((*name, test), None)

    def home(self, module: Names, path: Names, depth: int = 9) -> Names | None:
        """Return the module that defines what `path` names in `module`; none of another crate."""
        if path[0] == "crate":
            module, path = (), path[1:]
        elif path[0] in ("self", "super"):
            while path and path[0] in ("self", "super"):
                module, path = module[:-1] if path[0] == "super" else module, path[1:]
        elif (*module, path[0]) not in self.files:
            for item in self.files[module].imports:
                if item.name == path[0] != item.path[0] and depth:
                    return self.home(module, (*item.path, *path[1:]), depth - 1)
            return None
        while path and (*module, path[0]) in self.files:
            module, path = (*module, path[0]), path[1:]
        if module not in self.files:
            return None
        if path and depth and not self.files[module].defines(path[0]):
            for item in self.files[module].imports:
                if item.name == path[0]:
                    return self.home(module, (*item.path, *path[1:]), depth - 1)
        return module

    def needs(self, module: Names) -> Iterator[Names]:
        """Yield the modules whose items a module uses."""
        file = self.files[module]
        found = [tuple(match[0].split("::")) for match in NAMED.finditer(file.body)]
        for item in file.imports:
            home = self.home(module, item.path)
            below = home is not None and home[: len(module)] == module
            named = home is not None and home[-1:] == item.path[-1:]  # a module, for its items
            if not (named and file.uses(item.name, "::")) and (
                not (item.public and below) or file.uses(item.name)
            ):
                found.append(item.path)
        homes = {self.home(module, path) for path in found}
        yield from (home for home in homes if home is not None and home != module)


def missing_in_table(library: str) -> Iterator[str]:
    """Yield the modules of the text of `lib.rs` that the table of its documentation leaves out."""
    table = "\n".join(re.findall(r"^//! \| .*", library, re.MULTILINE))
    rows = set(re.findall(r"^//! \| (\w+) \|", table, re.MULTILINE))
    links = set(re.findall(r"\[`(?:mod@)?(\w+)`\]", table))
    for public, module in re.findall(r"^(pub )?mod (\w+);", library, re.MULTILINE):
        if module not in rows | {"python"} or (public and module not in links):
            yield module
    for names in re.findall(r"^pub use (?:\w+)::\{([a-z_, ]+)\};", library, re.MULTILINE):
        yield from (name for name in names.split(", ") if name not in links)


def violations(root: Path) -> Iterator[str]:
    """Yield what is wrong in the crate at `root`."""
    crate = Crate(root / "src")
    for module in missing_in_table((root / "src" / "lib.rs").read_text("utf-8")):
        yield f"{module}: not in the table of modules of src/lib.rs"
    graph = {module: sorted(crate.needs(module)) for module in sorted(crate.files)}
    for module, needs in graph.items():
        if module and module[0] not in CHAIN:
            yield f"{'::'.join(module)}: not a module of the chain in tests/house.py"
        for need in needs if module else []:
            if not need or need[0] not in CHAIN[: CHAIN.index(module[0]) + 1]:
                yield f"{'::'.join(module)} imports from {'::'.join(need)}, which comes later"
    try:
        TopologicalSorter(graph).prepare()
    except CycleError as error:
        yield "files import each other: " + " ← ".join("::".join(one) for one in error.args[1])


if __name__ == "__main__":
    wrong = list(violations(Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).parents[1])))
    print(*wrong, sep="\n", end="\n" if wrong else "")
    sys.exit(bool(wrong))
