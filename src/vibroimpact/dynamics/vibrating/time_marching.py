"""Time marching of a linear system through its contacts.

Flights are known in closed form: while no contact pushes, the march advances to the next touch.
Otherwise it advances by stretches of contact of adaptive length. Each is searched for its first
event: separation, zero force of a law that may not pull, a breakpoint of a law, a turn of an
approach, or a touch at another contact. The stretch is then solved again so that it ends there.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.contact.law import CompliantLaw
from vibroimpact.dynamics.core.contact_records import Attempt, Manner
from vibroimpact.dynamics.core.events import NO_EVENT, NO_PUSH, NO_TENSION, PARTED, TURN
from vibroimpact.dynamics.core.records import Event
from vibroimpact.dynamics.motion.impact_conditions import undamped_depths
from vibroimpact.dynamics.vibrating.active_contact import (
    ActiveContact,
    ContactDefinition,
    Impact,
    closing_speed,
    motion_speed,
    record_peaks,
)
from vibroimpact.dynamics.vibrating.contact_view import contact_view
from vibroimpact.dynamics.vibrating.events import (
    PUSHES,
    SEPARATES,
    ZERO_RATE,
    OtherEvent,
    coasting_end_value,
    end_of_coasting,
    first_crossing,
)
from vibroimpact.dynamics.vibrating.free_motion import FreePhase, coasting_loss
from vibroimpact.dynamics.vibrating.linear_system import FreeMotion, LinearSystem, State
from vibroimpact.dynamics.vibrating.local import LocalContact
from vibroimpact.dynamics.vibrating.next_touch import (
    next_touch,
    time_to_separation,
    times_apart,
)
from vibroimpact.dynamics.vibrating.radau_eigenbasis import GRID
from vibroimpact.dynamics.vibrating.solve_stretch import StretchAhead
from vibroimpact.dynamics.vibrating.stretch import VibratingStretch
from vibroimpact.dynamics.vibrating.stretch_end import (
    length_growth,
    solve_to_zero,
    time_of_zero,
    with_separation_loss,
)
from vibroimpact.errors import ComputationError

_FIRST_LENGTH = 0.125  # of the duration of a contact: length of the first stretch
# of the deepest indentation: a smaller overlap is no touch while other contacts push
_TOUCH_SLACK = 1e-12
_MOST_STRETCHES = 200_000
_ROUNDING = 1e-14  # of the deepest indentation
_NO_FORCE = 1e-10  # of the largest force
_NEAR_TOUCH = 1e-3  # of the way in a stretch: surfaces that come so near are looked at closely
_FASTER_BETWEEN = 4.0  # of the largest speed at a node: bound of that between the nodes


@dataclass(frozen=True)
class MotionPart:
    """A part of the history of a march: its start [s] and its motion."""

    start: float
    motion: VibratingStretch | FreePhase


class NotIntegrable(ComputationError):
    """A contact can't be integrated to the tolerance."""


