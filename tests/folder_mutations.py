"""Hostile versions of folders of results, whose checksums are right: as another program,
or a person, could write them.
"""

from __future__ import annotations

import json
import random
import sqlite3
from collections.abc import Callable
from contextlib import closing, suppress
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import tomli_w

from mutations import NUMBERS, OTHERS, TEXTS, deep
from vibroimpact.files.check_sums import CHECK_SUMS, SHA256, digest, file_digest

VALUES: tuple[Callable[[], Any], ...] = (
    *(lambda text=text: text for text in TEXTS if "\ud7ff" not in text),
    *(lambda number=number: number for number in NUMBERS),
    *OTHERS,
    lambda: None,
    lambda: deep(300),
)

ATTRIBUTES: tuple[Callable[[], Any], ...] = (
    lambda: "fast", lambda: "", lambda: "\x1b[31m" * 20, lambda: b"\xff\xfe", lambda: np.nan, lambda: np.inf, lambda: -1.0, lambda: 0,
    lambda: 1e308, lambda: [1.0, 2.0], list, lambda: ["a", "b"], lambda: h5py.Empty("f4"), lambda: np.zeros((2, 2)), lambda: 1j,
    lambda: "x " * 3000, lambda: np.zeros(2, dtype=[("x", "f4")]), lambda: 2**63 - 1, lambda: [0, 0], lambda: [np.nan, 1.0],
    lambda: "[sweep]\ndesign = 1", lambda: "a = [" + "[" * 3000,
)  # fmt: skip


def damage_folder(folder: Path, file: str, draw: random.Random) -> None:
    """Change a file of a folder, and put the checksums right."""
    path = folder / file
    if file.endswith(".json"):
        _change_json(path, draw)
    elif file.endswith(".toml"):
        path.write_text(
            tomli_w.dumps({"a": draw.choice(TEXTS[:5]), "sphere": draw.choice((1, {}, [], "x"))})
        )
    elif file.endswith(".sqlite"):
        _change_ledger(path, draw)
    else:
        with h5py.File(path, "a") as content:
            for _ in range(draw.choice((1, 1, 2))):
                draw.choice(_HDF5_CHANGES)(content, draw)
    for summary in folder.glob("*.json"):
        if summary == path:
            continue
        table = json.loads(summary.read_text())
        if file in table.get(CHECK_SUMS, {}):
            table[CHECK_SUMS][file] = file_digest(path)
            table.pop(SHA256)
            summary.write_text(json.dumps({**table, SHA256: digest(table)}))


def _change_json(path: Path, draw: random.Random) -> None:
    table = json.loads(path.read_text())
    table.pop(SHA256, None)
    for _ in range(draw.choice((1, 1, 2))):
        holder, key = draw.choice(places(table))
        if draw.random() < 0.2 and isinstance(holder, dict):
            holder.pop(key, None)
        else:
            holder[key] = draw.choice(VALUES)()
    with suppress(RecursionError, UnicodeEncodeError):
        path.write_text(json.dumps({**table, SHA256: digest(table)}))


def places(table: dict[str, Any]) -> list[tuple[Any, Any]]:
    """Return the places of a table: all of its tables, and the first and last of its lists."""
    found: list[tuple[Any, Any]] = []
    pending: list[Any] = [table]
    while pending and len(found) < 1000:
        holder = pending.pop()
        keys = list(holder)[:50] if isinstance(holder, dict) else [0, -1] if holder else []
        found += [(holder, key) for key in keys]
        pending += [holder[key] for key in keys if isinstance(holder[key], (dict, list))]
    return found


