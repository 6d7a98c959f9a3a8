"""
Accelerometer signal of an impact: resonance, range, anti-alias filter
======================================================================

A hard steel ball of 6 mm in diameter strikes a plate of hardened steel, neither of which yields,
and an accelerometer measures the motion at a point 70 mm away. The recorded signal differs from
this motion by the mounted resonance of the accelerometer, its range, the anti-alias filter and the
sampling.
"""

# %%
# One impact, several measuring chains
# ------------------------------------
# The impact is computed once; the signals of any instrument follow from the result, as sensors do
# not affect the plate in this model.
from dataclasses import replace

import matplotlib.pyplot as plt
import numpy as np

import vibroimpact as vi

hard = {
    "density": 7830,
    "youngs_modulus": "210 GPa",
    "poissons_ratio": 0.3,
    "yield_strength": "2 GPa",
}
case = {
    "sphere": {"radius": "3 mm", "material": hard},
    "plate": {
        "size": ["200 mm", "150 mm", "6 mm"],
        "material": hard,
        "model": "elastic",
        "supports": "simply-supported",
        "max_frequency": "80 kHz",
        "mesh": {"element_size": "10 mm"},
        "damping": 0.005,
    },
    "drop": {"speed": "0.7 m/s", "position": ["20 mm", "10 mm"]},
    "contact": {"law": "hertz"},
    "run": {"impacts": 1, "duration": "4 ms"},
    "sensors": [{"name": "a1", "position": ["-50 mm", "10 mm"], "rate": "50 kHz"}],
}
response = vi.simulate(vi.case_of(case))
bare = response.problem.sensors[0]


def recorded(**instrument):
    """Return what an accelerometer with these properties records of the impact."""
    chain = {name: instrument.pop(name) for name in ("filter", "rate") if name in instrument}
    sensor = replace(bare, instrument=vi.sensors.Accelerometer(**instrument), **chain)
    return response.signals(sensor)["a1"]


ideal = recorded(rate=400e3, filter="none")
resonant = recorded(rate=400e3, filter="none", resonance=30e3)
filtered = recorded()
aliased = recorded(filter="none")
clipped = recorded(resonance=30e3, range=1500.0)

# %%
# Aliasing, resonance and overload
# --------------------------------
# Without a filter, components above 25 kHz are aliased into the band of a signal sampled at 50 kHz.
# The resonance increases the peak, and the range clips it, which the signal reports as overload.
# The default filter, that of a delta-sigma converter, is flat up to 22.5 kHz.
assert np.allclose(
    aliased.value, ideal.value[::8][: len(aliased.value)], atol=1e-6 * np.abs(ideal.value).max()
)
assert np.abs(resonant.value).max() > 1.2 * np.abs(ideal.value).max()
assert clipped.overload_time > 0.0
print(
    f"{clipped.peak:.0f} m/s² reached a range of 1500 m/s², which was exceeded for "
    f"{1e6 * clipped.overload_time:.0f} µs in all"
)

spectrum = {
    name: np.abs(np.fft.rfft(one.value)) / one.sensor.rate
    for name, one in (("ideal", ideal), ("filtered", filtered), ("aliased", aliased))
}
frequency = {
    name: np.fft.rfftfreq(len(one.value), 1.0 / one.sensor.rate)
    for name, one in (("ideal", ideal), ("filtered", filtered))
}
band = frequency["filtered"] < 20e3
truth = np.interp(frequency["filtered"][band], frequency["ideal"], spectrum["ideal"])
assert (
    np.abs(spectrum["filtered"][band] - truth).mean()
    < 0.2 * np.abs(spectrum["aliased"][band] - truth).mean()
)

# %%
# Signals in time and frequency
# -----------------------------
plt.style.use("vibroimpact.charts.print")
figure, (above, below) = plt.subplots(2, figsize=(6.6, 5.2), layout="constrained")
for one, words, style in (
    (resonant, "with a mounted resonance at 30 kHz", {"color": "#56a8d8", "linewidth": 1.0}),
    (ideal, "motion of the plate", {"color": "#00204d", "linewidth": 1.4}),
    (
        clipped,
        "sampled at 50 kHz after resonance, range and filter",
        {"color": "#b3400e", "marker": "o", "markersize": 3.5, "linewidth": 0.7},
    ),
):
    above.plot(1e6 * one.time, one.value, label=words, **style)
above.set(
    xlabel="Time since first touch [µs]",
    ylabel="Acceleration [m/s²]",
    xlim=(0, 400),
    ylim=(-8500, 4500),
    title="A steel ball on a plate, 70 mm from the sensor",
)
above.legend(loc="lower left")
for name, colour, words in (
    ("ideal", "#00204d", "motion"),
    ("aliased", "#c79000", "50 kHz without a filter"),
    ("filtered", "#b3400e", "50 kHz with filter"),
):
    below.semilogy(
        1e-3 * frequency.get(name, frequency["filtered"]),
        spectrum[name],
        color=colour,
        linewidth=1.1,
        label=words,
    )
below.axvline(25.0, color="#6b6b6b", linestyle="--", linewidth=0.9)
below.set(
    xlabel="Frequency [kHz]", ylabel="Spectrum [m/s² / Hz]", xlim=(0.0, 60.0), ylim=(1e-4, 20.0)
)
below.text(25.4, 0.7, "Nyquist frequency", color="#6b6b6b", fontsize=8)
below.legend(loc="upper right", ncols=3)
plt.show()
