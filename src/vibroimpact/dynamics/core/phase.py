r"""A segment of a phase of the contact of two rigid bodies, collocated as a whole: the speed over
the indentation.

A phase, compression or restitution, is divided where the force is not smooth. In a segment y goes
from 0 at its deep end to 1 at its
shallow one, and the indentation is :math:`\delta = \delta_1 + (\delta_0 - \delta_1)\, s(y)`, with
:math:`s = 1 - y^2`, so that it is smooth
in y also just beyond a point where the speed is zero; that is raised to the power p, the root of
the law, in a segment that ends at touch. The square of the speed, :math:`w = f^2 u` with f = y in a
segment where the speed becomes zero and f = 1 else, is smooth in y throughout. It is collocated at
N Gauss nodes, with the acceleration a:

.. math:: \frac{dw}{dy} = 2 a(\delta, \pm\sqrt w)\, \frac{d\delta}{dy} = f\, G(y),
          \qquad u(y) = \frac1{f^2} \left(w(0) + \int_0^y f\, G(z)\, dz\right)

which is of order 2N - 1 at y = 1 (Hairer, Lubich and Wanner 2006, section II.1), and so is the
time, :math:`dt = d\delta/\sqrt w`.
"""

from __future__ import annotations

import math

from vibroimpact.arrays import Matrix
from vibroimpact.compiled import compiled, energies_at, force_at, multiply_row
from vibroimpact.dynamics.core.line_records import Line
from vibroimpact.dynamics.core.phase_records import (
    AT_TOUCH_INWARD,
    BEFORE_LAST,
    BY_DEPTH,
    BY_LENGTH,
    BY_SQUARE,
    CHANGE,
    DEFECT,
    DELTA,
    FACTOR,
    FALL,
    GROWTH,
    KINDS,
    LAST,
    LOSS,
    PACE,
    PER_FACTOR,
    RATE,
    REACHED,
    SHAPE,
    SHRUNK,
    SLOPE,
    SPEED,
    SQUARE,
    STATIC,
    SUMMAND,
    WEIGHT,
    Phase,
    PhaseRules,
    Segment,
)

_SWEEPS = 12
_FRESH = 2  # sweeps with derivatives of their own, after which they change too little to matter
_CLOSE = 0.1  # of the tolerance: defect of a solution
_ROUNDING = 1e-13
_FAST = 1e-2  # of the defect before: one that falls so fast is about to vanish
_DOUBT = 2.0  # times as much as it seems may be left of it
_SHORTER, _LONGER = -0.5, 0.35  # bounds of the change of the logarithm of a length in one sweep
_LEAST = 1e-3  # of the square of the approach speed: starting value of u
_LEAST_OF_BEFORE = 0.1  # of u, in one sweep
_MOST_DAMPED = 3.0  # bound of p, below the radius of convergence 2 sqrt(pi) of its series
_SMALL_DAMPING = 1e-3  # below it the logarithm loses digits
_LARGEST_LOSS = -0.9  # of the static force; beyond it the logarithm is of no use
_OF_WORK = 0.05  # of the tolerance: error of the static work


@compiled
def undamped_square(damping: float, relative_speed: float) -> float:
    r"""Return the square that a relative speed x would have without damping:
    :math:`2 (D x - \ln(1 + D x))/D^2`.
    """
    by_damping = damping * relative_speed
    if abs(by_damping) < _SMALL_DAMPING or by_damping <= _LARGEST_LOSS:
        return relative_speed * relative_speed / (1.0 + 2.0 / 3.0 * by_damping)
    return 2.0 * (by_damping - math.log1p(by_damping)) / (damping * damping)


@compiled
def damped_speed(damping: float, undamped: float) -> float:
    r"""Return the relative speed x whose `undamped_square` this is, nearly.

    Since :math:`1 + D x = -W(-e^{-1 - p^2/2})` with Lambert's W and p, D times the speed without
    damping, x is a series in p about the branch point (Corless et al. 1996, eq. 4.22).
    """
    speed = math.sqrt(undamped)
    p = min(max(damping * speed, -_MOST_DAMPED), _MOST_DAMPED)
    series = 1.0 / 36.0 + p * (-1.0 / 270.0 + p * (1.0 / 4320.0 + p * (1.0 / 17010.0)))
    return speed * (1.0 + p * (1.0 / 3.0 + p * series))


