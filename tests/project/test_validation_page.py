"""The page of validation is made of what tests record, of all of them, and of none that is gone."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from agreement import ROOT, TOLD, Agrees, merged, read
from validation_page import PAGE, page


def test_the_page_is_made_of_what_is_recorded() -> None:
    rows = read(TOLD)
    assert rows == merged(rows)
    assert PAGE.read_text(encoding="utf-8") == page(rows), (
        "python tests/validation_page.py writes the page anew"
    )


def test_every_file_of_comparisons_is_on_it() -> None:
    """But for those that need other programs or a quarter of an hour, which it then says
    were not run.
    """
    compared = {path.name for path in (ROOT / "tests" / "verification").glob("test_*.py")}
    missing = compared - {Path(row["file"]).name for row in read(TOLD)}
    assert missing <= {
        "test_vs_peers.py",
        "test_vs_identified_impacts.py",
        "test_vs_laboratory.py",
    }, "make validation records them"
    assert all(name in PAGE.read_text(encoding="utf-8") for name in missing)


def test_every_comparison_is_of_a_test_that_is_there() -> None:
    for row in read(TOLD):
        (function,) = re.findall(r"\w+$", row["test"])
        assert re.search(
            rf"def {function}\(\s*(self,)?\s*agrees\b",
            (ROOT / row["file"]).read_text(encoding="utf-8"),
        ), row


@pytest.mark.parametrize(
    ("ours", "theirs", "tolerance"),
    [
        (1.02, 1.0, {"relative": 0.01}),
        ([1.0, float("nan")], 1.0, {"absolute": 1e9}),
        ([0.0, 10.2], [0.1, 10.0], {"of_the_largest": 0.01}),
        ([1.0, 3.1], [1.0, 3.0], {"rms": 0.03}),
        ([1.0, 3.3], [1.0, 3.0], {"mean": 0.1}),
        ([], 1.0, {"absolute": 1.0}),
    ],
)
def test_what_does_not_agree_fails(
    agrees: Agrees, ours: object, theirs: object, tolerance: dict[str, float]
) -> None:
    with pytest.raises(AssertionError, match="a case, a quantity"):
        agrees("a case", "a quantity", ours, theirs, **tolerance)


def test_what_has_another_shape_fails(agrees: Agrees) -> None:
    with pytest.raises(ValueError):
        agrees("a case", "a quantity", [1.0, 1.0], [1.0, 1.0, 1.0], relative=1.0)
