"""Response of a body to loads on its surface, and planned convolutions."""

from __future__ import annotations

import copyreg
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Generic, Literal, NamedTuple, Self, TypeVar, overload

import numpy as np

import nacre._core as core
from nacre._tools.typing import Body, Field, Layers, Matrix, Vector

if TYPE_CHECKING:
    from scipy.sparse.linalg import LinearOperator

Value = TypeVar("Value", covariant=True)
Method = Literal["exact", "plain", "difference", "image", "spectral"]


@overload
def frequency_response(body: Body, wavenumber: float) -> float: ...
@overload
def frequency_response(body: Body, wavenumber: Vector | Matrix) -> Field: ...
def frequency_response(body: Body, wavenumber: object) -> float | Field:
    """Frequency response: normal surface displacement per unit pressure of one wavenumber.

    Parameters
    ----------
    body : HalfSpace, Elastic or Response
        Body under the pressure; its free ends are not counted.
    wavenumber : float or array_like
        ``alpha = sqrt(m**2 + n**2)`` [1/m], above 0, of any shape.

    Returns
    -------
    float or numpy.ndarray
        ``u_z/p`` [m/Pa], in the shape of `wavenumber`. For one layer it equals the formula of Nogi
        & Kato, J. Tribol. 119 (1997) 493, with the sign of its denominator corrected.

    Raises
    ------
    ValueError
        If a wavenumber is not finite and above 0.

    Examples
    --------
    >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    >>> alpha = 1e3
    >>> round(nacre.frequency_response(steel, alpha) * alpha * steel.plane_strain_modulus, 12)
    2.0
    """
    return core.frequency_response(body, wavenumber)


class SurfaceCompliance(NamedTuple, Generic[Value]):
    """Surface compliances [m/Pa] of one wavenumber, or of an array of wavenumbers."""

    c11: Value
    """Normal displacement under pressure."""
    c12: Value
    """Lateral displacement under pressure, and normal displacement under lateral traction."""
    c22: Value
    """Displacement under traction along the wave."""
    ct: Value
    """Displacement under traction across the wave."""


@overload
def surface_compliance(body: Layers, wavenumber: float) -> SurfaceCompliance[float]: ...
@overload
def surface_compliance(body: Layers, wavenumber: Vector | Matrix) -> SurfaceCompliance[Field]: ...
def surface_compliance(body: Layers, wavenumber: object) -> SurfaceCompliance[float | Field]:
    """Surface displacements per unit traction of one wavenumber, normal and lateral.

    With the x axis along the wave, under pressure p and tractions q_x, q_y on the body::

        u_z = c11 p - i c12 q_x      u_x = i c12 p + c22 q_x      u_y = ct q_y

    Parameters
    ----------
    body : HalfSpace or Elastic
        Body under the tractions; its free ends are not counted.
    wavenumber : float or array_like
        ``alpha = sqrt(m**2 + n**2)`` [1/m], above 0, of any shape.

    Returns
    -------
    SurfaceCompliance
        Named tuple ``(c11, c12, c22, ct)`` of numbers or arrays [m/Pa] in the shape of
        `wavenumber`; ``c11`` equals `frequency_response`.

    Raises
    ------
    TypeError
        If the wavenumbers are not real numbers.
    ValueError
        If a wavenumber is not finite and above 0.

    Examples
    --------
    On a half-space ``c12/c11 = (1 - 2 nu)/(2 - 2 nu)``:

    >>> compliance = nacre.surface_compliance(nacre.Elastic(young=1.0, poisson=0.25), [1.0, 2.0])
    >>> (compliance.c12 / compliance.c11).round(12)
    array([0.33333333, 0.33333333])
    """
    return SurfaceCompliance(*core.surface_compliance(body, wavenumber))


def influence_coefficients(
    body: Body, grid: core.Grid, method: Method = "exact", refinement: int | None = None
) -> Field:
    """Displacement at offsets from a cell under unit pressure.

    Parameters
    ----------
    body : HalfSpace, Elastic or Response
        Body under the pressure; its free ends are not counted.
    grid : Grid
        Grid with that cell; there is an offset for each of its cells.
    method : {"exact", "plain", "difference", "image", "spectral"}, optional
        ``"exact"`` has no aliasing, for any thickness and any cell. The other methods sample a
        frequency response and transform it back: ``"plain"`` the response of the body;
        ``"difference"`` its difference from the response of a half-space of the coating's material;
        ``"image"`` the remainder of that difference beside an image potential. ``"plain"`` and
        ``"difference"`` are inaccurate on long thin domains; ``"image"`` needs layers thicker than
        a cell. On a periodic grid, ``"exact"`` sums over the images of the cell; ``"spectral"``
        samples the response at the waves of a grid that repeats in both directions, as other
        programs do.
    refinement : int, optional
        Refinement of the spectral mesh of the conversions; 4 by default.

    Returns
    -------
    numpy.ndarray
        Coefficients ``(nx, ny)`` [m/Pa] of the offsets ``(i dx, j dy)``, ``i, j >= 0``.

    Raises
    ------
    ValueError
        If the method is another word or the refinement is below 1.
    MemoryError
        If the grid does not fit.

    Examples
    --------
    >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    >>> grid = nacre.Grid(shape=(8, 8), size=(8e-6, 8e-6))
    >>> nacre.influence_coefficients(steel, grid).shape
    (8, 8)
    """
    return core.influence_coefficients(body, grid, method, refinement)


