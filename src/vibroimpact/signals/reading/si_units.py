"""Units of signals in SI."""

from __future__ import annotations

import re
from functools import lru_cache

from vibroimpact.errors import InputError
from vibroimpact.shown import shown
from vibroimpact.units.reading import to_si

_QUANTITIES = {"V": "V", "m/s^2": "m/s2", "m/s": "m/s", "m": "m", "Pa": "Pa", "N": "N", "A": "A"}
"""What a signal can be: its SI unit as it is read, and as a record has it."""

_PLAIN = {"": 1.0, "1": 1.0, "-": 1.0, "NONE": 1.0, "strain": 1.0, "m/m": 1.0, "um/m": 1e-6, "microstrain": 1e-6, "%": 1e-2}
_POWER = re.compile(r"(?<=[A-Za-z])\^?(-?\d+)")


@lru_cache(maxsize=256)
def in_si(unit: str) -> tuple[float, str]:
    """Return the factor that converts a unit of a signal to SI, and the SI unit.

    Raises
    ------
    InputError
        If no signal has such a unit.

    Examples
    --------
    >>> in_si("mV"), in_si("m s-2"), in_si("um/m"), in_si("")
    ((0.001, 'V'), (1.0, 'm/s2'), (1e-06, '1'), (1.0, '1'))
    """
    if unit.strip() in _PLAIN:
        return _PLAIN[unit.strip()], "1"
    text = _POWER.sub(r"^\1", unit.strip())
    for quantity, name in _QUANTITIES.items():
        try:
            return to_si(f"1 {text}", quantity), name
        except InputError:
            continue
    known = ", ".join(_QUANTITIES.values())
    raise InputError(f"{shown(unit)} is no unit of a signal; known are {known} and their multiples, g, strain, and 1 for a plain number")
