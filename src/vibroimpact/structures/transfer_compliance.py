r"""The static compliance between the point where a plate is met and the points that are watched, from one static solve.

The force is spread over a disc, as finite elements miss what is near a point force; beyond the disc that changes nothing. The face of a
layer moves less than plate theory says (see `plate_compliance`), by the factor :math:`1 - k^2 \overline{r^2}/4` for long waves of a wave
number k, once for the point of the force and once for the point that is watched, with

.. math:: \overline{r^2} = 2 h^2 \left(\frac{1}{6 (1 - \nu) \kappa} - \frac15\right).

The modal shapes with which the compliance goes together may have that factor at neither point, at one or at both: `faces` says so, and the
disc then has as many times that mean of r^2. What is left between a layer and plate theory fades within two thicknesses, as
:math:`e^{-4.2\,r/h}`, and is added. By the thin theory the disc is one that elements resolve, and what a point force moves within it more
is added in closed form (`thin_near_term`).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.structures.plate_compliance import Average, layer_kernels, mean_square
from vibroimpact.structures.plate_element import shear_factor
from vibroimpact.structures.recipe import PlateOfPlates, Recipe, Reduction, is_thin
from vibroimpact.structures.static_compliance import response_to_spread_force
from vibroimpact.structures.store import key_of, load_entry, save_entry
from vibroimpact.structures.surface import Side, surface_motion

_KIND = "compliance"
_RADIUS = 0.75  # of the disc, thicknesses
_NEAR = 4.0  # thicknesses: beyond them a plate and plate theory are the same
_LEAST = 0.05  # thicknesses: where the face is loaded, a point closer to the force is taken for one so far from it
_NODES = 16  # of Gauss's rule on each part of an integral
_FINEST = 300.0  # wave number times thickness, or radius, at which the integral ends

Point = tuple[tuple[float, float], Side]
"""A point of a plate: x and y [m], and its face."""


def transfer_compliances(
    recipe: Recipe,
    place: tuple[float, float],
    side: Side,
    points: Sequence[Point],
    faces: int = 0,
    tell: Callable[[str], None] | None = None,
) -> Floats:
    """Return the static compliances between the point where a held plate is met and others [m/N], (points, 3), from the store if there.

    Parameters
    ----------
    recipe : Recipe
        The plate and its supports; which modes are kept plays no part.
    place : tuple of two floats
        x and y of the force [m].
    side : str
        The face that it acts on: "upper" or "lower". It acts upwards.
    points : sequence of ((x, y), side)
        The points.
    faces : int, default 0
        Of how many of the two points, of the force and of those watched, the compliance is that of the face of a plate of plate elements,
        and not of plate theory: 0, 1 or 2.
    tell : callable, optional
        Called with a sentence if something is wrong with the store.

    Raises
    ------
    InputError
        If a place is not on the body, the supports let it move vertically, or the mesh or a support is wrong.
    ComputationError
        If the stiffness is singular.

    Examples
    --------
    >>> from vibroimpact.structures.supports.edge import EDGES, Edge
    >>> edges = tuple(Edge(edge, "simply-supported") for edge in EDGES)
    >>> recipe = Recipe(PlateOfPlates((0.5, 0.5, 0.01), 0.1), 7850.0, 210e9, 0.3, edges)
    >>> there, back = ((0.1, 0.0), "upper"), ((0.0, 0.0), "upper")
    >>> one, other = (float(transfer_compliances(recipe, *a, [b], 2)[0, 2]) for a, b in ((there, back), (back, there)))
    >>> abs(one / other - 1.0) < 1e-4  # Maxwell and Betti
    True
    """
    key, say = transfer_key(recipe, place, side, points, faces), tell or (lambda text: None)
    found, trouble = load_entry(key, _KIND, lambda parts: np.asarray(parts[_KIND], dtype=float))
    if trouble:
        say(trouble)
    if found is None:
        found = computed_transfer(recipe, place, side, points, faces)
        trouble = save_entry(key, _KIND, {_KIND: found})
        if trouble:
            say(trouble)
    return found


def transfer_key(recipe: Recipe, place: tuple[float, float], side: Side, points: Sequence[Point], faces: int = 0) -> str:
    """Return the key under which the store has the compliances between a place and points."""
    return key_of(["transfer compliance", replace(recipe, reduction=Reduction()), place, side, list(points), faces])


def computed_transfer(recipe: Recipe, place: tuple[float, float], side: Side, points: Sequence[Point], faces: int = 0) -> Floats:
    """Compute the compliances between a place and points; takes and raises what `transfer_compliances` does."""
    shape, nu = recipe.shape, recipe.poissons_ratio
    flat = isinstance(shape, PlateOfPlates)
    thin = is_thin(recipe)
    square = faces * _square(nu) if flat else 0.0
    within = _disc_of_an_element(shape, place) if isinstance(shape, PlateOfPlates) else 0.0

    def spread(thickness: float) -> Average:
        return Average(within, 3.0) if thin else Average(_RADIUS * thickness, 3.0 - 6.0 * square / _RADIUS**2)

    structure, thickness, displacements = response_to_spread_force(recipe, place, side, spread)
    found = np.empty((len(points), 3))
    for number, (point, face) in enumerate(points):
        motion, _ = surface_motion(structure.mesh, np.array([point]), face, thickness if flat else 0.0, "a sensor")
        found[number] = motion @ displacements
        if flat and not thin:
            apart = math.dist(point, place)
            found[number, 2] += near_term(apart, face == side, thickness, recipe.youngs_modulus, nu, faces)
        elif thin and within:
            rigidity = recipe.youngs_modulus * thickness**3 / (12.0 * (1.0 - nu**2))
            found[number, 2] += thin_near_term(math.dist(point, place), within, rigidity)
    return found


def _disc_of_an_element(shape: PlateOfPlates, place: tuple[float, float]) -> float:
    """Return the radius [m] of a disc around a place that elements resolve, or zero where it would reach beyond the plate."""
    room = min(0.5 * side - abs(at) for side, at in zip(shape.size[:2], place, strict=True))
    return shape.element_size if room > shape.element_size else 0.0


def thin_near_term(distance: float, radius: float, rigidity: float) -> float:
    r"""Return by how much more Kirchhoff's plate moves under a unit point force than under one spread over a disc [m/N].

    It is the inverse Hankel transform of :math:`(1 - A(k)) / (D k^4)`, with A that of the weighted disc, whose mean of r^2 is zero: so
    there is nothing beyond the disc.

    Parameters
    ----------
    distance, radius : float
        From the centre, and of the disc [m].
    rigidity : float
        D [N m].

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
    y, weights = _gauss_rule(math.ceil(0.5 * _FINEST))  # k times the radius
    less = (1.0 - Average(1.0, 3.0).transform(y)) / y**3 * jv(0, y * distance / radius)
    return float(less @ weights) * radius**2 / (2.0 * math.pi * rigidity)


