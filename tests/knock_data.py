"""A small data set of knocks on plates whose bound is known: half-sine forces on damped modes, two
classes that differ by contact time.

Contact times are lognormal, with the same spread in both classes, so that no classifier errs less
than Phi(-d / 2), d being the distance of the means of their logarithms over the spread. Each rock
has a tone of its own, which tells the rock and nothing of its class: a split at random may
recognise rocks by it.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import h5py
import numpy as np
from scipy.signal import fftconvolve
from scipy.stats import norm

MEDIANS, SPREAD = {"coal": 260e-6, "gangue": 180e-6}, 0.25
BAYES_ERROR = float(norm.cdf(-0.5 * np.log(MEDIANS["coal"] / MEDIANS["gangue"]) / SPREAD))
FINE = 8  # steps of the motion in a step of the signal
MODES = ((310.0, 0.03), (840.0, 0.02), (2300.0, 0.02), (5200.0, 0.02))  # Hz, damping ratio


def knocks(
    *,
    rocks: int = 30,
    falls: int = 12,
    plates: int = 3,
    samples: int = 384,
    rate: float = 20e3,
    tone: float = 0.3,
    seed: int = 0,
) -> dict[str, Any]:
    """Return the variables of the data set by name."""
    generator = np.random.default_rng(seed)
    rock = np.repeat(np.arange(rocks), falls)
    classes = rock % 2
    plate = (rock // 2) % plates
    count = len(rock)
    medians = np.array(list(MEDIANS.values()))
    # nine tenths of the variance of a contact time are of the fall, one tenth is of the rock
    spread = (
        np.sqrt(0.9) * generator.standard_normal(count)
        + np.sqrt(0.1) * generator.standard_normal(rocks)[rock]
    )
    duration = medians[classes] * np.exp(SPREAD * spread)
    force = np.exp(0.4 * generator.standard_normal(count))
    place = generator.uniform(-1.0, 1.0, count)
    fine = (np.arange(FINE * samples) + 0.5) / (FINE * rate)
    pulse = (
        np.where(fine < duration[:, None], np.sin(np.pi * fine / duration[:, None]), 0.0)
        * force[:, None]
    )
    signal = np.zeros((count, samples))
    for number, (frequency, damping) in enumerate(MODES):
        own = 2.0 * np.pi * frequency * (1.0 + 0.02 * plate)[:, None]
        mode = np.exp(-damping * own * fine) * np.sin(own * fine)
        motion = fftconvolve(pulse, mode, axes=1)[:, : FINE * samples]
        # the filter of a converter
        signal += np.cos(number * place)[:, None] * motion.reshape(count, samples, FINE).mean(
            axis=2
        )
    signal /= np.abs(signal).max(axis=1).mean()
    time = np.arange(samples) / rate
    frequencies, delays = (
        generator.uniform(1e3, 8e3, rocks)[rock],
        generator.uniform(0.0, 1.0, rocks)[rock],
    )
    envelope = np.exp(-(((time - 0.6 * delays[:, None] * time[-1]) / 2e-3) ** 2))
    level = force[:, None] / force.mean()
    signal += tone * level * envelope * np.sin(2.0 * np.pi * frequencies[:, None] * time)
    signal += 1e-3 * generator.standard_normal(signal.shape)
    return {
        "signal_a1": signal.astype(np.float32),
        "class": classes.astype(np.int16),
        "rock": rock.astype(np.int32),
        "plate": plate.astype(np.int32),
        "fall": np.arange(count, dtype=np.int32),
        "drop.height": generator.uniform(1.0, 4.0, count),
        "plate.size.thickness": np.array([0.008, 0.010, 0.012, 0.015])[plate % 4],
        "first_duration_s": duration,
        "largest_force_N": force,
        "rate": rate,
    }


def write_knocks(
    folder: Path,
    change: Callable[[dict[str, Any]], None] = lambda _: None,
    *,
    bayes_error: bool = True,
    **settings: Any,
) -> Path:
    """Write the data set as a folder, after a change of its variables, and return the folder."""
    variables = knocks(**settings)
    change(variables)
    rate = variables.pop("rate")
    folder.mkdir(parents=True)
    with h5py.File(folder / "dataset.nc", "w") as file:
        file.attrs.update(
            title="knocks", version="0", seed=0, study="", format="vibroimpact dataset 1"
        )
        count, samples = variables["signal_a1"].shape
        file["signal"], file["time_a1"] = np.arange(count), np.arange(samples) / rate
        for scale in ("signal", "time_a1"):
            file[scale].make_scale(scale)
        for name, values in variables.items():
            file[name] = values
            file[name].dims[0].attach_scale(file["signal"])
        file["signal_a1"].attrs.update(units="V", long_name="voltage", rate_Hz=rate)
        if "class" in variables:
            file["class"].attrs.update(
                flag_values=np.array([0, 1], np.int16), flag_meanings=" ".join(MEDIANS)
            )
    summary = {"dataset": {"signals": count}} | (
        {"bayes_error": BAYES_ERROR} if bayes_error else {}
    )
    (folder / "summary.json").write_text(json.dumps(summary))
    return folder
