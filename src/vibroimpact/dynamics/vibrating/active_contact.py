"""A contact while its surfaces overlap, and what comes of it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.contact.law import CompliantLaw
from vibroimpact.contact.quasi_static import QuasiStatic
from vibroimpact.contact.roots import highest
from vibroimpact.contact.static import static_indentation
from vibroimpact.dynamics.vibrating.linear_system import LinearSystem, State
from vibroimpact.dynamics.vibrating.local import LocalContact
from vibroimpact.dynamics.vibrating.stretch import VibratingStretch

_PEAK = 0.98  # of the largest value at a node: where that is less, the largest is not between
_NOTHING = 2e-15  # of the energy of the motion


@dataclass(frozen=True)
class ContactDefinition:
    """The law of a contact of a march and what is in series with it; `forgets`: does each impact find fresh surfaces?"""

    law: CompliantLaw
    series: QuasiStatic
    fresh_surface: bool


class ContactPeak:
    """The largest value of a quantity in a contact, which is sought only once it is asked for.

    `near`: the largest at a node so far.
    """

    def __init__(self) -> None:
        self.nodal_max = 0.0
        self._candidates: list[tuple[float, float, VibratingStretch, Callable[[Floats], Floats]]] = []

    def add(self, nodal_max: float, start: float, stretch: VibratingStretch, values: Callable[[Floats], Floats]) -> None:
        """Note a stretch that starts at a time [s], the largest value at its nodes, and its values at x in [0, 1]."""
        if nodal_max >= _PEAK * self.nodal_max:
            self._candidates.append((nodal_max, start, stretch, values))
            self.nodal_max = max(self.nodal_max, nodal_max)

    def locate(self) -> tuple[float, float]:
        """Return the largest value, and when it is reached [s]; zeros if there is none."""
        found = (0.0, 0.0)
        for nodal_max, start, stretch, values in self._candidates:
            if nodal_max >= _PEAK * self.nodal_max:
                x = np.array([highest(values)])
                if (value := float(values(x)[0])) > found[0]:
                    found = value, start + stretch.length * float(stretch.rule.map_time(x)[0])
        return found


@dataclass
class Impact:
    """One impact of a contact, from touch to release.

    `start`, `end` [s]; the latter NaN while it lasts. `closing_speed` [m/s]. `force` [N], `indentation` [m]: the largest. `impulse` [N s].
    """

    contact: int
    start: float
    closing_speed: float
    end: float = np.nan
    force: ContactPeak = field(default_factory=ContactPeak)
    indentation: ContactPeak = field(default_factory=ContactPeak)
    impulse: float = 0.0


def locate_highest_peak(peaks: Sequence[ContactPeak]) -> tuple[float, float]:
    """Return the largest value of several peaks, and when it is reached [s]."""
    nodal_max = _PEAK * max(peak.nodal_max for peak in peaks)
    return max((peak.locate() for peak in peaks if peak.nodal_max >= nodal_max), key=lambda locate: locate[0])


@dataclass
class ActiveContact:
    """A contact whose surfaces overlap.

    `mass`: that it moves [kg]. `delta`: its law's own indentation [m]. `speed`, `span`: of its motion [m/s], and about how long it lasts
    [s]. `pushes`: else it recoils without a force. `fresh`: it has just met. `force` [N] at the end of its last
    stretch, `trend`: how fast it changes [N/s], and `closing`: how fast the surfaces approach each other [m/s].
    """

    number: int
    local: LocalContact
    mass: float
    delta: float
    speed: float
    span: float
    impact: Impact
    pushes: bool = True
    fresh: bool = True
    trend: float = 0.0
    force: float = np.inf
    closing: float = np.inf

    @property
    def energy(self) -> float:
        """About the energy of its motion [J]."""
        return 0.5 * self.mass * self.speed**2

    def overlap(self, system: LinearSystem, state: State) -> float:
        """Return by how much the surfaces overlap beyond where they part [m], not less than zero."""
        return max(float(system.approach(state)[self.number]) - self.local.release_level, 0.0)

    def law_indentation(self, system: LinearSystem, state: State) -> float:
        """Return the own indentation of its law in a state [m]."""
        return float(self.local.indentation_at(self.overlap(system, state) + self.local.release_level))

    def plastic_work(self, system: LinearSystem, state: State) -> float:
        """Return the plastic work since what its law remembers [J], in a state."""
        return float(self.local.law.plastic_work(np.asarray(max(self.law_indentation(system, state), self.local.release_indentation))))

    def stored_energy_at(self, delta: float) -> float:
        """Return the energy stored at an indentation of its law [J], without what is rounding."""
        held = float(self.local.energy_at_indentation(delta))
        return held if abs(held) > _NOTHING * self.energy else 0.0


def closing_speed(system: LinearSystem, state: State, number: int) -> float:
    """Return the speed at which the surfaces of a contact approach each other [m/s], > 0.

    Where a body's own vibration makes its surface meet the other, its centre may hardly come nearer.
    """
    return max(float(system.outer_rates(state)[number]), float(system.rates(state)[number]), 1e-300)


def motion_speed(system: LinearSystem, number: int, law: CompliantLaw, closing: float) -> float:
    """Return the speed of the motion in a contact [m/s]: that at which its surfaces meet, or what gravity adds to a soft touch."""
    mass, gravity = float(system.mass[number]), max(float(system.gravity[number]), 0.0)
    sag = float(static_indentation(law, np.array([mass * gravity]))[0]) if gravity else 0.0
    return max(closing, float(np.sqrt(gravity * sag)))


def record_peaks(impact: Impact, stretch: VibratingStretch, place: int, start: float) -> None:
    """Note the forces and indentations of one of its contacts within a stretch that starts at a time [s], and its impulse."""
    rule, contact, indentations = stretch.rule, stretch.contacts[place], stretch.indentations(place)
    force = float(contact.force.max()) if contact.local.law.tension == "kept" else max(float(contact.force.max()), 0.0)
    impact.force.add(force, start, stretch, contact.force_at)
    impact.indentation.add(float(indentations[1:].max()), start, stretch, lambda x: np.asarray(rule.weights(x).T @ indentations))
    impact.impulse += stretch.length * float(rule.integral[-1] @ contact.force)
