"""Motion and energy of contacts through a solved stretch."""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Vector
from vibroimpact.compiled import compiled
from vibroimpact.dynamics.core.linear import less_product
from vibroimpact.dynamics.core.records import (
    RELEASE_LEVEL,
    Basis,
    Contacts,
    Histories,
    Motion,
    Nodes,
    Start,
    Surfaces,
)
from vibroimpact.dynamics.core.stretch import begun_rate


@compiled
def contact_histories(
    basis: Basis,
    surfaces: Surfaces,
    contacts: Contacts,
    start: Start,
    begun: Vector,
    found: Nodes,
    motion: Motion,
    length: float,
) -> Histories:
    """Return motion and energy of the contacts through a solved stretch; `begun`:
    indentations of the laws at the start [m] (c,).
    """
    nodes = len(basis.time)
    number = len(begun)
    approaches = less_product(motion.approach, motion.approach_by_force, found.force)
    if len(motion.approach_by_static):
        approaches = less_product(approaches, motion.approach_by_static, found.static)
    rates = less_product(motion.rate, motion.rate_by_force, found.force)
    closings = less_product(motion.closing, motion.rate_by_force, found.force)
    if len(motion.closing_by_static):
        closings = less_product(closings, motion.closing_by_static, found.static)
    approach = np.empty((number, nodes + 1))
    rate = np.empty((number, nodes + 1))
    closing = np.empty((number, nodes + 1))
    delta = np.empty((number, nodes + 1))
    dissipated = np.zeros(number)
    roughness = 0.0
    for contact in range(number):
        first = contact * nodes
        approach[contact, 0] = max(
            start.approach[contact], contacts.numbers[contact, RELEASE_LEVEL]
        )
        delta[contact, 0] = begun[contact]
        first_rate = begun_rate(surfaces, start, contact)
        if surfaces.incidence[contact].any():  # the rate of a massless element jumps with the force
            first_rate = 0.0
            for node in range(nodes):
                first_rate += basis.at_start[node] * rates[first + node]
        rate[contact, 0] = first_rate
        closing[contact, 0] = first_rate + start.inner_rate[contact]
        fastest = abs(first_rate)
        for node in range(nodes):
            approach[contact, node + 1] = approaches[first + node]
            rate[contact, node + 1] = rates[first + node]
            closing[contact, node + 1] = closings[first + node]
            delta[contact, node + 1] = found.delta[first + node]
            fastest = max(fastest, abs(rates[first + node]))
            power = (found.force[first + node] - found.static[first + node]) * rates[first + node]
            dissipated[contact] += length * basis.integral[nodes - 1, node] * power
        # roughness: the last two Legendre coefficients of the force over the largest
        largest = surfaces.mass[contact] * fastest / length
        last = 0.0
        for order in range(nodes):
            coefficient = 0.0
            for node in range(nodes):
                coefficient += basis.spectrum[order, node] * found.force[first + node]
            largest = max(largest, abs(coefficient))
            if order >= nodes - 2:
                last = max(last, abs(coefficient))
        roughness = max(roughness, last / largest)
    return Histories(approach, rate, closing, delta, dissipated, roughness)
