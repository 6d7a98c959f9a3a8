"""One visit of a sphere to a surface that vibrates, or vibrating itself: from first touch to the last release.

The contact is marched through by stretches whose length adapts to what the bodies do. In each the first event is
sought: the surfaces part, the force of a law that may not pull becomes zero, a breakpoint of the law is crossed, the
indentation turns; and the stretch is solved again so that it ends there. Once the surfaces have parted, the sphere is
followed to the top of its flight: if the surface meets it again before, the visit goes on with another contact. So it does
where the sphere leaves more slowly than the rest speed, though something that still moves could lift it higher: it chatters, and
then rides, until it is thrown off, or nothing can lift it any more (`riding`), or it has been followed for long enough.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from vibroimpact.contact.law import CompliantLaw
from vibroimpact.contact.quasi_static import QuasiStatic
from vibroimpact.contact.roots import find_root, highest
from vibroimpact.contact.static import static_indentation
from vibroimpact.dynamics.collocation import Floats, Map
from vibroimpact.dynamics.contact import CAPTURED, FAILED, RELEASED, RIDING, SETTLED
from vibroimpact.dynamics.local import LocalContact
from vibroimpact.dynamics.next_touch import next_touch, time_to_part
from vibroimpact.dynamics.oscillators import FreeMotion, State
from vibroimpact.dynamics.riding import Riding, least_energy, may_stay, stays_below
from vibroimpact.dynamics.vibrating_events import GRID, ROUNDING, Event, first_event
from vibroimpact.dynamics.vibrating_stretch import Surroundings, VibratingStretch, mechanical_energy, solve_vibrating

MOST_STEPS, MOST_STEPS_TO_A_TIME = 5_000, 20_000
"""How many stretches of contact a visit is followed for: some ten seconds' work; and where the run has an end in time."""

_FIRST = 0.125  # of the span of a contact: the first stretch
_LONG = 10.0  # times the span of a contact: a sphere that long in touch rides
_GLIDE_SAMPLES = 65
_MOST_SECANTS = 60
_AT_END = 1e-12  # of a stretch: nearer to its end is at its end


@dataclass(frozen=True)
class Apart:
    """Free motion between two contacts, or inside an indentation once the law has stopped pushing.

    `length` [s]. `local` holds in its indentation what is lost as it recovers; None once the surfaces have parted.
    """

    free: FreeMotion
    length: float
    local: LocalContact | None = None

    @property
    def duration(self) -> Floats:
        """How long it lasts [s], as an array of one."""
        return np.array([self.length])

    def take(self, drops: NDArray[np.bool_]) -> Apart:
        """Return itself: it is of one drop."""
        return self

    def lost_by(self, time: Floats) -> Floats:
        """Return what is lost since the start [J] at times since then [s], (T, n + 1): in each oscillator; last, in the contact."""
        return self.lost_at(self.free.state(time))

    def lost_at(self, state: State) -> Floats:
        """Return the same of states that the motion comes to."""
        lost = self.free.lost_at(state)
        if self.local is not None:
            of, floor = self.free.oscillators, self.local.release_level
            before, now = (np.maximum(of.approach(place), floor) for place in (self.free.start, state))
            lost[..., -1] += self.local.elastic_energy(before) - self.local.elastic_energy(now)
        return lost


@dataclass(frozen=True)
class Part:
    """A part of a visit: when it begins, since first touch [s], and its motion."""

    start: float
    motion: VibratingStretch | Apart


@dataclass
class Visit:
    """A visit as it came out; `outcome` is RELEASED, SETTLED, CAPTURED, RIDING or FAILED.

    `state`: of everything at the end. `duration`: from first touch to last release [s]. `contacts`: how many.
    `max_indentation`, `max_force` and when they are reached since first touch [m, N, s]. `lost` [J], (n + 1,): in each
    oscillator, and in the contact. `plastic` [J]. `law`: with what it remembers. `stored`: energy left in the contact [J].
    `local`: the contact that the sphere lies in, if it does.
    """

    state: State
    law: CompliantLaw
    lost: Floats
    outcome: int = RELEASED
    duration: float = 0.0
    contacts: int = 0
    parts: list[Part] = field(default_factory=list)
    max_indentation: float = 0.0
    time_of_max_indentation: float = 0.0
    max_force: float = 0.0
    time_of_max_force: float = 0.0
    plastic: float = 0.0
    stored: float = 0.0
    local: LocalContact | None = None


