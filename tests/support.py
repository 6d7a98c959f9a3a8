"""Cases for tests, and what pages and examples compute."""

from __future__ import annotations

import importlib.util
import re
from collections.abc import Callable, Iterable
from functools import cache
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

from vibroimpact.cli import main

ROOT = Path(__file__).parents[1]


THIN_PLATE = {
    "size": ["300 mm", "200 mm", "6 mm"],
    "material": "steel",
    "model": "elastic",
    "modes": 12,
    "damping": 0.02,
    "supports": "clamped",
    "mesh": {"element_size": "50 mm"},
}
"""The plate of a case: a thin elastic one of few elements and modes."""
COARSE_PLATE = {
    "model": "elastic",
    "material": "steel",
    "size": [0.3, 0.2, 0.01],
    "modes": 30,
    "damping": 0.01,
    "supports": "clamped",
    "mesh": {"element_size": 0.05},
}
"""The plate of a case: an elastic one of few elements."""


def plain_case(**changes: object) -> dict:
    """A valid case as a mapping; `section__key=value` changes a key, None removes it."""
    case: dict = {
        "name": "a test",
        "sphere": {"radius": 0.025, "material": "rock-paper"},
        "plate": {"material": "steel-paper"},
        "drop": {"height": 0.5},
        "contact": {"law": "lankarani-nikravesh", "restitution": 0.7},
        "run": {"impacts": 3},
    }
    for path, value in changes.items():
        *parents, key = path.split("__")
        table = case
        for parent in parents:
            table = table.setdefault(parent, {})
        if value is None:
            table.pop(key, None)
        else:
            table[key] = value
    return case


def free_plate(mesh: Path) -> dict[str, Any]:
    """The plate of a case: a free one of steel with the mesh of a file, and two modes."""
    return {
        "material": "steel",
        "model": "elastic",
        "mesh": str(mesh),
        "supports": "free",
        "modes": 2,
    }


def supported_plate(size: Iterable[float], damping: float) -> dict[str, Any]:
    """The plate of a case: an elastic one of steel, simply supported along its edges."""
    return {
        "size": list(size),
        "material": "steel",
        "model": "elastic",
        "supports": "simply-supported",
        "damping": damping,
    }


def run_command(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], *arguments: object
) -> tuple[int, str, str]:
    """Run `vibroimpact`; return its exit status, its output and its errors."""
    monkeypatch.setattr("sys.argv", ["vibroimpact", *map(str, arguments)])
    with pytest.raises(SystemExit) as left:
        main()
    return int(left.value.code or 0), *capsys.readouterr()


def outcome(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], *arguments: str
) -> tuple[int, str]:
    """Run `vibroimpact`; return its exit status and all that it wrote, in one line."""
    status, output, errors = run_command(monkeypatch, capsys, *arguments)
    return status, " ".join((output + errors).split())


def one_in(every: int, values: Iterable[Any], name: Callable[[Any], str] = str) -> list[Any]:
    """Parameters of a test, of which one in so many is tried each time, and the others
    where there is time for the slow ones.
    """
    several = [value if isinstance(value, tuple) else (value,) for value in values]
    return [
        pytest.param(*value, id=name(value[0]), marks=pytest.mark.slow if place % every else ())
        for place, value in enumerate(several)
    ]


def example(name: str) -> ModuleType:
    """A program of `examples`, as a module."""
    return module_at(f"examples/{name}.py")


@cache
def module_at(place: str) -> ModuleType:
    """A Python file of the project, as a module."""
    found = importlib.util.spec_from_file_location(Path(place).stem, ROOT / place)
    assert found is not None
    assert found.loader is not None
    module = importlib.util.module_from_spec(found)
    found.loader.exec_module(module)
    return module


def blocks(page: str, language: str) -> list[str]:
    """The blocks of a page in a language."""
    return re.findall(
        rf"```{language}\n(.*?)```", (ROOT / page).read_text(encoding="utf-8"), flags=re.S
    )


@cache
def names_of_page(page: str) -> dict[str, Any]:
    """What the names in the Python programs of a page stand for, after they have run."""
    names: dict[str, Any] = {}
    for block in blocks(page, "python"):
        exec(compile(block, page, "exec"), names)
    return names
