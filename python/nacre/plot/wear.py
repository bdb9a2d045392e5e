"""Pictures of histories of wear: sections of depth and pressure over the distance, and films."""

from __future__ import annotations

import os
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from nacre._tools.disk import FILMS, replacing
from nacre._tools.extras import extra
from nacre._tools.units import Scale, travelled
from nacre.plot.drawer import draw
from nacre.plot.style import styled

with extra("plot"):
    import matplotlib.pyplot as plt
    from matplotlib.animation import FFMpegWriter, FuncAnimation, PillowWriter
    from matplotlib.axes import Axes

if TYPE_CHECKING:
    from nacre.contact.wear_solution import WearHistory, WearState

Array = npt.NDArray[np.float64]


def _section(state: WearState, values: Array) -> tuple[Array, Array]:
    """Return a section through the peak pressure of the last contact: along y in line contact."""
    grid = state.solution.grid
    i, j = np.unravel_index(int(state.solution.pressure.argmax()), grid.shape)
    return (grid.y, values[i]) if grid.is_line else (grid.x, values[:, j])


def _scale(arrays: Iterable[Array], unit: str) -> Scale:
    """Return the scale of the largest of these numbers."""
    return Scale.of(max(float(np.abs(numbers).max()) for numbers in arrays), unit)


def wear(history: WearHistory, axes: Axes | None = None) -> Axes:
    """Draw sections of the worn depth of both bodies together, over the distance.

    Parameters
    ----------
    history
        History of wear.
    axes
        Axes to draw into; a new figure by default.

    Returns
    -------
    matplotlib.axes.Axes
        The axes.

    Examples
    --------
    >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    >>> history = nacre.wear(nacre.Sphere(5e-3), steel, load=10.0, rate=1e-16, sliding=1.0)
    >>> nacre.plot.wear(history).get_ylabel()
    'depth removed [nm]'
    """
    return draw(history._depth_chart(), axes, (0.75, 0.45))


def animate_wear(
    history: WearHistory, path: str | os.PathLike[str], frames_per_second: float = 5.0
) -> Path:
    """Write sections of pressure and worn depth, a picture for each state, as a film.

    Parameters
    ----------
    history
        History of wear.
    path
        File to write, ``.gif``, or ``.mp4`` where ffmpeg is installed.
    frames_per_second
        States in a second, above 0.

    Returns
    -------
    pathlib.Path
        The file.

    Raises
    ------
    ValueError
        If the ending is another, or the number is not above 0.

    Examples
    --------
    >>> import tempfile
    >>> steel = nacre.Elastic(young=210e9, poisson=0.3)
    >>> ball = nacre.Sphere(5e-3)
    >>> history = nacre.wear(ball, steel, load=10.0, rate=1e-16, sliding=1.0, steps=2)
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     nacre.plot.animate_wear(history, f"{folder}/wear.gif").suffix
    '.gif'
    """
    path = Path(path)
    if path.suffix.lower() not in FILMS:
        raise ValueError(f"path must end in .gif or .mp4, got {str(path)!r}")
    if not frames_per_second > 0:
        raise ValueError(f"frames_per_second must be above 0, got {frames_per_second!r}")
    states = history.states
    both = [
        [_section(s, s.solution.pressure), _section(s, s.depth + s.counter_depth)] for s in states
    ]
    along = _scale([x for pair in both for x, _ in pair], "m")
    scales = [_scale([pair[k][1] for pair in both], unit) for k, unit in enumerate(("Pa", "m"))]
    with styled():
        figure, panels = plt.subplots(2, sharex=True)
        ends = along.factor * np.array([x[[0, -1]] for pair in both for x, _ in pair])
        curves = [panel.plot([], [])[0] for panel in panels]
        for panel, k, name in zip(panels, range(2), ("pressure", "depth removed"), strict=True):
            highest = scales[k].factor * max(float(pair[k][1].max()) for pair in both)
            panel.set(xlim=(ends.min(), ends.max()), ylim=(0, 1.05 * highest or 1.0))
            panel.set_ylabel(f"{name} [{scales[k].unit}]")
        panels[1].invert_yaxis()
        axis = "y" if states[0].solution.grid.is_line else "x"
        panels[1].set_xlabel(f"{axis} [{along.unit}]")

        def draw(number: int) -> list[object]:
            for curve, (x, values), scale in zip(curves, both[number], scales, strict=True):
                curve.set_data(along.factor * x, scale.factor * values)
            panels[0].set_title(travelled(states[number].distance, history.unit))
            return list(curves)

        film = FuncAnimation(figure, draw, frames=len(states))  # type: ignore[arg-type]
        kind = PillowWriter if path.suffix.lower() == ".gif" else FFMpegWriter
        try:
            with replacing(path) as temporary:
                film.save(temporary, writer=kind(fps=frames_per_second))  # type: ignore[arg-type]
        finally:
            plt.close(figure)
    return path
