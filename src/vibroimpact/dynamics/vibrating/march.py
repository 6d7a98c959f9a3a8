"""A system through its contacts: flights in closed form, stretches of contact, and the events that end them.

While no contact pushes, all motion is known in closed form and the march goes to the next touch. Else it goes by stretches whose length
adapts to what the bodies do. In each the first event is sought: surfaces part, the force of a law that may not pull becomes zero, a
breakpoint of a law is crossed, an approach turns; or other surfaces touch meanwhile. The stretch is solved again so that it ends there.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.contact.law import CompliantLaw
from vibroimpact.contact.roots import find_root
from vibroimpact.contact.static import undamped_depth
from vibroimpact.dynamics.collocation import Map
from vibroimpact.dynamics.lockstep import Course, asked
from vibroimpact.dynamics.vibrating.ending import before_event, broken, end_at, growth
from vibroimpact.dynamics.vibrating.events import GRID, STILL, Event, first_event
from vibroimpact.dynamics.vibrating.free_motion import Apart, given_up
from vibroimpact.dynamics.vibrating.linear_system import FreeMotion, LinearSystem, State
from vibroimpact.dynamics.vibrating.local import LocalContact
from vibroimpact.dynamics.vibrating.next_touch import next_touch, time_to_part
from vibroimpact.dynamics.vibrating.receptance import seen_by
from vibroimpact.dynamics.vibrating.recoil import after, end_of_recoil, recoil_of
from vibroimpact.dynamics.vibrating.solve_stretch import StretchProblem
from vibroimpact.dynamics.vibrating.stretch import VibratingStretch
from vibroimpact.dynamics.vibrating.touching import Impact, Law, Touching, closing_speed, motion_speed, note_peaks
from vibroimpact.errors import ComputationError

_FIRST = 0.125  # of the span of a contact: the first stretch
_SLACK = 1e-12  # of the deepest indentation: by less surfaces have not touched while other contacts push
_MOST_STRETCHES = 200_000
_POLISHES = 8
_ROUNDING = 1e-14  # of the deepest indentation
_NO_FORCE = 1e-10  # of the largest force


class NotIntegrable(ComputationError):
    """A contact can't be integrated to the tolerance."""


@dataclass(frozen=True)
class Part:
    """A part of a march: when it begins [s], and its motion."""

    start: float
    motion: VibratingStretch | Apart


