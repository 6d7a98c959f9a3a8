"""The folder of a result: its atomic creation, and the files that folders of all tasks have."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from functools import partial
from os import PathLike
from pathlib import Path
from typing import Any

import tomli_w

from vibroimpact.errors import InputError
from vibroimpact.files.atomic_write import atomic_folder
from vibroimpact.files.check_sums import CHECK_SUMS, digests_of, sealed
from vibroimpact.files.json_text import json_file_text
from vibroimpact.files.new_folders import made_folder
from vibroimpact.files.recover import recover

SUMMARY = "summary.json"
CASE = "case.toml"
REPORT = "report.html"
FIGURES = "figures"
"""Name of the folder of the charts as files."""

LONGEST_FOLDER_NAME = 200
"""In bytes; most file systems allow 255. This leaves room for what is appended, such as
the format in the name of an export.
"""


@contextmanager
def new_folder(directory: str | PathLike[str], *, force: bool = False) -> Iterator[Path]:
    """Context manager of an atomic folder write: yield a temporary folder that becomes `directory`
    when the block succeeds.

    Parameters
    ----------
    directory : path
        Final path of the folder.
    force : bool, default False
        Replace an existing result folder; nothing else is ever replaced.

    Raises
    ------
    InputError
        If the path exists and may not be replaced, or can't be written to.
    """
    target = Path(directory)
    check_free(target, force=force)
    with ExitStack() as stack:
        try:
            stack.enter_context(made_folder(target.parent))
            working = stack.enter_context(
                atomic_folder(target, partial(check_free, target, force=force))
            )
        except OSError as error:
            raise InputError(f"{target}: the folder can't be made: {error.strerror}") from None
        yield working


def check_free(directory: str | PathLike[str], *, force: bool = False) -> None:
    """Check that a result folder may be written to `directory`, after recovering from an
    interrupted write to it.

    Raises
    ------
    InputError
        If the path is not valid, exists and may not be replaced, or lies where nothing can be
        written.
    """
    target = Path(directory)
    if "\0" in str(target):
        raise InputError(f"{target}: a path can't have the character NUL")
    if len(os.fsencode(target.name)) > LONGEST_FOLDER_NAME:
        raise InputError(
            f"{target}: the name of a folder may have {LONGEST_FOLDER_NAME} bytes at most; "
            "letters beyond ASCII take several"
        )
    if target.absolute() == Path(target.absolute().anchor):
        raise InputError(f"{target}: this is the root of the file system; name a folder inside it")
    recover(target)
    if target.resolve() == Path.cwd():
        raise InputError(f"{target}: this is the current folder; name one inside it")
    above = next(folder for folder in target.absolute().parents if folder.exists())
    if not os.access(above, os.W_OK):
        raise InputError(
            f"{target}: {above} can't be written to; name another place for the result"
        )
    if not os.path.lexists(target):
        return
    if not target.is_dir():
        raise InputError(f"{target}: this is not a folder; name another place for the result")
    is_result = (target / SUMMARY).is_file()
    if (force and is_result) or not any(target.iterdir()):
        return
    if not is_result:
        raise InputError(
            f"{target}: the folder is there and is not a result folder, so --force does "
            "not replace it; name another one"
        )
    raise InputError(
        f"{target}: the folder is there already; name another one, or replace it with --force"
    )


def write_files(files: Mapping[str, Callable[[Path], object]], folder: Path) -> None:
    """Write the files of a folder by their names, each by its function."""
    for name, write in files.items():
        path = folder / name
        path.parent.mkdir(exist_ok=True)
        write(path)


def write_summary(
    summary: Mapping[str, Any], folder: Path, checked_files: Sequence[str] = ()
) -> None:
    """Write `summary.json` of a folder.

    Parameters
    ----------
    summary : mapping
        Its content, in SI.
    folder : pathlib.Path
        The folder.
    checked_files : sequence of str
        Names of files of the folder whose checksums the summary records, beside its own; those that
        are not there are left out.
    """
    if not checked_files:
        (folder / SUMMARY).write_text(json_file_text(summary), encoding="utf-8")
        return
    check_sums = digests_of(folder, checked_files)
    (folder / SUMMARY).write_bytes(sealed({**summary, CHECK_SUMS: check_sums}))


def write_case(case: Mapping[str, Any], path: Path) -> None:
    """Write a resolved case as a file that can be run."""
    path.write_text(tomli_w.dumps(case), encoding="utf-8")
