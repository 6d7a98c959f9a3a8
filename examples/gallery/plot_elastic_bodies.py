"""
Impact of an elastic sphere on an elastic plate: bending waves
==============================================================

Sphere and plate are elastic, as in Type 3 of the paper, but without damping in the contact. The
impact excites bending waves in a plate of 8 mm on four patches, which continue after the sphere has
left. First the elastic sphere on a rigid plane is compared with full finite-element solutions.
"""

# %%
# An elastic sphere on a rigid plane
# ----------------------------------
# Sphere and speed of Type 2 of the paper, without damping. Full finite elements of two codes of the
# authors of this package give a largest force of 12,166 N within 8 N. Ten modes of the sphere, and
# the contact counted once, come within half a per cent; a rigid sphere under Hertz's law is 7 %
# low.
import matplotlib.pyplot as plt
import numpy as np

import vibroimpact as vi

sphere = {"radius": "25 mm", "material": "rock-paper", "model": "elastic", "modes": 10}
case = {
    "sphere": sphere,
    "plate": {"material": "rigid"},
    "drop": {"speed": "8.826664 m/s", "gravity": 0},
    "contact": {"law": "hertz"},
    "run": {"impacts": 1},
}
rigid = vi.simulate(
    vi.case_of({**case, "sphere": {**sphere, "model": "rigid", "modes": None}})
).impacts["max_force_N"][0]
elastic = vi.simulate(vi.case_of(case)).impacts["max_force_N"][0]
print(f"rigid sphere {rigid:.0f} N, elastic {elastic:.0f} N, finite elements 12166 N")
assert abs(elastic / 12166.0 - 1.0) < 0.005
assert abs(rigid / 12166.0 - 0.926) < 0.002

# %%
# Elastic sphere and plate
# ------------------------
# The plate is supported on four patches, which stand for the bars of the paper. Its modes are
# computed once and stored.
plate = {
    "size": ["520 mm", "420 mm", "8 mm"],
    "material": "steel-paper",
    "model": "elastic",
    "modes": 60,
    "damping": 0.01,
}
plate["supports"] = {"type": "patches", "spacing": ["458.4 mm", "360 mm"], "radius": "20 mm"}
response = vi.simulate(
    vi.case_of({**case, "plate": plate, "run": {"impacts": 1, "duration": "4 ms"}})
)
assert abs(response.energy["closure_relative"]) < 1e-6
assert response.impacts["max_force_N"][0] < elastic  # the plate gives way

# %%
# Energy balance from first touch on.
response.plot("energy")

# %%
# Deflection of the plate
# -----------------------
# The result contains deflections on a grid at a number of times. At first the deflection is largest
# near the contact; the rock leaves 0.25 ms after first touch.
deflection = vi.result_of(response).deflection
plt.style.use("vibroimpact.charts.print")
figure, panels = plt.subplots(2, 3, figsize=(7.0, 4.2), layout="constrained")
for axes, moment in zip(
    panels.flat, (0.06e-3, 0.13e-3, 0.26e-3, 0.5e-3, 1.1e-3, 3.0e-3), strict=True
):
    frame = int(np.abs(deflection.time - moment).argmin())
    height = 1e6 * deflection.height[frame]
    most = np.nanmax(np.abs(height))
    axes.contourf(
        1e3 * deflection.x, 1e3 * deflection.y, height, np.linspace(-most, most, 41), cmap="RdBu_r"
    )
    axes.set_title(f"{1e3 * deflection.time[frame]:.2f} ms, to {most:.0f} µm", fontsize=9)
    axes.set(xticks=[], yticks=[], aspect="equal")
    for sign_x in (-1, 1):
        for sign_y in (-1, 1):
            axes.add_patch(
                plt.Circle((sign_x * 229.2, sign_y * 180.0), 20.0, fill=False, color="#5a5a5a")
            )
    for spine in axes.spines.values():
        spine.set_visible(True)
figure.suptitle(
    "Deflection of the plate on four patches: blue down, red up",
    x=0.02,
    ha="left",
    fontweight="bold",
)
# sphinx_gallery_thumbnail_number = -1
plt.show()
