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
from vibroimpact.arrays import Floats
from vibroimpact.errors import InputError
from vibroimpact.files.atomic_write import write_file
from vibroimpact.files.json_reading import parse_json
from vibroimpact.files.recover import clear
from vibroimpact.materials import Material
from vibroimpact.structures.finite_elements.geometry import MassProperties
from vibroimpact.structures.finite_elements.joints import Joints
from vibroimpact.structures.finite_elements.mesh import ElementBlock, Mesh
from vibroimpact.structures.memory_cache import MemoryCache
from vibroimpact.structures.modal_model import ModalModel

FORMAT = 6
"""Part of every key: to be increased when the stored data, or their computation, change.

Earlier entries are then not found.
"""

PLACE = "VIBROIMPACT_STORE"
"""Environment variable with the folder of the store."""

_LARGEST = 4_000_000_000  # bytes; the least recently used entries are removed first
# of _LARGEST: bytes written between two scans of the folder, which may hold thousands of entries
_SLACK = 0.01
_CHECKSUM_SIZE = 4  # bytes
_PIECE_SIZE = 2**20  # bytes that are read at once
_MODES = "modes"
COMPLIANCE = "compliance"
"""Kind of the entries with static responses."""
KINDS = (_MODES, COMPLIANCE, "parts")
"""Kinds of entries, which are the suffixes of their files."""

Content = TypeVar("Content")

_HELD_SIZE = 2000.0  # bytes of an entry that is kept in memory, about
_HELD = MemoryCache[Mapping[str, Any]](capacity=1000 * _HELD_SIZE)


def store_folder() -> Path:
    """Return the folder of the store.

    It is that of the environment variable VIBROIMPACT_STORE, else one in the user's cache.
    """
    from platformdirs import user_cache_path

    folder = os.environ.get(PLACE)
    if folder:
        return Path(folder)
    return user_cache_path("vibroimpact") / "modes"


