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

from vibroimpact.contact.law import CompliantLaw
from vibroimpact.contact.quasi_static import QuasiStatic
from vibroimpact.contact.roots import find_root, highest
from vibroimpact.contact.static import static_indentation
from vibroimpact.dynamics.apart import Apart
from vibroimpact.dynamics.collocation import Floats, Map
from vibroimpact.dynamics.contact import CAPTURED, FAILED, RELEASED, RIDING, SETTLED
from vibroimpact.dynamics.ending import before_event, broken, end_at, growth
from vibroimpact.dynamics.linear_system import FreeMotion, LinearSystem, State
from vibroimpact.dynamics.local import LocalContact
from vibroimpact.dynamics.next_touch import next_touch, time_to_part
from vibroimpact.dynamics.receptance import Seen
from vibroimpact.dynamics.riding import Riding, least_energy, may_stay, stays_below
from vibroimpact.dynamics.solve_vibrating import solve_vibrating
from vibroimpact.dynamics.vibrating_events import ROUNDING, first_event
from vibroimpact.dynamics.vibrating_stretch import VibratingStretch

MOST_STEPS, MOST_STEPS_TO_A_TIME = 5_000, 20_000
"""How many stretches of contact a visit is followed for: some ten seconds' work; and where the run has an end in time."""

_FIRST = 0.125  # of the span of a contact: the first stretch
_LONG = 10.0  # times the span of a contact: a sphere that long in touch rides
_GLIDE_SAMPLES = 65


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

    system: LinearSystem
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
    seen: Seen,
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
    seen : Seen
        The system of one drop, as its contact sees it.
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
        return _Visit(seen, law, series, state, tolerance, pace, forgets, rest_speed, until).run()


