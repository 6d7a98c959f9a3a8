"""Pictures and numbers of the guides: run it in docs/guides/images."""

import matplotlib

matplotlib.use("Agg")  # no window
import matplotlib.pyplot as plt
import numpy as np

import vibroimpact as vi
from vibroimpact.cases.reader import load_table

BLUE, RED, GREEN, GREY = "#0b4f8a", "#b3400e", "#3a7d44", "#6b6b6b"
PLATE = {
    "size": ["600 mm", "500 mm", "12 mm"],
    "material": "steel",
    "model": "elastic",
    "modes": 150,
    "damping": 0.02,
    "supports": "simply-supported",
}
CASE = {
    "sphere": {"radius": "25 mm", "material": "granite"},
    "plate": PLATE,
    "drop": {"height": "1 m", "position": ["60 mm", "40 mm"]},
    "contact": {"law": "tsuji", "restitution": 0.8},
    "run": {"impacts": 1},
}


def case_with(**changes: dict) -> vi.Case:
    """Return the case with other keys in its sections."""
    return vi.read_case({**CASE, **{section: {**CASE.get(section, {}), **keys} for section, keys in changes.items()}})


def saved(figure: plt.Figure, name: str) -> None:
    """Save a figure with a grid in all its axes."""
    for axes in figure.axes:
        axes.grid(color="#dcdcdc", linewidth=0.6)
    figure.savefig(f"{name}.png", dpi=120)
    plt.close(figure)


def adams() -> None:
    """Draw the restitution of a steel ball under IMPACT with the dialog's defaults, and with the damping that is found for 0.82."""
    mass, speeds = 7850.0 * 4.0 / 3.0 * np.pi * 0.02**3, np.geomspace(0.1, 10.0, 60)
    impact = vi.find_contact_law("adams-impact")
    dialogs = {
        "the dialog's defaults: 1e5 N/mm$^{2.2}$, 2.2, 10 N s/mm, 0.1 mm": (1e5, 2.2, 10.0, GREY),
        "found: 688021 N/mm$^{1.5}$, 1.5, 1.936 N s/mm, 0.1 mm": (688021.0, 1.5, 1.93605, BLUE),
    }
    figure, axes = plt.subplots(figsize=(7.2, 3.4), layout="constrained")
    for label, (stiffness, exponent, damping, colour) in dialogs.items():
        law = impact(stiffness=stiffness * 1000.0**exponent, exponent=exponent, damping_max=1000.0 * damping, full_damping_penetration=1e-4)
        achieved = [float(vi.achieved_restitution(law, mass=mass, speed=speed)) for speed in speeds]
        axes.semilogx(speeds, achieved, color=colour, label=label)
        print(f"adams: {label}: {np.interp(3.0683, speeds, achieved):.3f} at 3.07 m/s")
    axes.plot(3.0683, 0.8127, "o", color=RED, label="measured: from 0.5 m back to 0.337 m")
    axes.set(xlabel="approach speed [m/s]", ylabel="restitution", ylim=(0.0, 1.0))
    axes.legend(frameon=False)
    saved(figure, "adams-dialog")


def restitution() -> None:
    """Draw the restitution that laws achieve over the one that they are given."""
    asked = np.linspace(0.05, 1.0, 40)
    figure, axes = plt.subplots(figsize=(5.4, 4.6), layout="constrained")
    names = ("lee-wang", "lankarani-nikravesh", "hunt-crossley", "herbert-mcwhannell", "tsuji", "flores", "gonthier")
    for name, colour in zip(names, plt.cm.viridis(np.linspace(0.0, 0.9, len(names))), strict=True):
        law = vi.find_contact_law(name)
        more = {"effective_mass": 0.1} if name == "tsuji" else {}
        achieved = [
            float(vi.achieved_restitution(law(stiffness=1e8, restitution=float(one), **more), mass=0.1, speed=1.0)) for one in asked
        ]
        axes.plot(asked, achieved, color=colour, label=name)
    axes.plot([0.0, 1.0], [0.0, 1.0], color=GREY, linestyle=":")
    axes.set(xlabel="restitution given", ylabel="restitution achieved", xlim=(0.0, 1.0), ylim=(0.0, 1.0), aspect="equal")
    axes.legend(frameon=False)
    saved(figure, "restitution-achieved")


