"""Settings of the documentation site; `make docs` builds it."""

from __future__ import annotations

import os
import sys
import tomllib
from importlib.metadata import version as version_of
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

sys.path.insert(
    0, str(Path(__file__).parent / "extensions")
)  # claims, drawings, names, provenance, readme, work_counts
sys.path.insert(0, str(Path(__file__).parents[1] / "examples"))  # paper

project = "nacre"
author = copyright = "The nacre developers"
version = release = version_of("nacre-contact")
CARGO = tomllib.loads(
    (Path(__file__).parents[1] / "Cargo.toml").read_text(encoding="utf-8")
)
PROJECT_URL = CARGO["package"]["repository"]

extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "attributes",
    "sphinx_copybutton",
    "sphinx_design",
    "sphinx_gallery.gen_gallery",
    "sphinx-mathjax-offline",
    "claims",
    "work_counts",
    "names",
    "provenance",
    "readme",
]
# Links into the pages of other libraries need their inventories from the network; `make docs` needs
# none.
if os.environ.get("NACRE_DOCS_ONLINE"):
    extensions.append("sphinx.ext.intersphinx")
intersphinx_mapping = {
    "python": ("https://docs.python.org/3", None),
    "numpy": ("https://numpy.org/doc/stable", None),
    "scipy": ("https://docs.scipy.org/doc/scipy", None),
    "matplotlib": ("https://matplotlib.org/stable", None),
    "xarray": ("https://docs.xarray.dev/en/stable", None),
}
linkcheck_ignore = [
    r"https?://[^/]*\.invalid"
]  # the address of the project until it is known

default_role = "py:obj"
exclude_patterns = ["_build", "extensions", "gallery"]

# Equations are between $ or $$, and have numbers where they have labels.
myst_enable_extensions = ["amsmath", "colon_fence", "deflist", "dollarmath"]
myst_heading_anchors = 3
math_eqref_format = "({number})"
numfig = True
numfig_format = {
    "code-block": "%.0s"
}  # captions of code are file names, without numbers
numfig_secnum_depth = 1

# The compiled classes have NumPy docstrings and signatures without types.
autodoc_member_order = "bysource"
autodoc_default_options = {"members": True, "undoc-members": False}
autodoc_typehints = "none"
autodoc_mock_imports = ["jax", "torch"]  # large, and only documented
napoleon_google_docstring = False
napoleon_use_rtype = False
napoleon_use_ivar = True

html_theme = "furo"
html_title = f"nacre {release}"
html_static_path = ["_static"]
html_css_files = ["nacre.css"]
html_show_sphinx = False
html_theme_options: dict[str, Any] = {
    "light_css_variables": {
        "color-brand-primary": "#0072B2",
        "color-brand-content": "#0072B2",
    },
    "dark_css_variables": {
        "color-brand-primary": "#56B4E9",
        "color-brand-content": "#56B4E9",
    },
}
# Pages link to their source once there is a repository.
if not str(urlsplit(PROJECT_URL).hostname).endswith(".invalid"):
    html_theme_options |= {
        "source_repository": PROJECT_URL,
        "source_branch": "main",
        "source_directory": "docs/",
    }
copybutton_prompt_text = ">>> |$ "
copybutton_prompt_is_regexp = False


sphinx_gallery_conf = {
    "examples_dirs": "gallery",
    "gallery_dirs": "pictures",
    "filename_pattern": r"\.py$",
    "subsection_order": ["gallery/nacre", "gallery/paper"],
    "within_subsection_order": "drawings.place",
    "image_scrapers": ("matplotlib", "drawings.scraper"),
    "abort_on_example_error": True,
    "capture_repr": (),
    "image_srcset": ["3x"],  # some 1600 pixels, for sharp screens and for print
    "show_memory": False,
    "show_signature": False,
    "min_reported_time": 600,
    "copyfile_regex": "",
    "write_computation_times": False,
    "remove_config_comments": True,
    "download_all_examples": False,
}
# Buttons that run an example in the browser: off until PyPI has a wheel for Pyodide.
if os.environ.get("NACRE_DOCS_LIVE"):
    extensions.append("jupyterlite_sphinx")
    jupyterlite_silence = True
    sphinx_gallery_conf |= {
        "jupyterlite": {"use_jupyter_lab": False},
        "first_notebook_cell": "%pip install --quiet nacre-contact[plot]\n%matplotlib inline",
    }


def link_pages(app: Any, name: str, source: list[str]) -> None:
    """Replace links between files of the repository by links between pages of the site."""
    source[0] = source[0].replace("(../benches/README.md)", "(benches.md)")


def insert_reference(app: Any, name: str, source: list[str]) -> None:
    """Insert the reference of case files, which is made from their schema."""
    if name == "cases":
        from nacre.case.reference import text

        source[0] = source[0].replace("CASE-REFERENCE", text())


def find_type(app: Any, env: Any, node: Any, text: Any) -> Any:
    """Return a link to a class of `nacre.types`, which texts name without the module."""
    if node.get("refdomain") != "py":
        return None
    name = f"nacre.types.{node['reftarget'].removeprefix('nacre.')}"
    domain, page = env.get_domain("py"), node["refdoc"]
    return domain.resolve_xref(env, page, app.builder, "obj", name, node, text)


def place_notebooks(app: Any, config: Any) -> None:
    """Put notebooks where buttons look: jupyterlite-sphinx 0.23 keeps the names of folders."""
    config.jupyterlite_contents = [
        f"{folder}/*" for folder in config.jupyterlite_contents
    ]


def setup(app: Any) -> None:
    """Connect the functions that Sphinx calls."""
    if "jupyterlite_sphinx" in extensions:
        app.connect(
            "config-inited", place_notebooks, priority=950
        )  # after the gallery
    app.connect("source-read", link_pages)
    app.connect("source-read", insert_reference)
    app.connect("missing-reference", find_type)
