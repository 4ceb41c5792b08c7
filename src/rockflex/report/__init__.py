"""Results as documents.

A run is one page of HTML, for an appendix; a publication is a page of HTML, the same as Markdown, and a table of
numbers.
"""

from rockflex.report._document import (
    ConstructionCheck,
    FinishedResult,
    PublicationReport,
    PublishedNumber,
    Remark,
    ReproducedResult,
)
from rockflex.report._publication_files import (
    report_numbers_to_csv,
    report_to_html,
    report_to_markdown,
    write_publication_report,
)
from rockflex.report.run import write_report

__all__ = [
    "ConstructionCheck",
    "FinishedResult",
    "PublicationReport",
    "PublishedNumber",
    "Remark",
    "ReproducedResult",
    "report_numbers_to_csv",
    "report_to_html",
    "report_to_markdown",
    "write_publication_report",
    "write_report",
]
