"""A ball on a simply supported rectangular plate by exact three-dimensional elasticity.

On edges that keep their height and their place along themselves (and are free to move across) the
motion of an isotropic layer goes with sines and cosines in the plane, so each pair of half waves is
a plane strain problem through the thickness alone: that of H. Lamb (Proc. R. Soc. A 93:114, 1917),
of wave number k = pi sqrt((m/a)^2 + (n/b)^2) (S. Srinivas, C. V. Joga Rao and A. K. Rao, J. Sound
Vib. 12:187, 1970). Horizontally polarised shear waves have no normal motion and play no part. The
thickness problem is solved by Legendre polynomials, whose error is that of rounding well below the
highest branch; that the frequencies are roots of Rayleigh and Lamb's equations is tested.

The half space under the load belongs to Hertz's law and is taken out of the statics of the layer,
whose kernel is known in closed form (I. N. Sneddon, Fourier Transforms, 1951, section 46). None of
this shares code with the package.
"""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

Floats = NDArray[np.float64]

_POLYNOMIALS = 18  # half of them for each motion of either parity


@dataclass(frozen=True)
class Elastic:
    """Density [kg/m^3], Young's modulus [Pa], Poisson's ratio [-]."""

    density: float
    modulus: float
    ratio: float

    @property
    def lame(self) -> tuple[float, float]:
        """Lame's constants [Pa]."""
        shear = 0.5 * self.modulus / (1.0 + self.ratio)
        return 2.0 * shear * self.ratio / (1.0 - 2.0 * self.ratio), shear


@functools.cache
def _legendre(number: int) -> tuple[Floats, Floats, Floats]:
    """Integrals over (-1, 1) of p p', p dp' and dp dp' of normalised Legendre polynomials."""
    z, weight = legendre.leggauss(number + 2)
    scale = np.sqrt(np.arange(number) + 0.5)
    values = legendre.legvander(z, number - 1) * scale
    slopes = (
        np.stack(
            [legendre.legval(z, legendre.legder(np.eye(number)[i])) for i in range(number)], axis=1
        )
        * scale
    )
    return (values.T * weight) @ values, (values.T * weight) @ slopes, (slopes.T * weight) @ slopes


def thickness_modes(
    k: Floats, thickness: float, material: Elastic, even: bool, number: int = _POLYNOMIALS
) -> tuple[Floats, Floats]:
    """Return angular frequencies [rad/s] and upward motion of the upper face [(kg/m^2)^-1/2], shape
    (wave numbers, branches).

    The modes are those of the plane layer under waves of wave number k [1/m], of unit mass a unit
    area; `even` ones stretch the thickness (S0, S1, ...), the others bend the layer (A0, A1, ...).
    """
    half, (lame, shear) = 0.5 * thickness, material.lame
    unit, mixed, slope = _legendre(number)
    # polynomials of the motion along the wave, and of that across
    along = np.arange(0 if even else 1, number, 2)
    across = np.arange(1 if even else 0, number, 2)
    size = len(along)
    k = np.atleast_1d(k)[:, None, None]
    stiffness = np.zeros((len(k), size + len(across), size + len(across)))
    u, w = (slice(None), slice(0, size)), (slice(None), slice(size, None))
    uu, ww, uw = np.ix_(along, along), np.ix_(across, across), np.ix_(along, across)
    stiffness[(*u, slice(0, size))] = (lame + 2 * shear) * k**2 * unit[uu] + shear * slope[
        uu
    ] / half**2
    stiffness[(*w, slice(size, None))] = (lame + 2 * shear) * slope[
        ww
    ] / half**2 + shear * k**2 * unit[ww]
    coupling = k * (shear * mixed.T[uw] - lame * mixed[uw]) / half
    stiffness[(*u, slice(size, None))] = coupling
    stiffness[(*w, slice(0, size))] = coupling.transpose(0, 2, 1)
    squares, vectors = np.linalg.eigh(stiffness / material.density)
    face = np.sqrt(across + 0.5) @ vectors[:, size:] / math.sqrt(material.density * half)
    return np.sqrt(np.maximum(squares, 0.0)), face


