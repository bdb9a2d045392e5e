"""Files and calls as practice brings them: read right, or refused with what would help.

The inputs in `tests/data/cases` are made up after exports of instruments; each right value is known
from how its input was made, or from the reader of the format alone.
"""

from __future__ import annotations

import copy
import math
import os
import pickle
import re
import subprocess
import sys
import zipfile
from pathlib import Path
from typing import Any, Literal

import numpy as np
import numpy.typing as npt
import pytest

import nacre
from nacre._core import plain
from nacre.indent import Adhesion, Curve, Indentation, Tip, fit, read
from nacre.surfaces import read_profile
from support import assert_close

Array = npt.NDArray[np.float64]

CASES = Path(__file__).parents[2] / "data" / "cases"
FILM = nacre.HalfSpace(nacre.RIGID, [nacre.Layer(nacre.Elastic(3e9, 0.4), 1e-3)])
STEEL = nacre.Elastic(210e9, 0.3)
DIGITS = 1e-5
"""Relative error of right values, which were printed with six digits and more."""

pytestmark = pytest.mark.filterwarnings("ignore:Could not import mpi4py:ImportWarning")

MAPS: dict[str, tuple[str, dict[str, Any], tuple[int, int], float, float]] = {
    # file, keywords, shape, spacing [m], rms after the plane is removed [m]
    "points in a csv": ("csv_points_as_matrix/points.csv", {}, (14, 9), 2.5e-6, 7.90349e-7),
    "points, as a matrix would be asked for": (
        "csv_points_as_matrix/points.csv",
        {"unit": "um", "spacing": 2.5e-6},
        (14, 9),
        2.5e-6,
        7.90349e-7,
    ),
    "traces with their numbers": (
        "traces_with_index/traces.txt",
        {"unit": "A", "spacing": 1e-6},
        (30, 5),
        1e-6,
        2.91358e-7,
    ),
    "mm beside um": (
        "xyz_mixed_units/scan.txt",
        {"unit": "um", "spacing": 5e-6},
        (16, 16),
        5e-6,
        4.82166e-6,
    ),
    "a spacing in another unit": (
        "nms_sides_of_metres/surface.nms",
        {"spacing": 3.125e-7},
        (24, 20),
        3.125e-7,
        4.66194e-8,
    ),
    "a dash in the name of a standard": (
        "x3p_en_dash/surface.x3p",
        {},
        (9, 7),
        2e-6,
        2.814343e-7,
    ),
    "no mark at the beginning": (
        "ending_not_believed/surface.nms",
        {},
        (24, 20),
        3.125e-7,
        4.66192e-8,
    ),
    "a head of a microscope": (
        "microscope_csv_with_head/height.csv",
        {},
        (10, 8),
        1.389e-6,
        1.33928e-6,
    ),
    "decimal commas": ("txt_decimal_comma/surface.txt", {}, (8, 6), 5e-7, 1.984741e-7),
}


@pytest.mark.parametrize("kind", MAPS)
def test_a_map_of_an_instrument_is_read(kind: str) -> None:
    name, options, shape, spacing, rms = MAPS[kind]
    read = nacre.HeightMap.read(CASES / name, **options)
    assert read.heights.shape == shape
    assert_close(read.spacing, spacing, rtol=DIGITS, each=True)
    assert read.heights.std() == pytest.approx(rms, rel=DIGITS)


