"""Units of signals in SI."""

from __future__ import annotations

from functools import lru_cache

from vibroimpact.errors import InputError
from vibroimpact.quoting import quoted
from vibroimpact.units.reading import to_si
from vibroimpact.units.spelling import plain_factor

_QUANTITIES = {"V": "V", "m/s^2": "m/s2", "m/s": "m/s", "m": "m", "Pa": "Pa", "N": "N", "A": "A"}
"""What a signal can be: its SI unit as it is read, and as a record has it."""


@lru_cache(maxsize=256)
def in_si(unit: str) -> tuple[float, str]:
    """Return the factor that converts a unit of a signal to SI, and the SI unit.

    Raises
    ------
    InputError
        If no signal has such a unit.

    Examples
    --------
    >>> in_si("mV"), in_si("m·s⁻²"), in_si("µm/m"), in_si("a.u.")
    ((0.001, 'V'), (1.0, 'm/s2'), (1e-06, '1'), (1.0, '1'))
    """
    plain = plain_factor(unit)
    if plain is not None:
        return plain, "1"
    for quantity, name in _QUANTITIES.items():
        try:
            return to_si(f"1 {unit}", quantity), name
        except InputError:
            continue
    known = ", ".join(_QUANTITIES.values())
    raise InputError(
        f"{quoted(unit)} is no unit of a signal; known are {known} and their multiples, g, "
        "strain, and 1 or a.u. for a plain number"
    )
