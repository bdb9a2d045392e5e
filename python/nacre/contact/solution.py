"""Solved contacts, and the reports of how they were solved."""

from __future__ import annotations

import json
import math
import os
import types
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, Self, Unpack, overload

import numpy as np

import nacre._core as core
from nacre._tools.groups import names_itself
from nacre._tools.typing import Ending, Field, Matrix, Pair, Planned, Vector
from nacre._tools.units import Scale, printable, rounded, written
from nacre.contact import plausible
from nacre.contact.gradient import (
    Direction,
    Gradient,
    MethodCall,
    Output,
    described,
    differentiable,
    gradients,
    linearisation,
)
from nacre.contact.normal import NormalContact
from nacre.contact.stresses import DepthOptions, depth_charts
from nacre.results import display, files, tables, values, vtk
from nacre.results.base import Result, as_text
from nacre.results.charts import Picture, contact_charts
from nacre.results.quantities import CELLS, Quantity, derived
from nacre.results.report import Rows, input_rows, notebook_picture, other_numbers, writer
from nacre.results.rows import Row, remark
from nacre.results.shown import Shown

if TYPE_CHECKING:
    import numpy.typing as npt
    import xarray
    from matplotlib.axes import Axes

    from nacre.contact.conductance import Conductance, Conductivities, Kind

Parts = tuple[dict[str, Any], core.Grid, Planned, Planned | None]
"""Fields of a report, its grid and its bodies."""
State = tuple[str, core.Grid, Planned, Planned | None]
"""JSON text of a report's state, its grid and its bodies."""

BODIES: dict[str, type | types.UnionType] = {
    "grid": core.Grid,
    "body": Planned,
    "counterbody": Planned | None,
}
"""Classes of what stands beside the numbers of a report."""
NESTED = {
    "balance": ("force", "moment"),
    "motion": ("load", "approach", "eccentricity", "moment", "tilt"),
}
"""Tables in the state of a report, each with its keys."""
OPTIONAL = ("hardness", "indentation", "compliance", "coefficients")
"""Fields in the state of a solution that has them."""
THEORY = (
    "linear elasticity of half-spaces, bare or layered, with small slopes: influence coefficients "
    "of rectangular cells, convolution by FFT, conjugate gradients under p ≥ 0, gap ≥ 0"
)
NOT_COUNTED = (
    "the effect of friction on the pressure, plastic flow except by a given hardness, lubrication, "
    "adhesion, temperature, and what bodies of finite size add except by given free ends"
)
"""What a report says of the model."""
ENDLESS = ("residual", "overlap")
"""Numbers of a report that may be infinite, of which JSON has none."""


