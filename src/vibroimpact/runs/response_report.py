"""What the response to one drop tells: the run, with files of the moving bodies for ParaView."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

from vibroimpact.dynamics.response import Response
from vibroimpact.errors import InputError
from vibroimpact.report.report import Report
from vibroimpact.results.result import result_of
from vibroimpact.runs.paraview import PARAVIEW, write_paraview
from vibroimpact.runs.report import report_of as report_of_result


def report_of(response: Response) -> Report:
    """Return the report of a response to one drop, whose folder has files for ParaView too.

    A caller that is done with the response can release its memory, and take the report of its
    result.

    Raises
    ------
    InputError
        If the response is that of a batch.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> report = report_of(vi.simulate(vi.load_case("paper:type1-theory")))
    >>> list(report.files)
    ['case.toml', 'impacts.csv', 'result.nc', 'sensors', 'paraview']
    """
    if response.problem.shape != ():
        raise InputError("a report tells of one drop: response.drop(0).save(...)")
    report = report_of_result(result_of(response))
    moving_bodies = {PARAVIEW: partial(write_paraview, response)}
    return replace(report, files={**report.files, **moving_bodies})
