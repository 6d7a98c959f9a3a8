"""Tables with layouts of their own: LabVIEW, oscilloscopes that state the time step, Audacity."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from math import isclose
from typing import NamedTuple

from vibroimpact.errors import InputError
from vibroimpact.measurements.cell_numbers import number_in
from vibroimpact.measurements.header_cells import with_unit
from vibroimpact.measurements.table_lines import (
    Clock,
    Head,
    HeaderLines,
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


def instrument_layout(head: Head) -> HeaderLines | None:
    """Return the header of a file that one of these programs wrote; None if none did.

    Raises
    ------
    InputError
        If the file is not as its program writes it, or is no record over time.
    """
    for reader in _READERS:
        header = reader(head)
        if header is not None:
            return header
    return None


def rows_of_instrument(head: Head, rows: Iterator[tuple[int, str]]) -> Iterator[tuple[int, str]]:
    """Return the rows below a header, for LabVIEW of the first segment.

    Raises
    ------
    InputError
        If a further segment begins.
    """
    if _is_labview(head):
        return _one_segment(rows)
    return rows


def _is_labview(head: Head) -> bool:
    return head.lines[0][1].lstrip().startswith(_LABVIEW)


def _one_segment(rows: Iterator[tuple[int, str]]) -> Iterator[tuple[int, str]]:
    """Yield the rows of a LabVIEW file; raise InputError if a further segment begins."""
    for number, line in rows:
        if line.startswith(("Channels", "Notes", _END)):
            raise InputError(
                f"line {number}: a further segment of the LabVIEW file begins, with a header of "
                "its own; a record is one segment: keep one in the file"
            )
        yield number, line


def _labview(head: Head) -> HeaderLines | None:
    """Return the header of the first segment of a LabVIEW measurement file (.lvm).

    Its times follow from X0 and Delta_X.
    """
    if not _is_labview(head):
        return None
    segment = _labview_segment(head)
    number, line = head.lines[segment.names_index]
    if is_row(line, segment.delimiter):
        return None  # without a header of the segment
    names = [cell.strip() for cell in fields_of(line, segment.delimiter)]
    channels = len([name for name in names if name.lower() != "comment"])
    # columns a channel, in the rows and in the lines of the header
    apart = 2 if segment.x_columns == "multi" else 1
    cells = [""] * len(names)
    clocks: dict[int, Clock] = {}
    doubts: dict[int, str] = {}
    for column in range(1, channels, apart):
        dimension_number, dimension = segment.field("X_Dimension", column)
        if dimension and dimension.lower() != "time":
            raise InputError(
                f"line {dimension_number}: X_Dimension is {dimension}; a record is over time"
            )
        _, unit = segment.field("Y_Unit_Label", column)
        if not unit:
            doubts[column] = (
                "the LabVIEW file states no unit for it (Y_Unit_Label): it is read as a "
                "plain number; --columns (in a case the key columns) states one"
            )
        cells[column] = with_unit(names[column], unit or "1")
        if segment.x_columns != "no" and (apart == 2 or column == 1):
            cells[column - 1] = "time [s]"
        clock = _labview_clock(segment, column)
        if clock is not None:
            # the column of times is that of the first channel, and of those of its rate
            first = next(iter(clocks.values()), clock)
            is_alone = segment.x_columns == "no" or (
                apart == 1 and not isclose(clock.step, first.step, rel_tol=_EQUAL_STEPS)
            )
            clocks[column] = clock._replace(alone=is_alone)
        elif segment.x_columns == "no":
            raise InputError(
                f'line {number}: the channel "{names[column]}" has neither times '
                "(X_Columns is No) nor X0 and a positive Delta_X"
            )
    below = segment.names_index + 1
    return HeaderLines(number, cells, segment.delimiter, below, clocks, doubts)


class _LabviewSegment(NamedTuple):
    """Header of a segment of a LabVIEW file.

    What separates fields, how many columns have times (no, one, multi), the lines of the header by
    their key, with number and fields, and the index of the line with the names of the columns.
    """

    delimiter: str
    x_columns: str
    lines: dict[str, tuple[int, list[str]]]
    names_index: int

    def field(self, key: str, column: int) -> tuple[int, str]:
        """Return the number of a line and its field for a column of the rows; "" if it has none."""
        number, fields = self.lines.get(key, (0, []))
        if column > len(fields):
            return number, ""
        return number, fields[column - 1].strip()


def _labview_segment(head: Head) -> _LabviewSegment:
    """Return the header of the first segment of a LabVIEW file.

    Raises
    ------
    InputError
        If a header does not end, or there is nothing under it.
    """
    lines = head.lines
    last_number, _ = lines[-1]
    ends = [index for index, (_, line) in enumerate(lines) if line.startswith(_END)]
    if not ends:
        raise InputError(
            f"line {lines[0][0]}: the header of the LabVIEW file does not end up to line "
            f"{last_number} ({_END} is missing there)"
        )
    stated = {}
    for _, line in lines[: ends[0]]:
        key, *values = re.split(r"[\t,;]", line, maxsplit=1)
        if values:
            stated[key] = values[0].strip()
    separator = stated.get("Separator", "Tab").strip(",;\t ").lower()
    delimiter = _SEPARATORS.get(separator, "\t")
    # the header of the file comes first, that of the segment next, if there are two
    begin = 0
    end = ends[0]
    if len(ends) > 1:
        begin = ends[0] + 1
        end = ends[1]
    names_index = next((index for index in range(end + 1, len(lines)) if lines[index][1]), None)
    if names_index is None:
        raise InputError(
            f"line {lines[end][0]}: there are no rows under the header of the LabVIEW "
            f"file, up to line {last_number}"
        )
    by_key = {}
    for number, line in lines[begin:end]:
        if line:
            key, *fields = fields_of(line, delimiter)
            by_key[key.strip()] = (number, fields)
    x_columns = (stated.get("X_Columns") or "One").strip(",;\t ").lower()
    return _LabviewSegment(delimiter, x_columns, by_key, names_index)


def _labview_clock(segment: _LabviewSegment, column: int) -> Clock | None:
    """Return the times of a channel by X0 and Delta_X; None if they are not stated."""
    numbers = []
    for key in ("X0", "Delta_X"):
        line_number, text = segment.field(key, column)
        if not text:
            return None
        try:
            numbers.append(number_in(text, segment.delimiter))
        except ValueError:
            raise InputError(
                f'line {line_number}: {key} "{text[:20]}" of the LabVIEW header is not a number'
            ) from None
    start, step = numbers
    return Clock(start, step) if step > 0.0 else None


def _rigol(head: Head) -> HeaderLines | None:
    """Return the header of Rigol's oscilloscopes; rows have a number and samples.

    It is X,CH1,Start,Increment over Sequence,Volt,START,STEP.
    """
    number, line = head.lines[0]
    names = [cell.strip() for cell in fields_of(line, ",")]
    lower = [name.lower() for name in names]
    second = next((index for index in range(1, len(head.lines)) if head.lines[index][1]), None)
    if second is None or "start" not in lower or "increment" not in lower:
        return None
    units = [*fields_of(head.lines[second][1], ","), *[""] * len(names)]
    try:
        start = number_in(units[lower.index("start")], ",")
        step = number_in(units[lower.index("increment")], ",")
    except ValueError:
        return None
    clock = Clock(start, step)
    cells = [""] * len(names)
    clocks = {}
    for column, name in enumerate(names):
        # the first column numbers the samples
        if column > 0 and lower[column] not in ("start", "increment", ""):
            cells[column] = with_unit(name, units[column])
            clocks[column] = clock
    return HeaderLines(number, cells, ",", second + 1, clocks)


def _tektronix_beside(head: Head) -> HeaderLines | None:
    """Return the header of Tektronix' older oscilloscopes.

    They write what they state in the first columns of the rows.
    """
    number, line = head.lines[0]
    if not line.startswith(("Record Length", '"Record Length')) or len(fields_of(line, ",")) < 5:
        return None
    stated = {}
    for _, row in head.lines:
        cells = fields_of(row, ",")
        if len(cells) > 1 and cells[0].strip():
            stated[cells[0].strip()] = cells[1].strip()
    time_unit = stated.get("Horizontal Units", "s").lower()
    unit = stated.get("Vertical Units", "V")
    channel = stated.get("Source") or "CH1"
    header = ["", "", "", f"time [{time_unit}]", f"{channel} [{unit}]"]
    return HeaderLines(number, header, ",", 0)


def _audacity(head: Head) -> HeaderLines | None:
    """Return the header of Audacity's export of sample data.

    Its rate is in a line above, and it has no names of columns.
    """
    stated = _audacity_line(head)
    if stated is None:
        return None
    number, rate, scale = stated
    if scale.lower() == "db":
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
    first_row, delimiter = rows
    above = " ".join(line for _, line in head.lines[:first_row])
    count = 2 if "2 channels" in above else 1
    row_number, row = head.lines[first_row]
    width = filled(fields_of(row, delimiter))
    if width < count:
        raise InputError(
            f"line {row_number}: both channels are in one column; export them with "
            "the layout L-R on the same line"
        )
    # before the samples may be their number or their time
    cells = [""] * (width - count) + list(_CHANNELS[count])
    clock = Clock(0.0, 1.0 / float(rate))
    clocks = {column: clock for column, cell in enumerate(cells) if cell}
    return HeaderLines(number, cells, delimiter, first_row, clocks)


def _audacity_line(head: Head) -> tuple[int, str, str] | None:
    """Return the number of the line with the rate, the rate [Hz], and the scale of the samples."""
    for number, line in head.lines[:5]:
        stated = _AUDACITY.search(line)
        if stated is not None:
            rate, scale = stated.groups()
            return number, rate, scale
    return None


_READERS: tuple[Callable[[Head], HeaderLines | None], ...] = (
    _labview,
    _tektronix_beside,
    _rigol,
    _audacity,
)
