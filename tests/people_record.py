"""Records of drops whose restitutions are known, with faults of sensors and clocks, in
files as instruments write them.
"""

from __future__ import annotations

import wave
from functools import cache
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

import numpy as np

import vibroimpact as vi
from contact_forces import force_over_time
from support import plain_case
from vibroimpact.calibration.calibrate_case import calibrate_case, calibration_of
from vibroimpact.calibration.contact_law.calibration import Calibration
from vibroimpact.calibration.observed.noise import scaled, standard_deviations
from vibroimpact.calibration.observed.observations import Observations
from vibroimpact.calibration.records.bounce_record import impacts_in_bounces
from vibroimpact.calibration.records.force_record import impacts_in_force
from vibroimpact.calibration.records.position_record import impacts_in_position
from vibroimpact.signals.bounces.find import find_bounces
from vibroimpact.signals.reading.equal_steps import behind_decimals

GRAVITY, RADIUS = 9.80665, 0.008
STEEL = {"density": 7850, "youngs_modulus": "210 GPa", "poissons_ratio": 0.3}
NORMAL = 1.959964
"""Standard deviations on either side that hold 95 % of a normal distribution."""

CONTACT = 5.5e-5
"""About Hertz's duration of a contact of such a ball at 1 m/s [s]."""


class Made(NamedTuple):
    """A file with a record, its kind, the restitutions that it holds, and what is wrong
    with it; its times and values.
    """

    file: Path
    kind: str
    restitution: np.ndarray
    height: float
    faults: tuple[str, ...]
    time: np.ndarray
    value: np.ndarray


STYLES = (
    "plain",
    "numpy",
    "german",
    "utf-16",
    "preamble",
    "units-row",
    "blanks",
    "latin-1",
    "no-header",
    "no-units",
)


KINDS = ("position", "position", "force", "sound")
FAULTS = {
    "position": ("noise", "zero and drift", "clock", "jitter", "rounded times"),
    "force": ("noise", "offset and drift", "gain", "clipped"),
    "sound": ("noise", "offset and drift", "hum", "clipped"),
}
"""What may be wrong with a record of each kind."""


def made(seed: int, folder: Path | None, kind: str = "", only: str = "") -> Made:
    """Return the record of a seed: of positions, of a force or of sound; of one kind, or with one
    of its faults and a little noise.

    Without a folder there is no file.
    """
    random = np.random.default_rng(1000 + seed)
    kind = kind or KINDS[seed % 4]
    return {"position": _position, "force": _force, "sound": _sound}[kind](
        random, None if folder is None else folder / f"{kind}-{seed}", only
    )


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
    return calibrate_case(
        calibration_of({**case, "calibrate": {"target": target, "degree": 0, "air": False}})
    )


def standard_errors(record: Made) -> np.ndarray:
    """Return how far the restitutions that are found in a file are off, in standard deviations."""
    found = evaluated(record)
    count = min(len(found.values), len(record.restitution))
    deviations = np.diff(found.intervals, axis=1)[:count, 0] / (2.0 * NORMAL)
    return np.asarray((found.values[:count] - record.restitution[:count]) / deviations)


def errors_without_a_file(record: Made) -> np.ndarray:
    """Return the same of times and values alone."""
    seen = _seen(record)
    if "rebound_height" in seen.wanted:
        left = np.sqrt(2.0 * GRAVITY * (seen.wanted["rebound_height"] - RADIUS))
        noise = scaled(GRAVITY / left / seen.speeds, seen.noise["rebound_height"])
    else:
        left = seen.wanted["separation_speed"]
        noise = scaled(1.0 / seen.speeds, seen.noise["separation_speed"])
    values = left / seen.speeds
    deviations = standard_deviations(noise - scaled(values / seen.speeds, seen.speed_noise))
    count = min(len(values), len(record.restitution))
    return np.asarray((values[:count] - record.restitution[:count]) / deviations[:count])


