"""Parts of a contact as the core writes them, made into motions where these are asked for."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import overload

import numpy as np

from vibroimpact.contact.law import CompliantLaw
from vibroimpact.dynamics.contact import Piece
from vibroimpact.dynamics.core.contact_records import Parts
from vibroimpact.dynamics.core.records import MAPS
from vibroimpact.dynamics.core.surface_friction_records import SlidingSphere
from vibroimpact.dynamics.vibrating.contact_history import ContactHistory
from vibroimpact.dynamics.vibrating.contact_view import ContactView
from vibroimpact.dynamics.vibrating.free_motion import FreePhase
from vibroimpact.dynamics.vibrating.linear_system import FreeMotion, State
from vibroimpact.dynamics.vibrating.local import LocalContact
from vibroimpact.dynamics.vibrating.radau_eigenbasis import RadauEigenbasis, radau_eigenbasis
from vibroimpact.dynamics.vibrating.stretch import VibratingStretch
from vibroimpact.dynamics.vibrating.surface_friction import SlidingState, SlidingStretch


@dataclass(frozen=True)
class MotionPart:
    """A part of the history of a march: its start [s] and its motion."""

    start: float
    motion: VibratingStretch | FreePhase


@dataclass(frozen=True)
class RecordedContact:
    """Parts of a contact, one after the other: stretches and recoils.

    `view`: the system, reduced to the contact. `parts`: as the core wrote them. `locals`: the
    contact after each change of the law's memory. `sphere`: friction. `end`: the state at their
    end.
    """

    view: ContactView
    parts: Parts
    locals: tuple[LocalContact, ...]
    sphere: SlidingSphere
    end: State
    _motions: dict[int, VibratingStretch | FreePhase] = field(default_factory=dict)

    def __len__(self) -> int:
        return len(self.parts.start)

    def __iter__(self) -> Iterator[MotionPart]:
        for part in range(len(self)):
            yield MotionPart(float(self.parts.start[part]), self.motion(part))

    def phases(self) -> Iterator[tuple[int, int]]:
        """Yield the parts under one law: the first, and the one after the last.

        A recoil is alone.
        """
        kind = self.parts.kind.tolist()
        memories = self.parts.memories.tolist()
        first = 0
        for part in range(1, len(self) + 1):
            ends = part == len(self) or not (kind[part] and kind[first])
            if ends or memories[part] != memories[first]:
                yield first, part
                first = part

    def local(self, part: int) -> LocalContact:
        """Return the contact with the memory of its law in a part."""
        return self.locals[int(self.parts.memories[part])]

    def recoil(self, part: int) -> FreePhase:
        """Return the recoil that is a part."""
        motion = self.motion(part)
        assert isinstance(motion, FreePhase)
        return motion

    def stretch(self, part: int) -> VibratingStretch:
        """Return the stretch that is a part."""
        motion = self.motion(part)
        assert isinstance(motion, VibratingStretch)
        return motion

    def motion(self, part: int) -> VibratingStretch | FreePhase:
        """Return the motion of a part."""
        if part not in self._motions:
            is_stretch = bool(self.parts.kind[part])
            self._motions[part] = self._stretch(part) if is_stretch else self._recoil(part)
        return self._motions[part]

    def lose_at_end(self, energy: float) -> None:
        """Add stored energy that is lost at the end of the last part [J]."""
        self.parts.separation_loss[-1] += energy
        self._motions.pop(len(self) - 1, None)

    def _start(self, part: int) -> State:
        parts = self.parts
        return State(parts.displacement[part], parts.velocity[part], parts.local[part])

    def _recoil(self, part: int) -> FreePhase:
        free = FreeMotion(self.view.system, self._start(part))
        return FreePhase(free, float(self.parts.length[part]), ((0, self.local(part)),))

    def _stretch(self, part: int) -> VibratingStretch:
        parts = self.parts
        local = self.local(part)
        basis = radau_eigenbasis(MAPS[parts.time_map[part]], local.law.root)
        static = parts.static[part]
        history = ContactHistory(
            number=0,
            local=local,
            rule=basis.rule,
            static=static,
            dissipative=parts.force[part] - static,
            approach=parts.approach[part],
            rate=parts.rate[part],
            closing=parts.closing[part],
            delta=parts.delta[part],
            work=float(parts.work[part]),
            dissipated=float(parts.dissipated[part]),
            separation_loss=float(parts.separation_loss[part]),
        )
        length = float(parts.length[part])
        stretch = VibratingStretch(
            view=self.view,
            basis=basis,
            length=length,
            start=self._start(part),
            contacts=(history,),
            roughness=float(parts.roughness[part]),
            sliding=self._sliding(part, basis, length),
        )
        is_last = part + 1 == len(self)
        # which it would compute anew
        stretch.__dict__["end"] = self.end if is_last else self._start(part + 1)
        return stretch

    def _sliding(self, part: int, basis: RadauEigenbasis, length: float) -> SlidingStretch | None:
        """Return the friction through a part; None without friction."""
        if not self.sphere.directions:
            return None
        start, end = (SlidingState.of(numbers) for numbers in self.parts.sphere[part])
        return SlidingStretch(
            basis.rule,
            length,
            self.sphere,
            start,
            end,
            self.parts.friction[part],
            self.parts.slip[part],
        )


class PiecesOfImpacts(Sequence[Piece]):
    """The pieces of the contact of several drops, made when they are first asked for.

    `sections`: the histories of the impacts of the drops. `law`: their laws before it.
    """

    def __init__(
        self, sections: Sequence[Sequence[RecordedContact | MotionPart]], law: CompliantLaw
    ) -> None:
        self._sections = sections
        self._law = law

    @cached_property
    def _pieces(self) -> list[Piece]:
        pieces = []
        for drop, sections in enumerate(self._sections):
            for section in sections:
                for part in (section,) if isinstance(section, MotionPart) else section:
                    start = np.array([part.start])
                    pieces.append(Piece(np.array([drop]), start, part.motion, self._law))
        return pieces

    @overload
    def __getitem__(self, index: int) -> Piece: ...
    @overload
    def __getitem__(self, index: slice) -> list[Piece]: ...
    def __getitem__(self, index: int | slice) -> Piece | list[Piece]:
        return self._pieces[index]

    def __len__(self) -> int:
        return len(self._pieces)


def copied(parts: Parts, count: int) -> Parts:
    """Return copies of the first parts."""
    return Parts._make(np.copy(values[:count]) for values in parts)
