"""The tables and figures of Silva & Stojadinović (2024), with every number compared to print.

The paper is "Surrogate models for seismic response analysis of flexible rocking structures", Earthquake Engng Struct
Dyn, doi 10.1002/eqe.4193. A target is a table or a figure: a title, and a function of the records that returns a
`rockflex.report.ReproducedResult`. `_targets` lists them, each section of the paper has a module, and `_comparison` has
the rules by which a number passes.

The package also holds what the library has only for this paper: the random `population` and the equivalents of the two
tested specimens.
"""

from rockflex.papers.silva_stojadinovic_2024._comparison import RemarkKind, Verdict
from rockflex.papers.silva_stojadinovic_2024._equivalents import equivalent_2hz_long_base, equivalent_s1
from rockflex.papers.silva_stojadinovic_2024._inputs import SEED, SEEDS, PaperRecords, Piece
from rockflex.papers.silva_stojadinovic_2024._targets import (
    TARGETS,
    finish_target,
    reproduce_targets,
    target_cost,
    target_pieces,
    target_title,
)

__all__ = [
    "SEED",
    "SEEDS",
    "TARGETS",
    "PaperRecords",
    "Piece",
    "RemarkKind",
    "Verdict",
    "equivalent_2hz_long_base",
    "equivalent_s1",
    "finish_target",
    "reproduce_targets",
    "target_cost",
    "target_pieces",
    "target_title",
]
