"""Check the rules of the house that no compiler knows; `make check` runs this.

`python tests/house.py [ROOT]` prints each violation as `path:line: message`, and exits with 1 if
there is one. The rules:

1. Circles. No file needs an item of another file that needs, directly or through others, an item of
   the first.
2. Order. A module of `src/` imports only from modules before it in `CHAIN`.

A Rust file needs each item that it imports or names by a path through `crate`, `super`, `self` or a
module. The item counts where it is defined: re-exports are followed, so that a module that only
declares its children and re-exports their items (`pub use`, `#[pymodule_export]`) is in no circle
with them. A module that uses an item of a child, which uses an item of the module, is in one. Unit
tests do not count; inherent methods, which need no import, are not seen.

A Python file needs each module of nacre that it imports, also inside a function, where an import is
only late, and not under `TYPE_CHECKING`. `from nacre.a import b` needs `nacre.a` (or `nacre.a.b`,
where that is a module), and not the packages above.
"""

import ast
import re
import sys
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import NamedTuple

CHAIN = [
    *("error", "numerics", "model", "compliance", "contact"),
    *("stress", "friction", "indent", "gradient", "data", "python"),
]

# Comments, strings and characters of Rust; a lifetime is not a character.
QUIET = re.compile(
    r'//[^\n]*|/\*.*?\*/|r(#*)".*?"\1|"(?:\\.|[^"\\])*"|\'(?:\\[^\'\n]+|[^\'\\\n])\'', re.DOTALL
)
USE = re.compile(r"(\bpub(?:\s*\([^)]*\))?\s+|#\[pymodule_export\]\s*)?\buse\s+([^;]+);")
INLINE = re.compile(r"(#\[cfg\(test\)\]\s*)?(?:pub(?:\([^)]*\))?\s+)?mod\s+\w+\s*\{")
TEST_FILE = re.compile(r"#\[cfg\(test\)\]\s*mod\s+(\w+)\s*;")
NAMED = re.compile(r"(?<![\w:$])(?:\w+::)+\w+")

Module = tuple[str, ...]


class Violation(NamedTuple):
    """A rule that a line of a file breaks."""

    path: str
    line: int
    message: str


class Need(NamedTuple):
    """An item of the file `target` that the file `source` uses."""

    source: str
    target: str
    line: int


class Import(NamedTuple):
    """One name that a `use` brings in: `segments` as written, `levels` of inline modules around."""

    segments: Module
    name: str
    line: int
    public: bool
    levels: int


def blank(text: str) -> str:
    """Return spaces in place of `text`, on as many lines."""
    return re.sub(r"[^\n]", " ", text)


def files_below(root: Path, folders: Iterable[str], suffixes: set[str]) -> Iterator[Path]:
    """Yield the files of these suffixes in these folders of `root`, sorted, each once."""
    found = {path for folder in folders for path in (root / folder).rglob("*")}
    yield from sorted(path for path in found if path.suffix in suffixes)


# Rust's imports


def tree(text: str, before: Module = ()) -> Iterator[tuple[Module, str]]:
    """Yield the paths of a `use` tree and the names that they are known by."""
    text = text.strip()
    if "{" in text:
        start, _, rest = text.partition("{")
        before = (*before, *(part for part in re.split(r"::|\s+", start) if part))
        depth, item = 0, ""
        for character in rest[: rest.rindex("}")] + ",":
            depth += (character == "{") - (character == "}")
            if character == "," and depth == 0:
                yield from tree(item, before)
                item = ""
            else:
                item += character
    elif text:
        path, _, alias = re.sub(r"\s+", " ", text).partition(" as ")
        parts = (*before, *path.replace(" ", "").split("::"))
        parts = parts[:-1] if parts[-1] == "self" and len(parts) > 1 else parts
        yield parts, alias or parts[-1]


