"""The terms between a layer, its faces and plate theory."""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.special import j0, j1

from vibroimpact.structures.plate_compliance import (
    Average,
    plate_theory_average,
    plate_theory_term,
    through_thickness_average,
    through_thickness_term,
)


def layer(y: float) -> tuple[float, float]:
    x = 0.5 * y
    return math.cosh(x) ** 2 / (math.sinh(y) - y), math.sinh(x) ** 2 / (math.sinh(y) + y)


def integrated(kernel: Callable[[float], float]) -> float:
    ends = [0.02, 0.3, 1.0, 3.0, 10.0, 30.0, 100.0]
    return sum(
        quad(lambda k: kernel(k) * k / (2 * math.pi), a, b, limit=200)[0] for a, b in pairwise(ends)
    )


def disc(z: float, tilt: float) -> float:
    return quad(lambda t: (1 + tilt * (1 - 2 * t)) * j0(z * math.sqrt(t)), 0, 1, limit=200)[0]


@pytest.mark.parametrize("tilt", [0.0, 1.5, 3.0, 7.0])
def test_transforms(tilt: float) -> None:
    average = Average(0.2, tilt)
    k = np.array([0.0, 1.0, 7.0, 40.0])
    np.testing.assert_allclose(
        average.transform(k), [disc(0.2 * one, tilt) for one in k], rtol=1e-9, atol=1e-12
    )
    if tilt == 0.0:
        np.testing.assert_allclose(
            average.transform(k[1:]), 2 * j1(0.2 * k[1:]) / (0.2 * k[1:]), rtol=1e-12
        )


def test_through_the_thickness_under_a_point() -> None:
    exact = quad(lambda x: 2 * math.sinh(x) ** 2 / (math.sinh(2 * x) + 2 * x) - 1, 0, 20)[0]
    found = through_thickness_term(1.0, 1.0, 0.0, through_thickness_average(0.0)) * math.pi / 2
    assert found == pytest.approx(exact, rel=1e-8)
    assert found == pytest.approx(-1.16757684, abs=1e-8)


@pytest.mark.parametrize("poissons_ratio", [0.0, 0.3, 0.5])
@pytest.mark.parametrize("radius", [0.5, 0.75])
def test_against_adaptive_quadrature(poissons_ratio: float, radius: float) -> None:
    """Thickness and modulus 1; the reference begins at 0.02, below which the kernel is
    that of the half space but for k^2.
    """
    half_space = 2 * (1 - poissons_ratio**2)
    rigidity, factor = 1 / (12 * (1 - poissons_ratio**2)), 5 / (6 - poissons_ratio)
    shear = 0.5 * factor / (1 + poissons_ratio)
    faces, theory = (
        through_thickness_average(radius),
        plate_theory_average(radius, 1.0, poissons_ratio, factor),
    )

    def through(k: float) -> float:
        a, s = layer(k)
        return half_space / k * (a + s - 1 - (a - s) * float(faces.transform(np.array(k))) ** 2)

    def mindlin(k: float) -> float:
        return half_space / k * (sum(layer(k)) - 1) - float(theory.transform(np.array(k))) ** 2 * (
            1 / (rigidity * k**4) + 1 / (shear * k**2)
        )

    rest = -0.02 * half_space / (2 * math.pi)
    assert through_thickness_term(1.0, 1.0, poissons_ratio, faces) == pytest.approx(
        integrated(through) + rest, abs=2e-3
    )
    assert plate_theory_term(1.0, 1.0, poissons_ratio, factor, theory) == pytest.approx(
        integrated(mindlin) + rest, abs=2e-3
    )


def test_units() -> None:
    """A compliance goes with 1 / (E h)."""

    def terms(thickness: float, modulus: float) -> list[float]:
        theory = plate_theory_average(0.6 * thickness, thickness, 0.3, 5 / 5.7)
        through = through_thickness_term(
            thickness, modulus, 0.3, through_thickness_average(0.6 * thickness)
        )
        return [through, plate_theory_term(thickness, modulus, 0.3, 5 / 5.7, theory)]

    np.testing.assert_allclose(
        np.multiply(terms(0.008, 2.1e11), 2.1e11 * 0.008), terms(1.0, 1.0), rtol=1e-9
    )


@pytest.mark.parametrize("factor", [5 / 5.7, 5 / 6, math.inf])
def test_the_kernels_agree_for_long_waves(factor: float) -> None:
    """To the second order beyond that of bending: what is left is the half space, of the third."""
    k = np.array([0.02, 0.01])
    average = plate_theory_average(0.6, 1.0, 0.3, factor)
    rigidity, shear = 1 / (12 * 0.91), factor / 2.6
    structural = np.array([2 * 0.91 / one * (sum(layer(one)) - 1) for one in k])
    theory = (1 / (rigidity * k**4) + 1 / (shear * k**2)) * average.transform(k) ** 2
    np.testing.assert_allclose((structural - theory) * k, -2 * 0.91, atol=0.1)
    through = (
        np.array([2 * 0.91 / one * (layer(one)[0] - layer(one)[1]) for one in k])
        * through_thickness_average(0.6).transform(k) ** 2
    )
    np.testing.assert_allclose((structural - through) * k, -2 * 0.91, atol=0.1)