@compiled
def start_phase(
    line: Line, rules: PhaseRules, segment: Segment, room: Matrix
) -> tuple[float, float, float, float]:
    r"""Write starting values of u, and return the length [m], the powers of the indentation with
    which both forces grow, and the potential at the shallow end [J].

    Under a force :math:`F_s (1 + D\, \dot\delta/v)`, with the approach speed v, the equation of
    motion is separable: the static work since the speed x v was zero is
    :math:`m v^2 (D x - \ln(1 + D x))/D^2` (`undamped_square`), which is solved for x. D is taken
    from the forces in the middle of the segment.
    """
    force = force_at(line.force)
    energies = energies_at(line.energies)
    coefficients = line.coefficients
    vectors = rules.vectors
    speed = line.speed
    shallow = segment.shallow
    span = segment.deep - shallow
    sign = segment.sign
    weight = line.mass * line.gravity
    touch = speed * speed
    middle_rate = 0.7 * sign * speed
    static, loss = force(shallow + 0.5 * span, middle_rate, speed, coefficients)
    damping = 0.0
    if static > weight and loss * sign > 0.0:
        damping = loss / (0.7 * (static - weight))
    elastic, plastic = energies(shallow, coefficients)
    low = elastic + plastic - weight * shallow
    elastic, plastic = energies(shallow + span, coefficients)
    high = elastic + plastic - weight * (shallow + span)
    known = math.sqrt(max(segment.begun, segment.wanted)) / speed
    begun = undamped_square(damping, known)
    by_work = 2.0 / (line.mass * touch)
    static_power = 0.0
    loss_power = 0.0
    if segment.wanted > 0.0:
        static_deeper, loss_deeper = force(shallow + 0.55 * span, middle_rate, speed, coefficients)
        static_power = 21.0 * (static_deeper - static) / (static_deeper + static)
        if loss > 0.0:
            loss_power = 21.0 * (loss_deeper - loss) / (loss_deeper + loss)
        for _ in range(2):  # of powers, of which static forces mostly are sums
            span *= (begun / (by_work * (high - low))) ** (1.0 / (1.0 + max(static_power, 0.0)))
            elastic, plastic = energies(shallow + span, coefficients)
            high = elastic + plastic - weight * (shallow + span)
        by_work = begun / (high - low)
        begun = 0.0
    elif sign > 0.0:
        high = low
    vector = segment.kind
    width = (rules.counts[0] + 8) // 8 * 8
    for node in range(width):
        delta = shallow + span * vectors[vector, SHAPE, node]
        elastic, plastic = energies(delta, coefficients)
        room[SQUARE, node] = elastic + plastic - weight * delta
    for node in range(width):
        undamped = max(begun + by_work * (high - room[SQUARE, node]), 0.0)
        relative_speed = damped_speed(damping, undamped)
        per_speed = vectors[vector, PER_FACTOR, node] * relative_speed
        room[SQUARE, node] = touch * max(per_speed * per_speed, _LEAST)
    return span, static_power, loss_power, low


