"""State of format 0: tuples that are read by position, in pickles and NetCDF files.

No version writes it any more. Pickles call the functions here by their names in `nacre._core`.
"""

from __future__ import annotations

from typing import Any

import nacre._core as core
from nacre.values import FORMAT, encode

COMPONENTS = ("xx", "yy", "zz", "xy", "yz", "xz")
DISPLACEMENTS = ("ux", "uy", "uz")
AXES = ("z", "x", "y")


def _named(kind: str, **fields: Any) -> dict[str, Any]:
    """Return a state with the head that every state has."""
    return {"format": FORMAT, "nacre": "0.1.0", "kind": kind, **fields}


def _restore_report(state: tuple[Any, ...]) -> core.Report:
    """Return a report; the fields that format 0 lacks must be filled in here."""
    (
        termination,
        (iterations, convolutions),
        (residual, overlap),
        (force, moment, errors),
        warnings,
        (grid, body, counterbody),
        (method, refinement),
        (load, approach, (eccentricity, moments, tilt)),
        (tolerance, seconds),
    ) = state
    named = ("peak_pressure", "approach", "load")
    return core.Report.from_dict(
        _named(
            "Report",
            termination=termination,
            solver=None,
            iterations=iterations,
            convolutions=convolutions,
            residual=residual,
            overlap=overlap,
            balance={"force": force, "moment": moment},
            discretisation=None if errors is None else dict(zip(named, errors, strict=True)),
            warnings=[
                dict(zip(("kind", "axis", "figure"), warning, strict=True)) for warning in warnings
            ],
            grid=encode(grid),
            body=encode(body),
            counterbody=encode(counterbody),
            method=method,
            refinement=refinement,
            motion={
                "load": load,
                "approach": approach,
                "eccentricity": eccentricity,
                "moment": moments,
                "tilt": tilt,
            },
            tolerance=tolerance,
            seconds=seconds,
        )
    )


def _restore_solution(
    fields: tuple[Any, Any, Any], motion: tuple[float, Any], report: core.Report
) -> core.Solution:
    """Return a solution."""
    pressure, gap, displacement = fields
    approach, tilt = motion
    nested = {
        name: value
        for name, value in report.to_dict().items()
        if name not in ("format", "nacre", "kind")
    }
    return core.Solution.from_dict(
        _named(
            "Solution",
            pressure=pressure,
            gap=gap,
            displacement=displacement,
            approach=approach,
            tilt=tilt,
            report=nested,
        )
    )


def _restore_stress(state: tuple[Any, ...]) -> core.Stress:
    """Return a stress field."""
    (z, x, y), fields, body, side, friction, dropped = state
    displacement = dict(zip(DISPLACEMENTS, fields[6:], strict=True)) if len(fields) > 6 else None
    return core.Stress.from_dict(
        _named(
            "Stress",
            z=z,
            x=x,
            y=y,
            axes=[axis for axis, gone in zip(AXES, dropped, strict=True) if not gone],
            body=encode(body),
            side=side,
            friction=friction,
            components=dict(zip(COMPONENTS, fields[:6], strict=True)),
            displacement=displacement,
        )
    )


def _peak(state: tuple[float, Any] | None) -> dict[str, Any] | None:
    return None if state is None else {"value": state[0], "at": state[1]}


def _layer(state: tuple[Any, ...]) -> dict[str, Any]:
    layer, depths, (von_mises, tension, shear), factors = state
    return {
        "layer": layer,
        "name": None,
        "depths": depths,
        "von_mises": _peak(von_mises),
        "tension": _peak(tension),
        "max_shear": _peak(shear),
        "yield_safety_factor": factors[0],
        "strength_safety_factor": factors[1],
    }


def _interface(state: tuple[Any, ...]) -> dict[str, Any]:
    interface, depth, (tension, compression, shear), jump = state
    return {
        "interface": interface,
        "depth": depth,
        "tension": _peak(tension),
        "compression": _peak(compression),
        "shear": _peak(shear),
        "jump": _peak(jump),
    }


def _restore_layer_stress(state: tuple[Any, ...]) -> core.LayerStress:
    """Return the extremes of one layer."""
    return core.LayerStress.from_dict(_named("LayerStress", **_layer(state)))


def _restore_interface_stress(state: tuple[Any, ...]) -> core.InterfaceStress:
    """Return the extremes at one interface."""
    return core.InterfaceStress.from_dict(_named("InterfaceStress", **_interface(state)))


def _restore_stress_summary(state: tuple[Any, ...]) -> core.StressSummary:
    """Return a summary."""
    layers, interfaces, finished = state
    return core.StressSummary.from_dict(
        _named(
            "StressSummary",
            layers=[_layer(layer) for layer in layers],
            interfaces=[_interface(interface) for interface in interfaces],
            finished=finished,
        )
    )
