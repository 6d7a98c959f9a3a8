"""Applies a saved model to the signals of a data set, whose classes may not be known."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from os import PathLike

import numpy as np

from vibroimpact.arrays import Floats, Indices
from vibroimpact.errors import InputError
from vibroimpact.files.reading import with_path
from vibroimpact.recognition.dataset_signals import load_labelled_signals
from vibroimpact.recognition.fraction import Estimate
from vibroimpact.recognition.labelled_signals import LabelledSignals
from vibroimpact.recognition.recogniser import Recogniser, doubts_of_version, load_recogniser
from vibroimpact.recognition.signal_features import baseline_doubts
from vibroimpact.report.reported import Reported


@dataclass(frozen=True, eq=False)
class Recognised(Reported, reported_in="vibroimpact.recognition.applied_report"):
    """Signals with the classes predicted by a model.

    Parameters
    ----------
    name : str
        Title of the signals.
    classifier : str
        What the model is.
    class_names : tuple of str
        The classes of the model.
    probabilities : array, shape (signals, classes)
        Probability of each class.
    counted : tuple of float
        Fraction of the signals classified as each class.
    fractions : mapping of str to Estimate
        The fraction of each class, corrected by what the model confuses.
    accuracy : float, optional
        Balanced accuracy, where the classes of the signals are known.
    doubts : tuple of str
        What is doubtful, such as another version.
    places : array of int, shape (signals,), optional
        The place of each signal in its file, from 0; by default all are there, in this order.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> recognised = vi.recognition.apply_recogniser("recognised", "falls")
    >>> recognised.class_names, recognised.probabilities.shape, recognised.accuracy > 0.5
    (('coal', 'gangue'), (96, 2), True)
    """

    name: str
    classifier: str
    class_names: tuple[str, ...]
    probabilities: Floats
    counted: tuple[float, ...]
    fractions: Mapping[str, Estimate]
    accuracy: float | None
    doubts: tuple[str, ...]
    places: Indices | None = None


def apply_recogniser(
    model: Recogniser | str | PathLike[str], dataset: str | PathLike[str] | LabelledSignals
) -> Recognised:
    """Return the classes of signals predicted by a saved classifier, and their fractions.

    Parameters
    ----------
    model : Recogniser or path
        A model, or the folder of one.
    dataset : path or LabelledSignals
        A data set, whose classes need not be known: its signals are the stream of impacts.

    Returns
    -------
    Recognised
        Probabilities and fractions.

    Raises
    ------
    InputError
        If either can't be read, or the signals are not of the sensors and rates that the model was
        trained on.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> recognised = vi.recognition.apply_recogniser("recognised", "falls")
    >>> fractions = recognised.fractions.values()
    >>> recognised.class_names, round(sum(fraction.value for fraction in fractions), 6)
    (('coal', 'gangue'), 1.0)
    """
    recogniser = model
    if not isinstance(recogniser, Recogniser):
        recogniser = load_recogniser(recogniser)
    signals = dataset
    if not isinstance(signals, LabelledSignals):
        signals = load_labelled_signals(signals)
    try:
        probabilities = recogniser.probabilities(signals)
    except InputError as error:
        if isinstance(model, Recogniser):
            raise
        raise with_path(model, error) from None
    predicted = probabilities.argmax(axis=1)
    names = recogniser.class_names
    doubts = doubts_of_version(recogniser) + baseline_doubts(signals)
    if signals.check_sum and signals.check_sum == recogniser.card["data"]["sha256"]:
        doubts.append(
            "the model was trained on signals of this data set, so it may recognise them "
            "better than others"
        )
    return Recognised(
        name=signals.name,
        classifier=recogniser.card["classifier"],
        class_names=names,
        probabilities=probabilities,
        counted=tuple(float((predicted == number).mean()) for number in range(len(names))),
        fractions=recogniser.fractions(predicted),
        accuracy=_accuracy(signals, [names[number] for number in predicted], names),
        doubts=tuple(doubts),
        places=signals.places,
    )


def _accuracy(
    signals: LabelledSignals, predicted: list[str], names: tuple[str, ...]
) -> float | None:
    """Return the balanced accuracy.

    It is None if the classes are not known, or one is not a class of the model.
    """
    if signals.classes is None or not set(signals.of_present_classes().class_names) <= set(names):
        return None
    truth = np.array([signals.class_names[number] for number in signals.classes])
    right = truth == np.array(predicted)
    return float(np.mean([right[truth == name].mean() for name in np.unique(truth)]))
