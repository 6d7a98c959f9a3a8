"""The impact of a sphere on a surface, from first touch to the last release, where bodies vibrate.

The contact is integrated by a `TimeMarching`. After separation the sphere is followed to the top of
its flight: if the surfaces touch again before, the impact continues with another contact. It also
continues where the sphere separates more slowly than the rest speed while the vibration could still
lift it: it chatters and then rides, until it separates, no energy is left to lift it
(`contact_equilibrium`), or a limit of stretches or time is reached.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from operator import attrgetter

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.contact.law import CompliantLaw
from vibroimpact.contact.quasi_static import QuasiStatic
from vibroimpact.dynamics.contact import CAPTURED, FAILED, RELEASED, RIDING, SETTLED
from vibroimpact.dynamics.core import contact as core
from vibroimpact.dynamics.core.contact_records import Peaks
from vibroimpact.dynamics.core.surface_friction import flown
from vibroimpact.dynamics.core.surface_friction_records import SlidingSphere
from vibroimpact.dynamics.vibrating.active_contact import (
    ContactDefinition,
    closing_speed,
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
from vibroimpact.dynamics.vibrating.recorded_contact import MotionPart, RecordedContact
from vibroimpact.dynamics.vibrating.surface_friction import (
    NO_FRICTION,
    longest_with_friction,
)
from vibroimpact.dynamics.vibrating.time_marching import TimeMarching

MOST_STEPS = 5_000
"""Largest number of stretches of contact in an impact, some ten seconds' work."""

MOST_STEPS_TO_A_TIME = 20_000
"""That number where the run has an end in time."""

_OUTCOMES = {core.CAPTURED: CAPTURED, core.RIDES: RIDING, core.TOO_STIFF: FAILED}
"""Outcomes of a contact that the core has not followed to its release."""


