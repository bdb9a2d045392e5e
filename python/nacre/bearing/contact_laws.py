"""Contacts of elements and rings: energy, force and stiffness over approach and tilt.

A contact of element j has the coordinates ``(δ, s)``: the approach of the middle of the element
to the raceway, and the slope along its axis. Its potential energy is convex in both; the
derivatives of the energy are the force W and its first moment M about the middle, and those of
these the stiffness.
"""

from __future__ import annotations

import copy
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from types import MappingProxyType
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import numpy.typing as npt

import nacre._core as core
from nacre._tools.notices import heard
from nacre._tools.rounding import ceil, floor
from nacre._tools.threads import thread_pool
from nacre.bearing.geometry import RINGS, STEEL, Bearing, laminae_of
from nacre.contact import Contact
from nacre.contact.solution import Solution
from nacre.hertz import contact_modulus

if TYPE_CHECKING:
    from nacre.bearing.kinds import BallBearing, RollerBearing

Array = npt.NDArray[np.float64]

LAMINAE = 40
"""Laminae of a roller: ISO/TS 16281 asks for 30 at least."""
SPRING = 35948.0
"""Spring constant c_L of ISO/TS 16281, of both contacts of a steel roller [N/mm^(10/9)], over
L_we^(8/9)."""
LINE = 10 / 9
"""Exponent of the deflection in the load of a lamina, ISO/TS 16281."""
STANDARD = contact_modulus(STEEL, STEEL)
"""Contact modulus of the steel of the standard [Pa]."""
STEPS = 4
"""Steps of the width of a grid between a width and twice of it."""
TOO_NARROW = 4.0
"""Expected load over that of its grid above which a contact is not tried on it: half as wide as
the contact or less, which takes minutes."""
EQUAL = 1e-15
"""Approaches that differ by no more are equal [m]: by 1e-10 of a deflection of 10 µm, which is some
hundred units in its last place."""
NARROWEST = 3
"""Largest number of times that a grid is halved for lighter contacts."""
HELD = 1e-6
"""Part of its depth by which a contact moves with the stiffness that it had: the stiffness, some
power of a tenth of the depth, changes by less."""
LIGHT = 0.1
"""Part of the heaviest element's load above which an element shows how laminae are to be scaled."""
ALIKE = 0.8
"""The same above which it shows nothing that the heaviest does not."""


class Reaction(NamedTuple):
    """Energy, force and stiffness of the contacts of all elements with both rings."""

    energy: Array
    """Potential energies ``(Z, 2)`` [J]."""
    force: Array
    """Forces and moments ``(Z, 2, 2)`` [N, N m]."""
    stiffness: Array
    """Their derivatives ``(Z, 2, 2, 2)`` with respect to approach and slope."""
    contacts: Mapping[tuple[int, int], Solution] = MappingProxyType({})
    """Contacts that were solved, by element and ring."""


Law = Callable[[Array], Reaction]
"""Reaction of all contacts at their places ``(Z, 2, 2)``."""


class Several:
    """Contacts of several bearings, each of which has its own law and its own elements."""

    def __init__(self, laws: Sequence[Law], counts: Sequence[int]) -> None:
        """Take the laws, and the number of elements of each."""
        self.laws, self.counts = laws, counts
        self.slices = slices_of(counts)
        self.costly = any(isinstance(law, Solved) for law in laws)

    @property
    def guess(self) -> Several:
        """Formulas like the contacts."""
        return Several([law.guess for law in self.laws if isinstance(law, Solved)], self.counts)

    @property
    def is_rough(self) -> bool:
        """Whether the last stiffness was that of formulas."""
        return any(isinstance(law, Solved) and law.is_rough for law in self.laws)

    def __call__(self, places: Array) -> Reaction:
        """Return the reaction of all contacts, those that mirror each other solved once."""
        reactions: list[Reaction] = []
        for law, rows in zip(self.laws, self.slices, strict=True):
            is_mirrored = law is self.laws[0] and bool(reactions)
            is_mirrored = is_mirrored and are_equal(places[rows], places[self.slices[0]])
            reactions.append(reactions[0] if is_mirrored else law(places[rows]))
        contacts = {
            (element + rows.start, ring): contact
            for reaction, rows in zip(reactions, self.slices, strict=True)
            for (element, ring), contact in reaction.contacts.items()
        }
        fields = zip(*(reaction[:3] for reaction in reactions), strict=True)
        energy, force, stiffness = map(np.concatenate, fields)
        return Reaction(energy, force, stiffness, contacts)

    def split(self, reaction: Reaction) -> Iterator[Reaction]:
        """Yield the reaction of each bearing."""
        for rows in self.slices:
            contacts = {
                (element - rows.start, ring): contact
                for (element, ring), contact in reaction.contacts.items()
                if rows.start <= element < rows.stop
            }
            energy, force, stiffness = (field[rows] for field in reaction[:3])
            yield Reaction(energy, force, stiffness, contacts)