def near_term(distance: float, same_face: bool, thickness: float, youngs_modulus: float, poissons_ratio: float, faces: int = 0) -> float:
    r"""Return by how much more a plate moves near a unit force than plate theory gives for the force spread over the disc [m/N].

    Parameters
    ----------
    distance : float
        Along the plate [m].
    same_face : bool
        Is it on the face that the force acts on? There a point force moves it by :math:`(1 - \nu^2)/(\pi E r)` besides, without bound;
        closer than 0.05 thicknesses that of this distance is returned.
    thickness, youngs_modulus, poissons_ratio : float
        h [m], E [Pa] and nu [-].
    faces : int, default 0
        As `transfer_compliances` takes it.

    Notes
    -----
    The inverse Hankel transform of the difference between the kernels of an elastic layer (I. N. Sneddon, Fourier Transforms, 1951,
    section 46) and of R. D. Mindlin's theory (J. Appl. Mech. 18:31, 1951) times the transform of the disc, without what is long in range.

    Examples
    --------
    >>> near_term(0.05, True, 0.01, 210e9, 0.3)  # five thicknesses away
    0.0
    """
    from scipy.special import jv

    if distance > _NEAR * thickness:
        return 0.0
    modulus, factor = youngs_modulus / (1.0 - poissons_ratio**2), shear_factor(poissons_ratio)
    rigidity = modulus * thickness**3 / 12.0
    shear = factor * 0.5 * (1.0 - poissons_ratio) * modulus * thickness
    apart = max(distance, _LEAST * thickness) if same_face else distance
    y, weights = _gauss_rule(math.ceil(0.5 * _FINEST * max(1.0, apart / thickness)))  # k h
    k = y / thickness
    bending, squeezing = layer_kernels(y)
    layer = bending + squeezing - 1.0 if same_face else bending - squeezing
    square = _square(poissons_ratio)
    average = Average(_RADIUS * thickness, 3.0 - 6.0 * faces * square / _RADIUS**2)
    longer = 0.25 * (2 - faces) * square * thickness**2 / rigidity  # what the modes of plate theory have too much
    plate = (1.0 / (rigidity * k**4) + (1.0 / shear - longer) / k**2) * average.transform(k)
    kernel = (2.0 / (modulus * k) * layer - plate) * jv(0, k * apart)
    near = float(kernel @ (k * weights)) / thickness / (2.0 * math.pi)
    return near + (1.0 / (math.pi * modulus * apart) if same_face else 0.0)


def _square(poissons_ratio: float) -> float:
    """Return `mean_square` in thicknesses squared."""
    return mean_square(1.0, poissons_ratio, shear_factor(poissons_ratio))


def _gauss_rule(parts: int) -> tuple[Floats, Floats]:
    """Return nodes and weights of Gauss's rule on equal parts of the integral."""
    nodes, weights = np.polynomial.legendre.leggauss(_NODES)
    places = (np.arange(parts)[:, None] + 0.5 * (nodes + 1.0)).ravel() * (_FINEST / parts)
    return places, np.tile(weights, parts) * (0.5 * _FINEST / parts)
