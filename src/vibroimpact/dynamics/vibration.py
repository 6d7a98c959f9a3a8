"""The vibration of the bodies of a run: where the oscillators are, and what their damping takes."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vibroimpact.bodies.body import Body
from vibroimpact.contact.law import CompliantLaw
from vibroimpact.dynamics.collocation import Floats
from vibroimpact.dynamics.contact import CAPTURED, RIDING, SETTLED, Contact, Drops, Piece
from vibroimpact.dynamics.encounter import Encounter
from vibroimpact.dynamics.lying import Lying, lay_down
from vibroimpact.dynamics.next_touch import next_touch
from vibroimpact.dynamics.oscillators import FreeMotion, Oscillators, State
from vibroimpact.dynamics.problem import Problem
from vibroimpact.dynamics.receptance import Surroundings
from vibroimpact.dynamics.riding import Riding
from vibroimpact.dynamics.visit import Visit, visit


def oscillators_of(problem: Problem) -> Oscillators:
    """Return what vibrates in a problem: the modes of the sphere, then those of the plate; and the local element."""
    bodies = [(body.modes, sign) for body, sign in ((problem.sphere, -1.0), (problem.plate, 1.0)) if body.modes is not None]

    def of_all(parts: list[Floats]) -> Floats:
        return np.concatenate([np.zeros(0), *parts])

    local = [problem.local_element] if problem.local_element else []
    of_sphere = np.arange(sum(len(modes.frequencies) for modes, _ in bodies)) < modes_of(problem.sphere)
    return Oscillators(
        of_all([modes.angular_frequencies for modes, _ in bodies]),
        of_all([modes.damping_ratios for modes, _ in bodies]),
        of_all([sign * modes.contact for modes, sign in bodies]),
        np.array([stiffness / damping for stiffness, damping in local]),
        np.array([1.0 / damping for _, damping in local]),
        of_sphere & problem.sphere_inside,
        ~of_sphere,
    )


def modes_of(body: Body) -> int:
    """Return how many modes a body has."""
    return 0 if body.modes is None else len(body.modes.frequencies)


class Vibration:
    """The oscillators of B drops that share their bodies' modes.

    `lying`: how those lie that have come to rest. `left`: what those that rest or ride, and what carries them, hold above their
    equilibrium [J] (B,), NaN for the others.
    """

    def __init__(self, problem: Problem, size: int) -> None:
        self.problem, self.oscillators = problem, oscillators_of(problem)
        self.first_of_plate = modes_of(problem.sphere)
        count, massless = len(self.oscillators.shape), len(self.oscillators.rate)
        self.displacement, self.velocity = np.zeros((size, count)), np.zeros((size, count))
        self.local = np.zeros((size, massless))
        self.lost = np.zeros((size, count + 1))
        self.lying: list[Lying | None] = [None] * size
        self.left = np.full(size, np.nan)

    def flights(self, drops: Drops, approach: Floats, speed: Floats, gravity: Floats) -> tuple[FreeMotion, ...]:
        """Return the free motions of drops: approach [m] and speed [m/s] are their centres', downwards."""
        return tuple(
            FreeMotion(self.oscillators, self.state(drop, *centre), float(down))
            for drop, down, *centre in zip(drops, gravity, approach, speed, strict=True)
        )

    def state(self, drop: int, approach: float, speed: float) -> State:
        """Return the state of a drop."""
        parts = (part[drop].copy() for part in (self.displacement, self.velocity, self.local))  # which go on changing
        return State(np.asarray(approach), np.asarray(speed), *parts)

    def touches(self, motions: tuple[FreeMotion, ...], law: CompliantLaw) -> Floats:
        """Return when free drops next touch [s since their start]; the law is theirs."""
        level = law.touch_level + np.zeros(len(motions))
        return np.array([next_touch(motion, float(at), np.inf) for motion, at in zip(motions, level, strict=True)])

    def pass_freely(self, drops: Drops, motions: tuple[FreeMotion, ...], elapsed: Floats) -> None:
        """Let the oscillators of drops move freely for some time [s]."""
        for drop, motion, time in zip(drops, motions, elapsed, strict=True):
            self.lost[drop] += motion.lost_by(time)
            self.place(drop, motion.state(time))

    def place(self, drop: int, state: State) -> None:
        """Note where the oscillators of a drop are."""
        self.displacement[drop], self.velocity[drop], self.local[drop] = state.displacement, state.velocity, state.local

    def closing_speed(self, drops: Drops, speed: Floats) -> Floats:
        """Return the speed at which the surfaces approach each other [m/s], where the centres come down at `speed`."""
        state = State(np.zeros(len(drops)), speed, self.displacement[drops], self.velocity[drops], self.local[drops])
        return self.oscillators.outer_rates(state)

    def visit(
        self,
        drops: Drops,
        approach: Floats,
        speed: Floats,
        encounter: Encounter,
        rest_speed: Floats,
        until: Floats,
        row: dict[str, Floats],
    ) -> list[Visit]:
        """Take drops through their visits; write what only vibrating bodies have into the row of the impact.

        Those that ride are followed for a time since first touch, `until` [s].
        """
        visits = []
        for number, drop in enumerate(drops):
            one = encounter.pick(np.array([number]))
            around = Surroundings(float(one.mass[0]), float(one.gravity[0]), self.oscillators)
            pace = 3.0 * float(one.depth[0] / one.speed_scale[0])
            start = self.state(drop, approach[number], speed[number])
            problem = self.problem
            limits = (float(rest_speed[number]), float(until[number]))
            found = visit(around, one.law.take(0), problem.quasi_static, start, problem.tolerance, pace, not problem.same_spot, *limits)
            before, after = (float(np.sum(self.oscillators.energies(state))) for state in (start, found.state))
            row["closing_speed_m_s"][drop], row["contacts"][drop] = one.approach_speed[0], found.contacts
            row["energy_to_vibration_J"][drop] = after - before + found.lost[:-1].sum()
            self.lost[drop, :-1] += found.lost[:-1]
            self.place(drop, found.state)
            if found.outcome in (CAPTURED, SETTLED, RIDING):
                assert found.local is not None  # it is in contact, or nearly so
                riding = Riding(around, found.local)
                self.left[drop] = riding.excess(found.state, found.stored)
                if found.outcome != RIDING:
                    self.lying[drop] = lying = lay_down(riding, found.state, found.stored)
                    self.left[drop] = lying.left
            visits.append(found)
        return visits

    def lies(self, drops: Drops) -> NDArray[np.bool_]:
        """Tell which drops have been laid down."""
        return np.array([self.lying[drop] is not None for drop in drops], dtype=bool)

    def laid(self, drops: Drops) -> dict[str, Floats]:
        """Return how drops lie: the indentation [m], what it holds, and what was written off [J]."""
        lying = [found for drop in drops if (found := self.lying[drop]) is not None]
        told = [(found.riding.sag, found.riding.stored, found.written_off) for found in lying]
        return dict(zip(("sag", "stored", "written_off"), np.array(told).reshape(-1, 3).T, strict=True))

    def follow(self, drop: int, elapsed: float) -> tuple[float, float, float]:
        """Let a drop lie for some time [s]; return its gap [m], its upward velocity [m/s] and what its contact holds then [J]."""
        lying, time = self.lying[drop], np.array([elapsed])
        assert lying is not None  # it has been laid down
        state = lying.state(time)
        self.lost[drop] += lying.lost_by(time)[0]
        self.place(drop, State(*(part[0] for part in vars(state).values())))
        return -float(state.approach[0]), -float(state.speed[0]), float(lying.stored(time)[0])

    def energies(self) -> dict[str, Floats]:
        """Return the entries of the ledger [J], (B,); what the local elements hold, and lost in flight, apart."""
        state = State(np.zeros(1), np.zeros(1), self.displacement, self.velocity, self.local)
        kinetic, strain = self.oscillators.energies(state)
        at = self.first_of_plate
        return {
            "sphere_vibration_J": kinetic[:, :at].sum(axis=1),
            "sphere_strain_J": strain[:, :at].sum(axis=1),
            "sphere_damping_J": self.lost[:, :at].sum(axis=1),
            "plate_kinetic_J": kinetic[:, at:].sum(axis=1),
            "plate_strain_J": strain[:, at:].sum(axis=1),
            "plate_damping_J": self.lost[:, at:-1].sum(axis=1),
            "local_J": self.oscillators.local_energy(state),
            "local_damping_J": self.lost[:, -1],
        }


def contact_of(visits: list[Visit], law: CompliantLaw) -> Contact:
    """Return visits of several drops as one contact of them all; `law` is theirs before it."""

    def gathered(name: str) -> Floats:
        return np.array([getattr(found, name) for found in visits], dtype=float)

    pieces = [
        Piece(np.array([drop]), np.array([part.start]), part.motion, law) for drop, found in enumerate(visits) for part in found.parts
    ]
    memories = {name: np.array([found.law.memories()[name] for found in visits], dtype=float) for name in law.memories()}
    return Contact(
        pieces,
        gathered("outcome").astype(np.int8),
        gathered("duration"),
        np.array([float(found.state.approach) for found in visits]),
        np.array([float(found.state.speed) for found in visits]),
        gathered("max_indentation"),
        gathered("time_of_max_indentation"),
        np.array([found.lost[-1] for found in visits]),
        gathered("plastic"),
        gathered("stored"),
        law.changed(memories),
    )
