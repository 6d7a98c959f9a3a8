r"""The bodies between their contacts as one linear system, and its free motion in closed form.

Every rigid motion and every vibration mode is a coordinate q of unit mass; a rigid motion has an
angular frequency of zero. A massless local element, a spring parallel to a dashpot, may lie in
series with a contact. A coordinate i changes the approach of the surfaces at
contact c by its shape :math:`\chi_{ci}`. With the contact forces F and the load g on each
coordinate,

.. math::

    y_c = y_{c0} + \sum_i \chi_{ci} q_i + \sum_k r_k,\qquad \dot r_k + \kappa_k r_k = -\mu_k F_c

.. math:: \ddot q_i + 2 \zeta_i \omega_i \dot q_i + \omega_i^2 q_i = g_i - \sum_c \chi_{ci} F_{ci}

where y is the approach of the surfaces, negative where there is a gap. A coordinate may lie
*inside* the contacts of its body: it is then in series with the springs of the contact laws alone,
:math:`F_{ci}` is the force of that spring, and the dashpot of the law spans it. For all other
coordinates :math:`F_{ci} = F_c`.

The last coordinates may be *driven*: a prescribed harmonic motion of the body below is an undamped
oscillator whose mass is so large, and whose shape is so small, that no contact disturbs it. Its
energy says nothing and is not counted; what counts is the work of its drive.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np

from vibroimpact.arrays import Bools, Floats, Indices
from vibroimpact.dynamics.core import records
from vibroimpact.dynamics.core.flight import state_after
from vibroimpact.dynamics.vibrating.oscillators import Oscillators

# of the sum of the magnitudes of the terms of an acceleration: smaller sums are rounding errors
_ROUNDING = 1e-12


@dataclass(frozen=True)
class State:
    """State of a linear system; arrays may have leading axes of times.

    `displacement` and `velocity` of the coordinates (..., n); `local`, deformations of the massless
    elements (..., k) [m].
    """

    displacement: Floats
    velocity: Floats
    local: Floats

    @property
    def record(self) -> records.State:
        """The state as the core takes it."""
        return records.State(self.displacement, self.velocity, self.local)

    def part(self, coordinates: Indices) -> State:
        """Return the state of some of the coordinates."""
        return State(self.displacement[coordinates], self.velocity[coordinates], self.local)

    def take(self, index: int) -> State:
        """Return one state along the leading axis."""
        return State(self.displacement[index], self.velocity[index], self.local[index])


@dataclass(frozen=True)
class LinearSystem(Oscillators):
    """Coordinates of unit mass of bodies with contacts, and massless elements.

    An element is a spring parallel to a dashpot.

    Parameters
    ----------
    angular_frequency, damping_ratio : array, shape (n,)
        [rad/s] and [-]; zero for rigid motions.
    shape : array, shape (contacts, n)
        chi, derivative of the approach of the surfaces by each coordinate [kg^-1/2].
    offset : array, shape (contacts,)
        Approach of the surfaces where all coordinates are zero [m].
    load : array, shape (n,)
        Acceleration of each coordinate by gravity [kg^1/2 m/s^2]; zero for modes, which are
        measured from their static equilibrium.
    inside : array of bool, shape (n,)
        Which coordinates lie inside the contacts.
    below : array of bool, shape (contacts, n)
        Which coordinates count in the indentation of each contact: of a drop those of the body
        below, of a system all.
    rate, mobility : array, shape (k,)
        Of the massless elements: stiffness over damping [1/s], and one over damping [m/(N s)].
    local_contact : array of int, shape (k,)
        The contact that each massless element is in series with.
    along : array, shape (2, n) or (5, n), optional
        Displacement of the surface below along x and y at the only contact, by each coordinate
        [kg^-1/2], where there is friction; where moments act, also its rotations about -y, x and z
        [kg^-1/2 m^-1].
    residuals : mapping of str to array, shape (3,)
        Residual compliances between the only contact and the sensors, by their names [m/N].
    driven : int, default 0
        How many coordinates are driven, the last ones.
    """

    offset: Floats
    load: Floats
    inside: Bools
    below: Bools
    rate: Floats
    mobility: Floats
    local_contact: Indices
    along: Floats | None = None
    residuals: Mapping[str, Floats] = field(default_factory=dict)
    driven: int = 0

    @cached_property
    def views(self) -> dict[tuple[int, ...], Any]:
        """Cache of the `ContactView` of this system for sets of contacts, by their numbers."""
        return {}

    @cached_property
    def shared_modes(self) -> dict[tuple[int, ...], Any]:
        """Cache of `ContactModes` for sets of contacts, by their numbers.

        Systems with the same modes share it.
        """
        return {}

    @cached_property
    def _records(self) -> dict[int, records.System]:
        """Cache of `record_of`, by the contacts."""
        return {}

    def record_of(self, contact: int) -> records.System:
        """Return the system with one of its contacts, as the core takes it."""
        if contact not in self._records:
            self._records[contact] = records.System(
                frequency=self.angular_frequency,
                ratio=self.damping_ratio,
                damping=self.damping,
                load=self.load,
                shape=np.ascontiguousarray(self.shape[contact]),
                outer_shape=np.ascontiguousarray(self.outer_shape[contact]),
                indentation_shape=np.ascontiguousarray(self.indentation_shape[contact]),
                rate=self.rate,
                mobility=self.mobility,
                offset=float(self.offset[contact]),
                gravity=float(self.gravity[contact]),
                mass=float(self.mass[contact]),
                compliance=float(self.compliance[contact]),
                flexibility=float(self.flexibility.sum()),
                rigid=int(self.rigid.sum()),
                driven=self.driven,
            )
        return self._records[contact]

    def part(self, coordinates: Indices, contacts: Indices) -> LinearSystem:
        """Return some of the coordinates and contacts as a system of their own.

        There are no massless elements, driven coordinates or friction.
        """
        return LinearSystem(
            angular_frequency=self.angular_frequency[coordinates],
            damping_ratio=self.damping_ratio[coordinates],
            shape=self.shape[np.ix_(contacts, coordinates)],
            offset=self.offset[contacts],
            load=self.load[coordinates],
            inside=self.inside[coordinates],
            below=self.below[np.ix_(contacts, coordinates)],
            rate=self.rate,
            mobility=self.mobility,
            local_contact=self.local_contact,
        )

    def with_sphere(self, shape: float, load: float) -> LinearSystem:
        """Return the same system with a sphere of another mass and weight.

        The fall of the sphere is the first coordinate.
        """
        shapes = self.shape.copy()
        loads = self.load.copy()
        shapes[:, 0] = shape
        loads[0] = load
        system = replace(self, shape=shapes, load=loads)
        # the modes stay the same, and so does what is computed from them
        system.__dict__["shared_modes"] = self.shared_modes
        return system

    @cached_property
    def sliding(self) -> LinearSystem:
        """The same system with the directions of friction, and of its moments, as contacts."""
        assert self.along is not None
        directions = len(self.along)
        return replace(
            self,
            shape=np.concatenate([self.shape, -self.along]),
            offset=np.concatenate([self.offset, np.zeros(directions)]),
            below=np.repeat(self.below, 1 + directions, axis=0),
            along=None,
        )

    @cached_property
    def rigid(self) -> Bools:
        """Mask of the rigid motions (n,)."""
        return np.asarray(self.angular_frequency == 0.0)

    @property
    def ground(self) -> Bools:
        """Mask of the coordinates of the body below, without the driven ones, of a drop (n,)."""
        return np.asarray(self.below[0] & (np.arange(self.number) < self.number - self.driven))

    @cached_property
    def vibrating(self) -> Bools:
        """Mask of the vibration modes (n,)."""
        return ~self.rigid

    @cached_property
    def outer_shape(self) -> Floats:
        """Shapes of the coordinates outside the contacts, zero for those inside (contacts, n)."""
        return np.where(self.inside, 0.0, self.shape)

    @cached_property
    def inner_shape(self) -> Floats:
        """Shapes of the coordinates inside the contacts, zero for the others (contacts, n)."""
        return self.shape - self.outer_shape

    @cached_property
    def indentation_shape(self) -> Floats:
        """Shapes of the coordinates that count in the indentation (contacts, n).

        These are the rigid motions and the modes of `below`; the others are zero.
        """
        return np.where(self.below | self.rigid, self.shape, 0.0)

    @cached_property
    def rigid_shape(self) -> Floats:
        """Shapes of the rigid motions, zero for the modes (contacts, n)."""
        return np.where(self.rigid, self.shape, 0.0)

    @cached_property
    def mass(self) -> Floats:
        """Effective mass of the rigid motions at each contact [kg] (contacts,).

        Of a free and a held body it is the mass of the free one.
        """
        return np.asarray(1.0 / (self.rigid_shape**2).sum(axis=1))

    @cached_property
    def gravity(self) -> Floats:
        """Acceleration of the approach by gravity [m/s^2] (contacts,).

        It is exactly zero where both bodies fall alike.
        """
        terms = self.shape * self.load
        acceleration = terms.sum(axis=1)
        beyond_rounding = np.abs(acceleration) > _ROUNDING * np.abs(terms).sum(axis=1)
        return np.where(beyond_rounding, acceleration, 0.0)

    @cached_property
    def local_incidence(self) -> Floats:
        """Incidence matrix of contacts and the massless elements in series (contacts, k)."""
        return np.asarray(self.local_contact == np.arange(len(self.shape))[:, None], dtype=float)

    @cached_property
    def local_compliance(self) -> Floats:
        """Compliance of the springs of the massless elements [m/N] (k,)."""
        return self.mobility / self.rate

    @cached_property
    def flexibility(self) -> Floats:
        """Inverse squared angular frequency of each mode, zero for rigid motions [s^2] (n,)."""
        return np.where(
            self.rigid, 0.0, 1.0 / np.where(self.rigid, 1.0, self.angular_frequency) ** 2
        )

    @cached_property
    def compliance(self) -> Floats:
        """Static compliance of modes and massless elements at each contact [m/N] (contacts,)."""
        return np.asarray(
            self.shape**2 @ self.flexibility + self.local_incidence @ self.local_compliance
        )

    def energies(self, state: State) -> tuple[Floats, Floats]:
        """Return the kinetic and the strain energy of each coordinate [J] (..., n).

        They are zero for driven coordinates. States may have leading axes.
        """
        kinetic = 0.5 * state.velocity**2
        strain = 0.5 * (self.angular_frequency * state.displacement) ** 2
        if self.driven:
            kinetic[..., -self.driven :] = 0.0
            strain[..., -self.driven :] = 0.0
        return kinetic, strain

    def local_energy(self, state: State) -> Floats:
        """Return the energy in the springs of the massless elements [J]."""
        return np.asarray(0.5 * (state.local**2 * self.rate / self.mobility).sum(axis=-1))

    def mechanical_energy(self, state: State) -> Floats:
        """Return the kinetic, potential and strain energy [J], without that of contact laws."""
        kinetic, strain = self.energies(state)
        total = kinetic.sum(axis=-1) + strain.sum(axis=-1)
        return np.asarray(total - state.displacement @ self.load + self.local_energy(state))

    def common_energy(self, state: State) -> Floats:
        """Return the energy of rigid motions that do not change the first approach [J].

        It is the kinetic energy of two free bodies that move together.
        """
        if np.count_nonzero(self.rigid) == 1:
            return np.zeros(state.velocity.shape[:-1])
        approach_rate = state.velocity @ self.rigid_shape[0]
        twice_kinetic = (state.velocity[..., self.rigid] ** 2).sum(axis=-1)
        return np.asarray(0.5 * (twice_kinetic - self.mass[0] * approach_rate**2))

    def approach(self, state: State) -> Floats:
        """Return the approach of the surfaces [m] (..., contacts), negative in a gap."""
        return np.asarray(
            self.offset + state.displacement @ self.shape.T + state.local @ self.local_incidence.T
        )

    def approach_at(self, state: State, contact: int) -> Floats:
        """Return the approach of the surfaces of one contact [m] (...)."""
        return np.asarray(
            self.offset[contact]
            + state.displacement @ self.shape[contact]
            + state.local @ self.local_incidence[contact]
        )

    def rates(self, state: State) -> Floats:
        """Return the rate of the approach without contact force [m/s] (..., contacts)."""
        return np.asarray(
            state.velocity @ self.shape.T - (state.local * self.rate) @ self.local_incidence.T
        )

    def outer_rates(self, state: State) -> Floats:
        """Return the rate at the dashpot of each contact law [m/s] (..., contacts).

        It is that without contact force.
        """
        return np.asarray(
            state.velocity @ self.outer_shape.T - (state.local * self.rate) @ self.local_incidence.T
        )

    def rigid_motion(self, state: State) -> tuple[Floats, Floats]:
        """Return the approach by the rigid motions [m] and its rate [m/s] (..., contacts).

        The approach includes the offset.
        """
        approach = self.offset + state.displacement @ self.rigid_shape.T
        rate = state.velocity @ self.rigid_shape.T
        return approach, rate

    def driven_motion(self, state: State) -> tuple[Floats, Floats, Floats]:
        """Return the first approach by the driven coordinates, and its derivatives (...).

        The derivatives are its rate and its acceleration [m, m/s, m/s^2].
        """
        driven = slice(self.number - self.driven, None)
        shape = self.shape[0, driven]
        displacement = state.displacement[..., driven]
        approach = displacement @ shape
        rate = state.velocity[..., driven] @ shape
        acceleration = -(displacement * self.angular_frequency[driven] ** 2) @ shape
        return approach, rate, acceleration

    def accelerations(self, state: State, force: Floats) -> Floats:
        """Return the accelerations of the coordinates outside the contacts, (T, n).

        `force`: contact forces [N] (T, contacts).
        """
        unforced = (
            self.load
            - self.damping * state.velocity
            - self.angular_frequency**2 * state.displacement
        )
        return np.asarray(unforced - force @ self.outer_shape)


@dataclass(frozen=True)
class FreeMotion:
    """Motion without contact force from a given state, in closed form."""

    system: LinearSystem
    start: State

    def state(self, time: Floats) -> State:
        """Return the state at times since the start [s] (...)."""
        system = self.system
        start = self.start
        time = np.asarray(time, dtype=float)
        t = time[..., None]
        cosine, sine = system.propagators(time)
        # only rigid motions have a load, under which they fall freely
        displacement = (
            cosine * start.displacement + sine * start.velocity + 0.5 * system.load * t**2
        )
        velocity = (
            (cosine - system.damping * sine) * start.velocity
            - system.angular_frequency**2 * sine * start.displacement
            + system.load * t
        )
        return State(displacement, velocity, start.local * np.exp(-system.rate * t))

    def state_after(self, time: float) -> State:
        """Return the state at one time since the start [s], without the arrays of many times."""
        return State(*state_after(self.system.record_of(0), self.start.record, time))

    def after(self, time: float) -> FreeMotion:
        """Return the motion from a time on [s]."""
        return FreeMotion(self.system, self.state_after(time))

    def lost_by(self, time: Floats) -> Floats:
        """Return the energy lost since the start [J], (..., n + 1).

        It is given for each coordinate, and last for the massless elements.
        """
        return self.lost_at(self.state(time))

    def lost_at(self, state: State) -> Floats:
        """Return the energy lost since the start [J] as in `lost_by`, at states of this motion."""
        system = self.system
        initial_energy = sum(system.energies(self.start))
        coordinates = np.where(system.rigid, 0.0, initial_energy - sum(system.energies(state)))
        massless = system.local_energy(self.start) - system.local_energy(state)
        return np.concatenate([coordinates, massless[..., None]], axis=-1)

    def motion(self, time: Floats) -> tuple[Floats, Floats]:
        """Return the approach of the surfaces [m] and its rate [m/s], (..., contacts).

        Times [s] are since the start.
        """
        state = self.state(time)
        return self.system.approach(state), self.system.rates(state)