@pytest.mark.parametrize(
    ("name", "options", "message"),
    [
        (
            "csv_profile_as_matrix/profile.csv",
            {},
            "a profile, .* two dimensions, .*SampledProfile.read",
        ),
        (
            "csv_profile_as_matrix/profile.csv",
            {"unit": "um", "spacing": 1e-6, "transpose": True},
            "holds a profile",
        ),
        ("xyz_mixed_units/scan.txt", {"unit": "um"}, "x, y and z seem .* different .* spacing="),
        ("xyz_mixed_units/scan.txt", {"unit": "mm"}, "heights would span 0.024.* different units"),
        (
            "nms_sides_of_metres/surface.nms",
            {},
            "2.64e-07 m on a map of 7.5 m x 6.25 m; .*spacing=",
        ),
        ("gwy_without_a_map/empty.gwy", {}, "no channel with heights; its channels are none"),
        ("gwy_without_a_map/empty.gwy", {"unit": "nm"}, "no channel with heights"),
    ],
)
def test_what_is_no_map_is_refused(name: str, options: dict[str, Any], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        nacre.HeightMap.read(CASES / name, **options)


def heights(shape: tuple[int, int]) -> Array:
    """Return heights of some µm, with four decimals."""
    random = np.random.default_rng(0).standard_normal(shape)
    return np.asarray(np.cumsum(random, axis=0).round(4))


def rows(*columns: Any, mark: str = ",", comma: bool = False) -> str:
    lines = (mark.join(f"{value:.4f}" for value in row) for row in zip(*columns, strict=True))
    text = "\n".join(lines) + "\n"
    return text.replace(".", ",") if comma else text


def written(path: Path, text: str, encoding: str = "utf-8") -> Path:
    path.write_bytes(text.encode(encoding))
    return path


ALONG, ACROSS = (k.T.ravel() for k in np.indices((7, 5)))
Z = heights((7, 5)).T.ravel()
POINTS: dict[str, tuple[str, str, str]] = {
    # ending, encoding, text
    "csv": ("csv", "utf-8", rows(2.5 * ALONG, 2.5 * ACROSS, Z)),
    "semicolons": ("csv", "utf-8", rows(2.5 * ALONG, 2.5 * ACROSS, Z, mark=";", comma=True)),
    "tabs": ("txt", "utf-16", rows(2.5 * ALONG, 2.5 * ACROSS, Z, mark="\t", comma=True)),
    "blanks": ("dat", "utf-8", rows(2.5 * ALONG, 2.5 * ACROSS, Z, mark="  ")),
    "columns by name": ("csv", "utf-8", "Z;Y;X\n" + rows(Z, 2.5 * ACROSS, 2.5 * ALONG, mark=";")),
    "own units": (
        "txt",
        "cp1252",
        "x [mm]\ty [mm]\tz [µm]\n" + rows(ALONG * 2.5, ACROSS * 2.5, Z, mark="\t"),
    ),
    "counted from 0": ("csv", "utf-8", rows(np.arange(35.0), 2.5 * ALONG, 2.5 * ACROSS, Z)),
    "counted from 1": (
        "xyz",
        "utf-8",
        rows(1.0 + np.arange(35), 2.5 * ALONG, 2.5 * ACROSS, Z, mark="\t"),
    ),
    "heights first": ("csv", "utf-8", rows(Z, 2.5 * ALONG, 2.5 * ACROSS)),
    "a row of units": (
        "txt",
        "utf-8",
        "X\tY\tZ\nµm\tµm\tµm\n" + rows(2.5 * ALONG, 2.5 * ACROSS, Z, mark="\t"),
    ),
}


@pytest.mark.parametrize("kind", POINTS)
def test_points_are_recognised_however_they_are_written(kind: str, tmp_path: Path) -> None:
    ending, encoding, text = POINTS[kind]
    path = written(tmp_path / f"a.{ending}", text, encoding)
    options: dict[str, Any] = {"detrend": "none"} | ({} if "µm" in text else {"unit": "um"})
    read = nacre.HeightMap.read(path, **options)
    assert_close(read.heights, 1e-6 * heights((7, 5)), rtol=1e-12)
    # Sides of millimetres beside heights of micrometres, by the headings.
    assert_close(read.spacing, 2.5e-3 if "mm" in text else 2.5e-6, rtol=1e-12)


M = heights((6, 10))
COUNTED = "\n".join(f"{i + 1}\t" + "\t".join(f"{h:.4f}" for h in M[i]) for i in range(6)) + "\n"
HEAD = "Number of Points\t10\nNumber of Traces\t6\n\n"
MARK = pytest.mark.parametrize


@MARK("first", [0, 1, 5])
def test_numbers_of_lines_are_left_out_where_the_head_counts_them(
    first: int, tmp_path: Path
) -> None:
    text = re.sub(r"^(\d)\t", lambda m: f"{int(m[1]) - 1 + first}\t", COUNTED, flags=re.MULTILINE)
    for body in (f"Trace\tData\n{text}", f"Trace\tData\n{text}Raw\tData\n{text}"):
        path = written(tmp_path / "a.txt", HEAD + body)
        read = nacre.HeightMap.read(path, unit="um", spacing=1e-6, detrend="none")
        assert_close(read.heights, 1e-6 * M.T, rtol=1e-12)


@MARK("mark", [",", ";", "\t"])
def test_the_index_of_a_table_is_left_out(mark: str, tmp_path: Path) -> None:
    head = mark.join(["", *map(str, range(10))])
    lines = [mark.join([str(i), *(f"{h:.4f}" for h in M[i])]) for i in range(6)]
    path = written(tmp_path / "a.csv", "\n".join([head, *lines]))
    read = nacre.HeightMap.read(path, unit="um", spacing=1e-6, detrend="none")
    assert_close(read.heights, 1e-6 * M, rtol=1e-12)


X = 24.892 * np.arange(40)
DOME = 280 - X**2 / 5000


@MARK(
    ("text", "message"),
    [
        ("Trace\tData\n" + COUNTED, "first column .* counts or gives places, 1 to 6"),
        (COUNTED + "Raw\n" + COUNTED, "channel must be given: .* 2 tables, 0 .* 1 .'Raw', 6 lines"),
        (HEAD.replace("6", "7") + COUNTED, "counts or gives places, 1 to 6"),
        (rows(2.5 * ALONG, 2.5 * ACROSS, Z, Z**2), "holds points, not a matrix: columns 0 and 1"),
        ("1.0,x4,2,3,4\n" + rows(*heights((6, 5)).T), "must hold numbers, .* has '1.0,x4,2,3,4'"),
        (
            "y,0.5,1,1.5,2\n" + rows(0.5 * np.arange(6), *heights((6, 4)).T),
            "first column .* places",
        ),
        (rows(X, DOME), "holds a profile"),
        (rows(X[::-1], DOME, mark=";", comma=True), "holds a profile"),
        ("Lateral,Height\n" + rows(X, DOME), "holds a profile"),
        (rows(1.0 + np.arange(40), X, DOME, mark="\t"), "holds a profile"),
        (rows(*np.array([X, DOME]).T), "holds a profile"),
        (rows(X, DOME, DOME**2), "first column .* places, 0 to 970.788"),
        (rows(*np.vstack([np.arange(10.0), M]).T), "first line .* places, 0 to 9"),
    ],
)
@MARK("ending", ["csv", "txt", "dat"])
def test_no_keywords_make_a_map_of_what_is_none(
    text: str, message: str, ending: str, tmp_path: Path
) -> None:
    path = written(tmp_path / f"a.{ending}", text)
    for options in ({}, {"unit": "um"}, {"unit": "um", "spacing": 1e-5, "transpose": True}):
        with pytest.raises(ValueError, match=message):
            nacre.HeightMap.read(path, **options)


@pytest.mark.parametrize("unit", [None, "mm", "µm"])
def test_a_unit_of_a_column_is_not_applied_again(unit: str | None, tmp_path: Path) -> None:
    x, heights = np.linspace(0, 1, 6), np.random.default_rng(0).uniform(0, 1, (6, 6))
    rows = [f"{x[i]},{x[j]},{heights[i, j]}" for i in range(6) for j in range(6)]
    path = tmp_path / "scan.csv"
    path.write_text("\n".join(["x [mm],y [mm],z [µm]", *rows]), encoding="utf-8")
    found = nacre.HeightMap.read(path, unit=unit, detrend="none")
    assert found.spacing == pytest.approx((2e-4, 2e-4))
    assert np.diff(found.heights) == pytest.approx(1e-6 * np.diff(heights))


def test_matrices_of_few_columns_stay_readable(tmp_path: Path) -> None:
    random = np.random.default_rng(1)
    for shape in ((50, 2), (50, 3), (3, 50), (4, 4)):
        z = random.standard_normal(shape).round(4)
        path = written(tmp_path / "a.csv", rows(*z.T))
        read = nacre.HeightMap.read(path, unit="um", spacing=1e-6, detrend="none")
        assert_close(read.heights, 1e-6 * z, rtol=1e-12)


@MARK("scale", [1e-3, 1.0, 1e3])
def test_a_number_that_stands_for_no_height_is_missing(scale: float, tmp_path: Path) -> None:
    z = scale * np.random.default_rng(2).standard_normal((12, 9))
    z[3:5, 4] = {1e-3: -25.4, 1.0: -25400, 1e3: -25400000}[scale]
    np.save(tmp_path / "a.npy", z)
    with pytest.warns(nacre.NacreWarning, match="2 of 108 heights are missing"):
        read = nacre.HeightMap.read(tmp_path / "a.npy", unit="nm", spacing=1e-6)
    assert np.ptp(read.heights) < 10e-9 * scale


def test_heads_of_microscopes_come_in_other_separators_and_units(tmp_path: Path) -> None:
    source = (CASES / "microscope_csv_with_head" / "height.csv").read_bytes().decode()
    right = nacre.HeightMap.read(CASES / "microscope_csv_with_head" / "height.csv")
    for text, encoding in (
        (source.replace('","', '";"').replace(".", ","), "utf-8"),
        (source.replace('","', '"\t"'), "utf-16"),
        (source.replace('"', ""), "utf-8"),
        (source.replace('"1.389","um"', '"1389","nm"'), "utf-8"),
        (source.replace('"um"', '"µm"'), "cp1252"),
    ):
        read = nacre.HeightMap.read(written(tmp_path / "a.csv", text, encoding))
        assert_close(read.heights, right.heights, rtol=1e-9, atol=1e-20)
        assert_close(read.spacing, right.spacing, rtol=1e-12)
    lines = [line for line in source.splitlines() if "um" not in line]
    path = written(tmp_path / "a.csv", "\n".join(lines))
    with pytest.raises(ValueError, match=r"spacing must be given: .* table begins at line 9"):
        nacre.HeightMap.read(path)


def test_an_export_with_decimal_commas_comes_in_other_separators(tmp_path: Path) -> None:
    source = (CASES / "txt_decimal_comma" / "surface.txt").read_text(encoding="utf-8")
    right = nacre.HeightMap.read(written(tmp_path / "a.txt", source.replace(",", ".")))
    for ending, text in (("txt", source.replace("\t", ";")), ("asc", source.replace("\t", "  "))):
        for encoding in ("utf-8", "utf-16", "cp1252"):
            path = written(tmp_path / f"b.{ending}", text, encoding)
            assert nacre.HeightMap.read(path) == right
    other = source + source.replace("Height\n", "Other\n")
    path = written(tmp_path / "c.txt", other)
    assert nacre.HeightMap.read(path, channel="Other") == right


def x3p(path: Path, change: tuple[bytes, bytes], folder: str = "") -> Path:
    """Write the X3P of the cases with a change of its index, its files in a folder."""
    source = zipfile.ZipFile(CASES / "x3p_en_dash" / "surface.x3p")
    with source, zipfile.ZipFile(path, "w") as made:
        for name in source.namelist():
            content = source.read(name)
            made.writestr(folder + name, content.replace(*change) if "main" in name else content)
    return path


@MARK("text", [rows(X, DOME), rows(X, DOME, mark="\t"), "Lateral,Height\n" + rows(X, DOME)])
def test_a_profile_in_an_xyz_is_refused(text: str, tmp_path: Path) -> None:
    with pytest.raises(ValueError, match=r"holds a profile, .* SampledProfile.read"):
        nacre.HeightMap.read(written(tmp_path / "a.xyz", text), unit="um", spacing=1e-6)


@MARK("size", [50, 200, 1250])
@MARK("name", ["nms_sides_of_metres/surface.nms", "x3p_en_dash/surface.x3p"])
def test_no_other_format_is_guessed_for_a_truncated_file(
    name: str, size: int, tmp_path: Path
) -> None:
    # As numbers of two bytes these would be 5 x 5, 10 x 10 and 25 x 25 heights.
    pytest.importorskip("SurfaceTopography")
    path = tmp_path / Path(name).name
    path.write_bytes((CASES / name).read_bytes()[:size])
    with pytest.raises(ValueError, match=r"cannot be read: (NanoFocus NMS|XML 3D surface)"):
        nacre.HeightMap.read(path, unit="um", spacing=1e-3)


def test_what_the_reader_of_an_ending_said_is_told(tmp_path: Path) -> None:
    right = nacre.HeightMap.read(CASES / "x3p_en_dash" / "surface.x3p")
    for path in (
        x3p(tmp_path / "a.X3P", (b"", b""), "folder/"),
        x3p(tmp_path / "b.x3p", ("–".encode(), b"-")),
        x3p(tmp_path / "c.unknown", ("–".encode(), "—".encode())),
    ):
        assert nacre.HeightMap.read(path) == right
    damaged = x3p(tmp_path / "d.x3p", (b"<PointDataLink>", b"<Other>"))
    for path, message in (
        (x3p(tmp_path / "e.x3p", (b"SUR", b"PRF")), "FeatureType should be 'SUR'"),
        (damaged, "cannot be read: XML 3D surface profile"),
        (written(tmp_path / "f.x3p", "no archive"), "not a valid ZIP archive"),
        (written(tmp_path / "g.nms", "short"), "cannot be read: NanoFocus NMS: "),
    ):
        with pytest.raises(ValueError, match=message):
            nacre.HeightMap.read(path)


CURVES: dict[str, tuple[str, dict[str, Any], int, tuple[float, float], tuple[float, float]]] = {
    # file, keywords, points, ranges of depth [m] and of force [N]
    "height and spring constant": (
        "afm_table_with_json_head/curve.tab",
        {},
        60,
        (-5.2e-6, -4.81e-6),
        (0, 4.938376e-10),
    ),
    "a part of it": (
        "afm_table_with_json_head/curve.tab",
        {"segment": 1},
        20,
        (-5.0e-6, -4.81e-6),
        (0, 4.938376e-10),
    ),
    "a contact depth beside": (
        "contact_depth_taken/dynamic.txt",
        {},
        60,
        (0.6e-9, 23.02e-9),
        (9.0976e-6, 32.1941e-6),
    ),
    "one of three tables": (
        "one_of_three_tables/test.hld",
        {},
        20,
        (5e-9, 480e-9),
        (0.2e-3, 19.753008e-3),
    ),
    "the shorter of two tests": (
        "tests_of_different_length/tests.txt",
        {"depth": 3, "force": 1, "time": 0},
        9,
        (0, 16e-9),
        (0, 0.22627e-3),
    ),
    "the longer of two tests": (
        "tests_of_different_length/tests.txt",
        {"depth": 7, "force": 5, "time": 4},
        12,
        (0, 33e-9),
        (0, 0.729657e-3),
    ),
}


@MARK("kind", CURVES)
def test_a_curve_of_an_instrument_is_read(kind: str) -> None:
    name, options, points, depth, force = CURVES[kind]
    curve = read(CASES / name, **options)
    assert len(curve) == points
    assert_close([curve.depth.min(), curve.depth.max()], depth, rtol=DIGITS, each=True)
    assert_close([curve.force.min(), curve.force.max()], force, rtol=DIGITS, each=True)


def test_all_tables_with_a_curve_are_read_and_the_others_named() -> None:
    path = CASES / "one_of_three_tables" / "test.hld"
    assert read(path, segment="all") == [read(path)]
    with pytest.raises(ValueError, match=r"0 'Sample Approach Data Points: 6' .6 rows from line 6"):
        read(path, segment=7)
    whole = read(CASES / "afm_table_with_json_head" / "curve.tab", segment="all")
    assert [len(part) for part in whole] == [40, 20]


@MARK(
    "word",
    [
        *("Contact Depth", "Plastic depth", "Max. depth", "residual_displ", "Lateral Disp."),
        *("Film depth", "Permanent depth", "plastische Eindringtiefe", "Profondeur plastique"),
    ],
)
@MARK("known", [True, False])
def test_another_depth_never_is_the_displacement(word: str, known: bool, tmp_path: Path) -> None:
    source = (CASES / "contact_depth_taken" / "dynamic.txt").read_text(encoding="cp1252")
    text = source.replace("Contact Depth", word)
    if known:
        curve = read(written(tmp_path / "a.txt", text.replace("Disp. (nm)", "Displ. (nm)")))
        assert curve.depth.max() == pytest.approx(23.02e-9) or "Disp." in word
        return
    path = written(tmp_path / "a.txt", text.replace("Indent Disp.", "Channel 1"))
    with pytest.raises(ValueError, match=f"depth must be given: .* 7 '{word} .nm.'; give depth="):
        read(path)


@MARK("mark", ["\t", ";", ","])
def test_a_test_that_ends_before_its_neighbour_ends_there(mark: str, tmp_path: Path) -> None:
    source = (CASES / "tests_of_different_length" / "tests.txt").read_text(encoding="utf-8")
    options: dict[str, Any] = {"depth": 3, "force": 1, "time": 0}
    right = read(CASES / "tests_of_different_length" / "tests.txt", **options)
    text = source.replace("\t", mark)
    assert read(written(tmp_path / "tests.txt", text), **options) == right
    # The shorter test stands last, and its lines end early.
    turned = [mark.join((line.split(mark) * 2)[4:12]).rstrip(mark) for line in text.splitlines()]
    path = written(tmp_path / "tests.txt", "\n".join(turned))
    assert read(path, depth=7, force=5, time=4) == right
    lines = text.splitlines()
    fields = lines[4].split(mark)
    lines[4] = mark.join(["", "", "", "", *fields[4:]])
    with pytest.raises(ValueError, match=r"must be finite: line 5 of .* has ''"):
        read(written(tmp_path / "a.txt", "\n".join(lines)), **options)


def test_a_spring_constant_is_asked_for_and_given(tmp_path: Path) -> None:
    source = (CASES / "afm_table_with_json_head" / "curve.tab").read_text(encoding="utf-8")
    path = written(tmp_path / "a.tab", source.replace('"spring constant": 0.05', '"speed": 1'))
    with pytest.raises(ValueError, match=r"depth must be given: .*; spring_constant= in N/m makes"):
        read(path)
    right = read(CASES / "afm_table_with_json_head" / "curve.tab")
    np.testing.assert_array_equal(read(path, spring_constant=0.05).depth, right.depth)
    with pytest.raises(ValueError, match="spring_constant must be positive and finite, got 0"):
        read(path, spring_constant=0)


def test_a_number_of_a_column_has_a_sign_and_many_columns_are_not_all_listed(
    tmp_path: Path,
) -> None:
    path = written(tmp_path / "a.txt", "a\tb\n1\t2\n2\t3\n3\t5\n")
    curve = read(path, depth="-0", force="1", units={"depth": "nm", "force": "nN"})
    assert_close(curve.depth, [-1e-9, -2e-9, -3e-9])
    head = "\t".join([*(f"Channel {k} (V)" for k in range(100)), "Pd (nm)", "Fn (mN)"])
    path = written(tmp_path / "b.txt", head + "\n" + ("\t".join(["1.5"] * 102) + "\n") * 3)
    with pytest.raises(ValueError, match=r"102 columns, likely among them 100 'Pd .nm.'; give"):
        read(path)


# Profiles.


def simpack(kind: int, z: float) -> str:
    """Return a profile of 300 mm radius as Simpack writes it, z downwards."""
    y = np.linspace(-10, 10, 41)
    points = "".join(f"  {a:.4f} {z * a * a / 600:.9f}\n" for a in y)
    return (
        f"header.begin\n  version = 1\n  type = {kind}\nheader.end\nspline.begin\n"
        f"  comment = 'made up'\n  units.len.f = 1000.\n  point.begin\n  ! y z\n{points}"
        f"  point.end\nspline.end\n"
    )


PROFILES: dict[str, tuple[str, str, dict[str, Any]]] = {
    # file name, text, keywords
    "headings": ("a.csv", "x (mm),drop (mm)\n{0}", {}),
    "names with units": ("a.txt", "x_mm\tdrop_mm\n{1}", {}),
    "heights": ("a.csv", "# a comment\nx [mm];height [mm]\n{2}", {}),
    "no names": ("a.dat", "{1}", {"unit": "mm", "drop": 1}),
    "turned round": ("a.csv", "{3}", {"unit": "mm", "x": 1, "drop": 0}),
    "a rail": ("a.prr", simpack(0, 1.0), {}),
    "a wheel": ("A.PRW", simpack(1, -1.0), {}),
}


@MARK("kind", PROFILES)
def test_a_profile_is_read(kind: str, tmp_path: Path) -> None:
    name, text, options = PROFILES[kind]
    x = np.linspace(-10, 10, 41)
    drop = x**2 / 600
    bodies = [
        rows(x, drop),
        rows(x, drop, mark="\t"),
        rows(x, 3 - drop, mark=";", comma=True),
        rows(drop, x),
    ]
    path = written(tmp_path / name, text.format(*bodies))
    for found in (read_profile(path, **options), nacre.SampledProfile.read(path, **options)):
        assert_close(found.x, 1e-3 * x, atol=1e-12)
        assert_close(found.drop, 1e-3 * drop, atol=0.6e-7)  # four decimals


@MARK(
    ("name", "text", "options", "message"),
    [
        ("a.csv", "1,2\n2,3\n3,5\n", {"unit": "mm"}, "drop= or height= must name a column of"),
        ("a.csv", "1,2\n2,3\n3,5\n", {"drop": 1}, "unit must be one of .* for the x of"),
        ("a.csv", "1,2\n2,3\n3,5\n", {"drop": 4}, "drop= must name a column .*, got 4: it has 2"),
        ("a.csv", "1,2\n2,3\n2,5\n", {"unit": "mm", "drop": 1}, "0.002 m comes twice"),
        ("a.csv", "1,2\n2,3\n", {"drop": 1, "height": 1}, "drop and height must not both be given"),
        ("a.csv", "a b\n1 2\n", {}, "two columns, .* of two rows or more, got 2 of 1"),
        ("a.prr", "header.begin\n", {}, "points between point.begin and point.end"),
        ("a.prr", simpack(0, 1.0).replace("units", "other"), {}, "must name its unit of length"),
    ],
)
def test_what_is_no_profile_is_refused(
    name: str, text: str, options: dict[str, Any], message: str, tmp_path: Path
) -> None:
    with pytest.raises(ValueError, match=message):
        read_profile(written(tmp_path / name, text), **options)


# The zero of the force.

TIP, TRUE, YOUNG = Tip.sphere(2.5e-6), 10e3, "body.substrate.young"
SOFT = nacre.HalfSpace(nacre.Elastic(5e3, 0.49))


def approach(offset: float, slope: float = 0.0, seed: int = 1) -> tuple[Array, Array]:
    """Return a curve of a cantilever, half before contact, with a baseline over the force."""
    depth = np.linspace(1e-9, 5e-7, 100)
    load = Indentation(nacre.Elastic(TRUE, 0.49), TIP).curve(approach=depth).load
    piezo = np.concatenate([np.linspace(-5e-7, -1e-9, 100), depth]) + 5e-7
    noise = 0.005 * np.random.default_rng(seed).standard_normal(200)
    baseline = offset + slope * piezo / 1e-6
    return piezo, np.concatenate([np.zeros(100), load]) + (noise + baseline) * load[-1]


@MARK("offset", [0.025, -0.05])
def test_an_offset_of_the_force_is_named_and_then_fitted(offset: float) -> None:
    data = approach(offset)
    nuisance = ["contact_point"]
    with pytest.warns(nacre.NacreWarning, match="force_offset"):
        wrong = fit(data, SOFT, TIP, [YOUNG], noise="absolute", nuisance=nuisance, profile=False)
    assert not all(wrong.identifiable.values())
    nuisance += ["force_offset"]
    right = fit(data, SOFT, TIP, [YOUNG], noise="absolute", nuisance=nuisance)
    low, high = right.intervals[YOUNG]
    assert all(right.identifiable.values())
    assert low < TRUE < high
    assert high - low < 0.05 * TRUE
    assert right.estimates["force_offset"] == pytest.approx(offset * data[1].max(), rel=0.1)


def test_a_slope_of_the_baseline_is_named_and_then_fitted() -> None:
    data = approach(0.025, 0.03)
    nuisance = ["contact_point", "force_offset"]
    with pytest.warns(nacre.NacreWarning, match="force_slope"):
        fit(data, SOFT, TIP, [YOUNG], noise="absolute", nuisance=nuisance, profile=False)
    nuisance += ["force_slope"]
    right = fit(data, SOFT, TIP, [YOUNG], noise="absolute", nuisance=nuisance)
    low, high = right.intervals[YOUNG]
    assert all(right.identifiable.values())
    assert low < TRUE < high
    assert "N/m" in str(right)


# The environment, and arguments.


def test_names_of_files_may_be_in_capitals(tmp_path: Path) -> None:
    solution = nacre.solve(
        nacre.Sphere(5e-3),
        nacre.Elastic(210e9, 0.3),
        load=20.0,
        grid=nacre.Grid((32, 32), (4e-4, 4e-4)),
    )
    for name in ("RESULT.NC", "TABLE.Csv", "FIELDS.VTR", "MAP.PNG"):
        assert solution.save(tmp_path / name).is_file()
    assert nacre.load(tmp_path / "RESULT.NC") == solution
    found = nacre.indent.solve(nacre.Elastic(1e9, 0.3), TIP, load=1e-6)
    assert nacre.load(found.save(tmp_path / "INDENT.NC")) == found
    case = {"shape": nacre.Sphere(5e-3), "body": nacre.Elastic(210e9, 0.3), "load": 1.0}
    case["grid"] = nacre.Grid((32, 32), (2e-4, 2e-4))
    nacre.sweep(case, {"load": [1.0]}, store=tmp_path / "STUDY.NC")
    assert (tmp_path / "STUDY.NC").is_file()


@MARK("encoding", ["utf-8", "cp1252", "cp437", "cp932", "gbk", "ascii"])
def test_a_result_is_printed_in_any_encoding(encoding: str) -> None:
    program = (
        "import nacre\n"
        "film = nacre.Layer(nacre.Elastic(3e9, 0.4), 1e-6, name='α-film')\n"
        "body = nacre.HalfSpace(nacre.Elastic(210e9, 0.3), [film])\n"
        "grid = nacre.Grid((16, 16), (4e-5, 4e-5))\n"
        "solution = nacre.solve(nacre.Sphere(5e-3), body, load=0.01, grid=grid)\n"
        "print(solution, repr(solution))\n"
    )
    environment = {**os.environ, "PYTHONIOENCODING": encoding, "PYTHONWARNINGS": "ignore"}
    run = subprocess.run([sys.executable, "-c", program], capture_output=True, env=environment)
    assert run.returncode == 0, run.stderr
    said = run.stdout.decode(encoding)
    assert "peak pressure" in said
    assert ("ν 0.3" if encoding in ("utf-8", "cp932", "gbk") else "nu 0.3") in said


def run(program: str, **environment: str) -> subprocess.CompletedProcess[str]:
    """Run a program without other numbers of threads than those in `environment`."""
    kept = {k: v for k, v in os.environ.items() if not k.endswith("_NUM_THREADS")}
    return subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, env=kept | environment
    )


