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
    """A number of a case, or a list with one value per impact.

    It is given by its key in words, and the table and the name that hold it.
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
    >>> case = vi.case_of(
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
    sentences = []
    for checked, number, estimate in _checked_numbers(case):
        value = number.table[number.name]
        sentence, corrected = _assess(checked, estimate, number.key, number.table, value)
        if sentence and number.key not in aside:
            sentences.append(sentence)
        # later ranges are evaluated with the corrected value
        number.table[number.name] = corrected
    return sentences


def swept_slips(case: ResolvedCase, swept: Mapping[str, Any]) -> list[str]:
    """Return a sentence for each swept key with implausible values.

    It says how many there are, with an example, and the unit that was likely meant.

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
    sentences = []
    for checked, number, estimate in _checked_numbers(case, swept):
        key = number.key
        table = number.table
        values = swept.get(key)
        if values is not None and np.asarray(values).dtype.kind == "f":
            sentence, _ = _assess(checked, estimate, key, table, np.unique(values).tolist())
            if sentence:
                sentences.append(sentence)
        _, table[number.name] = _assess(checked, estimate, key, table, table[number.name])
    return sentences


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
            for number in _numbers_at(table, checked.key.split("."), ""):
                yield checked, number, HertzEstimate(table)


def _numbers_at(table: Any, path: Sequence[str], above: str) -> Iterator[_Number]:
    """Yield the numbers at a key path below a table."""
    part, *rest = path
    if part == "#":  # each item of a list
        items = table if isinstance(table, list) else []
        for number, item in enumerate(items):
            yield from _numbers_at(item, rest, item_label(above, items, number))
        return
    name: Any = None
    if isinstance(table, list):  # of numbers, which have labels such as "length"
        labels = next((labels for labels in NUMBER_LABELS.values() if part in labels), ())
        name = labels.index(part) if labels else None
    elif isinstance(table, dict) and part in table:
        name = part
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
    """Return the message for a value or a list of values, and the values with their corrections.

    The message is "" if they are plausible.
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
    numbers = given if isinstance(given, list) else [given]
    values = [float(number) for number in numbers]
    if not isinstance(table, Mapping):
        table = {}
    bounds = checked.rule(estimate, table)
    implausible = [
        value
        for value in values
        if value != 0.0 and (abs(value) < bounds.low or abs(value) > bounds.high)
    ]
    if not implausible:
        return "", given
    unit = checked.unit.replace("N/m^n", stiffness_unit(estimate.exponent))
    power = "" if estimate.exponent == 1.0 else f"^{estimate.exponent:g}"
    units = tuple(other.replace("^n", power) for other in checked.units)
    corrections = {value: _most_likely(abs(value), bounds, unit, units) for value in implausible}
    # one that a unit explains serves as the example
    example = next((value for value in implausible if corrections[value]), implausible[0])
    correction = corrections[example]
    if correction is None:
        remedy = _text(bounds.remedy, example)
    else:
        remedy = f'was {correction.text} meant? Write "{correction.text}"'
    if not remedy:
        return "", given
    is_too_small = abs(example) < bounds.low
    fault = _text(bounds.below if is_too_small else bounds.above, example)
    shown = f"{number_text(example)} {unit}"
    if len(values) == 1:
        sentence = f"{key}: {shown} {fault}; {remedy}"
    else:
        sentence = (
            f"{key}: {len(implausible)} of {len(values)} values, such as {shown}, which {fault}; "
            f"{remedy}"
        )
    corrected = []
    for value in values:
        correction = corrections.get(value)
        corrected.append(value if correction is None else correction.value)
    if not isinstance(given, list):
        return sentence, corrected[0]
    return sentence, corrected


def _most_likely(
    value: float, bounds: PlausibleRange, unit: str, units: tuple[str, ...]
) -> _Correction | None:
    """Return the most likely correction of an implausible value; None if no unit explains it."""
    sizes = {other: _si_factor(other, unit) for other in units}
    plausible = [
        correction
        for correction in _corrections(value, unit, sizes)
        if bounds.low <= correction.value <= bounds.high
    ]
    if bounds.reference is None:
        return plausible[0] if plausible else None
    # score: decades between corrected value and reference, plus half a decade for each step down
    # the order of likelihood; of equal scores the first one counts
    best: _Correction | None = None
    best_score = math.inf
    for rank, correction in enumerate(plausible):
        decades = abs(math.log10(correction.value / bounds.reference))
        score = decades + 0.5 * rank
        if decades <= math.log10(bounds.within) and score < best_score:
            best = correction
            best_score = score
    return best


def _text(phrase: Words, value: float) -> str:
    """Return a part of a message, which may be a function of the value."""
    if isinstance(phrase, str):
        return phrase
    return phrase(abs(value))


def _corrections(value: float, unit: str, sizes: Mapping[str, float]) -> Iterator[_Correction]:
    """Yield the possible corrections of a value.

    A unit was omitted, given in place of SI, or confused with another.
    """
    natural = sorted([(1.0, unit), *((size, other) for other, size in sizes.items())], reverse=True)

    def in_natural_unit(value: float) -> str:
        """Return a value in the largest unit in which it is not below one."""
        size, name = next((item for item in natural if value >= 0.999 * item[0]), natural[-1])
        return f"{number_text(value / size)} {name}"

    # the unit was omitted
    for other, size in sizes.items():
        text = f"{number_text(value)} {other}"
        if value >= _SHORT:
            text = in_natural_unit(value * size)
        yield _Correction(value * size, text)
    # a value in SI was given in another unit
    for size in sizes.values():
        meant = value / size
        text = f"{number_text(meant)} {unit}"
        if meant >= _SHORT and unit in _PREFIXED:
            text = in_natural_unit(meant)
        yield _Correction(meant, text)
    # two units were confused
    for size, other_size in permutations(sizes.values(), 2):
        meant = value * size / other_size
        yield _Correction(meant, in_natural_unit(meant))


@cache
def _si_factor(other: str, unit: str) -> float:
    """Return the conversion factor of a unit to the SI unit."""
    return to_si(f"1 {other}", unit)
