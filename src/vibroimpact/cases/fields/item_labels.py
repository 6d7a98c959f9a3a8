"""Labels of list items in messages: names or ordinals in place of indices counted from 0."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

NUMBER_LABELS: dict[str, tuple[str, ...]] = {
    "position": ("x", "y"),
    "size": ("length", "width", "thickness"),
}
"""Labels of the numbers of a list, such as in "drop.position.x"."""

_LONGEST = 40  # characters of a name that serves as a label


def item_label(key: str, items: Sequence[Any], number: int) -> str:
    """Return the key of a list item with its name, such as sensors."a1", or with its ordinal.

    The only item of a list needs neither.

    Parameters
    ----------
    key : str
        Key of the list.
    items : sequence
        Items of the list.
    number : int
        Index of the item, from 0.

    Examples
    --------
    >>> (
    ...     item_label("sensors", [{"name": "a1"}, {"rate": 5e4}], 0),
    ...     item_label("sensors", [{"name": "a1"}, {"rate": 5e4}], 1),
    ... )
    ('sensors."a1"', 'sensors (the 2nd)')
    >>> (
    ...     item_label("drop.position", [0.1, 0.0], 1),
    ...     item_label("plate.supports", [{"type": "point"}], 0),
    ... )
    ('drop.position.y', 'plate.supports')
    """
    item = items[number] if number < len(items) else None
    labels = NUMBER_LABELS.get(key.rpartition(".")[2], ())
    if isinstance(item, dict):
        name = item.get("name")
        names = [other.get("name") for other in items if isinstance(other, dict)]
        if _is_short_name(name) and names.count(name) == 1:
            return f'{key}."{name}"'
    elif number < len(labels):
        return f"{key}.{labels[number]}"
    if len(items) == 1:
        return key
    return f"{key} (the {ordinal(number + 1)})"


def _is_short_name(name: Any) -> bool:
    """Return whether a name fits into a message: a user may give anything."""
    return isinstance(name, str) and 0 < len(name) <= _LONGEST and name.isprintable()


def ordinal(number: int) -> str:
    """Return an ordinal number, such as "1st".

    Examples
    --------
    >>> [ordinal(number) for number in (1, 2, 3, 4, 11, 22, 113)]
    ['1st', '2nd', '3rd', '4th', '11th', '22nd', '113th']
    """
    ending = {1: "st", 2: "nd", 3: "rd"}.get(number % 10, "th")
    if 10 <= number % 100 <= 20:
        ending = "th"
    return f"{number}{ending}"


def path_in_words(path: str, table: Any) -> str:
    """Return a dotted key path in which the indices of list items are replaced by their labels.

    Parameters
    ----------
    path : str
        Path as pydantic gives it: "sensors.1.filter".
    table : any
        The case to which the path belongs.

    Examples
    --------
    >>> path_in_words("sensors.1.filter", {"sensors": [{"name": "a1"}, {"name": "b"}]})
    'sensors."b".filter'
    """
    label = ""
    value = table
    for part in path.split("."):
        if isinstance(value, (list, tuple)) and part.isdigit():
            index = int(part)
            label = item_label(label, value, index)
            value = value[index] if index < len(value) else None
        else:
            label = f"{label}.{part}" if label else part
            value = value.get(part) if isinstance(value, dict) else None
    return label