THREADS = """
import nacre
from nacre.studies import default_threads
steel, grid = nacre.Elastic(210e9, 0.3), nacre.Grid((16, 16), (1e-4, 1e-4))
print(nacre.Contact(steel, grid).threads, default_threads(), nacre.Convolution([[1.0]]).threads)
print(nacre.Contact(steel, grid, threads=3).threads)
"""


@MARK(
    "environment",
    [
        {"NACRE_NUM_THREADS": "1"},
        {"RAYON_NUM_THREADS": "1"},
        {"OMP_NUM_THREADS": "1"},
        {"OMP_NUM_THREADS": "1,8", "RAYON_NUM_THREADS": "0"},
        {"NACRE_NUM_THREADS": "1", "RAYON_NUM_THREADS": "8", "OMP_NUM_THREADS": "8"},
        {"NACRE_NUM_THREADS": " ", "RAYON_NUM_THREADS": "1", "OMP_NUM_THREADS": "8"},
    ],
    ids=str,
)
def test_the_environment_limits_the_threads(environment: dict[str, str]) -> None:
    assert run(THREADS, **environment).stdout.split() == ["1", "1", "1", "3"]


def test_the_environment_adds_no_threads() -> None:
    free = run(THREADS).stdout
    assert free.split()[-1] == "3"
    assert run(THREADS, NACRE_NUM_THREADS="4000", OMP_NUM_THREADS="1").stdout == free
    assert run(THREADS, OMP_NUM_THREADS="many").stdout == free


