"""How far modes left out may change a signal: what is told against runs with more modes,
whatever the filter and the rate.
"""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

import vibroimpact as vi
from support import plain_case

QUANTITIES, PLACES = (
    ("displacement", "velocity", "acceleration"),
    {"far": [0.08, 0.05], "near": [0.03, 0.0]},
)


@cache
def signals(modes: int, kind: str, rate: float) -> dict[str, vi.sensors.Signal]:
    """Signals of six sensors beside a contact of 0.08 ms, at the centre of a steel plate."""
    each = [
        {"name": f"{one} {name}", "quantity": one, "position": at}
        for one in QUANTITIES
        for name, at in PLACES.items()
    ]
    held = {
        "size": [0.3, 0.2, 0.01],
        "material": "steel",
        "model": "elastic",
        "supports": "simply-supported",
    }
    table = plain_case(
        sphere={"radius": 0.01, "material": "steel"},
        plate={**held, "modes": modes, "damping": 0.01},
        drop={"speed": 1.0},
        contact={"law": "tsuji", "restitution": 0.9},
        run={"duration": 0.004},
        sensors=[{"filter": kind, "rate": rate, **one} for one in each],
    )
    return dict(vi.simulate(vi.case_of(table)).signals())


@pytest.mark.parametrize(("kind", "rate"), [("none", 2e5), ("sigma-delta", 2e6)])
def test_neither_the_filter_nor_a_high_rate_makes_it_larger(kind: str, rate: float) -> None:
    """A part of the contact alone would end with a jump of the force: it told 0.7 of an
    unfiltered displacement in place of 0.0024.
    """
    usual, found = signals(60, "sigma-delta", 2e5), signals(60, kind, rate)
    for name, signal in found.items():
        assert 0.4 < signal.uncertainty / usual[name].uncertainty < 4.0, name


@pytest.mark.slow
@pytest.mark.parametrize(
    ("kind", "rate"), [("none", 2e5), ("sigma-delta", 2e5), ("sigma-delta", 1e6)]
)
def test_it_is_the_difference_to_many_more_modes(kind: str, rate: float) -> None:
    exact = signals(240, kind, rate)
    for name, signal in signals(80, kind, rate).items():
        off = np.linalg.norm(signal.value - exact[name].value) / np.linalg.norm(exact[name].value)
        assert 0.4 < signal.uncertainty / off < 6.0, name
