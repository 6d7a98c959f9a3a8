"""Text on how the deformation of the bodies is modelled: a sentence, and a table of
compliances and estimated errors.
"""

from __future__ import annotations

import math
from typing import Any

from vibroimpact.cases.validity.plate_mesh import plate_mesh_error
from vibroimpact.cases.validity.plate_waves import plate_theory_error
from vibroimpact.results.result import Result
from vibroimpact.units.display import digits, fixed, text

_SENTENCES = {
    "superposed": (
        "Superposed: the contact law and the modes of the bodies are in series, as in a "
        "multibody program with flexible bodies. Where a "
        "body has a solid mesh, as an elastic sphere does, the local indentation that its "
        "modes contain is counted twice."
    ),
    "identified": (
        "Identified: a spring and a dashpot in parallel, in series with the contact law, "
        "represent the deformation of the sphere; they "
        "were fitted to a measured impact or given, and are not material properties."
    ),
}


def treatment_sentence(result: Result) -> str:
    """Return a sentence on the treatment of local indentation; empty if the result states none."""
    treatment = str(result.deformation.get("treatment", ""))
    if treatment == "consistent":
        return _consistent_sentence(result)
    return _SENTENCES.get(treatment, "")


def _consistent_sentence(result: Result) -> str:
    """Return what the law contains and what is added to it, of the bodies that are elastic."""
    clauses = ["the contact law contains the local deformation"]
    if "sphere_modal_compliance_m_N" in result.deformation:
        clauses = [
            "the contact law contains the local and the quasi-static deformation of the sphere, "
            "and modes of the sphere add only the dynamic part"
        ]
    if "plate_static_compliance_m_N" in result.deformation:
        clauses.append(
            "the static compliance that the modes of the plate lack is in series with the law"
        )
    return f"Consistent: {'; '.join(clauses)}. No compliance is counted twice."


def counted_twice(result: Result) -> float:
    """Return the ratio of the sphere's modal compliance to the secant compliance of the contact law
    in impact 1.

    It is the part of local indentation counted twice with superposed compliances; NaN for other
    treatments or without an impact.
    """
    modal = result.deformation.get("sphere_modal_compliance_m_N")
    if (
        result.deformation.get("treatment") != "superposed"
        or modal is None
        or not len(result.impacts["impact"])
    ):
        return math.nan
    return (
        float(modal)
        * float(result.impacts["max_force_N"][0])
        / float(result.impacts["max_indentation_m"][0])
    )


def deformation_rows(result: Result) -> list[tuple[str, str]]:
    """Return the rows of a table on deformation: description, and value with unit."""
    facts = result.deformation
    rows = []
    of_modes = "Compliance of the plate's modes"
    if "plate_static_compliance_m_N" in facts:
        of_modes = "Part of it in the modes kept"
    for name, phrase in (
        (
            "plate_static_compliance_m_N",
            "Static compliance of the plate at the contact point, without rigid-body motion "
            "and local indentation",
        ),
        ("plate_modal_compliance_m_N", of_modes),
        ("sphere_modal_compliance_m_N", "Quasi-static compliance of the sphere's modes"),
        (
            "series_compliance_m_N",
            "Compliance in series with the law, so that each part is "
            "counted once; negative if subtracted",
        ),
    ):
        if name in facts:
            rows.append((phrase, f"{digits(float(facts[name]) / 1e-9)}\u00a0nm/N"))
    if not math.isnan(twice := counted_twice(result)):
        rows.append(
            (
                "Counted twice, relative to the law's own indentation over force in impact 1",
                f"{fixed(100.0 * twice, 1)}\u00a0%",
            )
        )
    if "finite_sphere_factor" in facts:
        factor = digits(float(facts["finite_sphere_factor"]))
        rows.append(
            (
                "Correction of the approach for a sphere instead of a half-space, c F/(E R)",
                f"c\u00a0=\u00a0{factor}",
            )
        )
    if "contact_patch_m" in facts:
        rows.append(
            (
                "Radius of the contact patch over which the sphere's modes are averaged",
                text(float(facts["contact_patch_m"]), "m"),
            )
        )
    rows += _local_element(result)
    for body, part in result.truncation.items():
        if math.isfinite(part):
            rows.append(
                (
                    f"Estimated error of the largest force due to the modes of the {body} left out",
                    f"{digits(100.0 * part, 2)}\u00a0%",
                )
            )
    for phrase, error in (
        ("the mesh of the plate", plate_mesh_error),
        ("the limits of plate elements", plate_theory_error),
    ):
        if math.isfinite(part := error(facts, result.impacts)):
            rows.append(
                (
                    f"Estimated error of the largest force due to {phrase}",
                    f"{digits(100.0 * part, 2)}\u00a0%",
                )
            )
    return rows


def _local_element(result: Result) -> list[tuple[str, str]]:
    """Return rows of stiffness and damping of the local element, identified or given in
    the case; empty without one.
    """
    contact = result.case.get("contact", {})
    facts = result.deformation
    stiffness = facts.get("local_stiffness_N_m", contact.get("local_stiffness"))
    damping = facts.get("local_damping_N_s_m", contact.get("local_damping"))
    if stiffness is None or damping is None:
        return []
    stiffness_text = _with_deviation(stiffness, facts.get("local_stiffness_deviation_N_m"))
    damping_text = _with_deviation(damping, facts.get("local_damping_deviation_N_s_m"))
    return [
        ("Stiffness of the local element", f"{stiffness_text}\u00a0N/m"),
        ("Damping of the local element", f"{damping_text}\u00a0N\u00a0s/m"),
    ]


def _with_deviation(value: Any, deviation: Any) -> str:
    """Return a number and, where it is known, its standard deviation."""
    if deviation is None:
        return digits(float(value))
    return f"{digits(float(value))} ± {digits(float(deviation), 2)}"
