"""Normal contact: pressure, gap, area and motion of a solution, with friction or without."""

from __future__ import annotations

from functools import cached_property
from typing import TypedDict

import numpy as np
import numpy.typing as npt

import nacre._core as core
from nacre._tools.typing import Field, Pair
from nacre.contact.stresses import Stressed


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

    @cached_property
    def pressure(self) -> Field:
        """Pressure [Pa], at least 0."""
        return self._normal._solved.field("pressure")

    @cached_property
    def gap(self) -> Field:
        """Gap [m]: 0 in contact, within the tolerance, and +inf where the shape cannot touch."""
        return self._normal._solved.field("gap")

    @cached_property
    def hardness(self) -> float | Field | None:
        """Largest pressure that the surfaces can carry [Pa], of all cells or of each.

        `None` where they do not yield.
        """
        return self._normal._solved.field("hardness")

    @cached_property
    def indentation(self) -> Field:
        """Permanent indentation of the surfaces [m], at least 0; the gap contains it.

        It includes that of the solutions before.
        """
        field = self._normal._solved.field("indentation")
        if field is None:
            field = np.zeros(self.grid.shape)
            field.setflags(write=False)
        return field

    @cached_property
    def compliance(self) -> float | Field | None:
        """Compliance of springs between the surfaces [m/Pa], of all cells or of each.

        `None` where there are none. The gap contains what they give, the displacement does not.
        """
        return self._normal._solved.field("compliance")

    @property
    def plastic_work(self) -> float:
        """Energy that the permanent indentation has taken [J], ``sum H w dA``.

        It is 0 without hardness.
        """
        return self._numbers["plastic_work"]

    @cached_property
    def in_contact(self) -> npt.NDArray[np.bool_]:
        """Whether each cell is in contact: its pressure is above 0."""
        return self._normal._solved.field("in_contact")

    @property
    def x(self) -> Field:
        """Cell centres along x, ``(nx,)`` [m]."""
        return self.grid.x

    @property
    def y(self) -> Field:
        """Cell centres along y, ``(ny,)`` [m]."""
        return self.grid.y

    @property
    def load(self) -> float:
        """Normal force [N]."""
        return self._numbers["load"]

    @property
    def eccentricity(self) -> Pair:
        """Point where the force acts, ``(e_x, e_y)`` [m]; the origin where there is no force.

        It is NaN along an axis on which the grid is periodic, and so is `moment`.
        """
        return self._numbers["eccentricity"]

    @property
    def moment(self) -> Pair:
        """First moments of the pressure about the origin [N m]; NaN along a periodic axis."""
        return self._numbers["moment"]

    @property
    def approach(self) -> float:
        """Approach of the origin [m]."""
        return self._numbers["approach"]

    @property
    def tilt(self) -> Pair:
        """Slopes ``(s_x, s_y)``."""
        return self._numbers["tilt"]

    @property
    def contact_area(self) -> float:
        """Area of the cells in contact [m^2]."""
        return self._numbers["contact_area"]

    @property
    def contact_share(self) -> float:
        """Share of the grid that is in contact; of a periodic surface, that of its area."""
        return int(self.in_contact.sum()) / self.in_contact.size

    @property
    def contact_extent(self) -> tuple[Pair, Pair]:
        """Ends of the contact ``((x0, x1), (y0, y1))`` [m], accurate to a fraction of a cell.

        They are NaN along an axis on which the grid is periodic where the contact goes on from the
        last cell to the first.
        """
        return self._numbers["contact_extent"]

    @property
    def peak_pressure(self) -> float:
        """Largest pressure of a cell [Pa]."""
        return self._numbers["peak_pressure"]

    @property
    def peak_position(self) -> Pair:
        """Centre of the cell of the largest pressure [m].

        Of several, it is that of the deepest indentation.
        """
        return self._numbers["peak_position"]

    @property
    def central_pressure(self) -> float:
        """Pressure at the origin [Pa], by cubic interpolation; 0 off the grid."""
        return self._numbers["central_pressure"]

    @cached_property
    def line_load(self) -> Field:
        """Force per length along x, ``(nx,)`` [N/m]."""
        return self._normal._solved.field("line_load")