def thickness() -> None:
    """Draw what a plate's thickness does to the rebound, and to the force."""
    thicknesses = np.array([8.0, 12.0, 20.0, 30.0, 50.0])  # mm
    responses = [vi.simulate(case_with(plate={"size": ["600 mm", "500 mm", f"{one} mm"]})) for one in thicknesses]
    achieved = [float(one.impacts["restitution_achieved"][0]) for one in responses]
    forces = [1e-3 * float(one.impacts["max_force_N"][0]) for one in responses]
    mass, stiffness = float(responses[0].problem.sphere.mass), float(responses[0].problem.laws[0].stiffness)
    speed = float(responses[0].impacts["approach_speed_m_s"][0])
    many = np.geomspace(8.0, 50.0, 80)
    # Zener 1941: an infinite plate is a dashpot; its restitution is about exp(-1.72 times the inelasticity parameter)
    dashpot = 1.0 / (8.0 * np.sqrt(210e9 * (1e-3 * many) ** 4 / (12.0 * (1.0 - 0.3**2)) * 7850.0))
    zener = np.exp(-1.72 * dashpot * mass / ((mass / stiffness) ** 0.4 * speed**-0.2))
    figure, (left, right) = plt.subplots(1, 2, figsize=(8.6, 3.3), layout="constrained")
    left.semilogx(many, 0.8 * zener, color=GREY, label="0.8 times Zener's plate without edges")
    left.semilogx(thicknesses, achieved, "o", color=BLUE, label="computed, 600 x 500 mm")
    left.axhline(0.8, color=GREY, linestyle=":")
    left.set(xlabel="thickness [mm]", ylabel="restitution of the first impact", ylim=(0.0, 0.9))
    left.legend(frameon=False)
    right.semilogx(thicknesses, forces, "o-", color=RED)
    right.set(xlabel="thickness [mm]", ylabel="largest force [kN]", ylim=(0.0, None))
    for axes in (left, right):
        axes.set_xticks(thicknesses, [f"{one:g}" for one in thicknesses])
        axes.minorticks_off()
    saved(figure, "thickness")
    for one, response, force, back in zip(thicknesses, responses, forces, achieved, strict=True):
        row = {name: float(values[0]) for name, values in response.impacts.items()}
        print(
            f"thickness {one:g} mm: {back:.3f} (Zener {0.8 * np.interp(one, many, zener):.3f}), {force:.2f} kN, "
            f"{1e6 * row['duration_s']:.0f} us, {row['contacts']:.0f} contacts, truncation {response.truncation}"
        )


def accelerometer() -> None:
    """Draw what accelerometers of different chains make of one impact."""
    chains = {
        "the motion itself, 200 kHz": ({"rate": "200 kHz"}, GREY),
        "mounted resonance 8 kHz, 51.2 kHz": ({"rate": "51.2 kHz", "accelerometer": {"resonance": "8 kHz"}}, RED),
        "resonance 32 kHz, range 2000 m/s$^2$, 51.2 kHz": (
            {"rate": "51.2 kHz", "accelerometer": {"resonance": "32 kHz", "range": 2000.0}},
            BLUE,
        ),
        "sampled at 5 kHz": ({"rate": "5 kHz"}, GREEN),
    }
    sensors = [{"name": name, "position": ["200 mm", "120 mm"], **chain} for name, (chain, _) in chains.items()]
    table = {**CASE, "plate": {**PLATE, "modes": 400}, "run": {"impacts": 1, "duration": "0.5 s"}, "sensors": sensors}
    response = vi.simulate(vi.read_case(table))
    touch = float(response.impacts["time_s"][0])
    figure, axes = plt.subplots(len(chains), 1, figsize=(7.6, 6.2), layout="constrained", sharex=True)
    for one, (name, signal) in zip(axes, response.signals().items(), strict=True):
        near = np.abs(1e3 * (signal.time - touch) - 2.0) < 2.5
        one.plot(1e3 * (signal.time[near] - touch), 1e-3 * signal.value[near], color=chains[name][1], linewidth=1.0)
        one.set_title(name, loc="left", fontsize=9)
        print(
            f"accelerometer, {name}: {np.abs(signal.value).max():.0f} m/s2, overload {1e3 * signal.overload_time:.3f} ms, "
            f"reached {signal.peak:.0f}, uncertain by {signal.uncertainty:.3f}"
        )
    axes[-1].set(xlabel="time since first touch [ms]", xlim=(-0.5, 4.0))
    figure.supylabel("acceleration [km/s$^2$]", fontsize=10)
    saved(figure, "accelerometer")


