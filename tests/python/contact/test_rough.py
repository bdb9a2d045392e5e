"""Statistics of rough contacts against closed forms and maps made by hand."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import nacre
from nacre import plot, rough
from nacre.case import Case, CaseError
from support import assert_close, python

pytestmark = pytest.mark.filterwarnings("ignore::nacre.NacreWarning")  # spots of few cells

BODY = nacre.Elastic(1.0, 0.0)
PERIODIC = nacre.Grid((64, 64), (1.0, 1.0), periodic=(True, True))
WAVES: dict[str, Any] = {"hurst": 0.8, "shortest": 8 / 64, "longest": 0.5}
SURFACE = rough.random_surface((64, 64), (1.0, 1.0), rms_slope=0.01, rng=4, **WAVES)
SOLUTION = nacre.solve(SURFACE, BODY, load=1e-3)


def hertz(cells: int, shift: float = 0.0) -> nacre.Solution:
    """Return a contact of radius 1 and peak pressure 2/π · 1e-3."""
    grid = nacre.Grid((cells, cells), (2.6, 2.6))
    ball = nacre.Paraboloid(1e3, 1e3).shifted(shift, 0.7 * shift)
    return nacre.solve(ball, BODY, grid=grid, load=4 / 3 * 1e-3)


def test_a_seed_makes_the_same_surface_with_the_waves_that_are_asked_for() -> None:
    np.random.seed(1)  # noqa: NPY002  the global state must not matter
    again = rough.random_surface((64, 64), (1.0, 1.0), rms_slope=0.01, rng=4, **WAVES)
    assert (again.heights == SURFACE.heights).all()
    other = rough.random_surface((64, 64), (1.0, 1.0), rms_slope=0.01, rng=5, **WAVES)
    assert abs(np.corrcoef(other.heights.ravel(), SURFACE.heights.ravel())[0, 1]) < 0.6
    spectrum = np.abs(np.fft.fft2(SURFACE.heights))
    number = np.fft.fftfreq(64, 1 / 64)
    q = np.hypot(number[:, None], number[None, :])
    kept = spectrum > 1e-9 * spectrum.max()
    # From twice a period to eight points, as many waves as 64/8.
    assert q[kept].min() == pytest.approx(2)
    assert 7 < q[kept].max() <= 8 + 1e-9
    # Parseval: Σ (2πq|h|)²/N⁴ is the mean square of the slope.
    slope = np.sqrt(np.sum((2 * np.pi * q * spectrum) ** 2)) / 64**2
    assert slope == pytest.approx(0.01, rel=1e-12)
    assert rough.spectral_slope(SURFACE) == pytest.approx(0.01, rel=1e-12)
    assert SURFACE.periodic == (True, True)


def test_the_height_may_be_given_and_the_spectrum_falls_as_it_should() -> None:
    """The mean density over 40 seeds falls as q^(-2-2H), within its scatter."""
    number = np.fft.fftfreq(128, 1 / 128)
    q = np.hypot(number[:, None], number[None, :])
    power = np.zeros((128, 128))
    for seed in range(40):
        surface = rough.random_surface(
            (128, 128),
            (1.0, 1.0),
            hurst=0.5,
            shortest=4 / 128,
            longest=0.5,
            rms_height=2.0,
            rng=seed,
        )
        assert surface.heights.std() == pytest.approx(2.0, rel=1e-12)
        power += np.abs(np.fft.fft2(surface.heights)) ** 2
    inside = (q >= 2) & (q <= 32)
    slope, _ = np.polyfit(np.log(q[inside]), np.log(power[inside]), 1)
    # 3200 waves with a relative scatter of 1/√40 each, over ln 16: the slope is known to 0.01.
    assert slope == pytest.approx(-3.0, abs=0.05)


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"hurst": 0.0}, "hurst must be"),
        ({"shortest": 0.01}, "shortest must be at least two points"),
        ({"shortest": 0.6}, "shortest must be"),
        ({"rms_slope": None}, "exactly one of rms_slope and rms_height"),
        ({"rms_height": 1.0}, "exactly one of rms_slope and rms_height"),
        ({"rms_slope": -1.0}, "rms_slope must be above 0"),
    ],
)
def test_wrong_surfaces_are_refused(wrong: dict[str, Any], message: str) -> None:
    given = {**WAVES, "rms_slope": 0.01, "rng": 1, **wrong}
    with pytest.raises(ValueError, match=message):
        rough.random_surface((64, 64), (1.0, 1.0), **given)


def test_a_surface_is_chosen_as_by_numpy() -> None:
    """SPEC 7 of Scientific Python: an integer, a SeedSequence, a Generator or None."""

    def heights(**rng: Any) -> Any:
        return rough.random_surface((64, 64), (1.0, 1.0), rms_slope=0.01, **WAVES, **rng).heights

    np.testing.assert_array_equal(heights(rng=4), SURFACE.heights)
    np.testing.assert_array_equal(heights(rng=np.random.SeedSequence(4)), SURFACE.heights)
    generator = np.random.default_rng(4)
    np.testing.assert_array_equal(heights(rng=generator), SURFACE.heights)
    assert (heights(rng=generator) != SURFACE.heights).any()  # which goes on from there
    assert (heights() != heights()).any()
    for wrong in (1.5, "4", True, np.random.RandomState(4)):
        with pytest.raises(TypeError, match="rng must be an integer, a SeedSequence, a Generator"):
            heights(rng=wrong)
    with pytest.raises(ValueError, match="rng must be"):
        heights(rng=-1)
    with pytest.raises(TypeError, match="no argument seed; rng has the seed"):
        heights(seed=4)
    with pytest.raises(TypeError, match=r"no argument seeds$"):
        heights(seeds=4)


def test_the_corrected_area_of_a_disc() -> None:
    """Counted cells are 1 % too many at 60 cells across; corrected, the error is a third of that.

    Means over six places, whose scatter is 2e-3.
    """
    found = [hertz(78, shift) for shift in (0.0, 0.004, 0.009, 0.013, 0.018, 0.023)]
    counted = np.mean([s.contact_area for s in found]) / np.pi - 1
    corrected = np.mean([rough.corrected_area(s) for s in found]) / np.pi - 1
    assert 0.005 < counted < 0.011
    assert abs(corrected) < 0.4 * counted
    # The perimeter counted along sides is 8 radii.
    excess = found[0].contact_area - rough.corrected_area(found[0])
    assert excess == pytest.approx(rough.PERIMETER * 8 * 2.6 / 78, rel=0.03)


def touching(*rows: str, periodic: tuple[bool, bool]) -> nacre.Solution:
    """Return a solution that touches in the cells of rows of "#" and ".", which are of size 1."""
    pattern = np.array([[letter == "#" for letter in row] for row in rows], dtype=float)
    grid = nacre.Grid(pattern.shape, pattern.shape, periodic=periodic)
    flat = nacre.HeightMap(np.zeros(grid.shape), 1.0, periodic=periodic)
    state = nacre.solve(flat, BODY, grid=grid, load=1e-3, max_iterations=0, check=False).to_dict()
    return nacre.Solution.from_dict(state | {"pressure": pattern, "gap": 1.0 - pattern})


@pytest.mark.parametrize(
    ("periodic", "sizes"),
    [
        ((False, False), [1, 2, 2, 2, 2, 2]),
        ((True, False), [2, 2, 3, 4]),
        ((False, True), [1, 2, 2, 2, 4]),
        ((True, True), [2, 3, 6]),
    ],
)
def test_patches_are_joined_across_the_seam(periodic: tuple[bool, bool], sizes: list[int]) -> None:
    pattern = ("#..#.#", "#....#", ".##...", "......", "...#..", "##.#..")
    assert sorted(rough.patches(touching(*pattern, periodic=periodic))) == sizes
    # A map without a cell beside is one patch.
    assert rough.patches(touching(*6 * ["######"], periodic=periodic)).tolist() == [36]


@pytest.mark.parametrize(
    ("rows", "periodic", "along"),
    [
        (["..#", "..#", "..#"], (False, False), (True, False)),
        (["###", "...", "###"], (False, False), (False, True)),
        (["#..", ".#.", "..#"], (False, False), (False, False)),
        # A staircase meets itself across both seams, and crosses along both.
        (["..###", "#..##", "##..#", "###..", ".###."], (True, True), (True, True)),
        # A ring of gap around a patch touches both sides but does not cross.
        (["#.#.#", "..#..", "#####", "..#..", "#.#.#"], (True, True), (False, False)),
        # A straight channel across the seam.
        (["#.##", "#.##", "#.##"], (True, True), (True, False)),
        # It ends one column beside where it begins, and the seam leads on: not the same cell.
        (["#.##", "#..#", "##.#"], (True, False), (False, False)),
        # The side steps back: it does close.
        (["#..#", "##.#", "#..#"], (True, False), (True, False)),
    ],
)
def test_open_gaps_lead_from_side_to_side(
    rows: list[str], periodic: tuple[bool, bool], along: tuple[bool, bool]
) -> None:
    assert rough.percolates(touching(*rows, periodic=periodic)) == along
    turned = ["".join(column) for column in zip(*rows, strict=True)]
    assert rough.percolates(touching(*turned, periodic=periodic[::-1])) == along[::-1]


def test_percolation_ends_as_the_load_grows() -> None:
    light = nacre.solve(SURFACE, BODY, load=1e-4)
    heavy = nacre.solve(SURFACE, BODY, load=2e-2)
    assert rough.percolates(light) == (True, True)
    assert rough.percolates(heavy) == (False, False)
    assert rough.patches(light).size > 1
    assert rough.patches(heavy).sum() == pytest.approx(heavy.contact_area, rel=1e-12)


def test_distributions_integrate_to_their_shares_and_hertz_has_its_own() -> None:
    """In Hertz' contact the density of the pressure is 2p/p0² times the share of the contact."""
    for found, share in (
        (rough.pressure_distribution(SOLUTION, 40), SOLUTION.in_contact.mean()),
        (rough.gap_distribution(SOLUTION, 40), 1 - SOLUTION.in_contact.mean()),
    ):
        name = str(found.dims[0])
        width = float(found[name][1] - found[name][0])
        assert float(found.sum()) * width == pytest.approx(share, rel=1e-12)
        assert found.attrs["share_at_zero"] == pytest.approx(1 - share, rel=1e-12)
    contact = hertz(260)
    density = rough.pressure_distribution(contact, 10)
    peak = 2 / np.pi * 1e-3
    expected = 2 * density["pressure"] / peak**2 * np.pi / 2.6**2
    # Some 3000 cells in a bin, whose edges cut 100 of them: 3 %. Cells at the edge
    # miss in the first two bins; the last reaches the peak.
    assert_close(density[2:-1], expected[2:-1], rtol=0.05, each=True)
    with pytest.raises(ValueError, match="bins must be"):
        rough.pressure_distribution(contact, 0)


