"""A solved stretch of contact: its motion, contact forces, energy balance and error measures."""

from __future__ import annotations

import threading
import weakref
from collections import deque
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.core.path import stretch_path
from vibroimpact.dynamics.core.records import Path
from vibroimpact.dynamics.motion.collocation import Rule
from vibroimpact.dynamics.vibrating.contact_history import ContactHistory
from vibroimpact.dynamics.vibrating.contact_view import ContactView
from vibroimpact.dynamics.vibrating.linear_system import LinearSystem, State
from vibroimpact.dynamics.vibrating.radau_eigenbasis import RadauEigenbasis
from vibroimpact.dynamics.vibrating.surface_friction import SlidingStretch

_KEPT = 64
"""Number of stretches whose motion a thread keeps in memory: those of a few impacts.

They are the last ones that were solved or read.
"""


class _Kept(threading.local):
    """The stretches whose motion a thread keeps, oldest first.

    Each thread has its own, so that runs beside each other, as for windows of the live page, take
    nothing from one another. A run has none of its own: responses that are held would then hold
    their motions, which is four times the memory.
    """

    def __init__(self) -> None:
        self.stretches: deque[weakref.ref[VibratingStretch]] = deque()


_kept = _Kept()


@dataclass(frozen=True)
class VibratingStretch:
    """A solved stretch of one system.

    `view`: the system reduced to the contacts that push. `length` [s]. `start`: state at the start.
    `contacts`: histories of the contacts that push. `roughness`: the last Legendre coefficients of
    the forces, relative to their scale; the error at the end is of the order of its square.
    `sliding`: friction, of a drop that has any.
    """

    view: ContactView
    basis: RadauEigenbasis
    length: float
    start: State
    contacts: tuple[ContactHistory, ...]
    roughness: float
    sliding: SlidingStretch | None = None

    @property
    def system(self) -> LinearSystem:
        """The linear system."""
        return self.view.system

    @property
    def duration(self) -> Floats:
        """Its length [s], as an array of one."""
        return np.array([self.length])

    @property
    def rule(self) -> Rule:
        """Nodes and time map."""
        return self.basis.rule

    @cached_property
    def force(self) -> Floats:
        """Contact forces at the nodes [N] (c, N)."""
        return np.stack([contact.force for contact in self.contacts])

    @cached_property
    def motion(self) -> Path:
        """Motion of the coordinates; recomputed from the forces if it is no longer kept."""
        self.keep()
        return self._path(accelerated=True)

    @cached_property
    def path(self) -> Path:
        """The same; the accelerations may be absent."""
        return self.__dict__.get("motion") or self._path(accelerated=False)

    def _path(self, *, accelerated: bool) -> Path:
        view = self.view
        force = self.force
        static = np.stack([contact.static for contact in self.contacts])
        if self.sliding is not None:
            # directions of friction are further contacts, without a static law
            view = view.sliding
            force = np.concatenate([force, self.sliding.force])
            static = np.concatenate([static, np.zeros_like(self.sliding.force)])
        return stretch_path(
            self.basis.basis,
            view.surfaces,
            view.coordinates,
            self.start.record,
            self.length,
            force.ravel(),
            static.ravel(),
            accelerated,
        )

    @property
    def accelerations(self) -> Floats:
        """Accelerations of the coordinates at the nodes (N, n)."""
        return self.motion.acceleration

    @property
    def velocities(self) -> Floats:
        """Velocities of the coordinates at the nodes (N, n)."""
        return self.path.velocity

    @cached_property
    def end(self) -> State:
        """State at the end."""
        path = self.path
        return State(path.displacement, path.speed, path.local)

    def state(self, time: Floats) -> State:
        """Return the state at times since the start [s] (T,)."""
        start = self.start
        load = self.system.load
        t = np.asarray(time)[:, None]
        # gravity is integrated in closed form, the other accelerations by the rule
        forced = self.accelerations - load
        to_time = self.length * self.rule.integral_to(self._x(time))
        forced_velocity = self.length * (self.rule.integral @ forced)
        fall = t * (start.velocity + 0.5 * t * load)
        displacement = start.displacement + fall + to_time @ forced_velocity
        velocity = start.velocity + t * load + to_time @ forced
        local = start.local + to_time @ self.motion.massless.T
        return State(displacement, velocity, local)

    @cached_property
    def powers(self) -> Floats:
        """Power lost at the nodes [W], (N, n + 1).

        It is given for each coordinate, and last for the laws and the massless elements.
        """
        system = self.system
        in_laws = sum(contact.power for contact in self.contacts)
        # of a dashpot e'^2/m, with the mobility m, and of a mode 2 zeta omega v^2
        in_elements = self.path.massless.T**2 / system.mobility
        in_contacts = in_laws + in_elements.sum(axis=1)
        in_coordinates = system.damping * self.velocities**2
        if system.driven:
            # a driven coordinate loses minus the work of its drive, which balances the contact
            driven = slice(-system.driven, None)
            generalised_force = self.force.T @ system.shape[self.view.contacts, driven]
            if self.sliding is not None and system.along is not None:
                generalised_force -= self.sliding.force.T @ system.along[:, driven]
            in_coordinates[:, driven] = -generalised_force * self.velocities[:, driven]
        return np.concatenate([in_coordinates, in_contacts[:, None]], axis=1)

    @cached_property
    def lost(self) -> Floats:
        """Energy lost over the stretch, with losses at its end [J], (n + 1,) as in `powers`."""
        lost = self.path.lost.copy()
        lost[-1] += sum(contact.dissipated + contact.separation_loss for contact in self.contacts)
        return lost

    def lost_by(self, time: Floats) -> Floats:
        """Return the energy lost at times since the start [s], (T, n + 1) as in `powers` [J]."""
        return np.asarray(self.length * self.rule.integrate(self._x(time), self.powers))

    def keep(self) -> None:
        """Keep the motion at the nodes in memory until others of this thread take its place.

        The state and the losses at the end stay.
        """
        kept = _kept.stretches
        kept.append(weakref.ref(self))
        while len(kept) > _KEPT:
            oldest = kept.popleft()()
            if oldest is not None:
                _ = oldest.end, oldest.lost  # compute them while the motion is there
                for name in ("motion", "path", "powers", "force"):
                    oldest.__dict__.pop(name, None)

    def _x(self, time: Floats) -> Floats:
        """Return x at times since the start [s]."""
        return self.rule.unmap_time(np.asarray(time) / self.length)
