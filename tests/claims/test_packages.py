"""Numbers of the page on packages."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path

from stated_numbers import says
from vibroimpact.compiler.code_store import LARGEST

PAGE = "docs/packages.md"


def test_compiled_code_is_bounded() -> None:
    says(PAGE, "it takes at most {} MB, of which the least recently used files", 1e-6 * LARGEST)


def test_pythons_without_numba() -> None:
    project = tomllib.loads(
        (Path(__file__).parents[2] / "pyproject.toml").read_text(encoding="utf-8")
    )["project"]
    (condition,) = (line for line in project["dependencies"] if line.startswith("numba"))
    first = re.search(r"python_version < '(.*)'", condition)
    assert first is not None
    says(PAGE, "for Python {} and later it is not installed", float(first.group(1)))
