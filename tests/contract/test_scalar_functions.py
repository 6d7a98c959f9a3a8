"""Force, energies, levels and memory of every law are functions, which give the same for
floats, for arrays and compiled.
"""

from __future__ import annotations

import dataclasses
import gc
import weakref
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest

import vibroimpact as vi
from support import plain_case
from vibroimpact.compiled import law_coefficients, law_function
from vibroimpact.compiler.function_values import (
    FRICTION_FUNCTIONS,
    LAW_FUNCTIONS,
    interpreted_function,
)
from vibroimpact.contact.friction.law import ImpulsiveFriction
from vibroimpact.contact.friction.laws.coulomb import Coulomb
from vibroimpact.contact.friction.laws.rigid import Rigid
from vibroimpact.contact.law import CompliantLaw
from vibroimpact.contact.laws.hertz import Hertz
from vibroimpact.contact.laws.hunt_crossley import HuntCrossley
from vibroimpact.contact.laws.linear_spring_dashpot import LinearSpringDashpot
from vibroimpact.contact.laws.walton_braun import WaltonBraun
from vibroimpact.contact.parameters import memory, parameter
from vibroimpact.contact.registry import contact_laws

COMPLIANT = [law for law in contact_laws().values() if issubclass(law, CompliantLaw)]
OTHER_PARAMETERS = [
    HuntCrossley(stiffness=1e9, dissipation=0.3),
    LinearSpringDashpot(stiffness=1e6, damping=10.0),
    WaltonBraun(stiffness=1e6, stiffening=1e3),
    contact_laws()["meyer"](
        effective_modulus=7e10, effective_radius=0.01, yield_strength=4e8, meyer_index=2.0
    ),
    contact_laws()["meyer"](
        effective_modulus=7e10, effective_radius=0.01, yield_strength=4e8, meyer_index=3.0
    ),
]
DROPS = 40


def example(law: type[CompliantLaw]) -> CompliantLaw:
    typical = {
        item.name: item.metadata["example"]
        for item in dataclasses.fields(law)
        if item.metadata["example"] is not None
    }
    made = vi.case_of(plain_case(contact={"law": law.name, **typical})).to_problem().laws[0]
    assert isinstance(made, CompliantLaw)
    return made


