"""How B drops of bodies that do not vibrate fly, meet and lie."""

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
"""How the bodies of drops move in a flight; none of those that do not vibrate."""


class RigidBodies:
    """The bodies of B drops, as rigid ones: a sphere falls on a plate that lies still; see `VibratingBodies` for those that vibrate.

    In methods `drops` says which of the run are meant, and the other arrays belong to these. `columns`: of the impact table. `left`: what
    those that rest or ride, and what carries them, hold above their equilibrium [J] (B,), NaN for the others. `lying`: how those lie that
    have come to rest.

    Parameters
    ----------
    size : int
        How many drops there are.
    solve_contact : SolvesContact
        What takes them through a contact.
    """

    left: Floats
    lying: list[RestMotion | None]

    def __init__(self, size: int, solve_contact: SolvesContact) -> None:
        self.columns = tuple(IMPACT_COLUMNS)
        self.solve_contact = solve_contact
        self.left, self.lying = np.full(size, np.nan), [None] * size

    def next_touch(self, drops: Drops, flight: Flight, law: ContactLaw) -> tuple[Floats, Floats, Motions]:
        """Return when the surfaces next meet [s], the speed at which the bodies do as rigid bodies [m/s], and their motions."""
        return *flight.touch(-law.touch_level if isinstance(law, CompliantLaw) else np.zeros(1)), ()

    def pass_flight(self, drops: Drops, motions: Motions, elapsed: Floats) -> None:
        """Let the bodies go through flights of some time [s]."""

    def closing_speed(self, drops: Drops, speed: Floats, velocity: Floats) -> Floats:
        """Return the speed at which the surfaces meet [m/s], from that of the rigid bodies, and the velocity of the spheres [m/s]."""
        return speed

    def rigid_speed(self, drops: Drops, velocity: Floats) -> Floats:
        """Return the speed at which the bodies part as rigid bodies [m/s], where the spheres have a velocity upwards [m/s]."""
        return velocity

    def collide(
        self, drops: Drops, encounter: Encounter, place: tuple[Floats, Floats], limits: tuple[Floats, Floats], row: dict[str, Floats]
    ) -> Coroutine[tuple[Contact, Floats, Floats]]:
        """Take drops through a contact; return it, the largest force [N], and when that is reached since first touch [s].

        Parameters
        ----------
        drops : array of int, shape (b,)
            Which drops of the run.
        encounter : Encounter
            Their impact.
        place : tuple of two arrays, shape (b,)
            Gaps [m] and velocities upwards [m/s] at first touch.
        limits : tuple of two arrays, shape (b,)
            Below what speed a sphere that leaves rests [m/s], and how long a ride is followed for [s since first touch].
        row : dict of str to array
            The row of the impact, which gets what only bodies that vibrate have.
        """
        yield from ()
        return self.solve_contact(encounter, drops)

    def falls_back(self, contact: Contact, law: CompliantLaw, gravity: Floats) -> Bools:
        """Tell which drops fall back into the indentation they have left, before a next touch under a law would be a new one."""
        overlap = np.maximum(contact.final_delta - law.touch_level, 0.0)
        return np.asarray((contact.outcome != FAILED) & (contact.final_rate**2 < 2.0 * gravity * overlap))

    def rests(self, drops: Drops, velocity: Floats, rest_speed: Floats) -> Bools:
        """Tell which drops that have left at a velocity upwards [m/s] are at rest."""
        return np.asarray((velocity < rest_speed) | (velocity == 0.0))

    def laid(self, drops: Drops, law: ContactLaw, weight: Floats, energy: Floats) -> dict[str, Floats]:
        """Return how drops lie under their weight [N] that had an energy [J]: `sag` [m], `stored` and `written_off` [J]."""
        sag = stored = np.zeros(len(drops))
        if isinstance(law, CompliantLaw):
            sag = static_indentation(law, weight)
            stored = law.elastic_energy(sag)
        return {"sag": sag, "stored": stored, "written_off": energy - (stored - weight * sag)}

    def follow(self, drops: Drops, elapsed: Floats, sag: Floats, stored: Floats) -> tuple[Floats, Floats, Floats]:
        """Let drops lie for some time [s]; return their gaps [m], velocities upwards [m/s] and what the contacts hold then [J]."""
        return -sag, np.zeros(len(drops)), stored

    def energies(self) -> dict[str, Floats]:
        """Return further entries of the ledger [J], (B,); `local_J` and `local_damping_J` belong to those of the contact."""
        return {}

    def growth(self, leg: Leg) -> Coroutine[Floats]:
        """Return how a relative change of the drop has grown by the impact of a leg [-], one value a drop of its contact; or none."""
        yield from ()
        return np.zeros(0)
