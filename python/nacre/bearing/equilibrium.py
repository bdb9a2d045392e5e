"""Equilibrium of the inner ring and of all elements: Newton's method on a convex energy.

The unknowns are the free displacements q of the ring and, for each element, its own position z. The
positions are eliminated element by element, so that a step solves at most five equations. Derived
here; for rollers the kinematics are those of ISO/TS 16281, equations 38 to 41.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import numpy.typing as npt

from nacre.bearing.cone import AXIAL
from nacre.bearing.contact_laws import LAMINAE, Law, Reaction, slices_of
from nacre.bearing.geometry import RINGS, laminae_of

if TYPE_CHECKING:
    from nacre.bearing.balls import _Balls
    from nacre.bearing.rollers import SphericalRoller, _Rollers

Array = npt.NDArray[np.float64]

FLAT = 1e-11
"""Stiffness that is added to that of a free position, relative to the stiffest element's.

It is some 1e5 roundings: what rests in a flat direction stays, and the steps in all others are
exact to 1e-11 of the stiffest.
"""
FARTHEST, FARTHER = 2.0, 4.0
"""Largest step over the deepest place of a contact, as the energy is not quadratic beyond; and
the factor by which it grows where a step of this length lowers the energy.
"""
HALVINGS = 30
"""Largest number of times that a step is halved: 1e-9 of it is left."""
SETTLING = 30
"""Largest number of steps of the elements at a place of the ring."""
ELEMENTS = 0.1
"""Mismatch of elements that have settled, over the tolerance."""
ROUNDING = 1e-14
"""Approach over the pitch diameter that is rounding: some 50 units in the last place."""
SLACK = 1e-8
"""Rounding of the energy, relative, which contacts of a tolerance of 1e-9 have."""


class Places(NamedTuple):
    """Coordinates of all contacts, and their derivatives by ``(t, z)`` of the element."""

    places: Array
    """Approach and slope ``(Z, 2, 2)``."""
    jacobian: Array
    """Derivatives ``(Z, 2, 2, 4)``."""
    curvature: Array
    """Second derivatives of the approaches ``(Z, 2, 4, 4)``."""


class Elements(ABC):
    """Motion of elements with the ring: coordinates, and forces that contacts can have."""

    motion: Array
    """Derivatives of ``t`` of each element by the displacements of the ring ``(Z, 2, 5)``."""
    lengths: Array
    """Lengths that make coordinates of an element displacements, ``(2,)`` or ``(Z, 2)`` [m]."""
    half: Array | float
    """Half of the lengths of the elements, ``(Z, 1)`` or one for all [m]."""
    arm: float
    """Length that makes moments forces [m]."""
    size: float
    """Pitch diameter [m]."""
    outward: tuple[Array | tuple[float, float], Array | float]
    """Parts of the centrifugal force on the elements' coordinates, and on the ring along z."""

    def ring_motion(self, ring: Array) -> Array:
        """Return ``t`` of all elements ``(Z, 2)`` at displacements of the ring."""
        motion: Array = self.motion @ ring
        return motion

    @abstractmethod
    def generators(self) -> Array:
        """Return forces ``(5, n)`` on the ring, of which those of contacts are sums."""

    @abstractmethod
    def neutral(self, ring_motion: Array, pressed: Array | float) -> Array:
        """Return positions of elements midway, or on the outer ring to which they are pressed."""

    @abstractmethod
    def places(self, ring_motion: Array, own: Array) -> Places:
        """Return the coordinates of all contacts."""

    @abstractmethod
    def angles(self, ring_motion: Array, own: Array) -> Array:
        """Return the contact angles ``(Z, 2)`` [rad]."""