def test_the_spectrum_knows_the_waves_and_flattens_under_load() -> None:
    found = rough.spectrum(SOLUTION)
    # In the band of the surface; between the bins the density is an average.
    band = (found["wavenumber"] > 2 * np.pi * 2.5) & (found["wavenumber"] < 2 * np.pi * 7)
    before = found["undeformed"].where(band, drop=True)
    after = found["deformed"].where(band, drop=True)
    assert bool((after < before).all())
    # Parseval: the mean square of heights is the integral of the density.
    full = nacre.solve(SURFACE, BODY, load=5e-2)
    flat = rough.spectrum(full)["deformed"]
    assert float(flat.max()) < 1e-6 * float(found["undeformed"].max())
    line = nacre.solve(nacre.Cylinder(1.0), BODY, grid=nacre.Grid.line(32, 1.0), load=1e-3)
    for statistic in (rough.spectrum, rough.corrected_area):
        with pytest.raises(ValueError, match="must have cells along x"):
            statistic(line)
    # Patches of a line contact have lengths.
    assert rough.patches(line).sum() == pytest.approx(line.contact_area, rel=1e-12)


def test_the_load_curve_is_that_of_single_solves() -> None:
    pressures = [3e-4, 1e-3, 3e-3]
    curve = rough.load_curve(SURFACE, BODY, pressures, threads=1)
    for pressure in pressures:
        alone = nacre.solve(SURFACE, BODY, load=pressure, threads=1)
        row = curve.sel(pressure=pressure)
        assert float(row["load"]) == pytest.approx(pressure, rel=1e-12)
        # Starts differ, solutions agree to their tolerance: no cell changes sides here.
        assert float(row["contact_area"]) == pytest.approx(alone.contact_area, rel=1e-3)
        assert float(row["mean_gap"]) == pytest.approx(alone.gap.mean(), rel=1e-6)
        assert float(row["corrected_area"]) == pytest.approx(rough.corrected_area(alone), rel=1e-3)
    # The stiffness is the slope of pressure over approach.
    close = rough.load_curve(SURFACE, BODY, [9.99e-4, 1e-3, 1.001e-3])
    slope = 2e-6 / float(close["approach"][2] - close["approach"][0])
    assert float(close["stiffness"][1]) == pytest.approx(slope, rel=2e-2)
    assert curve["mean_gap"].attrs["units"] == "m"
    with pytest.raises(ValueError, match="pressures must be"):
        rough.load_curve(SURFACE, BODY, [0.0])
    with pytest.raises(ValueError, match="grid must be given"):
        rough.load_curve(nacre.Sphere(1.0), BODY, [1.0])