def test_a_wrong_number_of_threads_is_named() -> None:
    said = run(THREADS, NACRE_NUM_THREADS="two", OMP_NUM_THREADS="1").stderr
    assert 'ValueError: NACRE_NUM_THREADS must be a whole number of at least 1, got "two"' in said


LIMITED = """
import resource, sys
import numpy as np
import nacre
steel, shape = nacre.Elastic(210e9, 0.3), nacre.Sphere(5e-3)
grid = nacre.Grid((256, 256), (2e-4, 2e-4))
nacre.solve(shape, steel, load=1.0, grid=nacre.Grid((64, 64), (2e-4, 2e-4)))
name, key, left, work = sys.argv[1:]
with open("/proc/self/status") as status:
    used = next(int(line.split()[1]) for line in status if line.startswith(key))
resource.setrlimit(getattr(resource, name), ((used << 10) + (int(left) << 20),) * 2)
kept = []
contact = nacre.Contact(steel, grid) if work == "keep" else None
try:
    for _ in range(400):
        if work == "solve":
            nacre.solve(shape, steel, load=10.0, grid=nacre.Grid((2048, 2048), (2e-4, 2e-4)))
        elif work == "plan":
            kept.append(nacre.Contact(steel, grid))
        elif work == "keep":
            kept.append(contact.solve(shape, load=10.0))
        elif work == "slide":
            arguments = dict(load=10.0, friction=0.3, force=(1.0, 0.0), grid=grid)
            kept.append(nacre.slide(shape, steel, **arguments))
        else:
            kept.append(nacre.Convolution.of_bodies(steel, grid).apply(np.ones((256, 256))))
except MemoryError as error:
    kept.clear()
    print(error)
"""


