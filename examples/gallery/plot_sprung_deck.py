"""
Impact of a rock on a vibrating screen deck
===========================================

A rock of 20 kg falls on the deck of a screen, 80 kg on springs, whose frame vibrates. The motions
of deck and rock are coupled; the motion of the rock agrees with SciPy's integration of both bodies
and their contact within a tenth of a micrometre over a second.
"""

# %%
# Deck and rock
# -------------
# A deck on springs is a plate with one mode of 12 Hz; its supports vibrate at 15 Hz. The contact is
# viscoelastic and so soft that the indentation is some millimetres.
import matplotlib.pyplot as plt
import numpy as np
from scipy.integrate import solve_ivp

import vibroimpact as vi

lump, deck, natural, damping = 20.0, 80.0, 12.0, 0.05
amplitude, frequency, gravity, fall = 1.6e-3, 15.0, 9.8, 0.006
law = vi.laws.KuwabaraKono(stiffness=1e7, dissipation_time=2e-3)
mode = vi.ModalBasis(
    np.array([natural]),
    np.array([damping]),
    np.array([deck**-0.5]),
    np.array([[0.0, 0.0, deck**0.5]]),
    mass=deck,
)
problem = vi.Problem(
    sphere=vi.Body(mass=lump, contact_offset=0.1),
    plate=vi.Body(mass=np.inf, contact_offset=0.0, modes=mode),
    laws=(law,),
    height=0.1 + fall,
    gravity=gravity,
    duration=1.0,
    impacts=None,
    motion=vi.PlateMotion(amplitude=amplitude, frequency=frequency),
)
response = vi.simulate(problem)

# %%
# Comparison with SciPy
# ---------------------
# Two bodies and the force between them, starting from the steady-state motion of the deck.
driven, own = 2.0 * np.pi * frequency, 2.0 * np.pi * natural


def motion(time, state):
    """Return the velocities and accelerations of rock and deck."""
    depth, rate = state[2] - state[0], state[3] - state[1]
    force = (
        max(0.0, 1e7 * (depth**1.5 + 1.5 * 2e-3 * np.sqrt(depth) * rate)) if depth > 0.0 else 0.0
    )
    frame = amplitude * np.array([np.sin(driven * time), driven * np.cos(driven * time)])
    spring = -(own**2) * (state[2] - frame[0]) - 2.0 * damping * own * (state[3] - frame[1])
    return [state[1], force / lump - gravity, state[3], spring - force / deck]


transfer = (own**2 + 2j * damping * own * driven) / (
    own**2 - driven**2 + 2j * damping * own * driven
)
steady = (
    amplitude * transfer
)  # times exp(i driven t), of which the imaginary part is the place of the deck
start = [fall, 0.0, steady.imag, (1j * driven * steady).imag]
time = np.linspace(0.0, 1.0, 1001)
by_scipy = solve_ivp(
    motion, (0.0, 1.0), start, "DOP853", time, rtol=1e-9, atol=1e-11, max_step=5e-4
).y
history = response.at(time)
away = np.abs(history["position_m"] - 0.1 - by_scipy[0]).max()
print(f"at most {1e9 * away:.1f} nm apart; {response.status}")
assert away < 1e-7
assert abs(response.energy["closure_relative"]) < 1e-9

# %%
# Motion of deck and rock
# -----------------------
plt.style.use("vibroimpact.charts.print")
figure, axes = plt.subplots(figsize=(6.6, 4.0), layout="constrained")
fine = np.linspace(0.0, 1.0, 4000)
path = response.at(fine)
axes.fill_between(fine, -12.0, 1e3 * path["plate_displacement_m"], color="#cfd6dd", label="deck")
axes.plot(fine, 1e3 * path["plate_displacement_m"], color="#5a5a5a", linewidth=1.2)
axes.plot(
    fine,
    1e3 * (path["position_m"] - 0.1),
    color="#b3400e",
    linewidth=1.8,
    label="lowest point of the rock",
)
axes.plot(
    time[::12],
    1e3 * by_scipy[0, ::12],
    "o",
    color="#00204d",
    markersize=3.5,
    markerfacecolor="none",
    label="integrated by SciPy",
)
axes.set(
    xlabel="Time [s]",
    ylabel="Height [mm]",
    title="A rock of 20 kg on a vibrating deck",
    xlim=(0.0, 1.0),
    ylim=(-12.0, 19.0),
)
axes.legend(loc="upper right", ncols=3)
plt.show()
