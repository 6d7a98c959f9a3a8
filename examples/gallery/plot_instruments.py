"""
Geophone, strain gauge and microphone signals of an impact
==========================================================

A grain strikes a steel plate, and a geophone, a strain gauge and a microphone record the impact.
The signal of the microphone is delayed by the travel time of sound in air; the geophone measures
velocity, the strain gauge the strain of the surface.
"""

# %%
# Impact and instruments
# ----------------------
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
response = vi.simulate(vi.case_of(case))
signals = response.signals()

# %%
# Checks
# ------
# Far above its natural frequency the voltage of a geophone is its sensitivity times the velocity,
# and the signal of a microphone is nearly zero until sound arrives from the plate.
velocity, volts, pressure = (signals[name] for name in ("velocity", "geophone", "microphone"))
early = velocity.time < 2e-3
assert np.allclose(
    volts.value[early], 27.6 * velocity.value[early], atol=0.1 * np.abs(volts.value[early]).max()
)
way = distance / 343.2
silent = (
    pressure.time < way - 33 / 100e3
)  # except for 33 samples of the linear-phase filter, which also rings before an event
assert np.abs(pressure.value[silent]).max() < 1e-3 * np.abs(pressure.value).max()

# %%
# Signals
# -------
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
    "travel\ntime of\nsound",
    transform=panels[2].get_xaxis_transform(),
    ha="center",
    va="bottom",
    color="#b3400e",
    fontsize=8,
)
panels[2].set(xlabel="Time since first touch [ms]", xlim=(-0.2, 10.0))
figure.suptitle(
    "Signals of three instruments after an impact on a steel plate",
    x=0.02,
    ha="left",
    fontweight="bold",
)
plt.show()
