"""Hostile studies: each is refused in a few clean lines, or a few of its drops are
computed, within seconds.
"""

from __future__ import annotations

from test_fuzz_cases import shown

import vibroimpact as vi
from hostile_runs import failures, number, seed
from mutations import studies
from seeds import Table
from vibroimpact.runs.case_explained import case_explained
from vibroimpact.studies.computation.compute_points import compute_points
from vibroimpact.studies.planning.explain_sweep import explain_sweep


def compute_a_few(table: Table) -> None:
    study = vi.studies.sweep_of(table)
    shown(explain_sweep(study))
    shown(case_explained(study.case))
    if study.deforms:
        return
    keep = tuple(study.section.keep)
    found = compute_points(study.table, keep, 0, study.plan.points(0, min(5, study.size)))
    assert len(found.arrays["outcome"]) == min(5, study.size)
    for reason in found.failures.values():
        assert reason.isprintable(), reason
        assert "Error: " not in reason, reason


def test_hostile_studies_are_refused_or_run() -> None:
    told = failures(compute_a_few, list(studies(number(40), seed(3))))
    assert not told, told
