"""The command `correlate`, which compares a test with the simulation of the case."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from vibroimpact.cli.completion import complete_compared
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
from vibroimpact.errors import InputError, did_you_mean
from vibroimpact.quoting import quoted

if TYPE_CHECKING:
    from vibroimpact.cases.case import Case
    from vibroimpact.signals.record import Record
    from vibroimpact.test_analysis.correlate import Correlation
    from vibroimpact.test_analysis.responses.result import ResponseCorrelation


@app.command()
def correlate(
    case: CaseArgument,
    records: Annotated[
        list[Path],
        typer.Argument(
            metavar="RECORD...",
            help="Records of one test: CSV, WAV, UFF, NetCDF-4 or the folder of a run; or UFF "
            "with responses.",
        ),
    ],
    output: Annotated[Path | None, output_folder("CASE-correlated")] = None,
    hammer: Annotated[
        str | None,
        typer.Option(
            "--hammer",
            metavar="CHANNEL",
            help="Channel with the force of the hammer; for frequency responses, its node.",
        ),
    ] = None,
    window: Annotated[
        str | None,
        typer.Option(
            "--window",
            metavar="TIME",
            help="Compared time after first touch; by default to the next impact or the end.",
        ),
    ] = None,
    band: Annotated[
        str | None,
        typer.Option(
            "--band",
            metavar="FROM,TO",
            help=(
                'Band of frequencies, such as "100 Hz, 5 kHz"; by default from half the '
                "lowest mode to the highest, or to what the sensors "
                "pass or the force excites, if that is less."
            ),
        ),
    ] = None,
    compare: Annotated[
        str | None,
        typer.Option(
            "--compare",
            metavar="KIND",
            autocompletion=complete_compared,
            help=(
                "For UFF files with both: records or responses; by default responses, "
                "unless --window, the channel of --hammer or another file asks for records."
            ),
        ),
    ] = None,
    columns: Columns = None,
    changes: Changes = None,
    figures: Figures = False,
    force: Force = False,
    as_json: Json = False,
) -> None:
    """Compare records of a test with the simulation. Results are residuals, frequency responses,
    FRAC, and modal damping from the decay.

    The case specifies the plate, the sensors, named as the records, and the impact; for a hammer
    with a measured force only its position. Measured frequency responses are compared with those of
    the case, and so are the modes that are fitted to them.
    """
    from vibroimpact.cases.reader import load_case
    from vibroimpact.files.result_folder import check_free
    from vibroimpact.signals.reading.record_files import load_records
    from vibroimpact.test_analysis.compared_kind import compared_kind

    test_case = load_case(case, settings_of(changes))
    target = output or Path(f"{stem(case)}-correlated")
    check_free(target, force=force)
    window_length = None
    if window is not None:
        window_length = quantity_in("--window", window, "s")
    band_ends = None
    if band is not None:
        band_ends = pair_in("--band", band, "Hz", "a lower and an upper frequency", "100 Hz, 5 kHz")
    compared = compared_kind(records, compare, hammer, windowed=window_length is not None)
    correlation: Correlation | ResponseCorrelation
    if compared.kind == "responses":
        if window_length is not None:
            raise InputError(
                "frequency responses have no time; leave it out, or take a --band", "--window"
            )
        correlation = _correlated_responses(test_case, records, hammer, band_ends, as_json=as_json)
    else:
        measured = [record for path in records for record in load_records(path, columns)]
        correlation = _correlated_records(
            test_case, measured, hammer, window_length, band_ends, as_json=as_json
        )
    correlation = replace(correlation, doubts=(*compared.remarks, *correlation.doubts))
    save_and_show(correlation, target, force=force, figures=figures, as_json=as_json)


def _correlated_records(
    case: Case,
    records: list[Record],
    force_channel: str | None,
    window: float | None,
    band: tuple[float, float] | None,
    *,
    as_json: bool,
) -> Correlation:
    """Return the comparison of records with the simulation of a case."""
    from vibroimpact.test_analysis.correlate import correlate as correlate_records

    force = None
    if force_channel is not None:
        force = _force_among(records, force_channel)
    motions = [record for record in records if record is not force]
    with progress_of("correlating", as_json=as_json) as progress:
        return correlate_records(
            case, motions, force=force, window=window, band=band, progress=progress
        )


def _correlated_responses(
    case: Case,
    paths: list[Path],
    reference: str | None,
    band: tuple[float, float] | None,
    *,
    as_json: bool,
) -> ResponseCorrelation:
    """Return the comparison of measured frequency responses with those of a case."""
    from vibroimpact.signals.reading.universal_responses import load_responses
    from vibroimpact.test_analysis.responses.compare import correlate_responses

    responses = [response for path in paths for response in load_responses(path)]
    with progress_of("correlating", as_json=as_json) as progress:
        return correlate_responses(
            case, responses, reference=reference, band=band, progress=progress
        )


def _force_among(records: list[Record], name: str) -> Record:
    """Return the record of a channel.

    Raises
    ------
    InputError
        If there is none of this name, or several.
    """
    from vibroimpact.signals.reading.one_record import is_named

    named = [record for record in records if is_named(record, name)]
    if len(named) == 1:
        return named[0]
    number = "are several channels" if named else "is no channel"
    names = list(dict.fromkeys(record.name for record in records))
    raise InputError(
        f"--hammer {quoted(name)}: there {number} of this name; the records are "
        f"{', '.join(map(quoted, names))}.{did_you_mean(name, names)}"
    )
