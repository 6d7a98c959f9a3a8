"""The table of a batch: the numbers of `simulate`, for every law and every way a drop ends."""

from __future__ import annotations

from dataclasses import fields, replace

import numpy as np
import pytest

import vibroimpact as vi
from vibrating import STIFFNESS, drop_on, modes_of
from vibroimpact.contact.law import CompliantLaw, ContactLaw
from vibroimpact.contact.laws.hertz import Hertz
from vibroimpact.contact.laws.lankarani_nikravesh import LankaraniNikravesh
from vibroimpact.contact.pair import ContactPair
from vibroimpact.contact.registry import contact_laws
from vibroimpact.dynamics import tabulate as module
from vibroimpact.dynamics.rigid import line_contact

LAWS = list(contact_laws().values())
SMOOTH = {
    *(
        "anagnostopoulos",
        "flores",
        "gonthier",
        "herbert-mcwhannell",
        "hertz",
        "hu-guo",
        "hunt-crossley",
        "lankarani-nikravesh",
    ),
    *("lee-wang", "linear-spring-dashpot", "safaeifar", "tsuji", "zhiying-qishao"),
}
TIMES = ("time_s", "time_of_max_indentation_s", "time_of_max_force_s")
BALL = vi.Body(mass=0.1, contact_offset=0.02)
LAW = LankaraniNikravesh(stiffness=5e8, restitution=0.6)


def problem(**changes: object) -> vi.Problem:
    return vi.Problem(
        **{"sphere": BALL, "plate": vi.rigid_plate(), "laws": (LAW,), "height": 1.0, **changes}
    )


def balls(size: int, seed: int = 0) -> tuple[vi.Body, ContactPair]:
    random = np.random.default_rng(seed)
    radius, modulus = random.uniform(0.004, 0.05, size), 10 ** random.uniform(8, 11, size)
    mass = 1e4 * radius**3
    return vi.Body(mass=mass, contact_offset=radius), ContactPair(
        modulus, radius, mass, 3e-3 * modulus, 0.3
    )


def assert_agrees(table: vi.Response, exact: vi.Response, tolerance: float) -> None:
    """Is the table that of a more exact response? Speeds and energies are off by parts of
    those of the approach, others of their own.
    """
    assert table.outcomes == exact.outcomes
    speed = exact.impacts["approach_speed_m_s"]
    # when a sphere that stays is found to be depends on where its stretches end
    left = exact.impacts["separation_speed_m_s"] > 0.0
    own = {
        "separation_speed_m_s": speed,
        "energy_lost_J": 0.5 * table.problem.sphere.mass.reshape(-1, 1) * speed**2,
    }
    own["plastic_work_J"] = own["energy_lost_J"]
    for name, values in exact.impacts.items():
        found = table.impacts[name]
        assert found.shape == values.shape, name
        np.testing.assert_array_equal(np.isnan(found), np.isnan(values), err_msg=name)
        if name in TIMES:
            # a top is flat: it is located to the root of the tolerance; and what came before is off
            # by as much as its flights
            allowed = (
                2.0 * tolerance * values
                + (0.0 if name == "time_s" else 1e-3) * exact.impacts["duration_s"]
            )
        elif name == "restitution_achieved":
            allowed = tolerance + 0.0 * values
        else:
            allowed = 2.0 * tolerance * np.abs(own.get(name, values))
        within = np.abs(found - values) <= allowed
        kept = left if name in ("duration_s", *TIMES[1:]) else np.ones_like(left)
        assert np.all((within | np.isnan(values))[kept]), (
            name,
            np.nanmax((np.abs(found - values) / allowed)[kept]),
        )