def are_equal(places: Array, others: Array) -> bool:
    """Return whether places are equal but for rounding."""
    return places.shape == others.shape and float(np.abs(places - others).max()) <= EQUAL


def slices_of(counts: Sequence[int]) -> list[slice]:
    """Return the rows of the elements of several bearings, one after the other."""
    ends = np.cumsum(counts).tolist()
    return [slice(end - count, end) for count, end in zip(counts, ends, strict=True)]


class Slices:
    """Laminae of a roller after ISO/TS 16281, each contact on its own.

    A lamina carries ``q = c_s δ^(10/9)`` where both contacts together approach by δ, so that one of
    two equal ones has the factor ``2^(10/9)``; and the standard's ``2 P(x)`` is a drop at each.
    """

    def __init__(self, bearing: RollerBearing, *, standard: bool = True) -> None:
        """Take the standard's steel, or the moduli of the substrates for a first guess."""
        self.length, self.diameter = bearing.length, bearing.diameter
        self.x = laminae_of(bearing.length, LAMINAE)
        self.drop = np.stack([bearing.drop(ring, LAMINAE) for ring in RINGS])
        both = SPRING * (bearing.length * 1e3) ** (8 / 9) * 1e3**LINE / LAMINAE
        moduli = (STANDARD, STANDARD) if standard else bearing.modulus
        self.spring = 2**LINE * both * np.array(moduli)[:, None] / STANDARD
        self.power = np.full((1, 1, 1), LINE)

    def matched(self, places: Array, loads: Mapping[tuple[int, int], float]) -> Slices:
        """Return laminae of those exponents and springs that have known loads at their places.

        The logarithms of loads over those of the laminae lie on a line over those of the laminae.
        """
        law, own = copy.copy(self), self(places).force[..., 0]
        law.power, ratio = np.full((1, len(RINGS), 1), LINE), np.ones(own.shape)
        lightest = np.zeros(len(RINGS), dtype=int)
        for ring in range(len(RINGS)):
            known = {own[key]: load / own[key] for key, load in loads.items() if key[1] == ring}
            at = np.log(np.fromiter(known, float))
            line = np.polyfit(at, np.log(list(known.values())), min(len(known), 2) - 1)
            inside = np.log(np.clip(own[:, ring], min(known), max(known)))
            ratio[:, ring] = np.exp(np.polyval(line, inside))
            # Energies of lower powers would not be convex.
            law.power[:, ring] = max(1.0, LINE * (1 + line[:-1].sum()))
            lightest[ring] = own[:, ring].tolist().index(min(known))
        changed = law(places).force[..., 0]
        share = np.divide(ratio * own, changed, out=np.zeros(own.shape), where=changed > 0)
        share = np.where(changed > 0, share, share[lightest, range(len(RINGS))])
        law.spring = self.spring * share[..., None]
        return law

    def deflections(self, places: Array) -> Array:
        """Return the deflections of the laminae ``(Z, 2, laminae)`` [m], at least 0."""
        depths = places[..., :1] + places[..., 1:] * self.x - self.drop
        # The stiffness of rounding beside the load, as δ^(1/9), would count by a hundredth.
        return np.where(depths > EQUAL, depths, 0.0)

    def loads(self, places: Array) -> Array:
        """Return the loads of the laminae ``(Z, 2, laminae)`` [N]."""
        loads: Array = self.spring * self.deflections(places) ** LINE
        return loads

    def largest_loads(self, places: Array) -> Array:
        """Return the largest loads per length of the contacts ``(Z, 2)`` [N/m]."""
        loads: Array = self.loads(places).max(-1) * LAMINAE / self.length
        return loads

    def touching_loads(self) -> Array:
        """Return the loads per length of contacts a millionth of the diameter deep [N/m]."""
        force = self.spring[:, 0] * (1e-6 * self.diameter) ** LINE
        loads: Array = force * (LAMINAE / self.length)
        return loads

    def approach(self, force: float) -> float:
        """Return a guess of the approach of an element that is pressed on the outer ring [m]."""
        return float((force / self.spring[1, 0] / LAMINAE) ** 0.9)

    def __call__(self, places: Array) -> Reaction:
        """Return the reaction of all contacts."""
        deflection, power = self.deflections(places), self.power
        loads = self.spring * deflection**power
        slopes = np.where(deflection > 0, power * self.spring * deflection ** (power - 1), 0.0)
        arms = np.stack([np.ones_like(self.x), self.x])
        return Reaction(
            (self.spring * deflection ** (power + 1)).sum(-1) / (power[..., 0] + 1),
            np.einsum("zrk,ak->zra", loads, arms),
            np.einsum("zrk,ak,bk->zrab", slopes, arms, arms),
        )


