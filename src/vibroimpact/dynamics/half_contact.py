"""Half a contact solved at once in the phase plane: the way in, whose depth is sought, or the way out."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from vibroimpact.dynamics.collocation import Floats
from vibroimpact.dynamics.contact import Drops
from vibroimpact.dynamics.encounter import Encounter
from vibroimpact.dynamics.plane_rule import PlaneRule

Way = Literal["in", "out"]

_FEW = 0.5  # the part of the drops that goes on alone rather than let all of them wait
_LEAST = 1e-13  # rounding


@dataclass(frozen=True)
class HalfContact:
    """Half a contact of B drops; arrays are (N, B) at the nodes, or (B,).

    `depth`: deepest indentation [m]. `squares`: w/y^2 at the nodes [m^2/s^2]. `touch_square`: w at first touch or
    release. `force`: at the nodes [N]. `duration` [s]. `dissipated` [J]. `solved`: to the tolerance?
    """

    depth: Floats
    squares: Floats
    touch_square: Floats
    force: Floats
    duration: Floats
    dissipated: Floats
    solved: NDArray[np.bool_]

    def put(self, drops: Drops, other: HalfContact) -> None:
        """Take over the halves of some drops."""
        for name, values in vars(self).items():
            values[..., drops] = getattr(other, name)


def solve_half(
    encounter: Encounter, rule: PlaneRule, way: Way, depth: Floats, squares: Floats, tolerance: float, sweeps: int
) -> HalfContact:
    r"""Solve one way of a contact of B drops by Newton's method, each drop on its own.

    With d the defect of u, the linearised equation for its correction e is a scalar one, and solved by quadrature:

    .. math:: y^2 e = y^2 d + M \int_0^y \frac{z G_u d}{M} dz,\qquad M = \exp \int_0^y \frac{G_u}{z} dz,
              \qquad G_u = -\frac{d\delta/dy}{y}\, \frac{F_d}{m u}

    for a dissipative force F_d that goes with the rate, as nearly all do; for others it takes more sweeps. On the way in
    the logarithm of the depth is corrected beside it, so that w at first touch is the square of the approach speed.

    Parameters
    ----------
    encounter : Encounter
        The impact.
    rule : PlaneRule
        Nodes and matrices.
    way : {"in", "out"}
        Which half.
    depth : array, shape (B,)
        The deepest indentation [m]: a guess on the way in, known on the way out.
    squares : array, shape (N, B)
        A guess of w/y^2 at the nodes.
    tolerance : float
        Relative error allowed, of the approach speed.
    sweeps : int
        How often to improve at most.
    """
    law, mass, gravity, speed = encounter.law, encounter.mass, encounter.gravity, encounter.approach_speed
    touch, per_mass, coming = speed * speed, -1.0 / mass, way == "in"
    signed = rule.nodes if coming else -rule.nodes
    close, static_power, loss_power = max(0.1 * tolerance, _LEAST) * touch, *_powers(encounter)
    for sweep in range(sweeps + 1):
        stretch = (2.0 * depth) * rule.slope
        velocity = np.sqrt(squares)
        velocity *= signed
        static, dissipative = law.forces(depth * rule.shape, velocity, speed)
        force = static + dissipative
        rate = force * per_mass
        rate += gravity
        rate *= stretch
        defect = rule.mean @ rate
        end = defect[-1].copy()
        defect = defect[:-1]
        defect -= squares
        missing = touch - end if coming else np.zeros_like(end)
        apart = np.maximum(np.maximum(defect.max(axis=0), -defect.min(axis=0)), np.abs(missing))
        settled = apart <= close
        if sweep == sweeps or np.count_nonzero(~settled) <= _FEW * len(settled):
            break
        by_square = dissipative * stretch
        by_square /= squares
        by_square *= 0.5 * per_mass
        growth = rule.integral @ (by_square * rule.per_node)
        np.exp(growth, out=growth)
        shrunk = 1.0 / growth[:-1]
        by_square *= defect
        by_square *= shrunk
        change = rule.mean @ by_square
        change *= growth
        defect += change[:-1]
        if coming:  # what a deeper indentation changes, by the powers with which the forces grow
            static *= per_mass * (1.0 + static_power)
            static += (per_mass * (1.0 + loss_power)) * dissipative
            static += gravity
            static *= stretch
            static *= shrunk
            by_depth = rule.mean @ static
            by_depth *= growth
            deeper = np.clip((missing - change[-1]) / by_depth[-1], -0.5, 0.3)
            defect += deeper * by_depth[:-1]
            depth = depth * np.exp(deeper)
        squares = np.maximum(squares + defect, 0.1 * squares)
    pace = stretch / np.sqrt(squares)
    spans = -0.5 * (rule.weights @ pace)
    # the ends are off by the square of the last terms, what lies between by a small part of them
    little = min(tolerance**0.5, 3e3 * tolerance)
    smooth = (_last(rule, rate) <= little * touch) & (_last(rule, pace) <= little * spans)
    if coming:  # all of the static work must be there, or the depth is off
        work = -0.5 * (rule.weights @ (static * rule.nodes * stretch))
        stored = law.elastic_energy(depth) + law.plastic_work(depth)
        smooth &= np.abs(work - stored) <= 0.05 * tolerance * mass * touch
    lost = -0.5 * (rule.weights @ (dissipative * signed * stretch))
    found = HalfContact(depth, squares, end, force, spans, lost, settled & smooth)
    late = np.flatnonzero(~settled)
    if late.size and sweep < sweeps:
        found.put(late, solve_half(encounter.pick(late), rule, way, depth[late], squares[:, late], tolerance, sweeps - sweep))
    return found


def _last(rule: PlaneRule, values: Floats) -> Floats:
    return np.asarray(np.abs(rule.last @ values).max(axis=0))


def _powers(encounter: Encounter) -> tuple[Floats, Floats]:
    """Return the powers of the indentation with which the static and the dissipative force grow, half way down."""
    forces, speed = encounter.law.forces, encounter.approach_speed
    before, after = (forces(part * encounter.depth, 0.7 * speed, speed) for part in (0.5, 0.55))
    powers = [np.log(late / early) / np.log(1.1) for early, late in zip(before, after, strict=True)]
    return powers[0], np.where(before[1] > 0.0, powers[1], 0.0)
