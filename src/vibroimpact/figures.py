"""Figures as files, of the charts of a result folder or of a study."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import ExitStack
from functools import partial
from os import PathLike
from pathlib import Path

from vibroimpact.charts.files import check_formats, save_charts
from vibroimpact.errors import InputError
from vibroimpact.files.new_folders import made_folder
from vibroimpact.files.recover import recover
from vibroimpact.files.result_folder import FIGURES
from vibroimpact.report.page import replace_report_files
from vibroimpact.report.save_report import write_figures
from vibroimpact.results.folder import load_result
from vibroimpact.results.result import Result


def save_figures(
    directory: str | PathLike[str],
    formats: Sequence[str] = ("png",),
    output: str | PathLike[str] | None = None,
    progress: Callable[[float], None] = lambda done: None,
) -> Path:
    """Write the charts of a result folder or of a study as files: all of them or none.

    Of a run also `plate.gif` is written, its plate in motion, if the plate deforms.

    Parameters
    ----------
    directory : path
        The folder of a run or of a study.
    formats : sequence of str
        Of "png", "svg" and "pdf".
    output : path, optional
        Folder into which they are written, and which is made if it is not there; by default
        `figures` in `directory`.
    progress : callable, optional
        Called with the fraction done.

    Returns
    -------
    pathlib.Path
        The folder with the figures.

    Raises
    ------
    InputError
        If it is neither a result folder nor a study, its data are damaged, there is no such format,
        or it can't be written to.

    Examples
    --------
    >>> import tempfile
    >>> import vibroimpact as vi
    >>> response = vi.simulate(vi.load_case("paper:type1-theory"))
    >>> with tempfile.TemporaryDirectory() as temporary:
    ...     folder = response.save(f"{temporary}/theory")
    ...     sorted(file.name for file in save_figures(folder, ["svg"]).iterdir())[:3]
    ['acceleration.svg', 'energy.svg', 'force.svg']
    """
    check_formats(formats)
    folder = Path(directory)
    recover(folder)
    write = _writer_of(folder, formats, progress)
    if output is None:
        replace_report_files(folder, partial(_write_below, write))
        return folder / FIGURES
    target = Path(output)
    with ExitStack() as stack:
        try:
            stack.enter_context(made_folder(target))
        except OSError as error:
            raise InputError(f"{target}: the folder can't be made: {error.strerror}") from None
        recover(target)
        replace_report_files(target, write)
    return target


def _write_below(write: Callable[[Path], None], folder: Path) -> None:
    (folder / FIGURES).mkdir()
    write(folder / FIGURES)


def _writer_of(
    folder: Path, formats: Sequence[str], progress: Callable[[float], None]
) -> Callable[[Path], None]:
    """Return the function that writes the figures of a result folder or a study."""
    from vibroimpact.studies.computation.study_folder import is_study

    if is_study(folder):
        from vibroimpact.studies.computation.study import load_study

        charts = load_study(folder).report.charts

        def write(target: Path) -> None:
            save_charts(charts, target, formats, progress)

        return write
    report = _result_in(folder).report
    return partial(write_figures, report, formats=formats, progress=progress)


def _result_in(folder: Path) -> Result:
    """Return the result in a folder.

    A reproduction of the paper has none, and has its figures already.
    """
    try:
        return load_result(folder)
    except InputError:
        from vibroimpact.paper.report.reproduction import is_reproduction

        if is_reproduction(folder):
            raise InputError(
                f"{folder}: a reproduction of the paper has its figures already, in "
                f"{folder / FIGURES}"
            ) from None
        raise
