"""The numbers of a report as a table for other programs."""

import csv
import io
import math

from rockflex.report._document import Document

COLUMNS = ("target", "place", "name", "printed", "rockflex", "unit", "difference", "criterion", "verdict", "note")


def to_csv(document: Document) -> str:
    """Write one row per number, with a header, in UTF-8; `rockflex` has all digits, or "inf" or "nan".

    Examples
    --------
    >>> from rockflex.report import Document, to_csv
    >>> document = Document("A title", "A paper, 2024", "none", {"rockflex": "1"}, {"met": "within 1 %"}, {}, [])
    >>> to_csv(document).split(",")[:3]
    ['target', 'place', 'name']
    """
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(COLUMNS)
    for section in document.sections:
        for line in section.numbers:
            ours = repr(line.ours) if math.isfinite(line.ours) else f"{line.ours:g}"
            writer.writerow(
                (
                    section.name, line.place, line.name, line.printed, ours, line.unit, line.difference_as_text,
                    line.criterion, line.verdict, line.note,
                )
            )  # fmt: skip
    return out.getvalue()
