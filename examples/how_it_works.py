"""How a run goes, seen from within: the coordinates of the bodies, the stretches of a contact and
its events, the ledger, a row of beads.

Makes the pictures of docs/how-it-works.md.
"""

from itertools import pairwise
from time import process_time

import matplotlib

matplotlib.use("Agg")  # no window
import matplotlib.pyplot as plt
import numpy as np
from numpy.polynomial import legendre
from scipy.special import betaincinv

import vibroimpact as vi
from vibroimpact.dynamics.core.system_records import PEAK_FORCE
from vibroimpact.dynamics.vibrating.free_motion import FreePhase
from vibroimpact.dynamics.vibrating.marched_system import (
    ContactDefinition,
    MarchedSystem,
    march_system,
)
from vibroimpact.dynamics.vibrating.stretch import VibratingStretch
from vibroimpact.structures.modal_model import ModalBasis

BLUE, RED, GREY = "#0b4f8a", "#b3400e", "#6b6b6b"
PALE_BLUE, PALE_RED, PALE_GREY = "#a9c4dc", "#e6bfa8", "#e4e4e4"

# A steel ball, 20 mm thick, on a simply supported steel plate, whose modes are known in closed
# form.
BALL = 4.0 / 3.0 * np.pi * 0.01**3 * 7850.0
SIDES, THICKNESS, PLACE = (0.3, 0.2), 0.01, (0.11, 0.08)
LAW = vi.laws.AdamsImpact(stiffness=1.5e10, damping_max=1200.0, full_damping_penetration=1e-5)


def plate(modes: int) -> ModalBasis:
    """Return so many modes of the plate."""
    bending, mass = 210e9 * THICKNESS**3 / (12.0 * (1.0 - 0.3**2)), 7850.0 * THICKNESS
    across = np.arange(1, int(2.0 * modes**0.5) + 3)
    m, n = (part.ravel() for part in np.meshgrid(across, across))
    frequencies = (
        0.5 * np.pi * np.sqrt(bending / mass) * ((m / SIDES[0]) ** 2 + (n / SIDES[1]) ** 2)
    )
    first = np.argsort(frequencies, kind="stable")[:modes]
    sines = np.sin(m * np.pi * PLACE[0] / SIDES[0]) * np.sin(n * np.pi * PLACE[1] / SIDES[1])
    shape = 2.0 / np.sqrt(mass * SIDES[0] * SIDES[1]) * sines[first]
    at = {"contact": np.outer(shape, [0.0, 0.0, 1.0])}
    return ModalBasis(frequencies[first], np.full(modes, 0.01), shape, np.zeros((modes, 3)), at)


def marched(system: vi.System, duration: float) -> MarchedSystem:
    """Return what `vi.simulate_system` keeps of a run: its stretches and flights, one
    after another.
    """
    linear, start = system.linear()
    definitions = [
        ContactDefinition(one.law, one.series, not one.same_spot)
        for one in system.contacts.values()
    ]
    return march_system(linear, definitions, start, system.tolerance, duration)


def ball_on_plate(modes: int) -> vi.System:
    """Return the ball, which comes at 1 m/s, and the plate."""
    vibrating = plate(modes) if modes else None
    bodies = {
        "ball": vi.MovingBody(mass=BALL, velocity=(0.0, 0.0, -1.0)),
        "plate": vi.MovingBody(mass=np.inf, modes=vibrating),
    }
    return vi.System(
        bodies=bodies, contacts={"contact": vi.PointContact(above="ball", below="plate", law=LAW)}
    )


