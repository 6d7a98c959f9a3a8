"""The drops that charts show one by one: what each of them is, by what they may be
coloured, and where they lie on the axes.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vibroimpact.arrays import Floats, Indices
from vibroimpact.charts.palette import SERIES, of_class
from vibroimpact.quoting import shortened, visible
from vibroimpact.studies.computation.study import Study
from vibroimpact.studies.computation.study_folder import STUDY
from vibroimpact.studies.report.axes import StudyAxis, study_axes
from vibroimpact.studies.report.labels import value_text, with_unit
from vibroimpact.studies.report.outputs import Output, drop_numbers, read_output, sampled_places
from vibroimpact.studies.report.scales import names_of, places, sentence
from vibroimpact.units.display import multiple, text

MOST_DROPS = 1500
"""Maximum number of drops drawn as points; more would overlap."""

_MOST_KEYS = 12  # told of a drop


class Group(NamedTuple):
    """Drops of one look.

    Attributes
    ----------
    name, role : str
        Name in the legend, and role.
    chosen : array of int
        Which of the drops that are drawn these are.
    texts : tuple of str
        What each of them is, with the command that runs it as the last line.
    keys : dict of str to array
        Values by which they may be coloured, by what these are.
    places : dict of str to array
        Where they lie on the axis of each swept key.
    """

    name: str
    role: str
    chosen: Indices
    texts: tuple[str, ...]
    keys: dict[str, NDArray[Any]]
    places: dict[str, Floats]


def drawn_groups(study: Study, axes: list[StudyAxis], outputs: list[Output]) -> list[Group]:
    """Return the drops that are drawn as points, a group for each name of the first key of names.

    Parameters
    ----------
    study : Study
        The study.
    axes : list of StudyAxis
        The keys that vary.
    outputs : list of Output
        The results told of each drop.
    """
    chosen = sampled_places(study, MOST_DROPS)
    numbers = drop_numbers(study, *chosen)
    return grouped(
        study, axes, numbers, drop_texts(study, results_of(study, outputs, *chosen), numbers)
    )


def grouped(
    study: Study,
    axes: list[StudyAxis],
    numbers: Indices,
    texts: tuple[str, ...],
    others: Mapping[str, NDArray[Any]] | None = None,
) -> list[Group]:
    """Return drops as groups, one for each name of the first key of few names.

    Parameters
    ----------
    study : Study
        The study.
    axes : list of StudyAxis
        The keys that vary.
    numbers : array of int
        Number of each drop.
    texts : tuple of str
        What each of them is.
    others : mapping of str to array, optional
        Other names by which they may be coloured; they are grouped by these if there is no key of
        names.
    """
    values = {axis.key: values_at(study, axis, numbers) for axis in axes}
    places_of = {}
    for axis in axes:
        places_of[axis.key] = places(axis, values[axis.key])
        if not axis.numeric:  # aside from each other, as many drops have the same name
            places_of[axis.key] = places_of[axis.key] + _offsets(len(numbers))
    keys = dict(others or {}) | {
        _key_label(axis): _key_values(axis, values[axis.key]) for axis in axes
    }
    named = {
        _key_label(axis): [_short(name) for name in names_of(axis)]
        for axis in axes
        if not axis.numeric
    }
    named |= {
        label: list(dict.fromkeys(column.tolist())) for label, column in (others or {}).items()
    }
    by = next((label for label, names in named.items() if 1 < len(names) <= SERIES), None)
    if by is None:
        return [Group("a drop", "mark", np.arange(len(numbers)), texts, keys, places_of)]
    groups = []
    for place, name in enumerate(named[by]):
        chosen = np.flatnonzero(keys[by] == name)
        if not len(chosen):
            continue
        own = {key: column[chosen] for key, column in keys.items()}
        where = {key: column[chosen] for key, column in places_of.items()}
        groups.append(
            Group(
                name,
                of_class(place),
                chosen,
                tuple(texts[number] for number in chosen.tolist()),
                own,
                where,
            )
        )
    return groups


def results_of(
    study: Study, outputs: list[Output], *chosen: slice
) -> dict[str, tuple[str, Floats]]:
    """Return the results of drops at slices along each dimension, by title: unit and values."""
    return {
        output.title: (output.unit, read_output(study, output.name, *chosen)) for output in outputs
    }


def drop_texts(
    study: Study,
    results: Mapping[str, tuple[str, Floats]],
    numbers: Indices,
    impacts: Indices | None = None,
) -> tuple[str, ...]:
    """Return what each drop is: its number, the values of its keys, results, and the command that
    runs it.

    Parameters
    ----------
    study : Study
        The study.
    results : mapping of str to (str, array)
        Unit and values of each result that is told, by title; NaN is left out.
    numbers : array of int
        Number of each drop.
    impacts : array of int, optional
        Number of the impact whose results these are, from 1.
    """
    axes = [axis for axis in study_axes(study) if axis.varies]
    columns = [_told(axis, values_at(study, axis, numbers)) for axis in axes[:_MOST_KEYS]]
    more = []
    if len(axes) > _MOST_KEYS:
        more = [f"and {len(axes) - _MOST_KEYS} keys more"]
    cells = [_result_lines(title, unit, values) for title, (unit, values) in results.items()]
    if impacts is None:
        heads = [""] * len(numbers)
    else:
        heads = [f", impact {impact}" for impact in impacts.tolist()]
    texts = []
    for place, (number, head) in enumerate(zip(numbers.tolist(), heads, strict=True)):
        lines = [
            f"drop {number}{head}",
            *(column[place] for column in columns),
            *more,
            *(column[place] for column in cells),
        ]
        texts.append("\n".join([line for line in lines if line] + [run_command(number)]))
    return tuple(texts)


def _result_lines(title: str, unit: str, values: Floats) -> list[str]:
    """Return the line that tells a result of each drop; empty for NaN."""
    name = shortened(visible(title), 60)
    return [f"{name}: {text(value, unit)}" if value == value else "" for value in values.tolist()]


def run_command(number: int) -> str:
    """Return the command that runs one drop of a study, in the study's folder.

    Examples
    --------
    >>> run_command(17)
    'vibroimpact run study.toml --drop 17 -o drop-17'
    """
    return f"vibroimpact run {STUDY} --drop {number} -o drop-{number}"


def values_at(study: Study, axis: StudyAxis, numbers: Indices) -> NDArray[Any]:
    """Return the values of a swept key in drops, by their numbers."""
    if not study.is_grid:
        return axis.values[numbers]
    lengths = tuple(study.dimensions.values())
    dimension = list(study.dimensions).index(axis.key)
    levels = np.unravel_index(numbers, lengths)[dimension]
    return np.asarray(axis.values[levels])


def _told(axis: StudyAxis, values: NDArray[Any]) -> list[str]:
    """Return the texts of values of a key, each of which often occurs several times."""
    phrase = cache(lambda value: f"{shortened(visible(axis.key), 60)}: {value_text(axis, value)}")
    return [phrase(value) for value in values.tolist()]


def _key_label(axis: StudyAxis) -> str:
    """Return the label of a key, with the unit of the scale of colours."""
    label = shortened(visible(sentence(axis.words)), 60)
    if not axis.numeric:
        return label
    return with_unit(label, multiple(axis.unit, axis.values).unit)


def _key_values(axis: StudyAxis, values: NDArray[Any]) -> NDArray[Any]:
    if axis.numeric:
        return np.asarray(values, dtype=float) / multiple(axis.unit, axis.values).size
    return np.array([_short(value) for value in values], dtype=object)


def _short(name: Any) -> str:
    return shortened(visible(str(name)), 40)


def _offsets(number: int) -> Floats:
    """Return offsets that separate points of the same name: a deterministic sequence by
    the golden ratio.
    """
    return np.asarray(
        0.5 * ((np.arange(number) * 0.6180339887498949) % 1.0 - 0.5), dtype=np.float64
    )
