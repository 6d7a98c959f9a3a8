"""A store of modal models and static compliances on disk, under the key of all that determines them: nothing is computed twice."""

from __future__ import annotations

import dataclasses
import hashlib
import json
import math
import os
import zlib
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from vibroimpact._version import __version__
from vibroimpact.errors import InputError
from vibroimpact.files.atomic_write import write_file
from vibroimpact.files.recover import clear
from vibroimpact.structures.geometry import MassProperties
from vibroimpact.structures.mesh import ElementBlock, Mesh
from vibroimpact.structures.modal_model import ModalModel

FORMAT = 3
"""Counts up when what is stored, or how it is computed, changes."""

PLACE = "VIBROIMPACT_STORE"
"""The environment variable that moves the store."""

_LARGEST = 4_000_000_000  # bytes; the entries that were not used for longest go first
_SLACK = 0.01  # of that: so much is written before the folder is looked through again, as it may have thousands of entries
_MODES = "modes"
KINDS = (_MODES, "compliance")
"""What entries hold, and how their names end."""

Content = TypeVar("Content")


def store_folder() -> Path:
    """Return where the store is: in the user's cache, or where the environment variable VIBROIMPACT_STORE says."""
    from platformdirs import user_cache_path

    given = os.environ.get(PLACE)
    return Path(given) if given else user_cache_path("vibroimpact") / "modes"