class _Visit:
    def __init__(
        self,
        seen: Seen,
        law: CompliantLaw,
        series: QuasiStatic,
        state: State,
        tolerance: float,
        pace: float,
        forgets: bool,
        rest_speed: float,
        until: float,
    ) -> None:
        self.seen, self.series, self.state, self.tolerance = seen, series, state, tolerance
        self.of, self.mass, self.gravity = seen.system, float(seen.system.mass[0]), float(seen.system.gravity[0])
        self.time, self.left, self.span, self.pace = 0.0, 0.0, pace, _FIRST * pace
        self.touching, self.stretches, self.most = True, 0, MOST_STEPS if np.isinf(until) else MOST_STEPS_TO_A_TIME
        self.law, self.ends_without_force = law, law.contact_end == "zero-force"
        self.forgets, self.rest_speed, self.until = forgets or not law.lasting, rest_speed, until
        self.found = Visit(seen.system, state, law, np.zeros(self.of.number + 1))
        self.local = self.at_touch(law)
        self.delta = float(law.touch_level)  # the law's own indentation
        self.riding: Riding | None = None
        self.trend: Floats | None = None  # how fast the force changes [N/s]
        self.speed = max(self.local.approach_speed, float(np.sqrt(self.gravity * self.sag(law))))

    # one contact after another ----------------------------------------------------------------------

    def at_touch(self, law: CompliantLaw) -> LocalContact:
        of, state = self.of, self.state
        # where the sphere's own vibration makes its surface meet the other, its centre may hardly come nearer
        return LocalContact(law, self.series, max(float(of.outer_rates(state)[0]), float(of.rates(state)[0]), 1e-300))

    def run(self) -> Visit:
        found = self.found
        found.contacts = 1
        while True:
            found.outcome = self.contact()
            if found.outcome != RELEASED:
                break
            rising = self.rising
            slow = rising < self.rest_speed and self.gravity > 0.0
            if slow and rising > 0.0 and stays_below(self.of, self.next_law, self.state, self.rest_speed):
                found.outcome = SETTLED
                break
            if not self.meets_again(slow) and rising >= 0.0:
                break
            found.contacts += 1
        found.law, found.state, found.duration = self.local.law, self.state, self.left
        found.local = self.local
        if found.outcome == SETTLED and float(self.of.approach(self.state)[0]) <= float(self.next_law.touch_level):
            found.local = replace(self.local, law=self.next_law)  # the dent it has left is forgotten
        return found

    # one contact -----------------------------------------------------------------------------------

    def contact(self) -> int:
        """March through one contact; return how it ended."""
        self.touching, begun, self.pace = True, self.time, min(self.pace, _FIRST * self.span)
        self.delta, self.trend = float(self.local.own(self.here())), None
        while True:
            if not self.touching and self.here() <= self.floor and self.of.rates(self.state)[0] < 0.0:
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
            if event is None:
                if not stretch.resolved(self.tolerance, self.energy):
                    self.pace *= 0.5
                    continue
                self.accept(stretch)
                self.pace = stretch.length * growth(stretch, self.tolerance)
            else:  # which may be all that keeps the stretch from being resolved
                found = end_at(stretch, event, self.tolerance, self.energy, self.speed, self.span)
                if found is None:
                    self.pace = 0.5 * min(self.pace, before_event(stretch, event, self.tolerance, self.energy))
                    continue
                name, ended = found[0].aim.name, found[1]
                released = name == "parted" or (name == "no push" and self.ends_without_force and self.will_part(ended.end))
                if released:  # what is still stored is lost, of a sticking contact that breaks or of a surface that lags behind
                    ended = broken(ended, 0, self.held_at(float(ended.contacts[0].delta[-1])))
                self.accept(ended)
                if not released and name == "no push":
                    released = self.glide()
                self.left = self.time
                if released:
                    return RELEASED
                if name == "turn":
                    self.turn()
            if self.held() or self.lies():
                return self.stay(CAPTURED)

    def stay(self, outcome: int) -> int:
        """End the visit in contact."""
        self.found.stored, self.left = float(self.local.own_energy(self.delta)), self.time
        return outcome

    def solve(self, time_map: Map, length: float) -> VibratingStretch:
        return solve_vibrating(self.seen, [self.local], time_map, length, self.state, [self.delta], trend=self.trend)

    @property
    def floor(self) -> float:
        return self.local.release_level

    def here(self) -> float:
        return max(float(self.of.approach(self.state)[0]), self.floor)

    def accept(self, stretch: VibratingStretch) -> None:
        """Take a stretch into the history."""
        found = self.found
        found.parts.append(Part(self.time, stretch))
        self.note_peaks(stretch)
        self.time += stretch.length
        self.state, self.delta = stretch.end, float(stretch.contacts[0].delta[-1])
        found.lost += stretch.lost
        self.touching, self.trend = False, stretch.trend
        stretch.forget()  # thousands of stretches would not fit into memory

    def held_at(self, delta: float) -> float:
        """Return the energy stored in the contact at an indentation of the law [J], without what is rounding."""
        held = float(self.local.own_energy(delta))
        return held if abs(held) > 2e-15 * self.energy else 0.0

    def break_off(self) -> None:
        """Lose what a contact still holds as it ends with a stretch that was taken already."""
        last, held = self.found.parts[-1], self.held_at(self.local.least)
        if held and isinstance(last.motion, VibratingStretch):
            self.found.parts[-1] = replace(last, motion=broken(last.motion, 0, held))
            self.found.lost[-1] += held

    def turn(self) -> None:
        """Go on with a law that remembers how deep it has been."""
        self.found.plastic += float(self.local.law.plastic_work(self.delta))
        self.local = self.local.after_own(self.delta)

    def held(self) -> bool:
        """Is there too little energy left to get out of the indentation?"""
        energy = float(self.of.mechanical_energy(self.state)) + float(self.local.own_work(self.delta))
        out = least_energy(self.of, self.floor, float(self.local.own_energy(self.local.least)))
        return energy < out + self.tolerance**2 * self.energy

    def lies(self) -> bool:
        """Does the contact carry the weight, with too little left at the contact to lift the sphere off it?"""
        last = self.found.parts[-1].motion
        if not isinstance(last, VibratingStretch):
            return False
        if not may_stay(self.of, self.state, float(last.contacts[0].force[-1]), self.here() - self.floor):
            return False
        if self.riding is None or self.riding.local.law is not self.local.law:
            self.riding = Riding(self.of, self.local)
        return self.riding.linear and self.riding.stays(self.state)

    def note_peaks(self, stretch: VibratingStretch) -> None:
        found = self.found
        for name, values in (("indentation", stretch.indentation_at), ("force", stretch.contacts[0].force_at)):
            if float(values(stretch.rule.nodes).max()) < 0.98 * getattr(found, f"max_{name}"):
                continue
            x = highest(values)
            value = float(values(np.array([x]))[0])
            if value > getattr(found, f"max_{name}"):
                setattr(found, f"max_{name}", value)
                setattr(found, f"time_of_max_{name}", self.time + stretch.length * float(stretch.rule.map_time(np.array([x]))[0]))

    def will_part(self, state: State) -> bool:
        """Will the surfaces part if nothing pushes any more? Else the sphere falls back into the indentation."""
        return bool(np.isfinite(time_to_part(FreeMotion(self.of, state), self.floor)))

    @property
    def energy(self) -> float:
        """About the energy of the motion [J]."""
        return 0.5 * self.mass * self.speed**2

    @property
    def rising(self) -> float:
        """How fast the centres move apart [m/s]."""
        return -float(self.of.rigid_motion(self.state)[1][0])

    def sag(self, law: CompliantLaw) -> float:
        """Return the indentation of a law under the sphere's weight [m]."""
        return float(static_indentation(law, np.array([self.mass * self.gravity]))[0])

    # apart -----------------------------------------------------------------------------------------

    def glide(self) -> bool:
        """Follow the free motion inside the indentation; return True if the surfaces part, False if the law pushes again."""
        free, floor = FreeMotion(self.of, self.state), self.floor

        def push(time: Floats) -> Floats:
            state = free.state(time)
            approach = of.approach(state)[..., 0]
            static, dissipative = self.local.forces(np.maximum(approach, floor), of.outer_rates(state)[..., 0])
            return np.where(approach > floor, static + dissipative, 0.0)

        of = self.of
        begun, step = 0.0, max((self.here() - floor) / max(-float(of.rates(self.state)[0]), 1e-3 * self.speed), 1e-6 * self.span)
        while True:
            times = begun + step * np.linspace(0.0, 1.0, _GLIDE_SAMPLES)[1:]
            approach = free.motion(times)[0][:, 0]
            events = np.array([push(times) > 0.0, approach < floor])
            if events.any():
                break
            begun += step
        index = int(events.any(axis=0).argmax())
        early, late = times[index] - step / (_GLIDE_SAMPLES - 1), times[index]
        parted = bool(events[1, index])
        rises = (lambda time: floor - free.motion(time)[0][:, 0]) if parted else push
        length = float(find_root(rises, np.array([early]), np.array([late]))[0])
        self.pass_freely(free, length, self.local)
        self.delta = float(self.local.own(self.here()))
        return parted

    @property
    def next_law(self) -> CompliantLaw:
        """The law of the next contact, once the surfaces have parted."""
        return self.law if self.forgets else self.local.law

    def meets_again(self, however_late: bool) -> bool:
        """Follow the free sphere to the top of its flight, or farther; return whether the surfaces meet again before.

        Where the next contact would begin with fresh surfaces, the visit goes on at least until these have parted.
        """
        free, rising, gravity = FreeMotion(self.of, self.state), self.rising, self.gravity
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
