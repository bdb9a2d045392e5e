"""Measured profiles: smooth between their stations, with an error that covers what lies there."""

from __future__ import annotations

import pickle
import re
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

import nacre
from nacre.results.values import decode, encode
from support import assert_close

Array = npt.NDArray[np.float64]

CASES = Path(__file__).parents[2] / "data" / "cases"
STEEL = nacre.Elastic(210e9, 0.3)
HARD = nacre.Elastic(2 * 82e9 * 1.28, 0.28)
MARK = pytest.mark.parametrize

LENGTH, RADIUS = 10e-3, 5e-3


def logarithmic(x: Array, amplitude: float, length: float, factor: float = 1.0) -> Array:
    """Return the drops of a logarithmic profile."""
    u = 2 * x / length
    return amplitude * np.log(1 / (1 - factor * u * u))


def chamfered(x: Array, flat: float, slope: float, radius: float) -> Array:
    """Return the drops of a straight middle with chamfers, rounded in between."""
    u = np.maximum(np.abs(x) - flat, 0)
    end = slope * radius
    return np.where(u < end, u * u / (2 * radius), slope * (u - end) + end * end / (2 * radius))


def crown(x: Array, radius: float) -> Array:
    """Return the drops of a crown."""
    return x * x / (2 * radius)


def beyond(x: Array, flat: float) -> Array:
    """Return the distances from a straight middle."""
    return np.maximum(np.abs(x) - flat, 0)


ROLLERS: dict[str, tuple[Callable[[Array], Array], float]] = {
    # drop [m] at x [m], load [N]
    "crown 0.5 m": (lambda x: crown(x, 0.5), 500),
    "crown 2 m": (lambda x: crown(x, 2), 1000),
    "crown off the middle": (lambda x: crown(x - 1e-3, 0.7), 500),
    "crown, steeper ends": (lambda x: 4e-6 * (x / 5e-3) ** 4 + crown(x, 4), 1000),
    "crowned ends": (lambda x: crown(beyond(x, 2e-3), 0.3), 800),
    "crowned ends, long middle": (lambda x: crown(beyond(x, 3e-3), 0.5), 800),
    "iso": (lambda x: logarithmic(x, 3.5e-6, 10.1e-3), 1000),
    "lundberg": (lambda x: logarithmic(x, 2.8e-7, 10.02e-3), 500),
    "johns and gohar": (lambda x: logarithmic(x, 2.8e-7, LENGTH, 0.995), 300),
    "fujiwara and kawase": (
        lambda x: 1e-6 * np.log(1 / (1 - 0.99 * (beyond(x, 2.5e-3) / 2.5e-3) ** 2)),
        1000,
    ),
    "logarithmic, steep": (lambda x: logarithmic(x, 1e-6, 10.001e-3), 1500),
    "chamfer 0.05 m": (lambda x: chamfered(x, 3.5e-3, 0.01, 0.05), 800),
    "chamfer 0.2 m": (lambda x: chamfered(x, 3e-3, 0.005, 0.2), 800),
    "chamfer 0.5 m": (lambda x: chamfered(x, 3e-3, 0.001, 0.5) + crown(x, 20), 250),
    "chamfer beside the contact": (lambda x: crown(x, 1) + 0.02 * beyond(x, 4.3e-3), 300),
    "chamfer in the contact": (lambda x: crown(x, 5) + chamfered(x, 2.1e-3, 0.002, 0.3), 800),
    "worn groove": (lambda x: crown(x, 2) + 1e-6 * np.exp(-((x / 1.5e-3) ** 2)), 800),
    "worn flat": (lambda x: 3e-7 * np.log1p(np.exp((crown(x, 2) - 1e-6) / 3e-7)), 800),
    "worn waves": (lambda x: crown(x, 3) + 2e-7 * np.cos(2 * np.pi * x / 2.7e-3 + 0.4), 800),
    "worn on one side": (lambda x: crown(x, 2) + 1e-6 * np.tanh((x - 0.7e-3) / 6e-4), 800),
    "worn edge": (lambda x: crown(x, 3) + 1.5e-6 / (1 + np.exp(-(x - 3e-3) / 2e-4)), 800),
}


