"""A measured surface is read in metres, without its trend, with what is missing filled."""

from __future__ import annotations

import time
import tracemalloc
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest

import nacre
from support import assert_close

ROUNDING = 1e-12  # of sums over some hundred points


def surface(shape: tuple[int, int] = (20, 14)) -> npt.NDArray[np.float64]:
    """Return heights of some micrometres that no trend of second order explains."""
    x, y = np.meshgrid(np.linspace(-1, 1, shape[0]), np.linspace(-1, 1, shape[1]), indexing="ij")
    return np.cos(4 * x) * np.cos(3 * y + 1) + 0.3 * np.sin(5 * x * y)


def plane(shape: tuple[int, int]) -> npt.NDArray[np.float64]:
    i, j = np.indices(shape)
    return 3.0 + 0.2 * i - 0.5 * j


def csv(path: Path, heights: npt.NDArray[np.float64], head: str = "", mark: str = ",") -> Path:
    lines = [mark.join("" if np.isnan(h) else repr(float(h)) for h in row) for row in heights]
    path.write_text(head + "\n".join(lines) + "\n", encoding="utf-8")
    return path


def test_npy_and_csv_are_the_array_itself(tmp_path: Path) -> None:
    heights = surface()
    np.save(tmp_path / "a.npy", heights)
    head = "# unit: um\n# spacing: 0.5 0.25\n"
    for path in (tmp_path / "a.npy", csv(tmp_path / "a.csv", heights)):
        read = nacre.HeightMap.read(path, spacing=(5e-7, 2.5e-7), unit="um", detrend="none")
        assert read == nacre.HeightMap(heights * 1e-6, (5e-7, 2.5e-7))
    read = nacre.HeightMap.read(csv(tmp_path / "b.csv", heights, head, ";"), detrend="none")
    assert read.heights.tobytes() == (heights * 1e-6).tobytes()
    assert read.spacing == (0.5 * 1e-6, 0.25 * 1e-6)


def test_xyz_points_may_come_in_any_order(tmp_path: Path) -> None:
    heights = surface()
    i, j = np.indices(heights.shape)
    points = np.stack([7 + 0.5 * i, 0.25 * j, heights], axis=-1).reshape(-1, 3)
    np.random.default_rng(3).shuffle(points)
    np.savetxt(tmp_path / "a.xyz", points, fmt="%.17g", header="unit: nm")
    read = nacre.HeightMap.read(tmp_path / "a.xyz", detrend="none")
    assert_close(read.heights, 1e-9 * heights, rtol=ROUNDING)
    assert_close(read.spacing, (0.5e-9, 0.25e-9), rtol=ROUNDING)


@pytest.mark.parametrize("detrend", ["mean", "plane", "quadratic"])
def test_a_trend_is_subtracted_whole(detrend: str, tmp_path: Path) -> None:
    shape = (20, 14)
    i, j = np.indices(shape)
    trend = {
        "mean": np.full(shape, 3.0),
        "plane": plane(shape),
        "quadratic": plane(shape) + 0.01 * i**2 - 0.02 * i * j + 0.03 * j**2,
    }[detrend]
    np.save(tmp_path / "with.npy", surface() + trend)
    np.save(tmp_path / "without.npy", surface())
    np.save(tmp_path / "trend.npy", trend)
    with_trend, without, alone = (
        nacre.HeightMap.read(tmp_path / f"{name}.npy", spacing=1.0, detrend=detrend).heights  # type: ignore[arg-type]
        for name in ("with", "without", "trend")
    )
    assert_close(with_trend, without, atol=ROUNDING * 10)
    assert_close(alone, 0, atol=ROUNDING * 10)
    assert np.ptp(without) > 1  # it is the trend alone that goes


def test_missing_points_are_filled_and_counted(tmp_path: Path) -> None:
    # A plane is harmonic: filled, it is whole again, in the middle of the surface.
    heights = plane((20, 14))
    holes = heights.copy()
    holes[5:9, 3:7] = np.nan
    holes[15, 10] = np.inf
    path = csv(tmp_path / "a.csv", holes)
    with pytest.warns(nacre.NacreWarning, match="17 of 280 heights are missing and were filled"):
        read = nacre.HeightMap.read(path, spacing=1.0, detrend="none")
    # Conjugate gradients stop at 1e-12 of the first residual; the system is well conditioned.
    assert_close(read.heights, heights, rtol=1e-10)


