"""Simulation of a system of several bodies with several contacts, and its response."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from numbers import Real
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.core.system_records import (
    CLOSING,
    CONTACT,
    END,
    IMPULSE,
    PEAK_DEPTH,
    PEAK_FORCE,
    START,
    TIME_OF_FORCE,
)
from vibroimpact.dynamics.motion.energy import CLOSURE_LIMIT
from vibroimpact.dynamics.status import end_in_words
from vibroimpact.dynamics.system import System
from vibroimpact.dynamics.vibrating.independent_systems import (
    IndependentSystems,
    march_independent,
)
from vibroimpact.dynamics.vibrating.linear_system import State
from vibroimpact.dynamics.vibrating.marched_system import ContactDefinition
from vibroimpact.errors import ComputationError, InputError

_LONGEST = 1e9  # seconds


@dataclass(frozen=True)
class BodyMotion:
    """Motion of a body at given times; arrays have the shape of the times and a last axis.

    Attributes
    ----------
    displacement, velocity : array, shape (..., 3)
        Of its centre of mass since the start [m], [m/s].
    rotation, angular_velocity : array, shape (..., 3)
        Of the body since the start [rad], [rad/s].
    modal : array, shape (..., modes)
        Its modal coordinates [kg^1/2 m]; times the shape of a mode they are displacements.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> balls = {
    ...     "hit": vi.MovingBody(mass=0.1),
    ...     "hitting": vi.MovingBody(mass=0.1, velocity=(0, 0, -1.0)),
    ... }
    >>> contact = vi.PointContact(
    ...     above="hitting", below="hit", law=vi.laws.find_contact_law("hertz")(stiffness=1e9)
    ... )
    >>> motion = vi.simulate_system(
    ...     vi.System(bodies=balls, contacts={"contact": contact}), duration=1e-3
    ... ).at([0.0, 1e-3])["hitting"]
    >>> (motion.velocity[:, 2].round(9) + 0.0).tolist(), motion.displacement.shape
    ([-1.0, 0.0], (2, 3))
    """

    displacement: Floats
    velocity: Floats
    rotation: Floats
    angular_velocity: Floats
    modal: Floats


@dataclass(frozen=True, eq=False)
class SystemResponse:
    """The response of a system.

    Attributes
    ----------
    system : System
        The system.
    impacts : dict of str to array
        One entry per impact of a contact, in the order in which they begin: `contact`, its name;
        `time_s`, of first touch; `closing_speed_m_s`; `duration_s`, NaN if the contact is still
        closed at the end; `max_force_N`, `time_of_max_force_s`, `max_indentation_m`, `impulse_N_s`.
    energy : dict of str to float
        At the end [J]: `kinetic_J` and `potential_J` of all coordinates, `strain_J` of the modes,
        `contact_elastic_J`, `modal_damping_J`, `contact_dissipated_J`, `plastic_work_J`; `input_J`
        at the start; `closure_relative`, the error of the energy balance relative to `input_J` plus
        the larger of `kinetic_J` and the magnitude of `potential_J`.
    end_time : float
        End of the run [s].

    See Also
    --------
    simulate_system : makes one.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> balls = {
    ...     "hit": vi.MovingBody(mass=0.1),
    ...     "hitting": vi.MovingBody(mass=0.1, velocity=(0, 0, -1.0)),
    ... }
    >>> contact = vi.PointContact(
    ...     above="hitting", below="hit", law=vi.laws.find_contact_law("hertz")(stiffness=1e9)
    ... )
    >>> response = vi.simulate_system(
    ...     vi.System(bodies=balls, contacts={"contact": contact}), duration=1e-3
    ... )
    >>> (
    ...     response.impacts["impulse_N_s"].round(9).tolist(),
    ...     response.energy["closure_relative"] < 1e-9,
    ... )
    ([0.1], True)
    """

    system: System
    impacts: dict[str, NDArray[Any]]
    energy: dict[str, float]
    end_time: float
    _motion: IndependentSystems

    def __repr__(self) -> str:
        return f"<SystemResponse: {len(self.impacts['time_s'])} impacts in {self.end_time:g} s>"

    def at(self, times: Any) -> dict[str, BodyMotion]:
        """Return the motion of all bodies at given times.

        Parameters
        ----------
        times : array_like
            Times since the start [s], within the run.

        Returns
        -------
        dict of str to BodyMotion
            By the names of the bodies.

        Raises
        ------
        InputError
            If a time lies outside the run.
        """
        times = self._times(times)
        state = self._motion.states(times.ravel())
        return {name: self._motion_of(name, state, times.shape) for name in self.system.bodies}

    def forces(self, times: Any) -> dict[str, Floats]:
        """Return the forces of the contacts [N] at times since the start [s], by their names.

        They are positive where they push.
        """
        times = self._times(times)
        forces = self._motion.forces(times.ravel())
        return {
            name: forces[:, row].reshape(times.shape)
            for row, name in enumerate(self.system.contacts)
        }

    def gaps(self, times: Any) -> dict[str, Floats]:
        """Return the gaps of the contacts [m] at times since the start [s], by their names.

        They are negative where the surfaces overlap.
        """
        times = self._times(times)
        approach = self._motion.system.approach(self._motion.states(times.ravel()))
        return {
            name: -approach[:, row].reshape(times.shape)
            for row, name in enumerate(self.system.contacts)
        }

    def momentum(self, times: Any) -> Floats:
        """Return the momentum of all free bodies [kg m/s] at times [s], (..., 3).

        Times are since the start.
        """
        motions = self.at(times)
        free = {name: body.mass for name, body in self.system.bodies.items() if not body.held}
        return np.asarray(sum(mass * motions[name].velocity for name, mass in free.items()))

    def _times(self, times: Any) -> Floats:
        """Return times as an array of floats; raise unless all lie within the run."""
        try:
            found = np.asarray(times)
            if found.dtype.kind not in "iuf":
                found = np.full(1, np.nan)
            found = found.astype(float)
        except (TypeError, ValueError, OverflowError):
            found = np.full(1, np.nan)
        if not np.all((found >= 0.0) & (found <= self.end_time)):
            raise InputError(
                f"times must be numbers within the run, 0 to {end_in_words(self.end_time)} s"
            )
        return found

    def _motion_of(self, name: str, state: State, shape: tuple[int, ...]) -> BodyMotion:
        """Return the motion of a body in states along one axis, at times of a shape."""
        rigid, modes = self.system.slices[name]

        def reshaped(values: Floats) -> Floats:
            return values.reshape(*shape, values.shape[1])

        displacement = reshaped(state.displacement[:, rigid])
        velocity = reshaped(state.velocity[:, rigid])
        modal = reshaped(state.displacement[:, modes])
        translation, rotation = self.system.bodies[name].coordinates()
        return BodyMotion(
            displacement @ translation,
            velocity @ translation,
            displacement @ rotation,
            velocity @ rotation,
            modal,
        )


def simulate_system(
    system: System, *, duration: float, progress: Callable[[float], None] | None = None
) -> SystemResponse:
    """Simulate a system of bodies that meet at point contacts.

    Motion between contacts is in closed form; contacts are integrated to the tolerance of the
    system, and all that act at the same time are solved as one system of equations.

    Parameters
    ----------
    system : System
        Bodies and contacts.
    duration : float
        Duration of the run [s], > 0.
    progress : callable, optional
        Called with a number from 0 to 1 as the run proceeds.

    Raises
    ------
    InputError
        If the duration is not a number in range, or no contact can ever bear a force.
    ComputationError
        If a contact can't be integrated to the tolerance, the energy balance does not close, or
        contacts follow each other without end.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> law = vi.laws.find_contact_law("hertz")(stiffness=1e9)
    >>> bodies = {
    ...     "ball": vi.MovingBody(mass=0.1, velocity=(0, 0, -1.0)),
    ...     "wall": vi.MovingBody(mass=float("inf")),
    ... }
    >>> system = vi.System(
    ...     bodies=bodies,
    ...     contacts={"contact": vi.PointContact(above="ball", below="wall", law=law)},
    ... )
    >>> simulate_system(system, duration=1e-3).impacts["impulse_N_s"].round(9).tolist()
    [0.2]
    """
    if not isinstance(system, System):
        raise InputError(f"system must be a System, not {type(system).__name__}")
    if (
        isinstance(duration, bool)
        or not isinstance(duration, Real)
        or not 0.0 < duration < _LONGEST
    ):
        raise InputError(
            f"duration must be a number greater than 0 s and less than {_LONGEST:g} s, not "
            f"{duration!r}"
        )
    if progress is not None and not callable(progress):
        raise InputError(f"progress must be a function of a number, not {progress!r}")
    linear, start = system.linear()
    if not (linear.rates(start) > 0.0).any() and not (linear.gravity > 0.0).any():
        raise InputError(
            "no contact will ever bear a force: no surfaces approach each other at the "
            "start, and gravity, if there is any, does not "
            "bring the bodies of a contact together; give a body a velocity, or hold one"
        )
    definitions = [
        ContactDefinition(contact.law, contact.series, fresh_surface=not contact.same_spot)
        for contact in system.contacts.values()
    ]
    # Newton iterates may overflow; results that are not finite are detected and retried
    with np.errstate(all="ignore"):
        motion = march_independent(linear, definitions, start, system.tolerance, duration, progress)
    names = np.array(list(system.contacts))
    impacts = motion.impacts().T
    columns = {
        "contact": names[impacts[CONTACT].astype(int)],
        "time_s": impacts[START],
        "duration_s": impacts[END] - impacts[START],
        "closing_speed_m_s": impacts[CLOSING],
        "max_force_N": impacts[PEAK_FORCE],
        "time_of_max_force_s": impacts[TIME_OF_FORCE],
        "max_indentation_m": impacts[PEAK_DEPTH],
        "impulse_N_s": impacts[IMPULSE],
    }
    # an independent check of the integration
    energy = _ledger(motion, duration)
    if not energy["closure_relative"] <= CLOSURE_LIMIT:
        raise ComputationError(
            "the energy ledger does not close: "
            f"it is off by {energy['closure_relative']:.2g} of the energy of "
            f"the motion (limit {CLOSURE_LIMIT:g})"
        )
    return SystemResponse(system, columns, energy, duration, motion)


def _ledger(motion: IndependentSystems, duration: float) -> dict[str, float]:
    """Return the energy balance at the end of a run [J]."""
    linear = motion.system
    kinetic_at_start, _ = linear.energies(motion.start)
    input_energy = float(kinetic_at_start.sum())
    end = motion.end(duration)
    kinetic, strain = (float(energies.sum()) for energies in linear.energies(end))
    potential = -float(end.displacement @ linear.load)
    in_modes, in_contacts = motion.lost(end)
    energy = {
        "kinetic_J": kinetic,
        "potential_J": potential,
        "strain_J": strain,
        "contact_elastic_J": motion.stored,
        "modal_damping_J": in_modes,
        "contact_dissipated_J": in_contacts,
        "plastic_work_J": motion.plastic,
    }
    scale = input_energy + max(abs(potential), kinetic)
    closure = 0.0
    if scale:
        closure = abs(sum(energy.values()) - input_energy) / scale
    return {**energy, "input_J": input_energy, "closure_relative": closure}
