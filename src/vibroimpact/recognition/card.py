"""The card of a saved model: what it must hold, of which types and sizes."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from math import isfinite
from typing import Any

from vibroimpact.errors import InputError
from vibroimpact.files.check_sums import CHECK_SUMS
from vibroimpact.files.reading import FileKind
from vibroimpact.quoting import quoted
from vibroimpact.recognition.labelled_signals import GROUPS

FORMAT = "vibroimpact model 1"
CARD_FILE = FileKind(
    "a card is a table in JSON of some kilobytes", 20_000_000, "larger cards are not read"
)
"""Requirements on a card."""

MOST_CLASSES = 100
MOST_FEATURES = 20_000
_MOST_DRAWS = 100_000
_MOST_SAMPLES = 2**40
_LONGEST = 200

_NAMES = "a list of different names"


def check_card(card: Mapping[str, Any], graph: str) -> None:
    """Check what a card holds.

    Parameters
    ----------
    card : mapping
        The content of `card.json`.
    graph : str
        Name of the file of the graph, whose checksum the card must hold.

    Raises
    ------
    InputError
        If something is missing, or not of the type and size that it must be; the message does not
        name the file.
    """
    _check_format(card)
    for key, (fits, what) in _KINDS.items():
        if key not in card:
            raise InputError(f"the card has no {key}; train the model anew")
        if not fits(card[key]):
            raise _wrong(key, card[key], what)
    for sensor, facts in card["sensors"].items():
        for key, (fits, what) in _SENSOR_KINDS.items():
            if not fits(facts.get(key)):
                raise _wrong(f"sensors.{sensor}.{key}", facts.get(key), what)
    for name in card["classes"]:
        _check_rates(name, card["confusion"].get(name))
    if not _is_text(card[CHECK_SUMS].get(graph)):
        raise InputError(f"the card has no check sum of {graph}; train the model anew")


def _check_format(card: Mapping[str, Any]) -> None:
    form = card.get("format")
    if form is None:
        raise InputError("the card has no format; train the model anew")
    if form != FORMAT:
        by = ""
        if "version" in card:
            by = f" by vibroimpact {quoted(card['version']).strip(chr(34))}"
        raise InputError(
            f"the model was saved in the format {quoted(form)}{by}; this version reads "
            f'"{FORMAT}": train it anew'
        )


def _check_rates(name: str, rates: Any) -> None:
    """Check how often impacts of a class, and of others, are taken for that class: one
    number a draw.
    """
    if not isinstance(rates, dict):
        rates = {}
    lengths = set()
    for key in ("true_rate", "false_rate"):
        values = rates.get(key)
        if not (
            isinstance(values, list)
            and 1 <= len(values) <= _MOST_DRAWS
            and all(map(_is_part, values))
        ):
            raise _wrong(f"confusion.{name}.{key}", values, "a list of numbers from 0 to 1")
        lengths.add(len(values))
    if len(lengths) > 1:
        raise InputError(
            f"confusion.{name} of the card has lists of different lengths; train the model anew"
        )


def _wrong(key: str, value: Any, what: str) -> InputError:
    return InputError(
        f"{quoted(key).strip(chr(34))} of the card is {quoted(value)}; it must be {what}"
    )


def _is_number(value: Any) -> bool:
    return type(value) in (int, float) and abs(value) < 1e300 and isfinite(value)


def _is_part(value: Any) -> bool:
    return _is_number(value) and 0.0 <= value <= 1.0


def _is_text(value: Any) -> bool:
    return isinstance(value, str) and len(value) <= _LONGEST and value.isprintable()


def _is_count(value: Any) -> bool:
    return type(value) is int and 0 < value <= _MOST_SAMPLES


def _are_names(least: int, most: int) -> Callable[[Any], bool]:
    def fits(value: Any) -> bool:
        is_list = isinstance(value, list) and least <= len(value) <= most
        return (
            is_list
            and all(_is_text(name) and name for name in value)
            and len(set(value)) == len(value)
        )

    return fits


def _is_table(value: Any) -> bool:
    return isinstance(value, dict)


_KINDS: dict[str, tuple[Callable[[Any], bool], str]] = {
    "version": (_is_text, "a short text"),
    "classifier": (_is_text, "a short text"),
    "classes": (_are_names(2, MOST_CLASSES), f"{_NAMES}, from 2 to {MOST_CLASSES}"),
    "features": (_are_names(1, MOST_FEATURES), f"{_NAMES}, from 1 to {MOST_FEATURES}"),
    "sensors": (
        lambda value: _is_table(value) and all(map(_is_table, value.values())) and len(value) > 0,
        "a table with a table for each sensor",
    ),
    "group": (lambda value: value in GROUPS, f"one of {', '.join(GROUPS)}"),
    "data": (
        lambda value: _is_table(value) and _is_text(value.get("sha256")),
        "a table with the text sha256",
    ),
    "confusion": (_is_table, "a table with a table for each class"),
    CHECK_SUMS: (_is_table, "a table with the check sum of each file"),
}
_SENSOR_KINDS: dict[str, tuple[Callable[[Any], bool], str]] = {
    "rate_Hz": (lambda value: _is_number(value) and value > 0.0, "a number greater than 0"),
    "unit": (_is_text, "a short text"),
    "samples": (_is_count, "a whole number greater than 0"),
}
