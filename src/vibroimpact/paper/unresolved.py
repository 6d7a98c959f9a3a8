"""The section on inferences about Types 2 and 3: whether the printed values are those of
an unresolved run.
"""

from __future__ import annotations

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.paper.derived import fall_beyond_touch, mesh_mass
from vibroimpact.paper.implicit_euler import ENERGY_SHARES, unresolved_impact
from vibroimpact.paper.measures import MESH_DIGITS
from vibroimpact.paper.printed import printed
from vibroimpact.paper.report_section import (
    ComparedValue,
    Explanation,
    Kind,
    ReportSection,
    TextTable,
    Verdict,
)
from vibroimpact.paper.runs import Runs
from vibroimpact.paper.sampling import output_step
from vibroimpact.paper.step_sweep import (
    COMPARED,
    MESHES,
    MODES,
    PHASES,
    StepSweep,
    closest,
    coarse,
    paper_impact,
    resolved_impact,
    superposed,
    sweep_steps,
)

SPHERE_COLUMNS = {
    "max_force": "max_force_N",
    "rebound_height": "rebound_height_m",
    "strain_energy": "sphere_strain_J",
}
"""Printed quantities of the sphere in the first impact, and their names in a run."""

PLATE_COLUMNS = {
    "plate.kinetic_energy": "plate_kinetic_J",
    "plate.strain_energy": "plate_strain_J",
    "plate.displacement": "plate_displacement_m",
    "plate.velocity": "plate_velocity_m_s",
    "plate.acceleration": "plate_acceleration_m_s2",
}
"""Printed quantities of the plate, and their names in a run."""

_COLUMNS = {
    f"type{kind}.{name}": column for kind in (2, 3) for name, column in SPHERE_COLUMNS.items()
} | PLATE_COLUMNS

_SHARE_HEADINGS = (
    "motion",
    "height",
    "vibration",
    "lost in the contact",
    "lost in the modes",
    "lost by the method",
)


def unresolved_range(runs: Runs, kind: int, quantity: str) -> tuple[float, float]:
    """Return the range of a quantity in unresolved runs with the step fitted to Type 2, over the
    phases of the touch in a step.

    The sphere has the coarse mesh, with all modes that are computed for it.

    Parameters
    ----------
    runs : Runs
        The simulations.
    kind : int
        2 or 3.
    quantity : str
        One of `implicit_euler.PEAKS`, "separation_speed_m_s" or "rebound_height_m".
    """
    values = _fitted_step(runs, kind)[1][quantity]
    return float(values.min()), float(values.max())


def unresolved_section(runs: Runs) -> ReportSection:
    """Return the section that compares unresolved runs of the superposed model with the
    printed Types 2 and 3.
    """
    rows = _compared_values(runs)
    return ReportSection(
        "Types 2 and 3: what an unresolved run gives",
        (_resolved_words(runs), _method_words(runs), _reading_words(runs)),
        rows,
        (_mesh_table(runs), _modes_table(runs), _energy_table(runs), _plate_table(runs)),
        (
            _fit_words(runs),
            _prediction_words(runs, rows),
            _counter_evidence(runs),
            _outcome(runs, rows),
        ),
    )


def _compared_values(runs: Runs) -> tuple[ComparedValue, ...]:
    """Return the values of Type 2, to which the step was fitted, and of Type 3, predicted
    with the same step.
    """
    rows = []
    for kind in (2, 3):
        step, results = _fitted_step(runs, kind)
        names = [f"type{kind}.{name}" for name in SPHERE_COLUMNS]
        if kind == 3:
            names += PLATE_COLUMNS
        rows += [_compared_value(name, kind, step, results[_COLUMNS[name]]) for name in names]
    return tuple(rows)


