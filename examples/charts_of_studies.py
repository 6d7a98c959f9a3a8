"""Two studies and their charts: four contact laws over the radius of the sphere, and drops of three
materials, coloured by them.

Makes the pictures of docs/studies.md.
"""

from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

import vibroimpact as vi
from vibroimpact.charts.files import save_charts

CASE = {
    "sphere": {"radius": "25 mm", "material": "granite"},
    "plate": {"material": "steel"},
    "drop": {"height": "1 m"},
    "contact": {"law": "flores", "restitution": 0.7},
    "run": {"impacts": 1},
}
RADII = {"from": "5 mm", "to": "50 mm", "scale": "log"}
STUDIES = {
    "study-curves": {
        "over": {
            "contact.law": ["flores", "hunt-crossley", "lankarani-nikravesh", "tsuji"],
            "sphere.radius": {**RADII, "number": 8},
        },
    },
    "study-drops": {
        "design": "latin-hypercube",
        "samples": 600,
        "over": {
            "sphere.material": ["granite", "glass", "steel"],
            "sphere.radius": RADII,
            "contact.restitution": {"distribution": "uniform", "from": 0.5, "to": 0.9},
            "drop.height": {"distribution": "normal", "mean": "1 m", "standard_deviation": "10 cm"},
        },
    },
}

DRAWN = {"study-curves": "curves", "study-drops": "first_rebound_height_m"}

for name, sweep in STUDIES.items():
    with TemporaryDirectory() as folder:
        study = vi.studies.load_study(
            vi.studies.run_sweep(
                vi.studies.sweep_of({**CASE, "sweep": sweep}), Path(folder, "study")
            )
        )
        chart = study.charts[DRAWN[name]]
    (file,) = save_charts([replace(chart, name=name)], Path())
    print(f"{file}: {chart.title}")
