"""A thin plate whose frequency responses are known in closed form, after Kirchhoff, and
universal files with them by pyuff.
"""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pyuff
from numpy.typing import NDArray

import vibroimpact as vi
from oracles.simply_supported import simply_supported

Complex = NDArray[np.complex128]
Floats = NDArray[np.float64]

SIZE, DENSITY, MODULUS, POISSON = (0.4, 0.3, 0.003), 7800.0, 206e9, 0.3
IMPACT, PLACES = (0.07, 0.04), ((0.12, 0.08), (-0.05, 0.06))
NODES, REFERENCE = (12, 13), 4
DAMPING = 0.008
FREQUENCY = np.arange(40.0, 800.0, 0.5)
MOST = 400
"""Modes of the closed form: what is left out of it is below a ten thousandth of the
largest response.
"""

TABLE: dict[str, Any] = {
    "name": "thin plate",
    "sphere": {"radius": 0.01, "material": "steel"},
    "plate": {
        "size": list(SIZE),
        "material": {"density": DENSITY, "youngs_modulus": MODULUS, "poissons_ratio": POISSON},
        "model": "elastic",
        "modes": 10,
        "supports": "simply-supported",
        "damping": DAMPING,
    },
    "drop": {"speed": 0.5, "position": list(IMPACT)},
    "contact": {"law": "hertz"},
    "run": {"impacts": 1},
    "sensors": [
        {"name": str(node), "position": list(place)}
        for node, place in zip(NODES, PLACES, strict=True)
    ],
}


def modal(place: tuple[float, float], modulus: float = MODULUS) -> tuple[Floats, Floats]:
    """Frequencies [Hz] and shapes at a place, from the centre of the plate."""
    corner = (place[0] + 0.5 * SIZE[0], place[1] + 0.5 * SIZE[1])
    return simply_supported(SIZE, (DENSITY, modulus, POISSON), corner, MOST)


def accelerance(
    place: tuple[float, float],
    frequency: Floats = FREQUENCY,
    modulus: float = MODULUS,
    damping: float = DAMPING,
) -> Complex:
    """Acceleration upwards at a place over a downward force at the impact [m/s2/N]."""
    natural, there = modal(place, modulus)
    _, here = modal(IMPACT, modulus)
    omega, resonant = 2.0 * np.pi * frequency, 2.0 * np.pi * natural[:, None]
    return np.asarray(
        omega**2
        * np.sum(
            (here * there)[:, None] / (resonant**2 - omega**2 + 2j * damping * resonant * omega),
            axis=0,
        )
    )


def noisy(responses: Sequence[Complex], level: float = 0.005, seed: int = 1) -> list[Complex]:
    """The responses with white noise, relative to their rms values."""
    random = np.random.default_rng(seed)
    return [
        one
        + level
        * np.sqrt(0.5 * np.mean(np.abs(one) ** 2))
        * (random.standard_normal(len(one)) + 1j * random.standard_normal(len(one)))
        for one in responses
    ]


HEADER = {
    "type": 151,
    "model_name": "m",
    "description": "d",
    "db_app": "a",
    "program": "p",
    **{
        f"{what}_{when}": ""
        for what in ("date", "time")
        for when in ("db_created", "db_saved", "file_written")
    },
}
COMMON = {
    "type": 58,
    **{f"id{number}": "NONE" for number in range(2, 6)},
    "id1": "plate",
    "func_type": 4,
    "rsp_ent_name": "NONE",
    "rsp_dir": 3,
    "ref_ent_name": "NONE",
    "ref_node": REFERENCE,
    "ref_dir": -3,
    "abscissa_spacing": 1,
    "abscissa_spec_data_type": 18,
    "abscissa_axis_units_lab": "Hz",
    "ordinate_spec_data_type": 12,
    "ordinate_axis_units_lab": "m/s^2",
    "orddenom_spec_data_type": 13,
    "orddenom_axis_units_lab": "N",
    "z_axis_spec_data_type": 0,
    "ord_data_type": 6,
    "binary": 0,
}
COHERENCE = {
    "func_type": 6,
    "ord_data_type": 4,
    "ordinate_spec_data_type": 0,
    "orddenom_spec_data_type": 0,
    "ordinate_axis_units_lab": "NONE",
    "orddenom_axis_units_lab": "NONE",
}


def by_pyuff(path: Path, *functions: dict[str, Any], first: dict[str, Any] | None = None) -> Path:
    """A universal file with functions, of which each states what differs from `COMMON`."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ResourceWarning)
        pyuff.UFF(str(path)).write_sets(
            [first or HEADER, *({**COMMON, **one} for one in functions)], "overwrite"
        )
    return path


def measured(
    path: Path,
    responses: Sequence[Complex],
    frequency: Floats = FREQUENCY,
    coherence: Floats | None = None,
    **changes: Any,
) -> Path:
    """A universal file with the responses of the two places, and their coherence."""
    sets: list[dict[str, Any]] = []
    for node, response in zip(NODES, responses, strict=True):
        sets.append({"rsp_node": node, "x": frequency, "data": response, **changes})
        if coherence is not None:
            sets.append({**sets[-1], "data": coherence, **COHERENCE})
    return by_pyuff(path, *sets)


OF_TIME = {
    "func_type": 1,
    "ord_data_type": 4,
    "ref_node": 0,
    "ref_dir": 0,
    "abscissa_spec_data_type": 17,
    "abscissa_axis_units_lab": "s",
    "orddenom_spec_data_type": 0,
    "orddenom_axis_units_lab": "NONE",
}


def with_records(
    path: Path, responses: Sequence[Complex], force: Floats, motions: Sequence[Floats], rate: float
) -> Path:
    """A universal file with the responses of the two places, and with the records of the
    force, "hammer", and of the motion at both.
    """
    time = np.arange(len(force)) / rate
    of_force = {
        "id1": "hammer",
        "rsp_node": REFERENCE,
        "ordinate_spec_data_type": 13,
        "ordinate_axis_units_lab": "N",
        "data": force,
    }
    sets: list[dict[str, Any]] = [{**OF_TIME, "x": time, **of_force}]
    sets += [
        {**OF_TIME, "x": time, "id1": str(node), "rsp_node": node, "data": motion}
        for node, motion in zip(NODES, motions, strict=True)
    ]
    sets += [
        {"rsp_node": node, "x": FREQUENCY, "data": response}
        for node, response in zip(NODES, responses, strict=True)
    ]
    return by_pyuff(path, *sets)


def a_case(**plate: Any) -> vi.Case:
    """The case, with another plate."""
    return vi.case_of({**TABLE, "plate": {**TABLE["plate"], **plate}})