def _compared_value(name: str, kind: int, step: float, values: Floats) -> ComparedValue:
    """Return a printed value beside those of unresolved runs, over the phases."""
    low = float(values.min())
    high = float(values.max())
    gives = f"an unresolved run gives {low:.4g} to {high:.4g} {printed(name).unit}"
    reason = f"a hypothesis: {gives}, depending on where in a step the surfaces meet"
    source = "fitted" if kind == 2 else "step from Type 2"
    return ComparedValue(
        printed(name),
        float(np.median(values)),
        by=f"implicit Euler, {_microseconds(step)} µs, {source}",
        explanations=(Explanation(reason, low, high),),
        otherwise=f"{gives}, wherever in a step the surfaces meet",
        fitted=kind == 2,
        digits=MESH_DIGITS,
        made_by=Kind.FITTED_MODEL,
    )


def _resolved_words(runs: Runs) -> str:
    results = []
    modes = []
    nodes = []
    compliance = []
    for mesh in ("fine", "coarse"):
        problem = superposed(runs, 2, mesh)
        results.append(_compared_text(resolved_impact(problem)))
        sphere_modes = problem.sphere.modes
        modes.append(len(sphere_modes.contact) if sphere_modes else 0)
        nodes.append(len(problem.models["sphere"].mesh.nodes))
        compliance.append(1e9 * float(problem.facts["sphere_modal_compliance_m_N"]))
    return (
        "Established: the result of the resolved model. A multibody program with flexible "
        "bodies has law and modes in series, "
        f"the superposed treatment. The first impact of Type 2 then comes to {results[0]} "
        f"with {modes[0]} modes of a fine mesh of "
        f"{nodes[0]} nodes, and to {results[1]} with {modes[1]} of the {3 * nodes[1] - 6} "
        f"modes of a coarse mesh of {nodes[1]} nodes, as "
        "many as the program computes of it (the paper has "
        f"{printed('mesh.sphere.nodes').text} nodes). It depends on the modes and the "
        f"mesh, since at a node the compliance of these modes is {compliance[0]:.3g} and "
        f"{compliance[1]:.3g} nm/N, and that of a solid "
        "under a point load is infinite. The paper prints "
        f"{_compared_text(paper_impact(runs, 2))}, the speed from the height of the "
        "rebound. According to the program's own check the coarse mesh is too coarse: "
        f"{superposed(runs, 2, 'coarse').facts['doubts']}. "
        "The printed forces and accelerations imply that the paper's own mesh has lost "
        f"{_lost_mass(runs)} of its mass, so that it would be another one."
    )


def _lost_mass(runs: Runs) -> str:
    problem = runs.problem("type1-variable")
    least_mass, _ = mesh_mass(3, float(problem.gravity))
    return _percent_text(1.0 - least_mass / float(problem.sphere.mass), 2)


def _method_words(runs: Runs) -> str:
    step, shares = _mean_shares(runs, 2)
    total = sum(shares.values())
    duration = resolved_impact(superposed(runs, 2, "coarse"))["duration_s"]
    share_texts = {
        name: f"{shares[name]:.3f} J ({100.0 * shares[name] / total:.1f} %)"
        for name in ENERGY_SHARES
    }
    return (
        "Established: an implicit method of first order, in fixed steps that are comparable "
        "with the contact, dissipates energy "
        f"numerically. In steps of {_microseconds(step)} µs, {duration / step:.1f} to the "
        "resolved contact, the method dissipates "
        f"{share_texts['integrator_J']} of the {total:.3f} J of Type 2, the damping of the "
        f"contact {share_texts['contact_dissipated_J']} and that of "
        f"the modes {share_texts['modal_damping_J']}; the sphere keeps "
        f"{share_texts['kinetic_J']}. These "
        f"are means over {len(PHASES)} places of the "
        "touch in a step, on the coarse mesh."
    )


def _reading_words(runs: Runs) -> str:
    return (
        "A hypothesis: that the paper's Types 2 and 3 are such runs. The paper states its "
        f"output steps, {1e3 * output_step():g} ms, but "
        "neither the steps of its solver nor their error control. The step is therefore "
        "fitted to the printed numbers of Type "
        "2, and its results for Type 3 are the test. Below, unresolved is the median, of "
        "each number by itself, over the places of the touch."
    )


