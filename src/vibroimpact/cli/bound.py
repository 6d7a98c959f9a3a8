"""The command `bound`, which computes the lowest error of classifiers of a population."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from vibroimpact.cli.completion import complete_case
from vibroimpact.cli.shared import (
    Force,
    Json,
    app,
    output_folder,
    progress_of,
    quantity_in,
    save_and_show,
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
    output: Annotated[Path | None, output_folder("STUDY-bound")] = None,
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
    from vibroimpact.bayes_error.observations import Channel
    from vibroimpact.files.result_folder import check_free
    from vibroimpact.studies.computation.study import load_study
    from vibroimpact.studies.planning.sweep_file import load_sweep

    target = output or Path(f"{stem(population)}-bound")
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
    channel = Channel(bandwidth=band, signal_to_noise=signal_to_noise)
    with progress_of("Bayes error", as_json=as_json) as progress:
        is_study = Path(population).is_dir()
        falls = load_study(population) if is_study else load_sweep(population, samples)
        bound = bound_of(falls, channel, progress=progress)
    save_and_show(bound, target, force=force, as_json=as_json)
