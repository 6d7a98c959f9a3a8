"""A quantity over time that is compared with the paper, and the sentence that compares it."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from vibroimpact.dynamics.response import Response
from vibroimpact.paper.measures import Timeline
from vibroimpact.paper.printed import printed
from vibroimpact.paper.runs import TREATMENTS, Runs
from vibroimpact.units.display import digits, multiple


class ComparedQuantity(NamedTuple):
    """A quantity over time with a value to compare with the paper.

    Parameters
    ----------
    number : int
        Number of the figure in the paper.
    name, short, unit : str
        Name of the quantity, its axis label, and its SI unit.
    timeline : callable
        Function of a response that returns times and values.
    peak : str
        Description of the compared value.
    value : callable
        Function of a response that returns the compared value [SI].
    printed : str
        Name of the printed value, with {} for the type; "" if none is printed.
    signs : tuple of int
        Signs with which the printed value is marked.
    note : callable
        Function of the simulations that returns a further sentence of the caption.
    """

    number: int
    name: str
    short: str
    unit: str
    timeline: Timeline
    peak: str
    value: Callable[[Response], float]
    printed: str = ""
    signs: tuple[int, ...] = (1,)
    note: Callable[[Runs], str] = lambda runs: ""


def comparison_sentence(shown: ComparedQuantity, kinds: tuple[int, ...], runs: Runs) -> str:
    """Return the sentence that compares the values of each treatment with the printed ones, and
    names the nearest treatment.

    Parameters
    ----------
    shown : ComparedQuantity
        The quantity.
    kinds : tuple of int
        The types: 2 and 3, or 3 alone; the nearest treatment is chosen for the last.
    runs : Runs
        The simulations.
    """
    computed = {
        treatment: [shown.value(runs.treated(kind, treatment)) for kind in kinds]
        for treatment in TREATMENTS
    }
    printed_values = []
    if shown.printed:
        printed_values = [printed(shown.printed.format(kind)) for kind in kinds]
    wanted = [value.value for value in printed_values]
    scaled_by = [value for values in computed.values() for value in values]
    if not any(scaled_by):
        scaled_by = wanted
    scale = multiple(shown.unit, scaled_by)

    def listed(values: list[float]) -> str:
        return " and ".join(digits(value / scale.size) for value in values)

    has_types = len(kinds) > 1
    types = " (Types 2 and 3)" if has_types else ""
    of_type = " of Type 3" if has_types else ""
    of_treatments = ", ".join(f"{name} {listed(values)}" for name, values in computed.items())
    results = f"{shown.peak}{types}: {of_treatments} {scale.unit}"
    if not printed_values:
        return f"{results}; the paper prints none."
    paper = f"{listed(wanted)} {scale.unit}"
    if printed_values[-1].relation == "<":
        below = [name for name, values in computed.items() if np.all(np.array(values) < wanted)]
        return f"{results}; the paper states below {paper}, and {_bound_clause(below)}."
    differences = {name: values[-1] / wanted[-1] - 1.0 for name, values in computed.items()}
    nearest = min(differences, key=lambda name: abs(differences[name]))
    side = "above" if differences[nearest] > 0.0 else "below"
    difference = f"{digits(100.0 * abs(differences[nearest]), 2)} % {side} it"
    return (
        f"{results}; printed {paper}. Nearest to that{of_type} is the {nearest} treatment, "
        f"{difference}."
    )


def _bound_clause(names: list[str]) -> str:
    """Return the clause on the treatments that keep a printed bound."""
    if not names:
        return "none is"
    if len(names) == len(TREATMENTS):
        return "so are all"
    verb = "is" if len(names) == 1 else "are"
    return f"so {verb} the {' and the '.join(names)} treatment alone"