def _fit_words(runs: Runs) -> str:
    as_printed = paper_impact(runs, 2)
    cells = [
        _best_cells(closest(superposed(runs, 2, mesh), as_printed), as_printed) for mesh in MESHES
    ]
    (coarse_step, coarse_misfit), (fine_step, fine_misfit) = cells
    return (
        f"On the coarse mesh a step of {coarse_step} µs comes closest to the three numbers of "
        f"Type 2: they are off by {coarse_misfit} % (root mean square). "
        f"On the fine mesh the best step, {fine_step} µs, leaves them off by {fine_misfit} %. "
        "With fewer modes of the coarse mesh they are off "
        "by more, as the table shows; with more it was not tried. So three settings were "
        "chosen for three numbers: the step, the mesh and the number of modes."
    )


def _best_cells(sweep: StepSweep, as_printed: dict[str, float]) -> tuple[str, str]:
    """Return a step [µs] and its misfit [%]."""
    misfit = float(sweep.misfit(as_printed)[0])
    return _microseconds(float(sweep.steps[0])), f"{100.0 * misfit:.1f}"


def _modes_table(runs: Runs) -> TextTable:
    as_printed = paper_impact(runs, 2)
    cells = []
    for modes in MODES:
        problem = coarse(2, modes)
        resolved = _compared_cells(resolved_impact(problem))
        best = _best_cells(closest(problem, as_printed), as_printed)
        cells.append((str(modes), *resolved, *best))
    headers = (
        "modes",
        "force, resolved [N]",
        "speed [m/s]",
        "strain energy [J]",
        "best step [µs]",
        "misfit [%]",
    )
    return TextTable(headers, tuple(cells), "Type 2 on the coarse mesh, by the number of its modes")


def _prediction_words(runs: Runs, rows: tuple[ComparedValue, ...]) -> str:
    predicted = [row for row in rows if not row.fitted]
    met = [row for row in predicted if _is_met(row)]
    missed = [row for row in predicted if not _is_met(row)]
    resolved = resolved_impact(superposed(runs, 3, "coarse"))
    met_by_resolved = [
        row
        for row in met
        if abs(resolved[_COLUMNS[row.printed.name]] - row.printed.value) <= row.printed.half
    ]
    weak = ""
    if met_by_resolved:
        weak = (
            " Some agree with the resolved run as well, so that they are weak evidence: "
            f"{_names_text(met_by_resolved)}."
        )
    out_of_range = [row for row in met if not row.explanations[0].contains(row.printed)]
    loose = ""
    if out_of_range:
        loose = (
            " Some lie outside their range, and agree only within their few digits: "
            f"{_names_text(out_of_range)}."
        )
    return (
        f"The same step gives Type 3, where nothing is fitted. Of the {len(predicted)} "
        f"numbers compared here, {len(met)} agree, within "
        "their digits, with the median or the range over the places of the touch: "
        f"{_differences_text(met)}. Not in agreement: {_differences_text(missed)}."
        f"{weak}{loose}"
    )


