"""The captions of a run say what is so under it: on a lower sphere, a shaken plate, with
friction, and of a sphere that vibrates.
"""

from __future__ import annotations

from html import unescape
from typing import Any

import pytest
from rich.console import Console

import vibroimpact as vi
from vibroimpact.report.page_of_report import page_of_report
from vibroimpact.runs.captions import caption, left_out
from vibroimpact.runs.case_explained import case_explained
from vibroimpact.runs.history_charts import POSITION, history_chart
from vibroimpact.runs.setup import setup_chart

SPHERE = {"radius": "10 mm", "material": "steel"}
FALL = {"height": "0.2 m"}
TSUJI = {"law": "tsuji", "restitution": 0.7}


def run_of(**sections: Any) -> vi.Result:
    """Return the result of a drop with these sections in place of the usual ones."""
    usual = {
        "sphere": SPHERE,
        "plate": {"material": "steel"},
        "drop": FALL,
        "contact": TSUJI,
        "run": {"impacts": 1},
    }
    return vi.result_of(vi.simulate(vi.case_of({**usual, **sections})))


def words(name: str, result: vi.Result) -> str:
    """Return a caption with plain blanks."""
    return caption(name, result).replace("\u00a0", " ")


def test_a_lower_sphere_is_not_called_a_plate() -> None:
    """In the place of a plate a sphere may lie, which may be free to fly off."""
    below = {"radius": "20 mm", "material": "steel"}
    fixed = run_of(plate=below)
    free = run_of(plate={**below, "supports": "free"}, drop={"speed": "1 m/s", "gravity": 0})
    missed = run_of(plate=below, run={"duration": "0.05 s"})
    assert words("position", fixed).startswith(
        "The sphere's centre starts 200.0 mm above the lower sphere."
    )
    assert "above the initial position of the lower sphere." in words("position", free)
    assert words("position", missed).endswith(
        "; the sphere has not touched the lower sphere when the run ends."
    )
    assert words("velocity", missed) == "The sphere does not touch the lower sphere in this run."
    assert left_out(missed).startswith("The sphere does not reach the lower sphere in this run")
    assert (
        history_chart(fixed, fixed.history, POSITION, "").title
        == "Height of the sphere's centre above the lower sphere"
    )
    assert "remains in the motion of the lower sphere." in words("energy", free)
    assert "damping of the bodies" not in words("energy", free)
    # both spheres yield, and what changes by more than a tenth has two figures
    assert free.relative_errors["restitution"] > 0.1
    assert "leaves at 0.70 m/s, relative to the lower sphere: a restitution of 0.70." in words(
        "velocity", free
    )


def test_heights_over_a_shaken_plate_are_above_its_mean_position() -> None:
    """A plate that is shaken is elsewhere when the drop begins; its own motion is not
    energy that remains.
    """
    motion = {"amplitude": "1 mm", "frequency": "20 Hz", "phase": "90 deg"}
    result = run_of(plate={"material": "steel", "motion": motion})
    assert words("position", result).startswith(
        "The sphere's centre starts 200.0 mm above the mean position of the plate."
    )
    assert (
        "Rebound height is that of the sphere's centre above the mean position of the plate."
        in unescape(page_of_report(result.report))
    )
    assert "remains" not in words("energy", result)


def test_air_slows_the_motion_along_the_plate() -> None:
    """Only in a vacuum the sphere moves freely between impacts."""
    drop = {"height": "0.2 m", "velocity": ["1 m/s", 0, 0]}
    friction = {**TSUJI, "friction": {"law": "coulomb", "coefficient": 0.2}}
    assert words("along_plate", run_of(drop=drop, contact=friction)).startswith(
        "Along the plate the sphere moves freely between impacts"
    )
    through_air = run_of(drop={**drop, "air": True}, contact=friction)
    assert words("along_plate", through_air).startswith(
        "Along the plate the drag of air slows the sphere between impacts; in contact"
    )


def test_friction_is_lost_too() -> None:
    """What friction takes is told beside what the contact loses along the normal."""
    friction = {**TSUJI, "friction": {"law": "coulomb", "coefficient": 0.2}}
    result = run_of(plate={"material": "steel", "inclination": "20 deg"}, contact=friction)
    assert "is lost in contact along the normal by the end, and" in words("energy", result)
    assert (
        f"({100.0 * result.energy['friction_J'] / result.energy['input_J']:.1f} %) by friction."
        in words("energy", result)
    )


@pytest.mark.parametrize("treatment", ["consistent", "superposed"])
def test_the_loop_of_a_sphere_that_vibrates_encloses_energy(treatment: str) -> None:
    """Also under a law without losses loading and unloading differ where the sphere
    vibrates, and nothing is damped in the contact.
    """
    sphere = {
        "radius": "25 mm",
        "material": "steel",
        "model": "elastic",
        "modes": 10,
        "mesh": {"elements_across": 4},
    }
    result = run_of(sphere=sphere, contact={"law": "hertz", "local_compliance": treatment})
    assert words("force_indentation", result).startswith(
        "No energy is lost in contact: the area that a loop encloses is the energy that"
    )
    assert "damping adds" not in words("force", result)


def test_a_check_tells_all_that_ends_a_run() -> None:
    """Without gravity a sphere never rests, and one that moves along a plate of known
    size may fall off it.
    """

    def ends(**sections: Any) -> str:
        table = {
            "sphere": SPHERE,
            "plate": {"material": "steel"},
            "drop": FALL,
            "contact": TSUJI,
            "run": {"impacts": 3},
            **sections,
        }
        console = Console(width=200)
        with console.capture() as printed:
            console.print(case_explained(vi.case_of(table)))
        return (
            next(line for line in printed.get().split("\n") if line.startswith("stops"))
            .removeprefix("stops")
            .strip()
        )

    tilted = {"material": "steel", "size": ["0.3 m", "0.2 m", "5 mm"], "inclination": "10 deg"}
    assert ends() == "at rest or after 3 impacts"
    assert (
        ends(drop={"speed": "1 m/s", "gravity": 0})
        == "when it flies off for good or after 3 impacts"
    )
    assert (
        ends(plate=tilted)
        == "at rest or after 3 impacts or when it falls off the edge of the plate"
    )


def test_what_is_not_known_is_not_drawn_to_scale() -> None:
    """A plate without a size is drawn somehow."""
    assert (
        setup_chart(run_of()).caption
        == "To scale but for the height of the drop and the plate, whose size is not given."
    )
    sized = run_of(plate={"material": "steel", "size": ["0.3 m", "0.2 m", "5 mm"]})
    assert (
        setup_chart(sized).caption
        == "To scale but for the height of the drop and the depth of the supports."
    )
