"""The sections on elastic bodies: forces and rebounds (5.1), energy of the sphere (5.2),
vibration of the plate (5.3).
"""

from __future__ import annotations

import math

import numpy as np

from vibroimpact.cases.build import resolved_case
from vibroimpact.cases.reader import load_case
from vibroimpact.contact.laws.adams_impact import AdamsImpact
from vibroimpact.dynamics.statement.problem import Problem
from vibroimpact.paper.derived import fall_beyond_touch, mesh_mass
from vibroimpact.paper.implicit_euler import PEAKS
from vibroimpact.paper.measures import (
    after_each_impact,
    energy_at_separation,
    energy_released,
    history_column,
    in_first_impact,
    kind_of,
    largest_of,
    plate_energy_part,
    sphere_rotation,
    sphere_strain,
    values_by_treatment,
)
from vibroimpact.paper.printed import printed
from vibroimpact.paper.report_section import (
    ComparedValue,
    Explanation,
    Kind,
    ReportSection,
    TextTable,
    holds_text,
)
from vibroimpact.paper.runs import IMPACTS, TREATMENTS, Runs
from vibroimpact.paper.sampling import contact_pulses, spacing_bound
from vibroimpact.paper.unresolved import unresolved_range

_IMPACT_COLUMNS = {
    "max_force": "max_force_N",
    "max_acceleration": "max_acceleration_m_s2",
    "rebound_height": "rebound_height_m",
}


def section_5_1(runs: Runs) -> ReportSection:
    """Return section 5.1: the first impact of Types 1, 2 and 3, and the statements on the
    later ones.
    """
    rows = [*_type_1(runs), *_accelerations(runs)]
    rows.append(
        ComparedValue(
            printed("type1.rebound_height"),
            float(runs.response("type1-variable").impacts["rebound_height_m"][0]),
            by="IMPACT",
        )
    )
    for kind in (2, 3):
        for quantity, name in _IMPACT_COLUMNS.items():
            unresolved = None
            if quantity != "max_acceleration":
                unresolved = unresolved_range(runs, kind, name)
            rows += values_by_treatment(
                runs, kind, printed(f"type{kind}.{quantity}"), in_first_impact(name), unresolved
            )
    ratio = float(resolved_case(load_case("paper:type2"))["sphere"]["damping"])
    return ReportSection(
        "Section 5.1: force, acceleration and rebound in Types 1, 2 and 3",
        (
            "Types 2 and 3 are computed in three ways. Consistent: the contact law contains "
            "the quasi-static and the modes the dynamic "
            "deformation of the sphere, so that no compliance is counted twice. The sphere's "
            f"modes have a damping ratio of {ratio:g} there, which is assumed, and the "
            "plate's the default of Adams. Superposed: law "
            "and modes in series, as in a multibody program with flexible bodies. "
            "Identified: a spring and a dashpot in parallel, in "
            "series with the law, represent the sphere, fitted to the force and the rebound "
            "that are printed for Type 2, and tested on Type 3.",
            "No setting that was tried reproduces all that is printed of Types 2 and 3: "
            "none of the three treatments, with the default "
            "damping of Adams in the superposed one. Where a row refers to an unresolved "
            "run, that is a hypothesis, not a proof: the "
            "section on inferences gives the evidence for and against it.",
        ),
        tuple(rows),
        (_statements(runs),),
    )


def _type_1(runs: Runs) -> list[ComparedValue]:
    """Return the largest force and acceleration of Type 1, with sampled peaks as the
    explanation, as for Table 2.
    """
    impacts = runs.response("type1-variable").impacts
    problem = runs.problem("type1-variable")
    mass = float(problem.sphere.mass)
    gravity = float(problem.gravity)
    spacing = spacing_bound(runs)
    high = float(impacts["max_force_N"][0])
    low = contact_pulses(runs)["variable", "force", 1].lowest(spacing)
    phrase = f"read off samples {1e6 * spacing:.0f} µs apart the peak is"
    force = Explanation(f"{phrase} {low:.1f} to {high:.1f} N", low, high)
    least, largest = (value / mass - gravity for value in (low, high))
    acceleration = Explanation(f"{phrase} {least:.0f} to {largest:.0f} m/s²", least, largest)
    return [
        ComparedValue(printed("type1.max_force"), high, by="IMPACT", explanations=(force,)),
        ComparedValue(
            printed("type1.max_acceleration"),
            float(impacts["max_acceleration_m_s2"][0]),
            by="IMPACT",
            explanations=(acceleration,),
        ),
    ]


