"""The commands for one case: `demo`, `run`, `check`, `modes` and `report`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from vibroimpact.cli.shared import CaseArgument, Changes, Force, app, console, exit_on_interrupt, note, say, settings_of, stem


@app.command()
def demo(
    output: Annotated[Path, typer.Option("-o", "--output", metavar="DIR", help="The result folder to make.")] = Path("vibroimpact-demo"),
    force: Force = False,
) -> None:
    """Run the paper's Type 1 as a first example.

    A rock sphere falls 4 m on a steel plate and bounces five times.
    """
    _run("paper:type1-variable", output, {}, force=force)


@app.command()
def run(
    case: CaseArgument,
    output: Annotated[
        Path | None, typer.Option("-o", "--output", metavar="DIR", help="The result folder to make; by default named after the case.")
    ] = None,
    changes: Changes = None,
    force: Force = False,
) -> None:
    """Run a case and write its result folder.

    The folder holds the case in full, the impact table, the data as NetCDF, figures, and a report.
    """
    _run(case, output, settings_of(changes), force=force)


@app.command()
def check(case: CaseArgument, changes: Changes = None) -> None:
    """Validate a case or a study and explain it; run nothing."""
    from vibroimpact.calibration.section import check_target
    from vibroimpact.cases.build import check_drop
    from vibroimpact.cases.reader import load_case, load_table, prefix_errors
    from vibroimpact.runs.case_explained import case_explained
    from vibroimpact.studies.explain_sweep import explain_sweep
    from vibroimpact.studies.sweep import read_sweep

    others = settings_of(changes)
    table = prefix_errors(case, lambda: load_table(case, others))
    if "sweep" not in table:
        found = load_case(case, others)
        prefix_errors(case, lambda: check_drop(found))
        prefix_errors(case, lambda: check_target(found.calibrate))
        console().print(prefix_errors(case, lambda: case_explained(found)))
        return
    study = prefix_errors(case, lambda: read_sweep(table))
    console().print(explain_sweep(study))
    console().print(prefix_errors(case, lambda: case_explained(study.case, study.axes)))


def _run(name: str, output: Path | None, changes: dict[str, Any], *, force: bool) -> None:
    from vibroimpact.cases.costs import describe_costs
    from vibroimpact.cases.reader import load_case, prefix_errors
    from vibroimpact.dynamics.simulate import simulate
    from vibroimpact.report.progress import patient_progress
    from vibroimpact.results.folder import check_free, new_folder
    from vibroimpact.runs.page import write_report
    from vibroimpact.runs.save import write_data
    from vibroimpact.runs.text import result_summary

    case = load_case(name, changes)
    target = Path(stem(name)) if output is None else output
    check_free(target, force=force)  # fail before the computation
    for sentence in describe_costs(case):
        note(sentence)
    screen = console()
    with exit_on_interrupt():
        with patient_progress("computing modes", screen) as progress:
            problem = prefix_errors(name, lambda: case.to_problem(progress, note))
        with patient_progress("simulating", screen) as progress:
            response = simulate(problem, progress)
        with new_folder(target, force=force) as folder:
            result = write_data(response, folder)
            del response  # of a long run it may take as much memory as the result: release it before figures are drawn
            write_report(result, folder)
    screen.print(result_summary(result, screen.width))
    say(f"wrote {target / 'report.html'}")


@app.command()
def modes(
    case: CaseArgument,
    output: Annotated[Path | None, typer.Option("-o", "--output", metavar="DIR", help="The folder to make; by default CASE-modes.")] = None,
    changes: Changes = None,
    force: Force = False,
) -> None:
    """Compute the modes of the elastic bodies of a case.

    The folder holds a table of frequencies, pictures of the first modes, and the meshes for ParaView, Nastran and Abaqus.
    """
    from vibroimpact.cases.costs import describe_costs
    from vibroimpact.cases.elastic.modes import compute_modes
    from vibroimpact.cases.reader import load_case, prefix_errors
    from vibroimpact.modes.folder import save_modes
    from vibroimpact.modes.text import modes_summary
    from vibroimpact.report.progress import patient_progress
    from vibroimpact.results.folder import check_free

    found = load_case(case, settings_of(changes))
    target = Path(f"{stem(case)}-modes") if output is None else output
    check_free(target, force=force)
    for sentence in describe_costs(found, modes_alone=True):
        note(sentence)
    screen = console()
    with exit_on_interrupt():
        with patient_progress("computing modes", screen) as progress:
            bodies = prefix_errors(case, lambda: compute_modes(found, progress, note))
        folder = save_modes(found, bodies, target, force=force)
    screen.print(modes_summary(found, bodies))
    say(f"wrote {folder / 'modes.csv'}, and pictures and meshes beside it")


@app.command()
def report(directory: Annotated[Path, typer.Argument(metavar="DIR", help="A result folder.")]) -> None:
    """Remake the report of a result folder."""
    from vibroimpact.remake import remake_report

    say(f"wrote {remake_report(directory) / 'report.html'}")
