"""Free flight, contact and rest of B drops whose bodies do not vibrate."""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Bools, Drops, Floats
from vibroimpact.contact.law import CompliantLaw, ContactLaw
from vibroimpact.contact.static import static_indentation
from vibroimpact.dynamics.columns import IMPACT_COLUMNS
from vibroimpact.dynamics.contact import FAILED, Contact
from vibroimpact.dynamics.encounter import Encounter
from vibroimpact.dynamics.flight import Flight
from vibroimpact.dynamics.leg import Leg
from vibroimpact.dynamics.lockstep import Coroutine
from vibroimpact.dynamics.rigid.solve_contact import SolvesContact
from vibroimpact.dynamics.vibrating.linear_system import FreeMotion
from vibroimpact.dynamics.vibrating.rest_motion import RestMotion

Motions = tuple[FreeMotion, ...]
"""Free motions of the bodies of each drop in a flight; empty for bodies that do not vibrate."""


class RigidBodies:
    """Rigid bodies of B drops: a sphere falls on a plate at rest; `VibratingBodies` has the same methods for bodies that vibrate.

    In the methods `drops` are indices of drops of the run, and the other arrays have one entry for each of them. `columns`: of the impact
    table. `left`: mechanical energy above equilibrium of drops at rest or riding, and of what carries them [J] (B,), NaN for the others.
    `lying`: the states of those at rest.

    Parameters
    ----------
    size : int
        Number of drops.
    solve_contact : SolvesContact
        Solver of their contacts.
    """

    left: Floats
    lying: list[RestMotion | None]

    def __init__(self, size: int, solve_contact: SolvesContact) -> None:
        self.columns = tuple(IMPACT_COLUMNS)
        self.solve_contact = solve_contact
        self.left, self.lying = np.full(size, np.nan), [None] * size

    def next_touch(self, drops: Drops, flight: Flight, law: ContactLaw) -> tuple[Floats, Floats, Motions]:
        """Return the time of the next touch [s], the approach speed of the rigid bodies [m/s], and the free motions until then."""
        return *flight.touch(-law.touch_level if isinstance(law, CompliantLaw) else np.zeros(1)), ()

    def pass_flight(self, drops: Drops, motions: Motions, elapsed: Floats) -> None:
        """Advance the state of the bodies through a flight of a given duration [s]."""

    def closing_speed(self, drops: Drops, speed: Floats, velocity: Floats) -> Floats:
        """Return the closing speed of the surfaces [m/s], from that of the rigid bodies and the velocity of the spheres [m/s]."""
        return speed

    def rigid_speed(self, drops: Drops, velocity: Floats) -> Floats:
        """Return the separation speed of the rigid bodies [m/s], from the upward velocity of the spheres [m/s]."""
        return velocity

    def collide(
        self, drops: Drops, encounter: Encounter, place: tuple[Floats, Floats], limits: tuple[Floats, Floats], row: dict[str, Floats]
    ) -> Coroutine[tuple[Contact, Floats, Floats]]:
        """Return the contact of drops, its largest force [N], and the time of that since first touch [s].

        Parameters
        ----------
        drops : array of int, shape (b,)
            Indices in the run.
        encounter : Encounter
            Their impact.
        place : tuple of two arrays, shape (b,)
            Gaps [m] and velocities upwards [m/s] at first touch.
        limits : tuple of two arrays, shape (b,)
            Rest speed [m/s], and the longest time for which a ride is followed, since first touch [s].
        row : dict of str to array
            The row of the impact table, into which further columns of bodies that vibrate are written.
        """
        yield from ()
        return self.solve_contact(encounter, drops)

    def falls_back(self, contact: Contact, law: CompliantLaw, gravity: Floats) -> Bools:
        """Return which drops fall back into the indentation before they have risen to the touch level of the law."""
        overlap = np.maximum(contact.final_delta - law.touch_level, 0.0)
        return np.asarray((contact.outcome != FAILED) & (contact.final_rate**2 < 2.0 * gravity * overlap))

    def rests(self, drops: Drops, velocity: Floats, rest_speed: Floats) -> Bools:
        """Return which drops that separate with an upward velocity [m/s] count as at rest."""
        return np.asarray((velocity < rest_speed) | (velocity == 0.0))

    def static_state(self, drops: Drops, law: ContactLaw, weight: Floats, energy: Floats) -> dict[str, Floats]:
        """Return the static state of drops: `sag` [m], `stored` energy [J], and `written_off`, the rest of their `energy` [J]."""
        sag = stored = np.zeros(len(drops))
        if isinstance(law, CompliantLaw):
            sag = static_indentation(law, weight)
            stored = law.elastic_energy(sag)
        return {"sag": sag, "stored": stored, "written_off": energy - (stored - weight * sag)}

    def follow(self, drops: Drops, elapsed: Floats, sag: Floats, stored: Floats) -> tuple[Floats, Floats, Floats]:
        """Return gap [m], upward velocity [m/s] and energy stored in the contact [J] of drops that have lain for some time [s]."""
        return -sag, np.zeros(len(drops)), stored

    def energies(self) -> dict[str, Floats]:
        """Return further entries of the energy ledger [J] (B,); `local_J` and `local_damping_J` are added to those of the contact."""
        return {}

    def growth(self, leg: Leg) -> Coroutine[Floats]:
        """Return the growth of a small relative change of the drop up to the contact of a leg [-], one value per drop; or nothing."""
        yield from ()
        return np.zeros(0)