def test_filling_makes_no_new_extremes_and_xyz_may_lack_points(tmp_path: Path) -> None:
    heights = surface()
    i, j = np.indices(heights.shape)
    points = np.stack([i, j, heights], axis=-1).reshape(-1, 3)
    kept = np.random.default_rng(5).permutation(len(points))[:200]
    np.savetxt(tmp_path / "a.xyz", points[kept], fmt="%.17g")
    with pytest.warns(nacre.NacreWarning, match="80 of 280 heights"):
        read = nacre.HeightMap.read(
            tmp_path / "a.xyz", unit="m", spacing=1.0, detrend="none"
        ).heights
    measured = np.zeros(heights.shape, dtype=bool)
    measured.ravel()[kept] = True
    assert read[measured].tobytes() == heights[measured].tobytes()
    assert heights[measured].min() <= read.min() <= read.max() <= heights[measured].max()
    # Each filled point is the mean of its neighbours inside.
    inside = (i > 0) & (i < 19) & (j > 0) & (j < 13) & ~measured
    around = sum(np.roll(read, step, axis) for step in (-1, 1) for axis in (0, 1)) / 4
    assert_close(read[inside], np.asarray(around)[inside], atol=1e-9)


@pytest.mark.filterwarnings("ignore:Could not import mpi4py:ImportWarning")
def test_an_instruments_file_is_read_by_surfacetopography(tmp_path: Path) -> None:
    from SurfaceTopography import Topography

    heights = surface()
    topography = Topography(heights, physical_sizes=(10.0, 3.5), unit="µm")
    topography.to_netcdf(str(tmp_path / "a.nc"))
    read = nacre.HeightMap.read(tmp_path / "a.nc", detrend="none")
    assert_close(read.heights, 1e-6 * heights, rtol=ROUNDING)
    assert_close(read.spacing, (10e-6 / 20, 3.5e-6 / 14), rtol=ROUNDING)


@pytest.mark.filterwarnings("ignore:Could not import mpi4py:ImportWarning")
def test_a_topography_of_surfacetopography_is_a_surface() -> None:
    from SurfaceTopography import Topography

    heights = surface()
    topography = Topography(heights, physical_sizes=(10.0, 3.5), unit="µm")
    read = nacre.HeightMap.read(topography, detrend="none")
    np.testing.assert_array_equal(read.heights, 1e-6 * heights)
    assert_close(read.spacing, (10e-6 / 20, 3.5e-6 / 14), rtol=ROUNDING)
    without = Topography(heights, physical_sizes=(10.0, 3.5))
    with pytest.raises(ValueError, match="unit must be given: the topography names none; its hei"):
        nacre.HeightMap.read(without)
    assert nacre.HeightMap.read(without, unit="µm", detrend="none") == read
    with pytest.raises(TypeError, match="path must be a path or a topography, got 3"):
        nacre.HeightMap.read(3)  # type: ignore[arg-type]


@pytest.mark.filterwarnings("ignore:Could not import mpi4py:ImportWarning")
def test_a_text_file_without_sizes_takes_a_spacing(tmp_path: Path) -> None:
    heights = surface()
    # SurfaceTopography takes the lines of a text as those of an image: one for each y.
    np.savetxt(tmp_path / "a.txt", heights.T, fmt="%.17g")
    read = nacre.HeightMap.read(tmp_path / "a.txt", spacing=(1e-6, 2e-6), unit="nm", detrend="none")
    np.testing.assert_array_equal(read.heights, 1e-9 * heights)
    assert read.spacing == (1e-6, 2e-6)
    with pytest.raises(ValueError, match=r"spacing must be given: '.*a\.txt' does not have it"):
        nacre.HeightMap.read(tmp_path / "a.txt", unit="nm")
    with pytest.raises(ValueError, match=r"channel must be one of 0 .*, got 7"):
        nacre.HeightMap.read(tmp_path / "a.txt", unit="nm", channel=7)


@pytest.mark.filterwarnings("ignore:Could not import mpi4py:ImportWarning")
@pytest.mark.parametrize(
    ("name", "content"),
    [
        ("a.gwx", b"\0\1\2"),
        ("b.bin", b"GWYP\0\1"),
        ("c.txt", b"nothing that an instrument writes\n"),
    ],
)
def test_an_unknown_file_is_refused(name: str, content: bytes, tmp_path: Path) -> None:
    (tmp_path / name).write_bytes(content)
    with pytest.raises(ValueError, match=f"{name}' has no format that SurfaceTopography reads; "):
        nacre.HeightMap.read(tmp_path / name)


