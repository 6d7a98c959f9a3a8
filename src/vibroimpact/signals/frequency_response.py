"""A frequency response: motion at one place over the force at another, at any frequencies."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vibroimpact.arrays import Complex, Floats
from vibroimpact.errors import InputError
from vibroimpact.quoting import quoted

RESPONSE_UNITS = ("m/s2/N", "m/s/N", "m/N", "V/N", "1/N")
"""Units of frequency responses, in SI; "" if it is not known.

Those of accelerations, velocities, displacements, voltages and strains.
"""

_DIRECTIONS = (-3, -2, -1, 0, 1, 2, 3)


@dataclass(frozen=True)
class DegreeOfFreedom:
    """Where and in which direction a frequency response was measured, or the force acted.

    Parameters
    ----------
    names : tuple of str
        The names by which it may be called, such as that of its entity or its node; the first is
        shown.
    direction : int, default 0
        1, 2 or 3 along x, y or z (upwards), negative against the axis; 0 if it is not stated.

    Raises
    ------
    InputError
        If it has no name, or there is no such direction.

    Examples
    --------
    >>> DegreeOfFreedom(("12", "12-Z"), -3).name
    '12'
    """

    names: tuple[str, ...]
    direction: int = 0

    def __post_init__(self) -> None:
        if not self.names:
            raise InputError("a place needs a name or more; give one")
        if self.direction not in _DIRECTIONS:
            raise InputError(
                f"there is no direction {self.direction}; give 1, 2 or 3 for x, y or z, "
                "negative against the axis, or 0 if it is not known"
            )

    @property
    def name(self) -> str:
        """The name that is shown."""
        return self.names[0]


@dataclass(frozen=True, eq=False)
class FrequencyResponse:
    """A frequency response of a plate.

    Parameters
    ----------
    response, reference : DegreeOfFreedom
        Where it was measured, and where the force acted.
    frequency : array, shape (n,)
        Frequencies [Hz], rising, above 0.
    value : array of complex, shape (n,)
        Response over force, in `unit`.
    unit : str
        One of `RESPONSE_UNITS`, or "" if it is not known.
    coherence : array, shape (n,), optional
        Coherence of response and force, from 0 to 1; None if it is not known.
    source : str, default ""
        The file that it was read from.
    doubts : tuple of str, default ()
        Warnings about it, as sentences.

    Raises
    ------
    InputError
        If shapes differ, there are fewer than two frequencies, they do not rise or are not above 0,
        a value is not finite, a coherence is not from 0 to 1, or there is no such unit.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> frequency = np.array([90.0, 100.0, 110.0])
    >>> value = 1.0 / (100.0**2 - frequency**2 + 2j * 0.01 * 100.0 * frequency)
    >>> response = vi.signals.FrequencyResponse(
    ...     vi.signals.DegreeOfFreedom(("a1",)),
    ...     vi.signals.DegreeOfFreedom(("hammer",)),
    ...     frequency,
    ...     value,
    ...     "m/N",
    ... )
    >>> response.name, int(np.argmax(np.abs(response.value)))
    ('a1', 1)
    """

    response: DegreeOfFreedom
    reference: DegreeOfFreedom
    frequency: Floats
    value: Complex
    unit: str
    coherence: Floats | None = None
    source: str = ""
    doubts: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        frequency = np.asarray(self.frequency, dtype=float)
        value = np.asarray(self.value, dtype=complex)
        name = quoted(self.name)
        if frequency.ndim != 1 or frequency.shape != value.shape or len(frequency) < 2:
            raise InputError(
                f"the frequency response {name} has frequencies of the shape "
                f"{frequency.shape} and values of the shape {value.shape}; "
                "give two rows of the same length, of two numbers or more"
            )
        rises = (frequency > 0.0).all() and (np.diff(frequency) > 0.0).all()
        if not rises or not np.isfinite(frequency).all():
            raise InputError(
                f"the frequencies of the response {name} do not rise from above 0; sort "
                "them, each once, and leave 0 Hz out"
            )
        if not np.isfinite(value).all():
            raise InputError(
                f"the frequency response {name} has values that are not finite; leave "
                "those frequencies out"
            )
        if self.unit not in ("", *RESPONSE_UNITS):
            raise InputError(
                f"{quoted(self.unit)} is no unit of a frequency response; there are "
                f'{", ".join(RESPONSE_UNITS)}, and "" for one not known'
            )
        if self.coherence is not None:
            coherence = np.asarray(self.coherence, dtype=float)
            in_range = (coherence >= 0.0) & (coherence <= 1.0)
            if coherence.shape != frequency.shape or not in_range.all():
                raise InputError(
                    f"the coherence of the response {name} must have one number from 0 to "
                    "1 for each frequency"
                )
            object.__setattr__(self, "coherence", coherence)
        object.__setattr__(self, "frequency", frequency)
        object.__setattr__(self, "value", value)

    @property
    def name(self) -> str:
        """The name of what was measured."""
        return self.response.name