def _accelerations(runs: Runs) -> list[ComparedValue]:
    """Return the accelerations F/m - g that follow from the printed forces; in Types 2
    and 3 m is the mass of a mesh.
    """
    problem = runs.problem("type1-variable")
    mass = float(problem.sphere.mass)
    gravity = float(problem.gravity)
    rows = []
    for kind in (1, 2, 3):
        force = printed(f"type{kind}.max_force")
        explanations: tuple[Explanation, ...] = ()
        if kind > 1:
            other = 5 - kind  # the mass implied by the same type would always fit
            least, most = mesh_mass(other, gravity)
            reason = (
                f"the mesh has lost a little mass: it has the mass implied by Type {other}, "
                f"{least:.7f} to {most:.7f} kg"
            )
            explanations = (
                Explanation(reason, force.value / most - gravity, force.value / least - gravity),
            )
        value = printed(f"type{kind}.max_acceleration")
        rows.append(
            ComparedValue(
                value,
                force.value / mass - gravity,
                by="the printed force over the mass, less gravity",
                explanations=explanations,
                made_by=Kind.ARITHMETIC,
            )
        )
    return rows


def _statements(runs: Runs) -> TextTable:
    """Return the qualitative statements of section 5.1, and whether each holds under each
    treatment.
    """
    said = (
        "Five impacts of Types 2 and 3 take less time than the first two of Type 1",
        "The first force is weaker in Type 2 than in Type 3",
        "The first rebound is higher in Type 2 than in Type 3",
        "From the second impact on the force is larger in Type 2 than in Type 3",
    )
    statements = [_statements_under(runs, treatment) for treatment in TREATMENTS]
    return TextTable(
        ("Statement", *TREATMENTS),
        tuple(zip(said, *statements, strict=True)),
        "Qualitative statements of the paper",
    )


def _statements_under(runs: Runs, treatment: str) -> list[str]:
    """Return for each statement whether it holds under a treatment, with the numbers."""
    two, three = (runs.treated(kind, treatment).impacts for kind in (2, 3))
    second = float(runs.response("type1-variable").impacts["time_s"][1])
    fifth = two["time_s"][-1]
    other = three["time_s"][-1]
    height = two["rebound_height_m"][0]
    lower = three["rebound_height_m"][0]
    forces = [
        f"{force:.0f} and {another:.0f} N"
        for force, another in zip(two["max_force_N"], three["max_force_N"], strict=True)
    ]
    more = two["max_force_N"] - three["max_force_N"]
    return [
        f"{holds_text(max(fifth, other) < second)}: {fifth:.3f} and {other:.3f} s, beside "
        f"{second:.3f} s",
        f"{holds_text(more[0] < 0.0)}: {forces[0]}",
        f"{holds_text(height > lower)}: {height:.3f} and {lower:.3f} m",
        f"{holds_text(all(more[1:] > 0.0))}: {', '.join(forces[1:])}",
    ]


def section_5_2(runs: Runs) -> ReportSection:
    """Return section 5.2: the energies of the sphere in the first impact."""
    rows: list[ComparedValue] = []
    for kind in (2, 3):
        rows += [_at_touch(runs, kind), *_released(runs, kind), _from_height(runs, kind)]
        rows += values_by_treatment(
            runs, kind, printed(f"type{kind}.energy_at_separation"), energy_at_separation
        )
        rows += [
            _percentage(kind, "energy_left", "energy_at_separation"),
            _percentage(kind, "strain_part", "strain_energy"),
        ]
        unresolved = unresolved_range(runs, kind, "sphere_strain_J")
        rows += values_by_treatment(
            runs, kind, printed(f"type{kind}.strain_energy"), largest_of(sphere_strain), unresolved
        )
        rows += values_by_treatment(
            runs, kind, printed(f"type{kind}.rotational_energy"), largest_of(sphere_rotation)
        )
    return ReportSection(
        "Section 5.2: the energy of the sphere",
        (
            "The printed values are compared with the other printed numbers, which "
            "indicates how they were obtained, and with the three "
            "treatments. The strain energy is that of the modes, as a multibody program "
            "reports it, and in the identified treatment "
            "that of the spring that represents the sphere; in the consistent one the "
            "contact law contains most of the sphere's strain "
            "energy. Without friction a sphere that strikes the centre of a plate along the "
            "normal does not rotate.",
        ),
        tuple(rows),
        conclusion=(_force_and_fall(runs),),
    )


