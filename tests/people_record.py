"""Records of drops whose restitutions are known, with faults of sensors and clocks, in files as instruments write them."""

from __future__ import annotations

import wave
from functools import cache
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

import numpy as np

import vibroimpact as vi
from support import plain_case
from vibroimpact.calibration.calibrate_case import calibrate_case, read_calibration
from vibroimpact.calibration.calibration import Calibration

GRAVITY, RADIUS = 9.80665, 0.008
STEEL = {"density": 7850, "youngs_modulus": "210 GPa", "poissons_ratio": 0.3}
CONTACT = 5.5e-5
"""About Hertz's duration of a contact of such a ball at 1 m/s [s]."""


class Made(NamedTuple):
    """A file with a record, its kind, the restitutions that it holds, and what is wrong with it."""

    file: Path
    kind: str
    restitution: np.ndarray
    height: float
    faults: tuple[str, ...]


STYLES = ("plain", "numpy", "german", "utf-16", "preamble", "units-row", "blanks", "latin-1", "no-header", "no-units")


def made(seed: int, folder: Path) -> Made:
    """Return the record of a seed: of positions, of a force or of sound."""
    random = np.random.default_rng(1000 + seed)
    kind = ("position", "position", "force", "sound")[seed % 4]
    return {"position": _position, "force": _force, "sound": _sound}[kind](random, folder / f"{kind}-{seed}")


def evaluated(record: Made) -> Calibration:
    """Return what `calibrate` finds in a record."""
    target: dict[str, object] = {"file": str(record.file)}
    if record.kind == "sound":
        target |= {"contact_duration": f"{CONTACT} s"}
        if record.file.suffix != ".wav":
            target |= {"channel": "microphone"}
    # what is typed is exact here: it would widen the intervals of the first impact
    case = plain_case(
        sphere={"radius": f"{RADIUS} m +- 0", "material": STEEL},
        plate={"material": STEEL},
        drop={"height": f"{record.height!r} m +- 0", "gravity": f"{GRAVITY} m/s^2 +- 0"},
        contact={"law": "newton", "restitution": 0.5},
    )
    return calibrate_case(read_calibration({**case, "calibrate": {"target": target, "degree": 0}}))


def _position(random: np.random.Generator, stem: Path) -> Made:
    number, restitution, height = int(random.integers(3, 6)), random.uniform(0.55, 0.85), random.uniform(0.3, 1.0)
    rate = float(random.choice([120.0, 240.0, 500.0, 1000.0]))
    fall = float(np.sqrt(2.0 * (height - RADIUS) / GRAVITY))
    speeds = GRAVITY * fall * restitution ** np.arange(number + 1)
    leaves, begin = [], fall
    for before, after in pairwise(speeds):
        leaves.append(begin + CONTACT * before**-0.2)
        begin = leaves[-1] + 2.0 * after / GRAVITY
    time = np.arange(random.uniform() / rate, begin - 0.6 * speeds[-1] / GRAVITY, 1.0 / rate)
    shown, faults = time.copy(), []
    fault = str(random.choice(["none", "none", "jitter", "rounded"]))
    if fault == "jitter":
        time = time + 0.1 / rate * random.normal(size=len(time))
        shown = time.copy()
        faults.append("jitter")
    elif fault == "rounded":
        shown = np.round(time, 3 if rate <= 500.0 else 4)
        faults.append("rounded times")
    position = height - 0.5 * GRAVITY * np.maximum(time, 0.0) ** 2
    for after, leave in zip(speeds[1:], leaves, strict=True):
        since = time - leave
        position = np.where(since >= 0.0, RADIUS + after * since - 0.5 * GRAVITY * since**2, position)
    zero, drift, clock = random.uniform(-2e-3, 2e-3), random.uniform(-1e-3, 1e-3), 1.0 + 2e-3 * random.normal()
    position = position + zero + drift * time + random.uniform(5e-5, 3e-4) * random.normal(size=len(time))
    file = _table(random, stem, clock * shown, position, ("position", "m"), faults)
    return Made(file, "position", np.full(number, restitution), height, ("zero, drift, clock, noise", *faults))


@cache
def _forces() -> tuple[vi.Response, np.ndarray, np.ndarray]:
    case = plain_case(
        sphere={"radius": RADIUS, "material": STEEL},
        plate={"material": STEEL},
        drop={"height": 0.5, "gravity": GRAVITY},
        contact={"law": "tsuji", "restitution": 0.72},
        run={"impacts": 5},
    )
    response = vi.simulate(vi.read_case(case))
    touches, lasting = response.impacts["time_s"], response.impacts["duration_s"]
    fine = [np.linspace(touch, touch + duration, 1001) for touch, duration in zip(touches, lasting, strict=True)]
    time = np.concatenate([[0.0], *(part for touch in fine for part in ([touch[0] - 1e-9], touch, [touch[-1] + 1e-9]))])
    force = response.at(time)["force_N"]
    for touch in fine:
        force[np.isclose(time, touch[0] - 1e-9, rtol=0.0, atol=1e-12) | np.isclose(time, touch[-1] + 1e-9, rtol=0.0, atol=1e-12)] = 0.0
    return response, np.append(time, touches[-1] + 0.02), np.append(force, 0.0)


