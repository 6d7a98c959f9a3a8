"""The command `recognise`, which trains classifiers of a data set, or applies a saved one."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path
from typing import Annotated

import typer

from vibroimpact.cli.shared import (
    Figures,
    Force,
    Json,
    app,
    exit_on_interrupt,
    note,
    output_folder,
    save_and_show,
    stem,
)
from vibroimpact.errors import InputError

_EVERY = 10.0
"""Time between two lines of progress [s]."""


@app.command()
def recognise(
    dataset: Annotated[
        str, typer.Argument(metavar="DATASET", help="The folder of a data set, or its dataset.nc.")
    ],
    output: Annotated[Path | None, output_folder("DATASET-recognised")] = None,
    model: Annotated[
        Path | None,
        typer.Option(
            "--model",
            metavar="DIR",
            help="Apply the model saved in DIR by an earlier recognise, without training.",
        ),
    ] = None,
    group: Annotated[
        str,
        typer.Option(
            "--group",
            metavar="NAME",
            help="Groups kept together in the cross-validation: rock, plate or fall.",
        ),
    ] = "rock",
    folds: Annotated[
        int | None,
        typer.Option(
            "--folds",
            metavar="N",
            help="Number of folds of the cross-validation; by default 5, or the smallest number "
            "of groups of a class, if below 10.",
        ),
    ] = None,
    seeds: Annotated[
        int,
        typer.Option(
            "--seeds", metavar="N", help="Number of seeds over which the scores are averaged."
        ),
    ] = 5,
    seed: Annotated[int, typer.Option("--seed", metavar="N", min=0, help="The first seed.")] = 0,
    most: Annotated[
        int,
        typer.Option(
            "--most",
            metavar="N",
            help="Largest number of signals; of more, whole groups are drawn at random, one at "
            "least.",
        ),
    ] = 4000,
    figures: Figures = False,
    force: Force = False,
    as_json: Json = False,
) -> None:
    """Train classifiers of impact signals, and validate them. Their accuracy is estimated by
    grouped cross-validation.

    Baselines and four classifiers are compared in a grouped and in a random split; the best one is
    saved, and --model applies it.
    """
    from vibroimpact.files.result_folder import check_free
    from vibroimpact.recognition.apply import apply_recogniser
    from vibroimpact.recognition.recognise import recognise as recognise_signals

    folder = Path(dataset)
    if dataset.endswith(".nc"):
        folder = folder.parent
    name = stem(str(folder))
    target = output or Path(f"{name}-recognised")
    check_free(target, force=force)
    _check_outside(target, Path(dataset))
    if model is not None:
        _check_outside(target, model)
        with exit_on_interrupt():
            recognised = apply_recogniser(model, dataset)
        save_and_show(recognised, target, force=force, figures=figures, as_json=as_json)
        return
    with exit_on_interrupt():
        recognition = recognise_signals(
            dataset,
            group=group,
            folds=folds,
            seeds=seeds,
            seed=seed,
            most=most,
            progress=_progress_lines(),
        )
    save_and_show(recognition, target, force=force, figures=figures, as_json=as_json)


def _check_outside(target: Path, source: Path) -> None:
    """Raise if a folder that is made would replace what it is made from."""
    if not source.exists():
        return
    path = source.resolve()
    if target.resolve() in (path, *path.parents):
        raise InputError(
            f"{target}: {source} lies there, and would be replaced; "
            "name another folder for the result"
        )


def _progress_lines() -> Callable[[str, int, int], None]:
    """Return a callback that prints a line at the start of a step, and every ten seconds."""
    last_line = time.monotonic()

    def progress(step: str, done: int, total: int) -> None:
        nonlocal last_line
        if not done:
            note(step)
        elif done < total and time.monotonic() - last_line > _EVERY:
            note(f"{step}: {done} of {total}")
        else:
            return
        last_line = time.monotonic()

    return progress