class RustFile:
    """One file of the crate: its module, its imports, and its text without those and unit tests."""

    def __init__(self, name: str, module: Module, text: str) -> None:
        self.name = name
        self.module = module
        self.tests = set(TEST_FILE.findall(text))
        text = QUIET.sub(lambda match: blank(match[0]), text)
        self.inline: list[range] = []
        for match in INLINE.finditer(text):
            block = range(match.start(), self.end_of_block(text, match.end()))
            if match[1]:
                text = (
                    text[: block.start] + blank(text[block.start : block.stop]) + text[block.stop :]
                )
            else:
                self.inline.append(block)
        self.imports = [
            Import(path, alias, line, bool(match[1]), self.levels(match.start()))
            for match in USE.finditer(text)
            for line in [text.count("\n", 0, match.start(2)) + 1]
            for path, alias in tree(match[2])
        ]
        self.body = USE.sub(lambda match: blank(match[0]), text)
        self.body = re.sub(r"\bpub\s*\([^)]*\)", lambda match: blank(match[0]), self.body)

    @staticmethod
    def end_of_block(text: str, start: int) -> int:
        """Return where the block ends whose opening brace is before `start`."""
        depth = 1
        for match in re.compile(r"[{}]").finditer(text, start):
            depth += 1 if match[0] == "{" else -1
            if depth == 0:
                return match.end()
        return len(text)

    def levels(self, position: int) -> int:
        """Return how many inline modules are around a position."""
        return sum(position in block for block in self.inline)

    def defines(self, name: str) -> bool:
        """Return whether an item of this name is defined here."""
        words = r"\b(?:fn|struct|enum|trait|type|const|static|union|macro_rules!)\s+"
        return re.search(rf"{words}{re.escape(name)}\b", self.body) is not None


class Crate:
    """The files of a crate by module, and the items that they need of each other."""

    def __init__(self, root: Path) -> None:
        self.files: dict[Module, RustFile] = {}
        for path in files_below(root, ["src"], {".rs"}):
            module = path.relative_to(root / "src").with_suffix("").parts
            module = () if module == ("lib",) else module
            text = path.read_text(encoding="utf-8")
            self.files[module] = RustFile(path.relative_to(root).as_posix(), module, text)
        for file in list(self.files.values()):
            for test in file.tests:
                self.files.pop((*file.module, test), None)

    def defining(self, module: Module, path: Module, seen: frozenset[Module]) -> Module | None:
        """Return the module that defines what `path`, counted from `module`, names."""
        while path and (*module, path[0]) in self.files:
            module, path = (*module, path[0]), path[1:]
        if module not in self.files:
            return None
        file = self.files[module]
        if not path or file.defines(path[0]) or (*module, *path) in seen:
            return module
        seen |= {(*module, *path)}
        for item in file.imports:
            if item.name == path[0] and item.levels == 0:
                return self.target(file, (*item.segments, *path[1:]), 0, seen)
        for item in file.imports:
            if item.name == "*":
                found = self.target(file, (*item.segments[:-1], *path), 0, seen)
                if found is not None and self.files[found].defines(path[0]):
                    return found
        return module

    def target(
        self, file: RustFile, path: Module, levels: int, seen: frozenset[Module] = frozenset()
    ) -> Module | None:
        """Return the module that defines what `path` names in `file`; none of another crate's."""
        first = path[0]
        if first == "crate":
            return self.defining((), path[1:], seen)
        if first in ("self", "super"):
            ups = [part for part in path if part == "super"]
            path = tuple(part for part in path if part not in ("self", "super"))
            above = len(file.module) - max(len(ups) - levels, 0)
            return self.defining(file.module[:above], path, seen)
        if (*file.module, first) in self.files:
            return self.defining(file.module, path, seen)
        for item in file.imports:
            if item.name == first and item.segments[0] != first:
                return self.target(file, (*item.segments, *path[1:]), item.levels, seen)
        return None

    def needs(self) -> Iterator[Need]:
        """Yield what each file needs of others."""
        for file in self.files.values():
            found = []
            for item in file.imports:
                name = re.escape(item.name)
                used = re.search(rf"(?<!fn )(?<!mod )(?<![.\w:]){name}\b", file.body)
                target = self.target(file, item.segments, item.levels)
                below = target is not None and target[: len(file.module)] == file.module
                # A module is imported for the items that paths through it name.
                module = target is not None and target[-1:] == item.segments[-1:]
                through = module and re.search(rf"(?<![.\w:]){name}::", file.body)
                if not through and not (item.public and below and not used):
                    found.append((target, item.line))
                if item.name == "*" and target is not None:
                    for other in self.files[target].imports:
                        if re.search(rf"\b{re.escape(other.name)}\b", file.body):
                            path = (*item.segments[:-1], other.name)
                            found.append((self.target(file, path, item.levels), item.line))
            for match in NAMED.finditer(file.body):
                target = self.target(file, tuple(match[0].split("::")), file.levels(match.start()))
                found.append((target, file.body.count("\n", 0, match.start()) + 1))
            for target, line in found:
                if target is not None and target != file.module:
                    yield Need(file.name, self.files[target].name, line)


