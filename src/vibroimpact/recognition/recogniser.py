"""A trained classifier that is saved without code that runs on loading: an ONNX graph,
and a card in JSON that says what it is of.
"""

from __future__ import annotations

import logging
import warnings
from collections.abc import Mapping
from dataclasses import dataclass
from hashlib import sha256
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from vibroimpact._version import __version__
from vibroimpact.arrays import Floats
from vibroimpact.errors import ComputationError, InputError
from vibroimpact.files.check_sums import (
    CHANGED,
    CHECK_SUMS,
    DamageError,
    file_digest,
    read_sealed,
    sealed,
)
from vibroimpact.files.reading import FileKind, read_bytes, with_path
from vibroimpact.quoting import quoted, shortened, visible
from vibroimpact.recognition.card import CARD_FILE, check_card
from vibroimpact.recognition.extra import needs_extra
from vibroimpact.recognition.fraction import Estimate, Rates, estimate_fraction
from vibroimpact.recognition.graph_check import ROWS, check_graph
from vibroimpact.recognition.labelled_signals import LabelledSignals
from vibroimpact.recognition.onnx_runtime import silent_onnxruntime
from vibroimpact.recognition.signal_features import by_name, features_of

FOLDER = "model"
CARD = "card.json"
GRAPH = "model.onnx"
_GRAPH_FILE = FileKind(
    "a graph is a file in ONNX", 100_000_000, "larger graphs are not read; train on fewer signals"
)
_DIFFERENT = 0.005
"""Largest part of the training signals that the saved graph may take for another class,
by rounding to single precision at a threshold.
"""
_TOLERANCE = 1e-3
"""Largest deviation of the sum of probabilities from 1: they are of single precision."""

_LONGEST_REASON = 120


@dataclass(frozen=True, eq=False)
class Recogniser:
    """A trained classifier.

    Parameters
    ----------
    card : mapping
        What it is: classifier, classes, features, sensors, versions, the data that it was trained
        on, and what it confuses.
    graph : bytes
        Its ONNX graph: features in, probabilities out.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> model = vi.recognition.load_recogniser("recognised")
    >>> model.class_names, model.probabilities(vi.recognition.load_labelled_signals("falls")).shape
    (('coal', 'gangue'), (96, 2))
    """

    card: Mapping[str, Any]
    graph: bytes

    @property
    def class_names(self) -> tuple[str, ...]:
        """Names of the classes."""
        return tuple(self.card["classes"])

    def probabilities(self, signals: LabelledSignals) -> Floats:
        """Return the probability of each class for each signal, shape (signals, classes).

        Parameters
        ----------
        signals : LabelledSignals
            Signals of the same sensors and rates as those trained on.

        Raises
        ------
        InputError
            If a sensor, its rate or its unit, or a feature differs.
        """
        for sensor, trained in self.card["sensors"].items():
            if sensor not in signals.sensors:
                raise InputError(
                    f"the model was trained on the sensor {quoted(sensor)}, which these "
                    "signals do not have"
                )
            given = signals.sensors[sensor]
            if (
                not np.isclose(given.rate, trained["rate_Hz"], rtol=1e-6)
                or given.unit != trained["unit"]
            ):
                message = (
                    f"at {trained['rate_Hz']:.10g} Hz in {trained['unit']}, and these signals "
                    f"are at {given.rate:.10g} Hz in {given.unit}"
                )
                raise InputError(f"{sensor}: the model was trained {message}")
            if (length := given.values.shape[1]) != trained["samples"]:
                raise InputError(
                    f"{sensor}: the model was trained on {trained['samples']} samples a "
                    f"signal, and these have {length}"
                )
        features = features_of(signals)
        return run_graph(
            self.graph, by_name(features, tuple(self.card["features"])), len(self.class_names)
        )

    def fractions(self, guessed: Any, seed: int = 0) -> dict[str, Estimate]:
        """Return the fraction of each class in a stream of impacts, corrected by what the model
        confuses.

        Parameters
        ----------
        guessed : array of int
            The class that each impact is taken for.
        seed : int
            Seed of the draws for the intervals.
        """
        generator = np.random.default_rng(seed)
        estimates = {}
        for number, name in enumerate(self.class_names):
            rates = self.card["confusion"][name]
            drawn = Rates(np.array(rates["true_rate"]), np.array(rates["false_rate"]))
            estimates[name] = estimate_fraction(
                int((guessed == number).sum()), len(guessed), drawn, generator
            )
        return estimates