def test_a_load_curve_with_hardness_is_a_history() -> None:
    """Unloaded, the dented surface touches with more area than on the way up."""
    curve = rough.load_curve(SURFACE, BODY, [1e-3, 3e-3, 1e-3], hardness=0.006)
    areas = curve["contact_area"].values
    assert areas[2] > 1.2 * areas[0]


def test_ensembles_are_studies_over_the_seed() -> None:
    def case(seed: int) -> dict[str, Any]:
        surface = rough.random_surface((32, 32), (1.0, 1.0), rms_slope=0.01, rng=seed, **WAVES)
        return {"shape": surface, "body": BODY, "load": 1e-3}

    outputs = {"area": rough.corrected_area, "patches": lambda s: rough.patches(s).size}
    study = nacre.sweep(case, {"seed": [1, 2, 3]}, outputs=outputs, version=1)
    direct = [rough.corrected_area(nacre.solve(**case(seed))) for seed in (1, 2, 3)]
    assert study["area"].values == pytest.approx(direct, rel=1e-12)
    assert study["area"].std() > 0


def test_case_files_have_random_surfaces(tmp_path: Path) -> None:
    data: dict[str, Any] = {
        "materials": {"soft": {"young": 1.0, "poisson": 0.0}},
        "shape": {
            "kind": "random_surface",
            "shape": [64, 64],
            "size": [1.0, 1.0],
            **WAVES,
            "rms_slope": 0.01,
            "seed": 4,
        },
        "body": {"substrate": "soft"},
        "solve": {"load": 1e-3},
        "sweep": {"parameters": {"shape.seed": [4, 5]}},
    }
    case = Case(data)
    assert (nacre.solve(**case.arguments()).pressure == SOLUTION.pressure).all()
    study = nacre.sweep(case, **case.study())
    assert study["contact_area"].values[0] == SOLUTION.contact_area
    with pytest.raises(CaseError, match="seed"):
        Case({**data, "shape": {**data["shape"], "seed": -1}})


