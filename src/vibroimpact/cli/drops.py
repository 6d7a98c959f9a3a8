"""The commands for one case: `demo`, `run`, `check`, `modes`, `report` and `figures`."""

from __future__ import annotations

import shlex
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from vibroimpact.cli.shared import (
    CaseArgument,
    Changes,
    Figures,
    Force,
    Json,
    app,
    console,
    exit_on_interrupt,
    names_in,
    note,
    output_folder,
    save_and_show,
    say,
    settings_of,
    show,
    show_folder,
    stem,
    write_and_show,
)
from vibroimpact.errors import InputError

if TYPE_CHECKING:
    from vibroimpact.cases.elastic.modes import BodyModes
    from vibroimpact.modes.tables import MeasuredTable


@app.command()
def demo(
    output: Annotated[
        Path, typer.Option("-o", "--output", metavar="DIR", help="The result folder to make.")
    ] = Path("vibroimpact-demo"),
    force: Force = False,
    as_json: Json = False,
) -> None:
    """Run the paper's Type 1 as a first example.

    A rock sphere falls from 4 m onto a steel plate and bounces five times.
    """
    _run("paper:type1-variable", output, {}, None, figures=False, force=force, as_json=as_json)


@app.command()
def run(
    case: CaseArgument,
    output: Annotated[
        Path | None,
        typer.Option(
            "-o",
            "--output",
            metavar="DIR",
            help="The result folder to make; by default named after the case.",
        ),
    ] = None,
    changes: Changes = None,
    figures: Figures = False,
    drop: Annotated[
        int | None,
        typer.Option(
            "--drop",
            metavar="N",
            min=0,
            help="Number of the drop to run, as in drops.csv, for a case with a [sweep] section.",
        ),
    ] = None,
    force: Force = False,
    as_json: Json = False,
) -> None:
    """Run a case and write its result folder.

    The folder contains the full case, the impact table, the data as NetCDF, and a report with
    interactive charts.
    """
    _run(case, output, settings_of(changes), drop, figures=figures, force=force, as_json=as_json)


@app.command()
def check(case: CaseArgument, changes: Changes = None, as_json: Json = False) -> None:
    """Validate and explain a case or a study, without running it."""
    from vibroimpact.calibration.observed.section import check_target
    from vibroimpact.cases.build import check_drop
    from vibroimpact.cases.reader import load_case, load_table, prefix_errors
    from vibroimpact.runs.case_document import case_document
    from vibroimpact.runs.case_explained import case_explained
    from vibroimpact.studies.planning.explain_sweep import explain_sweep, sweep_document
    from vibroimpact.studies.planning.sweep_file import sweep_of

    others = settings_of(changes)
    table = prefix_errors(case, lambda: load_table(case, others))
    if "sweep" not in table:
        loaded = load_case(case, others)
        prefix_errors(case, lambda: check_drop(loaded))
        prefix_errors(case, lambda: check_target(loaded.calibrate))
        show(
            lambda: prefix_errors(case, lambda: case_document(loaded)),
            lambda: prefix_errors(case, lambda: case_explained(loaded)),
            as_json=as_json,
        )
        return
    study = prefix_errors(case, lambda: sweep_of(table))
    show(
        lambda: {
            "study": sweep_document(study),
            **prefix_errors(case, lambda: case_document(study.case, study.axes)),
        },
        lambda: explain_sweep(study),
        lambda: prefix_errors(case, lambda: case_explained(study.case, study.axes)),
        as_json=as_json,
    )


def _run(
    name: str,
    output: Path | None,
    changes: dict[str, Any],
    drop: int | None,
    *,
    figures: bool,
    force: bool,
    as_json: bool,
) -> None:
    from vibroimpact.cases.costs import describe_costs
    from vibroimpact.cases.reader import load_case, prefix_errors
    from vibroimpact.dynamics.simulate import simulate
    from vibroimpact.files.result_folder import check_free, new_folder
    from vibroimpact.report.progress import patient_progress
    from vibroimpact.report.save_report import fill_folder
    from vibroimpact.report.terminal_report import terminal_report
    from vibroimpact.results.result import result_of
    from vibroimpact.runs.paraview import PARAVIEW, write_paraview
    from vibroimpact.studies.planning.sweep_file import load_drop

    if drop is None:
        case = load_case(name, changes)
        default_folder = stem(name)
    else:
        case = load_drop(name, drop, changes)
        default_folder = f"{stem(name)}-drop-{drop}"
    target = output or Path(default_folder)
    check_free(target, force=force)  # fail before the computation
    if case.sweep is not None:
        phrase = (
            f"vibroimpact sweep {shlex.quote(name)} runs the study, and --drop N one of its drops"
        )
        note(f"[sweep] is left out, as this is a single drop; {phrase}")
    for sentence in describe_costs(case):
        note(sentence)
    screen = console(err=as_json)
    with exit_on_interrupt():
        with patient_progress("computing modes", screen) as progress:
            problem = prefix_errors(name, lambda: case.to_problem(progress, note))
        with patient_progress("simulating", screen) as progress:
            response = simulate(problem, progress)
        with new_folder(target, force=force) as folder:
            result = result_of(response)
            write_paraview(response, folder / PARAVIEW)
            # of a long run it may take as much memory as the result: release it before charts are
            # made
            del response
            with patient_progress("drawing figures", screen) as progress:
                formats = ("png",) if figures else ()
                fill_folder(result.report, folder, formats, progress)
    beside = "figures" if figures else ""
    show_folder(
        target,
        lambda: result.document,
        lambda: terminal_report(result.report),
        as_json=as_json,
        beside=beside,
    )