@dataclass(frozen=True, repr=False)
class Report(Result):
    """Report of a solve: how the solution came about and how good it is, computed at the end.

    Examples
    --------
    >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    >>> report = nacre.solve(nacre.Sphere(5e-3), steel, load=10.0).report
    >>> report.termination, report.residual < 1e-8, report.warnings
    ('converged', True, [])
    """

    _DERIVED = ("free_ends", "warning_kinds", "_data")
    _LATER = ("rolling_direction",)

    termination: Ending
    """End of the iteration: "converged", "iteration limit" or "stopped"; "running" before it."""
    solver: Literal["preconditioned", "active-set", "polonsky-keer"] | None
    """Iteration that produced the solution: "preconditioned", "active-set" or "polonsky-keer".

    The algorithm "cascade" starts with the first and falls back to the others. `None` where it is
    not known: before the end.
    """
    iterations: int
    """Iterations done."""
    convolutions: float
    """Work done, in convolutions of the whole grid."""
    residual: float
    """Complementarity ``sum(p |g|) / sum(p u)`` over the cells that can touch.

    Where the local displacement is less than u, as on a substrate much softer than its coating, it
    takes the place of u.
    """
    overlap: float
    """Largest overlap ``max(-g, 0) / max(u)`` of the cells that can touch.

    Where the local displacement is less than the largest u, it takes its place.
    """
    balance: tuple[float, float, float]
    """Mismatch of the force, relative to W, and of the moments along x and y, to W × half a side.
    """
    discretisation: dict[str, Any] | None
    """Errors due to the size of the cells, estimated from coarser grids.

    The keys are ``peak_pressure`` [Pa], ``approach`` [m], ``load`` [N], ``contact_area`` [m²],
    ``contact_extent`` [m], of the ends along x and of those along y, and ``tilt``, of both slopes.
    A prescribed quantity has the error 0. The peak pressure has none, `None`, where the pressure is
    singular: at a sharp edge of the shape, or where the grid cuts the contact; a warning says so.
    An axis along which the contact has no ends has none. `None` altogether where no coarser grid
    was solved: with fewer than eight cells along a side, from a given pressure, by another
    algorithm, or without convergence. An error above 1 % of the peak from what lies between the
    stations of a sampled profile is then a warning. Files of earlier versions lack the last three.
    """
    free_ends: dict[str, bool | float | None] | None
    """How free ends of the bodies are counted; `None` where there are none.

    ``plates`` says whether a body has two ends, and is taken as a plate. ``error`` is the largest
    error of the displacement, relative to it, that was measured for such bodies, for bare plates
    that of the pressure too, larger for lengths below a quarter of the grid's width; `None` for
    layers whose moduli differ by a factor of more than 10.
    """
    warnings: list[str]
    """Warnings about the solution; each was also issued as a `nacre.NacreWarning`."""
    warning_kinds: list[str]
    """Kinds of the warnings, without their numbers: words by which warnings are counted.

    They are "grid edge", "sharp end", "free end", "coated end", "sharp edge", "map rim", "coarse",
    "coarse spots", "large contact", "outside grid", "peak error", "stations", "unknown stations"
    and "endless crown"; and of numbers that are not plausible "high pressure", "thick layer" and
    "odd modulus".
    """
    grid: core.Grid
    """Grid of the solve."""
    body: Planned
    """Body that the shape was pressed into."""
    counterbody: Planned | None
    """Body that carries the shape; rigid where `None`."""
    motion: dict[str, Any]
    """Motion that was asked for, as keywords of `Contact.solve`: load or approach, and the tilts.
    """
    rolling_direction: Pair | None
    """Unit vector ``(x, y)`` along which the shape rolls.

    It is across the axis of a roller, y in line contact, and x of a body of revolution that is
    pressed on its axis, as all are alike. Friction acts along it where no `direction` is given.
    `None` where the shape has no such direction, or it is not known, as in files of earlier
    versions.
    """
    tolerance: float
    """Tolerance that was asked for."""
    seconds: float
    """Seconds that the solve took, without planning."""
    _data: dict[str, object]
    """State of the report, but for its grid and its bodies."""

    @property
    def converged(self) -> bool:
        """Whether the tolerance was met."""
        return self.termination == "converged"

    @classmethod
    def _of(cls, record: Parts) -> Self:
        """Return the report of the parts that the compiled module hands over."""
        report, *bodies = record
        data = report["data"]
        balance, motion = data["balance"], data["motion"]
        fields = {
            "balance": (balance["force"], *balance["moment"]),
            "free_ends": report["free_ends"],
            "warnings": report["messages"],
            "warning_kinds": [warning["kind"] for warning in data["warnings"]],
            "motion": {k: v for k, v in motion.items() if v not in (None, (None, None))},
        }
        return cls(**data | fields | dict(zip(BODIES, bodies, strict=True)), _data=data)

    def _state(self) -> dict[str, object]:
        bodies = {name: getattr(self, name) for name in BODIES}
        state: dict[str, object] = values.encode(self._data | bodies)
        return state

    @classmethod
    def _parts(cls, data: object) -> State:
        """Return the parts of a report with this state, which the compiled module checks."""
        if not isinstance(data, Mapping):
            raise ValueError(f"report must be a dict of named fields, got {data!r}")
        state = values.with_names("report", data, cls._names(), cls._LATER)
        bodies: Any = []
        for name, kind in BODIES.items():
            encoded = state.pop(name)
            if not isinstance(value := values.decode(encoded), kind):
                raise ValueError(f'report: the value of the key "{name}" does not fit: {encoded!r}')
            bodies.append(value)
        for name, keys in NESTED.items():
            if isinstance(entries := state[name], Mapping):
                state[name] = values.with_names(name, entries, keys)
        state |= {name: None for name in ENDLESS if state[name] == math.inf}
        return as_text("Report", state), *bodies

    @classmethod
    def _restored(cls, state: dict[str, object]) -> Self:
        return cls._of(core.checked_report(*cls._parts(state)))

    def __repr__(self) -> str:
        """Return how the solve ended."""
        return (
            f"<Report: {self.termination} after {self.iterations} iterations, "
            f"{self.convolutions:.1f} convolutions, {self.seconds:.3f} s; "
            f"residual {self.residual:.1e}, overlap {self.overlap:.1e}; "
            f"{len(self.warnings)} warnings>"
        )


def check_unyielded(solution: Solution) -> None:
    """Raise a `ValueError` for a contact whose surfaces have yielded.

    Its pressure is right, but the residual stress of the material that yielded is not in the
    stresses, and the shape of the dent not in what follows from radii.
    """
    if (depth := float(solution.indentation.max())) > 0:
        raise ValueError(
            "solution must be one whose surfaces have not yielded, as stresses and radii below a "
            f"dent are not known, got a permanent indentation of {written(depth, 'm')}: solve "
            "without hardness and without a dented initial solution"
        )


