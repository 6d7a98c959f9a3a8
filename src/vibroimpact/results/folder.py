"""The data files of the result folder of a run: writing, and reading with verification of
checksums.
"""

from __future__ import annotations

import math
import shlex
from collections.abc import Callable, Mapping
from functools import partial
from os import PathLike
from pathlib import Path
from typing import Any, cast

import numpy as np

from vibroimpact.dynamics.motion.columns import (
    FIRST_IMPACT_COLUMNS,
    HISTORY_COLUMNS,
    IMPACT_COLUMNS,
    VIBRATION_HISTORY_COLUMNS,
    history_columns,
    impact_columns,
)
from vibroimpact.errors import InputError
from vibroimpact.files.check_sums import (
    CHECK_SUMS,
    DamageError,
    check_file,
    read_sealed,
)
from vibroimpact.files.damaged_part import check_hdf5
from vibroimpact.files.hdf5 import short_reason
from vibroimpact.files.recover import recover
from vibroimpact.files.result_folder import (
    CASE,
    SUMMARY,
    write_case,
)
from vibroimpact.files.toml_reading import read_toml
from vibroimpact.resolved_case import ResolvedCase
from vibroimpact.results.csv_files import write_impacts, write_signal_files
from vibroimpact.results.netcdf import read_groups, write_groups
from vibroimpact.results.result import Result
from vibroimpact.results.summary import check_case, check_types

IMPACTS = "impacts.csv"
NETCDF = "result.nc"
CHECKED_FILES = (CASE, NETCDF)
"""Files of the result folder whose checksums its summary records."""

_OTHER_FOLDERS = {
    "laws": "this is a comparison of contact laws, not the result of a run; make it anew with "
    "compare",
    "calibration": "this is a calibration, not the result of a run; run its case.toml, or make it "
    "anew with calibrate",
    "bounces": "these are bounces in a record, not the result of a run; find them anew with "
    "calibrate",
    "restitutions": "these are restitutions of a table, not the result of a run; fit them anew "
    "with calibrate",
    "reproduction": "this is a reproduction of the paper, not the result of a run; make it anew "
    "with reproduce",
    "study": "this is a study of many drops, not the result of a run; its results are in study.nc",
    "majority_error": "this is a bound on the error of classifiers, not the result of a run; make "
    "it anew with bound",
    "estimates": "this is an identified impact, not the result of a run; make it anew with "
    "identify",
    "octaves_Hz": "this is a comparison of a test with its simulation, not the result of a run; "
    "make it anew with correlate",
    "responses": "these are modes of measured frequency responses, not the result of a run; fit "
    "them anew with modes",
    "modes": "these are modes of elastic bodies, not the result of a run; make them anew with "
    "modes",
    "recognition": "this is a recognition of signals, not the result of a run; make it anew with "
    "recognise",
    "recognised": "these are recognised signals, not the result of a run; make them anew with "
    "recognise --model",
}
"""Messages for folders that are not results of a run, by the key that identifies them in
`summary.json`; the first that it has.
"""


def result_files(result: Result) -> dict[str, Callable[[Path], object]]:
    """Return the data files of a result by their names, each with the function that writes it.

    These are `case.toml`, `impacts.csv`, `result.nc`, and the folder `sensors` with signals that
    are not too long.
    """
    files: dict[str, Callable[[Path], object]] = {}
    # a problem defined in Python has no case; its provenance holds its representation
    if result.case:
        files[CASE] = partial(write_case, result.case)
    files[IMPACTS] = partial(write_impacts, result.impacts)
    files[NETCDF] = partial(write_groups, result)
    files["sensors"] = partial(write_signal_files, result.signals)
    return files


