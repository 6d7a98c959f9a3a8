"""
Parameter study: contact force and yield against size and drop height
=====================================================================

Which rocks dent a plate? A study computes drops of granite spheres of fifty sizes from forty
heights, and records the largest force and the contact pressure relative to the yield limit of the
plate. The pressure is independent of the size of the sphere.
"""

# %%
# The study
# ---------
# A study is a case with a section that specifies the swept keys, here a grid on logarithmic scales.
from pathlib import Path
from tempfile import TemporaryDirectory

import matplotlib.pyplot as plt
import numpy as np

import vibroimpact as vi

case = {
    "sphere": {"radius": "25 mm", "material": "granite"},
    "plate": {"material": "steel"},
    "drop": {"height": "1 m"},
    "contact": {"law": "hertz"},
    "run": {"impacts": 1},
    "sweep": {
        "over": {
            "sphere.radius": {"from": "2 mm", "to": "60 mm", "number": 50, "scale": "log"},
            "drop.height": {"from": "0.1 m", "to": "5 m", "number": 40, "scale": "log"},
        }
    },
}
with TemporaryDirectory() as folder:
    study = vi.studies.load_study(
        vi.studies.run_sweep(vi.studies.sweep_of(case), Path(folder, "rocks"))
    )
    radius, height = study.coordinates["sphere.radius"], study.coordinates["drop.height"]
    force, indentation = study.values("largest_force_N"), study.values("largest_indentation_m")
    overload = study.values("limit_plate_strength")

# %%
# Scaling with size and height
# ----------------------------
# Hertz's contact of a sphere that falls from a given height scales with its size: the force is
# proportional to the square of the radius, the indentation to the radius, and the peak pressure
# over 1.6 times the yield strength, the limit of the plate, is independent of it. The small
# deviation is due to the weight during the contact.
dropped = height - radius[:, None]  # the height is that of the centre
reference = force[0, 0] / radius[0] ** 2 / dropped[0, 0] ** 0.6
assert np.allclose(force, reference * radius[:, None] ** 2 * dropped**0.6, rtol=5e-3)
reference = overload[0, 0] / dropped[0, 0] ** 0.2
assert np.allclose(overload, reference * dropped**0.2, rtol=5e-3)

# %%
# Map of force and pressure
# -------------------------
# Colours show the largest force, dashed lines the ratio of the pressure to the yield limit of mild
# steel: granite dents it from all of these heights.
plt.style.use("vibroimpact.charts.print")
figure, axes = plt.subplots(figsize=(6.4, 4.4), layout="constrained")
map_of_force = axes.pcolormesh(
    1e3 * radius, height, force.T, norm="log", cmap="cividis", shading="gouraud", rasterized=True
)
lines = axes.contour(
    1e3 * radius, height, force.T, 10.0 ** np.arange(1.0, 6.0), colors="white", linewidths=0.9
)
axes.clabel(
    lines, fmt=lambda value: f"{value:g} N" if value < 1e3 else f"{1e-3 * value:g} kN", fontsize=8
)
yields = axes.contour(
    1e3 * radius,
    height,
    overload.T,
    [4.0, 5.0, 6.0, 7.0, 8.0],
    colors="#1b1b1b",
    linestyles="--",
    linewidths=1.2,
)
axes.clabel(yields, fmt="%g times yield", fontsize=8)
axes.set(
    xscale="log",
    yscale="log",
    xlabel="Radius of the rock [mm]",
    ylabel="Drop height [m]",
    title="Granite on steel: 2,000 drops",
)
axes.set_xticks([2, 5, 10, 20, 50], ["2", "5", "10", "20", "50"])
axes.set_yticks([0.1, 0.2, 0.5, 1.0, 2.0, 5.0], ["0.1", "0.2", "0.5", "1", "2", "5"])
axes.minorticks_off()
axes.grid(visible=False)
figure.colorbar(map_of_force, label="Largest force [N]")
plt.show()
