"""Damaged and hostile data sets, cards and graphs of models are refused in a sentence, or
give probabilities.
"""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterable
from functools import cache, partial
from pathlib import Path

import numpy as np
import pytest

import vibroimpact as vi
from hostile_runs import failures, number, seed
from recognition_mutations import (
    CARD_CHANGES,
    DATASET_CHANGES,
    GRAPH_CHANGES,
    Hostile,
    damage_card,
    damage_dataset,
    damage_graph,
    hostiles,
)
from trained_models import CLASSIFIERS
from vibroimpact.recognition.input_faults import check_signals
from vibroimpact.recognition.signal_features import features_of


@cache
def read_once(dataset: Path) -> vi.recognition.LabelledSignals:
    return vi.recognition.load_labelled_signals(dataset)


def read_dataset(use: Callable[[Path], None], made: Path, hostile: Hostile) -> None:
    """Read a damaged data set."""
    copy = made / "copy"
    shutil.rmtree(copy, ignore_errors=True)
    shutil.copytree(made / "data", copy)
    damage_dataset(copy / "dataset.nc", hostile)
    with pytest.MonkeyPatch.context() as patch:
        if hostile.change != "bytes":  # such files HDF5 endures
            patch.setattr(
                "vibroimpact.files.damaged_part.endures", lambda path: True, raising=False
            )
        use(copy)


def hear(dataset: Path) -> None:
    """Read its signals as any records."""
    for record in vi.signals.load_records(dataset):
        assert np.isfinite(record.rate)


def prepare(dataset: Path) -> None:
    """Do what `recognise` does before it trains."""
    signals = vi.recognition.load_labelled_signals(dataset).of_present_classes()
    check_signals(signals, "rock", 3)
    features_of(signals)


def apply_model(made: Path, damage: Callable[[Path, Hostile], None], hostile: Hostile) -> None:
    """Apply a damaged model, each classifier in turn, and look at what it says."""
    copy = made / "copy"
    shutil.rmtree(copy, ignore_errors=True)
    shutil.copytree(made / CLASSIFIERS[hostile.seed % len(CLASSIFIERS)], copy)
    damage(copy, hostile)
    found = vi.recognition.apply_recogniser(copy, read_once(made / "data"))
    found.save(made / "applied", force=True)
    assert np.isfinite(found.probabilities).all(), "a probability is not a number"
    assert (found.probabilities >= 0.0).all(), "a probability is negative"
    np.testing.assert_allclose(found.probabilities.sum(axis=1), 1.0, atol=1e-3)
    assert found.probabilities.shape[1] == len(found.class_names)


@pytest.fixture
def made(tiny_models: Path) -> Path:
    read_once(tiny_models / "data")
    return tiny_models


def no_failures(
    function: Callable[[Hostile], None], changes: Iterable[str], few: int, first: int
) -> None:
    told = failures(function, hostiles(changes, number(few), seed(first)))
    assert not told, told


@pytest.mark.parametrize("few", [22, pytest.param(165, marks=pytest.mark.slow)])
def test_data_sets(few: int, made: Path) -> None:
    no_failures(partial(read_dataset, prepare, made), DATASET_CHANGES, few, 41)


@pytest.mark.parametrize("few", [11, pytest.param(88, marks=pytest.mark.slow)])
def test_records(few: int, made: Path) -> None:
    no_failures(partial(read_dataset, hear, made), DATASET_CHANGES, few, 44)


@pytest.mark.parametrize("few", [18, pytest.param(165, marks=pytest.mark.slow)])
def test_cards(few: int, made: Path) -> None:
    no_failures(partial(apply_model, made, damage_card), CARD_CHANGES, few, 42)


@pytest.mark.parametrize("few", [24, pytest.param(170, marks=pytest.mark.slow)])
def test_graphs(few: int, made: Path) -> None:
    no_failures(partial(apply_model, made, damage_graph), ("bytes", *GRAPH_CHANGES), few, 43)
