"""What the numbers and tables of lists in a case are called, so that nobody has to count from 0."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

NUMBER_LABELS: dict[str, tuple[str, ...]] = {"position": ("x", "y"), "size": ("length", "width", "thickness")}
"""What the numbers of a list are called, such as in "drop.position.x"."""

_LONGEST = 40  # of a name that is shown


def item_label(key: str, items: Sequence[Any], number: int) -> str:
    """Return the key of one of a list: by its name, such as sensors."a1", or by its place, counted from 1, if there are several.

    Parameters
    ----------
    key : str
        That of the list.
    items : sequence
        What is in it.
    number : int
        Which one is meant, from 0.

    Examples
    --------
    >>> item_label("sensors", [{"name": "a1"}, {"rate": 5e4}], 0), item_label("sensors", [{"name": "a1"}, {"rate": 5e4}], 1)
    ('sensors."a1"', 'sensors (the 2nd)')
    >>> item_label("drop.position", [0.1, 0.0], 1), item_label("plate.supports", [{"type": "point"}], 0)
    ('drop.position.y', 'plate.supports')
    """
    item = items[number] if number < len(items) else None
    names = NUMBER_LABELS.get(key.rpartition(".")[2], ())
    if not isinstance(item, dict) and number < len(names):
        return f"{key}.{names[number]}"
    name = item.get("name") if isinstance(item, dict) else None
    alone = isinstance(name, str) and name and sum(isinstance(one, dict) and one.get("name") == name for one in items) == 1
    if alone and len(str(name)) <= _LONGEST and str(name).isprintable():
        return f'{key}."{name}"'
    return key if len(items) == 1 else f"{key} (the {ordinal(number + 1)})"


def ordinal(number: int) -> str:
    """Return 1st, 2nd, 3rd, 4th, ... 11th, ...

    Examples
    --------
    >>> [ordinal(number) for number in (1, 2, 3, 4, 11, 22, 113)]
    ['1st', '2nd', '3rd', '4th', '11th', '22nd', '113th']
    """
    ending = "th" if 10 <= number % 100 <= 20 else {1: "st", 2: "nd", 3: "rd"}.get(number % 10, "th")
    return f"{number}{ending}"


def path_in_words(path: str, table: Any) -> str:
    """Return a dotted place in a case with lists' own names and places counted from 1, in place of numbers from 0.

    Parameters
    ----------
    path : str
        As pydantic gives it: "sensors.1.filter".
    table : any
        The case that it is a place in.

    Examples
    --------
    >>> path_in_words("sensors.1.filter", {"sensors": [{"name": "a1"}, {"name": "b"}]})
    'sensors."b".filter'
    """
    words, inside = "", table
    for part in path.split("."):
        if isinstance(inside, (list, tuple)) and part.isdigit():
            words = item_label(words, inside, int(part))
            inside = inside[int(part)] if int(part) < len(inside) else None
        else:
            words = f"{words}.{part}" if words else part
            inside = inside.get(part) if isinstance(inside, dict) else None
    return words
