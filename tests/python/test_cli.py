"""`nacre` exits with 0 only for converged solutions, and says in one line why it did not."""

from __future__ import annotations

import signal
import subprocess
import sys
from pathlib import Path

import pytest

import nacre
import nacre.cli
from nacre.paper import cases


def run(*arguments: str) -> tuple[int, str, str]:
    """Run ``nacre`` in a process of its own: exit code, stdout, stderr."""
    command = [sys.executable, "-m", "nacre.cli", *arguments]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    return done.returncode, done.stdout, done.stderr


def main(*arguments: str) -> int:
    """Run ``nacre`` in this process: exit code."""
    with pytest.raises(SystemExit) as error:
        nacre.cli.main(arguments)
    assert isinstance(error.value.code, int)
    return error.value.code


def test_help_names_the_commands() -> None:
    code, out, err = run("--help")
    assert (code, err) == (0, "")
    assert [name for name in ("info", "paper", "solve", "sweep") if f" {name} " not in out] == []


def test_version_is_one_line() -> None:
    assert run("--version") == (0, f"nacre {nacre.__version__}\n", "")


def test_info_prints_the_versions(capsys: pytest.CaptureFixture[str]) -> None:
    assert main("info") == 0
    assert nacre.__version__ in capsys.readouterr().out


@pytest.mark.parametrize(
    ("arguments", "names"),
    [
        (["paper", "--threads", "0"], "--threads"),
        (["paper", "--threads", "x"], "--threads"),
        (["paper", "--out", "FILE"], "File exists"),
        (["paper", "--out", "FILE/below"], "Not a directory"),
        (["paper", "--bogus"], "--bogus"),
        (["paper", "extra"], "extra"),
        (["nothing"], "nothing"),
        ([], "command"),
    ],
)
def test_bad_input_is_one_line_and_exit_code_2(
    arguments: list[str], names: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "FILE").touch()
    assert main(*(a.replace("FILE", str(tmp_path / "FILE")) for a in arguments)) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith("nacre: ")
    assert err.count("\n") == 1
    assert names in err


def test_bad_input_leaves_no_traceback_in_a_process() -> None:
    code, out, err = run("paper", "--threads", "0")
    assert (code, out, err.count("\n")) == (2, "", 1)


@pytest.mark.parametrize(("missing", "extra"), [("typer", "cli"), ("rich", "cli")])
def test_a_missing_extra_is_named(missing: str, extra: str) -> None:
    code = (
        f"import sys; sys.modules[{missing!r}] = None; import nacre.cli; nacre.cli.main(['info'])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert done.stderr.count("\n") == 1
    assert f"nacre-contact[{extra}]" in done.stderr


def test_missing_matplotlib_is_named_before_solving(tmp_path: Path) -> None:
    code = (
        "import sys; sys.modules['matplotlib'] = None; import nacre.cli;"
        f"nacre.cli.main(['paper', '--out', {str(tmp_path)!r}])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert "nacre-contact[plot]" in done.stderr
    assert "Traceback" not in done.stderr
    assert list(tmp_path.iterdir()) == []


def test_paper_prints_table_claim_and_reference(tmp_path: Path) -> None:
    code, out, err = run("paper", "--quick", "--out", str(tmp_path))
    assert (code, err) == (0, "")
    assert max(map(len, out.splitlines())) <= 80 + len(str(tmp_path))
    for series in cases.SERIES:
        assert series.title in out
    rows = [line.split() for line in out.splitlines()]
    peaks = [row[1] for row in rows if row[:1] == ["1"] and len(row) == 12]
    assert peaks == ["1468", "823", "986", "823", "986"]  # MPa, E1 = E2
    assert "holds" in out
    assert "Largest deviations" in out
    assert (tmp_path / "table.csv").exists()


def test_a_solve_that_does_not_converge_is_exit_code_1(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    class Contact:
        def __init__(self, *arguments: object, **options: object) -> None: ...

        def solve(self, *arguments: object, **options: object) -> None:
            raise nacre.ConvergenceError("residual 1e-3 after 9 iterations")

    monkeypatch.setattr(nacre, "Contact", Contact)
    assert main("paper", "--out", str(tmp_path)) == 1
    err = capsys.readouterr().err
    assert err.startswith("nacre: ")
    assert "sphere, h = 0.1 mm, E1/E2 = " in err
    assert "residual 1e-3" in err
    assert err.count("\n") == 1
    assert list(tmp_path.iterdir()) == []


@pytest.mark.skipif(sys.platform == "win32", reason="no SIGINT for one process")
def test_interrupt_is_exit_code_130_without_traceback(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "nacre.cli", "paper", "--out", str(tmp_path)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        assert process.stdout is not None
        assert b"rigid" in process.stdout.readline()  # it is about to solve
        process.send_signal(signal.SIGINT)
        _, err = process.communicate(timeout=60)
    assert process.returncode == 130
    assert b"Traceback" not in err
    assert list(tmp_path.iterdir()) == []
