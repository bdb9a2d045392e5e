"""Stress below a contact: sections, and curves against depth."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, Any, Literal, NamedTuple, Unpack

import numpy as np
import numpy.typing as npt

from nacre._core import HalfSpace, check_memory, integer
from nacre._tools.extras import extra
from nacre._tools.groups import names_itself
from nacre._tools.typing import Member
from nacre._tools.units import Scale, written
from nacre.plot.drawer import draw
from nacre.plot.style import COLOURMAP, SIGNED, extent, lengths, new_axes, styled
from nacre.results.charts import Axis, Chart, Curve, ends_along, enlarged_depth

with extra("plot"):
    from matplotlib.axes import Axes
    from matplotlib.collections import QuadMesh
    from matplotlib.markers import CARETDOWN

if TYPE_CHECKING:
    from nacre.contact.solution import Solution
    from nacre.contact.stresses import SlidingOptions, Stress

Array = npt.NDArray[np.float64]

LABELS = {
    "xx": "stress xx",
    "yy": "stress yy",
    "zz": "stress zz",
    "xy": "stress xy",
    "yz": "stress yz",
    "xz": "stress xz",
    "von_mises": "von Mises stress",
    "tresca": "Tresca stress",
    "max_shear": "largest shear stress",
    "tension": "largest principal stress",
}
"""Labels of the quantities that can be drawn."""
SIGNED_QUANTITIES = ("xx", "yy", "zz", "xy", "yz", "xz", "tension")
"""Quantities that have either sign."""


class _Section(NamedTuple):
    """Values of a quantity of stress in a vertical plane, and how they are drawn."""

    quantity: str
    values: Array
    along: str
    sides: Array
    """Edges of the cells along x or y [m]."""
    edges: Array
    """Edges of the cells over the depth [m]."""
    ends: tuple[float, float]
    """Ends of the picture along x or y [m]."""
    across: Scale
    """Scale along x or y."""
    interfaces: Sequence[float]
    peak: tuple[float, float]
    """Place of the largest value: along x or y, and depth [m]."""
    contact: Sequence[float]
    """Ends of the contact along x or y, where they are known [m]."""

    @property
    def scale(self) -> Scale:
        """Scale of the values."""
        return Scale.of(self._highest, "Pa")

    @property
    def _highest(self) -> float:
        inside = np.isfinite(self.values)
        return float(np.abs(self.values).max(initial=0.0, where=inside))

    def draw(self, axes: Axes, bottom: float, down: Scale) -> QuadMesh:
        """Draw values to a depth, interfaces, the largest value and the ends of the contact."""
        across, scale = self.across, self.scale
        signed = self.quantity in SIGNED_QUANTITIES
        largest = scale.factor * self._highest or 1.0
        mesh = axes.pcolormesh(
            across.factor * self.sides,
            down.factor * self.edges,
            scale.factor * self.values,
            cmap=SIGNED if signed else COLOURMAP,
            vmin=-largest if signed else 0.0,
            vmax=largest,
            rasterized=True,
        )
        axes.grid(visible=False)
        for interface in self.interfaces:
            if interface < bottom:
                for colour, width in (("white", 2.0), ("black", 0.9)):
                    axes.axhline(down.factor * interface, color=colour, linewidth=width)
        peak = (across.factor * self.peak[0], down.factor * self.peak[1])
        for colour, width in (("black", 2.6), ("white", 1.2)):
            axes.plot(*peak, marker="+", markersize=8, markeredgewidth=width, color=colour)
        if self.contact:  # a line without points has no place in the layout
            ends = across.factor * np.array(self.contact)
            axes.plot(ends, 0.0 * ends, "k", marker=CARETDOWN, linestyle="none", clip_on=False)
        axes.set(xlabel=f"{self.along} [{across.unit}]", ylabel=f"z [{down.unit}]")
        axes.set_xlim(across.factor * self.ends[0], across.factor * self.ends[1])
        axes.set_ylim(down.factor * bottom, 0.0)
        return mesh


@names_itself
def stress_section(
    solution: Solution,
    quantity: str = "von_mises",
    *,
    along: Literal["x", "y"] = "x",
    at: float = 0.0,
    depth: float | None = None,
    rows: int = 60,
    axes: Axes | None = None,
    body: Member = "body",
    threads: int | None = None,
    **options: Unpack[SlidingOptions],
) -> Axes:
    """Draw a vertical section, with the interfaces.

    The cross marks the largest value, and triangles at the surface the edge of the contact, where
    it is known within cells (`StressPlan.edge`). A section much longer than deep is drawn out of
    scale, and the picture says so. Beyond a free end of the body nothing is drawn. Below it, a new
    figure enlarges layers thinner than a tenth of the depth: it shows three times their thickness.

    Parameters
    ----------
    solution
        Solution to draw.
    quantity
        A component ("xx" …), "von_mises", "tresca", "max_shear" or "tension".
    along
        Direction of the section.
    at
        Its place in the other direction [m].
    depth
        Largest depth [m]; 2.5 half-widths of the contact by default.
    rows
        Number of depths that are evaluated; every layer gets at least four.
    axes
        Axes to draw into; a new figure by default.
    body, threads, options
        Passed on to `Solution.stress`: `body`, `friction`, `direction`, `residual`, `threads`.

    Returns
    -------
    matplotlib.axes.Axes
        The axes.

    Raises
    ------
    ValueError
        If there is no such quantity or direction, or `Solution.stress` would raise.

    Examples
    --------
    >>> from nacre import plot
    >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    >>> body = nacre.HalfSpace(steel, [nacre.Layer(nacre.Elastic(420e9, 0.3), 20e-6)])
    >>> solution = nacre.solve(nacre.Sphere(5e-3), body, load=10.0)
    >>> plot.stress_section(solution, friction=0.2, direction=(1, 0), rows=8).get_ylabel()
    'z [µm]'
    """
    _check(quantity)
    if along not in ("x", "y"):
        raise ValueError(f"along must be 'x' or 'y', got {along!r}")
    half_space, bottom = _reach(solution, depth, body)
    edges = _edges(half_space, bottom, "rows", rows)
    x, y = (None, at) if along == "x" else (at, None)
    middles = 0.5 * (edges[1:] + edges[:-1])
    plan = solution.stress_plan(body, threads)
    field = plan.stress(middles, x=x, y=y, **options)
    values = _values(field, quantity)
    centres = field.x if along == "x" else field.y
    grid = solution.report.grid
    axis = "xy".index(along)
    sides = grid.center[axis] + grid.size[axis] * np.linspace(-0.5, 0.5, len(centres) + 1)
    low, high = np.clip(around(solution, axis, bottom), sides[0], sides[-1])
    (across, down), same = lengths([(low, high), (0.0, bottom)])
    if not np.isfinite(values).any():
        raise ValueError(f"at must be in the body, whose ends are {half_space.ends}, got {at:g}")
    row, column = np.unravel_index(np.nanargmax(values), values.shape)
    peak = centres[column], field.z[row]
    ends = [end for *_, end in ends_along(solution, axis, at, plan.edge)]
    parts = values, along, sides, edges, (low, high), across, half_space.interfaces, peak, ends
    section = _Section(quantity, *parts)
    enlarged = enlarged_depth(half_space.interfaces, bottom) if axes is None else 0.0
    with styled():
        axes = axes or new_axes(0.75, 0.75 if enlarged else 0.45)
        mesh = section.draw(axes, bottom, down)
        colourbar(axes, mesh, f"{LABELS[quantity]} [{section.scale.unit}]")
        if enlarged:
            halves = axes.figure.add_gridspec(2)
            axes.set_subplotspec(halves[0])
            below = axes.figure.add_subplot(halves[1])
            section.draw(below, enlarged, Scale.of(enlarged, "m"))
            axes.set_xlabel("")
            axes.tick_params(labelbottom=False)
        normal = "y" if along == "x" else "x"
        title = f"at {normal} = {written(at, 'm', 3)}; the cross marks the largest value, "
        title += written(float(np.nanmax(values)), "Pa", 3)
        if same:
            axes.set_aspect("equal")
            if enlarged:
                below.set_box_aspect(bottom / (high - low))
        else:
            title += f"\n{along} and z to different scales"
        axes.set_title(title)
    return axes


@names_itself
def stress_depth(
    solution: Solution,
    quantities: Sequence[str] = ("xx", "yy", "zz", "von_mises"),
    *,
    at: tuple[float, float] = (0.0, 0.0),
    depth: float | None = None,
    points: int = 80,
    axes: Axes | None = None,
    body: Member = "body",
    threads: int | None = None,
    **options: Unpack[SlidingOptions],
) -> Axes:
    """Draw stresses against depth below a point, with both sides of every interface.

    Beside it, a new figure enlarges layers thinner than a tenth of the depth: it shows three
    times their thickness.

    Parameters
    ----------
    solution
        Solution to draw.
    quantities
        Components, "von_mises", "tresca", "max_shear" or "tension".
    at
        The point (x, y) [m].
    depth
        Largest depth [m]; 2.5 half-widths of the contact by default.
    points
        Number of depths that are evaluated; every layer gets at least four.
    axes
        Axes to draw into; a new figure by default.
    body, threads, options
        Passed on to `Solution.stress`: `body`, `friction`, `direction`, `residual`, `threads`.

    Returns
    -------
    matplotlib.axes.Axes
        The axes.

    Raises
    ------
    ValueError
        If there is no such quantity, or `Solution.stress` would raise.

    Examples
    --------
    >>> from nacre import plot
    >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    >>> solution = nacre.solve(nacre.Sphere(5e-3), steel, load=10.0)
    >>> plot.stress_depth(solution, points=8).get_ylabel()
    'stress [GPa]'
    """
    if not quantities:
        raise ValueError("quantities must hold at least one name, got none")
    for quantity in quantities:
        _check(quantity)
    half_space, bottom = _reach(solution, depth, body)
    edges = _edges(half_space, bottom, "points", points)
    plan = solution.stress_plan(body, threads)
    above = plan.stress(edges, x=at[0], y=at[1], side="above", **options)
    # The sides differ at interfaces alone; the curve ends above its bottom.
    inner = [z for z in half_space.interfaces if z < bottom]
    below = plan.stress(inner, x=at[0], y=at[1], **options)
    z = np.concatenate([above.z, below.z])
    order = np.argsort(z, kind="stable")
    drawn = [np.concatenate([_values(f, q) for f in (above, below)])[order] for q in quantities]
    if not all(np.isfinite(values).all() for values in drawn):
        raise ValueError(
            f"at must be in the body, whose ends are {half_space.ends}, got x = {at[0]:g}"
        )
    curves = [Curve(z[order], v, LABELS[q]) for q, v in zip(quantities, drawn, strict=True)]
    enlarged = enlarged_depth(inner, bottom)
    inset = (0.0, enlarged) if enlarged else None
    title = f"at x = {written(at[0], 'm', 3)}, y = {written(at[1], 'm', 3)}"
    places = Axis("z", "m", (0.0, bottom)), Axis("stress", "Pa")
    return draw(Chart("", curves, places, inner, inset, title), axes, (1.0, 0.5))


def colourbar(axes: Axes, mesh: QuadMesh, label: str) -> None:
    """Draw a colour bar as high as the picture."""
    bar: Any = axes.figure.colorbar(mesh, cax=axes.inset_axes((1.03, 0.0, 0.035, 1.0)))
    bar.set_label(label)
    bar.outline.set_linewidth(0.6)
    bar.ax.grid(visible=False)


def _check(quantity: str) -> None:
    if quantity not in LABELS:
        raise ValueError(f"quantity must be one of {', '.join(LABELS)}, got {quantity!r}")


def _values(field: Stress, quantity: str) -> Array:
    """Return a quantity; a line contact has a single row."""
    values: Array = field.principal[0] if quantity == "tension" else getattr(field, quantity)
    return values.reshape(values.shape[0], -1) if values.ndim > 1 else values


def body_of(solution: Solution, member: Member) -> HalfSpace:
    """Return a body of a solution, in which there are stresses."""
    body = solution.report.body
    if member == "counterbody" and solution.report.counterbody is not None:
        body = solution.report.counterbody
    if not isinstance(body, HalfSpace):
        raise ValueError(f"stresses need a HalfSpace, got {body!r}")
    return body


def _reach(solution: Solution, depth: float | None, member: Member) -> tuple[HalfSpace, float]:
    """Return the body, and the depth down to which it is drawn."""
    body = body_of(solution, member)
    grid = solution.report.grid
    axes = (1,) if grid.is_line else (0, 1)
    if depth is None:
        widths = [np.diff(extent(solution)[axis])[0] for axis in axes]
        narrow = min(widths) or min(grid.size[axis] for axis in axes)
        depth = 1.25 * float(narrow)
    elif not 0 < depth < np.inf:
        raise ValueError(f"depth must be finite and above 0, got {depth:g}")
    # A rigid or a free base has no stresses to show.
    no_base = not hasattr(body.substrate, "young")
    return body, min(depth, body.interfaces[-1]) if no_base else depth


def _edges(body: HalfSpace, bottom: float, name: str, count: object) -> Array:
    """Return every interface, and about so many depths between them as the argument `name` says."""
    rows = integer(name, count)
    if rows < 1:
        raise ValueError(f"the number of depths must be at least 1, got {rows}")
    check_memory(name, rows, 1000)
    faces = [0.0, *(z for z in body.interfaces if z < bottom), bottom]
    if enlarged := enlarged_depth(body.interfaces, bottom):
        faces.insert(-1, enlarged)
    least = max(4, rows // 4) if enlarged else 4
    edges = [
        np.linspace(top, end, max(least, round(rows * (end - top) / bottom)), endpoint=False)
        for top, end in pairwise(faces)
    ]
    return np.concatenate([*edges, [bottom]])


def around(solution: Solution, axis: int, width: float) -> Array:
    """Return the ends of the range: the contact, and half of `width` on both sides."""
    low, high = extent(solution)[axis]
    return np.array([low - 0.5 * width, high + 0.5 * width])
