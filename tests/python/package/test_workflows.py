"""Workflows and other files in YAML parse, and name what exists; actions are pinned."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path
from typing import Any

import pytest
import yaml

from support import ROOT

WORKFLOWS = sorted((ROOT / ".github" / "workflows").glob("*.yml"))
OTHERS = [
    ROOT / ".github" / "dependabot.yml",
    ROOT / ".pre-commit-config.yaml",
    ROOT / "CITATION.cff",
    ROOT / "packaging" / "conda-forge" / "recipe.yaml",
    ROOT / "tests" / "data" / "benchmark" / "CITATION.cff",
]
ACTION = re.compile(r"[\w-]+/[\w-]+@[0-9a-f]{40}")


def read(path: Path) -> Any:
    return yaml.safe_load(path.read_text(encoding="utf-8"))


@pytest.mark.parametrize("path", WORKFLOWS, ids=lambda path: path.stem)
def test_a_workflow_says_what_it_may_and_pins_its_actions(path: Path) -> None:
    content = read(path)
    assert content["name"] == path.stem
    assert content["permissions"] == {"contents": "read"}
    assert "concurrency" in content
    for name, job in content["jobs"].items():
        if called := job.get("uses"):
            assert (ROOT / called.removeprefix("$/")).is_file(), name
            continue
        assert "runs-on" in job, name
        needs = job.get("needs", [])
        assert set([needs] if isinstance(needs, str) else needs) <= set(content["jobs"]), name
        for step in job["steps"]:
            assert len({"uses", "run"} & set(step)) == 1, (name, step)
            if "uses" in step:
                assert ACTION.fullmatch(step["uses"]), (name, step["uses"])
    # With the version beside each hash, for people and for Dependabot.
    lines = [line for line in path.read_text("utf-8").splitlines() if re.search(r"uses: \w", line)]
    assert [line for line in lines if not re.search(r"@[0-9a-f]{40} # v\d+\.\d+\.\d+$", line)] == []


RUST = "rustup toolchain install 1.95.0 && rustup default 1.95.0"
BUILDS = re.compile(r"\b(?:cargo|maturin|make|cibuildwheel|sphinx-build)\b|\.ci/run")


@pytest.mark.parametrize("path", WORKFLOWS, ids=lambda path: path.stem)
def test_rust_and_its_tools_have_versions(path: Path) -> None:
    """The newest Rust is where all is the newest; the oldest, where the crate's own is named."""
    for name, job in read(path)["jobs"].items():
        ready = (path.stem, name) in {("weekly", "newest"), ("tests", "least")}
        for step in job.get("steps", []):
            run = step.get("run", "")
            ready |= run == RUST
            assert ready or not BUILDS.search(run), (name, run)
            assert "rustup update" not in run or (path.stem, name) == ("weekly", "newest")
            assert re.findall(r"cargo install (?!--locked [\w-]+@\d+\.\d+\.\d+$)", run, re.M) == []
            assert re.findall(r"cargo publish(?! --locked)", run) == []
            if "maturin-action" in step.get("uses", ""):
                assert step["with"]["rust-toolchain"] == RUST.split()[-1]
    assert "cargo publish --locked" in (ROOT / "Makefile").read_text(encoding="utf-8")


def test_wheels_are_looked_into_before_they_are_uploaded() -> None:
    jobs = read(ROOT / ".github" / "workflows" / "wheels.yml")["jobs"]
    for name in ("wheel", "threaded"):
        runs = [step.get("run", step.get("uses")) for step in jobs[name]["steps"]]
        looked = runs.index("python tests/wheel.py dist/*.whl")
        (uploaded,) = (k for k, run in enumerate(runs) if "upload-artifact" in run)
        assert looked < uploaded
        # Wheels of Linux are built in containers, by root.
        assert "--remap-path-prefix=/root/.cargo=cargo" in jobs[name]["env"]["RUSTFLAGS"].split()


@pytest.mark.parametrize("path", OTHERS, ids=lambda path: f"{path.parent.name}-{path.stem}")
def test_other_files_parse(path: Path) -> None:
    assert isinstance(read(path), dict)


def test_what_nobody_has_seen_run_is_not_published() -> None:
    jobs = read(ROOT / ".github" / "workflows" / "wheels.yml")["jobs"]
    assert jobs["browser"]["continue-on-error"] is True
    assert not any("upload-artifact" in step.get("uses", "") for step in jobs["browser"]["steps"])
    assert "job `browser`" in (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")


def test_wheels_are_published_with_attestations_after_all_tests() -> None:
    jobs = read(ROOT / ".github" / "workflows" / "release.yml")["jobs"]
    assert set(jobs["pypi"]["needs"]) == {"tests", "wheels", "compatible"}
    (publish,) = (step for step in jobs["pypi"]["steps"] if "pypi-publish" in step["uses"])
    assert publish["with"]["attestations"] is True
    assert jobs["pypi"]["permissions"] == {"id-token": "write"}


def test_the_oldest_python_and_numpy_are_tested() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    rows = read(ROOT / ".github/workflows/tests.yml")["jobs"]["pythons"]["strategy"]["matrix"]
    pythons = [row["python"] for row in rows["include"]]
    assert pythons == ["3.11", "3.12", "3.13", "3.14", "3.15"]
    assert project["requires-python"] == f">={pythons[0]}"
    assert project["dependencies"] == ["numpy>=2"]
    assert rows["include"][0]["libraries"] == "numpy==2.0.*"


def test_the_recipe_of_conda_forge_has_what_the_distribution_needs() -> None:
    recipe = read(ROOT / "packaging" / "conda-forge" / "recipe.yaml")
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    extras = project["optional-dependencies"]
    changes = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    released = re.findall(r"^## \[(\d[^\]]*)\]", changes, flags=re.MULTILINE)
    assert recipe["context"]["version"] == released[0]
    run = {line.replace(" ", "") for line in recipe["requirements"]["run"]}
    assert {*project["dependencies"], *extras["cli"][1:]} <= run
    assert run - {"python"} <= {*project["dependencies"], *extras["cli"], *extras["files"]}
    host = {line.replace(" ", "") for line in recipe["requirements"]["host"]}
    assert any(line.startswith("maturin") for line in host)
