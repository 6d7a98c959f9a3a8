"""The result of a drop while it is being changed: the numbers of a full one, of which
only what is looked at is computed.
"""

from __future__ import annotations

import numpy as np
import pytest

import vibroimpact as vi
from vibrating import STIFFNESS, drop_on, random_modes
from vibroimpact.app.draft import draft_of, drafted
from vibroimpact.contact.laws.adams_impact import AdamsImpact
from vibroimpact.dynamics.motion.columns import MOTION_COLUMNS
from vibroimpact.dynamics.response import Response
from vibroimpact.dynamics.statement.problem import Problem
from vibroimpact.runs.charts import chart_makers


@pytest.fixture
def problem() -> Problem:
    law = AdamsImpact(stiffness=STIFFNESS, damping_max=180.0)
    return drop_on(
        law,
        random_modes(1, 20, 100.0, 2e4, 1.2, 0.03),
        random_modes(2, 6, 12e3, 60e3, 2.0, 1.0),
        height=0.5,
        impacts=3,
    )


def test_its_numbers_are_those_of_the_full_result(problem: Problem) -> None:
    draft, full = draft_of(vi.simulate(drafted(problem))), vi.result_of(vi.simulate(problem))
    for name, values in draft.impacts.items():
        np.testing.assert_allclose(values, full.impacts[name], rtol=1e-5, err_msg=name)
    assert list(chart_makers(draft)) == list(chart_makers(full))
    assert set(draft.history) == set(full.history)
    for name, values in draft.history.items():
        largest = np.abs(full.history[name]).max()
        assert np.abs(values).max() == pytest.approx(largest, rel=0.2, abs=1e-9), name
    assert draft.energy == pytest.approx(full.energy, rel=1e-4, abs=1e-7 * full.energy["input_J"])
    assert {body: draft.frequencies(body) for body in ("sphere", "plate")} == {
        body: full.frequencies(body) for body in ("sphere", "plate")
    }
    assert draft.peaks["plate"]["max_bending_m"] == pytest.approx(
        full.peaks["plate"]["max_bending_m"], rel=1e-4
    )


def test_only_what_is_looked_at_is_computed(
    problem: Problem, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[set[str]] = []
    history = Response.history

    def watched(
        response: Response, most: int | None = None, columns: tuple[str, ...] | None = None
    ) -> dict[str, np.ndarray]:
        asked.append(set(columns or ()))
        return history(response, most, columns)

    monkeypatch.setattr(Response, "history", watched)
    makers = chart_makers(draft_of(vi.simulate(drafted(problem))))
    for name in ("position", "force", "velocity", "acceleration", "force_indentation"):
        makers[name]()
    assert asked == [set(MOTION_COLUMNS)]
    makers["plate_energy"]()
    assert len(asked) == 2
    assert not asked[0] & asked[1]
