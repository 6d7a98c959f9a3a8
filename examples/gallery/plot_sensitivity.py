"""
Global sensitivity analysis of a drop: Sobol indices
====================================================

Five inputs of a drop have standard deviations of 2 to 16 %. Sobol indices quantify how much of the
variance of a result is explained by each of them, alone and in interaction with others: the largest
force depends mainly on the size and the modulus, the rebound height mainly on the restitution.
"""

# %%
# Study with random inputs
# ------------------------
# Saltelli's design needs ``samples`` times (number of keys + 2) drops.
from pathlib import Path
from tempfile import TemporaryDirectory

import matplotlib.pyplot as plt
import numpy as np

import vibroimpact as vi


def normal(mean, deviation, **more):
    return {"distribution": "normal", "mean": mean, "standard_deviation": deviation, **more}


over = {
    "sphere.radius": normal("25 mm", "1 mm"),
    "sphere.material.density": normal(2650, 60),
    "sphere.material.youngs_modulus": normal("50 GPa", "8 GPa"),
    "contact.restitution": normal(0.65, 0.03),
    "drop.height": normal("1 m", "2 cm"),
}
case = {
    "sphere": {
        "radius": "25 mm",
        "material": {"density": 2650, "youngs_modulus": "50 GPa", "poissons_ratio": 0.25},
    },
    "plate": {"material": "steel"},
    "drop": {"height": "1 m"},
    "contact": {"law": "tsuji", "restitution": 0.65},
    "run": {"impacts": 1},
    "sweep": {"design": "saltelli", "samples": 1024, "over": over},
}
with TemporaryDirectory() as folder:
    study = vi.studies.load_study(
        vi.studies.run_sweep(vi.studies.sweep_of(case), Path(folder, "tolerances"))
    )
    charts = study.charts

# %%
# Total indices of the largest force
# ----------------------------------
# The data of a chart can be accessed; its bars are the total indices of the largest force. For
# Hertz's contact that force is a product of powers, :math:`F \propto E^{*\,2/5} \rho^{3/5} R^2
# h^{3/5}`, so that the shares of the variance that is not due to the damping follow from the
# exponents and the relative standard deviations.
chart = charts["sensitivity"]
panel = next(panel for panel in chart.panels if panel.title == "Largest force")
bars = next(mark for mark in panel.marks if getattr(mark, "name", "").startswith("in all"))
total = dict(zip(panel.y.names, bars.values.tolist(), strict=True))

granite, steel = (1.0 - 0.25**2) / 50e9, (1.0 - 0.3**2) / 210e9
exponents = np.array(
    [0.6, 0.6, 0.4 * granite / (granite + steel), 2.0]
)  # of density, height, modulus and radius
scatter = np.array([60.0 / 2650.0, 0.02, 8.0 / 50.0, 1.0 / 25.0])
shares = (
    (1.0 - total["Restitution asked"])
    * (exponents * scatter) ** 2
    / ((exponents * scatter) ** 2).sum()
)
for name, share in zip(
    (
        "Density of the sphere",
        "Drop height",
        "Young's modulus of the sphere",
        "Radius of the sphere",
    ),
    shares,
    strict=True,
):
    print(f"{name}: {total[name]:.3f}, by the exponents {share:.3f}")
    assert abs(total[name] - share) < 0.03

# %%
# All results
# -----------
plt.style.use("vibroimpact.charts.print")
vi.charts.matplotlib_figure(chart, plt.figure())
plt.show()
