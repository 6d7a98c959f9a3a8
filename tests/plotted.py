"""What a page shows: the numbers that plotly holds of a chart, in SI units, and the
results that they should be.
"""

from __future__ import annotations

import re
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from vibroimpact.arrays import Floats
from vibroimpact.dynamics.motion.columns import ALL_HISTORY_COLUMNS
from vibroimpact.results.result import Result

if TYPE_CHECKING:
    from playwright.sync_api import Page

LONGEST = 60.0
"""Seconds after which what is waited for is given up."""

_SIZES = {
    "": 1.0,
    "G": 1e9,
    "M": 1e6,
    "k": 1e3,
    "m": 1e-3,
    "µ": 1e-6,
    "n": 1e-9,
    "p": 1e-12,
    "f": 1e-15,
}
_CHART = "(window.vibroimpact.charts || window.vibroimpact.live.charts).get(name)"


class BrowserStalled(AssertionError):
    """The browser draws no frames any more, as a headless Chromium on a busy machine may
    do for good: the test is run again.
    """


_FRAME = """() => Promise.race([
  new Promise((done) => requestAnimationFrame(() => done(true))), new Promise((done) => setTimeout(() => done(false), 5000))])"""


def until(page: Page, expression: str, argument: Any = None) -> Any:
    """Return what an expression of the page gives as soon as it is true. Playwright's own
    waiting evaluates text, which pages forbid.
    """
    end = time.monotonic() + LONGEST
    while not (found := page.evaluate(expression, argument)):
        if time.monotonic() > end:
            if not page.evaluate(_FRAME):
                raise BrowserStalled(expression)
            raise AssertionError(f"{expression} did not become true")
        time.sleep(0.02)
    return found


@dataclass
class Trace:
    """A trace of a chart: its kind and name, and the values that plotly holds, in SI units."""

    type: str
    name: str
    mode: str
    filled: bool
    panel: str
    x: Floats
    y: Floats
    own: Floats
    """Of a layer of a stack its own values; `y` is the edge of the stack."""


@dataclass
class Plotted:
    """A chart as it is drawn."""

    traces: list[Trace]
    titles: dict[str, str]
    """Of the axes, such as "x", "y2"."""
    ranges: dict[str, tuple[float, float]]
    """Of the axes, as shown: less the origin, in the multiple of the unit."""
    notes: list[str]
    shapes: int

    def lines(self, panel: str = "y") -> list[Trace]:
        """The lines of a panel, named by its vertical axis; no outlines, and no entries
        of the legend alone.
        """
        return [
            one
            for one in self.traces
            if one.panel == panel and "lines" in one.mode and not one.filled and len(one.x) > 1
        ]


def show(page: Page, name: str) -> None:
    """Bring a chart into the window, and wait until it is drawn."""
    # charts above that are drawn meanwhile may push it out again
    into = (
        "for (let fold = one.element.closest('details'); fold; "
        "fold = fold.parentElement.closest('details')) fold.open = true; "
        "one.element.scrollIntoView({ block: 'center', behavior: 'instant' })"
    )
    until(
        page,
        f"(name) => {{ const one = {_CHART}; {into}; return one.near && !one.stale && "
        f"!one.drawing; }}",
        name,
    )


def names(page: Page) -> list[str]:
    """Return the names of the charts of a page."""
    found: list[str] = page.evaluate(
        "() => [...(window.vibroimpact.charts || window.vibroimpact.live.charts).keys()]"
    )
    return found


def plotted(
    page: Page, name: str, units: tuple[str, str] | dict[str, tuple[str, str]] = ("", "")
) -> Plotted:
    """Return a chart as plotly holds it, brought into the window; values in the units
    given for the axes, x and y or by the panel.
    """
    show(page, name)
    found = page.evaluate(
        f"""(name) => {{
          const element = {_CHART}.element, full = element._fullLayout, axes = {{}};
          for (const key of Object.keys(full).filter((one) => /^[xy]axis\\d*$/.test(one)))
            axes[key.replace("axis", "")] = {{ title: full[key].title.text || "", range: Array.from(full[key].range, Number) }};
          const list = (values) => Array.from(values || [], (value) => (value === null || Number.isNaN(value) ? null : value));
          return {{
            axes, shapes: (full.shapes || []).length, notes: (element.layout.annotations || []).map((note) => note.text),
            traces: element.data.map((one) => ({{
              type: one.type, name: one.name || "", mode: one.mode || "", filled: Boolean(one.fill), x: list(one.x), y: list(one.y),
              own: list(one.customdata && one.customdata.length && one.customdata[0].length ? [] : one.customdata),
              axes: [one.xaxis || "x", one.yaxis || "y"] }})),
          }};
        }}""",
        name,
    )
    titles = {axis: one["title"] for axis, one in found["axes"].items()}
    traces = []
    for one in found["traces"]:
        across, up = one["axes"]
        base = units if isinstance(units, tuple) else units.get(up, ("", ""))
        # the panels of a row above others have no title: their time is that of the lowest one
        title = titles[across] or next(
            (words for axis, words in reversed(titles.items()) if axis.startswith("x") and words),
            "",
        )
        x, y, own = (
            np.array([np.nan if value is None else value for value in one[key]], dtype=float)
            for key in ("x", "y", "own")
        )
        size = unit_size(titles[up], base[1])
        traces.append(
            Trace(
                one["type"],
                one["name"],
                one["mode"],
                one["filled"],
                up,
                x * unit_size(title, base[0]),
                y * size,
                own * size,
            )
        )
    ranges = {axis: (one["range"][0], one["range"][1]) for axis, one in found["axes"].items()}
    return Plotted(traces, titles, ranges, found["notes"], found["shapes"])


