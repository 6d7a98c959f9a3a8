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
from vibroimpact.dynamics.lockstep import Coroutine
from vibroimpact.dynamics.vibrating.active_contact import ContactDefinition, closing_speed, locate_highest_peak, motion_speed
from vibroimpact.dynamics.vibrating.contact_equilibrium import ContactEquilibrium, least_energy, near_equilibrium, separates_slower_than
from vibroimpact.dynamics.vibrating.events import ROUNDING
from vibroimpact.dynamics.vibrating.linear_system import FreeMotion, LinearSystem, State
from vibroimpact.dynamics.vibrating.local import LocalContact
from vibroimpact.dynamics.vibrating.march import March, MotionPart, NotIntegrable
from vibroimpact.dynamics.vibrating.next_touch import next_touch, time_to_separation
from vibroimpact.dynamics.vibrating.stretch import VibratingStretch

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
    parts: list[MotionPart]
    max_indentation: float
    time_of_max_indentation: float
    max_force: float
    time_of_max_force: float
    plastic: float
    stored: float
    local: LocalContact


def follow_visit(
    system: LinearSystem,
    law: CompliantLaw,
    series: QuasiStatic,
    state: State,
    tolerance: float,
    contact_duration: float,
    fresh_surface: bool = False,
    rest_speed: float = 0.0,
    until: float = np.inf,
) -> Coroutine[Visit]:
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
    march = March(system, [ContactDefinition(law, series, fresh_surface)], state, tolerance, (speed, contact_duration))
    return (yield from _VisitMarch(march, rest_speed, until).run())


class _VisitMarch:
    """A march of one contact, and the rules that end it."""

    def __init__(self, march: March, rest_speed: float, until: float) -> None:
        self.march, self.rest_speed, self.until = march, rest_speed, until
        self.system, self.gravity = march.system, float(march.system.gravity[0])
        self.stretches, self.most_stretches = 0, MOST_STEPS if np.isinf(until) else MOST_STEPS_TO_A_TIME
        self.separation_time, self.stored = 0.0, 0.0
        self.equilibrium: ContactEquilibrium | None = None
        self.active = march.begin_contact(0)

    # one contact after another ----------------------------------------------------------------------

    def run(self) -> Coroutine[Visit]:
        march, contacts = self.march, 1
        while True:
            outcome = yield from self.contact()
            self.separation_time = march.time
            if outcome != RELEASED:
                break
            separation_speed = self.separation_speed
            slow = separation_speed < self.rest_speed and self.gravity > 0.0
            if slow and separation_speed > 0.0 and separates_slower_than(self.system, self.next_law, march.state, self.rest_speed):
                outcome = SETTLED
                break
            if not self.touches_again(slow) and separation_speed >= 0.0:
                break
            contacts += 1
        local = self.active.local
        if outcome == SETTLED and float(self.system.approach(march.state)[0]) <= float(self.next_law.touch_level):
            local = replace(local, law=self.next_law)  # the dent it has left is forgotten
        deepest, hardest = (locate_highest_peak([getattr(impact, name) for impact in march.impacts]) for name in ("indentation", "force"))
        return Visit(
            self.system,
            march.state,
            self.active.local.law,
            march.lost,
            outcome,
            self.separation_time,
            contacts,
            march.parts,
            *deepest,
            *hardest,
            march.plastic,
            self.stored,
            local,
        )

    # one contact -----------------------------------------------------------------------------------

    def contact(self) -> Coroutine[int]:
        """March through one contact; return how it ended."""
        march, begun = self.march, self.march.time
        while 0 in march.active:
            self.stretches += self.active.pushes
            rides, remaining = march.time - begun > _LONG * self.active.span, self.until - march.time
            if self.stretches > self.most_stretches or (rides and remaining <= ROUNDING * self.active.span):
                return self.end_in_contact(RIDING)
            try:
                taken = yield from march.step(remaining if rides and self.active.pushes else np.inf)
            except NotIntegrable:
                return self.end_in_contact(FAILED)
            if taken and 0 in march.active and self.active.pushes and (self.captured() or self.at_rest()):
                return self.end_in_contact(CAPTURED)
        return RELEASED

    def end_in_contact(self, outcome: int) -> int:
        """End the visit in contact."""
        self.stored = float(self.active.local.energy_at_indentation(self.active.delta))
        return outcome

    def captured(self) -> bool:
        """Is there too little energy left to get out of the indentation?"""
        active, local = self.active, self.active.local
        state = self.march.state
        energy = float(self.system.mechanical_energy(state) - self.system.common_energy(state)) + float(
            local.work_at_indentation(active.delta)
        )
        barrier = least_energy(self.system, local.release_level, float(local.energy_at_indentation(local.release_indentation)))
        return energy < barrier + self.march.tolerance**2 * active.energy

    def at_rest(self) -> bool:
        """Does the contact carry the weight, with too little left at the contact to lift the sphere off it?"""
        last, local = self.march.parts[-1].motion, self.active.local
        if not isinstance(last, VibratingStretch):
            return False
        if not near_equilibrium(
            self.system, self.march.state, float(last.contacts[0].force[-1]), self.active.overlap(self.system, self.march.state)
        ):
            return False
        if self.equilibrium is None or self.equilibrium.local.law is not local.law:
            self.equilibrium = ContactEquilibrium(self.system, local)
        return self.equilibrium.linear and self.equilibrium.cannot_separate(self.march.state)

    @property
    def separation_speed(self) -> float:
        """How fast the centres move apart [m/s]."""
        return -float(self.system.rigid_motion(self.march.state)[1][0])

    # apart -----------------------------------------------------------------------------------------

    @property
    def next_law(self) -> CompliantLaw:
        """The law of the next contact, once the surfaces have parted."""
        return self.march.next_laws[0]

    def touches_again(self, without_limit: bool) -> bool:
        """Follow the free sphere to the top of its flight, or farther; return whether the surfaces meet again before.

        Where the next contact would begin with fresh surfaces, the visit goes on at least until these have parted.
        """
        march, separation_speed, gravity = self.march, self.separation_speed, self.gravity
        free = FreeMotion(self.system, march.state)
        top = np.inf if separation_speed <= 0.0 or gravity == 0.0 or without_limit else separation_speed / gravity
        law, next_law = self.active.local.law, self.next_law
        level = float(next_law.touch_level)
        parted = time_to_separation(free, level)
        if law.release_level > level and (again := next_touch(free, float(law.release_level), parted)) < parted:
            time = again  # before they had parted: into the same dent
        else:
            law = law if law.lasting else next_law
            time = next_touch(free, float(law.touch_level), max(top, parted))
        if not np.isfinite(time):
            if separation_speed < 0.0:  # the next touch is nearer than rounding tells
                self.active = march.begin_contact(0, law)
            return False
        if without_limit and separation_speed > 0.0 and time > self.until - march.time:
            return False  # the run ends before
        march.append_free(free, time)
        self.active = march.begin_contact(0, law)
        return True
