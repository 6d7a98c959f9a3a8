"""A sensor on the plate: where it is, what it takes, and what an accelerometer adds."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal


@dataclass(frozen=True)
class Accelerometer:
    """What an accelerometer adds to the acceleration of its base.

    Parameters
    ----------
    resonance : float, optional
        Its mounted resonance [Hz], > 0; without one it follows its base exactly.
    damping_ratio : float, default 0.02
        Of that resonance [-].
    range : float, optional
        Largest magnitude that it reads [m/s^2]; beyond it is clipped.
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
    """A point that is watched.

    Parameters
    ----------
    name : str
        Under which the modes of the plate know the point.
    quantity : str, default "acceleration"
        "displacement" [m], "velocity" [m/s] or "acceleration" [m/s^2].
    direction : tuple of three floats, default (0, 0, 1)
        Unit vector along which it is taken; upwards by default.
    rate : float, default 50e3
        Samples per second [Hz], > 0.
    accelerometer : Accelerometer, optional
        What reads it; without one it is what the point does.
    """

    name: str
    quantity: Literal["displacement", "velocity", "acceleration"] = "acceleration"
    direction: tuple[float, float, float] = (0.0, 0.0, 1.0)
    rate: float = 50e3
    accelerometer: Accelerometer | None = None

    @property
    def unit(self) -> str:
        """The SI unit."""
        return {"displacement": "m", "velocity": "m/s", "acceleration": "m/s2"}[self.quantity]


def sample_count(duration: float, rate: float) -> int:
    """Return how many samples there are from the start to a time [s], both among them, at a rate [Hz].

    Examples
    --------
    >>> sample_count(0.05, 50e3)
    2501
    """
    return int(duration * rate * (1.0 + 1e-15)) + 1
