"""
Specified and achieved restitution of contact laws in DEM
=========================================================

With many contact laws the restitution that is entered in a discrete-element program is a parameter,
not the ratio of the speeds. Six laws are evaluated for parameters from 0.05 to 1: with some of them
a sphere that should hardly rebound keeps about two thirds of its speed.
"""

# %%
# Achieved restitution
# --------------------
# `achieved_restitution` uses a closed form where there is one, and integrates the contact
# otherwise, for arrays of parameters.
import matplotlib.pyplot as plt
import numpy as np

import vibroimpact as vi

asked = np.linspace(0.05, 1.0, 96)
laws = {
    "lankarani-nikravesh": "Lankarani\nNikravesh 1990",
    "hunt-crossley": "Hunt\nCrossley 1975",
    "lee-wang": "Lee, Wang 1983",
    "flores": "Flores 2011",
    "gonthier": "Gonthier 2004",
    "hu-guo": "Hu, Guo 2015",
}
mass, speed, stiffness = 0.0903, 3.0, 5.115e8
achieved = {
    name: vi.laws.achieved_restitution(
        vi.laws.find_contact_law(name)(stiffness=stiffness, restitution=asked),
        mass=mass,
        speed=speed,
    )
    for name in laws
}

# %%
# A published value for comparison: EXUDYN's test model contactSphereSphereTest.py gives a rebound
# speed of 6.629838 m/s for a sphere with an approach speed of 10 m/s, for Hunt and Crossley's law
# with a restitution of 0.5.
hunt = vi.laws.HuntCrossley(stiffness=1e6, exponent=1.0, restitution=0.5)
assert abs(vi.laws.achieved_restitution(hunt, mass=1.0, speed=10.0) - 0.6629838) < 1e-4

# %%
# Parameter for a required restitution
# ------------------------------------
# `law_achieving` is the inverse: it returns the law that achieves a required restitution.
wanted = 0.7
typed = {}
for name in laws:
    law = vi.laws.law_achieving(
        vi.laws.find_contact_law(name)(stiffness=stiffness, restitution=0.5),
        wanted,
        mass=mass,
        speed=speed,
    )
    assert abs(vi.laws.integrated_restitution(law, mass, speed) - wanted) < 1e-6
    typed[name] = float(law.restitution)
typed

# %%
# Comparison of the laws
# ----------------------
# On the dashed diagonal the achieved restitution is the specified one. The dots are the parameters
# that achieve a restitution of 0.7.
plt.style.use("vibroimpact.charts.print")
figure, axes = plt.subplots(figsize=(6.4, 4.4), layout="constrained")
axes.plot([0, 1], [0, 1], "--", color="#9a9a9a")
axes.axhline(wanted, color="#d9d9d9")
for name, colour in zip(
    laws, ("#00204d", "#0072b2", "#56a8d8", "#b3400e", "#c79000", "#5f8f3e"), strict=True
):
    axes.plot(
        asked, achieved[name], color=colour, linewidth=2.0, label=laws[name].replace("\n", ", ")
    )
    axes.plot(
        typed[name], wanted, "o", color=colour, markersize=6, markeredgecolor="white", zorder=3
    )
axes.annotate(
    "parameter near 0:\ntwo thirds remain",
    (0.06, achieved["lankarani-nikravesh"][1]),
    (0.02, 0.84),
    color="#00204d",
)
axes.set(
    xlabel="Restitution parameter [-]",
    ylabel="Restitution achieved [-]",
    title="Achieved restitution against the restitution parameter",
)
axes.set(xlim=(0.0, 1.0), ylim=(0.0, 1.0), aspect="equal")
axes.legend(loc="center left", bbox_to_anchor=(1.02, 0.5))
plt.show()
