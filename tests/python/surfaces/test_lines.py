"""Profiles and traces as instruments write them: read right, or refused with what would help."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

import nacre
from nacre._tools.text import unit_of
from nacre.indent import read as read_curve
from nacre.surfaces import heights as _heights
from support import Patch, assert_close

Array = npt.NDArray[np.float64]
MARK = pytest.mark.parametrize

pytestmark = pytest.mark.filterwarnings("ignore:Could not import mpi4py:ImportWarning")

X = 0.5 * np.arange(40)
ROUGH = np.cumsum(np.random.default_rng(0).standard_normal(40)).round(4)
TIME, SPEED = 0.1 * np.arange(40), 5 + 0.01 * np.random.default_rng(1).standard_normal(40)
COUNT = 1.0 + np.arange(40)
UNEVEN = X + 0.1 * np.random.default_rng(2).random(40)


def table(*columns: npt.NDArray[Any], head: str = "", mark: str = ",", comma: bool = False) -> str:
    lines = [mark.join(f"{number:.4f}" for number in row) for row in zip(*columns, strict=True)]
    text = "\n".join(lines) + "\n"
    return (f"{head}\n" if head else "") + (text.replace(".", ",") if comma else text)


def written(path: Path, text: str) -> Path:
    path.write_text(text, encoding="utf-8")
    return path


MAP = table(*np.random.default_rng(3).standard_normal((8, 12)))
ROWS = MAP.splitlines(keepends=True)


@MARK(
    "text",
    [
        MAP,
        MAP.replace(",", ";"),
        MAP.replace(",", " ; "),
        MAP.replace(",", " "),
        MAP.replace(",", ",\u2003"),
        MAP.replace(",", ";").replace(".", ","),
        MAP.replace(",", ";").replace(".", ",", 1),
        MAP.replace("0", "\N{FULLWIDTH DIGIT ZERO}"),
        MAP.replace("1", "0x1", 1),
        MAP.replace("1", "1_1"),
        MAP.replace("2", "nan").replace("3", "bad"),
        MAP.replace("\n", ",\n"),
        MAP.replace("\n", ",,\n", 2),
        MAP.replace("\n", "\n\n# no row\n"),
        MAP.replace("\n", "\nrest\n", 2),
        MAP[:-2] + "x\n",
        MAP + "end\n",
        MAP + "1,2\n",
        MAP + "# Channel: other\n" + MAP,
        "".join(row[: -7 * (k % 2) - 2] + "\n" for k, row in enumerate(ROWS)),
        '"' + MAP.replace(",", '","').replace("\n", '"\n"')[:-1],
    ],
)
def test_lines_are_read_at_once_as_they_are_one_by_one(
    text: str, tmp_path: Path, monkeypatch: Patch
) -> None:
    path = written(tmp_path / "a.csv", text)

    def outcome() -> tuple[object, ...]:
        try:
            heights, *others = _heights.text(path)
        except ValueError as error:
            return (str(error),)
        return (heights.tobytes(), heights.shape, *others)

    at_once = outcome()
    monkeypatch.setattr(_heights, "_block", lambda *arguments: None)
    assert outcome() == at_once


@MARK("ending", ["csv", "txt", "dat"])
@MARK(
    "text",
    [
        table(TIME, X, ROUGH, head="time,x,z"),
        table(TIME, X, ROUGH, head="t (s),x (um),z (um)"),
        table(X, ROUGH, SPEED, head="x,z,speed"),
        table(X, ROUGH, SPEED, head="Weg (mm);Höhe (µm);Geschwindigkeit (mm/s)", mark=";"),
        table(X, ROUGH, head="Zeit;Höhe", mark=";", comma=True),
        table(COUNT, TIME, X, ROUGH, SPEED, head="No,Time (s),X (um),Z (um),v (mm/s)"),
        table(TIME, X, ROUGH),
        table(X, ROUGH, TIME, mark="\t"),
        table(COUNT, TIME, X, ROUGH),
        table(TIME, UNEVEN, ROUGH),
        table(*np.array([TIME, X, ROUGH]).T),
    ],
)
def test_a_profile_with_other_columns_is_no_map(text: str, ending: str, tmp_path: Path) -> None:
    path = written(tmp_path / f"a.{ending}", text)
    for options in ({"unit": "um", "spacing": 1e-6}, {"unit": "um"}):
        with pytest.raises(ValueError, match=r"holds a profile, .* SampledProfile.read"):
            nacre.HeightMap.read(path, **options)


@MARK(
    ("text", "options", "step"),
    [
        (table(TIME, X, ROUGH, head="time,x,z"), {"unit": "um"}, 0.5e-6),
        (table(X, ROUGH, TIME, head="x (mm),z (um),t (s)"), {}, 0.5e-3),
        (
            table(COUNT, TIME, X, ROUGH, head="no;time;Abstand (mm);Höhe (µm)", mark=";"),
            {},
            0.5e-3,
        ),
        (table(TIME, X, ROUGH, head="time;s (mm);h (µm)", mark=";", comma=True), {}, 0.5e-3),
        (table(TIME, X, ROUGH), {"unit": "um", "x": 1, "height": 2}, 0.5e-6),
    ],
)
def test_places_beside_times_are_the_places(
    text: str, options: dict[str, Any], step: float, tmp_path: Path
) -> None:
    profile = nacre.SampledProfile.read(written(tmp_path / "a.csv", text), **options)
    assert_close(np.diff(profile.x), step, rtol=1e-9)
    assert_close(profile.drop, 1e-6 * (ROUGH.max() - ROUGH), atol=1e-18)


def test_two_columns_in_order_are_asked_about(tmp_path: Path) -> None:
    path = written(tmp_path / "a.csv", table(TIME, X, ROUGH))
    with pytest.raises(ValueError, match="x= must name a column"):
        nacre.SampledProfile.read(path, unit="um", height=2)


def crown(**changes: str) -> str:
    """Return a crown of 41 points in mm and µm, 1.25 at the ends; `p7` is the height of point 7."""
    x = np.linspace(-5, 5, 41)
    heights = [changes.get(f"p{k}", f"{-0.05 * place**2:.5f}") for k, place in enumerate(x)]
    lines = [f"{place:g},{height}" for place, height in zip(x, heights, strict=True)]
    return "x (mm),height (um)\n" + "\n".join(lines) + "\n"


@MARK("missing", ["NaN", "", "---", "BAD", "-9999", "-25400", "1e37"])
def test_points_that_were_not_measured_are_counted(missing: str, tmp_path: Path) -> None:
    path = written(tmp_path / "a.csv", crown(p5=missing, p19=missing, p20=missing, p21=missing))
    with pytest.warns(nacre.NacreWarning, match="4 of 41 points .* the widest gap is 1 mm"):
        profile = nacre.SampledProfile.read(path)
    assert profile.x.size == 37
    # The highest that is left lies at 0.5 mm, 0.0125 µm below the top.
    assert profile.drop.max() == pytest.approx(1.2375e-6, rel=1e-9)


def test_an_unknown_mark_of_a_missing_point_is_asked_about(tmp_path: Path) -> None:
    path = written(tmp_path / "a.csv", crown(p7="-8888", p9="-8888"))
    with pytest.warns(nacre.NacreWarning, match="2 of 41 drops .* 8.888 mm, is far .* mark of a"):
        nacre.SampledProfile.read(path)
    # A step and a deep chamfer are none.
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        nacre.SampledProfile.read(written(path, crown(p0="-900", p40="-900")))
        nacre.SampledProfile.read(written(path, crown()))


def test_most_of_a_profile_must_be_measured(tmp_path: Path) -> None:
    for count in (25, 41):
        text = crown(**{f"p{k}": "NaN" for k in range(count)})
        with pytest.raises(ValueError, match=f"half its points measured, .* {41 - count} of 41"):
            nacre.SampledProfile.read(written(tmp_path / "a.csv", text))


@MARK(
    ("text", "unit", "size"),
    [
        (text, unit, size)
        for unit, size, texts in [
            ("m", 1e-6, "um,µm,μm,UM,micron,microns,Micrometer,micrometres,Mikrometer,micromètres"),
            ("m", 1e-6, "micrómetro,micrometri,micras,mikrometern"),
            ("m", 1e-3, "mm,MM,millimeter,Millimetres,milímetros,millimetri"),
            ("m", 1e-9, "nm,NM,nanometers,Nanometer,nanómetros"),
            ("m", 1e-10, "Å,angstrom,Ångström,angstroms"),
            ("m", 1e-2, "cm,Zentimeter,centimètre"),
            ("m", 0.0254, "inch,inches"),
            ("m", 0.0254e-3, "mil,mils"),
            ("N", 1e-3, "mN,millinewtons,Millinewton"),
            ("N", 1e-6, "uN,µN,micronewton"),
            ("s", 1.0, "s,sec,seconds,Sekunden,secondes,segundos"),
            ("s", 1e-3, "ms,milliseconds"),
        ]
        for text in texts.split(",")
    ],
)
def test_units_come_in_words_of_several_languages(text: str, unit: str, size: float) -> None:
    known = unit_of(text)
    assert known is not None
    assert known[0] == unit
    assert known[1] == pytest.approx(size, rel=1e-12)


@MARK("text", ["Nm", "V", "deg", "MPa", "points", "micro", "milli", "metering"])
def test_other_words_are_no_units(text: str) -> None:
    assert unit_of(text) is None


@MARK(
    "head",
    [
        "X_(microns),Z (Nanometer)",
        "Position [Mikrometer],Raw nm",
        "LENGTH UM,HEIGHT NM",
        "x in micrometres,z in nanometres",
        "Distancia (micras),Altura (nanómetros)",
    ],
)
@MARK("end", ["", ",", ",,"])
def test_headings_name_units_and_ends_of_lines_no_columns(
    head: str, end: str, tmp_path: Path
) -> None:
    text = table(X, ROUGH).replace("\n", f"{end}\n")
    path = written(tmp_path / "a.csv", f"Scan Data\n{head}{end[:1]}\n{text}")
    profile = nacre.SampledProfile.read(path, x=0, height=1)
    assert_close(profile.x, 1e-6 * X, atol=1e-18)
    assert_close(profile.drop, 1e-9 * (ROUGH.max() - ROUGH), atol=1e-18)


def test_heights_without_a_unit_have_that_of_the_places(tmp_path: Path) -> None:
    path = written(tmp_path / "a.csv", "X_(microns),y1\n" + table(X, ROUGH))
    with pytest.warns(nacre.NacreWarning, match="name no unit, .* of the positions, microns"):
        profile = nacre.SampledProfile.read(path, height=1)
    assert np.ptp(profile.drop) == pytest.approx(1e-6 * np.ptp(ROUGH), rel=1e-12)
    path = written(path, "X (um),y1 (furlong)\n" + table(X, ROUGH))
    with pytest.raises(ValueError, match=r"heights of .*, got 'furlong'"):
        nacre.SampledProfile.read(path, height=1)


def test_a_curve_has_names_and_units_in_other_languages(tmp_path: Path) -> None:
    text = "Zeit (Sekunden);Eindringtiefe (Nanometer);Prüfkraft (Millinewton)\n"
    text += "0,0;0,0;0,0\n0,5;10,5;0,25\n1,0;20,0;0,75\n"
    curve = read_curve(written(tmp_path / "a.txt", text))
    assert_close(curve.depth, [0, 10.5e-9, 20e-9], rtol=1e-12)
    assert_close(curve.force, [0, 0.25e-3, 0.75e-3], rtol=1e-12)
    assert curve.time is not None
    assert_close(curve.time, [0, 0.5, 1])


@MARK("mark", ['" ', '"', "* ", "> "])
@MARK("ending", ["ban", "whl"])
def test_a_miniprof_marks_points(mark: str, ending: str, tmp_path: Path) -> None:
    y = np.linspace(-36, 36, 37)
    lines = [
        f"{mark if 3 < k < 12 else '  '}{place:.7E}\t {0.002 * place**2:.7E}"
        for k, place in enumerate(y)
    ]
    head = f"Filename=a.{ending}\nXYPoints=37\nRefPoint1=0.0000, 0.0000\nColumnDef=X,Y\n\n"
    path = written(tmp_path / f"a.{ending}", head + "\n".join(lines) + "\n")
    for options in ({}, {"unit": "mm"}):
        profile = nacre.SampledProfile.read(path, drop="Y", **options)  # type: ignore[arg-type]
        assert_close(profile.x, 1e-3 * y, atol=1e-15)
        assert_close(profile.drop, 2e-6 * y**2, atol=1e-12)
    with pytest.raises(ValueError, match=r"drop= or height= must name a column .* 0 'X', 1 'Y'"):
        nacre.SampledProfile.read(path)


@MARK(("points", "traces"), [(30, 4), (4, 30), (7, 6)])
@MARK("counted", [True, False])
@MARK("ending", ["txt", "asc", "csv"])
def test_traces_in_columns_are_all_read(
    points: int, traces: int, counted: bool, ending: str, tmp_path: Path
) -> None:
    z = np.random.default_rng(3).standard_normal((points, traces)).round(4)
    lines = [
        "\t".join([*([f"{k + 1}"] if counted else []), *(f"{h:.4f}" for h in row)])
        for k, row in enumerate(z)
    ]
    head = f"Number of Points {points}\nNumber of Traces {traces}\n\n"
    path = written(tmp_path / f"a.{ending}", head + "\n".join(lines) + "\n")
    read = nacre.HeightMap.read(path, unit="nm", spacing=(1e-6, 5e-5), detrend="none")
    assert_close(read.heights, 1e-9 * z, rtol=1e-12)
    assert read.spacing == (1e-6, 5e-5)


def nanoscope(cells: int) -> bytes:
    """Return a NanoScope image: a head of 8 kB, then heights of 16 bit."""
    offset = 8192
    i, j = np.indices((cells, cells))
    raw = (3000 * np.sin(i / 7) + 2000 * np.cos(j / 5)).astype("<i2")
    head = ["*File list", "Version: 0x05120003", "Date: 10:11:12 AM Mon Mar 03 2014"]
    head += ["Start context: OL2", f"Data length: {offset}", "*Equipment list"]
    head += [f"Spare line {k}: 0" for k in range(120)]
    head += ["*Scanner list", "@Sens. Zscan: V 12.5 nm/V", "*Ciao scan list", "Scan Size: 2 um"]
    head += [f"Samps/line: {cells}", f"Lines: {cells}", "*Ciao image list"]
    head += [f"Data offset: {offset}", f"Data length: {2 * cells * cells}", "Bytes/pixel: 2"]
    head += ["Start context: OL", "Data type: AFM", f"Samps/line: {cells}"]
    head += [f"Number of lines: {cells}", "Aspect Ratio: 1:1", "Scan Size: 2 2 ~m"]
    head += ['@2:Image Data: S [Height] "Height"', "@Z magnify: C [2:Z scale] 0.05"]
    head += ["@2:Z scale: V [Sens. Zscan] (0.0067 V/LSB) 22.0 V"]
    head += ["@2:Z offset: V [Sens. Zscan] (0.0067 V/LSB) 0 V", "*File list end"]
    text = "".join(f"\\{line}\r\n" for line in head).encode("latin-1") + b"\x1a"
    return bytes(text + bytes(offset - len(text)) + raw.tobytes())


@MARK("ending", ["000", "017", "123", "di", "dat", "txt", ""])
def test_a_nanoscope_image_is_one_whatever_its_ending(ending: str, tmp_path: Path) -> None:
    for name in ("a.001", f"a.{ending}" if ending else "a"):
        (tmp_path / name).write_bytes(nanoscope(48))
    right = nacre.HeightMap.read(tmp_path / "a.001")
    assert_close(right.spacing, 2e-6 / 48, rtol=1e-9)
    assert nacre.HeightMap.read(tmp_path / (f"a.{ending}" if ending else "a")) == right


def test_control_bytes_are_no_text(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    path.write_bytes(table(X, ROUGH).encode() + b"\x03" + table(X, ROUGH).encode())
    with pytest.raises(ValueError, match="must be text, got binary data"):
        nacre.HeightMap.read(path)
    path.write_bytes(table(*np.eye(4)).encode() + b"\x1a" + bytes(100))  # padding
    assert nacre.HeightMap.read(path, unit="um", spacing=1e-6).heights.shape == (4, 4)


def workbook(path: Path) -> Path:
    """Write a trace of 60 points, 0.5 mm apart, in the layout that SurfaceTopography reads."""
    openpyxl = pytest.importorskip("openpyxl")
    book = openpyxl.Workbook()
    sheet, certificate = book.active, book.create_sheet("Certificate")
    sheet.title = "DATA"
    for row in range(1, 61):
        sheet.cell(row, 5, 0.5 * row)
        sheet.cell(row, 6, 0.3 * np.sin(0.5 * row / 4))
    sheet["A1"] = "Ra\t0.191\tµm"
    certificate["E2"], certificate["E48"] = "3. March 2021", "0.8 mm"
    book.save(path)
    return path


@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_a_line_scan_of_an_instrument_is_a_profile(tmp_path: Path) -> None:
    path = workbook(tmp_path / "trace.xlsx")
    with pytest.raises(ValueError, match=r"holds a profile, .* channel 'Default'; SampledProfile"):
        nacre.HeightMap.read(path)
    z = 0.3e-6 * np.sin(0.5 * np.arange(1, 61) / 4)
    for options in ({}, {"height": 0}, {"height": "Default"}, {"unit": "um"}):
        profile = nacre.SampledProfile.read(path, **options)
        assert_close(profile.x, 0.5e-3 * np.arange(60), atol=1e-15)
        assert_close(profile.drop, z.max() - z, atol=1e-15)
    with pytest.raises(ValueError, match=r"height must be one of 0 .Default. .*, got 3"):
        nacre.SampledProfile.read(path, height=3)
    with pytest.raises(ValueError, match="drop must be left out for the line scan"):
        nacre.SampledProfile.read(path, drop=1)
    (tmp_path / "a.001").write_bytes(nanoscope(48))
    with pytest.raises(ValueError, match=r"holds no profile: .* HeightMap.read reads a map"):
        nacre.SampledProfile.read(tmp_path / "a.001")


@MARK("count", ["inf", "-inf", "nan"])
def test_counts_in_a_head_that_are_not_finite_count_for_nothing(count: str, tmp_path: Path) -> None:
    heights = np.random.default_rng(3).random((4, 5)).round(4)
    text = f"# columns: {count}\n# rows: {count}\n" + table(*heights.T)
    read = nacre.HeightMap.read(written(tmp_path / "a.txt", text), unit="um", spacing=1e-6)
    assert sorted(read.heights.shape) == [4, 5]
