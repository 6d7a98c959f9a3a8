"""Imports point down only: the order of the house, held by reading every import of every module."""

from __future__ import annotations

import ast
from pathlib import Path

import vibroimpact

PACKAGE = Path(vibroimpact.__file__).parent

# from the ground up; a module may import its own layer's package and what is below
LAYERS = [
    {"shown", "_version"},
    {"errors"},
    {"ranges", "registry", "writing", "files", "unit_grammar"},
    {"units", "materials", "quantity"},
    {"contact"},
    {"structures"},
    {"bodies"},
    {"dynamics"},
    {"calibration", "signals", "studies"},
    {"exchange"},
    {"cases"},
    {"storage"},
    {"reproduction"},
    {"report", "doctor"},
    {"cli", "app"},
    {"__main__", "__init__"},
]
LEVEL = {name: level for level, names in enumerate(LAYERS) for name in names}

# response.save(...) asks the package's front, which knows the writers: the one door upwards
DOORS = {("dynamics/response.py", "vibroimpact")}


def imports_of(path: Path) -> set[str]:
    found = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path}: imports are absolute"
            found.add(node.module or "")
    return {name for name in found if name.split(".")[0] == "vibroimpact"}


def room(name: str) -> str:
    parts = name.split(".")
    return parts[1] if len(parts) > 1 else "__init__"


def test_every_room_has_a_layer() -> None:
    rooms = {
        path.stem if path.is_file() else path.name for path in PACKAGE.iterdir() if path.suffix == ".py" or (path / "__init__.py").exists()
    }
    assert rooms <= LEVEL.keys()


def test_imports_point_down() -> None:
    modules = sorted(PACKAGE.rglob("*.py"))
    assert len(modules) > 40
    doors = set()
    for path in modules:
        relative = path.relative_to(PACKAGE).as_posix()
        here = room(f"vibroimpact.{relative.removesuffix('.py').replace('/', '.')}")
        for name in imports_of(path):
            if (relative, name) in DOORS:
                doors.add((relative, name))
                continue
            there = room(name)
            assert LEVEL[there] < LEVEL[here] or there == here, f"{relative} imports {name}, which lies above it"
    assert doors == DOORS, "a door that is no longer used"


def test_laws_know_nothing_of_each_other() -> None:
    for path in (PACKAGE / "contact" / "laws").glob("*.py"):
        assert not any(name.startswith("vibroimpact.contact.laws") for name in imports_of(path)), path


def test_files_hold_one_idea() -> None:
    lengths = {path: len(path.read_text(encoding="utf-8").splitlines()) for path in PACKAGE.rglob("*.py")}
    median = sorted(lengths.values())[len(lengths) // 2]
    assert median < 150
    assert max(lengths.values()) <= 420, max(lengths, key=lengths.__getitem__)
