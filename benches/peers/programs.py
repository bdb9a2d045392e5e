"""Who solves the problems, each program through its own public interface.

Libraries are imported where they are used: a worker has only what it measures in memory.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from importlib.metadata import version
from typing import Any, ClassVar, Protocol

import numpy as np
import numpy.typing as npt

import nacre
from peers.problems import SIDE, Problem

Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Answer:
    """What a program returned."""

    pressure: Array
    iterations: int | None = None
    work: float | None = None
    """In convolutions of the whole grid, where the program counts them."""
    reported: float | None = None
    """The residual by the program's own account, where it is defined as nacre's."""
    planning: float = 0.0
    """Seconds of the solve that the program says it spent on planning."""
    note: str = ""
    """How it ended, by the program's own account, where not well."""


class Program(Protocol):
    """One that is planned, then solves. `tolerance` is its own."""

    parallel: ClassVar[bool]
    """Whether it runs on more than one thread, as pip installs it."""
    repeats: ClassVar[bool]
    """Whether it solves surfaces that repeat."""

    def __init__(self, problem: Problem, gaps: Array, threads: int) -> None:
        """Import and convert: not timed."""

    def plan(self) -> None:
        """Set up what does not depend on the load."""

    def solve(self, tolerance: float) -> Callable[[], Answer]:
        """Solve for the problem's load; return what reads the answer out, which is not timed."""


class Nacre:
    """nacre, by default."""

    parallel: ClassVar[bool] = True
    repeats: ClassVar[bool] = True

    def __init__(self, problem: Problem, gaps: Array, threads: int) -> None:
        self.problem, self.threads = problem, threads
        self.body, self.grid, self.shape = problem.body, problem.grid, problem.shape(gaps)

    def plan(self) -> None:
        """Coefficients and their transform."""
        given = self.problem.coefficients()
        self.contact = nacre.Contact(self.body, self.grid, coefficients=given, threads=self.threads)

    def solve(self, tolerance: float) -> Callable[[], Answer]:
        """Residual and overlap below the tolerance."""
        solution = self.contact.solve(
            self.shape,
            load=self.problem.load,
            eccentricity=self.problem.eccentricity,
            tolerance=tolerance,
        )
        report = solution.report
        return lambda: Answer(
            solution.pressure, report.iterations, report.convolutions, reported=report.residual
        )


class Aspher:
    """ASPHER, nested grids with its exact convolution by FFT, in double precision."""

    parallel: ClassVar[bool] = True
    repeats: ClassVar[bool] = False

    def __init__(self, problem: Problem, gaps: Array, threads: int) -> None:
        import aspher

        self.module: Any = aspher
        self.problem, self.gaps = problem, gaps.ravel()

    def plan(self) -> None:
        """Nothing: the solve builds its operators, and says how long that took."""

    def solve(self, tolerance: float) -> Callable[[], Answer]:
        """Tolerance of its certificate."""
        result = self.module.solve_nested(
            grid_size=self.problem.cells,
            gap=self.gaps,
            p_nominal=self.problem.load / SIDE**2,
            domain_size=SIDE,
            E_star=1.0,
            tol=tolerance,
            backend="fft",
        )
        return lambda: Answer(
            np.asarray(result.pressure),
            result.iterations,
            planning=result.timings["build"],
            note="" if result.converged else f"ends as '{result.status}'",
        )


class Tamaas:
    """Tamaas, Polonsky and Keer's iteration over its convolutions, periodic or not."""

    parallel: ClassVar[bool] = False
    repeats: ClassVar[bool] = True

    def __init__(self, problem: Problem, gaps: Array, threads: int) -> None:
        import tamaas

        self.module: Any = tamaas
        self.module.set_log_level(self.module.LogLevel.warning)
        self.problem, self.heights = problem, -gaps

    def plan(self) -> None:
        """Model and operator."""
        cells = self.problem.cells
        self.model = self.module.ModelFactory.createModel(
            self.module.model_type.basic_2d, [SIDE, SIDE], [cells, cells]
        )
        self.model.E, self.model.nu = 1.0, 0.0
        if not self.problem.repeats:
            self.module.ModelFactory.registerNonPeriodic(self.model, "dcfft")

    def solve(self, tolerance: float) -> Callable[[], Answer]:
        """Tolerance of its complementarity."""
        self.model.traction[:] = 0.0
        solver = self.module.PolonskyKeerRey(self.model, self.heights, tolerance)
        if not self.problem.repeats:
            solver.setIntegralOperator("dcfft")
        solver.max_iter = 20000
        solver.solve(self.problem.load / SIDE**2)
        return lambda: Answer(np.array(self.model.traction))


class ContactMechanics:
    """ContactMechanics, Polonsky and Keer's iteration over its half-spaces, free or periodic."""

    parallel: ClassVar[bool] = False
    repeats: ClassVar[bool] = True

    def __init__(self, problem: Problem, gaps: Array, threads: int) -> None:
        import ContactMechanics as module
        from SurfaceTopography import Topography

        self.module: Any = module
        self.problem = problem
        sizes = (SIDE, SIDE)
        self.topography = Topography(-gaps, physical_sizes=sizes, periodic=problem.repeats)

    def plan(self) -> None:
        """Substrate and system."""
        cells = self.problem.cells
        kind = "PeriodicFFTElasticHalfSpace" if self.problem.repeats else "FreeFFTElasticHalfSpace"
        substrate = getattr(self.module, kind)((cells, cells), 1.0, (SIDE, SIDE))
        self.system = self.module.make_system(substrate=substrate, surface=self.topography)

    def solve(self, tolerance: float) -> Callable[[], Answer]:
        """Take the tolerance relative to the load of a cell and to the approach, of their order."""
        load, cells = self.problem.load, self.problem.cells
        result = self.system.minimize_proxy(
            external_force=load,
            pentol=tolerance * load / SIDE,
            forcetol=tolerance * load / cells**2,
            thermotol=tolerance,
            maxiter=20000,
        )
        if not result.success:
            raise RuntimeError(result.message)
        return lambda: Answer(np.asarray(result.jac) / (SIDE / cells) ** 2, result.nit)


PROGRAMS: dict[str, type[Program]] = {
    "nacre": Nacre,
    "ASPHER": Aspher,
    "Tamaas": Tamaas,
    "ContactMechanics": ContactMechanics,
}
PACKAGES = {
    "nacre": "nacre-contact",
    "ASPHER": "aspher",
    "Tamaas": "tamaas",
    "ContactMechanics": "ContactMechanics",
    "SciPy": "scipy",
}


def release(program: str) -> str:
    """Return the version that is installed."""
    return version(PACKAGES[program])
