"""A contact without its history, for laws whose force is smooth from first touch to release.

Each way is solved in the phase plane (`plane_rule`), where both ends are known and no event is sought. What does not come
out to the tolerance there, and every law that does not qualify, is integrated in time (`contact_phase`).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from vibroimpact.contact.law import CompliantLaw, ContactLaw
from vibroimpact.dynamics.collocation import Floats
from vibroimpact.dynamics.contact import RELEASED, Contact, Drops
from vibroimpact.dynamics.encounter import Encounter
from vibroimpact.dynamics.half_contact import HalfContact, solve_half
from vibroimpact.dynamics.plane_peak import plane_peak
from vibroimpact.dynamics.plane_rule import PlaneRule, plane_rule
from vibroimpact.dynamics.solve_contact import SolvesContact, collocated

_TIGHTEST = 1e-11  # below it rounding leaves too little room
_LEAST_RESTITUTION = 0.1  # slower drops are left to what knows how to capture them
_SWEEPS = 10


def quick(law: ContactLaw, tolerance: float, size: int) -> SolvesContact:
    """Return what solves the contacts of a run of `size` drops under laws of that kind, without history, as quickly as they allow."""
    slow = collocated(tolerance, size)
    if tolerance < _TIGHTEST or not (isinstance(law, CompliantLaw) and smooth_throughout(law)):
        return slow
    number, root = _nodes_for(tolerance, law.root), law.root
    few, many, starts = plane_rule(number, root), plane_rule(number + 8, root), _Starts(number, size)

    def solve(encounter: Encounter, drops: Drops) -> tuple[Contact, Floats, Floats]:
        with np.errstate(all="ignore"):  # what is not finite is found, and tried again
            found = _in_plane(encounter, few, starts, drops, tolerance)
            again = np.flatnonzero(~found.good)
            if again.size:
                fresh = _Starts(number + 8, len(again))
                found.put(again, _in_plane(encounter.pick(again), many, fresh, np.arange(len(again)), tolerance))
        contact, left = found.contact(encounter.law), np.flatnonzero(~found.good)
        if left.size:
            slower, force, when = slow(encounter.pick(left), drops[left])
            for name, values in vars(slower).items():
                if isinstance(values, np.ndarray):
                    getattr(contact, name)[left] = values
            found.force[left], found.when[left] = force, when
        return contact, found.force, found.when

    return solve


def smooth_throughout(law: CompliantLaw) -> bool:
    """Is the force one smooth function from first touch to zero indentation, at both of which the law says that the contact ends?

    Examples
    --------
    >>> from vibroimpact.contact.laws.flores import Flores
    >>> from vibroimpact.contact.laws.adams_impact import AdamsImpact
    >>> smooth_throughout(Flores(stiffness=1e8, restitution=0.7))
    True
    >>> smooth_throughout(AdamsImpact(stiffness=1e8, damping_max=10.0, full_damping_penetration=1e-4))
    False
    """
    ends = law.contact_end == "zero-indentation" and law.tension != "cut"
    return ends and not (law.memories() or law.breakpoints or law.yields)


def _nodes_for(tolerance: float, root: int) -> int:
    """Return the number of nodes: 14 at a tolerance of 1e-8, for a law that is smooth in the square root."""
    return int(2 * np.ceil(-np.log10(tolerance) - 1e-9)) + 2 * root - 6


class _Starts:
    """The dimensionless solutions of a run's last contacts, to start the next from."""

    def __init__(self, number: int, size: int) -> None:
        self.inward, self.outward = np.full((number, size), np.nan), np.full((number, size), np.nan)
        self.depth = np.full(size, np.nan)


@dataclass
class _Found:
    """What the phase plane tells of the contacts of B drops."""

    good: NDArray[np.bool_]
    depth: Floats
    speed: Floats
    time_in: Floats
    duration: Floats
    dissipated: Floats
    force: Floats
    when: Floats

    def put(self, drops: Drops, other: _Found) -> None:
        """Take over what was found of some drops."""
        for name, values in vars(other).items():
            getattr(self, name)[drops] = values

    def contact(self, law: CompliantLaw) -> Contact:
        """Return the contact, without pieces."""
        size = len(self.good)
        released = np.full(size, RELEASED, dtype=np.int8)
        nothing = [np.zeros(size) for _ in range(3)]
        return Contact(
            [], released, self.duration, nothing[0], -self.speed, self.depth, self.time_in, self.dissipated, nothing[1], nothing[2], law
        )


def _in_plane(encounter: Encounter, rule: PlaneRule, starts: _Starts, drops: Drops, tolerance: float) -> _Found:
    """Solve both ways of the contacts, from the last ones where they are known."""
    square = encounter.approach_speed**2
    known = np.isfinite(starts.depth[drops])
    inward, part = starts.inward[:, drops], starts.depth[drops]
    if not known.all():  # Hertz without damping
        inward[:, ~known] = (1.0 - rule.shape**2.5) / rule.nodes**2
        part[~known] = 1.0
    coming = solve_half(encounter, rule, "in", part * encounter.depth, inward * square, tolerance, _SWEEPS)
    outward = starts.outward[:, drops]
    if not known.all():
        outward[:, ~known] = (coming.squares / square)[:, ~known]
    leaving = solve_half(encounter, rule, "out", coming.depth, outward * square, tolerance, _SWEEPS)
    good = coming.solved & leaving.solved & (leaving.touch_square > _LEAST_RESTITUTION**2 * square)
    _keep(starts, drops, good, coming, leaving, encounter)
    force, when = plane_peak(encounter, rule, coming)
    good &= np.isfinite(force) & np.isfinite(when)
    return _Found(
        good,
        coming.depth,
        np.sqrt(leaving.touch_square),
        coming.duration,
        coming.duration + leaving.duration,
        coming.dissipated + leaving.dissipated,
        force,
        when,
    )


def _keep(starts: _Starts, drops: Drops, good: NDArray[np.bool_], coming: HalfContact, leaving: HalfContact, encounter: Encounter) -> None:
    per_square = 1.0 / encounter.approach_speed**2
    starts.inward[:, drops], starts.outward[:, drops] = coming.squares * per_square, leaving.squares * per_square
    starts.depth[drops] = np.where(good, coming.depth / encounter.depth, np.nan)