class TimeMarching:
    """Time marching of a system through its contacts.

    `time` [s], `state`: current ones. `next_length`: of the next stretch [s]. `active`: contacts
    whose surfaces overlap, by number. `next_laws`: laws of the next impacts, with their memory;
    `touch_levels`: approaches at which they touch [m].
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
    """

    def __init__(
        self,
        system: LinearSystem,
        definitions: Sequence[ContactDefinition],
        state: State,
        tolerance: float,
    ) -> None:
        self.system = system
        self.definitions = definitions
        self.state = state
        self.tolerance = tolerance
        self.next_laws = [definition.law for definition in definitions]
        self.touch_levels = np.array([float(law.touch_level) for law in self.next_laws])
        self.time = 0.0
        self.next_length = np.inf
        self.active: dict[int, ActiveContact] = {}
        self.dents: dict[int, CompliantLaw] = {}
        self.parts: list[MotionPart] = []
        self.impacts: list[Impact] = []
        self.lost = np.zeros(system.number + 1)
        self.plastic = 0.0

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
        """Advance by one part of the history of at most a length [s].

        Return False if it has to be retried with a shorter stretch.
        """
        pushing = [contact for contact in self.active.values() if contact.pushes]
        if pushing:
            return self.step_contact(pushing, longest)
        self.step_free(longest)
        return True

    # without contact forces
    # -------------------------------------------------------------------------

    def step_free(self, longest: float) -> None:
        """Advance in free motion to the next touch, or to the end of a recoil."""
        free = FreeMotion(self.system, self.state)
        touches = self.first_touches(free, longest)
        length = min([longest, *(time for time, _ in touches.values())])
        recoil_end = end_of_coasting(free, list(self.active.values()), length)
        if recoil_end is not None:
            length, number, separates = recoil_end
            self.append_free(free, length)
            self.end_coasting(self.active[number], separates=separates)
            return
        self.append_free(free, length)
        for number in sorted(touches):
            time, law = touches[number]
            if time <= self.same_time(length):
                self.begin_contact(number, law)

    def same_time(self, length: float) -> float:
        """Return until when surfaces touch at the same time as after a length [s]."""
        return length + 1e-13 * (self.time + length)

    def first_touches(
        self, free: FreeMotion, longest: float
    ) -> dict[int, tuple[float, CompliantLaw]]:
        """Return when contacts next touch in free motion, and under which laws, by number.

        Those are left out that surely touch later than another, or than `longest` [s].
        """
        apart_until = times_apart(self.system, self.state, self.touch_levels)
        touches = {}
        for number in np.argsort(apart_until, kind="stable").tolist():
            # a bound that rounding may exceed
            if (1.0 - 1e-9) * apart_until[number] > self.same_time(longest):
                break
            if number not in self.active:
                touches[number] = self.next_touch(free, number, self.same_time(longest))
                longest = min(longest, touches[number][0])
        return touches

    def next_touch(
        self, free: FreeMotion, number: int, longest: float
    ) -> tuple[float, CompliantLaw]:
        """Return when a contact next touches in free motion [s from here], and under which law."""
        law = self.next_laws[number]
        dent = self.dents.get(number)
        if dent is not None:
            separation = time_to_separation(free, float(law.touch_level), number)
            touch = next_touch(free, float(dent.release_level), min(separation, longest), number)
            if touch < separation:  # they touch the dent before they have separated from it
                return touch, dent
        return next_touch(free, float(law.touch_level), longest, number), law

    def append_free(self, free: FreeMotion, length: float) -> None:
        """Append a free motion of a length [s] to the history."""
        recoiling = tuple((number, contact.local) for number, contact in self.active.items())
        motion = FreePhase(free, length, recoiling)
        state = free.state_after(length)
        self.append_motion(motion, state, motion.lost_at(state))

    def end_coasting(self, contact: ActiveContact, *, separates: bool) -> None:
        """End the recoil of a contact, which separates or pushes again."""
        if separates:
            self.end_contact(contact)
        else:
            contact.pushes = True
            contact.delta = contact.law_indentation(self.system, self.state)
            contact.trend = 0.0

    # from touch to release
    # --------------------------------------------------------------------------

    def begin_contact(self, number: int, law: CompliantLaw | None = None) -> ActiveContact:
        """Begin an impact at a contact, under its next law or a given one."""
        if law is None:
            law = self.next_laws[number]
        closing = closing_speed(self.system, self.state, number)
        other_speeds = [contact.impact.closing_speed for contact in self.active.values()]
        if other_speeds and closing < 1e-3 * max(other_speeds):
            # surfaces that touch almost without speed, pressed together by other contacts
            closing = max(other_speeds)
        impact = Impact(number, self.time, closing)
        self.impacts.append(impact)
        speed, span = self._scale(number, law, closing)
        self.dents.pop(number, None)
        contact = ActiveContact(
            number,
            LocalContact(law, self.definitions[number].series, closing),
            float(self.system.mass[number]),
            float(law.touch_level),
            speed,
            span,
            impact,
        )
        self.active[number] = contact
        contact.delta = contact.law_indentation(self.system, self.state)
        self.next_length = min(self.next_length, _FIRST_LENGTH * span)
        return contact

    def _scale(self, number: int, law: CompliantLaw, closing: float) -> tuple[float, float]:
        """Return the speed of the motion in a contact [m/s] and its approximate duration [s]."""
        mass = float(self.system.mass[number])
        speed = motion_speed(self.system, number, law, closing)
        energy = np.array([0.5 * mass * speed**2])
        depth = float(undamped_depths(law, energy, np.zeros(1))[0] - law.touch_level)
        return speed, 3.0 * depth / speed

    def end_contact(self, contact: ActiveContact) -> None:
        """End an impact.

        The law keeps its memory where it is lasting and the next impact falls on the same spot.
        """
        contact.impact.end = self.time
        definition = self.definitions[contact.number]
        if not definition.fresh_surface and definition.law.lasting:
            self.next_laws[contact.number] = contact.local.law
            self.touch_levels[contact.number] = float(contact.local.law.touch_level)
        elif float(contact.local.law.release_level) > float(definition.law.touch_level):
            self.dents[contact.number] = contact.local.law
        del self.active[contact.number]

    # under contact forces
    # ---------------------------------------------------------------------------

    def step_contact(self, pushing: list[ActiveContact], longest: float) -> bool:
        """Advance by one stretch of contact, up to its first event.

        Return False if it has to be retried with a shorter one.
        """
        if self.ends_at_once(pushing):
            return True
        span = min(contact.span for contact in pushing)
        if self.next_length < 1e-12 * span:
            raise NotIntegrable(
                f"the contact at {self.time:g} s can't be integrated to the tolerance"
            )
        ahead = self.stretch_ahead(pushing, span)
        time_map = 0 if any(contact.fresh for contact in pushing) else 1
        attempt = ahead.solve(time_map, min(self.next_length, longest))
        if not attempt.solved:
            self.next_length *= 0.5
            return False
        balance = ahead.balance(attempt, time_map)
        stretch = ahead.stretch(attempt, balance, time_map)
        other = self.first_other_event(stretch)
        # an event of the pushing contacts: also tried if the stretch is not resolved, as the event
        # may be the only reason
        event = attempt.event
        if event.kind != NO_EVENT and (other is None or event.x <= other.x):
            # short of the event if the stretch is resolved; otherwise the event is not certain
            near = max(event.x, GRID[1]) if balance.resolved else 1.0
            return self.step_to_event(pushing, ahead, attempt, time_map, stretch.time_at(near))
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

    def ends_at_once(self, pushing: list[ActiveContact]) -> bool:
        """Treat events at the end of the last stretch; return whether one ends a contact.

        Another contact has ended that stretch, or it ends within rounding of its event.
        """
        for contact in pushing:
            if contact.fresh:
                continue
            overlap = contact.overlap(self.system, self.state)
            rate = float(self.system.rate_at(self.state, contact.number))
            if overlap <= _ROUNDING * contact.impact.indentation.nodal_max and rate < 0.0:
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
            turned = contact.closing <= ZERO_RATE * contact.speed
            if turned and contact.local.updates_memory(contact.delta):
                self.update_memory(contact)
        return False

    def step_to_event(
        self,
        pushing: list[ActiveContact],
        ahead: StretchAhead,
        attempt: Attempt,
        time_map: int,
        near: float,
    ) -> bool:
        """Advance by a stretch that ends at an event of the pushing contacts.

        `attempt`: the stretch beyond the event. `near`: about the length up to the event [s].
        Return False if it has to be retried with a shorter one.
        """
        success, solved, time_map_to_event, event = ahead.up_to_event(attempt, time_map)
        balance = ahead.balance(solved, time_map_to_event)
        if not (success and balance.resolved):
            self.next_length = 0.5 * min(self.next_length, near)
            return False
        stretch = ahead.stretch(solved, balance, time_map_to_event)
        missed = self.first_other_event(stretch)
        # an event at another contact lies between the estimate and the solved event
        if missed is not None:
            self.next_length = 0.5 * stretch.time_at(missed.x)
            return False
        self.end(pushing, event, stretch)
        return True

    def end(self, pushing: list[ActiveContact], event: Event, stretch: VibratingStretch) -> None:
        """Accept a stretch that ends with an event of one of its contacts."""
        contact = pushing[event.contact]
        separates = event.kind == PARTED or (
            event.kind == NO_PUSH and self.separates_at_zero_force(contact, stretch.end)
        )
        # stored energy is lost where a sticking contact breaks, or where the surface recovers more
        # slowly than the bodies part
        if separates:
            delta = float(stretch.contacts[event.contact].delta[-1])
            stretch = with_separation_loss(stretch, event.contact, contact.stored_energy_at(delta))
        self.accept(pushing, stretch)
        if separates:
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
        """Begin the recoil of a contact, or end it if its law releases at zero force.

        It is at the end of its last stretch.
        """
        if self.separates_at_zero_force(contact, self.state):
            self.dissipate_stored(contact, contact.delta)
            self.end_contact(contact)
        else:
            contact.pushes = False

    def dissipate_stored(self, contact: ActiveContact, delta: float | None = None) -> None:
        """Add the energy that a contact stores to the losses of the last accepted stretch.

        It is that at release, or at an indentation [m].
        """
        if delta is None:
            delta = contact.local.release_indentation
        stored = contact.stored_energy_at(delta)
        last = self.parts[-1]
        if (
            stored
            and isinstance(last.motion, VibratingStretch)
            and contact.number in last.motion.view.contacts
        ):
            index = last.motion.view.contacts.index(contact.number)
            self.parts[-1] = replace(last, motion=with_separation_loss(last.motion, index, stored))
        self.lost[-1] += stored

    def separates_at_zero_force(self, contact: ActiveContact, state: State) -> bool:
        """Whether a contact ends with its force: its law does, and the surfaces will separate.

        Otherwise they close again.
        """
        if contact.local.law.contact_end != "zero-force":
            return False
        free = FreeMotion(self.system, state)
        separation = time_to_separation(free, contact.local.release_level, contact.number)
        return bool(np.isfinite(separation))

    def stretch_ahead(self, pushing: list[ActiveContact], span: float) -> StretchAhead:
        """Return the next stretch, of contacts of about a duration [s]."""
        manner = Manner(
            tension=NO_TENSION,  # each contact has its own
            contact_end=0,
            motion_speed=max(contact.speed for contact in self.active.values()),
            energy=max(contact.energy for contact in pushing),
            span=span,
            tolerance=self.tolerance,
            begun=self.time,
            until=np.inf,
            longest=np.inf,
            most_steps=0,
        )
        view = contact_view(self.system, (contact.number for contact in pushing))
        indentations = np.array([contact.delta for contact in pushing])
        trend = np.array([contact.trend for contact in pushing])
        return StretchAhead.of(
            view, [contact.local for contact in pushing], self.state, indentations, trend, manner
        )

    def accept(self, pushing: list[ActiveContact], stretch: VibratingStretch) -> None:
        """Append a stretch to the history, and update the contacts at its end."""
        for index, (contact, history, trend) in enumerate(
            zip(pushing, stretch.contacts, stretch.trend.tolist(), strict=True)
        ):
            record_peaks(
                contact.impact,
                stretch,
                index,
                self.time,
                float(history.force.max()),
                stretch.indentations(index),
            )
            mean_force = float(stretch.rule.integral[-1] @ history.force)
            contact.impact.impulse += stretch.length * mean_force
            contact.delta = float(history.delta[-1])
            contact.force = float(history.force[-1])
            contact.trend = trend
            contact.fresh = False
            contact.closing = float(history.closing[-1]) if contact.local.law.memories() else np.inf
        end = stretch.end
        lost = stretch.lost
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
        self.time += motion.length
        self.state = state

    # events of contacts that are not part of a stretch
    # -----------------------------------------------

    def first_other_event(self, stretch: VibratingStretch) -> OtherEvent | None:
        """Return the first event of another contact within a stretch, or None.

        It is a touch, or the end of a recoil.
        """
        recoiling = [number for number in self.active if number not in stretch.view.contacts]
        apart = self.may_touch(stretch)
        if not (recoiling or apart):
            return None
        states = stretch.state(stretch.length * stretch.rule.map_time(GRID))
        slack = _TOUCH_SLACK * max(float(history.delta.max()) for history in stretch.contacts)
        possible: list[OtherEvent] = []
        for number in recoiling:
            possible += self.ends_of_coasting(self.active[number])
        possible += self.touches_within(states, apart, slack, stretch.start)
        events = []
        for event in possible:
            x = first_crossing(event.value(states))
            if x is not None:
                events.append(replace(event, x=x))
        first = min((event.x for event in events), default=np.inf)
        together = [event for event in events if event.x == first]  # met between two grid points
        if len(together) <= 1:
            return together[0] if together else None
        return min(together, key=lambda event: time_of_zero(stretch, event.value, event.x))

    def may_touch(self, stretch: VibratingStretch) -> list[int]:
        """Return the contacts that are not closed and may touch within a stretch.

        No coordinate moves by more than its largest speed times the length, and between the nodes
        the speed stays below a few times that at them. There are no massless elements in systems.
        """
        fastest = np.abs(stretch.velocities).max(axis=0)
        fastest = np.maximum(fastest, np.abs(stretch.start.velocity))
        reach = _FASTER_BETWEEN * stretch.length * (np.abs(self.system.shape) @ fastest)
        at_start = self.system.approach(stretch.start)
        near = np.flatnonzero(at_start + reach > self.touch_levels)
        # of these, those that come so near in the polynomials through the nodes
        rates = stretch.velocities @ self.system.shape[near].T
        at_nodes = at_start[near] + stretch.length * (stretch.rule.integral @ rates)
        between = stretch.basis.basis.grid @ np.concatenate([at_start[near][None], at_nodes])
        slack = _NEAR_TOUCH * reach[near]
        touching = near[(between + slack > self.touch_levels[near]).any(axis=0)]
        return [
            number
            for number in sorted({*touching.tolist(), *self.dents})
            if number not in self.active
        ]

    def ends_of_coasting(self, contact: ActiveContact) -> list[OtherEvent]:
        """Return the two ways in which the recoil of a contact may end."""
        return [
            OtherEvent(
                partial(coasting_end_value, self.system, contact, end),
                partial(self.end_coasting, contact, separates=end == SEPARATES),
            )
            for end in (SEPARATES, PUSHES)
        ]

    def touches_within(
        self, states: State, apart: list[int], slack: float, start: State
    ) -> list[OtherEvent]:
        """Return the touches of surfaces that are apart at the start of some states in order.

        They overlap by more than a slack [m] later. Of many contacts few come that near, so that
        all are looked at together first.
        """
        approaches = self.system.approach(states)[:, apart]
        touching = np.array(apart)[(approaches > self.touch_levels[apart] + slack).any(axis=0)]
        touches = [
            OtherEvent(
                partial(self.overlap_beyond, number, slack),
                partial(self.begin_contacts, number, slack, start),
            )
            for number in touching.tolist()
        ]
        for number in apart:
            dent = self.dents.get(number)
            if dent:
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
        """Return the overlap of surfaces beyond a slack [m].

        It is that under the next law, or with the dent that another law has left.
        """
        level = self.next_laws[number].touch_level if law is None else law.release_level
        return self.system.approach_at(states, number) - float(level) - slack

    def begin_contacts(self, number: int, slack: float, start: State) -> None:
        """Begin an impact at a contact, and at all others that touch with it.

        They overlap by half a slack [m], and did not at the start.
        """
        self.begin_contact(number)
        levels = self.touch_levels
        were_apart = self.system.approach(start) - levels <= slack
        overlap = self.system.approach(self.state) - levels > 0.5 * slack
        for other in np.flatnonzero(were_apart & overlap).tolist():
            if other not in self.active:
                self.begin_contact(other)
