"""For sphinx-gallery: the order of the pictures, and a scraper for the figures of Spinu et al."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from sphinx_gallery.scrapers import figure_rst

from paper.figures import Drawing

FIRST = (
    *(
        "stress_section",
        "coating_chart",
        "overview",
        "free_ends",
        "best_profile",
        "tilt_curve",
    ),
    *(
        "groove",
        "creep_curves",
        "both_coated",
        "study",
        "which_numbers",
        "where_to_remove",
    ),
    *(
        "rough_surface",
        "rough_bodies",
        "wave_stacks",
        "dent",
        "fretting_loop",
        "partial_slip",
    ),
)
"""Pictures that come first in the gallery, in this order: coatings, then rollers."""


def place(file: str) -> tuple[int, str]:
    """Place of a picture in the gallery; those that are not listed come last, by name."""
    name = Path(file).stem
    return (FIRST.index(name) if name in FIRST else len(FIRST), name)


def scraper(
    block: Any, variables: dict[str, Any], settings: dict[str, Any]
) -> str:
    """Show each figure of Spinu et al. that a block of an example has drawn."""
    shown = variables.setdefault("drawings_shown", set())
    paths = []
    for name, value in variables["example_globals"].items():
        if isinstance(value, Drawing) and name not in shown:
            shown.add(name)
            paths.append(next(variables["image_path_iterator"]))
            Path(paths[-1]).write_bytes(value.png)
    return str(figure_rst(paths, settings["src_dir"]))
