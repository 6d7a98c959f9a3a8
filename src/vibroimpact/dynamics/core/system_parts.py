"""The parts of the motion of a system, the laws of its contacts and its impacts, written as they
come.
"""

from __future__ import annotations

import math

from vibroimpact.compiled import compiled
from vibroimpact.dynamics.core.attempt import time_at
from vibroimpact.dynamics.core.contact_records import FLIGHT, STRETCH, Attempt, Balance
from vibroimpact.dynamics.core.events import TENSION_KEPT
from vibroimpact.dynamics.core.law import law_of
from vibroimpact.dynamics.core.linear import largest_of, write_row
from vibroimpact.dynamics.core.peak import peak_of, peak_of_force
from vibroimpact.dynamics.core.records import Basis, Law
from vibroimpact.dynamics.core.system_records import (
    CLOSING,
    CONTACT,
    DEEPEST,
    END,
    IMPACTS,
    IMPULSE,
    LARGEST_FORCE,
    LAWS,
    NOW,
    PARTS,
    PEAK_DEPTH,
    PEAK_FORCE,
    RECOILING,
    ROWS,
    START,
    TIME_OF_DEPTH,
    TIME_OF_FORCE,
    Group,
    SystemMarch,
    SystemParts,
)

# of the largest nodal value: stretches whose nodal values stay below can't hold the peak
_NEAR = 0.98


@compiled
def has_room(parts: SystemParts, contacts: int) -> bool:
    """Is there room for a further part of a system of so many contacts, and for what follows it?

    That is a change of memory and the beginning of an impact at each contact.
    """
    return bool(
        parts.written[PARTS] < len(parts.start)
        and parts.written[ROWS] + contacts <= len(parts.contact)
        and parts.written[LAWS] + 2 * contacts <= len(parts.origin)
        and parts.written[IMPACTS] + contacts <= len(parts.impacts)
    )


@compiled
def write_law(parts: SystemParts, contact: int, origin: int, compressed: float, law: Law) -> int:
    """Write a law of a contact, and return its number; `origin`, `compressed`: of `SystemParts`."""
    number = parts.written[LAWS]
    parts.of_contact[number] = contact
    parts.origin[number] = origin
    parts.closing_speed[number] = law.speed
    parts.compressed[number] = compressed
    parts.written[LAWS] = number + 1
    return int(number)


@compiled
def add_impact(parts: SystemParts, contact: int, start: float, closing: float) -> int:
    """Add an impact of a contact, which starts at a time [s] with a closing speed [m/s]; return its
    row.
    """
    row = parts.written[IMPACTS]
    impact = parts.impacts[row]
    for column in range(len(impact)):
        impact[column] = 0.0
    impact[CONTACT] = contact
    impact[START] = start
    impact[END] = math.nan
    impact[CLOSING] = closing
    parts.written[IMPACTS] = row + 1
    return int(row)


@compiled
def write_part(parts: SystemParts, march: SystemMarch, kind: int, length: float) -> None:
    """Write what all parts have: their kind, length [s], and where they begin."""
    part = parts.written[PARTS]
    parts.kind[part] = kind
    parts.start[part] = march.numbers[NOW]
    parts.length[part] = length
    write_row(parts.displacement, part, march.displacement)
    write_row(parts.velocity, part, march.velocity)
    parts.first_row[part] = parts.written[ROWS]
    parts.contacts[part] = 0
    parts.written[PARTS] = part + 1


@compiled
def add_row(parts: SystemParts, march: SystemMarch, contact: int) -> int:
    """Add a contact to the last part, and return its row."""
    row = parts.written[ROWS]
    parts.contact[row] = contact
    parts.law[row] = march.acting_law[contact]
    parts.separation_loss[row] = 0.0
    parts.contacts[parts.written[PARTS] - 1] += 1
    parts.written[ROWS] = row + 1
    return int(row)


@compiled
def write_flight(parts: SystemParts, march: SystemMarch, length: float) -> None:
    """Write a motion without contact force of a length [s], with the contacts that recoil."""
    write_part(parts, march, FLIGHT, length)
    for contact in range(len(march.phase)):
        if march.phase[contact] == RECOILING:
            add_row(parts, march, contact)


@compiled
def write_stretch(
    parts: SystemParts,
    march: SystemMarch,
    basis: Basis,
    group: Group,
    solved: Attempt,
    balance: Balance,
) -> None:
    """Write a stretch of the contacts of a group."""
    write_part(parts, march, STRETCH, solved.length)
    part = parts.written[PARTS] - 1
    parts.time_map[part] = basis.time_map
    parts.roughness[part] = solved.contact.roughness
    nodes = len(basis.time)
    histories = solved.contact
    for index in range(len(group.contacts)):
        row = add_row(parts, march, group.contacts[index])
        first = index * nodes
        end = first + nodes
        write_row(parts.static, row, solved.nodes.static[first:end])
        write_row(parts.force, row, solved.nodes.force[first:end])
        write_row(parts.approach, row, histories.approach[index])
        write_row(parts.rate, row, histories.rate[index])
        write_row(parts.closing, row, histories.closing[index])
        write_row(parts.delta, row, histories.delta[index])
        parts.work[row] = balance.work[index]
        parts.dissipated[row] = histories.dissipated[index]


@compiled
def write_peaks(parts: SystemParts, march: SystemMarch, basis: Basis, row: int) -> None:
    """Add a row of the last part to the largest force, the largest indentation and the impulse of
    its impact.
    """
    part = parts.written[PARTS] - 1
    contact = parts.contact[row]
    numbers = march.of_contact[contact]
    impact = parts.impacts[march.impact[contact]]
    force = parts.force[row]
    at_nodes = largest_of(force)
    if march.acting.tension[contact] != TENSION_KEPT:
        at_nodes = max(at_nodes, 0.0)
    if at_nodes >= _NEAR * numbers[LARGEST_FORCE]:
        numbers[LARGEST_FORCE] = max(numbers[LARGEST_FORCE], at_nodes)
        law = law_of(march.acting, contact)
        x, value = peak_of_force(basis, law, parts.delta[row], parts.rate[row])
        if value > impact[PEAK_FORCE]:
            impact[PEAK_FORCE] = value
            impact[TIME_OF_FORCE] = parts.start[part] + parts.length[part] * time_at(basis, x)
    at_nodes = largest_of(parts.approach[row, 1:])
    if at_nodes >= _NEAR * numbers[DEEPEST]:
        numbers[DEEPEST] = max(numbers[DEEPEST], at_nodes)
        x, value = peak_of(basis, parts.approach[row])
        if value > impact[PEAK_DEPTH]:
            impact[PEAK_DEPTH] = value
            impact[TIME_OF_DEPTH] = parts.start[part] + parts.length[part] * time_at(basis, x)
    mean = 0.0
    for node in range(len(force)):
        mean += basis.integral[len(force) - 1, node] * force[node]
    impact[IMPULSE] += parts.length[part] * mean


@compiled
def lose_stored(parts: SystemParts, march: SystemMarch, contact: int, stored: float) -> None:
    """Add the energy that a contact stored [J] to what is lost at the end of the last part."""
    march.lost[len(march.lost) - 1] += stored
    part = parts.written[PARTS] - 1
    if parts.kind[part] != STRETCH:
        return
    first = parts.first_row[part]
    for row in range(first, first + parts.contacts[part]):
        if parts.contact[row] == contact:
            parts.separation_loss[row] += stored
