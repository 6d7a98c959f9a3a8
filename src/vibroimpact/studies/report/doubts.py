"""What to doubt of a study, in words."""

from __future__ import annotations

from vibroimpact.cases.limit import limits
from vibroimpact.studies.report.axes import study_axes
from vibroimpact.studies.report.labels import value_text
from vibroimpact.studies.report.tables import point_of
from vibroimpact.studies.slips import study_slips
from vibroimpact.studies.study import Study
from vibroimpact.units.display import digits

COUNTED_FROM = "Drops are counted from 0, as in study.nc and drops.csv."

_KEYS = 4  # of the worst drop that are shown; all are in drops.csv


def doubt_sentences(study: Study) -> list[str]:
    """Return what to doubt of a study: slips of units, then each limit that drops are beyond, how many drops, the worst, counted from 0."""
    axes, found = study_axes(study), study_slips(study.table, study.coordinates)
    for limit, drops, worst, number in study.doubts:
        known = limits().get(limit)
        title, shown = (known.title, known.shown(number)) if known else (limit.replace("_", " "), digits(number, 3))
        point = zip(axes, point_of(study, axes, worst), strict=True)
        where = ", ".join([f"{axis.key} {value_text(axis, value)}" for axis, value in point if axis.varies][:_KEYS])
        found.append(f"{title}: {drops:,} of {study.size:,} drops, worst {shown} at drop {worst}{f' ({where})' if where else ''}")
    return found