@pytest.mark.skipif(sys.platform != "linux", reason="limits are those of Linux")
@MARK("work", ["solve", "plan", "keep", "slide", "apply"])
@MARK(
    ("limit", "used", "left"),
    [
        pytest.param("RLIMIT_AS", "VmSize:", 60, marks=pytest.mark.slow),
        pytest.param("RLIMIT_AS", "VmSize:", 170, marks=pytest.mark.slow),
        ("RLIMIT_DATA", "VmData:", 100),
    ],
)
def test_a_limit_of_memory_is_an_error(limit: str, used: str, left: int, work: str) -> None:
    command = [sys.executable, "-c", LIMITED, limit, used, str(left), work]
    # Otherwise glibc reserves 64 MiB for each of the first threads, beside what they use.
    environment = {**os.environ, "MALLOC_ARENA_MAX": "1"}
    ended = subprocess.run(command, capture_output=True, text=True, env=environment)
    assert ended.returncode == 0, ended.stderr
    said = re.fullmatch(
        r"a grid of \[(\d+), \1\] cells needs about (\d+) MiB, and (\d+) MiB are available; take "
        "fewer cells\n",
        ended.stdout,
    )
    assert said is not None, ended.stdout
    assert int(said[2]) >= int(said[3])


def test_without_docstrings_all_works() -> None:
    program = "import nacre.cli; nacre.cli.main(['schema'])"
    run = subprocess.run([sys.executable, "-OO", "-c", program], capture_output=True)
    assert run.returncode == 0, run.stderr


