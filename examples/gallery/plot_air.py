"""
Air drag in a drop test
=======================

A quartz grain of 0.1 mm that is dropped from 2 m reaches its terminal velocity; a pebble of 60 mm
loses 0.3 % of its speed. For particles of up to a few millimetres, neglected drag biases a
restitution that is computed from rebound heights: it appears as a loss in the contact.
"""

# %%
# Impact speed against size
# -------------------------
# Spheres of quartz of sixty sizes fall 2 m with and without air; each is computed as one batch.
import matplotlib.pyplot as plt
import numpy as np
from scipy.integrate import solve_ivp

import vibroimpact as vi

radius = np.geomspace(20e-6, 30e-3, 60)
quartz, height, gravity = (
    vi.Material(density=2650.0, youngs_modulus=72e9, poissons_ratio=0.17),
    2.0,
    9.80665,
)


def fallen(air):
    """Return the speed at first touch of all spheres."""
    problem = vi.Problem(
        sphere=vi.rigid_sphere(radius, quartz),
        plate=vi.rigid_plate(),
        laws=(vi.laws.Newton(restitution=0.8),),
        height=height + radius,
        air=air,
        impacts=1,
    )
    return vi.tabulate(problem).impacts["approach_speed_m_s"][:, 0]


vacuum, in_air = fallen(None), fallen(vi.Air())
assert np.allclose(vacuum, np.sqrt(2.0 * gravity * height))

# %%
# Comparison with SciPy
# ---------------------
# Gravity and the drag of Clift and Gauvin (1970), integrated until impact; the drag is taken from
# the package. The smallest sphere falls at nearly Stokes' terminal velocity.


def by_scipy(one):
    """Return the speed of one sphere at the ground, integrated by SciPy."""

    def motion(_, state):
        return [-state[1], gravity - vi.Air().drag(state[1], one, quartz.density)]

    def ground(_, state):
        return state[0]

    ground.terminal = True
    return solve_ivp(
        motion, (0.0, 100.0), [height, 0.0], method="LSODA", rtol=1e-9, atol=1e-12, events=ground
    ).y[1, -1]


some = slice(None, None, 6)
assert np.allclose(in_air[some], [by_scipy(one) for one in radius[some]], rtol=1e-5)
stokes = 2.0 / 9.0 * quartz.density * gravity * radius[0] ** 2 / 1.81e-5
assert 0.9 * stokes < in_air[0] < stokes

# %%
# Loss of speed
# -------------
plt.style.use("vibroimpact.charts.print")
figure, axes = plt.subplots(figsize=(6.4, 4.0), layout="constrained")
diameter = 2e3 * radius
axes.fill_between(diameter, in_air, vacuum, color="#b3400e", alpha=0.12, label="lost to drag")
axes.loglog(diameter, vacuum, "--", color="#6b6b6b", label="in a vacuum")
axes.loglog(diameter, in_air, color="#00204d", linewidth=2.0, label="in air")
axes.loglog(
    diameter[some],
    [by_scipy(one) for one in radius[some]],
    "o",
    color="#0072b2",
    markerfacecolor="none",
    label="integrated by SciPy",
)
for words, place in (("silt", 0.042), ("sand", 0.35), ("gravel", 8.0)):
    axes.text(place, 0.075, words, color="#5a5a5a", ha="left")
for limit in (0.063, 2.0):
    axes.axvline(limit, color="#d9d9d9")
axes.set(
    xlabel="Diameter [mm]",
    ylabel="Speed at first touch [m/s]",
    ylim=(0.06, 9.0),
    title="Impact speed of quartz spheres after a fall of 2 m",
)
axes.xaxis.set_major_formatter("{x:g}")
axes.yaxis.set_major_formatter("{x:g}")
axes.legend(loc="center right")
plt.show()
