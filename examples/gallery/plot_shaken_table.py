"""
Bouncing ball on a vibrating table: period doubling and chaos
=============================================================

As the acceleration of a vibrating table is increased, the motion of a ball on it changes from one
bounce per period by period doubling to chaos. The thresholds of the one-period motion and of the
first period doubling are known in closed form.
"""

# %%
# Thresholds
# ----------
# With the greatest acceleration of the table over gravity, :math:`\Gamma`, a motion with one bounce
# per period exists from :math:`\Gamma = \pi (1 - e)/(1 + e)` on; its period doubles at
# :math:`\Gamma^2 = [\pi (1 - e)/(1 + e)]^2 + 4 (1 + e^2)^2/(1 + e)^4` (Holmes 1982; Luck and Mehta
# 1993).
import matplotlib.pyplot as plt
import numpy as np

import vibroimpact as vi

frequency, restitution = 25.0, 0.5
omega = 2.0 * np.pi * frequency
exists = np.pi * (1.0 - restitution) / (1.0 + restitution)
doubles = np.hypot(exists, 2.0 * (1.0 + restitution**2) / (1.0 + restitution) ** 2)

# %%
# Batch of accelerations
# ----------------------
# Numbers in a problem may be arrays, and only the ratio of the accelerations matters: the batch has
# one table motion and as many values of gravity. Each ball starts nearly in phase with the table;
# after fifty bounces of transient the flights of the next thirty are recorded.
strength = np.append(np.linspace(1.02 * exists, doubles, 24), np.linspace(1.01 * doubles, 2.0, 70))
amplitude = 0.5e-3
gravity = amplitude * omega**2 / strength
balls = vi.Problem(
    sphere=vi.Body(mass=0.1, contact_offset=0.01),
    plate=vi.rigid_plate(),
    laws=(vi.laws.Newton(restitution=restitution),),
    speed=np.pi * gravity / omega,
    gravity=gravity,
    motion=vi.PlateMotion(amplitude=amplitude, frequency=frequency, phase=np.arccos(exists / 1.5)),
    impacts=80,
)
flights = np.diff(vi.tabulate(balls).impacts["time_s"][:, -31:]) * frequency
spread = np.ptp(flights, axis=1)
assert np.all(spread[(strength > 1.01 * exists) & (strength < 0.99 * doubles)] < 1e-3)
assert np.all(spread[strength > 1.01 * doubles] > 0.05)

# %%
# Bifurcation diagram
# -------------------
plt.style.use("vibroimpact.charts.print")
figure, axes = plt.subplots(figsize=(6.4, 4.2), layout="constrained")
axes.plot(strength, flights, ".", color="#00204d", markersize=2.2)
for threshold, words in ((exists, "one bounce per period"), (doubles, "period doubling")):
    axes.axvline(threshold, color="#b3400e", linestyle="--", linewidth=0.9)
    axes.text(threshold + 0.01, 1.5, words, color="#b3400e", fontsize=8)
axes.set(
    xlabel="Greatest acceleration of the table [g]",
    ylabel="Length of the flights [periods]",
    ylim=(0.4, 1.7),
)
axes.set_title("Bifurcation diagram of a bouncing ball, restitution 0.5")
plt.show()
