"""Valid cases and studies, with every section and key of a case file among them, from
which tests make hostile ones.
"""

from __future__ import annotations

import math
import re
import tomllib
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Any

from studies import RANDOM, study_table
from support import plain_case
from vibroimpact.contact.friction.registry import friction_laws

Table = dict[str, Any]

_ROOT = Path(__file__).parents[1]

ELASTIC: Table = {
    "sphere": {
        "radius": "25 mm",
        "material": "steel",
        "model": "elastic",
        "modes": 5,
        "damping": {"loss_factor": 0.01},
    },
    "plate": {
        "size": ["520 mm", "420 mm", "8 mm"],
        "material": "steel",
        "model": "elastic",
        "modes": 12,
        "supports": [
            {"type": "patch", "position": [0.2, 0.15], "radius": "20 mm"},
            {"type": "spring", "position": [-0.2, 0.1], "stiffness": "1 MN/m"},
            {"type": "edge", "edge": "x-min", "condition": "clamped"},
        ],
        "damping": {"frequencies": [100.0, 1000.0], "ratios": [0.01, 0.02]},
        "mesh": {"element_size": "40 mm"},
    },
    "sensors": [
        {"name": "a1", "position": ["100 mm", "50 mm"], "rate": "50 kHz"},
        {
            "name": "a2",
            "position": [0, 0],
            "accelerometer": {"resonance": "20 kHz", "range": 500.0, "noise": 0.1},
        },
    ],
}

_PLATE: Table = {
    "size": ["520 mm", "420 mm", "8 mm"],
    "material": "steel",
    "model": "elastic",
    "modes": 12,
}
_HELD: Table = {
    "supports": [{"type": "patch", "position": [0.2, 0.15], "radius": "20 mm"}],
    "damping": 0.02,
}
_CHAIN: Table = {
    "amplifier": {"gain": 2.0, "noise": "50 uV", "hum": "0.2 mV", "mains": "50 Hz", "seed": 3}
}

_INSTRUMENTS: Table = {
    "plate": {**_PLATE, **_HELD},
    "drop": {"speed": "1 m/s"},
    "run": {"duration": "50 ms", "rest_speed": "1 mm/s", "tolerance": 1e-8},
    "sensors": [
        {
            "name": "below",
            "position": [0, 0],
            "face": "lower",
            "rate": "10 kHz",
            "geophone": {
                "natural_frequency": "10 Hz",
                "sensitivity": "27.6 V s/m",
                "damping_ratio": 0.6,
                "low_pass": "2 kHz",
            },
            **_CHAIN,
            "converter": {"range": "10 V", "bits": 16},
        },
        {
            "name": "accelerometer",
            "position": ["60 mm", "40 mm"],
            "quantity": "voltage",
            "direction": "z",
            "filter": "butterworth",
            "corner": "15 kHz",
            "accelerometer": {
                "resonance": "32 kHz",
                "sensitivity": "100 mV/g",
                "resolution": "0.1 m/s^2",
                "damping_ratio": 0.03,
                "seed": 2,
            },
        },
        {
            "name": "gauge",
            "position": ["50 mm", 0],
            "direction": [1, 1, 0],
            "strain_gauge": {"sensitivity": "2 V"},
        },
        {
            "name": "support",
            "position": [0.2, 0.15],
            "instrument": "force",
            "force": {"sensitivity": "10 mV/N"},
        },
        {
            "name": "overhead",
            "position": ["100 mm", 0],
            "microphone": {
                "distance": "30 cm",
                "sensitivity": "50 mV/Pa",
                "air_density": 1.2,
                "speed_of_sound": "340 m/s",
            },
        },
    ],
}

_OBLIQUE: Table = {
    "plate": {"size": ["200 mm", "200 mm", "25 mm"], "material": "glass", "inclination": "10 deg"},
    "drop": {
        "speed": "3.85 m/s",
        "angle": "20 deg",
        "spin": [0, "100 rad/s", 5.0],
        "position": ["-60 mm", 0],
    },
}

_TARGETS: tuple[Table, ...] = (
    {
        "target": {"law": "lankarani-nikravesh", "restitution": 0.65},
        "parameter": "damping_max",
        "match": "separation_speed",
        "degree": 2,
    },
    {
        "target": {"restitution": 0.7},
        "match": {"separation_speed": 1, "max_force": 0.5},
        "model": {"law": "tsuji", "restitution": 0.6},
    },
    {
        "target": {
            "restitution": [0.75, 0.7, 0.68],
            "approach_speed": [1.0, 2.0, 3.0],
            "standard_deviation": 0.01,
        },
        "speeds": {"from": 0.5, "to": "4 m/s", "number": 20, "scale": "log"},
        "confidence": 0.9,
        "bootstrap": 40,
        "seed": 1,
    },
    {
        "target": {"rebound_heights": ["0.2 m", "0.1 m"], "standard_deviation": "1 mm"},
        "air": True,
        "degree": 1,
    },
    {
        "target": {
            "max_force": "800 N",
            "duration": "1 ms",
            "max_indentation": "1 mm",
            "restitution": 0.6,
            "relative_deviation": 0.02,
        }
    },
    {"target": {"file": "heights.csv"}, "model": "hunt-crossley"},
    {"target": "heights.csv"},
)