def layer(y: Floats) -> Floats:
    """Return the static response of the upper face of a layer over that of the half
    space, at y = k h.
    """
    y = np.minimum(y, 60.0)
    return (1.0 + np.cosh(y)) / (2.0 * (np.sinh(y) - y)) + (np.cosh(y) - 1.0) / (
        2.0 * (np.sinh(y) + y)
    )


@dataclass(frozen=True)
class Plate:
    """A simply supported plate: length, width and thickness [m], and the place (x, y) [m]
    from its centre where it is met.
    """

    size: tuple[float, float, float]
    material: Elastic
    place: tuple[float, float] = (0.0, 0.0)

    def half_waves(self, largest: float) -> tuple[Floats, Floats]:
        """Wave numbers up to a largest [1/m], and the motion of the place in sines of
        unit mean square times the area [1/m].
        """
        numbers = [
            np.arange(1, int(largest * side / math.pi) + 1) * math.pi / side
            for side in self.size[:2]
        ]
        k = np.hypot(*np.meshgrid(*numbers, indexing="ij"))
        sines = [
            np.sin(n * (at + 0.5 * side))
            for n, at, side in zip(numbers, self.place, self.size[:2], strict=True)
        ]
        shape = 2.0 / math.sqrt(self.size[0] * self.size[1]) * np.outer(*sines)
        kept = (k <= largest) & (np.abs(shape) > 1e-12 * np.abs(shape).max())
        return k[kept], shape[kept]

    def static(self) -> float:
        """The displacement of the place under a unit force less that of the half space [m/N].

        Under a Gaussian load so narrow (of width b) that neither the images of the half space nor
        the layer see that it is no point.
        """
        thickness, material = self.size[2], self.material
        b = 0.1 * thickness
        k, shape = self.half_waves(80.0 / thickness)
        images = (shape**2 / k * np.exp(-((b * k) ** 2))).sum() - 1.0 / (
            4.0 * math.sqrt(math.pi) * b
        )
        structural = (shape**2 / k * (layer(k * thickness) - 1.0)).sum()
        return float(2.0 * (1.0 - material.ratio**2) / material.modulus * (structural + images))

    def modes(self, highest: float) -> tuple[Floats, Floats]:
        """Angular frequencies below a highest [rad/s] and shapes at the place [kg^-1/2]."""
        # no surface wave is slower
        slowest = 0.85 * math.sqrt(self.material.lame[1] / self.material.density)
        k, shape = self.half_waves(self._largest(highest, slowest))
        omegas, shapes = [], []
        for even in (False, True):
            omega, face = thickness_modes(k, self.size[2], self.material, even)
            kept = omega < highest
            omegas.append(omega[kept])
            shapes.append((shape[:, None] * face)[kept])
        return np.concatenate(omegas), np.concatenate(shapes)

    def _largest(self, highest: float, slowest: float) -> float:
        """The largest wave number [1/m] that a frequency may belong to: that of bending
        waves, slow where they are long.
        """
        thickness, material = self.size[2], self.material
        k = np.linspace(1e-3, 40.0, 4000) / thickness
        bending = thickness_modes(k, thickness, material, even=False, number=12)[0][:, 0]
        return (
            float(k[np.searchsorted(bending, highest)])
            if bending[-1] > highest
            else highest / slowest
        )


@dataclass(frozen=True)
class Impact:
    """What came out: largest force [N], duration [s], restitution [-], largest indentation [m]."""

    force: float
    duration: float
    restitution: float
    indentation: float


