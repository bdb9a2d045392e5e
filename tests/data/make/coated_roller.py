"""The coated roller of Spinu et al. by a program of its own: coated_roller.json.

Response of the coated half-space: O'Sullivan and King, J. Tribol. 110 (1988) 235,
doi:10.1115/1.3261591, in closed form. Influence coefficients by images: the half-space of the
coat's material, an image 2h deep that makes up for the substrate far away, both integrated over
cells in closed form, and a smooth rest by Hankel's transform. Contact by the constrained conjugate
gradients of Polonsky and Keer, Wear 231 (1999) 206, doi:10.1016/S0043-1648(99)00113-1; the slope
that balances the moment by the secant method.
"""

import sys

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.optimize import root_scalar
from scipy.special import j0

from common import main

NAME, SECONDS = "coated_roller.json", 60
PLACES, WEIGHTS = np.polynomial.legendre.leggauss(16)


def response(alpha, ratio, young, poisson, h):
    """Displacement per pressure times alpha, of a coat of `ratio` times the substrate's modulus."""
    a, b = 3 - 4 * poisson, 1 - poisson
    lam, kappa = 1 - 4 * b / (1 + ratio * a), (ratio - 1) / (ratio + a)
    x = alpha * h
    theta = np.exp(-2 * x)
    top = 1 + 4 * x * kappa * theta - lam * kappa * theta**2
    bottom = 1 - (lam + kappa + 4 * kappa * x**2) * theta + lam * kappa * theta**2
    return 2 * (1 - poisson**2) / (ratio * young) * top / bottom


def potential(x, y, depth):
    """Integral of 1/ρ over a rectangle from the origin, ρ² = x² + y² + depth²."""
    rho = np.sqrt(x**2 + y**2 + depth**2)
    value = x * np.arcsinh(y / np.hypot(x, depth)) + y * np.arcsinh(x / np.hypot(y, depth))
    return value - depth * np.arctan2(x * y, depth * rho) if depth else value


def over_cells(x, y, dx, dy, depth):
    """Integral of 1/ρ over cells centred on x, y."""
    return sum(
        s * t * potential(x + s * dx / 2, y + t * dy / 2, depth) for s in (1, -1) for t in (1, -1)
    )


def rest(radii, ratio, young, poisson, h):
    """Kernel of what both half-spaces leave, at radii."""
    coat = 2 * (1 - poisson**2) / (ratio * young)
    base = 2 * (1 - poisson**2) / young
    end, count = 20 / h, 2500  # exp(-40) is left beyond the end
    edges = np.linspace(0, end, count + 1)
    half = 0.5 * np.diff(edges)[:, None]
    alpha = (edges[:-1, None] + half * (PLACES + 1)).ravel()
    weight = (half * WEIGHTS).ravel()
    smooth = (
        response(alpha, ratio, young, poisson, h) - coat - (base - coat) * np.exp(-2 * alpha * h)
    )
    return np.array([(weight * smooth) @ j0(alpha * r) for r in radii]) / (2 * np.pi)


def coefficients(shape, spacing, ratio, young, poisson, h):
    """Influence coefficients for offsets of -(n - 1) to n - 1 cells."""
    (nx, ny), (dx, dy) = shape, spacing
    x = dx * np.arange(nx)[:, None]
    y = dy * np.arange(ny)
    coat = (1 - poisson**2) / (np.pi * ratio * young)
    base = (1 - poisson**2) / (np.pi * young)
    quarter = coat * over_cells(x, y, dx, dy, 0.0)
    quarter = quarter + (base - coat) * over_cells(x, y, dx, dy, 2 * h)
    # The rest is a smooth function of asinh(r/2h) once its decay as r^-3 is taken out.
    reach = np.hypot(nx * dx, ny * dy)
    points = np.linspace(0, np.arcsinh(reach / (2 * h)), 300)
    radii = 2 * h * np.sinh(points)
    spline = CubicSpline(points, rest(radii, ratio, young, poisson, h) * np.cosh(points) ** 3)
    for u, wu in zip(*np.polynomial.legendre.leggauss(32), strict=True):
        for v, wv in zip(*np.polynomial.legendre.leggauss(4), strict=True):
            place = np.arcsinh(np.hypot(x + u * dx / 2, y + v * dy / 2) / (2 * h))
            quarter = quarter + 0.25 * wu * wv * dx * dy * spline(place) / np.cosh(place) ** 3
    rows = np.concatenate([quarter, quarter[:1] * 0, quarter[:0:-1]])
    return np.concatenate([rows, rows[:, :1] * 0, rows[:, :0:-1]], axis=1)


def press(convolve, gap, weight):
    """Pressure and approach where the pressures of all cells sum to `weight`, and gaps close."""
    pressure = (gap < np.median(gap)).astype(float)
    pressure *= weight / pressure.sum()
    direction, old, conjugate = np.zeros_like(gap), 1.0, 0.0
    for _ in range(20_000):
        distance = convolve(pressure) + gap
        inside = pressure > 0
        approach = distance[inside].mean()
        distance -= approach
        if np.abs(distance[inside]).max() < 1e-11 * approach and distance[~inside].min() > 0:
            return pressure, approach
        square = (distance[inside] ** 2).sum()
        direction = np.where(inside, distance + conjugate * square / old * direction, 0.0)
        old = square
        moved = convolve(direction)
        moved -= moved[inside].mean()
        step = (distance * direction)[inside].sum() / (moved * direction)[inside].sum()
        pressure = np.maximum(pressure - step * direction, 0.0)
        overlapping = (pressure == 0) & (distance < 0)
        pressure[overlapping] -= step * distance[overlapping]
        conjugate = 0.0 if overlapping.any() else 1.0
        pressure *= weight / pressure.sum()
    raise RuntimeError("not converged")


def fill(content):
    radius, flat, crown = (content["roller"][name] for name in ("radius", "flat_length", "crown"))
    young, poisson, load = (content["body"][name] for name in ("young", "poisson", "load"))
    shape, size = content["grid"]["shape"], content["grid"]["size"]
    spacing = [size[k] / shape[k] for k in range(2)]
    x, y = (spacing[k] * (np.arange(shape[k]) - 0.5 * (shape[k] - 1)) for k in range(2))
    beyond = np.maximum(np.abs(x) - flat / 2, 0.0)
    local = radius - (crown - np.sqrt(crown**2 - beyond**2))
    roller = radius - np.sqrt(local[:, None] ** 2 - y**2)
    weight = load / (spacing[0] * spacing[1])
    for case in content["cases"]:
        h, ratio = case["thickness"], case["modulus_ratio"]
        spectrum = np.fft.rfft2(coefficients(shape, spacing, ratio, young, poisson, h))

        def convolve(field, spectrum=spectrum):
            padded = [2 * n for n in shape]
            full = np.fft.irfft2(spectrum * np.fft.rfft2(field, s=padded), s=padded)
            return full[: shape[0], : shape[1]]

        def pressed(slope, convolve=convolve):
            return press(convolve, roller + slope * x[:, None], weight)

        def excess(slope, pressed=pressed, arm=case["eccentricity"]):
            pressure, _ = pressed(slope)
            return (pressure.sum(axis=1) @ x) / pressure.sum() - arm

        slope = 0.0
        if case["eccentricity"]:
            slope = root_scalar(excess, x0=0.0, x1=-1e-6, xtol=1e-14, rtol=1e-9).root
        pressure, approach = pressed(slope)
        case |= {"peak": float(pressure.max()), "approach": float(approach), "slope": slope}


if __name__ == "__main__":
    main(sys.modules[__name__])
