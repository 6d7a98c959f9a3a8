"""Contact law of one impact with a quasi-static compliance in series."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from vibroimpact.arrays import Array
from vibroimpact.compiled import law_addresses, law_coefficients
from vibroimpact.contact.law import CompliantLaw
from vibroimpact.contact.quasi_static import QuasiStatic
from vibroimpact.dynamics.core import law as core
from vibroimpact.dynamics.core.events import TENSIONS
from vibroimpact.dynamics.core.records import Contacts, Law

_MOST_ITERATIONS = 40
_STEP = 1e-7  # relative step of finite differences
_CONVERGED = 1e-8  # relative Newton step, after which the next would be below rounding
_TABLE_ROWS = 200


@dataclass(frozen=True)
class LocalContact:
    r"""A contact law and the quasi-static compliance in series with it, for one impact.

    The approach of the surfaces is :math:`y = \delta + s(F_s)`, with the indentation :math:`\delta`
    of the law and its static force
    :math:`F_s`. The dissipative force acts parallel to both, at a rate of its own: a negative
    compliance, as the finite-size term of a sphere has, would be unstable in series with a damped
    force.

    Parameters
    ----------
    law : CompliantLaw
        The law, of one drop.
    series : QuasiStatic
        The compliance in series with it.
    approach_speed : float
        Closing speed of the surfaces at this touch [m/s].
    """

    law: CompliantLaw
    series: QuasiStatic
    approach_speed: float

    def forces(self, approach: Array, rate: Array) -> tuple[Array, Array]:
        """Return the static and the dissipative force [N], before clipping.

        They are those at the approach y [m] and its rate [m/s].
        """
        return self.law.forces(self.indentation_at(approach), rate, self.approach_speed)

    def __getstate__(self) -> dict[str, object]:
        """Return what is pickled, without addresses of machine code, which hold in this process."""
        return {"law": self.law, "series": self.series, "approach_speed": self.approach_speed}

    @cached_property
    def with_levels(self) -> Law:
        """The law with its levels and energies, as the core finds them.

        They follow from the law and the compliance in series.
        """
        return core.law_at_touch(
            law_addresses(type(self.law)),
            law_coefficients(self.law),
            self.series.coefficients,
            float(self.approach_speed),
        )

    @cached_property
    def record(self) -> Contacts:
        """The contact as the core takes it."""
        law = self.with_levels
        levels = (law.touch, law.release, law.release_level, law.memory_level)
        breakpoints = (law.first_breakpoint, law.second_breakpoint)
        return Contacts(
            addresses=law.addresses,
            coefficients=law.coefficients[None],
            series=law.series[None],
            numbers=np.array([[law.speed, *levels, *breakpoints, law.jump]]),
            tension=np.array([TENSIONS.index(self.law.tension)]),
        )

    # in terms of the indentation of the law
    # ---------------------------------------------------------

    def forces_at_indentation(self, delta: Array, rate: Array) -> tuple[Array, Array]:
        """Return the static and the dissipative force [N], before clipping.

        They are those at an indentation of the law [m] and a rate [m/s].
        """
        return self.law.forces(
            np.maximum(delta, self.release_indentation), rate, self.approach_speed
        )

    def approximate_indentation(self, approach: Array) -> Array:
        """Return the indentation of the law at an approach [m], interpolated in a table."""
        if not self.series:
            return approach
        return np.interp(approach, *self._table(self._scale(approach)))

    def stiffness_at(self, delta: float) -> float:
        """Return the static stiffness of the law and what is in series with it [N/m].

        It is that at an indentation of the law [m].
        """
        delta = max(delta, self.release_indentation)
        step = _STEP * (abs(delta) + 1e-300)
        force, next_force = self._static(np.array([delta, delta + step])).tolist()
        stiffness = float(next_force - force) / step
        if not self.series:
            return stiffness
        # two springs in series: 1/(1/k + s')
        _, compliance = self.series.linearised(force)
        return stiffness / (1.0 + float(compliance) * stiffness)

    def energy_at_indentation(self, delta: Array) -> Array:
        """Return the energy stored since touch, at an indentation of the law [J]."""
        delta = np.maximum(delta, self.release_indentation)
        stored = self.law.elastic_energy(delta)
        if not self.series:
            return stored
        return stored + self.series.energy(self._static(delta)) - self.energy_of_jump

    def approach_at(self, delta: Array) -> Array:
        """Return the approach y [m] at an indentation of the law [m]."""
        if not self.series:
            return delta
        return delta + self.series.indentation(self._static(delta))

    def indentation_at(self, approach: Array) -> Array:
        """Return the indentation of the law [m] at an approach [m], by Newton's method.

        NaN where no solution exists, as a negative compliance in series exceeds that of the law:
        the problem is ill-posed.
        """
        approach = np.asarray(approach, dtype=float)
        if not self.series:
            return approach
        scale = self._scale(approach)
        delta = self.approximate_indentation(approach)
        slope = np.ones_like(approach)  # of the approach over the indentation
        step = _STEP * scale
        offsets = np.array([0.0, step]).reshape((2,) + (1,) * approach.ndim)
        # delta + s(F_s(delta)) = y, of which the slope is 1 + s' F_s'
        for _ in range(_MOST_ITERATIONS):
            force, next_force = self._static(delta + offsets)
            series_indentation, compliance = self.series.linearised(force)
            stiffness = (next_force - force) / step
            slope = 1.0 + compliance * stiffness
            correction = (delta + series_indentation - approach) / slope
            delta = np.maximum(delta - correction, self.release_indentation)
            if np.abs(correction).max() <= _CONVERGED * scale:
                break
        return np.where(slope > 0.0, delta, np.nan)

    def _scale(self, approach: Array) -> float:
        """Return a length scale of approaches [m]."""
        return max(float(np.abs(approach).max()), -2.0 * self.release_indentation) + 1e-300

    def _table(self, scale: float) -> tuple[Array, Array]:
        """Return a cached table of approaches up to a scale [m], and indentations of the law."""
        exponent = math.frexp(scale)[1]
        if exponent not in self._tables:
            span = 2.0 * math.ldexp(1.0, exponent)
            # denser near touch
            delta = self.release_indentation + span * np.linspace(0.0, 1.0, _TABLE_ROWS) ** 2
            self._tables[exponent] = np.maximum.accumulate(self.approach_at(delta)), delta
        return self._tables[exponent]

    @cached_property
    def _tables(self) -> dict[int, tuple[Array, Array]]:
        """Cache of `_table`, by the binary exponent of the scale."""
        return {}

    def _static(self, delta: Array) -> Array:
        """Return the static force at an indentation of the law [N]."""
        delta = np.asarray(delta, dtype=float)
        return self.law.forces(delta, np.zeros_like(delta), self.approach_speed)[0]

    # levels and energies in terms of the approach
    # ---------------------------------------------------

    @property
    def energy_of_jump(self) -> float:
        """Energy that an adhesive contact stores as it jumps into contact [J], <= 0.

        It is that of the law and the compliance in series, relative to the law alone. Energies are
        those since touch, as those of the law are, so that this one is a part of what is lost at
        release.
        """
        return self.with_levels.jump

    @property
    def release_level(self) -> float:
        """Approach at release [m]."""
        return self.with_levels.release_level

    @property
    def release_indentation(self) -> float:
        """Indentation of the law at release [m].

        With a compliance in series a sticking contact may snap off before the law releases.
        """
        return self.with_levels.release

    def elastic_energy(self, approach: Array) -> Array:
        """Return the energy stored since touch at an approach [m], with that in series [J]."""
        return self.energy_at_indentation(self.indentation_at(approach))

    def plastic_work(self, approach: Array) -> Array:
        """Return the plastic work at an approach [m] since the last update of the memory [J]."""
        return self.law.plastic_work(self.indentation_at(approach))

    def after_compression(self, deepest: float) -> LocalContact:
        """Return the contact after a largest approach of `deepest` [m]."""
        return self.after_indentation(self.indentation_at(deepest))

    def after_indentation(self, deepest: Array) -> LocalContact:
        """Return the contact after a largest indentation of the law of `deepest` [m]."""
        if not self.updates_memory(deepest):
            return self
        return replace(self, law=self.law.after_compression(deepest))

    def updates_memory(self, deepest: Array) -> bool:
        """Whether an indentation of the law of `deepest` [m] changes its memory."""
        memories = self.law.memories()
        changed = self.law.after_compression(deepest).memories()
        return not all(np.all(memories[name] == changed[name]) for name in memories)


def contacts_of(contacts: Sequence[LocalContact]) -> Contacts:
    """Return contacts as the core takes them."""
    if len(contacts) == 1:
        return contacts[0].record
    records = [contact.record for contact in contacts]
    return Contacts(*(np.concatenate(arrays) for arrays in zip(*records, strict=True)))
