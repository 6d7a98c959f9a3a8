"""A sensor on the plate: position, quantity, sampling, and the properties of an accelerometer."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from vibroimpact.errors import InputError, did_you_mean

FILTERS = ("sigma-delta", "butterworth", "none")
"""The anti-alias filters that a sensor may have."""

CORNER = 0.4  # default corner of a Butterworth filter, relative to the rate

Quantity = Literal["displacement", "velocity", "acceleration"]
_ORDERS: dict[Quantity, int] = {"displacement": 0, "velocity": 1, "acceleration": 2}
"""Order of the derivative of the displacement that each quantity is."""


@dataclass(frozen=True)
class Accelerometer:
    """Properties of an accelerometer beyond the acceleration of its base.

    Parameters
    ----------
    resonance : float, optional
        Its mounted resonance [Hz], > 0; without one it follows its base exactly.
    damping_ratio : float, default 0.02
        Of that resonance [-].
    range : float, optional
        Largest magnitude of its output [m/s^2], at which it is clipped before the anti-alias filter.
    noise : float, default 0
        Standard deviation of white noise in its samples [m/s^2]; the same in every run of one seed.
    resolution : float, optional
        Step of its readings [m/s^2].
    seed : int or tuple of int, default 0
        Of the noise; sensors of different names have noise of their own.
    """

    resonance: float | None = None
    damping_ratio: float = 0.02
    range: float | None = None
    noise: float = 0.0
    resolution: float | None = None
    seed: int | tuple[int, ...] = 0


@dataclass(frozen=True)
class Sensor:
    """A sensor at a point of the plate, and its sampling.

    Parameters
    ----------
    name : str
        Name of the point in the modes of the plate.
    quantity : str, default "acceleration"
        "displacement" [m], "velocity" [m/s] or "acceleration" [m/s^2].
    direction : tuple of three floats, default (0, 0, 1)
        Unit vector of the measured component; upwards by default.
    rate : float, default 50e3
        Samples per second [Hz], > 0.
    accelerometer : Accelerometer, optional
        The instrument; without one the signal is the motion of the point.
    filter : str, default "sigma-delta"
        Anti-alias filter, against frequencies above half the rate: "sigma-delta", "butterworth" or "none"; see `antialias_of`.
    corner : float, optional
        Frequency at which a Butterworth filter passes half of the power [Hz]; 0.4 of the rate by default.

    Raises
    ------
    InputError
        If there is no such filter, it takes no corner, or the corner is not below half the rate.
    """

    name: str
    quantity: Quantity = "acceleration"
    direction: tuple[float, float, float] = (0.0, 0.0, 1.0)
    rate: float = 50e3
    accelerometer: Accelerometer | None = None
    filter: str = "sigma-delta"
    corner: float | None = None

    def __post_init__(self) -> None:
        if self.filter not in FILTERS:
            known = ", ".join(f'"{name}"' for name in FILTERS)
            raise InputError(f'there is no filter "{self.filter}"; there are {known}.{did_you_mean(self.filter, FILTERS)}', "filter")
        if self.corner is not None and self.filter != "butterworth":
            raise InputError(f'the filter "{self.filter}" takes no corner; leave it out, or take "butterworth"', "corner")
        if self.corner is not None and self.corner >= 0.5 * self.rate:
            words = (
                f"{self.corner:g} Hz is not allowed; it must be below half of the {self.rate:g} samples per second, since what is faster"
            )
            raise InputError(f"{words} folds into the band; take {CORNER * self.rate:g} Hz or less, or a higher rate", "corner")

    @property
    def unit(self) -> str:
        """The SI unit."""
        return {"displacement": "m", "velocity": "m/s", "acceleration": "m/s2"}[self.quantity]

    @property
    def order(self) -> int:
        """Order of the derivative of the displacement that it takes."""
        return _ORDERS[self.quantity]


def sample_count(duration: float, rate: float) -> int:
    """Return the number of samples from the start to a time [s], both included, at a rate [Hz].

    Examples
    --------
    >>> sample_count(0.05, 50e3)
    2501
    """
    return int(duration * rate * (1.0 + 1e-15)) + 1
