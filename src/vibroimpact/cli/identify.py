"""The command `identify`, which estimates an impact from records."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from vibroimpact.cli.shared import (
    CaseArgument,
    Changes,
    Columns,
    Figures,
    Force,
    Json,
    app,
    output_folder,
    pair_in,
    progress_of,
    quantity_in,
    save_and_show,
    settings_of,
    stem,
)


@app.command()
def identify(
    case: CaseArgument,
    records: Annotated[
        list[Path],
        typer.Argument(
            metavar="RECORD...",
            help="Records of one fall: CSV, WAV, UFF, NetCDF-4 or the folder of a run.",
        ),
    ],
    output: Annotated[Path | None, output_folder("CASE-identified")] = None,
    place: Annotated[
        str | None,
        typer.Option(
            "--place",
            metavar="X,Y",
            help='Position of the impact, such as "60 mm, 40 mm"; by default it is estimated.',
        ),
    ] = None,
    window: Annotated[
        str,
        typer.Option(
            "--window",
            metavar="TIME",
            help="Time from first touch on that is used; it must end before the next impact.",
        ),
    ] = "5 ms",
    frequency_error: Annotated[
        float,
        typer.Option(
            "--frequency-error",
            metavar="PART",
            help="Uncertainty of the plate's frequencies, in addition to the error of the mesh: "
            "0.01 for 1 %.",
        ),
    ] = 0.0,
    sensor_error: Annotated[
        str,
        typer.Option(
            "--sensor-error",
            metavar="LENGTH",
            help="Uncertainty of the position of each sensor along x and y.",
        ),
    ] = "0 mm",
    gain_error: Annotated[
        float,
        typer.Option(
            "--gain-error",
            metavar="PART",
            help="Uncertainty of the sensitivity of each sensor: 0.02 for 2 %.",
        ),
    ] = 0.0,
    thickness_error: Annotated[
        float,
        typer.Option(
            "--thickness-error",
            metavar="PART",
            help="Uncertainty of the thickness of the plate: 0.01 for 1 %.",
        ),
    ] = 0.0,
    modulus_error: Annotated[
        float,
        typer.Option(
            "--modulus-error",
            metavar="PART",
            help="Uncertainty of Young's modulus of the plate: 0.03 for 3 %.",
        ),
    ] = 0.0,
    resonance_error: Annotated[
        float,
        typer.Option(
            "--resonance-error",
            metavar="PART",
            help="Uncertainty of the mounted resonance of each accelerometer: 0.1 for 10 %.",
        ),
    ] = 0.0,
    columns: Columns = None,
    changes: Changes = None,
    figures: Figures = False,
    force: Force = False,
    as_json: Json = False,
) -> None:
    """Identify an impact from records of sensors. Force, position, size and speed are estimated
    with 95 % intervals.

    The case specifies the plate, the sensors, named as the records, and the material of the sphere.
    Errors of what it specifies are in the intervals only if they are stated, as standard
    deviations.
    """
    from vibroimpact.cases.reader import load_case
    from vibroimpact.files.result_folder import check_free
    from vibroimpact.identification.identify import identify as identify_impact
    from vibroimpact.identification.setup import SetupErrors
    from vibroimpact.signals.reading.record_files import load_records

    plate_case = load_case(case, settings_of(changes))
    target = output or Path(f"{stem(case)}-identified")
    check_free(target, force=force)
    position = None
    if place is not None:
        position = pair_in("--place", place, "m", "x and y", "60 mm, 40 mm")
    window_length = quantity_in("--window", window, "s")
    errors = SetupErrors(
        quantity_in("--sensor-error", sensor_error, "m"),
        gain_error,
        thickness_error,
        modulus_error,
        resonance_error,
    )
    measured = [record for path in records for record in load_records(path, columns)]
    with progress_of("identifying", as_json=as_json) as progress:
        identification = identify_impact(
            plate_case,
            measured,
            place=position,
            window=window_length,
            frequency_error=frequency_error,
            errors=errors,
            progress=progress,
        )
    save_and_show(identification, target, force=force, figures=figures, as_json=as_json)
