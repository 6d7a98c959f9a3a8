r"""Growth of a small change of the drop from impact to impact, where bodies vibrate.

The difference of a neighbouring drop, from a slightly different height or speed, obeys the
linearised equations of motion. It is propagated along the computed history: in closed form through
flights, by one linear solve through each stretch of contact. Where the contact force jumps, as when
a dashpot meets the surface, the two drops meet the jump at different times: if the second is later
by :math:`\delta t`, the difference gains :math:`(f_- - f_+)\,\delta t`, with the rates f of the
state before and after (P. C. Mueller, Chaos, Solitons & Fractals 5:1671, 1995).
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.core.contact_records import RECOIL, STRETCH
from vibroimpact.dynamics.core.drop_records import RELEASE_VELOCITY, TOUCH
from vibroimpact.dynamics.core.peak import nodal_value_between
from vibroimpact.dynamics.statement.problem import Problem
from vibroimpact.dynamics.vibrating.contact_view import contact_view
from vibroimpact.dynamics.vibrating.linear_system import FreeMotion, LinearSystem, State
from vibroimpact.dynamics.vibrating.local import LocalContact
from vibroimpact.dynamics.vibrating.recorded_drop import RecordedDrop
from vibroimpact.dynamics.vibrating.recorded_motion import RecordedMotion
from vibroimpact.dynamics.vibrating.stretch import VibratingStretch
from vibroimpact.dynamics.vibrating.stretch_tangent import propagate_difference

# relative step of a law's closing speed, memory and largest indentation, for finite differences
_STEP = 1e-6
_JUMP = 1e-6  # of the force: a smaller change is no jump
_SLOW = 0.1  # of the closing speed: lower bound of the separation speed in a relative change


def growth_of(problem: Problem, drop: RecordedDrop) -> Floats:
    """Return the growth of a relative change of a drop by each of its impacts [-].

    The drop is changed in its height, or in its speed where that is given. The growth is the
    largest of the relative changes of the closing speed, of the largest force, and of the
    separation speed (relative to at least a tenth of the closing speed). For a rigid drop from a
    height it would be 0.6, as Hertz's force goes with the power 0.6 of the height.

    Parameters
    ----------
    problem : Problem
        Of one drop, of which a body vibrates.
    drop : RecordedDrop
        Its flights and impacts.
    """
    recorded = drop.recorded
    is_by_height = problem.speed is None
    height_or_speed = problem.height if is_by_height else problem.speed
    assert height_or_speed is not None
    change = float(np.sqrt(problem.sphere.mass) * height_or_speed)  # of the sphere's coordinate
    neighbour = _Neighbour(recorded.system, change, is_by_height)
    growth = np.empty(len(drop.rows))
    for number, row in enumerate(drop.rows):
        flight, motion = drop.flight(number)
        neighbour.fly(motion, float(row[TOUCH] - flight.start[0]))
        neighbour.pass_impact(recorded, recorded.parts_of(number))
        growth[number] = neighbour.leave(float(row[RELEASE_VELOCITY]))
    return growth


@dataclass
class _ImpactDifferences:
    """Differences recorded during an impact.

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

    def __init__(self, system: LinearSystem, change: float, by_height: bool) -> None:
        self.difference = State(
            np.zeros(system.number), np.zeros(system.number), np.zeros(len(system.rate))
        )
        if by_height:
            # height is measured upwards, the coordinate of the approach downwards
            self.difference.displacement[0] = -change
        else:
            self.difference.velocity[0] = change
        self.separated = True
        # the preceding stretch, if the drops come from one
        self.last_stretch: VibratingStretch | None = None
        self.force_difference = 0.0  # difference of the force at its end
        self.local: LocalContact | None = None  # the last contact of the reference drop
        # differences of the law's closing speed and memory
        self.law_differences: dict[str, float] = {}
        self.impact: _ImpactDifferences | None = None

    def fly(self, motion: FreeMotion, duration: float, inside: bool = False) -> None:
        """Propagate through free motion, in recoil (`inside`) or between contacts."""
        if not inside:
            self.separate()
        free = contact_view(motion.system, (0,)).without_load.system
        self.difference = FreeMotion(free, self.difference).state_after(duration)
        self.separated = not inside
        self.last_stretch = None

    def pass_impact(self, recorded: RecordedMotion, numbers: range) -> None:
        """Propagate through the parts of an impact."""
        for first, end in recorded.phases(numbers):
            kind = int(recorded.parts.kind[first])
            if kind == STRETCH:
                self.pass_through(recorded, first, end)
            else:
                free = recorded.free(first)
                self.fly(free.free, free.length, inside=kind == RECOIL)

    def pass_through(self, recorded: RecordedMotion, first: int, end: int) -> None:
        """Propagate through stretches of contact under one law, from the first one to an end."""
        local = recorded.local(int(recorded.parts.law[first]))
        if self.separated:
            self.begin_contact(recorded.stretch(first))
        elif local is not self.local:
            self.update_memory(recorded.stretch(first))
        variations = _law_variations(local, self.law_differences)
        self.difference, force_differences = propagate_difference(
            recorded, (first, end), self.difference, variations
        )
        self.force_difference = float(force_differences[-1, -1])
        self.last_stretch = recorded.stretch(end - 1)
        assert self.impact is not None  # it has touched
        forces = recorded.parts.force[first:end].max(axis=1)
        strongest = int(forces.argmax())
        if forces[strongest] > self.impact.force:
            self.impact.force = float(forces[strongest])
            self.impact.strongest = (
                recorded.stretch(first + strongest),
                force_differences[strongest],
            )

    def leave(self, speed: float) -> float:
        """End an impact with a speed upwards [m/s]; return the growth of the change."""
        self.separate()
        impact = self.impact
        self.impact = None
        if impact is None or impact.strongest is None:
            return float("nan")
        stretch, force_difference = impact.strongest
        x_of_peak, peak_force = stretch.peak_force()
        closing_change = impact.closing / impact.speed
        force_change = (
            nodal_value_between(stretch.basis.basis, force_difference, x_of_peak) / peak_force
        )
        _, rigid_rate = stretch.system.rigid_motion(self.difference)
        separation_change = float(rigid_rate[0]) / max(abs(speed), _SLOW * impact.speed)
        return max(abs(closing_change), abs(force_change), abs(separation_change))

    def begin_contact(self, stretch: VibratingStretch) -> None:
        """Shift the difference to the touch of each drop, and take those of the law.

        These are of the law's closing speed and memory.
        """
        system = stretch.system
        start = stretch.start
        local = stretch.contacts[0].local
        memories = local.law.memories()
        same_surface = self.local is not None and self.local.law.memories() == memories
        self.law_differences = {
            name: self.law_differences.get(name, 0.0) if same_surface else 0.0 for name in memories
        }
        # the level at which the surfaces touch depends on the memory
        level_difference = sum(
            weight * (varied.law.touch_level - local.law.touch_level)
            for varied, weight in _law_variations(local, self.law_differences)
        )
        rate = float(system.rates(start)[0])
        delay = (level_difference - float(system.approach(self.difference)[0])) / rate
        self.difference = _shifted(self.difference, _state_rates(system, start, 0.0, 0.0), delay)
        # as in the closing speed of the drop itself
        outer = system.outer_rates(start)[0] >= rate
        closing_rates = system.outer_rates if outer else system.rates
        closing = float(closing_rates(self.difference)[0])
        self.law_differences["approach_speed"] = closing
        self.local = local
        self.separated = False
        self.impact = self.impact or _ImpactDifferences(local.approach_speed, closing)

    def separate(self) -> None:
        """Shift the difference to the separation of each drop, if they come from a stretch."""
        if self.last_stretch is not None:
            excess = float(self.last_stretch.system.approach(self.difference)[0])
            closing_rate = float(self.last_stretch.contacts[0].closing[-1])
            self.shift_to_event(self.last_stretch, excess, closing_rate)
        self.last_stretch = None

    def update_memory(self, stretch: VibratingStretch) -> None:
        """Update the differences of the law's memory at a turn.

        The largest indentation differs by the difference of the approach.
        """
        assert self.local is not None  # it is in contact
        local = self.local
        next_local = stretch.contacts[0].local
        deepest = max(float(stretch.system.approach(stretch.start)[0]), local.release_level)
        if self.force_jumps(stretch):
            self.shift_to_turn()
        # finite differences of the memory, by the largest indentation and the law before
        step = _STEP * deepest
        approach_difference = float(stretch.system.approach(self.difference)[0])
        variations = [(local.after_compression(deepest + step), approach_difference / step)]
        for varied, weight in _law_variations(local, self.law_differences):
            variations.append((varied.after_compression(deepest), weight))
        memories = next_local.law.memories()
        differences = dict.fromkeys(memories, 0.0)
        for varied, weight in variations:
            for name, memory in varied.law.memories().items():
                differences[name] += weight * float(memory - memories[name])
        self.law_differences.update(differences)
        self.local = next_local

    def shift_to_turn(self) -> None:
        """Shift the difference at the end of the last stretch to the turn of each drop."""
        last = self.last_stretch
        assert last is not None
        system = last.system
        # the approach turns where its rate is zero; its second derivative is a finite difference
        x = np.array([1.0 - _STEP, 1.0])
        closing = last.rule.weights(x).T @ last.contacts[0].closing
        time = last.length * last.rule.map_time(x)
        acceleration = float((closing[1] - closing[0]) / (time[1] - time[0]))
        rate_difference = (
            float(system.rates(self.difference)[0]) - system.mobility.sum() * self.force_difference
        )
        self.shift_to_event(last, rate_difference, acceleration)

    def force_jumps(self, stretch: VibratingStretch) -> bool:
        """Whether the force jumps between the last stretch and the next one."""
        assert self.last_stretch is not None
        (contact,) = stretch.contacts
        elastic, dissipative = contact.local.forces_at_indentation(
            contact.delta[:1], contact.rate[:1]
        )
        before = float(self.last_stretch.force[0, -1])
        after = float((elastic + dissipative)[0])
        return bool(abs(after - before) > _JUMP * abs(before))

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


