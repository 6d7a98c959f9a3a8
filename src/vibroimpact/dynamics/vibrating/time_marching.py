"""Time marching of a linear system through its contacts: flights in closed form, stretches of
contact, and the events that end them.

While no contact pushes, the motion is known in closed form, and the march advances to the next
touch. Otherwise it advances by stretches of adaptive length. Each is searched for its first event:
separation, zero force of a law that may not pull, a breakpoint of a law, a turn of an approach, or
a touch at another contact. The stretch is then solved again so that it ends there.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.contact.law import CompliantLaw
from vibroimpact.dynamics.core.contact_records import Manner
from vibroimpact.dynamics.core.events import NO_EVENT, NO_PUSH, NO_TENSION, PARTED, TURN
from vibroimpact.dynamics.core.records import Event
from vibroimpact.dynamics.impact_conditions import undamped_depths
from vibroimpact.dynamics.vibrating.active_contact import (
    ActiveContact,
    ContactDefinition,
    Impact,
    closing_speed,
    motion_speed,
    record_peaks,
)
from vibroimpact.dynamics.vibrating.coasting import coasting_end_value, end_of_coasting
from vibroimpact.dynamics.vibrating.contact_view import contact_view
from vibroimpact.dynamics.vibrating.events import ZERO_RATE, OtherEvent, first_crossing
from vibroimpact.dynamics.vibrating.free_motion import FreePhase, coasting_loss
from vibroimpact.dynamics.vibrating.linear_system import FreeMotion, LinearSystem, State
from vibroimpact.dynamics.vibrating.local import LocalContact
from vibroimpact.dynamics.vibrating.next_touch import next_touch, time_to_separation
from vibroimpact.dynamics.vibrating.radau_eigenbasis import GRID
from vibroimpact.dynamics.vibrating.solve_stretch import StretchAhead
from vibroimpact.dynamics.vibrating.stretch import VibratingStretch
from vibroimpact.dynamics.vibrating.stretch_end import (
    length_growth,
    solve_to_zero,
    with_separation_loss,
)
from vibroimpact.errors import ComputationError

_FIRST_LENGTH = 0.125  # of the duration of a contact: length of the first stretch
# of the deepest indentation: a smaller overlap is no touch while other contacts push
_TOUCH_SLACK = 1e-12
_MOST_STRETCHES = 200_000
_ROUNDING = 1e-14  # of the deepest indentation
_NO_FORCE = 1e-10  # of the largest force


class NotIntegrable(ComputationError):
    """A contact can't be integrated to the tolerance."""


@dataclass(frozen=True)
class MotionPart:
    """A part of the history of a march: its start [s] and its motion."""

    start: float
    motion: VibratingStretch | FreePhase


