"""Pictures and numbers of the guides: run it in docs/guides/images."""

from __future__ import annotations

import re
import tomllib
from functools import cache
from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("Agg")  # no window
import matplotlib.pyplot as plt
import numpy as np

import vibroimpact as vi
from vibroimpact.cases.reader import load_table

BLUE, RED, GREEN, GREY = "#0b4f8a", "#b3400e", "#3a7d44", "#6b6b6b"


def case_on(page: str) -> dict[str, Any]:
    """Return the first case that a guide shows."""
    text = (Path(__file__).parents[1] / "docs" / "guides" / page).read_text(encoding="utf-8")
    return tomllib.loads(re.findall(r"```toml\n(.*?)```", text, flags=re.S)[0])


ADAMS = case_on("adams-damping.md")
THICKNESS = {key: value for key, value in case_on("plate-thickness.md").items() if key != "sweep"}
SENSORS = case_on("accelerometer.md")
TREATED = case_on("choosing.md")

DIALOG = {
    "stiffness": 1e5 * 1000.0**2.2,
    "exponent": 2.2,
    "damping_max": 10e3,
    "full_damping_penetration": 1e-4,
}
"""What Adams View offers for a new contact: MSC's help, "Contact Parameters for Parts
with Small Mass".
"""

THICKNESSES = (4.0, 6.0, 8.0, 12.0, 20.0)  # mm

CHAINS = {
    "the motion itself, 102.4 kHz": ({"rate": "102.4 kHz"}, GREY),
    "mounted resonance 8 kHz, 51.2 kHz": (
        {"rate": "51.2 kHz", "accelerometer": {"resonance": "8 kHz"}},
        RED,
    ),
    "resonance 32 kHz, range 2000 m/s$^2$, 51.2 kHz": (
        {"rate": "51.2 kHz", "accelerometer": {"resonance": "32 kHz", "range": 2000.0}},
        BLUE,
    ),
    "sampled at 5 kHz": ({"rate": "5 kHz"}, GREEN),
}
"""Measuring chains at one position, each with its colour."""


def case_with(table: dict[str, Any], **changes: dict[str, Any]) -> vi.Case:
    """Return a case with other keys in its sections."""
    return vi.case_of(
        {
            **table,
            **{section: {**table.get(section, {}), **keys} for section, keys in changes.items()},
        }
    )


def first_impact(response: vi.Response) -> dict[str, float]:
    """Return the first row of the impact table."""
    return {name: float(values[0]) for name, values in response.impacts.items()}


def saved(figure: plt.Figure, name: str) -> None:
    """Save a figure with a grid in all its axes."""
    for axes in figure.axes:
        axes.grid(color="#dcdcdc", linewidth=0.6)
    figure.savefig(f"{name}.png", dpi=120)
    plt.close(figure)


@cache
def found_for_adams() -> tuple[vi.calibration.Calibration, vi.Response]:
    """Return the damping of the ball in Adams, and the drop with it."""
    question = vi.calibration.calibration_of(ADAMS)
    found = vi.calibration.calibrate_case(question)
    return found, vi.simulate(found.calibrated_case)