def visit(
    around: Surroundings,
    law: CompliantLaw,
    series: QuasiStatic,
    state: State,
    tolerance: float,
    pace: float,
    forgets: bool = False,
    rest_speed: float = 0.0,
    until: float = np.inf,
) -> Visit:
    """Follow one drop from first touch to its last release, or to rest.

    Parameters
    ----------
    around : Surroundings
        Mass, gravity and what vibrates.
    law : CompliantLaw
        The law, of one drop.
    series : QuasiStatic
        What is in series with it.
    state : State
        At first touch.
    tolerance : float
        Relative error allowed at the end of each stretch.
    pace : float
        About how long a contact lasts [s].
    forgets : bool, default False
        Does the next impact find fresh surfaces, even where the law leaves a dent?
    rest_speed : float, default 0
        A sphere that leaves more slowly, and can nowhere leave faster any more, is at rest [m/s].
    until : float, default infinite
        When to stop a sphere that rides [s since first touch]; a contact of usual length is finished.
    """
    with np.errstate(all="ignore"):  # guesses may be wild; what is not finite is found and tried again
        return _Visit(around, law, series, state, tolerance, pace, forgets, rest_speed, until).run()


class _Visit:
    def __init__(
        self,
        around: Surroundings,
        law: CompliantLaw,
        series: QuasiStatic,
        state: State,
        tolerance: float,
        pace: float,
        forgets: bool,
        rest_speed: float,
        until: float,
    ) -> None:
        self.around, self.series, self.state, self.tolerance = around, series, state, tolerance
        self.time, self.left, self.span, self.pace = 0.0, 0.0, pace, _FIRST * pace
        self.touching, self.stretches, self.most = True, 0, MOST_STEPS if np.isinf(until) else MOST_STEPS_TO_A_TIME
        self.law, self.ends_without_force = law, law.contact_end == "zero-force"
        self.forgets, self.rest_speed, self.until = forgets or not law.lasting, rest_speed, until
        self.found = Visit(state, law, np.zeros(len(around.oscillators.shape) + 1))
        self.local = self.at_touch(law)
        self.riding: Riding | None = None
        self.speed = max(self.local.approach_speed, float(np.sqrt(around.gravity * _sag(around, law))))

    # one contact after another ----------------------------------------------------------------------

    def at_touch(self, law: CompliantLaw) -> LocalContact:
        of, state = self.around.oscillators, self.state
        # where the sphere's own vibration makes its surface meet the other, its centre may hardly come nearer
        return LocalContact(law, self.series, max(float(of.outer_rates(state)), float(of.rates(state)), 1e-300))

    def run(self) -> Visit:
        found = self.found
        found.contacts = 1
        while True:
            found.outcome = self.contact()
            if found.outcome != RELEASED:
                break
            rising = -float(self.state.speed)
            slow = rising < self.rest_speed and self.around.gravity > 0.0
            if slow and rising > 0.0 and stays_below(self.around, self.next_law, self.state, self.rest_speed):
                found.outcome = SETTLED
                break
            if not self.meets_again(slow) and rising >= 0.0:
                break
            found.contacts += 1
        found.law, found.state, found.duration = self.local.law, self.state, self.left
        found.local = self.local
        if found.outcome == SETTLED and float(self.around.oscillators.approach(self.state)) <= float(self.next_law.touch_level):
            found.local = replace(self.local, law=self.next_law)  # the dent it has left is forgotten
        return found

    # one contact -----------------------------------------------------------------------------------

    def contact(self) -> int:
        """March through one contact; return how it ended."""
        self.touching, begun, self.pace = True, self.time, min(self.pace, _FIRST * self.span)
        while True:
            if not self.touching and self.here() <= self.floor and self.around.oscillators.rates(self.state) < 0.0:
                self.left = self.time  # by less than rounding tells
                self.break_off()
                return RELEASED
            self.stretches += 1
            if self.pace < 1e-12 * self.span:
                return self.stay(FAILED)
            rides, left = self.time - begun > _LONG * self.span, self.until - self.time
            if self.stretches > self.most or (rides and left <= ROUNDING * self.span):
                return self.stay(RIDING)
            stretch = self.solve("touch" if self.touching else "inside", min(self.pace, left) if rides else self.pace)
            event = first_event(stretch, self.speed, self.span) if stretch.solved else None
            # up to where the surfaces part, the force is smooth in another root of time: the end may be resolved where this is not
            ends = event is not None and event.name == "parted" and not self.touching
            if not ends and not stretch.resolved(self.tolerance, self.speed):
                self.pace *= 0.5
                continue
            if event is None:
                self.accept(stretch)
                if stretch.roughness**2 < 1e-4 * self.tolerance:
                    self.pace *= 1.5
            else:
                ended = self.end_at(stretch, event)
                if ended is None or not ended.resolved(self.tolerance, self.speed):
                    self.pace = 0.5 * min(self.pace, stretch.length * float(stretch.rule.map_time(np.array([event.x]))[0]))
                    continue
                released = event.name == "parted" or (event.name == "no push" and self.ends_without_force and self.will_part(ended.end))
                if released:  # what is still stored is lost, of a sticking contact that breaks or of a surface that lags behind
                    ended = replace(ended, broken=self.held_at(max(float(ended.approach[-1]), self.floor)))
                self.accept(ended)
                if not released and event.name == "no push":
                    released = self.glide()
                self.left = self.time
                if released:
                    return RELEASED
                if event.name == "turn":
                    self.turn()
            if self.held() or self.lies():
                return self.stay(CAPTURED)

    def stay(self, outcome: int) -> int:
        """End the visit in contact."""
        self.found.stored, self.left = float(self.local.elastic_energy(self.here())), self.time
        return outcome

    def solve(self, time_map: Map, length: float) -> VibratingStretch:
        return solve_vibrating(self.around, self.local, time_map, length, self.state)

    @property
    def floor(self) -> float:
        return self.local.release_level

    def here(self) -> float:
        return max(float(self.around.oscillators.approach(self.state)), self.floor)

    def end_at(self, stretch: VibratingStretch, event: Event) -> VibratingStretch | None:
        """Solve a stretch again so that it ends at an event: regula falsi from where it was seen; None if it is not found.

        One that was seen in a solution which is not resolved may not be there: then the search runs against the end of the stretch.
        """
        time_map: Map = "touch" if self.touching else "release" if event.name in ("parted", "no push") else "inside"
        rule = stretch.rule
        low, high = (stretch.length * float(rule.map_time(np.array([x]))[0]) for x in (max(event.x - GRID[1], 0.0), event.x))
        length, least, most = 0.5 * (low + high), 0.0, stretch.length
        before: tuple[float, float] | None = None
        forces = None
        for _ in range(_MOST_SECANTS):
            ended = solve_vibrating(self.around, self.local, time_map, length, self.state, forces)
            if not ended.solved:
                return None
            values = event.rises(ended)
            value = float(values[-1])
            least, most = (least, min(most, length)) if value > 0.0 else (max(least, length), most)
            if before is None:  # the slope at the end of what was solved
                step = value * length * float(rule.time[-1] - rule.time[-2]) / max(float(values[-1] - values[-2]), 1e-300)
            else:
                step = value * (length - before[0]) / (value - before[1]) if value != before[1] else 0.0
            if abs(step) <= 1e-13 * length:
                return ended if value >= 0.0 or length < (1.0 - _AT_END) * stretch.length else None
            before, following = (length, value), length - step
            if not least < following < most:
                following = 0.5 * (least + most)
            length, forces = following, (ended.static, ended.dissipative)
        return None

    def accept(self, stretch: VibratingStretch) -> None:
        """Take a stretch into the history."""
        found = self.found
        found.parts.append(Part(self.time, stretch))
        self.note_peaks(stretch)
        self.time += stretch.length
        self.state = stretch.end
        found.lost += stretch.lost
        self.touching = False
        stretch.forget()  # thousands of stretches would not fit into memory

    def held_at(self, approach: float) -> float:
        """Return the energy stored in the contact at an approach of the surfaces [J], without what is rounding."""
        held = float(self.local.elastic_energy(approach))
        return held if abs(held) > 1e-15 * self.around.mass * self.speed**2 else 0.0

    def break_off(self) -> None:
        """Lose what a contact still holds as it ends with a stretch that was taken already."""
        last, held = self.found.parts[-1], self.held_at(self.floor)
        if held and isinstance(last.motion, VibratingStretch):
            self.found.parts[-1] = replace(last, motion=replace(last.motion, broken=held))
            self.found.lost[-1] += held

    def turn(self) -> None:
        """Go on with a law that remembers how deep it has been."""
        deepest = self.here()
        self.found.plastic += float(self.local.plastic_work(deepest))
        self.local = self.local.after_compression(deepest)

    def held(self) -> bool:
        """Is there too little energy left to get out of the indentation?"""
        here, around = self.here(), self.around
        energy = mechanical_energy(around, self.state) + float(self.local.work(here))
        out = least_energy(around, self.floor, float(self.local.elastic_energy(self.floor)))
        return energy < out + 0.5 * around.mass * (self.tolerance * self.speed) ** 2

    def lies(self) -> bool:
        """Does the contact carry the weight, with too little left at the contact to lift the sphere off it?"""
        around, last = self.around, self.found.parts[-1].motion
        if not isinstance(last, VibratingStretch) or not may_stay(around, self.state, float(last.force[-1]), self.here() - self.floor):
            return False
        if self.riding is None or self.riding.local.law is not self.local.law:
            self.riding = Riding(around, self.local)
        return self.riding.linear and self.riding.stays(self.state)

    def note_peaks(self, stretch: VibratingStretch) -> None:
        found = self.found
        for name, values in (("indentation", stretch.indentation_at), ("force", stretch.force_at)):
            if float(values(stretch.rule.nodes).max()) < 0.98 * getattr(found, f"max_{name}"):
                continue
            x = highest(values)
            value = float(values(np.array([x]))[0])
            if value > getattr(found, f"max_{name}"):
                setattr(found, f"max_{name}", value)
                setattr(found, f"time_of_max_{name}", self.time + stretch.length * float(stretch.rule.map_time(np.array([x]))[0]))

    def will_part(self, state: State) -> bool:
        """Will the surfaces part if nothing pushes any more? Else the sphere falls back into the indentation."""
        return bool(np.isfinite(time_to_part(FreeMotion(self.around.oscillators, state, self.around.gravity), self.floor)))

    # apart -----------------------------------------------------------------------------------------

    def glide(self) -> bool:
        """Follow the free motion inside the indentation; return True if the surfaces part, False if the law pushes again."""
        free, floor = FreeMotion(self.around.oscillators, self.state, self.around.gravity), self.floor

        def push(time: Floats) -> Floats:
            state = free.state(time)
            approach = of.approach(state)
            static, dissipative = self.local.forces(np.maximum(approach, floor), of.outer_rates(state))
            return np.where(approach > floor, static + dissipative, 0.0)

        of = free.oscillators
        begun, step = 0.0, max((self.here() - floor) / max(-float(of.rates(self.state)), 1e-3 * self.speed), 1e-6 * self.span)
        while True:
            times = begun + step * np.linspace(0.0, 1.0, _GLIDE_SAMPLES)[1:]
            approach, _ = free.motion(times)
            events = np.array([push(times) > 0.0, approach < floor])
            if events.any():
                break
            begun += step
        index = int(events.any(axis=0).argmax())
        early, late = times[index] - step / (_GLIDE_SAMPLES - 1), times[index]
        parted = bool(events[1, index])
        rises = (lambda time: floor - free.motion(time)[0]) if parted else push
        length = float(find_root(rises, np.array([early]), np.array([late]))[0])
        self.pass_freely(free, length, self.local)
        return parted

    @property
    def next_law(self) -> CompliantLaw:
        """The law of the next contact, once the surfaces have parted."""
        return self.law if self.forgets else self.local.law

    def meets_again(self, however_late: bool) -> bool:
        """Follow the free sphere to the top of its flight, or farther; return whether the surfaces meet again before.

        Where the next contact would begin with fresh surfaces, the visit goes on at least until these have parted.
        """
        free = FreeMotion(self.around.oscillators, self.state, self.around.gravity)
        rising, gravity = -float(self.state.speed), self.around.gravity
        top = np.inf if rising <= 0.0 or gravity == 0.0 or however_late else rising / gravity
        law, fresh = self.local.law, self.next_law
        level = float(fresh.touch_level)
        parted = time_to_part(free, level)
        if law.release_level > level and (again := next_touch(free, float(law.release_level), parted)) < parted:
            time = again  # before they had parted: into the same dent
        else:
            law = law if law.lasting else fresh
            time = next_touch(free, float(law.touch_level), max(top, parted))
        if not np.isfinite(time):
            if rising < 0.0:  # the next touch is nearer than rounding tells
                self.local = self.at_touch(law)
            return False
        if however_late and rising > 0.0 and time > self.until - self.time:
            return False  # the run ends before
        self.pass_freely(free, time, None)
        self.local = self.at_touch(law)
        return True

    def pass_freely(self, free: FreeMotion, length: float, local: LocalContact | None) -> None:
        apart = Apart(free, length, local)
        self.found.parts.append(Part(self.time, apart))
        self.found.lost += apart.lost_by(np.array([length]))[0]
        self.state = free.state(np.array(length))
        self.time += length


def _sag(around: Surroundings, law: CompliantLaw) -> float:
    """Return the indentation of the law under the sphere's weight [m]."""
    return float(static_indentation(law, np.array([around.mass * around.gravity]))[0])
