"""A visit: the impact of a sphere on a surface, from first touch to the last release, where bodies
vibrate.

The contact is integrated by a `TimeMarching`. After separation the sphere is followed to the top of
its flight: if the surfaces touch again before, the visit continues with another contact. It also
continues where the sphere separates more slowly than the rest speed while the vibration could still
lift it: it chatters and then rides, until it separates, no energy is left to lift it
(`contact_equilibrium`), or a limit of stretches or time is reached.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.contact.law import CompliantLaw
from vibroimpact.contact.quasi_static import QuasiStatic
from vibroimpact.dynamics.contact import CAPTURED, FAILED, RELEASED, RIDING, SETTLED
from vibroimpact.dynamics.core import contact as core
from vibroimpact.dynamics.core.surface_friction import flown
from vibroimpact.dynamics.core.surface_friction_records import SlidingSphere
from vibroimpact.dynamics.vibrating.active_contact import (
    ContactDefinition,
    closing_speed,
    locate_highest_peak,
    motion_speed,
)
from vibroimpact.dynamics.vibrating.carried_oscillations import SteadyResponse, steady_response
from vibroimpact.dynamics.vibrating.compiled_contact import CompiledContact, Limits
from vibroimpact.dynamics.vibrating.contact_equilibrium import (
    ContactEquilibrium,
    near_equilibrium,
    rides_for_good,
    separates_slower_than,
)
from vibroimpact.dynamics.vibrating.linear_system import FreeMotion, LinearSystem, State
from vibroimpact.dynamics.vibrating.local import LocalContact
from vibroimpact.dynamics.vibrating.next_touch import next_touch, time_to_separation
from vibroimpact.dynamics.vibrating.stretch import VibratingStretch
from vibroimpact.dynamics.vibrating.surface_friction import (
    NO_FRICTION,
    longest_with_friction,
)
from vibroimpact.dynamics.vibrating.time_marching import MotionPart, TimeMarching

MOST_STEPS, MOST_STEPS_TO_A_TIME = 5_000, 20_000
"""Largest number of stretches of contact in a visit, some ten seconds' work; and where
the run has an end in time.
"""


@dataclass
class ElasticImpact:
    """Result of a visit; `outcome` is RELEASED, SETTLED, CAPTURED, RIDING or FAILED.

    `state`: at the end. `duration`: from first touch to last release [s]. `contacts`: number of
    contacts. `max_indentation`, `max_force` and their times since first touch [m, N, s]. `lost`
    [J], (n + 1,): energy lost in each coordinate, and in the contact. `plastic`: plastic work [J].
    `law`: with its memory at the end. `stored`: energy left in the contact [J]. `local`: the
    contact in which the sphere rests, if so.
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


def follow_elastic_impact(
    system: LinearSystem,
    law: CompliantLaw,
    series: QuasiStatic,
    state: State,
    tolerance: float,
    contact_duration: float,
    fresh_surface: bool = False,
    rest_speed: float = 0.0,
    until: float = np.inf,
    sphere: SlidingSphere = NO_FRICTION,
) -> ElasticImpact:
    """Follow one drop from first touch to its last release, or to rest.

    Parameters
    ----------
    system : LinearSystem
        System of one drop, with one contact.
    law : CompliantLaw
        The law, of one drop.
    series : QuasiStatic
        The compliance in series with it.
    state : State
        State at first touch.
    tolerance : float
        Relative error allowed at the end of each stretch.
    contact_duration : float
        Approximate duration of a contact [s].
    fresh_surface : bool, default False
        Whether the next impact meets undeformed surfaces, even where the law leaves a dent.
    rest_speed : float, default 0
        A sphere that separates more slowly, and can no longer separate faster, is at rest [m/s].
    until : float, default infinite
        End of a ride [s since first touch]; a contact of usual duration is completed.
    sphere : SlidingSphere, default none
        Friction at first touch.
    """
    speed = motion_speed(system, 0, law, closing_speed(system, state, 0))
    march = TimeMarching(
        system,
        [ContactDefinition(law, series, fresh_surface)],
        state,
        tolerance,
        (speed, contact_duration),
    )
    return _ImpactMarching(march, rest_speed, until, sphere).run()


