"""
A user-defined contact law
==========================

A contact law is a frozen dataclass with functions that return its force and its energies. The
example is a rubber lining of a chute, a spring whose force has a cubic term and a relaxation time;
events, energy balance and charts need no further code, and the largest indentation is compared with
its closed form.
"""

# %%
# The law
# -------
# The elastic and the dissipative part of the force are returned separately, so that the dissipated
# energy can be computed. The function works for numbers, with which it is compiled, and for arrays;
# it takes its coefficients from the law. If it is installed as a package with an entry point, the
# law can also be used by its name in cases and on the command line.
from dataclasses import dataclass
from functools import cached_property

import matplotlib.pyplot as plt
import numpy as np

import vibroimpact as vi
from vibroimpact.compiled import scalar
from vibroimpact.contact.law import CompliantLaw
from vibroimpact.contact.parameters import parameter


@scalar
def lining_forces(delta, delta_dot, approach_speed, coefficients):
    """Return the elastic and the dissipative force [N]."""
    stiffness, stiffening, relaxation = coefficients[0], coefficients[1], coefficients[2]
    rate = stiffness + 3.0 * stiffening * delta**2
    return (
        stiffness * delta + stiffening * delta**3,
        relaxation * rate * delta_dot,
    )


@scalar
def lining_energies(delta, coefficients):
    """Return the elastic energy and the plastic work [J]."""
    stiffness, stiffening = coefficients[0], coefficients[1]
    return 0.5 * stiffness * delta**2 + 0.25 * stiffening * delta**4, 0.0 * delta


@dataclass(frozen=True, kw_only=True)
class Lining(CompliantLaw):
    """A rubber lining that stiffens."""

    name = "lining"
    equation = "F = k d + q d^3 + tau (k + 3 q d^2) d_dot"
    source = "this page"
    contact_end = "zero-force"
    tension = "cut"
    scalar_forces = staticmethod(lining_forces)
    scalar_energies = staticmethod(lining_energies)

    stiffness: float = parameter("stiffness k at small indentations", "N/m", above=0)
    stiffening: float = parameter("coefficient q of the cube", "N/m^3", at_least=0)
    relaxation: float = parameter("relaxation time tau", "s", at_least=0)

    @cached_property
    def coefficients(self):
        return self.stiffness, self.stiffening, self.relaxation


# %%
# Impact of a rock on the lining
# ------------------------------
# The law is used in a problem like those of the library.
rock = vi.rigid_sphere(25e-3, vi.find_material("granite"))


def dropped(speed, relaxation):
    """Return the first impact of the rock at a speed [m/s]."""
    law = Lining(stiffness=2e5, stiffening=4e10, relaxation=relaxation)
    return vi.simulate(
        vi.Problem(
            sphere=rock, plate=vi.rigid_plate(), laws=(law,), speed=speed, gravity=0.0, impacts=1
        )
    )


# %%
# Without relaxation the largest indentation follows from the energy: :math:`\tfrac12 m v^2 =
# \tfrac12 k d^2 + \tfrac14 q d^4`.
mass, speed, k, q = float(rock.mass), 3.0, 2e5, 4e10
deepest = np.sqrt((-k + np.sqrt(k**2 + 2.0 * q * mass * speed**2)) / q)
elastic = dropped(speed, 0.0)
assert abs(elastic.impacts["max_indentation_m"][0] / deepest - 1.0) < 1e-9
assert abs(elastic.impacts["restitution_achieved"][0] - 1.0) < 1e-9

# %%
# The chart of force against indentation is available too.
dropped(speed, 1e-4).plot("force_indentation")

# %%
# Force against indentation at three speeds
# -----------------------------------------
plt.style.use("vibroimpact.charts.print")
figure, axes = plt.subplots(figsize=(6.4, 4.2), layout="constrained")
for one, colour in zip((1.0, 2.0, 3.0), ("#56a8d8", "#0072b2", "#00204d"), strict=True):
    response = dropped(one, 1e-4)
    history = response.at(np.linspace(0.0, response.impacts["duration_s"][0], 600))
    assert abs(response.energy["closure_relative"]) < 1e-9
    words = f"{one:g} m/s, restitution {response.impacts['restitution_achieved'][0]:.2f}"
    axes.fill(1e3 * history["indentation_m"], 1e-3 * history["force_N"], color=colour, alpha=0.12)
    axes.plot(
        1e3 * history["indentation_m"],
        1e-3 * history["force_N"],
        color=colour,
        linewidth=2.0,
        label=words,
    )
depth = np.linspace(0.0, 1.05 * deepest, 200)
axes.plot(
    1e3 * depth,
    1e-3 * (k * depth + q * depth**3),
    "--",
    color="#6b6b6b",
    linewidth=0.9,
    label="$k \\delta + q \\delta^3$",
)
axes.set(
    xlabel="Indentation [mm]",
    ylabel="Force [kN]",
    title="A rock on a rubber lining: a user-defined law",
)
axes.legend(loc="upper left")
# sphinx_gallery_thumbnail_number = -1
plt.show()
