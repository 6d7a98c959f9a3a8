"""The data card of a population: what its signals are, how they were drawn, and how to divide them honestly."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from vibroimpact.cases.limit import limits
from vibroimpact.studies.drop_variables import SIGNAL
from vibroimpact.studies.population import CLASS, PLATE, ROCK
from vibroimpact.studies.report.axes import StudyAxis, study_axes
from vibroimpact.studies.report.labels import drops_text, range_text
from vibroimpact.studies.report.tables import reasons
from vibroimpact.studies.study import Study
from vibroimpact.units.display import digits

CARD = "card.md"

_SPLIT = (
    "Falls of one rock are more similar to each other than falls of its class, and so are falls on one plate. Split training and test data "
    "by `rock`, or by `plate` for an application to other plates than these; never by fall, and never by windows of one signal."
)
_LIMITS = (
    "The signals are computed: spheres, each of one material, fall on a plate whose supports, damping and instruments are as the study "
    "states. Irregular shapes, cracks, layers of fines, and other vibration of the plate are not included: expect a lower accuracy in the "
    "field than on these signals."
)


def data_card(study: Study) -> str:
    """Return the data card of a study of a population, in Markdown.

    Parameters
    ----------
    study : Study
        The completed study.
    """
    parts = [
        f"# {study.name[:1].upper() + study.name[1:]}",
        f"{drops_text(study.size)} of {_counted(study, ROCK)} on {_counted(study, PLATE)}, computed by vibroimpact "
        f"{study.version}. Signals, values and labels are in `study.nc`; `study.toml` computes it again.",
        "## Classes",
        _table(["class", "falls", "rocks", "share of the rocks"], _classes(study)),
        "## Sampled keys",
        "Keys of `plate` and `sensors` are drawn once a plate, those of `drop` once a fall, all others once a rock, each independently."
        + "".join(f" `{key}` follows `{other}`." for key, other in _following(study)),
        _table(["key", "meaning", *_names(study)], _drawn(study)),
        "## Signals",
        _table(["variable", "quantity", "unit", "samples", "rate [Hz]"], _signals(study)),
        "## Labels and groups",
        f"`{CLASS}` is the class of the rock, `{ROCK}` and `{PLATE}` number what falls share. {_SPLIT}",
        "## Limits",
        _LIMITS,
        *_doubts(study),
    ]
    return "\n\n".join(parts) + "\n"


def _number(study: Study, label: str) -> int:
    """Return how many rocks or plates there are."""
    return len(np.unique(study.labels[label]))


def _counted(study: Study, label: str) -> str:
    """Return a number of rocks or plates in words."""
    number = _number(study, label)
    return f"{number} {label}{'' if number == 1 else 's'}"


def _names(study: Study) -> list[str]:
    """Return the names of the classes in order."""
    return sorted(set(study.labels[CLASS].tolist()))


def _classes(study: Study) -> Iterator[Sequence[str]]:
    rocks = _number(study, ROCK)
    for name in _names(study):
        there = study.labels[CLASS] == name
        own = len(np.unique(study.labels[ROCK][there]))
        yield name, str(int(there.sum())), str(own), f"{digits(100.0 * own / rocks, 3)} %"


def _drawn(study: Study) -> Iterator[Sequence[str]]:
    for axis in study_axes(study):
        if axis.key != CLASS:
            ranges = (StudyAxis(axis.key, axis.words, axis.unit, axis.values[study.labels[CLASS] == name]) for name in _names(study))
            yield f"`{axis.key}`", axis.words, *map(range_text, ranges)


def _following(study: Study) -> list[tuple[str, str]]:
    """Return the keys that follow another one, and these."""
    sweep = study.table["sweep"]
    groups = [sweep["over"], *(one["over"] for one in sweep["classes"].values())]
    found = {key: value["of"] for over in groups for key, value in over.items() if isinstance(value, Mapping) and "of" in value}
    return list(found.items())


def _signals(study: Study) -> Iterator[Sequence[str]]:
    for variable, shape in study.shapes.items():
        if variable.startswith(SIGNAL):
            times = study.times(variable.removeprefix(SIGNAL))
            rate = f"{1.0 / (times[1] - times[0]):g}" if len(times) > 1 else ""
            yield f"`{variable}`", study.meanings[variable][1], study.meanings[variable][0], str(shape[-1]), rate


def _doubts(study: Study) -> Iterator[str]:
    """Yield what failed, and the limits of the theory that falls exceed."""
    for number, words in reasons(study):
        yield f"* {drops_text(number)} failed and {'has no signal' if number == 1 else 'have no signal, such as'}: {words}."
    known: Mapping[str, Any] = limits()
    for limit, drops, *_ in study.doubts:
        title = known[limit].title if limit in known else limit
        yield f"* {title}: beyond the limit in {drops:,} of {study.size:,} falls (listed in `doubts` of `study.nc`)."


def _table(heads: Sequence[str], rows: Iterator[Sequence[str]]) -> str:
    """Return a table in Markdown."""
    lines = [heads, ["---"] * len(heads), *rows]
    return "\n".join(f"| {' | '.join(cell.replace('|', '/') for cell in line)} |" for line in lines)