@dataclass
class ElasticImpact:
    """Result of an impact; `outcome` is RELEASED, SETTLED, CAPTURED, RIDING or FAILED.

    `state`: at the end. `duration`: from first touch to last release [s]. `contacts`: number of
    contacts. `sections`: its history, the contacts and the free motions between. `max_indentation`,
    `max_force` and their times since first touch [m, N, s]. `lost` [J], (n + 1,): energy lost in
    each coordinate, and in the contact. `plastic`: plastic work [J]. `law`: with its memory at the
    end. `stored`: energy left in the contact [J]. `local`: the contact in which the sphere rests,
    if so.
    """

    system: LinearSystem
    state: State
    law: CompliantLaw
    lost: Floats
    outcome: int
    duration: float
    contacts: int
    sections: list[RecordedContact | MotionPart]
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
    """TimeMarching of one contact with the rules that end an impact."""

    def __init__(
        self,
        march: TimeMarching,
        rest_speed: float,
        until: float,
        sphere: SlidingSphere,
    ) -> None:
        self.march = march
        self.rest_speed = rest_speed
        self.until = until
        self.sphere = sphere
        self.system = march.system
        self.gravity = float(march.system.gravity[0])
        self.stretches = 0
        self.most_stretches = MOST_STEPS if np.isinf(until) else MOST_STEPS_TO_A_TIME
        self.longest_stretch = _tangential_period(march.system, march.state)
        self.stored = 0.0
        self.equilibrium: ContactEquilibrium | None = None
        self.response: SteadyResponse | None = None
        self.sections: list[RecordedContact | MotionPart] = []
        self.peaks: list[Peaks] = []
        self.active = march.begin_contact(0)

    # one contact after another
    # ----------------------------------------------------------------------

    def run(self) -> ElasticImpact:
        """Return the impact."""
        march = self.march
        contacts = 1
        while True:
            outcome = self.follow_contact()
            separation_time = march.time
            if outcome != RELEASED:
                break
            separation_speed = self.separation_speed
            slow = separation_speed < self.rest_speed and self.gravity > 0.0
            if slow and separation_speed > 0.0 and self.settles():
                outcome = SETTLED
                break
            if not self.touches_again(slow) and separation_speed >= 0.0:
                break
            contacts += 1
        local = self.active.local
        if outcome == SETTLED:
            approach = float(self.system.approach(march.state)[0])
            if approach <= float(self.next_law.touch_level):
                local = replace(local, law=self.next_law)  # the next contact avoids the dent
        # of equal values the first
        force = max(self.peaks, key=attrgetter("force"))
        indentation = max(self.peaks, key=attrgetter("indentation"))
        return ElasticImpact(
            system=self.system,
            state=march.state,
            law=self.active.local.law,
            lost=march.lost,
            outcome=outcome,
            duration=separation_time,
            contacts=contacts,
            sections=self.sections,
            max_indentation=indentation.indentation,
            time_of_max_indentation=indentation.time_of_indentation,
            max_force=force.force,
            time_of_max_force=force.time_of_force,
            plastic=march.plastic,
            stored=self.stored,
            local=local,
        )

    def settles(self) -> bool:
        """Whether a sphere that has separated lacks the energy to exceed the rest speed again."""
        return not self.system.driven and separates_slower_than(
            self.system, self.next_law, self.march.state, self.rest_speed
        )

    # one contact
    # -----------------------------------------------------------------------------------

    def follow_contact(self) -> int:
        """Follow one contact in the core; return its outcome."""
        longest = self.longest_stretch
        if self.sphere.directions:
            longest = min(longest, longest_with_friction(self.march.tolerance) * self.active.span)
        limits = Limits(self.until, longest, self.most_stretches - self.stretches)
        contact = CompiledContact(self.march, self.active, limits, self.sphere)
        outcome = contact.follow()
        # the core asks where the force is near the weight
        while outcome == core.NEAR_REST:
            outcome = core.CAPTURED if self.at_rest() else contact.follow()
        self.sections.extend(contact.recorded)
        self.peaks.append(contact.progress.peaks)
        self.stretches += contact.steps
        self.sphere = contact.progress.sphere
        if outcome != core.RELEASED:
            self.end_in_contact()
            return _OUTCOMES[outcome]
        self.march.end_contact(self.active)
        return RELEASED

    def end_in_contact(self) -> None:
        """End the impact in contact, with its stored energy.

        The law keeps its memory of the largest indentation.
        """
        local = self.active.local
        if local.updates_memory(self.active.delta):
            self.march.update_memory(self.active)
        self.stored = float(self.active.local.energy_at_indentation(self.active.delta))

    def at_rest(self) -> bool:
        """Whether the contact carries the weight, and its force will not vanish again."""
        state = self.march.state
        local = self.active.local
        force = self.active.force
        driven = self.system.driven > 0
        if not driven:
            indentation = self.active.overlap(self.system, state)
            if not near_equilibrium(self.system, state, force, indentation):
                return False
        if self.equilibrium is None or self.equilibrium.local.law is not local.law:
            self.equilibrium = ContactEquilibrium(self.system, local)
            self.response = steady_response(self.equilibrium)
        if not driven:
            return self.equilibrium.linear and self.equilibrium.cannot_separate(state)
        if rides_for_good(self.equilibrium, state, force):
            return True
        return self.response is not None and self.response.carries_for_good(state, force)

    @property
    def separation_speed(self) -> float:
        """Speed at which the centres move apart [m/s], or the sphere from what drives the plate."""
        _, rigid_rate = self.system.rigid_motion(self.march.state)
        _, driven_rate, _ = self.system.driven_motion(self.march.state)
        return -float(rigid_rate[0] + driven_rate)

    # apart
    # -----------------------------------------------------------------------------------------

    @property
    def next_law(self) -> CompliantLaw:
        """Law of the next contact after separation."""
        return self.march.next_laws[0]

    def touches_again(self, without_limit: bool) -> bool:
        """Follow the free sphere to the top of its flight; return whether it touches again before.

        It may be followed without limit. Where the next contact meets undeformed surfaces, the
        impact continues at least until these have separated. Where the plate is shaken, it
        continues as long as the surfaces meet more slowly than the rest speed: any faster touch is
        an impact of its own.
        """
        separation_speed = self.separation_speed
        free = FreeMotion(self.system, self.march.state)
        shaken = self.system.driven > 0
        top = np.inf
        if separation_speed > 0.0 and self.gravity != 0.0 and not (without_limit or shaken):
            top = separation_speed / self.gravity
        time, law = self.next_touch(free, top)
        if not np.isfinite(time):
            if separation_speed < 0.0:  # the next touch is within rounding of this one
                self.active = self.march.begin_contact(0, law)
            return False
        if without_limit and separation_speed > 0.0 and time > self.until - self.march.time:
            return False  # after the end of the run
        if shaken and separation_speed >= 0.0:
            _, touch_rate = free.motion(np.array(time))
            if float(touch_rate[0]) >= self.rest_speed:
                return False
        self.march.append_free(free, time)
        self.sections.append(self.march.parts[-1])
        self.sphere = flown(self.sphere, time)
        self.active = self.march.begin_contact(0, law)
        return True

    def next_touch(self, free: FreeMotion, top: float) -> tuple[float, CompliantLaw]:
        """Return when the surfaces next touch after separation [s], and under which law.

        The time is infinite if they do not until the top of the flight [s].
        """
        law = self.active.local.law
        touch_level = float(self.next_law.touch_level)
        separation = time_to_separation(free, touch_level)
        if law.release_level > touch_level:
            time = next_touch(free, float(law.release_level), separation)
            if time < separation:  # into the same dent
                return time, law
        if not law.lasting:
            law = self.next_law
        return next_touch(free, float(law.touch_level), max(top, separation)), law


def _tangential_period(system: LinearSystem, state: State) -> float:
    """Return about the period with which the plate is moved along itself under friction [s].

    It is infinite where the plate is not moved so. Friction turns with the slip. A stretch of many
    periods would meet it at too few instants, and yet close its balance of energy.
    """
    if system.along is None or not system.driven:
        return np.inf
    driven = slice(-system.driven, None)
    omega = system.angular_frequency[driven]
    speeds = np.abs(system.along[:2, driven]) * np.hypot(
        state.velocity[driven], omega * state.displacement[driven]
    )
    acceleration = float(np.linalg.norm(speeds * omega))
    speed = float(np.linalg.norm(speeds))
    return 2.0 * np.pi * speed / acceleration if acceleration > 0.0 else np.inf
