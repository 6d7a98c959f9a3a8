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

from vibroimpact.contact.law import CompliantLaw
from vibroimpact.contact.quasi_static import QuasiStatic
from vibroimpact.contact.roots import find_root, highest
from vibroimpact.contact.static import free_depth
from vibroimpact.dynamics.collocation import Floats, Map
from vibroimpact.dynamics.contact_history import ContactHistory
from vibroimpact.dynamics.ending import before_event, broken, end_at, growth
from vibroimpact.dynamics.linear_system import FreeMotion, LinearSystem, State
from vibroimpact.dynamics.local import LocalContact
from vibroimpact.dynamics.next_touch import next_touch, time_to_part
from vibroimpact.dynamics.receptance import Seen
from vibroimpact.dynamics.solve_vibrating import solve_vibrating
from vibroimpact.dynamics.vibrating_events import GRID, Event, first_event
from vibroimpact.dynamics.vibrating_stretch import VibratingStretch
from vibroimpact.errors import ComputationError

_FIRST = 0.125  # of the span of a contact: the first stretch
_SLACK = 1e-12  # of the deepest indentation: by less surfaces have not touched while other contacts push
_MOST_STRETCHES = 200_000
_GLIDE_SAMPLES = 65
_POLISHES = 8


@dataclass(frozen=True)
class Law:
    """The law of a contact of a march and what is in series with it; `forgets`: does each impact find fresh surfaces?"""

    law: CompliantLaw
    series: QuasiStatic
    forgets: bool


@dataclass
class Impact:
    """One impact of a contact, from touch to release.

    `start`, `end` [s]; NaN while it lasts. `closing_speed` [m/s]. `max_force` [N], `max_indentation` [m] and when they are reached [s].
    `impulse` [N s].
    """

    contact: int
    start: float
    closing_speed: float
    end: float = np.nan
    max_force: float = 0.0
    time_of_max_force: float = np.nan
    max_indentation: float = 0.0
    time_of_max_indentation: float = np.nan
    impulse: float = 0.0


@dataclass
class Touching:
    """A contact whose surfaces overlap.

    `delta`: its law's own indentation [m]. `span`: about how long it lasts [s]. `pushes`: else it recoils without a force. `fresh`: it
    has just met. `trend`: how fast its force changes [N/s].
    """

    number: int
    local: LocalContact
    delta: float
    span: float
    impact: Impact
    pushes: bool = True
    fresh: bool = True
    trend: float = 0.0


@dataclass(frozen=True)
class Piece:
    """A part of a march: when it begins [s], how long it lasts [s], its motion, and what recoils in it."""

    start: float
    length: float
    motion: VibratingStretch | FreeMotion
    recoiling: tuple[int, ...] = ()


