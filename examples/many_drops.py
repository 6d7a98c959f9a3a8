"""A thousand drops at once: arrays go in where numbers go in, and the table gets one row a drop."""

import numpy as np

import vibroimpact as vi
from vibroimpact.contact.laws.lankarani_nikravesh import LankaraniNikravesh
from vibroimpact.contact.pair import effective_modulus, hertz_stiffness

rock, steel = vi.find_material("rock-paper"), vi.find_material("steel-paper")
random = np.random.default_rng(0)
radius = random.uniform(0.005, 0.05, 1000)
law = LankaraniNikravesh(stiffness=hertz_stiffness(effective_modulus(rock, steel), radius), restitution=random.uniform(0.3, 0.95, 1000))

response = vi.simulate(vi.Problem(sphere=vi.rigid_sphere(radius, rock), plate=vi.rigid_plate(), laws=(law,), height=2.0, impacts=1))
force = response.impacts["max_force_N"][:, 0]

print(response.status)
print(
    "largest force against radius squared [N/mm2]:",
    (force / (1e3 * radius) ** 2).min().round(2),
    "to",
    (force / (1e3 * radius) ** 2).max().round(2),
)