def test_an_indentation_goes_to_workers() -> None:
    test = Indentation(
        nacre.HalfSpace(nacre.RIGID, [nacre.Layer(nacre.Elastic(3e9, 0.4), 1e-6)]), TIP
    )
    sticky = Indentation(nacre.Elastic(3e9, 0.4), TIP, adhesion=Adhesion.jkr(0.05))
    for one in (test, sticky):
        for other in (pickle.loads(pickle.dumps(one)), copy.deepcopy(one), copy.copy(one)):
            assert other.at(load=1e-6).approach == one.at(load=1e-6).approach


class Quantity:
    """A number with a unit, as those of pint."""

    def __init__(self, magnitude: Any, units: str) -> None:
        self.magnitude, self.units = magnitude, units
        self.dimensionless = units == ""

    def to_base_units(self) -> Quantity:
        return self

    def __array__(self, dtype: Any = None, copy: Any = None) -> Array:
        return np.asarray(self.magnitude, dtype=np.float64)

    def __float__(self) -> float:
        return float(self.magnitude)


def test_numbers_with_units_and_masks_are_refused() -> None:
    values = np.array([1.0, 2.0, 3.0])
    masked = np.ma.masked_array(values, [False, True, False])
    for wrong, message in (
        (Quantity(values, "mN"), "force must be a real number or array in SI units"),
        ([Quantity(1.0, "mN")] * 3, "force must be a real number or array in SI units"),
        (masked, "force must be a real array without a mask"),
    ):
        with pytest.raises(TypeError, match=message):
            Curve(values, wrong)
    with pytest.raises(TypeError, match="load must be a real number or array in SI units"):
        nacre.indent.solve(nacre.Elastic(1e9, 0.3), TIP, load=Quantity(1.0, "mN"))
    assert plain("load", Quantity(1.0, "")) == 1.0


