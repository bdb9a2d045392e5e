"""Writes the files of format 0 beside this script, with the last nacre that wrote them.

Run with a build of nacre before `to_dict`: python make_fixtures.py. Then store ball.nc and line.nc
again with the seal that files have today: write_dataset(xarray.load_dataset(path), path).
"""

import pickle
from pathlib import Path

import numpy as np

import nacre

HERE = Path(__file__).parent
STEEL = nacre.Elastic(210e9, 0.3)
DLC = nacre.Elastic(420e9, 0.25)
COATED = nacre.HalfSpace(STEEL, [nacre.Layer(DLC, 4e-5), nacre.Layer(STEEL, 1e-5)])
SLIPPING = nacre.HalfSpace(STEEL, [nacre.Layer(DLC, 4e-5, "frictionless")])
GRID = nacre.Grid((24, 20), (3e-4, 2e-4), (1e-5, -2e-6))


def case(load):
    return {"shape": nacre.Sphere(5e-3), "body": COATED, "grid": GRID, "load": load}


ball = nacre.solve(
    nacre.Sphere(5e-3),
    COATED,
    nacre.HalfSpace(STEEL, [nacre.Layer(DLC, 2e-5)]),
    grid=GRID,
    load=10.0,
    eccentricity=(1e-6, None),
    tilt=(None, 1e-4),
)
line = nacre.solve(
    nacre.Cylinder(5e-3), SLIPPING, grid=nacre.Grid.line(64, 2e-4, 1e-6), load=1e4
)
ball.save(HERE / "ball.nc")
line.save(HERE / "line.nc")
summary = ball.stress_summary(yield_stress={0: 2e9}, strength={0: 1e9}, threads=1)
kept = {
    "ball": ball,
    "line": line,
    "report": ball.report,
    "stress": ball.stress([0.0, 1e-6], y=0.0, friction=0.1, displacement=True, threads=1),
    "summary": summary,
    "layer": summary.layers[0],
    "interface": summary.interfaces[0],
    "shape": (nacre.Sphere(5e-3) + nacre.HeightMap(np.arange(6).reshape(2, 3) / 3e6, 1e-6)).shifted(
        1e-3, 0.0
    ),
    "roller": nacre.Roller(5e-3, profile=nacre.LogarithmicProfile(1e-6, 1e-2)),
    "punch": nacre.FlatPunch(1e-3),
    "contact": nacre.Contact(COATED, GRID, method="image", refinement=2, threads=1),
}
(HERE / "values.pickle").write_bytes(pickle.dumps(kept))
# The bits that loading must give back.
numbers = {
    f"{name}.{field}": getattr(one, field)
    for name, one in (("ball", ball), ("line", line))
    for field in ("pressure", "gap", "displacement")
}
numbers |= {f"stress.{field}": getattr(kept["stress"], field) for field in ("xx", "xz", "uz", "z")}
for name, one in (("ball", ball), ("line", line)):
    r = one.report
    numbers[f"{name}.figures"] = np.array(
        [one.approach, *one.tilt, r.residual, r.overlap, *r.balance, r.iterations, r.convolutions,
         r.tolerance, r.seconds, *(r.discretisation or {}).values()]
    )
numbers["summary.figures"] = np.array(
    [
        x
        for part in (*summary.layers, *summary.interfaces)
        for name in ("von_mises", "tension", "max_shear", "compression", "shear", "jump")
        if (peak := getattr(part, name, None)) is not None
        for x in (peak[0], *peak[1])
    ]
)
np.savez(HERE / "numbers.npz", **numbers)
study = nacre.sweep(case, {"load": [5.0, 10.0, -1.0]}, store=HERE / "study.nc", progress=False)
