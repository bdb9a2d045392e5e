"""nacre needs NumPy alone, to be imported and to solve."""

import subprocess
import sys
from importlib.metadata import version

import pytest

import nacre

SCRIPT = """
import sys
before = set(sys.modules)
import nacre
steel = nacre.Elastic(young=210e9, poisson=0.3)
nacre.solve(nacre.Sphere(5e-3), steel, load=10.0).pressure
print(*sorted(set(sys.modules) - before))
"""


def imported(script: str = SCRIPT) -> list[str]:
    run = subprocess.run(
        [sys.executable, "-W", "error", "-c", script], capture_output=True, text=True, check=True
    )
    return run.stdout.split()


def test_what_stands_behind_names_and_commands_is_imported_when_it_is_used() -> None:
    heavy = {"numpy", "pydantic", "typer", "xarray", "matplotlib", "nacre.contact", "nacre.cards"}
    assert heavy & set(imported("import sys, nacre; print(*sys.modules)")) == set()
    script = "import sys, atexit; atexit.register(lambda: print(*sys.modules)); sys.argv[1:] = {}\n"
    run = "from nacre.cli import main; main()"
    for arguments in (["--help"], ["new"], ["new", "bearing"], ["solve", "--help"]):
        modules = imported(script.format(arguments) + run)
        assert "typer" in modules
        assert (heavy - {"typer", "pydantic"} | {"nacre.case.file"}) & set(modules) == set()


def test_nothing_but_numpy_is_imported() -> None:
    modules = imported()
    packages = {name.partition(".")[0] for name in modules}
    assert packages >= {"nacre", "numpy"}
    # Compiled modules of NumPy register helpers without a package.
    others = packages - sys.stdlib_module_names - {"nacre", "numpy", "cython_runtime"}
    assert {name for name in others if not name.startswith("_")} == set()


def test_the_parts_that_plot_and_talk_wait_until_they_are_used() -> None:
    later = {"plot", "case", "design", "surfaces.instruments"}
    assert {f"nacre.{name}" for name in later} & set(imported()) == set()


@pytest.mark.slow
def test_modules_are_attributes_that_are_imported_when_they_are_used() -> None:
    script = SCRIPT.replace("nacre.solve", "nacre.design.coating_chart; nacre.solve")
    assert "nacre.design" in imported(script)
    script = "import nacre; print(nacre.plot.curve.__module__, nacre.case.Case.__module__)"
    assert imported(script) == ["nacre.plot.studies", "nacre.case"]
    assert {"case", "design", "plot", "solve", "types"} <= set(dir(nacre))
    assert set(dir(nacre)).isdisjoint({"Any", "TYPE_CHECKING", "import_module"})
    shapes = {shape.__name__ for shape in nacre.types.Shape.__subclasses__()}
    assert len({*nacre.__all__} - {"__version__"} - shapes) <= 28
    with pytest.raises(AttributeError, match="module 'nacre' has no attribute 'plots'"):
        _ = nacre.plots  # type: ignore[attr-defined]


def test_printing_a_solution_needs_nothing_else() -> None:
    script = SCRIPT.replace(".pressure", ".__str__()")
    assert {name.partition(".")[0] for name in imported(script)} & {"matplotlib", "xarray"} == set()


def test_the_version_is_that_of_the_package() -> None:
    assert nacre.__version__ == version("nacre-contact")
