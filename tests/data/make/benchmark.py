"""The benchmark data set: tests/data/benchmark/*.json and the table that programs fill in.

The cases are chosen from the reference numbers; what is given and what is asked are spelled out in
units of a definite case, so that no other file is needed. Run it with --write after a reference
file has changed; docs/benchmark.md describes the cases.
"""

import argparse
import csv
import hashlib
import io
import json
import sys

import numpy as np

from common import DATA, read

HERE = DATA / "benchmark"
YOUNG, RADIUS, SPHERE_LOAD, LINE_LOAD = 210e9, 0.01, 20.0, 1e5  # Pa, m, N, N/m
LICENCE = "CC0-1.0: to the extent possible, the authors waive all rights in these numbers"
NU = 0.3
MODULUS = YOUNG / (1 - NU**2)


def coat(ratio, h, nu=NU):
    layer = {"young_Pa": ratio * YOUNG, "poisson": nu, "thickness_m": h}
    return {"coating": layer, "substrate": {"young_Pa": YOUNG, "poisson": nu}}


def case(name, given, asked, error):
    """Return a case; asked: quantity -> value, or (value, scale) where the error is of a scale."""
    rows = {}
    for key, value in asked.items():
        value, scale = value if isinstance(value, tuple) else (value, abs(value))
        rows[key] = {"value": float(value), "scale": float(scale), "error": error}
    return {"name": name, "given": given, "asked": rows}


def spheres():
    a = (3 * SPHERE_LOAD * RADIUS / (4 * MODULUS)) ** (1 / 3)
    p = 3 * SPHERE_LOAD / (2 * np.pi * a**2)
    for row in read("sphere_coated.json")["cases"]:
        given = coat(row["modulus_ratio"], row["h"] * a, row["poisson"])
        given |= {"radius_m": RADIUS, "load_N": SPHERE_LOAD}
        asked = {"peak_pressure_Pa": row["peak"] * p, "contact_radius_m": row["radius"] * a}
        asked["approach_m"] = row["approach"] * a**2 / RADIUS
        yield case(f"ratio {row['modulus_ratio']:g}, h/a_H {row['h']:g}", given, asked, 1e-11)


def lines():
    b = np.sqrt(4 * LINE_LOAD * RADIUS / (np.pi * MODULUS))
    p = 2 * LINE_LOAD / (np.pi * b)
    for row in read("line_coated.json")["cases"]:
        given = coat(row["modulus_ratio"], row["h"] * b, row["poisson"])
        given |= {"radius_m": RADIUS, "load_per_length_N/m": LINE_LOAD}
        asked = {"peak_pressure_Pa": row["peak"] * p, "half_width_m": row["half_width"] * b}
        asked["pressure_on_axis_Pa"] = row["centre"] * p
        yield case(f"ratio {row['modulus_ratio']:g}, h/b_H {row['h']:g}", given, asked, 1e-9)


def stresses():
    a = (3 * SPHERE_LOAD * RADIUS / (4 * MODULUS)) ** (1 / 3)
    p = 3 * SPHERE_LOAD / (2 * np.pi * a**2)
    for row in read("stress_sphere.json")["cases"]:
        given = coat(row["E1_over_E2"], row["h_over_aH"] * a, row["nu"])
        given |= {"radius_m": RADIUS, "load_N": SPHERE_LOAD}
        asked = {}
        for at in row["axis"]:
            z = at["z_over_h"] * row["h_over_aH"] * a
            side = "coating" if at["layer"] == 0 else "substrate"
            for key in ("szz", "srr"):
                asked[f"{key}_Pa on the axis, z = {z:.6e} m, {side}"] = (at[key] * p, p)
        asked["largest interface shear_Pa"] = row["interface_shear_max_over_pH"] * p
        yield case(f"ratio {row['E1_over_E2']:g}, h = a_H", given, asked, 1e-9)


ENDS = {  # what the letters of finite_roller.json mean, and the error stated there
    "A": ("roller and race are half-spaces: the surface goes on beyond the ends", 0.01),
    "C": ("the roller ends in free faces; the race is a half-space", 0.01),
    "D": ("roller and race end in flush free faces; exactly, p is uniform", 0.016),
}


