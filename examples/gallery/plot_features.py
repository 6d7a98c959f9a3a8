"""
Signal features of geophone packets
===================================

A synthetic record of a geophone below a plate contains the impacts of several grains. It is divided
into packets, as in bedload measurement, and some sixty features describe each packet: the peak
amplitude grows with the mass of the grain.
"""

# %%
# A record of several grains
# --------------------------
# Seven grains of quartz of different sizes strike a steel plate one after another; their signals
# are joined end to end, with noise.
import matplotlib.pyplot as plt
import numpy as np

import vibroimpact as vi

diameters = np.array([12.0, 30.0, 17.0, 24.0, 10.0, 38.0, 20.0])  # mm
rate, pause = 10e3, 0.06
quartz = {"density": 2650, "youngs_modulus": "72 GPa", "poissons_ratio": 0.17}


def struck(diameter):
    """Return the geophone signal of one grain [V]."""
    case = {
        "sphere": {"radius": f"{0.5 * diameter} mm", "material": quartz},
        "plate": {
            "size": ["492 mm", "358 mm", "15 mm"],
            "material": "steel",
            "model": "elastic",
            "supports": "simply-supported",
            "modes": 40,
            "damping": 0.03,
        },
        "drop": {"speed": "1 m/s", "gravity": 0, "position": ["40 mm", "-30 mm"]},
        "contact": {"law": "tsuji", "restitution": 0.6},
        "run": {"duration": pause},
        "sensors": [
            {
                "name": "geophone",
                "position": [0, 0],
                "face": "lower",
                "rate": rate,
                "geophone": {
                    "natural_frequency": "10 Hz",
                    "sensitivity": "27.6 V s/m",
                    "damping_ratio": 0.6,
                },
            }
        ],
    }
    return vi.simulate(vi.case_of(case)).signals()["geophone"].value[: int(pause * rate)]


random = np.random.default_rng(1)
value = np.concatenate([np.zeros(200), *(struck(one) for one in diameters)])
record = vi.signals.Record("geophone", value + 1e-4 * random.standard_normal(len(value)), rate, "V")

# %%
# Packets
# -------
# A packet begins where the envelope reaches a threshold, and ends where it falls below the
# threshold for longer than the dead time.
packets = vi.signals.find_packets(record, threshold=0.02, dead_time=5e-3)
assert len(packets.onset) == len(diameters)
assert np.abs(packets.onset / rate - (0.02 + pause * np.arange(len(diameters)))).max() < 3e-3

# %%
# Features of each
# ----------------
# The table has a row for each packet and a column for each feature. At a given speed the impulse of
# a grain is proportional to its mass, and so is the response of the plate as long as the contact is
# shorter than its periods.
table = vi.signals.record_table(vi.signals.packet_records(record, threshold=0.02))
peak = table["peak"]
power = np.polyfit(np.log(diameters), np.log(peak), 1)[0]
print(f"{len(table.names)} features; the peak grows with the power {power:.2f} of the diameter")
assert np.allclose(peak, packets.peak)
assert 2.8 < power < 3.05

# %%
# Packets and peak amplitudes
# ---------------------------
plt.style.use("vibroimpact.charts.print")
figure, (above, below) = plt.subplots(2, figsize=(6.6, 5.0), layout="constrained")
colours = plt.get_cmap("cividis")(np.interp(diameters, (10.0, 38.0), (0.0, 0.85)))
above.plot(record.time, record.value, color="#6b6b6b", linewidth=0.5)
for one, (first, last, colour) in enumerate(zip(packets.first, packets.last, colours, strict=True)):
    above.plot(
        record.time[first : last + 1], record.value[first : last + 1], color=colour, linewidth=0.9
    )
    above.axvspan(record.time[first], record.time[last], color=colour, alpha=0.15, linewidth=0)
    above.text(record.time[first], 1.15, f"{diameters[one]:.0f} mm", color=colour, fontsize=8)
above.set(
    xlabel="Time [s]",
    ylabel="Geophone [V]",
    title="Seven grains on the plate of a river bed",
    ylim=(-1.2, 1.35),
)
below.loglog(diameters, peak, linestyle="none")
below.scatter(diameters, peak, s=20.0 + 3.0 * packets.impulses**1.5, c=colours, zorder=3)
for one, (x, y) in enumerate(zip(diameters, peak, strict=True)):
    below.annotate(
        f"impulses: {packets.impulses[one]}",
        (x, y),
        (9, -8),
        textcoords="offset points",
        fontsize=8,
    )
line = np.array([9.0, 42.0])
below.loglog(
    line,
    peak[0] * (line / diameters[0]) ** 3,
    "--",
    color="#b3400e",
    linewidth=0.9,
    label="proportional to the mass",
)
below.set(xlabel="Diameter of the grain [mm]", ylabel="Peak of the packet [V]", xlim=(9.0, 48.0))
below.set_xticks([10, 15, 20, 30, 40], ["10", "15", "20", "30", "40"])
below.minorticks_off()
below.legend(loc="upper left")
plt.show()
