"""A solution prints what it is: forces, bodies, freedoms, and a small map in a notebook."""

from __future__ import annotations

import base64
import re
import struct
import zlib

import numpy as np
import pytest

import nacre
from nacre._display import thumbnail

STEEL, DLC = nacre.Elastic(210e9, 0.3), nacre.Elastic(420e9, 0.2)
COATED = nacre.HalfSpace(STEEL, [nacre.Layer(DLC, 2e-6)])


def table(solution: nacre.Solution) -> dict[str, str]:
    pairs = (re.split(r"\s{2,}", line.strip(), maxsplit=1) for line in str(solution).splitlines())
    return {pair[0]: pair[1] for pair in pairs if len(pair) == 2}


def test_the_table_names_bodies_modulus_freedoms_and_resultant() -> None:
    shape = nacre.Sphere(5e-3)
    solution = nacre.solve(shape, COATED, STEEL, load=10.0, eccentricity=(1e-6, None))
    rows = table(solution)
    assert rows["load"] == "10 N"
    assert rows["acts at"] == "(1 µm, 0 m)"
    assert rows["freedoms"] == "load; tilt x free, y locked"
    assert rows["body"] == "E 210 GPa, ν 0.3"
    assert rows["layer 1"] == "2 µm, E 420 GPa, ν 0.2"
    assert rows["counterbody"] == "E 210 GPa, ν 0.3"
    # 1/E* is the sum of both compliances (1 - ν²)/E.
    assert rows["E* (substrates)"] == f"{210 / 0.91 / 2:.4g} GPa"
    assert rows["E* (surfaces)"] == f"{1 / (0.96 / 420 + 0.91 / 210):.4g} GPa"
    assert rows["ended"].startswith("converged")


def test_a_rigid_counterbody_and_what_is_given_are_said() -> None:
    grid = nacre.Grid((16, 16), (1e-3, 1e-3))
    solution = nacre.solve(nacre.Sphere(5e-3), STEEL, grid=grid, approach=-1e-6, tilt=(1e-5, None))
    rows = table(solution)
    assert rows["counterbody"] == "rigid"
    assert rows["E*"] == f"{210 / 0.91:.4g} GPa"
    assert rows["freedoms"] == "approach; tilt x given, y locked"
    assert rows["acts at"] == "nothing touches"


def test_many_layers_are_one_row() -> None:
    body = nacre.HalfSpace(STEEL, [nacre.Layer(DLC, 1e-6)] * 20)
    assert table(nacre.solve(nacre.Sphere(5e-3), body, load=10.0))["layers"] == "20, together 20 µm"


def pixels(png: bytes) -> np.ndarray[tuple[int, int, int], np.dtype[np.uint8]]:
    """Decode a PNG of unfiltered 8-bit RGB lines."""
    width, height = struct.unpack(">II", png[16:24])
    start = png.index(b"IDAT") + 4
    (size,) = struct.unpack(">I", png[start - 8 : start - 4])
    lines = np.frombuffer(zlib.decompress(png[start : start + size]), dtype=np.uint8)
    lines = lines.reshape(height, 1 + 3 * width)
    assert not lines[:, 0].any()
    return lines[:, 1:].reshape(height, width, 3)


def test_the_small_map_has_x_to_the_right_and_y_upwards() -> None:
    pressure = np.zeros((40, 20))
    pressure[5:36, 4:17] = 1.0
    pressure[30:33, 12:15] = 4.0
    image = pixels(thumbnail(pressure)).astype(int)
    height, width, _ = image.shape
    rows, columns = np.nonzero((image == (253, 231, 37)).all(axis=-1))  # the top of viridis
    assert columns.min() > 0.6 * width
    assert rows.max() < 0.5 * height
    assert (image[0] == 255).all()  # white where nothing touches


def test_a_notebook_shows_table_and_map() -> None:
    solution = nacre.solve(nacre.Sphere(5e-3), COATED, load=10.0)
    html = solution._repr_html_()
    assert "<td" in html
    assert "E 420 GPa" in html
    encoded = re.search(r"base64,([^']+)'", html)
    assert encoded
    image = pixels(base64.b64decode(encoded[1]))
    assert max(image.shape) <= 240
    assert len(html) < 40_000


def test_warnings_are_part_of_what_is_printed() -> None:
    grid = nacre.Grid((8, 8), (1e-4, 1e-4))
    with pytest.warns(nacre.NacreWarning, match="cells wide"):
        solution = nacre.solve(nacre.Sphere(5e-3), STEEL, grid=grid, load=1.0)
    assert solution.report.warnings
    for said in solution.report.warnings:
        assert f"warning: {said}" in str(solution)
        assert said in solution._repr_html_()


def test_an_estimate_of_the_error_stands_with_the_figure() -> None:
    solution = nacre.solve(nacre.Sphere(5e-3), STEEL, load=10.0)
    estimate = solution.report.discretisation
    assert estimate is not None
    percent = 100 * estimate["peak_pressure"] / solution.peak_pressure
    assert table(solution)["peak pressure"].endswith(f"GPa ± {percent:.1g} %")
    # What is prescribed has no error.
    solution = nacre.solve(nacre.Sphere(5e-3), STEEL, approach=6e-7)
    assert table(solution)["approach"] == "600 nm"
