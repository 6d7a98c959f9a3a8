"""
Energy balance of an impact on a vibrating plate
================================================

Every run computes an energy balance: at all times the energy put in is the sum of kinetic, stored
and dissipated energy. A steel ball falls on a plate of acrylic glass with damped modes; the balance
closes to 1e-9. A run in which it does not close to 1e-6 is an error.
"""

# %%
# A ball on a damped plate
# ------------------------
import matplotlib.pyplot as plt
import numpy as np

import vibroimpact as vi

case = {
    "sphere": {"radius": "10 mm", "material": "steel"},
    "plate": {
        "size": ["300 mm", "240 mm", "10 mm"],
        "material": "polymethylmethacrylate",
        "model": "elastic",
        "supports": "simply-supported",
        "modes": 40,
        "damping": 0.02,
    },
    "drop": {"height": "0.2 m"},
    "contact": {"law": "hunt-crossley", "restitution": 0.9},
    "run": {"impacts": 6, "duration": "1.2 s"},
}
response = vi.simulate(vi.case_of(case))
response

# %%
# Energy balance
# --------------
# Every entry of the balance is a column of the history. At every time their sum is the energy put
# in.
history = response.history()
stored = (
    "kinetic_J",
    "potential_J",
    "contact_elastic_J",
    "plate_kinetic_J",
    "plate_strain_J",
    "contact_dissipated_J",
    "plate_damping_J",
)
total = sum(history[name] for name in stored)
assert np.abs(total / response.energy["input_J"] - 1.0).max() < 1e-6
assert abs(response.energy["closure_relative"]) < 1e-9

# %%
# The chart of the report: the whole run, and each contact enlarged.
response.plot("energy")

# %%
# First milliseconds and whole run
# --------------------------------
# The first contact dissipates 6 % of the energy. The plate takes up nine tenths, and has dissipated
# nearly all of it before the second impact.
words = (
    "kinetic, ball",
    "potential, ball",
    "elastic, contact",
    "kinetic, plate",
    "strain, plate",
    "dissipated, contact",
    "dissipated, plate",
)
colours = ("#4a8cc7", "#d6e6f4", "#f7cd6b", "#9fce7f", "#d9edc9", "#404040", "#a3a3a3")
plt.style.use("vibroimpact.charts.print")
figure, panels = plt.subplots(
    1, 2, figsize=(7.2, 4.0), sharey=True, width_ratios=(3, 2), layout="constrained"
)
touch = response.impacts["time_s"][0]
for axes, time, unit in zip(
    panels,
    (touch + np.linspace(-1e-3, 8e-3, 1500), np.linspace(0.0, response.end_time[0], 3000)),
    (1e3, 1.0),
    strict=True,
):
    part = response.at(time)
    layers = [part[name] / response.energy["input_J"] for name in stored[::-1]]
    origin = touch if unit > 1.0 else 0.0
    axes.stackplot(unit * (time - origin), layers, labels=words[::-1], colors=colours[::-1])
    axes.set(xlim=tuple(unit * (time[[0, -1]] - origin)), ylim=(0.0, 1.0))
panels[0].set(
    xlabel="Time since first touch [ms]",
    ylabel="Part of the energy put in [-]",
    title="A steel ball on 10 mm of acrylic glass",
)
panels[1].set(xlabel="Time [s]", title="All six impacts")
figure.legend(
    *(reversed(one) for one in panels[0].get_legend_handles_labels()),
    loc="outside lower center",
    ncols=4,
)
# sphinx_gallery_thumbnail_number = -1
plt.show()
