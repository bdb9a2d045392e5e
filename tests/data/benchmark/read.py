"""Read the benchmark into NumPy: python read.py prints how many numbers each set has.

>>> table = read()["coated_spheres"]
>>> table["value"][table["quantity"] == "peak_pressure_Pa"]  # one for each case
"""

import json
from pathlib import Path

import numpy as np

COLUMNS = [
    ("case", "U80"),
    ("quantity", "U120"),
    ("value", float),
    ("scale", float),
    ("error", float),
]


def read(folder=Path(__file__).parent):
    """Return an array with the columns case, quantity, value, scale and error for each set."""
    return {
        path.stem: np.array(
            [
                (case["name"], quantity, row["value"], row["scale"], row["error"])
                for case in json.loads(path.read_text(encoding="utf-8"))["cases"]
                for quantity, row in case["asked"].items()
            ],
            dtype=COLUMNS,
        )
        for path in sorted(Path(folder).glob("*.json"))
    }


if __name__ == "__main__":
    for name, table in read().items():
        print(f"{name:20} {len(table):4} numbers, errors up to {table['error'].max():.1e}")
