"""Statistics of rough contacts: curves, distributions, patches, percolation, spectra.

They need ``nacre-contact[surfaces,files]``: surfaces and their spectra are those of
SurfaceTopography, patches those of SciPy, and tables those of xarray.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Never

import numpy as np
import numpy.typing as npt

import nacre._core as core
from nacre._tools.extras import extra
from nacre._tools.groups import names_itself
from nacre._tools.typing import Body
from nacre._tools.units import symbol, written
from nacre.contact import Contact
from nacre.contact.solution import Solution
from nacre.hertz import contact_modulus
from nacre.results import display
from nacre.results.patches import CURVE, crosses, patch_labels, surfaces
from nacre.results.quantities import frozen, quantity
from nacre.results.shown import TableResult

if TYPE_CHECKING:
    import xarray
    from matplotlib.axes import Axes

__all__ = [
    "Roughness",
    "area_coefficient",
    "corrected_area",
    "gap_distribution",
    "load_curve",
    "patches",
    "percolates",
    "pressure_distribution",
    "random_surface",
    "roughness",
    "spectral_slope",
    "spectrum",
    "windowed",
]
__dir__ = __all__.copy

Array = npt.NDArray[np.float64]

SYNTHESIS_BYTES = 150.0
"""Bytes that a random surface takes for each point while it is made; measured."""

PERIMETER = (np.pi - 1 + np.log(2)) / 24
"""Error of the area of counted cells over perimeter times cell, by Yastrebov et al. (2017)."""


def random_surface(
    shape: tuple[int, int],
    size: tuple[float, float],
    *,
    hurst: float,
    shortest: float,
    longest: float,
    rms_slope: float | None = None,
    rms_height: float | None = None,
    rng: int | np.random.SeedSequence | np.random.Generator | None = None,
    **unknown: Never,
) -> core.HeightMap:
    """Self-affine random surface that repeats, by `SurfaceTopography.Generation.fourier_synthesis`.

    Its spectral density falls as q^(-2 - 2 hurst) between the two wavelengths and is 0 outside;
    amplitudes and phases of the waves are random.

    Parameters
    ----------
    shape : tuple of int
        Numbers of points along x and y.
    size : tuple of float
        Periods along x and y [m].
    hurst : float
        Hurst exponent, above 0 and at most 1.
    shortest, longest : float
        Shortest and longest wavelength [m].
    rms_slope, rms_height : float, optional
        Root of the mean square of the slope, or of the height [m]: one of them. The surface has it
        exactly, slopes as `spectral_slope` finds them.
    rng : int, numpy.random.SeedSequence or numpy.random.Generator, optional
        What chooses the surface, as in `numpy.random.default_rng`: the same number makes the same
        surface, a generator another one at each call, and None one that cannot be repeated.
    unknown
        No other keyword is accepted.

    Returns
    -------
    HeightMap
        The surface, periodic along x and y.

    Raises
    ------
    ValueError
        If a number is out of range, or not exactly one of slope and height is given.
    TypeError
        If ``rng`` is of another type, or a keyword is not known, as ``seed``.
    """
    for name in unknown:
        instead = "; rng has the seed" if name == "seed" else ""
        raise TypeError(f"random_surface has no argument {name}{instead}")
    with surfaces():
        from SurfaceTopography.Generation import fourier_synthesis

    nx, ny = (core.integer("shape", count) for count in core.vector("shape", 2, shape))
    lx, ly = (core.real("size", side) for side in core.vector("size", 2, size))
    shape, size = (nx, ny), (lx, ly)
    if not 0 < hurst <= 1:
        raise ValueError(f"hurst must be above 0 and at most 1, got {hurst}")
    finest = 2 * max(side / n for side, n in zip(size, shape, strict=True))
    if not finest <= shortest < longest:
        raise ValueError(
            "shortest must be at least two points, "
            f"{finest:g}, and below longest, got {shortest} and {longest}"
        )
    targets = {"rms_slope": rms_slope, "rms_height": rms_height}
    rms = {name: value for name, value in targets.items() if value is not None}
    if len(rms) != 1:
        raise ValueError("exactly one of rms_slope and rms_height must be given")
    (name, target), *_ = rms.items()
    if not (np.isfinite(target) and target > 0):
        raise ValueError(f"{name} must be above 0, got {target}")
    if min(shape) > 0:
        core.check_memory("shape", nx * ny, SYNTHESIS_BYTES)
    topography = fourier_synthesis(
        shape,
        size,
        hurst=hurst,
        rms_height=1.0,
        short_cutoff=shortest,
        long_cutoff=longest,
        rolloff=0.0,
        rng=_generator(rng),
    )
    heights = np.asarray(topography.heights(), dtype=np.float64)
    heights -= heights.mean()
    spacing = size[0] / shape[0], size[1] / shape[1]
    surface = core.HeightMap(heights, spacing, periodic=(True, True))
    actual = spectral_slope(surface) if name == "rms_slope" else heights.std()
    if actual == 0:
        raise ValueError(f"no wave lies between shortest {shortest} and longest {longest}")
    return core.HeightMap(heights * (target / actual), spacing, periodic=(True, True))


def _generator(rng: object) -> np.random.Generator:
    """Return the generator of an argument ``rng`` (Scientific Python's SPEC 7)."""
    if isinstance(rng, np.random.Generator):
        return rng
    if rng is None or isinstance(rng, np.random.SeedSequence):
        return np.random.default_rng(rng)
    try:
        seed = core.integer("rng", rng)
    except TypeError as error:
        raise TypeError(
            f"rng must be an integer, a SeedSequence, a Generator or None, got {rng!r}"
        ) from error
    if seed < 0:
        raise ValueError(f"rng must be at least 0, got {seed}")
    return np.random.default_rng(seed)


def spectral_slope(surface: core.HeightMap) -> float:
    """Root of the mean square of the gradient of a map, from its Fourier derivative.

    It is the h' of theories of rough contact. That of differences between points is less. Where a
    map is not periodic, its gradient is weighted by Hann's window, which leaves out the rim.
    """
    first, second, _, power = _derivatives(surface)
    return float(np.sqrt(np.mean(first**2 + second**2) / power))


def _check(surface: object) -> None:
    """Raise a `TypeError` unless this is a map."""
    if not isinstance(surface, core.HeightMap):
        raise TypeError(f"surface must be a HeightMap, got {surface!r}")


def _derivatives(surface: core.HeightMap) -> tuple[Array, Array, Array, float]:
    """Return gradient and Laplacian of a map times a window W, and the mean of W².

    Along an axis that is not periodic W is 1 - cos, halved; else it is 1. The products follow from
    Fourier derivatives of periodic functions alone: W h' = (W h)' - W' h, and
    W h'' = (W h)'' - 2 (W' h)' + W'' h. The mean slope is taken out first, so that both ends of h
    are alike.
    """
    _check(surface)
    heights = surface.heights - surface.heights.mean()
    shape, repeats = heights.shape, surface.periodic
    axes = [
        np.expand_dims(2 * np.pi * (np.arange(count) + 0.5) / count, 1 - axis)
        for axis, count in enumerate(shape)
    ]
    ones = [np.ones_like(place) for place in axes]
    window = [
        flat if so else 0.5 - 0.5 * np.cos(place)
        for flat, so, place in zip(ones, repeats, axes, strict=True)
    ]
    gradient, laplacian = [], np.zeros(shape)
    for axis, (count, step) in enumerate(zip(shape, surface.spacing, strict=True)):
        across, rate = window[1 - axis], 2 * np.pi / (count * step)
        trend, centred = 0.0, axes[axis] / rate - 0.5 * count * step
        if not repeats[axis]:
            trend = float((heights * centred).sum() / (centred**2 * np.ones(shape)).sum())
        residual = heights - trend * centred
        slope = 0 * ones[axis] if repeats[axis] else 0.5 * rate * np.sin(axes[axis])
        bend = 0 * ones[axis] if repeats[axis] else 0.5 * rate**2 * np.cos(axes[axis])
        waves = np.expand_dims(2 * np.pi * np.fft.rfftfreq(count, step), 1 - axis)

        def derivative(field: Array, order: int, axis: int = axis, waves: Array = waves) -> Array:
            factors = (1j * waves) ** order
            if order == 1 and field.shape[axis] % 2 == 0:
                factors[(slice(None),) * axis + (-1,)] = 0.0  # the highest wave has no direction
            transform = np.fft.rfft(field, axis=axis) * factors
            return np.asarray(np.fft.irfft(transform, field.shape[axis], axis=axis))

        weighted = window[axis] * residual
        inclined = derivative(weighted, 1) - slope * residual + trend * window[axis]
        gradient.append(across * inclined)
        curved = derivative(weighted, 2) - 2 * derivative(slope * residual, 1) + bend * residual
        laplacian += across * curved
    power = float(np.mean((window[0] * window[1]) ** 2))
    return gradient[0], gradient[1], laplacian, power


@frozen()
class Roughness(TableResult):
    """Height parameters of a map, about its mean, and its slope and curvature."""

    _TITLE = "roughness of a map"

    sa: float = quantity("m", label="Sa")
    """Mean of the absolute heights [m]: Sa of ISO 25178-2."""
    sq: float = quantity("m", label="Sq")
    """Root of the mean square of the heights [m]: Sq."""
    sp: float = quantity("m", label="Sp")
    """Highest point above the mean [m]: Sp."""
    sv: float = quantity("m", label="Sv")
    """Lowest point below the mean [m]: Sv."""
    ssk: float = quantity(label="Ssk")
    """Skewness of the heights: Ssk; 0 for a plane."""
    sku: float = quantity(label="Sku")
    """Kurtosis of the heights: Sku, 3 for Gaussian ones; 0 for a plane."""
    rms_slope: float = quantity(label="rms slope")
    """Root of the mean square of the gradient: as `spectral_slope` finds it."""
    rms_curvature: float = quantity("1/m", label="rms curvature")
    """Rms of half the Laplacian [1/m]: of the mean curvature, likewise."""


def roughness(surface: core.HeightMap) -> Roughness:
    """Height parameters, slope and curvature of a map.

    A plane that was not subtracted when the map was read is part of its roughness.

    Parameters
    ----------
    surface : HeightMap
        Measured or random surface.

    Returns
    -------
    Roughness
        Parameters of ISO 25178-2, and slope and curvature from the spectrum.

    Examples
    --------
    >>> wave = 1e-6 * np.sin(2 * np.pi * np.arange(64) / 64)[:, None] * np.ones(64)
    >>> parameters = nacre.rough.roughness(nacre.HeightMap(wave, 1e-6, periodic=(True, True)))
    >>> round(parameters.sq * 1e6, 3), round(parameters.rms_slope, 4)
    (0.707, 0.0694)
    """
    _check(surface)
    heights = surface.heights - surface.heights.mean()
    sq = float(heights.std())
    _, _, laplacian, power = _derivatives(surface)
    curvature = 0.5 * float(np.sqrt(np.mean(laplacian**2) / power))
    third, fourth = (float(np.mean(heights**n)) / sq**n if sq > 0 else 0.0 for n in (3, 4))
    return Roughness(
        sa=float(np.abs(heights).mean()),
        sq=sq,
        sp=float(heights.max()),
        sv=float(np.abs(heights.min())),
        ssk=third,
        sku=fourth,
        rms_slope=spectral_slope(surface),
        rms_curvature=curvature,
    )


def markup(surface: core.HeightMap) -> str:
    """Return what a notebook shows of a map: its size, its roughness and a picture."""

    def draw() -> Axes:
        from nacre import plot

        return plot.heights(surface)

    grid = map_grid(surface)
    points = " × ".join(map(str, surface.heights.shape))
    size = " × ".join(written(side, "m") for side in grid.size)
    repeats = [name for name, is_so in zip("xy", surface.periodic, strict=True) if is_so]
    rows = [("points", points), ("size", size), ("periodic", " and ".join(repeats) or "no")]
    table = [*rows, *((row.label, row.text) for row in roughness(surface)._rows())]
    return display.markup(table, picture=display.drawn(draw))


def windowed(surface: core.HeightMap, taper: float = 0.1) -> core.HeightMap:
    """Make a map periodic: its heights go to their mean at the rim, as half a cosine.

    Parameters
    ----------
    surface : HeightMap
        Map; along an axis in which it is periodic already it stays as it is.
    taper : float, optional
        Share of each side over which the heights fall off, above 0 and at most 0.5.

    Returns
    -------
    HeightMap
        The map, periodic along x and y.

    Raises
    ------
    ValueError
        If the share is out of range.

    Examples
    --------
    >>> rough = nacre.HeightMap(np.random.default_rng(1).normal(size=(64, 64)) * 1e-7, 1e-6)
    >>> nacre.rough.windowed(rough).periodic
    (True, True)
    """
    _check(surface)
    taper = core.real("taper", taper)
    if not 0 < taper <= 0.5:
        raise ValueError(f"taper must be above 0 and at most 0.5, got {taper!r}")
    mean = surface.heights.mean()
    heights = surface.heights - mean
    for axis, count in enumerate(heights.shape):
        if not surface.periodic[axis]:
            place = (np.arange(count) + 0.5) / count
            edge = np.minimum(np.minimum(place, 1 - place) / taper, 1.0)
            heights = heights * np.expand_dims(np.sin(0.5 * np.pi * edge) ** 2, 1 - axis)
    return core.HeightMap(
        heights + mean, surface.spacing, center=surface.center, periodic=(True, True)
    )


@names_itself
def load_curve(
    shape: core.Shape,
    body: Body,
    pressures: Sequence[float],
    counterbody: Body | None = None,
    *,
    grid: core.Grid | None = None,
    **keywords: Any,
) -> xarray.Dataset:
    """Contact under one mean pressure after the other, as a table; needs ``nacre-contact[files]``.

    Each solve starts from the one before. With a `hardness` the table is a history: the surfaces
    keep the permanent indentation of the steps before.

    Parameters
    ----------
    shape
        Surface that is pressed in, such as a `HeightMap`.
    body, counterbody
        Bodies, as in `nacre.solve`.
    pressures
        Mean pressures over the grid [Pa], above 0.
    grid
        Cells; those of the map by default.
    **keywords
        Other arguments of `nacre.Contact` and of its `solve`, but no load.

    Returns
    -------
    xarray.Dataset
        Over ``pressure``: load, contact area and its share of the grid, both also corrected as
        `corrected_area` does, the mean gap, the approach, the stiffness -d pressure / d gap, and
        the number of patches.

    Raises
    ------
    ValueError
        If there are no pressures, or one is not above 0.
    """
    with extra("files"):
        import xarray

    values = core.real_array("pressures", pressures)
    positive = np.isfinite(values) & (values > 0)
    if values.ndim != 1 or values.size == 0 or not positive.all():
        raise ValueError(f"pressures must be numbers above 0, at least one, got {pressures!r}")
    if grid is None:
        if not isinstance(shape, core.HeightMap):
            raise ValueError("grid must be given for a shape that is not a map")
        grid = map_grid(shape)
    plan_options = {
        name: keywords.pop(name) for name in ("coefficients", "threads") if name in keywords
    }
    contact = Contact(body, grid, counterbody, **plan_options)
    area = grid.size[0] * grid.size[1]
    columns: dict[str, list[float]] = {name: [] for name in CURVE}
    last: Solution | None = None
    for value in values:
        last = contact.solve(shape, load=value * area, initial=last, **keywords)
        corrected = corrected_area(last)
        gap = last.gap[np.isfinite(last.gap)]
        numbers = {
            "load": last.load,
            "contact_area": last.contact_area,
            "corrected_area": corrected,
            "share": last.contact_area / area,
            "corrected_share": corrected / area,
            "mean_gap": gap.mean(),
            "approach": last.approach,
            "stiffness": last.stiffness()[0, 0] / area,
            "patches": patches(last).size,
        }
        for name, number in numbers.items():
            columns[name].append(float(number))
    dataset = xarray.Dataset(
        {name: ("pressure", column) for name, column in columns.items()},
        coords={"pressure": values},
        attrs={"source": f"nacre {core.__version__}", "area": area},
    )
    for name, (words, unit) in CURVE.items():
        dataset[name].attrs = {"long_name": words, "units": symbol(unit) if unit != "1" else "1"}
    dataset["pressure"].attrs = {"long_name": "mean pressure", "units": symbol("Pa")}
    return dataset


def corrected_area(solution: Solution) -> float:
    """Contact area without the error of counting cells [m²], to the first order.

    Cells that the edge of the contact cuts count as a whole where more than a part of them is
    pressed: the area of all is too large by some tenth of perimeter times cell. Yastrebov,
    Anciaux & Molinari (Tribol. Int. 114 (2017) 161, arXiv:1701.02727)
    subtract (π - 1 + ln 2)/24 of it, the perimeter S counted along the sides of cells. On round
    contacts of nacre's own the error is 0.09 S, and 0.10 S with "spectral" coefficients, where they
    subtract 0.118 S: a quarter of the correction is the uncertainty of the result.

    Raises
    ------
    ValueError
        If the grid is one of strips.
    """
    if solution.report.grid.is_line:
        raise ValueError("the grid of solution must have cells along x, got a line")
    dx, dy = solution.report.grid.spacing
    along, across = _sides(solution)
    perimeter = along * dx + across * dy
    return float(max(solution.contact_area - PERIMETER * perimeter * np.sqrt(dx * dy), 0.0))


def area_coefficient(solution: Solution) -> float:
    """Area in contact over load and rms slope: κ = A E* h' / (A₀ p̄).

    A is `corrected_area`, A₀ the area of the grid, and p̄ the mean pressure over it. E* is that of
    the substrates, whatever lies on them. h' is the rms slope of the undeformed surface, as
    `spectral_slope` finds it, without the permanent indentation. At light loads of bare bodies
    theories give a constant: 1.60 (Persson, J. Chem. Phys. 115 (2001) 3840) to 2.51 (Bush, Gibson &
    Thomas, Wear 35 (1975) 87).

    Parameters
    ----------
    solution : Solution
        Contact of a rough surface that is periodic along x and y; `windowed` makes it so.

    Returns
    -------
    float
        The coefficient κ.

    Raises
    ------
    ValueError
        If the grid is not periodic along x and y, the surface is plane or cannot touch everywhere,
        nothing presses, or the bodies have no contact modulus: rigid substrates, a response.

    Examples
    --------
    A wave that is pressed flat touches everywhere: its κ is E* h' / p̄.

    >>> wave = 1e-7 * np.cos(2 * np.pi * np.arange(32) / 32)[:, None] * np.ones(8)
    >>> surface = nacre.HeightMap(wave, 1e-6, periodic=(True, True))
    >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    >>> solution = nacre.solve(surface, steel, load=4e9 * 256e-12)
    >>> slope = nacre.rough.spectral_slope(surface)
    >>> round(area_coefficient(solution) / (steel.plane_strain_modulus * slope / 4e9), 6)
    1.0
    """
    grid, report = solution.report.grid, solution.report
    if grid.is_line or not all(grid.periodic):
        raise ValueError(
            "the grid of solution must be periodic along x and y: the share of the area of one "
            "contact depends on the size of its grid"
        )
    if not np.isfinite(solution.gap).all():
        raise ValueError("the shape of solution must be able to touch everywhere")
    if not solution.load > 0:
        raise ValueError(f"the load of solution must be above 0, got {solution.load}")
    members = [body for body in (report.body, report.counterbody) if body is not None]
    bases = [getattr(body, "substrate", core.RIGID) for body in members]
    elastic = [base for base in bases if isinstance(base, core.Elastic)]
    if not elastic or any(isinstance(body, core.Response) for body in members):
        raise ValueError("the bodies of solution must have an elastic substrate for a modulus E*")
    heights = solution.displacement + solution.indentation - solution.gap
    slope = spectral_slope(core.HeightMap(heights, grid.spacing, periodic=grid.periodic))
    if not slope > 0:
        raise ValueError("the surface of solution must be rough, got a plane")
    return corrected_area(solution) * contact_modulus(*elastic) * slope / solution.load


def patches(solution: Solution) -> Array:
    """Areas of the patches of the contact [m²], the largest first.

    Cells that share a side belong to one patch, across the seam of a periodic grid as well.
    """
    labels = patch_labels(solution.in_contact, solution.report.grid)
    counts = np.bincount(labels.ravel())[1:]
    dx, dy = solution.report.grid.spacing
    areas: Array = np.sort(counts[counts > 0])[::-1] * np.float64(dx * dy)
    return areas


def percolates(solution: Solution) -> tuple[bool, bool]:
    """Whether the gap is open from side to side, along x and along y: whether it leaks.

    Cells that share a side are connected. Along a periodic direction, a path must lead from a cell
    to the same cell of the next period.
    """
    gap = ~solution.in_contact
    return crosses(gap, solution.report.grid, 0), crosses(gap, solution.report.grid, 1)


def pressure_distribution(solution: Solution, bins: int = 50) -> xarray.DataArray:
    """Probability density of the pressure in the contact [1/Pa], over the pressure.

    Its integral is the share of the cells in contact. The others, without pressure, are the
    attribute ``share_at_zero``.
    """
    contact = solution.in_contact
    return _distribution(solution.pressure[contact], contact.size, bins, "pressure", "Pa")


def gap_distribution(solution: Solution, bins: int = 50) -> xarray.DataArray:
    """Probability density of the gap outside the contact [1/m], over the gap.

    Its integral is the share of the cells that do not touch. Those in contact are the attribute
    ``share_at_zero``. Cells that can never touch do not count.
    """
    contact, gap = solution.in_contact, solution.gap
    finite = np.isfinite(gap)
    return _distribution(gap[finite & ~contact], int(finite.sum()), bins, "gap", "m")


def _distribution(values: Array, count: int, bins: int, name: str, unit: str) -> xarray.DataArray:
    with extra("files"):
        import xarray

    bins = core.integer("bins", bins)
    if bins < 1:
        raise ValueError(f"bins must be a whole number of at least 1, got {bins!r}")
    core.check_memory("bins", bins, 64)
    highest = float(values.max()) if values.size and values.max() > 0 else 1.0
    numbers, edges = np.histogram(values, bins, (0.0, highest))
    density = numbers / count / np.diff(edges)
    distribution = xarray.DataArray(
        density,
        {name: 0.5 * (edges[1:] + edges[:-1])},
        name="density",
        attrs={
            "long_name": f"probability density of the {name}",
            "units": f"1/{symbol(unit)}",
            "share_at_zero": 1 - values.size / count,
        },
    )
    distribution[name].attrs = {"long_name": name, "units": symbol(unit)}
    return distribution


def spectrum(solution: Solution | core.HeightMap) -> xarray.Dataset:
    """Power spectra of the undeformed and of the deformed surface, averaged over directions.

    Of a map it is the spectrum of the ``surface``; one that is not periodic is windowed.

    The deformed surface is minus the gap: flat where the bodies touch. The density is that of
    SurfaceTopography, ``power_spectrum_from_area`` [m⁴], over the wavenumber [rad/m].

    Raises
    ------
    ValueError
        If the grid is one of strips, or the shape cannot touch everywhere.
    """
    if isinstance(solution, core.HeightMap):
        return _spectra({"surface": solution.heights}, map_grid(solution), {})
    grid, report = solution.report.grid, solution.report
    if not np.isfinite(solution.gap).all():
        raise ValueError("the shape must be able to touch everywhere for a spectrum")
    tilt = solution.tilt[0] * solution.x[:, None] + solution.tilt[1] * solution.y[None, :]
    undeformed = -(solution.gap - solution.displacement + tilt)
    both = {"undeformed": undeformed, "deformed": -solution.gap}
    return _spectra(both, grid, {"residual": report.residual})


def _spectra(
    fields: dict[str, Array], grid: core.Grid, attributes: dict[str, object]
) -> xarray.Dataset:
    """Return the spectra of heights on a grid."""
    with extra("files"):
        import xarray

    densities = {}
    for name, heights in fields.items():
        topography = _topography(heights - heights.mean(), grid, "solution")
        wavenumber, density = topography.power_spectrum_from_area()
        finite = np.isfinite(density) & (wavenumber > 0)
        densities[name] = ("wavenumber", np.asarray(density[finite], dtype=np.float64))
    dataset = xarray.Dataset(densities, {"wavenumber": np.asarray(wavenumber[finite])})
    dataset.attrs["source"] = f"nacre {core.__version__}"
    dataset.attrs |= attributes
    dataset["wavenumber"].attrs = {"long_name": "wavenumber", "units": f"rad/{symbol('m')}"}
    for name in densities:
        words = f"spectral density of the {name} surface"
        dataset[name].attrs = {"long_name": words, "units": f"{symbol('m')}⁴"}
    return dataset


def map_grid(surface: core.HeightMap) -> core.Grid:
    """Return the grid of a map."""
    shape = surface.heights.shape
    size = shape[0] * surface.spacing[0], shape[1] * surface.spacing[1]
    return core.Grid(shape, size, surface.center, periodic=surface.periodic)


def _topography(heights: Array, grid: core.Grid, name: str) -> Any:
    """Return a topography of SurfaceTopography."""
    with surfaces():
        from SurfaceTopography import Topography

    if grid.is_line:
        raise ValueError(f"the grid of {name} must have cells along x, got a line")
    return Topography(np.asarray(heights), tuple(grid.size), periodic=all(grid.periodic))


def _sides(solution: Solution) -> tuple[int, int]:
    """Return how many sides of cells along x and along y lie between contact and gap."""
    contact, repeats = solution.in_contact, solution.report.grid.periodic
    counts = []
    for axis in (1, 0):
        # Beyond the rim of a grid that does not repeat nothing touches.
        last, none = np.take(contact, [-1], axis), np.zeros_like(np.take(contact, [0], axis))
        closed = [last, contact] if repeats[axis] else [none, contact, none]
        counts.append(int(np.sum(np.diff(np.concatenate(closed, axis), axis=axis))))
    return counts[0], counts[1]
