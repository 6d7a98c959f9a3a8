"""Node numbering of elements in other programs.

Each node is given by the corners whose midpoint it is.
"""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Integers
from vibroimpact.structures.finite_elements.element_kinds import ELEMENT_KINDS

_HEX_BOTTOM = "01 12 23 30"
_HEX_TOP = "45 56 67 74"
_HEX_UP = "04 15 26 37"
_HEX20_GMSH = "0 1 2 3 4 5 6 7 01 03 04 12 15 23 26 37 45 47 56 67"
_PYRAMID13_GMSH = "0 1 2 3 4 01 03 04 12 14 23 24 34"

GMSH = {
    "tet10": "0 1 2 3 01 12 02 03 23 13",
    "hex20": _HEX20_GMSH,
    "wedge15": "0 1 2 3 4 5 01 02 03 12 14 25 34 35 45",
    "pyramid13": _PYRAMID13_GMSH,
    "pyramid14": f"{_PYRAMID13_GMSH} 0123",
    "hex27": f"{_HEX20_GMSH} 0123 0154 0374 1265 2376 4567 01234567",
}
NASTRAN = {
    "hex20": f"0 1 2 3 4 5 6 7 {_HEX_BOTTOM} {_HEX_UP} {_HEX_TOP}",
    "wedge15": "0 1 2 3 4 5 01 12 20 03 14 25 34 45 53",
}
ABAQUS = {
    "hex27": f"0 1 2 3 4 5 6 7 {_HEX_BOTTOM} {_HEX_TOP} {_HEX_UP} 01234567 0123 4567 0154 1265 "
    "2376 0374"
}
"""Abaqus differs from this package in hex27 only: the centre node precedes the face nodes."""


def from_ours(kind: str, foreign: str) -> Integers:
    """Return the permutation from our node order to another one.

    It is that of `theirs = ours[from_ours(...)]`.
    """
    return np.argsort(to_ours(kind, foreign)).astype(np.int64)


def to_ours(kind: str, foreign: str) -> Integers:
    """Return the permutation from another node order to ours: `ours = theirs[to_ours(...)]`.

    Parameters
    ----------
    kind : str
        A name in `ELEMENT_KINDS`.
    foreign : str
        The other order: for each node in turn, the corners whose midpoint it is.

    Examples
    --------
    >>> to_ours("tet10", GMSH["tet10"]).tolist()
    [0, 1, 2, 3, 4, 5, 6, 7, 9, 8]
    """
    reference = ELEMENT_KINDS[kind].reference
    theirs = np.array(
        [reference[[int(corner) for corner in node]].mean(axis=0) for node in foreign.split()]
    )
    distance = np.abs(reference[:, None, :] - theirs[None, :, :]).max(axis=2)
    return np.asarray(distance.argmin(axis=1), dtype=np.int64)
