"""The data card of a population: what its signals are, how they were drawn, and how to
divide them honestly.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from vibroimpact.cases.limits.limit import limits
from vibroimpact.studies.computation.study import Study
from vibroimpact.studies.planning.drop_variables import SIGNAL
from vibroimpact.studies.planning.population import CLASS, PLATE, ROCK
from vibroimpact.studies.report.axes import StudyAxis, study_axes
from vibroimpact.studies.report.labels import drops_text, range_text
from vibroimpact.studies.report.tables import reasons
from vibroimpact.units.display import digits

CARD = "card.md"

_ALIKE = (
    "Falls of one rock are more similar to each other than falls of its class, and "
    "so are falls on one plate."
)
_BY_PLATE = "or by `plate` for an application to other plates than these"
_ONE_PLATE = "for an application to another plate than this, falls on several plates are needed"
_LIMITS = (
    "The falls are computed: spheres, each of one material, fall on a plate that is, with "
    "its supports, damping and instruments, as the "
    "study states. Irregular shapes, cracks, layers of fines, and other vibration of the "
    "plate are not included: expect a lower accuracy "
    "in the field than on these falls."
)


def data_card(study: Study) -> str:
    """Return the data card of a study of a population, in Markdown.

    Parameters
    ----------
    study : Study
        The completed study.
    """
    signals = [_signal(study, variable) for variable in study.shapes if variable.startswith(SIGNAL)]
    if signals:
        kept = "Signals, values and labels"
        headings = ["variable", "quantity", "unit", "samples", "rate [Hz]"]
        signal_parts = ["## Signals", _table(headings, signals)]
    else:
        kept = "Values and labels, without signals,"
        signal_parts = []
    parts = [
        f"# {study.name[:1].upper() + study.name[1:]}",
        f"{drops_text(study.size)} of {_counted(study, ROCK)} on {_counted(study, PLATE)}, "
        "computed by vibroimpact "
        f"{study.version}. {kept} are in `study.nc`; `study.toml` computes it again.",
        "## Classes",
        _table(["class", "falls", "rocks", "share of the rocks"], _classes(study)),
        "## Sampled keys",
        "Keys of `plate` and `sensors` are drawn once a plate, those of `drop` once a fall, "
        "all others once a rock, each independently."
        + "".join(f" {phrase}." for phrase in _following(study)),
        _table(["key", "meaning", *_names(study)], _drawn(study)),
        *signal_parts,
        "## Labels and groups",
        f"`{CLASS}` is the class of the rock, `{ROCK}` and `{PLATE}` number what falls "
        f"share. {_ALIKE} Split training and test data by "
        f"`{ROCK}`{_split(study)}; never by fall, and never by windows of one signal.",
        "## Limits",
        _LIMITS,
        *_doubts(study),
    ]
    return "\n\n".join(parts) + "\n"


def _split(study: Study) -> str:
    """Return by what else than rocks falls are split, and what that needs."""
    if _number(study, PLATE) > 1:
        return f", {_BY_PLATE}"
    return f" ({_ONE_PLATE})"


def _number(study: Study, label: str) -> int:
    """Return how many rocks or plates there are."""
    return len(np.unique(study.labels[label]))


def _counted(study: Study, label: str) -> str:
    """Return a number of rocks or plates in words."""
    number = _number(study, label)
    ending = "" if number == 1 else "s"
    return f"{number} {label}{ending}"


def _names(study: Study) -> list[str]:
    """Return the names of the classes in order."""
    return sorted(set(study.labels[CLASS].tolist()))


def _classes(study: Study) -> Iterator[Sequence[str]]:
    rocks = _number(study, ROCK)
    for name in _names(study):
        of_class = study.labels[CLASS] == name
        own = len(np.unique(study.labels[ROCK][of_class]))
        yield name, str(int(of_class.sum())), str(own), f"{digits(100.0 * own / rocks, 3)} %"


def _drawn(study: Study) -> Iterator[Sequence[str]]:
    for axis in study_axes(study):
        if axis.key != CLASS:
            ranges = (
                StudyAxis(axis.key, axis.words, axis.unit, axis.values[study.labels[CLASS] == name])
                for name in _names(study)
            )
            yield f"`{axis.key}`", axis.words, *map(range_text, ranges)


def _following(study: Study) -> list[str]:
    """Return which keys follow another one, and for what their factors are drawn, in words."""
    sweep = study.table["sweep"]
    groups = [
        ("", sweep["over"]),
        *((f" of {name}", class_sweep["over"]) for name, class_sweep in sweep["classes"].items()),
    ]
    sentences = []
    for of_class, over in groups:
        for key, value in over.items():
            if isinstance(value, Mapping) and "of" in value:
                if value.get("each"):
                    drawn = f", with a factor that is drawn once a {value['each']}"
                else:
                    drawn = ""
                sentences.append(f"`{key}`{of_class} follows `{value['of']}`{drawn}")
    return sentences


def _signal(study: Study, variable: str) -> Sequence[str]:
    times = study.times(variable.removeprefix(SIGNAL))
    rate = ""
    if len(times) > 1:
        rate = f"{1.0 / (times[1] - times[0]):.10g}"
    return (
        f"`{variable}`",
        study.meanings[variable][1],
        study.meanings[variable][0],
        str(study.shapes[variable][-1]),
        rate,
    )


def _doubts(study: Study) -> Iterator[str]:
    """Yield what failed, and the limits of the theory that falls exceed."""
    for number, phrase in reasons(study):
        lacks = "has no results" if number == 1 else "have no results, such as"
        yield f"* {drops_text(number)} failed and {lacks}: {phrase}."
    known: Mapping[str, Any] = limits()
    for limit, drops, *_ in study.doubts:
        title = limit
        if limit in known:  # another version may have had others
            title = known[limit].title
        yield (
            f"* {title}: beyond the limit in {drops:,} of {study.size:,} falls (listed in "
            "`doubts` of `study.nc`)."
        )


def _table(heads: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Return a table in Markdown."""
    lines = [heads, ["---"] * len(heads), *rows]
    return "\n".join(f"| {' | '.join(cell.replace('|', '/') for cell in line)} |" for line in lines)
