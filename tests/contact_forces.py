"""Contact forces of simulated drops over time, of which tests make records."""

from __future__ import annotations

import numpy as np

import vibroimpact as vi
from vibroimpact.arrays import Floats


def force_over_time(response: vi.Response, points: int) -> tuple[Floats, Floats]:
    """Times [s] from the release to 20 ms after the last touch, and the contact force [N].

    Each contact has equally spaced points, and is zero a nanosecond before and after.
    """
    touches, lasting = response.impacts["time_s"], response.impacts["duration_s"]
    fine = [
        np.linspace(touch, touch + duration, points)
        for touch, duration in zip(touches, lasting, strict=True)
    ]
    time = np.concatenate(
        [
            [0.0],
            *(part for touch in fine for part in ([touch[0] - 1e-9], touch, [touch[-1] + 1e-9])),
        ]
    )
    force = response.at(time)["force_N"]
    for touch in fine:
        force[
            np.isclose(time, touch[0] - 1e-9, rtol=0.0, atol=1e-12)
            | np.isclose(time, touch[-1] + 1e-9, rtol=0.0, atol=1e-12)
        ] = 0.0
    return np.append(time, touches[-1] + 0.02), np.append(force, 0.0)
