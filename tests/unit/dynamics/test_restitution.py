"""Achieved restitution and its inverse: shapes, messages, random round trips."""

from __future__ import annotations

import re

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

import vibroimpact as vi
from vibroimpact.contact.laws.adams_impact import AdamsImpact
from vibroimpact.contact.laws.flores import Flores
from vibroimpact.contact.laws.hertz import Hertz
from vibroimpact.contact.laws.jkr import JKR
from vibroimpact.contact.laws.kuwabara_kono import KuwabaraKono
from vibroimpact.contact.laws.lankarani_nikravesh import LankaraniNikravesh
from vibroimpact.contact.pair import ContactPair

TUNABLE = [law for law in vi.laws.contact_laws().values() if law.name != "hertz"]


def test_shapes_are_those_of_the_arguments_together() -> None:
    law = LankaraniNikravesh(stiffness=5e8, restitution=np.array([0.5, 0.7, 0.9]))
    assert np.shape(vi.laws.achieved_restitution(law, 0.09, 3.0)) == (3,)
    assert np.shape(vi.laws.achieved_restitution(law, np.full((2, 1), 0.09), 3.0)) == (2, 3)
    assert np.shape(vi.laws.integrated_restitution(law, np.full((2, 1), 0.09), 3.0)) == (2, 3)
    one = LankaraniNikravesh(stiffness=5e8, restitution=0.5)
    assert np.ndim(vi.laws.achieved_restitution(one, 0.09, 3.0)) == 0
    assert isinstance(vi.laws.law_achieving(one, 0.8, 0.09, 3.0).restitution, float)


def test_many_drops_are_integrated_in_pieces_with_the_same_result() -> None:
    speeds = np.geomspace(0.1, 10.0, 2500)
    law = AdamsImpact(stiffness=5e8, damping_max=np.linspace(50.0, 200.0, 2500))
    whole = vi.laws.achieved_restitution(law, 0.09, speeds)
    for index in (0, 1234, 2499):
        assert whole[index] == pytest.approx(
            vi.laws.achieved_restitution(law.take(index), 0.09, speeds[index]), rel=1e-9
        )


def test_what_can_not_be_achieved_is_named() -> None:
    law = LankaraniNikravesh(stiffness=5e8, restitution=0.7)
    with pytest.raises(
        vi.InputError,
        match=r"lankarani-nikravesh reaches restitutions from 0\.663 to 1 at 3 m/s, not 0\.5",
    ):
        vi.laws.law_achieving(law, 0.5, mass=0.09, speed=3.0)
    adhesive = vi.laws.find_contact_law("krijt")(
        effective_modulus=1e9, effective_radius=1e-3, work_of_adhesion=0.1, dissipation_time=1e-6
    )
    with pytest.raises(
        vi.InputError, match=r"krijt reaches restitutions up to 0\.9999\d+ at 3 m/s, not 1$"
    ):
        vi.laws.law_achieving(adhesive, 1.0, mass=0.09, speed=3.0)
    with pytest.raises(vi.InputError, match=r"not 0\.5"):
        vi.laws.law_achieving(law, np.array([0.9, 0.5]), mass=0.09, speed=3.0)
    with pytest.raises(
        vi.InputError, match=r"hertz has no loss parameter; it achieves 1, not 0\.5"
    ):
        vi.laws.law_achieving(Hertz(stiffness=5e8), 0.5, mass=0.09, speed=3.0)
    assert vi.laws.law_achieving(Hertz(stiffness=5e8), 1.0, mass=0.09, speed=3.0) == Hertz(
        stiffness=5e8
    )


def test_a_few_drops_have_the_restitution_of_many() -> None:
    """They are collocated in plain Python, and followed by compiled code where that does
    not come out, as under much damping.
    """
    speeds = np.array([1e-4, 0.01, 0.5, 3.0])
    laws: tuple[vi.laws.ContactLaw, ...] = (
        AdamsImpact(stiffness=5e8, damping_max=170.0, full_damping_penetration=1e-4),
        AdamsImpact(stiffness=5e8, damping_max=1e5, full_damping_penetration=1e-6),
        Flores(stiffness=5e8, restitution=0.7),
        LankaraniNikravesh(stiffness=5e8, restitution=0.01),
    )
    for law in laws:
        few = vi.laws.integrated_restitution(law, 0.09, speeds)
        many = vi.laws.integrated_restitution(law, 0.09, np.tile(speeds, 3))
        np.testing.assert_allclose(np.tile(few, 3), many, rtol=1e-12)


@pytest.mark.parametrize("wanted", [-0.1, 1.1, np.nan])
def test_impossible_restitution(wanted: float) -> None:
    with pytest.raises(vi.InputError, match="restitution"):
        vi.laws.law_achieving(Flores(stiffness=5e8, restitution=0.7), wanted, mass=0.09, speed=3.0)


