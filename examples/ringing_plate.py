"""A ball on a ringing plate, in slow motion: the plate's bending waves, coloured by deflection, and
what an accelerometer on it hears.

Makes the moving picture of docs/index.md.
"""

from io import BytesIO

import matplotlib

matplotlib.use("Agg")  # no window
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import PolyCollection
from matplotlib.colors import LinearSegmentedColormap
from PIL import Image

import vibroimpact as vi
from vibroimpact.results.surface_grid import surface_grid

RADIUS, SPOT, SENSOR = 0.025, (-0.07, -0.04), (0.15, 0.09)  # m
BEFORE, AFTER, FRAMES = 0.3e-3, 4.1e-3, 110  # s around the first touch
EXAGGERATION = 150.0
CASE = {
    "sphere": {"radius": RADIUS, "material": "rock-paper"},
    "plate": {
        "size": ["520 mm", "420 mm", "8 mm"],
        "material": "steel",
        "model": "elastic",
        "supports": {"type": "patches", "spacing": ["458.4 mm", "360 mm"], "radius": "20 mm"},
        "damping": 0.02,
        "modes": 150,
    },
    "drop": {"height": "1 m", "position": SPOT},
    "contact": {"law": "lankarani-nikravesh", "restitution": 0.65},
    "run": {"impacts": 1, "duration": "0.46 s"},
    "sensors": [{"name": "accelerometer", "position": SENSOR, "rate": "200 kHz"}],
}
GROUND, INK, LIGHT = "#0e1726", "#e6edf6", np.array([-0.35, -0.5, 0.8])
SHADES = LinearSegmentedColormap.from_list(
    "deflection", ["#2b7bd6", "#5f7fa3", "#8d99a8", "#c08a63", "#f07a24"]
)
# the directions of the picture, in those of the plate
RIGHT, ACROSS = np.array([0.80, -0.60, 0.0]), np.array([0.27, 0.36, 0.89])


def seen(points: np.ndarray) -> np.ndarray:
    """Return where points [m] are in the picture."""
    return np.stack([points @ RIGHT, points @ ACROSS], axis=-1)


def ball(size: int = 200) -> np.ndarray:
    """Return the picture of a lit ball, transparent around it."""
    x, y = np.meshgrid(*2 * [np.linspace(-1.0, 1.0, size)])
    inside = x**2 + y**2
    lit = 0.25 + 0.75 * np.clip(
        (-0.45 * x + 0.55 * y + 0.7 * np.sqrt(np.clip(1.0 - inside, 0.0, None))), 0.0, 1.0
    )
    shine = np.exp(-((x + 0.33) ** 2 + (y - 0.4) ** 2) / 0.03) * 0.35
    colour = np.clip(lit[..., None] * np.array([0.80, 0.72, 0.60]) + shine[..., None], 0.0, 1.0)
    return np.concatenate(
        [colour, np.clip((1.0 - inside) * size / 4.0, 0.0, 1.0)[..., None]], axis=-1
    )


BALL = ball()


