"""What follows from a case is computed once, and anew for a case that is changed."""

from __future__ import annotations

import pickle

import pytest

import vibroimpact as vi
from vibroimpact.cases.elastic.elastic_bodies import elastic_bodies
from vibroimpact.cases.rigid.pair import contact_pair
from vibroimpact.cases.rigid.rigid_problem import contact_laws_of
from vibroimpact.contact.law import ContactLaw


def test_a_run_makes_the_laws_of_a_case_once(monkeypatch: pytest.MonkeyPatch) -> None:
    made: list[str] = []
    checked = ContactLaw.__post_init__
    monkeypatch.setattr(
        ContactLaw, "__post_init__", lambda law: made.append(law.name) or checked(law)
    )
    case = vi.load_case("paper:type1-variable")
    case.to_problem()
    assert made == 5 * ["adams-impact"]


def test_elastic_bodies_are_made_once() -> None:
    case = vi.load_case("paper:type2-superposed")
    assert elastic_bodies(case) is elastic_bodies(case)


def test_a_changed_copy_has_its_own() -> None:
    case = vi.load_case("paper:type1-theory")
    laws, pair = contact_laws_of(case), contact_pair(case)
    larger = case.model_copy(update={"sphere": case.sphere.model_copy(update={"radius": 0.05})})
    assert contact_pair(larger).effective_radius == 2.0 * pair.effective_radius
    assert contact_laws_of(larger)[0].stiffness == pytest.approx(
        2.0**0.5 * laws[0].stiffness, rel=1e-12
    )
    assert contact_laws_of(case) is laws


def test_they_are_no_part_of_the_case() -> None:
    case, fresh = vi.load_case("paper:type1-theory"), vi.load_case("paper:type1-theory")
    contact_laws_of(case)
    assert case == fresh
    assert case.model_dump() == fresh.model_dump()
    assert pickle.loads(pickle.dumps(case)) == fresh