@pytest.mark.parametrize(
    ("mass", "speed", "key"),
    [(0.0, 1.0, "mass"), (1.0, -1.0, "speed"), (np.inf, 1.0, "mass"), (1.0, np.nan, "speed")],
)
def test_impossible_mass_or_speed(mass: float, speed: float, key: str) -> None:
    law = Flores(stiffness=5e8, restitution=0.7)
    for call in (vi.laws.achieved_restitution, vi.laws.integrated_restitution):
        with pytest.raises(vi.InputError, match=key):
            call(law, mass, speed)
    with pytest.raises(vi.InputError, match="agree in shape"):
        vi.laws.achieved_restitution(law, np.ones(2), np.ones(3))


def test_the_ends_of_the_range() -> None:
    assert (
        vi.laws.law_achieving(
            LankaraniNikravesh(stiffness=5e8, restitution=0.7), 1.0, 0.09, 3.0
        ).restitution
        == 1.0
    )
    assert (
        vi.laws.law_achieving(
            AdamsImpact(stiffness=5e8, damping_max=100.0), 1.0, 0.09, 3.0
        ).damping_max
        == 0.0
    )
    stuck = vi.laws.law_achieving(
        JKR(effective_modulus=3e8, effective_radius=2e-4, work_of_adhesion=0.3), 0.0, 5e-8, 0.1
    )
    assert vi.laws.achieved_restitution(stuck, 5e-8, 0.1) == 0.0


def test_a_parameter_for_each_speed() -> None:
    speeds = np.array([2.0, 4.0, 8.0])
    law = vi.laws.law_achieving(
        KuwabaraKono(stiffness=5e8, dissipation_time=1e-6), 0.7, mass=0.09, speed=speeds
    )
    assert law.dissipation_time.shape == (3,)
    np.testing.assert_allclose(vi.laws.integrated_restitution(law, 0.09, speeds), 0.7, atol=1e-10)


@pytest.mark.parametrize("tolerance", [1e-1, 1e-14, np.nan])
def test_tolerances_out_of_range_are_refused(tolerance: float) -> None:
    with pytest.raises(vi.InputError, match="tolerance must lie between 1e-13 and 1e-6"):
        vi.laws.integrated_restitution(
            AdamsImpact(stiffness=1e6, damping_max=0.1), 1e-3, 1.0, tolerance=tolerance
        )


def test_a_pull_between_two_nodes_is_cut() -> None:
    law = AdamsImpact(stiffness=1129e3, damping_max=np.linspace(0.15, 0.19, 2000))
    exact = vi.laws.integrated_restitution(law, 5.57e-4, 5.06, tolerance=1e-13)
    assert np.abs(vi.laws.integrated_restitution(law, 5.57e-4, 5.06) - exact).max() < 1e-9


wishes = given(
    st.sampled_from(TUNABLE),
    st.floats(0.4, 0.98),
    st.floats(-5.0, 1.0),
    st.floats(-1.5, 1.5),
    st.floats(7.0, 11.0),
)


@settings(max_examples=15, deadline=None)
@example(
    AdamsImpact, 0.9340729747981871, -3.2543028886997925, 0.7045442911229172, 7.095838841638937
)
@example(vi.laws.find_contact_law("krijt"), 0.5, -5.0, -1.5, 7.0)
@wishes
def test_round_trip(
    law: type[vi.laws.ContactLaw], wanted: float, mass: float, speed: float, modulus: float
) -> None:
    check_round_trip(law, wanted, mass, speed, modulus)


@pytest.mark.slow
@settings(max_examples=200, deadline=None)
@wishes
def test_many_round_trips(
    law: type[vi.laws.ContactLaw], wanted: float, mass: float, speed: float, modulus: float
) -> None:
    check_round_trip(law, wanted, mass, speed, modulus)


def check_round_trip(
    law: type[vi.laws.ContactLaw], wanted: float, mass: float, speed: float, modulus: float
) -> None:
    radius = (10**mass / 6000.0) ** (1 / 3)
    pair = ContactPair(
        10**modulus, radius, 10**mass, yield_strength=2e-3 * 10**modulus, poissons_ratio=0.3
    )
    try:
        tuned = vi.laws.law_achieving(law.example(pair), wanted, 10**mass, 10**speed)
    except vi.InputError as error:
        # some can't go so low, and one that sticks can't come so high
        assert re.search(r"reaches restitutions (from|up to) ", str(error))  # noqa: PT017
        return
    assert vi.laws.integrated_restitution(tuned, 10**mass, 10**speed) == pytest.approx(
        wanted, abs=1e-8
    )


@pytest.mark.parametrize(
    ("law", "key", "words"),
    [
        ("hertz", "stiffness", "two rigid materials have no contact stiffness of their own"),
        ("tsuji", "effective_mass", "that of the pair is infinite"),
    ],
)
def test_what_a_pair_can_not_give_is_asked_for_with_its_cause(
    law: str, key: str, words: str
) -> None:
    pair = ContactPair(
        np.inf if key == "stiffness" else 1e9, 0.01, 0.01 if key == "stiffness" else np.inf
    )
    given = {"restitution": 0.5} if law == "tsuji" else {}
    with pytest.raises(vi.InputError, match=rf"^{key}: it must be given, since {words}$"):
        vi.laws.find_contact_law(law).for_pair(pair, **given)
