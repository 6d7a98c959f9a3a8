"""What the modes of a case have in common.

It is an error of its modulus, thickness or density, and one of its damping.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.statement.problem import Problem
from vibroimpact.structures.modal_model import ModalBasis
from vibroimpact.test_analysis.mode_pairs import FEWEST, WEAK, ModePair

_LEAST = 2e-3
"""Least relative difference of frequencies that is reported."""

_ALIKE = 0.35
"""Largest distance from their median, relative to it, of differences that are alike: thick plates
and coarse meshes make them differ by some of it.
"""

_DAMPED = float(np.log(1.25))
"""Least logarithm of a ratio of dampings that is reported: FRAC of two resonances that differ in
nothing else is then 0.99.
"""

_SURE = 3.0
"""Standard deviations that a difference must exceed."""


@dataclass(frozen=True)
class CommonDifference:
    """The relative difference that the measured frequencies have from those of a case.

    Parameters
    ----------
    value, least, largest : float
        Their median, and the least and the largest of them.
    modes : int
        Number of modes.
    """

    value: float
    least: float
    largest: float
    modes: int

    @property
    def sentence(self) -> str:
        """What it says of the case, without a full stop."""
        sign = 1.0 if self.value > 0.0 else -1.0
        direction = "higher" if self.value > 0.0 else "lower"
        low, high = sorted((100.0 * (sign * self.least), 100.0 * (sign * self.largest)))
        # frequencies are proportional to the root of the modulus over the density, and of a plate
        # in bending to its thickness
        # frequencies of bending go with the root of modulus over density, and with the thickness
        modulus_percent = 100.0 * ((1.0 + self.value) ** 2 - 1.0)
        return (
            f"the frequencies of {self.modes} modes are {100.0 * abs(self.value):.2g} % "
            f"{direction} than the case's ({low:.2g} to {high:.2g} %), "
            "as with a Young's modulus over density of the plate that differs from the case's "
            f"by {modulus_percent:+.2g} %, or a thickness that differs by about "
            f"{100.0 * self.value:+.2g} %"
        )


@dataclass(frozen=True)
class DampingDifference:
    """The multiples of the damping ratios of a case that were measured.

    Parameters
    ----------
    value, least, largest : float
        Their median, and the least and the largest of them; infinite if the case has no damping.
    measured : mapping of int to float
        The measured damping ratio of each mode of the case, by its number from 1.
    apart : float
        Largest magnitude of the relative difference of the frequencies of these modes.
    """

    value: float
    least: float
    largest: float
    measured: Mapping[int, float]
    apart: float

    def applied_to(self, ratios: Floats) -> Floats:
        """Return the damping ratios of the modes of a case, (modes,), with the measured ones.

        Modes whose damping was not measured have the median multiple of that of the case; without
        any, the median of the measured ones.
        """
        if np.isfinite(self.value):
            damping_ratios = self.value * ratios
        else:
            median = float(np.median(list(self.measured.values())))
            damping_ratios = np.full(len(ratios), median)
        for number, ratio in self.measured.items():
            damping_ratios[number - 1] = ratio
        return damping_ratios

    @property
    def sentence(self) -> str:
        """What it says of the case, without a full stop."""
        if len(self.measured) > 1:
            subject = f"the measured damping ratios of {len(self.measured)} modes are"
        else:
            subject = "the measured damping ratio of a mode is"
        if np.isfinite(self.value):
            multiples = range_of((self.least, self.largest), 2)
            in_brackets = f" ({multiples})" if " " in multiples else ""
            differ = f"{subject} {self.value:.2g} times the case's{in_brackets}"
        else:
            ratios = range_of(list(self.measured.values()), 2)
            differ = f"{subject} {ratios}, and the case has no damping"
        if self.apart < _LEAST:
            agree = f"the frequencies agree within {100.0 * _LEAST:.1g} %"
            return f"{agree}, and the damping does not: {differ}"
        return differ


@dataclass(frozen=True)
class SharedDifferences:
    """What the measured modes have in common that the case has not; None where there is nothing."""

    frequency: CommonDifference | None
    damping: DampingDifference | None

    @property
    def sentences(self) -> tuple[str, ...]:
        """What they say of the case, without full stops."""
        differences = (self.frequency, self.damping)
        return tuple(difference.sentence for difference in differences if difference is not None)

    def scaled(self, problem: Problem) -> Problem:
        """Return a problem with the frequencies of its plate scaled by what they share.

        They are scaled as by another modulus, so that compliances go with the inverse square. It is
        the problem itself if they share nothing.
        """
        if self.frequency is None:
            return problem
        modes = _modes_of(problem)
        factor = 1.0 + self.frequency.value
        frequencies = factor * modes.frequencies
        residuals = {name: residual / factor**2 for name, residual in modes.residuals.items()}
        return _with_modes(problem, replace(modes, frequencies=frequencies, residuals=residuals))

    def damped(self, problem: Problem) -> Problem:
        """Return a problem with the measured damping ratios of its plate.

        It is the problem itself if they do not differ.
        """
        if self.damping is None:
            return problem
        modes = _modes_of(problem)
        damping_ratios = self.damping.applied_to(modes.damping_ratios)
        return _with_modes(problem, replace(modes, damping_ratios=damping_ratios))


def _modes_of(problem: Problem) -> ModalBasis:
    assert problem.plate.modes is not None  # a plate that is compared has modes
    return problem.plate.modes


def _with_modes(problem: Problem, modes: ModalBasis) -> Problem:
    return problem.on_plate(replace(problem.plate, modes=modes), problem.quasi_static)


def shared_differences(pairs: Sequence[ModePair]) -> SharedDifferences:
    """Return what the measured modes have in common that those of the case have not."""
    return SharedDifferences(common_difference(pairs), damping_difference(pairs))


def doubts_of_differences(
    differences: SharedDifferences, frac: Floats, scaled_frac: Floats, damped_frac: Floats
) -> Iterator[str]:
    """Yield what measured modes have in common that the case has not, and what it does to FRAC.

    There is one sentence for each, without its full stop.

    Parameters
    ----------
    differences : SharedDifferences
        The differences.
    frac, scaled_frac, damped_frac : array, shape (S,)
        FRAC of each record or response; that with frequencies as they were measured; and that with
        the damping too.
    """
    scaled = range_of(scaled_frac)
    if differences.frequency is not None:
        plain = range_of(frac)
        yield f"{differences.frequency.sentence}; with that FRAC is {scaled}, and {plain} without"
    if differences.damping is not None:
        damped = range_of(damped_frac)
        yield (
            f"{differences.damping.sentence}; with the measured damping FRAC is {damped}, and "
            f"{scaled} without"
        )


def common_difference(pairs: Sequence[ModePair]) -> CommonDifference | None:
    """Return the difference that all paired frequencies have from the case's.

    None if they have none in common.
    """
    relative_differences = []
    relative_deviations = []
    for pair in pairs:
        if pair.number is not None and pair.measured is not None:
            measured = pair.measured.frequency
            relative_differences.append(measured.value / pair.frequency - 1.0)
            relative_deviations.append(measured.deviation / pair.frequency)
    if len(relative_differences) < FEWEST:
        return None
    differences = np.array(relative_differences)
    deviations = np.array(relative_deviations)
    median = float(np.median(differences))
    # they are one difference if none strays from the median by more than its own uncertainty, or by
    # more than a part of the median
    tolerance = np.maximum(_ALIKE * abs(median), _SURE * deviations)
    alike = np.abs(differences - median) <= tolerance
    if abs(median) < max(_LEAST, _SURE * float(np.median(deviations))) or not alike.all():
        return None
    return CommonDifference(
        median, float(differences.min()), float(differences.max()), len(differences)
    )


def damping_difference(pairs: Sequence[ModePair]) -> DampingDifference | None:
    """Return how the measured damping ratios differ from the case's.

    None if they do not, most of them in one direction. Modes that hardly contribute to the records
    are left aside, and those whose damping could not be determined.
    """
    compared = [
        (pair, pair.measured)
        for pair in pairs
        if pair.damping_measured and pair.measured is not None and pair.response >= WEAK
    ]
    if not compared:
        return None
    of_case = np.array([pair.damping_ratio for pair, _ in compared])
    measured = np.array([mode.damping_ratio.value for _, mode in compared])
    deviation = float(np.median([mode.damping_ratio.deviation for _, mode in compared]))
    with np.errstate(divide="ignore"):  # infinite for a case without damping
        multiples = measured / of_case
    median = float(np.median(multiples))
    if abs(np.log(median)) < max(_DAMPED, _SURE * deviation):
        return None
    return DampingDifference(
        value=median,
        least=float(multiples.min()),
        largest=float(multiples.max()),
        measured={
            pair.number: mode.damping_ratio.value
            for pair, mode in compared
            if pair.number is not None
        },
        apart=max(abs(pair.frequency_difference) for pair, _ in compared),
    )


def range_of(values: Floats | Sequence[float], digits: int = 0) -> str:
    """Return the least and the largest of numbers as text, or the one that they are.

    They have three decimals, or so many digits.
    """
    number_format = f".{digits}g" if digits else ".3f"
    least = f"{min(values):{number_format}}"
    largest = f"{max(values):{number_format}}"
    if least == largest:
        return least
    return f"{least} to {largest}"
