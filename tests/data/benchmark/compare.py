"""Compare a program's numbers with the benchmark: python compare.py RESULTS.csv [SET ...].

RESULTS.csv has the columns set, case, quantity, value, as template.csv beside this file, whose
values are left empty; rows that are missing or empty are not compared. Each set is printed with the
largest and the median difference, relative to the scale of each quantity. --tolerance X makes the
exit status 1 where a difference is above X plus the error of the reference; --all prints every row.
Needs Python alone.
"""

import argparse
import csv
import json
import math
import statistics
import sys
from pathlib import Path

HERE = Path(__file__).parent


def known():
    """Return (set, case, quantity) -> value, scale, error of the number."""
    found = {}
    for path in sorted(HERE.glob("*.json")):
        for case in json.loads(path.read_text(encoding="utf-8"))["cases"]:
            for quantity, row in case["asked"].items():
                place = (path.stem, case["name"], quantity)
                found[place] = (row["value"], row["scale"], row["error"])
    return found


def read(path):
    """Return (set, case, quantity) -> value of a program's table."""
    found = {}
    with open(path, encoding="utf-8-sig", newline="") as file:
        table = csv.DictReader(file)
        lacking = {"set", "case", "quantity", "value"} - set(table.fieldnames or [])
        if lacking:
            raise ValueError(f"{path} has no column {', '.join(sorted(lacking))}")
        for row in table:
            if not (row["value"] or "").strip():
                continue
            place = tuple(row[key] or "" for key in ("set", "case", "quantity"))
            if place in found:
                raise ValueError(f"{path}, line {table.line_num}: {place} is there twice")
            try:
                found[place] = float(row["value"])
            except ValueError:
                text = f"{path}, line {table.line_num}: {row['value']!r} is no number"
                raise ValueError(text) from None
    return found


def differences(results, sets=()):
    """Return (difference, error of the number, place, value, expected), all sets or those named."""
    truth, rows = known(), []
    for place, value in results.items():
        if place not in truth:
            raise ValueError(f"no such row in the benchmark: {', '.join(place)}")
        expected, scale, error = truth[place]
        if not sets or place[0] in sets:
            off = abs(value - expected) / scale
            rows.append((math.inf if math.isnan(off) else off, error, place, value, expected))
    return rows


def report(rows, every=False):
    """Return the lines of the table."""
    lines = [f"{'set':20} {'rows':>5} {'median':>9} {'largest':>9} {'its error':>9}  worst row"]
    for name in sorted({row[2][0] for row in rows}):
        part = sorted((row for row in rows if row[2][0] == name), reverse=True)
        middle = statistics.median(row[0] for row in part)
        off, error, place, value, expected = part[0]
        worst = f"{place[1]}: {place[2]}: {value:.6g}, expected {expected:.6g}"
        lines.append(f"{name:20} {len(part):5} {middle:9.1e} {off:9.1e} {error:9.1e}  {worst}")
        if every:
            lines += [
                f"  {o:9.1e}  {p[1]}: {p[2]}: {v:.9g}, expected {e:.9g}" for o, _, p, v, e in part
            ]
    return lines


def main(arguments=None):
    """Run the command line; return the exit status."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("results", help="CSV with the columns set, case, quantity, value")
    parser.add_argument("sets", nargs="*", help="sets to compare; all without any")
    parser.add_argument("--tolerance", type=float, help="largest difference that passes")
    parser.add_argument("--all", action="store_true", help="print every row")
    asked = parser.parse_args(arguments)
    if asked.tolerance is not None and not asked.tolerance >= 0:
        parser.error("--tolerance must be 0 or more")
    if unknown := set(asked.sets) - {place[0] for place in known()}:
        parser.error(f"no such set: {', '.join(sorted(unknown))}")
    try:
        rows = differences(read(asked.results), asked.sets)
    except (OSError, ValueError, csv.Error) as error:
        print(f"{asked.results}: {error}", file=sys.stderr)
        return 2
    if not rows:
        print("nothing to compare: no row has a value", file=sys.stderr)
        return 2
    print("\n".join(report(rows, asked.all)))
    # A reference that is less certain than the tolerance cannot fail a program.
    return int(asked.tolerance is not None and any(r[0] > asked.tolerance + r[1] for r in rows))


if __name__ == "__main__":
    sys.exit(main())
