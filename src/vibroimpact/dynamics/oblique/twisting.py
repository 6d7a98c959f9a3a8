r"""The spin about the normal of spheres in contact, which twisting friction slows.

.. math:: I \dot\omega = -M\, p\left(\frac{a |\omega|}{s}\right) \frac{\omega}{|\omega|}

with the moment M of full twisting, and the part p of it that the slip s of the contact leaves
(`FrictionLaw.twisting_part`).
"""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.contact.friction.law import FrictionLaw


def slowed_spins(
    law: FrictionLaw, spin: Floats, slower: Floats, force: Floats, friction: Floats, slip: Floats
) -> tuple[Floats, Floats]:
    """Return the sizes of B spins about the normal at G points of time [rad/s] (G, B), and what
    they lose from each to the next.

    By Heun's method; what is lost, (G - 1, B), is more than the spin where it ends on the way.

    Parameters
    ----------
    law : FrictionLaw
        Of the contacts.
    spin : array, shape (B,)
        Spins at the first point [rad/s].
    slower : array, shape (G, B)
        By how much full twisting would have slowed the spin so far [rad/s].
    force, friction, slip : array, shape (G, B)
        Normal and friction forces [N] and slip speeds [m/s], >= 0.
    """
    left, lost = np.repeat(np.abs(spin)[None], len(slower), axis=0), np.diff(slower, axis=0)
    part = law.twisting_part(force[0], friction[0], slip[0], left[0])
    for point, most in enumerate(lost):
        there, tried = point + 1, np.maximum(left[point] - part * most, 0.0)
        part_there = law.twisting_part(force[there], friction[there], slip[there], tried)
        lost[point] *= 0.5 * (part + part_there)
        left[there] = np.maximum(left[point] - lost[point], 0.0)
        part = part_there
    return left, lost
