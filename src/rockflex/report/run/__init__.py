"""The report of a run: one page for an appendix, with all of its models side by side."""

from rockflex.report.run._given import MOST
from rockflex.report.run._write import checked_path, report_html, write_report

__all__ = ["MOST", "checked_path", "report_html", "write_report"]
