"""The linear system of a drop whose bodies vibrate."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from vibroimpact.arrays import Complex, Floats
from vibroimpact.bodies.body import Body
from vibroimpact.dynamics.statement.oblique import Oblique
from vibroimpact.dynamics.statement.problem import Problem
from vibroimpact.dynamics.statement.steady import steady_surface
from vibroimpact.dynamics.vibrating.linear_system import LinearSystem, State

if TYPE_CHECKING:
    from vibroimpact.structures.modal_model import ModalBasis  # which loads sparse matrices

_IMMOVABLE = 1e-10
"""Shape of a driven coordinate over that of the sphere [-].

It is that of a mass 1e20 times that of the sphere, which no contact disturbs.
"""


def system_of(problem: Problem, mass: float, gravity: float) -> LinearSystem:
    """Return the linear system of a drop.

    Its coordinates are the fall of the sphere, the rigid motions of the plate, the modes of both,
    and the motion of a plate that is shaken. The local element is in series with the contact.

    Parameters
    ----------
    problem : Problem
        The problem.
    mass, gravity : float
        Of this drop [kg, m/s^2].
    """
    frequencies = [np.zeros(1)]
    damping_ratios = [np.zeros(1)]
    shapes = [np.array([mass**-0.5])]
    # the approach grows as the plate rises, and as the sphere's surface falls
    for basis, sign in (
        (problem.plate.rigid, 1.0),
        (problem.sphere.modes, -1.0),
        (problem.plate.modes, 1.0),
    ):
        if basis is not None:
            frequencies.append(basis.angular_frequencies)
            damping_ratios.append(basis.damping_ratios)
            shapes.append(sign * basis.contact)
    driven_frequency, _, surface_shapes = driven_motion_of(problem)
    driven_shapes = _IMMOVABLE * mass**-0.5 * surface_shapes
    frequencies.append(driven_frequency)
    damping_ratios.append(np.zeros_like(driven_frequency))
    shapes.append(driven_shapes[2])
    shape = np.concatenate(shapes)

    of_rigid, of_sphere, of_plate = slices_of(problem)
    load = np.zeros(len(shape))
    load[0] = gravity * mass**0.5
    inside = np.zeros(len(shape), dtype=bool)
    inside[of_sphere] = problem.sphere_inside
    below = np.zeros(len(shape), dtype=bool)
    below[of_rigid] = True
    below[of_plate.start :] = True  # with the driven coordinates, which come last
    elements = [problem.local_element] if problem.local_element else []
    modes = problem.plate.modes
    residuals = {} if modes is None else modes.residuals
    return LinearSystem(
        angular_frequency=np.concatenate(frequencies),
        damping_ratio=np.concatenate(damping_ratios),
        shape=shape[None],
        offset=np.zeros(1),
        load=load,
        inside=inside,
        below=below[None],
        rate=np.array([stiffness / damping for stiffness, damping in elements]),
        mobility=np.array([1.0 / damping for _, damping in elements]),
        local_contact=np.zeros(len(elements), dtype=np.intp),
        along=_tangential_shapes(problem, len(shape), driven_shapes[:2]),
        residuals=residuals,
        driven=len(driven_frequency),
    )


def _tangential_shapes(problem: Problem, number: int, driven_shapes: Floats) -> Floats | None:
    """Return `LinearSystem.along` of a drop; None without friction.

    `number`: of coordinates. `driven_shapes`: displacements of the surface along x and y by the
    driven ones [kg^-1/2] (2, d).
    """
    if problem.oblique is None or problem.oblique.friction is None:
        return None
    of_rigid, _, of_plate = slices_of(problem)
    rotations = 3 if _moments_act(problem.oblique) else 0
    along = np.zeros((2 + rotations, number))
    for basis, coordinates in ((problem.plate.rigid, of_rigid), (problem.plate.modes, of_plate)):
        if basis is None:
            continue
        assert basis.along is not None  # the problem has seen to it
        along[:2, coordinates] = basis.along.T
        if basis.turning is not None:
            # rotations about x, y and z, as those about -y, x and z
            turned = (basis.turning[:, [1, 0, 2]] * [-1.0, 1.0, 1.0]).T
            along[2:, coordinates] = turned[:rotations]
    along[:2, of_plate.stop :] = driven_shapes
    return along


def _moments_act(oblique: Oblique) -> bool:
    """Return whether rolling resistance or twisting friction acts on some of the drops."""
    return oblique.friction is not None and bool(
        np.any(oblique.friction.rolling_coefficient) or np.any(oblique.spin[2])
    )


def driven_motion_of(problem: Problem) -> tuple[Floats, Complex, Floats]:
    """Return the harmonic motions that drive a plate, and how they move its surface.

    Returns
    -------
    angular_frequency : array, shape (d,)
        [rad/s].
    phasors : array of complex, shape (d,)
        Of the motions, times their shapes in metres.
    shape : array, shape (3, d)
        Displacement of the surface at the contact point along x, y and the normal by each. A rigid
        plate moves with its supports; an elastic one along its normal, and in all directions, out
        of phase, where it is hit obliquely: by sine and cosine of each frequency.
    """
    motion = problem.motion
    modes = problem.plate.modes
    if motion is None or not problem.shaken:
        return np.zeros(0), np.zeros(0, dtype=complex), np.zeros((3, 0))
    omega = motion.angular_frequency
    ones = np.ones(len(motion.phasors))
    if modes is None:
        return omega, motion.phasors, np.outer(motion.direction, ones)
    if problem.oblique is None:
        return omega, problem.surface_phasors, np.outer([0.0, 0.0, 1.0], ones)
    surface = steady_surface(motion, modes)
    phasors = np.concatenate([ones, 1j * ones])
    shapes = np.concatenate([surface.real, surface.imag], axis=1)
    return np.tile(omega, 2), phasors, shapes


def slices_of(problem: Problem) -> tuple[slice, slice, slice]:
    """Return the slices of the bodies in the coordinates of a drop.

    These are of the plate's rigid motions, the sphere's modes and the plate's modes. The fall of
    the sphere is the first coordinate; driven coordinates come last.
    """
    rigid = 0
    if problem.plate.rigid is not None:
        rigid = len(problem.plate.rigid.frequencies)
    sphere = 1 + rigid
    plate = sphere + modes_of(problem.sphere)
    end = plate + modes_of(problem.plate)
    return slice(1, sphere), slice(sphere, plate), slice(plate, end)


def bases_of_plate(problem: Problem) -> list[ModalBasis]:
    """Return the rigid motions of a free plate, and its modes, in the order of its coordinates."""
    return [basis for basis in (problem.plate.rigid, problem.plate.modes) if basis is not None]


def centre_of(state: State, mass: Floats | float) -> tuple[Floats, Floats]:
    """Return the depth of the sphere's centre [m] and its downward speed [m/s].

    The depth is below its position at touch.
    """
    root = np.sqrt(mass)
    return np.asarray(state.displacement[..., 0] / root), np.asarray(state.velocity[..., 0] / root)


def modes_of(body: Body) -> int:
    """Return the number of modes of a body."""
    if body.modes is None:
        return 0
    return len(body.modes.frequencies)


def driven_state_of(problem: Problem, mass: float, number: int) -> tuple[Floats, Floats]:
    """Return displacements and velocities of all coordinates at the start of a drop (n,).

    Only those that are driven move. `mass`: that for which the system was stated [kg]. `number`: of
    coordinates.
    """
    displacement = np.zeros(number)
    velocity = np.zeros(number)
    omega, phasors, _ = driven_motion_of(problem)
    first = number - len(omega)
    phasors = phasors / (_IMMOVABLE * mass**-0.5)
    displacement[first:] = phasors.imag
    velocity[first:] = omega * phasors.real
    return displacement, velocity