def draw_state() -> None:
    """Draw a ball and a plate as the sum of their coordinates."""
    figure, axes = plt.subplots(1, 5, figsize=(9.0, 1.75))
    figure.subplots_adjust(0.01, 0.02, 0.95, 0.98, wspace=0.22)
    x, place = np.linspace(0.0, 1.0, 201), PLACE[0] / SIDES[0]
    modes = [
        size * np.sin(number * np.pi * x) for number, size in ((1, -0.14), (2, -0.10), (3, 0.07))
    ]
    low = float(np.interp(place, x, sum(modes)))
    ball = {"facecolor": PALE_RED, "edgecolor": RED, "linewidth": 1.5}
    names = [
        "ball and plate",
        "$q_1$: rigid motion\nof the ball, $\\omega_1 = 0$",
        *(f"$q_{number}$: a mode of\nthe plate, $\\omega_{number}$" for number in (2, 3, 4)),
    ]
    for number, (axis, line, name) in enumerate(
        zip(axes, (sum(modes), None, *modes), names, strict=True)
    ):
        axis.set(xlim=(-0.04, 1.04), ylim=(-0.40, 0.60), aspect="equal")
        axis.axis("off")
        axis.text(0.5, 0.59, name, ha="center", va="top", fontsize=9)
        if number:
            axis.text(
                -0.13,
                0.0,
                "=" if number == 1 else "+",
                fontsize=15,
                ha="center",
                va="center",
                clip_on=False,
            )
        if line is not None:
            axis.plot(x, np.zeros_like(x), color=GREY, linewidth=0.7, linestyle=":")
            axis.plot(x, line, color=BLUE, linewidth=2.5)
            axis.plot([0.0, 1.0], [-0.04, -0.04], "^", color=GREY, markersize=5)
        if number > 1:
            moved = float(np.interp(place, x, line))
            axis.plot([place, place], [0.0, moved], color=RED, linewidth=2.5)
            axis.text(
                place,
                0.06 if moved < 0.0 else -0.04,
                f"$\\chi_{number} q_{number}$",
                color=RED,
                ha="center",
                va="bottom" if moved < 0.0 else "top",
            )
    axes[0].add_patch(plt.Circle((place, low + 0.29), 0.15, **ball))
    axes[0].plot([place, place], [low, low + 0.14], color=RED, linewidth=2.5)
    axes[0].text(place, low - 0.05, "gap, $-y$", color=RED, fontsize=10, ha="center", va="top")
    axes[1].add_patch(plt.Circle((0.5, 0.12), 0.15, **ball))
    axes[1].annotate(
        "",
        (0.5, -0.27),
        (0.5, 0.12),
        arrowprops={"arrowstyle": "->", "color": RED, "linewidth": 1.5},
    )
    axes[4].text(1.08, 0.0, "+ ...", fontsize=12, va="center", clip_on=False)
    figure.savefig("how-state.png", dpi=130)


def draw_root() -> None:
    """Draw Hertz's force over time and over the root of time, and the coefficients of its
    Legendre series in both.
    """
    nodes, weights = legendre.leggauss(60)
    places = 0.5 * (nodes + 1.0)

    def force(time: np.ndarray) -> np.ndarray:
        """Return the force of an undamped contact as a part of the largest, from first
        touch (0) to the deepest point (1).
        """
        return betaincinv(0.4, 0.5, time) ** 0.6

    figure, (left, right) = plt.subplots(1, 2, figsize=(8.2, 2.9), layout="constrained")
    line = np.linspace(0.0, 1.0, 301)
    left.plot(line, force(line), color=RED, label="over the time t")
    left.plot(line, force(line**2), color=BLUE, label="over x, where t = x$^2$")
    left.set(
        xlabel="t, x: from first touch (0) to the deepest point (1)",
        ylabel="force / largest force [-]",
    )
    left.legend(frameon=False)
    orders = np.arange(24)
    for values, colour, label in (
        (force(places), RED, "over t"),
        (force(places**2), BLUE, "over x"),
    ):
        coefficients = (orders + 0.5) * (legendre.legvander(nodes, 23).T @ (weights * values))
        right.semilogy(
            orders,
            np.abs(coefficients),
            "o-",
            color=colour,
            markersize=3.5,
            linewidth=0.8,
            label=label,
        )
        print(
            f"Hertz's force {label}: the coefficient of order 20 of its Legendre series is "
            f"{abs(coefficients[20]):.0e}"
        )
    right.set(
        xlabel="order of the Legendre polynomial", ylabel="coefficient [-]", ylim=(1e-14, 2.0)
    )
    right.legend(frameon=False)
    figure.savefig("how-root.png", dpi=130)


