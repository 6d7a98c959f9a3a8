"""A bounce of a run: a flight and the contact that follows it."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol, TypeVar, overload

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.motion.along import ContactAlong, Sphere, State
from vibroimpact.dynamics.motion.contact import Contact
from vibroimpact.dynamics.motion.flight import Flight
from vibroimpact.dynamics.motion.ride import Ride


@dataclass(frozen=True)
class Bounce:
    """A flight of one drop and the contact that follows it.

    `flight_end` [s] (1,). `contact`: None for a flight that ends the run, and for a law without a
    force. `oblique`: the sphere
    and its motion along the plate at the start of the flight, and `along` that in the contact,
    where there is any. `ride`: on a shaken plate after an impact of a law without a force.
    """

    flight: Flight
    flight_end: Floats
    contact: Contact | None = None
    oblique: tuple[Sphere, State] | None = None
    along: ContactAlong | None = None
    ride: Ride | None = None


MadeBounce = TypeVar("MadeBounce", bound=Bounce)


class MadeBounces(Sequence[MadeBounce]):
    """Bounces of one drop that are made where they are read.

    A run may have a hundred thousand of them, of which only numbers are kept.
    """

    @overload
    def __getitem__(self, index: int) -> MadeBounce: ...

    @overload
    def __getitem__(self, index: slice) -> list[MadeBounce]: ...

    def __getitem__(self, index: int | slice) -> MadeBounce | list[MadeBounce]:
        if isinstance(index, slice):
            return [self._bounce(number) for number in range(*index.indices(len(self)))]
        return self._bounce(range(len(self))[index])

    @abstractmethod
    def _bounce(self, number: int) -> MadeBounce:
        """Make the bounce with a number, from 0."""


class BouncesOfDrops(Protocol):
    """The bounces of the drops of a batch, made where they are asked for."""

    def of(self, drop: int) -> Sequence[Bounce]:
        """Return those of one drop."""


@dataclass(frozen=True, eq=False)
class BouncesOfSeveral:
    """The bounces of drops that were followed one by one."""

    drops: Sequence[Sequence[Bounce]]

    def of(self, drop: int) -> Sequence[Bounce]:
        """Return those of one drop."""
        return self.drops[drop]
