"""Results as documents.

A run is one page of HTML, for an appendix; a publication is a page of HTML, the same as Markdown, and a table of
numbers.
"""

from rockflex.report._document import Check, Document, Number, Remark, Result
from rockflex.report._write import to_csv, to_html, to_markdown, write_document
from rockflex.report.run import write_report

__all__ = [
    "Check",
    "Document",
    "Number",
    "Remark",
    "Result",
    "to_csv",
    "to_html",
    "to_markdown",
    "write_document",
    "write_report",
]
