from collections.abc import Callable, Sequence
from typing import ClassVar, Final, Literal, Self, TypeAlias, final, overload

import numpy as np
import numpy.typing as npt
from typing_extensions import disjoint_base

__all__ = [
    "RIGID",
    "Contact",
    "ConvergenceError",
    "Cylinder",
    "Elastic",
    "FlatPunch",
    "Grid",
    "HalfSpace",
    "HeightMap",
    "Layer",
    "LogarithmicProfile",
    "NacreWarning",
    "Paraboloid",
    "Report",
    "Rigid",
    "Roller",
    "SampledProfile",
    "Shape",
    "Solution",
    "Sphere",
    "__version__",
    "_restore_report",
    "_restore_solution",
    "frequency_response",
    "graded_layers",
    "influence_coefficients",
    "solve",
]

_Field: TypeAlias = npt.NDArray[np.float64]
_Real: TypeAlias = npt.NDArray[np.floating | np.integer | np.bool]
_Vector: TypeAlias = _Real | Sequence[float]
_Matrix: TypeAlias = _Real | Sequence[Sequence[float] | _Real]
_Pair: TypeAlias = tuple[float, float]
_Freedoms: TypeAlias = tuple[float | None, float | None]
_Interface: TypeAlias = Literal["bonded", "frictionless"]
_Method: TypeAlias = Literal["exact", "plain", "difference", "image"]
_Algorithm: TypeAlias = Literal["cascade", "polonsky-keer"]

__version__: Final[str]
RIGID: Final[Rigid]

class ConvergenceError(RuntimeError):
    solution: Solution

class NacreWarning(UserWarning): ...

@final
class Elastic:
    __hash__: ClassVar[None]  # type: ignore[assignment]
    def __new__(cls, young: float, poisson: float) -> Self: ...
    @property
    def young(self) -> float: ...
    @property
    def poisson(self) -> float: ...
    @property
    def shear(self) -> float: ...
    @property
    def plane_strain_modulus(self) -> float: ...
    def __eq__(self, other: object, /) -> bool: ...
    def __getnewargs__(self) -> tuple[float, float]: ...

@final
class Rigid:
    __hash__: ClassVar[None]  # type: ignore[assignment]
    def __eq__(self, other: object, /) -> bool: ...

@final
class Layer:
    __hash__: ClassVar[None]  # type: ignore[assignment]
    def __new__(
        cls, material: Elastic, thickness: float, interface: _Interface = "bonded"
    ) -> Self: ...
    @property
    def material(self) -> Elastic: ...
    @property
    def thickness(self) -> float: ...
    @property
    def interface(self) -> _Interface: ...
    def __eq__(self, other: object, /) -> bool: ...
    def __getnewargs__(self) -> tuple[Elastic, float, _Interface]: ...

@final
class HalfSpace:
    __hash__: ClassVar[None]  # type: ignore[assignment]
    def __new__(cls, substrate: Elastic | Rigid, layers: Sequence[Layer] | None = None) -> Self: ...
    @property
    def substrate(self) -> Elastic | Rigid: ...
    @property
    def layers(self) -> tuple[Layer, ...]: ...
    @property
    def interfaces(self) -> list[float]: ...
    def __eq__(self, other: object, /) -> bool: ...
    def __getnewargs__(self) -> tuple[Elastic | Rigid, tuple[Layer, ...]]: ...

@final
class Grid:
    __hash__: ClassVar[None]  # type: ignore[assignment]
    def __new__(cls, shape: tuple[int, int], size: _Pair, center: _Pair = ...) -> Self: ...
    @staticmethod
    def line(cells: int, width: float, center: float = 0.0) -> Grid: ...
    @property
    def is_line(self) -> bool: ...
    @property
    def shape(self) -> tuple[int, int]: ...
    @property
    def size(self) -> _Pair: ...
    @property
    def center(self) -> _Pair: ...
    @property
    def spacing(self) -> _Pair: ...
    @property
    def x(self) -> _Field: ...
    @property
    def y(self) -> _Field: ...
    def __eq__(self, other: object, /) -> bool: ...

