r"""The tangential contact of elastic spheres as a row of independent springs, for displacements in two directions.

By the method of dimensionality reduction the springs stand side by side on a line through the contact, :math:`|x| \le a = \sqrt{R D}`. Each
has the stiffness :math:`G^*` per unit length, follows the displacement of the surfaces while it is in contact, and slips where its
force would exceed :math:`\mu E^* (D - x^2 / R)` per unit length. Along one direction this is what `turning_points` follows exactly; that
has no counterpart where the direction turns.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from vibroimpact.arrays import Floats

_NUMBER = 200  # of springs in the radius of the largest contact: the friction force is then within 1e-4 of that of infinitely many


@dataclass(frozen=True)
class ContactSprings:
    """Springs of one contact; see `TangentialHistory`.

    `hertz`: Hertz's stiffness [N/m^1.5]. `radius`: effective radius [m]. `stiffness`: 2 G* [Pa]. `ratio`: mu E*/G* [-]. `width`: of a
    spring [m]. `depth`: D [m]. `stretch`: displacement of each spring of one half, integrated over its width in contact [m^2] (2, N).
    `slid`: how far the one in the middle, which sticks longest, slid on the way [m].
    """

    hertz: float
    radius: float
    stiffness: float
    ratio: float
    width: float
    depth: float
    stretch: Floats
    slid: float = 0.0

    def after(self, force: float, moved: Floats) -> tuple[ContactSprings, Floats]:
        """Return the springs at another normal force [N], after the surfaces have moved past each other [m] (2,), and the friction [N]."""
        before, depth = self.depth, (max(force, 0.0) / self.hertz) ** (2.0 / 3.0)
        rim = (self.radius * depth) ** 0.5
        stretch, number = self.stretch, int(rim / self.width) + 1
        if number > stretch.shape[1]:
            stretch = np.pad(stretch, ((0, 0), (0, number - stretch.shape[1])))
        left = self.width * np.arange(stretch.shape[1], dtype=float)
        right = np.minimum(left + self.width, rim)
        covered = np.maximum(right - left, 0.0)
        old = np.clip((self.radius * before) ** 0.5 - left, 0.0, self.width)
        if depth > before:
            # depth and displacement grow evenly: what comes into contact on the way follows for the rest of it
            reached = left + np.minimum(old, covered)
            entering = (self._pressed(right, depth) - self._pressed(reached, depth)) / (depth - before)
            stretch = stretch + moved[:, None] * np.where(covered > 0.0, reached - left + entering, 0.0)
        else:
            stretch = stretch * (covered / np.maximum(old, 1e-300)) + moved[:, None] * covered
        most = self.ratio * np.where(covered > 0.0, self._pressed(right, depth) - self._pressed(left, depth), 0.0)
        length = np.hypot(*stretch)
        stretch = stretch * np.where(length > most, most / np.maximum(length, 1e-300), 1.0)
        slid = max(float(length[0] - most[0]), 0.0) / max(float(covered[0]), 1e-300)
        return replace(self, depth=depth, stretch=stretch, slid=slid), self.stiffness * stretch.sum(axis=1)

    def _pressed(self, place: Floats, depth: float) -> Floats:
        """Return the integral of D - x^2/R up to a place [m^2]."""
        return np.asarray(place * (depth - place**2 / (3.0 * self.radius)))


def contact_springs(modulus: float, shear: float, radius: float, coefficient: float, largest_force: float) -> ContactSprings:
    """Return springs without displacement.

    Parameters
    ----------
    modulus, shear : float
        Effective modulus and effective shear modulus [Pa].
    radius : float
        Effective radius [m].
    coefficient : float
        Coefficient of friction.
    largest_force : float
        About the largest normal force [N], in whose contact the springs are close enough to each other.
    """
    hertz = 4.0 / 3.0 * modulus * radius**0.5
    width = (radius * (largest_force / hertz) ** (2.0 / 3.0)) ** 0.5 / _NUMBER
    return ContactSprings(hertz, radius, 2.0 * shear, coefficient * modulus / shear, width, 0.0, np.zeros((2, _NUMBER)))
