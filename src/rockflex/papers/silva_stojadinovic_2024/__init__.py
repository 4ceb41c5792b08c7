"""The tables and figures of Silva & Stojadinović (2024), a module a target, each number beside the printed one.

The paper is "Surrogate models for seismic response analysis of flexible rocking structures", Earthquake Engng Struct
Dyn, doi 10.1002/eqe.4193. A target is a module with a ``TITLE`` and a function ``reproduce(records)`` that returns a
`Result`. What lets a number pass is written in one place, `_verdict`.
"""

from rockflex.papers.silva_stojadinovic_2024._catalogue import TARGETS, reproduce, title_of
from rockflex.papers.silva_stojadinovic_2024._records import Records
from rockflex.papers.silva_stojadinovic_2024._result import Result
from rockflex.papers.silva_stojadinovic_2024._verdict import Number, Verdict

__all__ = ["TARGETS", "Number", "Records", "Result", "Verdict", "reproduce", "title_of"]
