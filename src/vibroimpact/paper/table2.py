"""Table 2: by how much compression and force of the simulations are smaller than the theory's."""

from __future__ import annotations

import numpy as np

from vibroimpact.paper.printed import printed
from vibroimpact.paper.printed_and_computed import Account, Row
from vibroimpact.paper.runs import DAMPINGS, IMPACTS, Runs
from vibroimpact.paper.sampling import QUANTITIES, error_range, found_spacing, table2_error
from vibroimpact.paper.section import Section


def table2(runs: Runs) -> Section:
    """Return Table 2 beside the exact errors, and beside what is read off samples."""
    rows = []
    for quantity, (_, column, _) in QUANTITIES.items():
        for damping in DAMPINGS:
            for impact, exact in zip(IMPACTS, np.abs(runs.below_theory(damping, column)), strict=True):
                # a compression is not held against a spacing that was found from itself
                spacing = found_spacing(runs, (damping, impact) if quantity == "compression" else None)
                low, high = _magnitudes(*error_range(runs, spacing, quantity, damping, impact))
                reason = f"peaks read off samples {1e6 * spacing:.0f} µs apart give {low:.2f} to {high:.2f} %"
                value = table2_error(quantity, damping, impact)
                rows.append(Row(value, float(exact), by=f"IMPACT, {damping} damping", accounts=(Account(reason, low, high),)))
    worst = max((table2_error("compression", "variable", impact) for impact in IMPACTS), key=lambda value: value.value)
    rows.append(
        Row(printed("worst_compression.variable"), worst.value, by="Table 2", otherwise=f"Table 2 and conclusion (1) have {worst.text} %")
    )
    return Section(
        "Table 2: errors of the simulations",
        (
            "Computed are the differences of the exact peaks. The printed ones scatter about them as if they were read off samples. "
            "That is a weak test, as the ranges show: sampling can be the cause (a compression is held against the spacing that the "
            "other contacts tell). The forensic section says what speaks for it and what remains open.",
        ),
        tuple(rows),
    )


def _magnitudes(low: float, high: float) -> tuple[float, float]:
    """Return the range of the magnitudes of a range: the paper prints errors without their sign."""
    return (0.0 if low < 0.0 < high else min(abs(low), abs(high))), max(abs(low), abs(high))
