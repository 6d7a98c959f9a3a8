"""One visit of a sphere to a surface that vibrates, or vibrating itself: from first touch to the last release.

The contact is marched through by stretches whose length adapts to what the bodies do. In each the first event is
sought: the surfaces part, the force of a law that may not pull becomes zero, a breakpoint of the law is crossed, the
indentation turns; and the stretch is solved again so that it ends there. Once the surfaces have parted, the sphere is
followed to the top of its flight: if the surface meets it again before, the visit goes on with another contact. So it does
where the sphere leaves more slowly than the rest speed, though something that still moves could lift it higher: it chatters, and
then rides, until it is thrown off, or nothing can lift it any more (`riding`), or it has been followed for long enough.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.contact.law import CompliantLaw
from vibroimpact.contact.quasi_static import QuasiStatic
from vibroimpact.dynamics.contact import CAPTURED, FAILED, RELEASED, RIDING, SETTLED
from vibroimpact.dynamics.lockstep import Course
from vibroimpact.dynamics.vibrating.events import ROUNDING
from vibroimpact.dynamics.vibrating.linear_system import FreeMotion, LinearSystem, State
from vibroimpact.dynamics.vibrating.local import LocalContact
from vibroimpact.dynamics.vibrating.march import March, NotIntegrable, Part
from vibroimpact.dynamics.vibrating.next_touch import next_touch, time_to_part
from vibroimpact.dynamics.vibrating.riding import Riding, least_energy, may_stay, stays_below
from vibroimpact.dynamics.vibrating.stretch import VibratingStretch
from vibroimpact.dynamics.vibrating.touching import Law, closing_speed, highest_peak, motion_speed

MOST_STEPS, MOST_STEPS_TO_A_TIME = 5_000, 20_000
"""How many stretches of contact a visit is followed for: some ten seconds' work; and where the run has an end in time."""

_LONG = 10.0  # times the span of a contact: a sphere that long in touch rides


@dataclass
class Visit:
    """A visit as it came out; `outcome` is RELEASED, SETTLED, CAPTURED, RIDING or FAILED.

    `state`: of everything at the end. `duration`: from first touch to last release [s]. `contacts`: how many.
    `max_indentation`, `max_force` and when they are reached since first touch [m, N, s]. `lost` [J], (n + 1,): in each
    coordinate, and in the contact. `plastic` [J]. `law`: with what it remembers. `stored`: energy left in the contact [J].
    `local`: the contact that the sphere lies in, if it does.
    """

    system: LinearSystem
    state: State
    law: CompliantLaw
    lost: Floats
    outcome: int
    duration: float
    contacts: int
    parts: list[Part]
    max_indentation: float
    time_of_max_indentation: float
    max_force: float
    time_of_max_force: float
    plastic: float
    stored: float
    local: LocalContact


