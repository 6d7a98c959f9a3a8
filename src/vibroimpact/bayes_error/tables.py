"""Sentences and tables of a bound, for its page and for the terminal."""

from __future__ import annotations

import numpy as np

from vibroimpact.bayes_error.bound import PROPERTIES, Bound
from vibroimpact.bayes_error.error_estimate import BayesError
from vibroimpact.bayes_error.observations import OBSERVATIONS
from vibroimpact.units.display import MISSING

_FEW = 5.0
"""Median number of neighbours below which more falls would narrow a bracket."""
_COARSE = 0.02
"""Standard error from which on an error has no decimals."""
_LEAST = 300
"""Number of falls below which none wrong among them is said to be compatible with an
error of 3 over their number (95 %) or less.
"""


def error_words(error: BayesError) -> str:
    """Return the bracket of a Bayes error in per cent, without tenths if few falls tell it.

    Examples
    --------
    >>> (
    ...     error_words(BayesError(0.0044, 0.0101, 0.002, 20.0)),
    ...     error_words(BayesError(0.0, 0.004, 0.002, 1.0)),
    ... )
    ('0.4 to 1.0 %', 'at most 0.4 %')
    >>> error_words(BayesError(0.21, 0.24, 0.043, 20.0))
    '21 to 24 %'
    """
    decimals = 1 if error.standard_error < _COARSE else 0
    low, high = f"{100.0 * error.lower:.{decimals}f}", f"{100.0 * error.upper:.{decimals}f}"
    if error.neighbours < _FEW:
        return f"at most {high} %"
    return f"{high} %" if low == high else f"{low} to {high} %"


def headline(bound: Bound) -> str:
    """Return the finding in a sentence."""
    time, impact = bound.errors["contact time"], bound.errors["one impact"]
    number = len(bound.falls)
    # so large an error leaves all of them right once in twenty times
    most = 100.0 * (1.0 - 0.05 ** (1.0 / number))
    few = (
        f" {number:,} falls are few: even an error of 0 may in truth be up to {most:.1f} % (95 %)."
        if number < _LEAST
        else ""
    )
    names = np.unique(bound.falls.classes).tolist()
    frequent = "more" if len(names) == 2 else "most"
    return (
        f"For {len(bound.falls):,} falls of {' and '.join(names)}, the lowest error of a "
        "classifier that sees only the contact time is "
        f"{error_words(time)}, and that of one that sees only impulse and contact time of "
        "one impact at a known position "
        f"{error_words(impact)}; always naming the {frequent} frequent class has an error "
        f"of {100.0 * bound.majority:.1f} %.{few}"
    )


def scatter_words(bound: Bound) -> str:
    """Return the share of the assumed scatter of the amplitude in the error, and for whom
    the bound holds, in sentences.
    """
    one = bound.channel
    far = "one impact, place unknown"
    return (
        f"The scatter of the amplitude is assumed, {100.0 * one.gain:g} % of the "
        f"sensitivity and {100.0 * one.place:g} % where the "
        f"position is unknown: with it the lowest error from {far}, is "
        f"{error_words(bound.errors[far])}, and without it "
        f"{error_words(bound.without_scatter[far])}. Each error holds for classifiers that "
        "see only the quantities named, with this "
        "scatter. A signal contains more, such as the position of the impact, the shape of "
        "the pulse and further impacts; a classifier "
        "that uses it can have a lower error."
    )


def heard_words(bound: Bound) -> str:
    """Return the measuring channel, and how falls and bounces were computed, in sentences."""
    one = bound.channel
    rigid = " The falls are computed on the plate as a rigid body." if bound.on_rigid_plate else ""
    return (
        f"Measured up to {one.bandwidth / 1e3:g} kHz, with the peak force of the median "
        f"fall {one.signal_to_noise:g} dB above the noise in "
        f"10 kHz. Assumed relative standard deviations: sensitivity {100.0 * one.gain:g} "
        "%, amplitude at an unknown position "
        f"{100.0 * one.place:g} %, speed where it is measured {100.0 * one.height:g} %, "
        f"radius where it is measured {100.0 * one.size:g} "
        f"%, time to the next impact {100.0 * one.interval:g} %, which is that of a bounce "
        f"on a level plate in standard gravity.{rigid}"
    )


def sampling_words(bound: Bound) -> str:
    """Return the largest standard error of the upper bounds, in a sentence."""
    most = max(error.standard_error for error in bound.errors.values())
    return (
        f"The upper bounds have standard errors of up to {100.0 * most:.1f} %, from the number "
        "of falls tested."
    )


def error_rows(bound: Bound) -> list[list[str]]:
    """Return a row for each observation: name, error with and without assumed scatter,
    and what remains of each property.
    """
    return [
        [
            one.name,
            error_words(bound.errors[one.name]),
            error_words(bound.without_scatter[one.name]),
            *(_part(value) for value in bound.remaining[one.name]),
        ]
        for one in OBSERVATIONS
    ]


HEADERS = [
    "Measured",
    "Classification error",
    "Without scatter",
    *(f"{name}, remaining" for name in PROPERTIES),
]
"""Headers of these rows."""


def bound_rows(bound: Bound) -> list[dict[str, str | float]]:
    """Return the rows of `bound.csv`."""
    return [
        {
            "measured": one.name,
            "meaning": one.meaning,
            "error_lower": bound.errors[one.name].lower,
            "error_upper": bound.errors[one.name].upper,
            "standard_error": bound.errors[one.name].standard_error,
            "neighbours": bound.errors[one.name].neighbours,
            **{
                f"{name}_remaining": float(value)
                for name, value in zip(PROPERTIES, bound.remaining[one.name], strict=True)
            },
            "error_lower_without_scatter": bound.without_scatter[one.name].lower,
            "error_upper_without_scatter": bound.without_scatter[one.name].upper,
        }
        for one in OBSERVATIONS
    ]


def _part(value: float) -> str:
    return f"{100.0 * value:.0f} %" if np.isfinite(value) else MISSING
