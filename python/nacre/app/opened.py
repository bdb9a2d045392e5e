"""Files that a browser sends as a card: a case with its files, a map, a profile or a curve."""

from __future__ import annotations

import base64
import copy
import dataclasses
import hashlib
import os
import re
import tomllib
from collections.abc import Mapping
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

import nacre
from nacre._tools.notices import heard
from nacre._tools.units import number_in
from nacre.app.answer import ERRORS, Measured
from nacre.app.cards import Card, cards, own_card
from nacre.app.fields import tidy
from nacre.case import Case, CaseError, templates, toml
from nacre.results.rows import remark

Data = dict[str, Any]

LARGEST = 10_000_000
"""Largest size of all files together, in bytes."""
LONGEST = 100
"""Largest number of characters of a name."""
KINDS = {
    "height_map": "a height map",
    "profile": "the profile of a roller",
    "curve": "a curve of a sphere that indents a body",
    "film_curve": "a curve of a sphere that indents a film",
}
"""What a file may be that is no case."""
ASKED = re.compile(
    r"\b(kind|channel|unit|spacing|units|columns|depth|force|segment) must be (?!left out)"
)
"""What a reader asks for."""
KEYWORDS = re.compile(r", such as units=\{.*?\}|[;.] [gG]ive depth=.*")
"""What readers say of their keywords, which the page has not."""
INPUTS = {"depth": "columns", "force": "columns", "segment": "channel"}
"""Inputs of the page for what readers of curves ask for."""
MOST_POINTS = 2000
"""Number of points up to which all of a curve are fitted: within a second."""
MICROMETRES = 1e6
"""Micrometres in a metre, micronewtons in a newton: cases of indentations are in these."""
CURVE_NOTE = (
    "The modulus holds for the numbers in the fields. Check the tip radius, Poisson's ratio, and "
    "of a film its thickness and its substrate"
)
MILLIMETRES = 1e3
"""Millimetres in a metre: cases of files are in N and mm."""


class Asks(CaseError):
    """Files that cannot be read yet; `what` is the key that is asked for, or ""."""

    def __init__(self, message: str) -> None:
        super().__init__(KEYWORDS.sub("", message))
        found = ASKED.search(message)
        self.what = INPUTS.get(found[1], found[1]) if found else ""


def opened_card(files: Any) -> Card:
    """Return the card of files that were sent; they are on the disk only until it is returned.

    Parameters
    ----------
    files
        Tables ``contents``, of texts in base64 by file name, and ``reading``, of what readers ask
        for: kind, channel, unit, spacing, columns and units, as they were typed.

    Returns
    -------
    Card
        Card whose measured files are named with their SHA-256.

    Raises
    ------
    Asks
        If the files cannot be read, or more must be known.
    """
    contents, reading = _checked(files)
    with TemporaryDirectory(prefix="nacre-") as name:
        folder = Path(name).resolve()
        try:
            for file, content in contents.items():
                (folder / file).write_bytes(content)
            with heard() as notes:
                if reading.get("kind", "").endswith("curve"):
                    card = _curve_card(folder, list(contents), reading)
                else:
                    card = own_card(_case_file(folder, list(contents), reading))
        except (ImportError, OSError, *ERRORS) as error:
            words = str(error) or type(error).__name__
            for inside in (repr(f"{folder}{os.sep}")[1:-1], f"{folder}{os.sep}"):
                words = words.replace(inside, "")
            raise Asks(" ".join(words.split())) from None
    rows = [
        remark(file, f"SHA-256 {hashlib.sha256(content).hexdigest()}")
        for file, content in contents.items()
    ]
    if "curve" in card.measured.arguments:
        rows.append(remark("modulus of the film in the case", "starting value of the fit"))
    notes = list(dict.fromkeys([*card.measured.notes, *notes]))
    measured = card.measured._replace(files=rows, notes=notes)
    return dataclasses.replace(card, title=", ".join(contents), measured=measured)


def _checked(files: Any) -> tuple[dict[str, bytes], dict[str, str]]:
    """Return contents by name, and what was typed, or raise an error."""
    try:
        texts, reading = dict(files["contents"]), dict(files["reading"])
        contents = {name: base64.b64decode(text, validate=True) for name, text in texts.items()}
        typed = {str(key): str(value).strip() for key, value in reading.items()}
    except (KeyError, TypeError, ValueError):
        raise Asks("files must be sent as the page sends them") from None
    if not contents or sum(map(len, contents.values())) > LARGEST:
        raise Asks(f"files must have 1 to {LARGEST} bytes together")
    for name in contents:
        if not name or len(name) > LONGEST or re.search(r'[\x00-\x1f/\\:*?"<>|]|^\.+$', name):
            raise Asks(f"the name of a file must be one of a file alone, got {name[:LONGEST]!r}")
    return contents, {key: value for key, value in typed.items() if value}