def _force_and_fall(runs: Runs) -> str:
    """Return the sentence on the contradiction between the printed force and the printed
    energies of Type 2.
    """
    problem = runs.problem("type1-variable")
    force = printed("type2.max_force").value
    law = problem.laws[0]
    assert isinstance(law, AdamsImpact)
    speed = float(runs.response("type1-variable").impacts["approach_speed_m_s"][0])
    least = 1e3 * ((force - float(law.damping_max) * speed) / float(law.stiffness)) ** (
        1.0 / float(law.exponent)
    )
    deep = 1e3 * fall_beyond_touch(2, float(problem.gravity))
    lower_bound = math.floor(100.0 * least) / 100.0
    return (
        f"The energies printed for Type 2 imply a fall of {deep:.2f} mm beyond first "
        f"touch. IMPACT gives the printed {force:g} N at no "
        f"indentation of less than {lower_bound:.2f} mm, even at the full approach speed "
        "and the full damping: the two are contradictory."
    )


def _fall(runs: Runs) -> tuple[float, float, float]:
    """Return the mass of the sphere [kg], gravity [m/s^2] and the drop height to first
    touch [m].
    """
    problem = runs.problem("type1-variable")
    assert problem.height is not None
    return (
        float(problem.sphere.mass),
        float(problem.gravity),
        float(problem.height) - float(problem.sphere.contact_offset),
    )


def _at_touch(runs: Runs, kind: int) -> ComparedValue:
    """Return the energy released by the fall to first touch."""
    mass, gravity, fall = _fall(runs)
    sag = _sag(runs.problem(f"type{kind}-superposed"))
    least, most = (weight * gravity * fall for weight in mesh_mass(kind, gravity))
    most *= 1.0 + sag / fall
    lower = ""
    if sag:
        lower = f", and a static deflection of the plate by up to {1e6 * sag:.1f} µm"
    phrase = (
        f"with the mass of the mesh that the printed force and acceleration imply{lower}: "
        f"{least:.6f} to {most:.6f} J"
    )
    explanation = Explanation(phrase, least, most)
    by = f"m g times the fall of {fall:g} m"
    return ComparedValue(
        printed(f"type{kind}.energy_at_touch"),
        mass * gravity * fall,
        by=by,
        explanations=(explanation,),
    )


def _sag(problem: Problem) -> float:
    """Return the static deflection of the plate at the contact point under its own weight
    [m]; zero for a rigid plate.
    """
    modes = problem.plate.modes
    if modes is None:
        return 0.0
    # gravity acts on a mode by its participation, and a mode of unit mass has the stiffness omega^2
    by_gravity = modes.contact * modes.participation[:, 2] / modes.angular_frequencies**2
    return float(problem.gravity * by_gravity.sum())


def _released(runs: Runs, kind: int) -> list[ComparedValue]:
    """Return the potential energy released down to the lowest point, under each treatment."""
    mass, gravity, fall = _fall(runs)
    value = printed(f"type{kind}.potential_energy")
    deep = 1e3 * fall_beyond_touch(kind, gravity)
    rows = []
    for treatment in TREATMENTS:
        released = energy_released(runs.treated(kind, treatment))
        beyond = 1e3 * (released / (mass * gravity) - fall)
        why = (
            f"the printed energies imply a fall of {deep:.2f} mm beyond first touch, the "
            f"computed fall is {beyond:.2f} mm"
        )
        rows.append(
            ComparedValue(value, released, by=treatment, otherwise=why, made_by=kind_of(treatment))
        )
    return rows


def _from_height(runs: Runs, kind: int) -> ComparedValue:
    """Return the energy at separation that follows from the printed rebound height."""
    mass, gravity, _ = _fall(runs)
    height = printed(f"type{kind}.rebound_height").value
    radius = float(runs.problem("type1-variable").sphere.contact_offset)
    response = runs.treated(kind, "identified")
    # at separation the sphere is below its height at touch, and climbs that far on top of the rise
    rise = float(response.impacts["rebound_height_m"][0] - radius)
    climbed = energy_at_separation(response) - mass * gravity * rise
    least_mass, _ = mesh_mass(kind, gravity)
    low = least_mass * gravity * (height - radius)
    high = mass * gravity * (height - radius) + climbed
    reason = (
        "the mesh has lost a little mass, and the sphere separates while it is still "
        f"indented: {low:.5f} to {high:.5f} J"
    )
    value = printed(f"type{kind}.energy_at_separation")
    return ComparedValue(
        value,
        mass * gravity * (height - radius),
        by="m g times the printed rebound",
        explanations=(Explanation(reason, low, high),),
        made_by=Kind.ARITHMETIC,
    )


def _percentage(kind: int, part: str, of: str) -> ComparedValue:
    """Return a printed percentage with the ratio of the two printed energies that define it."""
    over = printed(f"type{kind}.{of}")
    under = printed(f"type{kind}.potential_energy")
    ratio = 100.0 * over.value / under.value
    why = f"{over.text} J of {under.text} J are {ratio:.2f} %: a misprint"
    return ComparedValue(
        printed(f"type{kind}.{part}"),
        ratio,
        by="the printed energies",
        otherwise=why,
        made_by=Kind.ARITHMETIC,
    )


