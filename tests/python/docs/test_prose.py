"""Five habits that make prose hard to read may become rarer and not more frequent.

`tests/python/docs/prose.json` has the counts. `python tests/python/docs/test_prose.py` writes them;
`python tests/python/docs/test_prose.py GROUP` prints every place of a group, such as docs/howto.
"""

from __future__ import annotations

import ast
import json
import re
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[3]
COUNTS = Path(__file__).with_name("prose.json")
LONG = "30 words and more"
HABITS = {
    "that of, the one": r"\b(?:that|those) of\b"
    r"|\b(?:the|this|each|every) (?!on |of |in )(?:\w+ )?ones?\b"
    r"|\bones\b",
    # "where" after a formula defines its symbols; questions are not statements.
    "where, what": r"\bwhere\b(?! \$)(?![^.!?]*\?)|\bwhat\b(?![^.!?]*\?)",
    "private words": r"\b(?:says?|stands?|bears?|carr(?:y|ies)|coats?|(?<!error )bars?)\b(?!-)"
    r"|\b(?:is|are|was|were) through\b|\bgo(?:es)? on\b|\bbeside\b",
    "is no, too": r"(?<!there )\b(?:is|are|was|were) no\b(?! longer)|, too\b",
}
PATTERNS = {habit: re.compile(pattern, re.IGNORECASE) for habit, pattern in HABITS.items()}

# What is not prose in a page: programs, options of directives, formulas, tables, headings.
FENCE = re.compile(r"^([`~]{3,})(?!\{glossary\}).*?^\1$", re.DOTALL | re.MULTILINE)
NOT_PROSE = re.compile(
    r"^(?:\||#|:\w|:::|```|\(\w+\)=)[^\n]*$|<!--.*?-->", re.MULTILINE | re.DOTALL
)
INDENTED = re.compile(r"(?<=\n\n)(?: {4}[^\n]*\n)+")
DISPLAYED = re.compile(r"\$\$.*?\$\$", re.DOTALL)
FORMULA = re.compile(r"\$[^$]+\$")
CODE = re.compile(r"`[^`]+`")
LINK = re.compile(r"\]\([^)]*\)")
PARAGRAPH = re.compile(r"\n\s*(?:[-*]|\d+\.) |\n\s*\n")
SENTENCE = re.compile(r"(?<=[.!?])(?<!\bal\.)(?<!\beq\.)[)*_\"”]*\s+(?=[^a-z]|nacre\b)")

# Strings of Rust; unit tests are at the end of a file, and comments and attributes of doc are not
# strings. A message has four words or more.
RUST = re.compile(r'//[^\n]*|"((?:\\.|[^"\\])*)"', re.DOTALL)
MESSAGE = re.compile(r"(?:\S+\s+){3}\S")


def prose(page: str) -> Iterator[str]:
    """Yield the sentences of a page."""
    text = DISPLAYED.sub("", NOT_PROSE.sub("", INDENTED.sub("", FENCE.sub("\n\n", page))))
    text = LINK.sub("]", CODE.sub("`code`", FORMULA.sub("$formula$", text)))
    for paragraph in PARAGRAPH.split(text):
        yield from SENTENCE.split(" ".join(paragraph.split()))


def strings_of_python(text: str) -> Iterator[str]:
    """Yield the strings of a module that are not docstrings."""
    tree = ast.parse(text)
    skipped: set[int] = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Expr):
            skipped.add(id(node.value))
        if isinstance(node, ast.JoinedStr):
            skipped |= {id(part) for part in node.values}
            if id(node) not in skipped:
                constants = (getattr(part, "value", None) for part in node.values)
                yield "".join(part if isinstance(part, str) else "{}" for part in constants)
        elif isinstance(node, ast.Constant) and isinstance(node.value, str):
            if id(node) not in skipped:
                yield node.value


def strings_of_rust(text: str) -> Iterator[str]:
    """Yield the strings of a file before its unit tests."""
    for match in RUST.finditer(text.partition("#[cfg(test)]")[0]):
        if match[1]:
            yield re.sub(r"\\\n\s*", "", match[1])


