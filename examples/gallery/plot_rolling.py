"""
Transition from sliding to rolling after an oblique impact
==========================================================

A sphere that lands on a plate with a tangential velocity slides first and rolls at the end. Without
spin, friction reduces its velocity by two sevenths, whatever the coefficient; with a smaller
coefficient this takes longer. With sufficient backspin the sphere returns.
"""

# %%
# Four coefficients of friction
# -----------------------------
# The sphere has a normal velocity of 1 m/s and a tangential velocity of 2 m/s, without spin. It
# bounces, slides, and rolls.
import matplotlib.pyplot as plt
import numpy as np

import vibroimpact as vi


def thrown(coefficient, spin=0.0):
    """Return a sphere of glass thrown along a steel plate, with a spin about the axis
    across [rad/s].
    """
    case = {
        "sphere": {"radius": "10 mm", "material": "glass"},
        "plate": {"material": "steel"},
        "drop": {"velocity": [2.0, 0.0, -1.0], "spin": [0.0, spin, 0.0]},
        "contact": {
            "law": "newton",
            "restitution": 0.6,
            "friction": {"law": "coulomb", "coefficient": coefficient},
        },
        "run": {"duration": "2.5 s"},
    }
    return vi.simulate(vi.case_of(case))


coefficients = (0.03, 0.05, 0.08, 0.16)
slow = {coefficient: thrown(coefficient) for coefficient in coefficients}
backspin = thrown(0.16, spin=-700.0)

# %%
# Final velocity
# --------------
# Without spin all of them finally roll at 5/7 of the initial velocity. With backspin the final
# velocity follows from the angular momentum about a point of the plate: :math:`v = (5 v_0 + 2 R
# \omega_0)/7`, which is negative here.
for response in slow.values():
    end = response.at(2.5)
    assert abs(end["velocity_x_m_s"] - 5.0 / 7.0 * 2.0) < 1e-9
    assert abs(end["velocity_x_m_s"] - 0.01 * end["spin_y_rad_s"]) < 1e-9  # it rolls
assert abs(backspin.at(2.5)["velocity_x_m_s"] - (5.0 * 2.0 - 2.0 * 0.01 * 700.0) / 7.0) < 1e-9

# %%
# Velocity over time
# ------------------
# The velocity changes in steps while the sphere bounces, linearly while it slides in contact, and
# is then constant.
plt.style.use("vibroimpact.charts.print")
figure, axes = plt.subplots(figsize=(6.4, 4.2), layout="constrained")
time = np.linspace(0.0, 2.5, 3000)
for (coefficient, response), colour in zip(
    slow.items(), ("#8fc7e8", "#56a8d8", "#0072b2", "#00204d"), strict=True
):
    axes.plot(
        time,
        response.at(time)["velocity_x_m_s"],
        color=colour,
        linewidth=1.8,
        label=f"friction {coefficient:g}",
    )
axes.plot(
    time,
    backspin.at(time)["velocity_x_m_s"],
    color="#b3400e",
    linewidth=1.8,
    label="friction 0.16, backspin of 700 rad/s",
)
axes.axhline(10.0 / 7.0, color="#6b6b6b", linestyle="--", linewidth=0.9)
axes.text(
    2.5,
    10.0 / 7.0 - 0.03,
    "5/7 of the initial velocity",
    ha="right",
    va="top",
    color="#6b6b6b",
    fontsize=8,
)
axes.axhline(0.0, color="#6b6b6b", linewidth=0.7)
axes.set(
    xlabel="Time [s]",
    ylabel="Velocity along the plate [m/s]",
    title="Sliding and rolling of a sphere",
    xlim=(0.0, 2.5),
)
axes.legend(loc="center right", bbox_to_anchor=(1.0, 0.52))
plt.show()
