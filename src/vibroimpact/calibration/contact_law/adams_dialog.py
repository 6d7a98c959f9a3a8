"""Contacts of Adams' IMPACT as in the dialog of a contact in Adams View.

Units are newtons, millimetres and seconds.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from vibroimpact.calibration.contact_law.calibration import Calibration
from vibroimpact.contact.law import ContactLaw
from vibroimpact.contact.laws.adams_impact import AdamsImpact
from vibroimpact.report.report import Table, first_rows, table_of

_FIELDS = {
    "stiffness_N_mm_n": ("Stiffness", "N/mm^n"),
    "force_exponent": ("Force Exponent", ""),
    "damping_N_s_mm": ("Damping", "N s/mm"),
    "penetration_depth_mm": ("Penetration Depth", "mm"),
}
"""Label and unit of each field of the dialog, by its name in JSON."""

DIALOG_TITLE = "For the dialog of a contact in Adams View (Impact; newton, mm, s)"


def dialog_note(parameter: str) -> str:
    """Return a note on a dialog whose fields differ from impact to impact in a parameter.

    Examples
    --------
    >>> dialog_note("stiffness")
    'The dialog takes one stiffness for all impacts.'
    """
    if parameter == "damping_max":
        return (
            "The dialog takes one damping. For one that follows the speed, vibroimpact export "
            "--to adams writes a model."
        )
    return f"The dialog takes one {parameter} for all impacts."


def dialog_rows(laws: Iterable[ContactLaw]) -> list[dict[str, Any]]:
    """Return the fields of the dialog for the contact law of each impact.

    There is one row if all are equal, and none if a law is not IMPACT.

    Examples
    --------
    >>> (row,) = dialog_rows([AdamsImpact(stiffness=1e9, damping_max=150.0, exponent=1.0)])
    >>> row["stiffness_N_mm_n"], row["force_exponent"], row["damping_N_s_mm"]
    (1000000.0, 1.0, 0.15)
    """
    rows = []
    for law in laws:
        if not isinstance(law, AdamsImpact):
            return []
        exponent = float(law.exponent)
        rows.append(
            {
                "stiffness_N_mm_n": float(law.stiffness) / 1000.0**exponent,
                "force_exponent": exponent,
                "damping_N_s_mm": float(law.damping_max) / 1000.0,
                "penetration_depth_mm": 1000.0 * float(law.full_damping_penetration),
            }
        )
    if all(row == rows[0] for row in rows):
        return rows[:1]
    return rows


def calibrated_dialog(calibration: Calibration) -> list[dict[str, Any]]:
    """Return the fields of the dialog that match each impact.

    There are none if the tuned parameter is not one of IMPACT.
    """
    if "." in calibration.parameter:
        return []
    law = calibration.problem.laws[0]
    return dialog_rows(
        law.changed({calibration.parameter: value}) for value in calibration.values.tolist()
    )


def dialog_table(fields: Iterable[Mapping[str, Any]], names: Iterable[str]) -> Table:
    """Return the fields of the dialog as a table, whose rows have the names of the impacts.

    If there is one row, it is that of "every impact".

    Parameters
    ----------
    fields : iterable of mapping
        Fields of each impact, as `dialog_rows` returns them.
    names : iterable of str
        Names of the impacts.
    """
    impacts = list(fields)
    row_names = ["every impact"]
    if len(impacts) > 1:
        row_names = list(names)[: len(impacts)]
    rows = [
        [name, *(f"{impact[field]:.6g}" for field in _FIELDS)]
        for name, impact in zip(row_names, impacts, strict=True)
    ]
    return table_of([("", ""), *_FIELDS.values()], first_rows(rows), title=DIALOG_TITLE)