@pytest.mark.quick
def test_maps_have_x_to_the_right_and_y_upwards() -> None:
    cells: Any = plot.patches(SOLUTION).collections[0].get_array()
    labels = cells.reshape(64, 64).T  # white, patches, and the largest one
    np.testing.assert_array_equal(labels > 0, SOLUTION.in_contact)
    assert (labels == 2).mean() == rough.patches(SOLUTION).max()  # areas of a square of 1
    image: Any = plot.heights(SURFACE).images[0]
    assert_close(image.get_array(), 1e3 * (SURFACE.heights - SURFACE.heights.mean()).T)  # mm
    assert image.origin == "lower"


def test_pictures_have_labels_with_units() -> None:
    curve = rough.load_curve(SURFACE, BODY, [1e-3, 3e-3])
    axes = plot.load_curve(curve)
    assert axes.get_xlabel() == "mean pressure [mPa]"
    (line,) = axes.get_lines()
    assert_close(np.asarray(line.get_ydata()), curve["corrected_share"])
    assert plot.load_curve(curve, "mean_gap").get_ylabel() == "mean gap [µm]"
    with pytest.raises(ValueError, match="quantity must be one of"):
        plot.load_curve(curve, "nothing")
    assert (
        plot.distribution(rough.pressure_distribution(SOLUTION)).get_ylabel() == "density [1/mPa]"
    )
    count = rough.patches(SOLUTION).size
    title = plot.patches(SOLUTION).get_title(loc="left")
    assert title.startswith(f"{count} patches; the gap is open along")
    assert plot.spectrum(rough.spectrum(SOLUTION)).get_xlabel() == "wavenumber [rad/m]"


