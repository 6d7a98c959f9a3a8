r"""Compliance that the elements of a plate lack at a place.

Elements much larger than the thickness do not follow the field of a point force. A conforming mesh
is too stiff, and near a force most of what it lacks is lost in the elements around: the deflection
there is that of a point force on an infinite plate, which no polynomial over an element follows,
while the rest of the field is smooth. The same elements around the same place of a small plate lack
the same. That plate is of three by three elements and simply supported, so that its exact
compliance is a double series of sines (R. D. Mindlin, J. Appl. Mech. 18:31, 1951; of thin plates C.
L. M. H. Navier's),

.. math::

    C = \frac{4}{a b} \sum_{m,n} s_{mn}^2\, c(k_{mn}),\qquad
    c(k) = \left(\frac{1}{D k^4} + \frac{1}{\kappa G h k^2}\right) d(k)^2

with the sines s at the place and the transform d of the average over which force and displacement
are spread. The series converges
slowly. With :math:`x = k / k_s` and the weight :math:`w = (1 + x^2)\,e^{-x^2}` the sum of w c ends
after few terms, and that of
(1 - w) c is the field near the force, of which the images at the edges have no part:
:math:`\int_0^\infty (1 - w)\,c\,k\,dk / 2\pi`.
"""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.materials import Material
from vibroimpact.structures.mesh import Mesh
from vibroimpact.structures.modes import ElasticSystem
from vibroimpact.structures.plate_compliance import Average
from vibroimpact.structures.plate_element import shear_factor
from vibroimpact.structures.plate_mesh import plate_mesh
from vibroimpact.structures.recipe import Recipe, plate_key
from vibroimpact.structures.static_compliance import averaged_compliances, plate_element_average
from vibroimpact.structures.store import key_of
from vibroimpact.structures.structure import plate_structure
from vibroimpact.structures.supports.constraints import HeldStructure
from vibroimpact.structures.supports.edge import EDGES, Edge
from vibroimpact.structures.supports.support import held_by
from vibroimpact.structures.surface import element_at

# elements along each side of the small plate; five change what is lacking by less than 0.2 %
_ACROSS = 3
# wave number k_s times the shorter side of an element: the field of (1 - w) c falls to 1e-15 within
# two sides
_SPLIT = 6.0
_END = 6.0  # wave number at which the sum ends, over k_s: w is 1e-14
_LOG_STEP = 0.005  # of the rule of the integral, in ln k
# ends of the integral, relative to the least and the greatest of its scales
_BELOW, _ABOVE = 1e-4, 1e3
_PLATES = 16  # small plates that are kept, for other places on elements of the same size
_DIGITS = 9  # of the sides of an element; those of equal elements of a mesh differ by rounding


def mesh_compliance(
    mesh: Mesh, material: Material, thickness: float, place: tuple[float, float], thin: bool = False
) -> float:
    """Return the compliance that the elements of a plate lack at a place [m/N], >= 0.

    Parameters
    ----------
    mesh : Mesh
        Mesh of plate elements.
    material : Material
        Material of the plate.
    thickness : float
        Thickness [m].
    place : tuple of two floats
        x and y [m].
    thin : bool, default False
        Whether the plate is one of Kirchhoff's theory instead of Mindlin's.

    Raises
    ------
    InputError
        If the place is not on the body.

    Notes
    -----
    It is what `static_compliance` lacks of its limit for small elements, but for the smooth part of
    the field, which elements of order four resolve. Elements that are no rectangles count as such
    with the mean lengths of their sides. Closer to an edge of the plate than an element, the field
    of the edge is not included.

    Examples
    --------
    >>> steel = Material(density=7850.0, youngs_modulus=210e9, poissons_ratio=0.3)
    >>> mesh_compliance(plate_mesh((0.5, 0.4), 0.05), steel, 0.004, (0.01, 0.02)) > 1e-9
    True
    """
    corners, local = element_at(mesh, place)
    edges = np.linalg.norm(np.roll(corners, -1, axis=0) - corners, axis=1)
    small = _small_plate(
        _rounded(0.5 * (edges[0] + edges[2])),
        _rounded(0.5 * (edges[1] + edges[3])),
        thickness,
        material,
        thin,
    )
    at = float((local[0] - 0.5) * small.length), float((local[1] - 0.5) * small.width)
    return max(0.0, small.exact_compliance(at) - small.compliance(at))


