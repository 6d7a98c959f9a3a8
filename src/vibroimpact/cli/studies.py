"""The commands `sweep` and `dataset`, which run a study of many drops."""

from __future__ import annotations

import os
import shlex
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from vibroimpact.cli.completion import complete_case
from vibroimpact.cli.shared import (
    Json,
    app,
    console,
    fail,
    interrupt_flag,
    note,
    output_folder,
    quantity_in,
    say,
    show,
    stem,
)
from vibroimpact.errors import InputError
from vibroimpact.quoting import quoted

if TYPE_CHECKING:
    from vibroimpact.studies.planning.sweep import Sweep

MOST_DROPS_UNCONFIRMED = 100_000
"""Number of drops above which a study must be confirmed by --yes."""

MOST_BYTES_UNCONFIRMED = 10e9
"""Size of the results on disk above which a study must be confirmed [byte]."""


Output = Annotated[Path | None, output_folder("STUDY-sweep")]
Resume = Annotated[
    bool,
    typer.Option(
        "--resume", help="Continue the study in the folder, or start it if there is none."
    ),
]
Force = Annotated[bool, typer.Option("--force", help="Replace the folder of an existing study.")]
Yes = Annotated[
    bool,
    typer.Option(
        "--yes",
        help=f"Confirm more than {MOST_DROPS_UNCONFIRMED:,} drops, or "
        f"{MOST_BYTES_UNCONFIRMED / 1e9:g} GB of results.",
    ),
]
Processes = Annotated[
    int | None,
    typer.Option(
        "--processes", metavar="N", min=1, help="Number of processes; by default one per core."
    ),
]
Scheduler = Annotated[
    str | None,
    typer.Option(
        "--scheduler",
        metavar="ADDRESS",
        help='Dask scheduler, such as tcp://10.0.0.5:8786; "local" starts one on this machine.',
    ),
]
Memory = Annotated[
    str,
    typer.Option(
        "--memory",
        metavar="SIZE",
        help="Memory that each process may use for the drops that it computes at once.",
    ),
]


@app.command()
def sweep(
    study: Annotated[
        str,
        typer.Argument(
            metavar="STUDY", autocompletion=complete_case, help="A case with a [sweep] section."
        ),
    ],
    output: Output = None,
    resume: Resume = False,
    force: Force = False,
    yes: Yes = False,
    processes: Processes = None,
    scheduler: Scheduler = None,
    memory: Memory = "500 MB",
    as_json: Json = False,
) -> None:
    """Run a parameter study on all cores, or on a Dask cluster.

    The [sweep] section of the case specifies the swept keys. Completed drops are kept if the study
    is interrupted; --resume continues it.
    """
    options = {
        "resume": resume,
        "force": force,
        "yes": yes,
        "processes": processes,
        "memory": memory,
    }
    _interruptible("sweep", study, output, None, scheduler, as_json=as_json, **options)


@app.command()
def dataset(
    study: Annotated[
        str,
        typer.Argument(
            metavar="STUDY",
            autocompletion=complete_case,
            help="A case with a [sweep] section that has classes.",
        ),
    ],
    output: Annotated[Path | None, output_folder("STUDY-dataset")] = None,
    samples: Annotated[
        int | None,
        typer.Option(
            "--samples", metavar="N", min=1, help="Number of falls; by default that of the study."
        ),
    ] = None,
    resume: Resume = False,
    force: Force = False,
    yes: Yes = False,
    processes: Processes = None,
    scheduler: Scheduler = None,
    memory: Memory = "500 MB",
    as_json: Json = False,
) -> None:
    """Compute a data set of labelled signals. It has falls of rocks of several classes.

    Completed falls are kept if it is interrupted; --resume continues it. "vibroimpact recognise"
    trains classifiers on it.
    """
    options = {
        "resume": resume,
        "force": force,
        "yes": yes,
        "processes": processes,
        "memory": memory,
    }
    _interruptible("dataset", study, output, samples, scheduler, as_json=as_json, **options)


def _interruptible(
    command: str,
    study: str,
    output: Path | None,
    samples: int | None,
    scheduler: str | None,
    *,
    as_json: bool,
    **options: Any,
) -> None:
    """Run a study; after Ctrl-C tell the command that goes on."""
    target = output or Path(f"{stem(study)}-{command}")
    again = f"vibroimpact {command} {shlex.quote(study)} -o {shlex.quote(str(target))} --resume"
    if scheduler is not None:
        again += f" --scheduler {shlex.quote(scheduler)}"
    if samples is not None:
        again += f" --samples {samples}"
    message = f"interrupted; completed drops are kept; continue with: {again}"
    try:
        # entered first, so that no Ctrl-C is lost during imports
        with interrupt_flag(message) as stopped:
            _run_sweep(
                command,
                study,
                target,
                stopped,
                samples=samples,
                scheduler=scheduler,
                as_json=as_json,
                **options,
            )
    except KeyboardInterrupt:
        fail(message, 130)


