"""Run a study in its folder, to the report."""

from __future__ import annotations

from collections.abc import Callable
from os import PathLike
from pathlib import Path

from vibroimpact.studies.compute_study import MEMORY, compute_study
from vibroimpact.studies.report.page import write_study_report
from vibroimpact.studies.study import read_study
from vibroimpact.studies.sweep import Sweep


def run_sweep(
    sweep: Sweep,
    directory: str | PathLike[str],
    *,
    resume: bool = False,
    force: bool = False,
    workers: int = 1,
    scheduler: str | None = None,
    memory: float = MEMORY,
    progress: Callable[[int, int], None] | None = None,
    modes_progress: Callable[[float], None] | None = None,
    tell: Callable[[str], None] | None = None,
) -> Path:
    """Run a study in a folder: `study.nc`, `drops.csv`, a report, and the ledger of its chunks.

    Each chunk of drops is written as soon as it is computed. Whatever stops the run, `resume` goes on after the last of them, and the
    results are the same to the last bit.

    Parameters
    ----------
    sweep : Sweep
        The study, as `load_sweep` or `read_sweep` reads it.
    directory : path
        The folder to make.
    resume : bool, default False
        Go on with the study that was begun there; where there is none, begin.
    force : bool, default False
        Replace the folder of a study that is there.
    workers : int, default 1
        How many processes compute; one is this process itself. A script that asks for more must do its work under
        `if __name__ == "__main__":`.
    scheduler : str, optional
        The address of a Dask scheduler whose workers compute, such as "tcp://10.0.0.5:8786"; "local" starts one with `workers`.
    memory : float, default 5e8
        About how many bytes the drops of a chunk may take in each process, >= 1e6; what a study was begun with is kept.
    progress : callable, optional
        Is told how many drops are done, and of how many. What it raises ends the run, which can be resumed.
    modes_progress : callable, optional
        Is told which part of the modes of elastic bodies is computed, in [0, 1].
    tell : callable, optional
        Is told in words what takes long, or is made again.

    Returns
    -------
    pathlib.Path
        The folder.

    Raises
    ------
    InputError
        If something else is there, another sweep is at work in it, the ledger is damaged, or it is of another study.
    ComputationError
        If the disk is full, or the workers are gone.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> import vibroimpact as vi
    >>> case = vi.load_case("paper:type1-theory").to_problem().source
    >>> study = vi.read_sweep({**case, "sweep": {"over": {"drop.height": ["1 m", "2 m"]}}})
    >>> with TemporaryDirectory() as folder:
    ...     vi.read_study(vi.run_sweep(study, f"{folder}/heights")).values("largest_force_N").round(1).tolist()
    [4406.8, 6730.2]
    """
    folder = compute_study(
        sweep,
        directory,
        resume=resume,
        force=force,
        workers=workers,
        scheduler=scheduler,
        memory=memory,
        progress=progress,
        modes_progress=modes_progress,
        tell=tell,
    )
    if progress is not None:
        progress(sweep.size, sweep.size)  # who was told to stop while the results were put together does
    write_study_report(read_study(folder), folder)
    return folder
