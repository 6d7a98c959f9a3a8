"""Table 2: by how much compression and force of the simulations are smaller than the theory's."""

from __future__ import annotations

from vibroimpact.reproduction.printed import printed
from vibroimpact.reproduction.rigid import IMPACTS
from vibroimpact.reproduction.row import Account, Row
from vibroimpact.reproduction.runs import Runs
from vibroimpact.reproduction.sampling import error_range, found_spacing
from vibroimpact.reproduction.section import Section

COLUMNS = {"compression": "max_indentation_m", "force": "max_force_N"}
"""What Table 2 compares, and the column of the impact table that has it."""


def exact_errors(runs: Runs, quantity: str, damping: str) -> list[float]:
    """Return by how much "compression" or "force" of "constant" or "variable" damping differs from the theory's [%], by impact."""
    column = COLUMNS[quantity]
    simulation, theory = (runs.response(f"type1-{name}").impacts[column] for name in (damping, "theory"))
    return [100.0 * abs(1.0 - float(ours / theirs)) for ours, theirs in zip(simulation, theory, strict=True)]


def table2(runs: Runs) -> Section:
    """Return Table 2 beside the exact errors, and beside what is read off samples."""
    spacing = found_spacing(runs)
    rows = []
    for quantity in COLUMNS:
        for damping in ("constant", "variable"):
            for impact, exact in zip(IMPACTS, exact_errors(runs, quantity, damping), strict=True):
                low, high = _magnitudes(*error_range(runs, spacing, quantity, damping, impact))
                reason = f"peaks read off samples {1e6 * spacing:.0f} µs apart give {low:.2f} to {high:.2f} %"
                value = printed(f"table2.{quantity}.{damping}.{impact}")
                rows.append(Row(value, exact, by=f"IMPACT, {damping} damping", accounts=(Account(reason, low, high),)))
    worst = max((printed(f"table2.compression.variable.{impact}") for impact in IMPACTS), key=lambda value: value.value)
    rows.append(
        Row(printed("worst_compression.variable"), worst.value, by="Table 2", otherwise=f"Table 2 and conclusion (1) have {worst.text} %")
    )
    return Section(
        "Table 2: errors of the simulations",
        (
            "Computed are the differences of the exact peaks. The printed ones scatter about them because they were read off samples. "
            "For a single value that is a weak test, as the ranges show; the forensic section has the strong one, of all values together.",
        ),
        tuple(rows),
    )


def _magnitudes(low: float, high: float) -> tuple[float, float]:
    """Return the range of the magnitudes of a range: the paper prints errors without their sign."""
    return (0.0 if low < 0.0 < high else min(abs(low), abs(high))), max(abs(low), abs(high))
