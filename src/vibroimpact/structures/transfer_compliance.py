r"""Static transfer compliances of a plate between its contact point and its sensors.

They follow from one static solution.
The force is distributed over a disc, as finite elements do not resolve the field near a point
force; outside the disc the response is the same. The face of a layer moves less than plate theory
states (see `plate_compliance`), for long waves of wave number k by the factor
:math:`1 - k^2 \overline{r^2}/4`, once for the point of the force and once for the sensor, with

.. math:: \overline{r^2} = 2 h^2 \left(\frac{1}{6 (1 - \nu) \kappa} - \frac15\right).

The modal shapes that are used with the compliance may include that factor at neither point, at one
or at both. Their number is `faces`; the mean of r^2 of the disc is as many times the above. The
remaining difference between a layer and plate theory decays within two thicknesses, as
:math:`e^{-4.2\,r/h}`, and is added. By the thin theory the disc has the size of an element, and the
additional displacement under a point force within it is added in closed form (`thin_near_term`).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.structures.finite_elements.plate_element import shear_factor
from vibroimpact.structures.finite_elements.surface import Side, surface_motion
from vibroimpact.structures.plate_compliance import Average, layer_kernels, mean_square
from vibroimpact.structures.recipe import PlateOfPlates, Recipe, Shape, is_thin, plate_key
from vibroimpact.structures.static_compliance import responses_to_spread_forces
from vibroimpact.structures.store import COMPLIANCE, hold_entry, key_of, load_or_compute_array

_RADIUS = 0.75  # of the disc, in thicknesses
_NEAR = 4.0  # thicknesses beyond which a layer and plate theory agree
# thicknesses: least distance from the force on the loaded face; closer points are evaluated there
_LEAST = 0.05
_NODES = 16  # of Gauss's rule on each part of the integral
_FINEST = 300.0  # wave number times thickness, or radius, at which the integral ends

Point = tuple[tuple[float, float], Side]
"""Point of a plate: x and y [m], and its face."""


def transfer_compliances(
    recipe: Recipe,
    place: tuple[float, float],
    side: Side,
    points: Sequence[Point],
    faces: int = 0,
    tell: Callable[[str], None] | None = None,
) -> Floats:
    """Return the static compliances between a place and points of a held plate [m/N].

    They are an array (points, 3), from the store or computed.

    Parameters
    ----------
    recipe : Recipe
        The plate and its supports; the reduction has no effect.
    place : tuple of two floats
        x and y of the force [m].
    side : str
        Face of the force, "upper" or "lower"; the force acts upwards.
    points : sequence of ((x, y), side)
        Points of the displacements.
    faces : int, default 0
        For plate elements, the number of the two points (of the force and of the displacement) at
        which the compliance is that of the face instead of plate theory: 0, 1 or 2.
    tell : callable, optional
        Called with a message on a failure of the store.

    Raises
    ------
    InputError
        If a place is not on the body, the supports permit vertical rigid motion, or the mesh or a
        support is invalid.
    ComputationError
        If the stiffness is singular.

    Examples
    --------
    >>> from vibroimpact.structures.supports.edge import EDGES, Edge
    >>> edges = tuple(Edge(edge, "simply-supported") for edge in EDGES)
    >>> recipe = Recipe(PlateOfPlates((0.5, 0.5, 0.01), 0.1), 7850.0, 210e9, 0.3, edges)
    >>> there, back = ((0.1, 0.0), "upper"), ((0.0, 0.0), "upper")
    >>> one, other = (
    ...     float(transfer_compliances(recipe, *a, [b], 2)[0, 2])
    ...     for a, b in ((there, back), (back, there))
    ... )
    >>> abs(one / other - 1.0) < 1e-4  # Maxwell-Betti reciprocity
    True
    """
    return load_or_compute_array(
        transfer_key(recipe, place, side, points, faces),
        lambda: computed_transfer(recipe, place, side, points, faces),
        tell,
    )


def hold_transfers(
    recipe: Recipe,
    places: Sequence[tuple[float, float]],
    side: Side,
    points: Sequence[Point],
    faces: int = 0,
) -> None:
    """Compute the compliances between places and points together.

    Calls of `transfer_compliances` that follow in this process find them in memory.
    """
    transfers = computed_transfers(recipe, places, side, points, faces)
    for place, compliances in zip(places, transfers, strict=True):
        key = transfer_key(recipe, place, side, points, faces)
        hold_entry(key, COMPLIANCE, {COMPLIANCE: compliances})


def transfer_key(
    recipe: Recipe, place: tuple[float, float], side: Side, points: Sequence[Point], faces: int = 0
) -> str:
    """Return the key of the compliances between a place and points in the store."""
    return key_of(["transfer compliance", plate_key(recipe), place, side, list(points), faces])


def computed_transfer(
    recipe: Recipe, place: tuple[float, float], side: Side, points: Sequence[Point], faces: int = 0
) -> Floats:
    """Return the compliances between a place and points, computed anew.

    Parameters and errors are those of `transfer_compliances`.
    """
    return np.asarray(computed_transfers(recipe, [place], side, points, faces)[0])


def computed_transfers(
    recipe: Recipe,
    places: Sequence[tuple[float, float]],
    side: Side,
    points: Sequence[Point],
    faces: int = 0,
) -> Floats:
    """Return the compliances between several places and points, (places, points, 3).

    The forces at all places are solved together.
    """
    ratio = recipe.poissons_ratio
    has_plate_elements = isinstance(recipe.shape, PlateOfPlates)
    thin = is_thin(recipe)
    square = 0.0
    if has_plate_elements:
        square = faces * _square(ratio)

    def distribution(place: tuple[float, float], thickness: float) -> Average:
        if thin:
            return Average(_disc_of_an_element(recipe.shape, place), 3.0)
        return Average(_RADIUS * thickness, 3.0 - 6.0 * square / _RADIUS**2)

    structure, thicknesses, displacements = responses_to_spread_forces(
        recipe, places, side, distribution
    )
    compliances = np.empty((len(places), len(points), 3))
    element_thickness = structure.thickness if has_plate_elements else 0.0
    for number, (point, face) in enumerate(points):
        motion, _ = surface_motion(
            structure.mesh, np.array([point]), face, element_thickness, "a sensor"
        )
        compliances[:, number] = (motion @ displacements).T
        if not has_plate_elements:
            continue
        for index, (place, thickness) in enumerate(zip(places, thicknesses, strict=True)):
            # along z, what plate theory under a distributed force lacks near the force
            distance = math.dist(point, place)
            if not thin:
                compliances[index, number, 2] += near_term(
                    distance, face == side, thickness, recipe.youngs_modulus, ratio, faces
                )
            elif radius := _disc_of_an_element(recipe.shape, place):
                rigidity = recipe.youngs_modulus * thickness**3 / (12.0 * (1.0 - ratio**2))
                compliances[index, number, 2] += thin_near_term(distance, radius, rigidity)
    return compliances


def _disc_of_an_element(shape: Shape, place: tuple[float, float]) -> float:
    """Return the radius [m] of a disc of the size of an element of a plate.

    It is zero where the disc would extend beyond the plate.
    """
    assert isinstance(shape, PlateOfPlates)
    to_edges = [0.5 * side - abs(at) for side, at in zip(shape.size[:2], place, strict=True)]
    if min(to_edges) > shape.element_size:
        return shape.element_size
    return 0.0


def thin_near_term(distance: float, radius: float, rigidity: float) -> float:
    r"""Return the displacement of Kirchhoff's plate that a spread unit force lacks [m/N].

    It is that under a point force less that under a force distributed over a disc: the inverse
    Hankel transform of :math:`(1 - A(k)) / (D k^4)`, with A the transform of the weighted disc. As
    its mean of r^2 is zero, the term is zero outside the disc.

    Parameters
    ----------
    distance, radius : float
        Distance from the centre, and radius of the disc [m].
    rigidity : float
        Bending stiffness D [N m].

    Examples
    --------
    >>> thin_near_term(0.02, 0.01, 1.0)
    0.0
    >>> round(thin_near_term(0.0, 0.01, 1.0) / 0.01**2, 5)  # 1 / (48 pi)
    0.00663
    """
    from scipy.special import jv

    if distance >= radius:
        return 0.0
    y, weights = _gauss_rule(math.ceil(0.5 * _FINEST))  # y is k times the radius
    integrand = (1.0 - Average(1.0, 3.0).transform(y)) / y**3 * jv(0, y * distance / radius)
    return float(integrand @ weights) * radius**2 / (2.0 * math.pi * rigidity)


def near_term(
    distance: float,
    same_face: bool,
    thickness: float,
    youngs_modulus: float,
    poissons_ratio: float,
    faces: int = 0,
) -> float:
    r"""Return the displacement of a plate near a unit force that plate theory lacks [m/N].

    It is that of a layer less that of plate theory under the distributed force.

    Parameters
    ----------
    distance : float
        Distance along the plate [m].
    same_face : bool
        Whether the point is on the loaded face. There the singular displacement :math:`(1 -
        \nu^2)/(\pi E r)` of the half space is included; within 0.05 thicknesses the value at that
        distance is returned.
    thickness, youngs_modulus, poissons_ratio : float
        h [m], E [Pa] and nu [-].
    faces : int, default 0
        As in `transfer_compliances`.

    Notes
    -----
    The inverse Hankel transform of the difference between the kernels of an elastic layer (I. N.
    Sneddon, Fourier Transforms, 1951, section 46) and of R. D. Mindlin's theory (J. Appl. Mech.
    18:31, 1951) times the transform of the disc, without the long-range terms.

    Examples
    --------
    >>> near_term(0.05, True, 0.01, 210e9, 0.3)  # five thicknesses away
    0.0
    """
    from scipy.special import jv

    if distance > _NEAR * thickness:
        return 0.0
    modulus = youngs_modulus / (1.0 - poissons_ratio**2)
    rigidity = modulus * thickness**3 / 12.0
    shear_stiffness = (
        shear_factor(poissons_ratio) * 0.5 * (1.0 - poissons_ratio) * modulus * thickness
    )
    if same_face:
        distance = max(distance, _LEAST * thickness)
    intervals = math.ceil(0.5 * _FINEST * max(1.0, distance / thickness))
    y, weights = _gauss_rule(intervals)  # y is k h
    k = y / thickness
    # kernel of the layer over that of the half space, on the loaded face without the latter
    bending, squeezing = layer_kernels(y)
    layer = bending - squeezing
    if same_face:
        layer = bending + squeezing - 1.0
    square = _square(poissons_ratio)
    average = Average(_RADIUS * thickness, 3.0 - 6.0 * faces * square / _RADIUS**2)
    # excess of the modes of plate theory in long waves
    excess = 0.25 * (2 - faces) * square * thickness**2 / rigidity
    bending_term = 1.0 / (rigidity * k**4)
    shear_term = (1.0 / shear_stiffness - excess) / k**2
    plate = (bending_term + shear_term) * average.transform(k)
    # inverse Hankel transform: the integral of kernel J_0(k r) k dk/2 pi
    kernel = (2.0 / (modulus * k) * layer - plate) * jv(0, k * distance)
    displacement = float(kernel @ (k * weights)) / thickness / (2.0 * math.pi)
    if same_face:  # with the half space
        displacement += 1.0 / (math.pi * modulus * distance)
    return displacement


def _square(poissons_ratio: float) -> float:
    """Return `mean_square` over the square of the thickness."""
    return mean_square(1.0, poissons_ratio, shear_factor(poissons_ratio))


def _gauss_rule(intervals: int) -> tuple[Floats, Floats]:
    """Return the nodes and weights of Gauss's rule on equal intervals, from zero to the cutoff."""
    nodes, weights = np.polynomial.legendre.leggauss(_NODES)
    places = (np.arange(intervals)[:, None] + 0.5 * (nodes + 1.0)).ravel() * (_FINEST / intervals)
    return places, np.tile(weights, intervals) * (0.5 * _FINEST / intervals)
