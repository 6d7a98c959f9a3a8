"""What ends the run of a case, beside rest: the fields of `Problem` that state it, and words."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from vibroimpact.cases.rigid.plate_motion import motion_length
from vibroimpact.dynamics.statement.problem import Problem

if TYPE_CHECKING:
    from vibroimpact.cases.sections.schema import CaseTable


class RunEnd(NamedTuple):
    """A rule that ends a run.

    The field of `Problem` that states it, its value there, and a template of what is said of it.
    """

    field: str
    value: float
    template: str

    @property
    def words(self) -> str:
        """When the run ends."""
        return self.template.format(self.value)


def ends_of_run(case: CaseTable) -> list[RunEnd]:
    """Return the rules that end the run of a case, whichever comes first; none: only rest does.

    A run that nothing else ends has a default number of impacts.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> [end.words for end in ends_of_run(vi.load_case("signals:coal-gangue"))]
    ['at 0.9 s']
    """
    ends = []
    duration = _run_duration(case)
    if duration is not None:
        ends.append(RunEnd("duration", duration, "at {:g} s"))
    impacts = case.run.impacts
    if impacts is None and not ends:
        impacts = Problem.impacts
    if impacts is not None and impacts != "all":
        template = "after {} impact" if impacts == 1 else "after {} impacts"
        ends.insert(0, RunEnd("impacts", impacts, template))
    return ends


def stated_ends(case: CaseTable) -> dict[str, Any]:
    """Return the values of the fields of `Problem` that end the run of a case."""
    # without a number of impacts a problem has its default one
    return {"impacts": None, **{end.field: end.value for end in ends_of_run(case)}}


def impact_limit(case: CaseTable) -> int | None:
    """Return the number of impacts after which a run stops.

    None if it continues to rest or to a time.
    """
    limit: int | None = stated_ends(case)["impacts"]
    return limit


def _run_duration(case: CaseTable) -> float | None:
    """Return the time at which a run stops [s]; None if there is none.

    It is its duration, or the end of a tabulated motion of the plate.
    """
    length = motion_length(case)
    if np.isinf(length):
        return case.run.duration
    return min(case.run.duration or length, length)
