"""Nested cross-validation: parameters are chosen within each training part.

No model sees the group of a signal that it classifies.
"""

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
    class_count = int(classes.max()) + 1
    splits_by_seed = [split_signals(classes, groups, folds, seed) for seed in seeds]

    def validate(classifier: Classifier, seed: int, split: Split) -> tuple[Floats, Parameters]:
        """Return probabilities of the test part, and the parameters chosen in the training part."""
        values = tables[classifier.table]
        train_groups = None
        if groups is not None:
            train_groups = groups[split.train]
        # tuned by an inner cross-validation of the training part alone, without the test part
        fitted, parameters = fit_tuned(
            classifier, values[split.train], classes[split.train], train_groups, seed
        )
        return probabilities(fitted, values[split.test], class_count), parameters

    compared = [classifier for classifier in classifiers if classifier.table in tables]
    jobs = []
    for classifier in compared:
        for seed, splits in zip(seeds, splits_by_seed, strict=True):
            jobs += [partial(validate, classifier, seed, split) for split in splits]
    results = iter(run_jobs(what, jobs, workers, progress))
    validated: dict[str, Validated] = {}
    for classifier in compared:
        held_out = np.zeros((len(seeds), len(classes), class_count))
        parameters_by_seed: list[list[Parameters]] = []
        for number, splits in enumerate(splits_by_seed):
            parameters_by_seed.append([])
            for split in splits:
                held_out[number, split.test], parameters = next(results)
                parameters_by_seed[-1].append(parameters)
        validated[classifier.name] = Validated(held_out, splits_by_seed, parameters_by_seed)
    return validated


@dataclass(frozen=True, eq=False)
class Chosen:
    """A classifier with its cross-validation, to be tried on what it was not trained on.

    Parameters
    ----------
    classifier : Classifier
        What was chosen.
    classes, groups : array of int
        Class and group of each signal.
    validated : Validated
        Its cross-validation, of which the first seed is used.
    seed : int
        That seed.
    """

    classifier: Classifier
    classes: Indices
    groups: Indices
    validated: Validated
    seed: int

    @property
    def parts(self) -> list[tuple[Split, Parameters]]:
        """The parts of the cross-validation, with the parameters chosen in each."""
        return list(zip(self.validated.splits[0], self.validated.parameters[0], strict=True))

    @property
    def guessed(self) -> Indices:
        """The class that each signal was taken for by the model that did not see it."""
        return np.asarray(self.validated.held_out[0].argmax(axis=1))

    def refit(self, values: Floats, train: Indices, parameters: Parameters) -> Any:
        """Return the classifier fitted to some of the signals, with given parameters."""
        splits = inner_splits(self.classes[train], self.groups[train], self.seed)
        estimator = self.classifier.make(parameters, self.seed, splits)
        return estimator.fit(values[train], self.classes[train])

    def guess(self, fitted: Any, values: Floats) -> Indices:
        """Return the class that a fitted classifier takes each row of a table for."""
        class_count = self.validated.held_out.shape[2]
        return np.asarray(probabilities(fitted, values, class_count).argmax(axis=1))