def event_after(march: MarchedSystem, index: int) -> str:
    """Return the event that ended a piece of the run of one contact; "" if none did."""
    piece, follows = march.motions[index], [*march.motions, None][index + 1]
    pushes = follows is not None and isinstance(follows.motion, VibratingStretch)
    if not isinstance(piece.motion, VibratingStretch):
        return ("pushes again" if pushes else "parted") if piece.motion.recoiling else ""
    contact = piece.motion.contacts[0]
    if abs(contact.delta[-1] / contact.local.law.breakpoints[0] - 1.0) < 1e-9:
        return "breakpoint"
    return (
        ""
        if pushes or follows is None
        else "no push"
        if isinstance(follows.motion, FreePhase) and follows.motion.recoiling
        else "parted"
    )


def draw_contact(march: MarchedSystem) -> None:
    """Draw the force of the contact with its stretches, nodes and events."""
    figure, axis = plt.subplots(figsize=(8.2, 3.6), layout="constrained")
    count, last = 0, 0.0
    for index, piece in enumerate(march.motions):
        begin, end, event = (
            1e6 * piece.start,
            1e6 * (piece.start + piece.motion.length),
            event_after(march, index),
        )
        if isinstance(piece.motion, VibratingStretch):
            axis.axvspan(begin, end, color="#f1f5f9" if count % 2 else "#ffffff", zorder=0)
            count += 1
            contact, rule = piece.motion.contacts[0], piece.motion.rule
            x = np.linspace(0.0, 1.0, 61)
            axis.plot(begin + (end - begin) * rule.map_time(x), contact.force_at(x), color=BLUE)
            nodes = begin + (end - begin) * rule.time
            axis.plot(
                nodes, contact.force, "o", color=BLUE, markersize=3.5, markerfacecolor="white"
            )
            print(
                f"stretch {count}: {begin:6.2f} to {end:6.2f} us, time map "
                f"{rule.time_map!r}, ends with {event or 'its length'}"
            )
        elif piece.motion.recoiling:
            axis.axvspan(begin, end, color=PALE_GREY, zorder=0)
            axis.plot([begin, end], [0.0, 0.0], color=BLUE)
        if event:
            last = end
            axis.axvline(end, color=RED, linewidth=1.0, linestyle="--")
            axis.text(
                end,
                1.02,
                event,
                transform=axis.get_xaxis_transform(),
                rotation=30,
                fontsize=8.5,
                color=RED,
            )
    axis.set(
        xlabel="time since first touch [$\\mu$s]",
        ylabel="contact force [N]",
        xlim=(-0.02 * last, 1.06 * last),
        ylim=(0.0, None),
    )
    figure.savefig("how-contact.png", dpi=130)


def draw_ledger(march: MarchedSystem) -> None:
    """Draw where the energy is over time."""
    of, times, rows, gone = march.system, [], [], 0.0
    elastic = next(
        piece.motion.contacts[0].local
        for piece in march.motions
        if isinstance(piece.motion, VibratingStretch)
    ).elastic_energy
    for piece in march.motions:
        since = piece.motion.length * np.linspace(0.0, 1.0, 41)
        state = piece.motion.state(since)
        lost = piece.motion.lost_by(since).sum(axis=1)
        stored = elastic(np.maximum(of.approach(state)[:, 0], 0.0))
        kinetic, strain = of.energies(state)
        plate_has = (kinetic + strain)[:, of.vibrating].sum(axis=1)
        times.append(piece.start + since)
        rows.append([kinetic[:, of.rigid].sum(axis=1), stored, plate_has, gone + lost])
        gone += float(lost[-1])
    time, bands = 1e6 * np.concatenate(times), 1e3 * np.concatenate(rows, axis=1)
    whole = bands.sum(axis=0)
    print(
        f"energy of {whole[0]:.2f} mJ: the ball keeps {bands[0, -1]:.2f} mJ; the sum "
        f"varies by {np.ptp(whole) / whole[0]:.0e} of itself"
    )
    figure, axis = plt.subplots(figsize=(8.2, 3.2), layout="constrained")
    labels = [
        "kinetic energy of the ball",
        "stored in the contact",
        "vibration of the plate",
        "lost in contact and plate",
    ]
    axis.stackplot(time, bands, labels=labels, colors=[PALE_RED, RED, PALE_BLUE, PALE_GREY])
    axis.set(
        xlabel="time since first touch [$\\mu$s]",
        ylabel="energy [mJ]",
        xlim=(0.0, time[-1]),
        ylim=(0.0, whole[0]),
    )
    axis.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), frameon=False)
    figure.savefig("how-ledger.png", dpi=130)