@compiled
def solve_phase(
    line: Line, rules: PhaseRules, segment: Segment, roughness: float, sharper: float, room: Matrix
) -> Phase:
    r"""Solve a segment of a phase by Newton's method, with more nodes until it is resolved.

    With d the residual of u, the linearised equation for its correction e is scalar, and is solved
    by quadrature:

    .. math::

        e = d + M \int_0^y \frac{J d}{M} dz,\qquad M = \exp \int_0^y J\, dz,\qquad
        J = -\frac{d\delta}{dy}\, \frac{F_d}{m w}

    for a dissipative force F_d proportional to the indentation rate, as nearly all are; for others
    it takes more iterations. Where the deep end is sought, the logarithm of the length is corrected
    as well, so that the speed at the shallow end is the one wanted.

    Parameters
    ----------
    line : Line
        The bodies and their law.
    rules : PhaseRules
        The Gauss rules.
    segment : Segment
        The segment.
    roughness : float
        The last Legendre coefficients allowed.
    sharper : float
        Times as small those of G have to be, on which the motion between the nodes depends, while a
        larger number of nodes is left.
    room : array, shape (19, M)
        Room; the motion stays in it.
    """
    force = force_at(line.force)
    energies = energies_at(line.energies)
    vectors = rules.vectors
    matrices = rules.matrices
    coefficients = line.coefficients
    speed = line.speed
    sign = segment.sign
    shallow = segment.shallow
    begun = segment.begun
    touch = speed * speed
    weight = line.mass * line.gravity
    worked = _OF_WORK * rules.tolerance * line.mass * touch
    gravity = 2.0 * line.gravity
    per_mass = 1.0 / line.mass
    is_sought = segment.wanted > 0.0
    close = max(_CLOSE * rules.tolerance, _ROUNDING) * touch
    span, static_power, loss_power, low = start_phase(line, rules, segment, room)
    static_part = -2.0 * per_mass * (1.0 + static_power)
    loss_part = -2.0 * per_mass * (1.0 + loss_power)
    rule = 0
    vector = segment.kind
    matrix = 2 * segment.kind
    count = rules.counts[0]
    width = (count + 8) // 8 * 8
    for row in (STATIC, LOSS, DEFECT):
        for node in range(count, width):
            room[row, node] = 0.0
    before = 0.0
    contraction = 1.0
    sweep = 0
    solved_span = span
    duration = 0.0
    work = 0.0
    rough = math.inf
    solved = False
    high = low
    is_lossy = False
    for _ in range(len(rules.counts) * _SWEEPS):
        # only the force is not computed in vectors of eight
        for node in range(width):
            room[SLOPE, node] = span * vectors[vector, FALL, node]
            room[DELTA, node] = shallow + span * vectors[vector, SHAPE, node]
            room[SPEED, node] = sign * vectors[vector, FACTOR, node] * math.sqrt(room[SQUARE, node])
        for node in range(count):
            static, loss = force(room[DELTA, node], room[SPEED, node], speed, coefficients)
            room[STATIC, node] = static
            room[LOSS, node] = loss
        for node in range(width):
            static = room[STATIC, node]
            loss = room[LOSS, node]
            slope = room[SLOPE, node]
            by_square = -per_mass * loss * slope / room[SQUARE, node]
            room[RATE, node] = (gravity - 2.0 * per_mass * (static + loss)) * slope
            room[BY_SQUARE, node] = by_square
            room[SUMMAND, node] = by_square * vectors[vector, PER_FACTOR, node]
            room[BY_LENGTH, node] = (static_part * static + loss_part * loss + gravity) * slope
        multiply_row(room, RATE, matrices, matrix, width, width, REACHED)
        missing = segment.wanted - room[REACHED, count] if is_sought else 0.0
        apart = abs(missing)
        for node in range(count + 1):
            defect = begun + room[REACHED, node] - room[SQUARE, node]
            room[DEFECT, node] = defect
            apart = max(apart, abs(defect))
        if not apart < math.inf:
            break
        # the first correction with more nodes is as good as the last one before
        if rule > 0 and sweep == 0:
            before = apart / contraction
        settled = apart <= close or (
            apart <= _FAST * before and _DOUBT * apart * (apart / before) <= close
        )
        contraction = apart / before if before > 0.0 else 1.0
        before = apart
        solved_span = span
        if sweep < _FRESH:
            multiply_row(room, SUMMAND, matrices, matrix + 1, width, width, GROWTH)
            for node in range(width):  # the exponential, as closely as Newton's method needs it
                part = 0.125 * room[GROWTH, node]
                part = 1.0 + part * (
                    1.0
                    + part
                    * (1.0 / 2.0 + part * (1.0 / 6.0 + part * (1.0 / 24.0 + part * (1.0 / 120.0))))
                )
                part *= part
                part *= part
                part *= part
                room[GROWTH, node] = part
                room[SHRUNK, node] = 1.0 / part
        for node in range(width):
            room[SUMMAND, node] = room[BY_SQUARE, node] * room[DEFECT, node] * room[SHRUNK, node]
        multiply_row(room, SUMMAND, matrices, matrix, width, width, CHANGE)
        longer = 0.0
        if is_sought:  # derivative by the length, with forces taken as powers of the indentation
            if sweep < _FRESH:
                for node in range(width):
                    room[SUMMAND, node] = room[BY_LENGTH, node] * room[SHRUNK, node]
                multiply_row(room, SUMMAND, matrices, matrix, width, width, BY_DEPTH)
            longer = (missing / room[GROWTH, count] - room[CHANGE, count]) / room[BY_DEPTH, count]
            longer = min(max(longer, _SHORTER), _LONGER)
            span *= 1.0 + longer if longer > 0.0 else math.exp(longer)
        for node in range(width):
            square = room[SQUARE, node]
            change = room[DEFECT, node] + room[GROWTH, node] * (
                room[CHANGE, node] + longer * room[BY_DEPTH, node]
            )
            room[SQUARE, node] = max(square + change, _LEAST_OF_BEFORE * square)
        sweep += 1
        if not settled:
            if sweep == _SWEEPS:
                break
            continue
        for node in range(width):
            room[PACE, node] = -room[SLOPE, node] / math.sqrt(room[SQUARE, node])
        duration = 0.0
        work = 0.0
        rough_rate = 0.0
        rough_rate_before = 0.0
        rough_pace = 0.0
        rough_pace_before = 0.0
        is_lossy = False
        for node in range(count):
            pace = room[PACE, node]
            rate = room[RATE, node]
            duration += vectors[vector, WEIGHT, node] * pace
            work -= (
                vectors[vector, WEIGHT, node]
                * room[STATIC, node]
                * room[SLOPE, node]
                * vectors[vector, FACTOR, node]
            )
            rough_rate += vectors[vector, LAST, node] * rate
            rough_rate_before += vectors[vector, BEFORE_LAST, node] * rate
            rough_pace += vectors[vector, LAST, node] * pace
            rough_pace_before += vectors[vector, BEFORE_LAST, node] * pace
            is_lossy = is_lossy or room[LOSS, node] != 0.0
        duration *= span / solved_span
        rough = max(abs(rough_rate), abs(rough_rate_before)) / touch
        if rule < len(rules.counts) - 1:
            rough *= sharper
        rough = max(rough, 2.0 * max(abs(rough_pace), abs(rough_pace_before)) / duration)
        elastic, plastic = energies(shallow + solved_span, coefficients)
        high = elastic + plastic - weight * (shallow + solved_span)
        if rough <= roughness and abs(work - (high - low + weight * solved_span)) <= worked:
            solved = True
            break
        if rule == len(rules.counts) - 1:
            break
        rule += 1
        at_end = room[SQUARE, count]
        vector += KINDS
        matrix += 2 * KINDS
        count = rules.counts[rule]
        width = (count + 8) // 8 * 8
        multiply_row(room, SQUARE, rules.onward, rule, width, width, SUMMAND)
        for node in range(width):
            room[SQUARE, node] = room[SUMMAND, node] if node < count else at_end
        for row in (STATIC, LOSS, DEFECT):
            for node in range(count, width):
                room[row, node] = 0.0
        before = 0.0
        sweep = 0
        rough = math.inf
    deep = shallow + span
    reached = segment.wanted if is_sought else room[SQUARE, count]
    lost = 0.0
    # what is missing in the balance of energy, which is more accurate than the work of the
    # dissipative force
    if is_lossy:
        if is_sought:
            elastic, plastic = energies(deep, coefficients)
            high = elastic + plastic - weight * deep
        gained = reached - begun if segment.kind < AT_TOUCH_INWARD else begun - reached
        lost = sign * (0.5 * line.mass * gained - high + low)
    return Phase(solved, rule, deep, reached, duration, lost, rough)