def impact(
    mass: float,
    stiffness: float,
    speed: float,
    omega: Floats,
    shape: Floats,
    rest: float,
    step: float,
    steps: int,
) -> Impact:
    """A rigid ball with Hertz's force stiffness * indentation^1.5 against modes without damping and
    a compliance in series.

    Parameters
    ----------
    mass, stiffness, speed : float
        Of the ball [kg], of the law [N/m^1.5], at the first touch [m/s].
    omega, shape : array
        Of the modes [rad/s], [kg^-1/2].
    rest : float
        Compliance in series with the law [m/N]: of all the modes that are not there, less the half
        space.
    step : float
        Time [s]; between steps the force is straight, under which modes and ball move exactly.
    steps : int
        How many; a plate that comes back may touch the ball again.
    """
    cosine, sine = np.cos(omega * step), np.sin(omega * step)
    # displacements, and velocities, at the end of a step by a force of one at its beginning, and at
    # its end
    before = shape * (sine / (omega * step) - cosine) / omega**2
    after = shape * (1.0 - sine / (omega * step)) / omega**2
    before_speed = shape * (sine * omega - (1.0 - cosine) / step) / omega**2
    after_speed = shape * (1.0 - cosine) / step / omega**2
    at_once = float(shape @ after) + step**2 / (6.0 * mass) + rest
    q, moving = np.zeros_like(omega), np.zeros_like(omega)
    depth, velocity, force, delta, deepest, end = 0.0, speed, 0.0, 0.0, 0.0, 0.0
    forces = [0.0]
    for number in range(steps):
        free = cosine * q + sine / omega * moving + before * force
        gap = depth + step * velocity - step**2 / (3.0 * mass) * force - float(shape @ free)
        last, delta = delta, _indentation(gap, at_once, stiffness, delta)
        if delta == 0.0 and last > 0.0:
            one_before = (forces[-2] / stiffness) ** (2.0 / 3.0)
            end = step * (number + last / (one_before - last))  # it goes out in a straight line
        new = stiffness * delta**1.5
        moving = cosine * moving - sine * omega * q + before_speed * force + after_speed * new
        q = free + after * new
        depth += step * velocity - step**2 / 6.0 * (2.0 * force + new) / mass
        velocity -= 0.5 * step * (force + new) / mass
        force = new
        forces.append(new)
        deepest = max(deepest, delta)
    if force > 0.0:
        raise RuntimeError("the ball is still in contact")
    a, b, c = forces[(peak := int(np.argmax(forces))) - 1 : peak + 2]
    return Impact(b + (a - c) ** 2 / (8.0 * (2.0 * b - a - c)), end, -velocity / speed, deepest)


def _indentation(gap: float, at_once: float, stiffness: float, start: float) -> float:
    """The root of delta + at_once * stiffness * delta^1.5 = gap, by Newton's method; none
    beyond the surface.
    """
    if gap <= 0.0:
        return 0.0
    delta = start or gap
    for _ in range(60):
        force = stiffness * delta**1.5
        change = (delta + at_once * force - gap) / (1.0 + 1.5 * at_once * force / delta)
        delta = max(delta - change, 0.1 * delta)
        if abs(change) < 1e-14 * delta:
            break
    return delta


def drop(
    plate: Plate,
    radius: float,
    ball: Elastic,
    speed: float,
    periods: float = 12.0,
    steps: int = 1500,
    times: float = 3.0,
) -> Impact:
    """A ball (rigid but for Hertz's law) of a radius [m] at a speed [m/s], with all modes of the
    plate of so many periods in its contact.

    `steps` of time are in Hertz's contact on a half space, and so many of its `times` are looked
    at.
    """
    time = contact_time(plate.material, radius, ball, speed)
    omega, shape = plate.modes(2.0 * math.pi * periods / time)
    rest = plate.static() - float(((shape / omega) ** 2).sum())
    return impact(
        *hertz(plate.material, radius, ball),
        speed,
        omega,
        shape,
        rest,
        time / steps,
        int(times * steps),
    )


def hertz(material: Elastic, radius: float, ball: Elastic) -> tuple[float, float]:
    """Mass of the ball [kg] and Hertz's stiffness [N/m^1.5]."""
    modulus = 1.0 / (
        (1.0 - material.ratio**2) / material.modulus + (1.0 - ball.ratio**2) / ball.modulus
    )
    return ball.density * 4.0 / 3.0 * math.pi * radius**3, 4.0 / 3.0 * modulus * math.sqrt(radius)


def contact_time(material: Elastic, radius: float, ball: Elastic, speed: float) -> float:
    """Hertz's contact time on a half space [s]."""
    mass, stiffness = hertz(material, radius, ball)
    return 2.9432751843 / speed * (1.25 * mass * speed**2 / stiffness) ** 0.4


STEEL, ALUMINIUM = Elastic(7850.0, 210e9, 0.3), Elastic(2700.0, 70e9, 0.33)
PMMA = Elastic(1190.0, 3.3e9, 0.37)
