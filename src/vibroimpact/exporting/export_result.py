"""Export of a result folder to a format of another program, atomically."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from functools import partial
from os import PathLike
from pathlib import Path

from vibroimpact.errors import InputError
from vibroimpact.exporting.drop import Drop
from vibroimpact.exporting.export_format import (
    ExportFormat,
    export_formats,
    find_export_format,
)
from vibroimpact.exporting.load_drop import load_drop, load_matched_drop
from vibroimpact.files.atomic_write import atomic_folder, write_file, write_into
from vibroimpact.files.new_folders import made_folder
from vibroimpact.files.recover import recover

_MOST_NAMED = 3


def export_result(
    directory: str | PathLike[str],
    format: str,
    output: str | PathLike[str] | None = None,
    *,
    force: bool = False,
    match: str | None = None,
) -> list[Path]:
    """Export a result folder or a calibration folder to a format of another program.

    Parameters
    ----------
    directory : path
        The folder.
    format : str
        Name of the format; `export_formats()` lists them.
    output : path, optional
        The folder to write to, which may exist; by default `DIRECTORY-FORMAT`, next to `directory`.
        If the format writes a single file and the name has a suffix, it is the name of that file.
    force : bool, default False
        Replace existing files of the same names. Other files in the folder are left unchanged.
    match : str, optional
        Write Adams' IMPACT in place of the contact law of a run: "rebound", with the rebound of
        the run, or "contact", with that of its contact law alone.

    Returns
    -------
    list of pathlib.Path
        The files that were written.

    Raises
    ------
    InputError
        If the format is unknown, the folder holds no drop, the format can't represent it, or a file
        exists already or can't be written; then nothing is written.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> import vibroimpact as vi
    >>> with TemporaryDirectory() as temporary:
    ...     folder = vi.simulate(vi.load_case("paper:type1-theory")).save(Path(temporary, "drop"))
    ...     [file.name for file in export_result(folder, "csv")]
    ['impacts.csv', 'history.csv']
    """
    export_format = find_export_format(format)
    drop = drop_to_export(directory, export_format, match)
    if output is None:
        output = default_output(directory, format)
    return save_export(drop, export_format, Path(output), force=force)


def drop_to_export(
    directory: str | PathLike[str], format: ExportFormat, match: str | None = None
) -> Drop:
    """Return the drop of a folder as a format takes it.

    Raises
    ------
    InputError
        As `export_result`, or if the format takes data, which have no contact law to be matched.
    """
    if match is None:
        return format.prepare(load_drop(directory))
    if not format.simulates:
        programs = [name for name, other in export_formats().items() if other.simulates]
        raise InputError(
            f"--match is for programs that simulate the drop ({', '.join(programs)}); "
            f"{format.name} holds the data of the run"
        )
    return format.prepare(load_matched_drop(directory, match))


def default_output(directory: str | PathLike[str], format: str) -> Path:
    """Return the default output folder of an export, next to the exported folder.

    Examples
    --------
    >>> default_output("runs/first/", "csv").as_posix()
    'runs/first-csv'
    """
    folder = Path(directory)
    if folder.name in ("", ".."):
        folder = folder.resolve()
    return folder.with_name(f"{folder.name}-{format}")


def save_export(
    drop: Drop, format: ExportFormat, output: Path, *, force: bool = False
) -> list[Path]:
    """Write a drop, already prepared for the format, as `export_result` does.

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
        raise InputError(
            f"{output}: the files can't be written: {error.strerror or error}"
        ) from None
    return list(targets.values())


def _targets(contents: Mapping[str, bytes], output: Path) -> dict[str, Path]:
    """Return the destination of each file."""
    suffixes = {Path(name).suffix.lower() for name in contents}
    if output.suffix and not output.is_dir():
        if len(contents) == 1:
            return dict.fromkeys(contents, output)
        if output.suffix.lower() in suffixes:
            shown = ", ".join(list(contents)[:_MOST_NAMED])
            if len(contents) > _MOST_NAMED:
                shown += ", ..."
            raise InputError(
                f"{output}: there are {len(contents)} files to write ({shown}); name a folder"
            )
    return {name: output / name for name in contents}


def _check_free(targets: Iterable[Path], *, force: bool) -> None:
    """Raise if a destination is a folder, or a file that may not be replaced."""
    for target in targets:
        if target.is_dir():
            raise InputError(
                f"{target}: this is a folder, and a file of that name is to be written; "
                "name another place"
            )
        if os.path.lexists(target) and not force:
            raise InputError(
                f"{target}: the file is there already; name another place, "
                "or replace it with --force"
            )


def _write(contents: Mapping[str, bytes], targets: Mapping[str, Path], output: Path) -> None:
    """Write one file, a new folder, or files into an existing folder, atomically."""
    with made_folder(output.parent):
        if list(targets.values()) == [output]:
            write_file(output, *contents.values())
            return
        if output.exists():
            write_into(output, partial(_fill, contents))
            return
        with atomic_folder(output, partial(_check_free, targets.values(), force=False)) as working:
            _fill(contents, working)


def _fill(contents: Mapping[str, bytes], folder: Path) -> None:
    for name, content in contents.items():
        file = folder / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_bytes(content)
