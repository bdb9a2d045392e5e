"""`nacre` exits with 0 only for converged solutions, and says in one line why it did not."""

from __future__ import annotations

import csv
import os
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import pytest
import xarray

import nacre
import nacre.cli
from support import Capture, Patch, command, python, written


def run(*arguments: object) -> tuple[int, str, str]:
    """Run ``nacre`` in a process of its own: exit code, stdout, stderr."""
    done = python("-m", "nacre.cli", *arguments)
    return done.returncode, done.stdout, done.stderr


def test_help_names_the_commands() -> None:
    code, out, err = run("--help")
    assert (code, err) == (0, "")
    assert [
        name for name in ("info", "indent", "solve", "sweep", "verify") if f" {name} " not in out
    ] == []


def test_without_arguments_help_is_printed_and_the_exit_code_is_2(capsys: Capture) -> None:
    assert command() == 2
    assert "Commands:" in capsys.readouterr().out


def test_version_is_one_line_and_info_prints_the_versions(capsys: Capture) -> None:
    assert run("--version") == (0, f"nacre {nacre.__version__}\n", "")
    assert command("info") == 0
    assert nacre.__version__ in capsys.readouterr().out


@pytest.mark.parametrize(
    ("arguments", "names"),
    [
        (["solve", "FILE/below"], "Not a directory"),
        (["info", "--bogus"], "--bogus"),
        (["info", "extra"], "extra"),
        (["nothing"], "nothing"),
        (["solve", "FILE", "--save", "nodir/x.nc"], "'--save': 'nodir' is not a folder"),
        (["sweep", "FILE", "--save", "nodir/x.csv"], "'--save': 'nodir' is not a folder"),
        (["sweep", "FILE", "--store", "nodir/x.nc"], "'--store': 'nodir' is not a folder"),
        (["indent", "FILE", "--save", "nodir/x.nc"], "'--save': 'nodir' is not a folder"),
    ],
)
def test_bad_input_is_one_line_and_exit_code_2(
    arguments: list[str], names: str, tmp_path: Path, capsys: Capture
) -> None:
    (tmp_path / "FILE").touch()
    assert command(*(a.replace("FILE", str(tmp_path / "FILE")) for a in arguments)) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith("nacre: ")
    assert err.count("\n") == 1
    assert names in err


def test_bad_input_leaves_no_traceback_in_a_process() -> None:
    code, out, err = run("info", "--threads", "0")
    assert (code, out, err.count("\n")) == (2, "", 1)


@pytest.mark.skipif(sys.platform == "win32", reason="needs pipes and signals of POSIX")
@pytest.mark.parametrize("unbuffered", ["", "1"])
@pytest.mark.parametrize("arguments", [["--version"], ["new", "contact"], ["schema"], ["nothing"]])
def test_a_closed_pipe_is_silent(arguments: list[str], unbuffered: str) -> None:
    read, write = os.pipe()
    os.close(read)
    stream, code = ("stderr", 2) if arguments == ["nothing"] else ("stdout", 141)
    streams: dict[str, Any] = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, stream: write}
    environment = os.environ | {"PYTHONUNBUFFERED": unbuffered}
    asked = ("-m", "nacre.cli", *arguments)
    done = python(*asked, capture_output=False, env=environment, **streams)
    os.close(write)
    assert (done.returncode, done.stdout or "", done.stderr or "") == (code, "", "")


FULL = """
import resource, signal
from nacre.cli import main
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
resource.setrlimit(resource.RLIMIT_FSIZE, (100, 100))  # as little room as on a full disk
main(["new", "contact", "case.toml"])
"""


@pytest.mark.skipif(sys.platform == "win32", reason="no limit of the size of a file")
def test_a_new_case_that_a_full_disk_has_no_room_for_leaves_no_file(tmp_path: Path) -> None:
    done = python("-c", FULL, folder=tmp_path)
    assert (done.returncode, done.stdout, done.stderr.count("\n")) == (1, "", 1)
    assert "'case.toml'" in done.stderr
    assert list(tmp_path.iterdir()) == []


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs a full disk")
@pytest.mark.parametrize("unbuffered", ["", "1"])
@pytest.mark.parametrize("arguments", [["--version"], ["new", "contact"], ["schema"]])
def test_output_to_a_full_disk_is_one_line(arguments: list[str], unbuffered: str) -> None:
    environment = os.environ | {"PYTHONUNBUFFERED": unbuffered}
    streams: dict[str, Any] = {"capture_output": False, "stderr": subprocess.PIPE}
    with open("/dev/full", "w") as full:
        asked = ("-m", "nacre.cli", *arguments)
        done = python(*asked, stdout=full, env=environment, **streams)
    assert (done.returncode, done.stderr.count("\n")) == (1, 1)
    assert "No space left" in done.stderr


