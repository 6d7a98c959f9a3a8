"""
Contact force and rebound of a rock dropped on a steel plate
============================================================

A rock of 25 mm radius falls 4 m onto a steel plate and bounces five times: Type 1 of the paper from
which this project started, with Adams' IMPACT and a damping for each bounce. The rebound agrees
with the printed one, which is among the numbers from which the full-damping penetration of the case
was inferred; the largest force is 1.3 % larger than printed.
"""

# %%
# Run a shipped case
# ------------------
# A case is a file, a dictionary, or a shipped case. At the end of a cell a response shows its
# impacts, and the limits of the theory that the drop exceeds.
import matplotlib.pyplot as plt
import numpy as np

import vibroimpact as vi

response = vi.simulate(vi.load_case("paper:type1-variable"))
response

# %%
# The chart of the report
# -----------------------
# The charts of the report are also available by their names as figures of plotly.
response.plot("force")

# %%
# Comparison with the paper
# -------------------------
# The paper prints a first rebound of 2.41132 m and a largest force of 9583.984 N. Its simulation
# had 20,000 output steps in 5 s, one in 0.25 ms, which is about as long as a contact: a largest
# force that is read from output values can miss the peak.
force, rebound = response.impacts["max_force_N"], response.impacts["rebound_height_m"]
assert abs(rebound[0] - 2.41132) < 1e-4
assert force[0] > 9583.984
assert abs(response.energy["closure_relative"]) < 1e-9

# %%
# Contact forces
# --------------
# The history can be evaluated at any time of the run: height above, force of each impact from first
# touch on below.
plt.style.use("vibroimpact.charts.print")
figure, (above, below) = plt.subplots(
    2, figsize=(6.4, 5.0), height_ratios=(2, 3), layout="constrained"
)
time = np.linspace(0.0, response.end_time[0], 2000)
above.plot(time, response.at(time)["position_m"], color="#1b1b1b")
above.set(
    xlabel="Time [s]",
    ylabel="Height [m]",
    ylim=(0.0, 4.2),
    title="A rock bounces five times on a steel plate",
)

colours = plt.get_cmap("cividis")(np.linspace(0.0, 0.85, len(force)))
for colour, touch, duration, rise in zip(
    colours,
    *(response.impacts[key] for key in ("time_s", "duration_s", "rebound_height_m")),
    strict=True,
):
    since = np.linspace(0.0, duration, 300)
    pulse = 1e-3 * response.at(touch + since)["force_N"]
    below.fill_between(1e6 * since, pulse, color=colour, alpha=0.15)
    below.plot(
        1e6 * since,
        pulse,
        color=colour,
        linewidth=1.8,
        label=f"{pulse.max():.2f} kN, rebound {rise:.2f} m",
    )
    above.plot(touch, 0.025, "o", color=colour, markersize=7, clip_on=False)
below.axhline(9.583984, color="#b3400e", linestyle="--", linewidth=0.9)
below.text(
    350,
    9.65,
    "largest force that the paper prints",
    color="#b3400e",
    ha="right",
    va="bottom",
    fontsize=8,
)
below.set(
    xlabel="Time since first touch [µs]", ylabel="Contact force [kN]", xlim=(0, 350), ylim=(0, 11)
)
below.legend(loc="upper right", bbox_to_anchor=(1.0, 0.88))
# sphinx_gallery_thumbnail_number = -1
plt.show()
