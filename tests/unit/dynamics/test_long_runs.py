"""Runs of very many impacts: what they keep in memory, and what of their histories is written."""

from __future__ import annotations

import gc
import tracemalloc
from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest

import vibroimpact as vi
from vibroimpact.contact.laws.lankarani_nikravesh import LankaraniNikravesh
from vibroimpact.contact.laws.walton_braun import WaltonBraun
from vibroimpact.dynamics.motion.impact_rows import stacked_tables, table_of
from vibroimpact.results import fine_history

BALL = vi.Body(mass=0.09, contact_offset=0.025)


def drop(impacts: int, law: vi.laws.ContactLaw | None = None) -> vi.Problem:
    law = law or LankaraniNikravesh(stiffness=5e8, restitution=0.9999)
    return vi.Problem(sphere=BALL, plate=vi.rigid_plate(), laws=(law,), height=1.0, impacts=impacts)


@pytest.fixture
def traced() -> Iterator[None]:
    gc.collect()
    tracemalloc.start()
    yield
    tracemalloc.stop()


@pytest.mark.slow
@pytest.mark.usefixtures("traced")
def test_an_impact_takes_less_than_two_thousand_bytes() -> None:
    """Of its contact no more is kept than how it began and ended."""
    held = []
    for impacts in (10, 20, 60):  # the first fills what is computed once
        before = tracemalloc.get_traced_memory()[0]
        response = vi.simulate(drop(impacts))
        gc.collect()
        held.append(tracemalloc.get_traced_memory()[0] - before)
        assert len(response.impacts["impact"]) == impacts
    assert (held[2] - held[1]) / 40 < 2000.0


@pytest.mark.slow
@pytest.mark.usefixtures("traced")
def test_a_history_takes_little_more_memory_than_its_numbers() -> None:
    response = vi.simulate(drop(60))
    response.at([0.0])  # where the segments begin is found once
    gc.collect()
    before = tracemalloc.get_traced_memory()[0]
    tracemalloc.reset_peak()
    history = response.history()
    peak = tracemalloc.get_traced_memory()[1] - before
    assert peak < 1.3 * sum(values.nbytes for values in history.values())


def test_bounces_are_the_same_when_they_come_back() -> None:
    """A law with a memory, whose bounces hold another law after each deepest point."""
    law = WaltonBraun(stiffness=4e5, restitution=0.6)
    oblique = vi.Oblique(velocity=(0.1, 0.0))
    problem = replace(drop(4, law), air=vi.Air(), oblique=oblique)
    bounces = vi.simulate(problem).bounces
    assert bounces is not None
    assert bounces[0] is not bounces[0]  # made anew
    for one, other in zip(bounces, bounces, strict=True):
        _same(one, other)
    law = bounces[0].contact.pieces[-1].law
    assert isinstance(law, WaltonBraun)
    assert law.memories() == bounces[0].contact.law.memories()


def _same(one: object, other: object) -> None:
    assert type(one) is type(other)
    if isinstance(one, np.ndarray):
        assert one.dtype == other.dtype
        np.testing.assert_array_equal(one, other)
    elif isinstance(one, (list, tuple)):
        assert len(one) == len(other)
        for a, b in zip(one, other, strict=True):
            _same(a, b)
    elif not hasattr(one, "__dict__"):
        assert one is other or one == other
    else:
        for name, value in vars(one).items():
            if not name.startswith("_"):  # what a flight in air has computed so far
                _same(value, getattr(other, name))


def test_the_history_of_a_drop_is_that_of_the_same_drop_in_a_batch() -> None:
    """The parts of a drop are told by the core alike, alone and among others."""
    law = LankaraniNikravesh(stiffness=np.array([5e8, 1e7]), restitution=np.array([0.9, 0.5]))
    together, alone = vi.simulate(drop(6, law)).drop(0), vi.simulate(drop(6, law.take(0)))
    times = np.linspace(0.0, 0.999 * alone.end_time, 5000)
    one, other = together.at(times), alone.at(times)
    assert one.keys() == other.keys()
    for name, values in other.items():
        scale = max(float(np.abs(values).max()), 1e-30)
        np.testing.assert_allclose(one[name], values, atol=1e-6 * scale, rtol=0.0, err_msg=name)


def test_a_history_that_is_too_long_keeps_its_first_impacts_whole_and_every_event() -> None:
    response = vi.simulate(drop(60))
    whole, kept_of_it = response.history(), response.history(4000)
    assert len(kept_of_it["time_s"]) <= 4000 < len(whole["time_s"])
    first = int(np.searchsorted(kept_of_it["time_s"], response.impacts["time_s"][4]))
    for name, values in kept_of_it.items():
        np.testing.assert_array_equal(values[:first], whole[name][:first], err_msg=name)
    # the ends of each flight and the deepest point of each contact are there
    for name in ("time_s", "time_of_max_indentation_s"):
        assert (
            np.abs(kept_of_it["time_s"] - response.impacts[name][:, None]).min(axis=1).max() < 1e-12
        )
    told = response.at(kept_of_it["time_s"])
    # where the two sides of an event differ
    inside = np.abs(kept_of_it["time_s"] - response.impacts["time_s"][:, None]).min(axis=0) > 1e-9
    np.testing.assert_allclose(
        kept_of_it["position_m"][inside], told["position_m"][inside], atol=1e-12
    )


def test_what_is_written_of_a_history_is_bounded(monkeypatch: pytest.MonkeyPatch) -> None:
    response = vi.simulate(drop(40))
    whole = len(fine_history.fine_history(response)["time_s"])
    monkeypatch.setattr(fine_history, "MOST_POINTS", whole // 2)
    assert len(fine_history.fine_history(response)["time_s"]) <= whole // 2


def test_a_table_of_no_impact_has_all_columns() -> None:
    columns = ["impact", "time_s"]
    table = stacked_tables([table_of([], columns)] * 3, columns)
    assert {name: column.shape for name, column in table.items()} == {
        "impact": (3, 0),
        "time_s": (3, 0),
    }


def test_drops_of_fewer_impacts_have_none_where_others_have() -> None:
    tables = [table_of([{"time_s": 1.0}, {"time_s": 2.0}], ["time_s"]), table_of([], ["time_s"])]
    expected = np.array([[1.0, 2.0], [np.nan, np.nan]])
    np.testing.assert_array_equal(stacked_tables(tables, ["time_s"])["time_s"], expected)
