"""
Restitution from the sound of bounces
=====================================

The times between the bounces of a ball give its speeds, and their ratios the restitution, whatever
the sensitivity of the microphone. Bounces are detected in a sound record with noise, mains hum and
clicks, and the restitution is estimated with its intervals.
"""

# %%
# A synthetic record
# ------------------
# Nine impacts of a ball with a restitution of 0.85, each a short decaying vibration, in noise of
# the same mean power, with hum and three clicks. A file is read by
# ``vi.signals.one_record("bounces.wav")``.
import matplotlib.pyplot as plt
import numpy as np

import vibroimpact as vi

restitution, rate, gravity = 0.85, 48e3, 9.81
random = np.random.default_rng(3)
flights = 0.5 * restitution ** np.arange(8)
touches = 0.2 + np.append(0.0, np.cumsum(flights))
time = np.arange(int((touches[-1] + 0.3) * rate)) / rate
sound = np.zeros_like(time)
for number, touch in enumerate(touches):
    since = (time - touch).clip(0.0)
    ring = np.exp(-since / 3e-3) * np.sin(2.0 * np.pi * 2300.0 * since) + 0.6 * np.exp(
        -since / 1.5e-3
    ) * np.sin(2.0 * np.pi * 5100.0 * since)
    sound += restitution**number * (1.0 - np.exp(-since / 1.5e-4)) ** 2 * ring
sound += np.sqrt(np.mean(sound**2)) * random.standard_normal(len(time)) + 0.05 * np.sin(
    2.0 * np.pi * 50.0 * time
)
sound[random.integers(0, len(time), 3)] += 1.0
record = vi.signals.Record("telephone", sound, rate, "Pa")

# %%
# Detection and restitution
# -------------------------
bounces = vi.signals.find_bounces(record)
rebounds = vi.calibration.rebounds_of(bounces, gravity=gravity)
print(
    f"dropped from about {100.0 * rebounds.drop_height:.1f} cm, restitution "
    f"{rebounds.laws[0].coefficients[0]:.5f}"
)

assert np.allclose(bounces.time - bounces.time[0], touches - touches[0], atol=2e-5)
known = np.isfinite(rebounds.restitution)
assert known.sum() == 7  # of all but the first and the last touch
assert np.abs(rebounds.restitution[known] - restitution).max() < 3e-4
assert len(bounces.others) == 3  # the clicks

# %%
# Restitution against speed, with intervals, and three fits: the chart of the report.
record_chart, restitution_chart = rebounds.report.charts
vi.charts.plotly_figure(restitution_chart)

# %%
# Record and estimates
# --------------------
plt.style.use("vibroimpact.charts.print")
figure, (above, below) = plt.subplots(
    2, figsize=(6.6, 4.6), height_ratios=(3, 2), sharex=True, layout="constrained"
)
above.plot(time, sound, color="#0072b2", linewidth=0.4)
above.plot(
    bounces.time,
    np.abs(bounces.peak),
    "v",
    color="#b3400e",
    markersize=7,
    label="detected bounces",
)
above.plot(
    bounces.others,
    np.full(len(bounces.others), 1.2),
    "x",
    color="#6b6b6b",
    markersize=7,
    label="rejected clicks",
)
above.set(
    ylim=(-1.6, 1.5),
    ylabel="Sound pressure [Pa]",
    title="Restitution from the sound of nine bounces",
)
above.legend(loc="lower right")
below.axhline(restitution, color="#b3400e", linewidth=0.9, linestyle="--")
below.errorbar(
    bounces.time[known],
    rebounds.restitution[known],
    1.96 * rebounds.deviation[known],
    fmt="o",
    color="#00204d",
    capsize=4,
)
below.text(
    bounces.time[-1], restitution, "true", color="#b3400e", va="bottom", ha="right", fontsize=8
)
below.set(xlabel="Time [s]", ylabel="Restitution [-]")
below.yaxis.set_major_formatter("{x:.5f}")
# sphinx_gallery_thumbnail_number = -1
plt.show()