def graded_layers(
    substrate: core.Elastic | core.Rigid | core.Free,
    thickness: float,
    young: float | Callable[[float], float],
    poisson: float | Callable[[float], float],
    tolerance: float = 1e-3,
    breakpoints: Iterable[float] | None = None,
) -> list[core.Layer]:
    """Layers that replace a coating whose properties vary with depth.

    The functions are evaluated at two thousand depths, and wherever neighbours differ, the interval
    is bisected: jumps are located to rounding, and steep parts are set apart. Each section between
    them is cut into equal layers with the properties at their middle, and their number is doubled
    until the frequency response, at wavelengths down to a fifth of the thickness, is within
    `tolerance` of its limit by two estimates: the last two doublings, and the mean properties that
    the search found in each layer.

    No number of samples shows what lies between them: a feature thinner than a thousandth of the
    thickness may be missed, unless one of `breakpoints` lies on it.

    Parameters
    ----------
    substrate : Elastic, nacre.RIGID or nacre.FREE
        Material below the coating.
    thickness : float
        Thickness of the coating [m].
    young : float or callable
        Young's modulus [Pa], or a function of the depth z [m] that returns it.
    poisson : float or callable
        Poisson's ratio, or a function of the depth.
    tolerance : float, optional
        Relative error of the frequency response.
    breakpoints : sequence of float, optional
        Depths [m] of jumps and of thin features that are known. A section begins at each, and its
        neighbourhood is searched down to a trillionth of the thickness.

    Returns
    -------
    list of Layer
        Layers from the surface down.

    Raises
    ------
    ValueError
        If an argument is out of range, the functions vary at every scale, as noise does, or 4096
        layers do not meet the tolerance.

    Examples
    --------
    >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    >>> layers = nacre.graded_layers(
    ...     steel, 10e-6, young=lambda z: 420e9 - 21e15 * z, poisson=0.3
    ... )
    >>> len(layers)
    64
    >>> body = nacre.HalfSpace(steel, layers)

    An adhesive of 20 nm is found where a breakpoint tells of it:

    >>> glued = lambda z: 1e9 if abs(z - 5e-6) < 10e-9 else 210e9
    >>> len(nacre.graded_layers(steel, 10e-6, glued, 0.3, breakpoints=[5e-6]))
    3
    """
    if breakpoints is not None and core.real_array("breakpoints", breakpoints).ndim != 1:
        raise TypeError(f"breakpoints must be a sequence of depths, got {breakpoints!r}")
    return core.graded_layers(substrate, thickness, young, poisson, tolerance, breakpoints)


