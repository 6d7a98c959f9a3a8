"""The command `bound`, which computes the lowest error of classifiers that see stated
quantities of a population.
"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from vibroimpact.cli.completion import complete_case
from vibroimpact.cli.shared import (
    Force,
    Json,
    app,
    console,
    exit_on_interrupt,
    quantity_in,
    show_folder,
    stem,
)
from vibroimpact.errors import InputError


@app.command()
def bound(
    population: Annotated[
        str,
        typer.Argument(
            metavar="STUDY|DIR",
            autocompletion=complete_case,
            help="A study with classes, or the folder of a data set.",
        ),
    ],
    output: Annotated[
        Path | None,
        typer.Option(
            "-o", "--output", metavar="DIR", help="The folder to make; by default STUDY-bound."
        ),
    ] = None,
    samples: Annotated[
        int,
        typer.Option("--samples", metavar="N", min=100, help="Number of falls drawn from a study."),
    ] = 20_000,
    bandwidth: Annotated[
        str, typer.Option("--bandwidth", metavar="B", help="Upper end of the measured band.")
    ] = "10 kHz",
    signal_to_noise: Annotated[
        float,
        typer.Option(
            "--snr",
            metavar="DB",
            help="Peak force of the median fall over the noise in 10 kHz, in dB.",
        ),
    ] = 40.0,
    force: Force = False,
    as_json: Json = False,
) -> None:
    """Compute the lowest error of a classifier of stated quantities.

    This is the Bayes error of a population for a classifier that sees nothing else.
    The scatter of the amplitude is assumed; its share in the error is shown. The falls of a study
    are computed on its plate as a rigid body; those of a data set are read from it.
    """
    from vibroimpact.bayes_error.bound import bound_of
    from vibroimpact.bayes_error.folder import bound_document, save_bound
    from vibroimpact.bayes_error.observations import Channel
    from vibroimpact.bayes_error.text import bound_summary
    from vibroimpact.report.progress import patient_progress
    from vibroimpact.results.folder import check_free
    from vibroimpact.studies.read_sweep import load_sweep
    from vibroimpact.studies.study import read_study

    target = Path(f"{stem(population)}-bound") if output is None else output
    check_free(target, force=force)
    band = quantity_in("--bandwidth", bandwidth, "Hz")
    if not 10.0 <= band <= 1e7:
        raise InputError(
            f"{bandwidth} is not allowed; it must be 10 Hz or more, and at most 10 MHz",
            "--bandwidth",
        )
    if not -60.0 <= signal_to_noise <= 200.0:
        raise InputError(
            f"{signal_to_noise:g} is not allowed; it must be from -60 to 200 dB", "--snr"
        )
    screen = console(err=as_json)
    with exit_on_interrupt(), patient_progress("Bayes error", screen) as progress:
        found = (
            read_study(population) if Path(population).is_dir() else load_sweep(population, samples)
        )
        known = bound_of(
            found, Channel(bandwidth=band, signal_to_noise=signal_to_noise), progress=progress
        )
        folder = save_bound(known, target, force=force)
    show_folder(
        folder, lambda: bound_document(known), lambda: bound_summary(known), as_json=as_json
    )