def rollers():
    b, p = 1e-4, 1e9  # half-width and pressure of the line contact at the mean load per length
    for row in read("finite_roller.json")["cases"]:
        letter, modulus = row["case"].split()[1], YOUNG / (1 - row["nu"] ** 2)
        if letter not in ENDS:  # B is a model of the ends, and no reference
            continue
        given = {"material": {"young_Pa": YOUNG, "poisson": row["nu"]}, "length_m": 20 * b}
        given |= {"radius_m": modulus * b / (4 * p), "load_N": np.pi * b * p / 2 * 20 * b}
        given["ends"] = ENDS[letter][0]
        at = zip(row["x_over_b"], row["p_axis"], strict=True)
        asked = {f"pressure_Pa on the axis, {x * b:.3e} m from the end": (v * p, p) for x, v in at}
        yield case(f"{letter}, nu {row['nu']:g}", given, asked, ENDS[letter][1])


def slips():
    for row in read("friction/line_contact.json")["cattaneo"]:
        given = {"E1_over_E2": row["E1_over_E2"], "h_over_b": row["h_over_b"], "poisson": NU}
        given["Q_over_muP"] = row["Q_over_muP"]
        asked = {"c_over_b": row["c_over_b"], "shift_G2_over_(1-nu)muP": row["shift"]}
        name = f"ratio {row['E1_over_E2']:g}, h/b {row['h_over_b']:g}, Q/muP {row['Q_over_muP']:g}"
        yield case(name, given, asked, 1e-10)


def creeps():
    for row in read("friction/kalker_coated.json")["cases"]:
        given = {"E1_over_E2": row["E1_over_E2"], "h_over_a": row["h_over_a"], "poisson": NU}
        name = f"ratio {row['E1_over_E2']:g}, h/a {row['h_over_a']:g}"
        asked = {f"{key}_over_bare": row[key] for key in ("C11", "C22", "C23")}
        found = case(name, given, asked, 0.0)
        for key, error in zip(found["asked"], row["uncertainty"], strict=True):
            found["asked"][key]["error"] = error
        yield found


def indentations():
    # The file's thickness in m, its moduli in units of YOUNG; shapes blunter by `blunt`, since the
    # theory is of small slopes: load and approach are proportional to the shape.
    unit, blunt = 1e-6, 100
    for row in read("axisym.json")["cases"]:
        tip, plain = row["tip"], len(row["layers"]) == 1 and row["substrate"] != "rigid"
        if tip["kind"] not in ("paraboloid", "cone") or not plain:
            continue
        layer = row["layers"][0]
        given = coat(layer["young"], layer["thickness"] * unit, layer["poisson"])
        given["substrate"]["poisson"] = row["substrate"]["poisson"]
        given |= {"interface": layer["interface"], "tip": tip["kind"]}
        cone = tip["kind"] == "cone"
        given |= {"slope": tip["R"] / blunt} if cone else {"tip_radius_m": tip["R"] * blunt * unit}
        asked = {}
        for at in row["rows"]:
            where = f"at contact radius {at['a'] * unit:.3e} m"
            asked[f"load_N {where}"] = at["P"] / blunt * YOUNG * unit**2
            asked[f"approach_m {where}"] = at["delta"] / blunt * unit
            asked[f"stiffness_N/m {where}"] = at["S"] * YOUNG * unit
        yield case(row["name"], given, asked, 1e-11)


YIELDS = {
    "shakedown": "shakedown, von Mises",
    "shakedown_tresca_in_plane": "shakedown, Tresca in the plane",
    "first_yield": "first yield, von Mises",
}


def shakedowns():
    b, p = 1e-4, 1e9
    for row in read("fatigue/shakedown.json")["cases"]:
        ratio, h, nu, mu = (row[key] for key in ("E1_over_E2", "h_over_b", "nu", "mu"))
        given = coat(ratio, h * b, nu)
        if not h:
            del given["coating"]
        given |= {"half_width_m": b, "peak_pressure_Pa": p, "friction": mu}
        asked = {
            f"p0/k {text}, {part}": row[part][key]
            for part in ("coating", "substrate")
            if part in row
            for key, text in YIELDS.items()
        }
        name = f"ratio {ratio:g}, h/b {h:g}, mu {mu:g}" if h else f"bare, mu {mu:g}"
        yield case(name, given, asked, 3e-6)


