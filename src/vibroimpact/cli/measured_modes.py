"""The modes of measured frequency responses, for the command `modes`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from vibroimpact.cli.shared import exit_on_interrupt, save_and_show

if TYPE_CHECKING:
    from vibroimpact.cases.elastic.modes import BodyModes
    from vibroimpact.modes.measured_table import MeasuredTable


def measured_modes(
    paths: Sequence[Path], target: Path, *, figures: bool, force: bool, as_json: bool
) -> None:
    """Print and write the modes in the frequency responses of universal files."""
    from vibroimpact.test_analysis.measured.modes_of_file import modes_of_files

    with exit_on_interrupt():
        measured = modes_of_files(paths)
    save_and_show(measured, target, force=force, figures=figures, as_json=as_json)


def modes_beside_table(bodies: Mapping[str, BodyModes], paths: Sequence[Path]) -> MeasuredTable:
    """Return measured modes beside those of the plate of a case."""
    from vibroimpact.test_analysis.measured.modes_of_file import modes_beside
    from vibroimpact.test_analysis.measured.report import compared_table

    return compared_table(modes_beside(bodies["plate"].basis if "plate" in bodies else None, paths))