def _run_sweep(
    command: str,
    study: str,
    target: Path,
    stopped: Callable[[], bool],
    *,
    samples: int | None,
    memory: str,
    resume: bool,
    force: bool,
    yes: bool,
    processes: int | None,
    scheduler: str | None,
    as_json: bool,
) -> None:
    """Run a study with the options of a command.

    Raises
    ------
    KeyboardInterrupt
        At the next safe point, once `stopped` returns True.
    """
    from vibroimpact.report.progress import counting_progress, patient_progress
    from vibroimpact.report.terminal_report import terminal_report
    from vibroimpact.studies.computation.compute_study import compute_study
    from vibroimpact.studies.computation.study import load_study
    from vibroimpact.studies.computation.study_folder import has_study
    from vibroimpact.studies.planning.sweep_file import load_sweep
    from vibroimpact.studies.planning.unit_slips import sweep_slips
    from vibroimpact.studies.report.write_report import write_study_report

    size = quantity_in("--memory", memory, "byte")
    if size < 1e6:
        raise InputError(f"{memory} is too little; it must be 1 MB or more", "--memory")
    sweep = load_sweep(study, samples)
    screen = console(err=as_json)
    if command == "dataset":
        _check_labelled(study, sweep)
    _check_confirmed(study, sweep, yes=yes or (resume and has_study(target)))
    for doubt in sweep_slips(sweep):
        note(f"warning: {doubt}")  # before the computation, not only in the report
    with (
        patient_progress("computing modes", screen) as modes,
        counting_progress("drops", screen) as count,
    ):

        def raise_if_stopped() -> None:
            if stopped():
                raise KeyboardInterrupt

        def progress(done: int, total: int) -> None:
            count(done, total)
            raise_if_stopped()

        def modes_progress(done: float) -> None:
            modes(done)
            raise_if_stopped()

        raise_if_stopped()
        folder = compute_study(
            sweep,
            target,
            resume=resume,
            force=force,
            workers=processes or _cores(),
            scheduler=scheduler,
            memory=size,
            progress=progress,
            modes_progress=modes_progress,
            tell=note,
        )
        progress(sweep.size, sweep.size)
        completed = load_study(folder)
        write_study_report(completed)
    show(
        lambda: {"folder": str(folder), **completed.document},
        lambda: terminal_report(completed.report),
        as_json=as_json,
    )
    written = ["study.nc"]
    if completed.labels:
        written.append("card.md")
    paths = ", ".join(str(folder / name) for name in written)
    say(f"wrote {paths} and {folder / 'report.html'}", err=as_json)


def _check_labelled(study: str, sweep: Sweep) -> None:
    """Raise InputError if a study has no classes, or does not keep signals."""
    if sweep.population is None:
        message = (
            'a data set has classes: give design = "population" and tables such as '
            "[sweep.classes.coal.over]"
        )
        raise InputError(f"{study}: sweep.design: {message}")
    if "signals" not in sweep.section.keep:
        raise InputError(
            f"{study}: sweep.keep: a data set has signals, and these are not kept; give "
            'keep = ["signals"]'
        )


def _check_confirmed(study: str, sweep: Sweep, *, yes: bool) -> None:
    """Raise InputError if a study is large and not confirmed."""
    if sweep.size > MOST_DROPS_UNCONFIRMED and not yes:
        raise InputError(
            f"{study}: there would be {sweep.size:,} drops, more than "
            f"{MOST_DROPS_UNCONFIRMED:,}; confirm that they are wanted with --yes"
        )
    if sweep.bytes > MOST_BYTES_UNCONFIRMED and not yes:
        message = (
            f"the results would take about {sweep.bytes / 1e9:.3g} GB, more than "
            f"{MOST_BYTES_UNCONFIRMED / 1e9:g} GB"
        )
        keep = quoted(list(sweep.section.keep))
        raise InputError(
            f"{study}: {message}; confirm that they are wanted with --yes, or keep less: "
            f"sweep.keep is {keep}"
        )


def _cores() -> int:
    """Return the number of cores available to this process."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1  # macOS and Windows do not tell which are allowed
