"""An extra exists when something imports it: in the package, or in an example of the documents."""

from __future__ import annotations

import ast
import re
import sys
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
EXTRAS: dict[str, list[str]] = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))[
    "project"
]["optional-dependencies"]
_IMPORTED_AS = {"dask": "distributed", "scikit-learn": "sklearn"}  # of dask the scheduler is used

_PACKAGE_OF = {
    "pydantic_core": "pydantic",
    "PIL": "pillow",
    "sklearn": "scikit-learn",
    "distributed": "dask",
    "skfem": "scikit-fem",
    "tomli_w": "tomli-w",
    "markdown_it": "markdown-it-py",
    "mpl_toolkits": "matplotlib",
    "lazy_loader": "lazy-loader",
}


@pytest.mark.parametrize("extra", EXTRAS)
def test_an_extra_is_imported_by_something(extra: str) -> None:
    files = [*(ROOT / "src").rglob("*.py"), *(ROOT / "docs").glob("*.md")]
    text = "\n".join(file.read_text(encoding="utf-8") for file in files)
    name = re.split(r"[\[<>=~]", EXTRAS[extra][0])[0]
    assert re.search(rf"^\s*(?:import|from) {_IMPORTED_AS.get(name, name)}\b", text, re.M)


def test_no_text_names_an_extra_that_is_not_there() -> None:
    files = [*(ROOT / "src").rglob("*.py"), *(ROOT / "docs").glob("*.md"), ROOT / "README.md"]
    named = {
        extra
        for file in files
        for extra in re.findall(r"vibroimpact\[(\w+)\]", file.read_text(encoding="utf-8"))
    }
    assert named <= EXTRAS.keys()


def test_every_library_that_is_imported_is_declared() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    named = [*project["dependencies"], *(name for extra in EXTRAS.values() for name in extra)]
    packages = {re.split(r"[\[<>=~]", name)[0].lower() for name in named}
    imported: set[str] = set()
    for file in (ROOT / "src").rglob("*.py"):
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Import):
                imported |= {alias.name.split(".")[0] for alias in node.names}
            elif isinstance(node, ast.ImportFrom) and node.module:
                imported.add(node.module.split(".")[0])
    imported -= {*sys.stdlib_module_names, "vibroimpact"}
    assert {_PACKAGE_OF.get(name, name) for name in imported} <= packages