def _seen(record: Made) -> Observations:
    first_speed = float(np.sqrt(2.0 * GRAVITY * (record.height - RADIUS)))
    if record.kind == "position":
        steps = behind_decimals(record.time)
        time = record.time if steps is None else steps[0]
        given = {"radius": RADIUS, "first_speed": first_speed, "contact_duration": CONTACT}
        return impacts_in_position(time, record.value, gravity=GRAVITY, **given)
    if record.kind == "force":
        mass = 4.0 / 3.0 * np.pi * RADIUS**3 * float(STEEL["density"])
        return impacts_in_force(
            record.time, record.value, mass=mass, gravity=GRAVITY, first_speed=first_speed
        )
    heard = find_bounces(vi.signals.Record("microphone", record.value, 48e3, "V"), CONTACT)
    return impacts_in_bounces(heard, gravity=GRAVITY, first_speed=first_speed)


def _position(random: np.random.Generator, stem: Path | None, only: str = "") -> Made:
    number, restitution, height = (
        int(random.integers(3, 6)),
        random.uniform(0.55, 0.85),
        random.uniform(0.3, 1.0),
    )
    rate = float(random.choice([120.0, 240.0, 500.0, 1000.0]))
    fall = float(np.sqrt(2.0 * (height - RADIUS) / GRAVITY))
    speeds = GRAVITY * fall * restitution ** np.arange(number + 1)
    # how long a contact lasts is known to 80 % of Hertz's duration: losses prolong it, and plates
    # that give
    contact = CONTACT * max(1.0 + 0.8 * random.normal(), 0.2)
    leaves, begin = [], fall
    for before, after in pairwise(speeds):
        leaves.append(begin + contact * before**-0.2)
        begin = leaves[-1] + 2.0 * after / GRAVITY
    time = np.arange(random.uniform() / rate, begin - 0.6 * speeds[-1] / GRAVITY, 1.0 / rate)
    clock = 1.0 + (2e-3 * random.normal() if only in ("", "clock") else 0.0)
    shown, faults = clock * time, []
    fault = only or str(random.choice(["none", "none", "jitter", "rounded times"]))
    if fault == "jitter":
        time = time + 0.1 / rate * random.normal(size=len(time))
        faults.append("jitter")
    elif fault == "rounded times":
        shown = np.round(shown, 3 if rate <= 500.0 else 4)
        faults.append("rounded times")
    position = height - 0.5 * GRAVITY * np.maximum(time, 0.0) ** 2
    for after, leave in zip(speeds[1:], leaves, strict=True):
        since = time - leave
        position = np.where(
            since >= 0.0, RADIUS + after * since - 0.5 * GRAVITY * since**2, position
        )
    zero, drift = random.uniform(-2e-3, 2e-3), random.uniform(-1e-3, 1e-3)
    if only in ("", "zero and drift"):
        position = position + zero + drift * time
    position = position + (
        random.uniform(5e-5, 3e-4) if only in ("", "noise") else 5e-5
    ) * random.normal(size=len(time))
    file = _table(random, stem, shown, position, ("position", "m"), faults)
    return Made(
        file,
        "position",
        np.full(number, restitution),
        height,
        ("zero, drift, clock, noise", *faults),
        shown,
        position,
    )


_LAWS: dict[str, tuple[str, tuple[float, ...]]] = {
    "tsuji": ("restitution", (0.6, 0.7, 0.8, 0.9)),
    "hunt-crossley": ("restitution", (0.6, 0.7, 0.8, 0.9)),
    "flores": ("restitution", (0.6, 0.7, 0.8, 0.9)),
    "kuwabara-kono": ("dissipation_time", (5e-7, 1.2e-6, 2e-6, 4e-6)),
    "thornton": ("yield_pressure", (2e9, 2.5e9, 3e9, 4e9)),
    "storakers": ("yield_strength", (6e8, 8e8, 1e9, 1.2e9)),
}
"""Laws of viscous and of plastic contacts, and a parameter with values whose restitutions
are about 0.6 to 0.9.
"""


@cache
def _forces(law: str, value: float) -> tuple[vi.Response, np.ndarray, np.ndarray]:
    case = plain_case(
        sphere={"radius": RADIUS, "material": STEEL},
        plate={"material": STEEL},
        drop={
            "height": 0.5,
            "gravity": GRAVITY,
            **({"same_spot": False} if "yield" in _LAWS[law][0] else {}),
        },
        contact={"law": law, _LAWS[law][0]: value},
        run={"impacts": 5},
    )
    response = vi.simulate(vi.case_of(case))
    return response, *force_over_time(response, 1001)


