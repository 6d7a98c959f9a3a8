"""The modes of measured frequency responses, for the command `modes`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from vibroimpact.cli.shared import exit_on_interrupt, show_folder, stem

if TYPE_CHECKING:
    from vibroimpact.cases.elastic.modes import BodyModes
    from vibroimpact.modes.measured_table import MeasuredTable


def measured_modes(
    paths: Sequence[Path], target: Path, *, figures: bool, force: bool, as_json: bool
) -> None:
    """Print and write the modes in the frequency responses of universal files."""
    from vibroimpact.test_analysis.measured.document import summary_of_measured
    from vibroimpact.test_analysis.measured.folder import save_measured_modes
    from vibroimpact.test_analysis.measured.modes_of_file import modes_of_files
    from vibroimpact.test_analysis.measured.text import measured_summary

    name = stem(str(paths[0]))
    with exit_on_interrupt():
        found = modes_of_files(paths)
        folder = save_measured_modes(
            found, name, target, force=force, figures=("png",) if figures else ()
        )
    show_folder(
        folder,
        lambda: summary_of_measured(found),
        lambda: measured_summary(found, name),
        as_json=as_json,
    )


def modes_beside_table(bodies: Mapping[str, BodyModes], paths: Sequence[Path]) -> MeasuredTable:
    """Return measured modes beside those of the plate of a case."""
    from vibroimpact.test_analysis.measured.document import compared_table
    from vibroimpact.test_analysis.measured.modes_of_file import modes_beside

    return compared_table(modes_beside(bodies["plate"].basis if "plate" in bodies else None, paths))
