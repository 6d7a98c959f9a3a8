"""The section on the restitution and the full-damping penetration: what each printed number implies, in words and tables."""

from __future__ import annotations

import math

from vibroimpact.paper.evidence import PENETRATIONS, RESTITUTIONS
from vibroimpact.paper.printed import printed
from vibroimpact.paper.recovery import Estimate, Recovery, penetration_bands, recover
from vibroimpact.paper.runs import Runs
from vibroimpact.paper.section import Section, Table
from vibroimpact.units.display import MISSING, fixed


def recovery(runs: Runs) -> Section:
    """Return the section on the restitution and the full-damping penetration.

    Parameters
    ----------
    runs : Runs
        The cases.
    """
    found = recover(runs)
    return Section(
        title="The restitution and the full-damping penetration, from the paper's own numbers",
        words=(
            "The restitution e_h that the theory needs is nowhere printed, and the full-damping penetration d_max is printed as "
            f"{printed('full_damping_penetration').text} m. Both follow from the other printed numbers. The table gives what each piece of "
            "evidence implies with the other value held at the joint estimate: as far as rounding allows, or with the standard deviation "
            "that its own residuals show.",
            "The damping function is the least-squares parabola through the printed dampings at the approach speeds of the simulation "
            "with variable damping, as section 3.2 says, and not at those of the theory: the second table shows it. So it fixes d_max by "
            "itself; at the speeds of the theory it only tells once more that the rebounds match, and does not count. Nor do the errors of "
            "Table 2: they look as if they were read off samples, and then missed peaks pull them to one side.",
        ),
        tables=(_implied(found), _coefficients(found)),
        conclusion=(
            _of_joint(found),
            _of_printed(found),
            _of_round_values(found, runs),
            "Established: with Lankarani and Nikravesh's law as the theory, and with the printed dampings in IMPACT clipped at zero, the "
            "printed numbers are those of these two values. A reading: that the authors typed in the round ones.",
        ),
    )


def _implied(found: Recovery) -> Table:
    """Return what each piece of evidence implies, and all that counts."""
    cells = []
    for one in found.evidence:
        by, through = found.alone[one.name]
        known = "rounding" if one.freedom is None else "scatter"
        cells.append((one.name, _told(by, 1.0, one.reach), _told(through, 1e3, one.reach), known, "yes" if one.joint else "no"))
    cells.append(("all that counts, jointly", _told(found.restitution), _told(found.penetration, 1e3), "standard deviations", ""))
    return Table(("evidence", "e_h [-]", "d_max [mm]", "known to within", "counts"), tuple(cells), "What each number implies")


def _coefficients(found: Recovery) -> Table:
    """Return the parabola through the printed dampings as printed, and as it is at the speeds of the simulation and of the theory."""
    cells = tuple(
        (str(power), *(fixed(value, 5) for value in (printed(f"damping_function.{power + 1}").value, *both)))
        for power, both in enumerate(zip(*found.parabolas, strict=True))
    )
    headers = ("power of v", "printed", "at the simulation's speeds, at the joint estimate", "at the theory's speeds")
    return Table(headers, cells, "Coefficients of the parabola through the printed dampings [SI]")


def _of_joint(found: Recovery) -> str:
    single = (
        f"There is no second solution between e_h = {RESTITUTIONS[0]:g} and {RESTITUTIONS[1]:g}, d_max = {1e6 * PENETRATIONS[0]:g} "
        f"and {1e6 * PENETRATIONS[1]:g} µm: the first rebound rises with d_max, and the rebounds of the theory rise with e_h, all the way."
    )
    return (
        f"Jointly e_h = {_told(found.restitution)} and d_max = {_told(found.penetration, 1e3)} mm; the largest residual is "
        f"{found.worst:.1f} standard deviations. {single if found.single else 'A second solution is not excluded.'}"
    )


def _of_printed(found: Recovery) -> str:
    given = printed("full_damping_penetration")
    met = penetration_bands(found, given.value)
    height, fourth, fifth = found.as_printed
    words = (
        f"The printed d_max, {given.text} m, is met by {sum(met) or 'none'} of the {len(met)} pieces of evidence that depend on it alone. "
        f"With it the first rebound would be {fixed(height, 4)} m (printed {printed('type1.rebound_height').text} m), "
        f"with constant damping the fourth {fixed(fourth, 1)} % too low (printed {printed('constant.height_error.4').text} %) "
        f"and the fifth compression {fixed(fifth, 1)} % too small (printed {printed('constant.compression_error.5').text} %)."
    )
    if any(met):
        return words
    own = fixed(1e3 * found.penetration.value, 4)
    return f"{words} It is a misprint: the paper's own numbers are those of {own} mm, and 0.1 mm is the default of Adams."


def _of_round_values(found: Recovery, runs: Runs) -> str:
    """Tell how the round values do, which the shipped cases have."""
    restitution, penetration = found.round_values
    rounded = {
        "type1.rebound_height": runs.response("type1-constant").impacts["rebound_height_m"][0],
        "constant.height_error.4": runs.below_theory("constant", "rebound_height_m")[3],
        "constant.compression_error.5": runs.below_theory("constant", "max_indentation_m")[4],
    }
    worst = max(abs(float(value) - printed(name).value) / printed(name).half for name, value in rounded.items())
    off = (found.restitution.value - restitution) / found.restitution.deviation
    return (
        f"At the round values, e_h = {restitution:g} and d_max = {1e3 * penetration:g} mm, the rounded numbers are off by at most "
        f"{fixed(worst, 2)} times half a unit of their last digit: {'all come' if worst <= 1.0 else 'not all come'} out as printed. The "
        f"round e_h lies {fixed(abs(off), 1)} standard deviations {'below' if off > 0.0 else 'above'} the joint estimate."
    )


def _told(estimate: Estimate | None, unit: float = 1.0, reach: float = 1.0) -> str:
    """Return an estimate with how well it is known, in as many decimals as that takes; `unit`: how many of it make one of SI."""
    if estimate is None:
        return MISSING
    value, half = unit * estimate.value, unit * reach * estimate.deviation
    decimals = max(0, 1 - math.floor(math.log10(half)))
    return f"{fixed(value, decimals)} ± {fixed(half, decimals)}"