def test_saved_solutions_have_the_same_statistics(tmp_path: Path) -> None:
    again = nacre.load(SOLUTION.save(tmp_path / "rough.nc"))
    assert rough.corrected_area(again) == rough.corrected_area(SOLUTION)
    assert (rough.patches(again) == rough.patches(SOLUTION)).all()


# Maps.


def test_the_roughness_of_waves_is_theirs(tmp_path: Path) -> None:
    """Of a sin(qx) + b cos(ky): Sq² = (a² + b²)/2, slope² = (a²q² + b²k²)/2, and so on."""
    n, m, step = 96, 64, 1e-6
    x, y = step * np.arange(n)[:, None], step * np.arange(m)[None, :]
    q, k, a, b = 2 * np.pi * 3 / (n * step), 2 * np.pi * 2 / (m * step), 2e-7, 1e-7
    heights = 5e-6 + a * np.sin(q * x) + b * np.cos(k * y)
    surface = nacre.HeightMap(heights, step, periodic=(True, True))
    found = rough.roughness(surface)
    assert found.sq == pytest.approx(np.hypot(a, b) / np.sqrt(2), rel=1e-12)
    assert found.rms_slope == pytest.approx(np.hypot(a * q, b * k) / np.sqrt(2), rel=1e-12)
    curvature = 0.5 * np.hypot(a * q**2, b * k**2) / np.sqrt(2)
    assert found.rms_curvature == pytest.approx(curvature, rel=1e-12)
    assert found.sa == pytest.approx(np.abs(heights - heights.mean()).mean(), rel=1e-12)
    assert (found.sp, found.ssk) == pytest.approx((a + b, 0.0), rel=1e-2, abs=1e-9)
    # Fourth moments of sines: (3/8)(a⁴ + b⁴) + 6 (a²/2)(b²/2).
    fourth = 0.375 * (a**4 + b**4) + 1.5 * a**2 * b**2
    assert found.sku == pytest.approx(fourth / found.sq**4, rel=1e-12)
    assert "Sq             158.1 nm" in str(found)
    assert nacre.load(found.save(tmp_path / "a.nc")) == found
    done = python("-c", "import nacre; print(nacre.load('a.nc').sq)", folder=tmp_path)
    assert float(done.stdout) == found.sq
    assert found.to_xarray().sq.attrs["units"] == "m"
    for said in ("96 × 64", "x and y", "158.1 nm", "base64"):
        assert said in surface._repr_html_()  # type: ignore[attr-defined]


