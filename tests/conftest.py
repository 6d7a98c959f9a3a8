"""Shared drops."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

import vibroimpact as vi

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from vibroimpact.results.result import Result


@pytest.fixture(scope="session")
def theory() -> vi.Response:
    return vi.simulate(vi.load_case("paper:type1-theory"))


@pytest.fixture(scope="session")
def variable() -> vi.Response:
    return vi.simulate(vi.load_case("paper:type1-variable"))


@pytest.fixture
def few_pictures(monkeypatch: pytest.MonkeyPatch) -> None:
    """Draw no more than one figure of a run, and none of a study, where none is looked at: they take longest of all that is written."""
    from vibroimpact.report.style import style
    from vibroimpact.runs.history_figures import POSITION, draw_history

    def draw(result: Result) -> dict[str, Figure]:
        with style():
            return {"position": draw_history(result, POSITION)}

    monkeypatch.setattr("vibroimpact.runs.page.draw_figures", draw)
    monkeypatch.setattr("vibroimpact.studies.report.page.study_figures", lambda *_: {})