def test_an_export_of_an_instrument_is_transposed_on_request(tmp_path: Path) -> None:
    heights = surface()
    path = csv(tmp_path / "a.csv", heights.T, "# spacing: 2e-1 5e-1\n")  # a line for each y
    read = nacre.HeightMap.read(path, transpose=True, unit="um", detrend="none")
    np.testing.assert_array_equal(read.heights, heights * 1e-6)
    assert_close(read.spacing, (0.5e-6, 0.2e-6), rtol=ROUNDING)
    read = nacre.HeightMap.read(path, transpose=True, spacing=(1.0, 3.0), detrend="none")
    assert read == nacre.HeightMap(heights, (1.0, 3.0))


TEXTS = {
    "points": "1.5,2.5\n3.5,-4.5\n",
    "comma after a heading": "left,right\n1.5,2.5\n3.5,-4.5\n",
    "heading of two lines": "Height map;\nx1;x2\n1,5;2,5\n3,5;-4,5\n",
    "heading with a point and a comma": "Version 1.2, raw; map\n1,5;2,5\n3,5;-4,5\n",
    "semicolons": "1,5;2,5\n3,5;-4,5\n",
    "tabs": "1,5\t2,5\n3,5\t-4,5\n",
    "blanks": "1,5 2,5\n3,5  -4,5\n",
    "points after a comma and a blank": "1.5, 2.5\n3.5, -4.5\n",
    "a mark at the end": "1.5,2.5,\n3.5,-4.5,\n",
    "quotes": '"1,5";"2,5"\n"3,5";"-4,5"\n',
    "exponents": "15E-1 2.5e0\n.35e1 -4.5\n",
    "byte-order mark": "\ufeff1.5,2.5\n3.5,-4.5\n",
    "comments at the end": "1.5,2.5\n3.5,-4.5\n# the end\n",
}


@pytest.mark.parametrize("encoding", ["utf-8", "utf-16"])
@pytest.mark.parametrize("kind", TEXTS)
def test_numbers_are_read_however_they_are_written(
    kind: str, encoding: str, tmp_path: Path
) -> None:
    if encoding == "utf-16":  # brings a byte-order mark itself
        (tmp_path / "a.csv").write_text(TEXTS[kind].lstrip("\ufeff"), encoding=encoding)
    else:
        (tmp_path / "a.csv").write_text(TEXTS[kind], encoding=encoding)
    read = nacre.HeightMap.read(tmp_path / "a.csv", spacing=1.0, detrend="none")
    assert read.heights.tolist() == [[1.5, 2.5], [3.5, -4.5]]


def test_a_surface_that_was_read_can_be_pressed(tmp_path: Path) -> None:
    head = "# unit: nm\n# spacing: 1000\n"
    rough = nacre.HeightMap.read(csv(tmp_path / "a.csv", surface((64, 64)), head))
    shape = nacre.Sphere(5e-3) + rough
    solution = nacre.solve(shape, nacre.Elastic(210e9, 0.3), load=0.05)
    assert solution.report.grid.shape == (64, 64)
    assert solution.report.converged


