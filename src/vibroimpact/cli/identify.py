"""The command `identify`, which estimates force, position, size and speed of an impact
from records.
"""

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
    console,
    exit_on_interrupt,
    pair_in,
    quantity_in,
    settings_of,
    show_folder,
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
    output: Annotated[
        Path | None,
        typer.Option(
            "-o", "--output", metavar="DIR", help="The folder to make; by default CASE-identified."
        ),
    ] = None,
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
    from vibroimpact.identification.document import summary_of_identification
    from vibroimpact.identification.folder import save_identification
    from vibroimpact.identification.identify import identify as identified
    from vibroimpact.identification.setup import SetupErrors
    from vibroimpact.identification.text import identification_summary
    from vibroimpact.report.progress import patient_progress
    from vibroimpact.results.folder import check_free
    from vibroimpact.signals.read_records import read_records

    found = load_case(case, settings_of(changes))
    target = Path(f"{stem(case)}-identified") if output is None else output
    check_free(target, force=force)
    where = None if place is None else pair_in("--place", place, "m", "x and y", "60 mm, 40 mm")
    length = quantity_in("--window", window, "s")
    errors = SetupErrors(
        quantity_in("--sensor-error", sensor_error, "m"),
        gain_error,
        thickness_error,
        modulus_error,
        resonance_error,
    )
    heard = [record for path in records for record in read_records(path, columns)]
    with exit_on_interrupt():
        with patient_progress("identifying", console(err=as_json)) as progress:
            told = identified(
                found,
                heard,
                place=where,
                window=length,
                frequency_error=frequency_error,
                errors=errors,
                progress=progress,
            )
        folder = save_identification(told, target, force=force, figures=("png",) if figures else ())
    show_folder(
        folder,
        lambda: summary_of_identification(told),
        lambda: identification_summary(told),
        as_json=as_json,
    )