def visit(
    system: LinearSystem,
    law: CompliantLaw,
    series: QuasiStatic,
    state: State,
    tolerance: float,
    pace: float,
    forgets: bool = False,
    rest_speed: float = 0.0,
    until: float = np.inf,
) -> Course[Visit]:
    """Follow one drop from first touch to its last release, or to rest.

    Parameters
    ----------
    system : LinearSystem
        Of one drop: with one contact.
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
    speed = motion_speed(system, 0, law, closing_speed(system, state, 0))
    march = March(system, [Law(law, series, forgets)], state, tolerance, (speed, pace))
    return (yield from _Visit(march, rest_speed, until).run())


class _Visit:
    """A march of one contact, and the rules that end it."""

    def __init__(self, march: March, rest_speed: float, until: float) -> None:
        self.march, self.rest_speed, self.until = march, rest_speed, until
        self.of, self.gravity = march.system, float(march.system.gravity[0])
        self.stretches, self.most = 0, MOST_STEPS if np.isinf(until) else MOST_STEPS_TO_A_TIME
        self.left, self.stored = 0.0, 0.0
        self.riding: Riding | None = None
        self.touch = march.meet(0)

    # one contact after another ----------------------------------------------------------------------

    def run(self) -> Course[Visit]:
        march, contacts = self.march, 1
        while True:
            outcome = yield from self.contact()
            self.left = march.time
            if outcome != RELEASED:
                break
            rising = self.rising
            slow = rising < self.rest_speed and self.gravity > 0.0
            if slow and rising > 0.0 and stays_below(self.of, self.next_law, march.state, self.rest_speed):
                outcome = SETTLED
                break
            if not self.meets_again(slow) and rising >= 0.0:
                break
            contacts += 1
        local = self.touch.local
        if outcome == SETTLED and float(self.of.approach(march.state)[0]) <= float(self.next_law.touch_level):
            local = replace(local, law=self.next_law)  # the dent it has left is forgotten
        deepest, hardest = (highest_peak([getattr(impact, name) for impact in march.impacts]) for name in ("indentation", "force"))
        return Visit(
            self.of,
            march.state,
            self.touch.local.law,
            march.lost,
            outcome,
            self.left,
            contacts,
            march.parts,
            *deepest,
            *hardest,
            march.plastic,
            self.stored,
            local,
        )

    # one contact -----------------------------------------------------------------------------------

    def contact(self) -> Course[int]:
        """March through one contact; return how it ended."""
        march, begun = self.march, self.march.time
        while 0 in march.touching:
            self.stretches += self.touch.pushes
            rides, left = march.time - begun > _LONG * self.touch.span, self.until - march.time
            if self.stretches > self.most or (rides and left <= ROUNDING * self.touch.span):
                return self.stay(RIDING)
            try:
                taken = yield from march.step(left if rides and self.touch.pushes else np.inf)
            except NotIntegrable:
                return self.stay(FAILED)
            if taken and 0 in march.touching and self.touch.pushes and (self.held() or self.lies()):
                return self.stay(CAPTURED)
        return RELEASED

    def stay(self, outcome: int) -> int:
        """End the visit in contact."""
        self.stored = float(self.touch.local.own_energy(self.touch.delta))
        return outcome

    def held(self) -> bool:
        """Is there too little energy left to get out of the indentation?"""
        touch, local = self.touch, self.touch.local
        state = self.march.state
        energy = float(self.of.mechanical_energy(state) - self.of.common_energy(state)) + float(local.own_work(touch.delta))
        out = least_energy(self.of, local.release_level, float(local.own_energy(local.least)))
        return energy < out + self.march.tolerance**2 * touch.energy

    def lies(self) -> bool:
        """Does the contact carry the weight, with too little left at the contact to lift the sphere off it?"""
        last, local = self.march.parts[-1].motion, self.touch.local
        if not isinstance(last, VibratingStretch):
            return False
        if not may_stay(self.of, self.march.state, float(last.contacts[0].force[-1]), self.touch.overlap(self.of, self.march.state)):
            return False
        if self.riding is None or self.riding.local.law is not local.law:
            self.riding = Riding(self.of, local)
        return self.riding.linear and self.riding.stays(self.march.state)

    @property
    def rising(self) -> float:
        """How fast the centres move apart [m/s]."""
        return -float(self.of.rigid_motion(self.march.state)[1][0])

    # apart -----------------------------------------------------------------------------------------

    @property
    def next_law(self) -> CompliantLaw:
        """The law of the next contact, once the surfaces have parted."""
        return self.march.known[0]

    def meets_again(self, however_late: bool) -> bool:
        """Follow the free sphere to the top of its flight, or farther; return whether the surfaces meet again before.

        Where the next contact would begin with fresh surfaces, the visit goes on at least until these have parted.
        """
        march, rising, gravity = self.march, self.rising, self.gravity
        free = FreeMotion(self.of, march.state)
        top = np.inf if rising <= 0.0 or gravity == 0.0 or however_late else rising / gravity
        law, fresh = self.touch.local.law, self.next_law
        level = float(fresh.touch_level)
        parted = time_to_part(free, level)
        if law.release_level > level and (again := next_touch(free, float(law.release_level), parted)) < parted:
            time = again  # before they had parted: into the same dent
        else:
            law = law if law.lasting else fresh
            time = next_touch(free, float(law.touch_level), max(top, parted))
        if not np.isfinite(time):
            if rising < 0.0:  # the next touch is nearer than rounding tells
                self.touch = march.meet(0, law)
            return False
        if however_late and rising > 0.0 and time > self.until - march.time:
            return False  # the run ends before
        march.pass_freely(free, time)
        self.touch = march.meet(0, law)
        return True
