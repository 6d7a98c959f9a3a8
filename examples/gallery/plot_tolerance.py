"""
Integration error against tolerance
===================================

The restitution of five contact laws is integrated with tolerances from 1e-6 to 1e-13, and compared
with closed forms: the error stays below the tolerance.
"""

# %%
# Errors against closed forms
# ---------------------------
# These laws have a restitution in closed form; `integrated_restitution` does not use it.
import matplotlib.pyplot as plt
import numpy as np

import vibroimpact as vi

# %%
# Each law is integrated with fifteen tolerances.
mass, speed = 0.0903, 3.0
restitution = {"restitution": 0.6, "stiffness": 5.1e8}
laws = {
    "lankarani-nikravesh": restitution,
    "flores": restitution,
    "tsuji": {**restitution, "effective_mass": mass},
    "walton-braun": {"restitution": 0.6, "stiffness": 1e6},
    "thornton": {"effective_modulus": 2.4e9, "effective_radius": 0.025, "yield_pressure": 5e7},
}
tolerances = np.geomspace(1e-6, 1e-13, 15)
errors = {}
for name, values in laws.items():
    law = vi.laws.find_contact_law(name)(**values)
    exact = law.closed_form_restitution(mass, speed)
    found = [
        vi.laws.integrated_restitution(law, mass, speed, tolerance=float(one)) for one in tolerances
    ]
    errors[name] = np.abs(np.array(found) / exact - 1.0).clip(1e-16)
    assert np.all(errors[name] < np.maximum(tolerances, 1e-13))

# %%
# Error against tolerance
# -----------------------
plt.style.use("vibroimpact.charts.print")
figure, axes = plt.subplots(figsize=(6.4, 4.2), layout="constrained")
axes.fill_between(tolerances, tolerances, 1.0, color="#b3400e", alpha=0.1, linewidth=0)
axes.loglog(tolerances, tolerances, color="#b3400e", linewidth=1.2)
axes.text(
    2e-8, 2e-7, "error exceeds tolerance", color="#b3400e", ha="center", va="center", fontsize=8
)
for (name, error), marker in zip(errors.items(), "osD^v", strict=True):
    axes.loglog(tolerances, error, marker=marker, markersize=5, linewidth=1.0, label=name)
axes.set(
    xlabel="Tolerance [-]",
    ylabel="Error of the restitution [-]",
    title="Error of the restitution against the tolerance",
)
axes.set(xlim=(1e-13, 1e-6), ylim=(5e-17, 1e-5))
axes.legend(loc="upper left")
plt.show()
