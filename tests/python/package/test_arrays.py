"""Real arrays and lists of any dtype, order and stride are taken; nothing else is."""

import gc
from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

import nacre
from bodies import BALL, STEEL
from support import assert_close

GRID = nacre.Grid(shape=(20, 24), size=(3e-4, 3.3e-4))
CONTACT = nacre.Contact(STEEL, GRID)

# Whole numbers that every type below holds, and no symmetry that would hide a wrong order.
ROWS, COLUMNS = np.indices(GRID.shape)
WHOLE = np.asarray((3 * ROWS + 5 * COLUMNS) % 101 + 1, dtype=np.float64)


def read_only(array: npt.NDArray[Any]) -> npt.NDArray[Any]:
    array.setflags(write=False)
    return array


class Subclass(np.ndarray[Any, Any]):
    """Some other array."""


FORMS: dict[str, Any] = {
    "float32": WHOLE.astype(np.float32),
    "float16": WHOLE.astype(np.float16),
    "longdouble": WHOLE.astype(np.longdouble),
    "int8": WHOLE.astype(np.int8),
    "uint64": WHOLE.astype(np.uint64),
    "big-endian": WHOLE.astype(">f8"),
    "list": WHOLE.tolist(),
    "list of arrays": list(WHOLE),
    "tuple of tuples": tuple(map(tuple, WHOLE.tolist())),
    "Fortran order": np.asfortranarray(WHOLE),
    "strided": np.repeat(np.repeat(WHOLE, 2, axis=0), 3, axis=1)[::2, ::3],
    "reversed": np.ascontiguousarray(WHOLE[::-1, ::-1])[::-1, ::-1],
    "unaligned": np.frombuffer(b"\0" + WHOLE.tobytes(), offset=1).reshape(WHOLE.shape),
    "read-only": read_only(WHOLE.copy()),
    "subclass": WHOLE.view(Subclass),
}

NOT_REAL: dict[str, Any] = {
    "bools": WHOLE > 9,
    "list of bools": [[True, False], [False, True]],
    "complex": WHOLE.astype(complex),
    "complex list": [[1.0, 2j], [3.0, 4.0]],
    "object": WHOLE.astype(object),
    "None inside": [[1.0, None], [3.0, 4.0]],
    "text": WHOLE.astype(str),
    "bytes": WHOLE.astype(bytes),
    "dates": WHOLE.astype("datetime64[s]"),
    "durations": WHOLE.astype("timedelta64[s]"),
    "records": WHOLE.astype([("height", float)]),
    "ragged": [[1.0, 2.0], [3.0]],
    "a word": "heights",
    "nothing": object(),
}

every_form = pytest.mark.parametrize("form", FORMS.values(), ids=FORMS.keys())
everything_else = pytest.mark.parametrize("bad", NOT_REAL.values(), ids=NOT_REAL.keys())


@every_form
def test_every_form_of_real_numbers_is_taken(form: Any) -> None:
    assert nacre.HeightMap(form, spacing=1.0) == nacre.HeightMap(WHOLE, spacing=1.0)
    pressed = [CONTACT.solve(BALL, load=10.0, initial=initial) for initial in (form, WHOLE)]
    np.testing.assert_array_equal(pressed[0].pressure, pressed[1].pressure)
    found = nacre.frequency_response(STEEL, form)
    assert found.shape == WHOLE.shape
    np.testing.assert_array_equal(found, nacre.frequency_response(STEEL, WHOLE))


@pytest.mark.parametrize("turn", [list, tuple, np.float32, np.int64, np.flip, np.asfortranarray])
def test_profiles_are_taken(turn: Callable[[Any], Any]) -> None:
    turned = turn(np.flip([-9.0, 1.0, 9.0]) if turn is np.flip else np.array([-9.0, 1.0, 9.0]))
    assert nacre.SampledProfile(turned, [1, 0, 2]) == nacre.SampledProfile(
        np.array([-9.0, 1.0, 9.0]), np.array([1.0, 0.0, 2.0])
    )


@everything_else
def test_what_is_not_real_is_refused(bad: Any) -> None:
    calls: list[tuple[str, Callable[[], Any]]] = [
        ("heights", lambda: nacre.HeightMap(bad, spacing=1.0)),
        ("initial", lambda: CONTACT.solve(BALL, load=10.0, initial=bad)),
        ("wavenumber", lambda: nacre.frequency_response(STEEL, bad)),
        ("x", lambda: nacre.SampledProfile(bad, [1.0, 0.0])),
    ]
    for name, call in calls:
        with pytest.raises(TypeError, match=rf"{name}.*real"):
            call()