@pytest.mark.quick
def test_bowls_planes_and_the_highest_wave_have_their_slopes_and_curvatures() -> None:
    # A paraboloid that is not periodic has its curvature; a kink at the rim is left of it, 1e-4. A
    # plane has its slope alone.
    place = 1e-6 * (np.arange(80) - 39.5)
    bowl = nacre.HeightMap((place[:, None] ** 2 + place[None, :] ** 2) / 2e-2, 1e-6)
    assert rough.roughness(bowl).rms_curvature == pytest.approx(100.0, rel=1e-3)
    plane = nacre.HeightMap(1e-3 * place[:, None] + 0 * place, 1e-6)
    assert rough.spectral_slope(plane) == pytest.approx(1e-3, rel=1e-12)
    assert rough.roughness(plane).rms_curvature < 1e-9
    steps = (-1.0) ** np.arange(64)[:, None] * np.ones(64) * 1e-9
    highest = rough.roughness(nacre.HeightMap(steps, 1e-6, periodic=(True, True)))
    assert highest.rms_curvature == pytest.approx(0.5 * (np.pi / 1e-6) ** 2 * 1e-9, rel=1e-12)
    flat = rough.roughness(nacre.HeightMap(np.ones((4, 4)), 1e-6))
    assert (flat.sq, flat.ssk, flat.rms_slope) == (0.0, 0.0, 0.0)


def test_a_measured_map_has_the_slope_of_the_surface_that_it_is_cut_from() -> None:
    whole = rough.random_surface(
        (256, 256), (1e-4, 1e-4), hurst=0.8, shortest=4e-6, longest=1e-5, rms_slope=0.05, rng=3
    )
    part = nacre.HeightMap(whole.heights[30:220, 40:250], whole.spacing)
    # Of the window alone the slope is that of the whole map's derivative, weighted alike.
    waves = 2 * np.pi * np.fft.fftfreq(256, whole.spacing[0])
    transform = np.fft.fft2(whole.heights)
    slopes = [
        np.fft.ifft2(1j * side * transform).real[30:220, 40:250]
        for side in (waves[:, None], waves[None, :])
    ]
    n, m = part.heights.shape
    window = np.outer(*(np.sin(np.pi * (np.arange(k) + 0.5) / k) ** 2 for k in (n, m)))
    expected = np.sqrt(sum(np.mean((window * s) ** 2) for s in slopes) / np.mean(window**2))
    # Short of the whole by what waves of 4 µm, ten points long, do in one that ends: 1e-3.
    assert rough.spectral_slope(part) == pytest.approx(expected, rel=1e-3)
    assert expected == pytest.approx(0.05, rel=0.2)
    density = rough.spectrum(whole)
    assert set(density.data_vars) == {"surface"}
    smooth = rough.windowed(part, 0.2)
    assert smooth.periodic == (True, True)
    inner = (slice(50, 140), slice(50, 150))
    assert_close(smooth.heights[inner], part.heights[inner], rtol=0, atol=1e-21)
    rim = np.abs(smooth.heights[0] - part.heights.mean()).max()
    assert rim < 1e-2 * np.abs(part.heights).max()
    assert_close(rough.windowed(whole).heights, whole.heights, rtol=0, atol=1e-21)
    with pytest.raises(ValueError, match=r"taper must be above 0 and at most 0\.5, got 0\.6"):
        rough.windowed(part, 0.6)
    for function in (rough.roughness, rough.spectral_slope, rough.windowed):
        with pytest.raises(TypeError, match="surface must be a HeightMap, got 3"):
            function(3)  # type: ignore[arg-type]


# The coefficient of the area.

WAVE = nacre.HeightMap(
    np.repeat(1e-3 * np.cos(2 * np.pi * (np.arange(512) + 0.5) / 512)[:, None], 32, axis=1),
    1 / 512,
    periodic=(True, True),
)
FLAT = np.pi * 1e-3
"""Mean pressure that closes the last gap of `WAVE` on `BODY`: π E* Δ/λ, Johnson (1985), 13.27."""


