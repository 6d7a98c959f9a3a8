"""The energy ledger of a run at its end."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from vibroimpact.arrays import Bools, Floats

CLOSURE_LIMIT = 1e-6
"""Largest closure error of the ledger, as a part of the energy put in, above which a run
has failed.
"""

CLOSURE_USUAL = 1e-9
"""Part of the energy put in below which the closure error of runs at the default
tolerance is: rounding, which machines differ in.
"""

WRITE_OFF_LIMIT = 1e-9
"""Largest negative energy written off at rest, as a part of the energy put in, that
counts as rounding.
"""


def close_ledger(energy_in: Floats, added: Floats, entries: dict[str, Floats]) -> dict[str, Floats]:
    """Return the energy ledger [J] with input and closure error.

    Parameters
    ----------
    energy_in : array, shape (B,)
        Kinetic and potential energy at the start [J].
    added : array, shape (B,)
        Work of gravity and adhesion within the indentation, and of gravity down the plate [J]; in a
        soft touch more than `energy_in`.
    entries : dict of str to array
        The entries of the ledger at the end [J].

    Returns
    -------
    dict of str to array
        `input_J`, the entries, `closure_J` (entries less input) and `closure_relative`, its part of
        the energy put in by the drop, by gravity and by adhesion.
    """
    closure = sum(entries.values(), -energy_in)
    relative = np.abs(closure) / (energy_in + added)
    return {"input_J": energy_in, **entries, "closure_J": closure, "closure_relative": relative}


def ledger_holds(energy: Mapping[str, Floats], added: Floats) -> Bools:
    """Return whether a ledger closes, and no more was written off at rest than was there.

    Parameters
    ----------
    energy : mapping of str to array
        The ledger, as `close_ledger` returns it [J].
    added : array, shape (B,)
        As `close_ledger` takes it [J].
    """
    closes = energy["closure_relative"] <= CLOSURE_LIMIT
    least = -WRITE_OFF_LIMIT * (energy["input_J"] + added)
    return np.asarray(closes & (energy["written_off_at_rest_J"] >= least))


def closure_in_words(relative: float) -> str:
    """Return the closure error of the ledger as it is printed.

    It is a bound of rounding, which is the same on every machine, or its size.

    Examples
    --------
    >>> closure_in_words(7.3e-13)
    'closure below 1e-9 of the energy put in'
    >>> closure_in_words(2.6e-8)
    'closure 3e-8 of the energy put in'
    """
    is_usual = relative < CLOSURE_USUAL
    mantissa, _, exponent = f"{CLOSURE_USUAL if is_usual else relative:.0e}".partition("e")
    below = "below " if is_usual else ""
    return f"closure {below}{mantissa}e{int(exponent)} of the energy put in"


def why_failed(energy: Mapping[str, Any]) -> str:
    """Return the reason why the run of one drop failed, from its ledger.

    Examples
    --------
    >>> why_failed({"closure_relative": 0.0, "written_off_at_rest_J": 0.0, "input_J": 1.0})[:53]
    'the contact could not be integrated to the tolerance;'
    """
    closure_relative = float(energy["closure_relative"])
    written_off = float(energy["written_off_at_rest_J"])
    if written_off < -WRITE_OFF_LIMIT * float(energy["input_J"]):
        return (
            f"the sphere was set to rest with {-written_off:.3g} J more than it and the bodies "
            "below it had left."
        )
    if closure_relative > CLOSURE_LIMIT:
        return (
            f"the energy ledger does not close: it is off by {closure_relative:.2g} of the "
            f"energy put in (limit {CLOSURE_LIMIT:g})."
        )
    return (
        "the contact could not be integrated to the tolerance; try a larger tolerance "
        "(run.tolerance, up to 1e-6), and see what "
        "`vibroimpact check` warns of: a plate that deflects by many times its thickness is "
        "beyond the theory."
    )
