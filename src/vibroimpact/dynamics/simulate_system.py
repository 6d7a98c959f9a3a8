"""Simulation of a system of several bodies with several contacts, and its response."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property
from numbers import Real
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vibroimpact.arrays import Bools, Floats
from vibroimpact.dynamics.motion.energy import CLOSURE_LIMIT
from vibroimpact.dynamics.status import end_in_words
from vibroimpact.dynamics.system import System
from vibroimpact.dynamics.vibrating.active_contact import ContactDefinition
from vibroimpact.dynamics.vibrating.free_motion import FreePhase
from vibroimpact.dynamics.vibrating.linear_system import LinearSystem, State
from vibroimpact.dynamics.vibrating.stretch import VibratingStretch
from vibroimpact.dynamics.vibrating.time_marching import TimeMarching
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
    _march: TimeMarching

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
        state = self._states(times)
        return {name: self._motion(name, state, times.shape) for name in self.system.bodies}

    def forces(self, times: Any) -> dict[str, Floats]:
        """Return the forces of the contacts [N] at times since the start [s], by their names.

        They are positive where they push.
        """
        times = self._times(times)
        forces = {name: np.zeros(times.shape) for name in self.system.contacts}
        names = list(forces)
        for motion, inside, elapsed in self._parts_at(times.ravel()):
            if isinstance(motion, VibratingStretch):
                for contact in motion.contacts:
                    x = contact.rule.unmap_time(elapsed / motion.length)
                    forces[names[contact.number]].ravel()[inside] = contact.force_at(x)
        return forces

    def gaps(self, times: Any) -> dict[str, Floats]:
        """Return the gaps of the contacts [m] at times since the start [s], by their names.

        They are negative where the surfaces overlap.
        """
        times = self._times(times)
        approach = self._march.system.approach(self._states(times))
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
            found = found.astype(float) if found.dtype.kind in "iuf" else np.full(1, np.nan)
        except (TypeError, ValueError, OverflowError):
            found = np.full(1, np.nan)
        if not np.all((found >= 0.0) & (found <= self.end_time)):
            raise InputError(
                f"times must be numbers within the run, 0 to {end_in_words(self.end_time)} s"
            )
        return found

    @cached_property
    def _starts(self) -> Floats:
        """Starts of the parts of the history [s]."""
        return np.array([part.start for part in self._march.parts])

    def _parts_at(
        self, times: Floats
    ) -> Iterator[tuple[VibratingStretch | FreePhase, Bools, Floats]]:
        """Yield each motion of the history with a mask of the times within it, and these times.

        The latter are since its start [s].
        """
        part_of_time = np.maximum(np.searchsorted(self._starts, times, side="right") - 1, 0)
        for number in np.unique(part_of_time).tolist():
            part = self._march.parts[number]
            inside = part_of_time == number
            elapsed = np.minimum(times[inside] - part.start, part.motion.length)
            yield part.motion, inside, elapsed

    def _states(self, times: Floats) -> State:
        """Return the states at times, along one axis."""
        times = times.ravel()
        number = self._march.system.number
        displacement = np.empty((len(times), number))
        velocity = np.empty((len(times), number))
        for motion, inside, elapsed in self._parts_at(times):
            state = motion.state(elapsed)
            displacement[inside] = state.displacement
            velocity[inside] = state.velocity
        return State(displacement, velocity, np.zeros((len(times), 0)))

    def _motion(self, name: str, state: State, shape: tuple[int, ...]) -> BodyMotion:
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
    """Simulate several bodies with several contacts.

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
    march = TimeMarching(linear, definitions, start, system.tolerance)
    # Newton iterates may overflow; results that are not finite are detected and retried
    with np.errstate(all="ignore"):
        march.run_until(duration, progress)
    names = list(system.contacts)
    forces = np.array([impact.force.locate() for impact in march.impacts]).reshape(-1, 2)
    columns = {
        "contact": np.array([names[impact.contact] for impact in march.impacts]),
        "time_s": np.array([impact.start for impact in march.impacts]),
        "duration_s": np.array([impact.end - impact.start for impact in march.impacts]),
        "closing_speed_m_s": np.array([impact.closing_speed for impact in march.impacts]),
        "max_force_N": forces[:, 0],
        "time_of_max_force_s": forces[:, 1],
        "max_indentation_m": np.array([impact.indentation.locate()[0] for impact in march.impacts]),
        "impulse_N_s": np.array([impact.impulse for impact in march.impacts]),
    }
    # an independent check of the integration
    energy = _ledger(linear, start, march)
    if not energy["closure_relative"] <= CLOSURE_LIMIT:
        raise ComputationError(
            "the energy ledger does not close: "
            f"it is off by {energy['closure_relative']:.2g} of the energy of "
            f"the motion (limit {CLOSURE_LIMIT:g})"
        )
    return SystemResponse(system, columns, energy, duration, march)


def _ledger(linear: LinearSystem, start: State, march: TimeMarching) -> dict[str, float]:
    """Return the energy balance at the end of a run [J]."""
    kinetic_at_start, _ = linear.energies(start)
    input_energy = float(kinetic_at_start.sum())
    kinetic, strain = (float(energies.sum()) for energies in linear.energies(march.state))
    potential = -float(march.state.displacement @ linear.load)
    active = march.active.values()
    energy = {
        "kinetic_J": kinetic,
        "potential_J": potential,
        "strain_J": strain,
        "contact_elastic_J": sum(
            float(contact.local.energy_at_indentation(contact.law_indentation(linear, march.state)))
            for contact in active
        ),
        "modal_damping_J": float(march.lost[:-1].sum()),
        "contact_dissipated_J": float(march.lost[-1]),
        "plastic_work_J": march.plastic
        + sum(contact.plastic_work(linear, march.state) for contact in active),
    }
    scale = input_energy + max(abs(potential), kinetic)
    closure = abs(sum(energy.values()) - input_energy) / scale if scale else 0.0
    return {**energy, "input_J": input_energy, "closure_relative": closure}
