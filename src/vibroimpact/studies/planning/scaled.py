"""Values that follow those of another swept key by a power, times a factor that is drawn.

An example are speeds that grow with the size.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.cases.fields.quantities import Quantity
from vibroimpact.errors import InputError, did_you_mean
from vibroimpact.studies.planning.axes import Axis, Listed, Values

Each = Literal["plate", "rock", "fall"]
"""For what of a population a value is drawn."""

_ORDER: tuple[Each, ...] = ("plate", "rock", "fall")
_DESIGNS = ("latin-hypercube", "sobol", "population")


@dataclass(frozen=True)
class Scaled:
    """Values value * (x / at)^exponent * factor of another key's values x.

    Parameters
    ----------
    value, at : float
        The value, without the factor, where the other key has the value `at` [SI units].
    of : str
        The other key.
    exponent : float
        Exponent.
    factor : Axis
        Distribution of the factor.
    each : {"plate", "rock", "fall"}, optional
        For what of a population the factor is drawn; by default as the key itself.

    Examples
    --------
    >>> from vibroimpact.studies.planning.axes import Listed
    >>> axis = Scaled(1.0, 0.01, "sphere.radius", 0.5, Listed((1.0, 2.0)))
    >>> (axis.quantiles(np.array([0.2, 0.8])) * axis.ratio(np.array([0.01, 0.04]))).tolist()
    [1.0, 4.0]
    """

    value: float
    at: float
    of: str
    exponent: float
    factor: Axis
    each: Each | None = None

    @property
    def is_random(self) -> bool:
        """True: it depends on what is drawn."""
        return True

    def __len__(self) -> int:
        return len(self.factor)

    def levels(self) -> Values:
        """Return the levels where the other key has the value `at`."""
        return self.value * self.factor.levels()

    def quantiles(self, parts: Floats) -> Values:
        """Return the quantiles where the other key has the value `at`."""
        return self.value * self.factor.quantiles(parts)

    def ratio(self, others: Values) -> Floats:
        """Return how many times larger they are at values of the other key."""
        return np.asarray((others / self.at) ** self.exponent)


def scaled_columns(axes: Mapping[str, Axis], columns: Mapping[str, Values]) -> dict[str, Values]:
    """Return values by key, with those that follow another key scaled by its values.

    Raises
    ------
    InputError
        If one of its values has no such power.
    """
    scaled = dict(columns)
    for key, values in columns.items():
        axis = axes.get(key)
        if isinstance(axis, Scaled):
            with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
                ratio = axis.ratio(columns[axis.of])
            not_finite = np.flatnonzero(~np.isfinite(ratio))
            if not_finite.size:
                base = columns[axis.of][not_finite[0]] / axis.at
                raise InputError(
                    f"{base:.6g} to the power of {axis.exponent:g} is no finite number; it "
                    f"is {axis.of} over at",
                    f'over."{key}"',
                )
            scaled[key] = values * ratio
    return scaled


def drawn_for(key: str) -> Each:
    """Return for what of a population the values of a key are drawn.

    Examples
    --------
    >>> drawn_for("sensors.a1.position.x"), drawn_for("drop.height"), drawn_for("sphere.radius")
    ('plate', 'fall', 'rock')
    """
    drawn_by_section: dict[str, Each] = {"plate": "plate", "sensors": "plate", "drop": "fall"}
    return drawn_by_section.get(key.partition(".")[0], "rock")


def check_scaled(
    design: str, groups: Mapping[str, Mapping[str, Axis]], quantities: Mapping[str, Quantity | None]
) -> None:
    """Check that values which follow another key have one to follow.

    Parameters
    ----------
    design : str
        Name of the design.
    groups : mapping of str to (mapping of str to Axis)
        The axes by key, of all drops, and of each class, by where they stand.
    quantities : mapping of str to Quantity or None
        Quantity of each swept key.

    Raises
    ------
    InputError
        If the design or the key to be followed does not suit.
    """
    following = {key for _, key, _ in _scaled(groups)}
    for group, key, axis in _scaled(groups):
        try:
            _check(design, key, axis, following, quantities)
            _check_numbers(axis.of, [axes[axis.of] for axes in groups.values() if axis.of in axes])
        except InputError as error:
            separator = "." if error.key else ""
            position = f'{group}."{key}"{separator}{error.key}'
            raise InputError(error.message, position) from None


def _check_numbers(key: str, axes: Iterable[Axis]) -> None:
    """Check that a key that another one follows has numbers as values.

    The values of the other key are computed from them.
    """
    if any(isinstance(axis, Listed) and axis.levels().dtype == object for axis in axes):
        raise InputError(
            f"{key} has values that are not numbers, so that nothing can follow it", "of"
        )


def _scaled(groups: Mapping[str, Mapping[str, Any]]) -> Iterator[tuple[str, str, Scaled]]:
    """Yield group, key and axis of the values that follow another key."""
    for group, axes in groups.items():
        for key, axis in axes.items():
            if isinstance(axis, Scaled):
                yield group, key, axis


def _check(
    design: str,
    key: str,
    axis: Scaled,
    following: set[str],
    quantities: Mapping[str, Quantity | None],
) -> None:
    """Check that an axis suits the design, and that the key that it follows can be followed."""
    if design not in _DESIGNS:
        raise InputError(f"in a {design} no key follows another; take one of {', '.join(_DESIGNS)}")
    if axis.of not in quantities:
        hint = did_you_mean(axis.of, quantities)
        raise InputError(f"{axis.of} is not swept here, so that nothing can follow it.{hint}", "of")
    if axis.of in following:
        raise InputError(f"{axis.of} follows another key itself; follow that one", "of")
    if design != "population":
        if axis.each is not None:
            raise InputError(f"a {design} has neither plates nor rocks; leave this out", "each")
        return
    finest = _ORDER.index(drawn_for(key))
    if _ORDER.index(drawn_for(axis.of)) > finest:
        raise InputError(
            f"{axis.of} differs from {drawn_for(axis.of)} to {drawn_for(axis.of)}, and "
            f"{key} has one value a {_ORDER[finest]}",
            "of",
        )
    if axis.each is not None and _ORDER.index(axis.each) > finest:
        raise InputError(
            f"{key} has one value a {_ORDER[finest]}; its factor can't differ from "
            f"{axis.each} to {axis.each}",
            "each",
        )
