"""The table of features in the documentation is as `make docs` would write it."""

from __future__ import annotations

from pathlib import Path

import pytest

import vibroimpact as vi
from vibroimpact.cli.feature_page import feature_page

PAGE = Path(__file__).parents[2] / "docs" / "signals.md"


def test_the_table_is_not_stale() -> None:
    text = PAGE.read_text(encoding="utf-8")
    assert feature_page(text) == text, "docs/signals.md is stale: make docs"
    assert all(f"\n| `{name}` |" in text for name in vi.signals.signal_features())
    assert f"All {len(vi.signals.signal_features())} take" in text
    with pytest.raises(vi.InputError, match="must stand around the table"):
        feature_page("no markers")


def test_the_table_of_reasons_is_whole() -> None:
    from vibroimpact.signals.reasons import Reason

    reasons = (
        PAGE.read_text(encoding="utf-8")
        .split("| reason | when |")[1]
        .split("\n\n")[0]
        .replace("...", "there are fewer than")
    )
    assert [
        reason.text
        for reason in Reason
        if reason not in (Reason.NONE, Reason.UNDEFINED) and reason.text not in reasons
    ] == []
