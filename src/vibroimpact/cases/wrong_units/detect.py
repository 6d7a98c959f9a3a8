"""Detection of slips of units in a case or a study, with the unit that was likely meant."""

from __future__ import annotations

import copy
import math
from collections.abc import Container, Iterator, Mapping, MutableMapping, Sequence
from functools import cache
from itertools import permutations
from typing import Any, NamedTuple

import numpy as np

from vibroimpact.cases.fields.item_labels import NUMBER_LABELS, item_label
from vibroimpact.cases.wrong_units.hertz_estimate import HertzEstimate
from vibroimpact.cases.wrong_units.plausible import CheckedKey, PlausibleRange, Words, number_text
from vibroimpact.cases.wrong_units.rules import stiffness_unit
from vibroimpact.cases.wrong_units.table import CHECKED_KEYS
from vibroimpact.errors import InputError
from vibroimpact.resolved_case import ResolvedCase
from vibroimpact.units.reading import to_si

_SHORT = 1e6  # numbers below it are written without an exponent
_PREFIXED = ("Pa", "N", "Hz")  # large values of these units are written with k, M or G


class _Number(NamedTuple):
    """A number of a case, or a list with one value per impact: its key in words, and the
    table and the name that hold it.
    """

    key: str
    table: MutableMapping[Any, Any]
    name: Any


class _Correction(NamedTuple):
    """A possible correction of a value: the corrected value [SI] and its text with a unit."""

    value: float
    text: str


def slips(case: ResolvedCase, aside: Container[str] = ()) -> list[str]:
    """Return a sentence for each implausible value of a case, with the unit that was likely meant.

    Parameters
    ----------
    case : mapping
        A resolved case, in SI.
    aside : container of str
        Dotted keys that are not reported.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> from vibroimpact.cases.build import resolved_case
    >>> case = vi.read_case(
    ...     {
    ...         "sphere": {"radius": 25, "material": "granite"},
    ...         "plate": {"material": "steel"},
    ...         "drop": {"speed": 1.0},
    ...         "contact": {"law": "hertz"},
    ...     }
    ... )
    >>> slips(resolved_case(case))
    ['sphere.radius: 25 m is very large for a sphere; was 25 mm meant? Write "25 mm"']
    """
    found = []
    for checked, at, estimate in _checked_numbers(case):
        said, meant = _assess(checked, estimate, at.key, at.table, at.table[at.name])
        if said and at.key not in aside:
            found.append(said)
        at.table[at.name] = meant  # later ranges are evaluated with the corrected value
    return found


def swept_slips(case: ResolvedCase, swept: Mapping[str, Any]) -> list[str]:
    """Return a sentence for each swept key with implausible values: how many, an example, and the
    unit that was likely meant.

    Parameters
    ----------
    case : mapping
        The resolved case at the first point.
    swept : mapping of str to array
        Values of each swept key in SI.

    Examples
    --------
    >>> import numpy as np, vibroimpact as vi
    >>> from vibroimpact.cases.build import resolved_case
    >>> case = resolved_case(vi.load_case("paper:type1-theory"))
    >>> swept_slips(case, {"sphere.radius": np.array([0.005, 10.0, 25.0])})
    ['sphere.radius: 2 of 3 values, such as 10 m, which is very large for a sphere; was 10 mm meant?
    Write "10 mm"']
    """
    found = []
    for checked, at, estimate in _checked_numbers(case, swept):
        values = swept.get(at.key)
        if values is not None and np.asarray(values).dtype.kind == "f":
            said, _ = _assess(checked, estimate, at.key, at.table, np.unique(values).tolist())
            found += [said] if said else []
        at.table[at.name] = _assess(checked, estimate, at.key, at.table, at.table[at.name])[1]
    return found


def _checked_numbers(
    case: ResolvedCase, swept: Container[str] = ()
) -> Iterator[tuple[CheckedKey, _Number, HertzEstimate]]:
    """Yield the checked numbers that a case contains, each with an estimate of the case.

    The caller may correct a number in its table; the following estimates then use the corrected
    value. Parameters of the law that are derived from the bodies are left out, unless they are
    swept.
    """
    table = copy.deepcopy(case)
    with np.errstate(all="ignore"):
        derived = HertzEstimate(case).derived_parameters
    table["contact"] = {
        key: value
        for key, value in table["contact"].items()
        if f"contact.{key}" in swept or key not in derived
    }
    with np.errstate(all="ignore"):
        for checked in CHECKED_KEYS:
            for at in _numbers_at(table, checked.key.split("."), ""):
                yield checked, at, HertzEstimate(table)


