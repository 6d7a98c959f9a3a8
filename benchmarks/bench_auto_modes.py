"""What `modes = "auto"` leaves out: 40 plates beside four times the modes.

    python benchmarks/bench_auto_modes.py [NUMBER ...]      only the plates of these numbers

Both runs have the same finite elements, so that the difference is that of the modes alone. The
errors are those of the largest force, and of each signal over its rms value; the accuracy asked is
that of the case, 1 % by default.
"""

from __future__ import annotations

import os

# before NumPy is loaded: what is measured is one core
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import math
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

import vibroimpact as vi
from vibroimpact.cases.elastic.elastic_bodies import elastic_bodies
from vibroimpact.meshes.write_nastran import write_nastran
from vibroimpact.structures.finite_elements.lattice import box_mesh
from vibroimpact.units import to_si

ACCELERATION = {"quantity": "acceleration", "rate": "20 kHz"}
VELOCITY = {"quantity": "velocity", "rate": "50 kHz"}
DISPLACEMENT = {"quantity": "displacement", "rate": "50 kHz"}
ROCK = {"density": 1380, "youngs_modulus": "2.26 GPa", "poissons_ratio": 0.28}


def plates(folder: Path) -> Iterator[tuple[str, dict[str, Any]]]:
    """Yield the plates, with a name each."""
    for material in ("steel", "aluminium", "polymethylmethacrylate", "concrete"):
        for thickness in ("6 mm", "12 mm"):
            yield f"{material} of {thickness}, clamped", drop(material, thickness, "clamped")
            yield (
                f"{material} of {thickness}, simply supported",
                drop(material, thickness, "simply-supported", ball="glass", radius="5 mm"),
            )
    for thickness in ("2 mm", "3 mm"):
        yield (
            f"rock on steel of {thickness}",
            drop("steel", thickness, "clamped", ball=ROCK, radius="15 mm", height="0.1 m"),
        )
    for thickness in ("20 mm", "30 mm"):
        yield f"steel of {thickness}, clamped", drop("steel", thickness, "clamped", radius="15 mm")
    feet = {"type": "patches", "spacing": ["260 mm", "160 mm"], "radius": "10 mm"}
    for thickness in ("4 mm", "6 mm", "10 mm"):
        yield (
            f"aluminium of {thickness} on feet",
            drop("aluminium", thickness, feet, radius="15 mm"),
        )
    spring = {"type": "spring", "stiffness": 5e5, "horizontal_stiffness": 5e5, "radius": "10 mm"}
    springs = [
        {**spring, "position": [f"{x} mm", f"{y} mm"]} for x in (-130, 130) for y in (-80, 80)
    ]
    for thickness in ("6 mm", "15 mm"):
        yield f"steel of {thickness} on springs", drop("steel", thickness, springs)
    for position in (["100 mm", "50 mm"], ["148 mm", "0 mm"], ["149 mm", "99 mm"]):
        yield f"steel at {position}", drop("steel", "8 mm", feet, position=position)
    for height in ("15 mm", "100 mm", "5 m"):
        yield f"steel from {height}", drop("steel", "8 mm", "clamped", height=height)
    for quantity in ("velocity", "displacement"):
        sensors = [VELOCITY if quantity == "velocity" else DISPLACEMENT]
        yield f"aluminium, {quantity}", drop("aluminium", "8 mm", feet, sensors=sensors)
    for thickness in ("10 mm", "25 mm"):
        solid = drop("steel", thickness, "simply-supported", sensors=[])
        solid["plate"]["element"] = "solid"
        yield f"steel of {thickness}, bricks", solid
    yield "no sensor, steel", drop("steel", "8 mm", "clamped", sensors=[])
    yield "no sensor, aluminium", drop("aluminium", "6 mm", feet, sensors=[])
    paper = drop("steel", "8 mm", feet, ball=ROCK, radius="25 mm", height="4 m")
    paper["plate"]["size"] = ["520 mm", "420 mm", "8 mm"]
    paper["plate"]["supports"] = {**feet, "spacing": ["458.4 mm", "360 mm"], "radius": "20 mm"}
    yield "the paper's plate", paper
    for thickness in (0.01, 0.02):
        file = folder / f"box-{thickness}.bdf"
        write_nastran(box_mesh((0.3, 0.2, thickness), (18, 12, 1)), file)
        imported = drop("steel", "1 mm", springs, sensors=[])
        imported["plate"]["mesh"] = {"file": str(file)}
        del imported["plate"]["size"]
        yield f"imported plate of {thickness} m", imported


