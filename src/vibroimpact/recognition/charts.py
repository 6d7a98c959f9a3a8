"""The charts of a recognition, described as data."""

from __future__ import annotations

from functools import partial

import numpy as np

from vibroimpact.charts.axis import Axis
from vibroimpact.charts.chart import Chart, Panel
from vibroimpact.charts.made import made_charts
from vibroimpact.charts.marks import Bars, Level, Line, Map, Mark, Points
from vibroimpact.charts.palette import series
from vibroimpact.quoting import shortened, visible
from vibroimpact.recognition.recognise import Recognition
from vibroimpact.recognition.scores import Score

_HEIGHT = 3.6
_MOST_FEATURES = 20
_LETTERS = 34


def recognition_charts(recognition: Recognition) -> list[Chart]:
    """Return the charts of a recognition.

    Parameters
    ----------
    recognition : Recognition
        The recognition.

    Returns
    -------
    list of Chart
        `scores`, `confusion`, `unseen` where ranges could be left out, `robustness`, `reliability`,
        `importance` and `fraction`.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> [
    ...     chart.name
    ...     for chart in recognition_charts(vi.recognition.recognise("falls", folds=2, seeds=1))
    ... ][:2]
    ['scores', 'confusion']
    """
    makers = {"scores": _scores_chart, "confusion": _confusion_chart}
    if recognition.unseen:
        makers["unseen"] = _unseen_chart
    makers |= {
        "robustness": _robustness_chart,
        "reliability": _reliability_chart,
        "importance": _importance_chart,
    }
    if recognition.streams:
        makers["fraction"] = _fraction_chart
    return made_charts({name: partial(make, recognition) for name, make in makers.items()})


def _scores_chart(recognition: Recognition) -> Chart:
    names = list(recognition.scores)[::-1]
    places = np.arange(float(len(names)))
    marks: list[Mark] = [
        _lying(places + side, [scores[name].error for name in names], phrase, role, names)
        for side, scores, phrase, role in (
            (0.18, recognition.scores, f"grouped by {recognition.group}", "detail"),
            (-0.18, recognition.random, "split at random", "pale"),
        )
    ]
    if recognition.bayes_error is not None:
        marks.append(Level(recognition.bayes_error, "Bayes error", "mark line", upright=True))
    panel = Panel(
        Axis("Classification error", range=(0.0, np.nan)), Axis(names=_short(names)), tuple(marks)
    )
    bound = ""
    if recognition.bayes_error is not None:
        if recognition.bayes_error_sees:
            counted = f"for {recognition.bayes_error_sees} alone"
        else:
            counted = "that the data set states"
        bound = (
            f" Line: the Bayes error {counted}; a lower error means further information, a "
            "leak, or chance."
        )
    caption = (
        f"Error on test signals: with all signals of a {recognition.group} in either the "
        "training or the test data, and with signals split at "
        "random. The difference is the optimistic bias of the random split. Thin lines: "
        f"95 % intervals, which count {recognition.group}s, not signals.{bound}"
    )
    return Chart(
        "scores",
        "Classification errors and optimism",
        ((panel,),),
        caption,
        0.9 + 0.36 * len(names),
    )


def _lying(
    places: np.ndarray, scores: list[Score], phrase: str, role: str, names: list[str]
) -> Bars:
    values, low, high = (
        np.array(score)
        for score in zip(*((score.value, score.low, score.high) for score in scores), strict=True)
    )
    return Bars(
        places, values, phrase, role, 0.34, lying=True, low=low, high=high, texts=tuple(names)
    )


def _confusion_chart(recognition: Recognition) -> Chart:
    counts = recognition.confusion[recognition.best]
    parts = counts / counts.sum(axis=1, keepdims=True)
    names = tuple(shortened(visible(name), _LETTERS) for name in recognition.class_names)
    places = np.arange(float(len(names)))
    texts = tuple(
        f"{truth} classified as {guess}: {parts[row, column]:.1%}"
        for row, truth in enumerate(names)
        for column, guess in enumerate(names)
    )
    cells = Map(places, places, parts, Axis("Fraction of the class", range=(0.0, 1.0)), texts=texts)
    panel = Panel(Axis("Predicted class", names=names), Axis("True class", names=names), (cells,))
    caption = (
        f"Predicted classes of the best classifier ({recognition.best}) for {recognition.group}s "
        "not used in training; mean over the seeds."
    )
    return Chart("confusion", "Confusion matrix", ((panel,),), caption, _HEIGHT)


def _unseen_chart(recognition: Recognition) -> Chart:
    rows = recognition.unseen[::-1]
    names = [f"{row.key}: {row.words}" for row in rows]
    places = np.arange(float(len(rows)))
    marks = (
        _lying(places + 0.18, [row.seen for row in rows], "in the training data", "detail", names),
        _lying(places - 0.18, [row.unseen for row in rows], "left out of training", "lower", names),
        Level(1.0 / len(recognition.class_names), "chance", "dotted", upright=True),
    )
    panel = Panel(Axis("Balanced accuracy", range=(0.0, 1.0)), Axis(names=_short(names)), marks)
    caption = (
        "Signals in each range of a sampled key, in SI units, classified after training on "
        "all ranges, and after training on the others alone; "
        f"both are grouped by {recognition.group}. Not left out are ranges of the sphere's "
        "material and of the contact, and "
        "those without which a class could not be trained or "
        f"tested. Best classifier: {recognition.best}."
    )
    return Chart(
        "unseen",
        "Accuracy on ranges left out of training",
        ((panel,),),
        caption,
        0.9 + 0.36 * len(names),
    )


