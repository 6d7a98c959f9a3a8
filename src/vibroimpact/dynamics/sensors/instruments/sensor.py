"""A sensor on the plate: position, quantity, sampling, instrument and electronics."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal, get_args

from vibroimpact.dynamics.sensors.instruments.accelerometer import Accelerometer
from vibroimpact.dynamics.sensors.instruments.electronics import Amplifier, Converter, seeds
from vibroimpact.dynamics.sensors.instruments.instrument import (
    MOTIONS,
    UNITS,
    Direction,
    Instrument,
    Quantity,
    Subject,
)
from vibroimpact.dynamics.sensors.instruments.pole_pairs import Section
from vibroimpact.errors import InputError, did_you_mean

Filter = Literal["sigma-delta", "butterworth", "none"]
DEFAULT_FILTER: Filter = "sigma-delta"
FILTERS: tuple[Filter, ...] = get_args(Filter)
"""The anti-alias filters that a sensor may have."""

_CORNER = 0.4  # default corner of a Butterworth filter, relative to the rate
_FLAT = 0.45  # end of the pass band of a converter's filter, relative to the rate


@dataclass(frozen=True)
class Sensor:
    """A sensor at a point of the plate, and its sampling.

    Parameters
    ----------
    name : str
        Name of the point in the modes of the plate.
    quantity : str, default "acceleration"
        "displacement" [m], "velocity" [m/s] or "acceleration" [m/s^2]; or what the instrument puts
        out.
    direction : tuple of three floats, default (0, 0, 1)
        Unit vector of the measured component; upwards by default.
    rate : float, default 50e3
        Samples per second [Hz], > 0.
    instrument : Instrument, optional
        The instrument, such as an `Accelerometer` or a `Geophone`; without one the signal is the
        motion of the point.
    filter : str, default "sigma-delta"
        Anti-alias filter, against frequencies above half the rate: "sigma-delta", "butterworth" or
        "none"; see `antialias_of`.
    corner : float, optional
        Frequency at which a Butterworth filter passes half of the power [Hz]; 0.4 of the rate by
        default.
    amplifier : Amplifier, optional
        The amplifier behind the instrument.
    converter : Converter, optional
        What reads it.

    Raises
    ------
    InputError
        If the instrument puts out another quantity or has another filter, there is no such filter,
        it takes no corner, or the corner is not below half the rate.

    Examples
    --------
    >>> import vibroimpact as vi
    >>> geophone = vi.sensors.Geophone(natural_frequency=10.0, sensitivity=30.0)
    >>> (
    ...     vi.sensors.Sensor("a1", quantity="velocity", rate=20e3).unit,
    ...     vi.sensors.Sensor("a2", quantity="voltage", instrument=geophone).unit,
    ... )
    ('m/s', 'V')
    """

    name: str
    quantity: Quantity = "acceleration"
    direction: Direction = (0.0, 0.0, 1.0)
    rate: float = 50e3
    instrument: Instrument | None = None
    filter: str = DEFAULT_FILTER
    corner: float | None = None
    amplifier: Amplifier | None = None
    converter: Converter | None = None

    def __post_init__(self) -> None:
        if self.instrument is not None and self.quantity != self.instrument.quantity:
            words = (
                f"the output of the instrument is {self.instrument.quantity}, and not "
                f"{self.quantity}"
            )
            raise InputError(f'{words}; take quantity = "{self.instrument.quantity}"', "quantity")
        if self.filter not in FILTERS:
            known = ", ".join(f'"{name}"' for name in FILTERS)
            raise InputError(
                f'there is no filter "{self.filter}"; there are '
                f"{known}.{did_you_mean(self.filter, FILTERS)}",
                "filter",
            )
        if self.subject == "sound" and self.filter != "sigma-delta":
            raise InputError(
                'a microphone has the filter "sigma-delta"; leave out the filter', "filter"
            )
        if self.corner is not None and self.filter != "butterworth":
            # a microphone has no other filter
            other = "" if self.subject == "sound" else ', or take "butterworth"'
            raise InputError(
                f'the filter "{self.filter}" takes no corner; leave it out{other}', "corner"
            )
        if self.corner is not None and self.corner >= 0.5 * self.rate:
            words = (
                f"{self.corner:g} Hz is not allowed; it must be below half of the "
                f"{self.rate:g} samples per second, since what is faster"
            )
            raise InputError(
                f"{words} folds into the band; take {_CORNER * self.rate:g} Hz "
                "or less, or a higher rate",
                "corner",
            )

    @property
    def unit(self) -> str:
        """The SI unit."""
        return UNITS[self.quantity]

    @property
    def order(self) -> int:
        """Order of the derivative of the displacement that it takes."""
        if self.instrument is None:
            return MOTIONS[self.quantity]
        return self.instrument.order

    @property
    def sections(self) -> tuple[Section, ...]:
        """The pairs of poles of the instrument."""
        if self.instrument is None:
            return ()
        return self.instrument.sections

    @property
    def components(self) -> Direction:
        """Weights of the three numbers that a mode has at the sensor: displacements, or strains."""
        if self.instrument is None:
            return self.direction
        return self.instrument.components(self.direction)

    @property
    def subject(self) -> Subject:
        """What it is sensitive to."""
        if self.instrument is None:
            return "motion"
        return self.instrument.subject

    @property
    def steepness(self) -> float:
        """Power of the frequency by which what it sees grows in modes of the same deflection."""
        if self.instrument is None:
            return 0.0
        return self.instrument.steepness

    @property
    def passed(self) -> float:
        """Highest frequency that its anti-alias filter passes [Hz].

        Without one, it is what the default Butterworth filter would pass.
        """
        if self.filter == "sigma-delta":
            return _FLAT * self.rate
        return self.corner or _CORNER * self.rate

    def of_drop(self, number: int) -> Sensor:
        """Return the sensor with noise and hum of its own for a drop of a study, by its number."""
        instrument, amplifier = self.instrument, self.amplifier
        if isinstance(instrument, Accelerometer):
            instrument = replace(instrument, seed=(*seeds(instrument.seed), number))
        if amplifier is not None:
            amplifier = replace(amplifier, seed=(*seeds(amplifier.seed), number))
        return replace(self, instrument=instrument, amplifier=amplifier)


def sample_count(duration: float, rate: float) -> int:
    """Return the number of samples from the start to a time [s], both included, at a rate [Hz].

    Examples
    --------
    >>> sample_count(0.05, 50e3)
    2501
    """
    return int(duration * rate * (1.0 + 1e-15)) + 1