def _counter_evidence(runs: Runs) -> str:
    """Return the evidence against the hypothesis."""
    step, type3 = _fitted_step(runs, 3)
    _, type2 = _fitted_step(runs, 2)
    force_increase = type3["max_force_N"] / type2["max_force_N"] - 1.0
    as_printed = printed("type3.max_force").value / printed("type2.max_force").value - 1.0
    gravity = float(runs.problem("type1-variable").gravity)
    printed_falls = [1e3 * fall_beyond_touch(kind, gravity) for kind in (2, 3)]
    ranges = []
    for results in (type2, type3):
        falls = 1e3 * results["beyond_touch_m"]
        ranges.append(f"{falls.min():.2f} to {falls.max():.2f} mm")
    touch_at_end = unresolved_impact(superposed(runs, 3, "coarse"), step, np.ones(1))
    differences = [
        _more_text(float(touch_at_end[column][0]) / printed(f"type3.{name}").value - 1.0)
        for name, column in SPHERE_COLUMNS.items()
    ]
    return (
        "Evidence against the hypothesis: with the touch at the same place in a step, the "
        "largest force of Type 3 is between "
        f"{_more_text(float(force_increase.min()))} and "
        f"{_more_text(float(force_increase.max()))} than that "
        "of Type 2; as printed, it is "
        f"{_more_text(as_printed)}. The energies printed at first touch are those of the "
        "fall to touch with the mass of the mesh, to some "
        "1e-5 J, in both types: of a touch at the end of a step, unless they were "
        "calculated by hand. With the touch there, Type 3 has "
        f"{differences[0]} force, {differences[1]} rebound height and {differences[2]} "
        "strain energy than printed. And the printed energies imply a fall of "
        f"{printed_falls[0]:.2f} and {printed_falls[1]:.2f} mm beyond touch in Types 2 and 3, "
        f"where unresolved runs give {ranges[0]} and {ranges[1]}, and the three treatments, "
        "which are resolved, more."
    )


def _outcome(runs: Runs, rows: tuple[ComparedValue, ...]) -> str:
    faster = (
        resolved_impact(superposed(runs, 2, "coarse"))["separation_speed_m_s"]
        / paper_impact(runs, 2)["separation_speed_m_s"]
    )
    counts = []
    for body, is_plate in (("sphere", False), ("plate", True)):
        predicted = [
            row
            for row in rows
            if not row.fitted and (row.printed.name in PLATE_COLUMNS) == is_plate
        ]
        met = sum(map(_is_met, predicted))
        counts.append(f"{met} of the {len(predicted)} numbers of the {body}")
    as_printed = {name: printed(f"type3.{name}").value for name in SPHERE_COLUMNS}
    _, results = _fitted_step(runs, 3)
    squares = [
        (results[column] / as_printed[name] - 1.0) ** 2 for name, column in SPHERE_COLUMNS.items()
    ]
    misfits = np.sqrt(np.mean(squares, axis=0))
    identified = runs.treated(3, "identified").impacts
    differences = [
        _more_text(float(identified[SPHERE_COLUMNS[name]][0]) / as_printed[name] - 1.0)
        for name in ("max_force", "rebound_height")
    ]
    return (
        f"So {' and '.join(counts)} in Type 3 agree with the hypothesis, each by itself; at "
        "the best place of the touch the three of the "
        f"sphere are jointly off by {_percent_text(float(misfits.min()))} (root mean "
        "square). The test is not sharp: the identified "
        "treatment, fitted to force and rebound of Type 2, comes near those of Type 3 as "
        f"well (force {differences[0]}, rebound height "
        f"{differences[1]}). This shows that an unresolved run of a model whose resolved "
        f"rebound is {faster:.1f} times as fast can agree "
        "approximately with the printed numbers. It is not a proof: "
        "other settings may agree as well."
    )


def _mesh_table(runs: Runs) -> TextTable:
    cells = []
    for kind in (2, 3):
        as_printed = paper_impact(runs, kind)
        cells.append((f"{kind}", "printed", "", *_compared_cells(as_printed), ""))
        for mesh in MESHES:
            problem = superposed(runs, kind, mesh)
            resolved = _compared_cells(resolved_impact(problem))
            cells.append((f"{kind}", f"{mesh} mesh, resolved", "", *resolved, ""))
            step = float(closest(superposed(runs, 2, mesh), paper_impact(runs, 2)).steps[0])
            sweep = sweep_steps(problem, (step,))
            medians = {name: float(sweep.median(name)[0]) for name in COMPARED}
            misfit = f"{100.0 * sweep.misfit(as_printed)[0]:.1f}"
            unresolved = (_microseconds(step), *_compared_cells(medians), misfit)
            cells.append((f"{kind}", f"{mesh} mesh, unresolved", *unresolved))
    headers = (
        "Type",
        "run",
        "step [µs]",
        "largest force [N]",
        "rebound speed [m/s]",
        "strain energy of the sphere [J]",
        "misfit [%]",
    )
    return TextTable(
        headers,
        tuple(cells),
        "The first impact, resolved and in the steps that come closest to Type 2",
    )


