"""Line contacts on stiff coats, whose own surface moves less than the datum of displacements."""

import math
from typing import Any

import numpy as np
import pytest

import nacre
from support import assert_close

pytestmark = pytest.mark.filterwarnings("ignore::nacre.NacreWarning")  # few cells of stiff coats

LOAD, FRICTION, WIDTH = 1209.0, 0.2, 2.45e-4
BASE = nacre.Elastic(3.78e9, 0.3)
SHAPE = nacre.Cylinder(0.01)
COMPLIANCE = 2 * 2 * (1 - 0.3**2) / 3.78e9  # A of two bases


def coated(ratio: float, thickness: float) -> nacre.HalfSpace:
    """Return a coat of this ratio of moduli."""
    return nacre.HalfSpace(BASE, [nacre.Layer(nacre.Elastic(ratio * 3.78e9, 0.2), thickness)])


def slide(
    body: nacre.HalfSpace,
    counterbody: nacre.HalfSpace | nacre.Elastic | None = None,
    wider: int = 1,
    **keywords: Any,
) -> Any:
    """Slide on 200 cells, or on as many times more as the grid is wider."""
    grid = nacre.Grid.line(200 * wider, wider * WIDTH)
    other = body if counterbody is None else counterbody
    given: dict[str, Any] = {"load": LOAD, "friction": FRICTION, "threads": 1}
    solution: Any = nacre.slide(SHAPE, body, other, grid=grid, **{**given, **keywords})
    return solution


@pytest.mark.parametrize("ratio", [3, 20, 100])
@pytest.mark.parametrize("thickness", [10e-6, 60e-6, 300e-6, 2e-3])
def test_stiff_coats_slide_along_their_force(ratio: float, thickness: float) -> None:
    body = coated(ratio, thickness)
    for counterbody in (body, BASE):
        solution = slide(body, counterbody, force=(None, 104.0))
        assert solution.report.converged
        assert solution.force[1] == pytest.approx(104.0, rel=1e-6)
        assert 0 < solution.stick_share < 1
        energy = solution.tangential_energy
        assert counterbody is BASE or energy is None or energy > 0
        assert (solution.elastic_energy is None) == (energy is None)
        try:
            assert slide(body, counterbody, shift=(0.0, 2e-8)).force[1] > 0
        except ValueError as error:
            assert "shift cannot be prescribed on this grid" in str(error)  # noqa: PT017


@pytest.mark.parametrize("force", [(None, 104.0), (60.0, 80.0)])
def test_shifts_have_the_datum_of_the_bare_substrate(force: tuple[float | None, float]) -> None:
    # With the datum three times as far away, shifts grow by A Q/π ln 3, with A of the substrates
    # alone: 2 (1 - ν²)/E each along y, and 1/G = 2 (1 + ν)/E along x; tractions are the same.
    body = coated(20, 172e-6)
    near, far = (slide(body, wider=wider, force=force, tolerance=1e-10) for wider in (1, 3))
    assert near.shift is not None
    assert far.shift is not None
    inner = far.traction[:, :, 200:400]
    assert_close(near.traction, inner, atol=1e-6 * np.abs(inner).max())
    along = 2 * 2 * 1.3 / 3.78e9
    for axis, compliance in enumerate((along, COMPLIANCE)):
        moved = compliance * (force[axis] or 0.0) / math.pi * math.log(3)
        assert far.shift[axis] - near.shift[axis] == pytest.approx(moved, rel=1e-5, abs=1e-16)


def test_a_shift_is_refused_where_it_would_fall_with_the_force() -> None:
    body = coated(100, 172e-6)
    with pytest.raises(ValueError, match=r"shift cannot be .* give a force, or a width of") as info:
        slide(body, shift=(0.0, 2e-8))
    needed = float(str(info.value).split("width of ")[1].split()[0])
    wide = nacre.Grid.line(800, needed)
    solution = nacre.slide(
        SHAPE, body, body, grid=wide, load=LOAD, friction=FRICTION, shift=(0.0, 2e-8)
    )
    assert solution.force[1] > 0
    # A shift that stays needs a force, too, unless it stays the same.
    pulled = slide(body, force=(None, 104.0))
    with pytest.raises(ValueError, match="shift cannot be"):
        slide(body, initial=pulled, load=0.5 * LOAD)
    again = slide(body, initial=pulled)
    assert_close(again.shift, pulled.shift, rtol=1e-9)
    back = slide(body, initial=pulled, force=(None, 0.0))
    loop = slide(body, steps=[{"force": (None, 104.0)}, {"force": (None, 0.0)}])
    assert back.shift == pytest.approx(loop[-1].shift, rel=1e-6)
    with pytest.raises(ValueError, match="creepage cannot be"):
        nacre.roll(
            SHAPE,
            body,
            body,
            grid=nacre.Grid.line(200, WIDTH),
            load=LOAD,
            friction=FRICTION,
            creepage=(1e-4, None),
            cells=8,
        )


def test_printed_numbers_name_their_datum() -> None:
    for body, surface in ((coated(4, 60e-6), "surface of the bare substrate"), (BASE, "surface")):
        solution = nacre.slide(
            SHAPE,
            body,
            body,
            grid=nacre.Grid.line(200, WIDTH),
            load=LOAD,
            friction=FRICTION,
            force=(None, 104.0),
        )
        for printed, name in ((solution, "shift"), (solution.normal, "approach")):
            row = next(line for line in str(printed).splitlines() if line.startswith(name))
            assert row.endswith(f", from the {surface} 245 µm away")
