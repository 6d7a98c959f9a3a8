"""What friction adds to a signal: a lump of rock hits an inclined steel plate, with and without it,
and an accelerometer listens.

Makes the picture of docs/oblique.md.
"""

import matplotlib

matplotlib.use("Agg")  # no window
import matplotlib.pyplot as plt
import numpy as np

import vibroimpact as vi

case = {
    "sphere": {"radius": "25 mm", "material": "rock-paper"},
    "plate": {
        "size": ["520 mm", "420 mm", "20 mm"],
        "material": "steel",
        "model": "elastic",
        "supports": "simply-supported",
        "damping": 0.01,
        "modes": 60,
        "inclination": "30 deg",
    },
    "drop": {"speed": "6 m/s", "angle": "-30 deg", "position": ["-60 mm", "30 mm"]},
    "contact": {"law": "lankarani-nikravesh", "restitution": 0.65},
    "run": {"impacts": 1, "duration": "8 ms"},
    "sensors": [{"name": "beside", "position": ["100 mm", "-60 mm"]}],
}

figure, axes = plt.subplots(figsize=(7.5, 3.6), layout="constrained")
for coefficient, colour in ((0.0, "#6b6b6b"), (0.3, "#b3400e")):
    friction = {"friction": {"law": "mdr", "coefficient": coefficient}}
    response = vi.simulate(vi.case_of({**case, "contact": {**case["contact"], **friction}}))
    row = {name: values[0] for name, values in response.impacts.items()}
    signal = response.signals()["beside"]
    time = np.arange(len(signal.value)) / signal.sensor.rate
    axes.plot(
        1e3 * time, signal.value, color=colour, label=f"coefficient of friction {coefficient:g}"
    )
    print(
        f"coefficient {coefficient:g}: {row['separation_velocity_x_m_s']:.3f} m/s along "
        "the plate and "
        f"{-row['spin_y_after_rad_s']:.1f} rad/s after {row['approach_velocity_x_m_s']:.3f} m/s, "
        f"{1e3 * row['friction_lost_J']:.1f} mJ lost by friction, peak "
        f"{np.abs(signal.value).max():.0f} m/s2"
    )
axes.set(xlabel="time [ms]", ylabel="acceleration [m/s$^2$]", xlim=(0.0, 4.0))
axes.legend(frameon=False)
axes.grid(color="#dcdcdc", linewidth=0.6)
figure.savefig("oblique-on-a-plate.png", dpi=130)
