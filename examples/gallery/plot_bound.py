"""
Bayes error of coal and gangue classification
=============================================

The lowest error of a classifier that sees only the impulse and the contact time of an impact can be
bounded before any training: rocks that agree in both cannot be distinguished by them. A sample of
simulated drops gives estimates of bounds on this error, for a scatter of the measured amplitude
that is assumed. A classifier of whole signals sees more, and can have a lower error.
"""

# %%
# Population
# ----------
# Coal and gangue of 15 to 60 mm in radius fall from 0.8 to 3 m; their densities, moduli and
# restitutions have the distributions of the shipped study. The estimates from 2,048 falls have a
# sampling error: with 20,000 falls the bounds are 0.4 to 1.0 % with the position known and 1.7 to
# 2.0 % without.
import matplotlib.pyplot as plt
import numpy as np

import vibroimpact as vi

bound = vi.bayes_error.bound_of(vi.studies.load_sweep("signals:coal-gangue", samples=2048))
for name, error in bound.errors.items():
    exact = bound.without_scatter[name]
    print(
        f"{name:30} {100.0 * error.lower:5.1f} to {100.0 * error.upper:5.1f} % misclassified, "
        f"with an exact amplitude at most {100.0 * exact.upper:5.1f} %"
    )
assert bound.errors["one impact"].upper < 0.02 < 0.2 < bound.errors["contact time"].lower

# %%
# The contact times are near those of Hertz's theory, :math:`T = 2.87\, (m^2 / (E^{*2} R v))^{1/5}`
# (Johnson 1985, eq. 11.24), increased by the damping.
falls = bound.falls
mass = 4.0 / 3.0 * np.pi * falls.radius**3 * falls.density
effective = 1.0 / ((1.0 - 0.28**2) / falls.modulus + (1.0 - 0.3**2) / 210e9)  # against steel
johnson = 2.87 * (mass**2 / (effective**2 * falls.radius * falls.speed)) ** 0.2
longer = falls.duration / johnson
assert np.all((longer > 1.0) & (longer < 1.25))

# %%
# Impulse, contact time and classification error
# ----------------------------------------------
plt.style.use("vibroimpact.charts.print")
figure, (left, right) = plt.subplots(
    1, 2, figsize=(7.6, 4.0), width_ratios=(5, 4), layout="constrained"
)
for name, colour in (("coal", "#1b1b1b"), ("gangue", "#c79000")):
    some = falls.classes == name
    left.plot(
        falls.impulse[some],
        1e6 * falls.duration[some],
        ".",
        color=colour,
        markersize=3.0,
        alpha=0.6,
        label=name,
    )
left.set(
    xscale="log",
    yscale="log",
    xlabel="Impulse [N s]",
    ylabel="Duration of the contact [µs]",
    title="Impulse and contact time of 2,048 falls",
)
left.legend(loc="upper left", markerscale=4)
names = ("impulse", "contact time", "one impact, place unknown", "one impact")
upper = 100.0 * np.array([bound.errors[name].upper for name in names])
bars = right.barh(
    [name.replace(", ", ",\n") for name in names],
    upper,
    color=["#b9c9d8", "#b9c9d8", "#0072b2", "#00204d"],
)
right.bar_label(bars, [f"{one:.1f} %" for one in upper], padding=3)
right.axvline(100.0 * bound.majority, color="#b3400e", linestyle="--", linewidth=0.9)
right.text(
    100.0 * bound.majority + 0.7,
    3.6,
    "majority\nclass",
    color="#b3400e",
    ha="left",
    va="top",
    fontsize=8,
)
right.set(xlabel="Bayes error, upper bound [%]", title="By measured quantities", xlim=(0.0, 56.0))
right.grid(visible=False, axis="y")
plt.show()
