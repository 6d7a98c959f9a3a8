"""
Natural frequencies and mode shapes of a supported plate
========================================================

Frequencies and mode shapes of a steel plate are computed without a mesher or another finite-element
program. For simple supports they agree with Navier's closed form; on four patches they are compared
with finite elements.
"""

# %%
# Simply supported: comparison with Navier
# ----------------------------------------
# Kirchhoff's plate, simply supported on all edges, has the frequencies
# :math:`f_{mn} = \frac{\pi}{2} \sqrt{D / \rho h}\, [(m/a)^2 + (n/b)^2]`.
import matplotlib.pyplot as plt
import numpy as np

import vibroimpact as vi

length, width, thickness = 0.52, 0.42, 0.008
steel = vi.find_material("steel-paper")
case = {
    "sphere": {"radius": "25 mm", "material": "rock-paper"},
    "plate": {
        "size": [length, width, thickness],
        "material": "steel-paper",
        "model": "elastic",
        "modes": 12,
        "supports": "simply-supported",
        "mesh": {"theory": "thin"},
    },
    "drop": {"height": 1.0},
    "contact": {"law": "hertz"},
}
computed = vi.compute_modes(vi.case_of(case))["plate"].basis.frequencies

rigidity = steel.youngs_modulus * thickness**3 / 12.0 / (1.0 - steel.poissons_ratio**2)
waves = np.arange(1, 8)
squares = (waves[:, None] / length) ** 2 + (waves / width) ** 2
navier = np.sort((0.5 * np.pi * np.sqrt(rigidity / steel.density / thickness) * squares).ravel())[
    :12
]
assert np.abs(computed / navier - 1.0).max() < 1e-3

# %%
# Support on four patches
# -----------------------
# Thick plate elements on four patches of 20 mm radius, which stand for the paper's bars; curved
# tetrahedra on two meshes, computed by the authors of this package, give 171.3 and 268.8 Hz within
# 0.2 %.
plate = {
    **case["plate"],
    "supports": {"type": "patches", "spacing": ["458.4 mm", "360 mm"], "radius": "20 mm"},
}
del plate["mesh"]
modes = vi.compute_modes(vi.case_of({**case, "plate": plate}))
assert np.allclose(modes["plate"].basis.frequencies[:2], [171.3, 268.8], rtol=5e-3)

# %%
# The first twelve mode shapes
# ----------------------------
# The chart of the report, drawn by matplotlib into a given figure.
vi.charts.matplotlib_figure(modes.charts["plate_modes"], plt.figure())
plt.show()
