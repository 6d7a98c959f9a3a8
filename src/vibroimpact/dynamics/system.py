"""Definition of a system of several bodies with several contacts.

Each free body has three translations and, if it has an inertia, three rotations, and the vibration
modes it is given. A contact is a point, a direction and a law. Displacements are small: directions
and points stay those of the start, also through impacts.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from functools import cached_property
from numbers import Real
from typing import TYPE_CHECKING, Any

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.contact.law import CompliantLaw, ContactLaw
from vibroimpact.contact.quasi_static import QuasiStatic
from vibroimpact.dynamics.statement.tolerance import DEFAULT_TOLERANCE, check_tolerance
from vibroimpact.dynamics.vibrating.linear_system import LinearSystem, State
from vibroimpact.errors import InputError, did_you_mean

if TYPE_CHECKING:
    from vibroimpact.structures.modal_model import ModalBasis  # which loads sparse matrices

_LARGEST = 1e15  # in SI units: larger values are rejected as lengths, speeds or accelerations
_UNIT = 1e-9  # largest deviation of the length of a normal from one


@dataclass(frozen=True, kw_only=True, eq=False)
class MovingBody:
    """A body of a system, free or fixed.

    Parameters
    ----------
    mass : float
        Mass [kg], > 0; infinite for a body that is held.
    inertia : float or array, shape (3,) or (3, 3), optional
        Moment of inertia about the centre of mass [kg m^2]. A body without one does not rotate.
    centre : array, shape (3,)
        Position of the centre of mass at the start [m].
    velocity, angular_velocity : array, shape (3,)
        Of the centre [m/s], and about it [rad/s], at the start.
    modes : ModalBasis, optional
        Vibration modes. Its `points` give the mode shapes at each contact, by the name of the
        contact.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> beam = vi.MovingBody(mass=0.942, inertia=(2e-4, 7.07e-3, 7.26e-3))
    >>> wall = vi.MovingBody(mass=float("inf"))
    >>> beam.mass, wall.mass
    (0.942, inf)
    """

    mass: float
    inertia: Any = None
    centre: Any = (0.0, 0.0, 0.0)
    velocity: Any = (0.0, 0.0, 0.0)
    angular_velocity: Any = (0.0, 0.0, 0.0)
    modes: ModalBasis | None = None

    def __post_init__(self) -> None:
        if not _number("mass", self.mass) > 0.0:
            raise InputError(f"the mass of a body must be greater than 0 kg, not {self.mass!r}")
        for name in ("centre", "velocity", "angular_velocity"):
            object.__setattr__(self, name, _vector(name, getattr(self, name)))
        if self.inertia is not None:
            object.__setattr__(self, "inertia", _inertia(self.inertia))
        if self.modes is not None:
            _check_modes(self.modes)
        moves = np.any(self.velocity) or np.any(self.angular_velocity)
        if moves and np.isinf(self.mass):
            raise InputError(
                "a body that is held, of infinite mass, has no velocity and no angular_velocity"
            )
        if np.any(self.angular_velocity) and self.inertia is None:
            raise InputError(
                "a body without an inertia does not turn: give inertia [kg m^2], or no "
                "angular_velocity"
            )

    @property
    def held(self) -> bool:
        """Whether the body is held, of infinite mass."""
        return bool(np.isinf(self.mass))

    def coordinates(self) -> tuple[Floats, Floats]:
        """Return the rigid motions of unit mass, (r, 3) each.

        They are the translation of the centre [kg^-1/2] and the rotation [rad/(kg^1/2 m)] in each.
        """
        if self.held:
            return np.zeros((0, 3)), np.zeros((0, 3))
        translation = np.eye(3) / np.sqrt(self.mass)
        zeros = np.zeros((3, 3))
        if self.inertia is None:
            return translation, zeros
        # about the principal axes
        moments, axes = np.linalg.eigh(self.inertia)
        rotation = axes.T / np.sqrt(moments)[:, None]
        return np.concatenate([translation, zeros]), np.concatenate([zeros, rotation])


@dataclass(frozen=True, kw_only=True, eq=False)
class PointContact:
    """A contact between two bodies of a system.

    Parameters
    ----------
    above, below : str
        Names of the bodies.
    law : CompliantLaw
        Contact law.
    point : array, shape (3,)
        Contact point [m].
    normal : array, shape (3,)
        Unit vector from the body below to that above.
    gap : float, default 0
        Between the surfaces at the start [m], >= 0.
    series : QuasiStatic, optional
        Quasi-static compliance in series with the law.
    same_spot : bool, default True
        Whether each impact of this contact falls where the last one did; otherwise it meets
        undeformed surfaces.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> law = vi.laws.find_contact_law("hertz")(stiffness=1e9)
    >>> contact = vi.PointContact(above="ball", below="beam", law=law, point=(0.12, 0, 0), gap=1e-3)
    >>> contact.normal, contact.gap
    (array([0., 0., 1.]), 0.001)
    """

    above: str
    below: str
    law: CompliantLaw
    point: Any = (0.0, 0.0, 0.0)
    normal: Any = (0.0, 0.0, 1.0)
    gap: float = 0.0
    series: QuasiStatic = QuasiStatic()
    same_spot: bool = True

    def __post_init__(self) -> None:
        for name in ("above", "below"):
            if not isinstance(getattr(self, name), str):
                raise InputError(f"{name} must be the name of a body, not {getattr(self, name)!r}")
        if not isinstance(self.law, CompliantLaw):
            if not isinstance(self.law, ContactLaw):
                raise InputError(
                    "law must be a contact law with its parameters, such as "
                    f'vi.laws.find_contact_law("hertz")(stiffness=5e8), not {self.law!r}'
                )
            raise InputError(
                f"the law of a contact of a system must give a force, which {self.law!r} does not"
            )
        if any(np.ndim(getattr(self.law, item.name)) for item in fields(self.law)):
            raise InputError(
                "the parameters of the law of a contact must be numbers: a "
                "system is one, and no batch"
            )
        if not isinstance(self.series, QuasiStatic):
            raise InputError(f"series must be a QuasiStatic, not {self.series!r}")
        if not isinstance(self.same_spot, bool):
            raise InputError(f"same_spot must be True or False, not {self.same_spot!r}")
        for name in ("point", "normal"):
            object.__setattr__(self, name, _vector(name, getattr(self, name)))
        if abs(np.linalg.norm(self.normal) - 1.0) > _UNIT:
            raise InputError(
                f"normal must be a vector of length 1, not {np.asarray(self.normal).tolist()}"
            )
        if not 0.0 <= _number("gap", self.gap) < np.inf:
            words = "below 0 m the bodies overlap at the start"
            raise InputError(
                f"gap must be a finite number that is not negative, not {self.gap:g} m; {words}"
            )


@dataclass(frozen=True, kw_only=True, eq=False)
class System:
    """A system of bodies that meet at point contacts.

    Parameters
    ----------
    bodies : mapping of str to MovingBody
        By their names.
    contacts : mapping of str to PointContact
        By their names; at least one.
    gravity : array, shape (3,), default 0
        Acceleration of gravity [m/s^2]. Modal displacements are measured from the equilibrium under
        it.
    tolerance : float, default 1e-9
        Relative error allowed in the state at the end of each stretch of contact; 1e-13 to 1e-6.

    Raises
    ------
    InputError
        If a contact names an unknown body or the same body twice, both its bodies are held, or the
        modes of a body lack the contact point.

    Examples
    --------
    Two equal balls: the one that is hit leaves with the speed of the other.

    >>> import vibroimpact as vi
    >>> law = vi.laws.find_contact_law("hertz")(stiffness=1e9)
    >>> balls = {
    ...     "hit": vi.MovingBody(mass=0.1),
    ...     "hitting": vi.MovingBody(mass=0.1, velocity=(0, 0, -1.0)),
    ... }
    >>> system = vi.System(
    ...     bodies=balls,
    ...     contacts={"contact": vi.PointContact(above="hitting", below="hit", law=law)},
    ... )
    >>> vi.simulate_system(system, duration=1e-3).at(1e-3)["hit"].velocity.round(9).tolist()
    [0.0, 0.0, -1.0]
    """

    bodies: Mapping[str, MovingBody]
    contacts: Mapping[str, PointContact]
    gravity: Any = (0.0, 0.0, 0.0)
    tolerance: float = DEFAULT_TOLERANCE

    def __post_init__(self) -> None:
        object.__setattr__(self, "gravity", _vector("gravity", self.gravity))
        for name, kind in (("bodies", MovingBody), ("contacts", PointContact)):
            given = getattr(self, name)
            if not isinstance(given, Mapping) or not all(
                isinstance(key, str) and isinstance(one, kind) for key, one in given.items()
            ):
                raise InputError(
                    f'{name} must be a mapping of names to {kind.__name__}, as {{"name": '
                    f"vi.{kind.__name__}(...)}}",
                    name,
                )
        if not self.contacts:
            raise InputError(
                "the system has no contact: nothing can happen between its bodies", "contacts"
            )
        check_tolerance(_number("tolerance", self.tolerance))
        for name, contact in self.contacts.items():
            key = f"contacts.{name}"
            for body in (contact.above, contact.below):
                if body not in self.bodies:
                    raise InputError(
                        f'there is no body "{body}"{did_you_mean(body, self.bodies)}', key
                    )
                modes = self.bodies[body].modes
                if modes is not None and name not in modes.points:
                    raise InputError(
                        f'the modes of "{body}" have no shapes at its contact: add '
                        f'"{name}" to their points',
                        key,
                    )
            if contact.above == contact.below:
                raise InputError(f'a body cannot touch itself, as "{contact.above}" does here', key)
            if all(self.bodies[body].held for body in (contact.above, contact.below)):
                raise InputError(
                    f'neither "{contact.above}" nor "{contact.below}" can move: both are held', key
                )

    @cached_property
    def slices(self) -> dict[str, tuple[slice, slice]]:
        """Slices of the rigid motions and of the modes of each body among the coordinates.

        The rigid motions of all bodies come first.
        """
        bodies = self.bodies.values()
        rigid = [len(body.coordinates()[0]) for body in bodies]
        modes = []
        for body in bodies:
            frequencies = () if body.modes is None else body.modes.frequencies
            modes.append(len(frequencies))
        ends = np.cumsum([0, *rigid, *modes])
        number = len(rigid)
        return {
            name: (
                slice(ends[index], ends[index + 1]),
                slice(ends[number + index], ends[number + index + 1]),
            )
            for index, name in enumerate(self.bodies)
        }

    def linear(self) -> tuple[LinearSystem, State]:
        """Return the bodies as one linear system, and its state at the start."""
        slices = self.slices
        number = max(part.stop for pair in slices.values() for part in pair)
        frequency = np.zeros(number)
        damping = np.zeros(number)
        load = np.zeros(number)
        velocity = np.zeros(number)
        shape = np.zeros((len(self.contacts), number))
        for name, body in self.bodies.items():
            rigid, vibrating = slices[name]
            translation, rotation = body.coordinates()
            if not body.held:
                load[rigid] = body.mass * translation @ self.gravity
                velocity[rigid] = body.mass * translation @ body.velocity
                if body.inertia is not None:
                    velocity[rigid] += rotation @ body.inertia @ body.angular_velocity
            if body.modes is not None:
                frequency[vibrating] = body.modes.angular_frequencies
                damping[vibrating] = body.modes.damping_ratios
        # the approach of a contact grows with the motion of the body below along the normal, and
        # shrinks with that of the one above
        for row, (name, contact) in enumerate(self.contacts.items()):
            for sign, touching in ((1.0, contact.below), (-1.0, contact.above)):
                body = self.bodies[touching]
                rigid, vibrating = slices[touching]
                translation, rotation = body.coordinates()
                lever = _cross(contact.point - body.centre, contact.normal)
                shape[row, rigid] = sign * (translation @ contact.normal + rotation @ lever)
                if body.modes is not None:
                    mode_shapes = body.modes.points[name]
                    shape[row, vibrating] = sign * (mode_shapes @ contact.normal)
        gaps = np.array([-contact.gap for contact in self.contacts.values()])
        levels = np.array([float(contact.law.touch_level) for contact in self.contacts.values()])
        no_elements = np.zeros(0)
        system = LinearSystem(
            angular_frequency=frequency,
            damping_ratio=damping,
            shape=shape,
            offset=gaps + levels,
            load=load,
            inside=np.zeros(number, dtype=bool),
            below=np.ones(shape.shape, dtype=bool),
            rate=no_elements,
            mobility=no_elements,
            local_contact=np.zeros(0, dtype=np.intp),
        )
        return system, State(np.zeros(number), velocity, no_elements)


def _cross(first: Floats, second: Floats) -> Floats:
    """Return the cross product of two vectors; NumPy's takes twenty times as long for one pair."""
    return np.array(
        [
            first[1] * second[2] - first[2] * second[1],
            first[2] * second[0] - first[0] * second[2],
            first[0] * second[1] - first[1] * second[0],
        ]
    )