def _force(random: np.random.Generator, stem: Path | None, only: str = "") -> Made:
    law = str(random.choice(list(_LAWS)))
    response, times, force = _forces(law, float(random.choice(_LAWS[law][1])))
    rate = float(random.choice([2e5, 4e5]))
    time = np.arange(random.uniform() / rate, times[-1], 1.0 / rate)
    sampled = np.interp(time, times, force)
    peak, faults = float(force.max()), []
    gain = 1.0 + (0.02 * random.normal() if only in ("", "gain") else 0.0)
    noise = random.uniform(0.002, 0.02) if only in ("", "noise") else 0.002
    value = gain * sampled + peak * noise * random.normal(size=len(time))
    if only in ("", "offset and drift"):
        value += peak * (
            random.uniform(-0.03, 0.03) + random.uniform(-0.01, 0.01) * time / time[-1]
        )
    if only == "clipped" or (not only and random.uniform() < 0.2):
        value = np.minimum(value, 0.85 * peak)
        faults.append("clipped")
    file = _table(random, stem, time, value, ("force", "N"), faults)
    exact = response.impacts["restitution_achieved"]
    return Made(
        file, "force", np.asarray(exact), 0.5, ("offset, drift, gain, noise", *faults), time, value
    )


def _sound(random: np.random.Generator, stem: Path | None, only: str = "") -> Made:
    number, restitution, height, rate = (
        int(random.integers(4, 8)),
        random.uniform(0.6, 0.85),
        random.uniform(0.3, 1.0),
        48_000,
    )
    fall = float(np.sqrt(2.0 * (height - RADIUS) / GRAVITY))
    flights = 2.0 * fall * restitution ** np.arange(1, number) + CONTACT
    touches = 0.1 + np.concatenate([[0.0], np.cumsum(flights)])
    time = np.arange(round((touches[-1] + 0.25) * rate)) / rate
    value = 10.0 ** (random.uniform(-4.0, -2.3) if only in ("", "noise") else -4.0) * random.normal(
        size=len(time)
    )
    for bounce, touch in enumerate(touches):
        since = (time - touch).clip(0.0)
        ringing = sum(
            np.exp(-since / fade) * np.sin(2.0 * np.pi * pitch * since)
            for pitch, fade in ((1800, 0.02), (4300, 0.012), (9100, 6e-3))
        )
        value += np.where(
            time >= touch, 0.2 * (1.0 + 0.1 * random.normal()) * restitution**bounce * ringing, 0.0
        )
    if only in ("", "offset and drift"):
        value += random.uniform(-0.05, 0.05) + random.uniform(-0.02, 0.02) * time
    if only in ("", "hum"):
        value += random.uniform(0.0, 0.02) * np.sin(2.0 * np.pi * 50.0 * time)
    faults = []
    if only == "clipped" or (not only and random.uniform() < 0.2):
        value = np.clip(value, -0.12, 0.12)
        faults.append("clipped")
    exact = np.full(number - 2, restitution)
    if stem is None:
        file = Path()
    elif random.uniform() < 0.6:
        file = stem.with_suffix(".wav")
        with wave.open(str(file), "wb") as sound:
            sound.setnchannels(1)
            sound.setsampwidth(2)
            sound.setframerate(rate)
            sound.writeframes(np.round(value.clip(-1.0, 1.0) * 32767.0).astype("<i2").tobytes())
    else:
        file = _table(random, stem, time, value, ("microphone", "V"), faults)
    return Made(file, "sound", exact, height, ("offset, drift, hum, noise", *faults), time, value)


_UNITS = {
    "m": (("m", 1.0), ("mm", 1e-3), ("cm", 1e-2)),
    "N": (("N", 1.0), ("kN", 1e3)),
    "V": (("V", 1.0), ("mV", 1e-3)),
}


def _table(
    random: np.random.Generator,
    stem: Path | None,
    time: np.ndarray,
    value: np.ndarray,
    column: tuple[str, str],
    faults: list[str],
) -> Path:
    """Write a table in one of the styles, which joins the faults."""
    if stem is None:
        return Path()
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
        head = [
            "Measured with scope 7, channel 1",
            "Date,2026-11-20,10:15",
            "Operator,A. B.",
            *head,
        ]
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
    file.write_bytes(
        "\n".join([*head, *(separator.join(row) for row in rows), ""]).encode(encoding)
    )
    return file
