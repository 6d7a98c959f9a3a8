"""Populations of rocks: classes with distributions of their own, and falls in groups.

The falls of a group share a rock and a plate.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from zlib import crc32

import numpy as np

from vibroimpact.arrays import Floats, Indices
from vibroimpact.errors import InputError
from vibroimpact.studies.planning.axes import Axis, Listed, Values
from vibroimpact.studies.planning.scaled import Each, Scaled, drawn_for, scaled_columns

CLASS = "class"
ROCK = "rock"
PLATE = "plate"
"""Labels of a fall: the name of its class, and the numbers of its rock and its plate, from 0."""

LABELS = {
    CLASS: ("1", "class of the rock"),
    ROCK: ("1", "number of the rock, from 0"),
    PLATE: ("1", "number of the plate, from 0"),
}
"""Unit and meaning of each label."""


@dataclass(frozen=True)
class Population:
    """Rocks of several classes that fall on plates.

    Keys of [plate] and of sensors are drawn once for each plate, those of [drop] for each fall, and
    all others for each rock.

    Parameters
    ----------
    shares : mapping of str to float
        Share of the rocks of each class, > 0, not necessarily normalized.
    own : mapping of str to (mapping of str to Axis)
        The distributions of each class by key, the same keys for all.
    falls_per_rock, rocks_per_plate : int
        How many falls share a rock, and how many rocks share a plate.
    """

    shares: Mapping[str, float]
    own: Mapping[str, Mapping[str, Axis]]
    falls_per_rock: int = 1
    rocks_per_plate: int = 1

    @property
    def falls_per_plate(self) -> int:
        """How many falls share a plate."""
        return self.falls_per_rock * self.rocks_per_plate

    def draw(
        self, common: Mapping[str, Axis], falls: int, seed: int
    ) -> tuple[dict[str, Values], dict[str, Values]]:
        """Return the values of each fall by key, and its labels.

        Each key has a random stream of its own, so that more falls or another key leave what was
        drawn before as it is.

        Parameters
        ----------
        common : mapping of str to Axis
            The distributions that all classes have in common.
        falls : int
            Number of falls.
        seed : int
            Of the drawing.

        Raises
        ------
        InputError
            If a class gets no rock.

        Examples
        --------
        >>> own = {
        ...     "light": {"sphere.radius": Listed((1.0,))},
        ...     "heavy": {"sphere.radius": Listed((2.0,))},
        ... }
        >>> columns, labels = Population({"light": 1.0, "heavy": 1.0}, own, falls_per_rock=2).draw(
        ...     {}, 8, 0
        ... )
        >>> labels["class"].tolist()[::2]
        ['heavy', 'heavy', 'heavy', 'light']
        >>> columns["sphere.radius"].tolist()[::2]
        [2.0, 2.0, 2.0, 1.0]
        """
        rock = np.arange(falls) // self.falls_per_rock
        plate = rock // self.rocks_per_plate
        classes = list(self.shares)
        class_number = self._draw_classes(rock, seed)
        groups: dict[Each, Indices] = {"plate": plate, "rock": rock, "fall": np.arange(falls)}
        columns = {
            key: _drawn(axis, key, groups[_each(key, axis)], seed) for key, axis in common.items()
        }
        for key in next(iter(self.own.values())):
            # each class draws for all falls: what a fall gets does not depend on the others
            drawn = []
            for name in classes:
                axis = self.own[name][key]
                drawn.append(_drawn(axis, key, groups[_each(key, axis)], seed))
            mixed = np.empty(falls, dtype=np.result_type(*drawn))
            for number, values in enumerate(drawn):
                mixed[class_number == number] = values[class_number == number]
            columns[key] = mixed

        # last, as a key may follow another one, which has its values by now
        columns = scaled_columns(common, columns)
        for number, name in enumerate(classes):
            in_class = class_number == number
            class_columns = {key: values[in_class] for key, values in columns.items()}
            scaled = scaled_columns(self.own[name], class_columns)
            for key in self.own[name]:
                columns[key][in_class] = scaled[key]
        labels = {CLASS: np.array(classes, dtype=object)[class_number], ROCK: rock, PLATE: plate}
        return columns, labels

    def _draw_classes(self, rock: Indices, seed: int) -> Indices:
        """Return the number of the class of each fall, from 0, given the number of its rock.

        Raises
        ------
        InputError
            If a class gets no rock.
        """
        numbers = Listed(tuple(range(len(self.shares))), tuple(self.shares.values()))
        class_number = _drawn(numbers, CLASS, rock, seed).astype(int)
        for number, name in enumerate(self.shares):
            if not (class_number == number).any():
                message = (
                    f'"{name}" gets none of the {rock[-1] + 1} rocks; ask for more samples, '
                    "fewer falls per rock, or a larger share"
                )
                raise InputError(message, "samples")
        return class_number


def _each(key: str, axis: Axis) -> Each:
    """Return whether a key is drawn for each plate, rock or fall."""
    if isinstance(axis, Scaled) and axis.each:
        return axis.each
    return drawn_for(key)


def _drawn(axis: Axis, key: str, number: Indices, seed: int) -> Values:
    """Return a value for each number from the random stream of a key.

    Numbers ascend, and equal ones, such as those of falls of one rock, get the same value.
    """
    random = np.random.default_rng([seed, crc32(key.encode())])
    probabilities: Floats = random.random(int(number[-1]) + 1)
    return np.asarray(axis.quantiles(probabilities)[number])