def graph_of(estimator: Any, values: Floats, classes: int) -> bytes:
    """Return the ONNX graph of a fitted pipeline, after comparison with it on the signals that it
    was trained on.

    Parameters
    ----------
    estimator
        The pipeline.
    values : array, shape (signals, features)
        What it was trained on.
    classes : int
        Number of classes.

    Raises
    ------
    ComputationError
        If the graph classifies them differently.
    """
    with needs_extra():
        from skl2onnx import to_onnx
    with warnings.catch_warnings():
        # of attributes that scikit-learn will drop and the conversion asks for
        warnings.simplefilter("ignore")
        logging.getLogger("skl2onnx").setLevel(logging.ERROR)
        graph: bytes = to_onnx(
            estimator, values[:1].astype(np.float32), options={"zipmap": False}
        ).SerializeToString()
    probabilities = run_graph(graph, values, classes)
    expected = estimator.predict_proba(values)
    different = float(np.mean(probabilities.argmax(axis=1) != expected.argmax(axis=1)))
    if probabilities.shape != (len(values), classes) or different > _DIFFERENT:
        message = (
            f"the saved model takes {different:.1%} of the signals for another "
            "class than the trained one"
        )
        raise ComputationError(f"{message}; the conversion to ONNX failed")
    return graph


def run_graph(graph: bytes, values: Floats, classes: int) -> Floats:
    """Return the probabilities that an ONNX graph gives for features, after a check of the graph
    and of what it gives.

    Parameters
    ----------
    graph : bytes
        The graph.
    values : array, shape (signals, features)
        The features.
    classes : int
        Number of classes.

    Raises
    ------
    InputError
        If the graph is no classifier of this program, can't be run, or does not give probabilities.
    """
    check_graph(graph, values.shape[1], classes)
    onnxruntime = silent_onnxruntime()
    options = onnxruntime.SessionOptions()
    options.intra_op_num_threads = 1
    options.log_severity_level = 4
    outputs = np.empty((len(values), classes))
    try:
        session = onnxruntime.InferenceSession(graph, options, providers=["CPUExecutionProvider"])
        (given,) = session.get_inputs()
        for first in range(0, len(values), ROWS):
            _, probabilities = session.run(
                None, {given.name: values[first : first + ROWS].astype(np.float32)}
            )
            outputs[first : first + ROWS] = probabilities
    except Exception as error:  # onnxruntime has a class of its own for each kind of fault
        raise InputError(
            f"the graph can't be run: {shortened(visible(str(error)), _LONGEST_REASON)}; "
            "train the model anew"
        ) from None
    return _probabilities(outputs)


def _probabilities(values: Floats) -> Floats:
    """Return probabilities, after a check that they are."""
    with np.errstate(invalid="ignore"):
        right = (values >= -_TOLERANCE).all(axis=1) & (
            np.abs(values.sum(axis=1) - 1.0) <= _TOLERANCE
        )
    if not right.all():  # a comparison with NaN is not right either
        first = int(np.flatnonzero(~right)[0])
        what = quoted([float(f"{value:.4g}") for value in values[first]])
        raise InputError(
            f"the model gives {what} for a signal; probabilities are from 0 to 1, and add "
            "up to 1: train it anew"
        )
    return np.clip(values, 0.0, 1.0)


def save_recogniser(recogniser: Recogniser, folder: Path) -> None:
    """Write the graph and the card into an existing folder."""
    (folder / GRAPH).write_bytes(recogniser.graph)
    card = {**recogniser.card, CHECK_SUMS: {GRAPH: file_digest(folder / GRAPH)}}
    (folder / CARD).write_bytes(sealed(card))


def load_recogniser(directory: str | PathLike[str]) -> Recogniser:
    """Return a saved classifier, which is an ONNX graph and a card in JSON.

    Parameters
    ----------
    directory : path
        The result folder of `recognise`, or the folder `model` in it.

    Returns
    -------
    Recogniser
        The model; `doubts_of_version` says whether another version saved it.

    Raises
    ------
    InputError
        If it is no model, of a format that this version does not know, or damaged.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> vi.recognition.load_recogniser("recognised").class_names
    ('coal', 'gangue')
    """
    folder = Path(directory)
    if (folder / FOLDER).is_dir():
        folder = folder / FOLDER
    if not (folder / CARD).is_file():
        raise InputError(f"{directory}: this is no saved model; there is no {CARD}")
    name = CARD  # the file being read: error messages name it
    try:
        card = read_sealed(folder / name, CARD_FILE)
        check_card(card, GRAPH)
        name = GRAPH
        graph = read_bytes(folder / name, _GRAPH_FILE)
        if sha256(graph).hexdigest() != card.pop(CHECK_SUMS)[GRAPH]:
            raise DamageError(CHANGED)
    except (DamageError, InputError) as error:
        raise with_path(folder / name, InputError(str(error))) from None
    return Recogniser(card, graph)


def doubts_of_version(recogniser: Recogniser) -> list[str]:
    """Return a sentence if another version saved a model."""
    saved = recogniser.card["version"]
    if saved == __version__:
        return []
    phrase = "the features may be computed differently; train it anew where that matters"
    return [f"the model was saved by vibroimpact {saved} and this is {__version__}: {phrase}"]