def mesh_compliance_key(recipe: Recipe, place: tuple[float, float]) -> str:
    """Return the key of what the elements of a plate lack at a place, in the store."""
    return key_of(["compliance of the mesh", plate_key(recipe), place])


def _rounded(length: float) -> float:
    return float(f"{length:.{_DIGITS}g}")


@dataclass(frozen=True)
class _SmallPlate:
    """A simply supported plate of equal elements: length and width of an element [m], and
    what it is made of.
    """

    length: float
    width: float
    thickness: float
    material: Material
    thin: bool

    @property
    def size(self) -> tuple[float, float]:
        """Length and width of the plate [m]."""
        return _ACROSS * self.length, _ACROSS * self.width

    @property
    def average(self) -> Average:
        """The average over which force and displacement are spread."""
        return plate_element_average(self.thickness, self.material.poissons_ratio, self.thin)

    def compliance(self, at: tuple[float, float]) -> float:
        """Return the compliance of its elements at a place from the centre [m/N]."""
        return float(averaged_compliances(*self._elements, [at], [self.average])[0])

    @cached_property
    def _elements(self) -> tuple[HeldStructure, ElasticSystem]:
        lines = [
            [side * (number - 0.5 * _ACROSS) for number in range(1, _ACROSS)]
            for side in (self.length, self.width)
        ]
        mesh = plate_mesh(self.size, 2.0 * max(self.length, self.width), lines=(lines[0], lines[1]))
        structure = plate_structure(
            mesh, self.material, self.thickness, "thin" if self.thin else "thick"
        )
        held = held_by(structure, tuple(Edge(edge, "simply-supported") for edge in EDGES))
        return held, ElasticSystem(held.stiffness, held.mass, held.rigid, held.order)

    def exact_compliance(self, at: tuple[float, float]) -> float:
        """Return the compliance of plate theory at a place from the centre [m/N]."""
        waves = [
            np.arange(1, math.ceil(_END * self._split * side / math.pi) + 1) * math.pi / side
            for side in self.size
        ]
        sines = [
            np.sin(k * (place + 0.5 * side)) ** 2
            for k, place, side in zip(waves, at, self.size, strict=True)
        ]
        k = np.hypot(waves[0][:, None], waves[1])
        far = sines[0] @ (self._weight(k) * self._spectrum(k)) @ sines[1]
        return 4.0 / math.prod(self.size) * float(far) + self._near

    @cached_property
    def _near(self) -> float:
        """The integral of (1 - w) c, by the trapezoidal rule in ln k."""
        radius = self.average.radius
        scales = [self._split, 1.0 / radius] if radius else [self._split]
        k = np.exp(
            np.arange(math.log(_BELOW * min(scales)), math.log(_ABOVE * max(scales)), _LOG_STEP)
        )
        return (
            float(((1.0 - self._weight(k)) * self._spectrum(k) * k**2).sum())
            * _LOG_STEP
            / (2.0 * math.pi)
        )

    @property
    def _split(self) -> float:
        """The wave number k_s [1/m]."""
        return _SPLIT / min(self.length, self.width)

    def _weight(self, k: Floats) -> Floats:
        """Return w at wave numbers [1/m]."""
        square = (k / self._split) ** 2
        return np.asarray((1.0 + square) * np.exp(-square))

    def _spectrum(self, k: Floats) -> Floats:
        """Return c at wave numbers [1/m]."""
        modulus, ratio = self.material.youngs_modulus, self.material.poissons_ratio
        rigidity = modulus * self.thickness**3 / (12.0 * (1.0 - ratio**2))
        shear = (
            math.inf
            if self.thin
            else shear_factor(ratio) * modulus * self.thickness / (2.0 * (1.0 + ratio))
        )
        return np.asarray(
            (1.0 / (rigidity * k**4) + 1.0 / (shear * k**2)) * self.average.transform(k) ** 2
        )


_small_plate = functools.lru_cache(maxsize=_PLATES)(_SmallPlate)
