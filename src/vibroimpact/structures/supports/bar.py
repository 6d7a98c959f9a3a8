"""Bar under the plate: an elastic column, fixed to the ground."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.materials import Material
from vibroimpact.structures.rectangle import Disc
from vibroimpact.structures.structure import rotation_columns
from vibroimpact.structures.supports.constraints import Constraints
from vibroimpact.structures.supports.support import Support, nodes_within

_ELEMENTS = 8  # of the column, for an error of 1e-5 of its first bending frequency


@dataclass(frozen=True)
class Bar(Support):
    """Round elastic column, fixed to the ground; its top is a rigid disc attached to the lower side
    of the plate.

    Parameters
    ----------
    x, y : float
        Position of its axis [m].
    radius, length : float
        Radius and length of the column [m], > 0.
    material : Material
        Material of the column.
    """

    x: float
    y: float
    radius: float
    length: float
    material: Material

    @property
    def description(self) -> str:
        """Short description for users."""
        return (
            f"bar of radius {self.radius:g} m and length {self.length:g} m at ({self.x:g}, "
            f"{self.y:g}) m"
        )

    @property
    def discs(self) -> Sequence[Disc]:
        """The top of the bar."""
        return (Disc(self.x, self.y, self.radius),)

    def hold(self, constraints: Constraints) -> None:
        """Add the column, and attach the nodes above it to its top."""
        structure = constraints.structure
        nodes = nodes_within(structure, self.x, self.y, self.radius, "the bar")
        height = structure.mesh.nodes[nodes, 2].mean() - 0.5 * structure.thickness
        top = np.array([self.x, self.y, height])
        stiffness, mass = column_matrices(self.radius, self.length, self.material, _ELEMENTS)
        dofs = constraints.add_body(stiffness, mass, self._rigid(top, structure.properties.centre))
        constraints.attach(nodes, self.radius, (dofs[-6:], top))

    def _rigid(self, top: Floats, centre: Floats) -> Floats:
        """Return the rigid motions of the column about the centre of mass of the plate,
        (dofs, 6).
        """
        motions = np.zeros((_ELEMENTS, 6, 6))
        motions[:, :3, :3] = motions[:, 3:, 3:] = np.eye(3)
        at = (
            top
            - centre
            - np.outer(
                self.length * (1.0 - np.arange(1, _ELEMENTS + 1) / _ELEMENTS), [0.0, 0.0, 1.0]
            )
        )
        motions[:, :3, 3:] = rotation_columns(*at.T)
        return motions.reshape(-1, 6)


def column_matrices(
    radius: float, length: float, material: Material, elements: int
) -> tuple[Floats, Floats]:
    r"""Return stiffness and mass of a round column of Timoshenko beam elements, fixed at its lower
    end.

    Parameters
    ----------
    radius, length : float
        Radius and length of the column [m], > 0.
    material : Material
        Material of the column.
    elements : int
        Number of beam elements.

    Returns
    -------
    stiffness, mass : array, shape (6 elements, 6 elements)
        Three displacements and three rotations per node; the last six are those of the top.

    Notes
    -----
    Two-node beams with the exact static shape functions, consistent mass with rotary inertia (J. S.
    Przemieniecki, Theory of Matrix Structural Analysis, 1968); shear coefficient 6 (1 + nu) / (7 +
    6 nu) of a round section (G. R. Cowper, J. Appl. Mech. 33:335, 1966).

    Examples
    --------
    >>> steel = Material(density=7850.0, youngs_modulus=210e9, poissons_ratio=0.3)
    >>> stiffness, _ = column_matrices(0.02, 0.3, steel, 4)
    >>> stretch = np.linalg.inv(stiffness)[-4, -4]
    >>> round(float(stretch) * 210e9 * np.pi * 0.02**2 / 0.3, 9)
    1.0
    """
    modulus, ratio, step = material.youngs_modulus, material.poissons_ratio, length / elements
    shear_modulus = modulus / (2.0 * (1.0 + ratio))
    area = np.pi * radius**2
    second = 0.25 * np.pi * radius**4
    flexible = (
        12.0
        * modulus
        * second
        / (shear_modulus * area * 6.0 * (1.0 + ratio) / (7.0 + 6.0 * ratio) * step**2)
    )
    pair, share = np.array([[1.0, -1.0], [-1.0, 1.0]]), np.array([[2.0, 1.0], [1.0, 2.0]]) / 6.0
    stiffness, mass = np.zeros((2, 12, 12))
    for dof, rigidity, inertia in (
        (2, modulus * area, area),
        (5, shear_modulus * 2.0 * second, 2.0 * second),
    ):
        both = np.ix_([dof, dof + 6], [dof, dof + 6])
        stiffness[both], mass[both] = (
            rigidity / step * pair,
            material.density * inertia * step * share,
        )
    bend, heave = _bending(
        step, flexible, modulus * second, material.density * area, material.density * second
    )
    # w' is +theta_y for u, and -theta_x for v
    for displacement, rotation, sign in ((0, 4, 1.0), (1, 3, -1.0)):
        dofs = [displacement, rotation, displacement + 6, rotation + 6]
        turn = np.array([1.0, sign, 1.0, sign])
        stiffness[np.ix_(dofs, dofs)] += np.outer(turn, turn) * bend
        mass[np.ix_(dofs, dofs)] += np.outer(turn, turn) * heave
    whole = np.zeros((2, 6 * (elements + 1), 6 * (elements + 1)))
    for element in range(elements):
        part = slice(6 * element, 6 * element + 12)
        whole[:, part, part] += np.array([stiffness, mass])
    return whole[0, 6:, 6:], whole[1, 6:, 6:]


def _bending(
    step: float, flexible: float, rigidity: float, line_mass: float, line_inertia: float
) -> tuple[Floats, Floats]:
    """Return the stiffness of one beam for deflection and slope at both ends, and its
    mass integrated from its shape functions.
    """
    # Shape functions of deflection and slope at Gauss points; `flexible` is the ratio of shear to
    # bending flexibility
    points, weights = np.polynomial.legendre.leggauss(4)
    s, weights = 0.5 * (points + 1.0), 0.5 * step * weights
    scale = 1.0 / (1.0 + flexible)
    deflection = scale * np.array(
        [
            1 - 3 * s**2 + 2 * s**3 + flexible * (1 - s),
            step * (s - 2 * s**2 + s**3 + 0.5 * flexible * (s - s**2)),
            3 * s**2 - 2 * s**3 + flexible * s,
            step * (-(s**2) + s**3 - 0.5 * flexible * (s - s**2)),
        ]
    )
    slope = scale * np.array(
        [
            (-6 * s + 6 * s**2) / step,
            1 - 4 * s + 3 * s**2 + flexible * (1 - s),
            (6 * s - 6 * s**2) / step,
            -2 * s + 3 * s**2 + flexible * s,
        ]
    )
    mass = (
        line_mass * (deflection * weights) @ deflection.T
        + line_inertia * (slope * weights) @ slope.T
    )
    # The stiffness is known in closed form
    a, b, c = 12.0 / step**3, 6.0 / step**2, 1.0 / step
    stiffness = (
        rigidity
        * scale
        * np.array(
            [
                [a, b, -a, b],
                [b, (4 + flexible) * c, -b, (2 - flexible) * c],
                [-a, -b, a, -b],
                [b, (2 - flexible) * c, -b, (4 + flexible) * c],
            ]
        )
    )
    return stiffness, mass
