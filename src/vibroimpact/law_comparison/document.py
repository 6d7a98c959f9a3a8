"""A comparison of contact laws as data: the summary of its folder, and what `compare
--json` prints.
"""

from __future__ import annotations

from typing import Any

from vibroimpact._version import __version__
from vibroimpact.law_comparison.comparison import Comparison
from vibroimpact.results.csv_files import impact_rows


def comparison_document(comparison: Comparison) -> dict[str, Any]:
    """Return what `compare --json` prints: the summary of the folder, and for each law
    the case that was run.
    """
    summary = summary_of_comparison(comparison)
    laws = {
        name: {**one, "case": comparison.results[name].case}
        for name, one in summary["laws"].items()
    }
    return {**summary, "laws": laws}


def summary_of_comparison(comparison: Comparison) -> dict[str, Any]:
    """Return the content of `summary.json` in the folder of a comparison."""
    laws = {
        name: {
            "status": one.status,
            "impacts": impact_rows(one.impacts),
            "energy": one.energy,
            "doubts": one.doubts,
        }
        for name, one in comparison.results.items()
    }
    return {"name": comparison.name, "version": __version__, "laws": laws}