def test_labelled_axes_are_put_in_order() -> None:
    import xarray

    values = np.arange(6.0).reshape(2, 3)
    image = xarray.DataArray(values, dims=("y", "x"))
    np.testing.assert_array_equal(plain("heights", image), values.T)
    np.testing.assert_array_equal(plain("heights", image.T), values.T)
    np.testing.assert_array_equal(plain("heights", image.rename(x="a", y="b")), values)
    with pytest.raises(ValueError, match="heights must have the dimensions x and y, got z, x"):
        plain("heights", image.rename(y="z"))
    with pytest.raises(TypeError, match="with a unit"):
        plain("heights", image.assign_attrs(units="µm"))


# Solves.


def printed(solution: nacre.Solution, name: str) -> str:
    """Return the value of a row of the printed solution."""
    rows = [line for line in str(solution).splitlines() if line.startswith(f"{name}  ")]
    assert len(rows) == 1
    return rows[0].removeprefix(name).strip()


@MARK(
    ("grid", "body", "counterbody", "datum"),
    [
        (nacre.Grid.line(256, 1e-3), STEEL, STEEL, "1 mm"),
        (nacre.Grid.line(384, 1.5e-3), STEEL, None, "1.5 mm"),
        (nacre.Grid.line(256, 1e-3), FILM, STEEL, "1 mm"),
        (nacre.Grid.line(256, 1e-3), FILM, None, None),
        (nacre.Grid((8, 512), (1e-3, 2e-3), periodic=(True, False)), STEEL, None, "2 mm"),
        (nacre.Grid((8, 512), (1e-3, 2e-3), periodic=(True, False)), FILM, None, None),
        (nacre.Grid((64, 64), (1e-3, 1e-3)), STEEL, None, None),
    ],
)
def test_the_approach_of_a_line_contact_names_its_datum(
    grid: nacre.Grid, body: nacre.Elastic, counterbody: nacre.Elastic | None, datum: str | None
) -> None:
    shape = nacre.Cylinder(10e-3) if sum(grid.shape) > 128 else nacre.Sphere(10e-3)
    load = 1e4 if grid.is_line else 10.0
    row = printed(nacre.solve(shape, body, counterbody, load=load, grid=grid), "approach")
    if datum is None:
        assert "away" not in row
    else:
        assert row.endswith(f"m, from the surface {datum} away")
        assert "±" not in row