class Rollers(Elements):
    """Rollers between raceways. ``t = (u, ψ)`` of the ring and ``z = (v, w)`` of the roller.

    They are approaches and slopes of both contacts together, and of the outer one.
    """

    def __init__(self, bearing: _Rollers, angles: Array) -> None:
        """Take the motion of the inner ring at each roller."""
        cos, sin = np.cos(angles), np.sin(angles)
        zero = np.zeros_like(angles)
        self.contact_angles = np.array(bearing.contact_angles)
        across, along = math.cos(bearing.nominal_angle), math.sin(bearing.nominal_angle)
        lever = bearing.lever
        self.motion = np.stack(
            [
                np.stack(
                    [across * cos, across * sin, zero + along, lever * sin, -lever * cos], axis=-1
                ),
                np.stack([zero, zero, zero, -sin, cos], axis=-1),
            ],
            axis=1,
        )
        self.play, self.count, self.size = across * bearing.play, len(angles), bearing.pitch
        self.lengths = np.array([1.0, bearing.length / math.sqrt(12)])
        """A slope times this length moves a lamina as far, in the mean of squares."""
        self.arm, self.outward = bearing.length, bearing.outward
        self.half = bearing.length / 2
        drops = np.stack([bearing.drop(ring, LAMINAE) for ring in RINGS])
        carrying = laminae_of(bearing.length, LAMINAE)[np.isfinite(drops).all(axis=0)]
        self.ends = float(carrying[0]), float(carrying[-1])
        """Outermost laminae that can carry, of either contact."""
        self.jacobian = np.zeros((self.count, 2, 2, 4))
        self.jacobian[:, 0, 0] = [1, 0, -1, 0]
        self.jacobian[:, 0, 1] = [0, 1, 0, -1]
        self.jacobian[:, 1, 0] = [0, 0, 1, 0]
        self.jacobian[:, 1, 1] = [0, 0, 0, 1]
        self.curvature = np.zeros((self.count, 2, 4, 4))

    def generators(self) -> Array:
        """Return the forces ``(5, 2 Z)`` on the ring of unit forces at the ends of all rollers."""
        approach, slope = self.motion[:, 0], self.motion[:, 1]
        return np.concatenate([approach + end * slope for end in self.ends]).T

    def neutral(self, ring_motion: Array, pressed: Array | float) -> Array:
        """Return positions of elements midway, or on the outer ring to which they are pressed."""
        middle: Array = ring_motion / 2
        if np.any(pressed):
            middle[:, 0] = np.maximum(middle[:, 0], self.play / 4 + pressed)
        return middle

    def places(self, ring_motion: Array, own: Array) -> Places:
        """Return the coordinates of all contacts."""
        coordinates = np.stack([ring_motion - own, own], axis=1)
        coordinates[..., 0] -= self.play / 4
        return Places(coordinates, self.jacobian, self.curvature)

    def angles(self, ring_motion: Array, own: Array) -> Array:
        """Return the contact angles ``(Z, 2)`` [rad]."""
        return np.tile(self.contact_angles, (self.count, 1))


