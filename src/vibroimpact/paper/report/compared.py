"""A quantity over time of which the paper prints a value, and the sentence that sets what is computed beside it."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from vibroimpact.dynamics.response import Response
from vibroimpact.paper.measures import Timeline
from vibroimpact.paper.printed import printed
from vibroimpact.paper.runs import TREATMENTS, Runs
from vibroimpact.units.display import digits, multiple


class Compared(NamedTuple):
    """What a figure over time shows, and what the paper prints of it.

    Parameters
    ----------
    number : int
        The number that the figure has in the paper.
    name, short, unit : str
        The quantity, the label of its axis, and its SI unit.
    timeline : callable
        Its times and values.
    peak : str
        The value that is compared, in words.
    value : callable
        That value [SI].
    printed : str
        Its name among the printed values, with {} for the type; "" if none is printed.
    signs : tuple of int
        The sides of zero on which the printed value is marked.
    note : callable
        Says what else is to be seen.
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

    @property
    def heading(self) -> str:
        """The quantity, to begin a heading with."""
        return f"{self.name[0].upper()}{self.name[1:]}"


def beside_printed(shown: Compared, kinds: tuple[int, ...], runs: Runs) -> str:
    """Return what is computed in each treatment, beside what is printed, and which comes nearest.

    Parameters
    ----------
    shown : Compared
        What is compared.
    kinds : tuple of int
        The types: 2 and 3, or 3 alone; the nearest treatment is that of the last.
    runs : Runs
        The simulations.
    """
    computed = {treatment: [shown.value(runs.treated(kind, treatment)) for kind in kinds] for treatment in TREATMENTS}
    told = [printed(shown.printed.format(kind)) for kind in kinds] if shown.printed else []
    everything = [value for values in computed.values() for value in values]
    scale = multiple(shown.unit, everything if any(everything) else [one.value for one in told])

    def listed(values: list[float]) -> str:
        return " and ".join(digits(value / scale.size) for value in values)

    of = " (Types 2 and 3)" if len(kinds) > 1 else ""
    said = f"{shown.peak}{of}: " + ", ".join(f"{name} {listed(values)}" for name, values in computed.items()) + f" {scale.unit}"
    if not told:
        return f"{said}; the paper prints none."
    paper = f"{listed([one.value for one in told])} {scale.unit}"
    if told[-1].relation == "<":
        below = [name for name, values in computed.items() if np.all(np.array(values) < [one.value for one in told])]
        return f"{said}; the paper says below {paper}, and {_which(below)}."
    off = {name: values[-1] / told[-1].value - 1.0 for name, values in computed.items()}
    nearest = min(off, key=lambda name: abs(off[name]))
    side = "above" if off[nearest] > 0.0 else "below"
    far = f"{digits(100.0 * abs(off[nearest]), 2)} % {side} it"
    return f"{said}; printed {paper}. Nearest to that{' of Type 3' if of else ''} is the {nearest} treatment, {far}."


def _which(names: list[str]) -> str:
    """Say which treatments are as the paper says."""
    if len(names) in (0, len(TREATMENTS)):
        return "so are all" if names else "none is"
    return f"so {'is' if len(names) == 1 else 'are'} the {' and the '.join(names)} treatment alone"
