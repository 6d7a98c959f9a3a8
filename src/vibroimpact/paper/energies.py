"""Section 5.2: where the energy of the sphere is in Types 2 and 3."""

from __future__ import annotations

from vibroimpact.contact.laws.adams_impact import AdamsImpact
from vibroimpact.dynamics.problem import Problem
from vibroimpact.paper.measures import energy_at_separation, energy_released, largest_of, sphere_rotation, sphere_strain
from vibroimpact.paper.mesh_mass import fall_beyond_touch, mesh_mass
from vibroimpact.paper.printed import printed
from vibroimpact.paper.printed_and_computed import Account, Row
from vibroimpact.paper.runs import TREATMENTS, Runs
from vibroimpact.paper.section import Section
from vibroimpact.paper.treatments import rows_by_treatment
from vibroimpact.paper.unresolved import unresolved_range


def section_5_2(runs: Runs) -> Section:
    """Return the energies of the sphere in the first impact."""
    rows: list[Row] = []
    for kind in (2, 3):
        rows += [_at_touch(runs, kind), *_released(runs, kind), _from_height(runs, kind)]
        rows += rows_by_treatment(runs, kind, printed(f"type{kind}.energy_at_separation"), energy_at_separation)
        rows += [_part(kind, "energy_left", "energy_at_separation"), _part(kind, "strain_part", "strain_energy")]
        unresolved = unresolved_range(runs, kind, "sphere_strain_J")
        rows += rows_by_treatment(runs, kind, printed(f"type{kind}.strain_energy"), largest_of(sphere_strain), unresolved)
        rows += rows_by_treatment(runs, kind, printed(f"type{kind}.rotational_energy"), largest_of(sphere_rotation))
    return Section(
        "Section 5.2: the energy of the sphere",
        (
            "What is printed is checked twice: against the other printed numbers, which tells how it was obtained, and against the three "
            "treatments. The strain energy is that of the modes, as a multibody program tells it; in the consistent treatment the contact "
            "law carries most of the sphere's strain beside them, and in the identified one it is the spring that stands for the sphere. "
            "A sphere that falls upright on a plate's middle does not turn: what is printed of rotation is rounding, there as here.",
        ),
        tuple(rows),
        conclusion=(_force_and_fall(runs),),
    )


def _force_and_fall(runs: Runs) -> str:
    """Tell that the printed force and the printed energies of Type 2 don't go together."""
    problem, force = runs.problem("type1-variable"), printed("type2.max_force").value
    law = problem.laws[0]
    assert isinstance(law, AdamsImpact)
    speed = float(runs.response("type1-variable").impacts["approach_speed_m_s"][0])
    least = 1e3 * ((force - float(law.damping_max) * speed) / float(law.stiffness)) ** (1.0 / float(law.exponent))
    deep = 1e3 * fall_beyond_touch(2, float(problem.gravity))
    return (
        f"The energies printed of Type 2 tell a fall of {deep:.2f} mm beyond first touch. IMPACT gives the printed {force:g} N at no "
        f"indentation of less than {least:.2f} mm, even at the full approach speed and the full damping: the two can't both be."
    )


def _fall(runs: Runs) -> tuple[float, float, float]:
    """Return mass [kg], gravity [m/s^2] and the height of the fall to first touch [m]."""
    problem = runs.problem("type1-variable")
    assert problem.height is not None
    return float(problem.sphere.mass), float(problem.gravity), float(problem.height) - float(problem.sphere.contact_offset)


def _at_touch(runs: Runs, kind: int) -> Row:
    """Return the energy of the fall to first touch."""
    mass, gravity, fall = _fall(runs)
    sag = _sag(runs.problem(f"type{kind}-superposed"))
    least, most = (weight * gravity * fall for weight in mesh_mass(kind, gravity))
    most *= 1.0 + sag / fall
    lower = f", and a plate that its weight lets sag by {1e6 * sag:.1f} µm," if sag else ""
    account = Account(f"with the mass of the mesh, as above{lower} {least:.6f} to {most:.6f} J", least, most)
    by = f"m g times the fall of {fall:g} m"
    return Row(printed(f"type{kind}.energy_at_touch"), mass * gravity * fall, by=by, accounts=(account,))


def _sag(problem: Problem) -> float:
    """Return by how much the plate's own weight lowers it where it is hit [m]; zero of a rigid one."""
    modes = problem.plate.modes
    if modes is None:
        return 0.0
    return float(problem.gravity * (modes.contact * modes.participation[:, 2] / modes.angular_frequencies**2).sum())


def _released(runs: Runs, kind: int) -> list[Row]:
    """Return the potential energy released down to the deepest point, of each treatment."""
    mass, gravity, fall = _fall(runs)
    value, deep = printed(f"type{kind}.potential_energy"), 1e3 * fall_beyond_touch(kind, gravity)
    rows = []
    for treatment in TREATMENTS:
        released = energy_released(runs.treated(kind, treatment))
        beyond = 1e3 * (released / (mass * gravity) - fall)
        why = f"printed is a fall of {deep:.2f} mm beyond first touch, and it is {beyond:.2f} mm here"
        rows.append(Row(value, released, by=treatment, otherwise=why))
    return rows


def _from_height(runs: Runs, kind: int) -> Row:
    """Return the energy at separation that the printed rebound height tells."""
    mass, gravity, _ = _fall(runs)
    height, radius = printed(f"type{kind}.rebound_height").value, float(runs.problem("type1-variable").sphere.contact_offset)
    response = runs.treated(kind, "identified")
    climbed = energy_at_separation(response) - mass * gravity * float(response.impacts["rebound_height_m"][0] - radius)
    low, high = mesh_mass(kind, gravity)[0] * gravity * (height - radius), mass * gravity * (height - radius) + climbed
    reason = f"the sphere leaves while it is still pressed in, and lighter by the mesh: {low:.5f} to {high:.5f} J"
    value = printed(f"type{kind}.energy_at_separation")
    return Row(value, mass * gravity * (height - radius), by="m g times the printed rebound", accounts=(Account(reason, low, high),))


def _part(kind: int, part: str, of: str) -> Row:
    """Return a printed part in per cent beside the two numbers that it is made of."""
    over, under = printed(f"type{kind}.{of}"), printed(f"type{kind}.potential_energy")
    ratio = 100.0 * over.value / under.value
    why = f"{over.text} J of {under.text} J are {ratio:.2f} %: a misprint"
    return Row(printed(f"type{kind}.{part}"), ratio, by="the printed energies", otherwise=why)
