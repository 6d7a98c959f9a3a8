"""Read a case from a file, from the shipped library, or from a mapping."""

from __future__ import annotations

import tomllib
from collections.abc import Iterator, Mapping
from importlib.resources import files
from os import PathLike
from pathlib import Path
from typing import Any

from pydantic import BaseModel, ValidationError

from vibroimpact.cases.build import check_case
from vibroimpact.cases.material_field import InlineMaterial
from vibroimpact.cases.schema import Case, DropSection, PlateSection, RunSection, SensorSection, SphereSection
from vibroimpact.errors import InputError, did_you_mean

LARGEST_FILE = 1_000_000
"""Bytes; a case is a page of text, and more is a mistake."""

_SECTIONS: dict[tuple[str, ...], type[BaseModel]] = {
    (): Case,
    ("sphere",): SphereSection,
    ("plate",): PlateSection,
    ("drop",): DropSection,
    ("run",): RunSection,
    ("sensors",): SensorSection,
}


def _section(where: tuple[str, ...]) -> type[BaseModel] | None:
    return _SECTIONS.get(tuple(part for part in where if not part.isdigit()))


def load_case(source: str | PathLike[str]) -> Case:
    """Read a case file, or a shipped case such as "paper:type1-theory".

    Parameters
    ----------
    source : path or str
        A TOML file, or "paper:NAME".

    Raises
    ------
    InputError
        If it can't be read or is not a valid case; the message says where, what, and what is allowed.

    Examples
    --------
    >>> load_case("paper:type1-theory").sphere.radius
    0.025
    """
    name = str(source)
    text = _shipped(name) if name.startswith("paper:") else _file(Path(source))
    try:
        table = tomllib.loads(text)
    except ValueError as error:  # tomllib's own, or a number of thousands of digits
        raise InputError(f"{name}: this is not valid TOML: {error}") from None
    except RecursionError:
        raise InputError(f"{name}: this is not a case: its tables are nested too deeply") from None
    try:
        return read_case(_beside(table, Path(source).parent))
    except InputError as error:
        lines = str(error).splitlines()
        raise InputError("\n".join(f"{name}: {line}" for line in lines)) from None


def read_case(table: Mapping[str, Any]) -> Case:
    """Make a case from a mapping, as a TOML file would hold it.

    Raises
    ------
    InputError
        If it is not a valid case; one line a fault.
    """
    try:
        case = Case.model_validate(dict(table))
        check_case(case)
    except ValidationError as error:
        raise InputError("\n".join(dict.fromkeys(_explain(error)))) from None
    return case


def shipped_cases() -> dict[str, str]:
    """Return the shipped cases: their names as `load_case` takes them, and what they are.

    Examples
    --------
    >>> "paper:type1-theory" in shipped_cases()
    True
    """
    folder = files("vibroimpact").joinpath("cases/library")
    names = sorted(entry.name.removesuffix(".toml") for entry in folder.iterdir() if entry.name.endswith(".toml"))
    return {f"paper:{name}": tomllib.loads(_shipped(f"paper:{name}"))["name"] for name in names}


def _beside(table: dict[str, Any], folder: Path) -> dict[str, Any]:
    """Return a case whose mesh files are found beside it, wherever it is read from."""
    for body in ("sphere", "plate"):
        section = table.get(body)
        mesh = section.get("mesh") if isinstance(section, dict) else None
        file = mesh.get("file") if isinstance(mesh, dict) else mesh
        if isinstance(section, dict) and isinstance(file, str):
            path = str((folder / file).absolute())
            section["mesh"] = {**mesh, "file": path} if isinstance(mesh, dict) else path
    return table


def _shipped(name: str) -> str:
    entry = files("vibroimpact").joinpath("cases/library", name.removeprefix("paper:") + ".toml")
    if "/" in name or "\\" in name or not entry.is_file():
        known = list(shipped_cases())
        raise InputError(f'there is no shipped case "{name}"; there are {", ".join(known)}.{did_you_mean(name, known)}')
    return entry.read_text(encoding="utf-8")


