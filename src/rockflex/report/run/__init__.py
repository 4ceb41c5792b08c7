"""The report of a run: one page for an appendix, with all of its models side by side."""

from rockflex.report.run._report_page import checked_report_path, run_report_as_html, write_report
from rockflex.report.run._reported_runs import MAX_RUNS

__all__ = ["MAX_RUNS", "checked_report_path", "run_report_as_html", "write_report"]