def draw(figure: plt.Figure, number: int) -> None:
    """Draw a frame: the plate with the ball and the sensor, and what the sensor has heard
    so far.
    """
    now, lift = times[number], EXAGGERATION * heights[number]
    figure.clear()
    scene = figure.add_axes((0.0, 0.2, 1.0, 0.8))
    surface = np.stack([x, y, lift], axis=-1)
    corners = seen(surface)
    cells = np.stack(
        [corners[:-1, :-1], corners[:-1, 1:], corners[1:, 1:], corners[1:, :-1]], axis=2
    ).reshape(-1, 4, 2)
    normal = np.cross(surface[:-1, 1:] - surface[:-1, :-1], surface[1:, :-1] - surface[:-1, :-1])
    lit = np.clip(normal @ LIGHT / np.linalg.norm(normal, axis=-1), 0.0, None)
    shade = SHADES(0.5 + 0.5 * np.tanh(1.4 * heights[number, :-1, :-1] / scale))[..., :3]
    colours = np.clip(shade * (0.2 + lit[..., None]), 0.0, 1.0).reshape(-1, 3)
    far_first = np.argsort(surface[:-1, :-1].reshape(-1, 3) @ np.cross(RIGHT, ACROSS))
    scene.add_collection(
        PolyCollection(
            cells[far_first],
            facecolors=colours[far_first],
            edgecolors=colours[far_first],
            linewidths=0.4,
        )
    )
    # the gap between ball and plate is to scale, the plate's deflection exaggerated
    under = seen(np.array([*SPOT, EXAGGERATION * deflection[number]]))
    round_about = np.linspace(0.0, 2.0 * np.pi, 60)
    shadow = under + RADIUS * np.stack(
        [0.9 * np.cos(round_about), 0.5 * np.sin(round_about)], axis=1
    )
    scene.add_collection(PolyCollection([shadow], facecolors=[(0.0, 0.0, 0.0, 0.3)]))
    right, up = under + seen(np.array([0.0, 0.0, position[number] - deflection[number]]))
    scene.imshow(
        BALL,
        extent=(right - RADIUS, right + RADIUS, up - RADIUS, up + RADIUS),
        origin="lower",
        zorder=5,
    )
    row, column = (
        np.abs(side - place).argmin() for side, place in ((grid.y, SENSOR[1]), (grid.x, SENSOR[0]))
    )
    scene.plot(
        *corners[row, column], "s", color=INK, markersize=9, markeredgecolor=GROUND, zorder=4
    )
    scene.set(xlim=(-0.34, 0.34), ylim=(-0.165, 0.20), aspect="equal")
    scene.axis("off")
    scene.text(
        0.04,
        0.92,
        f"{1e3 * now:+.2f} ms",
        transform=scene.transAxes,
        color=INK,
        fontsize=16,
        family="monospace",
    )
    trace = figure.add_axes((0.05, 0.035, 0.90, 0.16))
    trace.plot(heard_at, heard, color=INK, alpha=0.12, linewidth=0.8)
    trace.plot(heard_at[heard_at <= now], heard[heard_at <= now], color="#f0a35c", linewidth=1.3)
    trace.axvline(now, color=INK, linewidth=0.6, alpha=0.6)
    trace.set(xlim=(-BEFORE, AFTER), ylim=1.1 * np.abs(heard).max() * np.array([-1.0, 1.0]))
    trace.axis("off")
    trace.text(
        0.0,
        1.02,
        "acceleration at the square",
        transform=trace.transAxes,
        color=INK,
        fontsize=11,
        alpha=0.85,
    )


response = vi.simulate(vi.case_of(CASE))
touch = float(response.impacts["time_s"][0])
times = np.linspace(-BEFORE, AFTER, FRAMES)
model = response.problem.models["plate"]
grid = surface_grid(model.mesh)
shapes = grid.interpolate(
    model.shapes.reshape(len(model.shapes), len(model.mesh.nodes), -1)[:, :, 2]
)
heights = (response.modal(touch + times)["plate"] @ shapes.reshape(len(shapes), -1)).reshape(
    FRAMES, len(grid.y), len(grid.x)
)
x, y = np.meshgrid(grid.x, grid.y)
scale = np.percentile(np.abs(heights), 99.0)
position, deflection = response.at(touch + times, ("position_m", "plate_deflection_m")).values()
signal = response.signals()["accelerometer"]
near = np.abs(signal.time - touch) < AFTER
heard_at, heard = signal.time[near] - touch, signal.value[near] / 9.80665  # s, g

figure, frames = plt.figure(figsize=(9.0, 5.4), dpi=100, facecolor=GROUND), []
for number in range(FRAMES):
    draw(figure, number)
    file = BytesIO()
    figure.savefig(file, facecolor=GROUND)
    frames.append(Image.open(file).convert("RGB"))
pauses = [60] * (FRAMES - 1) + [1500]  # ms
frames[0].save(
    "ringing-plate.webp",
    save_all=True,
    append_images=frames[1:],
    duration=pauses,
    loop=5,
    quality=72,
    method=4,
)
print(
    f"{FRAMES} frames: the plate gives way by {-1e3 * heights.min():.2f} mm at most, and "
    f"the sensor hears {np.abs(heard).max():.0f} g"
)