def _state_rates(system: LinearSystem, state: State, force: float, static: float) -> State:
    """Return the time derivative of a state under a contact force and its static part [N]."""
    # the static part acts on the coordinates inside the contact
    inner_shape = system.shape[0] - system.outer_shape[0]
    generalised_force = system.outer_shape[0] * force + inner_shape * static
    accelerations = (
        system.load
        - system.damping * state.velocity
        - system.angular_frequency**2 * state.displacement
        - generalised_force
    )
    return State(
        state.velocity, accelerations, -system.rate * state.local - system.mobility * force
    )


def _shifted(difference: State, rates: State, delay: float) -> State:
    """Return the difference if the neighbouring drop is taken later by a time.

    `delay`: that time per unit relative change [s].
    """
    return State(
        difference.displacement + delay * rates.displacement,
        difference.velocity + delay * rates.velocity,
        difference.local + delay * rates.local,
    )


def _law_variations(
    local: LocalContact, law_differences: dict[str, float]
) -> list[tuple[LocalContact, float]]:
    """Return contacts with the law's closing speed or a memory varied by a small step.

    Each comes with the factor of that variation.
    """
    variations = []
    for name, difference in law_differences.items():
        if difference == 0.0:
            continue
        if name == "approach_speed":
            step = _STEP * local.approach_speed
            varied = replace(local, approach_speed=local.approach_speed + step)
        else:
            memory = local.law.memories()[name]
            step = _STEP * (abs(float(memory)) or 1e-6)
            varied = replace(local, law=local.law.changed({name: memory + step}))
        variations.append((varied, difference / step))
    return variations