def peak(
    drop: Callable[[Array], Array] | Array, stations: int, load: float, **keywords: Any
) -> tuple[float, float]:
    """Return the peak pressure of a roller with so many stations, and its error."""
    x = np.linspace(-LENGTH / 2, LENGTH / 2, stations)
    profile = nacre.SampledProfile(x, drop(x) if callable(drop) else drop, **keywords)
    with warnings.catch_warnings():
        # Few stations may leave the peak uncertain, which is known.
        warnings.filterwarnings("ignore", ".*between the stations", nacre.NacreWarning)
        roller = nacre.Roller(radius=RADIUS, profile=profile)
        solution = nacre.solve(roller, STEEL, STEEL, load=load)
    errors = solution.report.discretisation
    assert errors is not None
    assert errors["peak_pressure"] is not None
    return solution.peak_pressure, errors["peak_pressure"]


@pytest.mark.slow
def test_the_peak_of_a_sampled_profile_is_within_its_error() -> None:
    within, closeness = [], []
    for name, (drop, load) in ROLLERS.items():
        right, left = peak(drop, 4801, load)
        assert left < 1e-3 * right, name
        for stations in (11, 21, 40, 101, 201):
            found, error = peak(drop, stations, load)
            within.append(abs(found - right) <= error + left)
            closeness.append((stations, abs(found - right) / right, error / right))
    assert np.mean(within) >= 0.95
    # With 101 stations on a length of 10 mm, the peak is right and known to be.
    fine = np.array([numbers for numbers in closeness if numbers[0] >= 101])
    assert np.median(fine[:, 1]) < 1e-4
    assert np.median(fine[:, 2]) < 2e-3


WAVY = np.linspace(-LENGTH / 2, LENGTH / 2, 9)
"""Stations 1.25 mm apart, on waves of 3 mm: 2.4 % of the peak lie between them."""


def wavy(x: Array) -> Array:
    """Return the drops of a crown with waves."""
    return 2e-6 * (x / 5e-3) ** 2 + 1e-6 * np.cos(2 * np.pi * x / 3e-3)


@MARK("shape", [(128, 32), (128, 63), (40, 40), (128, 64), (130, 130)])
@MARK("keywords", [{}, {"algorithm": "polonsky-keer"}])
def test_the_error_between_stations_is_known_on_every_grid(
    shape: tuple[int, int], keywords: dict[str, Any]
) -> None:
    grid = nacre.Grid(shape, (LENGTH, 2e-4))

    def solved(x: Array) -> nacre.Solution:
        roller = nacre.Roller(RADIUS, length=LENGTH, profile=nacre.SampledProfile(x, wavy(x)))
        contact = nacre.Contact(STEEL, grid, STEEL)
        return contact.solve(roller, load=300.0, **keywords)

    with warnings.catch_warnings(record=True):
        warnings.simplefilter("always")
        few, many = solved(WAVY), solved(np.linspace(-LENGTH / 2, LENGTH / 2, 2001))
    off = abs(few.peak_pressure - many.peak_pressure)
    assert off > 0.01 * many.peak_pressure
    told = [w for w in few.report.warnings if "between the stations" in w]
    stated = (few.report.discretisation or {}).get("peak_pressure")
    if stated is None:
        [text] = told
        percent = re.search(r"error of (\d+) %", text)
        assert percent is not None
        assert off < 0.01 * (int(percent[1]) + 0.5) * few.peak_pressure
        # Where nothing is lost between the stations, nothing is said.
        assert "stations" not in many.report.warning_kinds
    else:
        assert off < stated


