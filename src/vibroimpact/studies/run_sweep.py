"""Run a study in its folder: computation and report."""

from __future__ import annotations

from collections.abc import Callable
from os import PathLike
from pathlib import Path

from vibroimpact.studies.computation.compute_study import MEMORY, compute_study
from vibroimpact.studies.computation.study import load_study
from vibroimpact.studies.planning.sweep import Sweep
from vibroimpact.studies.report.write_report import write_study_report


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

    Each chunk of drops is written as soon as it is computed. After any interruption, `resume`
    continues with the missing chunks, and the results are identical to the last bit.

    Parameters
    ----------
    sweep : Sweep
        The study, from `load_sweep` or `sweep_of`.
    directory : path
        The folder to create.
    resume : bool, default False
        Continue the study in the folder; start it if there is none.
    force : bool, default False
        Replace an existing study.
    workers : int, default 1
        Number of processes; 1 is this process itself. A script that uses more must be guarded by
        `if __name__ == "__main__":`.
    scheduler : str, optional
        Address of a Dask scheduler whose workers compute, such as "tcp://10.0.0.5:8786"; "local"
        starts one with `workers` workers.
    memory : float, default 5e8
        Approximate memory for the drops of a chunk in each process [bytes], >= 1e6; a resumed study
        keeps its chunks.
    progress : callable, optional
        Called with the number of completed drops and of all drops. An exception that it raises ends
        the run, which can be resumed.
    modes_progress : callable, optional
        Called with the completed fraction of the computation of modes of elastic bodies, in [0, 1].
    tell : callable, optional
        Called with sentences on lengthy steps and recomputed chunks.

    Returns
    -------
    pathlib.Path
        The folder.

    Raises
    ------
    InputError
        If the folder contains something else or another study, another process is computing in it,
        or the ledger is damaged.
    ComputationError
        If the disk is full, or the workers are lost.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> import vibroimpact as vi
    >>> case = vi.load_case("paper:type1-theory").to_problem().source
    >>> study = vi.studies.sweep_of({**case, "sweep": {"over": {"drop.height": ["1 m", "2 m"]}}})
    >>> with TemporaryDirectory() as folder:
    ...     vi.studies.load_study(vi.studies.run_sweep(study, f"{folder}/heights")).values(
    ...         "largest_force_N"
    ...     ).round(1).tolist()
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
        progress(sweep.size, sweep.size)  # lets the callback interrupt before the report
    write_study_report(load_study(folder))
    return folder