class Balls(Elements):
    """Balls in grooves. ``t`` is the shift of the inner groove's centre, z the ball's position.

    Both are (radial, axial), and z counts from the centre of the outer groove.
    """

    def __init__(self, bearing: _Balls, angles: Array) -> None:
        cos, sin = np.cos(angles), np.sin(angles)
        zero = np.zeros_like(angles)
        groove = [(f - 0.5) * bearing.diameter for f in bearing.osculation]
        free = bearing.free_angle
        self.arm = bearing.pitch / 2 + groove[0] * math.cos(free)
        self.motion = np.stack(
            [
                np.stack([cos, sin, zero, zero, zero], axis=-1),
                np.stack([zero, zero, zero + 1, self.arm * sin, -self.arm * cos], axis=-1),
            ],
            axis=1,
        )
        between, self.size, self.outward = bearing.between, bearing.pitch, bearing.outward
        if bearing.nominal_angle:
            start = (between * math.cos(free), between * math.sin(free))
        else:
            start = (between - bearing.play / 2, 0.0)
        self.start, self.groove = np.array(start), np.array(groove)
        self.lengths, self.half = np.array([1.0, 1.0]), 0.0
        self.both_ways = bearing.nominal_angle == 0

    def generators(self) -> Array:
        """Return the forces on the ring of unit forces across the axis and along it ``(5, n)``.

        Contact angles follow the load, so that a force of a ball may be of any angle between both.
        """
        along = self.motion[:, 1]
        ways = [self.motion[:, 0], along, -along] if self.both_ways else [self.motion[:, 0], along]
        return np.concatenate(ways).T

    def neutral(self, ring_motion: Array, pressed: Array | float) -> Array:
        """Return positions of balls midway, or on the outer ring to which they are pressed."""
        away = self.start + ring_motion
        distance = np.linalg.norm(away, axis=1, keepdims=True)
        share = self.groove[1] / self.groove.sum()
        middle: Array = away * share
        if np.any(pressed):
            outward = np.maximum(share * distance, self.groove[1] + pressed) / distance
            middle = away * outward
        return middle

    def places(self, ring_motion: Array, own: Array) -> Places:
        """Return the coordinates of all contacts."""
        arms = np.stack([self.start + ring_motion - own, own], axis=1)
        distance = np.linalg.norm(arms, axis=2)
        unit = arms / distance[..., None]
        places = np.zeros((len(own), 2, 2))
        places[..., 0] = distance - self.groove
        jacobian = np.zeros((len(own), 2, 2, 4))
        jacobian[:, 0, 0, :2], jacobian[:, 0, 0, 2:] = unit[:, 0], -unit[:, 0]
        jacobian[:, 1, 0, 2:] = unit[:, 1]
        bend = (np.eye(2) - unit[..., None] * unit[..., None, :]) / distance[..., None, None]
        curvature = np.zeros((len(own), 2, 4, 4))
        signs = np.array([[1, -1], [-1, 1]])
        curvature[:, 0] = np.einsum("ab,zij->zaibj", signs, bend[:, 0]).reshape(-1, 4, 4)
        curvature[:, 1, 2:, 2:] = bend[:, 1]
        return Places(places, jacobian, curvature)

    def angles(self, ring_motion: Array, own: Array) -> Array:
        """Return the contact angles ``(Z, 2)`` [rad]."""
        arms = np.stack([self.start + ring_motion - own, own], axis=1)
        return np.arctan2(arms[..., 1], arms[..., 0])


class Barrels(Balls):
    """Barrels in a groove of the inner ring, and in a sphere about the bearing's centre.

    Both raceways are circles in the plane of the axis. A barrel between them turns freely until it
    touches both in its middle, so that its forces are those of a ball: along the lines to the
    centres of both circles. In the axes of the inner ring a tilt moves nothing, for the outer
    circle is a sphere. Ribs hold the barrels along their axes at speed.
    """

    def __init__(self, bearing: SphericalRoller, angles: Array) -> None:
        """Take the centres of both circles, and on which side of the middle a row is."""
        cos, sin = np.cos(angles), np.sin(angles)
        zero = np.zeros_like(angles)
        self.motion = np.stack(
            [
                np.stack([cos, sin, zero, zero, zero], axis=-1),
                np.stack([zero, zero, zero + 1, zero, zero], axis=-1),
            ],
            axis=1,
        )
        side = np.repeat([1.0, -1.0][: bearing.rows], bearing.count)
        sides = np.stack([np.ones_like(side), side], axis=-1)
        normal = np.array([math.cos(bearing.nominal_angle), math.sin(bearing.nominal_angle)])
        self.groove = np.array(bearing.grooves) - bearing.diameter / 2
        self.start = (self.groove.sum() - bearing.play * normal[0] / 2) * normal * sides
        self.size, self.arm = bearing.pitch, bearing.pitch / 2
        own, along = bearing.outward
        self.outward = np.array(own) * sides, along
        self.lengths, self.half = np.array([1.0, 1.0]), 0.0
        self.normals = normal * sides

    def generators(self) -> Array:
        """Return the forces on the ring of unit forces along the contacts' normals ``(5, n)``."""
        forces: Array = np.einsum("zak,za->kz", self.motion, self.normals)
        return forces


