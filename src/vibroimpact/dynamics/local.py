r"""The contact law of one impact as the bodies feel it: with the quasi-static compliance in series."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np

from vibroimpact.contact.law import CompliantLaw
from vibroimpact.contact.pair import Array
from vibroimpact.contact.quasi_static import QuasiStatic

_SWEEPS = 40
_STEP = 1e-7
_NEAR = 1e-8
_ROWS = 200
_PULLED, _TORN = 2000, 0.5
_ASIDE = np.array([[[0.0], [1.0], [0.0]], [[0.0], [0.0], [1.0]]])
"""What is added to indentation and rate for the force, and for its two derivatives."""


class Linearised(NamedTuple):
    """Forces [N] of a contact, their derivatives by the approach [N/m] and by the rate [N s/m], and the law's indentation [m]."""

    static: Array
    dissipative: Array
    static_by_approach: Array
    dissipative_by_approach: Array
    dissipative_by_rate: Array
    delta: Array


@dataclass(frozen=True)
class LocalContact:
    r"""A law and what is in series with it, for one impact.

    The bodies approach each other in the contact by :math:`y = \delta + s(F_s)`, with the law's own indentation
    :math:`\delta` and its static force :math:`F_s`. Its dissipative force acts beside both, at a rate of its own:
    in series with the damped force, what is negative, as the term of a sphere of finite size, would be unstable.

    Parameters
    ----------
    law : CompliantLaw
        The law, of one drop.
    series : QuasiStatic
        What is in series with it.
    approach_speed : float
        Closing speed of the surfaces at this touch [m/s].
    """

    law: CompliantLaw
    series: QuasiStatic
    approach_speed: float

    def forces(self, approach: Array, rate: Array, guess: Array | None = None) -> tuple[Array, Array]:
        """Return the static and the dissipative force [N], before any clip, at the approach y [m] and its rate [m/s].

        A guess of the law's indentation makes it quicker.
        """
        if not self.series:
            return self.law.forces(approach, rate, self.approach_speed)
        return self.law.forces(self.own(approach, guess)[0], rate, self.approach_speed)

    def linearised(self, approach: Array, rate: Array, guess: Array | None = None) -> Linearised:
        """Return the forces with their derivatives, which are differences, good enough for Newton's method."""
        delta, slope = self.own(approach, guess)
        step, faster = _STEP * (np.abs(delta).max() + 1e-300), _STEP * (np.abs(rate).max() + 1e-300)
        static, dissipative = self.law.forces(delta + step * _ASIDE[0], rate + faster * _ASIDE[1], self.approach_speed)
        return Linearised(
            static[0],
            dissipative[0],
            (static[1] - static[0]) / (step * slope),
            (dissipative[1] - dissipative[0]) / (step * slope),
            (dissipative[2] - dissipative[0]) / faster,
            delta,
        )

    def approach_at(self, delta: Array) -> Array:
        """Return the approach y [m] at an indentation of the law [m]."""
        return delta + self.series.indentation(self._static(delta)) if self.series else delta

    def own(self, approach: Array, guess: Array | None = None) -> tuple[Array, Array]:
        """Return the law's own indentation [m] at an approach [m], and dy/d delta to 1e-6; a guess of it makes it quicker.

        NaN where there is none, as the compliance taken out in series outweighs that of the law: the case is ill-posed.
        """
        approach = np.asarray(approach, dtype=float)
        if not self.series:
            return approach, np.ones_like(approach)
        least = self._least
        size = max(float(np.abs(approach).max()), -2.0 * least) + 1e-300
        delta = np.interp(approach, *self._table(size)) if guess is None else guess
        step, slope = _STEP * size, np.ones_like(approach)
        aside = np.array([0.0, step]).reshape((2,) + (1,) * approach.ndim)
        for _ in range(_SWEEPS):
            force, deeper = self._static(delta + aside)
            slope = 1.0 + self.series.compliance(force) * ((deeper - force) / step)
            change = (delta + self.series.indentation(force) - approach) / slope
            delta = np.maximum(delta - change, least)
            if np.abs(change).max() <= _NEAR * size:  # and the next change would be below rounding
                break
        return np.where(slope > 0.0, delta, np.nan), slope

    def _table(self, size: float) -> tuple[Array, Array]:
        """Return approaches and the law's indentations at them, to start from; for approaches up to a size [m]."""
        reach = math.frexp(size)[1]
        if reach not in self._tables:
            delta = self._least + 2.0 * math.ldexp(1.0, reach) * np.linspace(0.0, 1.0, _ROWS) ** 2
            self._tables[reach] = np.maximum.accumulate(self.approach_at(delta)), delta
        return self._tables[reach]

    @cached_property
    def _tables(self) -> dict[int, tuple[Array, Array]]:
        return {}

    def _static(self, delta: Array) -> Array:
        delta = np.asarray(delta, dtype=float)
        return self.law.forces(delta, np.zeros_like(delta), self.approach_speed)[0]

    # the law's levels and energies, in terms of the approach --------------------------------------

    @cached_property
    def touch_level(self) -> float:
        """Approach at which the surfaces meet [m]."""
        return float(self.approach_at(np.asarray(self.law.touch_level, dtype=float)))

    @cached_property
    def release_level(self) -> float:
        """Approach at which they part [m]."""
        return float(self.approach_at(np.asarray(self._least)))

    @cached_property
    def _least(self) -> float:
        """The law's indentation at which they part [m]: where what is in series tears a sticking contact off, before the law does."""
        least, touch = float(self.law.release_level), float(self.law.touch_level)
        if not self.series or not least < touch:
            return least
        delta = least + (touch - least) * np.linspace(0.0, 1.0, _PULLED) ** 6  # steeper and steeper towards the end
        torn = np.flatnonzero(np.gradient(self.approach_at(delta), delta) < _TORN)
        return float(delta[torn[-1]]) if torn.size else least

    @cached_property
    def breakpoints(self) -> tuple[float, ...]:
        """Approaches at which the force is not smooth [m]."""
        return tuple(float(self.approach_at(np.asarray(level, dtype=float))) for level in self.law.breakpoints)

    def elastic_energy(self, approach: Array) -> Array:
        """Return the energy stored by the law and in series with it [J]."""
        delta, _ = self.own(approach)
        stored = self.law.elastic_energy(delta)
        return stored + self.series.energy(self._static(delta)) if self.series else stored

    def plastic_work(self, approach: Array) -> Array:
        """Return the work spent on plastic deformation since what the law remembers [J]."""
        return self.law.plastic_work(self.own(approach)[0])

    def work(self, approach: Array) -> Array:
        """Return the energy stored and the plastic work together [J]: what moving there slowly takes."""
        delta, _ = self.own(approach)
        done = self.law.elastic_energy(delta) + self.law.plastic_work(delta)
        return done + self.series.energy(self._static(delta)) if self.series else done

    def after_compression(self, deepest: float) -> LocalContact:
        """Return the contact once it has been as deep as an approach of `deepest` [m]."""
        law = self.law.after_compression(self.own(deepest)[0])
        before, after = self.law.memories(), law.memories()
        return self if all(np.all(before[name] == after[name]) for name in before) else replace(self, law=law)
