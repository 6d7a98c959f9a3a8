"""Systems of several bodies: stated as the core takes them, marched through their contacts, and
their motion made into parts where these are asked for.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.contact.law import CompliantLaw
from vibroimpact.contact.quasi_static import QuasiStatic
from vibroimpact.dynamics.core.contact_records import OF_IMPACT, STRETCH
from vibroimpact.dynamics.core.events import ENDS
from vibroimpact.dynamics.core.records import MAPS, Contacts
from vibroimpact.dynamics.core.system_march import ENDED, FULL, TOO_STIFF, march_on
from vibroimpact.dynamics.core.system_records import (
    APART,
    IMPACT_NUMBERS,
    IMPACTS,
    LAWS,
    NEXT_LENGTH,
    NOW,
    PARTS,
    PLASTIC,
    ROWS,
    STRETCHES,
    ContactPoints,
    MarchManner,
    SystemMarch,
    SystemParts,
)
from vibroimpact.dynamics.vibrating.contact_view import contact_view
from vibroimpact.dynamics.vibrating.free_motion import FreePhase
from vibroimpact.dynamics.vibrating.linear_system import FreeMotion, LinearSystem, State
from vibroimpact.dynamics.vibrating.local import LocalContact, contacts_of
from vibroimpact.dynamics.vibrating.radau_eigenbasis import (
    NODES_PER_STRETCH,
    bases_of,
    radau_eigenbasis,
)
from vibroimpact.dynamics.vibrating.recorded_laws import RecordedLaws
from vibroimpact.dynamics.vibrating.room import with_more_room, written_of
from vibroimpact.dynamics.vibrating.stretch import VibratingStretch
from vibroimpact.dynamics.vibrating.surface_friction import NO_FRICTION
from vibroimpact.errors import ComputationError

_FIRST_PARTS = 128  # of a motion; the room doubles
_MOST_STRETCHES = 200_000
_AT_ONCE = 1_000  # stretches, until progress is told and an interrupt is heard

_GROUPS = {
    PARTS: (
        "kind",
        "time_map",
        "start",
        "length",
        "displacement",
        "velocity",
        "roughness",
        "first_row",
        "contacts",
    ),
    LAWS: ("of_contact", "origin", "closing_speed", "compressed"),
    IMPACTS: ("impacts",),
}
"""The arrays of `SystemParts` with one entry for each part, law and impact; the others, but for the
first, have one for each row.
"""


@dataclass(frozen=True)
class ContactDefinition:
    """A contact of a system.

    `law`: its law. `series`: the compliance in series. `fresh_surface`: whether each impact meets
    undeformed surfaces.
    """

    law: CompliantLaw
    series: QuasiStatic
    fresh_surface: bool


@dataclass(frozen=True)
class MotionPart:
    """A part of the motion of a system: its start [s] and its motion."""

    start: float
    motion: VibratingStretch | FreePhase


@dataclass(eq=False)
class MarchedSystem(RecordedLaws):
    """A system of bodies that has been marched through its contacts up to a time.

    Parameters
    ----------
    system : LinearSystem
        The system.
    definitions : sequence of ContactDefinition
        Its contacts.
    march, parts : SystemMarch, SystemParts
        Where it is, and the parts of its motion, as the core wrote them.
    """

    system: LinearSystem
    definitions: Sequence[ContactDefinition]
    march: SystemMarch
    parts: SystemParts
    _motions: dict[int, MotionPart] = field(default_factory=dict)

    @property
    def time(self) -> float:
        """Up to when it has been marched [s]."""
        return float(self.march.numbers[NOW])

    @property
    def state(self) -> State:
        """Its state then."""
        return State(self.march.displacement, self.march.velocity, np.zeros(0))

    @property
    def lost(self) -> Floats:
        """Energy lost in each coordinate, and last in the contacts [J] (n + 1,)."""
        return self.march.lost

    @property
    def plastic(self) -> float:
        """Plastic work in the contacts, with that since their memory last changed [J]."""
        return float(self.march.numbers[PLASTIC]) + sum(
            float(local.law.plastic_work(np.asarray(delta))) for local, delta in self._active()
        )

    @property
    def stored(self) -> float:
        """Energy that is stored in the contacts [J]."""
        return sum(float(local.energy_at_indentation(delta)) for local, delta in self._active())

    def _active(self) -> list[tuple[LocalContact, float]]:
        """Return the contacts whose surfaces overlap, and the indentations of their laws [m]."""
        active = []
        approach = self.system.approach(self.state)
        for contact in np.flatnonzero(self.march.phase != APART).tolist():
            local = self.local(int(self.march.acting_law[contact]))
            level = max(float(approach[contact]), local.release_level)
            active.append((local, float(local.indentation_at(level))))
        return active

    # laws
    # -------------------------------------------------------------------------

    @property
    def _written(self) -> SystemParts:
        return self.parts

    def _stated_law(self, law: int) -> CompliantLaw:
        return self.definitions[int(self.parts.of_contact[law])].law

    def _series(self, law: int) -> QuasiStatic:
        return self.definitions[int(self.parts.of_contact[law])].series

    # parts
    # -------------------------------------------------------------------------

    def __len__(self) -> int:
        return int(self.parts.written[PARTS])

    @cached_property
    def starts(self) -> Floats:
        """Starts of its parts [s]."""
        return self.parts.start[: len(self)]

    @property
    def motions(self) -> list[MotionPart]:
        """Its parts, one after another."""
        return [self.part(number) for number in range(len(self))]

    def part(self, number: int) -> MotionPart:
        """Return a part of the motion."""
        if number not in self._motions:
            is_stretch = self.parts.kind[number] == STRETCH
            make = self._stretch if is_stretch else self._flight
            start = float(self.parts.start[number])
            self._motions[number] = MotionPart(start, make(number))
        return self._motions[number]

    def _start(self, part: int) -> State:
        """Return the state at the start of a part; that of the one after the last is the end."""
        if part == len(self):
            return self.state
        return State(self.parts.displacement[part], self.parts.velocity[part], np.zeros(0))

    def _rows(self, part: int) -> range:
        """Return the rows of the contacts of a part."""
        first = int(self.parts.first_row[part])
        return range(first, first + int(self.parts.contacts[part]))

    def _flight(self, part: int) -> FreePhase:
        recoiling = tuple(
            (int(self.parts.contact[row]), self.local(int(self.parts.law[row])))
            for row in self._rows(part)
        )
        free = FreeMotion(self.system, self._start(part))
        return FreePhase(free, float(self.parts.length[part]), recoiling)

    def _stretch(self, part: int) -> VibratingStretch:
        parts = self.parts
        rows = self._rows(part)
        basis = radau_eigenbasis(MAPS[parts.time_map[part]], _root_of(self.definitions))
        histories = tuple(self._history(row, int(parts.contact[row]), basis.rule) for row in rows)
        stretch = VibratingStretch(
            view=contact_view(self.system, (history.number for history in histories)),
            basis=basis,
            length=float(parts.length[part]),
            start=self._start(part),
            contacts=histories,
            roughness=float(parts.roughness[part]),
        )
        stretch.__dict__["end"] = self._start(part + 1)  # which it would compute anew
        return stretch

    def impacts(self) -> Floats:
        """Return its impacts, with the columns of `core.system_records`."""
        return self.parts.impacts[: self.parts.written[IMPACTS]]


def march_system(
    system: LinearSystem,
    definitions: Sequence[ContactDefinition],
    start: State,
    tolerance: float,
    end: float,
    progress: Callable[[float], None] | None = None,
) -> MarchedSystem:
    """March a system of bodies through its contacts until a time [s].

    A contact in progress is cut off there.

    Parameters
    ----------
    system : LinearSystem
        The bodies, without massless elements and driven coordinates.
    definitions : sequence of ContactDefinition
        Its contacts.
    start : State
        State at the start.
    tolerance : float
        Relative error allowed at the end of each stretch.
    end : float
        When to end [s].
    progress : callable, optional
        Called with a number from 0 to 1.

    Raises
    ------
    ComputationError
        If a contact can not be integrated to the tolerance, or contacts follow each other without
        end.
    """
    marched = MarchedSystem(
        system,
        definitions,
        _march_at_start(system, definitions, start),
        _room_for_parts(system.number, len(definitions)),
    )
    bases = bases_of(_root_of(definitions))
    points = _contact_points(system, definitions)
    record = system.record_of(0)
    stretches = 0
    outcome = FULL
    while outcome != ENDED:
        if outcome == TOO_STIFF:
            raise ComputationError(
                f"the contact at {marched.time:g} s can't be integrated to the tolerance"
            )
        if stretches == _MOST_STRETCHES:
            raise ComputationError(
                f"after {_MOST_STRETCHES} stretches of motion the system is at "
                f"{marched.time:g} s: contacts are many, as where they "
                "follow each other ever faster because a body comes to rest, or last "
                "long; ask for a shorter duration"
            )
        manner = MarchManner(tolerance, end, min(stretches + _AT_ONCE, _MOST_STRETCHES))
        outcome = march_on(bases, record, points, marched.march, marched.parts, NO_FRICTION, manner)
        if progress is not None:
            progress(min(marched.time / end, 1.0))
        stretches = int(marched.march.counts[STRETCHES])
        if outcome == FULL:
            marched.parts = with_more_room(marched.parts)
    marched.parts = written_of(marched.parts, _GROUPS, ROWS)
    return marched


def _root_of(definitions: Sequence[ContactDefinition]) -> int:
    """Return the power of time in whose root the forces are smooth."""
    return max(definition.law.root for definition in definitions)


# what the core takes
# -----------------------------------------------------------------------------


def _contact_points(
    system: LinearSystem, definitions: Sequence[ContactDefinition]
) -> ContactPoints:
    """Return the contacts with the coordinates that move each of them."""
    moving = [np.flatnonzero(shape) for shape in system.shape]  # rigid motions come first
    coordinate = np.concatenate(moving)
    number = [len(coordinates) for coordinates in moving]
    flexible = [float(system.flexibility[coordinates].sum()) for coordinates in moving]
    return ContactPoints(
        first=np.cumsum([0, *number]),
        coordinate=coordinate,
        frequency=system.angular_frequency[coordinate],
        ratio=system.damping_ratio[coordinate],
        damping=system.damping[coordinate],
        load=system.load[coordinate],
        shape=np.concatenate(
            [shape[coordinates] for shape, coordinates in zip(system.shape, moving, strict=True)]
        ),
        rigid=np.array([np.count_nonzero(system.rigid[coordinates]) for coordinates in moving]),
        offset=system.offset,
        gravity=system.gravity,
        mass=system.mass,
        compliance=system.compliance,
        flexibility=np.array(flexible),
        contact_end=np.array(
            [ENDS.index(definition.law.contact_end) for definition in definitions]
        ),
        keeps_memory=np.array(
            [not definition.fresh_surface and definition.law.lasting for definition in definitions]
        ),
    )


def _march_at_start(
    system: LinearSystem, definitions: Sequence[ContactDefinition], start: State
) -> SystemMarch:
    """Return where a system is at its start."""
    contacts = len(definitions)

    stated = contacts_of(
        [LocalContact(definition.law, definition.series, 1.0) for definition in definitions]
    )
    numbers = np.zeros(4)
    numbers[NEXT_LENGTH] = np.inf
    return SystemMarch(
        counts=np.zeros(1, dtype=np.int64),
        numbers=numbers,
        displacement=start.displacement.copy(),
        velocity=start.velocity.copy(),
        lost=np.zeros(system.number + 1),
        phase=np.zeros(contacts, dtype=np.int64),
        is_fresh=np.zeros(contacts, dtype=bool),
        impact=np.zeros(contacts, dtype=np.int64),
        of_contact=np.zeros((contacts, 8)),
        acting=_copy_of(stated),
        upcoming=_copy_of(stated),
        dents=_copy_of(stated),
        has_dent=np.zeros(contacts, dtype=bool),
        acting_law=np.zeros(contacts, dtype=np.int64),
        upcoming_law=np.full(contacts, OF_IMPACT),
        dent_law=np.zeros(contacts, dtype=np.int64),
    )


def _copy_of(laws: Contacts) -> Contacts:
    """Return laws that may be written to."""
    return Contacts(**{name: values.copy() for name, values in laws._asdict().items()})


def _room_for_parts(number: int, contacts: int) -> SystemParts:
    """Return room for the parts of the motion of a system of so many coordinates and contacts."""
    most = _FIRST_PARTS
    rows = _FIRST_PARTS + contacts
    laws = _FIRST_PARTS + 2 * contacts
    nodes = NODES_PER_STRETCH
    return SystemParts(
        written=np.zeros(4, dtype=np.int64),
        kind=np.zeros(most, dtype=np.int64),
        time_map=np.zeros(most, dtype=np.int64),
        start=np.empty(most),
        length=np.empty(most),
        displacement=np.empty((most, number)),
        velocity=np.empty((most, number)),
        roughness=np.zeros(most),
        first_row=np.zeros(most, dtype=np.int64),
        contacts=np.zeros(most, dtype=np.int64),
        contact=np.zeros(rows, dtype=np.int64),
        law=np.zeros(rows, dtype=np.int64),
        static=np.empty((rows, nodes)),
        force=np.empty((rows, nodes)),
        approach=np.empty((rows, nodes + 1)),
        rate=np.empty((rows, nodes + 1)),
        closing=np.empty((rows, nodes + 1)),
        delta=np.empty((rows, nodes + 1)),
        work=np.empty(rows),
        dissipated=np.empty(rows),
        separation_loss=np.empty(rows),
        of_contact=np.zeros(laws, dtype=np.int64),
        origin=np.zeros(laws, dtype=np.int64),
        closing_speed=np.empty(laws),
        compressed=np.empty(laws),
        impacts=np.empty((_FIRST_PARTS + contacts, IMPACT_NUMBERS)),
    )
