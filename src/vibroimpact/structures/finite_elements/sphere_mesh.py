"""Mesh of a solid sphere: a bulged cube at the centre, and six blocks around it."""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.errors import InputError
from vibroimpact.structures.finite_elements.lattice import mesh_of_blocks
from vibroimpact.structures.finite_elements.mesh import Mesh

MOST_ACROSS = 100
"""Largest number of elements across; larger systems cannot be solved in practice."""

_CORE = 0.45  # half the side of the cube, in radii
_BULGE = 0.5  # of the cube: 0 for a cube, 1 for a ball


def sphere_mesh(
    radius: float, elements_across: int = 8, kind: str = "hex20", grading: float = 1.0
) -> Mesh:
    """Return a mesh of a solid sphere, centred at the origin.

    Elements are curved and of second order by default.

    Parameters
    ----------
    radius : float
        Radius R [m], > 0.
    elements_across : int, default 8
        Bricks from pole to pole, even, 4 to 100: half of them in the cube, the others between it
        and the surface.
    kind : str, default "hex20"
        Kind of element: "hex8", "hex20", "hex27", "tet4" or "tet10".
    grading : float, default 1
        Factor by which elements are smaller at the lower pole, where the contact is; >= 1. At the
        upper pole they are larger by the same factor, so that a strong grading needs more elements.

    Raises
    ------
    InputError
        If a number is out of range.

    Notes
    -----
    The grading is a conformal map of the ball onto itself (L. V. Ahlfors, Moebius Transformations
    in Several Dimensions, 1981): it changes the size of small elements, not their shape.

    Examples
    --------
    >>> sphere_mesh(0.025, 4).number_of_elements
    32
    """
    if not 4 <= elements_across <= MOST_ACROSS or elements_across % 2:
        raise InputError(
            f"{elements_across} elements across a sphere is not allowed; it must be an "
            f"even number from 4 to {MOST_ACROSS}"
        )
    if not grading >= 1.0:
        raise InputError(f"a grading of {grading:g} is not allowed; it must be at least 1")
    layers = elements_across // 4  # between the cube and the surface
    elements_in_cube = elements_across - 2 * layers
    # lattice points along a side of the cube, and from the cube to the surface
    along = np.linspace(-1.0, 1.0, 2 * elements_in_cube + 1)
    outwards = np.linspace(0.0, 1.0, 2 * layers + 1)[:, None]
    blocks = [_core(np.stack(np.meshgrid(along, along, along, indexing="ij"), axis=-1))]
    first, second = np.meshgrid(along, along, indexing="ij")
    for axis in range(3):
        first_axis, second_axis = [other for other in range(3) if other != axis]
        for sign in (-1.0, 1.0):
            face = np.full((*first.shape, 3), sign)
            face[..., first_axis] = first
            face[..., second_axis] = second
            # equal angles along the face, projected onto the sphere
            surface = np.tan(0.25 * np.pi * face)
            surface /= np.linalg.norm(surface, axis=-1, keepdims=True)
            blocks.append(
                (1.0 - outwards) * _core(face)[:, :, None] + outwards * surface[:, :, None]
            )
    return mesh_of_blocks([radius * _towards_lower_pole(block, grading) for block in blocks], kind)


def _core(points: Floats) -> Floats:
    """Return the image of points of the cube from -1 to 1 in the bulged core."""
    squares = points**2
    following = np.roll(squares, -1, axis=-1)
    last = np.roll(squares, -2, axis=-1)
    # a map of the cube onto the ball
    ball = points * np.sqrt(1.0 - 0.5 * following - 0.5 * last + following * last / 3.0)
    return np.asarray(_CORE * ((1.0 - _BULGE) * points + _BULGE * np.sqrt(2.0) * ball))


def _towards_lower_pole(points: Floats, grading: float) -> Floats:
    """Return the image of points of the unit ball under the Moebius map of a grading."""
    shift = np.array([0.0, 0.0, (grading - 1.0) / (grading + 1.0)])
    squared_shift = shift @ shift
    offset = points - shift
    squares = (points**2).sum(axis=-1)
    squared_offset = (offset**2).sum(axis=-1, keepdims=True)
    numerator = (1.0 - squared_shift) * offset - squared_offset * shift
    denominator = 1.0 - 2.0 * (points @ shift) + squares * squared_shift
    return np.asarray(numerator / denominator[..., None])
