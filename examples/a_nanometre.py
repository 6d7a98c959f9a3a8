"""Two drops a nanometre apart on an undamped plate: how fast they separate, and what the first run
predicts of it.

Makes the picture of docs/elastic-drops.md.
"""

from dataclasses import replace

import matplotlib

matplotlib.use("Agg")  # no window
import matplotlib.pyplot as plt
import numpy as np

import vibroimpact as vi

case = {
    "sphere": {"radius": "25 mm", "material": "rock-paper"},
    "plate": {
        "size": ["520 mm", "420 mm", "8 mm"],
        "material": "steel-paper",
        "model": "elastic",
        "supports": "simply-supported",
        "modes": 100,
    },
    "drop": {"height": "1 m", "position": ["30 mm", "50 mm"]},
    "contact": {"law": "lankarani-nikravesh", "restitution": 0.8},
    "run": {"impacts": 6},
}
problem = vi.case_of(case).to_problem()
first, second = (vi.simulate(replace(problem, height=height)) for height in (1.0, 1.0 + 1e-9))

number, predicted = first.impacts["impact"], 1e-9 * first.impacts["sensitivity"]
force = [response.impacts["max_force_N"][: len(number)] for response in (first, second)]
apart = np.abs(force[1] / force[0] - 1.0)
for row in zip(number, *force, apart, predicted, strict=True):
    print("impact {:.0f}: {:7.1f} and {:7.1f} N, difference {:.1e}, predicted {:.1e}".format(*row))

figure, (above, below) = plt.subplots(2, figsize=(7.5, 5.5), layout="constrained")
times = np.linspace(1.2, min(first.end_time[0], second.end_time[0]), 4001)
for response, style in ((first, "-"), (second, "--")):
    above.plot(
        times,
        1e3 * response.at(times)["position_m"],
        style,
        color="#0b4f8a" if response is first else "#b3400e",
    )
above.legend(["dropped from 1 m", "1 nm higher"], frameon=False, ncols=2)
above.set(
    xlabel="time [s]", ylabel="height of the centre [mm]", title="Two drops a nanometre apart"
)
below.semilogy(number, apart, "o", color="#b3400e", label="difference of the largest forces")
below.semilogy(
    number, predicted, "-", color="#0b4f8a", label="predicted by the first run: sensitivity x 1e-9"
)
below.axhline(1.0, color="#6b6b6b", linewidth=0.7)
below.set(xlabel="impact", ylabel="relative change [-]", ylim=(1e-10, 1e6))
below.legend(frameon=False)
figure.savefig("a-nanometre.png", dpi=130)
