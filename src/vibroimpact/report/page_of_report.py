"""The page of a report: one file that needs no network."""

from __future__ import annotations

from vibroimpact.report.page import render_page
from vibroimpact.report.report import Report


def page_of_report(report: Report) -> str:
    """Return the page of a report.

    Parameters
    ----------
    report : Report
        The report.

    Examples
    --------
    >>> page = page_of_report(Report("Two balls", (), {}, answer="They collide."))
    >>> '<p class="status">They collide.</p>' in page
    True
    """
    title = report.title[:1].upper() + report.title[1:]
    return render_page(__package__, report.all_charts, name=title, report=report)
