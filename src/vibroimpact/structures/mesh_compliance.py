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
are spread. The series converges slowly. With :math:`x = k / k_s` and the weight :math:`w = (1 +
x^2)\,e^{-x^2}` the sum of w c ends after few terms, and that of (1 - w) c is the field near the
force, of which the images at the edges have no part: :math:`\int_0^\infty (1 - w)\,c\,k\,dk /
2\pi`.
"""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.materials import Material
from vibroimpact.structures.finite_elements.mesh import Mesh
from vibroimpact.structures.finite_elements.plate_element import shear_factor
from vibroimpact.structures.finite_elements.plate_mesh import plate_mesh
from vibroimpact.structures.finite_elements.structure import plate_structure
from vibroimpact.structures.finite_elements.surface import element_at
from vibroimpact.structures.modes import ElasticSystem
from vibroimpact.structures.plate_compliance import Average
from vibroimpact.structures.recipe import Recipe, plate_key
from vibroimpact.structures.static_compliance import averaged_compliances, plate_element_average
from vibroimpact.structures.store import key_of
from vibroimpact.structures.supports.constraints import HeldStructure
from vibroimpact.structures.supports.edge import EDGES, Edge
from vibroimpact.structures.supports.support import held_by

# elements along each side of the small plate; five change what is lacking by less than 0.2 %
_ACROSS = 3
# wave number k_s times the shorter side of an element: the field of (1 - w) c falls to 1e-15 within
# two sides
_SPLIT = 6.0
_END = 6.0  # wave number at which the sum ends, over k_s: w is 1e-14
_LOG_STEP = 0.005  # of the rule of the integral, in ln k
# ends of the integral, relative to the least and the greatest of its scales
_BELOW = 1e-4
_ABOVE = 1e3
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
    sides = np.linalg.norm(np.roll(corners, -1, axis=0) - corners, axis=1)
    length = _rounded(0.5 * (sides[0] + sides[2]))
    width = _rounded(0.5 * (sides[1] + sides[3]))
    small_plate = _small_plate(length, width, thickness, material, thin)
    # in the middle element, whose centre is that of the plate
    position = (float((local[0] - 0.5) * length), float((local[1] - 0.5) * width))
    return max(0.0, small_plate.exact_compliance(position) - small_plate.compliance(position))


def mesh_compliance_key(recipe: Recipe, place: tuple[float, float]) -> str:
    """Return the key of what the elements of a plate lack at a place, in the store."""
    return key_of(["compliance of the mesh", plate_key(recipe), place])


def _rounded(length: float) -> float:
    """Return a length without the last digits, as those of equal elements differ by rounding."""
    return float(f"{length:.{_DIGITS}g}")


@dataclass(frozen=True)
class _SmallPlate:
    """A simply supported plate of equal elements.

    Length and width are those of an element [m].
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

    def compliance(self, position: tuple[float, float]) -> float:
        """Return the compliance of its elements at a position from the centre [m/N]."""
        held, elastic = self._elements
        return float(averaged_compliances(held, elastic, [position], [self.average])[0])

    @cached_property
    def _elements(self) -> tuple[HeldStructure, ElasticSystem]:
        """The finite elements with simply supported edges, and their factorised system."""
        steps = [number - 0.5 * _ACROSS for number in range(1, _ACROSS)]
        lines = ([self.length * step for step in steps], [self.width * step for step in steps])
        # larger than any element, so that the lines alone divide the plate
        element_size = 2.0 * max(self.length, self.width)
        mesh = plate_mesh(self.size, element_size, lines=lines)
        theory = "thin" if self.thin else "thick"
        structure = plate_structure(mesh, self.material, self.thickness, theory)
        held = held_by(structure, tuple(Edge(edge, "simply-supported") for edge in EDGES))
        return held, ElasticSystem(held.stiffness, held.mass, held.rigid, held.order)

    def exact_compliance(self, position: tuple[float, float]) -> float:
        """Return the compliance of plate theory at a position from the centre [m/N]."""
        # Navier's double series: 4/(a b) sum of w c sin^2(m pi x/a) sin^2(n pi y/b)
        wave_numbers = []
        squared_sines = []
        for side, coordinate in zip(self.size, position, strict=True):
            terms = math.ceil(_END * self._split * side / math.pi)
            k_along = np.arange(1, terms + 1) * math.pi / side
            from_edge = coordinate + 0.5 * side
            wave_numbers.append(k_along)
            squared_sines.append(np.sin(k_along * from_edge) ** 2)
        k = np.hypot(wave_numbers[0][:, None], wave_numbers[1])
        coefficients = self._weight(k) * self._spectrum(k)
        series = squared_sines[0] @ coefficients @ squared_sines[1]
        area = math.prod(self.size)
        return 4.0 / area * float(series) + self._near

    @cached_property
    def _near(self) -> float:
        """The integral of (1 - w) c, by the trapezoidal rule in ln k."""
        scales = [self._split]
        if self.average.radius:
            scales.append(1.0 / self.average.radius)
        start = math.log(_BELOW * min(scales))
        end = math.log(_ABOVE * max(scales))
        k = np.exp(np.arange(start, end, _LOG_STEP))
        integrand = (1.0 - self._weight(k)) * self._spectrum(k) * k**2  # k dk = k^2 d ln k
        return float(integrand.sum()) * _LOG_STEP / (2.0 * math.pi)

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
        # Mindlin: 1/(D k^4) + 1/(kappa G h k^2), the latter zero for the thin plate
        modulus = self.material.youngs_modulus
        ratio = self.material.poissons_ratio
        rigidity = modulus * self.thickness**3 / (12.0 * (1.0 - ratio**2))
        if self.thin:
            shear_stiffness = math.inf
        else:
            shear_stiffness = shear_factor(ratio) * modulus * self.thickness / (2.0 * (1.0 + ratio))
        plate_theory = 1.0 / (rigidity * k**4) + 1.0 / (shear_stiffness * k**2)
        return np.asarray(plate_theory * self.average.transform(k) ** 2)


_small_plate = functools.lru_cache(maxsize=_PLATES)(_SmallPlate)
