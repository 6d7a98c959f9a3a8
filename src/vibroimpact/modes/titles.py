"""How a mode is called: its number and its frequency."""

from __future__ import annotations

from vibroimpact.structures.modal_model import ModalModel
from vibroimpact.units.display import text


def mode_title(model: ModalModel, mode: int) -> str:
    """Return the number of a mode, counted from 1, and its frequency."""
    return f"{mode + 1}: {text(float(model.frequencies[mode]), 'Hz', 5)}"
