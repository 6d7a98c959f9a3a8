"""
Leakage in cross-validation of impact classifiers
=================================================

Classifiers are trained on signals of coal and gangue for which the Bayes error of one impact of an
unseen rock is known in closed form. Tested on rocks that are not in the training data they stay
below the accuracy that it allows; with signals split at random they appear to exceed it, as the
signals of one rock are then in both parts.
"""

# %%
# Signals with a known Bayes error
# --------------------------------
# Half-sine forces act on a plate of four modes. The classes differ by the contact time alone, whose
# logarithm is normal; each rock adds a characteristic tone, which identifies the rock but carries
# no information on its class. The intervals are wide, as there are only two hundred and forty
# signals of thirty rocks.
import matplotlib.pyplot as plt
import numpy as np
from scipy.signal import fftconvolve
from scipy.stats import norm

import vibroimpact as vi

rocks, falls, samples, rate, spread = 30, 8, 256, 20e3, 0.25
medians = np.array([260e-6, 180e-6])  # of coal and gangue
bayes_error = float(norm.cdf(-0.5 * np.log(medians[0] / medians[1]) / spread))

random = np.random.default_rng(0)
rock = np.repeat(np.arange(rocks), falls)
classes, count = rock % 2, rocks * falls
duration = medians[classes] * np.exp(spread * random.standard_normal(count))
fine = (np.arange(8 * samples) + 0.5) / (8 * rate)
pulse = np.where(fine < duration[:, None], np.sin(np.pi * fine / duration[:, None]), 0.0)
signal = np.zeros((count, samples))
for frequency, damping in ((310.0, 0.03), (840.0, 0.02), (2300.0, 0.02), (5200.0, 0.02)):
    mode = np.exp(-damping * 2.0 * np.pi * frequency * fine) * np.sin(
        2.0 * np.pi * frequency * fine
    )
    signal += (
        fftconvolve(pulse, mode[None], axes=1)[:, : 8 * samples]
        .reshape(count, samples, 8)
        .mean(axis=2)
    )
signal /= np.abs(signal).max(axis=1).mean()
tone, start = random.uniform(1e3, 8e3, rocks)[rock], random.uniform(0.0, 0.6, rocks)[rock]
time = np.arange(samples) / rate
signal += (
    0.3
    * np.exp(-(((time - start[:, None] * time[-1]) / 2e-3) ** 2))
    * np.sin(2.0 * np.pi * tone[:, None] * time)
)
signal += 1e-3 * random.standard_normal(signal.shape)

knocks = vi.recognition.LabelledSignals(
    "knocks",
    {"a1": vi.recognition.SensorSignals(signal.astype(np.float32), rate, "V")},
    classes,
    ("coal", "gangue"),
    groups={"rock": rock},
    truth={"first_duration_s": duration},
    bayes_error=bayes_error,
)

# %%
# Grouped and random splits
# -------------------------
found = vi.recognition.recognise(knocks, folds=3, seeds=1, workers=1)
classifiers = (
    "logistic regression",
    "random forest",
    "gradient boosting",
    "support vector machine",
)
best = 1.0 - bayes_error
for name in classifiers:
    apart, mixed = (scores[name].balanced_accuracy for scores in (found.scores, found.random))
    print(
        f"{name}: grouped {apart.value:.3f}, random {mixed.value:.3f}, highest possible {best:.3f}"
    )
    assert apart.low < best < mixed.value

# %%
# Charts of the result show the confusion matrix, the effect of noise, the calibration and the
# importance of features; this one shows the errors of all classifiers.
charts = found.charts
vi.charts.plotly_figure(charts["scores"])

# %%
# Optimistic bias of a random split
# ---------------------------------
plt.style.use("vibroimpact.charts.print")
figure, axes = plt.subplots(figsize=(6.6, 3.8), layout="constrained")
places = np.arange(len(classifiers))[::-1]
for scores, side, colour, words in (
    (found.scores, 0.14, "#00204d", "grouped by rock"),
    (found.random, -0.14, "#c79000", "split at random"),
):
    value = np.array([scores[name].balanced_accuracy.value for name in classifiers])
    interval = np.array(
        [
            (scores[name].balanced_accuracy.low, scores[name].balanced_accuracy.high)
            for name in classifiers
        ]
    ).T
    bars = np.abs(interval - value)
    axes.errorbar(
        100.0 * value,
        places + side,
        xerr=100.0 * bars,
        fmt="o",
        color=colour,
        markersize=8,
        capsize=4,
        label=words,
    )
axes.axvspan(100.0 * best, 100.0, color="#b3400e", alpha=0.1, linewidth=0)
axes.axvline(100.0 * best, color="#b3400e", linewidth=1.2)
axes.text(
    100.0 * best + 0.5,
    3.45,
    "not attainable\non unseen rocks",
    color="#b3400e",
    va="center",
    fontsize=9,
)
axes.set(
    xlabel="Balanced accuracy [%]",
    xlim=(50.0, 100.0),
    ylim=(-1.2, 3.8),
    title="Balanced accuracy with grouped and random splits",
)
axes.set_yticks(places, classifiers)
axes.legend(loc="lower left")
axes.grid(visible=False, axis="y")
# sphinx_gallery_thumbnail_number = -1
plt.show()
