"""A modal model: the modes of a body on its mesh, as they are computed, stored and drawn; and the modal basis seen at points."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, TypeVar

import numpy as np
from scipy.sparse import csr_array

from vibroimpact.arrays import Floats
from vibroimpact.structures.damping import Damping
from vibroimpact.structures.disc import HERTZ, disc_points
from vibroimpact.structures.geometry import MassProperties
from vibroimpact.structures.memory_cache import Recent
from vibroimpact.structures.mesh import Mesh
from vibroimpact.structures.modes import Eigenmodes
from vibroimpact.structures.supports.constraints import HeldStructure
from vibroimpact.structures.surface import Side, Spot, place_of, surface_motion

_REMEMBERED = 2e6  # bytes of modes at places

Found = TypeVar("Found")


@dataclass(frozen=True)
class ModalModel:
    """The modes of a body on its mesh.

    Parameters
    ----------
    mesh : Mesh
        The elements.
    properties : MassProperties
        Mass, centre of mass and inertia of the mesh.
    angular_frequencies : array, shape (modes,)
        [rad/s], ascending; rigid motions are not among them.
    shapes : array, shape (modes, dofs)
        Of unit modal mass [kg^-1/2], on the degrees of freedom of the nodes.
    participation : array, shape (modes, 6)
        Momentum of each mode along x, y and z [kg^1/2], and angular momentum about the centre of mass [kg^1/2 m].
    left : array, shape (r, 6)
        The rigid motions that the supports leave: how much of each translation, and of each rotation about the centre of mass.
    frequency_errors : array, shape (modes,)
        By what part each frequency may be off [-]; NaN where it is not known.
    thickness : float, default 0
        Thickness of plate elements [m].
    facts : mapping of str to str
        How it was made, in words.
    """

    mesh: Mesh
    properties: MassProperties
    angular_frequencies: Floats
    shapes: Floats
    participation: Floats
    left: Floats
    frequency_errors: Floats
    thickness: float = 0.0
    facts: Mapping[str, str] = field(default_factory=dict)

    @property
    def frequencies(self) -> Floats:
        """Frequencies [Hz]."""
        return np.asarray(self.angular_frequencies / (2.0 * np.pi))

    @property
    def is_held_vertically(self) -> bool:
        """Do the supports stop every rigid motion that has a vertical part?"""
        return not np.abs(self.left[:, 2:5]).max(initial=0.0) > 1e-6 * np.abs(self.left).max(initial=0.0)

    @property
    def size(self) -> int:
        """About how many bytes it takes."""
        connectivity = sum(block.connectivity.nbytes for block in self.mesh.blocks)
        return int(self.shapes.nbytes + self.mesh.nodes.nbytes + connectivity)

    def scaled(self, length: float, density: float, youngs_modulus: float) -> ModalModel:
        r"""Return the modes of a similar body, of the same Poisson's ratio and of solid elements.

        Parameters
        ----------
        length, density, youngs_modulus : float
            How many times longer, denser and stiffer it is [-], > 0.

        Notes
        -----
        Lengths are the only scale of the geometry, and the speed of waves goes with :math:`\sqrt{E/\rho}`: angular frequencies go
        with :math:`\sqrt{E/\rho}\,/L`, and shapes of unit modal mass with :math:`(\rho L^3)^{-1/2}`.
        """
        mass, turning = density * length**3, np.repeat([1.0, length], 3)
        properties = self.properties
        return replace(
            self,
            mesh=replace(self.mesh, nodes=length * self.mesh.nodes),
            properties=MassProperties(mass * properties.mass, length * properties.centre, mass * length**2 * properties.inertia),
            angular_frequencies=math.sqrt(youngs_modulus / density) / length * self.angular_frequencies,
            shapes=self.shapes / math.sqrt(mass),
            participation=math.sqrt(mass) * turning * self.participation,
            left=self.left / turning,
        )

    def displacements(self, mode: int) -> Floats:
        """Return how the nodes move in a mode (from 0), shape (nodes, 3) [kg^-1/2]."""
        return np.asarray(self.shapes[mode].reshape(len(self.mesh.nodes), -1)[:, :3])

    def at(self, places: Floats, side: Side = "upper", what: str = "") -> tuple[Floats, Floats]:
        """Return the mode shapes at places on one side, shape (modes, points, 3), and where these lie, (points, 3) [m].

        `what` is there, for the message if it lies beside the body.

        Raises
        ------
        InputError
            If a place lies beside the body.
        """

        def found() -> tuple[Floats, Floats]:
            motion, positions = surface_motion(self.mesh, places, side, self.thickness, what)
            return self.in_modes(motion).reshape(len(self.shapes), -1, 3), positions

        return self.recalled(f"{side} {places.tolist()}", found) if len(places) == 1 else found()

    def recalled(self, key: str, compute: Callable[[], Found]) -> Found:
        """Return what is computed of the modes, or was lately: many drops on one plate ask for the same sensors. Leave it unchanged."""
        found = self._recent.find(key)
        if found is None:
            found = compute()
            self._recent.keep(key, found, 24.0 * len(self.shapes))
        return found

    @cached_property
    def _recent(self) -> Recent[Any]:
        return Recent(most=_REMEMBERED)

    def in_modes(self, motion: csr_array) -> Floats:
        """Return the values of linear functions of the degrees of freedom, the rows of a sparse array, in each mode, (modes, rows)."""
        dofs = np.unique(motion.indices)  # few of many: the others need not be read
        return np.asarray(self.shapes[:, dofs] @ motion[:, dofs].T.toarray())

    def averaged(self, place: tuple[float, float], radius: float, side: Side = "upper", what: str = "") -> Floats:
        """Return the mode shapes at a place, averaged over a disc with the weight of Hertz's pressure, shape (modes, 3) [kg^-1/2].

        Parameters
        ----------
        place : tuple of two floats
            x and y [m] of the middle.
        radius : float
            Of the disc [m]; of 0 it is the point.
        side : str, default "upper"
            "upper" or "lower".
        what : str, optional
            What is there, for the message if some of the disc lies beside the body.

        Raises
        ------
        InputError
            If some of the disc lies beside the body.
        """
        places, weights = disc_points(HERTZ)
        return np.asarray(np.einsum("mpi,p->mi", self.at(np.asarray(place) + radius * places, side, what)[0], weights))


def modal_model(
    held: HeldStructure, modes: Eigenmodes, facts: Mapping[str, str] | None = None, frequency_errors: Floats | None = None
) -> ModalModel:
    """Make the modal model of a held structure from the modes of its free degrees of freedom; without errors, these are not known."""
    structure, shapes = held.structure, np.asarray(held.expansion @ modes.shapes)
    moved = shapes.reshape(len(structure.mesh.nodes), -1, shapes.shape[1])[:, :3].reshape(-1, shapes.shape[1])
    large = np.abs(moved) > 0.5 * np.abs(moved).max(axis=0)
    shapes *= np.sign(moved[large.argmax(axis=0), np.arange(shapes.shape[1])])  # the first large displacement is positive
    return ModalModel(
        structure.mesh,
        structure.properties,
        modes.angular_frequencies,
        np.ascontiguousarray(shapes.T),
        np.asarray(shapes.T @ (structure.mass @ structure.rigid_motions())),
        held.left,
        np.full(shapes.shape[1], np.nan) if frequency_errors is None else frequency_errors,
        structure.thickness,
        facts or {},
    )


@dataclass(frozen=True)
class ModalBasis:
    """What the dynamics know of an elastic body: its modes, seen at the contact point and at the points watched.

    Parameters
    ----------
    frequencies : array, shape (modes,)
        [Hz], ascending.
    damping_ratios : array, shape (modes,)
        [-].
    contact : array, shape (modes,)
        How far the contact point moves up in each mode of unit modal mass [kg^-1/2].
    participation : array, shape (modes, 3)
        Momentum of each mode [kg^1/2]; over the mass it is how far the centre of mass moves.
    points : mapping of str to array, shape (modes, 3)
        How the points watched move [kg^-1/2].
    mass : float, default NaN
        Mass of the whole body [kg].
    rotation : array, shape (modes, 3), optional
        How it turns as a whole [-]: of the modal velocities v, the energy of that is half the square of v times this.
    frequency_errors : array, shape (modes,), optional
        By what part each frequency may be off [-]; NaN where it is not known.
    residuals : mapping of str to array, shape (3,)
        How far the points watched move under a unit vertical force at the contact point beyond what these modes carry [m/N].
    """

    frequencies: Floats
    damping_ratios: Floats
    contact: Floats
    participation: Floats
    points: Mapping[str, Floats] = field(default_factory=dict)
    mass: float = np.nan
    rotation: Floats | None = None
    frequency_errors: Floats | None = None
    residuals: Mapping[str, Floats] = field(default_factory=dict)

    @property
    def angular_frequencies(self) -> Floats:
        """Angular frequencies [rad/s]."""
        return np.asarray(2.0 * np.pi * self.frequencies)


def modal_basis(
    model: ModalModel,
    damping: Damping,
    contact: Spot,
    side: Side,
    points: Mapping[str, tuple[Spot, Side]] | None = None,
) -> ModalBasis:
    """Return the modes of a model seen at its contact point and at the points watched.

    Parameters
    ----------
    model : ModalModel
        The modes.
    damping : Damping
        What gives them their damping ratios.
    contact : tuple of two floats, str or None
        The contact point: x and y [m]; the name of a set of nodes, whose middle is meant; or the point that reaches farthest.
    side : str
        Where it is: "upper" or "lower".
    points : mapping of str to (spot, side), optional
        The points watched.

    Raises
    ------
    InputError
        If a point is not on the body.
    """

    def seen(spot: Spot, face: Side, what: str = "the contact point") -> Floats:
        return model.at(np.array([place_of(model.mesh, spot, face)]), face, what)[0][:, 0]

    return ModalBasis(
        model.frequencies,
        damping.ratios(model.frequencies),
        seen(contact, side)[:, 2],
        model.participation[:, :3],
        {name: seen(*point, f'sensor "{name}"') for name, point in (points or {}).items()},
        model.properties.mass,
        _rotation(model.properties, model.participation[:, 3:]),
        model.frequency_errors,
    )


def rigid_basis(model: ModalModel, contact: tuple[Spot, Side], points: Mapping[str, tuple[Spot, Side]]) -> ModalBasis | None:
    """Return the rigid motions that the supports leave a body, as modes of frequency zero; None if they leave none.

    Parameters
    ----------
    model : ModalModel
        The body.
    contact : (spot, side)
        The contact point.
    points : mapping of str to (spot, side)
        The points watched.
    """
    if not len(model.left):
        return None
    properties = model.properties
    weights = np.zeros((6, 6))
    weights[:3, :3], weights[3:, 3:] = properties.mass * np.eye(3), properties.inertia
    motions = np.linalg.solve(np.linalg.cholesky(model.left @ weights @ model.left.T), model.left)  # of unit modal mass
    along, turning = motions[:, :3], motions[:, 3:]

    def seen(spot: Spot, side: Side) -> Floats:
        place = surface_motion(model.mesh, np.array([place_of(model.mesh, spot, side)]), side, model.thickness)[1][0]
        return np.asarray(along + np.cross(turning, place - properties.centre))

    return ModalBasis(
        np.zeros(len(motions)),
        np.zeros(len(motions)),
        seen(*contact)[:, 2],
        properties.mass * along,
        {name: seen(*point) for name, point in points.items()},
        properties.mass,
        _rotation(properties, turning @ properties.inertia),
    )


def _rotation(properties: MassProperties, momentum: Floats) -> Floats:
    """Return angular momenta of modes in the root of the inertia: half their squares are energy of rotation."""
    moments, axes = np.linalg.eigh(properties.inertia)
    return np.asarray(momentum @ axes / np.sqrt(moments))
