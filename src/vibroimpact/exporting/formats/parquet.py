"""Parquet: the tables of a drop with unit and meaning of each column in its metadata."""

from __future__ import annotations

from io import BytesIO

from vibroimpact.errors import InputError
from vibroimpact.exporting.drop import Drop
from vibroimpact.exporting.drop_tables import Table, tables_of
from vibroimpact.exporting.export_format import ExportFormat
from vibroimpact.files.plain_names import one_line


def write(drop: Drop) -> dict[str, bytes]:
    """Return one file per table.

    Raises
    ------
    InputError
        If the drop has no tables, or pyarrow is not installed.
    """
    return {
        f"{name}.parquet": _bytes(table, one_line(drop.name))
        for name, table in tables_of(drop).items()
    }


def _bytes(table: Table, title: str) -> bytes:
    try:
        import pyarrow
        import pyarrow.parquet
    except ImportError:
        raise InputError(
            'Parquet needs pyarrow, which is not installed: pip install "vibroimpact[parquet]"'
        ) from None
    # NaN becomes null
    arrays = [pyarrow.array(column.values, from_pandas=True) for column in table.values()]
    metadata = [{"unit": column.unit, "long_name": column.meaning} for column in table.values()]
    fields = [
        pyarrow.field(name, array.type, metadata=phrase)
        for name, array, phrase in zip(table, arrays, metadata, strict=True)
    ]
    result = pyarrow.Table.from_arrays(
        arrays, schema=pyarrow.schema(fields, metadata={"title": title})
    )
    file = BytesIO()
    pyarrow.parquet.write_table(result, file)
    return file.getvalue()


FORMAT = ExportFormat(
    name="parquet",
    program="pandas, Polars, DuckDB, Spark and other programs that read Parquet",
    files="impacts.parquet, history.parquet, and sensors/NAME.parquet of each sensor",
    tested="read back with pandas 3.1 and pyarrow 26, values and units the same",
    write=write,
    notes=lambda drop: [
        'Units are in the metadata of each column, "unit"; pyarrow shows them, pandas does not.',
        "The tables contain the results of the drop, not its bodies and its contact law.",
    ],
)
