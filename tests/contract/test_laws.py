"""What every contact law keeps, whatever it is: a new file in contact/laws is covered
without a new test.
"""

from __future__ import annotations

import dataclasses
import inspect

import numpy as np
import pytest

import vibroimpact as vi
from support import plain_case
from vibroimpact.cases.build import resolved_case
from vibroimpact.contact.law import CompliantLaw, ContactLaw
from vibroimpact.contact.registry import contact_laws
from vibroimpact.contact.static import static_indentation
from vibroimpact.dynamics.motion.columns import LEDGER
from vibroimpact.dynamics.restitution import integrated_restitution

LAWS = list(contact_laws().values())
COMPLIANT = [law for law in LAWS if issubclass(law, CompliantLaw)]
MASSES, SPEEDS = np.array([[0.01], [0.09], [2.0]]), np.array([0.03, 0.4, 3.0, 20.0])


def parameters(law: type[ContactLaw]) -> dict[str, float]:
    examples = {item.name: item.metadata["example"] for item in dataclasses.fields(law)}
    for item in dataclasses.fields(law):
        known = (
            item.default is not dataclasses.MISSING
            or item.metadata["from_pair"]
            or examples[item.name] is not None
        )
        assert known, f"{law.name}: {item.name} needs an example"
    return {key: value for key, value in examples.items() if value is not None}


def case_of(law: type[ContactLaw], **more: object) -> vi.Case:
    return vi.case_of(plain_case(contact={"law": law.name, **parameters(law)}, **more))


def made(law: type[ContactLaw]) -> ContactLaw:
    return case_of(law).to_problem().laws[0]


@pytest.mark.parametrize("law", COMPLIANT, ids=lambda law: law.name)
def test_no_force_without_indentation(law: type[CompliantLaw]) -> None:
    static, dissipative = made(law).forces(np.zeros(3), np.zeros(3), np.ones(3))
    assert not dissipative.any()
    assert abs(float(np.max(made(law).elastic_energy(np.zeros(1))))) <= 1e-15 * float(
        np.max(made(law).elastic_energy(np.full(1, 1e-4)))
    )
    if law.contact_end == "pull-off":  # the named exception: it snaps together
        assert np.all(static < 0.0)
    else:
        assert not static.any()


@pytest.mark.parametrize("law", COMPLIANT, ids=lambda law: law.name)
def test_no_force_where_the_surfaces_part(law: type[CompliantLaw]) -> None:
    dented = made(law).after_compression(np.array([1e-4]))
    for level in (dented.touch_level, dented.release_level):
        static, _ = dented.forces(level + np.zeros(1), np.zeros(1), np.ones(1))
        assert np.all(
            static <= 1e-9 * np.abs(dented.forces(np.array([1e-4]), np.zeros(1), np.ones(1))[0])
        )
    assert np.all(dented.release_level <= dented.touch_level)
    assert np.all(dented.touch_level < 1e-4)


@pytest.mark.parametrize("law", COMPLIANT, ids=lambda law: law.name)
@pytest.mark.parametrize("dent", [0.0, 2e-4])
def test_static_force_is_the_slope_of_elastic_energy_and_plastic_work(
    law: type[CompliantLaw], dent: float
) -> None:
    one = made(law).after_compression(np.full(7, dent))
    delta, step = one.touch_level + np.geomspace(1e-6, 1e-3, 7), 1e-5

    def work(at: np.ndarray) -> np.ndarray:
        return one.elastic_energy(at) + one.plastic_work(at)

    span = step * (delta - one.touch_level)
    slope = (work(delta + span) - work(delta - span)) / (2 * span)
    static, _ = one.forces(delta, np.ones(7), np.ones(7))
    np.testing.assert_allclose(static, slope, rtol=2e-6, atol=1e-6 * np.abs(static).max())


@pytest.mark.parametrize("law", COMPLIANT, ids=lambda law: law.name)
def test_damping_takes_and_never_gives(law: type[CompliantLaw]) -> None:
    delta, rate = np.meshgrid(np.geomspace(1e-7, 1e-3, 9), np.linspace(0.0, 3.0, 9))
    for one, sign in ((made(law), 1.0), (made(law).after_compression(np.full(9, 1e-3)), -1.0)):
        _, dissipative = one.forces(delta, sign * rate, np.full(delta.shape, 3.0))
        assert np.all(dissipative * sign * rate >= 0.0)


@pytest.mark.parametrize("law", COMPLIANT, ids=lambda law: law.name)
def test_memory_only_grows_and_takes(law: type[CompliantLaw]) -> None:
    one = made(law)
    if not one.memories():
        assert one.after_compression(np.array([1e-4])) is one
        return
    deepest = np.array([0.0, 5e-5, 1e-4, 2e-4])
    dented = one.after_compression(deepest)
    again = dented.after_compression(0.5 * deepest)
    np.testing.assert_array_equal(again.elastic_energy(deepest), dented.elastic_energy(deepest))
    np.testing.assert_array_equal(
        dented.take(np.array([0])).forces(deepest, 0.0, 1.0)[0], one.forces(deepest, 0.0, 1.0)[0]
    )
    assert np.all(np.diff(dented.touch_level + np.zeros(4)) >= 0.0)
    assert not np.asarray(dented.plastic_work(deepest)).any()
    np.testing.assert_allclose(
        dented.elastic_energy(deepest), one.elastic_energy(deepest), rtol=1e-12
    )
    assert np.all(one.plastic_work(deepest) >= 0.0)


