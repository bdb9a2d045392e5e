"""A layer has its number or its name wherever a path or a dict by layers is taken."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import nacre
from bodies import BALL, STEEL, quiet
from nacre import fatigue, indent
from nacre.case import Case, CaseError
from nacre.contact.layers import layer_numbers
from support import assert_close

DLC, CHROMIUM = nacre.Elastic(young=300e9, poisson=0.25), nacre.Elastic(young=250e9, poisson=0.2)
COATS = [nacre.Layer(DLC, 2e-6, name="DLC"), nacre.Layer(CHROMIUM, 5e-7, name="Cr")]
BODY = nacre.HalfSpace(STEEL, COATS)
GRID = nacre.Grid((24, 24), (2.4e-4, 2.4e-4))
SOLUTION = quiet(nacre.solve, BALL, BODY, load=5.0, grid=GRID, tolerance=1e-10)
FORMS = ("layers[1]", "layers.1", "layers[Cr]", "layers.Cr")
NUMBER = "body.layers[1].thickness"


@pytest.mark.parametrize("form", FORMS)
def test_derivatives_take_each_form(form: str) -> None:
    path = f"body.{form}.thickness"
    expected = SOLUTION.gradient("approach", [NUMBER])[NUMBER]
    gradient = SOLUTION.gradient("approach", [path])
    assert gradient[path] == gradient[NUMBER] == expected != 0.0
    assert path in gradient
    assert "body.layers[2].thickness" not in gradient
    change = SOLUTION.jvp({path: 1.0})
    assert change.approach == SOLUTION.jvp({NUMBER: 1.0}).approach
    weights = np.ones(GRID.shape)
    assert SOLUTION.vjp(weights, [path])[NUMBER] == SOLUTION.vjp(weights, [NUMBER])[NUMBER]


@pytest.mark.parametrize("form", FORMS)
def test_indentations_and_fits_take_each_form(form: str) -> None:
    path, test = f"body.{form}.thickness", indent.Indentation(BODY, indent.Tip.sphere(1e-5))
    depth = np.linspace(1e-8, 2e-7, 12)
    curve = test.curve(approach=depth, wrt=[path])
    assert_close(
        curve.derivatives, test.curve(approach=depth, wrt=[NUMBER]).derivatives, rtol=0, atol=0
    )
    states = test.at(load=1e-3)
    found = states.derivatives([path])[path].approach
    assert found == states.derivatives([NUMBER])[NUMBER].approach
    fits: list[Any] = [
        quiet(
            indent.fit,
            (depth, curve.load),
            BODY,
            indent.Tip.sphere(1e-5),
            [f"body.layers{name}.material.young"],
            known={thickness: (5e-7, 1e-8)},
            bounds={f"body.layers{name}.material.young": (1e10, 1e12)},
            profile=False,
        )
        for name, thickness in (("[DLC]", path), ("[0]", NUMBER))
    ]
    assert fits[0].estimates == fits[1].estimates
    assert list(fits[0].estimates) == ["body.layers[0].material.young"]


@pytest.mark.parametrize("key", [1, "Cr", *FORMS, *(f"body.{form}" for form in FORMS)])
def test_dicts_by_layer_take_each_form(key: int | str) -> None:
    def limited(key: int | str) -> Any:
        return quiet(
            SOLUTION.stress_summary,
            yield_stress={key: 3e9},
            strength={key: 2e9},
            residual={key: -1e9},
            bond_strength={key: (2e8, None)},
        )

    assert limited(key) == limited(1) != limited(0)
    assessed: list[Any] = [
        quiet(fatigue.assess, SOLUTION, direction=(1, 0), shear_yield={name: 2e9})
        for name in (key, 1)
    ]
    assert assessed[0] == assessed[1]


@pytest.mark.parametrize("first", ["layers[0]", "layers.DLC", "DLC"])
def test_rates_of_wear_take_each_form(first: str) -> None:
    given = {first: 1e-16, "body.layers[1]": 2e-16, "substrate": 0.0}
    assert layer_numbers("rate", given, BODY, "rate") == [1e-16, 2e-16, 0.0]


@pytest.mark.parametrize("path", ["body.layers[2].thickness", "body.layers.Au.thickness"])
def test_errors_list_what_there_is(path: str) -> None:
    for call in (
        lambda: SOLUTION.gradient("approach", [path]),
        lambda: SOLUTION.jvp({path: 1.0}),
        lambda: indent.Indentation(BODY, indent.Tip.sphere(1e-5)).curve(
            approach=[1e-8], wrt=[path]
        ),
    ):
        with pytest.raises(ValueError, match=r"body\.layers\[1\]\.thickness"):
            call()


CASE: dict[str, Any] = {
    "units": "N-mm-MPa",
    "materials": {
        "steel": {"young": 210e3, "poisson": 0.3},
        "coating": {"young": 300e3, "poisson": 0.25},
    },
    "shape": {"kind": "sphere", "radius": 5.0},
    "body": {
        "substrate": "steel",
        "layers": [{"material": "coating", "thickness": 2e-3, "name": "DLC"}],
    },
    "counterbody": {"substrate": "steel"},
    "solve": {"load": 10.0},
}


@pytest.mark.parametrize("form", ["layers[0]", "layers.0", "layers.DLC", "layers[DLC]"])
def test_a_key_of_a_case_leads_through_the_name_of_a_material(form: str) -> None:
    case = Case(CASE)
    changed = case(**{f"body.{form}.material.young": 1e5, "body.substrate.poisson": 0.2})
    assert changed["body"].layers[0].material == nacre.Elastic(1e5, 0.25)
    assert changed["body"].substrate == nacre.Elastic(210e3, 0.2)
    assert changed["counterbody"].substrate == nacre.Elastic(210e3, 0.3)  # the named one stays
    assert case(**{"materials.coating.young": 1e5})["body"].layers == changed["body"].layers
    both = {"body.substrate.poisson": 0.2, "materials.steel.young": 2e5}
    assert case(**both)["body"].substrate == nacre.Elastic(2e5, 0.2)
    with pytest.raises(CaseError, match="is not a key of this case; the nearest are"):
        case(**{f"body.{form}.material.yung": 1e5})
