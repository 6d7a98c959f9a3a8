"""
A rock falls on a steel plate
=============================

The rock of the paper falls 4 m and bounces five times. Its force is a peak of a quarter of a millisecond at each impact; zoom in on one.
"""

import vibroimpact as vi

response = vi.simulate(vi.load_case("paper:type1-theory"))
assert response.impacts["max_force_N"].argmax() == 0
response

# %%
# The contact force over the whole run:

response.plot("force")
