"""The modes in the frequency responses of files, alone or beside those of the plate of a case."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from os import PathLike

import numpy as np

from vibroimpact.arrays import Complex, Floats
from vibroimpact.errors import InputError
from vibroimpact.report.reported import Reported
from vibroimpact.signals.decay.find import DecayMode
from vibroimpact.signals.decay.responses import common_lines, modes_in_responses
from vibroimpact.signals.frequency_response import FrequencyResponse
from vibroimpact.signals.reading.universal_responses import contents_of, load_responses
from vibroimpact.structures.modal_model import ModalBasis
from vibroimpact.test_analysis.mode_pairs import ModePair, paired
from vibroimpact.test_analysis.responses.doubts import doubts_of_files, doubts_of_resolution
from vibroimpact.test_analysis.shared_differences import shared_differences


@dataclass(frozen=True, eq=False)
class MeasuredModes(Reported, reported_in="vibroimpact.test_analysis.measured.report"):
    """The modes in measured frequency responses.

    Parameters
    ----------
    responses : tuple of FrequencyResponse
        The responses.
    frequency : array, shape (n,)
        Their frequencies [Hz].
    value : array of complex, shape (S, n)
        Their values.
    modes : tuple of ModePair
        The modes, with those of a case where they were compared.
    doubts : tuple of str
        What is not sure, and why.
    """

    responses: tuple[FrequencyResponse, ...]
    frequency: Floats
    value: Complex
    modes: tuple[ModePair, ...]
    doubts: tuple[str, ...]


def modes_of_files(paths: Sequence[str | PathLike[str]]) -> MeasuredModes:
    """Return the modes in the frequency responses of universal files.

    Raises
    ------
    InputError
        If a file can't be read or has no frequency response, their frequencies differ, or there are
        too few.
    """
    responses, frequency, value = _read(paths)
    nan = float("nan")
    modes = modes_in_responses(responses)
    pairs = tuple(ModePair(None, nan, nan, nan, mode, mode.doubt) for mode in modes)
    return MeasuredModes(responses, frequency, value, pairs, _doubts(responses, modes, frequency))


def modes_beside(basis: ModalBasis | None, paths: Sequence[str | PathLike[str]]) -> MeasuredModes:
    """Return the modes in the frequency responses of files beside those of a plate.

    The files are universal ones, of whatever places. Modes are compared from half the lowest
    frequency of the plate to its highest.

    Raises
    ------
    InputError
        As `modes_of_files`, or if the plate has no modes or the responses end below them.
    """
    if basis is None:
        raise InputError(
            "only the modes of a plate are compared, and that of the case is rigid; give it "
            'model = "elastic"',
            "plate.model",
        )
    responses, frequency, value = _read(paths)
    lowest = float(basis.frequencies[0])
    highest = float(basis.frequencies[-1])
    band = (
        max(0.5 * lowest, float(frequency[0])),
        min(max(highest, 1.5 * lowest), float(frequency[-1])),
    )
    if band[0] >= band[1] or lowest >= frequency[-1]:
        raise InputError(
            f"the modes of the plate are from {lowest:.5g} to {highest:.5g} Hz, and the responses "
            f"from {frequency[0]:.5g} to {frequency[-1]:.5g} Hz; they have no mode in common"
        )
    modes = modes_in_responses(responses, band)
    # the places are not known: any mode may be in the responses
    response = np.ones(len(basis.frequencies))
    pairs = paired(basis.frequencies, basis.damping_ratios, response, modes, band)
    doubts = (*_doubts(responses, modes, frequency), *shared_differences(pairs).sentences)
    return MeasuredModes(responses, frequency, value, pairs, doubts)


def _read(
    paths: Sequence[str | PathLike[str]],
) -> tuple[tuple[FrequencyResponse, ...], Floats, Complex]:
    responses = tuple(response for path in paths for response in load_responses(path))
    return responses, *common_lines(responses)


def _doubts(
    responses: Sequence[FrequencyResponse], modes: Sequence[DecayMode], frequency: Floats
) -> tuple[str, ...]:
    return (
        *_of_records(responses),
        *doubts_of_files(responses),
        *doubts_of_resolution(modes, frequency),
    )


def _of_records(responses: Sequence[FrequencyResponse]) -> Iterator[str]:
    """Yield which files have records over time too."""
    for source in dict.fromkeys(response.source for response in responses):
        count = len(contents_of(source).records)
        if count:
            ending = "s" if count > 1 else ""
            records = f"{count} record{ending} over time"
            yield (
                f"{source} also has {records}, which these modes are not from; correlate "
                "--compare records compares them with a case"
            )