def _force(random: np.random.Generator, stem: Path) -> Made:
    response, times, force = _forces()
    rate = float(random.choice([2e5, 4e5]))
    time = np.arange(random.uniform() / rate, times[-1], 1.0 / rate)
    sampled = np.interp(time, times, force)
    peak, faults = float(force.max()), []
    gain = 1.0 + 0.02 * random.normal()
    value = gain * sampled + peak * (random.uniform(0.002, 0.02) * random.normal(size=len(time)) + random.uniform(-0.03, 0.03))
    value += peak * random.uniform(-0.01, 0.01) * time / time[-1]
    if random.uniform() < 0.2:
        value = np.minimum(value, 0.85 * peak)
        faults.append("clipped")
    file = _table(random, stem, time, value, ("force", "N"), faults)
    exact = response.impacts["restitution_achieved"][:4]
    return Made(file, "force", np.asarray(exact), 0.5, ("offset, drift, gain, noise", *faults))


def _sound(random: np.random.Generator, stem: Path) -> Made:
    number, restitution, height, rate = int(random.integers(4, 8)), random.uniform(0.6, 0.85), random.uniform(0.3, 1.0), 48_000
    fall = float(np.sqrt(2.0 * (height - RADIUS) / GRAVITY))
    flights = 2.0 * fall * restitution ** np.arange(1, number) + CONTACT
    touches = 0.1 + np.concatenate([[0.0], np.cumsum(flights)])
    time = np.arange(round((touches[-1] + 0.25) * rate)) / rate
    value = 10.0 ** random.uniform(-4.0, -2.3) * random.normal(size=len(time))
    for bounce, touch in enumerate(touches):
        since = (time - touch).clip(0.0)
        ringing = sum(
            np.exp(-since / fade) * np.sin(2.0 * np.pi * pitch * since) for pitch, fade in ((1800, 0.02), (4300, 0.012), (9100, 6e-3))
        )
        value += np.where(time >= touch, 0.2 * (1.0 + 0.1 * random.normal()) * restitution**bounce * ringing, 0.0)
    value += (
        random.uniform(-0.05, 0.05) + random.uniform(-0.02, 0.02) * time + random.uniform(0.0, 0.02) * np.sin(2.0 * np.pi * 50.0 * time)
    )
    faults = []
    if random.uniform() < 0.2:
        value = np.clip(value, -0.12, 0.12)
        faults.append("clipped")
    exact = np.full(number - 2, restitution)
    if random.uniform() < 0.6:
        file = stem.with_suffix(".wav")
        with wave.open(str(file), "wb") as sound:
            sound.setnchannels(1)
            sound.setsampwidth(2)
            sound.setframerate(rate)
            sound.writeframes(np.round(value.clip(-1.0, 1.0) * 32767.0).astype("<i2").tobytes())
    else:
        file = _table(random, stem, time, value, ("microphone", "V"), faults)
    return Made(file, "sound", exact, height, ("offset, drift, hum, noise", *faults))


_UNITS = {"m": (("m", 1.0), ("mm", 1e-3), ("cm", 1e-2)), "N": (("N", 1.0), ("kN", 1e3)), "V": (("V", 1.0), ("mV", 1e-3))}


def _table(
    random: np.random.Generator, stem: Path, time: np.ndarray, value: np.ndarray, column: tuple[str, str], faults: list[str]
) -> Path:
    """Write a table in one of the styles, which joins the faults."""
    style = str(random.choice(STYLES))
    faults.append(style)
    name, unit = column
    shown, size = _UNITS[unit][int(random.integers(len(_UNITS[unit])))]
    in_ms = style in ("german", "units-row")
    times, values = time * (1e3 if in_ms else 1.0), value / size
    rows = [(f"{one:.9g}", f"{other:.7g}") for one, other in zip(times, values, strict=True)]
    second = "ms" if in_ms else "s"
    encoding, separator, head = "utf-8", ",", [f"time [{second}],{name} [{shown}]"]
    if style == "numpy":
        head = [f"# time [s],{name} [{shown}]"]
    elif style == "german":
        separator, encoding = ";", "latin-1"
        words = {"position": "Position", "force": "Kraft", "microphone": "microphone"}
        head = ["sep=;", f"Zeit [ms];{words[name]} [{shown}]"]
        rows = [tuple(cell.replace(".", ",") for cell in row) for row in rows]
    elif style == "utf-16":
        separator, encoding, head = "\t", "utf-16", [f"time [s]\t{name} [{shown}]"]
    elif style == "preamble":
        head = ["Measured with scope 7, channel 1", "Date,2026-11-20,10:15", "Operator,A. B.", *head]
    elif style == "units-row":
        separator, head = ";", [f"Time;{name}", f"(ms);({shown})"]
    elif style == "blanks":
        separator, head = " ", [f"time_s {name}_{shown}"]
    elif style == "latin-1":
        encoding, head = "latin-1", ["# Gerät 3, Prüfung 12", *head]
    elif style == "no-header":
        head = []
    elif style == "no-units":
        head = [f"time,{name}"]
    file = stem.with_suffix(".txt" if style == "blanks" else ".csv")
    file.write_bytes("\n".join([*head, *(separator.join(row) for row in rows), ""]).encode(encoding))
    return file
