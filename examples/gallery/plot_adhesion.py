"""
Sticking velocity of fine particles: JKR adhesion
=================================================

Below a critical speed a small particle does not rebound but sticks, because of its surface energy.
The restitution of grains of different sizes on a wall is computed with the law of Johnson, Kendall
and Roberts, with and without Krijt's viscoelastic loss; the sticking velocity increases as the size
decreases.
"""

# %%
# Force and pull-off
# ------------------
# Adhesion attracts the surfaces at first touch, and a neck holds them together until it breaks at a
# negative indentation. The pull-off force is :math:`\tfrac32 \pi w R`, independent of the
# stiffness.
import matplotlib.pyplot as plt
import numpy as np

import vibroimpact as vi

modulus, surface_energy, density = 1.7e9, 0.1, 1050.0  # Pa, J/m^2, kg/m^3: chosen values


def laws_of(radius):
    """Return the mass of a grain [kg] and its law without and with a viscoelastic loss."""
    mass = 4.0 / 3.0 * np.pi * radius**3 * density
    pair = {
        "effective_modulus": modulus,
        "effective_radius": radius,
        "work_of_adhesion": surface_energy,
    }
    return (
        mass,
        vi.laws.JKR(**pair),
        vi.laws.Krijt(**pair, dissipation_time=radius / 4e3),
    )


radius, speed = 1e-6, 0.8
mass, jkr, _ = laws_of(radius)
grain = vi.Body(mass=mass, contact_offset=radius)
response = vi.simulate(
    vi.Problem(
        sphere=grain, plate=vi.rigid_plate(), laws=(jkr,), speed=speed, gravity=0.0, impacts=1
    )
)
time = np.linspace(0.0, (1.0 - 1e-9) * response.impacts["duration_s"][0], 2000)
history = response.at(time)
pull_off = 1.5 * np.pi * surface_energy * radius
assert abs(history["force_N"].min() / -pull_off - 1.0) < 1e-3

# %%
# Sticking velocity
# -----------------
# Without other losses, the energy that a grain loses to adhesion is :math:`7.09\, (w^5 R^4 /
# E^{*2})^{1/3}` (Thornton and Ning 1998), which gives the sticking velocity.
radii = np.array([0.3e-6, 1e-6, 3e-6, 10e-6])
sticks = np.sqrt(
    2.0
    * 7.09
    * (surface_energy**5 * radii**4 / modulus**2) ** (1.0 / 3.0)
    / (4.0 / 3.0 * np.pi * radii**3 * density)
)
for one, limit in zip(radii, sticks, strict=True):
    mass, jkr, _ = laws_of(one)
    restitution = vi.laws.achieved_restitution(jkr, mass, np.array([0.98, 1.02, 3.0]) * limit)
    assert restitution[0] == 0.0 < restitution[1]
    assert abs(restitution[2] - np.sqrt(1.0 - 1.0 / 9.0)) < 2e-3

# %%
# Force-indentation curve and restitution against speed
# -----------------------------------------------------
plt.style.use("vibroimpact.charts.print")
figure, (left, right) = plt.subplots(1, 2, figsize=(7.2, 3.8), layout="constrained")
left.axhline(0.0, color="#6b6b6b", linewidth=0.7)
left.axhline(-1.0, color="#b3400e", linestyle="--", linewidth=0.9)
left.fill_between(
    1e9 * history["indentation_m"], history["force_N"] / pull_off, color="#0072b2", alpha=0.08
)
left.plot(
    1e9 * history["indentation_m"], history["force_N"] / pull_off, color="#00204d", linewidth=1.8
)
left.text(
    0.98,
    -0.95,
    r"pull-off, $\frac{3}{2} \pi w R$",
    color="#b3400e",
    transform=left.get_yaxis_transform(),
    ha="right",
    va="bottom",
    fontsize=8,
)
left.set(
    xlabel="Indentation [nm]",
    ylabel="Force over the pull-off force [-]",
    title="A grain of 2 µm in diameter at 0.8 m/s",
)
speeds = np.geomspace(0.01, 20.0, 120)
for one, colour in zip(
    radii, plt.get_cmap("cividis")(np.linspace(0.0, 0.85, len(radii))), strict=True
):
    mass, jkr, krijt = laws_of(one)
    right.semilogx(
        speeds,
        vi.laws.achieved_restitution(jkr, mass, speeds),
        color=colour,
        linewidth=1.8,
        label=f"{2e6 * one:g} µm",
    )
    right.semilogx(
        speeds, vi.laws.achieved_restitution(krijt, mass, speeds), ":", color=colour, linewidth=1.4
    )
right.set(
    xlabel="Approach speed [m/s]",
    ylabel="Restitution [-]",
    title="Dotted: with viscoelastic loss",
    ylim=(-0.02, 1.02),
)
right.xaxis.set_major_formatter("{x:g}")
right.legend(title="diameter", loc="upper left")
plt.show()