def test_the_peak_between_stations_is_that_of_hertz() -> None:
    # tests/data/cases/profile_at_stations: a crown of 300 mm every 0.45 mm.
    path = CASES / "profile_at_stations" / "stations.csv"
    x, drop = 1e-3 * np.loadtxt(path, delimiter=",", skiprows=1).T
    radii = (0.3, 0.46)
    modulus = nacre.hertz.contact_modulus(STEEL, STEEL)
    hertz = nacre.hertz.Ellipse(*radii, modulus, load=10e3)
    assert hertz.peak_pressure == pytest.approx(574.42e6, rel=1e-4)
    for profile in ((x, drop), nacre.SampledProfile(x, drop), nacre.SampledProfile.read(path)):
        solution = nacre.solve(nacre.Roller(0.46, profile=profile), STEEL, STEEL, load=10e3)
        errors = solution.report.discretisation
        assert errors is not None
        assert abs(solution.peak_pressure - hertz.peak_pressure) <= (errors["peak_pressure"] or 0)
        assert (errors["peak_pressure"] or 0) < 1e-3 * hertz.peak_pressure


@pytest.mark.slow
def test_a_smoothing_length_takes_noise_from_a_profile() -> None:
    random = np.random.default_rng(7)
    drop, load = ROLLERS["worn groove"]
    right, _ = peak(drop, 801, load)
    x = np.linspace(-LENGTH / 2, LENGTH / 2, 201)
    noisy = drop(x) + 5e-8 * random.standard_normal(x.size)
    found, error = peak(noisy, 201, load)
    assert 0.03 * right < abs(found - right) < error
    found, error = peak(noisy, 201, load, smoothing=1e-3)
    assert abs(found - right) < error < 0.05 * right
    # A length that flattens the groove is seen to do so.
    found, error = peak(drop, 201, load, smoothing=8e-3)
    assert 0.005 * right < abs(found - right) < error


def test_a_profile_has_edges_where_they_are_said_to_be() -> None:
    x = np.linspace(-5e-3, 5e-3, 101)
    drop = 0.01 * np.maximum(np.abs(x) - 3e-3, 0) + crown(x, 20)
    edged = nacre.SampledProfile(x, drop, corners=[-3.02e-3, 2.97e-3])
    fine = np.linspace(-5e-3, 5e-3, 1001)
    right = 0.01 * np.maximum(np.abs(fine) - 3e-3, 0) + crown(fine, 20)
    assert_close(edged.drop_at(fine), right, atol=1e-13)
    assert np.abs(nacre.SampledProfile(x, drop).drop_at(fine) - right).max() > 1e-8
    straight = nacre.SampledProfile(x, drop, smooth=False)
    assert_close(straight.drop_at(fine), np.interp(fine, x, drop), atol=1e-16)
    # Steps do not make the curve swing.
    steps = np.where(np.abs(x) < 2e-3, 0.0, 1e-4)
    curve = nacre.SampledProfile(x, steps).drop_at(fine)
    assert curve.min() > -1e-18
    assert curve.max() < 1e-4 * (1 + 1e-12)


