"""
One impact, three instruments
=============================

A grain strikes a steel plate, and a geophone, a strain gauge and a microphone tell of it: volts, strain and pressure of the same vibration.
The microphone hears it later, by the way of sound through the air; the geophone reads velocity; the gauge what bends.
"""

# %%
# The impact and its listeners
# ----------------------------
import matplotlib.pyplot as plt
import numpy as np

import vibroimpact as vi

distance = 0.3
case = {
    "name": "a grain on the plate of a river bed",
    "sphere": {"radius": "10 mm", "material": "granite"},
    "plate": {
        "size": ["492 mm", "358 mm", "15 mm"],
        "material": "steel",
        "model": "elastic",
        "supports": "simply-supported",
        "max_frequency": "15 kHz",
        "damping": 0.02,
    },
    "drop": {"speed": "1 m/s", "position": ["60 mm", "30 mm"]},
    "contact": {"law": "hertz"},
    "run": {"impacts": 1, "duration": "12 ms"},
    "sensors": [
        {
            "name": "velocity",
            "position": [0, 0],
            "face": "lower",
            "rate": "100 kHz",
            "quantity": "velocity",
        },
        {
            "name": "geophone",
            "position": [0, 0],
            "face": "lower",
            "rate": "100 kHz",
            "geophone": {
                "natural_frequency": "10 Hz",
                "sensitivity": "27.6 V s/m",
                "damping_ratio": 0.6,
            },
        },
        {
            "name": "strain gauge",
            "position": [0, 0],
            "face": "lower",
            "rate": "100 kHz",
            "instrument": "strain-gauge",
        },
        {
            "name": "microphone",
            "position": [0, 0],
            "rate": "100 kHz",
            "microphone": {"distance": distance},
        },
    ],
}
response = vi.simulate(vi.read_case(case))
signals = response.signals()

# %%
# What they must agree on
# -----------------------
# Far above its natural frequency a geophone reads its sensitivity times the velocity, and a microphone hears nothing before sound has come
# from the plate.
velocity, volts, pressure = (signals[name] for name in ("velocity", "geophone", "microphone"))
early = velocity.time < 2e-3
assert np.allclose(
    volts.value[early], 27.6 * velocity.value[early], atol=0.1 * np.abs(volts.value[early]).max()
)
way = distance / 343.2
silent = (
    pressure.time < way - 33 / 100e3
)  # but for 33 samples of the filter, which rings before as well as after
assert np.abs(pressure.value[silent]).max() < 1e-3 * np.abs(pressure.value).max()

# %%
# Side by side
# ------------
plt.style.use("vibroimpact.charts.print")
figure, panels = plt.subplots(3, figsize=(6.4, 5.2), sharex=True, layout="constrained")
for axes, name, factor, unit, colour in zip(
    panels,
    ("geophone", "strain gauge", "microphone"),
    (1e3, 1e6, 1.0),
    ("Voltage [mV]", "Strain [µm/m]", "Pressure [Pa]"),
    ("#00204d", "#5f8f3e", "#b3400e"),
    strict=True,
):
    axes.plot(1e3 * signals[name].time, factor * signals[name].value, color=colour)
    axes.set(ylabel=unit)
    axes.set_title(f"{name[0].upper()}{name[1:]}", color=colour)
    axes.axvline(0.0, color="#6b6b6b", linestyle="--", linewidth=0.9)
panels[2].axvspan(0.0, 1e3 * way, color="#b3400e", alpha=0.08, linewidth=0)
panels[2].text(
    0.5e3 * way,
    0.05,
    "sound is\non its way",
    transform=panels[2].get_xaxis_transform(),
    ha="center",
    va="bottom",
    color="#b3400e",
    fontsize=8,
)
panels[2].set(xlabel="Time since first touch [ms]", xlim=(-0.2, 10.0))
figure.suptitle(
    "One grain on a steel plate, three instruments", x=0.02, ha="left", fontweight="bold"
)
plt.show()
