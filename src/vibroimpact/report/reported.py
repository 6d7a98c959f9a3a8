"""Findings with a report: read as data, drawn and saved by one interface."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from importlib import import_module
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

from vibroimpact.charts.chart import Chart
from vibroimpact.errors import InputError, choices
from vibroimpact.quoting import quoted
from vibroimpact.report.report import Report, Table

if TYPE_CHECKING:
    import plotly.graph_objects as go


class WithReport:
    """A finding of a task with its report, which is read as data and drawn.

    A subclass names the module whose function `report_of` returns the report of a finding: what a
    task computes does not depend on how it is reported.
    """

    _reported_in: ClassVar[str]

    def __init_subclass__(cls, reported_in: str = "", **options: Any) -> None:
        super().__init_subclass__(**options)
        if reported_in:
            cls._reported_in = reported_in

    @cached_property
    def report(self) -> Report:
        """The report: title, answer, tables, charts, warnings and files, as data."""
        report: Report = import_module(self._reported_in).report_of(self)
        return report

    @property
    def charts(self) -> dict[str, Chart]:
        """The charts of the report, by name."""
        return {chart.name: chart for chart in self.report.all_charts}

    @property
    def tables(self) -> list[Table]:
        """The tables of the report; not those that are shortened for terminals."""
        return [
            block
            for section in self.report.sections
            if section.medium != "terminal"
            for block in section.blocks
            if isinstance(block, Table)
        ]

    @property
    def document(self) -> dict[str, Any]:
        """The finding as data in SI: what the command prints with `--json`."""
        return self.report.document

    def plot(self, name: str | None = None) -> go.Figure:
        """Return a chart of the report as a figure of plotly, by its name.

        Parameters
        ----------
        name : str, optional
            Name of the chart; by default the main one.

        Raises
        ------
        InputError
            If there is no chart of that name.
        """
        from vibroimpact.charts.notebook import plotly_figure

        charts = self.charts
        if not charts:
            raise InputError("there are no charts, as nothing that they would show varies")
        if name is None:
            name = self.report.main_chart or next(iter(charts))
        if name in charts:
            return plotly_figure(charts[name])
        further = self.report.further_charts
        if name in further:
            return plotly_figure(further[name]())
        known = choices([*charts, *further], str(name))
        raise InputError(f"there is no chart {quoted(name)}; there are {known}")

    def _repr_html_(self) -> str | None:
        from vibroimpact.report.html_report import html_report

        return html_report(self.report)


class Reported(WithReport):
    """A finding of a task with its report, which is also saved as a folder."""

    def save(
        self,
        directory: str | PathLike[str],
        *,
        force: bool = False,
        figures: Sequence[str] = (),
    ) -> Path:
        """Write the report and its data as a folder, atomically, and return its path.

        Parameters
        ----------
        directory : path
            The folder to create.
        force : bool, default False
            Replace an existing result folder.
        figures : sequence of str
            Formats in which the charts are also written as files, into a folder `figures`: of
            "png", "svg" and "pdf".

        Raises
        ------
        InputError
            If the folder exists and may not be replaced, or it can't be written to.
        """
        from vibroimpact.report.save_report import save_report

        return save_report(self.report, directory, force=force, figures=figures)