@dataclass(frozen=True, repr=False, init=False)
class Solution(NormalContact, Shown, Result):
    """A solved contact. Fields are ``(nx, ny)``, at cell centres, and read-only.

    Examples
    --------
    >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    >>> solution = nacre.solve(nacre.Sphere(5e-3), steel, load=10.0)
    >>> solution.pressure.shape == solution.in_contact.shape == (solution.x.size, solution.y.size)
    True
    """

    _LATER = OPTIONAL
    _TITLE = "contact of coated bodies"

    _solved: core.Solved
    """Solution of the compiled module."""
    _shape: core.Shape | None = field(compare=False)
    """Shape that the contact was solved with; None where it is not known, as from a file."""

    def __init__(self) -> None:
        raise TypeError("a Solution is not made by hand: nacre.solve returns it")

    @classmethod
    def _of(cls, solved: core.Solved, shape: core.Shape | None = None) -> Self:
        """Return a solution of the compiled module."""
        solution = object.__new__(cls)
        solution.__dict__.update(_solved=solved, _shape=shape)
        return solution

    @cached_property
    @derived("m", dims=CELLS, after="gap")
    def displacement(self) -> Field:
        """Normal displacement of both bodies together [m], positive into them."""
        return self._solved.field("displacement")

    @cached_property
    @derived("m/Pa", dims=("offset_x", "offset_y"), after="line_load")
    def coefficients(self) -> Field | None:
        """Influence coefficients that the contact was given, ``(nx, ny)`` [m/Pa].

        `None` where they are those of the bodies.
        """
        return self._solved.field("coefficients")

    @property
    @derived("J", "J/m", after="central_pressure")
    def elastic_energy(self) -> float:
        """Elastic energy of the bodies [J] and of springs between them.

        It is ``½ sum p (u + c p) dA``: u is the normal displacement of the bodies and c the
        `compliance` of the springs. Where the surfaces do not yield, its derivative by the approach
        is the load. Where the approach has a datum, as in line contact, the displacement and the
        energy have it, too: the bare substrate's surface, as `Grid.line` says.
        """
        size, shape = self.grid.size, self.grid.shape
        cell = size[1] / shape[1] if self.grid.is_line else size[0] * size[1] / self.pressure.size
        springs = 0.0 if self.compliance is None else self.compliance * self.pressure
        return 0.5 * cell * float(np.vdot(self.pressure, self.displacement + springs))

    @cached_property
    def report(self) -> Report:
        """Report: how the solution came about, and how good it is."""
        report = Report._of(self._solved.report())
        doubts = dict(plausible.of_contact(self, report))
        return replace(
            report,
            warnings=[*report.warnings, *doubts.values()],
            warning_kinds=[*report.warning_kinds, *doubts],
        )

    def stiffness(self) -> Field:
        """Exact tangent stiffness ``(3, 3)`` of ``(sum p dA, sum p x dA, sum p y dA)``.

        The columns are the derivatives of the discrete contact with respect to the approach [m]
        and the slopes ``s_x`` and ``s_y``. The matrix is symmetric. The second row is the couple
        about y, to which force at positive x contributes positively. All elements are 0 where
        nothing touches.

        Returns
        -------
        numpy.ndarray
            Stiffness in N/m, N and N m.

        Raises
        ------
        MemoryError
            If the influence coefficients do not fit.

        Examples
        --------
        For a sphere on a half-space, dW/dδ = 2 E* a:

        >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
        >>> solution = nacre.solve(nacre.Sphere(5e-3), steel, load=10.0)
        >>> radius = (0.75 * 10.0 * 5e-3 / steel.plane_strain_modulus) ** (1 / 3)
        >>> stiffness = float(solution.stiffness()[0, 0])
        >>> round(stiffness / (2 * steel.plane_strain_modulus * radius), 2)
        1.0
        """
        return self._solved.stiffness()

    def conductance(
        self,
        *,
        conductivity: Conductivities,
        counter_conductivity: Conductivities | None = None,
        film: npt.ArrayLike = 0.0,
        kind: Kind = "thermal",
    ) -> Conductance:
        """Resistance of the contact to heat or to current, between bodies of layers.

        The cells in contact are at one temperature or voltage on each side, and all others are
        insulated. Layers, roughness, hardness, wear and springs change the resistance through the
        cells in contact, and layers also through their conductivities.

        Parameters
        ----------
        conductivity : float, str, dict or sequence
            Conductivity of the body [W/(m K), S/m]: one number for all of it, a number of each
            layer from the surface down and of the substrate, or by number or name of the layer
            with "substrate". A name of `nacre.materials` stands for its thermal conductivity,
            and `math.inf` for a body at one temperature or voltage throughout.
        counter_conductivity : float, str, dict or sequence
            Conductivity of the counterbody in the same forms. It must be given, since a rigid
            counterbody has no material.
        film : float or array_like
            Resistance per area of a film between the surfaces [m² K/W, Ω m²], of all cells or of
            each ``(nx, ny)``.
        kind : {"thermal", "electrical"}
            What is conducted, which decides on the units.

        Returns
        -------
        nacre.types.Conductance
            Resistance, its error, and the flux of each cell.

        Raises
        ------
        ValueError
            If a conductivity is missing, is not above 0 or looks like a resistivity, nothing is in
            contact, the bodies have free ends, or the grid repeats along one axis only.

        Notes
        -----
        In units of N, mm and MPa, a thermal conductivity is the same number, in mW/(mm K), and the
        resistance is in K/mW; an electrical one is in S/mm, and the resistance in Ω.

        Examples
        --------
        A ball on a flat, both of steel: 1/(2 k a) between equal bodies.

        >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
        >>> solution = nacre.solve(nacre.Sphere(5e-3), steel, steel, load=10.0)
        >>> heat = solution.conductance(conductivity=46.0, counter_conductivity=46.0)
        >>> radius = (0.75 * 10.0 * 5e-3 / (steel.plane_strain_modulus / 2)) ** (1 / 3)
        >>> round(heat.resistance * 2 * 46.0 * radius, 2)
        1.0
        """
        from nacre.contact.conductance import conductance_of

        return conductance_of(self, conductivity, counter_conductivity, film, kind)

    @overload
    def gradient(
        self,
        output: Output,
        wrt: Sequence[str] | None = None,
        *,
        shape: core.Shape | None = None,
        tolerance: float = 1e-9,
    ) -> Gradient: ...
    @overload
    def gradient(
        self,
        output: list[Output],
        wrt: Sequence[str] | None = None,
        *,
        shape: core.Shape | None = None,
        tolerance: float = 1e-9,
    ) -> list[Gradient]: ...
    def gradient(
        self,
        output: Output | list[Output],
        wrt: Sequence[str] | None = None,
        *,
        shape: core.Shape | None = None,
        tolerance: float = 1e-9,
    ) -> Gradient | list[Gradient]:
        """Differentiate an output with respect to all parameters of the contact.

        Derivatives are those of the discrete contact with its cells, exact within the tolerance of
        one linear solve for each output. Compared with the continuum they are in error by some 2e-4
        with 64 cells along the radius of the contact, see :doc:`/theory/gradients`.

        Parameters
        ----------
        output : str, tuple, dict or list
            ``"approach"``, ``"tilt[0]"``, ``"tilt[1]"``, ``"load"``, ``"moment[0]"``,
            ``"moment[1]"``, ``"peak_pressure"``, ``"cell_peak"``, ``"participation_area"`` or
            ``"area_estimate"``; ``("pressure_norm", r)``, ``("pressure", (x, y))``,
            ``("displacement", (x, y))`` or ``("gap", (x, y))``; a dict of a stress, with
            ``stress`` (``"xx"`` to ``"xz"``, ``"von_mises"``, ``"principal[0]"``,
            ``"max_shear"``, ``"plane_shear"``), one of ``at=(x, y, z)``, ``layer`` and
            ``interface``, and ``depths``, ``sharpness``, ``side``, ``body``, ``friction`` and
            ``direction``; or a list of these. ``"peak_pressure"`` is the peak between cells, from
            which `Solution.peak_pressure` of a cell differs by less than its error.
        wrt : list of str, optional
            Paths of the parameters, such as ``"body.layers[0].material.young"``,
            ``"shape.radius"`` or ``"load"``; all by default. A layer has its number or its name,
            ``"body.layers.DLC.thickness"``.
        shape : Shape, optional
            Shape that the contact was solved with, which a solution from a file does not know.
        tolerance : float, optional
            Residual of the linear solves, relative to their right-hand sides.

        Returns
        -------
        Gradient or list of Gradient
            Derivatives by path, and with respect to the gap of each cell.

        Raises
        ------
        ValueError
            If the output, a parameter or the solution has no derivative; the message says what to
            take instead.

        Examples
        --------
        >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
        >>> ball = nacre.Sphere(5e-3)
        >>> solution = nacre.solve(ball, steel, load=10.0)
        >>> peak = solution.gradient("peak_pressure")
        >>> round(peak["shape.radius"] * 5e-3 / peak.value, 2)  # p0 ~ R^(-2/3)
        -0.67
        """
        outputs = output if isinstance(output, list) else [output]
        named_outputs = [described(entry) for entry in outputs]
        all_gradients = gradients(self, "gradient", outputs, named_outputs, wrt, shape, tolerance)
        return all_gradients if isinstance(output, list) else all_gradients[0]

    def jvp(
        self,
        directions: dict[str, float] | None = None,
        gap: Matrix | None = None,
        *,
        shape: core.Shape | None = None,
        tolerance: float = 1e-9,
    ) -> Direction:
        """Change of the solution along a direction of parameters.

        Parameters
        ----------
        directions : dict, optional
            Rates of the parameters, by path.
        gap : array_like, optional
            Rate of the undeformed gap ``(nx, ny)``.
        shape : Shape, optional
            Shape that the contact was solved with, which a solution from a file does not know.
        tolerance : float, optional
            Residual of the linear solve, relative to its right-hand side.

        Returns
        -------
        Direction
            Changes of pressure, approach and tilt, and the step for which the contact keeps its
            cells.

        Raises
        ------
        ValueError
            If a parameter or the solution has no derivative.

        Examples
        --------
        >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
        >>> solution = nacre.solve(nacre.Sphere(5e-3), steel, load=10.0)
        >>> change = solution.jvp({"load": 1.0})
        >>> round(float(change.pressure.sum() / solution.pressure.sum()), 6)
        0.1
        """
        if not isinstance(directions, dict | None):
            raise TypeError("directions must be a dict of paths and their rates")
        linear, keywords = linearisation(self, shape, tolerance)
        rates = directions or {}
        paths = differentiable(self, rates)
        change = linear.jvp(list(zip(paths, rates.values(), strict=True)), gap)
        return Direction(*change, MethodCall(self, "jvp", (directions, gap), keywords))

    def vjp(
        self,
        cotangent: Matrix,
        wrt: Sequence[str] | None = None,
        *,
        shape: core.Shape | None = None,
        tolerance: float = 1e-9,
    ) -> Gradient:
        """Differentiate ``(cotangent * pressure).sum()``: a cotangent times the Jacobian.

        Parameters
        ----------
        cotangent : array_like
            Weights of the pressures ``(nx, ny)``.
        wrt : list of str, optional
            Paths of the parameters; all by default.
        shape : Shape, optional
            Shape that the contact was solved with, which a solution from a file does not know.
        tolerance : float, optional
            Residual of the linear solve, relative to its right-hand side.

        Returns
        -------
        Gradient
            Derivatives by path, and with respect to the gap of each cell.

        Raises
        ------
        ValueError
            If a parameter or the solution has no derivative.

        Examples
        --------
        >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
        >>> solution = nacre.solve(nacre.Sphere(5e-3), steel, load=10.0)
        >>> total = solution.vjp(solution.pressure * 0.0 + 1.0, ["load"])
        >>> round(total["load"] * 10.0 / total.value, 6)
        1.0
        """
        named_outputs = [("weighted pressure", cotangent)]
        return gradients(self, "vjp", [cotangent], named_outputs, wrt, shape, tolerance)[0]

    def plot(self, axes: Axes | Mapping[str, Axes] | None = None) -> dict[str, Axes]:
        """Draw map, sections and main numbers; needs ``nacre-contact[plot]``.

        Parameters
        ----------
        axes : matplotlib.axes.Axes or dict of them, optional
            Axes to draw into: a dict with any of the names "map", "x", "y" and "numbers", as
            ``subplot_mosaic`` makes it, or one for the map; a new figure by default.

        Returns
        -------
        dict of matplotlib.axes.Axes
            The axes, by name.

        Raises
        ------
        ValueError
            If there is no part of that name.

        Examples
        --------
        >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
        >>> solution = nacre.solve(nacre.Sphere(5e-3), steel, load=10.0)
        >>> sorted(solution.plot())
        ['map', 'numbers', 'x', 'y']
        """
        from nacre import plot

        return plot.overview(self, axes)

    def plot_3d(self, axes: object = None, *, interactive: bool = False) -> Any:
        """Draw the pressure as a relief; needs ``nacre-contact[plot]``.

        A relief that can be turned needs ``nacre-contact[view]``.

        Parameters
        ----------
        axes : mpl_toolkits.mplot3d.axes3d.Axes3D, optional
            Axes to draw into; a new figure by default.
        interactive : bool, optional
            Whether to open a window of PyVista's instead.

        Returns
        -------
        mpl_toolkits.mplot3d.axes3d.Axes3D or pyvista.Plotter
            The axes, or the plotter.

        Raises
        ------
        ValueError
            If the grid is one of strips, `Grid.line`.

        Examples
        --------
        >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
        >>> nacre.solve(nacre.Sphere(5e-3), steel, load=10.0).plot_3d().get_zlabel()
        'pressure [GPa]'
        """
        from nacre import plot

        return plot.view(self) if interactive else plot.relief(self, axes)

    def plot_section(
        self,
        along: Literal["x", "y"] = "x",
        *,
        at: float | None = None,
        quantity: Literal[
            "pressure", "gap", "displacement", "indentation", "line_load"
        ] = "pressure",
        axes: Axes | None = None,
    ) -> Axes:
        """Draw a quantity along x or y; needs ``nacre-contact[plot]``.

        Parameters
        ----------
        along : {"x", "y"}, optional
            Direction of the section.
        at : float, optional
            Position of the section in the other direction [m]; through the largest pressure by
            default.
        quantity : {"pressure", "gap", "displacement", "indentation", "line_load"}, optional
            Quantity to draw.
        axes : matplotlib.axes.Axes, optional
            Axes to draw into; a new figure by default.

        Returns
        -------
        matplotlib.axes.Axes
            The axes.

        Raises
        ------
        ValueError
            If there is no such direction or quantity, or the position is off the grid.

        Examples
        --------
        >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
        >>> nacre.solve(nacre.Sphere(5e-3), steel, load=10.0).plot_section("y").get_xlabel()
        'y [µm]'
        """
        from nacre import plot

        return plot.section(self, along, at, quantity, axes)

    def to_xarray(self) -> xarray.Dataset:
        """Dataset of the fields, with units and the whole problem; needs ``nacre-contact[files]``.

        Returns
        -------
        xarray.Dataset
            Fields on x and y; main numbers, bodies, motion and options as attributes.

        Examples
        --------
        >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
        >>> dataset = nacre.solve(nacre.Sphere(5e-3), steel, load=10.0).to_xarray()
        >>> sorted(dataset.data_vars), dataset.pressure.units
        (['displacement', 'gap', 'line_load', 'pressure'], 'Pa')
        """
        return files.gridded(self)

    @names_itself
    def save(
        self,
        path: str | os.PathLike[str],
        *,
        depths: float | Vector | None = None,
        whole: bool = False,
        **options: object,
    ) -> Path:
        """Write a file, whole or not at all; needs ``nacre-contact[files]``.

        Parameters
        ----------
        path : str or os.PathLike
            File to write. Its ending chooses the content: ``.nc`` is everything, as NetCDF, for
            `nacre.load` and xarray; ``.vtr`` is the fields, for ParaView; ``.csv`` is the sections
            along x and y through the largest pressure; ``.png``, ``.pdf`` and ``.svg`` are the
            picture that `plot` draws, which needs ``nacre-contact[plot]``; ``.html`` is a report:
            verdict, inputs, numbers, pictures, limits and warnings on a page to print and to sign.
        depths : float or array_like, optional
            Depths below the surface [m], each above the last. The ``.vtr`` then holds pressure and
            gap, the stresses ``stress_xx`` … ``stress_xz``, ``von_mises``, ``max_shear`` and
            ``tension`` (the largest principal stress) at points below the cell centres. A depth on
            an interface occurs twice, above and below it.
        whole : bool, optional
            Whether the ``.csv`` holds every cell, in place of the two sections, after a block of
            comments ``# name: value`` with the most important numbers.
        options : optional
            Keywords of `stress`, with depths only: ``body``, ``friction``, ``direction``,
            ``residual``, ``threads``, and ``displacement``, which adds a vector of that name.

        Returns
        -------
        pathlib.Path
            Path of the file.

        Raises
        ------
        ValueError
            If the ending is another, the depths do not increase, depths are given for another file
            than ``.vtr`` or `whole` for another than ``.csv``, or `stress` would raise.
        TypeError
            If there is no such option.
        OSError
            If the file cannot be written.

        Examples
        --------
        >>> import tempfile
        >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
        >>> solution = nacre.solve(nacre.Sphere(5e-3), steel, load=10.0)
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     nacre.load(solution.save(f"{folder}/ball.nc")) == solution
        True
        """
        writers = files.writers(self, lambda: next(iter(self.plot().values())))
        writers |= writer(self)
        if not whole:
            writers[".csv"] = lambda file: tables.write_sections(self, file)
        if depths is None and options:
            name, *_ = sorted(options)
            words = "without depths there are no options of stresses"
            raise TypeError(f"unexpected keyword argument {name!r}: {words}")
        for is_given, ending, name in (
            (depths is not None, ".vtr", "depths are"),
            (whole, ".csv", "whole is"),
        ):
            if is_given and Path(path).suffix.lower() in {*writers} - {ending}:
                raise ValueError(f"path must end in {ending} where {name} given, got {str(path)!r}")
        if depths is not None:
            writers[".vtr"] = lambda file: vtk.write_stress(self, file, depths, options)
        return files.save(path, writers)

    def __repr__(self) -> str:
        """Return the main numbers in a line."""
        report = self.report
        nx, ny = report.grid.shape
        counterbody = "rigid" if report.counterbody is None else repr(report.counterbody)
        force = "N/m" if report.grid.is_line else "N"
        return printable(
            f"<Solution on {nx} x {ny} cells, counterbody {counterbody}: "
            f"load {written(self.load, force, 6)}, "
            f"peak pressure {written(self.peak_pressure, 'Pa', 6)}, "
            f"approach {written(self.approach, 'm', 6)}, "
            f"tilt ({self.tilt[0]:.3e}, {self.tilt[1]:.3e}), "
            f"{'converged' if report.converged else 'not converged'}>"
        )

    def _rows(self) -> list[Row]:
        rows, report = _number_rows(self), self.report
        place = 1 + max(k for k, row in enumerate(rows) if row.key in ("approach", "tilt"))
        rows.insert(place, remark("motion", _motion(report.motion)))
        return [
            *rows,
            *display.body("body", report.body),
            *display.body("counterbody", report.counterbody),
            *_moduli(report),
        ]

    def _remarks(self) -> list[Row]:
        report = self.report
        ended = f"{report.termination}{_fallback(report)}, residual {report.residual:.0e}"
        return [remark("grid", _cells(report)), remark("ended", ended)]

    def _inputs(self) -> Rows:
        report = self.report
        units = {row.name: self._si(row) for row in self._QUANTITIES}
        inputs = {
            "shape": self._shape or "not kept in the solution",
            "body": report.body,
            "counterbody": report.counterbody or "rigid",
            **report.motion,
            "hardness": self.hardness,
            "compliance": self.compliance,
            "tolerance": report.tolerance,
            "grid": report.grid,
        }
        return input_rows(inputs, units)

    def _report_rows(self) -> Rows:
        return [*_number_rows(self), *_moduli(self.report), *other_numbers(self)]

    def _charts(self, **stress: Unpack[DepthOptions]) -> Sequence[Picture]:
        """Return the charts of a report; `stress` has keywords of stresses, for their picture."""
        return [*contact_charts(self), *depth_charts(self, **stress)]

    def _notebook_picture(self) -> bytes | None:
        return notebook_picture(contact_charts(self))

    def _model(self) -> Rows:
        report = self.report
        force, *moments = report.balance
        balance = f"force {force:.0e}, moments {moments[0]:.0e} and {moments[1]:.0e}, relative"
        ending = f"{report.termination}{_fallback(report)} after {report.iterations} iterations"
        words = {
            "theory": THEORY,
            "not counted": NOT_COUNTED,
            "motion": _motion(report.motion),
            "grid": _cells(report),
            "ended": ending,
            "residual": f"{report.residual:.0e}; overlap {report.overlap:.0e}",
            "balance": balance,
            "±": "errors due to the size of the cells, estimated from coarser grids",
        }
        return [remark(*item) for item in words.items()]

    @property
    def _warnings(self) -> list[str]:
        return self.report.warnings

    def _si(self, row: Quantity) -> str:
        """Return the SI unit of a quantity of this contact."""
        return row.si(line=self.grid.is_line)

    def _attributes(self) -> dict[str, object]:
        """Return what files say of the contact besides its numbers and fields."""
        report, names = self.report, ("body", "counterbody", "grid", "motion", "discretisation")
        return {
            **{name: json.dumps(values.encode(getattr(report, name))) for name in names},
            "tolerance": report.tolerance,
            "termination": report.termination,
            "solver": report.solver or "unknown",
            "residual": report.residual,
            "overlap": report.overlap,
            "balance": np.array(report.balance),
            "iterations": report.iterations,
            "warnings": "\n".join(report.warnings),
        }

    @classmethod
    def _names(cls) -> list[str]:
        return ["pressure", "gap", "displacement", "approach", "tilt", *OPTIONAL, "report"]

    def _state(self) -> dict[str, object]:
        optional = {name: self._solved.field(name) for name in OPTIONAL}
        return {
            **{name: getattr(self, name) for name in ("pressure", "gap", "displacement")},
            "approach": self.approach,
            "tilt": list(self.tilt),
            **{name: value for name, value in optional.items() if value is not None},
            "report": self.report._state(),
        }

    @classmethod
    def _restored(cls, state: dict[str, Any]) -> Self:
        position = {name: state.pop(name) for name in ("approach", "tilt")}
        report = Report._parts(state.pop("report"))
        with values.refusing(cls.__name__):
            return cls._of(core.Solved(as_text(cls.__name__, position), report, **state))


