"""Solved indentations: what was pressed into what, and the contacts as numbers."""

from __future__ import annotations

import math
import os
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, Self, get_args

import numpy as np
import numpy.typing as npt

import nacre._core as core
from nacre._core import plain
from nacre._display import aligned, table
from nacre.indent._system import System
from nacre.units import INDENT_UNITS, printable, written
from nacre.values import FORMAT, checked_state, decode, encode, refusing

if TYPE_CHECKING:
    import xarray

Given = Literal["load", "approach", "radius"]
Control = Literal["load", "approach"]

NUMBERS = ("load", "approach", "radius", "stiffness", "outer_radius", "central_pressure")
"""Numbers of each contact."""
COLUMNS = ("load", "approach", "radius", "stiffness", "central_pressure")
"""Numbers of each contact that are printed."""
PULLED = ("pull_off_load", "pull_off_approach", "pull_off_radius")
"""Numbers of the pull-off."""
ARGUMENTS = ("body", "tip", "counterbody", "adhesion")
ROWS = 30
"""Largest number of contacts that are printed."""


@dataclass(frozen=True, eq=False, repr=False)
class IndentSolution:
    """Contacts of an indentation, with all that they depend on; see `nacre.indent.solve`.

    Numbers have the shape of the load, approach or radius that was given: each is a float or an
    array.
    """

    body: core.HalfSpace
    """Body that is indented."""
    tip: core.Tip
    """Form of the tip."""
    counterbody: core.HalfSpace | None
    """Material of the tip; None where it is rigid."""
    adhesion: core.Adhesion | None
    """Adhesion of the surfaces."""
    given: Given
    """Which of load, approach and radius was given."""
    branch: str
    """Branch of the contacts, "stable" or "unstable"."""
    control: Control
    """What is held while the tip is pulled off."""
    load: Any
    """Load [N], below 0 where the tip is pulled."""
    approach: Any
    """Approach [m]."""
    radius: Any
    """Contact radius [m]."""
    stiffness: Any
    """Stiffness of this contact area [N/m]."""
    outer_radius: Any
    """Radius up to which the surfaces attract each other [m]."""
    central_pressure: Any
    """Pressure on the axis [Pa], infinite below a sharp tip."""
    warnings: tuple[str, ...] = ()
    """What makes the contacts doubtful, in sentences; each was also issued as a `NacreWarning`."""

    @cached_property
    def indentation(self) -> core.Indentation:
        """Indentation that was solved, planned again."""
        return core.Indentation(self.body, self.tip, self.counterbody, adhesion=self.adhesion)

    @cached_property
    def state(self) -> core.IndentState:
        """Contacts with pressures, surfaces, stresses, derivatives; solved again if need be."""
        given = {self.given: getattr(self, self.given)}
        return self.indentation.at(**given, branch=self.branch)

    @cached_property
    def _pulled(self) -> dict[str, float]:
        if self.adhesion is None:
            return dict.fromkeys(PULLED, math.nan)
        last = self.indentation.pull_off(self.control)
        return {name: getattr(last, name.removeprefix("pull_off_")) for name in PULLED}

    @property
    def pull_off_load(self) -> float:
        """Load of the last stable contact as the tip is pulled off [N]; NaN without adhesion."""
        return self._pulled["pull_off_load"]

    @property
    def pull_off_approach(self) -> float:
        """Approach of that contact [m]."""
        return self._pulled["pull_off_approach"]

    @property
    def pull_off_radius(self) -> float:
        """Radius of that contact [m]."""
        return self._pulled["pull_off_radius"]

    def to_dict(self) -> dict[str, Any]:
        """Return the whole state as plain data with names, for JSON."""
        state = {"format": FORMAT, "nacre": core.__version__, "kind": "IndentSolution"}
        state |= {name: encode(getattr(self, name)) for name in ARGUMENTS}
        state |= {name: getattr(self, name) for name in ("given", "branch", "control")}
        state |= {name: np.asarray(getattr(self, name)).tolist() for name in NUMBERS}
        return state | {"pull_off": self._pulled, "warnings": list(self.warnings)}

    @classmethod
    def from_dict(cls, data: Mapping[str, Any]) -> Self:
        """Return the solution of what `to_dict` returned.

        Raises
        ------
        ValueError
            If a key is missing or unknown, a value does not fit, or a newer version wrote the data.
        """
        names = {*ARGUMENTS, "given", "branch", "control", *NUMBERS, "pull_off", "warnings"}
        state = checked_state({"warnings": [], **data}, "IndentSolution", names)
        with refusing("IndentSolution"):
            for name in ARGUMENTS:
                state[name] = decode(state[name])
            for name in NUMBERS:
                values = np.array(state[name], dtype=np.float64)
                state[name] = values if values.ndim else float(values)
            state["warnings"] = tuple(state["warnings"])
            pulled = state.pop("pull_off")
            made = cls(**state)
            made.__dict__["_pulled"] = {name: float(pulled[name]) for name in PULLED}
            if not (
                System.holds(made.body, made.tip, made.counterbody, made.adhesion)
                and len({np.shape(getattr(made, name)) for name in NUMBERS}) == 1
                and made.given in get_args(Given)
                and made.branch in ("stable", "unstable")
                and made.control in get_args(Control)
                and all(isinstance(text, str) for text in made.warnings)
            ):
                raise TypeError("its parts do not fit together")
        return made

    def __reduce__(self) -> tuple[Any, ...]:
        """Return what pickles are made of."""
        return type(self).from_dict, (self.to_dict(),)

    def to_xarray(self) -> xarray.Dataset:
        """Return the contacts with units and all that they depend on.

        Needs ``nacre-contact[files]``.
        """
        from nacre.indent._files import indentation

        return indentation(self)

    def save(self, path: str | os.PathLike[str]) -> Path:
        """Write a file, whole or not at all.

        Parameters
        ----------
        path : str or os.PathLike
            File to write: ``.nc`` for NetCDF, which `nacre.load` reads and which needs
            ``nacre-contact[files]``, or ``.csv`` for a table.

        Returns
        -------
        pathlib.Path
            The file.

        Raises
        ------
        ValueError
            If the file has another ending.
        """
        from nacre.indent._files import contact_rows, save

        return save(self, contact_rows(self), path)

    def __eq__(self, other: object) -> bool:
        """Return whether all is equal, to the bit."""
        if not isinstance(other, IndentSolution):
            return NotImplemented
        # Texts tell NaN from other numbers, and equal NaN.
        return str(self.to_dict()) == str(other.to_dict())

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        """Return a line with the numbers of the contact, or their ranges."""
        count = np.size(self.load)
        said = ", ".join(f"{name} {self._range(name)}" for name in NUMBERS[:3])
        return f"<IndentSolution: {count} contact{'s' if count != 1 else ''}, {said}>"

    def __str__(self) -> str:
        """Return the table."""
        head, rows, notes = self._table()
        return printable("\n".join([*aligned([head, *rows]), *notes]))

    def _repr_html_(self) -> str:
        return table(*self._table())

    def _range(self, name: str) -> str:
        values = np.ravel(getattr(self, name))
        ends = dict.fromkeys(said(float(f(values)), name) for f in (np.min, np.max))
        return " to ".join(ends)

    def _table(self) -> tuple[list[str], list[list[str]], list[str]]:
        columns = [np.ravel(getattr(self, name)).tolist() for name in COLUMNS]
        rows = [
            [said(value, name) for value, name in zip(row, COLUMNS, strict=True)]
            for row in list(zip(*columns, strict=True))[:ROWS]
        ]
        notes = []
        if (more := np.size(self.load) - ROWS) > 0:
            notes.append(f"and {more} more contacts")
        if self.adhesion is not None:
            pulled = (f"{n.rpartition('_')[2]} {said(v, n)}" for n, v in self._pulled.items())
            notes.append(f"pull-off: {', '.join(pulled)}")
        notes += [f"warning: {warning}" for warning in self.warnings]
        return [name.replace("_", " ") for name in COLUMNS], rows, notes


