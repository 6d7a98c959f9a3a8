"""The registry of features, of this package and of others by their entry points."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from importlib.metadata import EntryPoint, entry_points

from vibroimpact.errors import InputError
from vibroimpact.registry import find_named, modules_in
from vibroimpact.signals.feature import Family, Feature

PACKAGE = "vibroimpact.signals.features"
GROUP = "vibroimpact.feature_families"


@cache
def families() -> tuple[Family, ...]:
    """Return all families of features.

    They are those of this package and those of the entry points "vibroimpact.feature_families".

    Raises
    ------
    InputError
        If two features have the same name, or an entry point can't be loaded or is not a family.
    """
    own = [
        value
        for module in modules_in(PACKAGE)
        for value in vars(module).values()
        if isinstance(value, Family)
    ]
    of_others = [_loaded(point) for point in entry_points(group=GROUP)]
    all_families = (*own, *of_others)
    names = [feature.name for family in all_families for feature in family.features]
    for name in names:
        if names.count(name) > 1:
            raise InputError(
                f'two features are called "{name}"; rename one, or uninstall its package'
            )
    return all_families


def signal_features() -> Mapping[str, Feature]:
    """Return all features by name.

    Examples
    --------
    >>> signal_features()["rms"].equation
    'sqrt(mean(x^2))'
    """
    return {feature.name: feature for family in families() for feature in family.features}


def find_feature(name: str) -> Feature:
    """Return the feature with a name.

    Raises
    ------
    InputError
        If there is none; the message names the closest.

    Examples
    --------
    >>> find_feature("kurtosis").unit
    '1'
    """
    return find_named("feature", name, signal_features(), "features --list")


def _loaded(point: EntryPoint) -> Family:
    """Return the family of an entry point."""
    try:
        family = point.load()
    except Exception as error:
        # any error of another package is reported with the entry point's name
        raise InputError(
            f'the features "{point.name}" of the entry point {point.value} can\'t be '
            f"loaded: {error}; mend or uninstall its package"
        ) from error
    if not isinstance(family, Family):
        raise InputError(
            f'the entry point "{point.name}", {point.value}, is not a Family of features; '
            "mend or uninstall its package"
        )
    return family
