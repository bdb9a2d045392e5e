"""Profiles in forms with a head are read with its spacing and units; damaged ones are refused."""

import struct
import time
import tracemalloc
import zipfile
import zlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest

import nacre
from support import assert_close

STEP, UM = 2.5e-7, 1e-6
Z = 0.25 * np.cos(np.arange(51) / 7)
"""Heights [µm]."""
DIGITS = 5e-7 / 0.25
"""Heights are written with six decimals."""


def text(values: Any = Z, form: str = ".6f") -> str:
    return "\n".join(format(value, form) for value in values)


def smd(
    x: str = "CX\0 I\0 51 mm\0 1.0e0 D\0 2.5e-4",
    z: str = "CZ\0 A\0 51 um\0 1.0e0 D\0",
    end: str = "\x03",
    numbers: str = "",
) -> str:
    """Return SMD as ISO 5436-2 has it: texts end in a zero, and records in a sign of their own."""
    head = f"ISO 5436-2:2012\0file\0\nPRF\0 1 ISO5436\0\n{x}\n{z}\n{end}\n"
    return f"{head}DATE: 1-May\0\n{end}\n{numbers or text()}\n{end}\n4711\n{end}\n\x1a"


def prf(
    x: str = "CX M 5.1e+001 MM 1.000000e+000 D",
    z: str = "CZ M 5.1e+001 UM 1.000000e-006 L",
    spacing: str = "SPACING CX 2.5e-004",
) -> str:
    numbers = text(1e6 * Z, ".0f")
    return (
        f"1 2\nSG2004 0.0e+000 PRF\n{x}\n{z}\nEOR\nCOMMENT\n{spacing}\nEOR\n{numbers}\nEOR\nEOF\n"
    )


def sdf(count: str = "51", scale: str = "1E-06", numbers: str = "", name: str = "aNPL-V1.0") -> str:
    head = f"{name}\nManufacID = made up\nNumPoints = {count}\nNumProfiles = 1\nXscale = 2.5E-07\n"
    head += f"Yscale = 0\nZscale = {scale}\nZresolution = -1\nDataType = 7\nCheckType = 0\n*\n"
    return f"{head}{numbers or text()}\n*\nComment = any\n*\n"


READ = {
    "smd": smd(),
    "smd, letters": smd("CX I 51 mm 1.0e0 D 2.5e-4", "CZ A 51 um 1.0e0 D", "EOR"),
    "smd, another order": smd("CX I 51 2.5e-4 MM", "CZ A 51 1.0 UM D", "EOR"),
    "smd, factors": smd("CX I 51 um 1e2 D 2.5e-3", "CZ A 51 mm 1e-3 D"),
    "smd, in metres": smd("CX I 51 m 1.0 D 2.5e-7", "CZ A 51 m 1e-6 D"),
    "prf": prf(),
    "prf, in mm": prf(z="CZ M 51 MM 1.0e-009 L"),
    "prf, in µm": prf(x="CX M 51 UM 1.0 D", spacing="SPACING CX 0.25"),
    "sdf": sdf(),
    "sdf of ISO": sdf(name="aISO-1.0"),
    "sdf of BCR": sdf(name="aBCR - 1.0"),
    "sdf in pm": sdf(scale="1e-12", numbers=text(1e6 * Z, ".0f")),
}


@pytest.mark.parametrize("newline", ["\n", "\r\n"])
@pytest.mark.parametrize("name", READ)
def test_heads_have_the_spacing_and_the_units(name: str, newline: str, tmp_path: Path) -> None:
    for ending in (name[:3], "txt"):  # the beginning of a file says what it is
        path = tmp_path / f"a.{ending}"
        path.write_text(READ[name], encoding="latin-1", newline=newline)
        read = nacre.SampledProfile.read(path)
        assert_close(read.x, STEP * np.arange(51), rtol=1e-12)
        assert_close(read.drop, UM * (Z.max() - Z), rtol=2 * DIGITS)
        with pytest.raises(ValueError, match=r"holds a profile, .*SampledProfile.read reads it"):
            nacre.HeightMap.read(path)
        with pytest.raises(
            ValueError, match=r"unit=.um. and spacing=1\.0 must be left out: the head"
        ):
            nacre.SampledProfile.read(path, unit="um", spacing=1.0)


