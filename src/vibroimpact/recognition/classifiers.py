"""The classifiers that are compared.

They are baselines of a single quantity, four classifiers of all features, and a probe of what
should tell little. Each is a scikit-learn pipeline in which gaps are filled and features scaled, so
that both are learned from the training part alone.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from vibroimpact.arrays import Floats, Indices
from vibroimpact.recognition.folds import Split, inner_splits
from vibroimpact.recognition.scores import balanced_accuracy
from vibroimpact.recognition.signal_features import CONTACT_TIME, EDGES, FEATURES, PEAK, TRUE_TIME

BASELINE = "baseline"
"""Kind of a classifier of one measured quantity."""

CLASSIFIER = "classifier"
"""Kind of a classifier of all features."""

TRUTH = "truth"
"""Kind of a classifier of what only the simulation knows."""

PROBE = "probe"
"""Kind of a classifier of what should tell little."""

Parameters = Mapping[str, Any]
_TREES = 60


@dataclass(frozen=True)
class Classifier:
    """A classifier that can be made anew for each training part.

    Parameters
    ----------
    name : str
        Its name.
    kind : str
        `BASELINE`, `CLASSIFIER`, `TRUTH` or `PROBE`.
    table : str
        The table that it reads.
    make : callable
        Returns an estimator for parameters, a seed, and the parts on which its probabilities are
        calibrated (none: not calibrated).
    grid : tuple of mapping
        Parameters of which the inner cross-validation chooses.
    """

    name: str
    kind: str
    table: str
    make: Callable[[Parameters, int, Sequence[Split]], Any]
    grid: tuple[Parameters, ...] = ({},)


def all_classifiers() -> tuple[Classifier, ...]:
    """Return all that are compared, the baselines first."""
    return (
        Classifier("majority", BASELINE, FEATURES, _majority),
        Classifier("peak alone", BASELINE, PEAK, _thresholds),
        Classifier("contact time alone", BASELINE, CONTACT_TIME, _thresholds),
        Classifier(
            "logistic regression",
            CLASSIFIER,
            FEATURES,
            _logistic_regression,
            ({"C": 0.03}, {"C": 1.0}),
        ),
        Classifier(
            "random forest", CLASSIFIER, FEATURES, _random_forest, ({"min_samples_leaf": 3},)
        ),
        Classifier(
            "gradient boosting",
            CLASSIFIER,
            FEATURES,
            _gradient_boosting,
            ({"max_depth": 2}, {"max_depth": 4}),
        ),
        Classifier(
            "support vector machine",
            CLASSIFIER,
            FEATURES,
            _support_vector_machine,
            ({"C": 0.5}, {"C": 5.0}),
        ),
        Classifier("true contact time", TRUTH, TRUE_TIME, _thresholds),
        Classifier("length, first and last sample", PROBE, EDGES, _small_forest),
    )


def fit_tuned(
    classifier: Classifier, values: Floats, classes: Indices, groups: Indices | None, seed: int
) -> tuple[Any, Parameters]:
    """Fit a classifier, with the parameters that are best within the training part.

    They are chosen by a cross-validation.

    Parameters
    ----------
    classifier : Classifier
        What is fitted.
    values, classes : array
        The training part.
    groups : array, optional
        Its groups, which the inner cross-validation keeps apart; None splits it at random.
    seed : int
        Seed of the splits and of the classifier.

    Returns
    -------
    estimator
        The fitted classifier.
    mapping
        The parameters chosen.
    """
    splits = inner_splits(classes, groups, seed)

    def mean_accuracy(parameters: Parameters) -> float:
        return float(
            np.mean(
                [
                    _accuracy(classifier.make(parameters, seed, ()), values, classes, split)
                    for split in splits
                ]
            )
        )

    chosen = classifier.grid[0]
    if len(classifier.grid) > 1:
        chosen = max(classifier.grid, key=mean_accuracy)
    return classifier.make(chosen, seed, splits).fit(values, classes), chosen


def probabilities(estimator: Any, values: Floats, classes: int) -> Floats:
    """Return the probability of each class, 0 for one that the training part did not have.

    Parameters
    ----------
    estimator
        A fitted classifier.
    values : array, shape (signals, features)
        What is classified.
    classes : int
        Number of classes.
    """
    probability = np.zeros((len(values), classes))
    probability[:, estimator.classes_] = estimator.predict_proba(values)
    return probability


def _accuracy(estimator: Any, values: Floats, classes: Indices, split: Split) -> float:
    """Return the balanced accuracy on one part of the inner cross-validation."""
    fitted = estimator.fit(values[split.train], classes[split.train])
    return balanced_accuracy(fitted.predict(values[split.test]), classes[split.test])


def _filled(*steps: Any) -> Any:
    """Return a pipeline of steps that fills gaps by medians before."""
    from sklearn.impute import SimpleImputer
    from sklearn.pipeline import make_pipeline

    return make_pipeline(SimpleImputer(strategy="median", keep_empty_features=True), *steps)


def _majority(parameters: Parameters, seed: int, calibration: Sequence[Split]) -> Any:
    from sklearn.dummy import DummyClassifier

    return DummyClassifier(strategy="prior")


def _thresholds(parameters: Parameters, seed: int, calibration: Sequence[Split]) -> Any:
    from sklearn.tree import DecisionTreeClassifier

    # three thresholds, at most
    return _filled(DecisionTreeClassifier(max_depth=2, min_samples_leaf=0.02, random_state=seed))


def _logistic_regression(parameters: Parameters, seed: int, calibration: Sequence[Split]) -> Any:
    from sklearn.linear_model import LogisticRegression
    from sklearn.preprocessing import StandardScaler

    return _filled(StandardScaler(), LogisticRegression(max_iter=5000, **parameters))


def _random_forest(parameters: Parameters, seed: int, calibration: Sequence[Split]) -> Any:
    from sklearn.ensemble import RandomForestClassifier

    return _filled(RandomForestClassifier(_TREES, random_state=seed, **parameters))


def _gradient_boosting(parameters: Parameters, seed: int, calibration: Sequence[Split]) -> Any:
    from sklearn.ensemble import GradientBoostingClassifier

    return _filled(
        GradientBoostingClassifier(
            n_estimators=_TREES, subsample=0.7, max_features="sqrt", random_state=seed, **parameters
        )
    )


def _support_vector_machine(parameters: Parameters, seed: int, calibration: Sequence[Split]) -> Any:
    from sklearn.calibration import CalibratedClassifierCV
    from sklearn.preprocessing import StandardScaler
    from sklearn.svm import SVC

    machine = SVC(**parameters)
    if not calibration:
        return _filled(StandardScaler(), machine)
    # on parts with groups kept apart, which those of its own would not be
    parts = [(split.train, split.test) for split in calibration]
    calibrated = CalibratedClassifierCV(machine, cv=parts, ensemble=False)
    return _filled(StandardScaler(), calibrated)


def _small_forest(parameters: Parameters, seed: int, calibration: Sequence[Split]) -> Any:
    from sklearn.ensemble import RandomForestClassifier

    return _filled(RandomForestClassifier(_TREES, min_samples_leaf=10, random_state=seed))
