"""Largest force and largest indentation of a contact, from the parts that were written."""

from __future__ import annotations

from vibroimpact.compiled import compiled
from vibroimpact.dynamics.core.attempt import basis_of, time_at
from vibroimpact.dynamics.core.contact_records import PARTS, RECOIL, Parts, Peaks
from vibroimpact.dynamics.core.linear import largest_of
from vibroimpact.dynamics.core.peak import peak_of, peak_of_force
from vibroimpact.dynamics.core.records import Bases, Law

# of the largest nodal value: parts whose nodal values stay below can't hold the peak
_NEAR = 0.98


@compiled
def peaks_since(
    bases: Bases,
    law: Law,
    before: Peaks,
    parts: Parts,
    first: int,
    largest_force: float,
    deepest: float,
) -> Peaks:
    """Return the peaks of an impact with those of the last parts of a contact under one law.

    They are located only in parts whose nodal values come near the largest.

    Parameters
    ----------
    bases : Bases
        The Radau rule under the three maps of time.
    law : Law
        The law in these parts.
    before : Peaks
        The peaks of the impact without these parts.
    parts : Parts
        The parts of the contact.
    first : int
        The first of the parts under the law.
    largest_force, deepest : float
        Largest force [N] and largest indentation [m] of the contact at a node so far.
    """
    force = before.force
    time_of_force = before.time_of_force
    indentation = before.indentation
    time_of_indentation = before.time_of_indentation
    for part in range(first, parts.written[PARTS]):
        if parts.kind[part] == RECOIL:
            continue
        basis = basis_of(bases, parts.time_map[part])
        if largest_of(parts.force[part]) >= _NEAR * largest_force:
            x, value = peak_of_force(basis, law, parts.delta[part], parts.rate[part])
            if value > force:
                force = value
                time_of_force = parts.start[part] + parts.length[part] * time_at(basis, x)
        if largest_of(parts.indentation[part, 1:]) >= _NEAR * deepest:
            x, value = peak_of(basis, parts.indentation[part])
            if value > indentation:
                indentation = value
                time_of_indentation = parts.start[part] + parts.length[part] * time_at(basis, x)
    return Peaks(force, time_of_force, indentation, time_of_indentation)
