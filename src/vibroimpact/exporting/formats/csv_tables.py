"""CSV: the impact table, the history and the signals."""

from __future__ import annotations

from vibroimpact.exporting.drop import Drop
from vibroimpact.exporting.drop_tables import Table, tables_of
from vibroimpact.exporting.export_format import ExportFormat
from vibroimpact.files.plain_names import plain_names
from vibroimpact.results.csv_files import signal_csv


def write(drop: Drop) -> dict[str, bytes]:
    """Return one file per table.

    Raises
    ------
    InputError
        If the drop has no tables.
    """
    texts = {
        name: _text(table)
        for name, table in tables_of(drop).items()
        if not name.startswith("sensors/")
    }
    texts |= {
        f"sensors/{plain}": signal_csv(drop.signals[name])
        for name, plain in plain_names(list(drop.signals)).items()
    }
    return {f"{name}.csv": text.encode() for name, text in texts.items()}


def _text(table: Table) -> str:
    """Return a table with full precision; missing values are empty cells."""
    columns = [[_cell(value) for value in column.values.tolist()] for column in table.values()]
    return "\n".join([",".join(table), *(",".join(row) for row in zip(*columns, strict=True)), ""])


def _cell(value: float) -> str:
    return "" if value != value else repr(value)


FORMAT = ExportFormat(
    name="csv",
    program="spreadsheets, and programs that read text",
    files="impacts.csv, history.csv, and sensors/NAME.csv of each sensor",
    tested="read back with pandas 3.1, every digit the same",
    write=write,
    notes=lambda drop: [
        "The tables contain the results of the drop, not its bodies and its contact law."
    ],
)