_PLATE_COLUMNS = {
    "displacement": "plate_displacement_m",
    "velocity": "plate_velocity_m_s",
    "acceleration": "plate_acceleration_m_s2",
    "kinetic_energy": "plate_kinetic_J",
    "strain_energy": "plate_strain_J",
    "potential_energy": "plate_potential_J",
}
"""Printed quantities of the plate, and their columns in the history."""


def section_5_3(runs: Runs) -> ReportSection:
    """Return section 5.3: the peaks of the plate's motion and energies."""
    rows: list[ComparedValue] = [_impact_speed(runs)]
    for name, column in _PLATE_COLUMNS.items():
        unresolved = None
        if column in PEAKS:
            unresolved = unresolved_range(runs, 3, column)
        rows += values_by_treatment(
            runs, 3, printed(f"plate.{name}"), largest_of(history_column(column)), unresolved
        )
    rows += values_by_treatment(
        runs,
        3,
        printed("plate.acceleration.5"),
        lambda response: float(
            after_each_impact(history_column(_PLATE_COLUMNS["acceleration"]))(response)[4]
        ),
    )
    rows += _plate_percentages()
    rows += values_by_treatment(runs, 3, printed("plate.energy_part"), plate_energy_part)
    table, phrase = _peak_decay(runs)
    return ReportSection(
        "Section 5.3: the vibration of the plate",
        ("Peaks of the whole run, of the plate's centre of mass and of its energies.",),
        tuple(rows),
        (table,),
        (phrase,),
    )


def _impact_speed(runs: Runs) -> ComparedValue:
    problem = runs.problem("type1-variable")
    assert problem.height is not None
    whole = float(np.sqrt(2.0 * problem.gravity * problem.height))
    explanation = Explanation(
        f"a fall of the full {float(problem.height):g} m, of the centre down to the plate "
        f"instead of to first touch: {whole:.3f} m/s",
        whole,
        whole,
    )
    speed = float(runs.response("type1-variable").impacts["approach_speed_m_s"][0])
    return ComparedValue(
        printed("impact_speed"), speed, by="the fall to first touch", explanations=(explanation,)
    )


def _plate_percentages() -> list[ComparedValue]:
    """Return the printed percentages with the ratios of the printed numbers that define them."""
    released = printed("type3.potential_energy")
    thickness = printed("plate.size.3")
    kinetic, strain = (printed(f"plate.{name}_energy") for name in ("kinetic", "strain"))
    parts = {
        "plate.displacement_part": (
            printed("plate.displacement").value / (1e-3 * thickness.value),
            "the printed displacement and thickness",
        ),
        "plate.kinetic_part": (kinetic.value / released.value, "the printed energies"),
        "plate.strain_part": (strain.value / released.value, "the printed energies"),
        "plate.energy_part": (
            (kinetic.value + strain.value) / released.value,
            "the printed energies",
        ),
    }
    return [
        ComparedValue(printed(name), 100.0 * part, by=by, made_by=Kind.ARITHMETIC)
        for name, (part, by) in parts.items()
    ]


def _peak_decay(runs: Runs) -> tuple[TextTable, str]:
    """Return the decay of the peaks over the impacts, and the sentence whether the
    acceleration decays most slowly, as printed.
    """
    cells = []
    slowest = []
    for treatment in TREATMENTS:
        response = runs.treated(3, treatment)
        remaining = {}
        for name in ("displacement", "velocity", "acceleration"):
            peaks = after_each_impact(history_column(_PLATE_COLUMNS[name]))(response)
            cells.append((treatment, name, *(f"{100.0 * peak / peaks[0]:.2f}" for peak in peaks)))
            remaining[name] = float(peaks[-1] / peaks[0])
        if remaining["acceleration"] == max(remaining.values()):
            slowest.append(treatment)
    headers = (
        "Treatment",
        "Peak of the plate's centre of mass",
        *(f"Impact {number} [%]" for number in IMPACTS),
    )
    if slowest:
        where = f"this holds in these treatments: {', '.join(slowest)}"
    else:
        where = "this holds in none of the three treatments"
    phrase = (
        "The paper states that from impact to impact the acceleration of the plate's centre "
        "of mass decreases more slowly than its "
        f"displacement and velocity: {where}."
    )
    return TextTable(
        headers, tuple(cells), "Peaks after each impact, relative to those after the first"
    ), phrase
