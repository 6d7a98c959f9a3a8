"""Limits that the pages on studies and on the live page state."""

from __future__ import annotations

import re
from pathlib import Path

import vibroimpact as vi
from stated_numbers import ROOT, page_text, says
from vibroimpact.app.draft import _POINTS, _TOLERANCE
from vibroimpact.app.measurement import MOST_RECORDED
from vibroimpact.app.messages import LONGEST_FILE
from vibroimpact.app.served_cases import (
    LONGEST_RUN,
    MOST_IMPACTS,
    MOST_MEMORY,
    MOST_MODES,
    MOST_NODES,
    MOST_SAMPLES,
    MOST_SECONDS,
    MOST_SENSORS,
)
from vibroimpact.app.server import MOST_WINDOWS
from vibroimpact.cli.studies import MOST_BYTES_UNCONFIRMED, MOST_DROPS_UNCONFIRMED
from vibroimpact.studies.planning.design import MOST_DROPS
from vibroimpact.studies.report.sensitivity import MOST_LEFT_OUT
from vibroimpact.studies.report.tables import doubt_sentences
from vibroimpact.test_analysis.alignment import ALIGNED

STUDIES = "docs/studies.md"
LIVE = "docs/live-page.md"


def test_sizes_of_studies() -> None:
    says(
        STUDIES,
        "More than {} drops, or {} GB of results, are computed only with",
        MOST_DROPS_UNCONFIRMED,
        1e-9 * MOST_BYTES_UNCONFIRMED,
    )
    assert "the maximum is ten million" in page_text(STUDIES)
    assert MOST_DROPS == 10_000_000
    says(STUDIES, "not if more than {} % of the points have no value", 100.0 * MOST_LEFT_OUT)


def test_doubts_of_a_study(tmp_path: Path) -> None:
    study = vi.studies.load_study(
        vi.studies.run_sweep(vi.studies.load_sweep("paper:sweep"), tmp_path / "sizes")
    )
    (shown,) = re.findall(r"^Warning: (.+)\.$", (ROOT / STUDIES).read_text(encoding="utf-8"), re.M)
    assert shown in [doubt.replace("\N{NO-BREAK SPACE}", " ") for doubt in doubt_sentences(study)]


def test_drafts() -> None:
    says(LIVE, "with a tolerance of {}, a history of about {} points", _TOLERANCE, _POINTS)


def test_sizes_of_cases() -> None:
    says(LIVE, "up to {} modes of a body (estimated if it has a", MOST_MODES)
    says(
        LIVE,
        "about {} nodes of a mesh, {} impacts, {} s of simulated time",
        MOST_NODES,
        MOST_IMPACTS,
        LONGEST_RUN,
    )
    says(LIVE, "{} sensors and {} million samples in total", MOST_SENSORS, 1e-6 * MOST_SAMPLES)
    says(LIVE, "three minutes and {} GB by the estimate", 1e-9 * MOST_MEMORY)
    assert MOST_SECONDS == 180.0
    assert "At most twelve windows" in page_text(LIVE)
    assert MOST_WINDOWS == 12


def test_measurements() -> None:
    says(LIVE, "aligned in time by their first {} ms", 1e3 * ALIGNED)
    says(
        LIVE,
        "A file of a measurement may have {} MB and {} samples",
        1e-6 * LONGEST_FILE,
        MOST_RECORDED,
    )