class Hertzian:
    """Hertz's ellipses of balls in grooves, of the substrates."""

    def __init__(self, bearing: BallBearing) -> None:
        self.diameter = bearing.diameter
        self.unit = [bearing.ellipse(ring, 1.0) for ring in RINGS]
        self.spring = np.array([ellipse.approach**-1.5 for ellipse in self.unit])

    def largest_loads(self, places: Array) -> Array:
        """Return the loads of the contacts ``(Z, 2)`` [N]."""
        return self(places).force[..., 0]

    def touching_loads(self) -> Array:
        """Return the loads of contacts a millionth of the diameter deep [N]."""
        loads: Array = self.spring * (1e-6 * self.diameter) ** 1.5
        return loads

    def approach(self, force: float) -> float:
        """Return the approach of an element that is pressed on the outer ring [m]."""
        return float((force / self.spring[1]) ** (2 / 3))

    def pressures(self, loads: Array) -> Array:
        """Return the peak pressures under loads ``(Z, 2)`` [Pa]."""
        return np.array([ellipse.peak_pressure for ellipse in self.unit]) * np.cbrt(loads)

    def __call__(self, places: Array) -> Reaction:
        """Return the reaction of all contacts."""
        deflection = np.maximum(places[..., 0], 0.0)
        force, stiffness = np.zeros(places.shape), np.zeros((*places.shape, 2))
        force[..., 0] = self.spring * deflection**1.5
        stiffness[..., 0, 0] = 1.5 * self.spring * deflection**0.5
        return Reaction(0.4 * self.spring * deflection**2.5, force, stiffness)


def binned(bearing: RollerBearing, contact: Solution) -> tuple[Array, Array]:
    """Return loads [N] and largest pressures [Pa] of the laminae of a roller in a contact.

    A cell that lies in two laminae gives each its part of the load, and both its pressure.
    """
    grid = contact.grid
    edges = np.linspace(-0.5, 0.5, grid.shape[0] + 1) * grid.size[0]
    sums = np.concatenate([[0.0], np.cumsum(contact.line_load * grid.spacing[0])])
    bounds = np.linspace(-0.5, 0.5, LAMINAE + 1) * bearing.length
    loads = np.diff(np.interp(bounds, edges, sums))
    pressures, peaks = np.zeros(LAMINAE), contact.pressure.max(1)
    inner = 1e-6 * grid.spacing[0]
    for side in (edges[:-1] + inner, edges[1:] - inner):
        lamina = np.floor((side / bearing.length + 0.5) * LAMINAE).astype(int)
        np.maximum.at(pressures, lamina, peaks)
    return loads, pressures