def _moduli(report: Report) -> list[Row]:
    return display.moduli(report.body, report.counterbody)


def _cells(report: Report) -> str:
    """Return the number of cells, and along which axes they repeat."""
    repeats = [name for name, is_so in zip("xy", report.grid.periodic, strict=True) if is_so]
    period = f", periodic along {' and '.join(repeats)}" if repeats else ""
    return f"{report.grid.shape[0]} × {report.grid.shape[1]} cells{period}"


def _number_rows(solution: Solution) -> list[Row]:
    """Return names and values of the quantities that are printed, with units."""
    report, touching = solution.report, solution.contact_area > 0
    left = set() if touching else {"peak_position", "contact_extent", "contact_area"}
    if all(report.grid.periodic):
        left.add("tilt")
    texts = TEXTS | dict.fromkeys(left, _nothing)
    return display.rows(solution, solution._QUANTITIES, texts, report.grid.is_line)


def _nothing(_: object) -> None:
    """Leave a row out."""


def _centred(solution: Solution, name: str, unit: str, scale: float = 1.0) -> str | None:
    """Return a position or a moment; rounding leaves 1e-16 of the largest possible one."""
    limits = [display.NOISE * scale * side for side in solution.report.grid.size]
    return _beyond(solution, name, unit, limits)