def adams() -> None:
    """Draw the restitution of a steel ball under IMPACT with the dialog's defaults, and
    with the damping that is found.
    """
    found, response = found_for_adams()
    mass, speeds, row = (
        float(response.problem.sphere.mass),
        np.geomspace(0.1, 10.0, 60),
        first_impact(response),
    )
    laws = {
        "the dialog's defaults: 1e5 N/mm$^{2.2}$, 2.2, 10 N s/mm, 0.1 mm": (
            vi.laws.AdamsImpact(**DIALOG),
            GREY,
        ),
        f"found: Hertz's stiffness, 1.5, {1e-3 * found.values[0]:.4g} N s/mm, 0.01 mm": (
            response.problem.laws[0],
            BLUE,
        ),
    }
    figure, axes = plt.subplots(figsize=(7.2, 3.4), layout="constrained")
    for label, (law, colour) in laws.items():
        achieved = [
            float(vi.laws.achieved_restitution(law, mass=mass, speed=speed)) for speed in speeds
        ]
        axes.semilogx(speeds, achieved, color=colour, label=label)
        print(
            f"adams: {label}: {np.interp(row['approach_speed_m_s'], speeds, achieved):.3f} "
            f"at {row['approach_speed_m_s']:.3f} m/s"
        )
    print(
        f"adams: {row['max_force_N']:.0f} N, {1e6 * row['max_indentation_m']:.1f} um, "
        f"doubts: {vi.result_of(response).doubts}"
    )
    measured = (
        f"measured: from {ADAMS['drop']['height']} back to "
        f"{ADAMS['calibrate']['target']['rebound_heights'][0]}"
    )
    axes.plot(
        row["approach_speed_m_s"], row["restitution_achieved"], "o", color=RED, label=measured
    )
    axes.set(xlabel="approach speed [m/s]", ylabel="restitution", ylim=(0.0, 1.05))
    axes.legend(frameon=False, loc="center left", bbox_to_anchor=(0.0, 0.55))
    saved(figure, "adams-dialog")


LAWS = (
    "lee-wang",
    "lankarani-nikravesh",
    "hunt-crossley",
    "herbert-mcwhannell",
    "tsuji",
    "flores",
    "gonthier",
)


def restitution_of(name: str, asked: float) -> float:
    """Return the restitution that a law achieves for a restitution parameter."""
    law = vi.laws.find_contact_law(name)
    more = {"effective_mass": 0.1} if "effective_mass" in law.__dataclass_fields__ else {}
    return float(
        vi.laws.achieved_restitution(
            law(stiffness=1e8, restitution=asked, **more), mass=0.1, speed=1.0
        )
    )


def restitution() -> None:
    """Draw the restitution that laws achieve over the one that they are given."""
    asked = np.linspace(0.05, 1.0, 40)
    figure, axes = plt.subplots(figsize=(5.4, 4.6), layout="constrained")
    for name, colour in zip(LAWS, plt.cm.viridis(np.linspace(0.0, 0.9, len(LAWS))), strict=True):
        axes.plot(
            asked, [restitution_of(name, float(one)) for one in asked], color=colour, label=name
        )
    axes.plot([0.0, 1.0], [0.0, 1.0], color=GREY, linestyle=":")
    axes.set(
        xlabel="restitution given",
        ylabel="restitution achieved",
        xlim=(0.0, 1.0),
        ylim=(0.0, 1.0),
        aspect="equal",
    )
    axes.legend(frameon=False)
    saved(figure, "restitution-achieved")


@cache
def on_rigid_plate() -> vi.Response:
    """Return the impact of the nylon ball on a rigid plate."""
    return vi.simulate(vi.case_of({**THICKNESS, "plate": {"material": "steel"}}))


@cache
def on_plate(thickness: float) -> vi.Response:
    """Return the impact of the nylon ball on a plate of a thickness [mm]."""
    return vi.simulate(
        case_with(THICKNESS, plate={"size": ["600 mm", "500 mm", f"{thickness:g} mm"]})
    )


def zener(thickness: float) -> float:
    """Return the restitution of the nylon ball on a plate without edges (Zener 1941), of a
    thickness [mm].

    The plate is a dashpot; the restitution of an elastic contact on it is about exp(-1.72 times the
    inelasticity parameter).
    """
    rigid, steel = on_rigid_plate(), vi.find_material("steel")
    row, mass = first_impact(rigid), float(rigid.problem.sphere.mass)
    stiffness = float(vi.case_of(THICKNESS).to_problem().laws[0].stiffness)
    bending = (
        steel.youngs_modulus * (1e-3 * thickness) ** 3 / (12.0 * (1.0 - steel.poissons_ratio**2))
    )
    dashpot = 8.0 * np.sqrt(bending * steel.density * 1e-3 * thickness)
    return row["restitution_achieved"] * np.exp(
        -1.72 * mass**0.6 * stiffness**0.4 * row["approach_speed_m_s"] ** 0.2 / dashpot
    )


