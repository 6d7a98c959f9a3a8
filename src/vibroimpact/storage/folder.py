"""The result folder: written beside and renamed, so that it is there whole or not at all."""

from __future__ import annotations

import json
import math
import os
import shutil
import tempfile
import tomllib
from collections.abc import Iterator
from contextlib import contextmanager
from os import PathLike
from pathlib import Path

import numpy as np
import tomli_w

from vibroimpact.dynamics.columns import IMPACT_COLUMNS, history_columns, impact_columns
from vibroimpact.errors import InputError
from vibroimpact.storage.netcdf import read_groups, write_groups
from vibroimpact.storage.result import Result
from vibroimpact.storage.signal_csv import write_signal_files
from vibroimpact.storage.summary import summary_of
from vibroimpact.storage.tables import impact_rows, write_csv

SUMMARY = "summary.json"

LONGEST_FOLDER_NAME = 200
"""Bytes; most disks take 255, and while it is written a folder has a longer name."""


_OTHER_FOLDERS = {
    "laws": "this is a comparison of contact laws, not the result of a run; make it anew with compare",
    "calibration": "this is a calibration, not the result of a run; run its case.toml, or make it anew with calibrate",
    "reproduction": "this is a reproduction of the paper, not the result of a run; make it anew with reproduce",
    "study": "this is a study of many drops, not the result of a run; its results are in study.nc",
    "modes": "these are modes of elastic bodies, not the result of a run; make them anew with modes",
}
"""What a folder is whose summary has one of these keys."""


@contextmanager
def new_folder(directory: str | PathLike[str], *, force: bool = False) -> Iterator[Path]:
    """Give a folder to fill, which becomes `directory` when the block ends without an error.

    Parameters
    ----------
    directory : path
        Where it is to be.
    force : bool, default False
        Replace a result folder that is there; nothing else is ever replaced.

    Raises
    ------
    InputError
        If something is there already, or the place can't be written to.
    """
    target = Path(directory)
    check_free(target, force=force)
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        working = Path(tempfile.mkdtemp(prefix=f".{target.name}.", dir=target.parent))
    except OSError as error:
        raise InputError(f"{target}: the folder can't be made: {error.strerror}") from None
    try:
        working.chmod(0o777 & ~_umask())
        yield working
        check_free(target, force=force)  # another process may have been quicker
        _put_in_place(working, target)
    except BaseException:
        shutil.rmtree(working, ignore_errors=True)
        raise


def check_free(directory: str | PathLike[str], *, force: bool = False) -> None:
    """Raise unless a result folder may be written to `directory`.

    Raises
    ------
    InputError
        If something is there that may not be replaced.
    """
    target = Path(directory)
    if "\0" in str(target):
        raise InputError(f"{target}: a path can't have the character NUL")
    if len(os.fsencode(target.name)) > LONGEST_FOLDER_NAME:
        raise InputError(f"{target}: the name of a folder may have {LONGEST_FOLDER_NAME} letters at most")
    if target.absolute() == Path(target.absolute().anchor):
        raise InputError(f"{target}: this is where all files are; name a folder inside it")
    if target.resolve() == Path.cwd():
        raise InputError(f"{target}: this is the folder you stand in; name one inside it")
    above = next(folder for folder in target.absolute().parents if folder.exists())
    if not os.access(above, os.W_OK):
        raise InputError(f"{target}: {above} can't be written to; name another place for the result")
    if not os.path.lexists(target):
        return
    if not target.is_dir():
        raise InputError(f"{target}: this is not a folder; name another place for the result")
    if (force and (target / SUMMARY).is_file()) or not any(target.iterdir()):
        return
    if force:
        raise InputError(f"{target}: the folder is there and is not a result folder, so --force does not replace it; name another one")
    raise InputError(f"{target}: the folder is there already; name another one, or replace it with --force")


def write_result(result: Result, directory: Path) -> None:
    """Write the data files of a result into a folder: case.toml, impacts.csv, summary.json, result.nc, and short signals as CSV."""
    if result.case:  # a problem made in Python has no case; its provenance says what it was
        (directory / "case.toml").write_text(tomli_w.dumps(result.case), encoding="utf-8")
    write_csv(impact_rows(result.impacts), list(impact_columns(result.impacts)), directory / "impacts.csv")
    (directory / SUMMARY).write_text(json.dumps(summary_of(result), indent=2, allow_nan=False) + "\n", encoding="utf-8")
    write_groups(result, directory / "result.nc")
    write_signal_files(result.signals, directory / "sensors")


def read_result(directory: str | PathLike[str]) -> Result:
    """Read a result folder.

    Raises
    ------
    InputError
        If it is not a result folder, or a file of it is missing or damaged.
    """
    folder = Path(directory)
    if not (folder / SUMMARY).is_file():
        raise InputError(f"{folder}: this is not a result folder; it has no {SUMMARY}")
    name = SUMMARY
    try:
        summary = json.loads((folder / name).read_text(encoding="utf-8"))
        for key, words in _OTHER_FOLDERS.items():
            if key in summary:
                raise InputError(f"{folder}: {words}")
        name = "case.toml"
        has_case = "problem" not in summary["provenance"]
        case = tomllib.loads((folder / name).read_text(encoding="utf-8")) if has_case else {}
        name = "result.nc"
        groups = read_groups(folder / name)
        missing = set(IMPACT_COLUMNS) - set(groups["impacts"])
        if missing:
            raise KeyError(f"no {', '.join(sorted(missing))}")
        energy = {key: float(value) for key, value in groups["energy"].items()}
        impacts = {key: np.atleast_1d(groups["impacts"][key]) for key in impact_columns(groups["impacts"])}
        return Result(
            case,
            impacts,
            {key: groups["history"][key] for key in history_columns(groups["history"])},
            energy,
            str(summary["status"]),
            dict(summary["provenance"]),
            dict(summary.get("deformation", {})),
            {body: math.nan if value is None else float(value) for body, value in summary.get("truncation", {}).items()},
            {body: dict(summary[body]) for body in ("sphere", "plate") if body in summary},
            groups["sensors"],
            groups["deflection"]["deflection"],
        )
    except InputError:
        raise
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise InputError(f"{folder / name}: the file is missing or damaged: {error}") from None


def _put_in_place(working: Path, target: Path) -> None:
    if not target.exists():
        working.rename(target)
        return
    # the old folder goes aside first: at every moment one whole result is on disk
    aside = Path(tempfile.mkdtemp(prefix=f".{target.name}.old.", dir=target.parent))
    target.rename(aside / "result")
    try:
        working.rename(target)
    except OSError:
        (aside / "result").rename(target)
        raise
    finally:
        shutil.rmtree(aside, ignore_errors=True)


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask
