"""Mindlin's stiffness as a single spring with history, as discrete-element codes have it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from vibroimpact.arrays import Drops, Floats
from vibroimpact.contact.friction.law import CompliantFriction, Memory, Pair, TangentialHistory


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

    rescales: ClassVar[bool] = False
    """Does the displacement shrink with the radius of the contact?"""

    def memory(self, size: int, steps: int) -> Memory:
        """Return springs without displacement; see `CompliantFriction`."""
        return Spring(size, rescales=self.rescales)

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

    def memory(self, size: int, steps: int) -> Memory:
        """Return contacts without a force; see `CompliantFriction`."""
        return KeptForce(size)

    def history(self, largest_force: float) -> TangentialHistory:
        """Return a contact without a force; see `CompliantFriction`."""
        return OneForce(self, 0.0, np.zeros(2))


class Spring:
    """Displacements of B springs; see `Memory`."""

    def __init__(self, size: int, *, rescales: bool) -> None:
        self.rescales = rescales
        self.stretch, self.before, self.radius = np.zeros(size), np.zeros(size), np.zeros(size)

    def advance(self, drops: Drops, depth: Floats, displacement: Floats, sticking: Floats, rates: Pair) -> Pair:
        """Stretch the springs, at most to sliding; return force and rate as integrals. See `Memory`."""
        radius, stretch = np.sqrt(depth), self.stretch[drops]
        with np.errstate(divide="ignore", invalid="ignore"):
            shrinks = self.rescales & (radius < self.radius[drops])
            shrink = np.where(shrinks, radius / self.radius[drops], 1.0)
            mean = 0.5 * (1.0 + shrink)  # what is added on the way shrinks too
            stretch = stretch * shrink + mean * displacement - mean * self.before[drops]
            widens = np.where(radius > 0.0, 0.5 * rates[0] / radius, 0.0)
        most = (2.0 / 3.0) * depth
        slides = np.abs(stretch) > most
        stretch = np.clip(stretch, -most, most)
        self.stretch[drops], self.before[drops], self.radius[drops] = stretch, displacement, radius
        shrinking = np.where(self.rescales & (widens < 0.0), 2.0, 1.0) * stretch * widens
        return radius * stretch, np.where(slides, np.sign(stretch) * radius * rates[0], radius * rates[1] + shrinking)


class KeptForce:
    """Forces of B contacts; see `Memory`."""

    def __init__(self, size: int) -> None:
        self.integral, self.start = np.zeros(size), np.zeros(size)

    def advance(self, drops: Drops, depth: Floats, displacement: Floats, sticking: Floats, rates: Pair) -> Pair:
        """Change the forces as without slip, at most to sliding; return them and their rates as integrals. See `Memory`."""
        radius = np.sqrt(depth)
        most = (2.0 / 3.0) * radius * depth
        integral = np.clip(sticking, -most, most)
        return integral, np.where(np.abs(sticking) > most, np.sign(integral) * radius * rates[0], radius * rates[1])


@dataclass(frozen=True)
class OneSpring:
    """Spring of one contact in two directions; see `TangentialHistory`. `radius` of the contact [m], `stretch` [m] (2,)."""

    law: Mindlin
    radius: float
    stretch: Floats

    def after(self, force: float, moved: Floats) -> tuple[OneSpring, Floats]:
        """Stretch the spring, at most to sliding."""
        law, radius = self.law, self.law.radius_under(force)
        kept = radius / self.radius if law.rescales and radius < self.radius else 1.0
        stretch, stiffness = self.stretch * kept + moved * (0.5 * (1.0 + kept)), 2.0 * float(law.effective_shear_modulus) * radius
        most, pulled = float(law.coefficient) * max(force, 0.0), stiffness * float(np.hypot(*stretch))
        if pulled > most:
            stretch = stretch * (most / pulled)
        return OneSpring(law, radius, stretch), stiffness * stretch


@dataclass(frozen=True)
class OneForce:
    """Kept force of one contact in two directions; see `TangentialHistory`. `radius` of the contact [m], `force` [N] (2,)."""

    law: Mindlin
    radius: float
    force: Floats

    def after(self, force: float, moved: Floats) -> tuple[OneForce, Floats]:
        """Change the force as without slip, by the mean stiffness on the way, at most to sliding."""
        law, radius = self.law, self.law.radius_under(force)
        pulled = self.force + float(law.effective_shear_modulus) * (self.radius + radius) * moved
        most, strength = float(law.coefficient) * max(force, 0.0), float(np.hypot(*pulled))
        if strength > most:
            pulled = pulled * (most / strength)
        return OneForce(law, radius, pulled), pulled
