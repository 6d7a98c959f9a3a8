"""The reasons for which a signal has no value of a feature."""

from __future__ import annotations

from enum import IntEnum


class Reason(IntEnum):
    """Why a feature has no value; 0 if it has one. The sentence is `text`.

    Examples
    --------
    >>> Reason.CONSTANT.text
    'all samples are the same'
    """

    NONE = 0
    EMPTY = 1
    NOT_FINITE = 2
    TOO_SHORT = 3
    CONSTANT = 4
    NO_ONSET = 5
    ONE_PACKET = 6
    TWO_PACKETS = 7
    BROAD_BAND = 8
    OUT_OF_RANGE = 9
    UNDEFINED = 10

    @property
    def text(self) -> str:
        """The reason in words."""
        return _TEXTS[self]


_TEXTS = {
    Reason.NONE: "",
    Reason.EMPTY: "there are no samples",
    Reason.NOT_FINITE: "a sample is not a finite number",
    Reason.TOO_SHORT: "there are too few samples",
    Reason.CONSTANT: "all samples are the same",
    Reason.NO_ONSET: "the envelope stays below the threshold",
    Reason.ONE_PACKET: "there are fewer than two packets",
    Reason.TWO_PACKETS: "there are fewer than three packets",
    Reason.BROAD_BAND: "the spectrum does not fall to the cut-off level below half the sampling "
    "rate",
    Reason.OUT_OF_RANGE: "the value is beyond the range of floating-point numbers",
    Reason.UNDEFINED: "the feature gave no number",
}
