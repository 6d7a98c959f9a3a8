"""Calls of a contact law in series with a quasi-static compliance, from compiled code.

The law's force is given by the address of a C function, so that one compiled core serves all laws;
in plain Python it is the function.
"""

from __future__ import annotations

import math

import numpy as np

from vibroimpact.arrays import Integers, Matrix, Vector
from vibroimpact.compiled import Address, compiled, compressed_at, energies_at, force_at, levels_at
from vibroimpact.dynamics.core.linear import write_row
from vibroimpact.dynamics.core.records import (
    FIRST_BREAKPOINT,
    JUMP,
    MEMORY_LEVEL,
    RELEASE,
    RELEASE_LEVEL,
    SECOND_BREAKPOINT,
    SPEED,
    TOUCH,
    Contacts,
    Law,
)

STATIC, DISSIPATIVE, APPROACH, SLOPE, STIFFNESS, BY_DELTA, BY_RATE = range(7)
"""Rows of a linearised law, which `linearise` writes."""

_LEAST_RADIUS = 1e-9  # of F_R's: below it the logarithm is held, or it would go to infinity
_STEP = 1e-7  # relative step of finite differences
_TINY = 1e-300
_CONVERGED = 1e-8  # relative Newton step, after which the next would be below rounding
_MOST_ITERATIONS = 60


@compiled
def series_indentation(series: Vector, force: float) -> tuple[float, float]:
    """Return the indentation of a compliance in series [m] at a force [N], and its derivative
    [m/N].

    `series` (7,): C, 1/(E R), c0, c1, c2, c3 and F_R of `contact.quasi_static.QuasiStatic`.
    """
    linear = series[0]
    unit = series[1]
    if unit == 0.0:
        return force * linear, linear
    # delta_s = F (C + f/(E R)) with f = c0 + c1 ln x + c2 x + c3 x^2 of x = (F/F_R)^(1/3), the
    # radius of a Hertzian contact over that at F_R
    x = max((abs(force) / series[6]) ** (1.0 / 3.0), _LEAST_RADIUS)
    logarithm = math.log(x)
    factor = series[2] + series[3] * logarithm + x * (series[4] + series[5] * x)
    # d(F f)/dF, where F dx/dF = x/3
    slope = (
        series[2]
        + series[3] * (logarithm + 1.0 / 3.0)
        + x * (4.0 / 3.0 * series[4] + 5.0 / 3.0 * series[5] * x)
    )
    return force * (linear + unit * factor), linear + unit * slope


@compiled
def is_in_series(series: Vector) -> bool:
    """Is there a compliance in series?"""
    return bool(series[0] != 0.0 or series[1] != 0.0)


@compiled
def indentation_at(
    law: Address,
    coefficients: Vector,
    speed: float,
    release: float,
    series: Vector,
    approach: float,
) -> float:
    """Return the indentation of a law [m] at an approach of the surfaces [m], at least that of
    release, to 1e-8 of it.

    By Newton's method, and by bisection where that goes to and fro between two branches of a law,
    as between those with and without its memory of a deeper indentation.
    """
    if not is_in_series(series):
        return max(approach, release)
    force = force_at(law)
    delta = max(approach, release)
    low = release
    high = math.inf
    is_bracketed = False
    change = math.inf
    for _ in range(_MOST_ITERATIONS):
        step = _STEP * (abs(delta) + _TINY)
        static, _ = force(delta, 0.0, speed, coefficients)
        deeper, _ = force(delta + step, 0.0, speed, coefficients)
        # Newton's method for delta + delta_s(F_s(delta)) = y; the dashpot has no part in it
        yielded, compliance = series_indentation(series, static)
        slope = 1.0 + compliance * (deeper - static) / step
        excess = delta + yielded - approach
        if excess < 0.0:
            low = delta
            is_bracketed = high < math.inf
        else:
            high = delta
        if not slope > 0.0:  # a negative compliance exceeds that of the law: no unique answer
            return delta
        nearer = max(delta - excess / slope, release)
        if nearer < low:
            nearer = 0.5 * (low + delta)
        # steps that do not halve go to and fro between two branches
        if is_bracketed and abs(nearer - delta) > 0.5 * change:
            nearer = 0.5 * (low + high)
        change = abs(nearer - delta)
        delta = nearer
        if change <= _CONVERGED * abs(delta) + _TINY:
            break
    return delta


