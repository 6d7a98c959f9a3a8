"""Multiples of the units that a study sweeps over; those of results are in `vibroimpact.quantity`."""

from __future__ import annotations

from numpy.typing import ArrayLike

from vibroimpact.quantity import Multiple, digits, largest, multiple

_AS_RESULTS = {"": "1", "m/s^2": "m/s2"}
"""Units of a case, as results have them."""

_KNOWN = ("m", "s", "m/s", "m/s2", "N", "J", "1")
_PREFIXED = ("Pa", "Hz", "N/m", "N s/m", "kg")
_PREFIXES = (("G", 1e9), ("M", 1e6), ("k", 1e3), ("", 1.0))


def study_multiple(unit: str, values: ArrayLike) -> Multiple:
    """Return the multiple of a unit in which values are read easily; the unit itself where none is in use.

    Examples
    --------
    >>> study_multiple("Pa", [1.1e9, 3.9e9]), study_multiple("m/s^2", [9.8]), study_multiple("kg/m^3", [7850.0]).unit
    (Multiple(unit='GPa', size=1000000000.0), Multiple(unit='m/s²', size=1.0), 'kg/m³')
    """
    unit = _AS_RESULTS.get(unit, unit)
    if unit in _KNOWN:
        return multiple(unit, values)
    written = unit.replace("^1.5", "^{1.5}").replace("^2", "²").replace("^3", "³").replace("^{1.5}", "^1.5")
    if unit in _PREFIXED and unit != "kg":
        size = largest(values)
        prefix, factor = next((one for one in _PREFIXES if size >= 0.9995 * one[1]), _PREFIXES[-1])
        return Multiple(f"{prefix}{written}", factor)
    if unit == "kg" and 0.0 < largest(values) < 0.9995:
        return Multiple("g", 1e-3)
    return Multiple(written, 1.0)


def with_unit(name: str, unit: str) -> str:
    """Return a label: a name, and its unit in brackets where it has one."""
    return f"{name} [{unit}]" if unit else name


def study_text(value: float, unit: str, significant: int = 4) -> str:
    """Return a value [SI] in a multiple of its unit, with that behind it.

    Examples
    --------
    >>> study_text(2.26e9, "Pa").replace("\u00a0", " ")
    '2.260 GPa'
    """
    scale = study_multiple(unit, value)
    return f"{digits(value / scale.size, significant)}\u00a0{scale.unit}".rstrip("\u00a0")