@pytest.mark.parametrize("shape", [(), (1,), (5,), (2, 3, 1), (0,)])
def test_a_response_has_the_shape_of_its_wavenumbers(shape: tuple[int, ...]) -> None:
    alpha = np.linspace(1e2, 1e3, int(np.prod(shape))).reshape(shape)
    found = nacre.frequency_response(STEEL, alpha)
    assert np.shape(found) == shape
    assert_close(found, 2 / (STEEL.plane_strain_modulus * alpha), rtol=1e-14)
    assert type(nacre.frequency_response(STEEL, 1e3)) is float


@pytest.mark.parametrize("number", [np.float32, np.float64, np.int64, np.array, int], ids=str)
def test_numbers_of_numpy_are_numbers(number: Callable[[int], Any]) -> None:
    assert nacre.Sphere(number(2)) == nacre.Sphere(2.0)
    assert nacre.solve(BALL, STEEL, load=number(10), grid=GRID).load == pytest.approx(
        10.0, rel=1e-12
    )


def test_nothing_that_was_given_is_changed_or_kept() -> None:
    heights, alpha, initial = WHOLE.copy(), WHOLE.copy(), WHOLE.copy()
    shape = nacre.HeightMap(heights, spacing=1.0)
    nacre.frequency_response(STEEL, alpha)
    CONTACT.solve(BALL, load=10.0, initial=initial)
    for given in (heights, alpha, initial):
        assert given.flags.writeable
        np.testing.assert_array_equal(given, WHOLE)
    heights[...] = 0.0
    np.testing.assert_array_equal(shape.heights, WHOLE)


def returned() -> dict[str, npt.NDArray[Any]]:
    solution = CONTACT.solve(BALL, load=10.0)
    names = ["pressure", "gap", "displacement", "in_contact", "x", "y", "line_load"]
    arrays = {name: getattr(solution, name) for name in names}
    heights = nacre.HeightMap(WHOLE, spacing=1.0).heights
    return arrays | {"Grid.x": GRID.x, "Grid.y": GRID.y, "heights": heights}


@pytest.mark.parametrize("name", returned())
def test_arrays_of_a_value_cannot_be_written(name: str) -> None:
    array = returned()[name]
    assert not array.flags.writeable
    with pytest.raises(ValueError, match="read-only"):
        array[...] = 0


def test_fields_have_the_shape_of_the_grid_and_outlive_their_solution() -> None:
    arrays = returned()
    for name in ("pressure", "gap", "displacement", "in_contact"):
        assert arrays[name].shape == GRID.shape
        assert arrays[name].flags.c_contiguous
        assert arrays[name].dtype == (bool if name == "in_contact" else np.float64)
    assert arrays["x"].shape == arrays["line_load"].shape == (20,)
    assert arrays["y"].shape == (24,)
    solution = CONTACT.solve(BALL, load=10.0)
    for name in ("pressure", "gap", "displacement"):
        assert np.shares_memory(getattr(solution, name), getattr(solution, name))
    pressure, peak = solution.pressure, solution.peak_pressure
    del solution
    gc.collect()
    assert pressure.max() == peak


def test_the_first_index_is_x() -> None:
    solution = CONTACT.solve(nacre.Sphere(20e-3).shifted(4e-5, -5e-5), load=10.0)
    i, j = np.unravel_index(np.argmax(solution.pressure), GRID.shape)
    assert solution.peak_position == (solution.x[i], solution.y[j])
    dx, dy = GRID.spacing
    assert abs(solution.x[i] - 4e-5) <= dx
    assert abs(solution.y[j] + 5e-5) <= dy
    assert_close(solution.line_load, solution.pressure.sum(axis=1) * dy, rtol=1e-12)


def test_returned_coefficients_belong_to_the_caller() -> None:
    first = nacre.influence_coefficients(STEEL, GRID)
    assert first.shape == GRID.shape
    kept = first.copy()
    first *= 0.0
    np.testing.assert_array_equal(nacre.influence_coefficients(STEEL, GRID), kept)
