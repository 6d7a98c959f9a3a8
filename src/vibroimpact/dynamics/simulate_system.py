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
from vibroimpact.dynamics.end_in_words import end_in_words
from vibroimpact.dynamics.system import MovingBody, System
from vibroimpact.dynamics.vibrating.active_contact import ContactDefinition
from vibroimpact.dynamics.vibrating.free_motion import FreePhase
from vibroimpact.dynamics.vibrating.linear_system import LinearSystem, State
from vibroimpact.dynamics.vibrating.stretch import VibratingStretch
from vibroimpact.dynamics.vibrating.time_marching import TimeMarching
from vibroimpact.errors import ComputationError, InputError

_LONGEST = 1e9  # seconds
_CLOSURE = 1e-6  # largest relative error of the energy balance


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
    ...     above="hitting", below="hit", law=vi.find_contact_law("hertz")(stiffness=1e9)
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
    ...     above="hitting", below="hit", law=vi.find_contact_law("hertz")(stiffness=1e9)
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
        return {
            name: _motion(body, *self._parts(name, state, times.shape))
            for name, body in self.system.bodies.items()
        }

    def forces(self, times: Any) -> dict[str, Floats]:
        """Return the forces of the contacts [N] at times since the start [s], by their
        names; positive where they push.
        """
        times = self._times(times)
        found = {name: np.zeros(times.shape) for name in self.system.contacts}
        names = list(found)
        for motion, here, since in self._parts_at(times.ravel()):
            if isinstance(motion, VibratingStretch):
                for contact in motion.contacts:
                    x = contact.rule.unmap_time(since / motion.length)
                    found[names[contact.number]].ravel()[here] = contact.force_at(x)
        return found

    def gaps(self, times: Any) -> dict[str, Floats]:
        """Return the gaps of the contacts [m] at times since the start [s], by their
        names; negative where the surfaces overlap.
        """
        times = self._times(times)
        approach = self._march.system.approach(self._states(times))
        return {
            name: -approach[:, row].reshape(times.shape)
            for row, name in enumerate(self.system.contacts)
        }

    def momentum(self, times: Any) -> Floats:
        """Return the momentum of all free bodies [kg m/s] at times since the start [s],
        (..., 3).
        """
        moved = self.at(times)
        free = {name: body.mass for name, body in self.system.bodies.items() if not body.held}
        return np.asarray(sum(mass * moved[name].velocity for name, mass in free.items()))

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
        """Yield each motion of the history with a mask of the times within it, and these
        times since its start [s].
        """
        index = np.maximum(np.searchsorted(self._starts, times, side="right") - 1, 0)
        for number in np.unique(index):
            part, here = self._march.parts[int(number)], index == number
            yield part.motion, here, np.minimum(times[here] - part.start, part.motion.length)

    def _states(self, times: Floats) -> State:
        """Return the states at times, along one axis."""
        times, number = times.ravel(), self._march.system.number
        displacement, velocity = np.empty((len(times), number)), np.empty((len(times), number))
        for motion, here, since in self._parts_at(times):
            state = motion.state(since)
            displacement[here], velocity[here] = state.displacement, state.velocity
        return State(displacement, velocity, np.zeros((len(times), 0)))

    def _parts(
        self, name: str, state: State, shape: tuple[int, ...]
    ) -> tuple[Floats, Floats, Floats]:
        """Return displacements and velocities of the rigid motions of a body, and its
        modal coordinates.
        """
        rigid, modes = self.system.slices[name]
        of_all = (
            state.displacement[:, rigid],
            state.velocity[:, rigid],
            state.displacement[:, modes],
        )
        place, speed, modal = (part.reshape(*shape, part.shape[1]) for part in of_all)
        return place, speed, modal


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
    >>> law = vi.find_contact_law("hertz")(stiffness=1e9)
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
    march = TimeMarching(
        linear,
        [
            ContactDefinition(one.law, one.series, not one.same_spot)
            for one in system.contacts.values()
        ],
        start,
        system.tolerance,
    )
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
    if not energy["closure_relative"] <= _CLOSURE:
        off = (
            f"it is off by {energy['closure_relative']:.2g} of the energy of "
            f"the motion (limit {_CLOSURE:g})"
        )
        raise ComputationError(f"the energy ledger does not close: {off}")
    return SystemResponse(system, columns, energy, duration, march)


def _ledger(linear: LinearSystem, start: State, march: TimeMarching) -> dict[str, float]:
    """Return the energy balance at the end of a run [J]."""
    kinetic, strain = (float(part.sum()) for part in linear.energies(march.state))
    begun, potential = (
        float(linear.energies(start)[0].sum()),
        -float(march.state.displacement @ linear.load),
    )
    energy = {
        "kinetic_J": kinetic,
        "potential_J": potential,
        "strain_J": strain,
        "contact_elastic_J": sum(
            float(touch.local.energy_at_indentation(touch.law_indentation(linear, march.state)))
            for touch in march.active.values()
        ),
        "modal_damping_J": float(march.lost[:-1].sum()),
        "contact_dissipated_J": float(march.lost[-1]),
        "plastic_work_J": march.plastic
        + sum(touch.plastic_work(linear, march.state) for touch in march.active.values()),
    }
    moved = begun + max(abs(potential), kinetic)
    return {
        **energy,
        "input_J": begun,
        "closure_relative": abs(sum(energy.values()) - begun) / moved if moved else 0.0,
    }


def _motion(body: MovingBody, place: Floats, speed: Floats, modal: Floats) -> BodyMotion:
    """Return the motion of a body from its rigid motions and its modal coordinates."""
    along, turning = body.coordinates()
    return BodyMotion(place @ along, speed @ along, place @ turning, speed @ turning, modal)
