"""Studies for tests."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import tomli_w

from support import plain_case

OVER: dict[str, Any] = {
    "sphere.radius": {"from": "5 mm", "to": "50 mm", "number": 4, "scale": "log"},
    "contact.restitution": [0.4, 0.6, 0.8],
}
"""A grid of twelve points."""

RANDOM: dict[str, Any] = {
    "design": "latin-hypercube",
    "samples": 200,
    "over": {
        "sphere.radius": {"from": "5 mm", "to": "50 mm", "scale": "log"},
        "sphere.material.youngs_modulus": {
            "distribution": "lognormal",
            "mean": "2 GPa",
            "standard_deviation": "0.5 GPa",
        },
        "contact.restitution": {"distribution": "uniform", "from": 0.3, "to": 0.95},
        "drop.height": {"distribution": "normal", "mean": "1 m", "standard_deviation": "10 cm"},
    },
}


def coal_on_steel() -> dict[str, Any]:
    """Return the bodies of a small elastic study: coal on a steel plate of twelve modes."""
    return {
        "sphere": {
            "radius": 0.02,
            "material": {"density": 1380.0, "youngs_modulus": 2.3e9, "poissons_ratio": 0.28},
        },
        "plate": {
            "size": [0.4, 0.3, 0.008],
            "material": "steel",
            "model": "elastic",
            "modes": 12,
            "damping": 0.02,
            "supports": "simply-supported",
        },
    }


def study_table(sweep: object = None, **changes: object) -> dict[str, Any]:
    """Return a study as a mapping: a plain case, and a section that sweeps it."""
    return {**plain_case(**changes), "sweep": {"over": OVER} if sweep is None else sweep}


def study_file(folder: Path, sweep: object = None, **changes: object) -> Path:
    """Write a study to a file."""
    file = folder / "study.toml"
    file.write_text(tomli_w.dumps(study_table(sweep, **changes)), encoding="utf-8")
    return file