class Solved:
    """Contacts that nacre solves, with warm starts; one plan for contacts of similar width."""

    costly = True
    """Whether elements settle no further than the ring has, as contacts take long."""

    def __init__(
        self,
        bearing: Bearing,
        lines: Array,
        cells: tuple[int, int],
        tolerance: float,
        threads: int | None,
    ) -> None:
        """Plan for the expected loads ``(Z, 2)``, per length those of rollers."""
        self.bearing, self.tolerance = bearing, tolerance
        self.shapes = [bearing.shape(ring) for ring in RINGS]
        self.reach = bearing.reach
        self.plans: dict[tuple[int, int], Contact] = {}
        self.last: dict[tuple[int, int], tuple[Array, Solution, Array, Array | None]] = {}
        """Place, solution and stiffness of each contact at the last places, and where that is
        exact; None where it is of a formula."""
        self.guess: Slices | Hertzian = bearing.law("solved")
        """Formulas like these contacts."""
        self.is_rough = self.is_begun = False
        """Whether the last stiffness was that of formulas, and the next one is to be."""
        power = bearing.width_power
        # Widths in steps, so that a small change of the loads does not change the cells.
        steps = int(ceil(STEPS * math.log2(float(lines.max())) / power))
        heaviest = 2.0 ** (steps * power / STEPS)
        halved = floor(np.log2(heaviest / np.maximum(lines, 1e-100 * heaviest)) / power)
        self.halved = np.clip(halved, 0, NARROWEST)
        self.heaviest, self.power, self.cells = heaviest, power, cells
        self.workers = threads or core.Convolution([[1.0]], None).threads()

    def _foresee(self, places: Array) -> None:
        """Widen grids of contacts that are expected to be far wider than them."""
        lines = self.bearing.law("solved").largest_loads(places)
        while True:
            allowed = TOO_NARROW * self.heaviest / np.maximum(lines, 1e-100 * self.heaviest)
            most = floor(np.log2(allowed) / self.power)
            if float(most.min()) >= 0:
                break
            self._widen()
        for j, r in np.argwhere(most < self.halved):
            self.last.pop((int(j), int(r)), None)  # it starts from no other grid
        self.halved = np.minimum(self.halved, most)

    def _plan(self, element: int, ring: int) -> Contact:
        """Return the plan for a contact."""
        key = ring, int(self.halved[element, ring])
        if key not in self.plans:
            line = self.heaviest * 2.0 ** (-self.power * key[1])
            grid = self.bearing.grid(RINGS[ring], line, self.cells)
            body, counterbody = self.bearing.bodies(RINGS[ring])
            self.plans[key] = Contact(body, grid, counterbody, threads=1)
        return self.plans[key]

    def match(self, places: Array) -> None:
        """Make the laminae of rollers like the heaviest and a light contact of either ring."""
        self.is_begun = True
        if not isinstance(self.guess, Slices):
            return
        loads = self.guess(places).force[..., 0]
        sums = np.where((loads > 0).all(axis=1), loads.sum(axis=1), 0.0)
        heaviest = int(sums.argmax())
        lighter = np.where(sums > LIGHT * sums[heaviest], sums, np.inf)
        light = int(lighter.argmin())
        if not sums[heaviest] > 0:
            return
        elements = {heaviest, light if sums[light] < ALIKE * sums[heaviest] else heaviest}
        keys = [(element, ring) for element in sorted(elements) for ring in range(len(RINGS))]
        with heard():
            for key in keys:
                solution = self._solution(key, places[key], None)
                self.last[key] = places[key].copy(), solution, np.zeros((2, 2)), None
        self.guess = self.guess.matched(places, {key: self.last[key][1].load for key in keys})

    def _rough(self, places: Array) -> dict[tuple[int, int], Array]:
        """Return the stiffness per load of the formulas, at the first places alone."""
        self.is_rough, self.is_begun = self.is_begun, False
        if not self.is_rough:
            return {}
        reaction = self.guess(places)
        loads = reaction.force[..., 0]
        keys = [(int(j), int(r)) for j, r in np.argwhere(loads > 0)]
        return {key: reaction.stiffness[key] / loads[key] for key in keys}

    def _solve(
        self, key: tuple[int, int], place: Array, rough: Array | None
    ) -> tuple[Solution, Array, Array | None]:
        """Return a contact, its stiffness per place, and where it is exact: nowhere if `rough`.

        Warnings of the contact are for later.
        """
        known = self.last.get(key)
        if known is not None and np.array_equal(place, known[0]):
            solution = known[1]
        else:
            solution = self._solution(key, place, known and known[1])
        if rough is not None:
            return solution, rough * solution.load, None
        exact_at = known and known[3]
        if known is None or exact_at is None or self._apart(place, exact_at) > HELD:
            return solution, solution.stiffness()[:2, :2], place.copy()
        return solution, known[2], exact_at

    def _apart(self, place: Array, other: Array) -> float:
        """Return how far two places are from each other, over the depth."""
        reach = max(self.reach, self.bearing.diameter)
        moved, depth = np.abs(place - other), abs(place[0]) + abs(place[1]) * self.reach
        return float((moved[0] + moved[1] * reach) / depth)

    def _solution(self, key: tuple[int, int], place: Array, initial: Solution | None) -> Solution:
        """Return a contact on a grid that holds it."""
        while True:
            solution = self._plan(*key).solve(
                self.shapes[key[1]],
                approach=float(place[0]),
                tilt=(float(place[1]), None),
                tolerance=self.tolerance,
                initial=initial,
            )
            if self._within(solution):
                return solution
            if self.halved[key] > 0:
                self.halved[key] -= 1
            else:
                self._widen()
            initial = None

    def coarse_contact(self, ring: int, contact: Solution) -> Solution | None:
        """Return a contact on half the cells, under the same load and moment.

        None where half the cells do not carry them, as where a corner bears on the outermost cells.
        """
        body, counterbody = self.bearing.bodies(RINGS[ring])
        cells = contact.grid.shape[0] // 2, contact.grid.shape[1] // 2
        plan = Contact(body, core.Grid(cells, contact.grid.size), counterbody)
        moment = contact.moment[0] if self.bearing.carries_moments else None
        with heard():
            try:
                return plan.solve(
                    self.shapes[ring],
                    load=contact.load,
                    moment=(moment, None),
                    tolerance=self.tolerance,
                )
            except (ValueError, core.ConvergenceError):
                return None

    def _within(self, solution: Solution) -> bool:
        """Return whether a contact ends within its grid, but for the ends of a roller."""
        inside = solution.in_contact
        across = inside[:, 0].any() or inside[:, -1].any()
        whole = solution.grid.size[0] == 2 * self.reach
        along = not whole and (inside[0].any() or inside[-1].any())
        return not (across or along)

    def _widen(self) -> None:
        """Make the widest grids twice as wide; the others keep theirs."""
        self.heaviest *= 2.0**self.power
        self.halved = self.halved + 1
        shifted = {(ring, halved + 1): plan for (ring, halved), plan in self.plans.items()}
        self.plans = shifted

    def __call__(self, places: Array) -> Reaction:
        """Return the reaction of all contacts."""
        count = places.shape[0]
        energy = np.zeros((count, 2))
        force, stiffness = np.zeros((count, 2, 2)), np.zeros((count, 2, 2, 2))
        touching = places[..., 0] + np.abs(places[..., 1]) * self.reach > 0
        tasks = [(int(j), int(r)) for j, r in np.argwhere(touching)]
        self._foresee(places)
        for element, ring in tasks:  # plans are made one at a time
            self._plan(element, ring)
        groups, rough = self._equal(tasks, places), self._rough(places)
        solved: dict[tuple[int, int], tuple[Array, Solution, Array, Array | None]] = {}
        pool = thread_pool(self.workers)
        try:
            with heard():
                futures = [
                    pool.submit(self._solve, group[0], places[group[0]], rough.get(group[0]))
                    for group in groups
                ]
                for group, future in zip(groups, futures, strict=True):
                    solution, tangent, exact_at = future.result()
                    for j, r in group:
                        self.halved[j, r] = self.halved[group[0]]
                        solved[j, r] = places[j, r].copy(), solution, tangent, exact_at
                        energy[j, r] = solution.elastic_energy
                        force[j, r] = solution.load, solution.moment[0]
                        stiffness[j, r] = tangent
        finally:
            pool.shutdown(wait=False, cancel_futures=True)  # Ctrl-C waits for no contact
        if not self.bearing.carries_moments:
            force[..., 1] = 0.0
            stiffness[..., 0, 1] = stiffness[..., 1, 0] = stiffness[..., 1, 1] = 0.0
        self.last = solved
        solutions = {key: solution for key, (_, solution, *_) in solved.items()}
        return Reaction(energy, force, stiffness, solutions)

    def _equal(self, tasks: list[tuple[int, int]], places: Array) -> list[list[tuple[int, int]]]:
        """Return groups of contacts that are equal but for rounding, as those beside a load are."""
        lengths = np.array([1.0, max(self.reach, self.bearing.diameter)])
        steps = np.round(places * lengths / EQUAL).astype(np.int64)
        groups: dict[tuple[int, ...], list[tuple[int, int]]] = {}
        for j, r in tasks:
            groups.setdefault((r, int(self.halved[j, r]), *steps[j, r].tolist()), []).append((j, r))
        return list(groups.values())

    def sizes(self) -> Array:
        """Return the sides of the grids ``(Z, 2, 2)`` [m]."""
        pairs = np.ndindex(self.halved.shape)
        sizes = [self._plan(element, ring).grid.size for element, ring in pairs]
        return np.array(sizes).reshape(-1, 2, 2)
