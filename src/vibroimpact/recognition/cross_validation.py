"""Nested cross-validation: parameters are chosen within each training part, and no model sees the group of a signal that it classifies."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from vibroimpact.arrays import Floats, Indices
from vibroimpact.recognition.classifiers import Classifier, Parameters, fit_tuned, probabilities
from vibroimpact.recognition.folds import Split, inner_splits, split_signals
from vibroimpact.recognition.jobs import Progress, run_jobs


@dataclass(frozen=True, eq=False)
class Validated:
    """What a cross-validation gave for one classifier.

    Parameters
    ----------
    held_out : array, shape (seeds, signals, classes)
        Probabilities of each signal by the model that did not see it.
    splits : list of list of Split
        The parts, by seed.
    parameters : list of list of mapping
        The parameters chosen in each.
    """

    held_out: Floats
    splits: list[list[Split]]
    parameters: list[list[Parameters]]


def cross_validate(
    classifiers: Sequence[Classifier],
    tables: Mapping[str, Floats],
    classes: Indices,
    groups: Indices | None,
    folds: int,
    seeds: Sequence[int],
    *,
    what: str,
    workers: int,
    progress: Progress,
) -> dict[str, Validated]:
    """Cross-validate classifiers under several seeds.

    Parameters
    ----------
    classifiers : sequence of Classifier
        What is compared; those whose table is missing are left out.
    tables : mapping of str to array
        What they read.
    classes : array of int
        Class of each signal.
    groups : array of int, optional
        Groups that are kept apart, in the inner cross-validations too; None splits at random.
    folds : int
        Number of parts.
    seeds : sequence of int
        Seeds of the splits and of the classifiers.
    what, workers, progress
        As `run_jobs` takes them.
    """
    count = int(classes.max()) + 1
    splits = [split_signals(classes, groups, folds, seed) for seed in seeds]

    def one(classifier: Classifier, seed: int, split: Split) -> tuple[Floats, Parameters]:
        values = tables[classifier.table]
        inner = None if groups is None else groups[split.train]
        fitted, chosen = fit_tuned(classifier, values[split.train], classes[split.train], inner, seed)
        return probabilities(fitted, values[split.test], count), chosen

    compared = [classifier for classifier in classifiers if classifier.table in tables]
    drawn = [(seed, split) for seed, parts in zip(seeds, splits, strict=True) for split in parts]
    jobs = [partial(one, classifier, seed, split) for classifier in compared for seed, split in drawn]
    done = iter(run_jobs(what, jobs, workers, progress))
    found: dict[str, Validated] = {}
    for classifier in compared:
        held_out = np.zeros((len(seeds), len(classes), count))
        parameters: list[list[Parameters]] = []
        for number, parts in enumerate(splits):
            parameters.append([])
            for split in parts:
                held_out[number, split.test], chosen = next(done)
                parameters[-1].append(chosen)
        found[classifier.name] = Validated(held_out, splits, parameters)
    return found


def refit(
    classifier: Classifier, values: Floats, classes: Indices, groups: Indices, train: Indices, seed: int, parameters: Parameters
) -> Any:
    """Return a classifier fitted to a training part with given parameters.

    Parameters
    ----------
    classifier : Classifier
        What is fitted.
    values, classes, groups : array
        Of all signals.
    train : array of int
        Indices of the training part.
    seed : int
        Seed of the classifier.
    parameters : mapping
        Its parameters.
    """
    splits = inner_splits(classes[train], groups[train], seed)
    return classifier.make(parameters, seed, splits).fit(values[train], classes[train])
