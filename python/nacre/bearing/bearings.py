"""What all bearings can do: be solved."""

from __future__ import annotations

from typing import Unpack

from nacre._tools.groups import grouped
from nacre.bearing.arguments import BearingKeywords, BearingOptions, Operation, RingConditions
from nacre.bearing.geometry import Bearing
from nacre.bearing.iso import rating
from nacre.bearing.solution import BearingSolution
from nacre.bearing.solving import solve_bearing


class Solvable(Bearing):
    """A bearing that can be rated and solved."""

    @property
    def standard_capacity(self) -> float:
        """Dynamic load rating of ISO 281 [N], whatever the capacity is."""
        return rating(self)

    @grouped(RingConditions, Operation, BearingOptions)
    def solve(self, **keywords: Unpack[BearingKeywords]) -> BearingSolution:
        """Load, tilt and pressure of every element under a load or displacement of the inner ring.

        Each of the five degrees of freedom of the inner ring is loaded, prescribed, or neither: it
        is then locked at 0.

        Parameters
        ----------
        force : sequence of float or None, optional
            Forces ``(x, y, z)`` on the inner ring [N]; along an axis with a number the displacement
            is found. None stands for None along all axes, here and below.
        displacement : sequence of float or None, optional
            Displacements ``(x, y, z)`` of the inner ring against the outer one [m].
        moment : sequence of float or None, optional
            Moments about x and y on the inner ring [N m]; the tilt about an axis with a number is
            found. They are about the point on the bearing's axis in the plane of the middles of the
            rollers, or of the centres of the inner groove of balls; so are displacements.
        tilt : sequence of float or None, optional
            Slopes of the inner ring about x and y: tangents of its angles.
        rotation : float, optional
            Angle of element 0 from the x axis [rad].
        speed : float, optional
            Angular velocity of the ring that rotates, that of the shaft [rad/s]. The elements
            follow at `cage_speed`, and their centrifugal force presses them on the outer ring;
            gyroscopic moments are not counted.
        rotating : {"inner", "outer"}, optional
            Ring that rotates.
        model : {"solved", "iso16281"}, optional
            Contacts that nacre solves; or those of ISO/TS 16281: 40 laminae of rollers, Hertz's
            ellipses of balls.
        cells : tuple of int, optional
            Cells of a contact along the axis of the element and across it; by default (120, 48) of
            rollers, a multiple of 40 laminae, and (96, 96) of balls. Grids are as long as a roller,
            and those of balls and barrels as the contact needs.
        tolerance : float, optional
            Largest mismatch of forces and moments, relative to those of the elements.
        max_iterations : int, optional
            Newton steps before it gives up.
        threads : int, optional
            Number of contacts that are solved side by side; by default as for `nacre.Contact`.
        progress : callable, optional
            Function that is called with the number of Newton steps and the mismatch after each;
            returning False stops, and gives the unfinished solution.
        check : bool, optional
            Whether to raise an error if the tolerance was not met.
        required_life : float, optional
            Life that is required [h], which the verdict judges; it needs a speed.
        static_safety : float, optional
            Static safety s_0 that is required; by default 1.5 of rollers and 1 of balls, ISO 76.

        Returns
        -------
        BearingSolution
            Loads, tilts and pressures of all elements.

        Raises
        ------
        ValueError
            If an argument is out of range, a degree of freedom is both loaded and prescribed, the
            bearing cannot carry a load along it, or no equilibrium carries the loads together.
        ConvergenceError
            If the tolerance was not met; the unfinished solution is its `solution`.

        Examples
        --------
        >>> from nacre.bearing import CylindricalRoller
        >>> bearing = CylindricalRoller(
        ...     count=14, diameter=10e-3, length=9.6e-3, pitch_diameter=65e-3, clearance=41e-6
        ... )
        >>> standard = bearing.solve(force=(4450.0, 0.0, None), model="iso16281")
        >>> round(float(standard.loads.max()))
        1929
        """
        ring, operation = RingConditions.of(keywords), Operation.of(keywords)
        return solve_bearing(self, ring, operation, BearingOptions.of(keywords))
