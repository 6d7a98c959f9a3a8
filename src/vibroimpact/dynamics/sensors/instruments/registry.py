"""The registry of instruments: those of the files of `dynamics/sensors/instruments/`."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from typing import get_args

from vibroimpact.dynamics.sensors.instruments.instrument import InstrumentInCase, Quantity
from vibroimpact.registry import modules_in


@cache
def instruments() -> Mapping[str, type[InstrumentInCase]]:
    """Return what a case may say of each instrument, by the name of the instrument.

    Examples
    --------
    >>> list(instruments())
    ['accelerometer', 'geophone', 'strain-gauge', 'microphone', 'force']
    """
    kinds = [
        kind
        for module in modules_in("vibroimpact.dynamics.sensors.instruments")
        for kind in vars(module).values()
        if isinstance(kind, type)
        and issubclass(kind, InstrumentInCase)
        and kind.__module__ == module.__name__
        and hasattr(kind, "name")  # bases have none
    ]
    quantities = get_args(Quantity)
    kinds.sort(key=lambda kind: quantities.index(kind.measures))
    return {kind.name: kind for kind in kinds}