class Shaft(Elements):
    """Elements of several bearings, whose inner rings move with one shaft.

    Each ring has a displacement along its own z of its own, which the shaft's adds to.
    """

    def __init__(self, groups: Sequence[Elements], ways: Sequence[Array], set_to: Array) -> None:
        """Take how each ring moves with the shaft ``(5, 5)``, and where it is without that [m]."""
        self.parts, self.ways, self.set_to = groups, ways, set_to
        counts = [len(group.motion) for group in groups]
        self.slices = slices_of(counts)
        motions = [group.motion @ way for group, way in zip(groups, ways, strict=True)]
        offsets = [group.motion[:, :, 2] * z for group, z in zip(groups, set_to, strict=True)]
        self.motion, self.offsets = np.concatenate(motions), np.concatenate(offsets)
        self.lengths = self._element_rows([group.lengths for group in groups], 2)
        self.half = self._element_rows([group.half for group in groups], 1)
        self.arm = max(group.arm for group in groups)
        self.size = max(group.size for group in groups)
        along = [group.outward[1] * way[2, 2] for group, way in zip(groups, ways, strict=True)]
        own = self._element_rows([group.outward[0] for group in groups], 2)
        self.outward = own, self._element_rows(along, 1)

    def _element_rows(
        self, numbers: Sequence[Array | float | tuple[float, ...]], width: int
    ) -> Array:
        """Return numbers of all parts for each element ``(Z, width)``."""
        rows = [np.zeros((len(group.motion), width)) for group in self.parts]
        return np.concatenate(
            [row + np.asarray(number) for row, number in zip(rows, numbers, strict=True)]
        )

    def ring_motion(self, ring: Array) -> Array:
        """Return ``t`` of all elements ``(Z, 2)`` at displacements of the shaft."""
        motion: Array = super().ring_motion(ring) + self.offsets
        return motion

    def generators(self) -> Array:
        """Return forces ``(5, n)`` on the shaft, of which those of contacts are sums."""
        forces = [
            way.T @ group.generators() for group, way in zip(self.parts, self.ways, strict=True)
        ]
        return np.concatenate(forces, axis=1)

    def neutral(self, ring_motion: Array, pressed: Array | float) -> Array:
        """Return positions of elements midway, or on the outer rings to which they are pressed."""
        approaches = np.zeros(len(ring_motion)) + pressed
        middles = [
            group.neutral(ring_motion[rows], float(approaches[rows.start]))
            for group, rows in zip(self.parts, self.slices, strict=True)
        ]
        return np.concatenate(middles)

    def places(self, ring_motion: Array, own: Array) -> Places:
        """Return the coordinates of all contacts."""
        pairs = zip(self.parts, self.slices, strict=True)
        places = [group.places(ring_motion[rows], own[rows]) for group, rows in pairs]
        return Places(*map(np.concatenate, zip(*places, strict=True)))

    def angles(self, ring_motion: Array, own: Array) -> Array:
        """Return the contact angles ``(Z, 2)`` [rad]."""
        pairs = zip(self.parts, self.slices, strict=True)
        angles = [group.angles(ring_motion[rows], own[rows]) for group, rows in pairs]
        return np.concatenate(angles)


