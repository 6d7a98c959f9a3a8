r"""The spin of a sphere about the normal, which twisting of its contact slows.

.. math:: I \dot\omega = -M\, p\left(\frac{a |\omega|}{s}\right) \frac{\omega}{|\omega|}

with the moment of full twisting :math:`M = \frac{3\pi}{16} \mu F a` under the normal force F on a
contact of radius a (Johnson 1985, section 7.2; Lubkin 1951), and the part p of it that the slip s
of the contact leaves (`contact.friction.twisting`).
"""

from __future__ import annotations

from typing import NamedTuple

from vibroimpact.arrays import Vector
from vibroimpact.compiled import compiled
from vibroimpact.contact.friction.twisting import FULL_TWISTING, twisting_share


class Twisting(NamedTuple):
    """A contact that resists twisting.

    coefficient: of friction. radius: of the contact under a normal force of 1 N [m], which grows
    with the cube root of the force; zero where it is a point.
    """

    coefficient: float
    radius: float


@compiled
def full_moment(twisting: Twisting, force: float) -> float:
    """Return the moment of full twisting under a normal force [N m]."""
    radius = twisting.radius * force ** (1.0 / 3.0)
    return float(FULL_TWISTING * twisting.coefficient * force * radius)


@compiled
def moment_share(
    twisting: Twisting, force: float, friction: float, slip: float, spin: float
) -> float:
    """Return the part of the moment of full twisting that a contact has beside its friction [-].

    Parameters
    ----------
    twisting : Twisting
        The contact.
    force, friction : float
        Normal and friction force [N], >= 0.
    slip : float
        Speed of the contact point along the plate [m/s], >= 0.
    spin : float
        Rate of twisting [rad/s], >= 0.
    """
    most = twisting.coefficient * force
    used = 1.0
    if most > 0.0:
        used = friction / most
    radius = twisting.radius * force ** (1.0 / 3.0)
    return float(twisting_share(radius * spin, slip, used))


@compiled
def slowed_spin(
    twisting: Twisting,
    spin: float,
    full: float,
    share: float,
    force: float,
    friction: float,
    slip: float,
) -> tuple[float, float]:
    """Return what a step takes from a spin [rad/s], more than there is where it ends on the way,
    and the share of the moment at its end; by Heun's method.

    Parameters
    ----------
    twisting : Twisting
        The contact.
    spin : float
        At the start of the step [rad/s], >= 0.
    full : float
        What full twisting would take [rad/s].
    share : float
        Share of the moment at the start.
    force, friction, slip : float
        At the end; see `moment_share`.
    """
    # a first estimate by the share at the start, then the mean of those at both ends
    after = max(spin - share * full, 0.0)
    share_after = moment_share(twisting, force, friction, slip, after)
    return 0.5 * (share + share_after) * full, share_after


@compiled
def slow_spin(
    twisting: Twisting,
    spin: float,
    inertia: float,
    time: Vector,
    force: Vector,
    friction: Vector,
    slip: Vector,
    spins: Vector,
) -> None:
    """Write the size of a spin at G points of time.

    Parameters
    ----------
    twisting : Twisting
        The contact.
    spin : float
        At the first point [rad/s], >= 0.
    inertia : float
        Of the sphere [kg m^2].
    time, force, friction, slip : array, shape (G,)
        Time [s]; see `moment_share`.
    spins : array, shape (G,)
        Room for the spins [rad/s].
    """
    share = moment_share(twisting, force[0], friction[0], slip[0], spin)
    moment = full_moment(twisting, force[0])
    spins[0] = spin
    for point in range(1, len(time)):
        # what full twisting would take, by the trapezoidal rule
        moment_before = moment
        moment = full_moment(twisting, force[point])
        full = 0.5 * (time[point] - time[point - 1]) * (moment + moment_before) / inertia
        spin_before = spins[point - 1]
        lost, share = slowed_spin(
            twisting, spin_before, full, share, force[point], friction[point], slip[point]
        )
        spins[point] = max(spin_before - lost, 0.0)
