"""Tables with layouts of their own: LabVIEW measurement files, oscilloscopes that state
the step of the times, and Audacity.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from math import isclose

from vibroimpact.errors import InputError
from vibroimpact.measurements.cell_numbers import number_in
from vibroimpact.measurements.header_cells import with_unit
from vibroimpact.measurements.table_lines import (
    Clock,
    Found,
    Head,
    fields_of,
    filled,
    first_rows,
    is_row,
)

_LABVIEW = "LabVIEW Measurement"
_END = "***End_of_Header***"
_SEPARATORS = {"tab": "\t", "comma": ",", "semicolon": ";"}
_AUDACITY = re.compile(
    r"Sample Rate: (\d+(?:\.\d+)?) Hz\. Sample values on (linear|dB) scale", re.IGNORECASE
)
_CHANNELS = {1: ("sound [1]",), 2: ("left [1]", "right [1]")}
_EQUAL_STEPS = 1e-9


def instrument_layout(head: Head) -> Found | None:
    """Return the header of a file that one of these programs wrote; None if none did.

    Raises
    ------
    InputError
        If the file is not as its program writes it, or is no record over time.
    """
    return next((found for reader in _READERS if (found := reader(head)) is not None), None)


def rows_of_instrument(head: Head, rows: Iterator[tuple[int, str]]) -> Iterator[tuple[int, str]]:
    """Return the rows below a header, for LabVIEW of the first segment.

    Raises
    ------
    InputError
        If a further segment begins.
    """
    return _one_segment(rows) if _is_labview(head) else rows


def _is_labview(head: Head) -> bool:
    return head.lines[0][1].lstrip().startswith(_LABVIEW)


def _one_segment(rows: Iterator[tuple[int, str]]) -> Iterator[tuple[int, str]]:
    for number, line in rows:
        if line.startswith(("Channels", "Notes", _END)):
            words = "a further segment of the LabVIEW file begins, with a header of its own"
            raise InputError(
                f"line {number}: {words}; a record is one segment: keep one in the file"
            )
        yield number, line


def _labview(head: Head) -> Found | None:
    """Return the header of a LabVIEW measurement file (.lvm): of its first segment, with
    the times by X0 and Delta_X.
    """
    if not _is_labview(head):
        return None
    lines = head.lines
    ends = [place for place, (_, line) in enumerate(lines) if line.startswith(_END)]
    if not ends:
        raise InputError(
            f"line {lines[0][0]}: the header of the LabVIEW file does not end up to line "
            f"{lines[-1][0]} ({_END} is missing there)"
        )
    stated = {
        words[0]: words[1].strip()
        for _, line in lines[: ends[0]]
        if len(words := re.split(r"[\t,;]", line, maxsplit=1)) > 1
    }
    mark = _SEPARATORS.get(stated.get("Separator", "Tab").strip(",;\t ").lower(), "\t")
    begin, end = (ends[0] + 1, ends[1]) if len(ends) > 1 else (0, ends[0])
    below = next((place for place in range(end + 1, len(lines)) if lines[place][1]), None)
    if below is None:
        raise InputError(
            f"line {lines[end][0]}: there are no rows under the header of the LabVIEW "
            f"file, up to line {lines[-1][0]}"
        )
    segment = {
        cells[0].strip(): (number, cells[1:])
        for number, line in lines[begin:end]
        if line and (cells := fields_of(line, mark))
    }
    number, line = lines[below]
    if is_row(line, mark):
        return None  # without a header of the segment
    names = [cell.strip() for cell in fields_of(line, mark)]
    has_times = (stated.get("X_Columns") or "One").strip(",;\t ").lower()
    # columns a channel, in the rows and in the lines of the header
    apart = 2 if has_times == "multi" else 1
    cells = [""] * len(names)
    clocks: dict[int, Clock] = {}
    doubts: dict[int, str] = {}
    for channel in range(1, len([name for name in names if name.lower() != "comment"]), apart):
        kind_at, kinds = segment.get("X_Dimension", (0, []))
        if (kind := _at(kinds, channel - 1)) and kind.lower() != "time":
            raise InputError(f"line {kind_at}: X_Dimension is {kind}; a record is over time")
        unit = _at(segment.get("Y_Unit_Label", (0, []))[1], channel - 1)
        if not unit:
            remedy = "--columns (in a case the key columns) states one"
            doubts[channel] = (
                "the LabVIEW file states no unit for it (Y_Unit_Label): it is read as a "
                f"plain number; {remedy}"
            )
        cells[channel] = with_unit(names[channel], unit or "1")
        if has_times != "no" and (apart == 2 or channel == 1):
            cells[channel - 1] = "time [s]"
        clock = _labview_clock(segment, channel - 1, mark)
        if clock is not None:
            is_first = isclose(
                clock.step, next(iter(clocks.values()), clock).step, rel_tol=_EQUAL_STEPS
            )
            clocks[channel] = clock._replace(
                alone=has_times == "no" or (apart == 1 and not is_first)
            )
        elif has_times == "no":
            raise InputError(
                f'line {number}: the channel "{names[channel]}" has neither times '
                "(X_Columns is No) nor X0 and a positive Delta_X"
            )
    return Found(number, cells, mark, below + 1, clocks, doubts)


def _labview_clock(
    segment: dict[str, tuple[int, list[str]]], place: int, mark: str
) -> Clock | None:
    """Return the times of a channel by X0 and Delta_X; None if they are not stated."""
    found = []
    for key in ("X0", "Delta_X"):
        number, cells = segment.get(key, (0, []))
        text = _at(cells, place)
        if not text:
            return None
        try:
            found.append(number_in(text, mark))
        except ValueError:
            raise InputError(
                f'line {number}: {key} "{text[:20]}" of the LabVIEW header is not a number'
            ) from None
    return Clock(found[0], found[1]) if found[1] > 0.0 else None


def _at(cells: list[str], place: int) -> str:
    return cells[place].strip() if place < len(cells) else ""


def _rigol(head: Head) -> Found | None:
    """Return the header of Rigol's oscilloscopes: X,CH1,Start,Increment over
    Sequence,Volt,START,STEP; rows have a number and samples.
    """
    number, line = head.lines[0]
    names = [cell.strip() for cell in fields_of(line, ",")]
    lower = [name.lower() for name in names]
    below = next((place for place in range(1, len(head.lines)) if head.lines[place][1]), None)
    if below is None or not {"start", "increment"} <= set(lower):
        return None
    units = [*fields_of(head.lines[below][1], ","), *[""] * len(names)]
    try:
        start, step = (number_in(units[lower.index(key)], ",") for key in ("start", "increment"))
    except ValueError:
        return None
    channels = [
        place
        for place, name in enumerate(lower)
        if place > 0 and name not in ("start", "increment", "")
    ]
    cells = [
        with_unit(name, units[place]) if place in channels else ""
        for place, name in enumerate(names)
    ]
    return Found(number, cells, ",", below + 1, dict.fromkeys(channels, Clock(start, step)))


def _tektronix_beside(head: Head) -> Found | None:
    """Return the header of Tektronix' older oscilloscopes, which write what they state in
    the first columns of the rows.
    """
    number, line = head.lines[0]
    if not line.startswith(("Record Length", '"Record Length')) or len(fields_of(line, ",")) < 5:
        return None
    stated = {
        cells[0].strip(): cells[1].strip()
        for _, line in head.lines
        if len(cells := fields_of(line, ",")) > 1 and cells[0].strip()
    }
    time, unit = stated.get("Horizontal Units", "s").lower(), stated.get("Vertical Units", "V")
    return Found(
        number, ["", "", "", f"time [{time}]", f"{stated.get('Source') or 'CH1'} [{unit}]"], ",", 0
    )


def _audacity(head: Head) -> Found | None:
    """Return the header of Audacity's export of sample data: its rate is in a line above,
    and it has no names of columns.
    """
    told = next(
        ((number, found) for number, line in head.lines[:5] if (found := _AUDACITY.search(line))),
        None,
    )
    if told is None:
        return None
    number, found = told
    if found.group(2).lower() == "db":
        raise InputError(
            f"line {number}: the samples are in dB, without their sign; export "
            "them on the linear scale"
        )
    rows = first_rows(head, least=1)
    if rows is None:
        raise InputError(
            f"line {number}: there are fewer than two samples under the header of "
            f"Audacity, up to line {head.lines[-1][0]}"
        )
    at, mark = rows
    first = " ".join(line for _, line in head.lines[:at])
    count = 2 if "2 channels" in first else 1
    width = filled(fields_of(head.lines[at][1], mark))
    if width < count:
        raise InputError(
            f"line {head.lines[at][0]}: both channels are in one column; export them with "
            "the layout L-R on the same line"
        )
    # before the samples may be their number or their time
    cells = [""] * (width - count) + list(_CHANNELS[count])
    clock = Clock(0.0, 1.0 / float(found.group(1)))
    return Found(
        number, cells, mark, at, {place: clock for place, cell in enumerate(cells) if cell}
    )


_READERS: tuple[Callable[[Head], Found | None], ...] = (
    _labview,
    _tektronix_beside,
    _rigol,
    _audacity,
)
