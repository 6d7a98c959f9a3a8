"""What a saved model tells of signals: their classes, and the fraction of each class."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Any

from vibroimpact._version import __version__
from vibroimpact.files.plain_names import one_line
from vibroimpact.recognition.apply import Recognised
from vibroimpact.report.report import Column, Note, Quantity, Report, Section, Table
from vibroimpact.results.csv_files import write_csv


def report_of(recognised: Recognised) -> Report:
    """Return the report of signals that a saved model was applied to."""
    notes = []
    if recognised.accuracy is not None:
        notes.append(
            Note(f"Balanced accuracy {recognised.accuracy:.1%}, by the classes in the data set.")
        )
    return Report(
        title=(
            f"{recognised.name}: {len(recognised.probabilities)} signals, classified by "
            f"{recognised.classifier}"
        ),
        quantities=_answer(recognised),
        sections=(Section("fractions", "Fractions", (fraction_table(recognised), *notes)),),
        warnings=recognised.doubts,
        files={"predictions.csv": partial(_write_predictions, recognised)},
        summary=_summary(recognised),
    )


def _answer(recognised: Recognised) -> list[Quantity]:
    """Return the fraction of each class with its interval, and the accuracy if it is known."""
    quantities = [
        Quantity(
            f"Fraction of {name}",
            100.0 * fraction.value,
            "%",
            interval=(100.0 * fraction.low, 100.0 * fraction.high),
        )
        for name, fraction in recognised.fractions.items()
    ]
    if recognised.accuracy is not None:
        note = "by the classes in the data set"
        accuracy = 100.0 * recognised.accuracy
        quantities.append(Quantity("Balanced accuracy", accuracy, "%", note=note, figures=3))
    return quantities


def fraction_table(recognised: Recognised) -> Table:
    """Return the table of the classes: counted, and corrected by what the model confuses."""
    fractions = list(recognised.fractions.values())
    intervals = [
        f"{100.0 * fraction.low:.1f} to {100.0 * fraction.high:.1f}" for fraction in fractions
    ]
    return Table(
        (
            Column("Class", recognised.class_names, is_text=True),
            Column("Counted", [f"{100.0 * share:.1f}" for share in recognised.counted], "%"),
            Column("Fraction", [f"{100.0 * fraction.value:.1f}" for fraction in fractions], "%"),
            Column("95 % interval", intervals, "%"),
        )
    )


def _write_predictions(recognised: Recognised, path: Path) -> None:
    """Write a row a signal with the probability of each class; signals are numbered as they
    are in the file, from 0.
    """
    columns = [f"probability_{one_line(name)}" for name in recognised.class_names]
    names = [recognised.class_names[index] for index in recognised.probabilities.argmax(axis=1)]
    numbers = list(range(len(names)))
    if recognised.places is not None:
        numbers = recognised.places.tolist()
    rows = []
    for number, name, values in zip(numbers, names, recognised.probabilities, strict=True):
        probabilities = dict(zip(columns, values.tolist(), strict=True))
        rows.append({"signal": number, "class": name, **probabilities})
    write_csv(rows, ["signal", "class", *columns], path)


def _summary(recognised: Recognised) -> dict[str, Any]:
    """Return the content of `summary.json`."""
    return {
        "name": recognised.name,
        "version": __version__,
        "recognised": {
            "classifier": recognised.classifier,
            "signals": len(recognised.probabilities),
            "balanced_accuracy": recognised.accuracy,
            "classes": {
                name: {
                    "counted": counted,
                    "fraction": fraction.value,
                    "fraction_low": fraction.low,
                    "fraction_high": fraction.high,
                }
                for (name, fraction), counted in zip(
                    recognised.fractions.items(), recognised.counted, strict=True
                )
            },
        },
        "doubts": list(recognised.doubts),
    }