@pytest.mark.skipif(sys.platform == "win32", reason="signals of Windows reach the whole console")
@pytest.mark.parametrize("module", ["typer", "typer.core", "nacre.case.commands", "numpy"])
def test_ctrl_c_while_modules_load_is_exit_code_130(module: str) -> None:
    done = python("-c", LOADING, module, "info")
    assert (done.returncode, done.stdout, done.stderr) == (130, "", "")


LOADING = """
import signal, sys

class Interrupt:
    def find_spec(name, *_):
        if name == sys.argv[1]:
            signal.raise_signal(signal.SIGINT)

sys.meta_path.insert(0, Interrupt)
from nacre.cli import main
main(sys.argv[2:])
"""


@pytest.mark.parametrize(("missing", "extra"), [("typer", "cli"), ("pydantic", "cli")])
def test_a_missing_extra_is_named(missing: str, extra: str) -> None:
    code = f"import sys; sys.modules[{missing!r}] = None; from nacre import cli; cli.main([])"
    done = python("-c", code)
    assert done.returncode == 2
    assert done.stderr.count("\n") == 1
    assert f"nacre-contact[{extra}]" in done.stderr


SPHERE = """
[shape]
kind = "sphere"
radius = 5e-3

[body]
substrate = { young = 210e9, poisson = 0.3 }

[solve]
load = 10

[sweep]
parameters."solve.load" = [1, 2]
"""


def test_a_solution_is_printed_where_a_save_fails(tmp_path: Path, capsys: Capture) -> None:
    case, saved = written(tmp_path, SPHERE), tmp_path / "x.nc"
    saved.mkdir()
    assert command("solve", case, "--save", saved) == 1
    out, err = capsys.readouterr()
    assert "peak pressure" in out
    assert err.count("\n") == 1


def test_a_bearing_in_millimetres_is_printed_in_its_units(tmp_path: Path, capsys: Capture) -> None:
    case = written(
        tmp_path,
        """
        units = "N-mm-MPa"
        bearing.kind = "deep_groove_ball"
        bearing.count = 7
        bearing.diameter = 11.5
        bearing.pitch_diameter = 43.5
        bearing.solve.force.z = 1000
        """,
    )
    assert command("solve", case) == 0
    printed = capsys.readouterr().out
    assert "1000 N" in printed
    assert " MPa" in printed
    heading, first, second, *_ = printed.partition("\n\nelement")[2].splitlines()
    assert heading.split()[:5] == ["angle", "[°]", "load", "inner", "[N]"]
    assert [line.split()[1] for line in (first, second)] == ["0", f"{360 / 7:.2f}"]
    assert "tilt           (0, 0) mrad" in printed


def test_an_error_of_a_history_names_the_step(tmp_path: Path, capsys: Capture) -> None:
    case = written(tmp_path, LONG["steps"].replace("x = -0.1", "x = 100.0") + FILM)
    assert command("solve", case) == 2
    assert f"{case}: slide: step 1: force must be below" in capsys.readouterr().err


@pytest.fixture
def hostile(tmp_path: Path) -> Path:
    """Return a folder of files that are no input of any command."""
    (tmp_path / "case.toml").write_text(SPHERE)
    (tmp_path / "empty").write_bytes(b"")
    (tmp_path / "text").write_text("no")
    (tmp_path / "binary").write_bytes(bytes(range(256)) * 8)
    (tmp_path / "nested").write_text("x = " + "[" * 100_000)
    (tmp_path / "digits").write_text("x = " + "1" * 1_000_000)
    (tmp_path / "folder").mkdir()
    with (tmp_path / "huge").open("wb") as file:
        file.truncate(1 << 34)  # 16 GB, none of them on the disk
    if hasattr(os, "mkfifo"):
        os.mkfifo(tmp_path / "fifo")
        (tmp_path / "endless").symlink_to("/dev/zero")
    else:
        (tmp_path / "fifo").mkdir()
        (tmp_path / "endless").mkdir()
    return tmp_path


