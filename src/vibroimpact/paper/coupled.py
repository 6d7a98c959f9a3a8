"""Section 5.1: force, acceleration and rebound of Types 1, 2 and 3, the elastic ones in three treatments."""

from __future__ import annotations

from vibroimpact.cases.build import resolved_case
from vibroimpact.cases.reader import load_case
from vibroimpact.paper.measures import in_first_impact
from vibroimpact.paper.mesh_mass import mesh_mass
from vibroimpact.paper.printed import printed
from vibroimpact.paper.printed_and_computed import Account, Row
from vibroimpact.paper.runs import TREATMENTS, Runs
from vibroimpact.paper.sampling import found_spacing, peaks
from vibroimpact.paper.section import Section, Table, holds_text
from vibroimpact.paper.treatments import rows_by_treatment
from vibroimpact.paper.unresolved import unresolved_range

_IMPACTS = {"max_force": "max_force_N", "max_acceleration": "max_acceleration_m_s2", "rebound_height": "rebound_height_m"}


def section_5_1(runs: Runs) -> Section:
    """Return the first impact of Types 1, 2 and 3, and what the paper says of the later ones."""
    rows = [*_type_1(runs), *_accelerations(runs)]
    rows.append(Row(printed("type1.rebound_height"), float(runs.response("type1-variable").impacts["rebound_height_m"][0]), by="IMPACT"))
    for kind in (2, 3):
        for quantity, column in _IMPACTS.items():
            unresolved = unresolved_range(runs, kind, column) if quantity != "max_acceleration" else None
            rows += rows_by_treatment(runs, kind, printed(f"type{kind}.{quantity}"), in_first_impact(column), unresolved)
    ratio = float(resolved_case(load_case("paper:type2"))["sphere"]["damping"])
    return Section(
        "Section 5.1: force, acceleration and rebound in Types 1, 2 and 3",
        (
            "Types 2 and 3 are computed in three ways. Consistent: the contact law carries what is quasi-static and the modes what is "
            "dynamic, so that nothing is counted twice; this is how elastic bodies would move under this contact law. The sphere's "
            f"modes are damped by {ratio:g} of critical there, a guess, and the plate's as Adams does it by default. Superposed: law "
            "and modes in series, as in a multibody program with flexible bodies. Identified: a spring and a dashpot in series with "
            "the law stand for the sphere, fitted to the force and the rebound that are printed for Type 2, and tested on Type 3.",
            "No setting that was tried gives the printed Types 2 and 3: none of the three treatments, with the damping that Adams has by "
            "default in the superposed one. Where a row calls on an unresolved run, that is a reading, not a proof: the forensic section "
            "says what speaks for it and what against.",
        ),
        tuple(rows),
        (_statements(runs),),
    )


def _type_1(runs: Runs) -> list[Row]:
    """Return the largest force and acceleration of Type 1: what is printed looks as if it were read off samples, as Table 2 does."""
    impacts, problem = runs.response("type1-variable").impacts, runs.problem("type1-variable")
    mass, gravity = float(problem.sphere.mass), float(problem.gravity)
    spacing, high = found_spacing(runs), float(impacts["max_force_N"][0])
    low = peaks(runs)["variable", "force", 1].lowest(spacing)
    words = f"read off samples {1e6 * spacing:.0f} µs apart the peak is"
    force = Account(f"{words} {low:.1f} to {high:.1f} N", low, high)
    least, largest = (value / mass - gravity for value in (low, high))
    acceleration = Account(f"{words} {least:.0f} to {largest:.0f} m/s²", least, largest)
    return [
        Row(printed("type1.max_force"), high, by="IMPACT", accounts=(force,)),
        Row(printed("type1.max_acceleration"), float(impacts["max_acceleration_m_s2"][0]), by="IMPACT", accounts=(acceleration,)),
    ]


def _accelerations(runs: Runs) -> list[Row]:
    """Return the accelerations that follow from the printed forces, F/m - g; in Types 2 and 3 the mass is that of a mesh."""
    problem = runs.problem("type1-variable")
    mass, gravity = float(problem.sphere.mass), float(problem.gravity)
    rows = []
    for kind in (1, 2, 3):
        force = printed(f"type{kind}.max_force")
        accounts: tuple[Account, ...] = ()
        if kind > 1:
            other = 5 - kind  # the mass that the other type tells: what a type tells of itself always fits
            least, most = mesh_mass(other, gravity)
            reason = f"the mesh has lost a little mass: it weighs what Type {other} tells of it, {least:.7f} to {most:.7f} kg"
            accounts = (Account(reason, force.value / most - gravity, force.value / least - gravity),)
        value = printed(f"type{kind}.max_acceleration")
        rows.append(Row(value, force.value / mass - gravity, by="the printed force over the mass, less gravity", accounts=accounts))
    return rows


def _statements(runs: Runs) -> Table:
    """Return what section 5.1 says without a number, and whether it holds."""
    said = (
        "Five impacts of Types 2 and 3 take less time than the first two of Type 1",
        "The first force is weaker in Type 2 than in Type 3",
        "The first rebound is higher in Type 2 than in Type 3",
        "From the second impact on the force is larger in Type 2 than in Type 3",
    )
    found = [_statements_under(runs, treatment) for treatment in TREATMENTS]
    return Table(("What is said", *TREATMENTS), tuple(zip(said, *found, strict=True)), "What the paper says in words")


def _statements_under(runs: Runs, treatment: str) -> list[str]:
    """Return of each statement whether it holds under a treatment, with the numbers."""
    two, three = (runs.treated(kind, treatment).impacts for kind in (2, 3))
    second = float(runs.response("type1-variable").impacts["time_s"][1])
    fifth, other = two["time_s"][-1], three["time_s"][-1]
    height, lower = two["rebound_height_m"][0], three["rebound_height_m"][0]
    forces = [f"{one:.0f} and {another:.0f} N" for one, another in zip(two["max_force_N"], three["max_force_N"], strict=True)]
    more = two["max_force_N"] - three["max_force_N"]
    return [
        f"{holds_text(max(fifth, other) < second)}: {fifth:.3f} and {other:.3f} s, beside {second:.3f} s",
        f"{holds_text(more[0] < 0.0)}: {forces[0]}",
        f"{holds_text(height > lower)}: {height:.3f} and {lower:.3f} m",
        f"{holds_text(all(more[1:] > 0.0))}: {', '.join(forces[1:])}",
    ]
