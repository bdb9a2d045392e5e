"""Normal contact: pressure, gap, area and motion of a solution, with friction or without."""

from __future__ import annotations

from functools import cached_property
from typing import TypedDict

import numpy as np
import numpy.typing as npt

import nacre._core as core
from nacre._tools.typing import Field, Pair
from nacre.contact.stresses import Stressed
from nacre.results.quantities import AXIS, CELLS, derived


class Numbers(TypedDict):
    """Numbers of a solution, as the compiled module hands them over."""

    load: float
    eccentricity: Pair
    moment: Pair
    approach: float
    tilt: Pair
    contact_area: float
    contact_extent: tuple[Pair, Pair]
    peak_pressure: float
    peak_position: Pair
    central_pressure: float
    plastic_work: float


class NormalContact(Stressed):
    """Fields, numbers and motion of the normal contact. Fields are ``(nx, ny)``, and read-only."""

    @cached_property
    def _numbers(self) -> Numbers:
        return self._normal._solved.numbers()

    @cached_property
    def grid(self) -> core.Grid:
        """Grid."""
        return self._normal._solved.grid()

    @property
    @derived("N", "N/m", label="load")
    def load(self) -> float:
        """Normal force [N]."""
        return self._numbers["load"]

    @property
    @derived("m", dims=AXIS, label="acts at")
    def eccentricity(self) -> Pair:
        """Point where the force acts, ``(e_x, e_y)`` [m]; the origin where there is no force.

        It is NaN along an axis on which the grid is periodic, and so is `moment`.
        """
        return self._numbers["eccentricity"]

    @property
    @derived("N m", "N", AXIS, "moment")
    def moment(self) -> Pair:
        """First moments of the pressure [N m] about the origin; NaN along a periodic axis."""
        return self._numbers["moment"]

    @property
    @derived("m", label="approach")
    def approach(self) -> float:
        """Approach of the origin [m]."""
        return self._numbers["approach"]

    @property
    @derived(dims=AXIS, label="tilt")
    def tilt(self) -> Pair:
        """Slopes ``(s_x, s_y)``."""
        return self._numbers["tilt"]

    @property
    @derived("Pa", label="peak pressure")
    def peak_pressure(self) -> float:
        """Largest pressure of a cell [Pa]."""
        return self._numbers["peak_pressure"]

    @property
    @derived("m", dims=AXIS, label="at")
    def peak_position(self) -> Pair:
        """Centre of that cell [m]: of the largest pressure.

        Of several, it is that of the deepest indentation.
        """
        return self._numbers["peak_position"]

    @property
    @derived("m", dims=("axis", "end"), label="contact")
    def contact_extent(self) -> tuple[Pair, Pair]:
        """Ends of the contact ``((x0, x1), (y0, y1))`` [m], accurate to a fraction of a cell.

        They are NaN along an axis on which the grid is periodic where the contact goes on from the
        last cell to the first.
        """
        return self._numbers["contact_extent"]

    @property
    @derived("m²", "m", label="area")
    def contact_area(self) -> float:
        """Area in contact [m^2]: of the cells."""
        return self._numbers["contact_area"]

    @property
    @derived(label="share")
    def contact_share(self) -> float:
        """Share of the grid in contact; of a periodic surface, that of its area."""
        return int(self.in_contact.sum()) / self.in_contact.size

    @property
    @derived("Pa")
    def central_pressure(self) -> float:
        """Pressure at the origin [Pa], by cubic interpolation; 0 off the grid."""
        return self._numbers["central_pressure"]

    @property
    @derived("J", "J/m")
    def plastic_work(self) -> float:
        """Energy that the permanent indentation has taken [J], ``sum H w dA``.

        It is 0 without hardness.
        """
        return self._numbers["plastic_work"]

    @cached_property
    @derived("Pa", dims=CELLS)
    def pressure(self) -> Field:
        """Pressure [Pa], at least 0."""
        return self._normal._solved.field("pressure")

    @cached_property
    @derived("m", dims=CELLS)
    def gap(self) -> Field:
        """Gap; infinite where the shape cannot touch [m], 0 in contact, within the tolerance."""
        return self._normal._solved.field("gap")

    @cached_property
    @derived("Pa", dims=CELLS, label="hardness")
    def hardness(self) -> float | Field | None:
        """Largest pressure that the surfaces can carry [Pa], of all cells or of each.

        `None` where they do not yield.
        """
        return self._normal._solved.field("hardness")

    @cached_property
    @derived("m", dims=CELLS, label="indentation")
    def indentation(self) -> Field:
        """Permanent indentation [m] of the surfaces, at least 0; the gap contains it.

        It includes that of the solutions before.
        """
        field = self._normal._solved.field("indentation")
        if field is None:
            field = np.zeros(self.grid.shape)
            field.setflags(write=False)
        return field

    @cached_property
    @derived("m/Pa", dims=CELLS, label="springs")
    def compliance(self) -> float | Field | None:
        """Compliance of springs between the surfaces [m/Pa], of all cells or of each.

        `None` where there are none. The gap contains what they give, the displacement does not.
        """
        return self._normal._solved.field("compliance")

    @cached_property
    @derived(dims=CELLS)
    def in_contact(self) -> npt.NDArray[np.bool_]:
        """Whether a cell is in contact: its pressure is above 0."""
        return self._normal._solved.field("in_contact")

    @cached_property
    @derived("N/m", dims=("x",), follows=True)
    def line_load(self) -> Field:
        """Force per length along x, ``(nx,)`` [N/m]."""
        return self._normal._solved.field("line_load")

    @property
    @derived("m", dims=("x",))
    def x(self) -> Field:
        """X of the cell centre, ``(nx,)`` [m]."""
        return self.grid.x

    @property
    @derived("m", dims=("y",))
    def y(self) -> Field:
        """Y of the cell centre, ``(ny,)`` [m]."""
        return self.grid.y