class Convolution:
    """A planned convolution: the displacement of a surface under any pressure.

    ``u[i, j] = sum over k, l of C[|i - k|, |j - l|] p[k, l]``: as a matrix it is symmetric, and its
    own adjoint.

    Parameters
    ----------
    coefficients : array_like
        Influence coefficients C ``(nx, ny)`` [m/Pa] of the offsets ``(i dx, j dy)``, ``i, j >= 0``.
    threads : int, optional
        Number of threads; by default all of the machine's, or what ``NACRE_NUM_THREADS`` says.

    Raises
    ------
    TypeError
        If the coefficients are not real numbers.
    ValueError
        If a coefficient is not finite, there is none, or `threads` is below 1.

    Examples
    --------
    >>> convolution = nacre.Convolution([[1.0, 0.5], [0.25, 0.125]])
    >>> convolution.apply([[2.0, 0.0], [0.0, 0.0]]).round(12)
    array([[2.  , 1.  ],
           [0.5 , 0.25]])
    """

    __slots__ = ("_planned",)

    _planned: core.Convolution

    def __new__(cls, coefficients: Matrix, *, threads: int | None = None) -> Self:
        """Plan the convolution."""
        return cls._of(core.Convolution(coefficients, threads))

    @classmethod
    def _of(cls, planned: core.Convolution) -> Self:
        convolution = object.__new__(cls)
        convolution._planned = planned
        return convolution

    @staticmethod
    def of_bodies(
        body: Body,
        grid: core.Grid,
        counterbody: Body | None = None,
        *,
        threads: int | None = None,
    ) -> Convolution:
        """Plan the convolution with the exact influence coefficients of one or two bodies.

        Parameters
        ----------
        body : HalfSpace, Elastic or Response
            Body under the pressure. Free ends are not counted, of either body.
        grid : Grid
            Cells of the pressure.
        counterbody : HalfSpace, Elastic or Response, optional
            Second body under the same pressure; rigid where there is none.
        threads : int, optional
            Number of threads; by default all of the machine's, or what ``NACRE_NUM_THREADS`` says.

        Returns
        -------
        Convolution
            Convolution that gives the displacement of both surfaces together.

        Raises
        ------
        ValueError
            If an argument is out of range.
        MemoryError
            If the grid does not fit.

        Examples
        --------
        >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
        >>> grid = nacre.Grid(shape=(8, 6), size=(8e-6, 6e-6))
        >>> nacre.Convolution.of_bodies(steel, grid).shape
        (8, 6)
        """
        return Convolution._of(core.Convolution.of_bodies(body, grid, counterbody, threads))

    def apply(self, pressure: Matrix) -> Field:
        """Displacement under a pressure.

        Parameters
        ----------
        pressure : array_like
            Pressure ``(nx, ny)`` [Pa].

        Returns
        -------
        numpy.ndarray
            Displacement ``(nx, ny)`` [m].

        Raises
        ------
        TypeError
            If the pressure is not real.
        ValueError
            If the pressure has another shape, or is not finite.

        Examples
        --------
        >>> convolution = nacre.Convolution(np.ones((3, 2)))
        >>> convolution.apply(np.ones((3, 2))).round(12)
        array([[6., 6.],
               [6., 6.],
               [6., 6.]])
        """
        return self._planned.apply(pressure)

    def as_linear_operator(self) -> LinearOperator:
        """SciPy's linear operator that applies the convolution; needs SciPy.

        Returns
        -------
        scipy.sparse.linalg.LinearOperator
            Symmetric operator ``(nx ny, nx ny)`` on pressures that are flattened in C order.

        Raises
        ------
        ModuleNotFoundError
            If SciPy is missing.

        Examples
        --------
        The pressure under a flat rigid punch that covers the grid:

        >>> from scipy.sparse.linalg import cg
        >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
        >>> grid = nacre.Grid(shape=(8, 6), size=(8e-6, 6e-6))
        >>> convolution = nacre.Convolution.of_bodies(steel, grid)
        >>> pressure, failed = cg(convolution.as_linear_operator(), np.full(48, 1e-9), rtol=1e-10)
        >>> displacement = convolution.apply(pressure.reshape(8, 6))
        >>> failed, bool(np.allclose(displacement, 1e-9, rtol=1e-8))
        (0, True)
        """
        try:
            from scipy.sparse.linalg import LinearOperator
        except ModuleNotFoundError as missing:
            message = "this needs scipy: pip install scipy"
            raise ModuleNotFoundError(message, name=missing.name) from missing

        shape = self.shape
        cells = shape[0] * shape[1]

        def apply(pressure: Field) -> Field:
            return self.apply(pressure.reshape(shape)).ravel()

        return LinearOperator((cells, cells), matvec=apply, rmatvec=apply, dtype=np.float64)

    @property
    def shape(self) -> tuple[int, int]:
        """Shape ``(nx, ny)`` of pressures and displacements."""
        return self._planned.shape()

    @property
    def coefficients(self) -> Field:
        """Influence coefficients ``(nx, ny)`` [m/Pa]."""
        return self._planned.coefficients()

    @property
    def threads(self) -> int:
        """Number of threads."""
        return self._planned.threads()

    def __eq__(self, other: object) -> bool:
        """Return whether the coefficients and the number of threads asked for are the same."""
        return self._planned == other._planned if isinstance(other, Convolution) else NotImplemented

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        """Return the number of cells and of threads."""
        nx, ny = self.shape
        return f"<Convolution on {nx} x {ny} cells, {self.threads} threads>"

    def __reduce__(self) -> tuple[object, ...]:
        """Return a callable and arguments with which a pickle of any protocol plans again."""
        call = (type(self), (self.coefficients,), {"threads": self._planned.asked_threads})
        return copyreg.__newobj_ex__, call  # type: ignore[attr-defined]
