"""One contact, followed by the core, and its parts read back."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from vibroimpact.dynamics.core import contact as core
from vibroimpact.dynamics.core.contact_records import Manner, Parts, Progress
from vibroimpact.dynamics.core.events import ENDS, TENSIONS
from vibroimpact.dynamics.core.records import MAPS
from vibroimpact.dynamics.core.surface_friction_records import NUMBERS, SlidingSphere
from vibroimpact.dynamics.vibrating.active_contact import ActiveContact, record_peaks
from vibroimpact.dynamics.vibrating.contact_history import ContactHistory
from vibroimpact.dynamics.vibrating.contact_view import contact_view
from vibroimpact.dynamics.vibrating.free_motion import FreePhase
from vibroimpact.dynamics.vibrating.linear_system import FreeMotion, State
from vibroimpact.dynamics.vibrating.local import LocalContact
from vibroimpact.dynamics.vibrating.radau_eigenbasis import (
    NODES_PER_STRETCH,
    RadauEigenbasis,
    bases_of,
    radau_eigenbasis,
)
from vibroimpact.dynamics.vibrating.stretch import VibratingStretch
from vibroimpact.dynamics.vibrating.stretch_end import with_separation_loss
from vibroimpact.dynamics.vibrating.surface_friction import SlidingState, SlidingStretch
from vibroimpact.dynamics.vibrating.time_marching import MotionPart, TimeMarching

_PARTS = 64


@dataclass(frozen=True)
class Limits:
    """When a contact is left: at the time `until` [s] if the sphere rides, or after so
    many steps; `longest`: of a stretch [s].
    """

    until: float
    longest: float
    most_steps: int


class CompiledContact:
    """The contact of a march with one contact, from touch on; `sphere`: friction at touch."""

    def __init__(
        self,
        march: TimeMarching,
        active: ActiveContact,
        limits: Limits,
        sphere: SlidingSphere,
    ) -> None:
        self.march = march
        self.active = active
        law = active.local.law
        self.view = contact_view(march.system, (0,))
        self.root = law.root
        self.manner = Manner(
            tension=TENSIONS.index(law.tension),
            contact_end=ENDS.index(law.contact_end),
            motion_speed=active.speed,
            energy=active.energy,
            span=active.span,
            tolerance=march.tolerance,
            begun=march.time,
            until=limits.until,
            longest=limits.longest,
            most_steps=limits.most_steps,
        )
        self.law = active.local.with_levels
        self.progress = Progress(
            time=march.time,
            next_length=march.next_length,
            delta=active.delta,
            force=np.inf,
            trend=0.0,
            closing=np.inf,
            fresh=True,
            pushes=True,
            steps=0,
            memories=0,
            largest_force=0.0,
            deepest=0.0,
            sphere=sphere,
        )
        self.state = march.state.record
        self.parts = _room(march.system.number, len(march.system.rate), sphere.directions)
        self.locals = [active.local]

    @property
    def steps(self) -> int:
        """Stretches that were tried."""
        return self.progress.steps

    def follow(self) -> int:
        """Follow the contact until something is to be decided; bring the march up to
        there, and return how it goes on.
        """
        march, outcome = self.march, core.FULL
        while outcome == core.FULL:
            outcome, count, self.progress, self.state, self.law = core.follow_contact(
                bases_of(self.root),
                self.view.bodies,
                self.manner,
                self.law,
                self.state,
                self.progress,
                march.lost,
                self.parts,
            )
            self._read(count)
        active, progress = self.active, self.progress
        march.state = State(*self.state)
        march.time, march.next_length = progress.time, progress.next_length
        active.local = self.locals[-1]
        active.delta, active.force, active.trend = progress.delta, progress.force, progress.trend
        active.fresh, active.pushes = progress.fresh, progress.pushes
        return outcome

    def _read(self, count: int) -> None:
        """Append the parts that were written to the history of the march, and record the peaks."""
        parts, march = self.parts, self.march
        if parts.late_loss[0]:
            last = march.parts[-1]
            assert isinstance(last.motion, VibratingStretch)
            march.parts[-1] = replace(
                last, motion=with_separation_loss(last.motion, 0, float(parts.late_loss[0]))
            )
        for turned_at in parts.turned_at[: self.progress.memories + 1 - len(self.locals)].tolist():
            before = self.locals[-1]
            march.plastic += float(before.law.plastic_work(turned_at))
            self.locals.append(before.after_indentation(turned_at))
        written = Parts._make(values[:count].copy() for values in parts)
        largest = written.force.max(axis=1).tolist()
        for part in range(count):
            local = self.locals[written.memories[part]]
            start = float(written.start[part])
            begun = State(written.displacement[part], written.velocity[part], written.local[part])
            if written.kind[part] == 0:
                length = float(written.length[part])
                march.parts.append(
                    MotionPart(
                        start, FreePhase(FreeMotion(march.system, begun), length, ((0, local),))
                    )
                )
                continue
            stretch = self._stretch(written, part, local, begun)
            march.parts.append(MotionPart(start, stretch))
            record_peaks(
                self.active.impact, stretch, 0, start, largest[part], written.indentation[part]
            )
            end = State(*self.state)
            if part + 1 < count:
                end = State(
                    written.displacement[part + 1],
                    written.velocity[part + 1],
                    written.local[part + 1],
                )
            stretch.__dict__["end"] = end  # which it would compute anew

    def _stretch(
        self, parts: Parts, part: int, local: LocalContact, begun: State
    ) -> VibratingStretch:
        basis = radau_eigenbasis(MAPS[parts.time_map[part]], self.root)
        static = parts.static[part]
        history = ContactHistory(
            0,
            local,
            basis.rule,
            static,
            parts.force[part] - static,
            parts.approach[part],
            parts.rate[part],
            parts.closing[part],
            parts.delta[part],
            work=float(parts.work[part]),
            dissipated=float(parts.dissipated[part]),
            separation_loss=float(parts.separation_loss[part]),
        )
        length = float(parts.length[part])
        sliding = self._rubbed(parts, part, basis, length)
        return VibratingStretch(
            self.view, basis, length, begun, (history,), float(parts.roughness[part]), sliding
        )

    def _rubbed(
        self, parts: Parts, part: int, basis: RadauEigenbasis, length: float
    ) -> SlidingStretch | None:
        sphere = self.progress.sphere
        if not sphere.directions:
            return None
        start, end = (SlidingState.of(numbers) for numbers in parts.sphere[part])
        return SlidingStretch(
            basis.rule, length, sphere, start, end, parts.friction[part], parts.slip[part]
        )


def _room(number: int, elements: int, directions: int) -> Parts:
    """Return room for parts of the motion of a system with so many coordinates, massless
    elements, and directions of friction.
    """
    nodes = NODES_PER_STRETCH
    return Parts(
        kind=np.zeros(_PARTS, dtype=np.int64),
        time_map=np.zeros(_PARTS, dtype=np.int64),
        start=np.empty(_PARTS),
        length=np.empty(_PARTS),
        displacement=np.empty((_PARTS, number)),
        velocity=np.empty((_PARTS, number)),
        local=np.empty((_PARTS, elements)),
        memories=np.zeros(_PARTS, dtype=np.int64),
        static=np.empty((_PARTS, nodes)),
        force=np.empty((_PARTS, nodes)),
        approach=np.empty((_PARTS, nodes + 1)),
        rate=np.empty((_PARTS, nodes + 1)),
        closing=np.empty((_PARTS, nodes + 1)),
        delta=np.empty((_PARTS, nodes + 1)),
        work=np.empty(_PARTS),
        dissipated=np.empty(_PARTS),
        roughness=np.empty(_PARTS),
        separation_loss=np.empty(_PARTS),
        indentation=np.empty((_PARTS, nodes + 1)),
        turned_at=np.empty(_PARTS + 1),
        late_loss=np.zeros(1),
        friction=np.empty((_PARTS, directions, nodes)),
        slip=np.empty((_PARTS, directions, nodes)),
        sphere=np.empty((_PARTS, 2, NUMBERS)),
    )
