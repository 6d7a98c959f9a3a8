"""What ends the run of a case: the problem states it, and `vibroimpact check` says it."""

from __future__ import annotations

from typing import Any

import pytest
from rich.console import Console

import vibroimpact as vi
from support import plain_case
from vibroimpact.cases.rigid.run_ends import ends_of_run
from vibroimpact.dynamics.statement.problem import Problem
from vibroimpact.runs.case_explained import case_explained


def case_of(run: dict[str, Any], **changes: Any) -> vi.Case:
    return vi.case_of({**plain_case(**changes), "run": run})


@pytest.mark.parametrize(
    ("run", "words", "impacts", "duration"),
    [
        ({}, ["after 5 impacts"], Problem.impacts, None),
        ({"impacts": 1}, ["after 1 impact"], 1, None),
        ({"impacts": "all"}, [], None, None),
        ({"duration": "250 ms"}, ["at 0.25 s"], None, 0.25),
        ({"impacts": 3, "duration": 2}, ["after 3 impacts", "at 2 s"], 3, 2.0),
    ],
)
def test_the_rules_that_a_case_states(
    run: dict[str, Any], words: list[str], impacts: int | None, duration: float | None
) -> None:
    case = case_of(run)
    assert [end.words for end in ends_of_run(case)] == words
    problem = case.to_problem()
    assert (problem.impacts, problem.duration) == (impacts, duration)
    console = Console(width=200)
    with console.capture() as captured:
        console.print(case_explained(case))
    (line,) = [line for line in captured.get().splitlines() if line.startswith("stops ")]
    assert line.split(maxsplit=1)[1].split(" or ") == ["at rest", *words]


def test_a_run_that_nothing_ends_needs_a_loss() -> None:
    elastic = {"law": "hertz"}
    with pytest.raises(vi.InputError, match='"all" needs a law that loses energy'):
        vi.case_of({**plain_case(), "contact": elastic, "run": {"impacts": "all"}})
    for run in ({"impacts": "all", "duration": 1}, {"impacts": 2}, {}):
        vi.case_of({**plain_case(), "contact": elastic, "run": run})
