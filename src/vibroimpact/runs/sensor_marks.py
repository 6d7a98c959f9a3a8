"""The sensors of a plate seen from above, with names that cover neither each other nor the ball."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from vibroimpact.charts.marks import Label, Line, Mark, Points
from vibroimpact.quoting import shortened, visible
from vibroimpact.results.result import Result
from vibroimpact.runs.supports import Extent, plate_extent

_MOST_NAMED = 12
"""Places of sensors that are named; the names of more would cover each other."""

_MOST_LETTERS = 20
_FEWEST_LETTERS = 8
"""Letters of a name: the most, and the fewest to which it is shortened."""

_ACROSS = 38
_SHAPE = 1.6
"""Letters that fit across a map in print, and its length over its width from which on a
map is narrower than its place.
"""

_LINE = 2.6
_BESIDE = 1.0
_ABOVE = 0.7
"""Height of a line of words, and their distance from their place, beside and above it [letters]."""

_DISTANCES = (1.5, 2.5, 3.5, 5.0, 7.0)
"""Distances of a name from its sensor where there is no room beside it [lines]."""

_ANGLES = np.radians([30.0, 150.0, -30.0, -150.0, 60.0, 120.0, -60.0, -120.0, 90.0, -90.0])


class _Box(NamedTuple):
    """A rectangle [m]."""

    left: float
    right: float
    low: float
    high: float

    def overlap(self, other: _Box) -> float:
        """Return the common area [m2]."""
        width = min(self.right, other.right) - max(self.left, other.left)
        height = min(self.high, other.high) - max(self.low, other.low)
        return max(width, 0.0) * max(height, 0.0)

    @property
    def area(self) -> float:
        """The area [m2]."""
        return (self.right - self.left) * (self.high - self.low)


class _Spot(NamedTuple):
    """Where a name may lie: a point, the side of the words where it lies, and their box."""

    x: float
    y: float
    anchor: str
    box: _Box


def sensor_marks(result: Result, ball: tuple[float, float, float]) -> tuple[Mark, ...]:
    """Return the sensors seen from above, with the names of those that stand apart; of
    many none.

    Parameters
    ----------
    result : Result
        The result.
    ball : tuple of three floats
        x, y and radius of the ball as it is drawn, which names do not cover [m].
    """
    placed = sensor_places(result)
    if not placed:
        return ()
    names, x, y = zip(*placed, strict=True)
    texts = tuple(shortened(visible(name), 60) for name in names)
    marks: list[Mark] = [Points(np.array(x), np.array(y), "sensor", "sensor", texts=texts)]
    together: dict[tuple[float, float], list[str]] = {}
    for name, *place in placed:
        together.setdefault((place[0], place[1]), []).append(name)
    if len(together) > _MOST_NAMED:
        return tuple(marks)
    words = {place: visible(", ".join(names)) for place, names in together.items()}
    extent = plate_extent(result)
    if extent is None:
        marks += [
            Label(*place, shortened(phrase, _MOST_LETTERS), "left")
            for place, phrase in words.items()
        ]
        return tuple(marks)
    return (*marks, *_names(words, extent, ball))


def _names(
    words: dict[tuple[float, float], str], extent: Extent, ball: tuple[float, float, float]
) -> list[Mark]:
    """Return names beside their places, or farther away with a line to them where there is no
    room.
    """
    (left, right), (front, back) = extent.x, extent.y
    letters = _ACROSS * min(1.0, _SHAPE * (right - left) / (back - front))
    letter = (right - left) / letters
    plate = _Box(left, right, front, back)
    taken = [_around(*place, _BESIDE * letter) for place in words]
    taken.append(_around(*ball[:2], max(ball[2], _BESIDE * letter)))
    marks: list[Mark] = []
    for (x, y), phrase in words.items():
        before = x - left
        after = right - x
        room = min(int(letters * max(before, after) / (right - left)) - 1, _MOST_LETTERS)
        if len(phrase) > room:
            if room < _FEWEST_LETTERS:
                continue
            phrase = shortened(phrase, room)
        spots = list(_spots(x, y, len(phrase), letter, to_the_right=before <= after))
        # a box that leaves the plate, or covers something, gives way to one that does not
        costs = [
            2.0 * (1.0 - spot.box.overlap(plate) / spot.box.area)
            + sum(spot.box.overlap(other) for other in taken) / spot.box.area
            for spot in spots
        ]
        spot = spots[int(np.argmin(np.round(costs, 3)))]
        taken.append(spot.box)
        if (spot.x, spot.y) != (x, y):
            marks.append(Line(np.array([x, spot.x]), np.array([y, spot.y]), role="reference"))
        marks.append(Label(spot.x, spot.y, phrase, spot.anchor))
    return marks


def _around(x: float, y: float, half: float) -> _Box:
    return _Box(x - half, x + half, y - half, y + half)


def _spots(x: float, y: float, count: int, letter: float, *, to_the_right: bool) -> Iterator[_Spot]:
    """Yield where a name of a number of letters may lie, the best first."""
    sides = ["left", "right"]
    if not to_the_right:
        sides.reverse()
    for anchor in (*sides, "above", "below"):
        yield _spot(x, y, anchor, count, letter)
    for distance in _DISTANCES:
        reach = distance * _LINE * letter
        for angle in _ANGLES.tolist():
            along, up = float(np.cos(angle)), float(np.sin(angle))
            anchor = "above"
            if abs(along) > 0.1:
                anchor = "left"
                if along < 0.0:
                    anchor = "right"
            elif up < 0.0:
                anchor = "below"
            yield _spot(x + reach * along, y + reach * up, anchor, count, letter)


def _spot(x: float, y: float, anchor: str, count: int, letter: float) -> _Spot:
    width = count * letter
    line = _LINE * letter
    beside = _BESIDE * letter
    above = _ABOVE * letter
    left, low = {
        "left": (x + beside, y - 0.5 * line),
        "right": (x - beside - width, y - 0.5 * line),
        "above": (x - 0.5 * width, y + above),
        "below": (x - 0.5 * width, y - above - line),
    }[anchor]
    return _Spot(x, y, anchor, _Box(left, left + width, low, low + line))


def sensor_places(result: Result) -> list[tuple[str, float, float]]:
    """Return name, x and y [m] of the sensors; of those at sets of a mesh only where it was
    brought.
    """
    sensors = result.case.get("sensors", [])
    shape = result.plate_shape
    if shape is not None:
        return [
            (sensor["name"], float(x), float(y))
            for sensor, (x, y) in zip(sensors, shape.sensors, strict=True)
        ]
    placed = [(sensor["name"], sensor["position"]) for sensor in sensors]
    return [
        (name, float(place[0]), float(place[1]))
        for name, place in placed
        if not isinstance(place, str)
    ]
