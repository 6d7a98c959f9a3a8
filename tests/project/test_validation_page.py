"""The page of validation is made of what tests record, of all of them, and of none that is gone."""

from __future__ import annotations

import re

from agreement import ROOT, TOLD, merged, read
from validation_page import PAGE, page


def test_the_page_is_made_of_what_is_recorded() -> None:
    rows = read(TOLD)
    assert rows == merged(rows)
    assert PAGE.read_text(encoding="utf-8") == page(rows), "python tests/validation_page.py writes the page anew"


def test_every_comparison_is_of_a_test_that_is_there() -> None:
    for row in read(TOLD):
        (function,) = re.findall(r"\w+$", row["test"])
        assert f"def {function}(" in (ROOT / row["file"]).read_text(encoding="utf-8"), row