@MARK(
    ("keywords", "message"),
    [
        ({"corners": [5e-3]}, "corners must be between the ends of the profile, got 0.005"),
        ({"corners": [float("nan")]}, "corners must be between the ends"),
        ({"corners": [[0.0]]}, "corners must have one dimension"),
        ({"smoothing": 0.0}, "smoothing must be finite and above 0, got 0"),
        ({"smoothing": -1.0}, "smoothing must be finite and above 0"),
    ],
)
def test_wrong_joints_of_stations_are_refused(keywords: dict[str, Any], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        nacre.SampledProfile([-5e-3, 0.0, 5e-3], [1e-6, 0.0, 1e-6], **keywords)


def test_a_profile_is_kept_with_its_joints(tmp_path: Path) -> None:
    x, drop = [-5e-3, -1e-3, 1e-3, 5e-3], [1e-5, 0.0, 0.0, 2e-5]
    for keywords in (
        {},
        {"smooth": False},
        {"corners": (-1e-3, 1e-3), "smoothing": 2e-4},
    ):
        profile = nacre.SampledProfile(x, drop, **keywords)
        for other in (
            pickle.loads(pickle.dumps(profile)),
            eval(repr(profile), {"SampledProfile": nacre.SampledProfile, "array": np.array}),
            decode(encode(profile)),
        ):
            assert other == profile
            assert other.drop_at(3e-3) == profile.drop_at(3e-3)
    # What says nothing is left out.
    assert set(encode(nacre.SampledProfile(x, drop))["SampledProfile"]) == {"x", "drop", "smooth"}
    assert "smooth" not in repr(nacre.SampledProfile(x, drop))
    case = tmp_path / "case.toml"
    case.write_text(
        "[shape]\nkind = 'roller'\nradius = 5e-3\n[shape.profile]\nkind = 'sampled'\n"
        "x = [-5e-3, -1e-3, 1e-3, 5e-3]\ndrop = [1e-5, 0.0, 0.0, 2e-5]\ncorners = [1e-3]\n"
        "smoothing = 2e-4\nsmooth = true\n[materials]\nsteel = { young = 210e9, poisson = 0.3 }\n"
        "[body]\nsubstrate = 'steel'\n[solve]\nload = 100.0\n",
        encoding="utf-8",
    )
    shape = nacre.case.Case.read(case).arguments()["shape"]
    assert "corners=(0.001,), smoothing=0.0002" in repr(shape)


def s1002(s: Array) -> Array:
    """Return the tread of the wheel S1002 from s = -26 to 32.158 mm off the tape circle [mm].

    EN 13715, zone B; positive where the wheel is larger.
    """
    powers = [
        *(0.0, -3.358537058e-2, 1.565681624e-3, -2.810427944e-5, 5.844240864e-8),
        *(-1.562379023e-8, 5.309217349e-15, -5.957839843e-12, 2.646656573e-13),
    ]
    return np.asarray(np.polynomial.polynomial.polyval(s, powers), np.float64)


def uic60() -> tuple[Array, Array]:
    """Return points of the head of the rail UIC60, canted by 1 in 40, below its top [mm].

    Arcs of 300, 80 and 13 mm, which meet at 20.456/2 and 52.053/2 mm from the middle, up to 36 mm.
    """
    radii, ends = (300.0, 80.0, 13.0), (20.456 / 2, 52.053 / 2, 36.0)
    (u0, w0), parts, low = (0.0, radii[0]), [], 0.0
    for k, (radius, end) in enumerate(zip(radii, ends, strict=True)):
        if k > 0:
            u0 += (radii[k - 1] - radius) * np.sin(low)
            w0 -= (radii[k - 1] - radius) * np.cos(low)
        high = np.arcsin((end - u0) / radius)
        angle = np.linspace(low, high, 20001)
        parts.append((u0 + radius * np.sin(angle), w0 - radius * np.cos(angle)))
        low = high
    u, w = (np.concatenate([part[axis] for part in parts]) for axis in (0, 1))
    u, w = np.concatenate([-u[::-1], u]), np.concatenate([w[::-1], w])
    cant = np.arctan(1 / 40)
    y, z = u * np.cos(cant) + w * np.sin(cant), w * np.cos(cant) - u * np.sin(cant)
    top = z.argmin()
    return y - y[top], z - z[top]


@MARK(("step", "known"), [(0.1, 0.002), (0.25, 0.005), (0.5, 0.01), (1.0, 0.1)])
def test_a_wheel_on_a_rail_is_that_of_the_manchester_benchmark(step: float, known: float) -> None:
    # CONTACT's reference output of the example mbench_a22_right, case 1: 10 kN, no displacement,
    # 338.3 MPa and 15.96 um. The profiles are those of the equations, not its points.
    y, z = uic60()
    gauge = np.interp(-14.0, -z[: z.argmin() + 1], y[: z.argmin() + 1])
    # The gauge of 1435 mm is measured 14 mm below the top, the tape circles are 1500 mm apart.
    offset = 717.5 - gauge - 750.0
    place = np.arange(-24.0, 12.0, step)
    drop = np.interp(place, y, z) - s1002(place + offset)
    drop -= drop.min()
    wheel = nacre.Roller(radius=0.46, profile=(1e-3 * place, 1e-3 * drop))
    solution = nacre.solve(wheel, HARD, HARD, load=10e3)
    errors = solution.report.discretisation
    assert errors is not None
    assert solution.peak_pressure == pytest.approx(338.3e6, rel=0.01)
    assert (errors["peak_pressure"] or np.inf) < known * solution.peak_pressure
    # The drop counts from its smallest at a station: with far ones the approach is less.
    assert solution.approach == pytest.approx(15.96e-6, rel=0.005)