def _peak_place(solution: Solution) -> str | None:
    """Return the place of the peak; one in a cell at the middle may be in the middle."""
    halves = [(0.5 + display.NOISE) * side for side in solution.report.grid.spacing]
    return _beyond(solution, "peak_position", "m", halves)


def _beyond(solution: Solution, name: str, unit: str, limits: Sequence[float]) -> str | None:
    """Return components; those below their limits are printed as 0."""
    values: tuple[float, float] = getattr(solution, name)
    components = [0.0 if abs(v) < limit else v for v, limit in zip(values, limits, strict=True)]
    scale = Scale.of(max((abs(v) for v in components if not math.isnan(v)), default=0.0), unit)
    texts = [f"{rounded(scale.factor * v, 4)} {scale.unit}" for v in components]
    return display.along(
        [None if math.isnan(v) else t for v, t in zip(components, texts, strict=True)]
    )


def _tilt(solution: Solution) -> str:
    """Return the slopes; a side that they move by rounding of the displacements is not tilted."""
    least = display.NOISE * float(np.abs(solution.displacement).max())
    sides = zip(solution.tilt, solution.report.grid.size, strict=True)
    slopes = [s if abs(s) * side > least else 0.0 for s, side in sides]
    errors = (solution.report.discretisation or {}).get("tilt") or (0.0, 0.0)
    text = "({:.4g}, {:.4g})".format(*slopes)
    return text + (" ± ({:.1g}, {:.1g})".format(*errors) if any(errors) else "")