@compiled
def linearise(
    law: Address,
    coefficients: Vector,
    speed: float,
    release: float,
    series: Vector,
    delta: Vector,
    rate: Vector,
    linear: Matrix,
) -> None:
    """Write forces, approach and derivatives of a law at N nodes into `linear` (7, N).

    Rows: static and dissipative force [N]; approach of the surfaces [m]; derivative of the approach
    by the indentation [-]; of the static force by it [N/m]; of the dissipative force by it [N/m]
    and by the rate [N s/m]. By finite differences; constant beyond release.
    """
    deepest = 0.0
    fastest = 0.0
    # steps of the largest indentation and rate of all nodes, as near touch a step of its own would
    # be below the rounding of the force
    for node in range(len(delta)):
        deepest = max(deepest, abs(max(delta[node], release)))
        fastest = max(fastest, abs(rate[node]))
    step = _STEP * (deepest + _TINY)
    faster = _STEP * (fastest + _TINY)
    force = force_at(law)
    in_series = is_in_series(series)
    for node in range(len(delta)):
        held = delta[node] > release
        reached = max(delta[node], release)
        static, dissipative = force(reached, rate[node], speed, coefficients)
        stiffness = 0.0
        by_delta = 0.0
        if held:
            deeper_static, deeper_dissipative = force(
                reached + step, rate[node], speed, coefficients
            )
            stiffness = (deeper_static - static) / step
            by_delta = (deeper_dissipative - dissipative) / step
        _, faster_dissipative = force(reached, rate[node] + faster, speed, coefficients)
        approach = delta[node]
        slope = 1.0
        if in_series:
            yielded, compliance = series_indentation(series, static)
            approach += yielded
            slope += compliance * stiffness
        linear[STATIC, node] = static
        linear[DISSIPATIVE, node] = dissipative
        linear[APPROACH, node] = approach
        linear[SLOPE, node] = slope
        linear[STIFFNESS, node] = stiffness
        linear[BY_DELTA, node] = by_delta
        linear[BY_RATE, node] = (faster_dissipative - dissipative) / faster


@compiled
def series_energy(series: Vector, force: float) -> float:
    """Return the energy of a compliance in series [J] at a force [N]; negative for a
    negative compliance.
    """
    linear = series[0]
    unit = series[1]
    if unit == 0.0:
        return float(0.5 * force * force * linear)
    x = max((abs(force) / series[6]) ** (1.0 / 3.0), _LEAST_RADIUS)
    # the integral of F (d delta_s/dF) dF, term by term, with the slope of `series_indentation`
    factor = (
        series[2]
        + series[3] * (math.log(x) + 1.0 / 6.0)
        + x * (8.0 / 7.0 * series[4] + 1.25 * series[5] * x)
    )
    return float(0.5 * force * force * (linear + unit * factor))


_TENSILE_POINTS = 2000
# of the approach by the indentation; at zero a contact snaps off, with 1e-4 less energy lost
_LEAST_SLOPE = 0.05


@compiled
def static_force(law: Law, delta: float) -> float:
    """Return the static force of a law [N] at an indentation [m]."""
    static, _ = force_at(law.addresses[0])(delta, 0.0, law.speed, law.coefficients)
    return float(static)


@compiled
def approach_at(law: Law, delta: float) -> float:
    """Return the approach of the surfaces [m] at an indentation of a law [m]."""
    if not is_in_series(law.series):
        return delta
    return delta + series_indentation(law.series, static_force(law, delta))[0]


@compiled
def law_indentation(law: Law, approach: float) -> float:
    """Return the indentation of a law [m] at an approach of the surfaces [m], at least
    that of release.
    """
    return indentation_at(
        law.addresses[0], law.coefficients, law.speed, law.release, law.series, approach
    )


@compiled
def stored_energy(law: Law, delta: float) -> float:
    """Return the energy that a law and the compliance in series store since touch [J], at
    an indentation of the law [m].
    """
    reached = max(delta, law.release)
    elastic, _ = energies_at(law.addresses[1])(reached, law.coefficients)
    if is_in_series(law.series):
        elastic += series_energy(law.series, static_force(law, reached)) - law.jump
    return float(elastic)


@compiled
def static_work(law: Law, delta: float) -> float:
    """Return the sum of the stored energy and the plastic work [J] at an indentation of a
    law [m].
    """
    _, plastic = energies_at(law.addresses[1])(max(delta, law.release), law.coefficients)
    return float(stored_energy(law, delta) + plastic)


@compiled
def law_of(contacts: Contacts, contact: int) -> Law:
    """Return the law of one of several contacts."""
    return Law(
        contacts.addresses[4 * contact : 4 * contact + 4],
        contacts.coefficients[contact],
        contacts.series[contact],
        contacts.numbers[contact, SPEED],
        contacts.numbers[contact, TOUCH],
        contacts.numbers[contact, RELEASE],
        contacts.numbers[contact, RELEASE_LEVEL],
        contacts.numbers[contact, MEMORY_LEVEL],
        contacts.numbers[contact, FIRST_BREAKPOINT],
        contacts.numbers[contact, SECOND_BREAKPOINT],
        contacts.numbers[contact, JUMP],
    )


