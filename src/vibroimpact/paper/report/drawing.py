"""A figure of the reproduction, with its title and what to see in it."""

from __future__ import annotations

from typing import NamedTuple

from matplotlib.figure import Figure


class Drawing(NamedTuple):
    """A figure of the reproduction.

    Parameters
    ----------
    figure : Figure
        The picture.
    title : str
        What it shows, with the number that it has in the paper.
    sentence : str
        What to see in it.
    """

    figure: Figure
    title: str
    sentence: str