class TimeMarching:
    """Time marching of a system through its contacts.

    `time` [s], `state`: current ones. `next_length`: of the next stretch [s]. `active`: contacts
    whose surfaces overlap, by number. `next_laws`: laws of the next impacts, with their memory.
    `dents`: laws of the last impacts where the next one meets undeformed surfaces, while surfaces
    may still overlap the dent. `parts`: the history. `impacts`: one record per impact. `lost` [J],
    (n + 1,): energy lost in each coordinate, and in the contacts; `plastic`: plastic work [J].

    Parameters
    ----------
    system : LinearSystem
        The system.
    definitions : sequence of ContactDefinition
        Its contacts.
    state : State
        State at the start.
    tolerance : float
        Relative error allowed at the end of each stretch.
    scale : tuple of two floats, optional
        Speed of the motion [m/s] and approximate duration of a contact [s]; by default each contact
        has its own.
    """

    def __init__(
        self,
        system: LinearSystem,
        definitions: Sequence[ContactDefinition],
        state: State,
        tolerance: float,
        scale: tuple[float, float] | None = None,
    ) -> None:
        self.system, self.definitions, self.state, self.tolerance, self.scale = (
            system,
            definitions,
            state,
            tolerance,
            scale,
        )
        self.next_laws = [law.law for law in definitions]
        self.time, self.next_length = 0.0, np.inf
        self.active: dict[int, ActiveContact] = {}
        self.dents: dict[int, CompliantLaw] = {}
        self.parts: list[MotionPart] = []
        self.impacts: list[Impact] = []
        self.lost, self.plastic = np.zeros(system.number + 1), 0.0

    def run_until(self, end: float, progress: Callable[[float], None] | None = None) -> None:
        """Advance to a time [s]; a contact in progress is cut off there.

        Raises
        ------
        ComputationError
            If a contact can not be integrated to the tolerance, or contacts follow each other
            without end.
        """
        stretches = 0
        while self.time < end:
            stretches += 1
            if stretches > _MOST_STRETCHES:
                raise ComputationError(
                    f"after {_MOST_STRETCHES} stretches of motion the system is at "
                    f"{self.time:g} s: contacts are many, as where they "
                    "follow each other ever faster because a body comes to rest, or last "
                    "long; ask for a shorter duration"
                )
            self.step(end - self.time)
            if progress is not None:
                progress(self.time / end)

    def step(self, longest: float) -> bool:
        """Advance by one part of the history of at most a length [s]; return False if it
        has to be retried with a shorter stretch.
        """
        pushing = [contact for contact in self.active.values() if contact.pushes]
        if pushing:
            return self.step_contact(pushing, longest)
        self.step_free(longest)
        return True

    # without contact forces
    # -------------------------------------------------------------------------

    def step_free(self, longest: float) -> None:
        """Advance in free motion to the next touch, or to where a recoiling contact
        pushes again or separates.
        """
        free = FreeMotion(self.system, self.state)
        apart = [number for number in range(len(self.definitions)) if number not in self.active]
        touches = {number: self.next_touch(free, number, longest) for number in apart}
        length = min([longest, *(time for time, _ in touches.values())])
        recoil = end_of_coasting(free, list(self.active.values()), length)
        if recoil is not None:
            length = recoil[0]
        self.append_free(free, length)
        if recoil is not None:
            self.end_coasting(self.active[recoil[1]], parts=recoil[2])
            return
        for number, (time, law) in touches.items():
            if time <= length + 1e-13 * (self.time + length):
                self.begin_contact(number, law)

    def next_touch(
        self, free: FreeMotion, number: int, longest: float
    ) -> tuple[float, CompliantLaw]:
        """Return when a contact next touches in free motion [s from here], and under which law."""
        law, dent = self.next_laws[number], self.dents.get(number)
        if dent is not None:
            parted = time_to_separation(free, float(law.touch_level), number)
            again = next_touch(free, float(dent.release_level), min(parted, longest), number)
            if again < parted:  # they touch the dent again before they have separated from it
                return again, dent
        return next_touch(free, float(law.touch_level), longest, number), law

    def append_free(self, free: FreeMotion, length: float) -> None:
        """Append a free motion of a length [s] to the history."""
        motion = FreePhase(
            free, length, tuple((number, contact.local) for number, contact in self.active.items())
        )
        state = free.state_after(length)
        self.append_motion(motion, state, motion.lost_at(state))

    def end_coasting(self, contact: ActiveContact, *, parts: bool) -> None:
        """End the recoil of a contact, which separates or pushes again."""
        if parts:
            self.end_contact(contact)
        else:
            contact.pushes, contact.delta, contact.trend = (
                True,
                contact.law_indentation(self.system, self.state),
                0.0,
            )

    # from touch to release
    # --------------------------------------------------------------------------

    def begin_contact(self, number: int, law: CompliantLaw | None = None) -> ActiveContact:
        """Begin an impact at a contact, under its next law or a given one."""
        system, state, law = self.system, self.state, self.next_laws[number] if law is None else law
        closing = closing_speed(system, state, number)
        under_way = [contact.impact.closing_speed for contact in self.active.values()]
        if under_way and closing < 1e-3 * max(under_way):
            # surfaces that touch almost without speed, pressed together by other contacts
            closing = max(under_way)
        local = LocalContact(law, self.definitions[number].series, closing)
        impact = Impact(number, self.time, closing)
        self.impacts.append(impact)
        speed, span = self.scale or self._scale(number, law, closing)
        mass = float(system.mass[number])
        self.dents.pop(number, None)
        self.active[number] = contact = ActiveContact(
            number, local, mass, float(law.touch_level), speed, span, impact
        )
        contact.delta = contact.law_indentation(self.system, self.state)
        self.next_length = min(self.next_length, _FIRST_LENGTH * span)
        return contact

    def _scale(self, number: int, law: CompliantLaw, closing: float) -> tuple[float, float]:
        """Return the speed of the motion in a contact [m/s] and its approximate duration [s]."""
        mass, speed = (
            float(self.system.mass[number]),
            motion_speed(self.system, number, law, closing),
        )
        depth = float(
            undamped_depths(law, np.array([0.5 * mass * speed**2]), np.zeros(1))[0]
            - law.touch_level
        )
        return speed, 3.0 * depth / speed

    def end_contact(self, contact: ActiveContact) -> None:
        """End an impact; the law keeps its memory where it is lasting and the next impact
        falls on the same spot.
        """
        contact.impact.end = self.time
        law = self.definitions[contact.number]
        if not law.fresh_surface and law.law.lasting:
            self.next_laws[contact.number] = contact.local.law
        elif float(contact.local.law.release_level) > float(law.law.touch_level):
            self.dents[contact.number] = contact.local.law
        del self.active[contact.number]

    # under contact forces
    # ---------------------------------------------------------------------------

    def step_contact(self, pushing: list[ActiveContact], longest: float) -> bool:
        """Advance by one stretch of contact, up to its first event; return False if it
        has to be retried with a shorter one.
        """
        system, state = self.system, self.state
        for contact in pushing:
            if contact.fresh:
                continue
            # events at the end of the last stretch: another contact ended it, or this one is within
            # rounding of its event
            rounding = _ROUNDING * contact.impact.indentation.nodal_max
            if (
                contact.overlap(system, state) <= rounding
                and float(system.rates(state)[contact.number]) < 0.0
            ):
                self.dissipate_stored(contact)
                self.end_contact(contact)
                return True
            if (
                contact.local.law.tension == "cut"
                and contact.force <= _NO_FORCE * contact.impact.force.nodal_max
                and contact.trend < 0.0
            ):
                self.end_force(contact)
                return True
            if contact.closing <= ZERO_RATE * contact.speed and contact.local.updates_memory(
                contact.delta
            ):
                self.update_memory(contact)
        span, speed = (
            min(contact.span for contact in pushing),
            max(contact.speed for contact in self.active.values()),
        )
        energy = max(contact.energy for contact in pushing)
        if self.next_length < 1e-12 * span:
            raise NotIntegrable(
                f"the contact at {self.time:g} s can't be integrated to the tolerance"
            )
        ahead = self.stretch_ahead(pushing, speed, energy, span)
        time_map = 0 if any(contact.fresh for contact in pushing) else 1
        tried = ahead.solve(time_map, min(self.next_length, longest))
        if not tried.solved:
            self.next_length *= 0.5
            return False
        balance = ahead.balance(tried, time_map)
        stretch = ahead.stretch(tried, balance, time_map)
        other = self.first_other_event(stretch)
        # an event of the pushing contacts: also tried if the stretch is not resolved, as the event
        # may be the only reason
        if tried.event.kind != NO_EVENT and (other is None or tried.event.x <= other.x):
            success, solved, ended_map, event = ahead.up_to_event(tried, time_map)
            to_event = ahead.balance(solved, ended_map)
            if not (success and to_event.resolved):
                # short of the event if the stretch is resolved; otherwise the event is not certain
                near = max(tried.event.x, GRID[1]) if balance.resolved else 1.0
                self.next_length = 0.5 * min(
                    self.next_length,
                    stretch.length * float(stretch.rule.map_time(np.array([near]))[0]),
                )
                return False
            ended = ahead.stretch(solved, to_event, ended_map)
            missed = self.first_other_event(ended)
            # an event at another contact lies between the estimate and the solved event
            if missed is not None:
                self.next_length = (
                    0.5 * ended.length * float(ended.rule.map_time(np.array([missed.x]))[0])
                )
                return False
            self.end(pushing, event, ended)
            return True
        if not balance.resolved:
            self.next_length *= 0.5
            return False
        if other is None:
            self.accept(pushing, stretch)
            self.next_length = stretch.length * length_growth(stretch, self.tolerance)
            return True
        shorter = solve_to_zero(ahead, stretch, time_map, other.value, other.x)
        if shorter is None:
            self.next_length = 0.5 * stretch.length
            return False
        self.accept(pushing, shorter)
        other.act()
        return True

    def end(self, pushing: list[ActiveContact], event: Event, stretch: VibratingStretch) -> None:
        """Accept a stretch that ends with an event of one of its contacts."""
        place = event.contact
        contact = pushing[place]
        parts = event.kind == PARTED or (
            event.kind == NO_PUSH and self.separates_at_zero_force(contact, stretch.end)
        )
        # stored energy is lost where a sticking contact breaks, or where the surface recovers more
        # slowly than the bodies part
        if parts:
            stretch = with_separation_loss(
                stretch, place, contact.stored_energy_at(float(stretch.contacts[place].delta[-1]))
            )
        self.accept(pushing, stretch)
        if parts:
            self.end_contact(contact)
        elif event.kind == NO_PUSH:
            contact.pushes = False
        elif event.kind == TURN:
            self.update_memory(contact)

    def update_memory(self, contact: ActiveContact) -> None:
        """Update the memory of a law with its largest indentation."""
        self.plastic += float(contact.local.law.plastic_work(contact.delta))
        contact.local = contact.local.after_indentation(contact.delta)

    def end_force(self, contact: ActiveContact) -> None:
        """Begin the recoil of a contact, or end it if its law releases at zero force, at
        the end of its last stretch.
        """
        if self.separates_at_zero_force(contact, self.state):
            self.dissipate_stored(contact, contact.delta)
            self.end_contact(contact)
        else:
            contact.pushes = False

    def dissipate_stored(self, contact: ActiveContact, delta: float | None = None) -> None:
        """Add the energy that a contact stores at release, or at an indentation [m], to
        the losses of the last accepted stretch.
        """
        last, held = (
            self.parts[-1],
            contact.stored_energy_at(contact.local.release_indentation if delta is None else delta),
        )
        if (
            held
            and isinstance(last.motion, VibratingStretch)
            and contact.number in last.motion.view.contacts
        ):
            place = last.motion.view.contacts.index(contact.number)
            self.parts[-1] = replace(last, motion=with_separation_loss(last.motion, place, held))
        self.lost[-1] += held

    def separates_at_zero_force(self, contact: ActiveContact, state: State) -> bool:
        """Whether a contact ends with its force: its law does, and the surfaces will
        separate; otherwise they close again.
        """
        if contact.local.law.contact_end != "zero-force":
            return False
        return bool(
            np.isfinite(
                time_to_separation(
                    FreeMotion(self.system, state), contact.local.release_level, contact.number
                )
            )
        )

    def stretch_ahead(
        self, pushing: list[ActiveContact], speed: float, energy: float, span: float
    ) -> StretchAhead:
        """Return the next stretch, of contacts of about a speed [m/s], an energy [J] and
        a duration [s].
        """
        manner = Manner(
            tension=NO_TENSION,  # each contact has its own
            contact_end=0,
            motion_speed=speed,
            energy=energy,
            span=span,
            tolerance=self.tolerance,
            begun=self.time,
            until=np.inf,
            longest=np.inf,
            most_steps=0,
        )
        view = contact_view(self.system, (contact.number for contact in pushing))
        begun = np.array([contact.delta for contact in pushing])
        trend = np.array([contact.trend for contact in pushing])
        return StretchAhead.of(
            view, [contact.local for contact in pushing], self.state, begun, trend, manner
        )

    def accept(self, pushing: list[ActiveContact], stretch: VibratingStretch) -> None:
        """Append a stretch to the history, and update the contacts at its end."""
        for place, (contact, history, trend) in enumerate(
            zip(pushing, stretch.contacts, stretch.trend.tolist(), strict=True)
        ):
            record_peaks(
                contact.impact,
                stretch,
                place,
                self.time,
                float(history.force.max()),
                stretch.indentations(place),
            )
            contact.impact.impulse += stretch.length * float(
                stretch.rule.integral[-1] @ history.force
            )
            contact.delta, contact.force, contact.trend = (
                float(history.delta[-1]),
                float(history.force[-1]),
                trend,
            )
            contact.fresh, contact.closing = (
                False,
                float(history.closing[-1]) if contact.local.law.memories() else np.inf,
            )
        end, lost = stretch.end, stretch.lost
        for contact in self.active.values():
            if not contact.pushes:  # recoiling contacts, which are not part of the stretch
                self.lost[-1] += float(
                    coasting_loss(self.system, contact.number, contact.local, self.state, end)
                )
        self.append_motion(stretch, end, lost)
        stretch.keep()

    def append_motion(
        self, motion: VibratingStretch | FreePhase, state: State, lost: Floats
    ) -> None:
        """Append a motion to the history, and advance to its end."""
        self.parts.append(MotionPart(self.time, motion))
        self.lost += lost
        self.time, self.state = self.time + motion.length, state

    # events of contacts that are not part of a stretch
    # -----------------------------------------------

    def first_other_event(self, stretch: VibratingStretch) -> OtherEvent | None:
        """Return the first touch, or end of a recoil, of another contact within a
        stretch; or None.
        """
        others = [
            number for number in range(len(self.definitions)) if number not in stretch.view.contacts
        ]
        if not others:
            return None
        states = stretch.state(stretch.length * stretch.rule.map_time(GRID))
        slack = _TOUCH_SLACK * max(float(history.delta.max()) for history in stretch.contacts)
        possible = [
            event
            for number in others
            if number in self.active
            for event in self.ends_of_coasting(self.active[number])
        ]
        possible += self.touches_within(
            states, [number for number in others if number not in self.active], slack, stretch.start
        )
        seen = [
            replace(other, x=x)
            for other in possible
            if (x := first_crossing(other.value(states))) is not None
        ]
        return min(seen, key=lambda other: other.x, default=None)

    def ends_of_coasting(self, contact: ActiveContact) -> list[OtherEvent]:
        """Return the two ways in which the recoil of a contact may end: its surfaces
        part, or its law pushes again.
        """
        return [
            OtherEvent(
                partial(coasting_end_value, self.system, contact, kind),
                partial(self.end_coasting, contact, parts=kind == 0),
            )
            for kind in (0, 1)
        ]

    def touches_within(
        self, states: State, apart: list[int], slack: float, start: State
    ) -> list[OtherEvent]:
        """Return the touches of surfaces that are apart at the start of some states in order, and
        overlap by more than a slack [m] later.

        Of many contacts few come that near, so that all are looked at together first.
        """
        approaches = self.system.approach(states)[:, apart]
        levels = np.array([float(self.next_laws[number].touch_level) for number in apart])
        touches = [
            OtherEvent(
                partial(self.overlap_beyond, number, slack),
                partial(self.begin_contacts, number, slack, start),
            )
            for number in np.array(apart)[(approaches > levels + slack).any(axis=0)].tolist()
        ]
        for number in apart:
            if dent := self.dents.get(number):
                touches.append(
                    OtherEvent(
                        partial(self.overlap_beyond, number, slack, law=dent),
                        partial(self.begin_contact, number, dent),
                    )
                )
        return touches

    def overlap_beyond(
        self, number: int, slack: float, states: State, law: CompliantLaw | None = None
    ) -> Floats:
        """Return the overlap of surfaces beyond a slack [m], under the next law, or
        beyond the dent of another.
        """
        level = self.next_laws[number].touch_level if law is None else law.release_level
        return np.asarray(self.system.approach(states)[..., number] - float(level) - slack)

    def begin_contacts(self, number: int, slack: float, before: State) -> None:
        """Begin an impact at a contact, and at all others that overlap by half a slack
        [m] and did not before.
        """
        self.begin_contact(number)
        for other in range(len(self.definitions)):
            apart = (
                other not in self.active and float(self.overlap_beyond(other, slack, before)) <= 0.0
            )
            if apart and float(self.overlap_beyond(other, 0.5 * slack, self.state)) > 0.0:
                self.begin_contact(other)
