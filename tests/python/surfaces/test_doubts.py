"""Where a file leaves a choice, readers take the only certain one, or list what there is."""

import time
import tracemalloc
import zipfile
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import h5py
import numpy as np
import pytest
import scipy.io
import xarray

import nacre
from nacre.surfaces.instruments import _channel
from support import assert_close

Arrays = dict[str, np.ndarray[Any, Any]]


def hdf5(path: Path, arrays: Arrays) -> None:
    with h5py.File(path, "w") as file:
        for name, values in arrays.items():
            file[f"scan/{name}"] = values


ARCHIVES: dict[str, Callable[[Path, Arrays], None]] = {
    "h5": hdf5,
    "npz": lambda path, arrays: np.savez(path, **arrays),  # type: ignore[arg-type]
    "mat": lambda path, arrays: scipy.io.savemat(path, arrays),
}
HEIGHTS = 1e-9 * np.random.default_rng(3).standard_normal((16, 12))
ONE: Arrays = {"height": HEIGHTS, "count": np.arange(3)[:, None, None]}
TWO: Arrays = {"error": HEIGHTS.round(9), "height": HEIGHTS}


@pytest.mark.parametrize("ending", ARCHIVES)
def test_of_two_arrays_one_is_named(ending: str, tmp_path: Path) -> None:
    options: dict[str, Any] = {"unit": "m", "spacing": 1e-7, "detrend": "none"}
    ARCHIVES[ending](tmp_path / f"one.{ending}", ONE)
    one = nacre.HeightMap.read(tmp_path / f"one.{ending}", **options)
    np.testing.assert_array_equal(one.heights, HEIGHTS)
    path = tmp_path / f"two.{ending}"
    ARCHIVES[ending](path, TWO)
    message = r"channel must be given, as one of 0 '.*error' \(16 x 12, no unit\), 1 '.*height'"
    with pytest.raises(ValueError, match=message):
        nacre.HeightMap.read(path, **options)
    assert nacre.HeightMap.read(path, channel=1, **options) == one
    name = "scan/height" if ending == "h5" else "height"
    assert nacre.HeightMap.read(path, channel=name, **options) == one


def points(first: int, step: float, names: str) -> str:
    lines = [
        f"{first + step * i:g} {first + step * j:g} {HEIGHTS[i, j] / 1e-9:.17g}"
        for i in range(16)
        for j in range(12)
    ]
    return "\n".join([names, *lines] if names else lines) + "\n"


@pytest.mark.parametrize("ending", ["txt", "csv", "xyz", "npy"])
@pytest.mark.parametrize("first", [0, 1])
@pytest.mark.parametrize("names", ["", "i j z", "x y height"])
def test_numbers_of_points_are_no_lengths(
    ending: str, first: int, names: str, tmp_path: Path
) -> None:
    path = tmp_path / f"a.{ending}"
    path.write_text(points(first, 1, names), encoding="utf-8")
    if ending == "npy":
        np.save(path, np.loadtxt(path, skiprows=len(names[:1])))
    message = "spacing must be given: .* x or y counts points and is no length"
    with pytest.raises(ValueError, match=message):
        nacre.HeightMap.read(path, unit="nm")
    read = nacre.HeightMap.read(path, unit="nm", spacing=4.9e-6, detrend="none")
    assert_close(read.heights, HEIGHTS, rtol=1e-12)
    path.with_suffix(".txt").write_text(points(first, 1, "# spacing: 4900 4900\nx y z"))
    read = nacre.HeightMap.read(path.with_suffix(".txt"), unit="nm")
    assert read.spacing == pytest.approx((4.9e-6, 4.9e-6))


def test_places_with_a_unit_keep_it(tmp_path: Path) -> None:
    path = tmp_path / "a.txt"
    path.write_text(points(0, 1, "x/um y/um z"), encoding="utf-8")
    read = nacre.HeightMap.read(path, unit="nm", detrend="none")
    assert read.spacing == pytest.approx((1e-6, 1e-6))
    assert_close(read.heights, HEIGHTS, rtol=1e-12)