class March:
    """A system on its way through contacts.

    `time` [s], `state`: where it is. `touching`: the contacts whose surfaces overlap, by number. `known`: the laws of the next contacts,
    with what they remember. `dents`: the laws of the last, where the next one does not find its dent again and surfaces may still be in
    it. `parts`: its history. `impacts`: what came of each contact. `lost` [J], (n + 1,): in each coordinate, and in the contacts;
    `plastic` [J].

    Parameters
    ----------
    system : LinearSystem
        What moves.
    laws : sequence of Law
        Of its contacts.
    state : State
        At the start.
    tolerance : float
        Relative error allowed at the end of each stretch.
    scale : tuple of two floats, optional
        Speed of the motion [m/s], and about how long a contact lasts [s]; else each contact has its own.
    """

    def __init__(
        self, system: LinearSystem, laws: Sequence[Law], state: State, tolerance: float, scale: tuple[float, float] | None = None
    ) -> None:
        self.system, self.laws, self.state, self.tolerance, self.scale = system, laws, state, tolerance, scale
        self.known = [law.law for law in laws]
        self.time, self.pace = 0.0, np.inf
        self.touching: dict[int, Touching] = {}
        self.dents: dict[int, CompliantLaw] = {}
        self.parts: list[Part] = []
        self.impacts: list[Impact] = []
        self.lost, self.plastic = np.zeros(system.number + 1), 0.0

    def course(self, end: float, progress: Callable[[float], None] | None = None) -> Course[None]:
        """Go on until a time [s]; a contact under way then is cut short.

        Raises
        ------
        ComputationError
            If a contact can not be integrated to the tolerance, or contacts follow each other without end.
        """
        stretches = 0
        while self.time < end:
            stretches += 1
            if stretches > _MOST_STRETCHES:
                raise ComputationError(
                    f"after {_MOST_STRETCHES} stretches of contact the system is at {self.time:g} s: contacts follow each other ever "
                    "faster, as where a body comes to rest; ask for a shorter duration"
                )
            yield from self.step(end - self.time)
            if progress is not None:
                progress(self.time / end)

    def step(self, longest: float) -> Course[bool]:
        """Take one part of the history, no longer than asked for [s]; return whether it was taken, and need not be tried with less."""
        pushing = [touch for touch in self.touching.values() if touch.pushes]
        if pushing:
            return (yield from self.press(pushing, longest))
        self.fly(longest)
        return True

    # without contact forces -------------------------------------------------------------------------

    def fly(self, longest: float) -> None:
        """Move freely to the next touch, or to where a law that recoils pushes again or its surfaces part."""
        free = FreeMotion(self.system, self.state)
        apart = [number for number in range(len(self.laws)) if number not in self.touching]
        touches = {number: self.next_touch(free, number, longest) for number in apart}
        length = min([longest, *(time for time, _ in touches.values())])
        recoil = end_of_recoil(free, list(self.touching.values()), length)
        if recoil is not None:
            length = recoil[0]
        self.pass_freely(free, length)
        if recoil is not None:
            self.recoiled(self.touching[recoil[1]], parts=recoil[2])
            return
        for number, (time, law) in touches.items():
            if time <= length + 1e-13 * (self.time + length):
                self.meet(number, law)

    def next_touch(self, free: FreeMotion, number: int, longest: float) -> tuple[float, CompliantLaw]:
        """Return when a contact touches in free motion [s from here], and under which law."""
        law, dent = self.known[number], self.dents.get(number)
        if dent is not None:
            parted = time_to_part(free, float(law.touch_level), number)
            again = next_touch(free, float(dent.release_level), min(parted, longest), number)
            if again < parted:  # back into the dent before they had parted from it
                return again, dent
        return next_touch(free, float(law.touch_level), longest, number), law

    def pass_freely(self, free: FreeMotion, length: float) -> None:
        """Take a free motion of a length [s] into the history."""
        motion = Apart(free, length, tuple((number, touch.local) for number, touch in self.touching.items()))
        self.take(motion, free.state(np.array(length)), motion.lost_by(np.array(length)))

    def recoiled(self, touch: Touching, *, parts: bool) -> None:
        """Go on with a contact that has parted, or pushes again."""
        if parts:
            self.part(touch)
        else:
            touch.pushes, touch.delta, touch.trend = True, touch.own(self.system, self.state), 0.0

    # from touch to release --------------------------------------------------------------------------

    def meet(self, number: int, law: CompliantLaw | None = None) -> Touching:
        """Let surfaces touch, under the law that is known or another."""
        of, state, law = self.system, self.state, self.known[number] if law is None else law
        closing = closing_speed(of, state, number)
        under_way = [touch.impact.closing_speed for touch in self.touching.values()]
        if under_way and closing < 1e-3 * max(under_way):
            closing = max(under_way)  # surfaces that lay against each other, and others push together
        local = LocalContact(law, self.laws[number].series, closing)
        impact = Impact(number, self.time, closing)
        self.impacts.append(impact)
        speed, span = self.scale or self._scale(number, law, closing)
        mass = float(of.mass[number])
        self.dents.pop(number, None)
        self.touching[number] = touch = Touching(number, local, mass, float(law.touch_level), speed, span, impact)
        touch.delta = touch.own(self.system, self.state)
        self.pace = min(self.pace, _FIRST * span)
        return touch

    def _scale(self, number: int, law: CompliantLaw, closing: float) -> tuple[float, float]:
        """Return the speed of the motion in a contact [m/s], and about how long it lasts [s]."""
        mass, speed = float(self.system.mass[number]), motion_speed(self.system, number, law, closing)
        depth = float(undamped_depth(law, np.array([0.5 * mass * speed**2]), np.zeros(1))[0] - law.touch_level)
        return speed, 3.0 * depth / speed

    def part(self, touch: Touching) -> None:
        """Let surfaces part; the law goes on with what it remembers, if that outlasts the contact."""
        touch.impact.end = self.time
        law = self.laws[touch.number]
        if not law.forgets and law.law.lasting:
            self.known[touch.number] = touch.local.law
        elif float(touch.local.law.release_level) > float(law.law.touch_level):
            self.dents[touch.number] = touch.local.law
        del self.touching[touch.number]

    # under contact forces ---------------------------------------------------------------------------

    def press(self, pushing: list[Touching], longest: float) -> Course[bool]:
        """Take one stretch, up to its first event; return False if it has to be tried again with less."""
        of, state = self.system, self.state
        for touch in pushing:
            if touch.fresh:
                continue
            # what ends with a stretch as another contact does, or by less than rounding tells
            rounding = _ROUNDING * touch.impact.indentation.near
            if touch.overlap(of, state) <= rounding and float(of.rates(state)[touch.number]) < 0.0:
                self.break_off(touch)
                self.part(touch)
                return True
            if touch.local.law.tension == "cut" and touch.force <= _NO_FORCE * touch.impact.force.near and touch.trend < 0.0:
                self.push_no_more(touch)
                return True
            if touch.closing <= STILL * touch.speed and touch.local.learns(touch.delta):
                self.turn(touch)
        span, speed = min(touch.span for touch in pushing), max(touch.speed for touch in self.touching.values())
        energy = max(touch.energy for touch in pushing)
        if self.pace < 1e-12 * span:
            raise NotIntegrable(f"the contact at {self.time:g} s can not be integrated to the tolerance")
        stretch = yield from asked(
            self.problem(pushing, "touch" if any(touch.fresh for touch in pushing) else "inside", min(self.pace, longest))
        )
        event = first_event(stretch, speed, span) if stretch.solved else None
        other = self.others(stretch) if stretch.solved else None
        if event is not None and (other is None or event.x <= other.x):  # which may be all that keeps the stretch from being resolved
            found = yield from end_at(stretch, event, self.tolerance, energy, speed, span)
            if found is None:
                self.pace = 0.5 * min(self.pace, before_event(stretch, event, self.tolerance, energy))
                return False
            missed = self.others(found[1])
            if missed is not None:  # it lies between what was seen of the event and where it is
                self.pace = 0.5 * found[1].length * float(found[1].rule.map_time(np.array([missed.x]))[0])
                return False
            self.end(pushing, *found)
            return True
        if not stretch.resolved(self.tolerance, energy):
            self.pace *= 0.5
            return False
        if other is None:
            self.accept(pushing, stretch)
            self.pace = stretch.length * growth(stretch, self.tolerance)
            return True
        ended = yield from self.polished(pushing, stretch, other)
        if ended is None or first_event(ended, speed, span) is not None:
            self.pace = 0.5 * stretch.length
            return False
        self.accept(pushing, ended)
        other.act()
        return True

    def end(self, pushing: list[Touching], event: Event, stretch: VibratingStretch) -> None:
        """Accept a stretch that ends with an event of one of its contacts."""
        name, place = event.aim.name, event.aim.contact
        touch = pushing[place]
        parts = name == "parted" or (name == "no push" and self.ends_without_force(touch, stretch.end))
        if parts:  # what is still stored is lost, of a sticking contact that breaks or of a surface that lags behind
            stretch = broken(stretch, place, touch.held_at(float(stretch.contacts[place].delta[-1])))
        self.accept(pushing, stretch)
        if parts:
            self.part(touch)
        elif name == "no push":
            touch.pushes = False
        elif name == "turn":
            self.turn(touch)

    def turn(self, touch: Touching) -> None:
        """Let a law remember how deep it has been."""
        self.plastic += float(touch.local.law.plastic_work(touch.delta))
        touch.local = touch.local.after_own(touch.delta)

    def push_no_more(self, touch: Touching) -> None:
        """Let a contact recoil, or part if it ends with its force, where its last stretch ended."""
        if self.ends_without_force(touch, self.state):
            self.break_off(touch, touch.delta)
            self.part(touch)
        else:
            touch.pushes = False

    def break_off(self, touch: Touching, delta: float | None = None) -> None:
        """Lose what a contact still holds as it ends with a stretch that was taken already, where it parts or at an indentation [m]."""
        last, held = self.parts[-1], touch.held_at(touch.local.least if delta is None else delta)
        if held and isinstance(last.motion, VibratingStretch) and touch.number in last.motion.seen.contacts:
            place = last.motion.seen.contacts.index(touch.number)
            self.parts[-1] = replace(last, motion=broken(last.motion, place, held))
        self.lost[-1] += held

    def ends_without_force(self, touch: Touching, state: State) -> bool:
        """Does a contact end as its force does? If its law does, and its surfaces will part; else they come back into the indentation."""
        if touch.local.law.contact_end != "zero-force":
            return False
        return bool(np.isfinite(time_to_part(FreeMotion(self.system, state), touch.local.release_level, touch.number)))

    def problem(self, pushing: list[Touching], time_map: Map, length: float) -> StretchProblem:
        """Return what is to be solved for a stretch of a length [s] from here."""
        locals_, begun, trend = zip(*((touch.local, touch.delta, touch.trend) for touch in pushing), strict=True)
        return StretchProblem(
            seen_by(self.system, (touch.number for touch in pushing)), locals_, time_map, length, self.state, begun, trend
        )

    def accept(self, pushing: list[Touching], stretch: VibratingStretch) -> None:
        """Take a stretch into the history."""
        for place, (touch, contact, trend) in enumerate(zip(pushing, stretch.contacts, stretch.trend.tolist(), strict=True)):
            note_peaks(touch.impact, stretch, place, self.time)
            touch.delta, touch.force, touch.trend = float(contact.delta[-1]), float(contact.force[-1]), trend
            touch.fresh, touch.closing = False, float(stretch.closing(place)[-1]) if touch.local.law.memories() else np.inf
        end, lost = stretch.end, stretch.lost
        for touch in self.touching.values():
            if not touch.pushes:  # what recoils beside it
                self.lost[-1] += float(given_up(self.system, touch.number, touch.local, self.state, end))
        self.take(stretch, end, lost)
        stretch.forget()  # thousands of stretches would not fit into memory

    def take(self, motion: VibratingStretch | Apart, state: State, lost: Floats) -> None:
        """Go on to the end of a part of the history."""
        self.parts.append(Part(self.time, motion))
        self.lost += lost
        self.time, self.state = self.time + motion.length, state

    # what ends a stretch besides its own contacts ----------------------------------------------------

    def others(self, stretch: VibratingStretch) -> Other | None:
        """Return the first touch, or end of a recoil, of another contact within a stretch."""
        numbers = [number for number in range(len(self.laws)) if number not in stretch.seen.contacts]
        if not numbers:
            return None
        states = stretch.state(stretch.length * stretch.rule.map_time(GRID))
        slack = _SLACK * max(float(contact.delta.max()) for contact in stretch.contacts)
        found = []
        for number in numbers:
            if number not in self.touching:
                found.append(Other(partial(self.beyond, number, slack), partial(self.touch, number, slack, stretch.start)))
                if dent := self.dents.get(number):
                    found.append(Other(partial(self.beyond, number, slack, law=dent), partial(self.meet, number, dent)))
                continue
            touch = self.touching[number]
            for kind in (0, 1):
                found.append(Other(partial(recoil_of, self.system, touch, kind), partial(self.recoiled, touch, parts=kind == 0)))
        seen = [replace(other, x=x) for other in found if (x := _first_crossing(other.value(states))) is not None]
        return min(seen, key=lambda other: other.x, default=None)

    def beyond(self, number: int, slack: float, states: State, law: CompliantLaw | None = None) -> Floats:
        """Return by how much surfaces overlap beyond a slack [m], under the law that is known, or beyond the dent of another."""
        level = self.known[number].touch_level if law is None else law.release_level
        return np.asarray(self.system.approach(states)[..., number] - float(level) - slack)

    def touch(self, number: int, slack: float, before: State) -> None:
        """Let a contact touch, and all others that overlap by half a slack [m] now and did not before."""
        self.meet(number)
        for other in range(len(self.laws)):
            apart = other not in self.touching and float(self.beyond(other, slack, before)) <= 0.0
            if apart and float(self.beyond(other, 0.5 * slack, self.state)) > 0.0:
                self.meet(other)

    def polished(self, pushing: list[Touching], stretch: VibratingStretch, other: Other) -> Course[VibratingStretch | None]:
        """Solve a stretch again so that it ends where another contact touches or its recoil ends; None if that is not found."""
        rule, whole = stretch.rule, stretch.length
        low, high = (whole * float(rule.map_time(np.array([x]))[0]) for x in (max(other.x - GRID[1], 0.0), other.x))
        length = float(find_root(after(stretch, other.value), np.array([low]), np.array([high]))[0])
        for _ in range(_POLISHES):
            ended: VibratingStretch = yield from asked(self.problem(pushing, rule.time_map, length))
            if not ended.solved:
                return None
            step = 1e-6 * length
            now, before = other.value(ended.end), other.value(ended.state(np.array([length - step])))[0]
            missing = float(now / (now - before)) * step
            if abs(missing) <= 1e-13 * whole:
                return ended
            length -= missing
            if not 0.0 < length <= 1.01 * whole:
                return None
        return ended


@dataclass(frozen=True)
class Other:
    """What may end a stretch besides its own contacts: where a value of the state becomes positive, and what is done then."""

    value: Callable[[State], Floats]
    act: Callable[[], object]
    x: float = np.inf


def _first_crossing(values: Floats) -> float | None:
    """Return the x of the first point of the grid at which values have become positive."""
    crossed = (values[1:] > 0.0) & (values[:-1] <= 0.0)
    return float(GRID[1:][crossed][0]) if crossed.any() else None