class March:
    """A system on its way through contacts.

    `time` [s], `state`: where it is. `touching`: the contacts whose surfaces overlap, by number. `pieces`: its history. `impacts`: what
    came of each contact. `lost` [J], (n + 1,): in each coordinate, and in the contacts; `plastic` [J].
    """

    def __init__(self, system: LinearSystem, laws: Sequence[Law], state: State, tolerance: float) -> None:
        self.system, self.laws, self.state, self.tolerance = system, laws, state, tolerance
        self.known = [law.law for law in laws]  # with what they remember
        self.time, self.pace, self.stretches = 0.0, np.inf, 0
        self.touching: dict[int, Touching] = {}
        self.pieces: list[Piece] = []
        self.impacts: list[Impact] = []
        self.lost, self.plastic = np.zeros(system.number + 1), 0.0
        self._seen: dict[tuple[int, ...], Seen] = {}

    def run(self, end: float, progress: Callable[[float], None] | None = None) -> None:
        """Go on until a time [s]; a contact under way then is cut short.

        Raises
        ------
        ComputationError
            If a contact can not be integrated to the tolerance, or contacts follow each other without end.
        """
        with np.errstate(all="ignore"):  # guesses may be wild; what is not finite is found and tried again
            while self.time < end:
                self.stretches += 1
                if self.stretches > _MOST_STRETCHES:
                    raise ComputationError(
                        f"after {_MOST_STRETCHES} stretches of contact the system is at {self.time:g} s: contacts follow each other ever "
                        "faster, as where a body comes to rest; ask for a shorter duration"
                    )
                pushing = [touch for touch in self.touching.values() if touch.pushes]
                if pushing:
                    self.press(pushing, end - self.time)
                else:
                    self.fly(end - self.time)
                if progress is not None:
                    progress(self.time / end)

    # without contact forces -------------------------------------------------------------------------

    def fly(self, longest: float) -> None:
        """Move freely to the next touch, or to where a law that recoils pushes again or its surfaces part."""
        free, length = FreeMotion(self.system, self.state), longest
        times = {number: self.next_touch(free, number, longest) for number in range(len(self.laws)) if number not in self.touching}
        length = min([longest, *times.values()])
        recoils = self.recoil_ends(free, length)
        if recoils is not None:
            length, number, parts = recoils
        self.take(Piece(self.time, length, free, tuple(self.touching)), free.state(np.array(length)), free.lost_by(np.array(length)))
        if recoils is not None:
            self.recoiled(self.touching[number], parts)
            return
        for number, time in times.items():
            if time <= length + 1e-13 * (self.time + length):
                self.touch(number)

    def next_touch(self, free: FreeMotion, number: int, longest: float) -> float:
        """Return when a contact touches in free motion [s from here]."""
        return next_touch(free, self.touch_level(number), longest, number)

    def recoil_ends(self, free: FreeMotion, longest: float) -> tuple[float, int, bool] | None:
        """Return when the first contact that recoils parts or pushes again [s from here], which, and whether it parts."""
        found = None
        for touch in self.touching.values():
            begun, step = 0.0, 0.25 * touch.span
            while begun < longest:
                times = np.minimum(begun + step * np.linspace(0.0, 1.0, _GLIDE_SAMPLES), longest)
                gone = self.watched(touch, free.state(times))
                crossed = (gone[:, 1:] > 0.0) & (gone[:, :-1] <= 0.0)
                if crossed.any():
                    index = int(crossed.any(axis=0).argmax())
                    kind = int(crossed[:, index].argmax())
                    value = after(free, partial(self.recoil_of, touch, kind))
                    longest = float(find_root(value, times[index : index + 1], times[index + 1 : index + 2])[0])
                    found = longest, touch.number, kind == 0
                    break
                begun, step = begun + step, 2.0 * step
        return found

    def watched(self, touch: Touching, states: State) -> Floats:
        """Return what becomes positive where a contact that recoils parts, and where its law pushes again, (2, T)."""
        approach, floor = self.system.approach(states)[..., touch.number], touch.local.release_level
        static, dissipative = touch.local.forces(np.maximum(approach, floor), self.system.outer_rates(states)[..., touch.number])
        return np.stack([floor - approach, np.where(approach > floor, static + dissipative, -1.0)])

    def recoil_of(self, touch: Touching, kind: int, states: State) -> Floats:
        """Return what becomes positive where a contact that recoils parts (0), or where its law pushes again (1)."""
        return np.asarray(self.watched(touch, states)[kind])

    def recoiled(self, touch: Touching, parts: bool) -> None:
        """Go on with a contact that has parted, or pushes again."""
        if parts:
            self.part(touch)
        else:
            touch.pushes, touch.delta = True, self.own(touch)

    def touch(self, number: int, slack: float = 0.0) -> None:
        """Let surfaces meet, and all others that do at the same time."""
        self.meet(number)
        for other in range(len(self.laws)):
            if other not in self.touching and slack and float(self.beyond(other, self.touch_level(other) + 0.5 * slack, self.state)) > 0.0:
                self.meet(other)

    def touch_level(self, number: int) -> float:
        """Return the approach at which a contact touches [m]."""
        return float(self.known[number].touch_level)

    def meet(self, number: int) -> None:
        """Begin a contact."""
        law, of, state = self.laws[number], self.system, self.state
        closing = max(float(of.outer_rates(state)[number]), float(of.rates(state)[number]))
        under_way = [touch.impact.closing_speed for touch in self.touching.values()]
        if under_way and closing < 1e-3 * max(under_way):
            closing = max(under_way)  # surfaces that lay against each other, and others push together
        closing = max(closing, 1e-300)
        local = LocalContact(self.known[number], law.series, closing)
        mass = float(of.mass[number])
        depth = float(free_depth(local.law, np.array([0.5 * mass * closing**2]), np.zeros(1))[0] - local.law.touch_level)
        span = 3.0 * depth / closing
        impact = Impact(number, self.time, closing)
        self.impacts.append(impact)
        self.touching[number] = touch = Touching(number, local, float(local.law.touch_level), span, impact)
        touch.delta = self.own(touch)
        self.pace = min(self.pace if len(self.touching) > 1 else np.inf, _FIRST * span)

    def own(self, touch: Touching) -> float:
        """Return the own indentation of the law of a contact now [m]."""
        return float(touch.local.own(max(float(self.system.approach(self.state)[touch.number]), touch.local.release_level)))

    def part(self, touch: Touching) -> None:
        """Let surfaces part; the law goes on with what it remembers, if that outlasts the contact."""
        touch.impact.end = self.time
        law = self.laws[touch.number]
        if not law.forgets and law.law.lasting:
            self.known[touch.number] = touch.local.law
        del self.touching[touch.number]

    # under contact forces ---------------------------------------------------------------------------

    def press(self, pushing: list[Touching], longest: float) -> None:
        """Take one stretch, up to its first event."""
        of, state = self.system, self.state
        for touch in pushing:
            rounding = 1e-14 * touch.impact.max_indentation
            overlap = float(of.approach(state)[touch.number]) - touch.local.release_level
            if not touch.fresh and overlap <= rounding and of.rates(state)[touch.number] < 0.0:
                self.lost[-1] += touch.local.own_energy(touch.local.least)
                self.part(touch)
                return
        span = min(touch.span for touch in pushing)
        if self.pace < 1e-12 * span:
            raise ComputationError(f"the contact at {self.time:g} s can not be integrated to the tolerance")
        stretch = self.solve(pushing, "touch" if any(touch.fresh for touch in pushing) else "inside", min(self.pace, longest))
        speed = max(touch.impact.closing_speed for touch in self.touching.values())
        energy = max(0.5 * float(of.mass[touch.number]) * touch.impact.closing_speed**2 for touch in pushing)
        event = first_event(stretch, speed, span) if stretch.solved else None
        other = self.others(stretch) if stretch.solved else None
        if event is not None and (other is None or event.x <= other.x):
            found = end_at(stretch, event, self.tolerance, energy, speed, span)
            if found is None:
                self.pace = 0.5 * min(self.pace, before_event(stretch, event, self.tolerance, energy))
                return
            self.ends(pushing, *found)
            return
        if not stretch.resolved(self.tolerance, energy):
            self.pace = 0.5 * min(self.pace, stretch.length)
            return
        tried = stretch.length
        if other is not None:
            polished = self.polished(pushing, stretch, other)
            if polished is None or first_event(polished, speed, span) is not None:
                self.pace = 0.5 * stretch.length
                return
            stretch = polished
        self.accept(pushing, stretch)
        self.pace = tried if other is not None else stretch.length * growth(stretch, self.tolerance)
        if other is not None:
            other.act()

    def ends(self, pushing: list[Touching], event: Event, stretch: VibratingStretch) -> None:
        """Accept a stretch that ends with an event of one of its contacts."""
        name, place = event.aim.name, event.aim.contact
        touch = pushing[place]
        parts = name == "parted" or (
            name == "no push" and touch.local.law.contact_end == "zero-force" and self.will_part(touch, stretch.end)
        )
        if parts:  # what is still stored is lost, of a sticking contact that breaks or of a surface that lags behind
            held = float(touch.local.own_energy(float(stretch.contacts[place].delta[-1])))
            stretch = broken(stretch, place, held)
        self.accept(pushing, stretch)
        if parts:
            self.part(touch)
        elif name == "no push":
            touch.pushes = False
        elif name == "turn":
            self.plastic += float(touch.local.law.plastic_work(touch.delta))
            touch.local = touch.local.after_own(touch.delta)

    def will_part(self, touch: Touching, state: State) -> bool:
        """Will surfaces part if nothing pushes any more?"""
        return bool(np.isfinite(time_to_part(FreeMotion(self.system, state), touch.local.release_level, touch.number)))

    def solve(self, pushing: list[Touching], time_map: Map, length: float) -> VibratingStretch:
        """Solve a stretch of a length [s] from here."""
        numbers = tuple(touch.number for touch in pushing)
        if numbers not in self._seen:
            self._seen[numbers] = Seen(self.system, numbers)
        locals_, begun = [touch.local for touch in pushing], [touch.delta for touch in pushing]
        trend = np.array([touch.trend for touch in pushing])
        return solve_vibrating(self._seen[numbers], locals_, time_map, length, self.state, begun, trend=trend)

    def accept(self, pushing: list[Touching], stretch: VibratingStretch) -> None:
        """Take a stretch into the history."""
        for touch, contact, trend in zip(pushing, stretch.contacts, stretch.trend.tolist(), strict=True):
            note_peaks(touch.impact, contact, self.time, stretch.length)
            touch.delta, touch.fresh, touch.trend = float(contact.delta[-1]), False, trend
        recoiling = tuple(touch.number for touch in self.touching.values() if not touch.pushes)
        self.take(Piece(self.time, stretch.length, stretch, recoiling), stretch.end, stretch.lost)
        stretch.forget()  # thousands of stretches would not fit into memory

    def take(self, piece: Piece, state: State, lost: Floats) -> None:
        """Go on to the end of a piece of the history; what recoils in it gives up what it holds."""
        for number in piece.recoiling:
            touch, floor = self.touching[number], self.touching[number].local.release_level
            before, now = (max(float(self.system.approach(at)[number]), floor) for at in (self.state, state))
            self.lost[-1] += float(touch.local.elastic_energy(before) - touch.local.elastic_energy(now))
        self.pieces.append(piece)
        self.lost += lost
        self.time, self.state = piece.start + piece.length, state

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
            touch = self.touching.get(number)
            if touch is None:
                found.append(Other(partial(self.beyond, number, self.touch_level(number) + slack), partial(self.touch, number, slack)))
            else:
                for kind in (0, 1):
                    found.append(Other(partial(self.recoil_of, touch, kind), partial(self.recoiled, touch, kind == 0)))
        seen = [replace(other, x=x) for other in found if (x := _first_crossing(other.value(states))) is not None]
        return min(seen, key=lambda other: other.x, default=None)

    def beyond(self, number: int, level: float, states: State) -> Floats:
        """Return by how much surfaces overlap beyond a level [m]."""
        return np.asarray(self.system.approach(states)[..., number] - level)

    def polished(self, pushing: list[Touching], stretch: VibratingStretch, other: Other) -> VibratingStretch | None:
        """Solve a stretch again so that it ends where another contact touches or its recoil ends; None if that is not found."""
        rule, whole = stretch.rule, stretch.length
        low, high = (whole * float(rule.map_time(np.array([x]))[0]) for x in (max(other.x - GRID[1], 0.0), other.x))
        length = float(find_root(after(stretch, other.value), np.array([low]), np.array([high]))[0])
        for _ in range(_POLISHES):
            ended = self.solve(pushing, rule.time_map, length)
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
    act: Callable[[], None]
    x: float = np.inf