class _ImpactMarching:
    """TimeMarching of one contact with the rules that end a visit."""

    def __init__(
        self,
        march: TimeMarching,
        rest_speed: float,
        until: float,
        sphere: SlidingSphere,
    ) -> None:
        self.march, self.rest_speed, self.until, self.sphere = (
            march,
            rest_speed,
            until,
            sphere,
        )
        self.system, self.gravity = march.system, float(march.system.gravity[0])
        self.stretches, self.most_stretches = (
            0,
            MOST_STEPS if np.isinf(until) else MOST_STEPS_TO_A_TIME,
        )
        self.separation_time, self.stored, self.longest = (
            0.0,
            0.0,
            _period_along(march.system, march.state),
        )
        self.equilibrium: ContactEquilibrium | None = None
        self.response: SteadyResponse | None = None
        self.active = march.begin_contact(0)

    # one contact after another
    # ----------------------------------------------------------------------

    def run(self) -> ElasticImpact:
        """Return the visit."""
        march, contacts = self.march, 1
        while True:
            outcome = self.contact()
            self.separation_time = march.time
            if outcome != RELEASED:
                break
            separation_speed = self.separation_speed
            slow = separation_speed < self.rest_speed and self.gravity > 0.0
            if (
                slow
                and separation_speed > 0.0
                and not self.system.driven
                and separates_slower_than(self.system, self.next_law, march.state, self.rest_speed)
            ):
                outcome = SETTLED
                break
            if not self.touches_again(slow) and separation_speed >= 0.0:
                break
            contacts += 1
        local = self.active.local
        if outcome == SETTLED and float(self.system.approach(march.state)[0]) <= float(
            self.next_law.touch_level
        ):
            local = replace(local, law=self.next_law)  # the next contact does not meet the dent
        deepest, hardest = (
            locate_highest_peak([getattr(impact, name) for impact in march.impacts])
            for name in ("indentation", "force")
        )
        return ElasticImpact(
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

    # one contact
    # -----------------------------------------------------------------------------------

    def contact(self) -> int:
        """Follow one contact in the core; return its outcome."""
        longest = self.longest
        if self.sphere.directions:
            longest = min(longest, longest_with_friction(self.march.tolerance) * self.active.span)
        limits = Limits(self.until, longest, self.most_stretches - self.stretches)
        contact = CompiledContact(self.march, self.active, limits, self.sphere)
        outcome = contact.follow()
        while outcome == core.NEAR_REST:
            if self.at_rest():
                outcome = core.CAPTURED
                break
            outcome = contact.follow()
        self.stretches += contact.steps
        self.sphere = contact.progress.sphere
        if outcome != core.RELEASED:
            return self.end_in_contact(
                {core.CAPTURED: CAPTURED, core.RIDES: RIDING, core.TOO_STIFF: FAILED}[outcome]
            )
        self.march.end_contact(self.active)
        return RELEASED

    def end_in_contact(self, outcome: int) -> int:
        """End the visit in contact, with its stored energy; the law keeps its memory of
        how deep it has come.
        """
        if self.active.local.updates_memory(self.active.delta):
            self.march.update_memory(self.active)
        self.stored = float(self.active.local.energy_at_indentation(self.active.delta))
        return outcome

    def at_rest(self) -> bool:
        """Whether the contact carries the weight, and the bound of its force excludes
        separation.
        """
        last, local = self.march.parts[-1].motion, self.active.local
        if not isinstance(last, VibratingStretch):
            return False
        force, driven = float(last.contacts[0].force[-1]), self.system.driven
        if not driven and not near_equilibrium(
            self.system, self.march.state, force, self.active.overlap(self.system, self.march.state)
        ):
            return False
        if self.equilibrium is None or self.equilibrium.local.law is not local.law:
            self.equilibrium = ContactEquilibrium(self.system, local)
            self.response = steady_response(self.equilibrium)
        if driven:
            if rides_for_good(self.equilibrium, self.march.state, force):
                return True
            return self.response is not None and self.response.carries_for_good(
                self.march.state, force
            )
        return self.equilibrium.linear and self.equilibrium.cannot_separate(self.march.state)

    @property
    def separation_speed(self) -> float:
        """Speed at which the centres move apart [m/s], or the sphere from what drives the plate."""
        return -float(
            self.system.rigid_motion(self.march.state)[1][0]
            + self.system.driven_motion(self.march.state)[1]
        )

    # apart
    # -----------------------------------------------------------------------------------------

    @property
    def next_law(self) -> CompliantLaw:
        """Law of the next contact after separation."""
        return self.march.next_laws[0]

    def touches_again(self, without_limit: bool) -> bool:
        """Follow the free sphere to the top of its flight, or without limit; return whether the
        surfaces touch again before.

        Where the next contact meets undeformed surfaces, the visit continues at least until these
        have separated. Where the plate is shaken, it continues as long as the surfaces meet more
        slowly than the rest speed: any faster touch is an impact of its own.
        """
        march, separation_speed, gravity = self.march, self.separation_speed, self.gravity
        free = FreeMotion(self.system, march.state)
        shaken = self.system.driven > 0
        top = (
            np.inf
            if separation_speed <= 0.0 or gravity == 0.0 or without_limit or shaken
            else separation_speed / gravity
        )
        law, next_law = self.active.local.law, self.next_law
        level = float(next_law.touch_level)
        parted = time_to_separation(free, level)
        if (
            law.release_level > level
            and (again := next_touch(free, float(law.release_level), parted)) < parted
        ):
            time = again  # before separation: into the same dent
        else:
            law = law if law.lasting else next_law
            time = next_touch(free, float(law.touch_level), max(top, parted))
        if not np.isfinite(time):
            if separation_speed < 0.0:  # the next touch is within rounding of this one
                self.active = march.begin_contact(0, law)
            return False
        if without_limit and separation_speed > 0.0 and time > self.until - march.time:
            return False  # after the end of the run
        if (
            shaken
            and separation_speed >= 0.0
            and float(free.motion(np.array(time))[1][0]) >= self.rest_speed
        ):
            return False
        march.append_free(free, time)
        self.sphere = flown(self.sphere, time)
        self.active = march.begin_contact(0, law)
        return True


def _period_along(system: LinearSystem, state: State) -> float:
    """Return about the period with which the plate is moved along itself under friction [s];
    infinite where it is not.

    Friction turns with the slip. A stretch of many periods would meet it at too few instants, and
    yet close its balance of energy.
    """
    if system.along is None or not system.driven:
        return np.inf
    driven = slice(-system.driven, None)
    omega = system.angular_frequency[driven]
    speeds = np.abs(system.along[:2, driven]) * np.hypot(
        state.velocity[driven], omega * state.displacement[driven]
    )
    fastest, greatest = float(np.linalg.norm(speeds * omega)), float(np.linalg.norm(speeds))
    return 2.0 * np.pi * greatest / fastest if fastest > 0.0 else np.inf