def _place(solution: Solution) -> str | None:
    touches = solution.contact_area > 0
    return _centred(solution, "eccentricity", "m") if touches else "nothing touches"


def _extent(solution: Solution) -> str | None:
    widths = [high - low for low, high in solution.contact_extent]
    ends = (solution.report.discretisation or {}).get("contact_extent") or (None, None)
    sides = [
        None
        if math.isnan(width)
        else written(width, "m") + display.plus_minus(2 * (end or 0.0), width)
        for width, end in zip(widths, ends, strict=True)
    ]
    return sides[1] if solution.report.grid.is_line else display.along(sides, " × ", "{}")


def _area(solution: Solution) -> str:
    unit = "m" if solution.report.grid.is_line else "m²"
    error = (solution.report.discretisation or {}).get("contact_area") or 0.0
    return written(solution.contact_area, unit) + display.plus_minus(error, solution.contact_area)


def _contact_share(solution: Solution) -> str | None:
    """Return the share of the area; beside one contact, the area of the grid means nothing."""
    if all(solution.grid.periodic):
        return f"{100 * solution.contact_share:.3g} % of the area"
    return f"{100 * solution.contact_share:.3g} % of the grid" if _has_spots(solution) else None


def _has_spots(solution: Solution) -> bool:
    """Return whether the contact consists of spots: a line crosses more than the two of a ring."""
    inside = solution.in_contact.astype(np.int8)
    begins = [np.diff(inside, axis=axis, prepend=0) == 1 for axis in range(2)]
    return max(int(starts.sum(axis).max()) for axis, starts in enumerate(begins)) > 2


