"""Write a drop in a format of another program: all files, or none."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from functools import partial
from os import PathLike
from pathlib import Path

from vibroimpact.errors import InputError
from vibroimpact.exporting.drop import Drop
from vibroimpact.exporting.export_format import ExportFormat, find_export_format
from vibroimpact.exporting.exported import drop_of
from vibroimpact.files.recover import recover
from vibroimpact.files.write_file import write_file
from vibroimpact.files.write_folder import whole_folder
from vibroimpact.files.write_into_folder import write_into

_MOST_NAMED = 3


def export_result(
    directory: str | PathLike[str], format: str, output: str | PathLike[str] | None = None, *, force: bool = False
) -> list[Path]:
    """Write a result folder, or a calibration folder, in a format of another program.

    Parameters
    ----------
    directory : path
        The folder.
    format : str
        Name of the format; `export_formats()` lists them.
    output : path, optional
        The folder to write to, which may be there; by default one beside `directory`, called `DIRECTORY-FORMAT`. Where the format
        writes one file and the name has a suffix, it is the name of the file.
    force : bool, default False
        Replace files of the same names. Other files in the folder are left as they are.

    Returns
    -------
    list of pathlib.Path
        The files that were written.

    Raises
    ------
    InputError
        If there is no such format, the folder holds no drop, the format can't hold the drop, or a file is there already or can't be
        written; then nothing is written.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> import vibroimpact as vi
    >>> with TemporaryDirectory() as place:
    ...     vi.simulate(vi.load_case("paper:type1-theory")).save(Path(place, "drop"))
    ...     [file.name for file in export_result(Path(place, "drop"), "csv")]
    ['impacts.csv', 'history.csv']
    """
    found = find_export_format(format)
    drop = found.told(drop_of(directory))
    return save_export(drop, found, default_output(directory, format) if output is None else Path(output), force=force)


def default_output(directory: str | PathLike[str], format: str) -> Path:
    """Return the folder that an export goes to if nothing is said: beside the one that is exported.

    Examples
    --------
    >>> default_output("runs/first/", "csv").as_posix()
    'runs/first-csv'
    """
    given = Path(directory)
    folder = given.resolve() if given.name in ("", "..") else given
    return folder.with_name(f"{folder.name}-{format}")


def save_export(drop: Drop, format: ExportFormat, output: Path, *, force: bool = False) -> list[Path]:
    """Write a drop that the format's program can be told of; as `export_result`.

    Raises
    ------
    InputError
        As `export_result`.
    """
    contents = format.write(drop)
    recover(output)
    targets = _targets(contents, output)
    _check_free(targets.values(), force=force)
    try:
        _write(contents, targets, output)
    except OSError as error:
        raise InputError(f"{output}: the files can't be written: {error.strerror or error}") from None
    return list(targets.values())


def _targets(contents: Mapping[str, bytes], output: Path) -> dict[str, Path]:
    """Return where each file goes."""
    suffixes = {Path(name).suffix.lower() for name in contents}
    if output.suffix and not output.is_dir():
        if len(contents) == 1:
            return dict.fromkeys(contents, output)
        if output.suffix.lower() in suffixes:
            more = ", ..." if len(contents) > _MOST_NAMED else ""
            shown = ", ".join(list(contents)[:_MOST_NAMED])
            raise InputError(f"{output}: there are {len(contents)} files to write ({shown}{more}); name a folder")
    return {name: output / name for name in contents}


def _check_free(targets: Iterable[Path], *, force: bool) -> None:
    for target in targets:
        if target.is_dir():
            raise InputError(f"{target}: this is a folder, and a file of that name is to be written; name another place")
        if os.path.lexists(target) and not force:
            raise InputError(f"{target}: the file is there already; name another place, or replace it with --force")


def _write(contents: Mapping[str, bytes], targets: Mapping[str, Path], output: Path) -> None:
    """Write one file, a new folder, or files into a folder that is there: all of them or none."""
    output.parent.mkdir(parents=True, exist_ok=True)
    if list(targets.values()) == [output]:
        write_file(output, *contents.values())
        return
    if output.exists():
        write_into(output, partial(_fill, contents))
        return
    with whole_folder(output, partial(_check_free, targets.values(), force=False)) as working:
        _fill(contents, working)


def _fill(contents: Mapping[str, bytes], folder: Path) -> None:
    for name, content in contents.items():
        file = folder / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_bytes(content)
