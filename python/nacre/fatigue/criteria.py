"""Shakedown and fatigue criteria of histories of stresses."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import ClassVar, Literal, NamedTuple, get_args

import numpy as np
import numpy.typing as npt

import nacre._core as core
from nacre._tools.groups import in_unit, names_itself
from nacre._tools.typing import Real, among
from nacre.results import values

Array = npt.NDArray[np.float64]
Rule = Literal["von_mises", "in_plane_tresca"]
"""Condition of yield."""


class Shakedown(NamedTuple):
    """What a perfectly plastic material needs to shake down under a history.

    Its fields have the leading axes of the history.
    """

    shear_yield: Array
    """Smallest yield stress in shear with which it shakes down [Pa]."""
    residual: Array
    """Residual stresses ``(..., 2)`` along x and y that make it possible [Pa]."""
    first_yield: Array
    """Smallest yield stress in shear with which nothing yields without them [Pa]."""


def shakedown(history: Real, *, rule: Rule = "von_mises") -> Shakedown:
    """Smallest yield stress with which a perfectly plastic material shakes down, after Melan.

    Residual stresses along x and y that do not change with time may add to every state: all that
    are in equilibrium in a line contact. The stress-free state far from a contact is not added.

    Parameters
    ----------
    history : array_like
        States of stress ``(..., times, 6)`` [Pa]: xx, yy, zz, xy, yz, xz.
    rule : {"von_mises", "in_plane_tresca"}, optional
        Condition of yield: ``sqrt(J2) <= k``, or ``hypot((yy - zz)/2, yz) <= k``, which is that of
        Tresca in the plane of rolling alone and has no residual stress along x.

    Returns
    -------
    Shakedown
        Yield stress in shear, residual stresses, and yield stress for first yield.

    Raises
    ------
    ValueError
        If the last axis has no 6 components, there is no state, or one is not finite.

    Examples
    --------
    A pull from 0 to 1, of which residual stresses take a half:

    >>> pull = np.zeros((2, 6))
    >>> pull[1, 1] = 1.0
    >>> limits = nacre.fatigue.shakedown(pull)
    >>> round(float(limits.first_yield / limits.shear_yield), 12)
    2.0
    """
    if not among(rule, get_args(Rule)):
        raise ValueError(f'rule must be "von_mises" or "in_plane_tresca", got {rule!r}')
    states, axes = _states(history)
    stresses, _ = core.shakedown(states, rule)
    residual = stresses[:, 1:3].reshape(*axes, 2)
    return Shakedown(stresses[:, 0].reshape(axes), residual, stresses[:, 3].reshape(axes))


def _states(history: object) -> tuple[Array, tuple[int, ...]]:
    """Return a history as ``(n, times, 6)``, and its leading axes."""
    states = core.real_array("history", history)
    if states.ndim < 2 or states.shape[-1] != 6:
        raise ValueError(f"history must have the shape (..., times, 6), got {states.shape}")
    axes = states.shape[:-2]
    count = int(np.prod(axes, dtype=np.int64))
    return states.reshape(count, *states.shape[-2:]), axes


@dataclass(frozen=True)
class Criterion:
    """Base of the fatigue criteria."""

    _KIND: ClassVar[str]

    bending: float | None = field(default=None, metadata=in_unit("Pa"))
    """Fatigue limit in fully reversed bending [Pa]."""
    torsion: float | None = field(default=None, metadata=in_unit("Pa"))
    """Fatigue limit in fully reversed torsion [Pa]."""

    def __post_init__(self) -> None:
        """Check the limits."""
        for name in ("bending", "torsion"):
            if (value := getattr(self, name)) is None:
                raise ValueError(f"{name} must be given: a criterion needs both fatigue limits")
            object.__setattr__(self, name, core.real(name, value))
        self._factor_and_limit()

    def _factor_and_limit(self) -> tuple[float, float]:
        """Return the factor and the limit."""
        return core.fatigue_constants(self._KIND, self.bending, self.torsion)

    @property
    def constants(self) -> tuple[float, float]:
        """Factor of the hydrostatic or normal stress, and limit [Pa]: (a, b) or (k, f)."""
        return self._factor_and_limit()

    @property
    def limit(self) -> float:
        """Limit with which `stress` is compared [Pa]."""
        return self._factor_and_limit()[1]

    def stress(self, history: Real) -> Array:
        """Equivalent stress of a history, which is safe up to `limit`.

        Parameters
        ----------
        history : array_like
            States of stress ``(..., times, 6)`` [Pa]: xx, yy, zz, xy, yz, xz. The stress-free
            state far from a contact is not added.

        Returns
        -------
        numpy.ndarray
            Equivalent stress [Pa], with the leading axes of the history.

        Raises
        ------
        ValueError
            If the last axis has no 6 components, there is no state, or one is not finite.

        Examples
        --------
        In fully reversed bending at its limit, it is the limit:

        >>> criterion = nacre.fatigue.DangVan(bending=520e6, torsion=330e6)
        >>> bent = np.zeros((2, 6))
        >>> bent[:, 1] = 520e6, -520e6
        >>> round(float(criterion.stress(bent) / criterion.limit), 12)
        1.0
        """
        states, axes = _states(history)
        return self._equivalent_stress(states)[0].reshape(axes)

    def _equivalent_stress(self, states: Array) -> tuple[Array, npt.NDArray[np.uintp], Array]:
        """Return equivalent stress, deciding state and gap to the next plane of each history."""
        return core.fatigue_stress(self._KIND, self.bending, self.torsion, states)

    def _arguments(self) -> dict[str, object]:
        """Return the arguments of the constructor, for data."""
        return {"bending": self.bending, "torsion": self.torsion}

    def __reduce__(self) -> tuple[object, tuple[object, ...]]:
        """Return the class and its arguments."""
        return type(self), (self.bending, self.torsion)


Criterion.__init__ = names_itself(Criterion.__init__)  # type: ignore[method-assign]


class DangVan(Criterion):
    """Dang Van's criterion: the largest ``tau(t) + a hydrostatic(t)``.

    ``tau`` is half the difference of the largest and smallest principal value of the deviator less
    the centre of the smallest hypersphere that holds all deviators of the history;
    ``a = 3 (torsion / bending - 1/2)``, and the limit is that of torsion.

    Parameters
    ----------
    bending, torsion : float
        Fatigue limits in fully reversed bending and torsion [Pa].

    Raises
    ------
    ValueError
        If a limit is missing or not above 0, or that of torsion is below half that of bending.

    Examples
    --------
    >>> a, b = nacre.fatigue.DangVan(bending=500e6, torsion=310e6).constants
    >>> round(a, 3), b
    (0.36, 310000000.0)
    """

    _KIND = "dang_van"


class Crossland(Criterion):
    """Crossland's criterion: ``R / sqrt(2) + a`` times the largest hydrostatic stress.

    ``R`` is the radius of the smallest hypersphere that holds all deviators of the history, with
    the norm ``sqrt(s:s)``; ``a = 3 torsion / bending - sqrt(3)``, and the limit is that of torsion.
    Crossland (1956); the form of code_aster's POST_FATIGUE, which has half of the largest distance
    of two states for ``R``: the same in proportional loading, up to 15 % less else.

    Parameters
    ----------
    bending, torsion : float
        Fatigue limits in fully reversed bending and torsion [Pa].

    Raises
    ------
    ValueError
        If a limit is missing or not above 0, or that of torsion is below that of bending over the
        square root of 3.

    Examples
    --------
    >>> a, b = nacre.fatigue.Crossland(bending=500e6, torsion=310e6).constants
    >>> round(a, 3), b
    (0.128, 310000000.0)
    """

    _KIND = "crossland"


class Findley(Criterion):
    """Findley's criterion: the largest ``tau_a + k sigma_n`` of all planes.

    ``tau_a`` is the radius of the smallest circle that holds the path of the shear stress on a
    plane, ``sigma_n`` the largest normal stress there. With ``w = 2 torsion / bending - 1``,
    ``k = w / sqrt(1 - w**2)`` and the limit is ``torsion sqrt(1 + k**2)``. Findley, J. Eng. Ind. 81
    (1959) 301; constants derived. A compressive ``sigma_n`` counts with its sign, so that it helps:
    programs that count tension alone, as code_aster does for Matake's criterion, are on the safe
    side of this where the whole history is compressed, as it mostly is in rolling.

    Parameters
    ----------
    bending, torsion : float
        Fatigue limits in fully reversed bending and torsion [Pa].

    Raises
    ------
    ValueError
        If a limit is missing or not above 0, or that of torsion is below half that of bending, or
        not below it.

    Examples
    --------
    >>> k, f = nacre.fatigue.Findley(bending=500e6, torsion=310e6).constants
    >>> round(k, 3), round(f / 1e6, 1)
    (0.247, 319.3)
    """

    _KIND = "findley"


class Matake(Criterion):
    """Matake's criterion: ``tau_a + k sigma_n`` on the plane of the largest ``tau_a``.

    The terms are those of `Findley`. Of planes with the same ``tau_a``, as a plane and its
    conjugate are, that with the largest ``sigma_n`` counts, with its sign as in `Findley`. ``k = 2
    torsion / bending - 1``, and the limit is that of torsion. Matake, Bull. JSME 20 (1977) 257 (not
    read); constants derived.

    Parameters
    ----------
    bending, torsion : float
        Fatigue limits in fully reversed bending and torsion [Pa].

    Raises
    ------
    ValueError
        If a limit is missing or not above 0, or that of torsion is below half that of bending.

    Examples
    --------
    >>> k, f = nacre.fatigue.Matake(bending=500e6, torsion=310e6).constants
    >>> round(k, 2), f
    (0.24, 310000000.0)
    """

    _KIND = "matake"


CRITERIA: dict[str, type[Criterion]] = {
    kind._KIND: kind for kind in (DangVan, Crossland, Findley, Matake)
}
"""Criteria by the words of case files."""
values.CALLS |= {kind.__name__: (kind, ("bending", "torsion")) for kind in CRITERIA.values()}