SETS = {
    "coated_spheres": (
        spheres,
        "sphere_coated.json",
        "Rigid paraboloid r^2/2R on a bonded coating, no friction, under a load",
    ),
    "coated_lines": (
        lines,
        "line_coated.json",
        "Rigid cylinder y^2/2R on a bonded coating, plane strain, no friction, under a line load",
    ),
    "rollers": (
        rollers,
        "finite_roller.json",
        "Straight roller with sharp ends on a flat race of the same material, no friction",
    ),
    "interior_stresses": (
        stresses,
        "stress_sphere.json",
        "Stress below a rigid paraboloid on a bonded coating, no friction; tension is positive",
    ),
    "partial_slip": (
        slips,
        "friction/line_contact.json",
        "Two identical coated cylinders, plane strain, tangential force Q after the load P",
    ),
    "kalker_coefficients": (
        creeps,
        "friction/kalker_coated.json",
        "Kalker's coefficients of two identical coated bodies, over those of bare bodies",
    ),
    "indentations": (
        indentations,
        "axisym.json",
        "Rigid tip on a coating, no friction, at given contact radii",
    ),
    "shakedown": (
        shakedowns,
        "fatigue/shakedown.json",
        "Half-plane, bare or with a bonded coating, over which the given pressure "
        "p0 sqrt(1 - y^2/b^2) and the traction friction * pressure along y pass steadily, plane "
        "strain: largest p0/k for which each material shakes down or does not yield, k its yield "
        "stress in pure shear. von Mises: sqrt(J2) <= k; Tresca in the plane: "
        "hypot((s_yy - s_zz)/2, s_yz) <= k. Shakedown: with the best residual stresses s_yy(z) "
        "and s_xx(z); in the plane, s_yy(z) alone",
    ),
}


def contents():
    """Texts of all files of the set."""
    every = io.StringIO()
    table = csv.writer(every, lineterminator="\n")
    table.writerow(["set", "case", "quantity", "value"])
    for name, (cases, file, problem) in SETS.items():
        stored, found = read(file), list(cases())
        head = {"problem": problem, "file": file, "licence": LICENCE}
        head |= {key: stored[key] for key in ("source", "method", "error")}
        head["meaning"] = "a value is exact to error * scale"
        rows = ",\n".join("  " + json.dumps(row) for row in found)
        text = json.dumps(head, indent=1)[:-2] + f',\n "cases": [\n{rows}\n ]\n}}\n'
        yield f"{name}.json", text
        for one in found:
            for key in one["asked"]:
                table.writerow([name, one["name"], key, ""])
    yield "template.csv", every.getvalue()


def checksums():
    """Text of SHA256SUMS: of all files of the folder but itself."""
    files = sorted(path for path in HERE.rglob("*") if path.is_file())
    names = [path.relative_to(HERE).as_posix() for path in files if path.suffix != ".pyc"]
    return "".join(
        f"{hashlib.sha256((HERE / name).read_bytes()).hexdigest()}  {name}\n"
        for name in names
        if name != "SHA256SUMS"
    )


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--write", action="store_true", help="write the files")
    write = parser.parse_args().write
    stale = []
    for name, text in contents():
        path = HERE / name
        if write:
            path.write_text(text, encoding="utf-8")
        elif not path.exists() or path.read_text(encoding="utf-8") != text:
            stale.append(name)
    sums = HERE / "SHA256SUMS"
    if write:
        sums.write_text(checksums(), encoding="utf-8")
    elif not sums.exists() or sums.read_text(encoding="utf-8") != checksums():
        stale.append(sums.name)
    if stale:
        sys.exit(f"not as the reference numbers are: {', '.join(stale)}")


if __name__ == "__main__":
    main()
