"""An image scraper of sphinx-gallery that shows the figures of Spinu et al."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from sphinx_gallery.scrapers import figure_rst

from paper.figures import Drawing


def scraper(block: Any, variables: dict[str, Any], settings: dict[str, Any]) -> str:
    """Show each figure of Spinu et al. that a block of an example has drawn."""
    shown = variables.setdefault("drawings_shown", set())
    paths = []
    for name, value in variables["example_globals"].items():
        if isinstance(value, Drawing) and name not in shown:
            shown.add(name)
            paths.append(next(variables["image_path_iterator"]))
            Path(paths[-1]).write_bytes(value.png)
    return str(figure_rst(paths, settings["src_dir"]))