DAMAGED = {
    "no step": (smd("CX I 51 mm 1.0e0 D", "CZ A 51 um 1.0 D"), "a number or a unit is missing"),
    "absolute places": (smd("CX A 51 mm 1.0e0 D"), r"must have even steps \(CX I\)"),
    "no unit": (smd("CX I 51 1.0e0 D 2.5e-4"), "a number or a unit is missing"),
    "an unknown unit": (smd(z="CZ A 51 V 1.0e0 D"), "a number or a unit is missing"),
    "fewer heights": (smd(numbers=text(Z[:-1])), "51 points, 2.5e-07 m apart, .*, and it has 50"),
    "other counts": (smd("CX I 50 mm 1.0e0 D 2.5e-4"), "its head has 50 places and 51 heights"),
    "cut off": (smd()[:300], "51 points, .* and it has 2[0-9] heights"),
    "cut off in the head": (smd()[:60], "a number or a unit is missing"),
    "a word": (smd(numbers=text(Z[:-1]) + "\n" + 9999 * "x"), "could not convert"),
    "two axes": (smd("CX I 51 mm 1 D 2.5e-4\nCX I 51 mm 1 D 9e-4"), "several lines CX or CZ"),
    "two profiles": (smd(z="CZ A 51 um 1 D\nCZ A 51 um 1 D"), "several lines CX or CZ"),
    "two spacings": (prf(spacing="SPACING CX 2.5e-4\nSPACING CX 5e-4"), "several lines SPACING"),
    "a unit below 0": (smd(z="CZ A 51 um -1.0 D"), "heights in -1e-06 m"),
    "no spacing": (prf(spacing="SPACING CY 1"), "a number or a unit is missing"),
    "no number": (prf(spacing="SPACING CX"), "a number or a unit is missing"),
    "a step of 0": (prf(spacing="SPACING CX 0"), "0 m apart"),
    "a step below 0": (prf(spacing="SPACING CX -1e-3"), "-1e-06 m apart"),
    "no end of steps": (prf(spacing="SPACING CX inf"), "inf m apart"),
    "half a point": (sdf(count="50.5"), "50.5 points"),
    "no count": (sdf(count="nan"), "nan points"),
    "many points": (sdf(count="1e400"), "inf points"),
    "no scale": (sdf(scale=""), "could not convert"),
}


@pytest.mark.parametrize("name", DAMAGED)
def test_damaged_profiles_are_refused_in_a_sentence(name: str, tmp_path: Path) -> None:
    content, message = DAMAGED[name]
    path = tmp_path / "a.smd"
    path.write_text(content, encoding="latin-1")
    for read in (nacre.SampledProfile.read, nacre.HeightMap.read):
        with pytest.raises(
            ValueError, match=f"must be whole, as a profile in S.*{message}"
        ) as error:
            read(path)
        assert len(str(error.value)) < 500


def test_missing_points_of_sdf_are_bridged(tmp_path: Path) -> None:
    lines = text().split("\n")
    lines[20] = "BAD"
    (tmp_path / "a.sdf").write_text(sdf(numbers="\n".join(lines)), encoding="ascii")
    with pytest.warns(nacre.NacreWarning, match="1 of 51 points .* are missing"):
        read = nacre.SampledProfile.read(tmp_path / "a.sdf")
    assert_close(read.x, STEP * np.delete(np.arange(51), 20), rtol=1e-12)


@pytest.mark.parametrize(("code", "kind"), [(5, "<i2"), (6, "<i4"), (3, "<f4"), (7, "<f8")])
def test_a_single_profile_of_a_binary_sdf_is_a_line(code: int, kind: str, tmp_path: Path) -> None:
    counts = np.round(1000 * Z).astype(kind)
    numbers = struct.pack("<HHddddBBB", 51, 1, STEP, 0.0, 1e-9, -1.0, 0, code, 0)
    head = b"bISO-1.0" + b"made up".ljust(10) + 2 * b"010120261200" + numbers
    path = tmp_path / "a.sdf"
    path.write_bytes(head + counts.tobytes())
    read = nacre.SampledProfile.read(path)
    assert_close(read.x, STEP * np.arange(51), rtol=1e-12)
    assert_close(read.drop, 1e-9 * (counts.max() - counts.astype(float)), rtol=1e-12)
    with pytest.raises(ValueError, match=r"holds a profile, .*SampledProfile.read reads it"):
        nacre.HeightMap.read(path)
    with pytest.raises(ValueError, match="spacing must be left out for the line scan"):
        nacre.SampledProfile.read(path, spacing=1e-6)


def column(heading: str) -> str:
    return f"{heading}\n{text()}\n" if heading else text()


@pytest.mark.parametrize(
    ("heading", "options"),
    [
        ("", {"unit": "um"}),
        ("", {"unit": ("mm", "um")}),
        ("", {"unit": "um", "height": 0}),
        ("z [um]", {}),
        ("height_um", {}),
        ("Profile", {"unit": "um", "height": "Profile"}),
        ("# unit: um", {}),
    ],
)
@pytest.mark.parametrize("ending", ["txt", "csv"])
def test_spacing_takes_a_single_column(
    heading: str, options: dict[str, Any], ending: str, tmp_path: Path
) -> None:
    path = tmp_path / f"a.{ending}"
    path.write_text(column(heading), encoding="utf-8")
    read = nacre.SampledProfile.read(path, spacing=STEP, **options)
    assert_close(read.x, STEP * np.arange(51), rtol=1e-12)
    assert_close(read.drop, UM * (Z.max() - Z), rtol=2 * DIGITS)


