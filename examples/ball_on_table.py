"""A ball on a shaken table: how it rides and is launched, and how one bounce a period becomes two.

Makes the picture of docs/shaken.md.
"""

import matplotlib

matplotlib.use("Agg")  # no window
import matplotlib.pyplot as plt
import numpy as np

import vibroimpact as vi
from vibroimpact.contact.laws.newton import Newton

gravity, frequency = 9.8, 25.0
omega = 2.0 * np.pi * frequency


def bounced(strength: float, restitution: float, phase: float = 0.0, **drop: float) -> vi.Response:
    """Return a run on a table whose greatest acceleration is so many times gravity."""
    motion = vi.PlateMotion(
        amplitude=strength * gravity / omega**2, frequency=frequency, phase=phase
    )
    ball, law = vi.Body(mass=0.1, contact_offset=0.01), Newton(restitution=restitution)
    return vi.simulate(
        vi.Problem(
            sphere=ball, plate=vi.rigid_plate(), laws=(law,), gravity=gravity, motion=motion, **drop
        )
    )


figure, (path, diagram) = plt.subplots(1, 2, figsize=(10.0, 4.2), layout="constrained")

response = bounced(1.8, 0.3, height=0.013, impacts=None, duration=0.2)
moments = np.linspace(0.0, 0.2, 4001)
motion = response.at(moments)
path.plot(
    1e3 * moments,
    1e3 * (motion["position_m"] - 0.01),
    color="#0072b2",
    label="lowest point of the ball",
)
path.plot(1e3 * moments, 1e3 * motion["surface_m"], "--", color="#b3400e", label="table")
path.set(
    xlabel="time [ms]",
    ylabel="height [mm]",
    title="e = 0.3, 1.8 g: impacts without end, a ride, a launch",
)
path.legend(frameon=False)

restitution = 0.5
exists = np.pi * (1.0 - restitution) / (1.0 + restitution)
doubles = np.hypot(exists, 2.0 * (1.0 + restitution**2) / (1.0 + restitution) ** 2)
for strength in np.linspace(1.005 * exists, 2.0, 48):
    start = {"speed": np.pi * gravity / omega, "phase": np.arccos(exists / strength) + 1e-3}
    times = bounced(strength, restitution, impacts=220, **start).impacts["time_s"]
    flights = np.diff(times[-41:]) * frequency
    diagram.plot(np.full(len(flights), strength), flights, ".", color="#0072b2", markersize=2.5)
for threshold, name in ((exists, "one bounce a period exists"), (doubles, "it doubles")):
    diagram.axvline(threshold, color="#6b6b6b", linestyle=":")
    diagram.text(threshold, 1.66, f"{name} ", rotation=90, va="top", ha="right", color="#6b6b6b")
    print(f"{name} from {threshold:.5f} g on")
diagram.set(
    xlabel="greatest acceleration of the table [g]",
    ylabel="flights [periods]",
    xlim=(0.95, 2.02),
    ylim=(0.4, 1.7),
    title="e = 0.5",
)
figure.savefig("ball-on-table.png", dpi=130)
