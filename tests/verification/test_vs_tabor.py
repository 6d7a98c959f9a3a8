"""Against Tabor's theory of rebound with Meyer's index, and one speed that Kharaz and Gorham give
(Philos. Mag. Lett. 80, 549, 2000).

The energies are integrated by SciPy over the contact radius, on which the law rests, while the law
is a function of the indentation.
"""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq

import vibroimpact as vi
from agreement import Against, Agrees
from vibroimpact.contact.laws.hertz import Hertz
from vibroimpact.contact.laws.meyer import Meyer

AGAINST = Against(
    "Tabor's rebound theory with Meyer's index, numerical quadrature (SciPy)",
    "own independent computation",
    "elastic-plastic contact",
    "Tabor 1948, Proc. R. Soc. A 192, 247; energies integrated over the contact radius",
)
JOHNSON = Against(
    "Johnson, rebound at constant contact pressure",
    "closed form",
    "elastic-plastic contact",
    "Johnson, Contact Mechanics, 1985, eq. 11.47",
)
MEASURED = Against(
    "Kharaz and Gorham, speed of full plasticity of spheres on steel and aluminium",
    "fitted to measurements",
    "elastic-plastic contact",
    "Kharaz and Gorham 2000, Philos. Mag. Lett. 80, 549: about 100 times the speed of first "
    "yield, for which the default Meyer "
    "index was chosen; none of their restitutions is compared",
)


MODULUS, RADIUS, STRENGTH, MASS = 7e10, 0.0025, 3e8, 2.6e-4
AT_YIELD, FULL = 1.6 * 2.0 / 3.0 * STRENGTH, 2.8 * STRENGTH
# Hertz's, whose mean pressure is 4 E* a/(3 pi R)
YIELD_RADIUS = 0.75 * np.pi * AT_YIELD * RADIUS / MODULUS


def law_of(index: float) -> Meyer:
    return Meyer(
        effective_modulus=MODULUS,
        effective_radius=RADIUS,
        yield_strength=STRENGTH,
        meyer_index=index,
    )


def force(a: float, index: float) -> float:
    return np.pi * a * a * min(AT_YIELD * (a / YIELD_RADIUS) ** (index - 2.0), FULL)


def indentation(a: float, index: float) -> float:
    """That of the dent's sphere, and half the elastic one."""
    return 0.5 * a * a / RADIUS + 0.375 * force(a, index) / (MODULUS * a)


def full_radius(index: float) -> float:
    return YIELD_RADIUS * (FULL / AT_YIELD) ** (1.0 / (index - 2.0)) if index > 2.0 else np.inf


def loading_work(a: float, index: float) -> float:
    """The integral of the force over the indentation, by parts: F delta less the integral
    of delta over F.
    """
    hertz = 0.4 * np.pi * AT_YIELD * YIELD_RADIUS**4 / RADIUS
    at_full, work = full_radius(index), 0.0
    for low, high, power in (
        (YIELD_RADIUS, min(a, at_full), index),
        (at_full, max(a, at_full), 2.0),
    ):
        if high > low:
            begun, ended = (
                force(low, index) * indentation(low, index),
                force(high, index) * indentation(high, index),
            )
            rest = quad(
                lambda r, power=power: indentation(r, index) * power * force(r, index) / r,
                low,
                high,
                epsrel=1e-12,
            )[0]
            work += ended - begun - rest
    return hertz + work


YIELD_SPEED = np.sqrt(2.0 * loading_work(YIELD_RADIUS, 2.45) / MASS)


@pytest.mark.parametrize("index", [2.0, 2.2, 2.45, 2.7, 3.0])
def test_force_over_indentation(agrees: Agrees, index: float) -> None:
    law = law_of(index)
    for a in YIELD_RADIUS * np.array([1.0, 1.3, 3.0, 8.0, 9.0, 30.0]):
        delta = indentation(a, index)
        agrees(
            "five Meyer indices, contact radii to 30 times the yield radius",
            "contact force",
            law.loading_force(np.array(delta)),
            force(a, index),
            unit="N",
            relative=1e-12,
        )
        work = loading_work(a, index)
        agrees(
            "five Meyer indices, contact radii to 30 times the yield radius",
            "work of loading",
            law.loading_work(np.array(delta)),
            work,
            unit="J",
            relative=1e-9,
        )
        assert law.contact_radius(np.array(delta)) == pytest.approx(a, rel=1e-12)


