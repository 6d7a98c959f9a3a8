"""Hostile cases of vibrating bodies: each is refused in a few clean lines, told to take
long, or runs within seconds.
"""

from __future__ import annotations

from collections import Counter
from importlib import import_module

import pytest

import vibroimpact as vi
from hostile_runs import attack, number, seed
from mutations import elastic_cases
from seeds import Table
from vibroimpact.cases.costs import describe_costs


def run_unless_told(table: Table) -> None:
    case = vi.case_of(table)
    if not describe_costs(case):
        vi.simulate(case)


@pytest.mark.slow
def test_hostile_elastic_cases_run_or_are_told() -> None:
    import_module("vibroimpact.cases.elastic.elastic_bodies")  # once, and not in each process
    cases = list(elastic_cases(number(40), seed(4)))
    # each in a process of its own: modes are remembered there
    outcomes = [attack(run_unless_told, [case])[0] for case in cases]
    print(Counter(one.kind for one in outcomes))
    told = [
        f"{one.kind}: {one.text}\n    of {case!r:.2000}"
        for case, one in zip(cases, outcomes, strict=True)
        if one.failed
    ]
    assert not told, "\n".join(told)
