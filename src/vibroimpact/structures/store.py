"""Store of modal models and static compliances on disk, each under a hash of its inputs.

An entry is a CRC-32 followed by an npz archive. The checksum covers all of the archive, as NumPy
does not verify those of zip members that it reads in part.
"""

from __future__ import annotations

import dataclasses
import hashlib
import json
import math
import os
import zlib
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cache
from io import BytesIO
from pathlib import Path
from typing import Any, BinaryIO, TypeVar

import numpy as np
from scipy.sparse import coo_array, csr_array

from vibroimpact._version import __version__
from vibroimpact.errors import InputError
from vibroimpact.files.atomic_write import write_file
from vibroimpact.files.json_reading import parse_json
from vibroimpact.files.recover import clear
from vibroimpact.materials import Material
from vibroimpact.structures.geometry import MassProperties
from vibroimpact.structures.joints import Joints
from vibroimpact.structures.memory_cache import MemoryCache
from vibroimpact.structures.mesh import ElementBlock, Mesh
from vibroimpact.structures.modal_model import ModalModel

FORMAT = 6
"""Part of every key: to be increased when the stored data, or their computation, change;
earlier entries are then not found.
"""

PLACE = "VIBROIMPACT_STORE"
"""Environment variable with the folder of the store."""

_LARGEST = 4_000_000_000  # bytes; the least recently used entries are removed first
# of _LARGEST: bytes written between two scans of the folder, which may hold thousands of entries
_SLACK = 0.01
_CHECKSUM, _PIECE = 4, 2**20  # bytes
_MODES = "modes"
KINDS = (_MODES, "compliance", "parts")
"""Kinds of entries, which are the suffixes of their files."""

Content = TypeVar("Content")

_HELD_SIZE = 2000.0  # bytes, about
_HELD = MemoryCache[Mapping[str, Any]](capacity=1000 * _HELD_SIZE)


def store_folder() -> Path:
    """Return the folder of the store: that of the environment variable VIBROIMPACT_STORE,
    else one in the user's cache.
    """
    from platformdirs import user_cache_path

    given = os.environ.get(PLACE)
    return Path(given) if given else user_cache_path("vibroimpact") / "modes"


