"""The report of a run: one page for an appendix, with all of its models side by side."""

from rockflex.report.run._page import checked_path, report_html, write_report
from rockflex.report.run._runs import MOST

__all__ = ["MOST", "checked_path", "report_html", "write_report"]