def varied(law: CompliantLaw, random: np.random.Generator) -> CompliantLaw:
    """The law with one value per drop of each of its parameters, below those it has."""
    changes = {}
    for item in dataclasses.fields(law):
        value = getattr(law, item.name)
        if (
            value is not None
            and not item.metadata["memory"]
            and 0.95 * value >= item.metadata["range"].at_least
        ):
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
    """Indentations, of an adhesive contact negative ones as well, their rates and
    approach speeds.
    """
    random = np.random.default_rng(2)
    delta = 10.0 ** random.uniform(-9.0, -3.0, DROPS)
    delta[::4] = (
        0.99 * random.random(DROPS // 4) * np.minimum(law.release_level + np.zeros(DROPS), 0.0)[::4]
    )
    return delta, random.normal(size=DROPS), random.uniform(0.1, 5.0, DROPS)


def functions_in_python(law: type[CompliantLaw]) -> list[Callable[..., Any]]:
    assert not law.missing_functions()
    return [getattr(law, attribute) for attribute in LAW_FUNCTIONS.values()]


def compiled_functions(law: type[CompliantLaw]) -> list[Callable[..., Any]]:
    return [law_function(law, kind) for kind in LAW_FUNCTIONS]


def assert_close(of_floats: np.ndarray, of_arrays: np.ndarray, name: str) -> None:
    for alone, together in zip(of_floats, of_arrays, strict=True):
        # what is a difference is known to that of its terms
        rounding = 1e-15 * np.abs(of_arrays[np.isfinite(of_arrays)]).max()
        np.testing.assert_allclose(alone, together, rtol=1e-13, atol=rounding, err_msg=name)


def assert_rounded(changed: np.ndarray, wanted: np.ndarray) -> None:
    """Assert that coefficients agree to a few roundings of the terms, of which two are
    differences in elastic-plastic laws.
    """
    terms = np.abs(wanted)
    terms[1] += terms[0]
    terms[5] += terms[0] * terms[3]
    differs = changed != wanted  # equal infinities have no difference
    assert np.all(np.abs(changed[differs] - wanted[differs]) <= 2e-15 * terms[differs])


def assert_same(functions: list[Callable[..., Any]], law: CompliantLaw) -> None:
    """Assert that functions of floats give what the methods of the law give for arrays."""
    forces, energies, levels, compressed = functions
    delta, rate, speed = motions(law)
    shape = np.zeros(DROPS)
    breakpoints = [
        np.broadcast_to(level, DROPS)
        for level in (*law.breakpoints, shape + np.inf, shape + np.inf)
    ]
    expected_levels = np.array(
        [law.touch_level + shape, law.release_level + shape, *breakpoints[:2]]
    )
    after = law.after_compression(delta) if law.memories() else law
    found_forces, found_energies, found_levels = (
        np.empty((2, DROPS)),
        np.empty((2, DROPS)),
        np.empty((5, DROPS)),
    )
    for drop in range(DROPS):
        own = law.take(drop)
        coefficients = law_coefficients(own)
        # whose pressure may rise without end
        assert np.all(np.isfinite(coefficients) | (law.name == "meyer"))
        found_forces[:, drop] = forces(
            float(delta[drop]), float(rate[drop]), float(speed[drop]), coefficients
        )
        found_energies[:, drop] = energies(float(delta[drop]), coefficients)
        found_levels[:, drop] = levels(coefficients)
        changed = coefficients.copy()
        memory_level = compressed(float(delta[drop]), coefficients, changed)
        assert_rounded(changed, law_coefficients(after.take(drop)))
        assert memory_level == levels(changed)[2]
        if delta[drop] <= found_levels[2, drop]:
            assert_rounded(changed, coefficients)
        else:
            assert np.any(changed != coefficients)
    assert_close(found_forces, np.array(law.forces(delta, rate, speed)), "forces")
    assert_close(
        found_energies, np.array([law.elastic_energy(delta), law.plastic_work(delta)]), "energies"
    )
    assert_close(found_levels[[0, 1, 3, 4]], expected_levels, "levels")


@pytest.mark.parametrize("law", COMPLIANT, ids=lambda law: law.name)
def test_floats_give_what_arrays_give(law: type[CompliantLaw]) -> None:
    for state in states(example(law)):
        assert_same(functions_in_python(law), state)


@pytest.mark.parametrize("law", COMPLIANT, ids=lambda law: law.name)
def test_compiled_gives_what_arrays_give(law: type[CompliantLaw]) -> None:
    for state in states(example(law)):
        assert_same(compiled_functions(law), state)


@pytest.mark.parametrize("law", OTHER_PARAMETERS, ids=lambda law: law.name)
def test_laws_with_other_parameters(law: CompliantLaw) -> None:
    for state in states(law):
        assert_same(functions_in_python(type(law)), state)
        assert_same(compiled_functions(type(law)), state)


@pytest.mark.parametrize(
    "law", [*map(example, COMPLIANT), *OTHER_PARAMETERS], ids=lambda law: law.name
)
def test_compiled_force_is_the_slope_of_the_energies(law: CompliantLaw) -> None:
    """The static force, in loading and in unloading, away from the breakpoints."""
    forces, energies, levels, _ = compiled_functions(type(law))
    for state in (law, law.after_compression(2e-4)):
        coefficients = law_coefficients(state)
        touch, release, memory, first, second = levels(coefficients)
        assert release <= touch <= first <= second
        if type(law).yields:
            assert touch <= memory
        corners = np.array([touch, memory, first, second])
        for delta in touch + np.geomspace(1e-6, 1e-3, 13):
            step = 1e-5 * (delta - touch)
            if np.any(np.abs(corners - delta) < 2.0 * step):
                continue
            slope = (
                sum(energies(delta + step, coefficients))
                - sum(energies(delta - step, coefficients))
            ) / (2.0 * step)
            largest = abs(forces(touch + 1e-3, 0.0, 1.0, coefficients)[0])
            assert slope == pytest.approx(
                forces(delta, 0.0, 1.0, coefficients)[0], rel=1e-6, abs=1e-6 * largest
            )


@dataclass(frozen=True, kw_only=True)
class Crushing(CompliantLaw):
    """A spring that unloads at twice the stiffness, given by methods alone, as another
    package may.
    """

    name = "crushing"
    equation = "F = k delta loading, 2 k (delta - delta_m/2) unloading"
    source = "this test"
    contact_end = "zero-force"
    tension = "none"

    stiffness: float = parameter("stiffness", "N/m", above=0)
    deepest: float = memory("deepest indentation so far", "m")

    @property
    def touch_level(self) -> float:
        return 0.5 * self.deepest

    @property
    def breakpoints(self) -> tuple[float, ...]:
        return (self.deepest,)

    def forces(self, delta: float, delta_dot: float, approach_speed: float) -> tuple[float, float]:
        unloading = 2.0 * self.stiffness * np.maximum(delta - self.touch_level, 0.0)
        return np.minimum(unloading, self.stiffness * delta), 0.0 * delta

    def elastic_energy(self, delta: float) -> float:
        return 0.25 * self.forces(delta, 0.0, 1.0)[0] ** 2 / self.stiffness

    def plastic_work(self, delta: float) -> float:
        return 0.25 * self.stiffness * np.maximum(delta**2 - self.deepest**2, 0.0)

    def after_compression(self, deepest: float) -> Crushing:
        return self.changed({"deepest": np.maximum(self.deepest, deepest)})


@pytest.mark.parametrize(
    "take",
    [compiled_functions, lambda law: [interpreted_function(law, kind) for kind in LAW_FUNCTIONS]],
)
@pytest.mark.filterwarnings("ignore::vibroimpact.errors.SlowLawWarning")
def test_a_law_of_methods_is_called(take: Callable[..., list[Callable[..., Any]]]) -> None:
    assert Crushing.missing_functions() == list(LAW_FUNCTIONS.values())
    assert Crushing.yields
    forces, energies, levels, compressed = take(Crushing)
    law = Crushing(stiffness=100.0)
    coefficients = law_coefficients(law)
    assert forces(0.1, 1.0, 1.0, coefficients) == pytest.approx((10.0, 0.0))
    assert energies(0.1, coefficients) == pytest.approx((0.25, 0.25))
    assert levels(coefficients) == (0.0, 0.0, 0.0, 0.0, np.inf)
    for _ in range(1000):  # more than are kept
        deepest = coefficients[1] + 1e-4
        changed = coefficients.copy()
        memory_level = compressed(deepest, coefficients, changed)
        assert memory_level == deepest
        coefficients = changed
    assert levels(coefficients) == pytest.approx((0.05, 0.05, 0.05, 0.1, np.inf))
    assert forces(0.08, 1.0, 1.0, coefficients)[0] == pytest.approx(6.0)
    assert energies(0.1, coefficients) == pytest.approx((0.25, 0.0))
    assert forces(0.1, 1.0, 1.0, law_coefficients(law)) == pytest.approx((10.0, 0.0))


@dataclass(frozen=True, kw_only=True)
class Halting(ImpulsiveFriction):
    """Coulomb's friction given by methods alone, as another package may."""

    name = "halting"
    equation = "Q = mu F"
    source = "this test"

    def slip_after(
        self, slip: np.ndarray, impulse: np.ndarray, whole: np.ndarray, mass: np.ndarray
    ) -> np.ndarray:
        taken = np.minimum(np.abs(slip), self.coefficient * impulse / mass)
        return slip - np.sign(slip) * taken

    def force(self, slip: np.ndarray, normal_force: np.ndarray) -> np.ndarray:
        return np.sign(slip) * self.coefficient * normal_force


@pytest.mark.parametrize("name", ["newton", "hertz"])
@pytest.mark.filterwarnings("ignore::vibroimpact.errors.SlowLawWarning")
def test_a_friction_law_of_methods_is_followed(name: str) -> None:
    """It gives what the same law gives that is compiled, in an impulse and in a contact."""
    assert Halting.missing_functions() == list(FRICTION_FUNCTIONS.values())
    assert not Coulomb.missing_functions()
    number = {"newton": {"restitution": 0.6}, "hertz": {"stiffness": 1e8}}[name]
    velocity = np.array([0.1, 3.0])
    found = [
        vi.tabulate(
            vi.Problem(
                sphere=vi.Body(mass=0.03, contact_offset=0.01),
                plate=vi.rigid_plate(),
                laws=(vi.laws.find_contact_law(name)(**number),),
                speed=1.0,
                impacts=2,
                oblique=vi.Oblique(
                    velocity=(velocity, 0.0),
                    gravity=(0.3, 0.2),
                    friction=law(coefficient=np.array([0.3, 0.2])),
                ),
            )
        ).impacts
        for law in (Halting, Coulomb)
    ]
    for column, values in found[0].items():
        np.testing.assert_array_equal(values, found[1][column], err_msg=column)


@pytest.mark.parametrize("law", [Coulomb, Rigid])
def test_friction_of_floats_is_that_of_arrays(law: type[ImpulsiveFriction]) -> None:
    random = np.random.default_rng(5)
    slip, impulse, whole, mass = random.uniform(0.0, 3.0, (4, DROPS))
    impulse[::3] = whole[::3]
    drops = law(coefficient=random.uniform(0.0, 1.0, DROPS))
    left, force = drops.slip_after(slip, impulse, whole, mass), drops.force(slip, whole)
    for kind in (interpreted_function, law_function):
        slip_after, friction = (kind(law, name) for name in FRICTION_FUNCTIONS)
        for drop in range(DROPS):
            coefficients = law_coefficients(drops.take(drop))
            numbers = (float(values[drop]) for values in (slip, impulse, whole, mass))
            assert slip_after(*numbers, coefficients) == left[drop]
            assert friction(float(slip[drop]), float(whole[drop]), coefficients) == force[drop]


def test_a_law_of_methods_may_be_collected() -> None:
    law = Crushing(stiffness=100.0)
    law_coefficients(law)
    kept = weakref.ref(law)
    del law
    gc.collect()
    assert kept() is None


def test_a_law_that_defines_forces_anew_is_not_compiled() -> None:
    @dataclass(frozen=True, kw_only=True)
    class Halved(Hertz):
        def forces(
            self, delta: np.ndarray, delta_dot: np.ndarray, approach_speed: np.ndarray
        ) -> tuple[np.ndarray, np.ndarray]:
            static, dissipative = super().forces(delta, delta_dot, approach_speed)
            return 0.5 * static, dissipative

    assert Halved.missing_functions() == ["scalar_forces"]
    assert not Hertz.missing_functions()
    assert Halved(stiffness=2.0).forces(4.0, 1.0, 1.0) == (8.0, 0.0)


def test_a_law_without_a_force_says_so() -> None:
    @dataclass(frozen=True, kw_only=True)
    class Forceless(CompliantLaw):
        name = "forceless"

    with pytest.raises(NotImplementedError, match="Forceless has neither"):
        Forceless().forces(1e-6, 1.0, 1.0)
