"""A sphere that has come to rest on what vibrates: both go on as one, about their equilibrium under its weight."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from vibroimpact.dynamics.collocation import Floats
from vibroimpact.dynamics.oscillators import FreeMotion, Oscillators, State
from vibroimpact.dynamics.riding import Riding, coupled_oscillators


@dataclass(frozen=True, eq=False)
class Lying:
    """The small oscillations of a sphere and what carries it, from where it was laid down on.

    `riding`: their equilibrium and modes. `start`: the state then. `left`: what they hold above their equilibrium then [J].
    `written_off`: what laying it down took [J].
    """

    riding: Riding
    start: State
    left: float
    written_off: float

    @cached_property
    def _coupled(self) -> tuple[Oscillators, Floats]:
        return coupled_oscillators(self.riding)

    @cached_property
    def free(self) -> FreeMotion:
        """The motion of both together, in the coordinates of their modes."""
        coupled, _ = self._coupled
        _, shapes = self.riding.modes
        place, speed = (shapes.T @ part for part in self.riding.deviation(self.start))
        return FreeMotion(coupled, State(np.zeros(()), np.zeros(()), place, speed, np.zeros(0)), 0.0)

    def state(self, time: Floats) -> State:
        """Return the state at times since the sphere was laid down [s] (...)."""
        riding, together = self.riding, self.free.state(time)
        root, at, (_, shapes) = np.sqrt(riding.around.mass), riding.equilibrium, riding.modes
        place, speed = together.displacement @ shapes.T, together.velocity @ shapes.T
        force = riding.weight + riding.stiffness * (place @ riding.pull)
        return State(
            at.approach + place[..., 0] / root,
            speed[..., 0] / root,
            at.displacement + place[..., 1:],
            speed[..., 1:],
            -force[..., None] * riding.around.oscillators.local_compliance,
        )

    def force(self, time: Floats) -> Floats:
        """Return the force of the contact [N] at times since then [s]: what the motion of the sphere takes."""
        together, (coupled, _) = self.free.state(time), self._coupled
        pull = coupled.damping * together.velocity + coupled.angular_frequency**2 * together.displacement
        return np.asarray(self.riding.weight + np.sqrt(self.riding.around.mass) * (pull @ self.riding.modes[1][0]))

    def stored(self, time: Floats) -> Floats:
        """Return what the contact holds [J] at times since then [s], without the massless elements."""
        riding = self.riding
        excess = riding.stiffness * (self.free.state(time).displacement @ (riding.modes[1].T @ riding.pull))
        deeper = excess / riding.contact[0]
        return np.asarray(riding.stored + (riding.weight + 0.5 * excess) * deeper)

    def lost_by(self, time: Floats) -> Floats:
        """Return what is lost since then [J] at times (T,), (T, n + 1): in each oscillator; last, in the contact."""
        return np.asarray(self.free.lost_by(time)[..., :-1] @ self._coupled[1])


def lay_down(riding: Riding, state: State, stored: float) -> Lying:
    """Take a sphere that is at rest from the contact as it is to small oscillations.

    Where the force hardly varies, it goes on as it moves, on a linear spring: it is put where that holds what the contact and the massless
    elements do. Else it is laid into its static indentation where the surface is now, and moves with it as after a perfectly plastic
    impact. Neither makes energy: that indentation is the one of the least energy, and the impulse that makes both move together
    is the one that loses the most.

    Parameters
    ----------
    riding : Riding
        The equilibrium.
    state : State
        Where everything is.
    stored : float
        What the contact holds [J].
    """
    root, pull, at = np.sqrt(riding.around.mass), riding.pull, riding.equilibrium
    (place, speed), held = riding.deviation(state), riding.excess(state, stored)
    behind, never = place[1:] @ pull[1:], (1.0 - riding.share) * stored
    if riding.linear and riding.stays(state):
        of_modes = (riding.around.oscillators.angular_frequency * place[1:]) ** 2
        on_spring = held - 0.5 * (float(speed @ speed) + float(of_modes.sum()))
        deeper = np.copysign(np.sqrt(2.0 * max(on_spring, 0.0) / riding.stiffness), place @ pull)
        return Lying(riding, replace(state, approach=np.asarray(at.approach + deeper - behind)), held, never)
    speed -= pull * (speed @ pull) / (pull @ pull)
    start = State(np.asarray(at.approach - behind), speed[0] / root, state.displacement, speed[1:], at.local)
    left = riding.excess(start, riding.stored / riding.share)
    return Lying(riding, start, left, never + held - left)
