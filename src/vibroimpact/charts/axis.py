"""An axis of a chart, and the parts of it that are shown enlarged."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, eq=False)
class View:
    """A part of an axis that is shown enlarged: one contact of a run.

    Parameters
    ----------
    name : str
        What the part is.
    start, end : float
        Range shown.
    origin : float
        Value from which the axis counts in this view.
    label : str
        Label of the axis in this view, without unit.
    headline : str
        The number that this view is about, with its unit.
    level : float
        Value from which the vertical axis counts in this view.
    level_label : str
        Label of the vertical axis in this view; empty for the usual one.
    """

    name: str
    start: float
    end: float
    origin: float = 0.0
    label: str = ""
    headline: str = ""
    level: float = 0.0
    level_label: str = ""


@dataclass(frozen=True, eq=False)
class Axis:
    """An axis: a quantity with its unit. Panels that have the same axis object share its range.

    Parameters
    ----------
    label : str
        The quantity.
    unit : str
        Its SI unit, or a unit without multiples; "" for a number.
    log : bool
        Whether it is logarithmic.
    range : tuple of float, optional
        Range shown; by default that of what is drawn. One of the two may be NaN.
    names : tuple of str
        Names at 0, 1, 2 and so on, for an axis of names.
    ticks : tuple of float
        Where numbers stand; by default chosen when drawn.
    integer : bool
        Whether only whole numbers exist on it.
    views : tuple of View
        Parts that are shown enlarged.
    """

    label: str = ""
    unit: str = ""
    log: bool = False
    range: tuple[float, float] | None = None
    names: tuple[str, ...] = ()
    ticks: tuple[float, ...] = ()
    integer: bool = False
    views: tuple[View, ...] = ()
