"""Modal model of a body: its modes on the mesh, or at the contact point and at sensors.

The latter are the modal basis.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, TypeVar

import numpy as np
from scipy.sparse import csr_array

from vibroimpact.arrays import Floats
from vibroimpact.structures.damping import Damping
from vibroimpact.structures.finite_elements.disc_quadrature import HERTZ, pressure_rule
from vibroimpact.structures.finite_elements.geometry import MassProperties
from vibroimpact.structures.finite_elements.mesh import Mesh
from vibroimpact.structures.finite_elements.surface import Side, Spot, place_of, surface_motion
from vibroimpact.structures.finite_elements.surface_strain import surface_strain
from vibroimpact.structures.memory_cache import MemoryCache
from vibroimpact.structures.modes import Eigenmodes
from vibroimpact.structures.sound_paths import Listener, SoundPaths, sound_paths
from vibroimpact.structures.supports.constraints import HeldStructure

_CACHE_SIZE = 1e7  # bytes, of mode shapes at places and on the grid of a picture

Quantity = TypeVar("Quantity")


@dataclass(frozen=True)
class ModalModel:
    """Modes of a body on its mesh.

    Parameters
    ----------
    mesh : Mesh
        The finite elements.
    properties : MassProperties
        Mass, centre of mass and inertia of the mesh.
    angular_frequencies : array, shape (modes,)
        [rad/s], ascending, without rigid motions.
    shapes : array, shape (modes, dofs)
        Mode shapes of unit modal mass [kg^-1/2], on the degrees of freedom of the nodes.
    participation : array, shape (modes, 6)
        Momentum of each mode along x, y and z [kg^1/2], and angular momentum about the centre of
        mass [kg^1/2 m].
    rigid_coefficients : array, shape (r, 6)
        Rigid motions that the supports do not prevent, as coefficients of the three translations
        and of the three rotations about the centre of mass.
    frequency_errors : array, shape (modes,)
        Estimated relative error of each frequency [-]; NaN where unknown.
    thickness : float, default 0
        Thickness of plate elements [m].
    facts : mapping of str to str
        Facts on the computation, for users.
    """

    mesh: Mesh
    properties: MassProperties
    angular_frequencies: Floats
    shapes: Floats
    participation: Floats
    rigid_coefficients: Floats
    frequency_errors: Floats
    thickness: float = 0.0
    facts: Mapping[str, str] = field(default_factory=dict)

    @property
    def frequencies(self) -> Floats:
        """Natural frequencies [Hz]."""
        return np.asarray(self.angular_frequencies / (2.0 * np.pi))

    @property
    def is_held_vertically(self) -> bool:
        """Whether the supports prevent every rigid motion with a vertical component."""
        largest = np.abs(self.rigid_coefficients).max(initial=0.0)
        # translation along z, and rotations about x and y
        vertical = np.abs(self.rigid_coefficients[:, 2:5]).max(initial=0.0)
        return not vertical > 1e-6 * largest

    @property
    def size(self) -> int:
        """Approximate memory [bytes]."""
        connectivity = sum(block.connectivity.nbytes for block in self.mesh.blocks)
        return int(self.shapes.nbytes + self.mesh.nodes.nbytes + connectivity)

    def scaled(self, length: float, density: float, youngs_modulus: float) -> ModalModel:
        r"""Return the modes of a geometrically similar body of solid elements.

        Its Poisson's ratio is the same.

        Parameters
        ----------
        length, density, youngs_modulus : float
            Ratios of length, density and Young's modulus [-], > 0.

        Notes
        -----
        Wave speeds are proportional to :math:`\sqrt{E/\rho}`, hence angular frequencies to
        :math:`\sqrt{E/\rho}\,/L`, and shapes of unit modal mass to :math:`(\rho L^3)^{-1/2}`.
        """
        mass = density * length**3
        frequency = math.sqrt(youngs_modulus / density) / length
        arms = np.repeat([1.0, length], 3)  # of translations and rotations
        properties = MassProperties(
            mass * self.properties.mass,
            length * self.properties.centre,
            mass * length**2 * self.properties.inertia,
        )
        return replace(
            self,
            mesh=replace(self.mesh, nodes=length * self.mesh.nodes),
            properties=properties,
            angular_frequencies=frequency * self.angular_frequencies,
            shapes=self.shapes / math.sqrt(mass),
            participation=math.sqrt(mass) * arms * self.participation,
            rigid_coefficients=self.rigid_coefficients / arms,
        )

    def displacements(self, mode: int) -> Floats:
        """Return the displacements of the nodes in a mode, (nodes, 3) [kg^-1/2].

        Modes are numbered from 0.
        """
        return np.asarray(self.shapes[mode].reshape(len(self.mesh.nodes), -1)[:, :3])

    def at(self, places: Floats, side: Side = "upper", what: str = "") -> tuple[Floats, Floats]:
        """Return the mode shapes at places (x, y) on one side, and the positions of the places [m].

        They are (modes, points, 3) and (points, 3). `what` names the places in the message if one
        is not on the body.

        Raises
        ------
        InputError
            If a place is not on the body.
        """

        def shapes_at_places() -> tuple[Floats, Floats]:
            motion, positions = surface_motion(self.mesh, places, side, self.thickness, what)
            return self.modal_values(motion).reshape(len(self.shapes), -1, 3), positions

        if len(places) == 1:
            return self.cached(f"{side} {places.tolist()}", shapes_at_places)
        return shapes_at_places()

    def cached(self, key: str, compute: Callable[[], Quantity], numbers: int = 3) -> Quantity:
        """Return a quantity of the modes from the cache, or compute it. Do not change it.

        Many drops on one plate have the same sensors. `numbers` is how many it has for each mode.
        """
        quantity: Quantity | None = self._cache.get(key)
        if quantity is None:
            quantity = compute()
            self._cache.put(key, quantity, 8.0 * numbers * len(self.shapes))
        return quantity

    @cached_property
    def _cache(self) -> MemoryCache[Any]:
        """Quantities of the modes by key."""
        return MemoryCache(capacity=_CACHE_SIZE)

    def strains(self, place: tuple[float, float], side: Side) -> Floats:
        """Return the strains of a face at a place in each mode, (modes, 3) [kg^-1/2 m^-1].

        They are those along x and y, and of shear.

        Raises
        ------
        InputError
            If the place is not on the body.
        """
        rows = surface_strain(self.mesh, place, side, self.thickness)
        return self.cached(f"strain {side} {place}", lambda: self.modal_values(rows))

    def sound(self, listener: Listener) -> SoundPaths:
        """Return the paths of sound of the modes to a point, from the cache or computed.

        Errors are those of `sound_paths`.
        """
        diagonal = math.dist(self.mesh.nodes.min(axis=0), self.mesh.nodes.max(axis=0))
        delays = math.ceil(diagonal / (listener.speed * listener.step))  # about
        return self.cached(
            f"sound {listener}", lambda: sound_paths(self.mesh, listener, self.shapes), delays
        )

    def modal_values(self, motion: csr_array) -> Floats:
        """Return linear functions of the degrees of freedom in each mode, (modes, rows).

        The functions are the rows of a sparse array.
        """
        dofs = np.unique(motion.indices)  # a few of many columns
        return np.asarray(self.shapes[:, dofs] @ motion[:, dofs].T.toarray())

    def averaged(
        self, place: tuple[float, float], radius: float, side: Side = "upper", what: str = ""
    ) -> Floats:
        """Return the mode shapes averaged over a disc, (modes, 3) [kg^-1/2].

        The weight of the average is Hertz's pressure.

        Parameters
        ----------
        place : tuple of two floats
            x and y of the centre of the disc [m].
        radius : float
            Radius of the disc [m]; 0 for the point.
        side : str, default "upper"
            "upper" or "lower".
        what : str, optional
            Name of the place in the message if part of the disc is not on the body.

        Raises
        ------
        InputError
            If part of the disc is not on the body.
        """
        points, weights = pressure_rule(HERTZ)
        shapes, _ = self.at(np.asarray(place) + radius * points, side, what)
        return np.asarray(np.einsum("mpi,p->mi", shapes, weights))


def modal_model(
    held: HeldStructure,
    modes: Eigenmodes,
    facts: Mapping[str, str] | None = None,
    frequency_errors: Floats | None = None,
) -> ModalModel:
    """Return the modal model of a held structure from the modes of its free degrees of freedom.

    Errors that are not given are unknown (NaN).
    """
    structure = held.structure
    shapes = np.asarray(held.expansion @ modes.shapes)
    number_of_modes = shapes.shape[1]
    if frequency_errors is None:
        frequency_errors = np.full(number_of_modes, np.nan)
    # sign convention: the first large displacement is positive
    displacements = shapes.reshape(len(structure.mesh.nodes), -1, number_of_modes)[:, :3]
    displacements = displacements.reshape(-1, number_of_modes)
    is_large = np.abs(displacements) > 0.5 * np.abs(displacements).max(axis=0)
    first_large = displacements[is_large.argmax(axis=0), np.arange(number_of_modes)]
    shapes *= np.sign(first_large)
    return ModalModel(
        mesh=structure.mesh,
        properties=structure.properties,
        angular_frequencies=modes.angular_frequencies,
        shapes=np.ascontiguousarray(shapes.T),
        participation=np.asarray(shapes.T @ (structure.mass @ structure.rigid_motions())),
        rigid_coefficients=held.rigid_coefficients,
        frequency_errors=frequency_errors,
        thickness=structure.thickness,
        facts=facts or {},
    )


@dataclass(frozen=True)
class ModalBasis:
    """Modes of an elastic body, with their shapes at its contact point and at its sensors.

    Parameters
    ----------
    frequencies : array, shape (modes,)
        [Hz], ascending.
    damping_ratios : array, shape (modes,)
        [-].
    contact : array, shape (modes,)
        Upward displacement of the contact point in each mode of unit modal mass [kg^-1/2].
    participation : array, shape (modes, 3)
        Momentum of each mode [kg^1/2]; over the mass it is the displacement of the centre of mass.
    points : mapping of str to array, shape (modes, 3)
        Displacements of the sensors in each mode [kg^-1/2]; of strain gauges the strains along x
        and y and of shear [kg^-1/2 m^-1]; of force sensors the forces of the supports [N m^-1
        kg^-1/2].
    mass : float, default NaN
        Mass of the body [kg].
    rotation : array, shape (modes, 3), optional
        Rotation of the body as a whole [-]: its kinetic energy is half the squared norm of the
        modal velocities times this matrix.
    frequency_errors : array, shape (modes,), optional
        Estimated relative error of each frequency [-]; NaN where unknown.
    residuals : mapping of str to array, shape (3,)
        Residual compliances: static displacements of the sensors under a unit vertical force at the
        contact point, less those of these modes [m/N]; of strain gauges the strains [1/N]; of force
        sensors the forces [-].
    along : array, shape (modes, 2), optional
        Displacement of the contact point along x and y in each mode [kg^-1/2], by which friction
        moves the body.
    turning : array, shape (modes, 3), optional
        Rotation about x, y and z in each rigid motion [kg^-1/2 m^-1], by which moments at the
        contact turn the body; none by default.
    sounds : mapping of str to SoundPaths
        Paths of sound to the microphones.

    Examples
    --------
    >>> import numpy as np
    >>> import vibroimpact as vi
    >>> contact = np.array([1.0, -0.7])
    >>> modes = vi.ModalBasis(
    ...     np.array([200.0, 550.0]), np.array([0.01, 0.01]), contact, np.zeros((2, 3))
    ... )
    >>> plate = vi.Body(mass=10.0, contact_offset=0.0, modes=modes)
    >>> plate.modes.frequencies.tolist()
    [200.0, 550.0]
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
    along: Floats | None = None
    turning: Floats | None = None
    sounds: Mapping[str, SoundPaths] = field(default_factory=dict)

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
    strained: Mapping[str, tuple[Spot, Side]] | None = None,
    heard: Mapping[str, Listener] | None = None,
) -> ModalBasis:
    """Return the modes of a model at its contact point and at its sensors.

    Parameters
    ----------
    model : ModalModel
        The modes.
    damping : Damping
        Model of their damping ratios.
    contact : tuple of two floats, str or None
        Contact point: x and y [m]; the name of a set of nodes, for its centre; or None, for the
        highest or lowest point of the side.
    side : str
        Side of the contact point: "upper" or "lower".
    points : mapping of str to (spot, side), optional
        Sensors of motion by name.
    strained : mapping of str to (spot, side), optional
        Sensors of strain by name.
    heard : mapping of str to Listener, optional
        Microphones by name.

    Raises
    ------
    InputError
        If a point is not on the body.
    """

    def displacements_at(spot: Spot, face: Side, what: str) -> Floats:
        place = np.array([place_of(model.mesh, spot, face)])
        return model.at(place, face, what)[0][:, 0]

    strains = {
        name: model.strains(place_of(model.mesh, spot, face), face)
        for name, (spot, face) in (strained or {}).items()
    }
    at_contact = displacements_at(contact, side, "the contact point")
    at_sensors = {
        name: displacements_at(spot, face, f'sensor "{name}"')
        for name, (spot, face) in (points or {}).items()
    }
    return ModalBasis(
        frequencies=model.frequencies,
        damping_ratios=damping.ratios(model.frequencies),
        contact=at_contact[:, 2],
        participation=model.participation[:, :3],
        points=at_sensors | strains,
        mass=model.properties.mass,
        rotation=_rotation(model.properties, model.participation[:, 3:]),
        frequency_errors=model.frequency_errors,
        along=at_contact[:, :2],
        sounds={name: model.sound(listener) for name, listener in (heard or {}).items()},
    )