@compiled
def room_for_laws(law: Law, laws: int, tension: int) -> Contacts:
    """Return room for so many laws of the kind of one, with the same `tension`."""
    return Contacts(
        np.empty(4 * laws, law.addresses.dtype),
        np.empty((laws, len(law.coefficients))),
        np.empty((laws, 7)),
        np.empty((laws, 8)),
        np.full(laws, tension),
    )


@compiled
def write_law_of(contacts: Contacts, contact: int, law: Law) -> None:
    """Write the law of one of several contacts."""
    for function in range(4):
        contacts.addresses[4 * contact + function] = law.addresses[function]
    write_row(contacts.coefficients, contact, law.coefficients)
    write_row(contacts.series, contact, law.series)
    numbers = contacts.numbers[contact]
    numbers[SPEED] = law.speed
    numbers[TOUCH] = law.touch
    numbers[RELEASE] = law.release
    numbers[RELEASE_LEVEL] = law.release_level
    numbers[MEMORY_LEVEL] = law.memory_level
    numbers[FIRST_BREAKPOINT] = law.first_breakpoint
    numbers[SECOND_BREAKPOINT] = law.second_breakpoint
    numbers[JUMP] = law.jump


@compiled
def contacts_of(law: Law, tension: int) -> Contacts:
    """Return the law of one contact as stretches take it."""
    contacts = room_for_laws(law, 1, tension)
    write_law_of(contacts, 0, law)
    return contacts


@compiled
def law_at_touch(addresses: Integers, coefficients: Vector, series: Vector, speed: float) -> Law:
    """Return a law of one contact with the levels that follow from its coefficients;
    `speed`: closing speed at touch [m/s].
    """
    _, _, memory_level, _, _ = levels_at(addresses[2])(coefficients)
    return law_beyond(addresses, coefficients, series, speed, memory_level)


@compiled
def law_beyond(
    addresses: Integers, coefficients: Vector, series: Vector, speed: float, memory_level: float
) -> Law:
    """Return a law of one contact whose memory changes beyond an indentation [m]."""
    touch, release, _, first, second = levels_at(addresses[2])(coefficients)
    law = Law(
        addresses,
        coefficients,
        series,
        speed,
        touch,
        release,
        release,
        memory_level,
        first,
        second,
        0.0,
    )
    if not is_in_series(series):
        return law
    if release < touch:  # a sticking contact may snap off before the law releases
        release = snap_off(law)
        law = Law(
            addresses,
            coefficients,
            series,
            speed,
            touch,
            release,
            release,
            memory_level,
            first,
            second,
            0.0,
        )
    # a force at touch, as by adhesion, pulls the compliance in series at once; stored energy is
    # counted from after that
    jump = 0.0
    if static_force(law, touch) != 0.0:
        delta = law_indentation(law, touch)
        elastic, _ = energies_at(addresses[1])(delta, coefficients)
        jump = elastic + series_energy(series, static_force(law, delta))
    return Law(
        addresses,
        coefficients,
        series,
        speed,
        touch,
        release,
        approach_at(law, release),
        memory_level,
        first,
        second,
        jump,
    )


@compiled
def snap_off(law: Law) -> float:
    """Return the indentation [m] at which a sticking contact with a compliance in series
    snaps off, or that at which its law releases.
    """
    deltas = np.empty(_TENSILE_POINTS)
    approaches = np.empty(_TENSILE_POINTS)
    # graded towards release, where the force of a sticking contact changes most steeply
    for point in range(_TENSILE_POINTS):
        deltas[point] = (
            law.release + (law.touch - law.release) * (point / (_TENSILE_POINTS - 1)) ** 6
        )
        approaches[point] = approach_at(law, deltas[point])
    # the contact is unstable where the surfaces would have to approach as the law is unloaded,
    # dy/d delta <= 0; the deepest such point is met first
    snapped = law.release
    for point in range(_TENSILE_POINTS):
        before = max(point - 1, 0)
        after = min(point + 1, _TENSILE_POINTS - 1)
        if approaches[after] - approaches[before] < _LEAST_SLOPE * (deltas[after] - deltas[before]):
            snapped = deltas[point]
    return snapped


@compiled
def law_after(law: Law, deepest: float) -> Law:
    """Return a law with its memory of a compression to an indentation [m]."""
    changed = law.coefficients.copy()
    memory_level = compressed_at(law.addresses[3])(deepest, law.coefficients, changed)
    return law_beyond(law.addresses, changed, law.series, law.speed, memory_level)


@compiled
def law_remembering(law: Law, deepest: float) -> Law:
    """Return a law after a compression to an indentation [m]: itself where that does not
    change its memory.
    """
    if deepest > law.memory_level:
        return law_after(law, deepest)
    return law
