"""Rigid drops that the core follows from start to end: the same compiled and interpreted, however
often it pauses, and in every company.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

import vibroimpact as vi
from vibroimpact.compiled import interpreted, law_addresses, law_coefficients
from vibroimpact.contact.law import CompliantLaw
from vibroimpact.contact.laws.jkr import JKR
from vibroimpact.contact.laws.thornton import Thornton
from vibroimpact.contact.pair import ContactPair
from vibroimpact.contact.registry import contact_laws
from vibroimpact.contact.speed_function import SpeedTable
from vibroimpact.contact.static import static_indentation
from vibroimpact.dynamics.core import drop_records as records
from vibroimpact.dynamics.core import static
from vibroimpact.dynamics.motion.columns import IMPACT_COLUMNS, OBLIQUE_IMPACT_COLUMNS

PAIR = ContactPair(2.4e9, 0.02, 0.1, 8e7, 0.3)
BALL = vi.Body(mass=0.1, contact_offset=0.02)
SLUGGISH = vi.laws.find_contact_law("flores")(stiffness=1e7, restitution=0.05)
NEWTON = vi.laws.find_contact_law("newton")(restitution=0.6)
LAWS = sorted(name for name, law in contact_laws().items() if issubclass(law, CompliantLaw))


def problem(**changes: object) -> vi.Problem:
    law = vi.laws.find_contact_law("flores").example(PAIR).changed({"restitution": 0.6})
    stated = {"sphere": BALL, "plate": vi.rigid_plate(), "laws": (law,), "height": 1.0}
    return vi.Problem(**{**stated, **changes})


def assert_same(one: vi.Response, other: vi.Response) -> None:
    assert one.outcomes == other.outcomes
    np.testing.assert_array_equal(one.end_time, other.end_time)
    for told, expected in ((one.impacts, other.impacts), (one.energy, other.energy)):
        assert told.keys() == expected.keys()
        for name, values in expected.items():
            np.testing.assert_array_equal(told[name], values, err_msg=name)


def test_columns_and_endings_are_those_of_the_rest() -> None:
    names = list(IMPACT_COLUMNS)
    assert names[records.TOUCH] == "time_s"
    assert names[records.REBOUND] == "rebound_height_m"
    assert names[records.TIME_OF_FORCE] == names[-1] == "time_of_max_force_s"
    assert len(names) == records.COMPRESSION
    along = list(OBLIQUE_IMPACT_COLUMNS)
    assert records.COLUMNS == records.ALONG == records.DENT_BEFORE + 1
    assert along[0] == "position_x_m"
    last = records.GROSS_SLIP_LOST - records.ALONG
    assert along[last - 4 :] == [
        "tangential_restitution",
        "rebound_angle_deg",
        "friction_lost_J",
        "microslip_lost_J",
        "gross_slip_lost_J",
    ]
    endings = {name: code for name, code in vars(records).items() if name.startswith("END_")}
    endings.pop("END_TIME")
    for name, code in endings.items():
        assert vi.Outcome[name.removeprefix("END_").removeprefix("BY_")].code == code
    # files store the codes, which thus stay
    assert [outcome.name for outcome in vi.Outcome] == [
        "IMPACTS",
        "DURATION",
        "REST_SPEED",
        "CAPTURED",
        "STUCK",
        "LEFT",
        "LIMIT",
        "FAILED",
        "RIDING",
        "FELL",
    ]


@pytest.mark.parametrize("name", LAWS)
def test_interpreted_drops_have_the_same_numbers(name: str) -> None:
    law = vi.laws.find_contact_law(name).example(PAIR)
    for changes in ({"impacts": 2}, {"height": 0.05, "impacts": None, "rest_speed": 0.6}):
        stated = problem(laws=(law,), duration=1.0, **changes)
        compiled = vi.simulate(stated)
        with interpreted():
            plain = vi.simulate(stated)
        assert plain.outcomes == compiled.outcomes
        for column, values in compiled.impacts.items():
            allowed = 1e-12 * np.abs(values)
            if column.endswith("_J"):
                allowed = 1e-12 * compiled.energy["input_J"]
            if column == "time_of_max_force_s":  # the force is flat there
                allowed = 1e-8 * compiled.impacts["duration_s"]
            within = np.abs(plain.impacts[column] - values) <= allowed
            np.testing.assert_array_equal(within, ~np.isnan(values), err_msg=column)


def rubbed(friction: str, **changes: object) -> vi.Oblique:
    moduli = {}
    if friction != "coulomb":
        moduli = {
            "effective_modulus": 1e8,
            "effective_shear_modulus": 0.8e8,
            "effective_radius": 0.02,
        }
    law = vi.friction.find_friction_law(friction)(coefficient=0.3, **moduli, **changes)
    return vi.Oblique(velocity=(1.0, 0.4), spin=(10.0, -30.0, 50.0), friction=law, size=(1.0, 0.8))


@pytest.mark.parametrize(
    ("friction", "rolling"), [("coulomb", 0.05), ("mindlin", 0.0), ("mdr", 0.0), ("mindlin", 0.05)]
)
@pytest.mark.parametrize("name", ["flores", "thornton", "jkr"])
def test_interpreted_oblique_drops_have_the_same_numbers(
    name: str, friction: str, rolling: float
) -> None:
    law = vi.laws.find_contact_law(name).example(PAIR)
    oblique = rubbed(friction, rolling_coefficient=rolling)
    stated = problem(laws=(law,), impacts=2, oblique=oblique)
    compiled = vi.simulate(stated)
    with interpreted():
        plain = vi.simulate(stated)
    assert plain.outcomes == compiled.outcomes
    speed = compiled.impacts["approach_speed_m_s"][0]
    for column in OBLIQUE_IMPACT_COLUMNS:
        scale = speed
        if column.endswith("rad_s"):
            scale = speed / 0.02
        if column.endswith("_deg"):
            scale = 90.0
        if column.endswith("_J"):
            scale = compiled.energy["input_J"]
        np.testing.assert_allclose(
            plain.impacts[column], compiled.impacts[column], rtol=0, atol=1e-11 * scale
        )


@pytest.mark.parametrize(
    ("name", "friction"),
    [
        ("newton", "coulomb"),
        ("thornton", "coulomb"),
        ("thornton", "mdr"),
        ("jkr", "coulomb"),
        ("jkr", "mdr"),
    ],
)
def test_oblique_flights_and_contacts_join_up(name: str, friction: str) -> None:
    """A contact, which is computed again where it is read, ends where the next flight begins."""
    law = vi.laws.find_contact_law(name).example(PAIR)
    stated = problem(laws=(law,), height=0.3, impacts=None, duration=5.0, oblique=rubbed(friction))
    response = vi.simulate(stated)
    assert response.outcomes == (vi.Outcome.FELL,)
    bounces = response.bounces
    assert bounces is not None
    for bounce, following in pairwise(bounces):
        state, _, taken = bounce.along.at(bounce.along.duration)
        sphere, begun = following.oblique
        for name_of, values in vars(begun).items():
            np.testing.assert_allclose(getattr(state, name_of), values, rtol=1e-9, atol=1e-12)
        assert sphere.mass[0] == 0.1
    lost = response.impacts["friction_lost_J"][: len(bounces) - 1]
    assert taken[0] == pytest.approx(lost[-1], abs=1e-12)
    edge = response.at(response.end_time)
    beyond = (edge["position_x_m"][0] / 0.5, edge["position_y_m"][0] / 0.4)
    assert max(beyond) > 1.0


@pytest.mark.parametrize("name", ["newton", "jackson-green-marghitu"])
def test_drops_without_a_force_are_the_same_alone_and_in_a_batch(name: str) -> None:
    """Those of a large batch are compiled, a single one is not: to the last digit."""
    law = vi.laws.find_contact_law(name).example(PAIR)
    stated = problem(laws=(law,), height=np.geomspace(0.021, 2.0, 60), impacts=4)
    for changes in ({}, {"impacts": None, "rest_speed": 0.3, "duration": 1.5}):
        together = vi.tabulate(replace(stated, **changes))
        for drop in range(0, 60, 7):
            alone = vi.tabulate(replace(stated, **changes).take(drop))
            assert alone.outcomes[0] is together.outcomes[drop]
            for column, values in alone.impacts.items():
                rows = together.impacts[column][drop, : len(values)]
                np.testing.assert_array_equal(rows, values, err_msg=column)
            for entry, value in alone.energy.items():
                assert together.energy[entry][drop] == value, entry


@pytest.mark.parametrize("shape", [(), (5,)])
def test_pauses_change_no_digit(shape: tuple[int, ...]) -> None:
    """With `progress` the core pauses after each impact, without it only for room."""
    height = 1.0 if shape == () else np.geomspace(0.03, 2.0, 5)
    told: list[float] = []
    ways = ({"impacts": 40}, {"impacts": None, "rest_speed": 1e-3})
    for changes in (*ways, {"impacts": 20, "oblique": rubbed("mdr")}):
        law = vi.laws.find_contact_law("hunt-crossley").example(PAIR).changed({"restitution": 0.9})
        stated = problem(laws=(law,), height=height, **changes)
        assert_same(vi.simulate(stated), vi.simulate(stated, told.append))
    assert len(told) > 80


def test_laws_at_the_speed_of_each_impact_are_those_of_the_drop_alone() -> None:
    law = vi.laws.find_contact_law("walton-braun").example(PAIR)
    by_speed = {"restitution": SpeedTable((0.5, 5.0), (0.9, 0.6))}
    stated = problem(
        laws=(law,), by_speed=by_speed, height=np.geomspace(0.05, 2.0, 6), impacts=4, gravity=9.8
    )
    together = vi.tabulate(stated)
    np.testing.assert_array_equal(
        together.impacts["restitution_asked"],
        by_speed["restitution"](together.impacts["approach_speed_m_s"]),
    )
    for drop in range(6):
        alone = vi.simulate(stated.take(drop))
        for name, values in alone.impacts.items():
            np.testing.assert_array_equal(together.impacts[name][drop], values, err_msg=name)


@pytest.mark.parametrize(
    ("changes", "outcome", "flights"),
    [
        ({"impacts": 3}, vi.Outcome.IMPACTS, 4),
        ({"impacts": None, "duration": 0.5}, vi.Outcome.DURATION, 2),
        ({"impacts": None, "rest_speed": 1.5}, vi.Outcome.REST_SPEED, 2),
        ({"height": None, "speed": 1.0, "gravity": 0.0}, vi.Outcome.LEFT, 2),
        ({"laws": (NEWTON,), "impacts": 3}, vi.Outcome.IMPACTS, 4),
        ({"laws": (NEWTON,), "impacts": None, "rest_speed": 1.5}, vi.Outcome.REST_SPEED, 3),
        ({"laws": (SLUGGISH,), "height": 0.02 + 1e-6}, vi.Outcome.CAPTURED, 1),
        ({"laws": (JKR.example(PAIR),), "height": 0.02 + 1e-9}, vi.Outcome.STUCK, 1),
    ],
)
def test_flights_and_contacts_join_up(
    changes: dict[str, object], outcome: vi.Outcome, flights: int
) -> None:
    response = vi.simulate(problem(**changes))
    assert response.outcomes == (outcome,)
    bounces = response.bounces
    assert bounces is not None
    assert len(bounces) == len(bounces[:]) == flights
    for number, (bounce, following) in enumerate(pairwise(bounces)):
        length = response.impacts["duration_s"][number]
        np.testing.assert_array_equal(following.flight.start, bounce.flight_end + length)
        if bounce.contact is None:
            continue
        last = bounce.contact.pieces[-1]
        assert last.start + last.motion.duration[0] == pytest.approx(length, rel=1e-14)
        delta, rate, _ = last.motion.at(last.motion.duration)
        scale = response.impacts["max_indentation_m"][number]
        np.testing.assert_allclose(-following.flight.gap, delta, atol=1e-9 * scale)
        np.testing.assert_allclose(-following.flight.velocity, rate, rtol=1e-9)
    assert response.at([0.0])["position_m"][0] == pytest.approx(
        0.02 if "speed" in changes else changes.get("height", 1.0)
    )


def test_a_dent_is_remembered_from_impact_to_impact() -> None:
    stated = problem(laws=(Thornton.example(PAIR),), impacts=4)
    bounces = vi.simulate(stated).bounces
    depth = vi.simulate(stated).impacts["max_indentation_m"]
    for number, bounce in enumerate(bounces[:-1]):
        before = depth[:number].max(initial=0.0)
        assert bounce.contact.pieces[0].law.loaded_to == before
        assert bounce.contact.law.loaded_to == max(before, depth[number])
    fresh = vi.simulate(replace(stated, same_spot=False)).bounces
    assert all(bounce.contact.pieces[0].law.loaded_to == 0.0 for bounce in fresh[:-1])


@pytest.mark.parametrize("name", LAWS)
def test_the_static_indentation_is_that_of_arrays(name: str) -> None:
    law = vi.laws.find_contact_law(name).example(PAIR)
    for weight in (0.0, 1e-3, 1.0, 30.0):
        expected = float(static_indentation(law, weight))
        found = static.static_indentation(
            law_addresses(type(law)), law_coefficients(law), float(law.release_level), weight
        )
        assert found == pytest.approx(expected, rel=1e-12, abs=1e-22), weight