@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.name)
def test_closed_form_agrees_with_integration(law: type[ContactLaw]) -> None:
    one = made(law)
    closed, integrated = (
        one.closed_form_restitution(MASSES, SPEEDS),
        integrated_restitution(one, MASSES, SPEEDS),
    )
    assert integrated.shape == (3, 4)
    assert np.all((integrated >= 0.0) & (integrated <= 1.0 + 1e-9))
    # the named exception: it may stick
    assert np.all((integrated > 0.0) | (getattr(law, "contact_end", "") == "pull-off"))
    if closed is not None:
        np.testing.assert_allclose(closed, integrated, rtol=0, atol=1e-8)


@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.name)
def test_restitution_of_many_is_that_of_each(law: type[ContactLaw]) -> None:
    one, speeds = made(law), np.array([20.0, 0.4, 3.0, 0.03, 6.0])
    alone = [integrated_restitution(one, 0.09, speed) for speed in speeds]
    np.testing.assert_allclose(integrated_restitution(one, 0.09, speeds), alone, rtol=0, atol=2e-9)


@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.name)
def test_achieving_is_the_inverse(law: type[ContactLaw]) -> None:
    one = made(law)
    if one.free_parameter is None:
        with pytest.raises(vi.InputError, match="no loss parameter"):
            vi.laws.law_achieving(one, 0.5, mass=0.09, speed=3.0)
        return
    found = vi.laws.law_achieving(one, np.array([0.75, 0.9]), mass=0.09, speed=3.0)
    np.testing.assert_allclose(
        integrated_restitution(found, 0.09, 3.0), [0.75, 0.9], rtol=0, atol=1e-9
    )


@pytest.mark.parametrize("law", COMPLIANT, ids=lambda law: law.name)
def test_array_equals_scalar(law: type[CompliantLaw]) -> None:
    delta, rate, speed = (
        np.geomspace(1e-6, 1e-3, 5),
        np.linspace(-2.0, 2.0, 5),
        np.linspace(1.0, 3.0, 5),
    )
    for one in (made(law), made(law).after_compression(3e-4)):
        together = one.forces(delta, rate, speed)
        for index in range(5):
            alone = one.forces(float(delta[index]), float(rate[index]), float(speed[index]))
            np.testing.assert_allclose([part[index] for part in together], alone, rtol=1e-14)


@pytest.mark.parametrize("law", COMPLIANT, ids=lambda law: law.name)
def test_static_indentation_carries_the_weight(law: type[CompliantLaw]) -> None:
    weight = np.array([0.1, 1.0, 1000.0])
    delta = static_indentation(made(law), weight)
    np.testing.assert_allclose(
        made(law).forces(delta, np.zeros(3), np.ones(3))[0], weight, rtol=1e-12
    )


@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.name)
def test_restitution_and_ledger(law: type[ContactLaw]) -> None:
    response = vi.simulate(case_of(law))
    achieved = response.impacts["restitution_achieved"]
    assert len(achieved) == 3
    assert np.all((achieved > 0.0) & (achieved <= 1.0 + 1e-9))
    assert np.all(response.impacts["energy_lost_J"] >= -1e-12)
    assert response.energy["closure_relative"] <= 1e-9
    history = response.history()
    total = sum(history[name] for name in LEDGER)
    np.testing.assert_allclose(total, total[0], rtol=1e-6)


@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.name)
def test_round_trip_through_a_case(law: type[ContactLaw]) -> None:
    case = case_of(law)
    again = vi.case_of(resolved_case(case))
    assert resolved_case(again) == resolved_case(case)
    assert again.to_problem().laws == case.to_problem().laws


@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.name)
def test_a_list_is_one_value_an_impact(law: type[ContactLaw]) -> None:
    key, value = next(iter((parameters(law) or {"stiffness": 2e6}).items()))
    case = vi.case_of(
        plain_case(contact={"law": law.name, **parameters(law), key: [value, 0.9 * value]})
    )
    laws = case.to_problem().laws
    assert [getattr(one, key) for one in laws] == [value, 0.9 * value]
    assert len(vi.simulate(case).impacts["impact"]) == 3


@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.name)
def test_documentation_is_complete(law: type[ContactLaw]) -> None:
    text = inspect.getdoc(law) or ""
    for section in ("Parameters", "Notes", "References", "Examples"):
        assert f"\n{section}\n---" in text, f"{law.name}: no section {section}"
    for item in dataclasses.fields(law):
        assert f"\n{item.name} : " in text, f"{law.name}: {item.name} is not documented"
        assert item.metadata["meaning"]
    assert "\n    Parameters\n" not in inspect.getsource(law), (
        f"{law.name}: the section is made from the declarations"
    )
    assert law.equation
    assert law.source
    assert law.name == inspect.getmodule(law).__name__.rpartition(".")[2].replace("_", "-")


@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.name)
def test_impossible_parameters_are_refused(law: type[ContactLaw]) -> None:
    good = {item.name: getattr(made(law), item.name) for item in dataclasses.fields(law)}
    for item in dataclasses.fields(law):
        if good[item.name] is None:
            continue
        for wrong in (np.nan, np.inf, -1.0):
            with pytest.raises(vi.InputError, match=item.name):
                law(**{**good, item.name: wrong})


def test_two_laws_of_one_name_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    from vibroimpact.contact.laws import hertz, newton

    monkeypatch.setattr(newton.Newton, "name", hertz.Hertz.name)
    with pytest.raises(vi.InputError, match='two contact laws are called "hertz"'):
        contact_laws.__wrapped__()