def messages() -> Iterator[tuple[str, str]]:
    for folder, suffix, strings in (
        ("python/nacre", "*.py", strings_of_python),
        ("src", "*.rs", strings_of_rust),
    ):
        for path in sorted((ROOT / folder).rglob(suffix)):
            for string in strings(path.read_text(encoding="utf-8")):
                for sentence in SENTENCE.split(" ".join(string.split())):
                    if MESSAGE.match(sentence):
                        yield str(path.relative_to(ROOT)), sentence


def pages(*paths: Path) -> Iterator[tuple[str, str]]:
    for path in sorted(paths):
        for sentence in prose(path.read_text(encoding="utf-8")):
            yield str(path.relative_to(ROOT)), sentence


def groups() -> dict[str, Iterator[tuple[str, str]]]:
    """Return by group its sentences with their files."""
    docs = ROOT / "docs"
    return {
        "README.md": pages(ROOT / "README.md"),
        "CONTRIBUTING.md": pages(ROOT / "CONTRIBUTING.md"),
        "docs": pages(*docs.glob("*.md"), *docs.glob("limits/*.md")),
        "docs/howto": pages(*docs.glob("howto/*.md")),
        "docs/theory": pages(*docs.glob("theory/*.md")),
        "messages": messages(),
    }


def found(sentence: str) -> Iterator[str]:
    """Yield a habit for each time that a sentence has it."""
    for habit, pattern in PATTERNS.items():
        yield from (habit for _ in pattern.finditer(sentence))
    if sum(any(c.isalnum() for c in word) for word in sentence.split()) >= 30:
        yield LONG


def count(sentences: Iterator[tuple[str, str]]) -> dict[str, int]:
    counts = dict.fromkeys((*HABITS, LONG), 0)
    for _, sentence in sentences:
        for habit in found(sentence):
            counts[habit] += 1
    return counts


@pytest.mark.parametrize("group", groups())
def test_the_habits_become_rarer(group: str) -> None:
    allowed = json.loads(COUNTS.read_text(encoding="utf-8"))[group]
    counts = count(groups()[group])
    assert counts.keys() == allowed.keys()
    risen = {habit: n for habit, n in counts.items() if n > allowed[habit]}
    assert not risen, f"rewrite the new sentences of {group}; this file, run with it, lists them"
    fallen = {habit: n for habit, n in counts.items() if n < allowed[habit]}
    assert not fallen, f"well done: lower these counts of {group} in tests/python/docs/prose.json"


@pytest.mark.parametrize(
    ("sentence", "habits"),
    [
        ("Its pressure is that of a sphere, and the last one counts.", ["that of, the one"] * 2),
        ("It warns where the film is thin.", ["where, what"]),
        ("Where do rates come from?", []),
        ("This is $a = b$, where $b$ is the radius.", []),
        ("The coat is through, and wear goes on.", ["private words"] * 3),
        ("The error bar is small; the bar is 5 %.", ["private words"]),
        ("There is no warning, and each on one thread.", []),
        ("This is no limit, too.", ["is no, too"] * 2),
        ("A word " * 15, [LONG]),
        ("The load is carried by the last ball of the row.", []),
    ],
)
def test_a_sentence_has_these_habits(sentence: str, habits: list[str]) -> None:
    assert list(found(sentence)) == habits


def test_a_page_without_its_programs_formulas_and_tables_is_prose() -> None:
    page = """# What is where?

The load `what = 1` is
1 N. It is [known](where.md).

```python
what = "that of"
```

| what | where |

- where $what$ is
"""
    assert [sentence for sentence in prose(page) if sentence] == [
        "The load `code` is 1 N.",
        "It is [known].",
        "where $formula$ is",
    ]


def test_messages_are_found_in_both_languages() -> None:
    python = '"""No."""\ndef f(x):\n    """No."""\n    raise ValueError(f"a {x} b" "c")\n'
    assert list(strings_of_python(python)) == ["a {} bc"]
    rust = '// "no"\n#[error("a \\\n    b")] "c"\n#[cfg(test)] mod tests { "no" }'
    assert list(strings_of_rust(rust)) == ["a b", "c"]


if __name__ == "__main__":
    if sys.argv[1:]:
        for path, sentence in groups()[sys.argv[1]]:
            if habits := list(found(sentence)):
                print(f"{path}: {', '.join(habits)}: {sentence}")
    else:
        table = {group: count(sentences) for group, sentences in groups().items()}
        COUNTS.write_text(json.dumps(table, indent=2) + "\n", encoding="utf-8")