def test_spacing_stands_in_for_numbers_of_points(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    rows = "\n".join(f"{k},{abs(z):.6f}" for k, z in enumerate(Z))
    path.write_text(f"no,drop\n{rows}\n", encoding="utf-8")
    read = nacre.SampledProfile.read(path, unit="um", spacing=STEP)
    assert_close(read.x, STEP * np.arange(51), rtol=1e-12)
    assert_close(read.drop, UM * abs(Z), rtol=2 * DIGITS)


REFUSED: list[tuple[str, dict[str, Any], str]] = [
    (column(""), {"unit": "um"}, "must have two columns, .* got 1 of 51; spacing= goes with"),
    (column(""), {"spacing": STEP}, "for the heights of .* names none"),
    (column("error"), {"spacing": STEP, "unit": "um"}, "drop= or height= must name .* 0 'error'"),
    (column("z error [um]"), {"spacing": STEP}, "drop= or height= must name .* 0 'z error'"),
    (column("x [um]"), {"spacing": STEP}, "drop= or height= must name .* 0 'x'"),
    (column(""), {"spacing": STEP, "x": 0}, "x must be left out where spacing is given, got 0"),
    *(
        (column(""), {"spacing": wrong, "unit": "um"}, "spacing must be finite and above 0, got")
        for wrong in (0.0, -1e-6, float("inf"), float("nan"))
    ),
    ("0,1\n1,2\n2,4\n", {"spacing": STEP, "unit": "um"}, "height= must name a column of .* 2 col"),
]


@pytest.mark.parametrize(("content", "options", "message"), REFUSED)
def test_what_is_not_certain_in_a_column_is_asked_for(
    content: str, options: dict[str, Any], message: str, tmp_path: Path
) -> None:
    (tmp_path / "a.csv").write_text(content, encoding="utf-8")
    with pytest.raises(ValueError, match=message):
        nacre.SampledProfile.read(tmp_path / "a.csv", **options)


@pytest.mark.parametrize(("column", "hint"), [(None, True), (0, False)])
def test_a_column_that_was_named_is_not_asked_for(
    column: int | None, hint: bool, tmp_path: Path
) -> None:
    path = tmp_path / "a.csv"
    path.write_text("x,drop\n" + "\n".join(f"{k},{k * k / 9:g}" for k in range(9)))
    with pytest.raises(ValueError, match=r"unit must be a pair, .* or spacing= given") as error:
        nacre.SampledProfile.read(path, unit="mm", x=column)
    assert ("x= can name other ones" in str(error.value)) is hint


BOMBS: dict[str, Callable[[], str]] = {
    "smd": lambda: smd(numbers=4_000_000 * "0 "),
    "prf": lambda: prf() + 8_000_000 * "EOR\n"[:1],
    "sdf": lambda: sdf(count="1e18", numbers=4_000_000 * "0\n"),
}


@pytest.mark.parametrize("name", BOMBS)
def test_numbers_that_the_head_does_not_have_are_not_read(name: str, tmp_path: Path) -> None:
    (tmp_path / "a.smd").write_text(BOMBS[name](), encoding="latin-1")
    if name == "prf":  # what follows the last record is left out
        assert nacre.SampledProfile.read(tmp_path / "a.smd").x.size == 51
    else:
        with pytest.raises(ValueError, match=r"must be whole, .* and it has 4000000 heights"):
            nacre.SampledProfile.read(tmp_path / "a.smd")


def unpacked(path: Path) -> None:
    """Write zeros that unpack to 200 MB in the form of a file's ending."""
    kind, cells = path.suffix, (5000, 5000)
    if kind in (".h5", ".nc"):
        with h5py.File(path, "w") as file:
            chunks = {"chunks": (500, 500), "compression": "gzip", "fillvalue": 0.0}
            file.create_dataset("height", cells, "f8", **chunks)
    elif kind == ".mat":
        head = b"MATLAB 5.0".ljust(124) + b"\x00\x01IM"
        packed = zlib.compress(struct.pack("<II", 14, 200_000_000) + bytes(100_000))
        path.write_bytes(head + struct.pack("<II", 15, len(packed)) + packed)
    elif kind == ".sdf":
        numbers = struct.pack("<HHddddBBB", *cells, STEP, STEP, 1e-9, -1.0, 0, 7, 0)
        path.write_bytes(b"bISO-1.0" + b"made up".ljust(10) + 2 * b"010120261200" + numbers)
    else:
        with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
            archive.writestr("height.npy", bytes(20_000_000))


@pytest.mark.parametrize("ending", ["h5", "nc", "mat", "sdf", "npz", "zip", "xlsx"])
def test_what_would_unpack_out_of_proportion_is_refused(ending: str, tmp_path: Path) -> None:
    path = tmp_path / f"a.{ending}"
    path.write_bytes(b"\x89HDF\r\n\x1a\n")
    with pytest.raises(ValueError, match=r"cannot be read|must be text|has no format"):
        nacre.HeightMap.read(path)  # which imports the libraries
    unpacked(path)
    tracemalloc.start()
    start = time.process_time()
    try:
        with pytest.raises(
            ValueError, match=r"nothing out of proportion: .* would unpack to [0-9]+ b"
        ):
            nacre.HeightMap.read(path, unit="m", spacing=1e-6)
        assert tracemalloc.get_traced_memory()[1] < 200e6
    finally:
        tracemalloc.stop()
    assert time.process_time() - start < 1  # of the processor
