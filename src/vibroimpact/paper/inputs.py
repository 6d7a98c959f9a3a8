"""The sections on the inputs: Table 1, contact parameters (section 3.1), meshes (section
4), and the corrections of the paper.
"""

from __future__ import annotations

from typing import Any

from vibroimpact.cases.build import resolved_case
from vibroimpact.cases.reader import load_case
from vibroimpact.cases.rigid.pair import contact_pair
from vibroimpact.contact.laws.adams_impact import AdamsImpact
from vibroimpact.dynamics.simulate import simulate
from vibroimpact.paper.printed import corrections, printed
from vibroimpact.paper.report_section import ComparedValue, ReportSection, TextTable
from vibroimpact.paper.runs import Runs, with_law


def table1(runs: Runs) -> ReportSection:
    """Return the section that compares Table 1 with the shipped case of Type 3, which has
    all of its inputs.
    """
    case = resolved_case(load_case("paper:type3"))
    sphere = case["sphere"]
    plate = case["plate"]
    drop = case["drop"]
    bodies = (("sphere", sphere["material"]), ("plate", plate["material"]))
    values: dict[str, Any] = {
        f"{body}.{name}": material[name] for body, material in bodies for name in _MATERIAL
    }
    values["sphere.radius"] = 1e3 * sphere["radius"]
    values |= {
        f"plate.size.{number}": 1e3 * length for number, length in enumerate(plate["size"], start=1)
    }
    values |= {
        f"plate.spacing.{number}": 1e3 * length
        for number, length in enumerate(plate["supports"][0]["spacing"], start=1)
    }
    values |= {"gravity": drop["gravity"], "drop.height": drop["height"]}
    return ReportSection(
        "Table 1: the inputs",
        ("The inputs of the shipped case of Type 3, compared with the printed ones.",),
        tuple(
            ComparedValue(printed(name), value, by="the shipped case")
            for name, value in values.items()
        ),
    )


_MATERIAL = ("density", "youngs_modulus", "poissons_ratio")


def section_3_1(runs: Runs) -> ReportSection:
    """Return the section that compares the contact parameters with Hertz's theory and the
    shipped cases.
    """
    problem = runs.problem("type1-variable")
    thin = printed("full_damping_penetration")
    law = problem.laws[0]
    assert isinstance(law, AdamsImpact)
    rebound = simulate(with_law(problem, full_damping_penetration=thin.value)).impacts[
        "rebound_height_m"
    ][0]
    return ReportSection(
        "Section 3.1: the contact",
        (
            "IMPACT, the contact of Adams, is Hertz's spring and a dashpot whose damping "
            "increases with the indentation up to the "
            "full-damping penetration. The stiffness follows from the corrected equations "
            "(3) and (4); the full-damping penetration is not the one printed.",
        ),
        (
            ComparedValue(
                printed("stiffness"),
                float(contact_pair(load_case("paper:type1-variable")).hertz_stiffness),
                by="Hertz",
            ),
            ComparedValue(printed("exponent"), float(law.exponent), by="Hertz"),
            ComparedValue(
                thin,
                float(law.full_damping_penetration),
                by="the shipped case",
                otherwise=f"with the printed one the first rebound would be {rebound:.5f} m, and "
                f"{printed('type1.rebound_height').text} m is printed",
            ),
        ),
    )


def section_4(runs: Runs) -> ReportSection:
    """Return the section that compares the meshes with those of the paper."""
    sphere, plate = (runs.problem("type3").models[body].mesh for body in ("sphere", "plate"))
    counts = {
        "mesh.sphere.nodes": len(sphere.nodes),
        "mesh.sphere.elements": sphere.number_of_elements,
        "mesh.plate.elements": plate.number_of_elements,
    }
    return ReportSection(
        "Section 4: the meshes",
        (
            "The meshes of the paper are not available; it gives the sphere "
            f"{printed('mesh.sphere.nodes').text} and "
            f"{printed('mesh.sphere.elements').text} grids, which are taken for nodes and "
            "elements. Here the plate has plate elements of "
            "order four, and the sphere curved bricks of second order; the errors of their "
            "frequencies are estimated in each run, and "
            "stated where they exceed 0.5 %. The superposed treatment depends on the mesh "
            "in any case, as the section on inferences shows.",
        ),
        tuple(
            ComparedValue(
                printed(name), float(count), by="the shipped case", otherwise="a mesh of our own"
            )
            for name, count in counts.items()
        ),
    )


def corrections_section(runs: Runs) -> ReportSection:
    """Return the section that lists the corrections on which all other sections build."""
    cells = tuple((item.place, item.printed, item.right, item.why) for item in corrections())
    return ReportSection(
        "Misprints and omissions of the paper",
        ("Everything above was computed with these corrections.",),
        tables=(TextTable(("Place", "Printed", "Correct", "Evidence"), cells),),
    )