@dataclass
class State:
    """Displacements, positions and reactions, with the gradient of the energy and its tangent."""

    ring: Array
    own: Array
    places: Array
    reaction: Reaction
    energy: float
    wanting: Array
    """Forces and moments that the ring wants from outside, less those that it has ``(5,)``."""
    slack: Array
    """Gradients of the energy by the positions of the elements ``(Z, 2)``."""
    tangent: Array
    """Stiffness ``(5, 5)`` with the elements in equilibrium."""
    condensed: Array = field(repr=False)
    """Gradient ``(5,)`` with the elements moved into equilibrium."""
    back: tuple[Array, Array] = field(repr=False)
    """Steps of the elements ``(Z, 2)``, and their change by the ring's ``(Z, 2, 5)``."""
    deepest: float
    """Largest deflection of a contact without its drop [m], at an end of a roller that leans."""
    energies: Array
    """Energies of the elements ``(Z,)``, with that of the centrifugal force."""
    balance: float = math.inf
    """Largest mismatch, relative."""
    unsettled: Array = field(default_factory=lambda: np.zeros(0))
    """Mismatches of the elements, relative ``(Z,)``."""


@dataclass
class Problem:
    """What is asked of the ring: loads along free directions, displacements along the others."""

    kinematics: Elements
    law: Law
    loads: Array
    """Forces and moments ``(5,)``, those of directions that are not free 0."""
    free: npt.NDArray[np.bool_]
    centrifugal: Array | float
    """Force on each element [N], ``(Z, 1)`` or one for all."""

    def __post_init__(self) -> None:
        """Divide the centrifugal force between elements and ring."""
        own, ring = self.kinematics.outward
        self.outward = np.array(own)
        along = np.zeros((len(self.kinematics.motion), 1)) + ring
        self.thrust = float((along * self.centrifugal).sum())
        self.costly = getattr(self.law, "costly", False)
        """Whether contacts are solved, so that elements settle no further than the ring has."""

    def state(self, ring: Array, own: Array) -> State:
        """Return what holds at a displacement and positions."""
        kinematics = self.kinematics
        ring_motion = kinematics.ring_motion(ring)
        places = kinematics.places(ring_motion, own)
        reaction = self.law(places.places)
        gradient = np.einsum("zrak,zra->zk", places.jacobian, reaction.force)
        gradient[:, 2:] -= self.centrifugal * self.outward
        hessian = np.einsum(
            "zrak,zrab,zrbl->zkl", places.jacobian, reaction.stiffness, places.jacobian
        )
        hessian += np.einsum("zr,zrkl->zkl", reaction.force[..., 0], places.curvature)
        scale = np.trace(hessian[:, 2:, 2:], axis1=1, axis2=2).max(initial=0.0) or 1.0
        inner = hessian[:, 2:, 2:] + FLAT * scale * kinematics.lengths[..., None] ** 2 * np.eye(2)
        inverse = np.linalg.inv(inner)
        cross = hessian[:, :2, 2:] @ inverse
        tangent = hessian[:, :2, :2] - cross @ hessian[:, 2:, :2]
        pull = gradient[:, :2] - np.einsum("zab,zb->za", cross, gradient[:, 2:])
        motion = kinematics.motion
        wanting = np.einsum("zak,za->k", motion, gradient[:, :2]) - self.loads
        wanting -= self.thrust * AXIAL
        step = -np.einsum("zab,zb->za", inverse, gradient[:, 2:])
        follow = -inverse @ hessian[:, 2:, :2] @ motion
        energies = reaction.energy.sum(1) - (self.centrifugal * own * self.outward).sum(1)
        energy = float(energies.sum() - self.loads @ ring) - self.thrust * float(ring[2])
        state = State(
            ring, own, places.places, reaction, energy, wanting, gradient[:, 2:],
            np.einsum("zak,zab,zbl->kl", motion, tangent, motion),
            np.einsum("zak,za->k", motion, pull) - self.loads - self.thrust * AXIAL,
            (step, follow),
            float(self.depths(places.places).max()),
            energies,
        )  # fmt: skip
        state.balance, state.unsettled = self.mismatches(state)
        return state

    def mismatches(self, state: State) -> tuple[float, Array]:
        """Return mismatches of forces and moments, relative to those that act.

        The first is the largest of the ring and of the elements, the second those of the elements.
        """
        force: float = max(
            float(np.abs(state.reaction.force[..., 0]).sum()) / 2,
            float(np.linalg.norm(self.loads[:3])),
            float(np.abs(self.loads[3:]).max()) / self.kinematics.arm,
        )
        pressed = state.deepest > ROUNDING * self.kinematics.size
        if force == 0.0 or not (pressed or self.loads.any() or np.any(self.centrifugal)):
            return 0.0, np.zeros(len(state.own))
        arm = np.array([1, 1, 1, self.kinematics.arm, self.kinematics.arm])
        ring = np.abs(state.wanting / arm)[self.free]
        own = np.abs(state.slack / self.kinematics.lengths).max(axis=1) / force
        return max(float(ring.max(initial=0.0)) / force, float(own.max(initial=0.0))), own

    def settled_state(self, state: State, mismatch: float) -> State:
        """Return the state with no element above a mismatch, at this place of the ring.

        Each element makes Newton's steps of its own, which are made again at a quarter where its
        energy rises.
        """
        share = np.ones(len(state.own))
        for _ in range(SETTLING):
            moves = state.unsettled > mismatch
            if not moves.any():
                break
            share = np.minimum(share, self.limits(state, state.back[0]))
            step = np.where(moves, share, 0.0)[:, None] * state.back[0]
            trial = self.state(state.ring, state.own + step)
            lower = trial.energies <= state.energies + FLAT * trial.reaction.energy.sum(1)
            share = np.where(lower, 1.0, share / 4)
            if not lower.all():
                trial = self.state(state.ring, np.where(lower[:, None], trial.own, state.own))
            state = trial
        return state

    def start(self, displacement: Array, pressed: Array | float) -> tuple[Array, Array]:
        """Return a first guess: where the energy is least along the direction of the loads."""
        arm = np.array([1, 1, 1, 1 / self.kinematics.arm, 1 / self.kinematics.arm])
        along = np.where(self.free, self.loads * arm**2, 0.0)
        size = float(np.linalg.norm(along / arm))
        ring = displacement.copy()
        if size > 0:
            along = along / size

            def slope(way: float) -> float:
                at = displacement + way * along
                own = self.kinematics.neutral(self.kinematics.ring_motion(at), pressed)
                return float(self.state(at, own).wanting @ along)

            way = 1e-7
            while slope(way) < 0 and way < 1.0:
                way *= 2
            low = 0.0
            for _ in range(20):
                middle = (low + way) / 2
                low, way = (middle, way) if slope(middle) < 0 else (low, middle)
            ring = displacement + way * along
        return ring, self.kinematics.neutral(self.kinematics.ring_motion(ring), pressed)

    def step(self, state: State, reach: float) -> tuple[Array, Array, bool]:
        """Return Newton's step of the ring and of the elements, and whether it was shortened.

        The ring goes no farther than `reach` times the deepest place of a contact.
        """
        free, kinematics = self.free, self.kinematics
        ring = np.zeros(5)
        if free.any():
            arm = np.array([1, 1, 1, kinematics.arm, kinematics.arm])[free]
            tangent = state.tangent[np.ix_(free, free)] / np.outer(arm, arm)
            # Where contacts hardly touch, rounding can make an eigenvalue negative.
            stiffness, ways = np.linalg.eigh((tangent + tangent.T) / 2)
            least = FLAT * stiffness[-1] if stiffness[-1] > 0 else 1.0
            pull = ways.T @ (state.condensed[free] / arm)
            ring[free] = -ways @ (pull / np.maximum(stiffness, least)) / arm
        step, follow = state.back
        own = step + follow @ ring
        ring_motion = kinematics.motion @ ring
        farthest = reach * max(state.deepest, 0.0)
        largest = float((np.abs(ring_motion) * kinematics.lengths).max())
        shorter = largest > farthest > 0
        if shorter:
            share = farthest / largest
            ring, own, ring_motion = ring * share, own * share, ring_motion * share
        beside = (np.abs(ring_motion) * kinematics.lengths).max(axis=1)
        return ring, own * self.limits(state, own, beside)[:, None], shorter

    def limits(self, state: State, step: Array, beside: Array | float = 0.0) -> Array:
        """Return the shares of steps of elements that are not too long for them ``(Z,)``.

        No contact gets deeper by more than twice its gap or the deepest deflection of its element,
        and what the ring moves `beside` it: one that hardly touches has next to no stiffness.
        """
        before = self.depths(state.places)
        moved = self.kinematics.ring_motion(state.ring)
        deeper = self.depths(self.kinematics.places(moved, state.own + step).places) - before
        sizes = np.maximum(np.abs(before), before.max(axis=1, keepdims=True))
        allowed = FARTHEST * sizes + np.reshape(beside, (-1, 1))
        shares = np.divide(allowed, deeper, out=np.ones(deeper.shape), where=deeper > allowed)
        share: Array = shares.min(axis=1)
        return share

    def depths(self, places: Array) -> Array:
        """Return the deepest approaches of contacts ``(Z, 2)`` [m], at an end of a roller."""
        depths: Array = places[..., 0] + np.abs(places[..., 1]) * self.kinematics.half
        return depths

    def idle_midway(self, state: State) -> State:
        """Return the state with elements midway that touch nothing there: they carry rounding."""
        if not np.any(self.centrifugal):
            ring_motion = self.kinematics.ring_motion(state.ring)
            own = self.kinematics.neutral(ring_motion, 0.0)
            places = self.kinematics.places(ring_motion, own).places
            idle = np.asarray((self.depths(places) <= 0).all(axis=1))
            state.reaction.force[idle] = 0.0
            state.own = np.where(idle[:, None], own, state.own)
            state.places = np.where(idle[:, None, None], places, state.places)
        return state

    def solve(
        self,
        ring: Array,
        own: Array,
        tolerance: float,
        max_iterations: int,
        tell: Callable[[int, float], object] | None,
    ) -> tuple[State, int, str]:
        """Return the equilibrium, the number of steps, and how the iteration ended."""

        def settled_state(ring: Array, own: Array, balance: float) -> State:
            mismatch = balance if self.costly else 0.0
            return self.settled_state(self.state(ring, own), max(mismatch, ELEMENTS * tolerance))

        state, reach = settled_state(ring, own, math.inf), FARTHEST
        # Steps must go below the lowest values so far: steps of rounding alone would never end.
        lowest, closest = state.energy, state.balance
        for done in range(max_iterations + 1):
            if tell is not None and tell(done, state.balance) is False:
                return state, done, "stopped"
            if state.balance <= tolerance:
                if getattr(self.law, "is_rough", False):
                    state = self.state(state.ring, state.own)
                return self.idle_midway(state), done, "converged"
            if done == max_iterations:
                break
            ring_step, own_step, shorter = self.step(state, reach)
            share = 1.0
            for _ in range(HALVINGS):
                ring, own = state.ring + share * ring_step, state.own + share * own_step
                trial = settled_state(ring, own, state.balance)
                rounding = SLACK * float(np.abs(trial.reaction.energy).sum())
                if trial.energy < lowest or (
                    trial.energy <= state.energy + rounding and trial.balance < closest
                ):
                    break
                share /= 2
            else:
                return state, done, "no descent"
            if share < 1:
                reach = max(FARTHEST, share * reach)
            elif shorter:
                reach *= FARTHER
            closest = min(trial.balance, closest if trial.energy >= lowest - rounding else math.inf)
            lowest = min(trial.energy, lowest)
            state = trial
        return state, done, "iteration limit"
