"""
Identification of an impact from accelerometer signals
======================================================

From the signals of three accelerometers and a model of the plate, the position and the force of an
impact and the radius and the speed of the sphere are estimated, with 95 % intervals.
"""

# %%
# Synthetic records
# -----------------
# The records are simulated, with noise 40 dB below the vibration after the impact; the case used
# for the identification does not contain the true radius, speed and position.
import matplotlib.pyplot as plt
import numpy as np

import vibroimpact as vi

rate, places = 25.6e3, {"a": (0.17, 0.05), "b": (-0.13, 0.11), "c": (-0.03, -0.14)}
case = {
    "name": "coal on a plate",
    "sphere": {
        "radius": "20 mm",
        "material": {"density": 1380, "youngs_modulus": "2.26 GPa", "poissons_ratio": 0.28},
    },
    "plate": {
        "size": ["500 mm", "400 mm", "10 mm"],
        "material": "steel",
        "model": "elastic",
        "modes": 120,
        "damping": 0.01,
        "supports": "simply-supported",
    },
    "drop": {"speed": "3 m/s"},
    "contact": {"law": "tsuji", "restitution": 0.6},
    "sensors": [
        {"name": name, "position": list(place), "rate": rate} for name, place in places.items()
    ],
}
truth = {"radius": 0.0235, "speed": 2.4, "x": 0.06, "y": 0.04}
fallen = {
    **case,
    "sphere": {**case["sphere"], "radius": truth["radius"]},
    "drop": {
        "height": truth["radius"] + truth["speed"] ** 2 / (2 * 9.80665),
        "position": [truth["x"], truth["y"]],
    },
    "run": {"impacts": 1, "duration": truth["speed"] / 9.80665 + 8e-3},
}
response = vi.simulate(vi.case_of(fallen))
random, records = np.random.default_rng(2), []
for name, signal in response.signals().items():
    noise = (
        0.01
        * np.sqrt(np.mean(signal.value[-150:] ** 2))
        * random.standard_normal(len(signal.value))
    )
    records.append(vi.signals.Record(name, signal.value + noise, rate, "m/s2"))

# %%
# Estimates
# ---------
found = vi.identification.identify(vi.case_of(case), records)
for name, key in (
    ("radius_m", "radius"),
    ("speed_m_s", "speed"),
    ("place_x_m", "x"),
    ("place_y_m", "y"),
):
    one = found.estimates[name]
    low, high = one.interval
    print(f"{name:10} {one.value:.5f}, {low:.5f} to {high:.5f}; true {truth[key]:g}")
    # twice the interval, since its coverage is 95 % only
    assert abs(one.value - truth[key]) < high - low
assert abs(found.estimates["max_force_N"].value / response.impacts["max_force_N"][0] - 1.0) < 0.01

# %%
# The records and the fit, as in the report.
charts = found.charts
vi.charts.plotly_figure(charts["records"])

# %%
# Position and force
# ------------------
# The fraction of the records explained by the best pulse at each position; and the force, estimated
# without a contact law.
plt.style.use("vibroimpact.charts.print")
figure, (left, right) = plt.subplots(
    1, 2, figsize=(7.4, 3.6), width_ratios=(5, 4), layout="constrained"
)
explained = 1.0 - found.search.misfit
picture = left.pcolormesh(
    1e3 * found.search.x,
    1e3 * found.search.y,
    explained,
    cmap="cividis",
    shading="gouraud",
    vmin=0.0,
    rasterized=True,
)
left.plot(
    *(1e3 * np.array(list(places.values())).T),
    "^",
    color="#ffffff",
    markeredgecolor="#1b1b1b",
    markersize=8,
    label="accelerometers",
)
left.plot(
    1e3 * truth["x"],
    1e3 * truth["y"],
    "o",
    color="#b3400e",
    markersize=13,
    markerfacecolor="none",
    markeredgewidth=2.0,
    label="true position",
)
left.plot(
    *(1e3 * found.estimates[name].value for name in ("place_x_m", "place_y_m")),
    "+",
    color="#b3400e",
    markersize=9,
    label="estimated",
)
left.set(xlabel="x [mm]", ylabel="y [mm]", aspect="equal", title="Position of the impact")
left.grid(visible=False)
left.legend(loc="upper center", bbox_to_anchor=(0.5, -0.18), ncols=3)
figure.colorbar(picture, ax=left, label="Fraction explained [-]", shrink=0.7)
since = found.force.time - found.sphere.parameters[4]
force, spread = found.force.found.force, 1.96 * found.force.found.deviation
right.fill_between(
    1e6 * since,
    1e-3 * (force - spread),
    1e-3 * (force + spread),
    color="#56a8d8",
    alpha=0.4,
    label="95 % interval",
)
right.plot(
    1e6 * since, 1e-3 * force, color="#0072b2", linewidth=1.6, label="from the records alone"
)
real = np.linspace(0.0, response.impacts["duration_s"][0], 300)
right.plot(
    1e6 * real,
    1e-3 * response.at(response.impacts["time_s"][0] + real)["force_N"],
    "--",
    color="#b3400e",
    label="true",
)
right.set(
    xlabel="Time since first touch [µs]",
    ylabel="Contact force [kN]",
    title="Contact force",
    xlim=(-200, 700),
    ylim=(-0.3, 2.2),
)
right.legend(loc="upper right")
# sphinx_gallery_thumbnail_number = -1
plt.show()
