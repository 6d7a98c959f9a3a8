"""The signal of a sensor: what its recording holds."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.sensors.instruments.sensor import Sensor


@dataclass(frozen=True)
class Signal:
    """Signal of a sensor.

    Parameters
    ----------
    sensor : Sensor
        The sensor.
    value : array, shape (samples,)
        Samples at `time`, in the unit of the sensor.
    uncertainty : float, default NaN
        Estimated error by the modes left out, relative to the signal's rms value around the first
        contact.
    peak : float, default NaN
        The largest magnitude at an accelerometer before clipping [m/s^2].
    overload_time : float, default 0
        Total time beyond its range [s].

    Examples
    --------
    >>> import numpy as np
    >>> import vibroimpact as vi
    >>> signal = vi.sensors.Signal(vi.sensors.Sensor("a1", rate=50e3), np.array([0.0, 3.0, -5.0]))
    >>> signal.time.tolist(), signal.sensor.unit
    ([0.0, 2e-05, 4e-05], 'm/s2')
    """

    sensor: Sensor
    value: Floats
    uncertainty: float = float("nan")
    peak: float = float("nan")
    overload_time: float = 0.0

    @property
    def time(self) -> Floats:
        """Times of the samples since the start [s].

        They are recomputed on access, as they take as much memory as the values.
        """
        return self.times(0, len(self.value))

    def times(self, first: int, last: int) -> Floats:
        """Return the times of some samples [s], from the first to before the last."""
        return np.arange(first, min(last, len(self.value))) / self.sensor.rate

    def first_at(self, time: float) -> int:
        """Return the number of the first sample that is not before a time [s].

        It is the number of samples if there is none.
        """
        # may be off by rounding
        about = min(max(int(time * self.sensor.rate) - 2, 0), len(self.value))
        return about + int(np.searchsorted(self.times(about, about + 5), time))

    @property
    def largest(self) -> float:
        """The largest magnitude."""
        return float(max(self.value.max(initial=0.0), -self.value.min(initial=0.0)))