def order(needs: Iterable[Need], files: Iterable[str]) -> Iterator[Violation]:
    """Yield modules of `src/` that are not in the chain, and imports from later ones."""
    place = {module: index for index, module in enumerate(CHAIN)}

    def top(path: str) -> str:
        return Path(path).parts[1].removesuffix(".rs")

    for path in files:
        if top(path) != "lib" and top(path) not in place:
            yield Violation(
                path, 1, f"the module {top(path)} is not in the chain of tests/house.py"
            )
    for need in needs:
        earlier, later = place.get(top(need.source)), place.get(top(need.target))
        if earlier is not None and (later is None or later > earlier):
            message = f"{top(need.source)} imports from {top(need.target)}, which comes later"
            yield Violation(need.source, need.line, message)


# Python's imports


def python_needs(root: Path) -> Iterator[Need]:
    """Yield what the modules of `python/nacre` need of each other."""
    folder = root / "python"
    paths = {}
    for path in files_below(root, ["python/nacre"], {".py"}):
        parts = path.relative_to(folder).with_suffix("").parts
        name = ".".join(parts[:-1] if parts[-1] == "__init__" else parts)
        paths[name] = path
    for name, path in paths.items():
        package = name if path.stem == "__init__" else name.rpartition(".")[0]
        for node in imports(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Import):
                targets = {alias.name for alias in node.names}
            else:
                start = package.split(".")
                start = start[: len(start) - node.level + 1] if node.level else []
                module = ".".join([*start, *([node.module] if node.module else [])])
                names = [f"{module}.{alias.name}" for alias in node.names]
                targets = {full if full in paths else module for full in names}
            for target in sorted(targets & paths.keys() - {name}):
                source, needed = (paths[n].relative_to(root).as_posix() for n in (name, target))
                yield Need(source, needed, node.lineno)


def imports(node: ast.AST) -> Iterator[ast.Import | ast.ImportFrom]:
    """Yield the import statements of a module, but those for type checkers."""
    for child in ast.iter_child_nodes(node):
        if isinstance(child, ast.Import | ast.ImportFrom):
            yield child
        elif isinstance(child, ast.If) and "TYPE_CHECKING" in ast.unparse(child.test):
            yield from (
                found for other in child.orelse for found in imports(ast.Module([other], []))
            )
        else:
            yield from imports(child)


# Circles


def shortest(graph: dict[str, dict[str, int]], start: str) -> list[str] | None:
    """Return the shortest way from `start` back to it."""
    ways, seen = [[start]], set()
    while ways:
        way = ways.pop(0)
        for target in sorted(graph.get(way[-1], {})):
            if target == start:
                return way
            if target not in seen:
                seen.add(target)
                ways.append([*way, target])
    return None


def circles(needs: Iterable[Need]) -> Iterator[Violation]:
    """Yield the shortest circle through each file that is in one, each once."""
    graph: dict[str, dict[str, int]] = {}
    for need in needs:
        graph.setdefault(need.source, {}).setdefault(need.target, need.line)
    told = set()
    for start in sorted(graph):
        circle = shortest(graph, start)
        if circle is not None and frozenset(circle) not in told:
            told.add(frozenset(circle))
            way = " → ".join([*circle, start])
            line = graph[start][[*circle, start][1]]
            yield Violation(start, line, f"files import each other: {way}")


def violations(root: Path) -> list[Violation]:
    """Return every violation in the tree at `root`."""
    crate = Crate(root)
    rust, python = list(crate.needs()), list(python_needs(root))
    found = [*circles(rust), *circles(python)]
    found += order(rust, [file.name for file in crate.files.values()])
    return sorted(set(found))


def main() -> int:
    """Print the violations; return 1 if there is one."""
    root = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parents[1]
    found = violations(root)
    for path, line, message in found:
        print(f"{path}:{line}: {message}")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