def _change_ledger(path: Path, draw: random.Random) -> None:
    statements = (
        "UPDATE chunk SET sha256 = 5", "UPDATE chunk SET sha256 = NULL", "UPDATE chunk SET first = 'x'", "UPDATE chunk SET count = 1e300",
        "UPDATE chunk SET count = 9223372036854775807", "UPDATE chunk SET state = 'done'", "UPDATE chunk SET state = x'ff'",
        "DELETE FROM study", "DELETE FROM study WHERE key = 'digest'", "UPDATE study SET value = x'fffe'", "UPDATE study SET value = 7",
        "DROP TABLE chunk", "DROP TABLE study", "INSERT INTO chunk (number, first, count) VALUES (99, 99, 1)",
        "ALTER TABLE chunk DROP COLUMN sha256",
        "CREATE TRIGGER t AFTER UPDATE ON chunk BEGIN DELETE FROM chunk; END", "UPDATE chunk SET finished = zeroblob(100000)",
        "DROP TABLE chunk; CREATE VIEW chunk AS WITH RECURSIVE c(number) AS " "(SELECT " "0 " "UNION " "ALL SELECT number + 1 FROM c) "
        "SELECT number, number AS first, 1 AS count, 'waiting' AS state, NULL " "AS " "sha256, 0 " "AS failed, '' AS finished FROM c",
    )  # fmt: skip
    with closing(sqlite3.connect(path)) as connection, connection:
        connection.executescript(draw.choice(statements))


def _members(file: h5py.File) -> list[str]:
    names: list[str] = []
    file.visit(names.append)
    return sorted(names)


def _remove(file: h5py.File, draw: random.Random) -> None:
    if names := _members(file):
        del file[draw.choice(names)]


def _to_group(file: h5py.File, draw: random.Random) -> None:
    if names := _members(file):
        name = draw.choice(names)
        del file[name]
        file.create_group(name)


def _to_link(file: h5py.File, draw: random.Random) -> None:
    names = _members(file)
    name = draw.choice(names) if names else "a"
    targets = (
        h5py.SoftLink("/nothing"), h5py.SoftLink("/"), h5py.SoftLink(f"/{name}"), h5py.ExternalLink("/dev/zero", "/"),
        h5py.ExternalLink("other.nc", "/a"), h5py.ExternalLink("/proc/self/mem", "/"),
    )  # fmt: skip
    if name in file:
        del file[name]
    file[name] = draw.choice(targets)


def _to_value(file: h5py.File, draw: random.Random) -> None:
    names = [name for name in _members(file) if isinstance(file.get(name), h5py.Dataset)]
    if not names:
        return
    name = draw.choice(names)
    old, attributes = file[name], dict(file[name].attrs)
    shape, dtype = old.shape, old.dtype
    values: Any = draw.choice(
        (
            lambda: np.full(shape, np.nan), lambda: np.full(shape, np.inf), lambda: np.full(shape, -1.0), lambda: np.full(shape, 1e300),
            lambda: np.zeros((*shape, 2)), lambda: np.zeros(()), lambda: np.zeros(0), lambda: np.zeros(3), lambda: np.zeros(shape, "S4"),
            lambda: np.zeros(shape, np.complex64), lambda: np.zeros(shape, [("x", "f4")]), lambda: np.zeros(shape, np.int64) - 7,
            lambda: "text", lambda: None, lambda: None,
        )
    )()  # fmt: skip
    del file[name]
    if values is None:  # a shape that the file does not hold
        huge = draw.choice(((10**9,), (10**5, 10**5), (2**40,)))
        file.create_dataset(name, huge, dtype, chunks=tuple(min(size, 1000) for size in huge))
    else:
        file[name] = values
    for key, value in attributes.items():
        if key not in ("DIMENSION_LIST", "REFERENCE_LIST", "CLASS", "NAME"):
            file[name].attrs[key] = value


def _to_attribute(file: h5py.File, draw: random.Random) -> None:
    owners = [file, *(file[name] for name in _members(file) if file.get(name) is not None)]
    owner = draw.choice([one for one in owners if len(one.attrs)] or [file])
    name = draw.choice(sorted(owner.attrs) or ["title"])
    if draw.random() < 0.25:
        owner.attrs.pop(name, None)
    elif name not in ("DIMENSION_LIST", "REFERENCE_LIST"):
        owner.attrs[name] = draw.choice(ATTRIBUTES)()


_HDF5_CHANGES: tuple[Callable[[h5py.File, random.Random], None], ...] = (
    _remove, _to_group, _to_link, _to_value, _to_value, _to_value, _to_attribute, _to_attribute,
)  # fmt: skip
