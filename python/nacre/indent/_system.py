"""Arguments of an indentation, which a fit writes parameters into."""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

import nacre._core as core
from nacre.indent.solution import Indentation, IndentCurve

Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class System:
    """Arguments of an indentation, which parameters are written into."""

    body: core.HalfSpace
    tip: core.Tip
    counterbody: core.HalfSpace | None
    adhesion: core.Adhesion | None

    @classmethod
    def of(
        cls,
        body: core.HalfSpace | core.Elastic,
        tip: core.Tip,
        counterbody: core.HalfSpace | core.Elastic | None = None,
        adhesion: core.Adhesion | None = None,
    ) -> System:
        """Return the system of these arguments, elastic materials as half-spaces."""
        if isinstance(body, core.Elastic):
            body = core.HalfSpace(body)
        if isinstance(counterbody, core.Elastic):
            counterbody = core.HalfSpace(counterbody)
        return cls(body, tip, counterbody, adhesion)

    def values(self) -> dict[str, float]:
        """Return the value of each parameter that may be free, by its path."""
        found: dict[str, float] = {}
        for side, body in (("body", self.body), ("counterbody", self.counterbody)):
            if body is None:
                continue
            for number, layer in enumerate(body.layers):
                path = f"{side}.layers[{number}]"
                found[f"{path}.material.young"] = layer.material.young
                found[f"{path}.material.poisson"] = layer.material.poisson
                found[f"{path}.thickness"] = layer.thickness
            if isinstance(body.substrate, core.Elastic):
                found[f"{side}.substrate.young"] = body.substrate.young
                found[f"{side}.substrate.poisson"] = body.substrate.poisson
        found |= {f"tip.{name}": float(value) for name, value in self.tip.numbers.items()}
        found["tip.area"] = 1.0
        if self.adhesion is not None:
            found["adhesion.work"] = self.adhesion.work
        return found

    def changed(self, values: Mapping[str, float]) -> System:
        """Return the system with other values of some parameters, but for the area of the tip."""
        body = _changed_body(self.body, "body", values)
        counterbody = self.counterbody
        if counterbody is not None:
            counterbody = _changed_body(counterbody, "counterbody", values)
        tip, adhesion = self.tip, self.adhesion
        numbers = {
            path.removeprefix("tip."): value
            for path, value in values.items()
            if path.startswith("tip.") and path != "tip.area"
        }
        if numbers:
            tip = getattr(core.Tip, tip.kind)(**{**tip.numbers, **numbers})
        if adhesion is not None and "adhesion.work" in values:
            adhesion = getattr(core.Adhesion, adhesion.kind)(values["adhesion.work"])
        return System(body, tip, counterbody, adhesion)

    def narrowed(self, factor: float) -> System:
        """Return the system with lateral lengths divided by a factor, but for those of the tip."""
        counterbody = self.counterbody
        if counterbody is not None:
            counterbody = _changed_body(counterbody, "", {}, factor)
        adhesion = self.adhesion
        if adhesion is not None:
            adhesion = getattr(core.Adhesion, adhesion.kind)(adhesion.work * factor)
        body = _changed_body(self.body, "", {}, factor)
        return replace(self, body=body, counterbody=counterbody, adhesion=adhesion)

    def curve(self, approach: Array, wrt: Sequence[str] = ()) -> IndentCurve:
        """Return the loads at these approaches, without issuing the warnings that they hold."""
        made = Indentation(self.body, self.tip, self.counterbody, adhesion=self.adhesion)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", core.NacreWarning)  # of places on the way to a fit
            return made.curve(approach=approach, wrt=wrt)


def _changed_body(
    body: core.HalfSpace, side: str, values: Mapping[str, float], narrower: float = 1.0
) -> core.HalfSpace:
    layers = []
    for number, layer in enumerate(body.layers):
        path, material = f"{side}.layers[{number}]", layer.material
        young = values.get(f"{path}.material.young", material.young)
        poisson = values.get(f"{path}.material.poisson", material.poisson)
        thickness = values.get(f"{path}.thickness", layer.thickness) / narrower
        new = core.Elastic(young, poisson)
        layers.append(core.Layer(new, thickness, interface=layer.interface, name=layer.name))
    substrate = body.substrate
    if isinstance(substrate, core.Elastic):
        substrate = core.Elastic(
            values.get(f"{side}.substrate.young", substrate.young),
            values.get(f"{side}.substrate.poisson", substrate.poisson),
        )
    return core.HalfSpace(substrate, layers=layers)
