"""
Phase portraits of all contact laws
===================================

The impact of a grain is computed with all contact laws of the library at the same speed. In the
plane of indentation and velocity an elastic impact is symmetric, a damped one has a lower rebound
velocity, a plastic one leaves a dent, and an adhesive one has a tensile phase before separation.
"""

# %%
# One impact under each law
# -------------------------
# A grain of 20 µm in diameter hits a plate of the same polymer at 0.3 m/s: with the chosen
# strengths and work of adhesion, small enough for adhesion and fast enough to yield. What follows
# from the bodies, such as Hertz's stiffness and the effective mass, is supplied by the case.
import matplotlib.pyplot as plt
import numpy as np

import vibroimpact as vi

polymer = {"density": 1050, "youngs_modulus": "3.2 GPa", "poissons_ratio": 0.34}
damped = {"restitution": 0.5}
properties = {
    "hertz": {},
    "adams-poisson": {**damped, "penalty": "300 N/m"},
    "anagnostopoulos": {**damped, "stiffness": "300 N/m"},
    "linear-spring-dashpot": {**damped, "stiffness": "300 N/m"},
    "walton-braun": {**damped, "stiffness": "300 N/m"},
    "adams-impact": {"damping_max": 1.2e-5, "full_damping_penetration": "1 nm"},
    "kuwabara-kono": {"dissipation_time": 1.5e-8},
    "jkr": {"work_of_adhesion": 0.2},
    "krijt": {"work_of_adhesion": 0.2, "dissipation_time": 2e-9},
    "meyer": {"yield_strength": "6 MPa"},
    "storakers": {"yield_strength": "6 MPa"},
    "thornton": {"yield_pressure": "10 MPa"},
    "jackson-green-marghitu": {"yield_strength": "6 MPa"},
}
speed, paths, bounced = 0.3, {}, {}
for name in vi.laws.contact_laws():
    case = {
        "sphere": {"radius": "10 um", "material": polymer},
        "plate": {"material": polymer},
        "drop": {"speed": speed, "gravity": 0},
        "contact": {"law": name, **properties.get(name, damped)},
        "run": {"impacts": 1},
    }
    response = vi.simulate(vi.case_of(case))
    bounced[name] = response.impacts["restitution_achieved"][0]
    time = np.linspace(0.0, response.impacts["duration_s"][0], 400)
    history = response.at(time)
    paths[name] = (
        np.array([0.0, *history["indentation_m"]]),
        np.array([-speed, *history["velocity_m_s"]]),
    )
    assert abs(response.energy["closure_relative"]) < 1e-9

# %%
# Hunt and Crossley's restitution follows from :math:`D (1 + e) = \ln[(1 + D)/(1 - e D)]` with a
# damping factor D = 0.75; Tsuji's is the specified one.
e = bounced["hunt-crossley"]
assert abs(0.75 * (1 + e) - np.log(1.75 / (1 - 0.75 * e))) < 1e-6
assert abs(bounced["tsuji"] - 0.5) < 1e-6

# %%
# Comparison
# ----------
# Velocity against indentation for each law, with Hertz's elastic impact as a grey area: approach at
# the bottom, rebound at the top. Laws without a force (``newton``, ``jackson-green-marghitu``) are
# vertical lines.
plt.style.use("vibroimpact.charts.print")
figure, panels = plt.subplots(
    5, 5, figsize=(7.0, 7.0), sharex=True, sharey=True, layout="constrained"
)
kinds = {
    "#b3400e": ("meyer", "storakers", "thornton", "walton-braun", "jackson-green-marghitu"),
    "#5f8f3e": ("jkr", "krijt"),
}
kinds |= {"#6b6b6b": ("hertz", "newton")}
deepest = paths["hertz"][0].max()
for axes, (name, (indentation, velocity)) in zip(panels.flat, paths.items(), strict=True):
    colour = next((colour for colour, names in kinds.items() if name in names), "#0072b2")
    axes.fill(paths["hertz"][0] / deepest, paths["hertz"][1] / speed, color="#eeeeee")
    axes.plot(indentation / deepest, velocity / speed, color=colour, linewidth=1.8)
    axes.set_title(name, fontsize=7.5, color=colour, pad=2)
    axes.grid(visible=False)
figure.suptitle(
    f"Phase portraits of {len(paths)} contact laws", x=0.02, ha="left", fontweight="bold"
)
figure.supxlabel("Indentation over that of Hertz [-]")
figure.supylabel("Velocity over the approach speed [-]")
plt.show()