def drop(
    material: str,
    thickness: str,
    supports: Any,
    *,
    ball: Any = "steel",
    radius: str = "10 mm",
    height: str = "0.5 m",
    position: list[str] | None = None,
    sensors: list[dict[str, Any]] | None = None,
) -> dict[str, Any]:
    """Return a case: a ball falls once on a plate of 300 x 200 mm with an accelerometer."""
    if sensors is None:
        sensors = [ACCELERATION]
    return {
        "sphere": {"radius": radius, "material": ball},
        "plate": {
            "size": ["300 mm", "200 mm", thickness],
            "material": material,
            "model": "elastic",
            "supports": supports,
            "damping": 0.01,
        },
        "drop": {"height": height, "position": position or [0.0, 0.0]},
        "contact": {"law": "flores", "restitution": 0.8},
        # the fall, and 20 ms of vibration
        "run": {"impacts": 1, "duration": math.sqrt(2.0 * to_si(height, "m") / 9.81) + 0.02},
        "sensors": [
            {"name": f"s{number}", "position": ["90 mm", "40 mm"], **sensor}
            for number, sensor in enumerate(sensors)
        ],
    }


def simulated(table: dict[str, Any]) -> vi.Result:
    """Return the result of a case."""
    return vi.result_of(vi.simulate(vi.case_of(table)))


def with_plate(table: dict[str, Any], **keys: Any) -> dict[str, Any]:
    """Return a case with other keys of its plate."""
    return {**table, "plate": {**table["plate"], **keys}}


def errors_of(table: dict[str, Any]) -> tuple[int, float, list[float], float]:
    """Return the number of modes chosen, errors of force and signals, and the accuracy asked."""
    body = elastic_bodies(vi.case_of(table))["plate"]
    chosen = simulated(table)
    number = len(chosen.frequencies("plate"))
    more = with_plate(table, modes=4 * number)
    shape = elastic_bodies(vi.case_of(more))["plate"].recipe.shape
    mesh = {}
    if hasattr(shape, "element_size"):
        mesh = {"mesh": {"element_size": shape.element_size}}
    reference = simulated(with_plate(more, **mesh))
    reduction = body.recipe.reduction
    kept: dict[str, Any] = {"modes": number}
    if reduction.max_frequency is not None:
        kept = {"max_frequency": reduction.max_frequency}
    same_mesh = simulated(with_plate(table, **kept, **mesh))
    force = relative(same_mesh.impacts["max_force_N"], reference.impacts["max_force_N"])
    signals = [
        relative(same_mesh.signals[name].value, signal.value)
        for name, signal in reference.signals.items()
    ]
    return number, force, signals, 0.01


def relative(values: Any, truth: Any) -> float:
    """Return the norm of a difference over that of the truth."""
    return float(np.linalg.norm(values - truth) / np.linalg.norm(truth))


def main() -> None:
    """Print a row for each plate, and how many hold."""
    chosen = [int(number) for number in sys.argv[1:]]
    held = 0
    count = 0
    with tempfile.TemporaryDirectory() as folder:
        for index, (name, table) in enumerate(plates(Path(folder))):
            if chosen and index not in chosen:
                continue
            os.environ["VIBROIMPACT_STORE"] = tempfile.mkdtemp(dir=folder)
            number, force, signals, accuracy = errors_of(table)
            os.environ["VIBROIMPACT_STORE"] = tempfile.mkdtemp(dir=folder)
            holds = max([force, *signals]) <= accuracy
            held += holds
            count += 1
            of_signals = ", ".join(f"{100 * error:.2f}" for error in signals) or "none"
            print(
                f"{index:3d} {name:42s} {number:5d} modes, force {100 * force:.2f} %, signals "
                f"{of_signals} %{'' if holds else '   does not hold'}",
                flush=True,
            )
    print(f"{held} of {count} plates hold")


if __name__ == "__main__":
    main()
