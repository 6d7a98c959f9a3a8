"""A small data set of knocks and models trained on it, of each kind of classifier, made
in a second: what recognition reads.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import h5py
import numpy as np

import vibroimpact as vi
from knock_data import write_knocks
from vibroimpact.recognition.classifiers import CLASSIFIER, all_classifiers
from vibroimpact.recognition.folds import inner_splits
from vibroimpact.recognition.recogniser import Recogniser, graph_of, save_recogniser
from vibroimpact.recognition.signal_features import features_of

TINY = {"rocks": 12, "falls": 3, "samples": 128}
CLASSIFIERS = tuple(one.name for one in all_classifiers() if one.kind == CLASSIFIER)


def write_tiny_models(folder: Path) -> Path:
    """Write the data set into `folder / "data"`, and a model of each classifier into
    `folder / NAME`; return the folder.
    """
    write_knocks(folder / "data", **TINY)
    # with times, so that other readers find records too
    with h5py.File(folder / "data" / "dataset.nc", "a") as file:
        file["time_a1"].attrs["units"] = "s"
        file["signal_a1"].dims[1].attach_scale(file["time_a1"])
    signals = vi.recognition.load_labelled_signals(folder / "data")
    features = features_of(signals)
    assert signals.classes is not None
    for classifier in all_classifiers():
        if classifier.name not in CLASSIFIERS:
            continue
        splits = inner_splits(signals.classes, signals.groups["rock"], 0)
        fitted = classifier.make(classifier.grid[0], 0, splits).fit(
            features.values, signals.classes
        )
        graph = graph_of(fitted, features.values, len(signals.class_names))
        (folder / classifier.name).mkdir()
        save_recogniser(
            Recogniser(card_of(signals, features.names, classifier.name), graph),
            folder / classifier.name,
        )
    return folder


def card_of(
    signals: vi.recognition.LabelledSignals, features: tuple[str, ...], classifier: str
) -> dict[str, Any]:
    """Return the card of a model."""
    draws = np.random.default_rng(0)
    rates = {
        name: {"true_rate": draws.uniform(0.7, 0.9, 50).tolist()} for name in signals.class_names
    }
    return {
        "format": "vibroimpact model 1",
        "version": "0",
        "packages": {"scikit-learn": "1", "skl2onnx": "1", "onnxruntime": "1"},
        "classifier": classifier,
        "parameters": {"C": 1.0},
        "classes": list(signals.class_names),
        "features": list(features),
        "units": ["1"] * len(features),
        "sensors": {
            name: {"rate_Hz": one.rate, "unit": one.unit, "samples": one.values.shape[1]}
            for name, one in signals.sensors.items()
        },
        "group": "rock",
        "data": {"name": signals.name, "signals": len(signals), "groups": 12, "sha256": ""},
        "seed": 0,
        "confusion": {
            name: {**one, "false_rate": draws.uniform(0.1, 0.3, 50).tolist()}
            for name, one in rates.items()
        },
    }
