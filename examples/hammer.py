"""A hammer hits a plate that is not quite as it was drawn: the records of the test beside the
simulation of the drawing.

The test is one of the program too: of a plate 2 % thinner, with another damping in each mode, and
with noise. Makes the picture of docs/hammer.md.
"""

from dataclasses import replace
from pathlib import Path

import numpy as np
from scipy.signal import resample_poly

import vibroimpact as vi

RATE, FINE = 12800.0, 16
DRAWN = {
    "name": "a plate under a hammer",
    "sphere": {
        "radius": "16 mm",
        "material": {"density": 7850, "youngs_modulus": "8 GPa", "poissons_ratio": 0.4},
    },
    "plate": {
        "size": ["400 mm", "300 mm", "12 mm"],
        "material": "steel",
        "model": "elastic",
        "modes": 12,
        "damping": 0.01,
        "supports": "simply-supported",
    },
    "drop": {"speed": "1 m/s", "position": ["70 mm", "40 mm"]},
    "contact": {"law": "hertz"},
    "run": {"impacts": 1, "duration": "0.35 s"},
    "sensors": [{"name": "a1", "position": ["120 mm", "80 mm"], "rate": RATE}],
}


def measured() -> tuple[vi.signals.Record, vi.signals.Record]:
    """The records of the acceleration and of the force."""
    damping = {"frequencies": [400, 1000, 2000, 4500], "ratios": [0.012, 0.006, 0.004, 0.003]}
    built = {**DRAWN["plate"], "size": ["400 mm", "300 mm", "11.76 mm"], "damping": damping}
    response = vi.simulate(vi.case_of({**DRAWN, "plate": built}))
    value = response.signals()["a1"].value
    time = np.arange(len(value) * FINE) / (RATE * FINE)
    duration = float(response.impacts["duration_s"][0])
    force = np.where(time < duration, response.at(np.minimum(time, duration))["force_N"], 0.0)
    # a force sensor and its converter have a band too
    force = resample_poly(force, 1, FINE, window=("kaiser", 10.0))
    quiet, random = round(0.02 * RATE), np.random.default_rng(1)
    value, force = (np.concatenate([np.zeros(quiet), part]) for part in (value, force))
    value += 0.003 * np.abs(value).max() * random.standard_normal(len(value))
    force += 0.001 * force.max() * random.standard_normal(len(force))
    return vi.signals.Record("a1", value, RATE, "m/s2"), vi.signals.Record(
        "hammer", force, RATE, "N"
    )


acceleration, hammer = measured()
found = vi.test_analysis.correlate(vi.case_of(DRAWN), [acceleration], force=hammer)
print(f"as drawn: residual {100.0 * found.relative_residual[0]:.0f} %, FRAC {found.frac[0]:.3f}")
pairs = [pair for pair in found.modes if pair.damping_measured]
for pair in pairs:
    mode, difference = pair.measured, 100.0 * pair.frequency_difference
    print(
        f"mode {pair.number}: {mode.frequency.value:.1f} Hz ({difference:+.2f} %), damping "
        f"ratio {mode.damping_ratio.value:.5f}"
    )
chart = found.charts["responses"]
vi.charts.save_charts([replace(chart, name="hammer-responses")], Path(), ["png"])

# frequencies 2 % low in all modes are those of a plate 2 % thinner; the damping is the measured one
damping = {
    "frequencies": [pair.frequency for pair in pairs],
    "ratios": [pair.measured.damping_ratio.value for pair in pairs],
}
thinner = {**DRAWN["plate"], "size": ["400 mm", "300 mm", "11.76 mm"], "damping": damping}
again = vi.test_analysis.correlate(
    vi.case_of({**DRAWN, "plate": thinner}), [acceleration], force=hammer
)
print(
    "thinner, with the measured damping: residual "
    f"{100.0 * again.relative_residual[0]:.1f} %, FRAC {again.frac[0]:.4f}"
)