def _file(path: Path) -> str:
    try:
        if path.is_dir():
            raise InputError(f"{path}: this is a directory; a case is a TOML file")
        with path.open("rb") as file:
            data = file.read(LARGEST_FILE + 1)
        if len(data) > LARGEST_FILE:
            raise InputError(f"{path}: the file is larger than {LARGEST_FILE // 1_000_000} MB; a case is a page of text")
        return data.decode("utf-8-sig")  # some editors put a byte-order mark first
    except FileNotFoundError:
        raise InputError(f'{path}: there is no such file; a case is a TOML file, or a shipped one such as "paper:type1-theory"') from None
    except (OSError, ValueError) as error:
        reason = "it is not UTF-8 text" if isinstance(error, UnicodeDecodeError) else getattr(error, "strerror", None) or str(error)
        if isinstance(error, InputError):
            raise
        raise InputError(f"{path}: the file can't be read: {reason}") from None


# from pydantic's errors to sentences -----------------------------------------------------------------


def _explain(error: ValidationError) -> Iterator[str]:
    for fault in error.errors():
        where = tuple(str(part) for part in fault["loc"] if not _is_branch(str(part)))
        path = ".".join(where)
        prefix = f"{path}: " if path else ""
        kind, context = fault["type"], fault.get("ctx", {})
        if kind == "extra_forbidden":
            known = list((_section(where[:-1]) or InlineMaterial).model_fields)
            place = f"[{'.'.join(where[:-1])}]" if where[:-1] else "a case"
            yield f'{path}: unknown key "{where[-1]}"; {place} takes {", ".join(known)}.{did_you_mean(where[-1], known)}'
        elif kind == "missing" and where[-1].isdigit():
            parent = ".".join(where[:-1])
            yield f"{parent}: there are too few values; it takes {_about(where[:-1]).removeprefix(': ')}"
        elif kind == "missing":
            what = "section" if len(where) == 1 else "key"
            yield f"{path}: this {what} is missing{_about(where)}"
        elif kind == "value_error" and isinstance(context.get("error"), ValidationError):
            for line in _explain(context["error"]):
                yield f"{path}.{line}" if path else line
        elif kind == "value_error":
            fault_key = getattr(context["error"], "key", "")
            yield f"{path}.{context['error']}" if path and fault_key else f"{prefix}{context['error']}"
        elif kind == "literal_error":
            yield f"{prefix}{_show(fault['input'])} is not allowed; it must be {context['expected']}"
        elif kind == "string_type":
            yield f"{prefix}{_show(fault['input'])} is not a text; put it in quotes"
        elif kind == "bool_type":
            yield f"{prefix}{_show(fault['input'])} is not allowed; it must be true or false"
        elif kind in ("model_type", "dict_type"):
            yield f"{prefix}{_show(fault['input'])} is not a table"
        elif kind in ("tuple_type", "too_long", "too_short"):
            yield f"{prefix}{_show(fault['input'])} does not have the right number of values; it takes {_about(where).removeprefix(': ')}"
        else:
            yield f"{prefix}{_show(fault['input'])} is not allowed; {fault['msg'][0].lower()}{fault['msg'][1:]}"


def _is_branch(part: str) -> bool:
    """Is this part of a location the name that pydantic gives to one alternative of a union?"""
    return part.startswith(("literal[", "constrained-", "function-", "tuple[", "nullable"))


def _about(where: tuple[str, ...]) -> str:
    section = _section(where[:-1])
    field = section.model_fields.get(where[-1]) if section else None
    text = (field.description or "") if field else ""
    return f": {text}" if text else ""


def _show(value: Any) -> str:
    text = f'"{value}"' if isinstance(value, str) else str(value)
    return text if len(text) <= 60 else text[:57] + "..."