def _energy_table(runs: Runs) -> TextTable:
    cells = []
    for kind in (2, 3):
        _, mean_shares = _mean_shares(runs, kind)
        shares_of = {
            "resolved": resolved_impact(superposed(runs, kind, "coarse")),
            "unresolved": mean_shares,
        }
        for name, shares in shares_of.items():
            # 0.0 is added to turn -0 into 0
            texts = [f"{round(shares[share], 4) + 0.0:.4f}" for share in ENERGY_SHARES]
            cells.append((f"{kind}", name, *texts))
    title = (
        "Where the energy of the touch is at separation [J] (coarse mesh; unresolved: means "
        "over the places of the touch)"
    )
    return TextTable(("Type", "run", *_SHARE_HEADINGS), tuple(cells), title)


def _plate_table(runs: Runs) -> TextTable:
    _, results = _fitted_step(runs, 3)
    resolved = resolved_impact(superposed(runs, 3, "coarse"))
    cells = []
    for name, column in PLATE_COLUMNS.items():
        value = printed(name)
        values = results[column]
        cells.append(
            (
                f"{value.what} [{value.unit}]",
                value.text,
                f"{np.median(values):.4g}",
                f"{values.min():.4g} to {values.max():.4g}",
                f"{resolved[column]:.4g}",
            )
        )
    return TextTable(
        ("quantity", "printed", "unresolved", "range", "resolved"),
        tuple(cells),
        "The plate of Type 3 (coarse mesh of the sphere)",
    )


def _fitted_step(runs: Runs, kind: int) -> tuple[float, dict[str, Floats]]:
    """Return the step fitted to Type 2 on the coarse mesh [s], and the results for Type 2
    or 3 with it, over the phases.
    """
    step = float(closest(superposed(runs, 2, "coarse"), paper_impact(runs, 2)).steps[0])
    sweep = sweep_steps(superposed(runs, kind, "coarse"), (step,))
    return step, {name: values[0] for name, values in sweep.found.items()}


def _mean_shares(runs: Runs, kind: int) -> tuple[float, dict[str, float]]:
    """Return the fitted step [s] and the energy shares at separation [J]: means over the
    phases, since medians do not add up.
    """
    step, results = _fitted_step(runs, kind)
    return step, {name: float(results[name].mean()) for name in ENERGY_SHARES}


def _compared_text(values: dict[str, float]) -> str:
    force, speed, strain = _compared_cells(values)
    return f"{force} N, {speed} m/s and {strain} J of strain energy in the sphere"


def _compared_cells(values: dict[str, float]) -> tuple[str, ...]:
    force, speed, strain = (values[name] for name in COMPARED)
    return f"{force:.0f}", f"{speed:.3f}", f"{strain:.4g}"


def _is_met(row: ComparedValue) -> bool:
    return row.verdict is not Verdict.NOT_REPRODUCED


def _differences_text(rows: list[ComparedValue]) -> str:
    """Return the quantities of compared values with their differences."""
    return "; ".join(f"{row.printed.what} ({_more_text(row.difference)})" for row in rows) or "none"


def _names_text(rows: list[ComparedValue]) -> str:
    return "; ".join(row.printed.what for row in rows)


def _percent_text(part: float, decimals: int = 1) -> str:
    return f"{100.0 * part:.{decimals}f} %"


def _more_text(part: float) -> str:
    direction = "more" if part > 0.0 else "less"
    return f"{_percent_text(abs(part))} {direction}"


def _microseconds(step: float) -> str:
    return f"{1e6 * step:.0f}"
