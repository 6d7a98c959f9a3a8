"""Amplitudes of grains that strike the shipped river plate."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np

import vibroimpact as vi
from vibroimpact.cases.reader import load_table

PLACES = ((0.03, 0.02), (0.1, 0.05), (-0.15, 0.1), (0.05, -0.12), (0.2, 0.0), (-0.08, -0.06))


def class_limit(diameter: float) -> float:
    """Return the amplitude [V] above which a grain is counted as of at least a diameter
    [mm]: Wyss and others 2016.
    """
    return 4.6e-4 * diameter**1.71


@cache
def amplitudes(
    diameter: float, speed: float = 1.0, yield_strength: float | None = None
) -> np.ndarray:
    """Return the largest voltage of the geophone for impacts of a grain [mm] at six
    places [V]; with a strength [Pa] the contact yields.
    """
    table: dict[str, Any] = load_table("signals:river-plate")
    del table["sweep"], table["sensors"][0]["amplifier"]
    table["drop"], table["run"] = {"speed": speed}, {"duration": 0.06}
    table["plate"]["damping"] = 0.03
    table["sphere"]["radius"] = 0.5e-3 * diameter
    if yield_strength is not None:
        table["contact"] = {"law": "meyer", "yield_strength": yield_strength}
    found = []
    for place in PLACES:
        table["drop"]["position"] = list(place)
        found.append(vi.simulate(vi.case_of(table)).signals()["geophone"].largest)
    return np.array(found)
