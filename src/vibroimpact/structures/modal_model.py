"""Modal model of a body: its modes on the mesh; and the modal basis: the same modes at
the contact point and at sensors.
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
from vibroimpact.structures.disc_quadrature import HERTZ, pressure_rule
from vibroimpact.structures.geometry import MassProperties
from vibroimpact.structures.memory_cache import MemoryCache
from vibroimpact.structures.mesh import Mesh
from vibroimpact.structures.modes import Eigenmodes
from vibroimpact.structures.sound_paths import Listener, SoundPaths, sound_paths
from vibroimpact.structures.supports.constraints import HeldStructure
from vibroimpact.structures.surface import Side, Spot, place_of, surface_motion
from vibroimpact.structures.surface_strain import surface_strain

_CACHE_SIZE = 1e7  # bytes, of mode shapes at places and on the grid of a picture

Found = TypeVar("Found")


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
        return not np.abs(self.rigid_coefficients[:, 2:5]).max(initial=0.0) > 1e-6 * np.abs(
            self.rigid_coefficients
        ).max(initial=0.0)

    @property
    def size(self) -> int:
        """Approximate memory [bytes]."""
        connectivity = sum(block.connectivity.nbytes for block in self.mesh.blocks)
        return int(self.shapes.nbytes + self.mesh.nodes.nbytes + connectivity)

    def scaled(self, length: float, density: float, youngs_modulus: float) -> ModalModel:
        r"""Return the modes of a geometrically similar body of solid elements with the same
        Poisson's ratio.

        Parameters
        ----------
        length, density, youngs_modulus : float
            Ratios of length, density and Young's modulus [-], > 0.

        Notes
        -----
        Wave speeds are proportional to :math:`\sqrt{E/\rho}`, hence angular frequencies to
        :math:`\sqrt{E/\rho}\,/L`, and shapes of
        unit modal mass to :math:`(\rho L^3)^{-1/2}`.
        """
        mass, turning = density * length**3, np.repeat([1.0, length], 3)
        properties = self.properties
        return replace(
            self,
            mesh=replace(self.mesh, nodes=length * self.mesh.nodes),
            properties=MassProperties(
                mass * properties.mass,
                length * properties.centre,
                mass * length**2 * properties.inertia,
            ),
            angular_frequencies=math.sqrt(youngs_modulus / density)
            / length
            * self.angular_frequencies,
            shapes=self.shapes / math.sqrt(mass),
            participation=math.sqrt(mass) * turning * self.participation,
            rigid_coefficients=self.rigid_coefficients / turning,
        )

    def displacements(self, mode: int) -> Floats:
        """Return the displacements of the nodes in a mode (numbered from 0), (nodes, 3)
        [kg^-1/2].
        """
        return np.asarray(self.shapes[mode].reshape(len(self.mesh.nodes), -1)[:, :3])

    def at(self, places: Floats, side: Side = "upper", what: str = "") -> tuple[Floats, Floats]:
        """Return the mode shapes at places (x, y) on one side, (modes, points, 3), and the
        positions of the places, (points, 3) [m].

        `what` names the places in the message if one is not on the body.

        Raises
        ------
        InputError
            If a place is not on the body.
        """

        def found() -> tuple[Floats, Floats]:
            motion, positions = surface_motion(self.mesh, places, side, self.thickness, what)
            return self.modal_values(motion).reshape(len(self.shapes), -1, 3), positions

        return self.cached(f"{side} {places.tolist()}", found) if len(places) == 1 else found()

    def cached(self, key: str, compute: Callable[[], Found], numbers: int = 3) -> Found:
        """Return a quantity of the modes from the cache, or compute it: many drops on one plate
        have the same sensors. Do not change it.

        `numbers` is how many it has for each mode.
        """
        found = self._cache.get(key)
        if found is None:
            found = compute()
            self._cache.put(key, found, 8.0 * numbers * len(self.shapes))
        return found

    @cached_property
    def _cache(self) -> MemoryCache[Any]:
        return MemoryCache(capacity=_CACHE_SIZE)

    def strains(self, place: tuple[float, float], side: Side) -> Floats:
        """Return the strains of a face at a place in each mode, along x and y and of shear, (modes,
        3) [kg^-1/2 m^-1].

        Raises
        ------
        InputError
            If the place is not on the body.
        """
        rows = surface_strain(self.mesh, place, side, self.thickness)
        return self.cached(f"strain {side} {place}", lambda: self.modal_values(rows))

    def sound(self, listener: Listener) -> SoundPaths:
        """Return the paths of sound of the modes to a point, from the cache or computed;
        errors are those of `sound_paths`.
        """
        numbers = math.ceil(
            math.dist(self.mesh.nodes.min(axis=0), self.mesh.nodes.max(axis=0))
            / (listener.speed * listener.step)
        )
        return self.cached(
            f"sound {listener}", lambda: sound_paths(self.mesh, listener, self.shapes), numbers
        )

    def modal_values(self, motion: csr_array) -> Floats:
        """Return linear functions of the degrees of freedom, the rows of a sparse array,
        evaluated for each mode, (modes, rows).
        """
        dofs = np.unique(motion.indices)  # a few of many columns
        return np.asarray(self.shapes[:, dofs] @ motion[:, dofs].T.toarray())

    def averaged(
        self, place: tuple[float, float], radius: float, side: Side = "upper", what: str = ""
    ) -> Floats:
        """Return the mode shapes averaged over a disc with Hertz's pressure as weight, (modes, 3)
        [kg^-1/2].

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
        places, weights = pressure_rule(HERTZ)
        return np.asarray(
            np.einsum(
                "mpi,p->mi", self.at(np.asarray(place) + radius * places, side, what)[0], weights
            )
        )