def rigid_basis(
    model: ModalModel,
    contact: tuple[Spot, Side],
    points: Mapping[str, tuple[Spot, Side]],
    strained: Iterable[str] = (),
    heard: Mapping[str, Listener] | None = None,
) -> ModalBasis | None:
    """Return the rigid motions that the supports do not prevent, as modes of frequency zero.

    It is None if there are none.

    Parameters
    ----------
    model : ModalModel
        The body.
    contact : (spot, side)
        Contact point.
    points : mapping of str to (spot, side)
        Sensors of motion by name.
    strained : iterable of str, optional
        Names of sensors of strain, which rigid motions leave zero.
    heard : mapping of str to Listener, optional
        Microphones by name.
    """
    if not len(model.rigid_coefficients):
        return None
    properties = model.properties
    mesh = model.mesh
    motions = _rigid_motions_of_unit_mass(properties, model.rigid_coefficients)
    number_of_motions = len(motions)
    translation = motions[:, :3]
    rotation = motions[:, 3:]

    def displacements_at(spot: Spot, side: Side) -> Floats:
        place = np.array([place_of(mesh, spot, side)])
        _, positions = surface_motion(mesh, place, side, model.thickness)
        return np.asarray(translation + np.cross(rotation, positions[0] - properties.centre))

    at_contact = displacements_at(*contact)
    at_sensors = {name: displacements_at(spot, side) for name, (spot, side) in points.items()}
    strains = {name: np.zeros((number_of_motions, 3)) for name in strained}
    # faces move by the displacements of their nodes
    nodes = np.zeros((number_of_motions, len(mesh.nodes), mesh.dofs_per_node))
    nodes[:, :, :3] = translation[:, None] + np.cross(
        rotation[:, None], mesh.nodes - properties.centre
    )
    shapes = nodes.reshape(number_of_motions, -1)
    sounds = {name: sound_paths(mesh, listener, shapes) for name, listener in (heard or {}).items()}
    return ModalBasis(
        frequencies=np.zeros(number_of_motions),
        damping_ratios=np.zeros(number_of_motions),
        contact=at_contact[:, 2],
        participation=properties.mass * translation,
        points=at_sensors | strains,
        mass=properties.mass,
        rotation=_rotation(properties, rotation @ properties.inertia),
        along=at_contact[:, :2],
        turning=rotation,
        sounds=sounds,
    )


def _rigid_motions_of_unit_mass(properties: MassProperties, coefficients: Floats) -> Floats:
    """Return combinations of rigid motions, (r, 6), that are orthonormal in the mass of the body.

    Coefficients are those of translations and of rotations about the centre of mass.
    """
    mass = np.zeros((6, 6))
    mass[:3, :3] = properties.mass * np.eye(3)
    mass[3:, 3:] = properties.inertia
    lower = np.linalg.cholesky(coefficients @ mass @ coefficients.T)
    return np.asarray(np.linalg.solve(lower, coefficients))


def _rotation(properties: MassProperties, momentum: Floats) -> Floats:
    """Return the angular momenta of modes over the square root of the inertia.

    Half their squares are the energy of rotation.
    """
    moments, axes = np.linalg.eigh(properties.inertia)
    return np.asarray(momentum @ axes / np.sqrt(moments))
