"""Files of the live page, which the browser saves: report, signals, exports and figures."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from io import BytesIO
from typing import Any
from zipfile import ZIP_DEFLATED, ZipFile, ZipInfo

import numpy as np

from vibroimpact.app.state import State
from vibroimpact.charts.chart import Chart
from vibroimpact.errors import InputError, choices
from vibroimpact.exporting.export_format import find_export_format
from vibroimpact.exporting.load_drop import drop_of_result
from vibroimpact.files.plain_names import identifier, plain_names
from vibroimpact.quoting import quoted
from vibroimpact.report.page_of_report import page_of_report
from vibroimpact.results.csv_files import signal_csv
from vibroimpact.results.result import Result
from vibroimpact.runs.charts import chart_makers
from vibroimpact.runs.report import report_of

_BINARY = "application/octet-stream"


def files_of(
    kind: str, content: Mapping[str, Any], state: State | None, measured: Mapping[str, Chart]
) -> dict[str, Any]:
    """Return files of a case that was computed, each with its name, and notes on them.

    Parameters
    ----------
    kind : str
        "report", "signals", "export" or "figure".
    content : mapping
        What else the message asks for: the `format`, and the `chart` of a figure.
    state : State
        The case, computed in full; None if there is none yet.
    measured : mapping of str to Chart
        Further charts by their names, those of a measurement.

    Raises
    ------
    InputError
        If nothing was computed yet, or there is no such format, chart or signal.
    """
    if state is None:
        raise InputError("nothing was computed in full yet")
    match kind:
        case "report":
            return {"files": [_report(state.result)], "notes": []}
        case "signals":
            return {"files": _signals(state.result), "notes": []}
        case "export":
            return _export(state, content["format"])
    return {"files": [_figure(state.result, measured, **content)], "notes": []}


def _stem(result: Result) -> str:
    return identifier(result.name, "A-Za-z0-9", "drop", "-")


def _report(result: Result) -> dict[str, Any]:
    page = page_of_report(report_of(result))
    return {"name": f"{_stem(result)}.html", "kind": "text/html", "text": page}


def _signals(result: Result) -> list[dict[str, Any]]:
    if not result.signals:
        raise InputError("there are no signals: the case has no sensors", "sensors")
    names = plain_names(list(result.signals))
    return [
        {"name": f"{names[name]}.csv", "kind": "text/csv", "text": signal_csv(signal)}
        for name, signal in result.signals.items()
    ]


def _export(state: State, name: str) -> dict[str, Any]:
    """Return what `vibroimpact export` writes: a file, or an archive of several."""
    export_format = find_export_format(name)
    drop = export_format.prepare(drop_of_result(state.result, state.case))
    contents = export_format.write(drop)
    if len(contents) == 1:
        ((file, content),) = contents.items()
    else:
        file = f"{_stem(state.result)}-{name}.zip"
        content = archive_of(contents)
    return {
        "files": [{"name": file, "kind": _BINARY, "bytes": _as_array(content)}],
        "notes": export_format.notes(drop),
    }


def archive_of(contents: Mapping[str, bytes]) -> bytes:
    """Return files as a ZIP archive, the same bytes for the same files.

    Examples
    --------
    >>> archive = archive_of({"impacts.csv": b"impact", "sensors/a1.csv": b"time_s"})
    >>> ZipFile(BytesIO(archive)).namelist()
    ['impacts.csv', 'sensors/a1.csv']
    """
    archive = BytesIO()
    with ZipFile(archive, "w") as opened:
        for name, content in contents.items():
            # without the time of day
            opened.writestr(ZipInfo(name), content, ZIP_DEFLATED)
    return archive.getvalue()


def _figure(
    result: Result, measured: Mapping[str, Chart], *, chart: str, format: str
) -> dict[str, Any]:
    """Return a chart as a figure."""
    # imports matplotlib
    from vibroimpact.charts.files import FORMATS, check_formats
    from vibroimpact.charts.matplotlib import matplotlib_figure

    check_formats([format])
    makers: dict[str, Callable[[], Chart]] = dict(chart_makers(result))
    makers |= {name: lambda found=found: found for name, found in measured.items()}  # type: ignore[misc]
    if chart not in makers:
        raise InputError(f"there is no chart {quoted(chart)}; there are {choices(makers, chart)}")
    content = FORMATS[format](matplotlib_figure(makers[chart]()))
    return {
        "name": f"{_stem(result)}-{chart}.{format}",
        "kind": _BINARY,
        "bytes": _as_array(content),
    }


def _as_array(content: bytes) -> np.ndarray[Any, Any]:
    return np.frombuffer(content, dtype=np.uint8)
