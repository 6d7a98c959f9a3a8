"""Bar under the plate: an elastic column, fixed to the ground."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.materials import Material
from vibroimpact.structures.finite_elements.rectangle import Disc
from vibroimpact.structures.finite_elements.structure import rotation_columns
from vibroimpact.structures.supports.constraints import Constraints
from vibroimpact.structures.supports.support import Support, nodes_within

_ELEMENTS = 8  # of the column, for an error of 1e-5 of its first bending frequency


@dataclass(frozen=True)
class Bar(Support):
    """Round elastic column, fixed to the ground.

    Its top is a rigid disc attached to the lower side of the plate.

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
        """Return the rigid motions of the column about the plate's centre of mass, (dofs, 6)."""
        motions = np.zeros((_ELEMENTS, 6, 6))
        motions[:, :3, :3] = np.eye(3)
        motions[:, 3:, 3:] = np.eye(3)
        depths = self.length * (1.0 - np.arange(1, _ELEMENTS + 1) / _ELEMENTS)  # below the top
        nodes = top - centre - np.outer(depths, [0.0, 0.0, 1.0])
        motions[:, :3, 3:] = rotation_columns(*nodes.T)
        return motions.reshape(-1, 6)


def column_matrices(
    radius: float, length: float, material: Material, elements: int
) -> tuple[Floats, Floats]:
    r"""Return stiffness and mass of a round column of Timoshenko beam elements.

    It is fixed at its lower end.

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
    element_matrices = np.array(_beam_matrices(radius, length / elements, material))
    # all elements have the same matrices; neighbours share a node of six degrees of freedom
    size = 6 * (elements + 1)
    column = np.zeros((2, size, size))
    for element in range(elements):
        dofs = slice(6 * element, 6 * element + 12)
        column[:, dofs, dofs] += element_matrices
    stiffness, mass = column[:, 6:, 6:]  # without the fixed end
    return stiffness, mass


def _beam_matrices(radius: float, length: float, material: Material) -> tuple[Floats, Floats]:
    """Return the stiffness and the mass of one beam element, (12, 12)."""
    modulus = material.youngs_modulus
    ratio = material.poissons_ratio
    density = material.density
    shear_modulus = modulus / (2.0 * (1.0 + ratio))
    area = np.pi * radius**2
    second_moment = 0.25 * np.pi * radius**4
    polar_moment = 2.0 * second_moment
    # 12 E I / (kappa G A L^2), with Cowper's shear coefficient kappa
    shear_flexibility = (
        12.0
        * modulus
        * second_moment
        / (shear_modulus * area * 6.0 * (1.0 + ratio) / (7.0 + 6.0 * ratio) * length**2)
    )
    stiffness, mass = np.zeros((2, 12, 12))

    # stretching and torsion: linear between the two nodes
    linear_stiffness = np.array([[1.0, -1.0], [-1.0, 1.0]])
    linear_mass = np.array([[2.0, 1.0], [1.0, 2.0]]) / 6.0
    torsional_rigidity = shear_modulus * 2.0 * second_moment
    for dof, rigidity, inertia in (
        (2, modulus * area, area),
        (5, torsional_rigidity, polar_moment),
    ):
        ends = np.ix_([dof, dof + 6], [dof, dof + 6])
        stiffness[ends] = rigidity / length * linear_stiffness
        mass[ends] = density * inertia * length * linear_mass

    # bending: w' is +theta_y for u, and -theta_x for v
    bending_stiffness, bending_mass = _bending(
        length, shear_flexibility, modulus * second_moment, density * area, density * second_moment
    )
    for displacement, rotation, sign in ((0, 4, 1.0), (1, 3, -1.0)):
        numbers = [displacement, rotation, displacement + 6, rotation + 6]
        dofs = np.ix_(numbers, numbers)
        signs = np.array([1.0, sign, 1.0, sign])
        stiffness[dofs] += np.outer(signs, signs) * bending_stiffness
        mass[dofs] += np.outer(signs, signs) * bending_mass
    return stiffness, mass


def _bending(
    length: float,
    shear_flexibility: float,
    rigidity: float,
    line_mass: float,
    line_inertia: float,
) -> tuple[Floats, Floats]:
    """Return the bending stiffness and mass of one beam for deflection and slope at both ends.

    The mass is integrated from the shape functions of deflection and slope at Gauss points.
    `shear_flexibility` is the ratio of shear to bending flexibility.
    """
    # cubic shape functions of deflection; those with phi are of the shear that bending causes
    phi = shear_flexibility
    points, weights = np.polynomial.legendre.leggauss(4)
    s = 0.5 * (points + 1.0)  # from one end to the other, 0 to 1
    weights = 0.5 * length * weights
    scale = 1.0 / (1.0 + phi)
    deflection = scale * np.array(
        [
            1 - 3 * s**2 + 2 * s**3 + phi * (1 - s),
            length * (s - 2 * s**2 + s**3 + 0.5 * phi * (s - s**2)),
            3 * s**2 - 2 * s**3 + phi * s,
            length * (-(s**2) + s**3 - 0.5 * phi * (s - s**2)),
        ]
    )
    slope = scale * np.array(
        [
            (-6 * s + 6 * s**2) / length,
            1 - 4 * s + 3 * s**2 + phi * (1 - s),
            (6 * s - 6 * s**2) / length,
            -2 * s + 3 * s**2 + phi * s,
        ]
    )
    mass = (
        line_mass * (deflection * weights) @ deflection.T
        + line_inertia * (slope * weights) @ slope.T
    )
    # Przemieniecki's stiffness in closed form, E I/((1 + phi) L^3) times 12, 6 L, (4 + phi) L^2 ...
    a = 12.0 / length**3
    b = 6.0 / length**2
    c = 1.0 / length
    coefficients = np.array(
        [
            [a, b, -a, b],
            [b, (4 + phi) * c, -b, (2 - phi) * c],
            [-a, -b, a, -b],
            [b, (2 - phi) * c, -b, (4 + phi) * c],
        ]
    )
    return rigidity * scale * coefficients, mass