def load_result(directory: str | PathLike[str]) -> Result:
    """Read a result folder and verify the checksums of its files.

    Parameters
    ----------
    directory : path
        Result folder, as written by `Response.save` or `vibroimpact run`.

    Returns
    -------
    Result
        The result as stored.

    Raises
    ------
    InputError
        If it is not a result folder, or one of its files is missing or damaged.

    See Also
    --------
    vibroimpact.Response : its method `save` writes one.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> import vibroimpact as vi
    >>> with TemporaryDirectory() as folder:
    ...     place = vi.simulate(vi.load_case("paper:type1-theory")).save(f"{folder}/theory")
    ...     vi.load_result(place).impacts["rebound_height_m"].round(4).tolist()
    [2.4111, 1.4572, 0.8846, 0.5409, 0.3346]
    """
    folder = Path(directory)
    recover(folder)  # an interrupted replacement may have left the folder under its temporary name
    if not (folder / SUMMARY).is_file():
        raise InputError(f"{folder}: this is not a result folder; it has no {SUMMARY}")
    name = SUMMARY  # the file being read: error messages name it
    try:
        summary = read_sealed(folder / name)
        for key, message in _OTHER_FOLDERS.items():
            if key in summary:
                raise InputError(f"{folder}: {message}")
        check_types(summary)
        expected = summary.get(CHECK_SUMS, {})
        name = CASE
        case: ResolvedCase = {}
        if "problem" not in summary["provenance"]:
            check_file(folder / name, expected.get(name))
            case = cast("ResolvedCase", read_toml(folder / name))
            check_case(case)
        name = NETCDF
        check_hdf5(folder / name, expected.get(name))
        return _result_from(case, summary, read_groups(folder / name))
    except InputError:
        raise
    except DamageError as error:
        raise InputError(f"{folder / name}: {error}; {_remedy(folder, name)}") from None
    except Exception as error:  # damaged files raise many types of exceptions
        raise InputError(
            f"{folder / name}: the file is missing or damaged: {_cause(error)}; "
            f"{_remedy(folder, name)}"
        ) from None


def _result_from(
    case: ResolvedCase, summary: Mapping[str, Any], groups: Mapping[str, Mapping[str, Any]]
) -> Result:
    """Return a result from the case, the summary and the groups of the NetCDF file, after
    checking its columns.
    """
    found = groups["impacts"]
    missing = set(FIRST_IMPACT_COLUMNS) - set(found)
    if missing:
        raise KeyError(f"no {', '.join(sorted(missing))}")
    impacts = {key: np.atleast_1d(found[key]) for key in impact_columns(found)}
    # of a folder that was written before there was this column
    for key in IMPACT_COLUMNS.keys() - found.keys():
        impacts[key] = np.full(impacts["impact"].shape, np.nan)
    history = {key: groups["history"][key] for key in history_columns(groups["history"])}
    _check_history(history)
    for group, columns in (("impacts", impacts), ("history", history)):
        shapes = {column.shape for column in columns.values()}
        if len(shapes) != 1 or len(shapes.pop()) != 1:
            raise ValueError(f"the columns of {group} differ in length")
    truncation = {}
    for body, error in summary.get("truncation", {}).items():
        truncation[body] = math.nan if error is None else float(error)  # JSON has no NaN
    return Result(
        case,
        impacts,
        history,
        {key: float(value) for key, value in groups["energy"].items()},
        summary["status"],
        dict(summary["provenance"]),
        dict(summary.get("deformation", {})),
        truncation,
        {body: dict(summary[body]) for body in ("sphere", "plate") if body in summary},
        groups["sensors"],
        groups["deflection"]["deflection"],
        groups["plate"]["shape"],
    )


def _check_history(history: Mapping[str, Any]) -> None:
    """Raise KeyError if a history lacks a column that every one has, or one of those that
    it has where a body vibrates.
    """
    needed = set(HISTORY_COLUMNS)
    if history.keys() & set(VIBRATION_HISTORY_COLUMNS):
        needed |= set(VIBRATION_HISTORY_COLUMNS)
    missing = sorted(needed - history.keys())
    if missing:
        raise KeyError(f"no {', '.join(missing)}")


def _cause(error: Exception) -> str:
    """Return the cause of a failed read in words."""
    if isinstance(error, KeyError):
        if error.args and not str(error.args[0]).startswith("no "):
            return f"it has no {error.args[0]}"
        return str(error.args[0])
    return short_reason(error)


def _remedy(folder: Path, name: str) -> str:
    """Return a sentence on how to restore a damaged file of a result."""
    # it may be the folder of another command
    unknown = name == SUMMARY and not (folder / NETCDF).is_file()
    if name == CASE or unknown or not (folder / CASE).is_file():
        return "make the result anew"
    return (
        f"make it anew with: vibroimpact run {shlex.quote(str(folder / CASE))} -o "
        f"{shlex.quote(str(folder))} --force"
    )
