"""What every contact law keeps, whatever it is: a new file in contact/laws is covered without a new test."""

from __future__ import annotations

import dataclasses
import inspect

import numpy as np
import pytest

import vibroimpact as vi
from support import plain_case
from vibroimpact.cases.build import resolved
from vibroimpact.contact.law import CompliantLaw, ContactLaw, contact_laws
from vibroimpact.contact.static import static_indentation
from vibroimpact.dynamics.columns import LEDGER

LAWS = list(contact_laws().values())
COMPLIANT = [law for law in LAWS if issubclass(law, CompliantLaw)]
# what a case must give for laws whose parameters have no default
GIVEN = {"restitution": 0.7, "damping_max": 150.0, "stiffness": 2e6}


def parameters(law: type[ContactLaw]) -> dict[str, float]:
    needed = {item.name for item in dataclasses.fields(law) if item.default is dataclasses.MISSING and not item.metadata["from_pair"]}
    if law.name == "linear-spring-dashpot":
        needed |= {"restitution"}  # it has a choice of two
    missing = needed - GIVEN.keys()
    assert not missing, f"say in GIVEN what a test may give {law.name} for {missing}"
    return {key: GIVEN[key] for key in needed}


def case_of(law: type[ContactLaw], **more: object) -> vi.Case:
    return vi.read_case(plain_case(contact={"law": law.name, **parameters(law)}, **more))


def made(law: type[ContactLaw]) -> ContactLaw:
    return case_of(law).to_problem().laws[0]


@pytest.mark.parametrize("law", COMPLIANT, ids=lambda law: law.name)
def test_no_force_without_indentation(law: type[CompliantLaw]) -> None:
    elastic, dissipative = made(law).forces(np.zeros(3), np.zeros(3), np.ones(3))
    assert not elastic.any()
    assert not dissipative.any()
    assert not np.asarray(made(law).elastic_energy(np.zeros(3))).any()


@pytest.mark.parametrize("law", COMPLIANT, ids=lambda law: law.name)
def test_elastic_force_is_the_slope_of_the_elastic_energy(law: type[CompliantLaw]) -> None:
    delta, step = np.geomspace(1e-6, 1e-3, 7), 1e-4
    energy = made(law).elastic_energy
    slope = (energy(delta * (1 + step)) - energy(delta * (1 - step))) / (2 * step * delta)
    elastic, _ = made(law).forces(delta, np.ones(7), np.ones(7))
    np.testing.assert_allclose(elastic, slope, rtol=1e-6)


@pytest.mark.parametrize("law", COMPLIANT, ids=lambda law: law.name)
def test_damping_takes_and_never_gives(law: type[CompliantLaw]) -> None:
    delta, rate = np.meshgrid(np.geomspace(1e-7, 1e-3, 9), np.linspace(-3.0, 3.0, 9))
    _, dissipative = made(law).forces(delta, rate, np.full(delta.shape, 3.0))
    assert np.all(dissipative * rate >= 0.0)


@pytest.mark.parametrize("law", COMPLIANT, ids=lambda law: law.name)
def test_array_equals_scalar(law: type[CompliantLaw]) -> None:
    delta, rate, speed = np.geomspace(1e-6, 1e-3, 5), np.linspace(-2.0, 2.0, 5), np.linspace(1.0, 3.0, 5)
    together = made(law).forces(delta, rate, speed)
    for index in range(5):
        alone = made(law).forces(float(delta[index]), float(rate[index]), float(speed[index]))
        np.testing.assert_allclose([part[index] for part in together], alone, rtol=1e-14)


@pytest.mark.parametrize("law", COMPLIANT, ids=lambda law: law.name)
def test_static_indentation_carries_the_weight(law: type[CompliantLaw]) -> None:
    weight = np.array([0.1, 1.0, 1000.0])
    delta = static_indentation(made(law), weight)
    np.testing.assert_allclose(made(law).forces(delta, np.zeros(3), np.ones(3))[0], weight, rtol=1e-12)


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
    again = vi.read_case(resolved(case))
    assert resolved(again) == resolved(case)
    assert again.to_problem().laws == case.to_problem().laws


@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.name)
def test_a_list_is_one_value_an_impact(law: type[ContactLaw]) -> None:
    key, value = next(iter((parameters(law) or {"stiffness": 2e6}).items()))
    case = vi.read_case(plain_case(contact={"law": law.name, **parameters(law), key: [value, 0.9 * value]}))
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