def key_of(recipe: Any) -> str:
    """Return the key of a recipe: a digest of its content and of the version of the package.

    Examples
    --------
    >>> from vibroimpact.structures.supports.point import Point
    >>> key_of(Point(0.0, 0.1)) == key_of(Point(0.0, 0.1)), key_of(Point(0.0, 0.1)) == key_of(Point(0.1, 0.0))
    (True, False)
    """
    text = json.dumps([FORMAT, __version__, _content(recipe)], sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()[:32]


def _content(value: Any) -> Any:
    """Return what determines a value, as JSON holds it: of a dataclass its name and its fields that are compared."""
    if dataclasses.is_dataclass(value):
        return [
            type(value).__name__,
            {item.name: _content(getattr(value, item.name)) for item in dataclasses.fields(value) if item.compare},
        ]
    if isinstance(value, (list, tuple)):
        return [_content(item) for item in value]
    if isinstance(value, Mapping):
        return {str(key): _content(item) for key, item in value.items()}
    if isinstance(value, np.ndarray):
        return [str(value.dtype), value.shape, hashlib.sha256(np.ascontiguousarray(value).tobytes()).hexdigest()]
    if isinstance(value, (np.generic, float, int)) and not isinstance(value, bool):
        return (float(value) + 0.0).hex()  # one and 1.0 are the same, and so are zero and minus zero
    return value


def has_model(key: str) -> bool:
    """Is there a model under a key?"""
    return _path(key, _MODES).is_file()


def load_model(key: str) -> tuple[ModalModel | None, str]:
    """Return the model under a key, or None; and what was wrong with its entry, or ""."""
    return load_entry(key, _MODES, _model)


def save_model(key: str, model: ModalModel) -> str:
    """Keep a model under a key; return what prevented it, or ""."""
    return save_entry(key, _MODES, _parts(model))


def load_entry(key: str, kind: str, read: Callable[[Mapping[str, Any]], Content]) -> tuple[Content | None, str]:
    """Return what an entry holds, or None; and what was wrong with it, or "".

    An entry carries a check sum of all of it, so that a damaged one is known and taken as absent.

    Parameters
    ----------
    key : str
        Its key.
    kind : str
        What it is: one of `KINDS`.
    read : callable
        Makes the content of its arrays.
    """
    path = _path(key, kind)
    _clear_once(store_folder())
    try:
        content = read(_unpacked(path.read_bytes()))
        os.utime(path)  # it was used just now
    except FileNotFoundError:
        return None, ""
    except OSError as error:
        return None, f"the {kind} stored in {path} can't be read ({error.strerror}) and will be computed again"
    except (ValueError, KeyError) as error:
        return None, f"the {kind} stored in {path} can't be used: the file is damaged ({error}), and its content will be computed again"
    return content, ""


def save_entry(key: str, kind: str, parts: Mapping[str, Any]) -> str:
    """Keep arrays under a key; return what prevented it, or ""."""
    return _put(key, kind, _packed(parts))


def _put(key: str, kind: str, pieces: Sequence[bytes]) -> str:
    """Write an entry; it appears whole or not at all, so that several processes may save and load at once."""
    folder = store_folder()
    try:
        folder.mkdir(parents=True, exist_ok=True)
        write_file(_path(key, kind), pieces)
        _make_room(sum(map(len, pieces)))
    except OSError as error:
        return f"the {kind} can't be kept in {folder} ({error.strerror}) and will be computed again next time"
    return ""


def carry(keys: Iterable[str]) -> dict[str, bytes]:
    """Return the entries under some keys as bytes, by the names of their files: for a process that does not see this disk.

    What is not in the store is left out; who receives the others computes it.

    Examples
    --------
    >>> carry(["none has this key"])
    {}
    """
    paths = [_path(key, kind) for key in keys for kind in KINDS]
    return {path.name: path.read_bytes() for path in paths if path.is_file()}


def receive(entries: Mapping[str, bytes]) -> str:
    """Take what `carry` gave into this store; return what prevented it, or "".

    Parameters
    ----------
    entries : mapping of str to bytes
        Those that are here already stay as they are.

    Raises
    ------
    InputError
        If one is no entry, or was damaged on its way.
    """
    for name, data in entries.items():
        key, _, kind = name.partition(".")
        if not (key.isalnum() and kind in KINDS):
            raise InputError(f'"{name}" is not the name of an entry of the store')
        try:
            _unpacked(data)
        except ValueError as error:
            raise InputError(f"the entry {name} was damaged on its way ({error}); send it again") from None
        if not _path(key, kind).is_file() and (trouble := _put(key, kind, [data])):
            return trouble
    return ""


def _path(key: str, kind: str) -> Path:
    return store_folder() / f"{key}.{kind}"


def _packed(parts: Mapping[str, Any]) -> list[bytes]:
    """Return arrays as bytes: a check sum of what follows, the length of the heading, the heading, and the numbers."""
    arrays = {name: np.ascontiguousarray(part) for name, part in parts.items()}
    heading = json.dumps([[name, array.dtype.str, array.shape] for name, array in arrays.items()]).encode()
    body = [len(heading).to_bytes(8, "little"), heading, *(array.tobytes() for array in arrays.values())]
    total = 0
    for piece in body:
        total = zlib.crc32(piece, total)
    return [total.to_bytes(4, "little"), *body]


def _unpacked(data: bytes) -> dict[str, Any]:
    """Return the arrays of an entry.

    Raises
    ------
    ValueError
        If the check sum is not that of the data.
    """
    view = memoryview(data)
    if len(view) < 12 or zlib.crc32(view[4:]) != int.from_bytes(view[:4], "little"):
        raise ValueError("its check sum does not agree")
    end = 12 + int.from_bytes(view[4:12], "little")
    found = {}
    for name, kind, shape in json.loads(bytes(view[12:end])):
        count = math.prod(shape)
        found[name] = np.frombuffer(view, np.dtype(kind), count, end).reshape(shape)
        end += count * np.dtype(kind).itemsize
    return found


def entries() -> list[Path]:
    """Return the files of the store, the one that was used last at the end."""
    found = [(path.stat().st_mtime, path) for kind in KINDS for path in store_folder().glob(f"*.{kind}")]
    return [path for _, path in sorted(found)]


def store_size() -> int:
    """Return how many bytes the store holds."""
    return sum(path.stat().st_size for path in entries())


def clear_store() -> int:
    """Empty the store; return how many entries it had."""
    found = entries()
    for path in found:
        path.unlink(missing_ok=True)
    return len(found)


@cache
def _clear_once(folder: Path) -> None:
    """Clear what processes that died have left in the store, once in the life of this one."""
    clear(folder)


_written = [math.inf]  # bytes, since this process looked


def _make_room(size: int) -> None:
    """Count what was written, and now and then remove what was not used for longest."""
    _written[0] += size
    if _written[0] < _SLACK * _LARGEST:
        return
    _written[0] = 0.0
    found = entries()
    total = sum(path.stat().st_size for path in found)
    for path in found[:-1]:
        if total <= _LARGEST:
            break
        total -= path.stat().st_size
        path.unlink(missing_ok=True)


def _parts(model: ModalModel) -> dict[str, Any]:
    parts: dict[str, Any] = {
        "nodes": model.mesh.nodes,
        "angular_frequencies": model.angular_frequencies,
        "shapes": model.shapes,
        "participation": model.participation,
        "centre": model.properties.centre,
        "inertia": model.properties.inertia,
        "numbers": np.array([model.properties.mass, model.thickness]),
        "left": model.left,
        "frequency_errors": model.frequency_errors,
        "facts": np.frombuffer(json.dumps(dict(model.facts)).encode(), np.uint8),
    }
    for index, block in enumerate(model.mesh.blocks):
        parts[f"block:{index}:{block.kind}"] = block.connectivity
    for name, nodes in model.mesh.node_sets.items():
        parts[f"nodes:{name.encode().hex()}"] = nodes
    for name, elements in model.mesh.element_sets.items():
        parts[f"elements:{name.encode().hex()}"] = elements
    return parts


def _model(entry: Mapping[str, Any]) -> ModalModel:
    def named(prefix: str) -> dict[str, Any]:
        return {bytes.fromhex(key[len(prefix) :]).decode(): entry[key] for key in entry if key.startswith(prefix)}

    blocks = sorted((key.split(":") for key in entry if key.startswith("block:")), key=lambda parts: int(parts[1]))
    mesh = Mesh(
        entry["nodes"],
        tuple(ElementBlock(kind, entry[f"block:{index}:{kind}"]) for _, index, kind in blocks),
        named("nodes:"),
        named("elements:"),
    )
    mass, thickness = entry["numbers"].tolist()
    return ModalModel(
        mesh,
        MassProperties(mass, entry["centre"], entry["inertia"]),
        entry["angular_frequencies"],
        entry["shapes"],
        entry["participation"],
        entry["left"],
        entry["frequency_errors"],
        thickness,
        json.loads(entry["facts"].tobytes()),
    )
