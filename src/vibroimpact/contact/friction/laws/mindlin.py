"""Mindlin's stiffness as a single spring with history, as discrete-element codes have it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from vibroimpact.arrays import Drops, Floats
from vibroimpact.contact.friction.cubics import place_of_turn, place_of_value
from vibroimpact.contact.friction.law import CompliantFriction, Memory, Step, TangentialHistory


@dataclass(frozen=True, kw_only=True)
class Mindlin(CompliantFriction):
    r"""A single spring of Mindlin's stiffness, whose displacement is kept.

    .. math:: Q = 2 G^* a\, \xi,\qquad \dot\xi = \dot s,\qquad Q \le \mu F

    with a the radius of Hertz's contact under the normal force.

    Notes
    -----
    The stiffness is that of a contact without slip. As the contact shrinks, the spring gives back less than it was given, and the energy is
    lost. LAMMPS calls it `mindlin`; `mindlin-rescale` and `mindlin-force` are its variants.

    References
    ----------
    Mindlin, R. D. (1949). Compliance of elastic bodies in contact. J. Appl. Mech. 16, 259-268.

    Examples
    --------
    >>> Mindlin(coefficient=0.1, effective_modulus=60e9, effective_shear_modulus=50e9, effective_radius=2.5e-3).name
    'mindlin'
    """

    name = "mindlin"
    equation = "Q = 2 G* a xi, at most mu F"
    source = "Mindlin 1949, J. Appl. Mech. 16:259; LAMMPS, granular: mindlin"
    sliding_bound = 2.0 / 3.0
    sliding_energy = 4.0 / 15.0

    rescales: ClassVar[bool] = False
    """Does the displacement shrink with the radius of the contact?"""

    def memory(self, size: int) -> Memory:
        """Return springs without displacement; see `CompliantFriction`."""
        return RescaledSpring(size) if self.rescales else Spring(size)

    def history(self, largest_force: float) -> TangentialHistory:
        """Return a spring without displacement; see `CompliantFriction`."""
        return OneSpring(self, 0.0, np.zeros(2))

    def radius_under(self, force: float) -> float:
        """Return the radius of the contact of one drop under a normal force [N]."""
        return float(np.cbrt(0.75 * max(force, 0.0) * self.effective_radius / self.effective_modulus))


@dataclass(frozen=True, kw_only=True)
class MindlinRescale(Mindlin):
    r"""Mindlin's stiffness as a single spring, whose displacement shrinks with the contact.

    .. math:: Q = 2 G^* a\, \xi,\qquad \dot\xi = \dot s + \xi\, \min(\dot a, 0) / a,\qquad Q \le \mu F

    Notes
    -----
    So the unloading of the normal force does not make energy (Thornton and others 2013).

    References
    ----------
    Thornton, C., Cummins, S. J. and Cleary, P. W. (2013). An investigation of the comparative behaviour of alternative contact force
    models during inelastic collisions. Powder Technol. 233, 30-46.

    Examples
    --------
    >>> MindlinRescale(coefficient=0.1, effective_modulus=60e9, effective_shear_modulus=50e9, effective_radius=2.5e-3).rescales
    True
    """

    name = "mindlin-rescale"
    equation = "Q = 2 G* a xi, xi shrinks with a, at most mu F"
    source = "Thornton, Cummins & Cleary 2013, Powder Technol. 233:30; LAMMPS, granular: mindlin_rescale"
    rescales = True
    sliding_bound = 1.0 / 3.0


@dataclass(frozen=True, kw_only=True)
class MindlinForce(Mindlin):
    r"""Mindlin's stiffness as a single spring, whose force is kept.

    .. math:: \dot Q = 2 G^* a\, \dot s,\qquad Q \le \mu F

    Notes
    -----
    This is the stiffness of the contact as long as no point of it slips.

    References
    ----------
    Mindlin, R. D. and Deresiewicz, H. (1953). Elastic spheres in contact under varying oblique forces. J. Appl. Mech. 20, 327-344.

    Examples
    --------
    >>> MindlinForce(coefficient=0.1, effective_modulus=60e9, effective_shear_modulus=50e9, effective_radius=2.5e-3).name
    'mindlin-force'
    """

    name = "mindlin-force"
    equation = "dQ = 2 G* a ds, at most mu F"
    source = "Mindlin & Deresiewicz 1953, J. Appl. Mech. 20:327; LAMMPS, granular: mindlin/force"
    sliding_bound = 1.0
    sliding_energy = 0.4

    def memory(self, size: int) -> Memory:
        """Return contacts without a force; see `CompliantFriction`."""
        return KeptForce(size)

    def history(self, largest_force: float) -> TangentialHistory:
        """Return a contact without a force; see `CompliantFriction`."""
        return OneForce(self, 0.0, np.zeros(2))


class Spring:
    """Single springs of B contacts, whose displacement is kept; see `Memory`.

    The integral I is the radius of the contact times the displacement of the spring.
    """

    power: ClassVar[int] = 0

    def __init__(self, size: int) -> None:
        self.every, self.fresh = np.arange(size), True
        self.slides, self.next = np.zeros(size), np.zeros(size)  # 1 or -1 in the direction of sliding, or 0; now, and after the next turn

    def stuck(self, step: Step) -> Floats:
        """Return the integral at the end of a step without sliding."""
        return np.asarray(np.sqrt(step.depth[2]) * (_over(step.integral[0], np.sqrt(step.depth[0])) + step.integral[2]))

    def growth(self, deepening: Floats) -> Floats | float:
        """Return the power of the depth with which the integral changes while the displacement is kept."""
        return 0.5

    def least_rate(self, deepening: Floats) -> Floats:
        """Return the rate of the displacement above which springs slide on, from that of the depth."""
        return (2.0 / 3.0) * deepening

    def slide(self, drops: Drops, depth: Floats, displacement: Floats, integral: Floats) -> Floats:
        """Let springs begin that have slid so far; see `Memory`."""
        slides = self.slides[drops] = np.sign(integral)
        return self._with_derivatives(integral, slides, *depth)

    def turns(self, drops: Drops, step: Step) -> tuple[Drops, Floats, Floats]:
        """Return which springs begin or cease to slide, and where; see `Memory`."""
        integral = self.stuck(step)
        (start, deepening_before, depth, deepening), sign = step.depth, np.sign(integral)
        over = sign * integral - (2.0 / 3.0) * depth**1.5
        if self.fresh:
            self.slides[drops], self.fresh = np.where(over > 0.0, sign, 0.0), False
        slides = self.slides[drops]
        ends = [slides * step.displacement[end] - self.least_rate(step.depth[end]) for end in (1, 3)]
        some = np.flatnonzero(np.where(slides == 0.0, over > 0.0, ends[1] < 0.0))
        before, after = ends[0][some], ends[1][some]
        ceasing = np.clip(_over(before, before - after), 0.0, 1.0)
        change = over - sign * step.integral[0] + (2.0 / 3.0) * start**1.5
        slope = sign * step.integral[1] - np.sqrt(start) * deepening_before
        slope_there = (
            sign * (np.sqrt(depth) * step.displacement[3] + self.growth(deepening) * _over(integral, depth) * deepening)
            - np.sqrt(depth) * deepening
        )
        beginning = place_of_value(*(one[some] for one in (change, slope, slope_there, over)))
        self.next[self.every[drops][some]] = np.where(slides == 0.0, sign, 0.0)[some]
        return some, np.where(slides[some] == 0.0, beginning, ceasing), np.ones(len(some))

    def turn(self, drops: Drops, depth: Floats, force: Floats) -> Floats:
        """Let springs begin or cease to slide; see `Memory`."""
        slides = self.slides[drops] = self.next[drops]
        return self._with_derivatives(force[0], slides, *depth)

    def _with_derivatives(self, integral: Floats, slides: Floats, depth: Floats, deepening: Floats) -> Floats:
        """Return integrals with their derivatives by displacement and by depth (3, b)."""
        radius, sticks = np.sqrt(depth), slides == 0.0
        by_depth = np.where(sticks, self.growth(deepening) * _over(integral, depth), slides * radius)
        return np.array([integral, np.where(sticks, radius, 0.0), by_depth])

    def advance(self, drops: Drops, step: Step) -> Floats:
        """Stretch the springs, or slide; return the integral and its derivatives. See `Memory`."""
        slides, most = self.slides[drops], (2.0 / 3.0) * step.depth[2] ** 1.5
        integral = np.where(slides == 0.0, np.clip(self.stuck(step), -most, most), slides * most)
        return self._with_derivatives(integral, slides, *step.depth[2:])


class RescaledSpring(Spring):
    """The same, with a displacement that shrinks with the contact."""

    power: ClassVar[int] = -1

    def turns(self, drops: Drops, step: Step) -> tuple[Drops, Floats, Floats]:
        """Return which springs begin or cease to slide or to shrink, and where; see `Memory`."""
        some, found, _ = super().turns(drops, step)
        places, every = np.full(step.depth.shape[1], np.inf), self.every[drops]
        places[some] = found
        shrinks = np.flatnonzero((step.depth[1] > 1e-9 * step.depth[0]) & (step.depth[3] < 0.0))
        peaks = place_of_turn(step.depth[:, shrinks])
        earlier = peaks < places[shrinks]
        first = shrinks[earlier]
        places[first] = peaks[earlier]
        self.next[every[first]] = self.slides[every[first]]
        some = np.flatnonzero(places < np.inf)
        return some, places[some], np.ones(len(some))

    def stuck(self, step: Step) -> Floats:
        """Return the integral at the end of a step without sliding."""
        (before, _, depth, _), moved = step.depth, step.displacement[2] - step.displacement[0]
        shrunk = depth * (_over(step.integral[0], before) + step.integral[2])
        return np.asarray(np.where(depth > before, np.sqrt(depth) * (_over(step.integral[0], np.sqrt(before)) + moved), shrunk))

    def growth(self, deepening: Floats) -> Floats:
        """Return the power of the depth with which the integral changes while the displacement is kept."""
        return np.where(deepening > 0.0, 0.5, 1.0)

    def least_rate(self, deepening: Floats) -> Floats:
        """Return the rate of the displacement above which springs slide on, from that of the depth."""
        return np.where(deepening > 0.0, 2.0 / 3.0, 1.0 / 3.0) * deepening


class KeptForce(Spring):
    """The same, whose force is kept."""

    power: ClassVar[int] = 1

    def stuck(self, step: Step) -> Floats:
        """Return the integral at the end of a step without sliding."""
        return np.asarray(step.integral[0] + step.integral[2])

    def growth(self, deepening: Floats) -> float:
        """Return the power of the depth with which the integral changes while the displacement is kept."""
        return 0.0

    def least_rate(self, deepening: Floats) -> Floats:
        """Return the rate of the displacement above which springs slide on, from that of the depth."""
        return deepening


def _over(one: Floats, other: Floats) -> Floats:
    """Return a quotient, and 0 where it is by 0."""
    return np.divide(one, other, out=np.zeros_like(one), where=other > 0.0)


@dataclass(frozen=True)
class OneSpring:
    """Spring of one contact in two directions; see `TangentialHistory`. `radius` of the contact [m], `stretch` [m] (2,)."""

    law: Mindlin
    radius: float
    stretch: Floats
    slid: float = 0.0

    def after(self, force: float, moved: Floats) -> tuple[OneSpring, Floats]:
        """Stretch the spring, at most to sliding."""
        law, radius = self.law, self.law.radius_under(force)
        kept = radius / self.radius if law.rescales and radius < self.radius else 1.0
        stretch, stiffness = self.stretch * kept + moved * (0.5 * (1.0 + kept)), 2.0 * float(law.effective_shear_modulus) * radius
        bounded = _kept(stiffness * stretch, float(law.coefficient) * force)
        slid, stretch = (1.0 - bounded) * float(np.hypot(*stretch)), stretch * bounded
        return OneSpring(law, radius, stretch, slid), stiffness * stretch


@dataclass(frozen=True)
class OneForce:
    """Kept force of one contact in two directions; see `TangentialHistory`. `radius` of the contact [m], `force` [N] (2,)."""

    law: Mindlin
    radius: float
    force: Floats
    slid: float = 0.0

    def after(self, force: float, moved: Floats) -> tuple[OneForce, Floats]:
        """Change the force as without slip, by the mean stiffness on the way, at most to sliding."""
        law, radius = self.law, self.law.radius_under(force)
        stiffness = float(law.effective_shear_modulus) * (self.radius + radius)
        pulled = self.force + stiffness * moved
        bounded = _kept(pulled, float(law.coefficient) * force)
        slid, pulled = (1.0 - bounded) * float(np.hypot(*pulled)) / max(stiffness, 1e-300), pulled * bounded
        return OneForce(law, radius, pulled, slid), pulled


def _kept(pulled: Floats, most: float) -> float:
    """Return the part of a force that is left where its magnitude may be no more than `most` [N]."""
    strength = float(np.hypot(*pulled))
    return max(most, 0.0) / strength if strength > max(most, 0.0) else 1.0
