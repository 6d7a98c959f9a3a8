"""The finite size of a sphere: its series, and its closed form."""

from __future__ import annotations

import numpy as np
import pytest

from vibroimpact.errors import InputError
from vibroimpact.structures import sphere_compliance
from vibroimpact.structures.sphere_compliance import finite_sphere_factor, sphere_term

POISSON = (0.0, 0.15, 0.28, 0.4, 0.5)


@pytest.fixture
def longer_series(monkeypatch: pytest.MonkeyPatch) -> None:
    """Twice the terms, and what the integral over the patch then needs."""
    for name, factor in (("_REACH", 2.0), ("_LEAST", 2), ("_NODES", 2)):
        monkeypatch.setattr(sphere_compliance, name, factor * getattr(sphere_compliance, name))


def fresh(poissons_ratio: float, ratios: np.ndarray) -> np.ndarray:
    for cached in (sphere_compliance._factor, sphere_compliance._gauss):
        cached.cache_clear()
    found = finite_sphere_factor(poissons_ratio, ratios)
    for cached in (sphere_compliance._factor, sphere_compliance._gauss):
        cached.cache_clear()
    return found


RATIOS = np.array([0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.35, 0.5])
SHORT = {ratio: fresh(ratio, RATIOS) for ratio in (0.0, 0.28, 0.5)}


@pytest.mark.usefixtures("longer_series")
@pytest.mark.parametrize("poissons_ratio", list(SHORT))
def test_the_series_is_long_enough(poissons_ratio: float) -> None:
    np.testing.assert_allclose(SHORT[poissons_ratio], fresh(poissons_ratio, RATIOS), atol=1e-5)


def test_numbers_of_another_program() -> None:
    """A series of four thousand terms without the half space taken away, kept from the
    time of writing.
    """
    assert finite_sphere_factor(0.28, 0.04) == pytest.approx(-0.377311, abs=1e-5)
    assert finite_sphere_factor(0.28, 0.18) == pytest.approx(-0.420903, abs=1e-5)


@pytest.mark.parametrize("poissons_ratio", POISSON)
def test_the_closed_form_holds_its_promise(poissons_ratio: float) -> None:
    ratios = np.geomspace(0.01, 0.35, 12)
    np.testing.assert_allclose(
        sphere_term(poissons_ratio).factor(ratios),
        finite_sphere_factor(poissons_ratio, ratios),
        atol=3e-4,
    )


@pytest.mark.parametrize("poissons_ratio", POISSON)
def test_small_contacts_know_a_logarithm(poissons_ratio: float) -> None:
    """The slope of the series itself goes to what was derived, linearly in the ratio."""
    coarse, fine = (
        np.diff(finite_sphere_factor(poissons_ratio, [x / 1.5, 1.5 * x]))[0] / np.log(1.5**2)
        for x in (0.02, 0.01)
    )
    assert 2 * fine - coarse == pytest.approx(sphere_term(poissons_ratio).logarithm, abs=3e-4)


def test_shapes_are_kept() -> None:
    assert finite_sphere_factor(0.3, 0.1).shape == ()
    assert finite_sphere_factor(0.3, np.full((2, 3), 0.1)).shape == (2, 3)


@pytest.mark.parametrize(
    ("poissons_ratio", "ratio"), [(0.3, 0.001), (0.3, 0.7), (0.6, 0.1), (-0.1, 0.1), (0.3, np.nan)]
)
def test_out_of_range(poissons_ratio: float, ratio: float) -> None:
    with pytest.raises(InputError, match="finite size of a sphere"):
        finite_sphere_factor(poissons_ratio, ratio)