@app.command()
def modes(
    case: CaseArgument,
    output: Annotated[Path | None, output_folder("CASE-modes")] = None,
    measured: Annotated[
        list[Path] | None,
        typer.Option(
            "--measured",
            metavar="FILE",
            help="A universal file with frequency responses; its modes are compared.",
        ),
    ] = None,
    changes: Changes = None,
    figures: Figures = False,
    force: Force = False,
    as_json: Json = False,
) -> None:
    """Compute the modes of elastic bodies, or fit measured ones.

    In place of a case a universal file with frequency responses may be given.

    The folder contains a table of frequencies, a report with the first mode shapes, and the meshes
    for ParaView, Nastran and Abaqus.
    """
    from vibroimpact.cases.costs import describe_costs
    from vibroimpact.cases.elastic.modes import compute_modes
    from vibroimpact.cases.reader import load_case, prefix_errors
    from vibroimpact.files.result_folder import check_free
    from vibroimpact.measurements.universal_file import is_universal
    from vibroimpact.modes.report import report_of
    from vibroimpact.report.progress import patient_progress

    target = output or Path(f"{stem(case)}-modes")
    if Path(case).is_file() and is_universal(case):
        if changes:
            raise InputError(f"{case} is a measurement, which has no keys; leave it out", "--set")
        check_free(target, force=force)
        measured_modes(
            [Path(case), *(measured or [])], target, figures=figures, force=force, as_json=as_json
        )
        return
    loaded = load_case(case, settings_of(changes))
    check_free(target, force=force)
    for sentence in describe_costs(loaded, modes_alone=True):
        note(sentence)
    screen = console(err=as_json)
    with exit_on_interrupt():
        with patient_progress("computing modes", screen) as progress:
            bodies = prefix_errors(case, lambda: compute_modes(loaded, progress, note))
        files = "modes.csv and meshes"
        measured_table = None
        if measured:
            files = "modes.csv, measured.csv and meshes"
            measured_table = modes_beside_table(bodies, measured)
        report = report_of(bodies, measured_table)
    write_and_show(report, target, force=force, figures=figures, as_json=as_json, beside=files)


@app.command()
def report(
    directory: Annotated[Path, typer.Argument(metavar="DIR", help="A result folder.")],
) -> None:
    """Regenerate the report of a result folder."""
    from vibroimpact.regenerate import remake_report

    say(f"wrote {remake_report(directory) / 'report.html'}")


@app.command()
def figures(
    directory: Annotated[
        Path, typer.Argument(metavar="DIR", help="A result folder, or the folder of a study.")
    ],
    formats: Annotated[
        str,
        typer.Option(
            "--format", metavar="NAMES", help="Formats, separated by commas: png, svg, pdf."
        ),
    ] = "png",
    output: Annotated[
        Path | None,
        typer.Option(
            "-o",
            "--output",
            metavar="FOLDER",
            help="The folder to write to; by default DIR/figures.",
        ),
    ] = None,
) -> None:
    """Write the charts of a run or a study as files.

    For a run whose elastic plate is hit an animation, plate.gif, is written too.
    """
    from vibroimpact.figures import save_figures
    from vibroimpact.report.progress import patient_progress

    with exit_on_interrupt(), patient_progress("drawing figures", console()) as progress:
        written = save_figures(directory, names_in(formats), output, progress)
    say(f"wrote {written}")


def measured_modes(
    paths: Sequence[Path], target: Path, *, figures: bool, force: bool, as_json: bool
) -> None:
    """Print and write the modes in the frequency responses of universal files."""
    from vibroimpact.test_analysis.measured.modes_of_file import modes_of_files

    with exit_on_interrupt():
        measured = modes_of_files(paths)
    save_and_show(measured, target, force=force, figures=figures, as_json=as_json)


def modes_beside_table(bodies: Mapping[str, BodyModes], paths: Sequence[Path]) -> MeasuredTable:
    """Return measured modes beside those of the plate of a case."""
    from vibroimpact.test_analysis.measured.modes_of_file import modes_beside
    from vibroimpact.test_analysis.measured.report import compared_table

    basis = bodies["plate"].basis if "plate" in bodies else None
    return compared_table(modes_beside(basis, paths))
