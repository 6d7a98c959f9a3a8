"""The interface of the bodies of a run: their flights, contacts and rest, for B drops at once."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol, TypeAlias

from vibroimpact.arrays import Bools, Drops, Floats
from vibroimpact.contact.law import CompliantLaw, ContactLaw
from vibroimpact.dynamics.bounce import Bounce
from vibroimpact.dynamics.contact import Contact
from vibroimpact.dynamics.flight import Flight
from vibroimpact.dynamics.impact_conditions import ImpactConditions
from vibroimpact.dynamics.oblique.oblique_motion import ObliqueMotion
from vibroimpact.dynamics.oblique.state import ObliqueContacts

if TYPE_CHECKING:  # a drop of rigid bodies does not load what vibrates
    from vibroimpact.dynamics.vibrating.linear_system import FreeMotion
    from vibroimpact.dynamics.vibrating.rest_motion import RestMotion

Motions: TypeAlias = "tuple[FreeMotion, ...]"
"""Free motions of the bodies of each drop in a flight; empty for bodies that do not vibrate."""


class Bodies(Protocol):
    """The bodies of B drops, rigid or vibrating.

    In the methods `drops` are indices of drops of the run, and the other arrays have one entry for
    each of them. `columns`: of the impact table. `remaining_energy`: mechanical energy above
    equilibrium of drops at rest or riding, and of what carries them [J] (B,), NaN for the others.
    `lying`: the motions of those at rest on what vibrates.
    """

    columns: tuple[str, ...]
    remaining_energy: Floats
    lying: list[RestMotion | None]

    def next_touch(
        self, drops: Drops, flight: Flight, law: ContactLaw
    ) -> tuple[Floats, Floats, Motions]:
        """Return the time of the next touch [s], the approach speed, and the motions until then.

        The speed is that of the rigid bodies [m/s]; the motions are those of the bodies without
        contact.
        """

    def pass_flight(self, drops: Drops, motions: Motions, elapsed: Floats) -> None:
        """Advance the state of the bodies through a flight of a given duration [s]."""

    def closing_speed(self, drops: Drops, speed: Floats, velocity: Floats) -> Floats:
        """Return the closing speed of the surfaces [m/s].

        `speed`: of the rigid bodies. `velocity`: of the spheres [m/s].
        """

    def rigid_speed(self, drops: Drops, velocity: Floats) -> Floats:
        """Return the separation speed of the rigid bodies [m/s].

        `velocity`: upwards, of the spheres [m/s].
        """

    def collide(
        self,
        drops: Drops,
        conditions: ImpactConditions,
        at_touch: tuple[Floats, Floats],
        limits: tuple[Floats, Floats],
        row: dict[str, Floats],
    ) -> tuple[Contact, Floats, Floats]:
        """Return the contact of drops, its largest force [N], and the time of that [s].

        The time is since first touch.

        Parameters
        ----------
        drops : array of int, shape (b,)
            Indices in the run.
        conditions : ImpactConditions
            Their impact.
        at_touch : tuple of two arrays, shape (b,)
            Gaps [m] and velocities upwards [m/s] at first touch.
        limits : tuple of two arrays, shape (b,)
            Rest speed [m/s], and the longest time for which a ride is followed, since first touch
            [s].
        row : dict of str to array
            The row of the impact table, into which further columns of bodies that vibrate are
            written.
        """

    def slide(
        self, oblique: ObliqueMotion, bounce: Bounce, row: dict[str, Floats]
    ) -> ObliqueContacts:
        """Advance drops along the plate through the contacts of a bounce.

        Write their columns, and return the motion in them.
        """

    def falls_back(self, contact: Contact, law: CompliantLaw, gravity: Floats) -> Bools:
        """Return which drops fall back into the indentation.

        They do before they have risen to the touch level of the law.
        """

    def rests(self, drops: Drops, velocity: Floats, rest_speed: Floats) -> Bools:
        """Return which drops that separate with an upward velocity [m/s] count as at rest."""

    def static_state(
        self, drops: Drops, law: ContactLaw, weight: Floats, energy: Floats
    ) -> dict[str, Floats]:
        """Return the static state of drops.

        It consists of `sag` [m], `stored` energy [J], and `written_off`, the rest of their `energy`
        [J].
        """

    def follow(
        self, drops: Drops, elapsed: Floats, sag: Floats, stored: Floats
    ) -> tuple[Floats, Floats, Floats]:
        """Return gap, upward velocity and stored energy of drops that have lain for some time [s].

        They are in m, m/s and J.
        """

    def energies(self) -> dict[str, Floats]:
        """Return further entries of the energy ledger [J] (B,).

        `local_J` and `local_damping_J` are added to those of the contact.
        """

    def growth(self, bounce: Bounce) -> Floats:
        """Return the growth of a small relative change of the drop up to a contact [-].

        There is one value per drop of a bounce, or none.
        """
