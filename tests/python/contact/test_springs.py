"""Layers that are joined by springs, and plates with a free base."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import nacre
from bodies import BALL, STEEL, quiet
from nacre.case import Case
from nacre.results import values
from support import DATA, assert_close

COAT = nacre.Elastic(420e9, 0.25)
BOND = nacre.Spring(normal=2e16, tangential=5e15)
GRID = nacre.Grid((48, 40), (1.4e-4, 1.2e-4))
H = 5e-6


def on(interface: Any, substrate: Any = STEEL) -> nacre.HalfSpace:
    """Return a coating of 5 µm on an interface."""
    return nacre.HalfSpace(substrate, [nacre.Layer(COAT, H, interface)])


def solved(body: nacre.HalfSpace, **keywords: Any) -> nacre.Solution:
    """Return the contact with the ball at 1 N."""
    return nacre.solve(BALL, body, grid=GRID, load=1.0, tolerance=1e-12, **keywords)


def test_responses_equal_the_dense_system() -> None:
    """Made by tests/data/make/springs.py with 120 digits."""
    compared = 0
    for case in json.loads((DATA / "springs.json").read_text(encoding="utf-8"))["cases"]:
        layers = []
        for layer in case["layers"]:
            given = layer["interface"]
            interface = nacre.Spring(**given) if isinstance(given, dict) else given
            material = nacre.Elastic(layer["young"], layer["poisson"])
            layers.append(nacre.Layer(material, layer["thickness"], interface))
        base = case["substrate"]
        bases: dict[str | None, Any] = {None: nacre.RIGID, "free": nacre.FREE}
        substrate = nacre.Elastic(**base) if isinstance(base, dict) else bases[base]
        body = nacre.HalfSpace(substrate, layers)
        for row in case["rows"]:
            found = nacre.surface_compliance(body, row["wavenumber"])
            due = [row[name] for name in ("c11", "c12", "c22", "ct")]
            scale = [due[0], np.sqrt(due[0] * due[2]), due[2], due[3]]
            assert np.abs(np.subtract(found, due) / scale).max() < 1e-12
            response = nacre.frequency_response(body, row["wavenumber"])
            assert response == pytest.approx(row["c11"], rel=1e-12)
            compared += 1
    assert compared == 77


def test_stiff_springs_are_a_bond_and_loose_ones_slip() -> None:
    """Springs change the response by α/k times the modulus, 1e-15 at 4e11 Pa and α = 1e6."""
    bonded, stiff = solved(on("bonded")), solved(on(nacre.Spring(1e33, 1e33)))
    assert_close(stiff.pressure, bonded.pressure, rtol=1e-9, atol=1e-9 * 1e9)
    assert stiff.approach == pytest.approx(bonded.approach, rel=1e-11)
    slips, loose = solved(on("frictionless")), solved(on(nacre.Spring(1e33, 0.0)))
    assert loose.approach == pytest.approx(slips.approach, rel=1e-11)
    joined = solved(on(BOND))
    assert joined.approach > 1.01 * bonded.approach
    assert solved(on(nacre.Spring(normal=2e16))).approach < joined.approach


def test_tractions_pass_and_displacements_jump() -> None:
    """The upper side is displaced by traction over stiffness more than the lower one."""
    for substrate in (STEEL, nacre.Elastic(70e9, 0.35)):
        solution = solved(on(BOND, substrate))
        above, below = (
            quiet(solution.stress, H, side=side, displacement=True) for side in ("above", "below")
        )
        peak = abs(above.zz).max()
        for name in ("zz", "xz", "yz"):
            difference = getattr(above, name) - getattr(below, name)
            assert abs(difference).max() < 1e-10 * peak, name
        jumps = {"ux": ("xz", 5e15), "uy": ("yz", 5e15), "uz": ("zz", 2e16)}
        for name, (traction, stiffness) in jumps.items():
            jump = getattr(above, name) - getattr(below, name)
            due = -getattr(above, traction) / stiffness
            # Displacements are of the solver's pressure, stresses of that within cells.
            assert abs(jump - due).max() < 2e-2 * abs(due).max(), name
            assert abs(due).max() > 1e-10


def test_jumps_of_a_uniform_pressure_over_cells_are_exact() -> None:
    pressure = np.zeros(GRID.shape)
    pressure[20:29, 15:22] = 1e9
    above, below = (
        nacre.stress(on(BOND), GRID, pressure, H, side=side, displacement=True)
        for side in ("above", "below")
    )
    for name, traction, stiffness in (("ux", "xz", 5e15), ("uy", "yz", 5e15), ("uz", "zz", 2e16)):
        jump = getattr(above, name) - getattr(below, name)
        due = -getattr(above, traction) / stiffness
        # Each side is computed from tables that are good to 1e-9 of the displacement.
        assert abs(jump - due).max() < 1e-8 * abs(above.uz).max(), name


def test_gradients_by_stiffnesses_equal_differences() -> None:
    gradient = solved(on(BOND)).gradient("approach", tolerance=1e-12)
    for name in ("normal", "tangential"):
        path = f"body.layers[0].interface.{name}"
        size = getattr(BOND, name)

        def approach(factor: float, name: str = name) -> float:
            changed = {one: getattr(BOND, one) for one in ("normal", "tangential")}
            changed[name] *= factor
            return solved(on(nacre.Spring(**changed))).approach

        difference = (approach(1.001) - approach(0.999)) / (0.002 * size)
        assert gradient[path] == pytest.approx(difference, rel=1e-4)
        assert gradient[path] < 0
    free = solved(on(nacre.Spring(normal=2e16, tangential=0.0))).gradient("approach")
    assert "body.layers[0].interface.tangential" not in free


def test_friction_takes_springs_that_hold() -> None:
    """Compliance along the interface adds to the shift of a stuck contact."""
    keywords: dict[str, Any] = {"grid": GRID, "load": 1.0, "friction": 1.0, "force": (0.05, 0.0)}
    bonded = nacre.slide(BALL, on("bonded"), **keywords)
    stiff = nacre.slide(BALL, on(nacre.Spring(1e33, 1e33)), **keywords)
    joined = nacre.slide(BALL, on(BOND), **keywords)
    assert stiff.shift[0] == pytest.approx(bonded.shift[0], rel=1e-9)
    # The layer spreads the traction over a wider part of the interface than the contact.
    mean = 0.05 / bonded.normal.contact_area
    assert 0.02 * mean / 5e15 < joined.shift[0] - bonded.shift[0] < mean / 5e15
    with pytest.raises(ValueError, match="frictionless"):
        nacre.slide(BALL, on(nacre.Spring(2e16, 0.0)), **keywords)


def test_the_interface_is_in_case_files_studies_and_saved_files(tmp_path: Path) -> None:
    table = {
        "body": {
            "substrate": {"young": 210e9, "poisson": 0.3},
            "layers": [
                {
                    "material": {"young": 420e9, "poisson": 0.25},
                    "thickness": H,
                    "interface": {"normal": 2e16, "tangential": 5e15},
                }
            ],
        },
        "shape": {"kind": "sphere", "radius": 5e-3},
        "solve": {"load": 1.0},
    }
    assert Case(table).arguments()["body"] == on(BOND)
    stiffnesses = [1e16, 1e17]
    study = nacre.sweep(
        {"shape": BALL, "body": on(BOND), "grid": GRID, "load": 1.0},
        {"body.layers[0].interface.normal": stiffnesses},
        outputs=["approach"],
    )
    for found, normal in zip(np.ravel(study.approach), stiffnesses, strict=True):
        due = solved(on(nacre.Spring(normal, 5e15))).approach
        assert float(found) == pytest.approx(due, rel=1e-7)
    solution = solved(on(BOND))
    assert nacre.load(solution.save(tmp_path / "a.nc")).report.body == on(BOND)
    plain = values.encode(solution)
    assert values.decode(json.loads(json.dumps(plain))).report.body == on(BOND)
    assert "on springs: normal" in str(solution)


PERIOD = 0.02
CELLS = nacre.Grid((64, 16), (PERIOD, PERIOD / 4), periodic=(True, True))
PLATE = nacre.HalfSpace(nacre.FREE, [nacre.Layer(STEEL, 1e-3)])


def wave(amplitude: float, number: int) -> nacre.HeightMap:
    """Return a wavy surface along x."""
    heights = amplitude * np.cos(2 * np.pi * number * CELLS.x / PERIOD)
    return nacre.HeightMap(
        np.repeat(heights[:, None], 16, axis=1), CELLS.spacing, periodic=(True, True)
    )


@pytest.mark.parametrize("number", [1, 2, 8])
def test_a_wave_pressed_flat_on_a_plate_has_the_pressure_of_its_response(number: int) -> None:
    """In full contact, p̂ is û over the response, summed over waves alike at centres of cells."""
    alpha = 2 * np.pi * number / PERIOD
    due = 1e-9 / nacre.frequency_response(PLATE, alpha)
    load = 2 * due * PERIOD**2 / 4
    solution = nacre.solve(wave(1e-9, number), PLATE, grid=CELLS, load=load, tolerance=1e-9)
    assert bool(solution.in_contact.all())
    mean = solution.pressure.mean()
    assert mean == pytest.approx(2 * due, rel=1e-8)
    spectrum = np.fft.rfft(solution.pressure[:, 0] - mean)
    q = alpha + np.arange(-400, 401) * 2 * np.pi / CELLS.spacing[0]
    smoothed = np.sinc(q * CELLS.spacing[0] / 2 / np.pi)
    seen = (smoothed * nacre.frequency_response(PLATE, abs(q))).sum()
    assert 2 * abs(spectrum[number]) / 64 == pytest.approx(1e-9 / seen, rel=1e-8)
    assert abs(solution.displacement.mean()) < 1e-9 * abs(solution.displacement).max()


def test_a_long_wave_bends_the_plate_as_a_beam() -> None:
    """Kirchhoff: M = p/q² per width and σ_xx = ± 6 M/h² on the faces; the lower one is free.

    Shear adds a part of (qh)²/5, 2e-2 here, to the deflection; to the stress a sixth of that. The
    displacement on top is that of the response to a wave that is uniform over cells.
    """
    q, h = 2 * np.pi / PERIOD, 1e-3
    pressure = np.repeat(1e3 * np.cos(q * CELLS.x)[:, None], 16, axis=1)
    top, bottom = (
        nacre.stress(PLATE, CELLS, pressure, z, side="above", displacement=True) for z in (0.0, h)
    )
    bending = 6 * 1e3 / q**2 / h**2
    assert bottom.xx[:, 0] == pytest.approx(bending * np.cos(q * CELLS.x), abs=4e-3 * bending)
    assert top.xx[:, 0] == pytest.approx(-bending * np.cos(q * CELLS.x), abs=4e-3 * bending)
    for name in ("zz", "xz", "yz"):
        assert abs(getattr(bottom, name)).max() < 1e-6 * 1e3, name
    rigidity = STEEL.plane_strain_modulus * h**3 / 12
    due = 1e3 * np.cos(q * CELLS.x) / (rigidity * q**4)
    assert bottom.uz[:, 0] == pytest.approx(due, abs=0.05 * due.max())
    # A load that is uniform over cells has more waves, which are seen at their centres as this one.
    alias = np.arange(-64, 65)
    waves = nacre.frequency_response(PLATE, abs(q * (1 + 64 * alias)))
    exact = 1e3 * (waves * np.sinc(alias + 1 / 64)).sum()
    assert top.uz[:, 0] == pytest.approx(exact * np.cos(q * CELLS.x), rel=1e-9, abs=1e-9 * exact)


def test_stresses_of_short_waves_are_those_of_a_half_space() -> None:
    """Waves of a fifth of the thickness do not see the lower face: e^{−2αh} is 1e-27."""
    grid = nacre.Grid((10, 20), (1e-3, 2e-3), periodic=(True, True))
    thick = nacre.HalfSpace(nacre.FREE, [nacre.Layer(STEEL, 5e-3)])
    pressure = (
        1e6
        * np.cos(np.arange(10) * 2 * np.pi / 10)[:, None]
        * np.cos(np.arange(20) * 2 * np.pi * 2 / 20)
    )
    for z in (0.0, 2e-4):
        plate = nacre.stress(thick, grid, pressure, z, displacement=True)
        whole = nacre.stress(STEEL, grid, pressure, z, displacement=True)
        for name in ("xx", "yy", "zz", "xy", "yz", "xz"):
            difference = getattr(plate, name) - getattr(whole, name)
            assert abs(difference).max() < 1.0, name


def test_solved_contacts_on_plates_have_stresses_and_gradients() -> None:
    bump = nacre.HeightMap(
        -((CELLS.x[:, None] / 2e-2) ** 2) * 1e-6 + 0 * CELLS.y, CELLS.spacing, periodic=(True, True)
    )
    solution = nacre.solve(bump, PLATE, grid=CELLS, load=1.0, tolerance=1e-11)
    assert solution.report.converged
    assert "a free base" in str(solution)
    below = quiet(solution.stress, 1e-3, side="above")
    mean = solution.pressure.mean()
    # Only the mean acts on the free face: a uniform pressure balances the load.
    assert abs(below.zz + mean).max() < 1e-3 * solution.peak_pressure
    gradient = solution.gradient("approach", tolerance=1e-11)

    def approach(h: float) -> float:
        plate = nacre.HalfSpace(nacre.FREE, [nacre.Layer(STEEL, h)])
        return nacre.solve(bump, plate, grid=CELLS, load=1.0, tolerance=1e-12).approach

    difference = (approach(1.0001e-3) - approach(0.9999e-3)) / 2e-7
    assert gradient["body.layers[0].thickness"] == pytest.approx(difference, rel=1e-3)
    with pytest.raises(ValueError, match="free base"):
        solution.stress(0.5e-3, friction=0.1, direction=(1, 0))


@pytest.mark.parametrize("tangential", [0.0, 1e10])
def test_a_force_on_a_plate_on_springs_sinks_as_hertz_says(tangential: float) -> None:
    """The deflection is P/(8 √(k D)): Hertz, Wiedemanns Ann. 22 (1884) 449.

    To it the contact adds that of the surface. What is left is of the order of P/(E h) and of the
    deflection times the square of h over ⁴√(D/k), 7e-3 at most.
    """
    load, h, k = 1.0, 1e-3, 1e10
    body = nacre.HalfSpace(nacre.RIGID, [nacre.Layer(STEEL, h, nacre.Spring(k, tangential))])
    due = load / (8 * np.sqrt(k * STEEL.plane_strain_modulus * h**3 / 12))
    due += nacre.hertz.Point(5e-3, STEEL.plane_strain_modulus, load).approach
    found = nacre.solve(BALL, body, load=load)
    assert found.approach == pytest.approx(due, rel=7e-3)
    tip = nacre.indent.Indentation(body, nacre.indent.Tip.sphere(5e-3)).at(load=load)
    assert found.approach == pytest.approx(tip.approach, rel=2e-4)


def test_contacts_on_springs_are_those_of_tips() -> None:
    for interface in (BOND, nacre.Spring(2e15, 5e13)):
        ball = nacre.Paraboloid(5e-3, 5e-3)
        found = nacre.solve(ball, on(interface), load=1.0)
        tip = nacre.indent.Tip.paraboloid(5e-3)
        due = nacre.indent.Indentation(on(interface), tip).at(load=1.0)
        assert found.approach == pytest.approx(due.approach, rel=2e-4)
        assert found.central_pressure == pytest.approx(due.central_pressure, rel=1e-3)


def test_coefficients_of_a_plate_are_sums_of_waves() -> None:
    """The difference from a half-space of the surface's material, by waves: e^{−2αh} is 1e-13."""
    soft, hard = nacre.Elastic(1.0, 0.35), nacre.Elastic(5.0, 0.2)
    for layers, cells in (
        ([nacre.Layer(soft, 2.0)], (12, 9)),
        ([nacre.Layer(hard, 0.4, nacre.Spring(1.0, 0.3)), nacre.Layer(soft, 1.0)], (9, 16)),
    ):
        plate = nacre.HalfSpace(nacre.FREE, layers)
        grid = nacre.Grid(cells, (cells[0] * 1.0, cells[1] * 1.5), periodic=(True, True))
        found = nacre.influence_coefficients(plate, grid)
        top = nacre.HalfSpace(layers[0].material)
        base = nacre.influence_coefficients(top, grid)
        numbers = [np.arange(-20 * n, 20 * n + 1) for n in cells]
        m, n = np.meshgrid(
            *(2 * np.pi * k / length for k, length in zip(numbers, grid.size, strict=True)),
            indexing="ij",
        )
        dx, dy = grid.spacing
        alpha = np.hypot(m, n)
        seen = (alpha > 0) & (alpha < 40)
        response = np.zeros_like(alpha)
        response[seen] = nacre.frequency_response(plate, alpha[seen])
        response[seen] -= nacre.frequency_response(top, alpha[seen])
        response *= np.sinc(m * dx / 2 / np.pi) * np.sinc(n * dy / 2 / np.pi)
        for i, j in ((0, 0), (1, 0), (0, 3), (5, 4)):
            wave = (response * np.cos(m * i * dx + n * j * dy)).sum() / found.size
            # Sums over images are good to 1e-10 of the coefficient of the loaded cell.
            assert found[i, j] - base[i, j] == pytest.approx(wave, abs=2e-10 * found[0, 0])
        assert abs(found.sum()) < 1e-10 * found[0, 0]
