r"""A measuring chain while a sphere lies on the plate, in closed form: both move as one linear system about their equilibrium.

With the coupled oscillators c of sphere and plate, of shapes S (rows: the sphere times the root of its mass, then the modes of the plate),
the plate's modes move by :math:`q = q_0 + S c`, and the contact force is what the motion of the sphere takes,

.. math:: F = m g - m \ddot s = m g - \sqrt m \sum_j S_{0j}\,\ddot c_j .

So all that a chain adds up, the modes, the force with its derivatives, and its own pairs of poles that the force drives, is a transfer
function seen at the poles of the coupled oscillators (`pole_pairs`), a constant, and the free motion of the chain's own pairs of poles.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from vibroimpact.contact.phase.collocation import Floats
from vibroimpact.contact.phase.oscillators import Oscillators
from vibroimpact.dynamics.lying import Lying
from vibroimpact.dynamics.measuring_chain import MeasuringChain
from vibroimpact.dynamics.pole_pairs import PolePairs
from vibroimpact.dynamics.pulses import gauss_rule

_FAST = 16.0
"""Times what a linear system answers to: what swings faster acts on it as one impulse, to the square of one over it."""
_TURN = 10.0
"""Radians, or time constants, in a panel of Gauss's rule."""


@dataclass(frozen=True)
class LyingChain:
    """A chain without force: coupled oscillators, then the chain's own, that move freely from `place` (2, n) on, and a `constant` (S,)."""

    chain: MeasuringChain
    place: Floats
    constant: Floats


def lying_chain(chain: MeasuringChain, lying: Lying, own: Floats) -> LyingChain:
    """Return what a chain becomes while a sphere lies on the plate.

    Parameters
    ----------
    chain : MeasuringChain
        From the contact force to the outputs.
    lying : Lying
        How sphere and plate move.
    own : array, shape (2, pairs of poles)
        Where the pairs of poles of the chain itself are as that begins.
    """
    riding, coupled = lying.riding, lying.free.oscillators
    at, shapes, weight = PolePairs(coupled.angular_frequency**2, coupled.damping), riding.modes[1], riding.weight
    ground = riding.around.oscillators.ground
    force = -math.sqrt(riding.around.mass) * shapes[0] * at.power(2)
    outputs = chain.outputs[..., : chain.modes] @ shapes[1:][ground]
    constant = chain.outputs[0, :, : chain.modes] @ riding.equilibrium.displacement[ground] - chain.direct[:, 0] * weight
    for order in range(chain.direct.shape[1]):
        outputs -= chain.direct[:, order, None] * at.product(force, at.power(order))[:, None]
    start = np.stack([lying.free.start.displacement, lying.free.start.velocity])
    poles, left = chain.of.pick(np.arange(chain.modes, len(chain.of.shape))), own.copy()
    for number, (stiffness, damping) in enumerate(zip(poles.angular_frequency**2, poles.damping, strict=True)):
        driven = -at.product(force, at.inverse(at.quadratic(stiffness, damping)))
        seen = chain.outputs[..., chain.modes + number]  # (2, S)
        outputs += at.product(seen[0][:, None] * at.power(0)[:, None] + seen[1][:, None] * at.power(1)[:, None], driven)
        constant -= seen[0] * weight / stiffness
        left[0, number] -= float((driven * start).sum()) - weight / stiffness
        left[1, number] -= float((at.product(driven, at.power(1)) * start).sum())
    free = MeasuringChain(
        _beside(coupled, poles),
        len(coupled.shape),
        np.concatenate([outputs, chain.outputs[..., chain.modes :]], axis=-1),
        np.zeros_like(chain.direct),
    )
    return LyingChain(free, np.concatenate([start, left], axis=1), constant)


def lying_pulses(lying: Lying, fastest: float, length: float) -> tuple[Floats, Floats]:
    """Return times since the sphere was laid down [s] and impulses [N s] that act on a smooth linear system as the force does.

    Parameters
    ----------
    lying : Lying
        How sphere and plate move.
    fastest : float
        The highest angular frequency that the system answers to [rad/s].
    length : float
        Up to when it matters [s].
    """
    riding, of, start = lying.riding, lying.free.oscillators, lying.free.start
    share = -math.sqrt(riding.around.mass) * riding.modes[1][0]  # of an acceleration in the force
    fast = (of.damping_ratio < 1.0) & (of.angular_frequency > _FAST * fastest)
    at_once = -float(share[fast] @ start.velocity[fast])  # the whole impulse of a swing that dies, or averages, away
    slow, share = of.pick(np.flatnonzero(~fast)), share[~fast]
    times, weights = _graded_rule(length, fastest, slow)
    cosine, sine = slow.propagators(times)
    stiffness, displacement, velocity = slow.angular_frequency**2, start.displacement[~fast], start.velocity[~fast]
    place = cosine * displacement + sine * velocity
    speed = -stiffness * sine * displacement + (cosine - slow.damping * sine) * velocity
    force = riding.weight - (stiffness * place + slow.damping * speed) @ share
    return np.append(0.0, times), np.append(at_once, weights * force)


def _graded_rule(length: float, fastest: float, of: Oscillators) -> tuple[Floats, Floats]:
    """Return nodes [s] and weights [s] of Gauss's rule up to a time: panels for the waves, ever shorter towards 0 for what dies at once."""
    swinging = of.angular_frequency[of.damping_ratio < 1.0].max(initial=0.0)
    panel = length / math.ceil(max(1.0, (fastest + swinging) * length / _TURN))
    dying = float((2.0 * of.damping_ratio * of.angular_frequency).max(initial=0.0))
    halvings = math.ceil(math.log2(max(1.0, dying * panel / _TURN)))
    ends = np.concatenate([[0.0], panel * 0.5 ** np.arange(halvings, 0, -1), panel * np.arange(1, round(length / panel) + 1)])
    x, weights = gauss_rule(_TURN)
    spans = np.diff(ends)[:, None]
    return (ends[:-1, None] + spans * x).ravel(), (spans * weights).ravel()


def _beside(one: Oscillators, other: Oscillators) -> Oscillators:
    """Return the oscillators of two systems side by side, without massless elements."""
    parts = ("angular_frequency", "damping_ratio", "shape", "rate", "mobility", "inside", "ground")
    return Oscillators(*(np.concatenate([getattr(one, part), getattr(other, part)]) for part in parts))
