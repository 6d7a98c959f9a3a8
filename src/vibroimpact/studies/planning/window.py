"""The part of a signal around the first touch that a study keeps."""

from __future__ import annotations

import math
from dataclasses import dataclass

from vibroimpact.arrays import Floats
from vibroimpact.errors import ComputationError


@dataclass(frozen=True)
class Window:
    """A part of a signal.

    Parameters
    ----------
    before : float
        Time that is kept before the first touch [s], >= 0.
    length : float
        Length of the part [s], > 0.
    """

    before: float
    length: float

    def samples(
        self, touches: Floats, rate: float, count: int, *, ended: bool = False
    ) -> tuple[int, int]:
        """Return the numbers of the first sample that is kept and of the one after the last.

        The first is the last sample that is not later than `before` ahead of the first touch, so
        that the touch falls between samples as it happens to.

        Parameters
        ----------
        touches : array
            Times of first touch of the impacts [s].
        rate : float
            Samples per second [Hz].
        count : int
            Number of samples of the whole signal.
        ended : bool, default False
            Whether the run ended before its duration, such as after its last impact.

        Raises
        ------
        ComputationError
            If there is no impact, or the part is not within the signal.

        Examples
        --------
        >>> import numpy as np
        >>> Window(1e-3, 10e-3).samples(np.array([0.1, 0.3]), 10e3, 5000)
        (990, 1090)
        """
        if not len(touches) or not math.isfinite(touches[0]):
            raise ComputationError(
                "there was no impact, so that its signal can't be cut around the first touch"
            )
        first_touch = float(touches[0])
        # the tolerance is for windows that start at a sample, but for rounding
        begin = math.floor((first_touch - self.before) * rate + 1e-6)
        end = begin + round(self.length * rate)
        if begin < 0:
            raise ComputationError(
                f"the sphere touches {first_touch:.3g} s after the start, less than the "
                f"{self.before:g} s before the touch that sweep.window keeps; let it fall from "
                "higher up, by drop.height in place of drop.speed, or keep less before the touch"
            )
        if end > count:
            shortness = (
                f"the signal ends at {count / rate:.4g} s, before the window does, at "
                f"{end / rate:.4g} s"
            )
            if ended:
                raise ComputationError(
                    f"{shortness}, as the run ended before run.duration; where run.impacts "
                    "ended it, allow more; else keep a shorter part"
                )
            raise ComputationError(f"{shortness}; give a longer run.duration")
        return begin, end
