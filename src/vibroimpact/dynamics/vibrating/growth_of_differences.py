r"""Growth of a small change of the drop from impact to impact, where bodies vibrate.

The difference of a neighbouring drop, from a slightly different height or speed, obeys the
linearised equations of motion. It is propagated along the computed history: in closed form through
flights, by one linear solve through each stretch of contact. Where the contact force jumps, as when
a dashpot meets the surface, the two drops meet the jump at different times: if the second is later
by
:math:`\delta t`, the difference gains :math:`(f_- - f_+)\,\delta t`, with the rates f of the state
before and after (P. C. Mueller,
Chaos, Solitons & Fractals 5:1671, 1995).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import groupby
from typing import TYPE_CHECKING

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.core.peak import nodal_value_between
from vibroimpact.dynamics.problem import Problem
from vibroimpact.dynamics.vibrating.contact_view import contact_view
from vibroimpact.dynamics.vibrating.free_motion import FreePhase
from vibroimpact.dynamics.vibrating.linear_system import FreeMotion, LinearSystem, State
from vibroimpact.dynamics.vibrating.local import LocalContact
from vibroimpact.dynamics.vibrating.stretch import VibratingStretch
from vibroimpact.dynamics.vibrating.stretch_tangent import propagate_difference

if TYPE_CHECKING:
    from vibroimpact.dynamics.bounce import Bounce

# relative step of a law's closing speed, memory and largest indentation, for finite differences
_STEP = 1e-6
_JUMP = 1e-6  # of the force: a smaller change is no jump
_SLOW = 0.1  # of the closing speed: lower bound of the separation speed in a relative change


class SharedStatics:
    """Neighbouring drops of a run, one of each, propagated along with it."""

    def __init__(self, problem: Problem, mass: Floats, system: LinearSystem) -> None:
        by_height = problem.speed is None
        changed = np.broadcast_to(
            np.asarray(problem.height if by_height else problem.speed, dtype=float), mass.shape
        )
        self._drops = [
            _Neighbour(system, value, by_height) for value in (np.sqrt(mass) * changed).tolist()
        ]

    def follow(self, bounce: Bounce) -> Floats:
        """Return the growth of a relative change of the drop by the impact of a bounce [-], one
        value per drop of its contact.

        The drop is changed in its height, or in its speed where that is given. The growth is the
        largest of the relative changes of the closing speed, of the largest force, and of the
        separation speed (relative to at least a tenth of the closing speed). For a rigid drop from
        a height it would be 0.6, as Hertz's force goes with the power 0.6 of the height.

        Parameters
        ----------
        bounce : Bounce
            The next flight and contact of the drops, of which a body vibrates.
        """
        for drop, motion, length in zip(
            bounce.drops, bounce.motions, bounce.flight_end - bounce.flight.start, strict=True
        ):
            self._drops[drop].fly(motion, float(length))
        if bounce.contact is None:
            return np.zeros(0)
        motions: dict[int, list[VibratingStretch | FreePhase]] = {
            drop: [] for drop in bounce.contact_drops.tolist()
        }
        for piece in bounce.contact.pieces:
            assert isinstance(piece.motion, (VibratingStretch, FreePhase))  # of bodies that vibrate
            motions[int(bounce.contact_drops[piece.drops[0]])].append(piece.motion)
        for drop, parts in motions.items():
            self._drops[drop].pass_visit(parts)
        ends = zip(bounce.contact_drops, bounce.contact.final_rate, strict=True)
        return np.array([self._drops[drop].leave(-float(speed)) for drop, speed in ends])


@dataclass
class _ImpactDifferences:
    """Differences recorded during a visit.

    `speed`, `closing`: closing speed, and its difference [m/s]. `force`: largest force at a node
    [N]. `strongest`: the stretch with that force, and the difference of the force at its nodes [N].
    """

    speed: float
    closing: float
    force: float = 0.0
    strongest: tuple[VibratingStretch, Floats] | None = None


class _Neighbour:
    """Difference of a neighbouring drop, per unit relative change of the drop.

    The equations of motion are autonomous, so the drops need not be compared at equal times:
    whenever a contact begins or ends, each drop is taken at its own time of that event.
    """

    def __init__(self, system: LinearSystem, value: float, by_height: bool) -> None:
        self.difference = State(
            np.zeros(system.number), np.zeros(system.number), np.zeros(len(system.rate))
        )
        if by_height:
            # height is measured upwards, the coordinate of the approach downwards
            self.difference.displacement[0] = -value
        else:
            self.difference.velocity[0] = value
        self.separated = True
        # the preceding stretch, if the drops come from one
        self.last_stretch: VibratingStretch | None = None
        self.force_difference = 0.0  # difference of the force at its end
        self.local: LocalContact | None = None  # the last contact of the reference drop
        # differences of the law's closing speed and memory
        self.law_differences: dict[str, float] = {}
        self.visit: _ImpactDifferences | None = None

    def fly(self, motion: FreeMotion, length: float, inside: bool = False) -> None:
        """Propagate through free motion, in recoil (`inside`) or between contacts."""
        if not inside:
            self.separate()
        free = contact_view(motion.system, (0,)).without_load.system
        self.difference = FreeMotion(free, self.difference).state_after(length)
        self.separated, self.last_stretch = not inside, None

    def pass_visit(self, motions: Sequence[VibratingStretch | FreePhase]) -> None:
        """Propagate through the parts of a visit."""
        for _, parts in groupby(motions, _contact_of):
            stretches = []
            for motion in parts:  # all of them stretches under one law, or all of them free
                if isinstance(motion, FreePhase):
                    self.fly(motion.free, motion.length, inside=motion.local is not None)
                else:
                    stretches.append(motion)
            if stretches:
                self.pass_through(stretches)

    def pass_through(self, stretches: Sequence[VibratingStretch]) -> None:
        """Propagate through stretches of contact under one law."""
        first, local = stretches[0], stretches[0].contacts[0].local
        if self.separated:
            self.begin_contact(first)
        elif local is not self.local:
            self.update_memory(first)
        variations = _law_variations(local, self.law_differences)
        self.difference, force_differences = propagate_difference(
            stretches, self.difference, variations
        )
        self.force_difference, self.last_stretch = float(force_differences[-1, -1]), stretches[-1]
        assert self.visit is not None  # it has touched
        for stretch, force_difference in zip(stretches, force_differences, strict=True):
            force = float(stretch.contacts[0].force.max())
            if force > self.visit.force:
                self.visit.force, self.visit.strongest = force, (stretch, force_difference)

    def leave(self, speed: float) -> float:
        """End a visit with a speed upwards [m/s]; return the growth of the change."""
        self.separate()
        visit, self.visit = self.visit, None
        if visit is None or visit.strongest is None:
            return float("nan")
        stretch, force_difference = visit.strongest
        top, force = stretch.peak_force()
        force_change = nodal_value_between(stretch.basis.basis, force_difference, top) / force
        speed_change = float(stretch.system.rigid_motion(self.difference)[1][0]) / max(
            abs(speed), _SLOW * visit.speed
        )
        return max(abs(visit.closing) / visit.speed, abs(force_change), abs(speed_change))

    def begin_contact(self, stretch: VibratingStretch) -> None:
        """Shift the difference to the touch of each drop, and take the differences of the
        law's closing speed and memory.
        """
        system, start, local = stretch.system, stretch.start, stretch.contacts[0].local
        same_surface = self.local is not None and self.local.law.memories() == local.law.memories()
        self.law_differences = {
            name: self.law_differences.get(name, 0.0) if same_surface else 0.0
            for name in local.law.memories()
        }
        laws = [
            (varied.law, weight) for varied, weight in _law_variations(local, self.law_differences)
        ]
        level = sum(weight * (law.touch_level - local.law.touch_level) for law, weight in laws)
        rate = float(system.rates(start)[0])
        later = (level - float(system.approach(self.difference)[0])) / rate
        self.difference = _shifted(self.difference, _state_rates(system, start, 0.0, 0.0), later)
        closing = float(
            (system.outer_rates if system.outer_rates(start)[0] >= rate else system.rates)(
                self.difference
            )[0]
        )
        self.law_differences["approach_speed"] = closing
        self.local, self.separated = local, False
        self.visit = self.visit or _ImpactDifferences(local.approach_speed, closing)

    def separate(self) -> None:
        """Shift the difference to the separation of each drop, if they come from a stretch."""
        if self.last_stretch is not None:
            excess = float(self.last_stretch.system.approach(self.difference)[0])
            self.shift_to_event(
                self.last_stretch, excess, float(self.last_stretch.contacts[0].closing[-1])
            )
        self.last_stretch = None

    def update_memory(self, stretch: VibratingStretch) -> None:
        """Update the differences of the law's memory at a turn: the largest indentation
        differs by the difference of the approach.
        """
        assert self.local is not None  # it is in contact
        assert self.last_stretch is not None
        system, local, after = stretch.system, self.local, stretch.contacts[0].local
        deepest = max(float(system.approach(stretch.start)[0]), local.release_level)
        if self.force_jumps(stretch):
            x = np.array([1.0 - _STEP, 1.0])
            closing, time = (
                self.last_stretch.rule.weights(x).T @ self.last_stretch.contacts[0].closing,
                self.last_stretch.length * self.last_stretch.rule.map_time(x),
            )
            excess = (
                float(system.rates(self.difference)[0])
                - system.mobility.sum() * self.force_difference
            )
            self.shift_to_event(
                self.last_stretch, excess, float((closing[1] - closing[0]) / (time[1] - time[0]))
            )
        now = after.law.memories()
        step = _STEP * deepest
        found = dict.fromkeys(now, 0.0)
        variations = [
            (
                local.after_compression(deepest + step),
                float(system.approach(self.difference)[0]) / step,
            )
        ]
        variations += [
            (varied.after_compression(deepest), weight)
            for varied, weight in _law_variations(local, self.law_differences)
        ]
        for varied, weight in variations:
            for name, value in varied.law.memories().items():
                found[name] += weight * float(value - now[name])
        self.law_differences.update(found)
        self.local = after

    def force_jumps(self, stretch: VibratingStretch) -> bool:
        """Whether the force jumps between the last stretch and the next one."""
        assert self.last_stretch is not None
        (contact,) = stretch.contacts
        before, after = (
            float(self.last_stretch.force[0, -1]),
            np.add(*contact.local.forces_at_indentation(contact.delta[:1], contact.rate[:1])),
        )
        return bool(abs(float(after[0]) - before) > _JUMP * abs(before))

    def shift_to_event(self, stretch: VibratingStretch, excess: float, rate: float) -> None:
        """Shift the difference at the end of a stretch to the event of each drop.

        The event function of the neighbouring drop exceeds that of the reference drop by `excess`,
        and grows at a rate.
        """
        (contact,) = stretch.contacts
        rates = _state_rates(
            stretch.system, stretch.end, float(contact.force[-1]), float(contact.static[-1])
        )
        self.difference = _shifted(self.difference, rates, -excess / rate)


def _contact_of(motion: VibratingStretch | FreePhase) -> int:
    """Return a number of the contact of a stretch, which stays the same until its law's
    memory changes; 0 for free motion.
    """
    return id(motion.contacts[0].local) if isinstance(motion, VibratingStretch) else 0


def _state_rates(system: LinearSystem, state: State, force: float, static: float) -> State:
    """Return the time derivative of a state under a contact force and its static part [N]."""
    pushed = system.outer_shape[0] * force + (system.shape[0] - system.outer_shape[0]) * static
    return State(
        state.velocity,
        system.load
        - system.damping * state.velocity
        - system.angular_frequency**2 * state.displacement
        - pushed,
        -system.rate * state.local - system.mobility * force,
    )


def _shifted(difference: State, rates: State, time: float) -> State:
    """Return the difference if the neighbouring drop is taken later by a time, per unit
    relative change.
    """
    return State(
        *(
            one + time * rate
            for one, rate in zip(vars(difference).values(), vars(rates).values(), strict=True)
        )
    )


def _law_variations(
    local: LocalContact, law_differences: dict[str, float]
) -> list[tuple[LocalContact, float]]:
    """Return contacts with the law's closing speed or a memory varied by a small step,
    each with the factor of that variation.
    """
    found = []
    for name, change in law_differences.items():
        if change == 0.0:
            continue
        if name == "approach_speed":
            step = _STEP * local.approach_speed
            found.append(
                (replace(local, approach_speed=local.approach_speed + step), change / step)
            )
        else:
            value = local.law.memories()[name]
            step = _STEP * (abs(float(value)) or 1e-6)
            found.append(
                (replace(local, law=local.law.changed({name: value + step})), change / step)
            )
    return found