def key_of(recipe: Any) -> str:
    """Return the key of a recipe: a hash of its content and of the version of the package.

    The format of the store is part of it.

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
    """Return a value in terms of JSON.

    A dataclass is its name and its compared fields, and an array is a hash.
    """
    if dataclasses.is_dataclass(value):
        compared_fields = {
            item.name: _content(getattr(value, item.name))
            for item in dataclasses.fields(value)
            if item.compare
        }
        return [type(value).__name__, compared_fields]
    if isinstance(value, (list, tuple)):
        return [_content(item) for item in value]
    if isinstance(value, Mapping):
        return {str(key): _content(item) for key, item in value.items()}
    if isinstance(value, np.ndarray):
        array_hash = hashlib.sha256(np.ascontiguousarray(value).tobytes()).hexdigest()
        return [str(value.dtype), value.shape, array_hash]
    if isinstance(value, (np.generic, float, int)) and not isinstance(value, bool):
        return (float(value) + 0.0).hex()  # 1 and 1.0 are equal, and so are 0.0 and -0.0
    return value


def has_model(key: str) -> bool:
    """Return whether the store has a model under a key."""
    return _path(key, _MODES).is_file()


def load_model(key: str) -> tuple[ModalModel | None, str]:
    """Return the model under a key, or None; and a message on a failure to read it, or ""."""
    return load_entry(key, _MODES, _model_of_arrays)


def save_model(key: str, model: ModalModel) -> str:
    """Store a model under a key; return a message on failure, or ""."""
    return save_entry(key, _MODES, _arrays_of_model(model))


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


def hold_entry(key: str, kind: str, arrays: Mapping[str, Any]) -> None:
    """Keep arrays by name in memory for this process.

    It is for what is used soon, and then hardly again.
    """
    _HELD.put(f"{key}.{kind}", arrays, _HELD_SIZE)


def save_entry(key: str, kind: str, arrays: Mapping[str, Any]) -> str:
    """Store arrays by name under a key; return a message on failure, or ""."""
    return _put(key, kind, _packed(arrays))


def load_or_compute(
    key: str,
    kind: str,
    read: Callable[[Mapping[str, Any]], Content],
    compute: Callable[[], Content],
    arrays: Callable[[Content], Mapping[str, Any]],
    tell: Callable[[str], None] | None = None,
) -> Content:
    """Return the content of an entry from the store, or computed and then stored.

    Parameters
    ----------
    key, kind, read
        As in `load_entry`.
    compute : callable
        Computes the content where the store does not have it.
    arrays : callable
        Makes arrays by their names from the content; the inverse of `read`.
    tell : callable, optional
        Called with a message on a failure of the store.
    """
    content, trouble = load_entry(key, kind, read)
    if trouble and tell is not None:
        tell(trouble)
    if content is None:
        content = compute()
        trouble = save_entry(key, kind, arrays(content))
        if trouble and tell is not None:
            tell(trouble)
    return content


def load_or_compute_array(
    key: str, compute: Callable[[], Floats], tell: Callable[[str], None] | None = None
) -> Floats:
    """Return an array of static responses from the store, or computed and then stored.

    Parameters are those of `load_or_compute`.
    """
    return load_or_compute(
        key,
        COMPLIANCE,
        lambda arrays: np.asarray(arrays[COMPLIANCE], dtype=float),
        compute,
        lambda array: {COMPLIANCE: array},
        tell,
    )


def _put(key: str, kind: str, pieces: Sequence[bytes]) -> str:
    """Write an entry; return a message on failure, or "".

    It is written atomically, so that several processes may save and load at once.
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
    """Return the entries under some keys as bytes, by file name.

    They are for a process without access to this disk. Keys that are not in the store are left out;
    the receiving process computes their content.

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
    """Return the file of an entry."""
    return store_folder() / f"{key}.{kind}"


def _packed(arrays: Mapping[str, Any]) -> list[bytes]:
    """Return arrays as an npz archive, preceded by its CRC-32."""
    stream = BytesIO()
    np.savez(stream, **arrays)
    archive = stream.getvalue()
    return [zlib.crc32(archive).to_bytes(_CHECKSUM_SIZE, "little"), archive]


def _unpacked(file: BinaryIO) -> dict[str, Any]:
    """Return the arrays of an entry, read-only.

    What is made of them is shared within the process. The file is read twice, in pieces: it may
    take as much memory as the arrays.

    Raises
    ------
    ValueError
        If the checksum does not agree, or the content is not an archive of arrays.
    """
    expected = file.read(_CHECKSUM_SIZE)
    checksum = 0
    while piece := file.read(_PIECE_SIZE):
        checksum = zlib.crc32(piece, checksum)
    is_empty = file.tell() <= _CHECKSUM_SIZE
    if is_empty or checksum.to_bytes(_CHECKSUM_SIZE, "little") != expected:
        raise ValueError("its check sum does not agree")
    file.seek(_CHECKSUM_SIZE)
    with np.load(file, allow_pickle=False) as archive:
        arrays = dict(archive)
    for array in arrays.values():
        array.flags.writeable = False
    return arrays


def entries() -> list[Path]:
    """Return the files of the store, the least recently used first."""
    folder = store_folder()
    times = [(path.stat().st_mtime, path) for kind in KINDS for path in folder.glob(f"*.{kind}")]
    return [path for _, path in sorted(times)]


def store_size() -> int:
    """Return the size of the store [bytes]."""
    return sum(path.stat().st_size for path in entries())


def clear_store() -> int:
    """Remove all entries; return how many there were."""
    paths = entries()
    for path in paths:
        path.unlink(missing_ok=True)
    return len(paths)


@cache
def _clear_once(folder: Path) -> None:
    """Remove the working files of killed processes, once per process."""
    clear(folder)


_written = [math.inf]  # bytes since the last scan of the folder by this process


def _make_room(size: int) -> None:
    """Count the bytes written; from time to time remove entries beyond the limit.

    The least recently used entries are removed first.
    """
    _written[0] += size
    if _written[0] < _SLACK * _LARGEST:
        return
    _written[0] = 0.0
    paths = entries()
    total = sum(path.stat().st_size for path in paths)
    for path in paths[:-1]:
        if total <= _LARGEST:
            break
        total -= path.stat().st_size
        path.unlink(missing_ok=True)


def _arrays_of_model(model: ModalModel) -> dict[str, Any]:
    """Return the arrays of a model by name; `_model_of_arrays` is the inverse."""
    mesh = model.mesh
    arrays: dict[str, Any] = {
        "nodes": mesh.nodes,
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
    if mesh.materials:
        table = [
            [material.name, material.density, material.youngs_modulus, material.poissons_ratio]
            for material in mesh.materials
        ]
        arrays["materials"] = _text_array(table)
        arrays["element_materials"] = mesh.element_materials
    if mesh.joints is not None:
        weights = mesh.joints.weights.tocoo()
        arrays["followers"] = mesh.joints.followers
        arrays["movers"] = np.stack([weights.row, weights.col])
        arrays["weights"] = weights.data
    for index, block in enumerate(mesh.blocks):
        arrays[f"block:{index}:{block.kind}"] = block.connectivity
    for name, nodes in mesh.node_sets.items():
        arrays[f"nodes:{name.encode().hex()}"] = nodes
    for name, elements in mesh.element_sets.items():
        arrays[f"elements:{name.encode().hex()}"] = elements
    return arrays


def _text_array(value: Any) -> Any:
    """Return a value as JSON in an array of bytes."""
    return np.frombuffer(json.dumps(value).encode(), np.uint8)


def _model_of_arrays(arrays: Mapping[str, Any]) -> ModalModel:
    """Return the model of the arrays of an entry."""
    mass, thickness = arrays["numbers"].tolist()
    return ModalModel(
        _mesh_of_arrays(arrays),
        MassProperties(mass, arrays["centre"], arrays["inertia"]),
        arrays["angular_frequencies"],
        arrays["shapes"],
        arrays["participation"],
        arrays["rigid_coefficients"],
        arrays["frequency_errors"],
        thickness,
        parse_json(arrays["facts"].tobytes()),
    )


def _mesh_of_arrays(arrays: Mapping[str, Any]) -> Mesh:
    """Return the mesh of the model of an entry."""
    block_names = [key.split(":") for key in arrays if key.startswith("block:")]
    block_names.sort(key=lambda parts: int(parts[1]))
    mesh = Mesh(
        arrays["nodes"],
        tuple(
            ElementBlock(kind, arrays[f"block:{index}:{kind}"]) for _, index, kind in block_names
        ),
        _named_sets(arrays, "nodes:"),
        _named_sets(arrays, "elements:"),
    )
    if "materials" in arrays:
        table = parse_json(arrays["materials"].tobytes())
        materials = tuple(
            Material(density, modulus, ratio, name=name) for name, density, modulus, ratio in table
        )
        mesh = dataclasses.replace(
            mesh, materials=materials, element_materials=arrays["element_materials"]
        )
    if "followers" in arrays:
        followers = arrays["followers"]
        weights = coo_array(
            (arrays["weights"], tuple(arrays["movers"])), shape=(len(followers), mesh.nodes.size)
        )
        mesh = dataclasses.replace(mesh, joints=Joints(followers, csr_array(weights)))
    return mesh


def _named_sets(arrays: Mapping[str, Any], prefix: str) -> dict[str, Any]:
    """Return the sets of a mesh by name; names are in hexadecimal, after a prefix."""
    return {
        bytes.fromhex(key[len(prefix) :]).decode(): arrays[key]
        for key in arrays
        if key.startswith(prefix)
    }
