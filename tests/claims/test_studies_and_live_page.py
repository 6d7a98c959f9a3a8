"""Limits that the pages on studies and on the live page state."""

from __future__ import annotations

from stated import page_text, says
from vibroimpact.app.draft import _POINTS, _TOLERANCE
from vibroimpact.app.limits import (
    LONGEST_RUN,
    MOST_IMPACTS,
    MOST_MEMORY,
    MOST_MODES,
    MOST_NODES,
    MOST_SAMPLES,
    MOST_SECONDS,
    MOST_SENSORS,
)
from vibroimpact.app.messages import LONGEST
from vibroimpact.app.server import MOST_WINDOWS
from vibroimpact.app.session import _SHORT
from vibroimpact.cli.studies import MOST_BYTES_UNCONFIRMED, MOST_DROPS_UNCONFIRMED
from vibroimpact.studies.compute_points import _TOGETHER
from vibroimpact.studies.compute_study import _ELASTIC_CHUNK
from vibroimpact.studies.section import MOST_DROPS

STUDIES = "docs/studies.md"
LIVE = "docs/live-page.md"


def test_sizes_of_studies() -> None:
    says(STUDIES, "More than {} drops, or {} GB of results, are computed only with", MOST_DROPS_UNCONFIRMED, 1e-9 * MOST_BYTES_UNCONFIRMED)
    assert "the maximum is ten million" in page_text(STUDIES)
    assert MOST_DROPS == 10_000_000
    says(STUDIES, "static problems of {} contact points at a time", _TOGETHER)
    says(STUDIES, "and drops of elastic bodies, are computed in batches of {}", _ELASTIC_CHUNK)


def test_drafts() -> None:
    says(LIVE, "with a tolerance of {}, a history of about {} points", _TOLERANCE, _POINTS)
    says(LIVE, "A draft that takes more than {} seconds is abandoned", _SHORT)


def test_sizes_of_cases() -> None:
    says(LIVE, "up to {} modes of a body (estimated if it has a", MOST_MODES)
    says(LIVE, "about {} nodes of a mesh, {} impacts, {} s of simulated time", MOST_NODES, MOST_IMPACTS, LONGEST_RUN)
    says(LIVE, "{} sensors and {} million samples in total", MOST_SENSORS, 1e-6 * MOST_SAMPLES)
    says(LIVE, "three minutes and {} GB by the estimate", 1e-9 * MOST_MEMORY)
    assert MOST_SECONDS == 180.0
    says(LIVE, "a message is at most {} kB", 1e-3 * LONGEST)
    assert "at most twelve windows" in page_text(LIVE)
    assert MOST_WINDOWS == 12