@pytest.mark.parametrize(
    ("name", "content", "options", "message"),
    [
        ("a.csv", "1,2\n3,4\n", {}, "spacing must be given"),
        ("a.csv", "# spacing:\n1,2\n3,4\n", {}, "one or two numbers above 0 as spacing, got ''"),
        ("a.csv", "# spacing: a\n1,2\n3,4\n", {}, "one or two numbers above 0 as spacing, got 'a'"),
        ("a.csv", "# spacing: 1 2 3\n1,2\n3,4\n", {}, "one or two numbers above 0 as spacing"),
        ("a.csv", "# spacing: 0\n1,2\n3,4\n", {}, "one or two numbers above 0 as spacing"),
        ("a.csv", "1,2\n3,x4\n", {"spacing": 1.0}, "must hold numbers, line 2 has 'x4'"),
        ("a.csv", "1,2\n3,1_0\n", {"spacing": 1.0}, "must hold numbers, line 2 has '1_0'"),
        ("a.csv", "1,5;2.5\n3;4\n", {"spacing": 1.0}, "decimal commas or decimal points, line 1"),
        ("a.csv", "x,y\nz,w\n", {"spacing": 1.0}, "must hold numbers, got none"),
        ("a.csv", "1\n2\n", {"spacing": 1.0}, "number of heights .* must be at least 2, got 1"),
        ("a.csv", "0,90\n30,40\n", {"spacing": 1e-6}, "unit must be given: .* would span 90 m on"),
        ("a.npy", "1,2\n3,4\n", {"spacing": 1.0}, "must hold an array of NumPy's"),
        (
            "a.xyz",
            "0 0 1\n1.5 0 1\n0 3 1\n1.5 3 2\n",
            {},
            "unit must be given: .*1 and its sides 1.5 x 3",
        ),
        ("a.xyz", "0 0 1\n1 nan 1\n0 1 1\n", {}, "finite x and y at every point"),
        ("a.xyz", "0 0 1\n1 0 1\n0 1 1\n1 1 1\n1 1 2\n", {}, "one height at each place"),
        ("a.csv", "1,2\n3\n", {"spacing": 1.0}, "2 numbers in each line, line 2 has 1"),
        ("a.csv", "\n", {"spacing": 1.0}, "must hold numbers, got none"),
        ("a.csv", "# unit: parsec\n1,2\n3,4\n", {"spacing": 1.0}, "units .*, got 'parsec'"),
        ("a.csv", "1,,\n,,2\n", {"spacing": 1.0}, "half its points measured, got 2 of 6"),
        ("a.csv", "1,2\n3,4\n", {"spacing": -1.0}, "spacing must be"),
        ("a.csv", "1,2\n3,4\n", {"spacing": 1.0, "unit": "ft"}, "unit must be one of"),
        ("a.csv", "1,2\n3,4\n", {"spacing": 1.0, "detrend": "sphere"}, "detrend must be one of"),
        ("a.csv", "1,2\n3,4\n", {"spacing": 1.0, "channel": 1}, "channel must be left out"),
        ("a.xyz", "1 2\n3 4\n", {}, "three columns x, y, z"),
        ("a.xyz", "0 0 1\n1 0 1\n0 1 1\n1 1.3 1\n", {}, "regular grid|fill its grid"),
        ("a.xyz", "0 0 1\n0 1 1\n", {}, "two places along each"),
        (
            "a.xyz",
            "0 0 1\n1 1 1\n2 2 1\n3 3 1\n4 4 1\n",
            {},
            "fill its grid of 5 x 5 points, got 5",
        ),
        ("a.dat", "nothing that an instrument writes\n", {}, "a.dat"),
    ],
)
def test_what_cannot_be_understood_is_refused(
    name: str, content: str, options: dict[str, object], message: str, tmp_path: Path
) -> None:
    (tmp_path / name).write_text(content)
    with pytest.raises(ValueError, match=message):
        nacre.HeightMap.read(tmp_path / name, **options)  # type: ignore[arg-type]


def test_a_file_that_is_not_there_is_named(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError, match=r"none\.csv"):
        nacre.HeightMap.read(tmp_path / "none.csv")


@pytest.mark.parametrize("text", ["{}a", "1.{}a", "{} {}", "1,5 {}x", "1 2e{}x", "# spacing: {}x"])
@pytest.mark.parametrize("ending", [".csv", ".xyz"])
def test_a_long_run_of_digits_takes_linear_time(text: str, ending: str, tmp_path: Path) -> None:
    path = tmp_path / f"a{ending}"
    path.write_text(text.replace("{}", "1" * 200_000) + "\n", encoding="utf-8")
    start = time.process_time()
    with pytest.raises(ValueError, match="a\\.") as error:
        nacre.HeightMap.read(path, spacing=1e-6)
    assert time.process_time() - start < 20  # of the processor; quadratic work would take minutes
    assert len(str(error.value)) < 500


@pytest.mark.parametrize(
    ("descr", "shape"),
    [("<f8", (40_000, 40_000)), ("<i1", (10**9, 10**9)), ("(1000,1000)f8", (9, 9))],
)
def test_an_array_that_its_file_does_not_hold_is_refused(
    descr: str, shape: tuple[int, int], tmp_path: Path
) -> None:
    with (tmp_path / "a.npy").open("wb") as file:
        head = {"descr": descr, "fortran_order": False, "shape": shape}
        np.lib.format.write_array_header_1_0(file, head)
        file.write(bytes(1000))
    tracemalloc.start()
    try:
        with pytest.raises(ValueError, match="must hold an array of NumPy's"):
            nacre.HeightMap.read(tmp_path / "a.npy", spacing=1e-6)
        assert tracemalloc.get_traced_memory()[1] < 10_000_000
    finally:
        tracemalloc.stop()


def test_points_far_apart_make_no_large_grid(tmp_path: Path) -> None:
    path = tmp_path / "a.xyz"
    for far in ("1e5", "1e9", "1e300"):
        path.write_text("".join(f"{x} {y} {x}\n" for x in (0, 1, 2, 3, far) for y in (0, 1)))
        with pytest.raises(ValueError, match="must"):
            nacre.HeightMap.read(path, unit="nm")
