r"""How a small change of the drop grows from impact to impact, where bodies vibrate.

A second drop, begun from a height or with a speed that differs by a small part, stays beside the first by a difference that obeys the
linearised equations of motion. It is carried along the history that was computed: in closed form through flights, by one linear solve
through each stretch of contact. Where the contact force jumps, as a dashpot meets the surface, the two drops meet the jump at different
times: if the second is later by :math:`\delta t`, the difference gains :math:`(f_- - f_+)\,\delta t`, with the rates f of the state
before and after (P. C. Mueller, Chaos, Solitons & Fractals 5:1671, 1995).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.contact.roots import locate_maximum
from vibroimpact.dynamics.lockstep import Course, asked, side_by_side
from vibroimpact.dynamics.problem import Problem
from vibroimpact.dynamics.vibrating.free_motion import Apart
from vibroimpact.dynamics.vibrating.linear_system import FreeMotion, LinearSystem, State
from vibroimpact.dynamics.vibrating.local import LocalContact
from vibroimpact.dynamics.vibrating.stretch import VibratingStretch
from vibroimpact.dynamics.vibrating.tangent import Beside

if TYPE_CHECKING:
    from vibroimpact.dynamics.leg import Leg

RELATIVE_CHANGE = 1e-9
"""A relative change of the drop that nobody can rule out: of 4 m, 4 nm."""

_STEP = 1e-6  # relative, of what a law knows of its contact: for differences
_JUMP = 1e-6  # of the force: less is no jump
_SLOW = 0.1  # of the speed at which the surfaces meet: what leaves more slowly counts as that


class Neighbours:
    """Second drops beside those of a run, carried along as it goes."""

    def __init__(self, problem: Problem, mass: Floats, system: LinearSystem) -> None:
        by_height = problem.speed is None
        changed = np.broadcast_to(np.asarray(problem.height if by_height else problem.speed, dtype=float), mass.shape)
        self._drops = [_Neighbour(system, value, by_height) for value in (np.sqrt(mass) * changed).tolist()]

    def follow(self, leg: Leg) -> Course[Floats]:
        r"""Return how a relative change of the drop has grown by the impact of a leg [-], one value a drop of its contact.

        The drop is changed in its height, or in its speed where that is given. The growth is the largest of the relative changes of the
        speed at which the surfaces meet, of the largest force, and of the speed of separation (as a part of at least a tenth of the
        former). Of a rigid drop it would be 0.6 from a height, as Hertz's force goes with its power 0.6.

        Parameters
        ----------
        leg : Leg
            The next flight and contact of the drops; something in them vibrates.
        """
        for drop, flight, length in zip(leg.drops, leg.motions, leg.flight_end - leg.flight.start, strict=True):
            self._drops[drop].fly(flight, float(length))
        if leg.contact is None:
            return np.zeros(0)
        motions: dict[int, list[VibratingStretch | Apart]] = {drop: [] for drop in leg.contact_drops.tolist()}
        for piece in leg.contact.pieces:
            assert isinstance(piece.motion, (VibratingStretch, Apart))  # of bodies that vibrate
            motions[int(leg.contact_drops[piece.drops[0]])].append(piece.motion)
        yield from side_by_side(self._drops[drop].go_through(parts) for drop, parts in motions.items())
        ends = zip(leg.contact_drops, leg.contact.final_rate, strict=True)
        return np.array([self._drops[drop].leave(-float(speed)) for drop, speed in ends])


def change_by_impact(impacts: Mapping[str, Floats], tolerance: float) -> Floats:
    """Return the relative change of each impact for one of 1e-9 in the drop [-]; 0 where nothing vibrates.

    Each contact is integrated to a tolerance, which grows likewise: where it is larger, it counts instead.

    Examples
    --------
    >>> change_by_impact({"impact": np.ones(1), "sensitivity": np.array([1e6])}, 1e-9).round(6).tolist()
    [0.001]
    """
    return impacts.get("sensitivity", np.zeros(len(impacts["impact"]))) * max(RELATIVE_CHANGE, tolerance)


@dataclass
class _Visit:
    """A visit so far.

    `speed`, `closing`: speed at which the surfaces met, and its difference [m/s]. `force`: the largest at a node [N]. `strongest`: the
    stretch where it is, and the difference of the force at the nodes [N].
    """

    speed: float
    closing: float
    force: float = 0.0
    strongest: tuple[VibratingStretch, Floats] | None = None


class _Neighbour:
    """The difference of a second drop from the first, per unit relative change of the drop.

    The equations of motion do not depend on time itself, so that the two need not be compared at equal times: whenever a contact
    begins or ends, the second drop is compared when it begins or ends for that one.
    """

    def __init__(self, of: LinearSystem, value: float, by_height: bool) -> None:
        self.difference = State(np.zeros(of.number), np.zeros(of.number), np.zeros(len(of.rate)))
        if by_height:
            self.difference.displacement[0] = -value  # height is up, approach is down
        else:
            self.difference.velocity[0] = value
        self.apart = True
        self.last: VibratingStretch | None = None  # which the drops have just left
        self.pressed = 0.0  # difference of the force at its end
        self.local: LocalContact | None = None  # the last contact as the first drop felt it
        self.knowledge: dict[str, float] = {}  # differences of what the law knows: the speed of first touch, and what it remembers
        self.visit: _Visit | None = None

    def fly(self, motion: FreeMotion, length: float, inside: bool = False) -> None:
        """Go through free motion, `inside` the indentation or apart."""
        if not inside:
            self.part()
        of, before = motion.system, self.difference
        cosine, sine = of.transition(np.array(length)).swapaxes(0, 1)
        place, speed = cosine * before.displacement + sine * before.velocity
        self.difference = State(place, speed, before.local * np.exp(-of.rate * length))
        self.apart, self.last = not inside, None

    def go_through(self, motions: Sequence[VibratingStretch | Apart]) -> Course[None]:
        """Go through the parts of a visit."""
        for motion in motions:
            if isinstance(motion, Apart):
                self.fly(motion.free, motion.length, inside=motion.local is not None)
            else:
                yield from self.pass_through(motion)

    def pass_through(self, stretch: VibratingStretch) -> Course[None]:
        """Go through a stretch of contact."""
        if self.apart:
            self.touch(stretch)
        elif stretch.contacts[0].local is not self.local:
            self.turn(stretch)
        beside = Beside(stretch, self.difference, _asides(stretch.contacts[0].local, self.knowledge))
        self.difference, pressed = yield from asked(beside)
        self.pressed, self.last = float(pressed[-1]), stretch
        assert self.visit is not None  # it has touched
        force = float(stretch.force.max())
        if force > self.visit.force:
            self.visit.force, self.visit.strongest = force, (stretch, pressed)

    def leave(self, speed: float) -> float:
        """Leave at a speed upwards; return how the change has grown in the visit."""
        self.part()
        visit, self.visit = self.visit, None
        if visit is None or visit.strongest is None:
            return float("nan")
        stretch, pressed = visit.strongest
        (contact,) = stretch.contacts
        top = np.array([locate_maximum(contact.force_at)])
        stronger = float(stretch.rule.interpolate(top, pressed)[0]) / float(contact.force_at(top)[0])
        slower = float(stretch.system.rigid_motion(self.difference)[1][0]) / max(abs(speed), _SLOW * visit.speed)
        return max(abs(visit.closing) / visit.speed, abs(stronger), abs(slower))

    def touch(self, stretch: VibratingStretch) -> None:
        """Meet the surface with the stretch that begins there."""
        of, start, local = stretch.system, stretch.start, stretch.contacts[0].local
        same_surface = self.local is not None and self.local.law.memories() == local.law.memories()
        self.knowledge = {name: self.knowledge.get(name, 0.0) if same_surface else 0.0 for name in local.law.memories()}
        level = sum(times * (aside.touch_level - local.touch_level) for aside, times in _asides(local, self.knowledge))
        rate = float(of.rates(start)[0])
        later = (level - float(of.approach(self.difference)[0])) / rate
        self.difference = _later(self.difference, _rates(of, start, 0.0, 0.0), later)
        closing = float((of.outer_rates if of.outer_rates(start)[0] >= rate else of.rates)(self.difference)[0])
        self.knowledge["approach_speed"] = closing
        self.local, self.apart = local, False
        self.visit = self.visit or _Visit(local.approach_speed, closing)

    def part(self) -> None:
        """Compare the drops when their surfaces part, if they do."""
        if self.last is not None:
            excess = float(self.last.system.approach(self.difference)[0])
            self.synchronise(self.last, excess, float(self.last.closing()[-1]))
        self.last = None

    def turn(self, stretch: VibratingStretch) -> None:
        """Let the law remember how deep the contact has been: the second drop deeper by the difference of the approach."""
        assert self.local is not None  # it is in contact
        assert self.last is not None
        of, local, after = stretch.system, self.local, stretch.contacts[0].local
        deepest = max(float(of.approach(stretch.start)[0]), local.release_level)
        if self.force_jumps(stretch):
            x = np.array([1.0 - _STEP, 1.0])
            closing, time = self.last.rule.weights(x).T @ self.last.closing(), self.last.length * self.last.rule.map_time(x)
            faster = float(of.rates(self.difference)[0]) - of.mobility.sum() * self.pressed
            self.synchronise(self.last, faster, float((closing[1] - closing[0]) / (time[1] - time[0])))
        now = after.law.memories()
        step = _STEP * deepest
        found = dict.fromkeys(now, 0.0)
        beside = [(local.after_compression(deepest + step), float(of.approach(self.difference)[0]) / step)]
        beside += [(aside.after_compression(deepest), times) for aside, times in _asides(local, self.knowledge)]
        for aside, times in beside:
            for name, value in aside.law.memories().items():
                found[name] += times * float(value - now[name])
        self.knowledge.update(found)
        self.local = after

    def force_jumps(self, stretch: VibratingStretch) -> bool:
        """Does the force jump where a stretch follows the last one?"""
        assert self.last is not None
        (contact,) = stretch.contacts
        before, after = float(self.last.force[0, -1]), np.add(*contact.local.own_forces(contact.delta[:1], contact.rate[:1]))
        return bool(abs(float(after[0]) - before) > _JUMP * abs(before))

    def synchronise(self, stretch: VibratingStretch, excess: float, rate: float) -> None:
        """Compare the drops at the end of a stretch, where what ends it exceeds by `excess` in the second drop and grows at a rate."""
        (contact,) = stretch.contacts
        rates = _rates(stretch.system, stretch.end, float(contact.force[-1]), float(contact.static[-1]))
        self.difference = _later(self.difference, rates, -excess / rate)


def _rates(of: LinearSystem, state: State, force: float, static: float) -> State:
    """Return how a state changes under a contact force, and its static part [N]."""
    pushed = of.outer[0] * force + (of.shape[0] - of.outer[0]) * static
    return State(
        state.velocity,
        of.load - of.damping * state.velocity - of.angular_frequency**2 * state.displacement - pushed,
        -of.rate * state.local - of.mobility * force,
    )


def _later(difference: State, rates: State, time: float) -> State:
    """Return the difference if the second drop is looked at later by a time, per unit relative change."""
    return State(*(one + time * rate for one, rate in zip(vars(difference).values(), vars(rates).values(), strict=True)))


def _asides(local: LocalContact, knowledge: dict[str, float]) -> list[tuple[LocalContact, float]]:
    """Return contacts whose law knows something a little differently, each with how many times its change there is."""
    found = []
    for name, change in knowledge.items():
        if change == 0.0:
            continue
        if name == "approach_speed":
            step = _STEP * local.approach_speed
            found.append((replace(local, approach_speed=local.approach_speed + step), change / step))
        else:
            value = local.law.memories()[name]
            step = _STEP * (abs(float(value)) or 1e-6)
            found.append((replace(local, law=local.law.changed({name: value + step})), change / step))
    return found
