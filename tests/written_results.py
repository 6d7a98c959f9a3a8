"""Results written without their pages, which take time."""

from __future__ import annotations

from pathlib import Path

from vibroimpact.files.result_folder import write_files, write_summary
from vibroimpact.results.folder import CHECKED_FILES, result_files
from vibroimpact.results.result import Result
from vibroimpact.results.summary import summary_of


def write_result(result: Result, folder: Path) -> None:
    """Write the data files of a result and their summary into an existing folder."""
    write_files(result_files(result), folder)
    write_summary(summary_of(result), folder, CHECKED_FILES)