def modal_model(
    held: HeldStructure,
    modes: Eigenmodes,
    facts: Mapping[str, str] | None = None,
    frequency_errors: Floats | None = None,
) -> ModalModel:
    """Return the modal model of a held structure from the modes of its free degrees of
    freedom; errors not given are unknown (NaN).
    """
    structure, shapes = held.structure, np.asarray(held.expansion @ modes.shapes)
    moved = shapes.reshape(len(structure.mesh.nodes), -1, shapes.shape[1])[:, :3].reshape(
        -1, shapes.shape[1]
    )
    large = np.abs(moved) > 0.5 * np.abs(moved).max(axis=0)
    # sign convention: the first large displacement is positive
    shapes *= np.sign(moved[large.argmax(axis=0), np.arange(shapes.shape[1])])
    return ModalModel(
        structure.mesh,
        structure.properties,
        modes.angular_frequencies,
        np.ascontiguousarray(shapes.T),
        np.asarray(shapes.T @ (structure.mass @ structure.rigid_motions())),
        held.rigid_coefficients,
        np.full(shapes.shape[1], np.nan) if frequency_errors is None else frequency_errors,
        structure.thickness,
        facts or {},
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

    def seen(spot: Spot, face: Side, what: str = "the contact point") -> Floats:
        return model.at(np.array([place_of(model.mesh, spot, face)]), face, what)[0][:, 0]

    strains = {
        name: model.strains(place_of(model.mesh, *point), point[1])
        for name, point in (strained or {}).items()
    }
    touched = seen(contact, side)
    return ModalBasis(
        model.frequencies,
        damping.ratios(model.frequencies),
        touched[:, 2],
        model.participation[:, :3],
        {name: seen(*point, f'sensor "{name}"') for name, point in (points or {}).items()}
        | strains,
        model.properties.mass,
        _rotation(model.properties, model.participation[:, 3:]),
        model.frequency_errors,
        along=touched[:, :2],
        sounds={name: model.sound(listener) for name, listener in (heard or {}).items()},
    )


def rigid_basis(
    model: ModalModel,
    contact: tuple[Spot, Side],
    points: Mapping[str, tuple[Spot, Side]],
    strained: Iterable[str] = (),
    heard: Mapping[str, Listener] | None = None,
) -> ModalBasis | None:
    """Return the rigid motions that the supports do not prevent as modes of frequency zero; None if
    there are none.

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
    weights = np.zeros((6, 6))
    weights[:3, :3], weights[3:, 3:] = properties.mass * np.eye(3), properties.inertia
    coefficients = model.rigid_coefficients
    # of unit modal mass
    motions = np.linalg.solve(
        np.linalg.cholesky(coefficients @ weights @ coefficients.T), coefficients
    )
    along, turning = motions[:, :3], motions[:, 3:]

    def seen(spot: Spot, side: Side) -> Floats:
        place = surface_motion(
            model.mesh, np.array([place_of(model.mesh, spot, side)]), side, model.thickness
        )[1][0]
        return np.asarray(along + np.cross(turning, place - properties.centre))

    # faces move by the displacements of their nodes
    nodes = np.zeros((len(motions), len(model.mesh.nodes), model.mesh.dofs_per_node))
    nodes[:, :, :3] = along[:, None] + np.cross(
        turning[:, None], model.mesh.nodes - properties.centre
    )
    shapes = nodes.reshape(len(motions), -1)
    touched = seen(*contact)
    return ModalBasis(
        np.zeros(len(motions)),
        np.zeros(len(motions)),
        touched[:, 2],
        properties.mass * along,
        {name: seen(*point) for name, point in points.items()}
        | {name: np.zeros((len(motions), 3)) for name in strained},
        properties.mass,
        _rotation(properties, turning @ properties.inertia),
        along=touched[:, :2],
        turning=turning,
        sounds={
            name: sound_paths(model.mesh, listener, shapes)
            for name, listener in (heard or {}).items()
        },
    )


def _rotation(properties: MassProperties, momentum: Floats) -> Floats:
    """Return the angular momenta of modes over the square root of the inertia; half their
    squares are the energy of rotation.
    """
    moments, axes = np.linalg.eigh(properties.inertia)
    return np.asarray(momentum @ axes / np.sqrt(moments))
