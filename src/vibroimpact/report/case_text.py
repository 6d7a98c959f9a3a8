"""A resolved case as a text to copy from a page."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import tomli_w

from vibroimpact.report.report import Code

_LEAD = "The case with all defaults filled in; plain numbers are in SI units."


def case_text(case: Mapping[str, Any]) -> Code:
    """Return a resolved case as TOML.

    Examples
    --------
    >>> case_text({"drop": {"height": 4.0}}).text
    '[drop]\\nheight = 4.0\\n'
    """
    return Code("case", _LEAD, tomli_w.dumps(case))
