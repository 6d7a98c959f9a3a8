"""
Restitution coefficient against impact speed: elastic-plastic contact laws
==========================================================================

A ball that yields leaves a permanent dent and loses energy to plastic deformation. Elastic-plastic
contact laws are evaluated from below the yield speed to a thousand times this speed, and Thornton's
law is compared with its closed form; the area of the loop of force against indentation is the
energy lost.
"""

# %%
# Thornton's closed form
# ----------------------
# An elastic-perfectly-plastic sphere (J. Appl. Mech. 64:383, 1997) has the following restitutions
# at multiples of the speed at which it first yields.
import matplotlib.pyplot as plt
import numpy as np

import vibroimpact as vi

modulus, radius, mass, strength = 115e9, 5e-3, 4.1e-3, 1.0e9
thornton = vi.laws.Thornton(
    effective_modulus=modulus, effective_radius=radius, yield_pressure=1.6 * strength
)
meyer = vi.laws.Meyer(effective_modulus=modulus, effective_radius=radius, yield_strength=strength)
storakers = vi.laws.Storakers(
    effective_modulus=modulus, effective_radius=radius, yield_strength=strength
)
walton = vi.laws.WaltonBraun(stiffness=2e7, restitution=0.7)

yields = np.sqrt(0.8 * thornton.stiffness * thornton.yield_indentation**2.5 / mass)
for ratio, restitution in {
    2: 0.930626,
    5: 0.773337,
    10: 0.658558,
    50: 0.444606,
    100: 0.374299,
    1000: 0.210701,
}.items():
    assert abs(vi.laws.achieved_restitution(thornton, mass, ratio * yields) - restitution) < 1e-6

# %%
# Force-indentation hysteresis
# ----------------------------
# At 3 m/s the contact of each law is loaded, and unloaded along a steeper curve. The enclosed area
# is the energy lost.
loops = {}
for name, law in {
    "thornton": thornton,
    "meyer": meyer,
    "storakers": storakers,
    "walton-braun": walton,
}.items():
    problem = vi.Problem(
        sphere=vi.Body(mass=mass, contact_offset=radius),
        plate=vi.rigid_plate(),
        laws=(law,),
        speed=3.0,
        gravity=0.0,
        impacts=1,
    )
    response = vi.simulate(problem)
    time = np.linspace(0.0, response.impacts["duration_s"][0], 5000)
    history = response.at(time)
    loops[name] = history["indentation_m"], history["force_N"]
    work = np.trapezoid(loops[name][1], loops[name][0])
    lost = response.impacts["energy_lost_J"][0]
    assert abs(work / lost - 1.0) < 1e-3
    assert (
        abs(
            lost / response.energy["input_J"]
            - (1.0 - response.impacts["restitution_achieved"][0] ** 2)
        )
        < 1e-9
    )

# %%
# Hysteresis and restitution
# --------------------------
plt.style.use("vibroimpact.charts.print")
figure, (left, right) = plt.subplots(1, 2, figsize=(7.2, 3.8), layout="constrained")
speeds = np.geomspace(0.3 * yields, 1000.0 * yields, 80)
colours = {
    "thornton": "#00204d",
    "meyer": "#b3400e",
    "storakers": "#0072b2",
    "walton-braun": "#c79000",
}
for name, law in {
    "thornton": thornton,
    "meyer": meyer,
    "storakers": storakers,
    "walton-braun": walton,
}.items():
    indentation, force = loops[name]
    left.plot(1e6 * indentation, 1e-3 * force, color=colours[name], linewidth=1.8, label=name)
    left.fill(1e6 * indentation, 1e-3 * force, color=colours[name], alpha=0.07)
    right.semilogx(
        speeds, vi.laws.achieved_restitution(law, mass, speeds), color=colours[name], linewidth=1.8
    )
right.semilogx(
    speeds[20:], 1.18499 * (yields / speeds[20:]) ** 0.25, "--", color="#00204d", linewidth=0.9
)
right.text(
    speeds[-42],
    0.33,
    "tends to\n1.185 $(v_y/v)^{1/4}$",
    color="#00204d",
    ha="right",
    va="top",
    fontsize=8,
)
left.set(xlabel="Indentation [µm]", ylabel="Force [kN]", title="One impact at 3 m/s")
right.set(
    xlabel="Approach speed [m/s]",
    ylabel="Restitution [-]",
    title="Restitution against speed",
    ylim=(0.0, 1.03),
)
left.legend(loc="upper left")
plt.show()