def _number(name: str, value: object) -> float:
    """Return a number as a float; raise InputError unless it is one."""
    if isinstance(value, bool) or not isinstance(value, Real):
        raise InputError(f"{name} must be a number in SI, not {value!r}")
    try:
        return float(value)
    except OverflowError:
        raise InputError(f"{name} is beyond all numbers that are computed with") from None


def _array(value: object) -> Floats:
    """Return an array of finite numbers below 1e15 in magnitude.

    It is empty if the value is not such an array.
    """
    empty = np.zeros(0)
    try:
        array = np.asarray(value)
        if array.dtype.kind not in "iuf":
            return empty
        array = array.astype(float)
    except (TypeError, ValueError, OverflowError):
        return empty
    if array.size and np.all(np.abs(array) < _LARGEST):
        return array
    return empty


def _vector(name: str, value: object) -> Floats:
    """Return a vector of three finite numbers."""
    vector = _array(value)
    if vector.shape != (3,):
        raise InputError(
            f"{name} must be three finite numbers, along x, y and z, below {_LARGEST:g} in "
            f"magnitude; not {value!r}"
        )
    return vector


def _inertia(value: object) -> Floats:
    """Return a tensor of inertia (3, 3)."""
    tensor = _array(value)
    if tensor.shape in ((), (3,)):
        tensor = tensor * np.eye(3)
    if tensor.shape == (3, 3) and np.allclose(tensor, tensor.T):
        moments = np.linalg.eigvalsh(tensor)
        if moments[0] > 0.0 and moments[2] <= (1.0 + 1e-9) * (moments[0] + moments[1]):
            return tensor
    raise InputError(
        "inertia must be a moment of inertia [kg m^2], > 0, three of them, or a symmetric "
        "matrix of 3 by 3, none of whose principal "
        f"moments is more than the sum of the others; not {value!r}"
    )


def _check_modes(modes: ModalBasis) -> None:
    """Raise InputError unless modes have valid frequencies, damping ratios and point shapes."""
    names = ("frequencies", "damping_ratios", "points")
    if not all(hasattr(modes, name) for name in names) or not isinstance(modes.points, Mapping):
        raise InputError(f"modes must be a ModalBasis, not {type(modes).__name__}", "modes")
    frequencies, ratios = _array(modes.frequencies), _array(modes.damping_ratios)
    if (
        frequencies.ndim != 1
        or not (frequencies > 0.0).all()
        or ratios.shape != frequencies.shape
        or not (ratios >= 0.0).all()
    ):
        raise InputError(
            "modes need frequencies greater than 0 Hz and as many damping ratios, not "
            "negative, all finite",
            "modes",
        )
    for name, shapes in modes.points.items():
        if _array(shapes).shape != (len(frequencies), 3):
            raise InputError(
                f'the shapes of the point "{name}" must be finite, three for each of the '
                f"{len(frequencies)} modes",
                "modes",
            )