def draw_row(number: int = 12) -> None:
    """Draw the forces in a row of beads that touch, the last of which touches a wall,
    after the first is hit.
    """
    mass = 4.0 / 3.0 * np.pi * 2.38e-3**3 * 7850.0
    law = vi.laws.Hertz(stiffness=4.0 / 3.0 * 0.5 * 210e9 / (1.0 - 0.3**2) * np.sqrt(0.5 * 2.38e-3))
    names = [*(str(bead) for bead in range(1, number + 1)), "wall"]
    bodies = {
        name: vi.MovingBody(mass=mass, velocity=(0.5 if name == "1" else 0.0, 0.0, 0.0))
        for name in names[:-1]
    }
    bodies["wall"] = vi.MovingBody(mass=np.inf)
    contacts = {
        f"{left} on {right}": vi.PointContact(
            below=left, above=right, law=law, normal=(1.0, 0.0, 0.0)
        )
        for left, right in pairwise(names)
    }
    duration = 2.2e-4
    response = vi.simulate_system(vi.System(bodies=bodies, contacts=contacts), duration=duration)
    times = np.linspace(0.0, duration, 1201)
    forces = response.forces(times)
    scale = max(float(force.max()) for force in forces.values())
    figure, axis = plt.subplots(figsize=(8.2, 4.0), layout="constrained")
    for row, force in reversed(list(enumerate(forces.values(), start=1))):
        axis.fill_between(
            1e6 * times,
            row,
            row + 1.9 * force / scale,
            color="#ffffff" if row < number else PALE_RED,
            zorder=number - row,
        )
        axis.plot(
            1e6 * times,
            row + 1.9 * force / scale,
            color=BLUE if row < number else RED,
            linewidth=1.2,
            zorder=number - row,
        )
    axis.set(
        xlabel="time since first touch [$\\mu$s]",
        ylabel="contact",
        xlim=(0.0, 1e6 * duration),
        ylim=(0.8, number + 2.0),
    )
    axis.set_yticks(range(1, number + 1), [*(str(contact) for contact in range(1, number)), "wall"])
    figure.savefig("how-row.png", dpi=130)
    within = float(forces[f"{number // 2} on {number // 2 + 1}"].max())
    print(
        f"row of {number} beads: {within:.1f} N within and {scale:.1f} N at the wall, "
        f"closure {response.energy['closure_relative']:.0e}"
    )


run = marched(ball_on_plate(50), 3e-4)
draw_state()
draw_root()
draw_contact(run)
draw_ledger(run)
draw_row()
for modes in (5, 50, 500, 5000):
    system = ball_on_plate(modes)
    begun = process_time()
    found = marched(system, 1.5e-4)
    stretches = sum(isinstance(piece.motion, VibratingStretch) for piece in found.motions)
    force = found.impacts()[:, PEAK_FORCE].max()
    took, highest = (
        1e3 * (process_time() - begun),
        system.linear()[0].angular_frequency.max() / 2e3 / np.pi,
    )
    print(
        f"{modes:4d} modes to {highest:.1f} kHz: largest force {force:6.1f} N, {stretches} "
        f"stretches, {took:.0f} ms"
    )