@pytest.mark.parametrize("names", ["", "x,height"])
def test_numbers_of_stations_are_no_places(names: str, tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    lines = [f"{k},{-k * k / 100:g}" for k in range(12)]
    path.write_text("\n".join([*names.split(" "), *lines]), encoding="utf-8")
    options: dict[str, Any] = {"x": 0, "height": 1}
    with pytest.raises(ValueError, match=r"unit must be a pair, .* count points"):
        nacre.SampledProfile.read(path, unit="mm", **options)
    read = nacre.SampledProfile.read(path, unit=("mm", "mm"), **options)
    assert read.x[-1] == pytest.approx(11e-3)


@pytest.mark.parametrize(
    "read", [nacre.HeightMap.read, nacre.SampledProfile.read, nacre.indent.read]
)
def test_of_many_tables_ten_are_named_in_linear_time(
    read: Callable[[Path], object], tmp_path: Path
) -> None:
    path = tmp_path / "a.txt"
    path.write_text("\n\nx\n".join(["1 2\n3 4\n5 7"] * 8000), encoding="utf-8")
    start = time.process_time()
    with pytest.raises(
        ValueError, match=r"must (be given|hold one table): .*8000 tables.* and 7990 more"
    ) as error:
        read(path)
    assert time.process_time() - start < 10  # of the processor, some 1; quadratic work takes 20
    assert len(str(error.value)) < 1000


@pytest.mark.parametrize("shape", [(0, 5), (5, 0)])
def test_an_array_without_numbers_is_refused(shape: tuple[int, int], tmp_path: Path) -> None:
    np.save(tmp_path / "a.npy", np.zeros(shape))
    with pytest.raises(
        ValueError, match="must hold a real matrix of heights, got float64 of shape"
    ):
        nacre.HeightMap.read(tmp_path / "a.npy", spacing=1.0)


def test_a_head_of_brackets_is_refused_in_a_line(tmp_path: Path) -> None:
    content = b"\x93NUMPY\x01\x00" + (18_000).to_bytes(2, "little") + 18_000 * b"("
    (tmp_path / "a.npy").write_bytes(content)
    with pytest.raises(ValueError, match="must hold an array of NumPy's") as error:
        nacre.HeightMap.read(tmp_path / "a.npy", spacing=1.0)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize("is_named", [False, True])
def test_what_unpacks_out_of_proportion_is_not_unpacked(is_named: bool, tmp_path: Path) -> None:
    source = zipfile.ZipFile(Path(__file__).parents[2] / "data/cases/x3p_en_dash/surface.x3p")
    with source, zipfile.ZipFile(tmp_path / "a.x3p", "w", zipfile.ZIP_DEFLATED) as made:
        parts = {name: source.read(name) for name in source.namelist()}
        for name, content in (parts | {"bindata/data.bin" if is_named else "a": b""}).items():
            made.writestr(name, content or bytes(50_000_000))
    tracemalloc.start()
    try:
        if is_named:
            with pytest.raises(ValueError, match=r"'bindata/data.bin' would unpack to 50000000"):
                nacre.HeightMap.read(tmp_path / "a.x3p")
        else:
            assert nacre.HeightMap.read(tmp_path / "a.x3p").heights.shape == (9, 7)
        assert tracemalloc.get_traced_memory()[1] < 20_000_000
    finally:
        tracemalloc.stop()


def lines(names: str, *columns: Any, times: int = 1) -> str:
    """Return a table with a heading, if any, as often as asked for."""
    table = [" ; ".join(f"{value:.9g}" for value in row) for row in zip(*columns, strict=True)]
    return "\n\n".join(times * ["\n".join([names, *table] if names else table)])


SPACED = {"spacing": 1e-6}
ROW, LINE = (grid.ravel() for grid in np.indices((16, 12)))
X, Y, Z = 0.5 * ROW, 0.5 * LINE, HEIGHTS.ravel() / 1e-9
PLACE = 0.3 * np.arange(20.0)
CROWN = PLACE**2 / 100
DOUBTS: dict[str, tuple[str, dict[str, Any], str]] = {
    "no unit": (lines("x;y;z", X, Y, Z), {}, "unit must be given: .* names none"),
    "pixel numbers": (lines("x;y;z", ROW, LINE, Z), {"unit": "nm"}, "spacing must be given"),
    "numbers of lines": (lines("x;y;z", X, LINE, Z), {"unit": "nm"}, "spacing must be given"),
    "two heights": (lines("x;y;z;z", X, Y, Z, Z), {"unit": "nm"}, "name the columns x, y and z in"),
    "an unknown word": (lines("x;y;z error", X, Y, Z), {"unit": "nm"}, "name the columns x, y and"),
    "another one": (
        lines("x;y;error of z", X, Y, Z),
        {"unit": "nm"},
        "name the columns x, y and z",
    ),
    "two tables": (lines("x;y;z", X, Y, Z, times=2), {}, "channel must be given: .* 0 .* 1 "),
}
OF_PROFILES: dict[str, tuple[str, dict[str, Any], str]] = {
    "no unit": (lines("x;drop", PLACE, CROWN), {}, "unit must be one of .* names none"),
    "pixel numbers": (lines("x;drop", np.arange(20), CROWN), {"unit": "mm"}, "unit must be a pair"),
    "two drops": (
        lines("x;drop;drop", PLACE, CROWN, CROWN),
        {"unit": "mm"},
        "drop= or height= must name",
    ),
    "an unknown word": (
        lines("x;drop error", PLACE, CROWN),
        {"unit": "mm"},
        "drop= or height= must",
    ),
    "of the place": (lines("x error;drop", PLACE, CROWN), {"unit": "mm"}, "x= must name a column"),
    "two tables": (lines("x;drop", PLACE, CROWN, times=2), {"unit": "mm"}, "must hold one table"),
    "one column": (lines("", CROWN), {"unit": "mm"}, "got 1 of 20; spacing= goes with drops or"),
    "no unit of it": (lines("", CROWN), {"spacing": 1e-6}, "for the heights of .* names none"),
    "another word": (lines("z error", CROWN), {"unit": "mm", **SPACED}, "must name .* 0 'z error'"),
    "places alone": (lines("x", PLACE), {"unit": "mm", **SPACED}, "must name a column .* 0 'x'"),
}
OF_CURVES: dict[str, tuple[str, dict[str, Any], str]] = {
    "no unit": (lines("depth;force", PLACE, CROWN), {}, "units must be given: .* names no unit"),
    "pixel numbers": (lines(";force (N)", np.arange(20), CROWN), {}, "depth must be given"),
    "two depths": (
        lines("depth (nm);depth (nm);force (N)", PLACE, PLACE, CROWN),
        {},
        "depth must be given: 2 columns have the name",
    ),
    "an unknown word": (
        lines("Film depth (nm);Load (N)", PLACE, CROWN),
        {},
        "depth must be given: .* 0 'Film depth .nm.', 1 'Load",
    ),
    "of the force": (
        lines("Depth (nm);Frame load (N)", PLACE, CROWN),
        {},
        "force must be given: .* 1 'Frame load",
    ),
    "two tables": (
        lines("Depth (nm);Load (N)", PLACE, CROWN, times=2),
        {},
        "segment must be given: .* 2 tables, 0 .* 1 ",
    ),
}


@pytest.mark.parametrize(
    ("read", "ending", "case"),
    [
        *(
            (nacre.HeightMap.read, end, row)
            for end in ("txt", "csv", "xyz", "dat")
            for row in DOUBTS.values()
        ),
        *(
            (nacre.SampledProfile.read, end, row)
            for end in ("txt", "csv")
            for row in OF_PROFILES.values()
        ),
        *((nacre.indent.read, end, row) for end in ("txt", "csv") for row in OF_CURVES.values()),
    ],
)
def test_each_reader_takes_what_is_certain_or_lists(
    read: Callable[..., object], ending: str, case: tuple[str, dict[str, Any], str], tmp_path: Path
) -> None:
    text, options, message = case
    path = tmp_path / f"a.{ending}"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(ValueError, match=message):
        read(path, **options)


@pytest.mark.parametrize("ending", ARCHIVES)
def test_archives_of_heights_name_no_unit(ending: str, tmp_path: Path) -> None:
    ARCHIVES[ending](tmp_path / f"one.{ending}", ONE)
    with pytest.raises(ValueError, match=r"unit must be given: .* names none"):
        nacre.HeightMap.read(tmp_path / f"one.{ending}", spacing=1e-7)


def test_zygos_text_has_the_size_of_a_pixel(tmp_path: Path) -> None:
    head = ["Zygo XYZ Data File - Format 1", "0 8", "0 0", "5 3 16 12", '"a"', '"b"', '"c"']
    head += [
        "0 0.5 5.79e-07 0.08 1 0 {} 1767225600",
        "16 12 0 0",
        "0 0",
        "1 1",
        '1 " "',
        "1 0",
        "#",
    ]
    body = [f"{5 + i} {3 + j} {HEIGHTS[i, j] / 1e-6:.12f}" for j in range(12) for i in range(16)]
    for ending in ("xyz", "txt"):
        path = tmp_path / f"a.{ending}"
        text = "\r\n".join([*head, *body, "#"]) + "\r\n"
        path.write_text(text.format(4.9e-6), encoding="ascii")
        read = nacre.HeightMap.read(path, detrend="none")
        assert read.spacing == (4.9e-6, 4.9e-6)
        assert_close(read.heights, HEIGHTS, rtol=1e-8)
        path.write_text(text.format(4.9e-6).replace(body[7], "12 3 No Data"), encoding="ascii")
        with pytest.warns(nacre.NacreWarning, match="1 of 192 heights are missing"):
            nacre.HeightMap.read(path)
        path.write_text(text.format(0), encoding="ascii")
        with pytest.raises(ValueError, match="spacing must be given"):
            nacre.HeightMap.read(path)
        for damaged in (
            text[:200],
            text.format(1).replace("16 12", "16 13"),
            text.replace("8 7 ", "x 7 "),
        ):
            path.write_text(damaged.replace("{}", "1e-6"), encoding="ascii")
            with pytest.raises(ValueError, match=r"must be whole|must have \(16, 13\) points"):
                nacre.HeightMap.read(path)


def array(
    unit: str | None = "m", places: str | None = "m", size: float = 1e-6, order: int = 1
) -> xarray.DataArray:
    """Return heights with coordinates from 3 steps of a size on, which may descend."""
    attrs = {} if places is None else {"units": places}
    coords = {
        axis: (axis, size * np.arange(3, 3 + cells)[::order], attrs)
        for axis, cells in zip("xy", HEIGHTS.shape, strict=True)
    }
    named = {} if unit is None else {"units": unit}
    heights = HEIGHTS[::order, ::order]
    return xarray.DataArray(heights, coords, ("x", "y"), "topography", named)


NETCDF = {
    "as it is": array(),
    "y first": array().T,
    "Y first": array().T.rename(x="X", y="Y"),
    "descending": array(order=-1),
    "in other units": array("nm", "um", 1.0) * 1e9,
    "beside a line": array().to_dataset().assign(line=("x", np.arange(16.0))),
}
NETCDF["in other units"].attrs["units"] = "nm"


@pytest.mark.parametrize("form", ["NETCDF4", "NETCDF3_64BIT"])
@pytest.mark.parametrize("name", NETCDF)
def test_xarrays_files_are_read_as_they_are(name: str, form: Any, tmp_path: Path) -> None:
    NETCDF[name].to_netcdf(tmp_path / "a.nc", format=form)
    read = nacre.HeightMap.read(tmp_path / "a.nc", detrend="none")
    assert read.spacing == pytest.approx((1e-6, 1e-6))
    assert_close(read.heights, HEIGHTS, rtol=1e-15)


TWO_ARRAYS = xarray.Dataset({"error": array(), "height": array()})
UNEVEN = array().assign_coords(x=("x", 1e-6 * np.arange(16.0) ** 2, {"units": "m"}))
OF_NETCDF: dict[str, tuple[Any, dict[str, Any], str]] = {
    "no unit": (array(unit=None), {}, "unit must be given: .* names none"),
    "another unit": (array("V"), {}, "unit must be given: .* has 'V'"),
    "no unit of places": (array(places=None), {}, "spacing must be given: .* no unit of length"),
    "pixel numbers": (array(places=None, size=1.0), {}, "spacing must be given: .* no unit of l"),
    "numbers in pixels": (array(places="px"), {}, "spacing must be given: .* no unit of length"),
    "no coordinates": (array().drop_vars(["x", "y"]), {}, "spacing must be given"),
    "two arrays": (TWO_ARRAYS, {}, r"as one of 0 'error' \(16 x 12, in m\), 1 'height' \(16 x"),
    "an unknown channel": (TWO_ARRAYS, {"channel": "z"}, "channel must be one of .* got 'z'"),
    "uneven places": (UNEVEN, {}, "places along x must be on a regular grid"),
    "a single place": (array(size=0.0), {}, "places along x must be on a regular grid"),
    "a map of one line": (array()[:, :1], {}, "holds a profile, places beside heights, not a map"),
    "a line": (array()[:, 0], {}, "must hold heights, an array of two dimensions, got none"),
    "words": (array().astype(str), SPACED, "must hold heights, an array of two dimensions"),
}


@pytest.mark.parametrize("name", OF_NETCDF)
def test_of_netcdf_the_certain_is_taken(name: str, tmp_path: Path) -> None:
    data, options, message = OF_NETCDF[name]
    data.to_netcdf(tmp_path / "a.nc")
    with pytest.raises(ValueError, match=message):
        nacre.HeightMap.read(tmp_path / "a.nc", **options)


def test_netcdf_takes_what_is_given(tmp_path: Path) -> None:
    TWO_ARRAYS.to_netcdf(tmp_path / "a.nc")
    for name in (1, "height"):
        read = nacre.HeightMap.read(tmp_path / "a.nc", channel=name, detrend="none")
        np.testing.assert_array_equal(read.heights, HEIGHTS)
    array(unit=None, places=None).to_netcdf(tmp_path / "b.nc")
    read = nacre.HeightMap.read(tmp_path / "b.nc", unit="m", spacing=4e-6, detrend="none")
    assert read.spacing == (4e-6, 4e-6)
    np.testing.assert_array_equal(read.heights, HEIGHTS)


@pytest.mark.parametrize("begin", [b"CDF\x01", b"CDF\x02", b"\x89HDF\r\n\x1a\n", b"x"])
def test_damaged_netcdf_is_refused(begin: bytes, tmp_path: Path) -> None:
    (tmp_path / "a.nc").write_bytes(begin + bytes(range(256)))
    with pytest.raises(ValueError, match=r"'.*a\.nc' cannot be read: .") as error:
        nacre.HeightMap.read(tmp_path / "a.nc", unit="m", spacing=1e-6)
    assert len(str(error.value)) < 400


def channel(name: str, kind: str = "height", dim: int = 2, unit: str | None = "m") -> Any:
    size, kinds = (4, 3)[:dim], SimpleNamespace(value=kind)
    return SimpleNamespace(name=name, dim=dim, nb_grid_pts=size, unit=unit, data_kind=kinds)


def test_of_several_channels_the_only_one_of_heights_is_taken() -> None:
    retrace, trace = channel("Height (retrace)"), channel("Height")
    error, line = channel("Vertical deflection", "deflection", unit="V"), channel("Line", dim=1)
    one = SimpleNamespace(channels=[error, trace, line])
    assert _channel(one, None, 2) is trace
    assert _channel(one, None, 1) is line
    assert _channel(one, 0, 2) is _channel(one, "Vertical deflection", 2) is error
    two = SimpleNamespace(channels=[error, trace, retrace, trace])
    given = r"channel must be given, as one of 1 'Height' \(4 x 3, in m\), 2 'Height \(retrace\)'"
    for choice, words in ((None, given), ("Height", "got 'Height'"), (7, "one of 0 'Vert.*got 7")):
        with pytest.raises(ValueError, match=words):
            _channel(two, choice, 2)