@disjoint_base
class Shape:
    __hash__: ClassVar[None]  # type: ignore[assignment]
    def gaps(self, grid: Grid) -> _Field: ...
    def shifted(self, x: float, y: float) -> Shape: ...
    def __add__(self, value: Shape, /) -> Shape: ...
    def __radd__(self, value: Shape, /) -> Shape: ...
    def __eq__(self, other: object, /) -> bool: ...

@final
class Sphere(Shape):
    def __new__(cls, radius: float) -> Self: ...

@final
class Paraboloid(Shape):
    def __new__(cls, radius_x: float, radius_y: float) -> Self: ...

@final
class Cylinder(Shape):
    def __new__(cls, radius: float) -> Self: ...

@final
class Roller(Shape):
    def __new__(
        cls,
        radius: float,
        flat_length: float | None = None,
        crown_radius: float | None = None,
        length: float | None = None,
        profile: LogarithmicProfile | SampledProfile | tuple[_Vector, _Vector] | None = None,
    ) -> Self: ...

@final
class LogarithmicProfile:
    __hash__: ClassVar[None]  # type: ignore[assignment]
    def __new__(
        cls, amplitude: float, length: float, flat_length: float = 0.0, end_factor: float = 1.0
    ) -> Self: ...
    @staticmethod
    def lundberg(length: float, load: float, contact_modulus: float) -> LogarithmicProfile: ...
    @staticmethod
    def johns_gohar(
        length: float, load: float, contact_modulus: float, radius: float
    ) -> LogarithmicProfile: ...
    @staticmethod
    def iso16281(diameter: float, length: float) -> LogarithmicProfile: ...
    @property
    def amplitude(self) -> float: ...
    @property
    def length(self) -> float: ...
    @property
    def flat_length(self) -> float: ...
    @property
    def end_factor(self) -> float: ...
    def __eq__(self, other: object, /) -> bool: ...
    def __getnewargs__(self) -> tuple[float, float, float, float]: ...

@final
class SampledProfile:
    __hash__: ClassVar[None]  # type: ignore[assignment]
    def __new__(cls, x: _Vector, drop: _Vector) -> Self: ...
    @property
    def x(self) -> _Field: ...
    @property
    def drop(self) -> _Field: ...
    def __eq__(self, other: object, /) -> bool: ...
    def __getnewargs__(self) -> tuple[_Field, _Field]: ...

@final
class FlatPunch(Shape):
    def __new__(cls, radius: float) -> Self: ...

@final
class HeightMap(Shape):
    def __new__(cls, heights: _Matrix, spacing: float | _Pair, center: _Pair = ...) -> Self: ...
    @property
    def heights(self) -> _Field: ...
    @property
    def spacing(self) -> _Pair: ...
    @property
    def center(self) -> _Pair: ...

@final
class Contact:
    __hash__: ClassVar[None]  # type: ignore[assignment]
    def __new__(
        cls,
        body: HalfSpace | Elastic,
        grid: Grid,
        counterbody: HalfSpace | Elastic | None = None,
        *,
        method: _Method = "exact",
        refinement: int | None = None,
        threads: int | None = None,
    ) -> Self: ...
    @property
    def body(self) -> HalfSpace: ...
    @property
    def counterbody(self) -> HalfSpace | None: ...
    @property
    def grid(self) -> Grid: ...
    @property
    def method(self) -> _Method: ...
    @property
    def threads(self) -> int: ...
    def solve(
        self,
        shape: Shape,
        *,
        load: float | None = None,
        approach: float | None = None,
        eccentricity: _Freedoms | None = None,
        moment: _Freedoms | None = None,
        tilt: _Freedoms | None = None,
        tolerance: float = 1e-8,
        max_iterations: int | None = None,
        algorithm: _Algorithm = "cascade",
        initial: Solution | _Matrix | None = None,
        progress: Callable[[Report], object] | None = None,
        check: bool = True,
    ) -> Solution: ...
    def __eq__(self, other: object, /) -> bool: ...
    def __getnewargs_ex__(
        self,
    ) -> tuple[tuple[HalfSpace, Grid, HalfSpace | None], dict[str, object]]: ...