def test_two_rollers_approach_as_johnson_says() -> None:
    # Johnson (1985), section 5.6, from the approach of a grid: theory/influence.md, eq. (datum).
    load, radii, width = 1e5, (15e-3, 30e-3), 2e-3
    bodies = (STEEL, nacre.Elastic(100e9, 0.2))
    radius = nacre.hertz.equivalent_radius(*radii)
    hertz = nacre.hertz.Line(radius, nacre.hertz.contact_modulus(*bodies), load)
    solution = nacre.solve(
        nacre.Cylinder(radius), *bodies, load=load, grid=nacre.Grid.line(512, width)
    )
    approach, expected = solution.approach, 0.0
    for one, of in zip(bodies, radii, strict=True):
        compliance = load * (1 - one.poisson**2) / (np.pi * one.young)
        approach += 2 * compliance * np.log(2 * of / (math.e * width))
        expected += compliance * (2 * np.log(4 * of / hertz.half_width) - 1)
    # The contact is 85 cells wide, of which the rim may err by a part.
    assert abs(approach / expected - 1) < 1e-4


ALUMINIUM, HARD = nacre.Elastic(2 * 23e9 * 1.31, 0.31), nacre.Elastic(2 * 82e9 * 1.28, 0.28)


def rolled(friction: float, force: float, cells: int = 216, **keywords: Any) -> Any:
    """Return a roller of aluminium on one of steel, half-width 0.1 mm, at a part of full slip."""
    load = 16.2019e3
    return nacre.roll(
        nacre.Cylinder(25e-3),
        ALUMINIUM,
        HARD,
        grid=nacre.Grid.line(cells, 0.216e-3),
        load=load,
        friction=friction,
        force=(force * friction * load, None),
        **keywords,
    )


@MARK(
    ("friction", "creepage"),
    # CONTACT prints 5.260e-4 for the first; the others by bisection with given creepages.
    [(1e-4, 5.261e-4), (1e-3, 5.253e-4), (2e-3, 5.236e-4), (5e-3, 5.166e-4)],
)
def test_free_rolling_with_little_friction_converges(friction: float, creepage: float) -> None:
    # The right values have four digits.
    assert rolled(friction, 0.0).creepage[0] == pytest.approx(creepage, rel=2e-4)


@MARK("friction", [1e-5, 1e-4, 7e-4, 3e-3])
@MARK("force", [-0.97, 0.0, 0.4, 0.97])
@MARK("direction", ["+y", "-y"])
def test_rolling_with_little_friction_is_that_of_its_creepage(
    friction: float, force: float, direction: Literal["+y", "-y"]
) -> None:
    found = rolled(friction, force, 150, direction=direction)
    again = nacre.roll(
        nacre.Cylinder(25e-3),
        ALUMINIUM,
        HARD,
        grid=nacre.Grid.line(150, 0.216e-3),
        load=found.normal.load,
        friction=friction,
        creepage=found.creepage,
        direction=direction,
    )
    # Displacements within the tolerance of 1e-8 tell a force to 1e-8 of the load, or less.
    assert_close(again.force, found.force, atol=1e-8 * found.normal.load)


def test_a_load_at_the_limit_of_the_hardness_is_refused() -> None:
    shape = nacre.rough.random_surface(
        (32, 32), (64e-6, 48e-6), hurst=0.8, rms_slope=0.08, shortest=8e-6, longest=48e-6, rng=2
    )
    hardness = 0.1 * STEEL.plane_strain_modulus
    bears = hardness * 64e-6 * 48e-6
    full = nacre.solve(shape, STEEL, load=(1 - 1e-9) * bears, hardness=hardness)
    assert full.contact_area == pytest.approx(64e-6 * 48e-6)
    for part in (1 - 1e-15, 1.0, 1 + 1e-15, 1.1):
        with pytest.raises(ValueError, match="all of them yield, no approach is determined"):
            nacre.solve(shape, STEEL, load=part * bears, hardness=hardness)