def _robustness_chart(recognition: Recognition) -> Chart:
    levels = np.array([score.level for score in recognition.noise])[::-1]
    marks: list[Mark] = []
    for number, (phrase, scores) in enumerate(
        (
            ("trained with noise", [score.trained_with for score in recognition.noise]),
            ("trained without noise", [score.trained_without for score in recognition.noise]),
        )
    ):
        values, low, high = (
            np.array(score)[::-1]
            for score in zip(
                *((score.value, score.low, score.high) for score in scores), strict=True
            )
        )
        marks += [
            Line(levels, values, phrase, series(number), marked=True),
            Points(levels, values, role=series(number), low=low, high=high),
        ]
    marks.append(
        Level(
            recognition.scores[recognition.best].balanced_accuracy.value,
            "signals without noise",
            "reference",
        )
    )
    marks.append(Level(1.0 / len(recognition.class_names), "chance", "dotted"))
    panel = Panel(
        Axis("Signal-to-noise ratio", "dB"),
        Axis("Balanced accuracy", range=(0.0, 1.0)),
        tuple(marks),
    )
    caption = (
        "White noise of the same power is added to all signals of a sensor before their "
        "features are computed; the ratio refers to the "
        f"median of their mean squares. Best classifier: {recognition.best}."
    )
    return Chart("robustness", "Recognition in noise", ((panel,),), caption, _HEIGHT)


def _reliability_chart(recognition: Recognition) -> Chart:
    marks: list[Mark] = [
        Line(np.array([0.0, 1.0]), np.array([0.0, 1.0]), "calibrated", "reference")
    ]
    for number, name in enumerate(dict.fromkeys(row.class_name for row in recognition.reliability)):
        rows = [row for row in recognition.reliability if row.class_name == name]
        part, predicted, low, high = (
            np.array([getattr(row, key) for row in rows])
            for key in ("part", "probability", "low", "high")
        )
        texts = tuple(f"{row.signals} signals" for row in rows)
        marks += [
            Line(predicted, part, name, series(number)),
            Points(predicted, part, role=series(number), low=low, high=high, texts=texts),
        ]
    panel = Panel(
        Axis("Predicted probability", range=(0.0, 1.0)),
        Axis("Observed frequency", range=(0.0, 1.0)),
        tuple(marks),
    )
    caption = (
        "Observed frequency of a class over its predicted probability (reliability "
        "diagram); mean absolute difference "
        f"{recognition.calibration_error:.3f}. Best classifier: {recognition.best}."
    )
    return Chart("reliability", "Calibration of the probabilities", ((panel,),), caption, _HEIGHT)


def _importance_chart(recognition: Recognition) -> Chart:
    rows = recognition.importance[:_MOST_FEATURES][::-1]
    names = [row.feature for row in rows]
    loss, spread = (np.array([getattr(row, key) for row in rows]) for key in ("loss", "spread"))
    places = np.arange(float(len(rows)))
    bars = Bars(places, loss, lying=True, low=loss - spread, high=loss + spread, texts=tuple(names))
    panel = Panel(
        Axis("Loss of balanced accuracy"),
        Axis(names=_short(names)),
        (bars, Level(0.0, role="main", upright=True)),
    )
    caption = (
        f"Permutation importance: loss of balanced accuracy on {recognition.group}s not used in "
        "training when a feature is exchanged between "
        "their signals; thin lines: standard deviation over the folds. Correlated features "
        f"share their importance. Best classifier: {recognition.best}."
    )
    return Chart(
        "importance", "Importance of features", ((panel,),), caption, 0.9 + 0.26 * len(names)
    )


def _fraction_chart(recognition: Recognition) -> Chart:
    panels = []
    across = Axis("True fraction", range=(-0.02, 1.02))
    up = Axis("Estimated fraction", range=(0.0, 1.0))
    for impacts in dict.fromkeys(stream.impacts for stream in recognition.streams):
        marks: list[Mark] = [Line(np.array([0.0, 1.0]), np.array([0.0, 1.0]), "true", "reference")]
        for number, name in enumerate(
            dict.fromkeys(stream.class_name for stream in recognition.streams)
        ):
            rows = [
                stream
                for stream in recognition.streams
                if (stream.class_name, stream.impacts) == (name, impacts)
            ]
            true, counted, value, low, high = (
                np.array([getattr(stream, key) for stream in rows])
                for key in ("fraction", "counted", "adjusted", "low", "high")
            )
            marks.append(Line(true, counted, f"{name}, counted", f"thin {series(number)}"))
            marks += [
                Line(true, value, f"{name}, corrected", series(number)),
                Points(true, value, role=series(number), low=low, high=high),
            ]
        panels.append(Panel(across, up, tuple(marks), f"{impacts} impacts"))
    caption = (
        f"The fraction of a class in streams of {recognition.group}s that were not used to "
        "estimate the confusion matrix: as counted, and "
        "corrected by it, with mean 95 % intervals."
    )
    return Chart("fraction", "Fraction in a stream of impacts", (tuple(panels),), caption, _HEIGHT)


def _short(names: list[str]) -> tuple[str, ...]:
    return tuple(shortened(visible(name), _LETTERS) for name in names)