_FRICTION_TARGET: Table = {
    "target": "oblique.csv",
    "parameter": ["friction.coefficient", "friction.effective_shear_modulus"],
}

_MEASURED: Table = {
    "plate": {**_PLATE, "supports": "simply-supported"},
    "contact": {
        "law": "hertz",
        "local_compliance": "identified",
        "measured": {
            "max_force": "800 N",
            "rebound_height": "0.2 m",
            "relative_deviation": 0.02,
            "plate": "rigid",
        },
    },
}

_SIGNALS: Table = {
    "plate": {**_PLATE, "supports": "simply-supported", "damping": 0.02},
    "sensors": [
        {
            "name": "a1",
            "position": ["60 mm", "40 mm"],
            "rate": "25 kHz",
            "accelerometer": {"resonance": "32 kHz", "noise": 2.0},
        }
    ],
    "run": {"duration": "0.4 s"},
}

_POPULATION: Table = {
    "design": "population",
    "samples": 64,
    "seed": 1,
    "keep": ["signals"],
    "falls_per_rock": 2,
    "rocks_per_plate": 8,
    "window": {"before": "2 ms", "length": "40 ms"},
    "over": {
        "sphere.radius": {"from": "15 mm", "to": "60 mm", "scale": "log"},
        "plate.size.thickness": {
            "distribution": "normal",
            "mean": "20 mm",
            "standard_deviation": "1 mm",
        },
        "sensors.a1.accelerometer.noise": {"from": "1 m/s^2", "to": "5 m/s^2", "scale": "log"},
        "drop.height": {
            "value": "0.7 m",
            "of": "sphere.radius",
            "at": "20 mm",
            "exponent": 0.2,
            "each": "rock",
            "factor": {"distribution": "lognormal", "mean": 1, "standard_deviation": 0.1},
        },
    },
    "classes": {
        "coal": {
            "share": 0.6,
            "over": {
                "sphere.material.density": {
                    "distribution": "normal",
                    "mean": 1380,
                    "standard_deviation": 60,
                    "at_least": 1200,
                },
                "contact.restitution": {"from": 0.3, "to": 0.6},
            },
        },
        "gangue": {
            "over": {
                "sphere.material.density": {
                    "distribution": "normal",
                    "mean": 2550,
                    "standard_deviation": 120,
                    "at_most": 2900,
                },
                "contact.restitution": [0.4, 0.5],
            },
        },
    },
}

_SWEEPS: tuple[Any, ...] = (
    None,
    RANDOM,
    {"design": "zip", "over": {"drop.height": [0.5, 1.0], "contact.restitution": [0.5, 0.6]}},
    {"over": {"plate.size.thickness": [0.01, 0.02]}},
    {
        "over": {
            "drop.position.x": {"from": 0, "to": "1 cm", "number": 3},
            "run.duration": ["1 s", "2 s"],
        }
    },
    {
        "design": "sobol",
        "samples": 8,
        "seed": 3,
        "over": {"drop.speed": {"distribution": "uniform", "from": 1, "to": 5}},
    },
    {"design": "saltelli", "samples": 4, "over": RANDOM["over"], "keep": ["peaks"]},
    {
        "over": {
            "contact.law": ["lankarani-nikravesh", "tsuji"],
            "sphere.material": ["steel", "glass"],
        }
    },
)

_SCALED: Table = {
    "design": "latin-hypercube",
    "samples": 8,
    "over": {
        "sphere.radius": {"from": "5 mm", "to": "10 mm"},
        "drop.height": {
            "value": "0.7 m",
            "of": "sphere.radius",
            "at": "10 mm",
            "exponent": 0.5,
            "factor": [0.9, 1.1],
        },
    },
}

_COLUMN: Table = {
    "design": "latin-hypercube",
    "samples": 8,
    "over": {
        "sphere": {"radius": {"file": "grains.csv", "column": "radius [mm]", "weights": "share"}}
    },
}