def coal() -> None:
    """Draw what one impact of coal and of gangue shows mainly: impulse and contact time."""
    found = vi.bound_of(vi.load_sweep("signals:coal-gangue", 1000))
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
    places = ((0.03, 0.02), (0.1, 0.05), (-0.15, 0.1), (0.05, -0.12), (0.2, 0.0), (-0.08, -0.06))  # m
    sizes, speeds = np.array([10.0, 12.3, 17.4, 21.8, 28.0, 37.6]), (0.3, 1.0)  # mm, m/s
    table = load_table("signals:river-plate")
    del table["sweep"], table["sensors"][0]["amplifier"]
    table["run"] = {"duration": 0.06}
    figure, axes = plt.subplots(figsize=(6.8, 4.2), layout="constrained")
    for speed, colour in zip(speeds, (GREEN, BLUE), strict=True):
        heard = np.empty((len(sizes), len(places)))
        for row, size in enumerate(sizes):
            for column, place in enumerate(places):
                table["sphere"]["radius"], table["drop"] = 0.5e-3 * size, {"speed": speed, "position": list(place)}
                heard[row, column] = vi.simulate(vi.read_case(table)).signals()["geophone"].largest
        axes.fill_between(sizes, heard.min(axis=1), heard.max(axis=1), color=colour, alpha=0.15)
        axes.loglog(sizes, np.median(heard, axis=1), "o-", color=colour, label=f"computed, {speed:g} m/s: median and range of six places")
        for size, one in zip(sizes, heard, strict=True):
            print(f"river {speed:g} m/s, {size:g} mm: {np.median(one):.4f} V, {one.max() / one.min():.2f} times between places")
    axes.loglog(sizes, 4.6e-4 * sizes**1.71, color=RED, label="class limits in use, $4.6\\cdot10^{-4}\\,D^{1.71}$")
    axes.set(xlabel="size of the grain D [mm]", ylabel="amplitude [V]")
    axes.set_xticks(sizes, [f"{one:g}" for one in sizes])
    axes.minorticks_off()
    axes.legend(frameon=False)
    saved(figure, "river-plate")


def treatments() -> None:
    """Draw the force of one impact between bodies that are treated as rigid, quasi-static and elastic."""
    acetal = {"density": 1410, "youngs_modulus": "2.8 GPa", "poissons_ratio": 0.35, "yield_strength": "70 MPa"}
    plate = {**PLATE, "size": ["600 mm", "500 mm", "5 mm"]}
    drop = {"speed": "0.5 m/s", "position": ["60 mm", "40 mm"]}
    elastic = {**CASE, "sphere": {"radius": "25 mm", "material": acetal}, "plate": plate, "drop": drop}
    rigid = {**elastic, "plate": {"material": "steel"}}
    cases = {
        "rigid": vi.read_case(rigid),
        "rigid, finite_sphere": vi.read_case({**rigid, "contact": {**CASE["contact"], "finite_sphere": True}}),
    }
    cases |= {f"elastic plate, {modes} modes": vi.read_case({**elastic, "plate": {**plate, "modes": modes}}) for modes in (10, 40, 150)}
    figure, axes = plt.subplots(figsize=(7.2, 3.6), layout="constrained")
    for (name, case), colour in zip(cases.items(), (GREY, "#222222", "#a9c4dc", "#5b93c4", BLUE), strict=True):
        response = vi.simulate(case)
        row = {column: float(values[0]) for column, values in response.impacts.items()}
        time = np.linspace(0.0, 6e-4, 300)
        axes.plot(1e6 * time, response.at(row["time_s"] + time, ("force_N",))["force_N"], color=colour, label=name)
        print(
            f"{name}: {row['max_force_N']:.0f} N, {1e6 * row['duration_s']:.0f} us, {row['restitution_achieved']:.3f}, "
            f"truncation {response.truncation}"
        )
    axes.set(xlabel="time since first touch [us]", ylabel="contact force [N]", xlim=(0.0, 600.0), ylim=(0.0, None))
    axes.legend(frameon=False)
    saved(figure, "treatments")


for draw in (adams, restitution, thickness, accelerometer, coal, river, treatments):
    draw()