@final
class Report:
    __hash__: ClassVar[None]  # type: ignore[assignment]
    @property
    def converged(self) -> bool: ...
    @property
    def termination(self) -> Literal["converged", "iteration limit", "stopped"]: ...
    @property
    def iterations(self) -> int: ...
    @property
    def convolutions(self) -> float: ...
    @property
    def residual(self) -> float: ...
    @property
    def overlap(self) -> float: ...
    @property
    def balance(self) -> tuple[float, float, float]: ...
    @property
    def warnings(self) -> list[str]: ...
    @property
    def grid(self) -> Grid: ...
    @property
    def method(self) -> _Method: ...
    @property
    def seconds(self) -> float: ...
    def __eq__(self, other: object, /) -> bool: ...

@final
class Solution:
    __hash__: ClassVar[None]  # type: ignore[assignment]
    @property
    def pressure(self) -> _Field: ...
    @property
    def gap(self) -> _Field: ...
    @property
    def displacement(self) -> _Field: ...
    @property
    def in_contact(self) -> npt.NDArray[np.bool_]: ...
    @property
    def x(self) -> _Field: ...
    @property
    def y(self) -> _Field: ...
    @property
    def load(self) -> float: ...
    @property
    def eccentricity(self) -> _Pair: ...
    @property
    def moment(self) -> _Pair: ...
    @property
    def approach(self) -> float: ...
    @property
    def tilt(self) -> _Pair: ...
    @property
    def contact_area(self) -> float: ...
    @property
    def contact_extent(self) -> tuple[_Pair, _Pair]: ...
    @property
    def peak_pressure(self) -> float: ...
    @property
    def peak_position(self) -> _Pair: ...
    @property
    def central_pressure(self) -> float: ...
    @property
    def line_load(self) -> _Field: ...
    @property
    def report(self) -> Report: ...
    def __eq__(self, other: object, /) -> bool: ...

def _restore_report(state: tuple[object, ...]) -> Report: ...
def _restore_solution(
    fields: tuple[_Field, _Field, _Field], motion: tuple[float, _Pair], report: Report
) -> Solution: ...
@overload
def frequency_response(body: HalfSpace | Elastic, wavenumber: float) -> float: ...
@overload
def frequency_response(body: HalfSpace | Elastic, wavenumber: _Vector | _Matrix) -> _Field: ...
def graded_layers(
    substrate: Elastic | Rigid,
    thickness: float,
    young: float | Callable[[float], float],
    poisson: float | Callable[[float], float],
    tolerance: float = 1e-4,
) -> list[Layer]: ...
def influence_coefficients(
    body: HalfSpace | Elastic,
    grid: Grid,
    method: _Method = "exact",
    refinement: int | None = None,
) -> _Field: ...
def solve(
    shape: Shape,
    body: HalfSpace | Elastic,
    counterbody: HalfSpace | Elastic | None = None,
    *,
    grid: Grid | None = None,
    method: _Method = "exact",
    refinement: int | None = None,
    threads: int | None = None,
    load: float | None = None,
    approach: float | None = None,
    eccentricity: _Freedoms | None = None,
    moment: _Freedoms | None = None,
    tilt: _Freedoms | None = None,
    tolerance: float = 1e-8,
    max_iterations: int | None = None,
    algorithm: _Algorithm = "cascade",
    initial: Solution | _Matrix | None = None,
    progress: Callable[[Report], object] | None = None,
    check: bool = True,
) -> Solution: ...
