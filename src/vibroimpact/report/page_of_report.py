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
    scene = None
    if report.scenes:
        scene = dict(report.scenes[0].data)
    return render_page(
        __package__,
        report.page_charts,
        scene,
        name=report.title[:1].upper() + report.title[1:],
        report=report,
    )