def unit_size(title: str, base: str) -> float:
    """Return the size of the multiple of a unit that the title of an axis tells: 1e-3 for "Time
    [ms]" and "s".

    Examples
    --------
    >>> unit_size("Time [ms]", "s"), unit_size("kN", "N"), unit_size("Acceleration [m/s²]", "m/s2")
    (0.001, 1000.0, 1.0)
    """
    if not base:
        return 1.0
    match = re.search(r"\[([^]]+)\]$", title)
    unit = (match.group(1) if match else title).replace("²", "2")
    assert unit.endswith(base), f"{title!r} is not in a multiple of {base}"
    return _SIZES[unit.removesuffix(base)]


def distance(at: Floats, values: Floats, x: Floats, y: Floats, near: float) -> float:
    """Return the largest distance of values to those of a curve at the same place;
    infinity if the curve has no point there.
    """
    first, last = (
        np.searchsorted(x, at - near, side="left"),
        np.searchsorted(x, at + near, side="right"),
    )
    far = [
        np.abs(y[low:high] - value).min() if low < high else np.inf
        for low, high, value in zip(first, last, values, strict=True)
    ]
    return float(max(far))


def assert_is_line(
    trace: Trace, x: Floats, y: Floats, *, whole: bool, tolerance: float = 1e-6
) -> None:
    """Check that a trace consists of points of a curve, in its order: of the whole one, or of a
    part every point.

    Parameters
    ----------
    trace : Trace
        The trace.
    x, y : array
        The curve; x ascends.
    whole : bool
        Whether the first, last, lowest and highest point of the curve must be there; otherwise
        every point between the first and the last one of the trace.
    tolerance : float
        Of y, relative to its largest magnitude. Arrays travel in single precision.
    """
    near = (
        2e-3 * float(np.min(np.diff(np.unique(x)), initial=1.0))
        if not whole
        else 1e-7 * float(x[-1] - x[0]) + 1e-12
    )
    within = tolerance * max(float(np.abs(y).max()), 1e-300)
    assert distance(trace.x, trace.y, x, y, near) <= within
    assert np.all(np.diff(trace.x) >= 0.0)
    if whole:
        for end in (0, -1):
            assert abs(trace.x[end] - x[end]) <= near
        assert abs(trace.y.min() - y.min()) <= within
        assert abs(trace.y.max() - y.max()) <= within
    else:
        assert len(trace.x) == np.searchsorted(
            x, trace.x[-1] + near, side="right"
        ) - np.searchsorted(x, trace.x[0] - near, side="left")


def plot_area(page: Page, name: str) -> dict[str, float]:
    """Return where the axes of a chart lie in the window."""
    show(page, name)
    found: dict[str, float] = page.evaluate(
        f"""(name) => {{ const {{ element }} = {_CHART}, box = element.getBoundingClientRect(), {{ xaxis, yaxis }} = element._fullLayout;
        return {{ left: box.left + xaxis._offset, top: box.top + yaxis._offset, width: xaxis._length, height: yaxis._length }}; }}""",
        name,
    )
    return found


def zoom(page: Page, name: str, start: float, end: float) -> None:
    """Drag over a chart, between parts of its width."""
    area = plot_area(page, name)
    middle = area["top"] + 0.5 * area["height"]
    before = page.evaluate(f"(name) => {_CHART}.element._fullLayout.xaxis.range.join()", name)
    page.mouse.move(area["left"] + start * area["width"], middle)
    page.mouse.down()
    page.mouse.move(area["left"] + 0.5 * (start + end) * area["width"], middle, steps=3)
    page.mouse.move(area["left"] + end * area["width"], middle, steps=3)
    page.mouse.up()
    until(
        page,
        f"""([name, before]) => {{ const one = {_CHART};
        return Object.keys(one.state.ranges).length && !one.stale && !one.drawing
          && one.element._fullLayout.xaxis.range.join() !== before; }}""",
        [name, before],
    )