def after(motion: FreeMotion | VibratingStretch, value: Callable[[State], Floats]) -> Callable[[Floats], Floats]:
    """Return a function of the state as one of the time since the start of a motion [s]."""
    return lambda time: value(motion.state(time))


def _first_crossing(values: Floats) -> float | None:
    """Return the x of the first point of the grid at which values have become positive."""
    crossed = (values[1:] > 0.0) & (values[:-1] <= 0.0)
    return float(GRID[1:][crossed][0]) if crossed.any() else None


def note_peaks(impact: Impact, contact: ContactHistory, start: float, length: float) -> None:
    """Note the largest force and indentation of a contact within a stretch that starts at a time [s]."""
    rule = contact.rule

    def indentation(x: Floats) -> Floats:
        return np.asarray(rule.weights(x).T @ contact.approach)

    for name, values in (("force", contact.force_at), ("indentation", indentation)):
        if float(values(rule.nodes).max()) < 0.98 * getattr(impact, f"max_{name}"):
            continue
        x = np.array([highest(values)])
        if (value := float(values(x)[0])) > getattr(impact, f"max_{name}"):
            setattr(impact, f"max_{name}", value)
            setattr(impact, f"time_of_max_{name}", start + length * float(rule.map_time(x)[0]))
    impact.impulse += length * float(rule.integral[-1] @ contact.force)
