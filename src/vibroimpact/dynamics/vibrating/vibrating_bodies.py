"""Drops whose bodies vibrate: their linear systems, flights, contacts and rest, for the
run of a batch of B drops.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from vibroimpact.arrays import Bools, Complex, Drops, Floats
from vibroimpact.bodies.body import Body
from vibroimpact.contact.friction.law import CompliantFriction
from vibroimpact.contact.law import CompliantLaw, ContactLaw
from vibroimpact.dynamics.bounce import Bounce
from vibroimpact.dynamics.columns import VIBRATING_IMPACT_COLUMNS
from vibroimpact.dynamics.contact import CAPTURED, RIDING, SETTLED, Contact, Piece
from vibroimpact.dynamics.core.surface_friction_records import SlidingSphere
from vibroimpact.dynamics.flight import Flight
from vibroimpact.dynamics.impact_conditions import ImpactConditions
from vibroimpact.dynamics.oblique.oblique_motion import ObliqueMotion
from vibroimpact.dynamics.oblique.state import ObliqueContacts
from vibroimpact.dynamics.oblique.statement import Oblique
from vibroimpact.dynamics.problem import Problem
from vibroimpact.dynamics.run_bodies import Motions
from vibroimpact.dynamics.shaken.steady import steady_surface
from vibroimpact.dynamics.vibrating.carried_motion import carry
from vibroimpact.dynamics.vibrating.carried_oscillations import carry_oscillating, steady_response
from vibroimpact.dynamics.vibrating.contact_equilibrium import ContactEquilibrium
from vibroimpact.dynamics.vibrating.elastic_impact import ElasticImpact, follow_elastic_impact
from vibroimpact.dynamics.vibrating.fluid_motion import free_motion
from vibroimpact.dynamics.vibrating.growth_of_differences import SharedStatics
from vibroimpact.dynamics.vibrating.linear_system import FreeMotion, LinearSystem, State
from vibroimpact.dynamics.vibrating.next_touch import next_touch
from vibroimpact.dynamics.vibrating.rest_motion import RestMotion, bring_to_rest
from vibroimpact.dynamics.vibrating.sliding_contact import sliding_contacts
from vibroimpact.dynamics.vibrating.surface_friction import (
    NO_FRICTION,
    surface_friction_at_touch,
)

if TYPE_CHECKING:
    from vibroimpact.structures.modal_model import ModalBasis  # which loads sparse matrices

_SAME_PLACE = 1e-12
"""Distance of places at which the contact is the same [m]."""

_MOST_PLACES = 8
"""Number of corrections of the place where a sphere touches a plate that deflects."""


def system_of(problem: Problem, mass: float, gravity: float) -> LinearSystem:
    """Return the linear system of a drop: the fall of the sphere, the rigid motions of the plate,
    the modes of both, the local element, and the motion of a plate that is shaken.

    Parameters
    ----------
    problem : Problem
        The problem.
    mass, gravity : float
        Of this drop [kg, m/s^2].
    """
    parts = [(np.zeros(1), np.zeros(1), np.array([mass**-0.5]))]
    of_bodies = (
        (problem.plate.rigid, 1.0),
        (problem.sphere.modes, -1.0),
        (problem.plate.modes, 1.0),
    )
    parts += [
        (basis.angular_frequencies, basis.damping_ratios, sign * basis.contact)
        for basis, sign in of_bodies
        if basis
    ]
    driven, _, moved = driven_motion_of(problem)
    parts += [(driven, np.zeros_like(driven), _IMMOVABLE * mass**-0.5 * moved[2])]
    frequency, damping, shape = (np.concatenate(part) for part in zip(*parts, strict=True))
    of_rigid, of_sphere, of_plate = slices_of(problem)
    load, inside, ground = (
        np.zeros(len(shape)),
        np.zeros(len(shape), dtype=bool),
        np.zeros(len(shape), dtype=bool),
    )
    load[0], inside[of_sphere], ground[of_rigid], ground[of_plate] = (
        gravity * mass**0.5,
        problem.sphere_inside,
        True,
        True,
    )
    ground[of_plate.stop :] = True
    along = None
    if problem.oblique is not None and problem.oblique.friction is not None:
        along = np.zeros((5 if _moments_act(problem.oblique) else 2, len(shape)))
        for basis, where in ((problem.plate.rigid, of_rigid), (problem.plate.modes, of_plate)):
            if basis is not None:
                assert basis.along is not None  # the problem has seen to it
                along[:2, where] = basis.along.T
                if basis.turning is not None:
                    along[2:, where] = (basis.turning[:, [1, 0, 2]] * [-1.0, 1.0, 1.0]).T[
                        : len(along) - 2
                    ]
        along[:2, of_plate.stop :] = _IMMOVABLE * mass**-0.5 * moved[:2]
    local = [problem.local_element] if problem.local_element else []
    rate = np.array([stiffness / damping for stiffness, damping in local])
    mobility = np.array([1.0 / damping for _, damping in local])
    contact = np.zeros(len(local), dtype=np.intp)
    residuals = {} if problem.plate.modes is None else problem.plate.modes.residuals
    of_elements = (rate, mobility, contact)
    return LinearSystem(
        frequency,
        damping,
        shape[None],
        np.zeros(1),
        load,
        inside,
        ground[None],
        *of_elements,
        along,
        residuals,
        len(driven),
    )


def _moments_act(oblique: Oblique) -> bool:
    """Return whether rolling resistance or twisting friction acts on some of the drops."""
    return oblique.friction is not None and bool(
        np.any(oblique.friction.rolling_coefficient) or np.any(oblique.spin[2])
    )


_IMMOVABLE = 1e-10
"""Shape of a driven coordinate over that of the sphere [-]: of a mass 1e20 times that of
the sphere, which no contact disturbs.
"""


def driven_motion_of(problem: Problem) -> tuple[Floats, Complex, Floats]:
    """Return the harmonic motions that what drives a plate consists of, and what each adds to that
    of its surface at the contact point.

    Returns
    -------
    angular_frequency : array, shape (d,)
        [rad/s].
    phasors : array of complex, shape (d,)
        Of the motions, times their shapes in metres.
    shape : array, shape (3, d)
        Displacement of the surface along x, y and the normal by each. A rigid plate moves with its
        supports; an elastic one along its normal, and in all directions, out of phase, where it is
        hit obliquely: by sine and cosine of each frequency.
    """
    motion, modes = problem.motion, problem.plate.modes
    if motion is None or not problem.shaken:
        return np.zeros(0), np.zeros(0, dtype=complex), np.zeros((3, 0))
    omega, ones = motion.angular_frequency, np.ones(len(motion.phasors))
    if modes is None:
        return omega, motion.phasors, np.outer(motion.direction, ones)
    if problem.oblique is None:
        return omega, problem.surface_phasors, np.outer([0.0, 0.0, 1.0], ones)
    surface = steady_surface(motion, modes)
    return (
        np.tile(omega, 2),
        np.concatenate([ones, 1j * ones]),
        np.concatenate([surface.real, surface.imag], axis=1),
    )


def slices_of(problem: Problem) -> tuple[slice, slice, slice]:
    """Return the slices of the plate's rigid motions, the sphere's modes and the plate's modes
    among the coordinates of a drop.

    The fall of the sphere is the first coordinate; driven coordinates come last.
    """
    rigid = 0 if problem.plate.rigid is None else len(problem.plate.rigid.frequencies)
    ends = np.cumsum([1, rigid, modes_of(problem.sphere), modes_of(problem.plate)]).tolist()
    return slice(ends[0], ends[1]), slice(ends[1], ends[2]), slice(ends[2], ends[3])


def bases_of_plate(problem: Problem) -> list[ModalBasis]:
    """Return the rigid motions of a plate that is not held, and its modes, in the order
    of its coordinates.
    """
    return [basis for basis in (problem.plate.rigid, problem.plate.modes) if basis is not None]


def centre_of(state: State, mass: Floats | float) -> tuple[Floats, Floats]:
    """Return the depth of the sphere's centre below its position at touch [m], and its
    downward speed [m/s].
    """
    root = np.sqrt(mass)
    return np.asarray(state.displacement[..., 0] / root), np.asarray(state.velocity[..., 0] / root)


def modes_of(body: Body) -> int:
    """Return the number of modes of a body."""
    return 0 if body.modes is None else len(body.modes.frequencies)


class VibratingBodies:
    """The bodies of B drops of which some vibrate: one linear system per drop, with the modes in
    common. `Bodies` describes the methods.

    `oblique`: their motion along the plate, where they have any.
    """

    def __init__(
        self, problem: Problem, mass: Floats, gravity: Floats, oblique: ObliqueMotion | None
    ) -> None:
        self.problem, self.mass, self.gravity, self.oblique, size = (
            problem,
            mass,
            gravity,
            oblique,
            len(mass),
        )
        sensitive = (
            problem.sensitivity
            and oblique is None
            and problem.air is None
            and problem.liquid is None
        )
        self.columns = tuple(
            name for name in VIBRATING_IMPACT_COLUMNS if sensitive or name != "sensitivity"
        )
        pairs = list(zip(mass.tolist(), gravity.tolist(), strict=True))
        self.system = system_of(problem, *pairs[0])
        distinct = {
            (mass, gravity): self.system.with_sphere(mass**-0.5, gravity * mass**0.5)
            for mass, gravity in set(pairs)
        }
        self.systems, self.series = (
            [distinct[pair] for pair in pairs],
            [problem.quasi_static] * size,
        )
        self.displacement, self.velocity = (
            np.zeros((size, self.system.number)),
            np.zeros((size, self.system.number)),
        )
        if driven := self.system.driven:
            phasors = driven_motion_of(problem)[1] / (_IMMOVABLE * float(mass[0]) ** -0.5)
            self.displacement[:, -driven:], self.velocity[:, -driven:] = (
                phasors.imag,
                self.system.angular_frequency[-driven:] * phasors.real,
            )
        self.places = [problem] * size
        self.local = np.zeros((size, len(self.system.rate)))
        self.lost = np.zeros((size, self.system.number + 1))
        self.lying: list[RestMotion | None] = [None] * size
        self.left = np.full(size, np.nan)
        self.neighbours = SharedStatics(problem, mass, self.system) if sensitive else None

    def state(self, drop: int, gap: float, velocity: float) -> State:
        """Return the state of a drop whose sphere has a gap [m] and a velocity upwards [m/s]."""
        # as these go on changing
        state = State(
            *(part[drop].copy() for part in (self.displacement, self.velocity, self.local))
        )
        root = self.mass[drop] ** 0.5
        state.displacement[0], state.velocity[0] = -root * gap, -root * velocity
        return state

    def place(self, drop: int, state: State) -> None:
        """Store the state of a drop."""
        self.displacement[drop], self.velocity[drop], self.local[drop] = (
            state.displacement,
            state.velocity,
            state.local,
        )

    def next_touch(
        self, drops: Drops, flight: Flight, law: ContactLaw
    ) -> tuple[Floats, Floats, Motions]:
        """Return the times of the next touch [s], the approach speeds of the rigid bodies
        then [m/s], and the free motions of the drops.
        """
        assert isinstance(law, CompliantLaw)  # the problem has seen to it
        levels, guess = (
            law.touch_level + np.zeros(len(drops)),
            flight.touch(np.zeros(1))[0] - flight.start,
        )
        flights = [flight.take(np.array([number])) for number in range(len(drops))]
        found = [
            self._touch(*one)
            for one in zip(drops.tolist(), flights, levels.tolist(), guess.tolist(), strict=True)
        ]
        motions, elapsed = (
            tuple(motion for motion, _ in found),
            np.array([time for _, time in found]),
        )
        touch = flight.start + elapsed
        when = np.where(np.isfinite(elapsed), touch, flight.start)
        surface = self.problem.surface(when)[1]
        if self.problem.at_place is not None:
            surface = np.array(
                [self.places[drop].surface(time)[1] for drop, time in zip(drops, when, strict=True)]
            )
        return touch, -self._rigid_speed(drops, flight.at(when)[1] - surface), motions

    def _free(self, drop: int, flight: Flight) -> FreeMotion:
        """Return the free motion of a drop whose sphere is on a flight."""
        return free_motion(
            self.systems[drop],
            self.state(drop, float(flight.gap[0]), float(flight.velocity[0])),
            flight,
        )

    def _touch(
        self, drop: int, flight: Flight, level: float, guess: float
    ) -> tuple[FreeMotion, float]:
        """Return the free motion of a drop and the time until it touches [s], where it
        then is over the plate; `guess`: about that time.
        """
        problem = self.problem
        if self.oblique is None or problem.at_place is None or problem.plate_at_place is None:
            motion = self._free(drop, flight)
            return motion, next_touch(motion, level, np.inf)
        one = np.array([drop])
        time = guess
        place = self.oblique.place_on_plate(one, flight, flight.start + time)[:, 0]
        # the deflection of the plate where it falls changes the time a little, and that the place
        for _ in range(_MOST_PLACES):
            at = (float(place[0]), float(place[1]))
            self._put_contact(
                drop, problem.on_plate(problem.plate_at_place(at), problem.quasi_static)
            )
            time = next_touch(self._free(drop, flight), level, np.inf)
            if not np.isfinite(time):
                break
            before = place
            place = self.oblique.place_on_plate(one, flight, flight.start + time)[:, 0]
            if np.abs(place - before).max() <= _SAME_PLACE:
                break
        self._put_contact(drop, problem.at_place(at))
        return self._free(drop, flight), time

    def _put_contact(self, drop: int, there: Problem) -> None:
        """Let the contact of a drop be at another place on the plate, as a problem has it."""
        mass, gravity = float(self.mass[drop]), float(self.gravity[drop])
        # what drives the plate has its coordinates in common
        system = system_of(there, float(self.mass[0]), float(self.gravity[0])).with_sphere(
            mass**-0.5, gravity * mass**0.5
        )
        self.places[drop] = there
        self.systems[drop] = system
        self.series[drop] = there.quasi_static

    def pass_flight(self, drops: Drops, motions: Motions, elapsed: Floats) -> None:
        """Advance the coordinates of drops by free motion."""
        for drop, motion, time in zip(drops, motions, elapsed, strict=True):
            state = motion.state_after(float(time))
            self.lost[drop] += motion.lost_at(state)
            self.place(drop, state)

    def closing_speed(self, drops: Drops, speed: Floats, velocity: Floats) -> Floats:
        """Return the closing speed of the surfaces, with the vibration outside the
        contact [m/s].
        """
        states = (self.state(drop, 0.0, up) for drop, up in zip(drops, velocity, strict=True))
        return np.array(
            [
                float(self.systems[drop].outer_rates(state)[0])
                for drop, state in zip(drops, states, strict=True)
            ]
        )

    def rigid_speed(self, drops: Drops, velocity: Floats) -> Floats:
        """Return the separation speed of the rigid motions [m/s], of sphere and plate,
        relative to what drives the plate.
        """
        surface = [
            float(self.systems[drop].driven_motion(self.state(drop, 0.0, 0.0))[1]) for drop in drops
        ]
        return self._rigid_speed(drops, velocity - np.array(surface))

    def _rigid_speed(self, drops: Drops, velocity: Floats) -> Floats:
        states = (self.state(drop, 0.0, up) for drop, up in zip(drops, velocity, strict=True))
        return np.array(
            [
                -float(self.systems[drop].rigid_motion(state)[1][0])
                for drop, state in zip(drops, states, strict=True)
            ]
        )

    def collide(
        self,
        drops: Drops,
        conditions: ImpactConditions,
        place: tuple[Floats, Floats],
        limits: tuple[Floats, Floats],
        row: dict[str, Floats],
    ) -> tuple[Contact, Floats, Floats]:
        """Take drops through their visits."""
        (gaps, velocities), (rest_speed, until) = place, limits
        starts, visits = [], []
        for number, drop in enumerate(drops):
            one, problem = conditions.take(np.array([number])), self.problem
            # the duration of Hertz's contact goes with the 0.4th power of the mass; a free plate
            # reduces the effective mass
            lighter = float(self.systems[drop].mass[0] / one.mass[0]) ** 0.4
            start, pace = (
                self.state(drop, gaps[number], velocities[number]),
                3.0 * lighter * float(one.depth[0] / one.speed_scale[0]),
            )
            rules = (
                problem.tolerance,
                pace,
                not problem.same_spot,
                float(rest_speed[number]),
                float(until[number]),
            )
            visits.append(
                follow_elastic_impact(
                    self.systems[drop],
                    one.law.take(0),
                    self.series[drop],
                    start,
                    *rules,
                    self.sliding_sphere(drop, one),
                )
            )
            starts.append(start)
        for number, (drop, start, found) in enumerate(zip(drops, starts, visits, strict=True)):
            system = self.systems[drop]
            before, after = (
                float(np.sum(system.energies(state), axis=0)[system.vibrating].sum())
                for state in (start, found.state)
            )
            row["closing_speed_m_s"][drop], row["contacts"][drop] = (
                conditions.approach_speed[number],
                found.contacts,
            )
            row["energy_to_vibration_J"][drop] = (
                after - before + found.lost[: system.number - system.driven].sum()
            )
            if self.problem.motion is not None:
                row["plate_work_J"][drop] = -found.lost[system.number - system.driven : -1].sum()
            if self.problem.motion is not None and self.problem.at_place is not None:
                row["plate_velocity_m_s"][drop] = system.driven_motion(start)[1]
            self.lost[drop, :-1] += found.lost[:-1]
            self.place(drop, found.state)
            if found.outcome == CAPTURED and system.driven:
                equilibrium = ContactEquilibrium(system, found.local)
                response = steady_response(equilibrium)
                self.lying[drop] = (
                    carry(equilibrium, found.state, found.stored)
                    if response is None
                    else carry_oscillating(response, found.state, found.stored)
                )
            elif found.outcome in (CAPTURED, SETTLED, RIDING) and not system.driven:
                equilibrium = ContactEquilibrium(system, found.local)
                self.left[drop] = equilibrium.excess(found.state, found.stored)
                if found.outcome != RIDING:
                    self.lying[drop] = lying = bring_to_rest(equilibrium, found.state, found.stored)
                    self.left[drop] = lying.excess
        force, when = (
            np.array([getattr(found, name) for found in visits])
            for name in ("max_force", "time_of_max_force")
        )
        return contact_of(visits, conditions.law), force, when

    def sliding_sphere(self, drop: int, conditions: ImpactConditions) -> SlidingSphere:
        """Return the friction of a drop at first touch."""
        law = (
            None
            if self.oblique is None or self.oblique.law is None
            else self.oblique.law.take(drop)
        )
        if self.oblique is None or not isinstance(law, CompliantFriction):
            return NO_FRICTION
        sphere, before = self.oblique.now(np.array([drop]))
        largest = float(
            conditions.law.forces(conditions.depth, np.zeros(1), conditions.approach_speed)[0][0]
        )
        along = self.systems[drop].along
        assert along is not None  # there is friction
        return surface_friction_at_touch(law, largest, sphere, before, len(along))

    def slide(
        self, oblique: ObliqueMotion, bounce: Bounce, row: dict[str, Floats]
    ) -> ObliqueContacts:
        """Advance drops along the plate as their visits have it."""
        assert bounce.contact is not None
        return sliding_contacts(oblique, bounce.contact_drops, bounce.contact, row)

    def falls_back(self, contact: Contact, law: CompliantLaw, gravity: Floats) -> Bools:
        """Return False for all drops: a visit includes the contacts of those that fall back."""
        return np.zeros(len(gravity), dtype=bool)

    def rests(self, drops: Drops, velocity: Floats, rest_speed: Floats) -> Bools:
        """Return which drops have come to rest."""
        return np.array([self.lying[drop] is not None for drop in drops], dtype=bool)

    def static_state(
        self, drops: Drops, law: ContactLaw, weight: Floats, energy: Floats
    ) -> dict[str, Floats]:
        """Return `sag` [m], `stored` and `written_off` [J] of drops that have come to rest."""
        lying = [found for drop in drops if (found := self.lying[drop]) is not None]
        rows = [
            (found.equilibrium.sag, found.equilibrium.stored, found.written_off) for found in lying
        ]
        return dict(
            zip(("sag", "stored", "written_off"), np.array(rows).reshape(-1, 3).T, strict=True)
        )

    def follow(
        self, drops: Drops, elapsed: Floats, sag: Floats, stored: Floats
    ) -> tuple[Floats, Floats, Floats]:
        """Advance drops at rest by their small oscillations; return gaps [m], upward
        velocities [m/s] and energies in the contacts [J].
        """
        ends = np.zeros((len(drops), 3))
        for number, drop in enumerate(drops):
            lying, time = self.lying[drop], elapsed[number : number + 1]
            assert lying is not None  # it has come to rest
            state = lying.state(time).take(0)
            self.lost[drop] += lying.lost_by(time)[0]
            self.place(drop, state)
            depth, sinking = centre_of(state, self.mass[drop])
            ends[number] = -float(depth), -float(sinking), float(lying.stored(time)[0])
        return ends[:, 0], ends[:, 1], ends[:, 2]

    def growth(self, bounce: Bounce) -> Floats:
        """Return the growth of a small change of each drop by the impact of a bounce [-], or
        nothing where it is not asked for.
        """
        return np.zeros(0) if self.neighbours is None else self.neighbours.follow(bounce)

    def energies(self) -> dict[str, Floats]:
        """Return the entries of the energy balance [J], (B,), with separate ones for the
        local elements.
        """
        state = State(self.displacement, self.velocity, self.local)
        (kinetic, strain), (rigid, sphere, plate) = (
            self.system.energies(state),
            slices_of(self.problem),
        )
        return {
            "sphere_vibration_J": kinetic[:, sphere].sum(axis=1),
            "sphere_strain_J": strain[:, sphere].sum(axis=1),
            "sphere_damping_J": self.lost[:, sphere].sum(axis=1),
            "plate_kinetic_J": kinetic[:, rigid].sum(axis=1) + kinetic[:, plate].sum(axis=1),
            "plate_strain_J": strain[:, plate].sum(axis=1),
            "plate_damping_J": self.lost[:, plate].sum(axis=1),
            "local_J": self.system.local_energy(state),
            "local_damping_J": self.lost[:, -1],
            **(
                {"drive_J": self.lost[:, -1 - driven : -1].sum(axis=1)}
                if (driven := self.system.driven)
                else {}
            ),
        }


def contact_of(visits: list[ElasticImpact], law: CompliantLaw) -> Contact:
    """Return the visits of several drops as one contact; `law` holds their laws before it."""

    def gathered(name: str) -> Floats:
        return np.array([getattr(found, name) for found in visits], dtype=float)

    pieces = [
        Piece(np.array([drop]), np.array([part.start]), part.motion, law)
        for drop, found in enumerate(visits)
        for part in found.parts
    ]
    ends = np.array(
        [centre_of(found.state, float(found.system.shape[0, 0]) ** -2) for found in visits],
        dtype=float,
    )
    memories = {
        name: np.array([found.law.memories()[name] for found in visits], dtype=float)
        for name in law.memories()
    }
    return Contact(
        pieces,
        gathered("outcome").astype(np.int8),
        gathered("duration"),
        ends[:, 0],
        ends[:, 1],
        gathered("max_indentation"),
        gathered("time_of_max_indentation"),
        np.array([found.lost[-1] for found in visits]),
        gathered("plastic"),
        gathered("stored"),
        law.changed(memories),
    )
