"""The motion along the plate and the spin of the drops of a run, through flights and contacts."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from vibroimpact.arrays import Bools, Drops, Floats
from vibroimpact.contact.friction.law import CompliantFriction, FrictionLaw, ImpulsiveFriction
from vibroimpact.dynamics.columns import OBLIQUE_IMPACT_COLUMNS
from vibroimpact.dynamics.flight import Flight
from vibroimpact.dynamics.oblique.normal_motion import NormalMotion
from vibroimpact.dynamics.oblique.resisted_contact import ResistedContact, resisted_contact
from vibroimpact.dynamics.oblique.rolling import ACROSS, LyingSpheres
from vibroimpact.dynamics.oblique.sliding import slide
from vibroimpact.dynamics.oblique.state import (
    ContactAlong,
    ImpulseAlong,
    ObliqueContact,
    ObliqueContacts,
    Sliding,
    Sphere,
    State,
    energy_taken,
)
from vibroimpact.dynamics.oblique.statement import Oblique
from vibroimpact.dynamics.oblique.twisting import slowed_spins
from vibroimpact.dynamics.shaken.statement import PlateMotion

_PARTS = 8  # of a step for twisting, whose moment grows steeply where a slip ends

# of each phase of a contact at the default tolerance: the slip velocity at its end is within 2e-4
# of that at first touch
_STEPS = 16
_DEFAULT_TOLERANCE = 1e-9
_ORDER = 4  # of the error, in the steps
_ROUNDING = 1e-9


def friction_steps(tolerance: float) -> int:
    """Return the number of steps of friction in each phase of a contact."""
    finer: float = (_DEFAULT_TOLERANCE / tolerance) ** (1.0 / _ORDER)
    return _STEPS * max(math.ceil(finer - _ROUNDING), 1)


class ObliqueMotion:
    """Places, velocities along the plate and spins of the B drops of a run.

    Parameters
    ----------
    oblique : Oblique
        What the drops have at the start.
    mass, radius, inertia : array, shape (B,)
        Of the spheres [kg], [m], [kg m^2].
    motion : PlateMotion or None
        Of the plate.
    """

    def __init__(
        self,
        oblique: Oblique,
        mass: Floats,
        radius: Floats,
        inertia: Floats,
        motion: PlateMotion | None,
    ) -> None:
        def spread(values: Any) -> Floats:
            return np.array(
                [np.broadcast_to(np.asarray(value, dtype=float), mass.shape) for value in values]
            )

        self.sphere = Sphere(mass, radius, inertia, spread(oblique.gravity))
        self.state = State(spread(oblique.position), spread(oblique.velocity), spread(oblique.spin))
        self.start, self.half = (
            self.state.position,
            None if oblique.size is None else 0.5 * np.array(oblique.size)[:, None],
        )
        self.law, self.lost, self.microslip = (
            oblique.friction,
            np.zeros(len(mass)),
            np.zeros(len(mass)),
        )
        self.motion = motion

    def fly(self, drops: Drops, flight: Flight, time: Floats) -> None:
        """Advance drops through their flights up to a time [s]."""
        self._put(drops, self._flown(drops, flight, time))

    def _flown(self, drops: Drops, flight: Flight, time: Floats) -> State:
        return flight.carry(self.sphere.take(drops), self.state.take(drops), time)

    def pulled(self, drops: Drops) -> tuple[Floats, Floats]:
        """Return the velocities of drops along the plate [m/s], and the accelerations of
        gravity along it [m/s^2], (2, B).
        """
        return self.state.velocity[:, drops], self.sphere.gravity[:, drops]

    def now(self, drops: Drops) -> tuple[Sphere, State]:
        """Return spheres and state of drops."""
        return self.sphere.take(drops), self.state.take(drops)

    def lie(self, drops: Drops, pressing: Floats, elapsed: Floats) -> Floats:
        """Let drops lie on the plate for a time [s], at most until they leave it, and return that
        time.

        `pressing`: gravity along the normal [m/s^2].
        """
        sphere, before = self.sphere.take(drops), self.state.take(drops)
        law = None if self.law is None else self.law.take(drops)
        lying = LyingSpheres(sphere, before, law, pressing, elapsed)
        if self.half is not None:
            elapsed = lying.edge_time(self.half)
        after, _ = lying.at(np.arange(len(drops)), elapsed)
        self.lost[drops] += energy_taken(sphere, before, after)
        self._put(drops, after)
        return elapsed

    def distance(self, drops: Drops, flight: Flight, time: Floats) -> Floats:
        """Return how far drops move along the plate in their flights up to a time [m]."""
        with np.errstate(invalid="ignore"):
            moved = self._over_plate(drops, flight, time) - self._over_plate(
                drops, flight, flight.start
            )
        return np.asarray(np.nan_to_num(np.hypot(*moved)))

    def _over_plate(self, drops: Drops, flight: Flight, time: Floats) -> Floats:
        """Return the places of drops at times of their flights [s], seen from the plate
        [m] (2, b).
        """
        return self._from_plate(self._flown(drops, flight, time).position, time)

    def _from_plate(self, place: Floats, time: Floats) -> Floats:
        """Return places at some times [s], seen from the plate, whose supports may move
        along it [m] (2, b).
        """
        return (
            place
            if self.motion is None
            else place - np.outer(self.motion.direction[:2], self.motion.at(time)[0])
        )

    def seen_from_plate(self, drops: Drops, time: Floats) -> Floats:
        """Return the places of drops now, at some times [s], seen from the plate [m] (2, b)."""
        return self._from_plate(self.state.position[:, drops], time)

    def place_on_plate(self, drops: Drops, flight: Flight, time: Floats) -> Floats:
        """Return the places of drops at times of their flights [s], or the nearest ones
        on the plate [m] (2, b).
        """
        with np.errstate(invalid="ignore"):
            place = np.nan_to_num(self._over_plate(drops, flight, time))
        return place if self.half is None else np.clip(place, -self.half, self.half)

    def beside(self, drops: Drops, flight: Flight, time: Floats) -> Bools:
        """Return which drops will be beside the plate at a time of their flights [s]."""
        if self.half is None:
            return np.zeros(len(drops), dtype=bool)
        with np.errstate(invalid="ignore"):
            place = self._over_plate(drops, flight, time)
        return np.asarray(np.isfinite(time) & (np.abs(place) > self.half).any(axis=0))

    def collide(
        self, drops: Drops, motions: Sequence[tuple[Drops, NormalMotion]], row: dict[str, Floats]
    ) -> ObliqueContacts:
        """Advance drops through a contact, write its columns, and return the motion in it.

        `motions`: normal motions of groups of the drops, with their places among these.
        """
        found: list[tuple[Drops, ContactAlong]] = []
        for places, normal in motions:
            resisted = self._resists_rolling(drops[places])
            for one in np.flatnonzero(resisted).tolist():
                place = places[one : one + 1]
                found.append((place, self._march(drops[place], normal.take(np.array([one])), row)))
            free = np.flatnonzero(~resisted)
            if free.size:
                motion = normal.take(free) if resisted.any() else normal
                found.append((places[free], self._collide(drops[places[free]], motion, row)))
        return tuple(found)

    def _resists_rolling(self, drops: Drops) -> Bools:
        """Return of which drops rolling is resisted while friction is elastic, so that
        both have to be followed together.
        """
        if not isinstance(self.law, CompliantFriction):
            return np.zeros(len(drops), dtype=bool)
        return np.broadcast_to(self.law.rolling_coefficient, self.lost.shape)[drops] > 0.0

    def _march(self, drops: Drops, normal: NormalMotion, row: dict[str, Floats]) -> ResistedContact:
        assert isinstance(self.law, CompliantFriction)
        sphere, before = self.now(drops)
        contact = resisted_contact(self.law.take(int(drops[0])), normal, sphere, before)
        self.finish(
            drops, contact.end, energy_taken(sphere, before, contact.end), contact.microslip, row
        )
        return contact

    def _collide(
        self, drops: Drops, normal: NormalMotion, row: dict[str, Floats]
    ) -> ObliqueContact:
        sphere, before = self.sphere.take(drops), self.state.take(drops)
        law = self.law if self.law is None or len(drops) == len(self.lost) else self.law.take(drops)
        direction, slip, pull = _along(sphere, before)
        sliding = slide(law, normal, slip, sphere.tangential_mass, pull)
        contact = ObliqueContact(
            sphere, before, direction, sliding, _twist(law, normal, sliding, sphere, before)
        )
        contact = contact.changed(_across(sphere, contact))
        rubbed = sphere.tangential_mass * np.abs(sliding.slip[-1] - slip - pull * normal.time[-1])
        contact = contact.changed(_rolling(law, sphere, contact.end, normal.impulse[-1], rubbed))
        after = contact.end
        self.finish(drops, after, energy_taken(sphere, before, after), sliding.microslip, row)
        return contact

    def collide_at_once(
        self, drops: Drops, time: Floats, impulse: Floats, row: dict[str, Floats]
    ) -> tuple[ObliqueContacts, Floats]:
        """Let a normal impulse without duration act on drops at some times [N s], [s], and write
        its columns.

        Return the contacts, and the plate's work [J]: that of friction on the spheres, as the plate
        moves along itself.
        """
        sphere, start = self.sphere.take(drops), self.state.take(drops)
        surface = (
            0.0
            if self.motion is None
            else np.outer(self.motion.direction[:2], self.motion.at(time)[1])
        )
        before = replace(start, velocity=start.velocity - surface)  # seen from the plate
        direction, slip, _ = _along(sphere, before)
        left = slip
        if isinstance(self.law, ImpulsiveFriction):
            left = self.law.take(drops).slip_after(slip, impulse, impulse, sphere.tangential_mass)
        after = sphere.pushed(before, sphere.tangential_mass * (left - slip) * direction)
        law, sliding = (
            None if self.law is None else self.law.take(drops),
            sphere.tangential_mass * np.abs(left - slip),
        )
        change = _rolling(law, sphere, after, impulse, sliding)
        after = after if change is None else after.changed(change)
        lost, after = (
            energy_taken(sphere, before, after),
            replace(after, velocity=after.velocity + surface),
        )
        self.finish(drops, after, lost, np.zeros(len(drops)), row)
        return ((np.arange(len(drops)), ImpulseAlong(after, lost)),), lost - energy_taken(
            sphere, start, after
        )

    def finish(
        self, drops: Drops, after: State, lost: Floats, microslip: Floats, row: dict[str, Floats]
    ) -> None:
        """Put drops into their states after a contact in which friction took an energy [J], and
        write its columns.

        `microslip`: the part of it that was lost while a part of the contact stuck [J].
        """
        before = self.state.take(drops)
        self.lost[drops] += lost
        self.microslip[drops] += microslip
        values = [*before.position, *before.velocity, *after.velocity, *before.spin, *after.spin]
        speed = np.hypot(*before.velocity)
        with np.errstate(divide="ignore", invalid="ignore"):
            onward = np.where(
                speed > 0.0,
                (before.velocity * after.velocity).sum(axis=0) / speed,
                np.hypot(*after.velocity),
            )
            ratio = np.where(speed > 0.0, onward / speed, np.nan)
        angle = np.degrees(np.arctan2(onward, row["separation_speed_m_s"][drops]))
        for name, value in zip(
            OBLIQUE_IMPACT_COLUMNS,
            [*values, ratio, angle, lost, microslip, lost - microslip],
            strict=True,
        ):
            row[name][drops] = value
        self._put(drops, after)

    def _put(self, drops: Drops, state: State) -> None:
        now = State(self.state.position.copy(), self.state.velocity.copy(), self.state.spin.copy())
        for name, values in vars(now).items():
            values[:, drops] = getattr(state, name)
        self.state = now

    def energies(self) -> tuple[Floats, Floats, Floats]:
        """Return the kinetic energies along the plate and of rotation, and the potential
        energy along the plate, zero at the start [J].
        """
        fallen = (self.sphere.gravity * (self.state.position - self.start)).sum(axis=0)
        return *self.sphere.kinetic(self.state), -self.sphere.mass * fallen

    def friction_parts(self) -> dict[str, Floats]:
        """Return the two parts of the energy that friction took so far [J]; see
        `FRICTION_PARTS`.
        """
        return {"microslip_J": self.microslip, "gross_slip_J": self.lost - self.microslip}


def _along(sphere: Sphere, state: State) -> tuple[Floats, Floats, Floats]:
    """Return the directions of slip (2, B), the slip speeds [m/s], and the accelerations of gravity
    along the directions [m/s^2].

    Where nothing slips the direction is that of gravity.
    """
    slip = sphere.slip(state)
    speed = np.hypot(*slip)
    ahead = np.where(speed > 0.0, slip, sphere.gravity)
    length = np.hypot(*ahead)
    with np.errstate(invalid="ignore"):
        direction = np.where(length > 0.0, ahead / length, np.array([[1.0], [0.0]]))
    return direction, speed, (sphere.gravity * direction).sum(axis=0)


def _across(sphere: Sphere, contact: ObliqueContact) -> State | None:
    """Return what friction changes across the direction of slip in contacts, where gravity pulls
    across it; None if it does nowhere.

    The slip across is small: friction Q against a slip s along the direction slows it at the rate Q
    / (m s), and holds it where s is over.
    """
    direction, sliding = contact.direction, contact.sliding
    along = (sphere.gravity * direction).sum(axis=0)
    across = sphere.gravity - along * direction
    if not (np.hypot(*across) > ACROSS * np.hypot(*sphere.gravity)).any():
        return None
    elapsed, slip = np.diff(sliding.time, axis=0), sliding.slip
    slowed = np.divide(
        slip[1:] - along * elapsed, slip[:-1], out=np.zeros_like(elapsed), where=slip[:-1] > 0.0
    )
    # what is left by the end of the slip that is there at a point
    left = np.cumprod(
        np.append(np.clip(slowed, 0.0, 1.0), np.ones_like(elapsed[:1]), axis=0)[::-1], axis=0
    )[::-1]
    lost = (elapsed * (0.5 * (left[1:] + left[:-1]) - 1.0)).sum(axis=0) * across
    still = np.zeros_like(direction)
    return sphere.pushed(
        State(still, still, np.zeros((3, still.shape[1]))), sphere.tangential_mass * lost
    )


def _twist(
    law: FrictionLaw | None, normal: NormalMotion, sliding: Sliding, sphere: Sphere, before: State
) -> Floats:
    """Return the change of the spin about the normal by twisting of the contact [rad/s]."""
    spin = before.spin[2]
    if law is None or not spin.any():
        return np.zeros_like(spin)
    moment = law.twisting_moment(normal.force)
    with np.errstate(divide="ignore", invalid="ignore"):
        growth = np.where(
            normal.force > 0.0, (4.0 / 3.0) * moment * normal.force_slope / normal.force, 0.0
        )
    slower = normal.integrals(moment, growth) / sphere.inertia
    known = (slower, normal.force, np.abs(sliding.force), np.abs(sliding.slip))
    left, _ = slowed_spins(law, spin, *(_between(one) for one in known))
    return np.asarray(np.sign(spin) * (left[-1] - left[0]))


def _between(values: Floats) -> Floats:
    """Return values at G points, and on straight lines at more between each two of them
    (`_PARTS` (G - 1) + 1, B).
    """
    share = np.arange(_PARTS)[:, None] / _PARTS
    between = values[:-1, None] + share * (values[1:] - values[:-1])[:, None]
    return np.concatenate([between.reshape(-1, values.shape[1]), values[-1:]])


def _rolling(
    law: FrictionLaw | None, sphere: Sphere, after: State, impulse: Floats, sliding: Floats
) -> State | None:
    """Return what rolling resistance changes in states after contacts; None if it does not act.

    Its moment acts at the end, against the spin that is left, with the whole normal impulse [N s].
    What the impulse of friction so far, `sliding` [N s], has left of friction keeps the sphere
    rolling, but where the contact point slips with the spin so fast that this made energy.
    """
    if law is None or not np.any(law.rolling_coefficient):
        return None
    share, turning = sphere.tangential_mass / sphere.mass, sphere.turning(after)
    speed, moment = np.hypot(*turning), law.rolling_coefficient * impulse
    along = np.divide(turning, speed, out=np.zeros_like(turning), where=speed > 0.0)
    slips = 2.0 * (1.0 - share) * (sphere.slip(after) * along).sum(axis=0) > speed
    held = np.where(
        slips,
        0.0,
        np.minimum((1.0 - share) * moment, np.maximum(law.coefficient * impulse - sliding, 0.0)),
    )
    turn = sphere.radius**2 / sphere.inertia
    slower = (moment - held) * turn
    part = np.divide(speed, slower, out=np.ones_like(speed), where=slower > speed)
    still = State(np.zeros_like(turning), np.zeros_like(turning), np.zeros_like(after.spin))
    return sphere.turned(sphere.pushed(still, part * held * along), -part * moment * turn * along)
