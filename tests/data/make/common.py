"""What the generators of reference numbers share: files, comparison, command line.

A generator is a module with ``NAME``, the file of reference numbers; ``fill(content)``, which
computes all numbers of the file from the inputs that it lists; and ``SECONDS``, how long that
takes. To add a case, write its inputs into the file and run the generator with ``--write``.

A file says in ``description`` what it holds, in ``source`` and ``method`` where the numbers come
from, and in ``error`` how good they are. ``tolerance`` states the error for programs:
``{key: [relative, absolute]}``, where the key is that of the number or of an object around it (the
innermost counts), and ``""`` stands for all others. The allowed difference is
absolute + relative * |stored|.
"""

import argparse
import copy
import json
import sys
import time
from pathlib import Path

DATA = Path(__file__).parents[1]


def read(name):
    return json.loads((DATA / name).read_text(encoding="utf-8"))


def write(name, content):
    """Write a file whole: a line for each key and for each entry of a list of objects."""
    lines = []
    for key, value in content.items():
        if isinstance(value, list) and value and isinstance(value[0], dict):
            rows = ",\n".join("  " + json.dumps(row, ensure_ascii=False) for row in value)
            lines.append(f" {json.dumps(key)}: [\n{rows}\n ]")
        else:
            lines.append(f" {json.dumps(key)}: {json.dumps(value, ensure_ascii=False)}")
    part = (DATA / name).with_suffix(".part")
    part.write_text("{\n" + ",\n".join(lines) + "\n}\n", encoding="utf-8")
    part.replace(DATA / name)


def differences(new, old, tolerance, path=()):
    """Yield (difference / allowed, path, new, old) of numbers that differ and of other changes."""
    if isinstance(old, dict) and isinstance(new, dict) and old.keys() == new.keys():
        for key in old:
            yield from differences(new[key], old[key], tolerance, (*path, str(key)))
    elif isinstance(old, list) and isinstance(new, list) and len(old) == len(new):
        for k in range(len(old)):
            yield from differences(new[k], old[k], tolerance, (*path, str(k)))
    elif new != old:
        try:
            off = abs(float(new) - float(old))
        except (TypeError, ValueError):
            yield float("inf"), path, new, old
            return
        key = next((key for key in reversed(path) if key in tolerance), "")
        relative, absolute = tolerance[key]
        allowed = absolute + relative * abs(float(old))
        yield (off / allowed if allowed and off == off else float("inf")), path, new, old


def compare(generator):
    """Differences, in units of the stated error and worst first, and the new content."""
    old = read(generator.NAME)
    new = copy.deepcopy(old)
    generator.fill(new)
    found = sorted(differences(new, old, old["tolerance"]), key=lambda d: -d[0])
    return found, new


def main(generator):
    """Command line of one generator; the exit status is 1 where a number is off."""
    parser = argparse.ArgumentParser(description=generator.__doc__.splitlines()[0])
    parser.add_argument(
        "--write", action="store_true", help="replace the stored numbers by the new ones"
    )
    arguments = parser.parse_args()
    start = time.perf_counter()
    found, new = compare(generator)
    worst = found[0][0] if found else 0.0
    for share, path, is_now, was in [d for d in found if d[0] > 1][:10]:
        print(f"  {'/'.join(path)}: {is_now!r}, stored {was!r}: {share:.3g} times the stated error")
    took = time.perf_counter() - start
    print(f"{generator.NAME}: largest difference {worst:.3g} of the stated error, {took:.1f} s")
    if arguments.write:
        write(generator.NAME, new)
        print(f"{generator.NAME} written")
    elif worst > 1:
        sys.exit(1)