def _numbers_at(table: Any, path: Sequence[str], above: str) -> Iterator[_Number]:
    """Yield the numbers at a key path below a table."""
    part, *rest = path
    if part == "#":
        for count, one in enumerate(table if isinstance(table, list) else ()):
            yield from _numbers_at(one, rest, item_label(above, table, count))
        return
    if isinstance(table, list):
        name: Any = next(
            (names.index(part) for names in NUMBER_LABELS.values() if part in names), None
        )
    else:
        name = part if isinstance(table, dict) and part in table else None
    if name is None:
        return
    key = f"{above}.{part}" if above else part
    if rest:
        yield from _numbers_at(table[name], rest, key)
    elif isinstance(table[name], (int, float, list)):
        yield _Number(key, table, name)


def _assess(
    checked: CheckedKey, estimate: HertzEstimate, key: str, table: Mapping[Any, Any], given: Any
) -> tuple[str, Any]:
    """Return the message for a value or a list of values, "" if plausible; and the values
    with their corrections.
    """
    try:
        return _assess_values(checked, estimate, key, table, given)
    except (ArithmeticError, InputError):
        # extreme values for which no range or unit exists, such as N/m^1e-200
        return "", given


def _assess_values(
    checked: CheckedKey, estimate: HertzEstimate, key: str, table: Mapping[Any, Any], given: Any
) -> tuple[str, Any]:
    """Return what `_assess` returns, without its protection against extreme values."""
    values = [float(one) for one in given] if isinstance(given, list) else [float(given)]
    bounds = checked.rule(estimate, table if isinstance(table, Mapping) else {})
    strange = [
        value
        for value in values
        if value != 0.0 and (abs(value) < bounds.low or abs(value) > bounds.high)
    ]
    if not strange:
        return "", given
    unit = checked.unit.replace("N/m^n", stiffness_unit(estimate.exponent))
    units = tuple(
        one.replace("^n", f"^{estimate.exponent:g}")
        if estimate.exponent != 1.0
        else one.replace("^n", "")
        for one in checked.units
    )
    meant = {value: _most_likely(abs(value), bounds, unit, units) for value in strange}
    first = next((value for value in strange if meant[value] is not None), strange[0])
    likely = meant[first]
    remedy = (
        _text(bounds.remedy, first)
        if likely is None
        else f'was {likely.text} meant? Write "{likely.text}"'
    )
    if not remedy:
        return "", given
    words = _text(bounds.below if abs(first) < bounds.low else bounds.above, first)
    shown = f"{number_text(first)} {unit}"
    many = (
        f"{shown} {words}"
        if len(values) == 1
        else f"{len(strange)} of {len(values)} values, such as {shown}, which {words}"
    )
    repaired = [value if (one := meant.get(value)) is None else one.value for value in values]
    return f"{key}: {many}; {remedy}", repaired if isinstance(given, list) else repaired[0]


def _most_likely(
    value: float, bounds: PlausibleRange, unit: str, units: tuple[str, ...]
) -> _Correction | None:
    """Return the most likely correction of an implausible value; None if no unit explains it."""
    sizes = {one: _si_factor(one, unit) for one in units}
    likely = [
        one for one in _corrections(value, unit, sizes) if bounds.low <= one.value <= bounds.high
    ]
    if bounds.reference is None:
        return likely[0] if likely else None
    near = math.log10(bounds.within)
    # score: decades between corrected value and reference, plus half a decade for each step down
    # the order of likelihood
    scored = [
        (abs(math.log10(one.value / bounds.reference)), 0.5 * place, place, one)
        for place, one in enumerate(likely)
    ]
    return min(
        ((off + rare, place, one) for off, rare, place, one in scored if off <= near),
        default=(0.0, 0, None),
    )[2]


def _text(words: Words, value: float) -> str:
    return words if isinstance(words, str) else words(abs(value))


def _corrections(value: float, unit: str, sizes: Mapping[str, float]) -> Iterator[_Correction]:
    """Yield the possible corrections of a value: a unit was omitted, given in place of
    SI, or confused with another.
    """
    natural = sorted([(1.0, unit), *((size, one) for one, size in sizes.items())], reverse=True)

    def written(meant: float) -> str:
        size, name = next(
            ((size, one) for size, one in natural if meant >= 0.999 * size), natural[-1]
        )
        return f"{number_text(meant / size)} {name}"

    for one, size in sizes.items():
        yield _Correction(
            value * size, f"{number_text(value)} {one}" if value < _SHORT else written(value * size)
        )
    for size in sizes.values():
        meant = value / size
        yield _Correction(
            meant,
            written(meant)
            if meant >= _SHORT and unit in _PREFIXED
            else f"{number_text(meant)} {unit}",
        )
    for size, other in permutations(sizes.values(), 2):
        yield _Correction(value * size / other, written(value * size / other))


@cache
def _si_factor(one: str, unit: str) -> float:
    """Return the conversion factor of a unit to the SI unit."""
    return to_si(f"1 {one}", unit)
