"""Reading of cases: from a TOML file, from the shipped library, or from a mapping."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Callable, Mapping
from functools import cache
from importlib.resources import files
from os import PathLike
from pathlib import Path
from typing import Any, TypeVar

from pydantic import ValidationError

from vibroimpact.cases.build import check_case
from vibroimpact.cases.case import Case
from vibroimpact.cases.fields.fault_messages import fault_messages
from vibroimpact.cases.fields.item_labels import path_in_words
from vibroimpact.cases.fields.size_limits import MOST_BYTES, check_bounds, check_text
from vibroimpact.cases.keys import with_values
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
        Other values by dotted key, such as ``{"plate.size.thickness": "10 mm"}``.

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
        if "calibrate" in table and "contact" in str(error) and "missing" in str(error):
            raise _with_hint(
                error, "for `vibroimpact calibrate` what it tunes may be left out"
            ) from None
        if "sweep" in table and "missing" in str(error):
            raise _with_hint(
                error, "for `vibroimpact sweep` what it sweeps may be left out"
            ) from None
        raise


def _with_hint(error: InputError, hint: str) -> InputError:
    return InputError.of_several([*error.faults[:-1], f"{error.faults[-1]}; {hint}"])


def load_table(
    source: str | PathLike[str], changes: Mapping[str, Any] | None = None
) -> dict[str, Any]:
    """Return the parsed, not yet validated table of a case file or a shipped case; paths are made
    absolute, relative to the file.

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
    table = with_values(table, changes, "set")
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
    return (
        _shipped(str(source))
        if str(source).partition(":")[0] in GROUPS
        else read_text(Path(source), _CASE)
    )


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
    """Return the likely cause of a TOML syntax error, as a hint to be added to the
    message; "" if not known.
    """
    place = re.search(r"at line (\d+)", fault)
    line = text.split("\n")[int(place[1]) - 1] if place else ""
    if re.match(r"[^=]{1,100}=\s*[+-]?[\d.]+(?:[eE][+-]?\d+)?\s*[^\W\d_][^\"']*$", line):
        return '; a number with a unit is a text: write it in quotes, such as "25 mm"'
    if "overwrite" in fault or "twice" in fault:
        again = re.match(r"\s*\[\s*(sensors|plate\.supports)\s*\]", line)
        return (
            f"; write [[{again[1]}]] above each table of a list"
            if again
            else "; a key or a table stands there twice"
        )
    return (
        "; close the quotes on the line where they are opened"
        if "Illegal character '\\n'" in fault
        else ""
    )


def prefix_errors(source: str | PathLike[str], read: Callable[[], Read]) -> Read:
    """Return the result of `read`, with the source prefixed to each line of an
    `InputError` that it raises.
    """
    try:
        return read()
    except InputError as error:
        place = shortened(str(source), 160)
        raise InputError.of_several(f"{place}: {fault}" for fault in error.faults) from None


def read_case(table: Mapping[str, Any]) -> Case:
    """Return the case of a mapping with the structure of a case file.

    Raises
    ------
    InputError
        If it is not a valid case; one line per fault.

    Examples
    --------
    >>> case = read_case(
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
        faults = fault_messages(error, Case, of_case=True)
        raise InputError.of_several(
            f"{shortened(path_in_words(path, table), 160)}: {message}" if path else message
            for path, message in faults
        ) from None
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
    """Make the file paths of a case absolute, in place, relative to the folder of the
    case file; return the case.
    """
    for body in ("sphere", "plate"):
        section = table.get(body)
        mesh = section.get("mesh") if isinstance(section, dict) else None
        file = mesh.get("file") if isinstance(mesh, dict) else mesh
        if isinstance(section, dict) and isinstance(file, str) and file.strip():
            path = str((folder / file).absolute())
            section["mesh"] = {**mesh, "file": path} if isinstance(mesh, dict) else path
    plate = table.get("plate")
    motion = plate.get("motion") if isinstance(plate, dict) else None
    if isinstance(motion, dict) and isinstance(motion.get("file"), str) and motion["file"].strip():
        motion["file"] = str((folder / motion["file"]).absolute())
    wanted = table.get("calibrate")
    target = wanted.get("target") if isinstance(wanted, dict) else None
    file = target.get("file") if isinstance(target, dict) else target
    if isinstance(wanted, dict) and isinstance(file, str) and file.strip():
        wanted["target"] = {"file": str((folder / file).absolute())}
    _resolve_sweep_paths(table.get("sweep"), folder)
    return table


def _resolve_sweep_paths(inside: Any, folder: Path) -> None:
    """Make the file paths of a [sweep] section absolute, in place, at any depth."""
    for value in inside.values() if isinstance(inside, dict) else ():
        if isinstance(value, dict) and isinstance(value.get("file"), str) and value["file"].strip():
            value["file"] = str((folder / value["file"]).absolute())
        _resolve_sweep_paths(value, folder)


@cache
def _names() -> list[str]:
    """Return the names of the shipped cases."""
    folder = files("vibroimpact").joinpath("cases/library")
    found = [
        (group, entry.name)
        for group in GROUPS
        for entry in folder.joinpath(group).iterdir()
        if entry.name.endswith(".toml")
    ]
    return sorted(f"{group}:{name.removesuffix('.toml')}" for group, name in found)


def _shipped(name: str) -> str:
    """Return the text of a shipped case."""
    if name not in (known := _names()):
        raise InputError(
            f"there is no shipped case {quoted(name)}; there are {choices(known, name, 'cases')}"
        )
    return (
        files("vibroimpact")
        .joinpath("cases/library", *f"{name}.toml".split(":"))
        .read_text(encoding="utf-8")
    )