def _range(values: float | Field | None, unit: str) -> str | None:
    if values is None:
        return None
    words = [written(float(end), unit) for end in (np.min(values), np.max(values))]
    return " to ".join(dict.fromkeys(words))


def _indentation(solution: Solution) -> str | None:
    deepest = float(solution.indentation.max())
    return f"{written(deepest, 'm')} at most, permanent" if deepest > 0 else None


def _approach(solution: Solution) -> str:
    """Return the approach with its error, or with the datum that it depends on and no error."""
    if datum := datum_words(solution.report):
        return written(solution.approach, "m") + datum
    return display.estimated(solution, "approach", "m")


def datum_words(report: Report) -> str:
    """Return from where displacements of a line contact are counted, in words; else nothing."""
    repeats = (True, False) if report.grid.is_line else report.grid.periodic
    free = [body for body in (report.body, report.counterbody) if not _is_held(body)]
    if sum(repeats) != 1 or not free:
        return ""
    bare = all(isinstance(body, core.HalfSpace) and not body.layers for body in free)
    surface = "surface" if bare else "surface of the bare substrate"
    width = report.grid.size[repeats.index(False)]
    return f", from the {surface} {written(width, 'm')} away"


def _is_held(body: Planned | None) -> bool:
    """Return whether a body stays in its place far from a load."""
    if isinstance(body, core.Response):
        return body.limits[0] == 0
    return body is None or isinstance(body.substrate, core.Rigid)


