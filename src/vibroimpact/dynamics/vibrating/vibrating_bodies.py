"""Drops whose bodies vibrate: their linear systems, flights, contacts and rest, for B drops."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from vibroimpact.arrays import Bools, Complex, Drops, Floats
from vibroimpact.bodies.body import Body
from vibroimpact.contact.friction.law import CompliantFriction
from vibroimpact.contact.law import CompliantLaw, ContactLaw
from vibroimpact.dynamics.bounce import Bounce
from vibroimpact.dynamics.columns import VIBRATING_IMPACT_COLUMNS
from vibroimpact.dynamics.contact import CAPTURED, RIDING, SETTLED, Contact
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
from vibroimpact.dynamics.vibrating.growth_of_differences import NeighbouringDrops
from vibroimpact.dynamics.vibrating.linear_system import FreeMotion, LinearSystem, State
from vibroimpact.dynamics.vibrating.next_touch import next_touch
from vibroimpact.dynamics.vibrating.recorded_contact import PiecesOfImpacts
from vibroimpact.dynamics.vibrating.rest_motion import RestMotion, bring_to_rest
from vibroimpact.dynamics.vibrating.sliding_contact import sliding_contacts
from vibroimpact.dynamics.vibrating.surface_friction import (
    NO_FRICTION,
    surface_friction_at_touch,
)

if TYPE_CHECKING:
    from vibroimpact.structures.modal_model import ModalBasis  # which loads sparse matrices

_SAME_POSITION = 1e-12
"""Distance of positions on the plate at which the contact is the same [m]."""

_MOST_POSITIONS = 8
"""Number of corrections of the position where a sphere touches a plate that deflects."""

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
        residuals={} if problem.plate.modes is None else problem.plate.modes.residuals,
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
    rigid = 0 if problem.plate.rigid is None else len(problem.plate.rigid.frequencies)
    ends = np.cumsum([1, rigid, modes_of(problem.sphere), modes_of(problem.plate)]).tolist()
    return slice(ends[0], ends[1]), slice(ends[1], ends[2]), slice(ends[2], ends[3])


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
    return 0 if body.modes is None else len(body.modes.frequencies)


class VibratingBodies:
    """The bodies of B drops of which some vibrate; `Bodies` describes the methods.

    There is one linear system per drop, with the modes in common. `oblique`: their motion along the
    plate, where they have any.
    """

    def __init__(
        self, problem: Problem, mass: Floats, gravity: Floats, oblique: ObliqueMotion | None
    ) -> None:
        self.problem = problem
        self.mass = mass
        self.gravity = gravity
        self.oblique = oblique
        size = len(mass)
        sensitive = (
            problem.sensitivity
            and oblique is None
            and problem.air is None
            and problem.liquid is None
        )
        self.columns = tuple(
            name for name in VIBRATING_IMPACT_COLUMNS if sensitive or name != "sensitivity"
        )
        # drops of the same sphere share a system, with what is cached in it
        spheres = list(zip(mass.tolist(), gravity.tolist(), strict=True))
        self.system = system_of(problem, *spheres[0])
        system_of_sphere = {
            (mass, gravity): self.system.with_sphere(mass**-0.5, gravity * mass**0.5)
            for mass, gravity in set(spheres)
        }
        self.systems = [system_of_sphere[sphere] for sphere in spheres]
        # the contact of each drop, which may depend on its position on the plate
        self.quasi_static = [problem.quasi_static] * size
        self.problems_at_contact = [problem] * size

        self.displacement = np.zeros((size, self.system.number))
        self.velocity = np.zeros((size, self.system.number))
        driven = self.system.driven
        if driven:
            phasors = driven_motion_of(problem)[1] / (_IMMOVABLE * float(mass[0]) ** -0.5)
            self.displacement[:, -driven:] = phasors.imag
            self.velocity[:, -driven:] = self.system.angular_frequency[-driven:] * phasors.real
        self.local = np.zeros((size, len(self.system.rate)))
        self.lost = np.zeros((size, self.system.number + 1))
        self.lying: list[RestMotion | None] = [None] * size
        self.remaining_energy = np.full(size, np.nan)
        self.neighbours = NeighbouringDrops(problem, mass, self.system) if sensitive else None
        self.last_impacts: list[ElasticImpact] = []

    def state(self, drop: int, gap: float, velocity: float) -> State:
        """Return the state of a drop whose sphere has a gap [m] and a velocity upwards [m/s]."""
        # copies, since the arrays go on changing
        state = State(
            self.displacement[drop].copy(), self.velocity[drop].copy(), self.local[drop].copy()
        )
        root_mass = self.mass[drop] ** 0.5
        state.displacement[0] = -root_mass * gap
        state.velocity[0] = -root_mass * velocity
        return state

    def _store(self, drop: int, state: State) -> None:
        """Store the state of a drop."""
        self.displacement[drop] = state.displacement
        self.velocity[drop] = state.velocity
        self.local[drop] = state.local

    # flight
    # ----------------------------------------------------------------------------------------

    def next_touch(
        self, drops: Drops, flight: Flight, law: ContactLaw
    ) -> tuple[Floats, Floats, Motions]:
        """Return the times of the next touch [s], the approach speeds and the free motions.

        The approach speeds [m/s] are those of the rigid bodies at touch.
        """
        assert isinstance(law, CompliantLaw)  # the problem has seen to it
        levels = law.touch_level + np.zeros(len(drops))
        time_over_rigid_plate = flight.touch(np.zeros(1))[0] - flight.start
        motions = []
        times = []
        for number, drop in enumerate(drops.tolist()):
            motion, time = self._touch(
                drop,
                flight.take(np.array([number])),
                float(levels[number]),
                float(time_over_rigid_plate[number]),
            )
            motions.append(motion)
            times.append(time)
        elapsed = np.array(times)
        touch = flight.start + elapsed
        # the speed is not asked for where there is no touch
        evaluated_at = np.where(np.isfinite(elapsed), touch, flight.start)
        surface_velocity = self.problem.surface(evaluated_at)[1]
        if self.problem.at_place is not None:
            surface_velocity = np.array(
                [
                    self.problems_at_contact[drop].surface(time)[1]
                    for drop, time in zip(drops, evaluated_at, strict=True)
                ]
            )
        velocity = flight.at(evaluated_at)[1] - surface_velocity
        return touch, -self._rigid_speed(drops, velocity), tuple(motions)

    def _free(self, drop: int, flight: Flight) -> FreeMotion:
        """Return the free motion of a drop whose sphere is on a flight."""
        state = self.state(drop, float(flight.gap[0]), float(flight.velocity[0]))
        return free_motion(self.systems[drop], state, flight)

    def _touch(
        self, drop: int, flight: Flight, level: float, guess: float
    ) -> tuple[FreeMotion, float]:
        """Return the free motion of a drop and the time until it touches [s].

        It touches where it is over the plate at that time. `level`: gap at touch with sign
        reversed [m]. `guess`: approximate time [s].
        """
        problem = self.problem
        if self.oblique is None or problem.at_place is None or problem.plate_at_place is None:
            motion = self._free(drop, flight)
            return motion, next_touch(motion, level, np.inf)
        drops = np.array([drop])
        time = guess
        position = self.oblique.place_on_plate(drops, flight, flight.start + time)[:, 0]
        # a fixed-point iteration: the deflection of the plate where the sphere falls changes the
        # time a little, and the time the position
        for _ in range(_MOST_POSITIONS):
            contact_point = (float(position[0]), float(position[1]))
            plate = problem.plate_at_place(contact_point)
            self._put_contact(drop, problem.on_plate(plate, problem.quasi_static))
            time = next_touch(self._free(drop, flight), level, np.inf)
            if not np.isfinite(time):
                break
            previous = position
            position = self.oblique.place_on_plate(drops, flight, flight.start + time)[:, 0]
            if np.abs(position - previous).max() <= _SAME_POSITION:
                break
        self._put_contact(drop, problem.at_place(contact_point))
        return self._free(drop, flight), time

    def _put_contact(self, drop: int, problem: Problem) -> None:
        """Move the contact of a drop to the position on the plate for which a problem is stated."""
        mass = float(self.mass[drop])
        gravity = float(self.gravity[drop])
        # all drops have what drives the plate in common, and with it the mass of the first
        system = system_of(problem, float(self.mass[0]), float(self.gravity[0]))
        self.problems_at_contact[drop] = problem
        self.systems[drop] = system.with_sphere(mass**-0.5, gravity * mass**0.5)
        self.quasi_static[drop] = problem.quasi_static

    def pass_flight(self, drops: Drops, motions: Motions, elapsed: Floats) -> None:
        """Advance the coordinates of drops by free motion."""
        for drop, motion, time in zip(drops, motions, elapsed, strict=True):
            state = motion.state_after(float(time))
            self.lost[drop] += motion.lost_at(state)
            self._store(drop, state)

    def closing_speed(self, drops: Drops, speed: Floats, velocity: Floats) -> Floats:
        """Return the closing speed of the surfaces [m/s].

        It includes the vibration outside the contact.
        """
        return np.array(
            [
                float(self.systems[drop].outer_rates(self.state(drop, 0.0, upward))[0])
                for drop, upward in zip(drops, velocity, strict=True)
            ]
        )

    def rigid_speed(self, drops: Drops, velocity: Floats) -> Floats:
        """Return the separation speed of the rigid motions of sphere and plate [m/s].

        It is relative to what drives the plate.
        """
        surface_velocity = [
            float(self.systems[drop].driven_motion(self.state(drop, 0.0, 0.0))[1]) for drop in drops
        ]
        return self._rigid_speed(drops, velocity - np.array(surface_velocity))

    def _rigid_speed(self, drops: Drops, velocity: Floats) -> Floats:
        """Return the separation speed of the rigid motions [m/s], of upward velocities [m/s]."""
        return np.array(
            [
                -float(self.systems[drop].rigid_motion(self.state(drop, 0.0, upward))[1][0])
                for drop, upward in zip(drops, velocity, strict=True)
            ]
        )

    # contact
    # ---------------------------------------------------------------------------------------

    def collide(
        self,
        drops: Drops,
        conditions: ImpactConditions,
        at_touch: tuple[Floats, Floats],
        limits: tuple[Floats, Floats],
        row: dict[str, Floats],
    ) -> tuple[Contact, Floats, Floats]:
        """Take drops through their impacts."""
        gaps, velocities = at_touch
        rest_speeds, longest_rides = limits
        impacts = []
        for number, drop in enumerate(drops):
            start = self.state(drop, gaps[number], velocities[number])
            impact = self._impact(
                drop,
                conditions.take(np.array([number])),
                start,
                float(rest_speeds[number]),
                float(longest_rides[number]),
            )
            row["closing_speed_m_s"][drop] = conditions.approach_speed[number]
            self._write_columns(drop, start, impact, row)
            self.lost[drop, :-1] += impact.lost[:-1]
            self._store(drop, impact.state)
            self._leave_or_rest(drop, impact)
            impacts.append(impact)
        self.last_impacts = impacts
        max_force = np.array([impact.max_force for impact in impacts])
        time_of_max_force = np.array([impact.time_of_max_force for impact in impacts])
        return contact_of(impacts, conditions.law), max_force, time_of_max_force

    def _impact(
        self,
        drop: int,
        conditions: ImpactConditions,
        start: State,
        rest_speed: float,
        longest_ride: float,
    ) -> ElasticImpact:
        """Return the impact of one drop from its state at first touch."""
        # the duration of Hertz's contact goes with the 0.4th power of the mass; a free plate
        # reduces the effective mass
        mass_ratio = float(self.systems[drop].mass[0] / conditions.mass[0])
        rigid_duration = float(conditions.depth[0] / conditions.speed_scale[0])
        return follow_elastic_impact(
            self.systems[drop],
            conditions.law.take(0),
            self.quasi_static[drop],
            start,
            tolerance=self.problem.tolerance,
            contact_duration=3.0 * mass_ratio**0.4 * rigid_duration,
            fresh_surface=not self.problem.same_spot,
            rest_speed=rest_speed,
            until=longest_ride,
            sphere=self.sliding_sphere(drop, conditions),
        )

    def _write_columns(
        self, drop: int, start: State, impact: ElasticImpact, row: dict[str, Floats]
    ) -> None:
        """Write the columns of the impact table that bodies have which vibrate."""
        system = self.systems[drop]
        own = system.number - system.driven

        def vibration_energy(state: State) -> float:
            energies = np.sum(system.energies(state), axis=0)
            return float(energies[system.vibrating].sum())

        row["contacts"][drop] = impact.contacts
        gained = vibration_energy(impact.state) - vibration_energy(start)
        row["energy_to_vibration_J"][drop] = gained + impact.lost[:own].sum()
        if self.problem.motion is not None:
            row["plate_work_J"][drop] = -impact.lost[own:-1].sum()
            if self.problem.at_place is not None:
                row["plate_velocity_m_s"][drop] = system.driven_motion(start)[1]

    def _leave_or_rest(self, drop: int, impact: ElasticImpact) -> None:
        """Replace the contact of a sphere that stays on the plate by its small oscillations."""
        system = self.systems[drop]
        if impact.outcome not in (CAPTURED, SETTLED, RIDING):
            return
        equilibrium = ContactEquilibrium(system, impact.local)
        if not system.driven:
            self.remaining_energy[drop] = equilibrium.excess(impact.state, impact.stored)
            if impact.outcome != RIDING:
                rest = bring_to_rest(equilibrium, impact.state, impact.stored)
                self.lying[drop] = rest
                self.remaining_energy[drop] = rest.excess
        elif impact.outcome == CAPTURED:
            response = steady_response(equilibrium)
            if response is None:
                self.lying[drop] = carry(equilibrium, impact.state, impact.stored)
            else:
                self.lying[drop] = carry_oscillating(response, impact.state, impact.stored)

    def sliding_sphere(self, drop: int, conditions: ImpactConditions) -> SlidingSphere:
        """Return the friction of a drop at first touch."""
        if self.oblique is None or self.oblique.law is None:
            return NO_FRICTION
        law = self.oblique.law.take(drop)
        if not isinstance(law, CompliantFriction):
            return NO_FRICTION
        sphere, state = self.oblique.now(np.array([drop]))
        # at the depth of a contact of rigid bodies
        elastic_force, _ = conditions.law.forces(
            conditions.depth, np.zeros(1), conditions.approach_speed
        )
        along = self.systems[drop].along
        assert along is not None  # there is friction
        return surface_friction_at_touch(law, float(elastic_force[0]), sphere, state, len(along))

    def slide(
        self, oblique: ObliqueMotion, bounce: Bounce, row: dict[str, Floats]
    ) -> ObliqueContacts:
        """Advance drops along the plate as in their impacts."""
        assert bounce.contact is not None
        return sliding_contacts(oblique, bounce.contact_drops, bounce.contact, row)

    def falls_back(self, contact: Contact, law: CompliantLaw, gravity: Floats) -> Bools:
        """Return False for all drops: an impact includes the contacts of those that fall back."""
        return np.zeros(len(gravity), dtype=bool)

    # rest
    # ------------------------------------------------------------------------------------------

    def rests(self, drops: Drops, velocity: Floats, rest_speed: Floats) -> Bools:
        """Return which drops have come to rest."""
        return np.array([self.lying[drop] is not None for drop in drops], dtype=bool)

    def static_state(
        self, drops: Drops, law: ContactLaw, weight: Floats, energy: Floats
    ) -> dict[str, Floats]:
        """Return `sag` [m], `stored` and `written_off` [J] of drops that have come to rest."""
        resting = [motion for drop in drops if (motion := self.lying[drop]) is not None]
        return {
            "sag": np.array([motion.equilibrium.sag for motion in resting]),
            "stored": np.array([motion.equilibrium.stored for motion in resting]),
            "written_off": np.array([motion.written_off for motion in resting]),
        }

    def follow(
        self, drops: Drops, elapsed: Floats, sag: Floats, stored: Floats
    ) -> tuple[Floats, Floats, Floats]:
        """Advance drops at rest by their small oscillations.

        Return gaps [m], upward velocities [m/s] and energies in the contacts [J].
        """
        gaps = np.zeros(len(drops))
        velocities = np.zeros(len(drops))
        energies = np.zeros(len(drops))
        for number, drop in enumerate(drops):
            motion = self.lying[drop]
            assert motion is not None  # it has come to rest
            time = elapsed[number : number + 1]
            state = motion.state(time).take(0)
            self.lost[drop] += motion.lost_by(time)[0]
            self._store(drop, state)
            depth, fall_speed = centre_of(state, self.mass[drop])
            gaps[number] = -float(depth)
            velocities[number] = -float(fall_speed)
            energies[number] = float(motion.stored(time)[0])
        return gaps, velocities, energies

    def growth(self, bounce: Bounce) -> Floats:
        """Return the growth of a small change of each drop by the impact of a bounce [-].

        It is empty where it is not asked for.
        """
        if self.neighbours is None:
            return np.zeros(0)
        return self.neighbours.follow(bounce, [impact.sections for impact in self.last_impacts])

    def energies(self) -> dict[str, Floats]:
        """Return the entries of the energy balance [J] (B,); those of local elements are apart."""
        state = State(self.displacement, self.velocity, self.local)
        kinetic, strain = self.system.energies(state)
        rigid, sphere, plate = slices_of(self.problem)
        balance = {
            "sphere_vibration_J": kinetic[:, sphere].sum(axis=1),
            "sphere_strain_J": strain[:, sphere].sum(axis=1),
            "sphere_damping_J": self.lost[:, sphere].sum(axis=1),
            "plate_kinetic_J": kinetic[:, rigid].sum(axis=1) + kinetic[:, plate].sum(axis=1),
            "plate_strain_J": strain[:, plate].sum(axis=1),
            "plate_damping_J": self.lost[:, plate].sum(axis=1),
            "local_J": self.system.local_energy(state),
            "local_damping_J": self.lost[:, -1],
        }
        driven = self.system.driven
        if driven:
            balance["drive_J"] = self.lost[:, -1 - driven : -1].sum(axis=1)
        return balance


def contact_of(impacts: list[ElasticImpact], law: CompliantLaw) -> Contact:
    """Return the impacts of several drops as one contact; `law` holds their laws before it."""
    final_delta = []
    final_rate = []
    for impact in impacts:
        mass = float(impact.system.shape[0, 0]) ** -2
        depth, fall_speed = centre_of(impact.state, mass)
        final_delta.append(float(depth))
        final_rate.append(float(fall_speed))

    def gathered(name: str) -> Floats:
        return np.array([getattr(impact, name) for impact in impacts], dtype=float)

    memories = {
        name: np.array([impact.law.memories()[name] for impact in impacts], dtype=float)
        for name in law.memories()
    }
    return Contact(
        pieces=PiecesOfImpacts([impact.sections for impact in impacts], law),
        outcome=gathered("outcome").astype(np.int8),
        duration=gathered("duration"),
        final_delta=np.array(final_delta),
        final_rate=np.array(final_rate),
        max_delta=gathered("max_indentation"),
        time_of_max_delta=gathered("time_of_max_indentation"),
        dissipated=np.array([impact.lost[-1] for impact in impacts]),
        plastic=gathered("plastic"),
        stored=gathered("stored"),
        law=law.changed(memories),
    )