def _case_file(folder: Path, names: list[str], reading: Mapping[str, str]) -> Path:
    """Return the case among files in a folder, or one of its own for a map or a profile."""
    cases = [name for name in names if name.lower().endswith(".toml")]
    if len(cases) == 1:
        path = folder / cases[0]
        for measured in Case.read(path).measured():
            if measured.parent != folder or measured.name not in names:
                raise CaseError(
                    f"{path.name}: {measured.name} must be opened together with the case, and be "
                    f"named in it without a folder"
                )
        return path
    if cases or len(names) > 1:
        raise CaseError(f"one case with its files, or one other file, must be opened, got {names}")
    if (kind := reading.get("kind", "")) not in KINDS:
        raise CaseError(f"{names[0]}: kind must be chosen: {', '.join(KINDS.values())}")
    spacing = {"spacing": number_in("m", reading["spacing"])} if "spacing" in reading else {}
    options: Data = spacing | ({"unit": reading["unit"]} if "unit" in reading else {})
    if channel := reading.get("channel"):
        options["channel"] = _number_or_name(channel)
    make = _map if kind == "height_map" else _profile
    path = folder / f"{names[0]}.toml"
    path.write_text(toml.text(make(folder / names[0], options)), "utf-8")
    return path


def _curve_card(folder: Path, names: list[str], reading: Mapping[str, str]) -> Card:
    """Return the card of an indentation whose modulus is fitted to a curve."""
    if len(names) > 1:
        raise CaseError(f"one curve must be opened, got {names}")
    read: Any = nacre.indent.read(folder / names[0], **_curve_options(reading))
    curve = read.loading()
    every = -(-len(curve) // MOST_POINTS)
    depth, force = (MICROMETRES * part[::every] for part in (curve.depth, curve.force))
    notes = [CURVE_NOTE, *filter(None, [curve.note])]
    notes += [f"of {len(curve)} points one in {every} is fitted"] if every > 1 else []
    card, left = cards()["indentation"], {"adhesion.work", "indent.load", "materials.film.young"}
    data = copy.deepcopy(card.base)
    data.pop("adhesion")
    data["indent"]["load"] = float(f"{force.max():.5g}")
    is_bare = reading["kind"] == "curve"
    if is_bare:
        left |= {path for path in card.by_path if path.startswith(("body", "materials.glass"))}
        data["body"] = {"substrate": "film"}
        data["materials"].pop("glass")
    fields = [
        field._replace(label=field.label.replace("film ", "" if is_bare else "film "))
        for field in card.fields
        if field.path not in left
    ]
    measured = Measured({"curve": nacre.indent.Curve(depth, force, name=curve.name)}, {}, (), notes)
    changed = dataclasses.replace(card, name="own", group="own file", base=data, measured=measured)
    return dataclasses.replace(changed, fields=fields, more=[])


def _curve_options(reading: Mapping[str, str]) -> Data:
    """Return what was typed as keywords of the reader of curves."""
    channel = reading.get("channel")
    options: Data = {"segment": _number_or_name(channel)} if channel else {}
    for key in reading.keys() & {"columns", "units"}:
        parts = re.split(r"\s*[,;]\s*", reading[key])
        if len(parts) != 2:
            raise CaseError(f"{key} must be two, of depth and force, got {reading[key]!r}")
        pair = dict(zip(("depth", "force"), map(_number_or_name, parts), strict=True))
        options |= {"units": pair} if key == "units" else pair
    return options


def _number_or_name(text: str) -> int | str:
    """Return a column, a table or a channel, by its number or its name."""
    return int(text) if text.isdecimal() else text


def _map(path: Path, options: Data) -> Data:
    """Return the case of a height map on steel, with the mean pressure of the template."""
    data = tomllib.loads(templates.texts()["rough"])
    surface = nacre.HeightMap.read(path, **options)
    area = surface.heights.size * float(np.prod(surface.spacing)) * MILLIMETRES**2
    load = data["solve"]["load"] * area / np.prod(data.pop("grid")["size"])
    if "spacing" in options:
        options = options | {"spacing": tidy(options["spacing"] * MILLIMETRES)}
    shape = {"kind": "height_map", "path": path.name} | options
    return data | {"shape": shape, "solve": {"load": float(f"{load:.3g}")}}


def _profile(path: Path, options: Data) -> Data:
    """Return the case of a steel roller with a profile, counted from the middle of its length."""
    data = tomllib.loads(templates.texts()["roller"])
    if "channel" in options:
        options["height"] = options.pop("channel")
    profile = nacre.SampledProfile.read(path, **options)
    x, drop = (MILLIMETRES * np.asarray(values) for values in (profile.x, profile.drop))
    half = tidy(np.ptp(x) / 2)
    x = np.clip(x - (x[0] + x[-1]) / 2, -half, half)
    stations = {"x": [tidy(value) for value in x], "drop": [tidy(value) for value in drop]}
    data["shape"] = {
        **{"kind": "roller", "radius": data["shape"]["radius"], "length": 2 * half},
        "profile": {"kind": "sampled", **stations},
    }
    data["materials"].pop("coating")
    data["body"] = {"substrate": "steel"}
    data["counterbody"]["ends"] = [-half, half]
    data["solve"].pop("eccentricity")
    return data