def key_of(recipe: Any) -> str:
    """Return the key of a recipe: a hash of its content, of the format of the store and of the
    version of the package.

    Examples
    --------
    >>> from vibroimpact.structures.supports.point import Point
    >>> (
    ...     key_of(Point(0.0, 0.1)) == key_of(Point(0.0, 0.1)),
    ...     key_of(Point(0.0, 0.1)) == key_of(Point(0.1, 0.0)),
    ... )
    (True, False)
    """
    text = json.dumps([FORMAT, __version__, _content(recipe)], sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()[:32]


def _content(value: Any) -> Any:
    """Return a value in terms of JSON: a dataclass as its name and its compared fields,
    an array as a hash.
    """
    if dataclasses.is_dataclass(value):
        return [
            type(value).__name__,
            {
                item.name: _content(getattr(value, item.name))
                for item in dataclasses.fields(value)
                if item.compare
            },
        ]
    if isinstance(value, (list, tuple)):
        return [_content(item) for item in value]
    if isinstance(value, Mapping):
        return {str(key): _content(item) for key, item in value.items()}
    if isinstance(value, np.ndarray):
        return [
            str(value.dtype),
            value.shape,
            hashlib.sha256(np.ascontiguousarray(value).tobytes()).hexdigest(),
        ]
    if isinstance(value, (np.generic, float, int)) and not isinstance(value, bool):
        return (float(value) + 0.0).hex()  # 1 and 1.0 are equal, and so are 0.0 and -0.0
    return value


def has_model(key: str) -> bool:
    """Return whether the store has a model under a key."""
    return _path(key, _MODES).is_file()


def load_model(key: str) -> tuple[ModalModel | None, str]:
    """Return the model under a key, or None; and a message on a failure to read it, or ""."""
    return load_entry(key, _MODES, _model)


def save_model(key: str, model: ModalModel) -> str:
    """Store a model under a key; return a message on failure, or ""."""
    return save_entry(key, _MODES, _parts(model))


def load_entry(
    key: str, kind: str, read: Callable[[Mapping[str, Any]], Content]
) -> tuple[Content | None, str]:
    """Return the content of an entry, or None; and a message on a failure to read it, or "".

    A damaged entry, recognised by its checksum, counts as absent.

    Parameters
    ----------
    key : str
        Key of the entry.
    kind : str
        Kind of the entry, one of `KINDS`.
    read : callable
        Makes the content from the arrays by their names.
    """
    held = _HELD.get(f"{key}.{kind}")
    if held is not None:
        return read(held), ""
    path = _path(key, kind)
    _clear_once(store_folder())
    try:
        with path.open("rb") as file:
            content = read(_unpacked(file))
        os.utime(path)  # its time of use, by which entries are removed
    except FileNotFoundError:
        return None, ""
    except OSError as error:
        return (
            None,
            f"the {kind} stored in {path} can't be read ({error.strerror}) "
            "and will be computed again",
        )
    except (ValueError, KeyError) as error:
        return (
            None,
            f"the {kind} stored in {path} can't be used: the file is damaged ({error}), "
            "and its content will be computed again",
        )
    return content, ""


def hold_entry(key: str, kind: str, parts: Mapping[str, Any]) -> None:
    """Keep arrays by name in memory for this process: for what is used soon, and then
    hardly again.
    """
    _HELD.put(f"{key}.{kind}", parts, _HELD_SIZE)


def save_entry(key: str, kind: str, parts: Mapping[str, Any]) -> str:
    """Store arrays by name under a key; return a message on failure, or ""."""
    return _put(key, kind, _packed(parts))


def _put(key: str, kind: str, pieces: Sequence[bytes]) -> str:
    """Write an entry atomically, so that several processes may save and load at once;
    return a message on failure, or "".
    """
    folder = store_folder()
    try:
        folder.mkdir(parents=True, exist_ok=True)
        write_file(_path(key, kind), pieces)
        _make_room(sum(map(len, pieces)))
    except OSError as error:
        return (
            f"the {kind} can't be kept in {folder} ({error.strerror}) and will be computed "
            "again next time"
        )
    return ""


def carry(keys: Iterable[str]) -> dict[str, bytes]:
    """Return the entries under some keys as bytes, by file name, for a process without access to
    this disk.

    Keys that are not in the store are left out; the receiving process computes their content.

    Examples
    --------
    >>> carry(["none has this key"])
    {}
    """
    paths = [_path(key, kind) for key in keys for kind in KINDS]
    return {path.name: path.read_bytes() for path in paths if path.is_file()}


def receive(entries: Mapping[str, bytes]) -> str:
    """Add entries that `carry` returned to this store; return a message on failure, or "".

    Parameters
    ----------
    entries : mapping of str to bytes
        Bytes by file name; entries that the store has already are not replaced.

    Raises
    ------
    InputError
        If a name is not that of an entry, or a checksum does not agree.
    """
    for name, data in entries.items():
        key, _, kind = name.partition(".")
        if not (key.isalnum() and kind in KINDS):
            raise InputError(f'"{name}" is not the name of an entry of the store')
        try:
            _unpacked(BytesIO(data))
        except ValueError as error:
            raise InputError(
                f"the entry {name} was damaged on its way ({error}); send it again"
            ) from None
        if not _path(key, kind).is_file() and (trouble := _put(key, kind, [data])):
            return trouble
    return ""


def _path(key: str, kind: str) -> Path:
    return store_folder() / f"{key}.{kind}"


def _packed(parts: Mapping[str, Any]) -> list[bytes]:
    """Return arrays as an npz archive, preceded by its CRC-32."""
    stream = BytesIO()
    np.savez(stream, **parts)
    archive = stream.getvalue()
    return [zlib.crc32(archive).to_bytes(_CHECKSUM, "little"), archive]


def _unpacked(file: BinaryIO) -> dict[str, Any]:
    """Return the arrays of an entry, read-only, as what is made of them is shared within the
    process.

    The file is read twice, in pieces: it may take as much memory as the arrays.

    Raises
    ------
    ValueError
        If the checksum does not agree, or the content is not an archive of arrays.
    """
    expected, sum_so_far = file.read(_CHECKSUM), 0
    while piece := file.read(_PIECE):
        sum_so_far = zlib.crc32(piece, sum_so_far)
    if file.tell() <= _CHECKSUM or sum_so_far.to_bytes(_CHECKSUM, "little") != expected:
        raise ValueError("its check sum does not agree")
    file.seek(_CHECKSUM)
    with np.load(file, allow_pickle=False) as archive:
        found = dict(archive)
    for array in found.values():
        array.flags.writeable = False
    return found


def entries() -> list[Path]:
    """Return the files of the store, the least recently used first."""
    found = [
        (path.stat().st_mtime, path) for kind in KINDS for path in store_folder().glob(f"*.{kind}")
    ]
    return [path for _, path in sorted(found)]


def store_size() -> int:
    """Return the size of the store [bytes]."""
    return sum(path.stat().st_size for path in entries())


def clear_store() -> int:
    """Remove all entries; return how many there were."""
    found = entries()
    for path in found:
        path.unlink(missing_ok=True)
    return len(found)


@cache
def _clear_once(folder: Path) -> None:
    """Remove the working files of killed processes, once per process."""
    clear(folder)


_written = [math.inf]  # bytes since the last scan of the folder by this process


def _make_room(size: int) -> None:
    """Count the bytes written; from time to time remove the least recently used entries
    beyond the limit.
    """
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
    """Return the arrays of a model by name; `_model` is the inverse."""
    parts: dict[str, Any] = {
        "nodes": model.mesh.nodes,
        "angular_frequencies": model.angular_frequencies,
        "shapes": model.shapes,
        "participation": model.participation,
        "centre": model.properties.centre,
        "inertia": model.properties.inertia,
        "numbers": np.array([model.properties.mass, model.thickness]),
        "rigid_coefficients": model.rigid_coefficients,
        "frequency_errors": model.frequency_errors,
        "facts": _text_array(dict(model.facts)),
    }
    if model.mesh.materials:
        table = [
            [one.name, one.density, one.youngs_modulus, one.poissons_ratio]
            for one in model.mesh.materials
        ]
        parts |= {
            "materials": _text_array(table),
            "element_materials": model.mesh.element_materials,
        }
    joints = model.mesh.joints
    if joints is not None:
        entries = joints.weights.tocoo()
        parts |= {
            "followers": joints.followers,
            "movers": np.stack([entries.row, entries.col]),
            "weights": entries.data,
        }
    for index, block in enumerate(model.mesh.blocks):
        parts[f"block:{index}:{block.kind}"] = block.connectivity
    for name, nodes in model.mesh.node_sets.items():
        parts[f"nodes:{name.encode().hex()}"] = nodes
    for name, elements in model.mesh.element_sets.items():
        parts[f"elements:{name.encode().hex()}"] = elements
    return parts


def _text_array(value: Any) -> Any:
    """Return a value as JSON in an array of bytes."""
    return np.frombuffer(json.dumps(value).encode(), np.uint8)


def _model(entry: Mapping[str, Any]) -> ModalModel:
    """Return the model of the arrays of an entry."""

    def named(prefix: str) -> dict[str, Any]:
        return {
            bytes.fromhex(key[len(prefix) :]).decode(): entry[key]
            for key in entry
            if key.startswith(prefix)
        }

    blocks = sorted(
        (key.split(":") for key in entry if key.startswith("block:")),
        key=lambda parts: int(parts[1]),
    )
    mesh = Mesh(
        entry["nodes"],
        tuple(ElementBlock(kind, entry[f"block:{index}:{kind}"]) for _, index, kind in blocks),
        named("nodes:"),
        named("elements:"),
    )
    if "materials" in entry:
        rows = parse_json(entry["materials"].tobytes())
        materials = tuple(
            Material(density, modulus, ratio, name=name) for name, density, modulus, ratio in rows
        )
        mesh = dataclasses.replace(
            mesh, materials=materials, element_materials=entry["element_materials"]
        )
    if "followers" in entry:
        shape = (len(entry["followers"]), mesh.nodes.size)
        weights = csr_array(coo_array((entry["weights"], tuple(entry["movers"])), shape=shape))
        mesh = dataclasses.replace(mesh, joints=Joints(entry["followers"], weights))
    mass, thickness = entry["numbers"].tolist()
    return ModalModel(
        mesh,
        MassProperties(mass, entry["centre"], entry["inertia"]),
        entry["angular_frequencies"],
        entry["shapes"],
        entry["participation"],
        entry["rigid_coefficients"],
        entry["frequency_errors"],
        thickness,
        parse_json(entry["facts"].tobytes()),
    )