def write_files(folder: Path) -> None:
    """Write the files that the cases name."""
    steps = [
        (place / 200.0, 2.0 * math.sin(2.0 * math.pi * 5.0 * place / 200.0)) for place in range(200)
    ]
    (folder / "deck.csv").write_text(
        "time [s],displacement [mm]\n" + "".join(f"{time:.9g},{at:.12g}\n" for time, at in steps)
    )
    (folder / "heights.csv").write_text("impact,rebound_height [mm]\n1,310\n2,190\n3,130\n")
    (folder / "grains.csv").write_text("radius (mm);share\n5;10\n7.5;20\n10;5\n")
    (folder / "oblique.csv").write_text(
        "angle [deg],speed [m/s],tangential_restitution\n20,3.9,0.8\n40,3.9,0.75\n60,3.9,0.8\n"
    )


@cache
def seeds() -> tuple[Table, ...]:
    """Return the cases that the program ships and its documents show, one of vibrating
    bodies, and those of the sections added later.
    """
    library = files("vibroimpact").joinpath("cases/library")
    shipped = [
        file.read_text()
        for group in library.iterdir()
        for file in group.iterdir()
        if file.name.endswith(".toml")
    ]
    pages = [
        page.read_text(encoding="utf-8")
        for page in sorted([_ROOT / "README.md", *(_ROOT / "docs").glob("*.md")])
    ]
    shown = [
        block for page in pages for block in re.findall(r"```toml\n(.*?)```", page, flags=re.S)
    ]
    return (
        *(tomllib.loads(text) for text in (*sorted(shipped), *shown)),
        plain_case(**ELASTIC),
        *later_seeds(),
    )


def later_seeds() -> tuple[Table, ...]:
    """Return cases of friction, moved plates, fluids, instruments, calibrations of every
    kind, and measured contacts.
    """
    laws = {
        name: {"law": name, "coefficient": 0.3, "rolling_coefficient": 0.01}
        for name in friction_laws()
    }
    laws["mdr"] |= {
        "effective_modulus": "40 GPa",
        "effective_shear_modulus": "10 GPa",
        "effective_radius": "25 mm",
    }
    laws["rigid"] |= {"slip_restitution": 0.4}
    friction = {"contact__friction": laws["mdr"]}
    thrown = {
        "height": "0.3 m",
        "velocity": ["1 m/s", 0, "-2 m/s"],
        "air": {"density": 1.2, "viscosity": "18 uPa*s"},
        "same_spot": False,
    }
    return (
        *(plain_case(**_OBLIQUE, contact__friction=law) for law in laws.values()),
        plain_case(
            plate__motion={
                "amplitude": "3 mm",
                "frequency": "16 Hz",
                "phase": "90 deg",
                "direction": [1, 0, 1],
            },
            **friction,
        ),
        plain_case(plate__motion={"file": "deck.csv", "repeat": True}, run={"duration": "1 s"}),
        plain_case(drop=thrown, run={"impacts": "all"}),
        plain_case(drop__air=True, contact__finite_sphere=True),
        plain_case(contact__liquid={"density": 998.0, "viscosity": "1 mPa*s"}),
        plain_case(contact__liquid=True),
        plain_case(**_INSTRUMENTS),
        plain_case(**_MEASURED),
        *(
            plain_case(contact={"law": "adams-impact", "damping_max": 100.0}, calibrate=target)
            for target in _TARGETS
        ),
        plain_case(**_OBLIQUE, **friction, calibrate=_FRICTION_TARGET),
    )


@cache
def study_seeds() -> tuple[Table, ...]:
    """Return studies of drops, most of which run in no time."""
    plain = [
        study_table(sweep, run={"impacts": 2}, plate__size=[0.5, 0.4, 0.02], **_start(sweep))
        for sweep in _SWEEPS
    ]
    return (*plain, *later_studies())


def _start(sweep: Any) -> Table:
    """Return the drop of a study that sweeps its speed."""
    return {"drop": {"speed": 2.0}} if sweep and "drop.speed" in sweep["over"] else {}


def later_studies() -> tuple[Table, ...]:
    """Return studies of friction laws and moved plates, of columns and scaled keys, and
    populations whose signals are kept.
    """
    friction = {"law": "mdr", "coefficient": 0.3}
    over_friction = {
        "over": {
            "contact.friction.law": ["mdr", "rigid"],
            "contact.friction.coefficient": [0.1, 0.3],
        }
    }
    shaken = {"amplitude": "3 mm", "frequency": "16 Hz"}
    over_shaken = {
        "over": {
            "plate.motion.phase": ["0 deg", "90 deg"],
            "plate.motion.frequency": {"from": 10, "to": 20, "number": 3},
        }
    }
    return (
        study_table(over_friction, **_OBLIQUE, contact__friction=friction),
        study_table(over_shaken, plate__motion=shaken),
        study_table({"over": {"drop.air.density": [1.0, 1.2]}}, drop__air=True),
        study_table({"over": {"contact.liquid.viscosity": [0.001, 0.002]}}),
        study_table(_SCALED),
        study_table(_COLUMN),
        study_table(_POPULATION, **_SIGNALS),
    )