def _fallback(report: Report) -> str:
    """Return the solver that ended the solve, where a cascade fell back to it."""
    return "" if report.solver in (None, "preconditioned") else f" by the {report.solver} solver"


def _motion(motion: Mapping[str, Any]) -> str:
    """Return which degrees of freedom are loaded, given and locked, in words."""
    tilts = []
    for axis, name in enumerate("xy"):
        keys = [
            key
            for key in ("eccentricity", "moment", "tilt")
            if motion.get(key, (None,) * 2)[axis] is not None
        ]
        kind = {"eccentricity": "free", "moment": "free", "tilt": "given"}
        tilts.append(f"{name} {kind[keys[0]] if keys else 'locked'}")
    control = "load" if "load" in motion else "approach"
    return f"{control}; tilt {', '.join(tilts)}"


TEXTS: dict[str, Callable[[Solution], str | None]] = {
    "eccentricity": _place,
    "moment": lambda s: _centred(s, "moment", "N" if s.report.grid.is_line else "N m", s.load),
    "approach": _approach,
    "tilt": _tilt,
    "peak_pressure": lambda s: display.estimated(s, "peak_pressure", "Pa"),
    "peak_position": _peak_place,
    "contact_extent": _extent,
    "contact_area": _area,
    "contact_share": _contact_share,
    "hardness": lambda s: _range(s.hardness, "Pa"),
    "compliance": lambda s: _range(s.compliance, "m/Pa"),
    "indentation": _indentation,
}
"""Values of a normal contact that are more than a number with its unit."""
