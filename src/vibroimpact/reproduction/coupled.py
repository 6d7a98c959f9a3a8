"""Section 5.1: force, acceleration and rebound of Types 1, 2 and 3, the elastic ones in three treatments."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from vibroimpact.contact.phase.collocation import Floats
from vibroimpact.dynamics.response import Response
from vibroimpact.reproduction.printed import Printed, printed
from vibroimpact.reproduction.row import Account, Row
from vibroimpact.reproduction.runs import TREATMENTS, Runs
from vibroimpact.reproduction.sampling import error_range, found_spacing
from vibroimpact.reproduction.section import Section, Table
from vibroimpact.reproduction.unresolved import unresolved_range

Measure = Callable[[Response], float]
"""What is measured of a run."""

_IMPACTS = {"max_force": "max_force_N", "max_acceleration": "max_acceleration_m_s2", "rebound_height": "rebound_height_m"}


def section_4(runs: Runs) -> Section:
    """Return the meshes beside those of the paper."""
    models = runs.problem("type3").models
    sphere, plate = models["sphere"].mesh, models["plate"].mesh
    why = "a mesh of our own"
    counts = {
        "mesh.sphere.nodes": len(sphere.nodes),
        "mesh.sphere.elements": sum(len(block.connectivity) for block in sphere.blocks),
        "mesh.plate.elements": sum(len(block.connectivity) for block in plate.blocks),
    }
    return Section(
        "Section 4: the meshes",
        (
            "The meshes of the paper are not to be had. Here the plate has plate elements of order four, and the sphere curved bricks of "
            "second order, fine enough for the modes that are kept. The superposed treatment depends on the mesh whatever is done, as "
            "the forensic section shows.",
        ),
        tuple(Row(printed(name), float(count), by="the shipped case", otherwise=why) for name, count in counts.items()),
    )


def section_5_1(runs: Runs) -> Section:
    """Return the first impact of Types 1, 2 and 3, and what the paper says of the later ones."""
    rows = [_force_of_type_1(runs), *_accelerations(runs)]
    rows.append(Row(printed("type1.rebound_height"), float(runs.response("type1-variable").impacts["rebound_height_m"][0]), by="IMPACT"))
    for kind in (2, 3):
        for quantity, column in _IMPACTS.items():
            unresolved = unresolved_range(runs, kind, column) if quantity != "max_acceleration" else None
            rows += treated(runs, kind, printed(f"type{kind}.{quantity}"), _first(column), unresolved)
    return Section(
        "Section 5.1: force, acceleration and rebound in Types 1, 2 and 3",
        (
            "Types 2 and 3 are computed in three ways. Consistent: the contact law carries what is quasi-static and the modes what is "
            "dynamic, so that nothing is counted twice; so would elastic bodies do under this contact law. Superposed: law and modes in "
            "series, as in a multibody program with flexible bodies. Identified: a spring and a dashpot in series with the law stand for "
            "the sphere, fitted to the force and the rebound that are printed for Type 2, and tested on Type 3.",
            "No documented setting gives the printed Types 2 and 3. Where a row calls on an unresolved run, that is a reading, not a "
            "proof: the forensic section says what speaks for it and what against.",
        ),
        tuple(rows),
        (_statements(runs),),
    )


def treated(runs: Runs, kind: int, value: Printed, measure: Measure, unresolved: tuple[float, float] | None = None) -> list[Row]:
    """Return the rows of a value of Type 2 or 3, one a treatment.

    Parameters
    ----------
    runs : Runs
        The simulations.
    kind : int
        2 or 3.
    value : Printed
        What is printed.
    measure : callable
        Takes a response, and returns the value in the printed unit.
    unresolved : tuple of two floats, optional
        Between which an unresolved run of the superposed model gives it.
    """
    words = {
        "consistent": "elastic bodies under this contact law do otherwise, and no documented setting gives it",
        "superposed": "the superposed model, resolved, does otherwise, and no documented setting gives it",
        "identified": "a prediction from Type 2" if kind == 3 else "fitted to force and rebound alone",
    }
    if unresolved is not None:
        inside = Account("", *unresolved).holds(value)
        words["superposed"] += (
            f". A reading: unresolved, on a coarse mesh, it gives {unresolved[0]:.4g} to {unresolved[1]:.4g} {value.unit}, "
            f"and the printed value is {'among' if inside else 'not among'} these"
        )
    return [
        Row(
            value,
            measure(runs.treated(kind, treatment)),
            by=treatment,
            otherwise=words[treatment],
            fitted=treatment == "identified" and value.name in FITTED,
        )
        for treatment in TREATMENTS
    ]


FITTED = ("type2.max_force", "type2.rebound_height")
"""What the identified treatment was fitted to."""


def _first(column: str) -> Measure:
    return lambda response: float(response.impacts[column][0])


def _force_of_type_1(runs: Runs) -> Row:
    """Return the largest force of Type 1: what is printed was read off samples, as Table 2 was."""
    exact, theory = (runs.response(f"type1-{name}").impacts["max_force_N"][0] for name in ("variable", "theory"))
    spacing = found_spacing(runs)
    most = error_range(runs, spacing, "force", "variable", 1)[1]
    low = float(theory) * (1.0 - most / 100.0)
    reason = f"read off samples {1e6 * spacing:.0f} µs apart the peak is {low:.1f} to {exact:.1f} N"
    return Row(printed("type1.max_force"), float(exact), by="IMPACT", accounts=(Account(reason, low, float(exact)),))


def _accelerations(runs: Runs) -> list[Row]:
    """Return the accelerations that follow from the printed forces, F/m - g: in Types 2 and 3 they tell the mass of the mesh."""
    problem = runs.problem("type1-variable")
    mass, gravity = float(problem.sphere.mass), float(problem.gravity)
    rows = []
    for kind in (1, 2, 3):
        force, acceleration = printed(f"type{kind}.max_force"), printed(f"type{kind}.max_acceleration")
        least, most = mesh_mass(kind, gravity)
        reason = f"the mesh has lost a little mass: force and acceleration tell {least:.7f} to {most:.7f} kg instead of {mass:.7f} kg"
        account = Account(reason, force.value / most - gravity, force.value / least - gravity)
        accounts = (account,) if most < mass else ()
        rows.append(Row(acceleration, force.value / mass - gravity, by="the printed force over the mass, less gravity", accounts=accounts))
    return rows


def mesh_mass(kind: int, gravity: float) -> tuple[float, float]:
    """Return between which values the mass of the sphere lies, from the force and the acceleration printed of one instant [kg]."""
    force, acceleration = printed(f"type{kind}.max_force"), printed(f"type{kind}.max_acceleration")
    return (
        (force.value - force.half) / (acceleration.value + acceleration.half + gravity),
        (force.value + force.half) / (acceleration.value - acceleration.half + gravity),
    )


def _statements(runs: Runs) -> Table:
    """Return what section 5.1 says without a number, and whether it holds."""
    second = float(runs.response("type1-variable").impacts["time_s"][1])
    cells: list[tuple[str, ...]] = []
    kinds = {treatment: [runs.treated(kind, treatment).impacts for kind in (2, 3)] for treatment in TREATMENTS}

    def told(words: str, holds: Callable[[list[dict[str, Floats]]], tuple[bool, str]]) -> None:
        found = [holds(kinds[treatment]) for treatment in TREATMENTS]
        cells.append((words, *(f"{'holds' if is_so else 'does not hold'}: {numbers}" for is_so, numbers in found)))

    def fifth(both: list[dict[str, Floats]]) -> tuple[bool, str]:
        times = [impacts["time_s"][-1] for impacts in both]
        return max(times) < second, " and ".join(f"{time:.3f}" for time in times) + f" s, beside {second:.3f} s"

    def forces(part: slice, sign: float) -> Callable[[list[dict[str, Floats]]], tuple[bool, str]]:
        def compared(both: list[dict[str, Floats]]) -> tuple[bool, str]:
            two, three = (impacts["max_force_N"][part] for impacts in both)
            pairs = [f"{a:.0f} and {b:.0f} N" for a, b in zip(two, three, strict=True)]
            return bool(np.all(sign * (two - three) > 0)), ", ".join(pairs)

        return compared

    def heights(both: list[dict[str, Floats]]) -> tuple[bool, str]:
        two, three = (impacts["rebound_height_m"][0] for impacts in both)
        return bool(two > three), f"{two:.3f} and {three:.3f} m"

    told("Five impacts of Types 2 and 3 take less time than the first two of Type 1", fifth)
    told("The first force is weaker in Type 2 than in Type 3", forces(slice(0, 1), -1.0))
    told("The first rebound is higher in Type 2 than in Type 3", heights)
    told("From the second impact on the force is larger in Type 2 than in Type 3", forces(slice(1, None), 1.0))
    return Table(("What is said", *TREATMENTS), tuple(cells), "What the paper says of the later impacts")
