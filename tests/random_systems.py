"""Systems of bodies, made by hand and at random."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

import vibroimpact as vi
from vibrating import modes_of
from vibroimpact.contact.law import CompliantLaw
from vibroimpact.contact.laws.hertz import Hertz
from vibroimpact.structures.modal_model import ModalBasis

HERTZ = Hertz(stiffness=1e9)

ROOTS = np.array(
    [
        4.730040744862704,
        7.853204624095838,
        10.995607838001671,
        14.137165491257464,
        17.27875965739948,
        20.42035224562606,
    ]
)
"""Of cos x cosh x = 1: free vibration of a beam."""


def row_of_balls(
    number: int,
    speed: float = 1.0,
    *,
    mass: float = 0.1,
    law: CompliantLaw = HERTZ,
    gap: float = 0.0,
) -> vi.System:
    """Balls in a row along z, of which the first moves towards the others."""
    balls = {
        f"{ball}": vi.MovingBody(mass=mass, velocity=(0.0, 0.0, 0.0 if ball else speed))
        for ball in range(number)
    }
    contacts = {
        f"{ball}-{ball + 1}": vi.PointContact(
            below=f"{ball}", above=f"{ball + 1}", law=law, gap=gap
        )
        for ball in range(number - 1)
    }
    return vi.System(bodies=balls, contacts=contacts)


def modes_at(frequencies: np.ndarray, damping: float, **shapes: np.ndarray) -> ModalBasis:
    """Modes [Hz] that move contacts along z, of shapes [kg^-1/2] by the names of the contacts."""
    some = modes_of(frequencies, np.zeros(len(frequencies)), damping)
    return replace(
        some, points={name: np.outer(shape, [0.0, 0.0, 1.0]) for name, shape in shapes.items()}
    )


def free_beam(
    length: float,
    width: float,
    thickness: float,
    material: tuple[float, float],
    number: int,
    **places: float,
) -> vi.MovingBody:
    """A free beam along x by Euler and Bernoulli, of a density and a modulus; with so
    many modes, seen at places x from its middle.
    """
    density, modulus = material
    mass = density * length * width * thickness
    roots = np.array(
        [
            4.730040744862704,
            7.853204624095838,
            10.995607838001671,
            14.137165491257464,
            17.27875965739948,
            20.42035224562606,
        ]
    )[:number]
    frequencies = (
        (roots / length) ** 2 * np.sqrt(modulus * thickness**2 / 12.0 / density) / (2.0 * np.pi)
    )

    def shape(x: float) -> np.ndarray:
        at, end = (
            roots * (x / length + 0.5),
            (np.cosh(roots) - np.cos(roots)) / (np.sinh(roots) - np.sin(roots)),
        )
        return (np.cosh(at) + np.cos(at) - end * (np.sinh(at) + np.sin(at))) / np.sqrt(mass)

    modes = (
        modes_at(frequencies, 0.0, **{name: shape(x) for name, x in places.items()})
        if number
        else None
    )
    turning = (
        mass
        / 12.0
        * np.array([width**2 + thickness**2, length**2 + thickness**2, length**2 + width**2])
    )
    return vi.MovingBody(mass=mass, inertia=turning, modes=modes)
