"""
Damping of Adams' IMPACT function from rebound heights
======================================================

The damping of Adams' IMPACT function cannot be measured directly, but rebound heights can, with a
ruler and a camera. From four of them follow the damping at the four approach speeds, its intervals,
and the values in the units of the dialog: newtons, millimetres and seconds.
"""

# %%
# The measurement
# ---------------
# A rock of 25 mm radius is dropped from 4 m. Its first four rebounds are those of the paper's
# theory, taken as if measured to 2 mm.
import matplotlib.pyplot as plt
import numpy as np

import vibroimpact as vi

case = {
    "sphere": {"radius": "25 mm", "material": "rock-paper"},
    "plate": {"material": "steel-paper"},
    "drop": {"height": "4 m", "gravity": 9.8},
    "contact": {"law": "adams-impact"},
    "calibrate": {
        "target": {
            "rebound_heights": ["2.411 m", "1.457 m", "885 mm", "541 mm"],
            "standard_deviation": "2 mm",
        },
        "degree": 1,
    },
}
question = vi.calibration.calibration_of(case)
found = vi.calibration.calibrate_case(question)

# %%
# Values for the dialog
# ---------------------
# The conversion of a stiffness from N/m\ :sup:`1.5` to N/mm\ :sup:`1.5` is not a factor of 1000:
# the unit of length is raised to the exponent.
law = found.problem.laws[0]
stiffness = vi.units.convert_units(float(law.stiffness), "N/m^1.5", "N/mm^1.5")
print(f"Stiffness          {stiffness:.0f} N/mm^{law.exponent}")
print(f"Force exponent     {law.exponent}")
print(f"Penetration depth  {1e3 * law.full_damping_penetration:g} mm")
for speed, damping in zip(found.observations.speeds, found.values, strict=True):
    print(f"Damping            {1e-3 * damping:.4f} N s/mm for an impact at {speed:.2f} m/s")

# %%
# The doubts are those of a run: the rebound can be matched beyond the limits of the theory, but
# force and indentation are then doubtful.
print(*found.doubts, sep="\n")

# %%
# The paper prints 179.75, 172.8, 166.3 and 160.9 N s/m, for the rebounds of its own theory: the
# intervals contain these values.
printed = np.array([179.75, 172.8, 166.3, 160.9])
assert np.all((found.intervals[:, 0] < printed) & (printed < found.intervals[:, 1]))

# %%
# Check and chart
# ---------------
# The calibrated case runs as any other, and reproduces the rebound heights within 2 mm.
response = vi.simulate(found.calibrated_case)
assert np.allclose(
    response.impacts["rebound_height_m"][:4], [2.411, 1.457, 0.885, 0.541], atol=2e-3
)

plt.style.use("vibroimpact.charts.print")
figure, axes = plt.subplots(figsize=(6.4, 4.0), layout="constrained")
speeds = np.linspace(found.observations.speeds.min(), found.observations.speeds.max(), 100)
line, band = found.fit.function(speeds), found.fit.band(speeds, found.confidence)
axes.fill_between(
    speeds,
    1e-3 * (line - band),
    1e-3 * (line + band),
    color="#0072b2",
    alpha=0.15,
    label="95 % band of the fit",
)
axes.plot(
    speeds,
    1e-3 * line,
    color="#0072b2",
    linewidth=1.8,
    label="linear fit over the speed: one input for all impacts",
)
axes.errorbar(
    found.observations.speeds,
    1e-3 * found.values,
    1e-3 * np.abs(found.intervals.T - found.values),
    fmt="o",
    color="#00204d",
    markersize=7,
    capsize=4,
    label="from the measured rebounds, 95 % intervals",
)
axes.plot(
    found.observations.speeds,
    1e-3 * printed,
    "_",
    color="#b3400e",
    markersize=22,
    markeredgewidth=1.8,
    label="printed in the paper",
)
axes.set(
    xlabel="Approach speed [m/s]",
    ylabel="Damping of IMPACT [N s/mm]",
    title="Damping of Adams' IMPACT function against approach speed",
)
axes.legend(loc="upper left")
plt.show()
