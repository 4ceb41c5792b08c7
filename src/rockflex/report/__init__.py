"""Results as documents.

A run is one page of HTML, for an appendix; a publication is a page of HTML, the same as Markdown, and a table of
numbers.
"""

from rockflex.report._csv import to_csv
from rockflex.report._document import Document
from rockflex.report._html import to_html
from rockflex.report._line import Check, Number
from rockflex.report._markdown import to_markdown
from rockflex.report._result import Remark, Result
from rockflex.report._write import write_document
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
