"""What packages say is what the project says: versions, dependencies, files."""

from __future__ import annotations

import json
import re
import tomllib
from pathlib import Path

ROOT = Path(__file__).parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
RECIPE = (ROOT / "packaging" / "conda" / "recipe.yaml").read_text(encoding="utf-8")
NAMES = {"matplotlib-base": "matplotlib"}
"""Conda packages whose names differ."""


def test_versions_are_one() -> None:
    version = PROJECT["project"]["version"]
    (recipe,) = re.findall(r'^  version: "(.+)"$', RECIPE, re.MULTILINE)
    (citation,) = re.findall(
        r"^version: (.+)$", (ROOT / "CITATION.cff").read_text(encoding="utf-8"), re.MULTILINE
    )
    assert recipe == citation == version
    for name in ("codemeta.json", ".zenodo.json"):
        assert json.loads((ROOT / name).read_text(encoding="utf-8"))["version"] == version


def test_the_recipe_needs_what_the_project_needs() -> None:
    run = RECIPE.split("  run:\n")[1].split("\n\n")[0]
    needed = {NAMES.get(name, name): least for name, least in re.findall(r"- (\S+) >=(\S+)", run)}
    assert needed.pop("python") == PROJECT["project"]["requires-python"].removeprefix(">=")
    assert needed == dict(
        one.partition(";")[0].split(">=") for one in PROJECT["project"]["dependencies"]
    )


def test_groups_and_extras_allow_the_same_versions() -> None:
    """A package that several lists name has one lowest version, so that the one that is
    tested is the one that is allowed.
    """
    lists = [
        PROJECT["project"]["dependencies"],
        *PROJECT["project"]["optional-dependencies"].values(),
        *PROJECT["dependency-groups"].values(),
    ]
    least: dict[str, str] = {}
    for one in (one for some in lists for one in some if isinstance(one, str)):
        name, version = one.partition(";")[0].split(">=", 1)
        assert least.setdefault(name, version) == version, name


def test_the_sdist_has_what_the_makefile_and_the_tests_need() -> None:
    included = set(PROJECT["tool"]["hatch"]["build"]["targets"]["sdist"]["include"])
    beside = {path.name for path in ROOT.iterdir() if not path.name.startswith(".")} - {
        "build",
        "dist",
        "site",
        "LICENSE",
        "pyproject.toml",
    }
    assert included <= beside
    assert {
        "src",
        "tests",
        "examples",
        "benchmarks",
        "docs",
        "packaging",
        "conftest.py",
        "Makefile",
    } <= included
