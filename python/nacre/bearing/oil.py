"""Viscosity of mineral oils by their ISO grade: ISO 3448, ASTM D2270 and ASTM D341."""

from __future__ import annotations

import numpy as np

import nacre._core as core
from nacre.bearing.geometry import above

INDEX = 95.0
"""Viscosity index for which ISO 281 draws its charts of mineral oils."""
COLDEST, HOTTEST = -20.0, 150.0
"""Temperatures between which mineral oils flow and last [°C]."""
KELVIN, SHIFT = 273.15, 0.7
"""Temperature of 0 °C [K], and the number that ASTM D341 adds to a viscosity [mm²/s]."""
THINNEST, THICKEST = 10.0, 1500.0
"""Grades of ISO 3448 between which the table below holds [mm²/s]."""
BASIS = np.array(
    """
     2.0 1.14673   1.7576   -0.109 0.84155  1.5521  -0.077
     3.8 3.38095 -15.4952   33.196 0.78571  1.7929  -0.183
     4.4 2.50000  -7.2143   13.812 0.82143  1.5679   0.119
     5.0 0.10100  16.6350  -45.469 0.04985  9.1613 -18.557
     6.4 3.35714 -23.5643   78.466 0.22619  7.7369 -16.656
     7.0 0.01191  21.4750  -72.870 0.79762 -0.7321  14.610
     7.7 0.41858  16.1558  -56.040 0.05794 10.5156 -28.240
     9.0 0.88779   7.5527  -16.600 0.26665  6.7015 -10.810
    12.0 0.76720  10.7972  -38.180 0.20073  8.4658 -22.490
    15.0 0.97305   5.3135   -2.200 0.28889  5.9741  -4.930
    18.0 0.97256   5.2500   -0.980 0.24504  7.4160 -16.730
    22.0 0.91413   7.4759  -21.820 0.20323  9.1267 -34.230
    28.0 0.87031   9.7157  -50.770 0.18411 10.1015 -46.750
    40.0 0.84703  12.6752 -133.310 0.17029 11.4866 -80.620
    55.0 0.85921  11.1009  -83.190 0.17130 11.3680 -76.940
    70.0 0.83531  14.6731 -216.246 0.16841 11.8493 -96.947
    """.split(),
    dtype=float,
).reshape(-1, 7)
"""Rows of ASTM D2270, appendix X2: from a viscosity Y at 100 °C [mm²/s] on, the coefficients of the
parabolas in Y of the viscosities at 40 °C of oils with the indices 0 and 100."""


def oil_viscosity(grade: float, temperature: float) -> float:
    """Kinematic viscosity of a mineral oil of an ISO grade at a temperature [m²/s].

    Parameters
    ----------
    grade : float
        ISO VG of ISO 3448, the viscosity at 40 °C in mm²/s: 68 of ISO VG 68; from 10 to 1500.
    temperature : float
        Temperature [°C], from -20 to 150.

    Returns
    -------
    float
        Viscosity [m²/s].

    Raises
    ------
    ValueError
        If an argument is out of range.

    Notes
    -----
    The oil has the viscosity index 95, for which ISO 281 draws its charts: ASTM D2270 gives the
    viscosity at 100 °C, and the line of ASTM D341, ``log log (ν + 0.7)`` over ``log T``, passes
    through both. Real oils of a grade differ by 10 % at 40 °C, and more by their index.

    Examples
    --------
    >>> from nacre.bearing import oil_viscosity
    >>> [round(oil_viscosity(68, celsius) * 1e6, 1) for celsius in (40, 70, 100)]
    [68.0, 19.9, 8.5]
    """
    at_40, celsius = above("grade", grade), core.real("temperature", temperature)
    if not THINNEST <= at_40 <= THICKEST:
        raise ValueError(f"grade must be from {THINNEST:g} to {THICKEST:g}, got {grade!r}")
    if not COLDEST <= celsius <= HOTTEST:
        raise ValueError(
            f"temperature must be from {COLDEST:g} to {HOTTEST:g} °C, got {temperature!r}"
        )
    at_100 = np.geomspace(BASIS[0, 0], 2 * BASIS[-1, 0], 1000)
    rows = BASIS[np.searchsorted(BASIS[:, 0], at_100, side="right") - 1].T
    low, high = (np.polyval(rows[k : k + 3], at_100) for k in (1, 4))
    known = (at_40, np.interp(at_40, low - INDEX / 100 * (low - high), at_100))
    places = np.log10(np.array([40.0, 100.0, celsius]) + KELVIN)
    first, last = np.log10(np.log10(np.array(known) + SHIFT))
    slope = (last - first) / (places[1] - places[0])
    return float(10**10 ** (first + slope * (places[2] - places[0])) - SHIFT) * 1e-6
