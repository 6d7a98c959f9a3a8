"""What the modes of a case have in common: an error of its modulus, thickness or density,
and one of its damping.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.problem import Problem
from vibroimpact.structures.modal_model import ModalBasis
from vibroimpact.test_analysis.mode_pairs import FEWEST, WEAK, ModePair

_LEAST = 2e-3
"""Least relative difference of frequencies that is told."""
_ALIKE = 0.35
"""Largest distance from their median, relative to it, of differences that are alike: thick plates
and coarse meshes make them differ by some of it."""
_DAMPED = float(np.log(1.25))
"""Least logarithm of a ratio of dampings that is told: FRAC of two resonances that differ
in nothing else is then 0.99.
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
        way = "higher" if self.value > 0.0 else "lower"
        frequency, stiffness = 100.0 * abs(self.value), 100.0 * ((1.0 + self.value) ** 2 - 1.0)
        ends = sorted(
            100.0 * (end if self.value > 0.0 else -end) for end in (self.least, self.largest)
        )
        thickness = f"a thickness that differs by about {100.0 * self.value:+.2g} %"
        causes = (
            "as with a Young's modulus over density of the plate that differs from the case's "
            f"by {stiffness:+.2g} %, or {thickness}"
        )
        differ = (
            f"the frequencies of {self.modes} modes are {frequency:.2g} % {way} than the "
            f"case's ({ends[0]:.2g} to {ends[1]:.2g} %)"
        )
        return f"{differ}, {causes}"


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
        usual = float(np.median(list(self.measured.values())))
        found = self.value * ratios if np.isfinite(self.value) else np.full(len(ratios), usual)
        for number, ratio in self.measured.items():
            found[number - 1] = ratio
        return found

    @property
    def sentence(self) -> str:
        """What it says of the case, without a full stop."""
        number = len(self.measured)
        modes = (
            f"the measured damping ratios of {number} modes are"
            if number > 1
            else "the measured damping ratio of a mode is"
        )
        if np.isfinite(self.value):
            ends = range_of((self.least, self.largest), 2)
            ends = f" ({ends})" if " " in ends else ""
            differ = f"{modes} {self.value:.2g} times the case's{ends}"
        else:
            differ = (
                f"{modes} {range_of(list(self.measured.values()), 2)}, and the case has no damping"
            )
        agree = f"the frequencies agree within {100.0 * _LEAST:.1g} %, and the damping does not: "
        return f"{agree if self.apart < _LEAST else ''}{differ}"


@dataclass(frozen=True)
class SharedDifferences:
    """What the measured modes have in common that the case has not; None where there is nothing."""

    frequency: CommonDifference | None
    damping: DampingDifference | None

    @property
    def sentences(self) -> tuple[str, ...]:
        """What they say of the case, without full stops."""
        return tuple(one.sentence for one in (self.frequency, self.damping) if one is not None)

    def scaled(self, problem: Problem) -> Problem:
        """Return a problem with the frequencies of its plate scaled by what they share,
        as by another modulus; itself if by none.
        """
        if self.frequency is None:
            return problem
        modes, factor = _modes_of(problem), 1.0 + self.frequency.value
        residuals = {name: residual / factor**2 for name, residual in modes.residuals.items()}
        return _with_modes(
            problem, replace(modes, frequencies=factor * modes.frequencies, residuals=residuals)
        )

    def damped(self, problem: Problem) -> Problem:
        """Return a problem with the measured damping ratios of its plate; itself if they
        do not differ.
        """
        if self.damping is None:
            return problem
        modes = _modes_of(problem)
        return _with_modes(
            problem, replace(modes, damping_ratios=self.damping.applied_to(modes.damping_ratios))
        )


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
    """Yield what measured modes have in common that the case has not, with what it does to FRAC,
    one sentence each without its full stop.

    Parameters
    ----------
    differences : SharedDifferences
        The differences.
    frac, scaled_frac, damped_frac : array, shape (S,)
        FRAC of each record or response; that with frequencies as they were measured; and that with
        the damping too.
    """
    plain, scaled, damped = (range_of(one) for one in (frac, scaled_frac, damped_frac))
    if differences.frequency is not None:
        yield f"{differences.frequency.sentence}; with that FRAC is {scaled}, and {plain} without"
    if differences.damping is not None:
        yield (
            f"{differences.damping.sentence}; with the measured damping FRAC is {damped}, and "
            f"{scaled} without"
        )


def common_difference(pairs: Sequence[ModePair]) -> CommonDifference | None:
    """Return the difference that all paired frequencies have from the case's; None if
    they have none in common.
    """
    both = [
        (pair.frequency, pair.measured.frequency)
        for pair in pairs
        if pair.number is not None and pair.measured is not None
    ]
    told = [
        (measured.value / frequency - 1.0, measured.deviation / frequency)
        for frequency, measured in both
    ]
    if len(told) < FEWEST:
        return None
    differences, deviations = np.array(told).T
    middle = float(np.median(differences))
    alike = np.abs(differences - middle) <= np.maximum(_ALIKE * abs(middle), _SURE * deviations)
    if abs(middle) < max(_LEAST, _SURE * float(np.median(deviations))) or not alike.all():
        return None
    return CommonDifference(middle, float(differences.min()), float(differences.max()), len(told))


def damping_difference(pairs: Sequence[ModePair]) -> DampingDifference | None:
    """Return how the measured damping ratios differ from the case's; None if they do not, most of
    them in one direction.

    Modes that hardly contribute to the records are left aside, and those whose damping could not be
    determined.
    """
    told = [
        (pair, pair.measured)
        for pair in pairs
        if pair.damping_measured and pair.measured is not None and pair.response >= WEAK
    ]
    if not told:
        return None
    of_case = np.array([pair.damping_ratio for pair, _ in told])
    measured = np.array([mode.damping_ratio.value for _, mode in told])
    deviation = float(np.median([mode.damping_ratio.deviation for _, mode in told]))
    with np.errstate(divide="ignore"):
        multiples = measured / of_case
    middle = float(np.median(multiples))
    if abs(np.log(middle)) < max(_DAMPED, _SURE * deviation):
        return None
    return DampingDifference(
        middle,
        float(multiples.min()),
        float(multiples.max()),
        {pair.number: mode.damping_ratio.value for pair, mode in told if pair.number is not None},
        max(abs(pair.frequency_difference) for pair, _ in told),
    )


def range_of(values: Floats | Sequence[float], digits: int = 0) -> str:
    """Return the least and the largest of numbers as text, or the one that they are: with
    three decimals, or with so many digits.
    """
    least, largest = (
        f"{end:.{digits}g}" if digits else f"{end:.3f}" for end in (min(values), max(values))
    )
    return least if least == largest else f"{least} to {largest}"
