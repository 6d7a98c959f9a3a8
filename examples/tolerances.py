"""How exactly can a rebound be known? Tolerances of a drop test, propagated to the height of its first rebound."""

from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

import vibroimpact as vi

study = vi.read_sweep(
    {
        "sphere": {"radius": "25 mm", "material": "rock-paper"},
        "plate": {"material": "steel-paper"},
        "drop": {"height": "4 m"},
        "contact": {"law": "lankarani-nikravesh", "restitution": 0.65},
        "run": {"impacts": 1},
        "sweep": {
            "design": "sobol",
            "samples": 1024,
            "over": {
                "sphere.radius": {"distribution": "normal", "mean": "25 mm", "standard_deviation": "1 mm"},
                "drop.height": {"distribution": "normal", "mean": "4 m", "standard_deviation": "2 cm"},
                "contact.restitution": {"distribution": "normal", "mean": 0.65, "standard_deviation": 0.02, "at_most": 1.0},
            },
        },
    }
)

with TemporaryDirectory() as folder:
    found = vi.read_study(vi.run_sweep(study, Path(folder, "tolerances")))
    heights = found.values("first_rebound_height_m")

print("first rebound, 5 %, median, 95 % [m]:", np.percentile(heights, [5, 50, 95]).round(3).tolist())
