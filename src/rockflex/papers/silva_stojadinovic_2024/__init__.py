"""The tables and figures of Silva & Stojadinović (2024), one module for each, with every number compared to print.

The paper is "Surrogate models for seismic response analysis of flexible rocking structures", Earthquake Engng Struct
Dyn, doi 10.1002/eqe.4193. A target is a module with a ``TITLE`` and a function ``reproduce(records)`` that returns a
`rockflex.report.Result`. The rules by which a number passes are all in `_number`.

The package also holds what the library has only for this paper: the random `population` and the equivalents of the two
tested specimens.
"""

from rockflex.papers.silva_stojadinovic_2024._catalogue import TARGETS, reproduce, title_of
from rockflex.papers.silva_stojadinovic_2024._equivalents import equivalent_2hz_long_base, equivalent_s1
from rockflex.papers.silva_stojadinovic_2024._records import Records
from rockflex.papers.silva_stojadinovic_2024._verdict import Kind, Verdict

__all__ = [
    "TARGETS",
    "Kind",
    "Records",
    "Verdict",
    "equivalent_2hz_long_base",
    "equivalent_s1",
    "reproduce",
    "title_of",
]
