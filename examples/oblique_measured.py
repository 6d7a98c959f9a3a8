"""Measured and computed: what a sphere of alumina that hits glass at an angle keeps of its velocity along the plate.

Makes the picture of docs/oblique.md.
"""

from dataclasses import replace

import matplotlib

matplotlib.use("Agg")  # no window
import matplotlib.pyplot as plt
import numpy as np

import vibroimpact as vi

# Kharaz, Gorham and Salman (2001), Powder Technol. 120:281: angle from the normal [deg], velocity along the plate after over before
measured = np.array(
    [(2.03, 0.794), (3.93, 0.745), (9.63, 0.673), (20.08, 0.596), (30.22, 0.688), (39.30, 0.772), (49.55, 0.847), (59.84, 0.902)]
)
speed = 3.85
case = {
    "sphere": {"radius": "2.5 mm", "material": {"density": 4000, "youngs_modulus": "380 GPa", "poissons_ratio": 0.23}},
    "plate": {"material": {"density": 2500, "youngs_modulus": "70 GPa", "poissons_ratio": 0.25}},
    "drop": {"speed": speed, "angle": 0.1},
    "contact": {"law": "lankarani-nikravesh", "restitution": 0.98},
    "run": {"impacts": 1},
}


def kept(law: str, degrees: np.ndarray) -> np.ndarray:
    """Return the velocity along the plate after over before under a friction law, at angles from the normal [deg]."""
    friction = {"friction": {"law": law, "coefficient": 0.092}}
    problem = vi.read_case({**case, "contact": {**case["contact"], **friction}}).to_problem()
    angle = np.radians(degrees)
    oblique = replace(problem.oblique, velocity=(speed * np.sin(angle), 0.0))
    found = vi.tabulate(replace(problem, speed=speed * np.cos(angle), oblique=oblique))
    return found.impacts["tangential_restitution"][:, 0]


figure, axes = plt.subplots(figsize=(7.5, 4.2), layout="constrained")
angles = np.linspace(0.3, 65.0, 260)
styles = {"mdr": "-", "mindlin": "--", "mindlin-rescale": "-.", "mindlin-force": ":", "coulomb": (0, (1, 3))}
colours = ("#00204d", "#0072b2", "#b3400e", "#5f8f3e", "#6b6b6b")
for (law, style), colour in zip(styles.items(), colours, strict=True):
    error = np.abs(kept(law, measured[:, 0]) - measured[:, 1]).mean()
    axes.plot(angles, kept(law, angles), linestyle=style, color=colour, label=f"{law}: mean error {error:.4f}")
    print(f"{law}: mean error {error:.4f}")
axes.plot(*measured.T, "o", color="#1b1b1b", label="measured (Kharaz, Gorham and Salman 2001)")
axes.set(xlabel="angle from the normal [deg]", ylabel="tangential restitution [-]", ylim=(0.55, 1.02), xlim=(0.0, 65.0))
axes.legend(frameon=False, loc="upper center", ncols=2, fontsize=8)
axes.grid(color="#dcdcdc", linewidth=0.6)
figure.savefig("oblique-measured.png", dpi=130)