COLUMNS = {
    "position": "position_m",
    "velocity": "velocity_m_s",
    "force": "force_N",
    "acceleration": "acceleration_m_s2",
}
"""Charts of one column of the history."""

ROWS: dict[str, Callable[[dict[str, Floats]], Floats]] = {
    "Kinetic energy of the centre": lambda history: history["kinetic_J"],
    "Potential energy, zero at first touch": lambda history: history["potential_J"],
    "Strain energy of its modes": lambda history: history["sphere_strain_J"],
    "Energy of its vibration: strain and kinetic": lambda history: (
        history["sphere_strain_J"] + history["sphere_vibration_J"]
    ),
    "Displacement of the centre of mass": lambda history: history["plate_displacement_m"],
    "Velocity of the centre of mass": lambda history: history["plate_velocity_m_s"],
    "Acceleration of the centre of mass": lambda history: history["plate_acceleration_m_s2"],
    "Displacement at the contact point": lambda history: history["plate_deflection_m"],
    "Kinetic energy": lambda history: history["plate_kinetic_J"],
    "Strain energy, from where it rests": lambda history: history["plate_strain_J"],
    "Energy of its vibration: strain and kinetic of the plate": lambda history: (
        history["plate_kinetic_J"] + history["plate_strain_J"]
    ),
    "Change of the potential energy": lambda history: history["plate_potential_J"],
}
"""What the rows of the charts of vibrating bodies show, by their titles."""

UNITS = {
    "position": "m",
    "velocity": "m/s",
    "force": "N",
    "acceleration": "m/s2",
    "energy": "J",
    "force_indentation": "N",
}

_LAYERS = {
    "vibration of the sphere": lambda history: (
        history["sphere_vibration_J"] + history["sphere_strain_J"]
    ),
    "motion of the plate": lambda history: history["plate_kinetic_J"] + history["plate_strain_J"],
    "damping of the contact": lambda history: history["contact_dissipated_J"],
}


def assert_history_is_drawn(page: Page, result: Result, history: dict[str, Floats]) -> None:
    """Compare the charts of columns of the history, over the whole run, with the result."""
    for name in [one for one in names(page) if one in COLUMNS]:
        chart = plotted(page, name, ("s", UNITS[name]))
        (line,) = chart.lines()
        assert_is_line(line, history["time_s"], history[COLUMNS[name]], whole=True)
    chart = plotted(page, "energy", ("s", "J"))
    layers = [one for one in chart.traces if len(one.own)]
    shorts = {
        column.short: history[name]
        for name, column in ALL_HISTORY_COLUMNS.items()
        if column.short and name in history
    }
    for layer in layers:
        values = _LAYERS[layer.name](history) if layer.name in _LAYERS else shorts[layer.name]
        near = 1e-7 * float(history["time_s"][-1])
        assert (
            distance(layer.x, layer.own, history["time_s"], values, near)
            <= 1e-6 * result.energy["input_J"]
        )
    # the bands of all entries reach the energy put in at every time
    np.testing.assert_allclose(layers[-1].y, result.energy["input_J"], rtol=2e-5)


def assert_loops_are_drawn(page: Page, result: Result, history: dict[str, Floats]) -> None:
    """Compare the loops of force over indentation with the history of each contact."""
    chart = plotted(page, "force_indentation", ("m", "N"))
    loops = [one for one in chart.lines() if one.name.startswith("impact ")]
    assert len(loops) == len(result.impacts["impact"])
    scale = np.array(
        [result.impacts["max_indentation_m"].max(), result.impacts["max_force_N"].max()]
    )
    for number, loop in enumerate(loops):
        touch, duration = result.impacts["time_s"][number], result.impacts["duration_s"][number]
        inside = (history["time_s"] >= touch) & (history["time_s"] <= touch + duration)
        own = (
            np.column_stack([history["indentation_m"][inside], history["force_N"][inside]]) / scale
        )
        drawn = np.column_stack([loop.x, loop.y]) / scale
        assert np.abs(own[None] - drawn[:, None]).max(axis=2).min(axis=1).max() < 1e-6
        assert abs(len(drawn) - len(own)) <= 4
        assert abs(loop.y.max() - history["force_N"][inside].max()) < 1e-6 * scale[1]
