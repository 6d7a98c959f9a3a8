"""The force of every law is one function, which gives the same for floats, for arrays and compiled."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest

import vibroimpact as vi
from support import plain_case
from vibroimpact.compiled import law_coefficients, law_function
from vibroimpact.contact.law import CompliantLaw
from vibroimpact.contact.laws.hertz import Hertz
from vibroimpact.contact.laws.hunt_crossley import HuntCrossley
from vibroimpact.contact.laws.linear_spring_dashpot import LinearSpringDashpot
from vibroimpact.contact.laws.walton_braun import WaltonBraun
from vibroimpact.contact.registry import contact_laws

COMPLIANT = [law for law in contact_laws().values() if issubclass(law, CompliantLaw)]
OTHER_PARAMETERS = [
    HuntCrossley(stiffness=1e9, dissipation=0.3),
    LinearSpringDashpot(stiffness=1e6, damping=10.0),
    WaltonBraun(stiffness=1e6, stiffening=1e3),
    contact_laws()["meyer"](effective_modulus=7e10, effective_radius=0.01, yield_strength=4e8, meyer_index=2.0),
    contact_laws()["meyer"](effective_modulus=7e10, effective_radius=0.01, yield_strength=4e8, meyer_index=3.0),
]
DROPS = 40


def example(law: type[CompliantLaw]) -> CompliantLaw:
    typical = {item.name: item.metadata["example"] for item in dataclasses.fields(law) if item.metadata["example"] is not None}
    made = vi.read_case(plain_case(contact={"law": law.name, **typical})).to_problem().laws[0]
    assert isinstance(made, CompliantLaw)
    return made


def varied(law: CompliantLaw, random: np.random.Generator) -> CompliantLaw:
    """The law with one value per drop of each of its parameters, below those it has."""
    changes = {}
    for item in dataclasses.fields(law):
        value = getattr(law, item.name)
        if value is not None and not item.metadata["memory"] and 0.95 * value >= item.metadata["range"].at_least:
            changes[item.name] = value * random.uniform(0.95, 1.0, DROPS)
    return dataclasses.replace(law, **changes)


def states(law: CompliantLaw) -> Iterator[CompliantLaw]:
    random = np.random.default_rng(len(law.name))
    for fresh in (law, varied(law, random)):
        yield fresh
        if fresh.memories():
            yield fresh.after_compression(np.float64(1e-4))
            yield fresh.after_compression(random.uniform(0.0, 2e-4, DROPS))


def motions(law: CompliantLaw) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Indentations, of an adhesive contact negative ones as well, their rates and approach speeds."""
    random = np.random.default_rng(2)
    delta = 10.0 ** random.uniform(-9.0, -3.0, DROPS)
    delta[::4] = 0.99 * random.random(DROPS // 4) * np.minimum(law.release_level + np.zeros(DROPS), 0.0)[::4]
    return delta, random.normal(size=DROPS), random.uniform(0.1, 5.0, DROPS)


def assert_same(scalar_forces: Callable[..., Any], law: CompliantLaw) -> None:
    delta, rate, speed = motions(law)
    together = np.array(law.forces(delta, rate, speed))
    alone = np.empty((2, DROPS))
    for drop in range(DROPS):
        coefficients = law_coefficients(law.take(drop))
        assert np.all(np.isfinite(coefficients) | (law.name == "meyer"))  # whose pressure may rise without end
        alone[:, drop] = scalar_forces(float(delta[drop]), float(rate[drop]), float(speed[drop]), coefficients)
    for of_floats, of_arrays in zip(alone, together, strict=True):
        rounding = 1e-15 * np.abs(of_arrays).max()  # an adhesive force is a difference, known to the rounding of what it is between
        np.testing.assert_allclose(of_floats, of_arrays, rtol=1e-13, atol=rounding)


@pytest.mark.parametrize("law", COMPLIANT, ids=lambda law: law.name)
def test_floats_give_what_arrays_give(law: type[CompliantLaw]) -> None:
    assert law.scalar_forces is not None
    for state in states(example(law)):
        assert_same(law.scalar_forces, state)


@pytest.mark.parametrize("law", COMPLIANT, ids=lambda law: law.name)
def test_compiled_gives_what_arrays_give(law: type[CompliantLaw]) -> None:
    assert law.scalar_forces is not None
    for state in states(example(law)):
        assert_same(law_function(law), state)


@pytest.mark.parametrize("law", OTHER_PARAMETERS, ids=lambda law: law.name)
def test_laws_with_other_parameters(law: CompliantLaw) -> None:
    assert type(law).scalar_forces is not None
    for state in states(law):
        assert_same(type(law).scalar_forces, state)
        assert_same(law_function(type(law)), state)


def test_a_law_that_defines_forces_anew_is_not_compiled() -> None:
    @dataclass(frozen=True, kw_only=True)
    class Halved(Hertz):
        def forces(self, delta: np.ndarray, delta_dot: np.ndarray, approach_speed: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
            static, dissipative = super().forces(delta, delta_dot, approach_speed)
            return 0.5 * static, dissipative

    assert Halved.scalar_forces is None
    assert Hertz.scalar_forces is not None
    assert Halved(stiffness=2.0).forces(4.0, 1.0, 1.0) == (8.0, 0.0)


def test_a_law_without_a_force_says_so() -> None:
    @dataclass(frozen=True, kw_only=True)
    class Forceless(CompliantLaw):
        name = "forceless"

    with pytest.raises(NotImplementedError, match="Forceless has neither"):
        Forceless().forces(1e-6, 1.0, 1.0)
