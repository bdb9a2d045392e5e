"""Append criterion's medians to a history, and print the change since the last entry.

Usage: python3 benches/track.py target/criterion benches/history.csv

The change is against the newest earlier figure of the same benchmark on the same machine.
"""

import argparse
import csv
import json
import os
import platform
import subprocess
from datetime import UTC, datetime
from pathlib import Path

COLUMNS = ["date", "commit", "machine", "id", "nanoseconds"]


def medians(criterion: Path) -> dict[str, float]:
    """Return the median time [ns] of each benchmark of the last run, by id."""
    times = {}
    for estimates in sorted(criterion.glob("**/new/estimates.json")):
        benchmark = json.loads(estimates.with_name("benchmark.json").read_text(encoding="utf-8"))
        median = json.loads(estimates.read_text(encoding="utf-8"))["median"]
        times[str(benchmark["full_id"])] = float(median["point_estimate"])
    return times


def latest(history: Path, machine: str) -> dict[str, float]:
    """Return the newest recorded time [ns] of each benchmark on this machine, by id."""
    if not history.exists():
        return {}
    with history.open(newline="", encoding="utf-8") as file:
        rows = [row for row in csv.DictReader(file) if row["machine"] == machine]
    return {row["id"]: float(row["nanoseconds"]) for row in rows}


def append(history: Path, commit: str, machine: str, times: dict[str, float]) -> None:
    """Add one row for each benchmark, under a header if the file is new."""
    date = datetime.now(UTC).date().isoformat()
    new = not history.exists()
    with history.open("a", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        if new:
            writer.writerow(COLUMNS)
        writer.writerows([date, commit, machine, name, f"{t:.1f}"] for name, t in times.items())


def commit_name() -> str:
    """Return the short hash of the commit, marked if the checkout differs from it."""
    try:
        head = ["git", "rev-parse", "--short", "HEAD"]
        commit = subprocess.run(head, capture_output=True, text=True, check=True).stdout.strip()
        changes = ["git", "diff", "--quiet", "HEAD", "--", ".", ":!benches/history.csv"]
        return commit + ("-dirty" if subprocess.run(changes, check=False).returncode else "")
    except (OSError, subprocess.CalledProcessError):
        return "unknown"


def machine_name() -> str:
    """Return processor and number of cores, the same on every run on one machine."""
    processor = platform.processor() or platform.machine()
    cpuinfo = Path("/proc/cpuinfo")
    if cpuinfo.exists():
        lines = cpuinfo.read_text(encoding="utf-8").splitlines()
        models = (line.partition(":")[2].strip() for line in lines if line.startswith("model name"))
        processor = next(models, processor)
    return f"{processor} x {os.cpu_count()}"


def main() -> None:
    """Compare, then record."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("criterion", type=Path, help="criterion's output directory")
    parser.add_argument("history", type=Path, help="the CSV file to append to")
    options = parser.parse_args()

    times = medians(options.criterion)
    if not times:
        parser.error(f"no results under {options.criterion}; run cargo bench first")
    machine = machine_name()
    before = latest(options.history, machine)
    width = max(map(len, times))
    print(f"{'id':{width}}  {'now [us]':>12}  {'last [us]':>12}  change")
    for name, time in times.items():
        if name in before:
            last, change = f"{before[name] / 1e3:.2f}", f"{time / before[name] - 1:+.1%}"
        else:
            last, change = "-", "first run"
        print(f"{name:{width}}  {time / 1e3:12.2f}  {last:>12}  {change}")
    append(options.history, commit_name(), machine, times)


if __name__ == "__main__":
    main()
