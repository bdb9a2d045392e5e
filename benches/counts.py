"""Count the work of the cases of benches/counts.rs under Valgrind: benches/counts.csv.

Usage: python3 benches/counts.py [--compare]

The table has one row for each case and release; a run replaces those of the version that is not
released. With --compare nothing is written, and the run fails where a count has risen by more than
2 % over the newest release of the table. Instructions depend on the tools that the table names, and
are compared where these are the same; convolutions depend on the code alone, and always are.
"""

from __future__ import annotations

import argparse
import csv
import json
import os
import platform
import re
import shutil
import subprocess
import sys
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
TABLE = ROOT / "benches" / "counts.csv"
COLUMNS = ["release", "date", "case", "instructions", "convolutions", "tools"]
BAR = 0.02
"""Largest part by which a count may rise."""
NEXT = "next"
"""What the version that is not released is called in the table."""
VALGRIND = ("valgrind", "--tool=cachegrind", "--cache-sim=no", "--cachegrind-out-file=/dev/null")


@dataclass(frozen=True)
class Work:
    """Counts of a case; None where they are not known."""

    instructions: int | None
    convolutions: float | None


Counts = dict[str, Work]


def release(changelog: str) -> str:
    """Return the version on top of a changelog, or `NEXT` where it is not released."""
    name = re.search(r"^## \[(.+?)\]", changelog, re.MULTILINE)
    return NEXT if name is None or name[1] == "Unreleased" else name[1]


def read(table: Path) -> list[dict[str, str]]:
    """Return the rows of a table, the oldest release first."""
    if not table.exists():
        return []
    with table.open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def recorded(rows: list[dict[str, str]]) -> tuple[str, Counts]:
    """Return the tools and the counts of the newest release."""
    newest = [row for row in rows if row["release"] == rows[-1]["release"]]
    counts = {
        row["case"]: Work(
            int(row["instructions"]) if row["instructions"] else None,
            float(row["convolutions"]) if row["convolutions"] else None,
        )
        for row in newest
    }
    return newest[-1]["tools"], counts


def replaced(
    rows: list[dict[str, str]], name: str, date: str, tools: str, counts: Counts
) -> list[dict[str, str]]:
    """Return the rows with those of a release anew, which stand for the version before it."""
    kept = [row for row in rows if row["release"] not in (name, NEXT)]
    for case, work in counts.items():
        numbers = ["" if count is None else str(count) for count in astuple(work)]
        kept.append(dict(zip(COLUMNS, [name, date, case, *numbers, tools], strict=True)))
    return kept


def astuple(work: Work) -> tuple[float | None, float | None]:
    """Return instructions and convolutions."""
    return work.instructions, work.convolutions


def compared(before: Counts, now: Counts) -> tuple[list[str], list[str]]:
    """Return a line for each case, and what is wrong: counts that have risen, cases that differ."""
    lines = []
    wrong = [
        f"{case}: not in both"
        for case in dict.fromkeys([*before, *now])
        if case not in before or case not in now
    ]
    for case, work in now.items():
        words = []
        for name, old, new in zip(
            ("instructions", "convolutions"),
            astuple(before.get(case, Work(None, None))),
            astuple(work),
            strict=True,
        ):
            if new is None:
                continue
            words.append(
                f"{name} {new:.4g}" + (f" ({100 * (new / old - 1):+.2f} %)" if old else "")
            )
            if old and new > (1 + BAR) * old:
                wrong.append(f"{case}: {words[-1]}")
        lines.append(f"{case:24}{', '.join(words)}")
    return lines, wrong


def build() -> Path:
    """Build the cases as the crate is released, whatever the environment says."""
    changed = ("CARGO_PROFILE_", "CARGO_INCREMENTAL", "CARGO_ENCODED_RUSTFLAGS", "RUSTFLAGS")
    environment = {
        name: value for name, value in os.environ.items() if not name.startswith(changed)
    }
    command = ["cargo", "bench", "--no-run", "--bench", "counts", "--message-format", "json"]
    done = subprocess.run(
        command, cwd=ROOT, env=environment, stdout=subprocess.PIPE, text=True, check=True
    )
    messages = map(json.loads, done.stdout.splitlines())
    built = (message.get("executable") for message in messages)
    return next(Path(program) for program in built if program)


def run(*command: str | Path) -> tuple[str, str]:
    """Return what a program prints, and what it says on errors."""
    environment = os.environ | {"RAYON_NUM_THREADS": "1"}
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    if done.returncode:
        sys.exit(f"{' '.join(map(str, command))} has ended with {done.returncode}:\n{done.stderr}")
    return done.stdout, done.stderr


def instructions(program: Path, *words: str) -> int:
    """Return the instructions of a run under Valgrind."""
    log = run(*VALGRIND, program, *words)[1]
    return int(re.findall(r"I +refs: +([\d,]+)", log)[0].replace(",", ""))


def counted(program: Path, valgrind: bool) -> Counts:
    """Return the work of all cases: instructions are those beyond the preparation.

    Runs differ by some 1e-4 of them, as threads of a pool look for work before they sleep.
    """
    counts = {}
    for case in run(program)[0].split():
        convolutions, beyond = run(program, case)[0], None
        if valgrind:
            total = instructions(program, case) - instructions(program, case, "prepare")
            beyond = int(float(f"{total:.4g}"))
        counts[case] = Work(beyond, round(float(convolutions), 2) if convolutions else None)
        print(case, *astuple(counts[case]), file=sys.stderr, flush=True)
    return counts


def tools_of(program: Path) -> str:
    """Return all that instructions depend on beside the code, in words.

    Valgrind shows a processor of its own to programs, which choose their instructions by it.
    """
    compiler = " ".join(run("rustc", "--version")[0].split()[:2])
    valgrind = run("valgrind", "--version")[0].strip().replace("-", " ")
    processor = run(*VALGRIND, program, "processor")[0].strip()
    return ", ".join([compiler, valgrind, " ".join(platform.libc_ver()), processor])


def main(words: list[str] | None = None) -> None:
    """Write the table, or compare with it."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--compare", action="store_true", help="write nothing; fail at a rise")
    only_compares = parser.parse_args(words).compare
    program = build()
    has_valgrind = shutil.which("valgrind") is not None
    tools = tools_of(program) if has_valgrind else "no Valgrind"
    rows = read(TABLE)
    known, before = recorded(rows) if rows else (tools, {})
    if tools != known:
        print(f"instructions are not compared: the table is of {known}; here is {tools}")
    if not only_compares and not has_valgrind:
        sys.exit("make counts needs Valgrind")
    counts = counted(program, has_valgrind and (not only_compares or tools == known))
    if tools != known:
        before = {case: Work(None, work.convolutions) for case, work in before.items()}
    lines, wrong = compared(before, counts)
    print(*lines, sep="\n")
    if only_compares and wrong:
        sys.exit("\n".join([f"more than {100 * BAR:g} % more work than in {TABLE.name}:", *wrong]))
    if not only_compares:
        name = release((ROOT / "CHANGELOG.md").read_text(encoding="utf-8"))
        date = datetime.now(UTC).date().isoformat()
        with TABLE.open("w", newline="", encoding="utf-8") as file:
            writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
            writer.writeheader()
            writer.writerows(replaced(rows, name, date, tools, counts))


if __name__ == "__main__":
    main()
