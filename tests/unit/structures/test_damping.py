"""Damping ratios of modes."""

from __future__ import annotations

import numpy as np
import pytest

from vibroimpact.errors import InputError
from vibroimpact.structures.damping import (
    AdamsDefault,
    ConstantRatio,
    LossFactor,
    RatioOfEach,
    RatioTable,
    Rayleigh,
)

FREQUENCIES = np.array([10.0, 100.0, 400.0, 1000.0, 5000.0])


def test_constant() -> None:
    np.testing.assert_array_equal(ConstantRatio(0.02).ratios(FREQUENCIES), 0.02)
    assert ConstantRatio(0.0).description == "none"
    assert "0.02" in ConstantRatio(0.02).description


def test_adams_limits() -> None:
    """1 % below 100 Hz, 10 % from there to 1 kHz, critical above."""
    at = np.array([1e-3, 99.999, 100.0, 100.001, 999.999, 1000.0, 1000.001, 1e6])
    np.testing.assert_array_equal(
        AdamsDefault().ratios(at), [0.01, 0.01, 0.1, 0.1, 0.1, 0.1, 1.0, 1.0]
    )


def test_rayleigh() -> None:
    """zeta = a / 2 omega + b omega / 2; two ratios at two frequencies give a and b (A. K.
    Chopra, Dynamics of Structures, 11.4).
    """
    first, second, ratio = 2 * np.pi * 50.0, 2 * np.pi * 800.0, 0.03
    damping = Rayleigh(2 * ratio * first * second / (first + second), 2 * ratio / (first + second))
    np.testing.assert_allclose(damping.ratios(np.array([50.0, 800.0])), ratio, rtol=1e-12)
    lowest = damping.ratios(np.array([200.0]))[0]  # at the geometric mean
    assert lowest == pytest.approx(
        np.sqrt(damping.mass_coefficient * damping.stiffness_coefficient), rel=1e-12
    )
    assert (damping.ratios(np.linspace(10.0, 3000.0, 50)) >= lowest).all()


def test_rayleigh_is_the_damping_of_its_matrix() -> None:
    random = np.random.default_rng(0)
    root = random.standard_normal((6, 6))
    stiffness, a, b = root @ root.T + np.eye(6), 0.4, 0.01
    squared, shapes = np.linalg.eigh(stiffness)
    modal = np.diag(shapes.T @ (a * np.eye(6) + b * stiffness) @ shapes)
    np.testing.assert_allclose(
        Rayleigh(a, b).ratios(np.sqrt(squared) / (2 * np.pi)),
        modal / (2 * np.sqrt(squared)),
        rtol=1e-12,
    )


def test_table() -> None:
    table = RatioTable((100.0, 200.0, 1000.0), (0.01, 0.03, 0.02))
    at = np.array([1.0, 100.0, 150.0, 200.0, 600.0, 1000.0, 1e5])
    np.testing.assert_allclose(
        table.ratios(at), [0.01, 0.01, 0.02, 0.03, 0.025, 0.02, 0.02], rtol=1e-12
    )
    assert table.description == "a table of 3 ratios from 100 to 1000 Hz"
    np.testing.assert_array_equal(RatioTable((100.0,), (0.05,)).ratios(at), 0.05)
    assert RatioTable((100.0,), (0.05,)).description == ConstantRatio(0.05).description


@pytest.mark.parametrize(
    ("frequencies", "ratios", "message"),
    [
        ((), (), "0 frequencies and 0 ratios do not make a table"),
        ((1.0, 2.0), (0.1,), "2 frequencies and 1 ratio do not make a table"),
        ((2.0, 1.0), (0.1, 0.1), "frequencies: the frequencies of the table must ascend"),
        ((1.0, 1.0), (0.1, 0.2), "frequencies: the frequencies of the table must ascend"),
    ],
)
def test_wrong_tables(
    frequencies: tuple[float, ...], ratios: tuple[float, ...], message: str
) -> None:
    with pytest.raises(InputError, match=message):
        RatioTable(frequencies, ratios)


def test_one_ratio_a_mode() -> None:
    np.testing.assert_array_equal(
        RatioOfEach((0.01, 0.02)).ratios(FREQUENCIES), [0.01, 0.02, 0.02, 0.02, 0.02]
    )
    np.testing.assert_array_equal(RatioOfEach((0.01, 0.02, 0.03)).ratios(FREQUENCIES[:1]), [0.01])
    assert (
        RatioOfEach(tuple(np.arange(1, 7) / 100)).description
        == "damping ratios of the modes one by one: 0.01, 0.02, 0.03, 0.04, ...; the last "
        "holds for all further modes"
    )


def test_loss_factor() -> None:
    np.testing.assert_array_equal(LossFactor(0.02).ratios(FREQUENCIES), 0.01)
    assert "damping ratio 0.01" in LossFactor(0.02).description


def test_no_modes() -> None:
    for damping in (
        ConstantRatio(0.1),
        RatioTable((1.0,), (0.1,)),
        RatioOfEach((0.1,)),
        Rayleigh(1, 1),
        LossFactor(0.1),
        AdamsDefault(),
    ):
        assert damping.ratios(np.zeros(0)).shape == (0,)
        assert damping.description
