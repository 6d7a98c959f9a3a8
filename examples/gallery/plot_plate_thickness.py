"""
Restitution coefficient against plate thickness
===============================================

A plate takes energy from an impact, which its bending waves carry away. The restitution of the
paper's rock of 25 mm radius on steel plates of 7 to 20 mm agrees with Zener's theory of an infinite
plate within 0.01: at 8 mm a quarter of the speed is lost without any damping. The contact is taken
to be elastic; whether the rock would yield or crack is not known, since the paper gives no
strength.
"""

# %%
# Zener's theory of an infinite plate
# -----------------------------------
# The velocity of an infinite plate at the contact is proportional to the force, so that one
# parameter remains, :math:`\lambda = m / (8 \sqrt{D \rho h}\, T)`, and one equation,
# :math:`\sigma'' + (1 + \lambda\, d/d\tau)\, \sigma^{3/2} = 0` (Phys. Rev. 59:669, 1941). SciPy
# integrates it.
import matplotlib.pyplot as plt
import numpy as np
from scipy.integrate import solve_ivp

import vibroimpact as vi

radius, speed = 25e-3, 8.826664
rock, steel = vi.find_material("rock-paper"), vi.find_material("steel-paper")
modulus = steel.youngs_modulus / (1.0 - steel.poissons_ratio**2)
effective = 1.0 / (1.0 / modulus + (1.0 - rock.poissons_ratio**2) / rock.youngs_modulus)
mass, stiffness = (
    4.0 / 3.0 * np.pi * radius**3 * rock.density,
    4.0 / 3.0 * effective * np.sqrt(radius),
)
contact_time = (mass / (stiffness * np.sqrt(speed))) ** 0.4


def zener(thickness):
    """Return the restitution of the rock on an infinite plate of steel of this thickness [m]."""
    rigidity = modulus * thickness**3 / 12.0
    loss = mass / (8.0 * np.sqrt(rigidity * steel.density * thickness) * contact_time)

    def slopes(_, state):
        root = np.sqrt(max(state[0], 0.0))
        return [state[1], -root * max(state[0], 0.0) - 1.5 * loss * root * state[1]]

    def apart(time, state):
        return state[0] if time > 0.1 else 1.0

    apart.terminal = True
    return -solve_ivp(slopes, (0.0, 50.0), [0.0, 1.0], rtol=1e-9, atol=1e-12, events=apart).y[1, -1]


# %%
# Finite plates
# -------------
# The plate of the paper with other thicknesses, simply supported, with all modes up to 6 kHz. Its
# edges are so far away that hardly any wave returns before the rock has left.


def dropped(thickness):
    """Return the restitution of the rock on a plate of this thickness [m]."""
    case = {
        "sphere": {"radius": radius, "material": "rock-paper"},
        "plate": {
            "size": [0.52, 0.42, thickness],
            "material": "steel-paper",
            "model": "elastic",
            "supports": "simply-supported",
            "max_frequency": "6 kHz",
        },
        "drop": {"speed": speed, "gravity": 0},
        "contact": {"law": "hertz"},
        "run": {"impacts": 1},
    }
    return vi.simulate(vi.case_of(case)).impacts["restitution_achieved"][0]


thicknesses = np.array([0.007, 0.009, 0.013, 0.02])
computed = np.array([dropped(one) for one in thicknesses])
theory = np.array([zener(one) for one in thicknesses])
assert abs(zener(0.008) - 0.74196) < 1e-4  # for the parameter 0.1768 of the paper's plate and drop
assert np.abs(computed - theory).max() < 0.01

# %%
# Required thickness
# ------------------
# For a loss of less than a hundredth of the speed to bending waves, an infinite plate would have to
# be 44 mm thick.
fine = np.geomspace(4e-3, 60e-3, 60)
curve = np.array([zener(one) for one in fine])
enough = np.interp(0.99, curve, fine)
print(f"restitution of 0.99 from {1e3 * enough:.0f} mm on")

plt.style.use("vibroimpact.charts.print")
figure, axes = plt.subplots(figsize=(6.4, 4.0), layout="constrained")
axes.fill_between(
    1e3 * fine, curve, 1.0, color="#b3400e", alpha=0.12, label="lost to waves in the plate"
)
axes.plot(1e3 * fine, curve, color="#00204d", linewidth=2.0, label="infinite plate (Zener 1941)")
axes.plot(
    1e3 * thicknesses,
    computed,
    "o",
    color="#b3400e",
    markersize=8,
    markeredgecolor="white",
    label="plates of 520 x 420 mm, computed",
)
axes.annotate(
    f"0.99 from {1e3 * enough:.0f} mm on",
    (1e3 * enough, 0.99),
    (1e3 * enough, 0.85),
    ha="center",
    arrowprops={"arrowstyle": "->", "color": "#555555"},
)
axes.set(
    xlabel="Thickness of the plate [mm]",
    ylabel="Restitution of a lossless contact [-]",
    xlim=(4.0, 60.0),
    ylim=(0.3, 1.0),
)
axes.set_title("Restitution of a rock on a steel plate")
axes.legend(loc="lower right")
plt.show()
