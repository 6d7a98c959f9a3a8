"""Imports point down only: the order of the house, held by reading every import of every module."""

from __future__ import annotations

import ast
import re
from functools import cache
from pathlib import Path

import vibroimpact

PACKAGE = Path(vibroimpact.__file__).parent

# from the ground up; a module may import its own room and what is below
LAYERS = [
    {"quoting", "_version"},
    {"errors", "arrays"},
    {"ranges", "registry", "resolved_case"},
    {"files"},
    {"compiler"},
    {"compiled"},
    {"units"},
    {"materials"},
    # how anything is shown
    {"charts"},
    {"report"},
    # the physics
    {"contact"},
    {"structures"},
    {"bodies"},
    {"dynamics"},
    {"friction", "sensors"},
    # what comes in, and what came out
    {"meshes", "measurements"},
    {"cases"},
    {"results"},
    {"signals"},
    # what people do, each whole
    {"modes"},
    {"runs"},
    {"law_comparison", "calibration", "studies", "law_sheets", "identification"},
    {"bayes_error", "laws", "test_analysis"},
    {"recognition"},
    {"exporting", "paper"},
    {"regenerate", "figures"},
    {"app"},
    {"cli"},
    {"__main__", "__init__"},
]
LEVEL = {name: level for level, names in enumerate(LAYERS) for name in names}


# a room that people work in may have a section of the case, which is part of the case file and lies
# beside the work that it asks for
SECTIONS = {"vibroimpact.calibration.observed.section", "vibroimpact.studies.planning.section"}


@cache
def statements(path: Path) -> list[ast.Import | ast.ImportFrom]:
    """What a module imports, as it says it."""
    return [
        node
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, (ast.Import, ast.ImportFrom))
    ]


def imports_of(path: Path) -> set[str]:
    found = set()
    for node in statements(path):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        else:
            assert node.level == 0, f"{path}: imports are absolute"
            found.add(node.module or "")
    return {name for name in found if name.split(".")[0] == "vibroimpact"}


def room(name: str) -> str:
    parts = name.split(".")
    return parts[1] if len(parts) > 1 else "__init__"


def test_every_room_has_a_layer() -> None:
    rooms = {
        path.stem if path.is_file() else path.name
        for path in PACKAGE.iterdir()
        if path.suffix == ".py" or (path / "__init__.py").exists()
    }
    assert rooms | {"_version"} == LEVEL.keys()  # which is written as the package is installed


def test_imports_point_down() -> None:
    modules = sorted(PACKAGE.rglob("*.py"))
    assert len(modules) > 40
    for path in modules:
        relative = path.relative_to(PACKAGE).as_posix()
        here = room(f"vibroimpact.{relative.removesuffix('.py').replace('/', '.')}")
        for name in imports_of(path):
            if here == "cases" and name in SECTIONS:
                continue
            there = room(name)
            assert LEVEL[there] < LEVEL[here] or there == here, (
                f"{relative} imports {name}, which lies above it"
            )


def test_modules_do_not_import_in_circles() -> None:
    """Within rooms neither, and not for types alone; the package's front is above all of them."""
    paths = {
        f"vibroimpact.{path.relative_to(PACKAGE).with_suffix('').as_posix().replace('/', '.')}": path
        for path in PACKAGE.rglob("*.py")
    }
    paths = {name.removesuffix(".__init__"): path for name, path in paths.items()}
    below = {
        name: {one for one in modules_of(path) if one in paths} - {name, "vibroimpact"}
        for name, path in paths.items()
    }
    while leaves := {name for name, needs in below.items() if not needs & below.keys()}:
        below = {name: needs for name, needs in below.items() if name not in leaves}
    assert not below, sorted(below)


def test_folders_do_not_import_in_circles() -> None:
    """Of one room neither."""
    folders = {path.parent for path in PACKAGE.rglob("*.py")} - {PACKAGE}
    below: dict[Path, set[Path]] = {folder: set() for folder in folders}
    for path in PACKAGE.rglob("*.py"):
        if path.parent == PACKAGE:
            continue
        for name in imports_of(path) - SECTIONS:
            parts = name.split(".")[1:]
            imported = PACKAGE.joinpath(*parts)
            imported = imported if imported.is_dir() else imported.parent
            below[path.parent] |= {imported} & folders - {path.parent}
    reached = {folder: reachable(folder, below) for folder in folders}
    circles = {
        (folder.relative_to(PACKAGE).parts[0], lower.relative_to(PACKAGE).parts[0])
        for folder in folders
        for lower in reached[folder]
        if folder in reached[lower]
    }
    assert not circles


def reachable(start: Path, below: dict[Path, set[Path]]) -> set[Path]:
    """Return the folders that a folder imports, itself or by others."""
    reached: set[Path] = set()
    following = set(below[start])
    while following:
        folder = following.pop()
        reached.add(folder)
        following |= below[folder] - reached
    return reached


def modules_of(path: Path) -> set[str]:
    """What a module imports: modules, and what may be one in a package or a name in a module."""
    found = imports_of(path)
    for node in statements(path):
        if isinstance(node, ast.ImportFrom):
            found |= {f"{node.module}.{alias.name}" for alias in node.names}
    return found


def test_laws_know_nothing_of_each_other() -> None:
    for path in (PACKAGE / "contact" / "laws").glob("*.py"):
        assert not any(name.startswith("vibroimpact.contact.laws") for name in imports_of(path)), (
            path
        )


def test_the_page_on_architecture_names_files_that_exist() -> None:
    root = Path(__file__).parents[2]
    text = (root / "docs" / "architecture.md").read_text(encoding="utf-8")
    named = set(re.findall(r"`([\w/.]+/|[\w/.]+\.(?:py|j2))`", text))
    assert len(named) > 60
    # of the files of one room the second and third may be named alone
    files = {path.name for path in PACKAGE.rglob("*.*")}
    assert [
        name
        for name in named
        if not ((PACKAGE / name).exists() or (root / name).exists() or name in files)
    ] == []


def test_the_picture_of_the_rooms_has_all_of_them() -> None:
    example = (Path(__file__).parents[2] / "examples" / "rooms.py").read_text(encoding="utf-8")
    rooms = {path.name for path in PACKAGE.iterdir() if (path / "__init__.py").exists()}
    assert {room for room in rooms if f'"{room}": ' not in example} == set()
