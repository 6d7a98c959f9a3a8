"""
Export of a contact model to Adams, LAMMPS, YADE, MuJoCo and EXUDYN
===================================================================

A contact is exported to five programs. The file for Adams is read back and
integrated by SciPy in its own units; the rebounds agree with those of the run.
"""

# %%
# Export
# ------
import re
from pathlib import Path
from tempfile import TemporaryDirectory

import matplotlib.pyplot as plt
import numpy as np
from scipy.integrate import solve_ivp

import vibroimpact as vi

case = {
    "name": "glass on steel",
    "sphere": {"radius": "10 mm", "material": "glass"},
    "plate": {"material": "steel"},
    "drop": {"height": "0.5 m"},
    "contact": {"law": "adams-impact", "damping_max": 40, "full_damping_penetration": "0.01 mm"},
    "run": {"impacts": 4},
}
response = vi.simulate(vi.case_of(case))
texts = {}
with TemporaryDirectory() as folder:
    result = Path(folder, "drop")
    response.save(result)
    for program in ("adams", "lammps", "yade", "mujoco", "exudyn"):
        for file in vi.exporting.export_result(result, program):
            texts[file.name] = file.read_text()
print({name: f"{len(text.splitlines())} lines" for name, text in texts.items()})

# %%
# The file for Adams
# ------------------
# The unit of length is the millimetre: the stiffness is that in N/m\ :sup:`1.5` divided by 1000\
# :sup:`1.5`.
dataset = next(text for name, text in texts.items() if name.endswith(".adm"))
words = re.search(r"IMPACT\(DZ\([^)]*\), VZ\([^)]*\), ([^)]*)\)", dataset.replace("\n,", ""))
print(words[0])
radius, stiffness, exponent, damping, full = (float(word) for word in words[1].split(","))
mass = float(re.search(r"MASS = ([\d.]+)", dataset)[1])
gravity = -float(re.search(r"KGRAV = (\S+)", dataset)[1])

# %%
# Integration of the exported model
# ---------------------------------
# The equation in the file is integrated by SciPy from each first touch to release; the flights in
# between have a closed form.


def motion(_, state):
    """Return velocity and acceleration [mm/s, mm/s^2] in contact, by the file alone."""
    depth = max(radius - state[0], 0.0)
    part = min(depth / full, 1.0)
    force = max(
        0.0, stiffness * depth**exponent - damping * part**2 * (3.0 - 2.0 * part) * state[1]
    )
    return [state[1], 1e3 * force / mass - gravity]


def release(_, state):
    """Return the gap [mm]."""
    return state[0] - radius


release.terminal, release.direction = True, 1
height, contacts = 500.0, []
for _ in range(4):
    speed = np.sqrt(2.0 * gravity * (height - radius))
    contacts.append(
        solve_ivp(
            motion,
            (0.0, 1e-3),
            [radius, -speed],
            "DOP853",
            rtol=1e-10,
            atol=1e-10,
            events=release,
            dense_output=True,
        )
    )
    height = radius + contacts[-1].y[1, -1] ** 2 / (2.0 * gravity)
    print(f"rises to {height:.3f} mm")
    assert abs(1e-3 * height / response.impacts["rebound_height_m"][len(contacts) - 1] - 1.0) < 1e-6

# %%
# Comparison of the contacts
# --------------------------
plt.style.use("vibroimpact.charts.print")
figure, axes = plt.subplots(figsize=(6.4, 4.0), layout="constrained")
for number, (touch, contact) in enumerate(zip(response.impacts["time_s"], contacts, strict=True)):
    since = np.linspace(0.0, contact.t[-1], 200)
    labels = ("vibroimpact", "the file for Adams, integrated by SciPy") if number == 0 else ("", "")
    depth = 1e6 * response.at(touch + since)["indentation_m"]
    axes.plot(
        1e6 * since,
        depth,
        color="#56a8d8",
        linewidth=7.0,
        alpha=0.5,
        label=labels[0],
        solid_capstyle="round",
    )
    axes.plot(
        1e6 * since,
        1e3 * (radius - contact.sol(since)[0]),
        color="#b3400e",
        linewidth=1.3,
        label=labels[1],
    )
axes.set(
    xlabel="Time since first touch [µs]",
    ylabel="Indentation [µm]",
    title="Four contacts for Adams, read back from the file",
    xlim=(0.0, None),
)
axes.set_ylim(0.0, 1.25 * 1e6 * response.impacts["max_indentation_m"].max())
axes.legend(loc="upper right")
plt.show()