def thickness() -> None:
    """Draw what a plate's thickness does to the rebound, and to the force."""
    rows = [first_impact(on_plate(one)) for one in THICKNESSES]
    many, rigid = np.geomspace(THICKNESSES[0], THICKNESSES[-1], 80), first_impact(on_rigid_plate())
    figure, (left, right) = plt.subplots(1, 2, figsize=(8.6, 3.3), layout="constrained")
    left.semilogx(
        many, [zener(one) for one in many], color=GREY, label="Zener's plate without edges"
    )
    left.semilogx(
        THICKNESSES,
        [row["restitution_achieved"] for row in rows],
        "o",
        color=BLUE,
        label="computed, 600 x 500 mm",
    )
    left.axhline(rigid["restitution_achieved"], color=GREY, linestyle=":", label="rigid plate")
    left.set(xlabel="thickness [mm]", ylabel="restitution of the first impact", ylim=(0.0, 1.0))
    left.legend(frameon=False, loc="lower right")
    right.semilogx(THICKNESSES, [row["max_force_N"] for row in rows], "o-", color=RED)
    right.axhline(rigid["max_force_N"], color=GREY, linestyle=":")
    right.set(xlabel="thickness [mm]", ylabel="largest force [N]", ylim=(0.0, None))
    for axes in (left, right):
        axes.set_xticks(THICKNESSES, [f"{one:g}" for one in THICKNESSES])
        axes.minorticks_off()
    saved(figure, "thickness")
    for one, row in zip((*THICKNESSES, np.inf), (*rows, rigid), strict=True):
        response = on_plate(one) if np.isfinite(one) else on_rigid_plate()
        print(
            f"thickness {one:g} mm: {row['restitution_achieved']:.4f} (Zener "
            f"{zener(one):.4f}), {row['max_force_N']:.1f} N, "
            f"{1e6 * row['duration_s']:.1f} us, truncation {response.truncation}, doubts: "
            f"{vi.result_of(response).doubts}"
        )


@cache
def measured_by_chains(law: str = SENSORS["contact"]["law"]) -> vi.Response:
    """Return the impact on the plate under a law, with four measuring chains at the
    position of the page's sensors.
    """
    position = SENSORS["sensors"][0]["position"]
    sensors = [{"name": name, "position": position, **chain} for name, (chain, _) in CHAINS.items()]
    return vi.simulate(vi.case_of({**SENSORS, "contact": {"law": law}, "sensors": sensors}))


def accelerometer() -> None:
    """Draw what accelerometers of different chains make of one impact."""
    response = measured_by_chains()
    touch = float(response.impacts["time_s"][0])
    figure, axes = plt.subplots(
        len(CHAINS), 1, figsize=(7.6, 6.2), layout="constrained", sharex=True
    )
    for one, (name, signal) in zip(axes, response.signals().items(), strict=True):
        near = np.abs(1e3 * (signal.time - touch) - 2.0) < 2.5
        one.plot(
            1e3 * (signal.time[near] - touch),
            1e-3 * signal.value[near],
            color=CHAINS[name][1],
            linewidth=1.0,
        )
        one.set_title(name, loc="left", fontsize=9)
        print(
            f"accelerometer, {name}: {signal.largest:.0f} m/s2, overload "
            f"{1e3 * signal.overload_time:.3f} ms, "
            f"reached {signal.peak:.0f}, uncertain by {signal.uncertainty:.3f}"
        )
    print(f"accelerometer: {first_impact(response)}, doubts: {vi.result_of(response).doubts}")
    axes[-1].set(xlabel="time since first touch [ms]", xlim=(-0.5, 4.0))
    figure.supylabel("acceleration [km/s$^2$]", fontsize=10)
    saved(figure, "accelerometer")


def coal() -> None:
    """Draw what one impact of coal and of gangue shows mainly: impulse and contact time."""
    found = vi.bayes_error.bound_of(vi.studies.load_sweep("signals:coal-gangue", 1000))
    figure, axes = plt.subplots(figsize=(6.6, 4.0), layout="constrained")
    for name, colour in (("coal", "#222222"), ("gangue", RED)):
        these = found.falls.classes == name
        impulse, contact = found.falls.impulse[these], found.falls.duration[these]
        axes.loglog(1e6 * contact, impulse, "o", color=colour, markersize=4, alpha=0.6, label=name)
    axes.set(xlabel="contact time [us]", ylabel="impulse [N s]")
    axes.legend(frameon=False)
    saved(figure, "coal-and-gangue")


