"""Checksum of a mesh file together with the files that it includes."""

from __future__ import annotations

import re
from hashlib import sha256
from os import PathLike
from pathlib import Path

from vibroimpact.files.reading import input_file_digest, read_bytes
from vibroimpact.meshes.abaqus_blocks import abaqus_include
from vibroimpact.meshes.nastran_cards import nastran_include
from vibroimpact.meshes.text_files import MESH, read_lines_with_includes

_INCLUDES = {
    ".inp": abaqus_include,
    **dict.fromkeys((".bdf", ".dat", ".nas", ".fem"), nastran_include),
}
_MENTIONED = re.compile(rb"include|input\s*=", re.IGNORECASE)


def mesh_digest(path: str | PathLike[str]) -> str:
    """Return the SHA-256 of a mesh file and of the files that it includes, in hexadecimal digits.

    Raises
    ------
    InputError
        If a file can't be read.
    """
    path = Path(path)
    digest = input_file_digest(path, MESH)
    included = _INCLUDES.get(path.suffix.lower())
    if included is None or not _MENTIONED.search(read_bytes(path, MESH)):
        return digest
    with_includes = sha256(digest.encode())
    for line in read_lines_with_includes(path, included):
        if line.path != path:
            with_includes.update(line.text.encode() + b"\n")
    return with_includes.hexdigest()
