"""A value of Types 2 and 3 under each treatment of the local compliance, beside the printed one."""

from __future__ import annotations

from vibroimpact.paper.measures import Measure
from vibroimpact.paper.printed import Printed
from vibroimpact.paper.printed_and_computed import Account, Row
from vibroimpact.paper.runs import TREATMENTS, Runs

MESH_DIGITS = 5
"""How many digits of a value are shown that depends on a mesh."""

FITTED = ("type2.max_force", "type2.rebound_height")
"""What the identified treatment was fitted to."""


def rows_by_treatment(runs: Runs, kind: int, value: Printed, measure: Measure, unresolved: tuple[float, float] | None = None) -> list[Row]:
    """Return the rows of a value of Type 2 or 3, one a treatment.

    Parameters
    ----------
    runs : Runs
        The simulations.
    kind : int
        2 or 3.
    value : Printed
        What is printed.
    measure : callable
        Takes a response, and returns the value in the printed unit.
    unresolved : tuple of two floats, optional
        Between which an unresolved run of the superposed model gives it.
    """
    words = {
        "consistent": "elastic bodies under this contact law do otherwise, and no setting that was tried gives it",
        "superposed": "the superposed model, resolved, does otherwise, and no setting that was tried gives it",
        "identified": "a prediction from Type 2" if kind == 3 else "fitted to force and rebound alone",
    }
    if unresolved is not None:
        low, high = unresolved
        account = Account("", low, high)
        few = "touches these with its few digits" if account.holds(value) else "is not among these"
        inside = "is among these" if account.contains(value) else few
        steps = "in steps fitted to Type 2" if kind == 2 else "in steps found from Type 2"
        words["superposed"] += (
            f". A reading: unresolved, on a coarse mesh and {steps}, it gives {low:.4g} to {high:.4g} {value.unit}, and the printed value "
            f"{inside}"
        )
    return [
        Row(
            value,
            measure(runs.treated(kind, treatment)),
            by=treatment,
            otherwise=words[treatment],
            fitted=treatment == "identified" and value.name in FITTED,
            digits=MESH_DIGITS,
        )
        for treatment in TREATMENTS
    ]