# every law
# -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.name)
def test_every_law_gives_the_table_of_simulate(law: type[ContactLaw]) -> None:
    ball, pair = balls(8)
    stated = problem(
        sphere=ball,
        laws=(law.example(pair),),
        height=ball.contact_offset + np.geomspace(0.02, 30.0, 8),
        impacts=2,
    )
    table = vi.tabulate(replace(stated, tolerance=1e-8))
    exact = vi.simulate(replace(stated, tolerance=1e-11))
    assert_agrees(table, exact, 1e-8)
    assert np.all(table.energy["closure_relative"] < 1e-7)
    for name in exact.energy:
        np.testing.assert_allclose(
            table.energy[name],
            exact.energy[name],
            atol=1e-7 * exact.energy["input_J"].max(),
            err_msg=name,
        )
    assert not table.failures


# collocation
# ---------------------------------------------------------------------------------------


@pytest.fixture
def collocation_only(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let every contact that collocation does not solve fail."""
    monkeypatch.setattr(line_contact, "_MOST_STEPS", 0)


@pytest.mark.parametrize("tolerance", [1e-6, 1e-8, 1e-9, 1e-10])
def test_random_drops_need_nothing_else(tolerance: float, request: pytest.FixtureRequest) -> None:
    random = np.random.default_rng(3)
    ball, pair = balls(300, 1)
    law = LankaraniNikravesh(
        stiffness=pair.hertz_stiffness, restitution=random.uniform(0.3, 1.0, 300)
    )
    height = ball.contact_offset + 10 ** random.uniform(-1, 2, 300)
    stated = problem(sphere=ball, laws=(law,), height=height, impacts=3, tolerance=tolerance)
    exact = vi.simulate(replace(stated, tolerance=1e-13))
    request.getfixturevalue("collocation_only")
    assert_agrees(vi.tabulate(stated), exact, tolerance)


@pytest.mark.parametrize(
    "name", sorted(SMOOTH | {"adams-impact", "kuwabara-kono", "thornton", "walton-braun"})
)
def test_most_drops_need_nothing_else(name: str, request: pytest.FixtureRequest) -> None:
    """Breakpoints, memories, dents on which the next impact falls, and tension that is
    cut: all is solved by collocation.
    """
    ball, pair = balls(60, 5)
    height = ball.contact_offset + np.geomspace(0.1, 3.0, 60)
    stated = problem(
        sphere=ball, laws=(vi.laws.find_contact_law(name).example(pair),), height=height, impacts=3
    )
    assert_agrees(vi.tabulate(stated), vi.simulate(replace(stated, tolerance=1e-12)), 1e-9)
    request.getfixturevalue("collocation_only")
    failures = vi.tabulate(stated).failures
    # that lose nearly all, or hardly pass the breakpoint
    assert len(failures) <= {"adams-impact": 9, "kuwabara-kono": 2}.get(name, 0)


@pytest.mark.parametrize("name", sorted(law.name for law in LAWS if issubclass(law, CompliantLaw)))
def test_a_drop_is_what_it_is_alone(name: str) -> None:
    """Its numbers don't depend on the size of the batch, on its place in it, or on its
    neighbours, to the last digit.
    """
    ball, pair = balls(30, 7)
    law = vi.laws.find_contact_law(name).example(pair)
    height = ball.contact_offset + np.geomspace(1e-4, 3.0, 30)
    stated = problem(sphere=ball, laws=(law,), height=height, impacts=3)
    together = vi.tabulate(stated)
    turned = vi.tabulate(stated.take(np.arange(30)[::-1]))
    for drop in range(0, 30, 4):
        alone = vi.tabulate(stated.take(np.array([drop])))
        rows = alone.impacts["impact"].shape[1]
        for key, values in alone.impacts.items():
            np.testing.assert_array_equal(
                together.impacts[key][drop, :rows], values[0], err_msg=key
            )
            np.testing.assert_array_equal(
                turned.impacts[key][29 - drop, :rows], values[0], err_msg=key
            )


@pytest.mark.parametrize(
    "name",
    sorted(
        law.name for law in LAWS if issubclass(law, CompliantLaw) and law.contact_end != "pull-off"
    ),
)
@pytest.mark.parametrize("height", [0.03, 1.5])
def test_histories_are_those_of_a_single_drop(name: str, height: float) -> None:
    pair = ContactPair(2.4e9, 0.02, 0.1, 8e7, 0.3)
    stated = problem(laws=(vi.laws.find_contact_law(name).example(pair),), height=height, impacts=2)
    found, exact = (
        vi.simulate(replace(stated, height=np.full(2, height))).drop(0),
        vi.simulate(replace(stated, tolerance=1e-13)),
    )
    assert found.outcomes == exact.outcomes
    for start, duration in zip(exact.impacts["time_s"], exact.impacts["duration_s"], strict=True):
        times = start + duration * np.linspace(-0.1, 1.1, 1200)
        one, other = found.at(times), exact.at(times)
        for column in (
            "position_m",
            "velocity_m_s",
            "force_N",
            "contact_elastic_J",
            "contact_dissipated_J",
            "plastic_work_J",
        ):
            scale = (
                exact.energy["input_J"] if column.endswith("_J") else np.abs(other[column]).max()
            )
            np.testing.assert_allclose(
                one[column] / scale, other[column] / scale, rtol=0, atol=2e-7, err_msg=column
            )


@pytest.mark.parametrize(
    "name", ["adams-impact", "flores", "jankowski", "kuwabara-kono", "thornton"]
)
def test_a_drop_has_its_history_in_a_batch_of_which_some_are_followed(name: str) -> None:
    ball, pair = balls(12, 6)
    law = vi.laws.find_contact_law(name).example(pair)
    if name == "flores":
        law = law.changed({"restitution": np.linspace(0.02, 1.0, 12)})
    if name == "adams-impact":
        law = law.changed({"damping_max": law.damping_max * np.geomspace(0.1, 30.0, 12)})
    stated = problem(
        sphere=ball,
        laws=(law,),
        height=ball.contact_offset + np.geomspace(1e-4, 2.0, 12),
        impacts=3,
    )
    together = vi.simulate(stated)
    for number in range(12):
        alone = vi.simulate(stated.take(np.array([number]))).drop(0)
        times = np.linspace(0.0, alone.end_time, 2000)[:-1]
        one, other = together.drop(number).at(times), alone.at(times)
        for column in (
            "velocity_m_s",
            "contact_elastic_J",
            "contact_dissipated_J",
            "plastic_work_J",
        ):
            scale = (
                float(alone.energy["input_J"])
                if column.endswith("_J")
                else np.abs(other[column]).max()
            )
            np.testing.assert_allclose(
                one[column] / scale, other[column] / scale, rtol=0, atol=1e-6, err_msg=column
            )


@pytest.mark.usefixtures("collocation_only")
@pytest.mark.parametrize("name", sorted(SMOOTH - {"linear-spring-dashpot"}))
def test_restitution_is_that_of_the_closed_form(name: str) -> None:
    ball, pair = balls(40, 2)
    law = vi.laws.find_contact_law(name).example(pair)
    if any(item.name == "restitution" for item in fields(law)):
        law = law.changed({"restitution": np.linspace(0.4, 1.0, 40)})
    stated = problem(
        sphere=ball,
        laws=(law,),
        height=None,
        speed=np.geomspace(0.01, 40.0, 40),
        gravity=0.0,
        impacts=1,
        tolerance=1e-8,
    )
    row = {key: column[:, 0] for key, column in vi.tabulate(stated).impacts.items()}
    closed = law.closed_form_restitution(ball.mass, row["approach_speed_m_s"])
    np.testing.assert_allclose(row["restitution_achieved"], closed, rtol=0, atol=1e-8)
    brought = 0.5 * ball.mass * row["approach_speed_m_s"] ** 2
    np.testing.assert_allclose(row["energy_lost_J"] / brought, 1.0 - closed**2, rtol=0, atol=1e-8)


@pytest.mark.parametrize("stiffness", [1e6, 1e12])
@pytest.mark.parametrize("exponent", [1.0, 1.5, 2.0, 1.3, "mixed"])
def test_corners(stiffness: float, exponent: float | str) -> None:
    given = np.tile([1.0, 1.5, 2.0], 4) if exponent == "mixed" else exponent
    law = LankaraniNikravesh(
        stiffness=stiffness, restitution=np.repeat([0.0, 0.3, 0.9, 1.0], 3), exponent=given
    )
    height = 0.02 + np.tile([0.002, 1.0, 100.0], 4)
    stated = problem(
        sphere=vi.Body(mass=np.full(12, 0.1), contact_offset=0.02),
        laws=(law,),
        height=height,
        impacts=2,
        tolerance=1e-8,
    )
    table, exact = vi.tabulate(stated), vi.simulate(replace(stated, tolerance=1e-12))
    assert_agrees(table, exact, 1e-8)


@pytest.mark.parametrize("restitution", [0.05, 0.2, 0.5])
def test_heavy_damping(restitution: float) -> None:
    law = vi.laws.find_contact_law("flores")(
        stiffness=np.geomspace(1e6, 1e11, 9), restitution=restitution
    )
    stated = problem(
        sphere=vi.Body(mass=np.full(9, 0.1), contact_offset=0.02),
        laws=(law,),
        impacts=1,
        tolerance=1e-8,
    )
    assert_agrees(vi.tabulate(stated), vi.simulate(replace(stated, tolerance=1e-12)), 1e-8)


@pytest.mark.parametrize("ratio", [1e-3, 0.01, 0.3, 1.26])
def test_the_peak_of_a_dashpot_is_found(ratio: float) -> None:
    law = vi.laws.find_contact_law("linear-spring-dashpot")(
        stiffness=1e6, damping=2.0 * ratio * np.sqrt(1e6 * 0.1)
    )
    stated = problem(laws=(law,), height=None, speed=2.0, impacts=1)
    table, dense = vi.tabulate(stated).impacts, vi.simulate(stated)
    force = dense.at(np.linspace(0.0, dense.impacts["duration_s"][0], 20001))["force_N"]
    assert table["max_force_N"][0] == pytest.approx(force.max(), rel=1e-7)


def test_below_the_tightest_tolerance_it_is_simulate() -> None:
    stated = problem(
        sphere=vi.Body(mass=np.array([0.1, 0.2]), contact_offset=0.02), tolerance=1e-12
    )
    table, response = vi.tabulate(stated), vi.simulate(stated)
    for name, values in response.impacts.items():
        np.testing.assert_array_equal(table.impacts[name], values, err_msg=name)


# how drops end
# -------------------------------------------------------------------------------------


def test_to_rest_captured_and_in_blocks(monkeypatch: pytest.MonkeyPatch) -> None:
    law = vi.laws.find_contact_law("flores")(
        stiffness=1e7, restitution=np.tile([0.3, 0.6, 0.05], 4)
    )
    ball = vi.Body(mass=np.full(12, 0.1), contact_offset=0.02)
    stated = problem(
        sphere=ball, laws=(law,), height=0.02 + np.geomspace(1e-6, 1.0, 12), impacts=None
    )
    whole, exact = vi.tabulate(stated), vi.simulate(replace(stated, tolerance=1e-12))
    assert {vi.Outcome.REST_SPEED, vi.Outcome.CAPTURED} == set(whole.outcomes)
    assert_agrees(whole, exact, 1e-7)
    told: list[float] = []
    monkeypatch.setattr(module, "BLOCK", 5)
    parts = vi.tabulate(stated, told.append)
    assert told == pytest.approx([5 / 12, 10 / 12, 1.0])
    assert parts.outcomes == whole.outcomes
    assert len(parts) == 12
    for name, values in whole.impacts.items():
        kept = (
            np.s_[:]
            if name not in ("duration_s", *TIMES)
            else whole.impacts["separation_speed_m_s"] > 0.0
        )
        np.testing.assert_allclose(
            parts.impacts[name][kept], values[kept], rtol=1e-7, atol=1e-9, err_msg=name
        )


@pytest.mark.parametrize("oblique", [False, True])
def test_threads_change_no_digit(oblique: bool) -> None:
    ball, pair = balls(40, 8)
    law = vi.laws.find_contact_law("flores").example(pair)
    along = (
        vi.Oblique(
            velocity=(0.5, 0.0), friction=vi.friction.find_friction_law("coulomb")(coefficient=0.2)
        )
        if oblique
        else None
    )
    stated = problem(
        sphere=ball,
        laws=(law,),
        height=ball.contact_offset + np.geomspace(0.01, 1.0, 40),
        impacts=None,
        oblique=along,
    )
    told: list[float] = []
    one, several = vi.tabulate(stated), vi.tabulate(stated, told.append, threads=3)
    assert told == pytest.approx([14 / 40, 28 / 40, 1.0])
    assert several.outcomes == one.outcomes
    for name, values in one.impacts.items():
        np.testing.assert_array_equal(several.impacts[name], values, err_msg=name)
    with pytest.raises(vi.InputError, match="0 is no number of threads; give 1 or more"):
        vi.tabulate(stated, threads=0)


def test_the_same_rules_end_a_run() -> None:
    for changes in (
        {"duration": 0.6, "impacts": None},
        {"height": None, "speed": 2.0, "gravity": 0.0},
        {"impacts": None, "rest_speed": 0.5},
    ):
        table, response = vi.tabulate(problem(**changes)), vi.simulate(problem(**changes))
        assert table.outcomes == response.outcomes
        np.testing.assert_allclose(table.end_time, response.end_time, rtol=1e-8)


def test_a_single_drop_has_the_arrays_of_simulate() -> None:
    table, response = vi.tabulate(problem(impacts=3)), vi.simulate(problem(impacts=3))
    assert table.impacts["rebound_height_m"].shape == (3,)
    np.testing.assert_allclose(
        table.impacts["rebound_height_m"], response.impacts["rebound_height_m"], rtol=1e-8
    )
    assert table.energy["closure_J"].shape == ()
    assert table.status.split(",")[0] == response.status.split(",")[0]
    with pytest.raises(vi.InputError, match="tabulate keeps no histories; ask simulate"):
        table.at([0.0])


def test_a_drop_of_a_table_is_that_of_its_batch() -> None:
    table = vi.tabulate(problem(height=[0.5, 1.0], impacts=3))
    np.testing.assert_array_equal(table.drop(1).impacts["time_s"], table.impacts["time_s"][1])
    with pytest.raises(vi.InputError, match="a history belongs to one drop"):
        table.history()


def test_laws_of_each_impact() -> None:
    laws = tuple(LankaraniNikravesh(stiffness=5e8, restitution=e) for e in (0.9, 0.5))
    assert vi.tabulate(problem(laws=laws, impacts=4)).impacts["restitution_asked"].tolist() == [
        0.9,
        0.5,
        0.5,
        0.5,
    ]


def test_what_fails_says_why(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(line_contact, "_MOST_STEPS", 3)
    table = vi.tabulate(problem(laws=(Hertz(stiffness=5e8),), height=[1.0, 2.0], tolerance=1e-12))
    assert table.outcomes == (vi.Outcome.FAILED, vi.Outcome.FAILED)
    assert set(table.failures) == {0, 1}
    assert table.failures[0].endswith(".")


def test_bodies_that_vibrate_take_the_way_they_always_took() -> None:
    stated = drop_on(
        Hertz(stiffness=STIFFNESS),
        plate=modes_of([300.0, 2000.0], [0.3, 0.5], 0.01),
        height=0.5,
        impacts=2,
    )
    table, response = vi.tabulate(stated), vi.simulate(stated)
    for name, values in response.impacts.items():
        np.testing.assert_array_equal(table.impacts[name], values, err_msg=name)


def test_what_is_no_problem_is_refused() -> None:
    with pytest.raises(vi.InputError, match=r"vi\.load_case"):
        vi.tabulate("paper:type1-theory")  # type: ignore[arg-type]
