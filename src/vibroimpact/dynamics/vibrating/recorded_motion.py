"""The motion of a drop as the core wrote it, made into parts and laws where these are asked for."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import overload

import numpy as np

from vibroimpact.contact.law import CompliantLaw
from vibroimpact.contact.quasi_static import QuasiStatic
from vibroimpact.dynamics.core.contact_records import (
    FLIGHT,
    LAWS,
    PARTS,
    RECOIL,
    STRETCH,
    Parts,
)
from vibroimpact.dynamics.core.records import MAPS
from vibroimpact.dynamics.core.surface_friction_records import NUMBERS, SlidingSphere
from vibroimpact.dynamics.motion.contact import Piece
from vibroimpact.dynamics.vibrating.contact_view import ContactView, contact_view
from vibroimpact.dynamics.vibrating.free_motion import FreePhase
from vibroimpact.dynamics.vibrating.linear_system import FreeMotion, LinearSystem, State
from vibroimpact.dynamics.vibrating.local import LocalContact
from vibroimpact.dynamics.vibrating.radau_eigenbasis import (
    NODES_PER_STRETCH,
    RadauEigenbasis,
    radau_eigenbasis,
)
from vibroimpact.dynamics.vibrating.recorded_laws import RecordedLaws
from vibroimpact.dynamics.vibrating.room import written_of
from vibroimpact.dynamics.vibrating.stretch import VibratingStretch
from vibroimpact.dynamics.vibrating.surface_friction import (
    NO_FRICTION,
    SlidingState,
    SlidingStretch,
)

_FIRST_PARTS = 128  # of a motion; the room doubles
_FIRST_LAWS = 32

_COUNTED = {LAWS: ("origin", "closing_speed", "compressed", "coefficients")}
"""The arrays of `Parts` with one entry for each law; the others, but for the first, have one for
each part.
"""


@dataclass
class ImpactOn:
    """What an impact meets: the system with its contact, the compliance in series with the law, and
    the law itself. `sphere`: friction at first touch.
    """

    system: LinearSystem
    series: QuasiStatic
    law: Callable[[], CompliantLaw]
    sphere: SlidingSphere = NO_FRICTION


@dataclass(eq=False)
class RecordedMotion(RecordedLaws):
    """The motion of a drop: flights, and the parts of its impacts.

    `system`: the bodies at the start. `parts`: as the core wrote them. `end`: the state at the end
    of the last part. `impacts`: what each of them met; it begins with the part and the law of the
    numbers in `first_parts` and `first_laws`.
    """

    system: LinearSystem
    parts: Parts
    end: State
    impacts: list[ImpactOn] = field(default_factory=list)
    first_parts: list[int] = field(default_factory=list)
    first_laws: list[int] = field(default_factory=list)
    _motions: dict[int, VibratingStretch | FreePhase] = field(default_factory=dict)

    def __len__(self) -> int:
        return int(self.parts.written[PARTS])

    def keep_written(self) -> None:
        """Keep what is written of the parts, without the room behind it."""
        self.parts = written_of(self.parts, _COUNTED, PARTS)
        self._motions.clear()  # they are read from the room

    # laws
    # ----------------------------------------------------------------------------------------

    @property
    def _written(self) -> Parts:
        return self.parts

    def _impact_under(self, law: int) -> ImpactOn:
        """Return what the impact meets that a law belongs to."""
        return self.impacts[int(np.searchsorted(self.first_laws, law, side="right")) - 1]

    def _stated_law(self, law: int) -> CompliantLaw:
        return self._impact_under(law).law()

    def _series(self, law: int) -> QuasiStatic:
        return self._impact_under(law).series

    # parts
    # ---------------------------------------------------------------------------------------

    def parts_of(self, impact: int) -> range:
        """Return the numbers of the parts of an impact, counted from 0."""
        first = self.first_parts[impact]
        end = len(self)
        if impact + 1 < len(self.first_parts):
            end = self.first_parts[impact + 1] - 1  # a flight
        elif int(self.parts.kind[end - 1]) == FLIGHT:
            end -= 1
        return range(first, end)

    def start(self, part: int) -> State:
        """Return the state at the start of a part."""
        parts = self.parts
        return State(parts.displacement[part], parts.velocity[part], parts.local[part])

    def motion(self, part: int) -> VibratingStretch | FreePhase:
        """Return the motion of a part of an impact."""
        if part not in self._motions:
            is_stretch = self.parts.kind[part] == STRETCH
            make = self._stretch if is_stretch else self._free
            self._motions[part] = make(part)
        return self._motions[part]

    def view(self, part: int) -> ContactView:
        """Return the system in a part of an impact, reduced to its contact."""
        return contact_view(self._impact(part).system, (0,))

    def _impact(self, part: int) -> ImpactOn:
        """Return what the impact meets that a part belongs to."""
        return self.impacts[int(np.searchsorted(self.first_parts, part, side="right")) - 1]

    def _free(self, part: int) -> FreePhase:
        free = FreeMotion(self._impact(part).system, self.start(part))
        recoiling: tuple[tuple[int, LocalContact], ...] = ()
        if self.parts.kind[part] == RECOIL:
            recoiling = ((0, self.local(int(self.parts.law[part]))),)
        return FreePhase(free, float(self.parts.length[part]), recoiling)

    def _stretch(self, part: int) -> VibratingStretch:
        parts = self.parts
        local = self.local(int(parts.law[part]))
        basis = radau_eigenbasis(MAPS[parts.time_map[part]], local.law.root)
        history = self._history(part, 0, basis.rule)
        length = float(parts.length[part])
        stretch = VibratingStretch(
            view=self.view(part),
            basis=basis,
            length=length,
            start=self.start(part),
            contacts=(history,),
            roughness=float(parts.roughness[part]),
            sliding=self._sliding(part, basis, length),
        )
        is_last = part + 1 == len(self)
        # which it would compute anew
        stretch.__dict__["end"] = self.end if is_last else self.start(part + 1)
        return stretch

    def _sliding(self, part: int, basis: RadauEigenbasis, length: float) -> SlidingStretch | None:
        """Return the friction through a part; None without friction."""
        sphere = self._impact(part).sphere
        if not sphere.directions:
            return None
        start, end = (SlidingState.of(numbers) for numbers in self.parts.sphere[part])
        return SlidingStretch(
            basis.rule,
            length,
            sphere,
            start,
            end,
            self.parts.friction[part],
            self.parts.slip[part],
        )


@dataclass(frozen=True, eq=False)
class PiecesOfImpact(Sequence[Piece]):
    """The pieces of the contact of a drop, made where they are asked for.

    `numbers`: of the parts.
    """

    recorded: RecordedMotion
    numbers: range

    @cached_property
    def _pieces(self) -> list[Piece]:
        parts = self.recorded.parts
        return [
            Piece(
                float(parts.start[part]),
                self.recorded.motion(part),
                self.recorded.local(int(parts.law[part])).law,
            )
            for part in self.numbers
        ]

    @overload
    def __getitem__(self, index: int) -> Piece: ...
    @overload
    def __getitem__(self, index: slice) -> list[Piece]: ...
    def __getitem__(self, index: int | slice) -> Piece | list[Piece]:
        return self._pieces[index]

    def __len__(self) -> int:
        return len(self.numbers)


def room_for_parts(system: LinearSystem, coefficients: int) -> Parts:
    """Return room for the parts of the motion of a drop, whose law has so many coefficients."""
    most = _FIRST_PARTS
    laws = _FIRST_LAWS
    number = system.number
    elements = len(system.rate)
    directions = 0 if system.along is None else len(system.along)
    sphere_numbers = NUMBERS if directions else 0
    nodes = NODES_PER_STRETCH
    return Parts(
        written=np.zeros(2, dtype=np.int64),
        kind=np.zeros(most, dtype=np.int64),
        time_map=np.zeros(most, dtype=np.int64),
        start=np.empty(most),
        length=np.empty(most),
        displacement=np.empty((most, number)),
        velocity=np.empty((most, number)),
        local=np.empty((most, elements)),
        law=np.zeros(most, dtype=np.int64),
        static=np.empty((most, nodes)),
        force=np.empty((most, nodes)),
        approach=np.empty((most, nodes + 1)),
        rate=np.empty((most, nodes + 1)),
        closing=np.empty((most, nodes + 1)),
        delta=np.empty((most, nodes + 1)),
        work=np.empty(most),
        dissipated=np.empty(most),
        roughness=np.empty(most),
        separation_loss=np.empty(most),
        indentation=np.empty((most, nodes + 1)),
        friction=np.empty((most, directions, nodes)),
        slip=np.empty((most, directions, nodes)),
        sphere=np.empty((most, 2, sphere_numbers)),
        origin=np.zeros(laws, dtype=np.int64),
        closing_speed=np.empty(laws),
        compressed=np.empty(laws),
        coefficients=np.empty((laws, coefficients)),
    )
