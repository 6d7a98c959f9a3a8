"""Reading of cases: from a TOML file, from the shipped library, or from a mapping."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Callable, Mapping
from functools import cache
from importlib.resources import files
from os import PathLike
from pathlib import Path
from typing import Any, TypeGuard, TypeVar

from pydantic import ValidationError

from vibroimpact.cases.build import check_case
from vibroimpact.cases.case import Case
from vibroimpact.cases.fields.fault_messages import fault_messages
from vibroimpact.cases.fields.item_labels import path_in_words
from vibroimpact.cases.fields.size_limits import MOST_BYTES, check_bounds, check_text
from vibroimpact.cases.sections.keys import with_values
from vibroimpact.cases.sections.left_out import applicable
from vibroimpact.errors import InputError, choices
from vibroimpact.files.reading import FileKind, read_text
from vibroimpact.quoting import quoted, shortened

Read = TypeVar("Read")

GROUPS = ("paper", "signals")
"""Groups of shipped cases: of the paper, and of data sets; a name is "GROUP:NAME"."""

_CASE = FileKind(
    'a case is a TOML file, or a shipped one such as "paper:type1-theory"',
    MOST_BYTES,
    "a case is a page of text",
)


def load_case(source: str | PathLike[str], changes: Mapping[str, Any] | None = None) -> Case:
    """Return the case of a TOML file, or a shipped case such as "paper:type1-theory".

    Parameters
    ----------
    source : path or str
        A TOML file, or "paper:NAME".
    changes : mapping, optional
        Other values by dotted key, such as ``{"plate.size.thickness": "10 mm"}``. Keys of the file
        that do not apply with another contact law, or with a body that becomes rigid, are left out,
        with a `LeftOutWarning`.

    Raises
    ------
    InputError
        If it can't be read or is not a valid case; the message says where, what, and what is
        allowed.

    Examples
    --------
    >>> load_case("paper:type1-theory").sphere.radius
    0.025
    >>> load_case("paper:type1-theory", {"sphere.radius": "30 mm"}).sphere.radius
    0.03
    """
    return prefix_errors(source, lambda: _read_to_run(load_table(source, changes)))


def _read_to_run(table: dict[str, Any]) -> Case:
    """Return the case, with a hint if it lacks keys that `calibrate` or `sweep` would supply."""
    try:
        return _case_of(table)
    except InputError as error:
        is_missing = "missing" in str(error)
        if is_missing and "calibrate" in table and "contact" in str(error):
            hint = "for `vibroimpact calibrate` what it tunes may be left out"
        elif is_missing and "sweep" in table:
            hint = "for `vibroimpact sweep` what it sweeps may be left out"
        else:
            raise
        raise _with_hint(error, hint) from None


def _with_hint(error: InputError, hint: str) -> InputError:
    """Return an error with a hint after its last fault."""
    return InputError.of_several([*error.faults[:-1], f"{error.faults[-1]}; {hint}"])


def load_table(
    source: str | PathLike[str], changes: Mapping[str, Any] | None = None
) -> dict[str, Any]:
    """Return the parsed, not yet validated table of a case file or a shipped case.

    Paths in it are made absolute; they are relative to the file.

    Parameters
    ----------
    source : path or str
        A TOML file, or "paper:NAME".
    changes : mapping, optional
        Other values by dotted key.

    Raises
    ------
    InputError
        If it can't be read or is not TOML; the message does not name the source.
    """
    table = _resolve_paths(parse_case(case_text(source)), Path(source).parent)
    if not changes:
        return table
    table = with_values(applicable(table, changes), changes, "set")
    check_bounds(table)
    # files in the changes are relative to the working directory
    return _resolve_paths(table, Path())


def case_text(source: str | PathLike[str]) -> str:
    """Return the text of a case file or a shipped case.

    Raises
    ------
    InputError
        If it can't be read, or is too large for a case; the message does not name the source.
    """
    if str(source).partition(":")[0] in GROUPS:
        return _shipped(str(source))
    return read_text(Path(source), _CASE)


def parse_case(text: str) -> dict[str, Any]:
    """Return the parsed, not yet validated table of the text of a case.

    Raises
    ------
    InputError
        If it is not TOML, or too large for a case.

    Examples
    --------
    >>> parse_case('sphere = { radius = "25 mm" }')
    {'sphere': {'radius': '25 mm'}}
    """
    check_text(text)
    try:
        table = tomllib.loads(text)
    except ValueError as error:  # a TOML syntax error, or an integer of too many digits
        raise InputError(f"this is not valid TOML: {error}{_toml_hint(text, str(error))}") from None
    except RecursionError:
        raise InputError("this is not a case: its tables are nested too deeply") from None
    check_bounds(table)
    return table


def _toml_hint(text: str, fault: str) -> str:
    """Return the likely cause of a TOML syntax error, to be added to the message; "" if unknown."""
    position = re.search(r"at line (\d+)", fault)
    line = ""
    if position:
        line = text.split("\n")[int(position[1]) - 1]
    if re.match(r"[^=]{1,100}=\s*[+-]?[\d.]+(?:[eE][+-]?\d+)?\s*[^\W\d_][^\"']*$", line):
        return '; a number with a unit is a text: write it in quotes, such as "25 mm"'
    if "overwrite" in fault or "twice" in fault:
        header = re.match(r"\s*\[\s*(sensors|plate\.supports)\s*\]", line)
        if header:
            return f"; write [[{header[1]}]] above each table of a list"
        return "; a key or a table stands there twice"
    if "Illegal character '\\n'" in fault:
        return "; close the quotes on the line where they are opened"
    return ""


def prefix_errors(source: str | PathLike[str], read: Callable[[], Read]) -> Read:
    """Return the result of `read`; errors have the source before each line.

    These are `InputError`s that it raises.
    """
    try:
        return read()
    except InputError as error:
        name = shortened(str(source), 160)
        raise InputError.of_several(f"{name}: {fault}" for fault in error.faults) from None


def case_of(table: Mapping[str, Any]) -> Case:
    """Return a case from a dictionary with the structure of a case file.

    Raises
    ------
    InputError
        If it is not a valid case; one line per fault.

    Examples
    --------
    >>> case = case_of(
    ...     {
    ...         "sphere": {"radius": "25 mm", "material": "granite"},
    ...         "plate": {"material": "rigid"},
    ...         "drop": {"speed": 1.0},
    ...         "contact": {"law": "hertz"},
    ...     }
    ... )
    >>> case.sphere.radius
    0.025
    """
    check_bounds(table)
    return _case_of(table)


def _case_of(table: Mapping[str, Any]) -> Case:
    """Return the case of a mapping whose size has been checked."""
    try:
        case = Case.model_validate(dict(table))
        check_case(case)
    except ValidationError as error:
        faults = []
        for path, message in fault_messages(error, Case, of_case=True):
            if path:
                message = f"{shortened(path_in_words(path, table), 160)}: {message}"
            faults.append(message)
        raise InputError.of_several(faults) from None
    return case


def shipped_cases() -> dict[str, str]:
    """Return the titles of the shipped cases by their names, which `load_case` accepts.

    Examples
    --------
    >>> "paper:type1-theory" in shipped_cases()
    True
    """
    return {name: tomllib.loads(_shipped(name))["name"] for name in _names()}


def _resolve_paths(table: dict[str, Any], folder: Path) -> dict[str, Any]:
    """Make the file paths of a case absolute, in place, and return the case.

    They are relative to the folder of the case file.
    """
    sphere = table.get("sphere")
    plate = table.get("plate")
    for body in (sphere, plate):
        if isinstance(body, dict):
            _resolve_mesh_path(body, folder)
    motion = plate.get("motion") if isinstance(plate, dict) else None
    if isinstance(motion, dict) and _is_path(motion.get("file")):
        motion["file"] = _absolute(motion["file"], folder)
    calibrate = table.get("calibrate")
    if isinstance(calibrate, dict):
        target = calibrate.get("target")
        if _is_path(target):
            calibrate["target"] = {"file": _absolute(target, folder)}
        elif isinstance(target, dict) and _is_path(target.get("file")):
            target["file"] = _absolute(target["file"], folder)
    _resolve_sweep_paths(table.get("sweep"), folder)
    return table


def _resolve_mesh_path(body: dict[str, Any], folder: Path) -> None:
    """Make the file path of the mesh of a body absolute: a text, or one in a table."""
    mesh = body.get("mesh")
    if _is_path(mesh):
        body["mesh"] = _absolute(mesh, folder)
    elif isinstance(mesh, dict) and _is_path(mesh.get("file")):
        body["mesh"] = {**mesh, "file": _absolute(mesh["file"], folder)}


def _resolve_sweep_paths(section: Any, folder: Path) -> None:
    """Make the file paths of a [sweep] section absolute, in place, at any depth."""
    if not isinstance(section, dict):
        return
    for inner in section.values():
        if isinstance(inner, dict) and _is_path(inner.get("file")):
            inner["file"] = _absolute(inner["file"], folder)
        _resolve_sweep_paths(inner, folder)


def _is_path(value: object) -> TypeGuard[str]:
    return isinstance(value, str) and bool(value.strip())


def _absolute(file: str, folder: Path) -> str:
    return str((folder / file).absolute())


@cache
def _names() -> list[str]:
    """Return the names of the shipped cases."""
    folder = files("vibroimpact").joinpath("cases/library")
    names = [
        f"{group}:{entry.name.removesuffix('.toml')}"
        for group in GROUPS
        for entry in folder.joinpath(group).iterdir()
        if entry.name.endswith(".toml")
    ]
    return sorted(names)


def _shipped(name: str) -> str:
    """Return the text of a shipped case.

    Raises
    ------
    InputError
        If there is no such case.
    """
    names = _names()
    if name not in names:
        raise InputError(
            f"there is no shipped case {quoted(name)}; there are {choices(names, name, 'cases')}"
        )
    group, _, stem = name.partition(":")
    folder = files("vibroimpact").joinpath("cases/library", group)
    return folder.joinpath(f"{stem}.toml").read_text(encoding="utf-8")
