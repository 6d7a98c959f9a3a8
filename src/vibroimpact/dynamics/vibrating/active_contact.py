"""A contact while its surfaces overlap, and the impact that it records."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.contact.law import CompliantLaw
from vibroimpact.contact.quasi_static import QuasiStatic
from vibroimpact.contact.static import static_indentation
from vibroimpact.dynamics.core.attempt import time_at
from vibroimpact.dynamics.core.law import law_indentation
from vibroimpact.dynamics.core.peak import peak_of
from vibroimpact.dynamics.vibrating.linear_system import LinearSystem, State
from vibroimpact.dynamics.vibrating.local import LocalContact
from vibroimpact.dynamics.vibrating.stretch import VibratingStretch

# of the largest nodal value: stretches whose nodal values stay below can't hold the peak
_PEAK = 0.98
_ROUNDING = 2e-15  # of the energy of the motion: less is a rounding error


@dataclass(frozen=True)
class ContactDefinition:
    """A contact of a system.

    `law`: its law. `series`: the compliance in series. `fresh_surface`: whether each impact meets
    undeformed surfaces.
    """

    law: CompliantLaw
    series: QuasiStatic
    fresh_surface: bool


class ContactPeak:
    """Largest value of a quantity over a contact, located between the nodes only on request.

    `nodal_max`: the largest value at a node so far.
    """

    def __init__(self) -> None:
        self.nodal_max = 0.0
        self._candidates: list[
            tuple[float, float, VibratingStretch, Callable[[], tuple[float, float]]]
        ] = []

    def add(
        self,
        nodal_max: float,
        start: float,
        stretch: VibratingStretch,
        peak: Callable[[], tuple[float, float]],
    ) -> None:
        """Add a stretch that starts at a time [s], with its largest nodal value.

        `peak` returns the x of the largest value between the nodes, and that value.
        """
        if nodal_max >= _PEAK * self.nodal_max:
            self._candidates.append((nodal_max, start, stretch, peak))
            self.nodal_max = max(self.nodal_max, nodal_max)

    def locate(self) -> tuple[float, float]:
        """Return the largest value and its time [s]; zeros if there is none."""
        largest = 0.0
        time = 0.0
        for nodal_max, start, stretch, peak in self._candidates:
            if nodal_max < _PEAK * self.nodal_max:
                continue
            x, value = peak()
            if value > largest:
                largest = value
                time = start + stretch.length * time_at(stretch.basis.basis, x)
        return largest, time


@dataclass
class Impact:
    """One impact of a contact, from touch to release.

    `start`, `end` [s]; the latter is NaN until release. `closing_speed` [m/s]. `force` [N],
    `indentation` [m]: peaks. `impulse` [N s].
    """

    contact: int
    start: float
    closing_speed: float
    end: float = np.nan
    force: ContactPeak = field(default_factory=ContactPeak)
    indentation: ContactPeak = field(default_factory=ContactPeak)
    impulse: float = 0.0


@dataclass
class ActiveContact:
    """A contact whose surfaces overlap.

    `mass`: effective mass of its motion [kg]. `delta`: indentation of its law [m]. `speed`, `span`:
    speed of its motion [m/s], and its approximate duration [s]. `pushes`: whether its law acts;
    otherwise it recoils without a force. `fresh`: no stretch has been solved yet. At the end of its
    last stretch: `force` [N], its rate of change `trend` [N/s], and `closing`, the rate of the
    approach [m/s].
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
        """Energy scale of its motion [J]."""
        return 0.5 * self.mass * self.speed**2

    def overlap(self, system: LinearSystem, state: State) -> float:
        """Return the approach beyond that of release [m], at least zero."""
        return max(float(system.approach_at(state, self.number)) - self.local.release_level, 0.0)

    def law_indentation(self, system: LinearSystem, state: State) -> float:
        """Return the indentation of its law in a state [m]."""
        approach = self.overlap(system, state) + self.local.release_level
        return law_indentation(self.local.with_levels, approach)

    def plastic_work(self, system: LinearSystem, state: State) -> float:
        """Return the plastic work since the last update of the law's memory [J], in a state."""
        delta = max(self.law_indentation(system, state), self.local.release_indentation)
        return float(self.local.law.plastic_work(np.asarray(delta)))

    def stored_energy_at(self, delta: float) -> float:
        """Return the energy stored at an indentation of its law [J]; rounding errors are zero."""
        energy = float(self.local.energy_at_indentation(delta))
        return energy if abs(energy) > _ROUNDING * self.energy else 0.0


def closing_speed(system: LinearSystem, state: State, number: int) -> float:
    """Return the closing speed of the surfaces of a contact [m/s], > 0.

    It is the larger of the rates with and without the coordinates inside the contact: a surface may
    meet the other by its own vibration while the centre hardly moves.
    """
    return max(float(system.outer_rates(state)[number]), float(system.rates(state)[number]), 1e-300)


def motion_speed(system: LinearSystem, number: int, law: CompliantLaw, closing: float) -> float:
    """Return the speed scale of the motion in a contact [m/s].

    It is the closing speed, or the speed that gravity adds at a soft touch.
    """
    mass = float(system.mass[number])
    gravity = max(float(system.gravity[number]), 0.0)
    if not gravity:
        return closing
    fall_height = closing**2 / gravity
    if float(law.forces(fall_height, 0.0, closing)[0]) >= mass * gravity:
        return closing  # the sphere sinks in by less than that height
    sag = float(static_indentation(law, np.array([mass * gravity]))[0])
    return max(closing, float(np.sqrt(gravity * sag)))


def record_peaks(
    impact: Impact,
    stretch: VibratingStretch,
    index: int,
    start: float,
    force: float,
    indentations: Floats,
) -> None:
    """Add the peaks of force and indentation of one contact within a stretch to its impact.

    `index`: of the contact in the stretch. `start`: time at which the stretch begins [s]. `force`:
    the largest at a node [N]. `indentations`: of the centre above, at the start and the nodes [m]
    (N + 1,).
    """
    law = stretch.contacts[index].local.law
    impact.force.add(
        force if law.tension == "kept" else max(force, 0.0),
        start,
        stretch,
        partial(stretch.peak_force, index),
    )
    impact.indentation.add(
        max(indentations[1:].tolist()),
        start,
        stretch,
        partial(peak_of, stretch.basis.basis, indentations),
    )