def test_the_coefficient_of_a_wave_is_that_of_closed_forms() -> None:
    """H' = √2 π Δ/λ = √2 p*/E*, so κ = √2 (A/A₀) p*/p̄, for two bodies and with a dent likewise."""
    area, both = 32 / 512, nacre.Elastic(2.0, 0.0)
    for kinds in ((BODY,), (both, both), (nacre.HalfSpace(BODY, [nacre.Layer(BODY, 0.1)]),)):
        full = nacre.solve(WAVE, *kinds, load=2 * FLAT * area)
        # Full contact, A = A₀, at twice the pressure that it takes: what remains is rounding.
        assert rough.area_coefficient(full) == pytest.approx(2**0.5 / 2, rel=1e-12)
        # Westergaard (Johnson 13.25): A/A₀ = 1/2 at sin²(π/4) p*. A cell at either edge: 2/512.
        half = nacre.solve(WAVE, *kinds, load=0.5 * FLAT * area)
        assert rough.area_coefficient(half) == pytest.approx(2**0.5, rel=2 / 256)
    dented = nacre.solve(WAVE, BODY, load=0.5 * FLAT * area, hardness=0.6 * FLAT)
    assert dented.indentation.max() > 0
    share = rough.corrected_area(dented) / area
    assert rough.area_coefficient(dented) == pytest.approx(2**0.5 * share / 0.5, rel=1e-9)


@pytest.mark.slow
def test_the_coefficient_of_rough_bodies_is_that_of_the_table() -> None:
    """Row of docs/kappa.csv: five surfaces on a stiff layer of four of their shortest waves.

    `make kappa` starts each solve from the last and divides by the slope that it asked for. Some of
    10^5 cells in contact may differ, within the tolerance of the solves.
    """
    path = Path(__file__).parents[3] / "docs" / "kappa.csv"
    with path.open(encoding="utf-8") as file:
        *_, row = (r for r in csv.DictReader(file) if (r["young"], r["thickness"]) == ("4", "64"))
    layer = nacre.Layer(nacre.Elastic(4.0, 0.0), 64.0)
    grid = nacre.Grid((1024, 1024), (1024.0, 1024.0), periodic=(True, True))
    contact = nacre.Contact(nacre.HalfSpace(BODY, [layer]), grid)
    found = []
    for seed in range(1, 1 + int(row["seeds"])):
        surface = rough.random_surface(
            grid.shape, grid.size, hurst=0.8, rms_slope=0.01, shortest=16, longest=256, rng=seed
        )
        solution = contact.solve(surface, load=float(row["pressure"]) * 0.01 * 1024**2)
        found.append(rough.area_coefficient(solution))
    assert np.mean(found) == pytest.approx(float(row["kappa"]), rel=1e-4)


def test_a_coefficient_that_means_nothing_is_refused() -> None:
    ball = nacre.solve(nacre.Sphere(1.0), BODY, load=1e-3)
    with pytest.raises(ValueError, match="periodic along x and y"):
        rough.area_coefficient(ball)
    soft = nacre.HalfSpace(nacre.RIGID, [nacre.Layer(BODY, 0.1)])
    with pytest.raises(ValueError, match="elastic substrate"):
        rough.area_coefficient(nacre.solve(SURFACE, soft, load=1e-3))
    springs = nacre.Response(lambda alpha: np.ones_like(alpha))
    with pytest.raises(ValueError, match="elastic substrate"):
        rough.area_coefficient(nacre.solve(SURFACE, BODY, springs, load=1e-3))
    with pytest.raises(ValueError, match="above 0, got 0"):
        rough.area_coefficient(nacre.solve(SURFACE, BODY, approach=-1.0))
    plane = nacre.HeightMap(np.zeros((8, 8)), 0.1, periodic=(True, True))
    with pytest.raises(ValueError, match="rough, got a plane"):
        rough.area_coefficient(nacre.solve(plane, BODY, load=1e-3))
