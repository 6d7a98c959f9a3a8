"""Reading of records from files and folders."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from os import PathLike
from pathlib import Path

from vibroimpact.errors import InputError
from vibroimpact.files.reading import received, with_path
from vibroimpact.measurements.universal_file import is_universal
from vibroimpact.signals.reading.coded_sound import FORMATS as CODED_SOUND
from vibroimpact.signals.reading.coded_sound import coded_records
from vibroimpact.signals.reading.netcdf import netcdf_records
from vibroimpact.signals.reading.table import ENDINGS as TABLES
from vibroimpact.signals.reading.table import table_records
from vibroimpact.signals.reading.universal import universal_records
from vibroimpact.signals.reading.wave import wave_records
from vibroimpact.signals.record import Record

_READERS = {
    **dict.fromkeys(TABLES, table_records),
    ".wav": wave_records,
    ".uff": universal_records,
    ".unv": universal_records,
    ".nc": netcdf_records,
    ".nc4": netcdf_records,
    ".h5": netcdf_records,
    **dict.fromkeys(CODED_SOUND, coded_records),
}
FROM_MEMORY = (".wav", *TABLES)
"""Endings of files whose content is enough."""

_WHOLE = ("result.nc", "dataset.nc", "study.nc")
"""Files that hold all signals of a folder of this program."""


def load_records(path: str | PathLike[str], columns: str | None = None) -> Iterator[Record]:
    """Yield the records of a file, or of a folder.

    Read are tables with a column `time [s]` and a column with its unit for each channel (CSV,
    LabVIEW), WAV files (8 to 64 bits, floating point), with the extra `audio` M4A, MP3, Ogg and
    FLAC files, functions of time in universal files (dataset 58) and NetCDF-4 files with a
    dimension of time; of a folder the signals of its `result.nc`, `dataset.nc` or `study.nc`, else
    of all files of these formats in it. Values are in SI; those of sound are parts of full scale,
    unless an export of this program says what full scale is.

    Parameters
    ----------
    path : path
        The file or the folder.
    columns : str, optional
        The columns of a table in place of its header, in order: "time=s,-,force=N", with - for one
        that is left out; without a column of times with the rate of the rows, "rate=10
        kHz,force=N".

    Yields
    ------
    Record
        A channel of a file; or one of its signals, where a variable has several.

    Raises
    ------
    InputError
        If a file can't be read, or there is none; or columns are given and no file is a table.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     file = Path(folder, "hammer.csv")
    ...     _ = file.write_text("time [ms],force [kN]\\n0,1\\n1,2\\n")
    ...     [(record.name, record.value.tolist(), record.rate) for record in load_records(file)]
    [('force', [1000.0, 2000.0], 1000.0)]
    """
    files = record_files(path)
    if columns is not None and not any(_is_table(file) for file in files):
        tables = "this is none"
        if Path(path).is_dir():
            tables = "there is none in this folder"
        raise with_path(
            path,
            InputError(
                "--columns (in a case the key columns) states the columns of tables "
                f"({', '.join(TABLES)}), and {tables}; leave it out"
            ),
        )
    for file in files:
        for record in _records_of(file, columns):
            yield replace(record, source=str(file))


def records_in(name: str, content: bytes) -> list[Record]:
    """Return the records of a WAV file or a table whose content is in memory.

    Parameters
    ----------
    name : str
        Its name, whose ending states the format; nothing of this name is read from the disk.
    content : bytes
        Its content.

    Raises
    ------
    InputError
        If it is neither, or can't be read.

    Examples
    --------
    >>> (force,) = records_in("hammer.csv", b"time [ms],force [kN]\\n0,1\\n1,2\\n")
    >>> force.name, force.value.tolist(), force.source
    ('force', [1000.0, 2000.0], 'hammer.csv')
    """
    file = Path(name)
    if file.suffix.lower() not in FROM_MEMORY:
        raise with_path(
            name,
            InputError(
                "its format does not follow from its name; read here are files ending in "
                f"{', '.join(FROM_MEMORY)}"
            ),
        )
    with received(str(file), content):
        return [replace(record, source=name) for record in _records_of(file, None)]


def _records_of(file: Path, columns: str | None) -> Iterator[Record]:
    """Return the records of a file, with the columns that are stated if it is a table."""
    if _is_table(file):
        return table_records(file, columns)
    if is_universal(file):
        return universal_records(file)
    return _READERS[file.suffix.lower()](file)


def _is_table(file: Path) -> bool:
    return file.suffix.lower() in TABLES and not is_universal(file)


def record_files(path: str | PathLike[str]) -> list[Path]:
    """Return the files with the records of a file, which is itself, or of a folder.

    Raises
    ------
    InputError
        If there is no such file or folder, none of a known format in it, or the format of the file
        is not known.
    """
    file_or_folder = Path(path)
    known = ", ".join(_READERS)
    if file_or_folder.is_dir():
        return _files_of_folder(file_or_folder)
    if file_or_folder.suffix.lower() in _READERS or is_universal(file_or_folder):
        return [file_or_folder]
    if file_or_folder.exists():
        cause = "its format does not follow from its name"
    else:
        cause = "there is no such file"
    raise with_path(
        file_or_folder, InputError(f"{cause}; records are read from files ending in {known}")
    )


def _files_of_folder(folder: Path) -> list[Path]:
    """Return the file with all signals of a folder of this program, or all files of records."""
    for name in _WHOLE:
        file = folder / name
        if file.is_file():
            return [file]
    files = sorted(
        file for file in folder.iterdir() if file.suffix.lower() in _READERS and file.is_file()
    )
    if not files:
        raise with_path(
            folder,
            InputError(
                f"there is no file of records in this folder; known are {', '.join(_READERS)}"
            ),
        )
    return files