@pytest.mark.parametrize("index", [2.0, 2.2, 2.45, 2.7, 3.0])
@pytest.mark.parametrize("ratio", [1.5, 10.0, 80.0, 300.0])
def test_restitution(agrees: Agrees, index: float, ratio: float) -> None:
    speed = ratio * YIELD_SPEED
    energy = 0.5 * MASS * speed**2
    a = brentq(
        lambda a: loading_work(a, index) - energy,
        YIELD_RADIUS,
        1e3 * YIELD_RADIUS,
        xtol=1e-20,
        rtol=1e-14,
    )
    recovered = 0.3 * force(a, index) ** 2 / (MODULUS * a)  # Tabor's: Hertz's energy of the dent
    expected = np.sqrt(recovered / energy)
    case, law = "five Meyer indices, 1.5 to 300 times the yield speed", law_of(index)
    agrees(
        f"{case}, closed form",
        "coefficient of restitution",
        law.closed_form_restitution(MASS, speed),
        expected,
        relative=1e-8,
    )
    agrees(
        f"{case}, integrated",
        "coefficient of restitution",
        vi.laws.integrated_restitution(law, MASS, speed),
        expected,
        relative=1e-6,
    )


def test_elastic_up_to_yield() -> None:
    law, hertz = law_of(2.45), Hertz(stiffness=4.0 / 3.0 * MODULUS * RADIUS**0.5)
    assert law.closed_form_restitution(MASS, 0.999 * YIELD_SPEED) == pytest.approx(1.0, abs=1e-15)
    deltas = float(law.yield_indentation) * np.linspace(0.01, 1.0, 30)
    np.testing.assert_allclose(
        law.forces(deltas, 0.0, 1.0)[0], hertz.forces(deltas, 0.0, 1.0)[0], rtol=1e-14
    )
    # with an index of 3 it is elastic up to the full pressure
    assert law_of(3.0).closed_form_restitution(
        MASS, YIELD_SPEED * 0.999 * (FULL / AT_YIELD) ** 2.5
    ) == pytest.approx(1.0, abs=1e-12)


def test_the_power_of_the_speed(agrees: Agrees) -> None:
    """Johnson's closed form of a constant pressure (Contact Mechanics, 1985, eq. 11.47),
    and the power of Meyer's index.
    """
    energy = 0.5 * MASS * (1e9 * YIELD_SPEED) ** 2
    for index, pressure in ((2.0, AT_YIELD), (2.45, FULL)):
        expected = (
            0.3
            * np.pi**1.25
            * 4**0.75
            * pressure
            / MODULUS
            * (energy / (pressure * RADIUS**3)) ** -0.25
        )
        found = law_of(index).closed_form_restitution(MASS, 1e9 * YIELD_SPEED) ** 2
        agrees(
            "far above the yield speed",
            "square of the coefficient of restitution",
            found,
            expected,
            against=JOHNSON,
            relative=1e-4,
        )
    index = 2.02  # full plasticity is beyond
    slow, fast = (
        law_of(index).closed_form_restitution(MASS, ratio * YIELD_SPEED) for ratio in (1e8, 1e9)
    )
    assert np.log10(fast / slow) == pytest.approx(-(3.0 - index) / (index + 2.0), abs=1e-4)


def test_full_plasticity_at_a_hundred_times_the_speed_of_yield(agrees: Agrees) -> None:
    """With the default index, which was chosen for it: between 1.1 and 2.8 times the
    yield strength lie two decades of speed.
    """
    law = Meyer(effective_modulus=MODULUS, effective_radius=RADIUS, yield_strength=STRENGTH)
    at_yield, at_full = (
        np.sqrt(2.0 * float(law.loading_work(np.asarray(level))) / MASS)
        for level in law.breakpoints
    )
    agrees(
        "`meyer`, default index",
        "speed at full plasticity, normalized by the yield speed",
        at_full / at_yield,
        100.0,
        against=MEASURED,
        relative=0.02,
    )
    assert float(law.loading_force(law.breakpoints[0])) / (
        np.pi * YIELD_RADIUS**2 * STRENGTH
    ) == pytest.approx(1.1, abs=0.04)
    radius = float(law.contact_radius(np.asarray(law.breakpoints[1])))
    assert float(law.loading_force(law.breakpoints[1])) / (
        np.pi * radius**2 * STRENGTH
    ) == pytest.approx(2.8, rel=1e-12)