def river() -> None:
    """Draw the amplitude of a river plate's geophone over the size of the grain."""
    # m
    places = ((0.03, 0.02), (0.1, 0.05), (-0.15, 0.1), (0.05, -0.12), (0.2, 0.0), (-0.08, -0.06))
    sizes, speeds = np.array([10.0, 12.3, 17.4, 21.8, 28.0, 37.6]), (0.3, 1.0)  # mm, m/s
    table = load_table("signals:river-plate")
    del table["sweep"], table["sensors"][0]["amplifier"]
    table["run"] = {"duration": 0.06}
    figure, axes = plt.subplots(figsize=(6.8, 4.2), layout="constrained")
    for speed, colour in zip(speeds, (GREEN, BLUE), strict=True):
        heard = np.empty((len(sizes), len(places)))
        for row, size in enumerate(sizes):
            for column, place in enumerate(places):
                table["sphere"]["radius"], table["drop"] = (
                    0.5e-3 * size,
                    {"speed": speed, "position": list(place)},
                )
                heard[row, column] = vi.simulate(vi.case_of(table)).signals()["geophone"].largest
        axes.fill_between(sizes, heard.min(axis=1), heard.max(axis=1), color=colour, alpha=0.15)
        axes.loglog(
            sizes,
            np.median(heard, axis=1),
            "o-",
            color=colour,
            label=f"computed, {speed:g} m/s: median and range of six places",
        )
        for size, one in zip(sizes, heard, strict=True):
            print(
                f"river {speed:g} m/s, {size:g} mm: {np.median(one):.4f} V, "
                f"{one.max() / one.min():.2f} times between places"
            )
    axes.loglog(
        sizes,
        4.6e-4 * sizes**1.71,
        color=RED,
        label="class limits in use, $4.6\\cdot10^{-4}\\,D^{1.71}$",
    )
    axes.set(xlabel="size of the grain D [mm]", ylabel="amplitude [V]")
    axes.set_xticks(sizes, [f"{one:g}" for one in sizes])
    axes.minorticks_off()
    axes.legend(frameon=False)
    saved(figure, "river-plate")


def treatments() -> None:
    """Draw the force of one impact between bodies that are treated as rigid, quasi-static
    and elastic.
    """
    rigid = {**TREATED, "plate": {"material": "steel"}}
    cases = {
        "rigid": vi.case_of(rigid),
        "rigid, finite_sphere": vi.case_of(
            {**rigid, "contact": {**TREATED["contact"], "finite_sphere": True}}
        ),
    }
    cases |= {
        f"elastic plate, {modes} modes": case_with(TREATED, plate={"modes": modes})
        for modes in (10, 40, 150)
    }
    figure, axes = plt.subplots(figsize=(7.2, 3.6), layout="constrained")
    for (name, case), colour in zip(
        cases.items(), (GREY, "#222222", "#a9c4dc", "#5b93c4", BLUE), strict=True
    ):
        response = vi.simulate(case)
        row = first_impact(response)
        time = np.linspace(0.0, 6e-4, 300)
        axes.plot(
            1e6 * time,
            response.at(row["time_s"] + time, ("force_N",))["force_N"],
            color=colour,
            label=name,
        )
        print(
            f"{name}: {row['max_force_N']:.0f} N, {1e6 * row['duration_s']:.0f} us, "
            f"{row['restitution_achieved']:.3f}, "
            f"truncation {response.truncation}"
        )
    axes.set(
        xlabel="time since first touch [us]",
        ylabel="contact force [N]",
        xlim=(0.0, 600.0),
        ylim=(0.0, None),
    )
    axes.legend(frameon=False)
    saved(figure, "treatments")


if __name__ == "__main__":
    for draw in (adams, restitution, thickness, accelerometer, coal, river, treatments):
        draw()
