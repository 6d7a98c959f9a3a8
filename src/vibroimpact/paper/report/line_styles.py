"""How the lines of the paper's figures look, up to three of which lie on one another."""

from __future__ import annotations

from typing import Any

from vibroimpact.report.style import LOOPS

LOOKS: tuple[dict[str, Any], ...] = tuple(
    {"color": colour, "linestyle": dashes, "linewidth": width, "alpha": opacity}
    for (colour, dashes), width, opacity in zip(LOOPS, (2.3, 1.5, 1.1), (0.35, 1.0, 1.0), strict=False)
)
"""The first is wide and pale, so that it shows where others lie on it, and they on it."""