@pytest.mark.parametrize(
    "arguments",
    [
        *(["solve", "FILE"], ["sweep", "FILE"], ["indent", "FILE"]),
        *(["solve", "case.toml", "--initial", "FILE"], ["sweep", "case.toml", "--store", "FILE"]),
        ["solve", "map.toml"],
    ],
    ids=" ".join,
)
def test_a_hostile_file_is_one_line_and_exit_code_2(
    arguments: list[str], hostile: Path, monkeypatch: Patch, capsys: Capture
) -> None:
    monkeypatch.chdir(hostile)
    names = "missing empty text binary nested digits folder fifo endless huge".split()
    for name in names:
        file = name
        if arguments[0] == "sweep" and "--store" in arguments:
            if name in ("missing", "endless"):
                continue
            file = f"{name}.nc"
            Path(name).rename(file)
        if "map.toml" in arguments:
            if name in ("missing", "huge"):  # a matrix in a file of 16 GB is read
                continue
            file = f"{name}.csv"
            Path(name).rename(file)
            shape = f'kind = "height_map"\npath = "{file}"\nspacing = 1e-6'
            text = SPHERE.replace('kind = "sphere"\nradius = 5e-3', shape)
            Path("map.toml").write_text(text)
        start = time.process_time()
        assert command(*(argument.replace("FILE", file) for argument in arguments)) == 2, name
        out, err = capsys.readouterr()
        assert out == ""
        assert err.startswith("nacre: ")
        assert err.count("\n") == 1
        assert len(err) < 1000
        assert time.process_time() - start < 20, name  # digits of a megabyte are read once


LONG = {
    "loads": '[tip]\nkind = "sphere"\nradius = 5e-6\n[adhesion]\nkind = "maugis"\nwork = 0.05\n'
    "strength = 1e7\n[indent]\nload = [" + "1e-3, " * 10_000 + "]\n",
    "steps": '[shape]\nkind = "sphere"\nradius = 5e-3\n[solve]\nload = 10\n[slide]\n'
    "friction = 0.2\n[[slide.steps]]\nforce = { x = 0.1 }\n[[slide.steps]]\nforce = { x = -0.1 }\n",
}
FILM = """
[body]
substrate = { young = 210e9, poisson = 0.3 }
layers = [{ material = { young = 1e9, poisson = 0.4 }, thickness = 1e-6 }]
"""
# Ctrl-C is sent when the first line of progress has been written.
WAITING = """
import signal, sys
import nacre.cli, nacre._tools.progress
nacre._tools.progress.EVERY = 0.2
write = sys.stderr.write
def interrupt(text):
    write(text)
    if "solving" in text:
        sys.stderr.write = write
        signal.raise_signal(signal.SIGINT)
sys.stderr.write = interrupt
nacre.cli.main(sys.argv[1:])
"""


def test_a_radius_beyond_all_contacts_is_refused(tmp_path: Path, capsys: Capture) -> None:
    tip = '[tip]\nkind = "paraboloid"\nradius = 1e23\n[adhesion]\nkind = "jkr"\nwork = 0.05\n'
    assert command("indent", written(tmp_path, f"{FILM}{tip}[indent]\nload = 1e-3\n")) == 2
    assert "no minimum within the radii" in capsys.readouterr().err


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="no SIGINT for one process")
@pytest.mark.parametrize("name", LONG)
def test_a_long_solve_of_a_case_shows_that_it_goes_on_and_ends_at_ctrl_c(
    name: str, tmp_path: Path
) -> None:
    text = LONG[name]
    if name == "steps":
        head, step = text.split("[[slide.steps]]", 1)
        text = head + ("[[slide.steps]]" + step) * 2000
    verb = "solve" if name == "steps" else "indent"
    run = python("-u", "-c", WAITING, verb, written(tmp_path, FILM + text))
    assert run.returncode == 130, run
    assert run.stderr.startswith("nacre: solving, 0:0")
    assert "Traceback" not in run.stderr


@pytest.mark.slow
def test_store_of_a_case_stays_in_its_folder(tmp_path: Path, capsys: Capture) -> None:
    folder = tmp_path / "cases"
    folder.mkdir()
    case = folder / "case.toml"
    outside = tmp_path / "x.nc"
    names = ["../x.nc", str(outside), "a/../../x.nc", "\\u0000.nc"]
    if sys.platform != "win32":
        (folder / "link").symlink_to(tmp_path)
        (folder / "to.journal").symlink_to(tmp_path / "x.journal")
        names += ["link/x.nc", "to.nc"]
    for name in names:
        text = SPHERE.replace("[sweep]", f'[sweep]\nstore = "{name}"')
        case.write_text(text)
        assert command("sweep", case) == 2, name
        err = capsys.readouterr().err
        assert "sweep.store: " in err
        assert err.count("\n") == 1
        assert sorted(tmp_path.iterdir()) == [folder]
    table = tmp_path / "x.csv"
    assert command("sweep", case, "--store", outside, "--save", table) == 0  # the command may
    frame = xarray.load_dataset(outside).to_dataframe()
    with table.open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert [float(row["approach"]) for row in rows] == frame["approach"].tolist()
    assert command("sweep", case, "--save", tmp_path / "x.nc") == 2
    table.unlink()
    case.write_text(SPHERE.replace("[sweep]", '[sweep]\nstore = "below/x.nc"'))
    (folder / "below").mkdir()
    assert command("sweep", case) == 0
    assert (folder / "below" / "x.nc").exists()