def said(value: float, name: str) -> str:
    """Return a number of an indentation with its unit."""
    return written(value, INDENT_UNITS[name], 4) if math.isfinite(value) else str(value)


def solve(
    body: core.HalfSpace | core.Elastic,
    tip: core.Tip,
    counterbody: core.HalfSpace | core.Elastic | None = None,
    *,
    adhesion: core.Adhesion | None = None,
    load: npt.ArrayLike | None = None,
    approach: npt.ArrayLike | None = None,
    radius: npt.ArrayLike | None = None,
    branch: Literal["stable", "unstable"] = "stable",
    control: Control = "load",
) -> IndentSolution:
    """Solve an indentation to a result that can be saved, and that studies take outputs from.

    Parameters
    ----------
    body : HalfSpace or Elastic
        Body that is indented.
    tip : Tip
        Form of the tip.
    counterbody : HalfSpace or Elastic, optional
        Material of the tip; rigid by default.
    adhesion : Adhesion, optional
        Adhesion of the surfaces; none by default.
    load, approach, radius : float or array_like
        Loads [N], approaches [m] or contact radii [m] of any shape; exactly one of them.
    branch : {"stable", "unstable"}
        Branch of the curve where adhesion gives two contacts the same load or approach.
    control : {"load", "approach"}
        What is held while the tip is pulled off.

    Returns
    -------
    IndentSolution
        Contacts in the shape of what was given.

    Raises
    ------
    ValueError
        If `Indentation` or `Indentation.at` cannot take an argument.

    Warns
    -----
    NacreWarning
        If the slope of the tip within a contact is above 0.5, beyond the theory of small slopes.

    Examples
    --------
    >>> glass, film = nacre.Elastic(70e9, 0.22), nacre.Elastic(3e9, 0.4)
    >>> body = nacre.HalfSpace(glass, [nacre.Layer(film, thickness=1e-6)])
    >>> found = nacre.indent.solve(body, nacre.indent.Tip.sphere(5e-6), load=1e-3)
    >>> found
    <IndentSolution: 1 contact, load 1 mN, approach 115.5 nm, radius 938.1 nm>
    """
    if control not in ("load", "approach"):
        raise ValueError(f"control must be 'load' or 'approach', got {control!r}")
    test = core.Indentation(body, tip, counterbody, adhesion=adhesion)
    asked: dict[str, Any] = {"load": load, "approach": approach, "radius": radius}
    asked = {name: plain(name, value) for name, value in asked.items()}
    state = test.at(**asked, branch=branch)
    # What was given is the value that is not None, as `at` has checked.
    given: Any = next(name for name, value in asked.items() if value is not None)
    numbers = {name: getattr(state, name) for name in NUMBERS[:-1]}
    solution = IndentSolution(
        body=test.body,
        tip=test.tip,
        counterbody=test.counterbody,
        adhesion=test.adhesion,
        given=given,
        branch=branch,
        control=control,
        **numbers,
        central_pressure=state.pressure(0.0),
        warnings=tuple(state.warnings),
    )
    solution.__dict__.update(indentation=test, state=state)
    return solution
