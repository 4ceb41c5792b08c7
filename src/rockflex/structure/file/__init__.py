"""Structures as TOML files hold them."""

from rockflex.structure.file._entry import KINDS, StructureEntry, TendonTable
from rockflex.structure.file._read import build_in, read_structure, read_toml
from rockflex.structure.file._table import NUMBER, Table, beside, checked, expected, number, problems
from rockflex.structure.file._tables import Built, Structure, StructureTable

__all__ = [
    "KINDS",
    "NUMBER",
    "Built",
    "Structure",
    "StructureEntry",
    "StructureTable",
    "Table",
    "TendonTable",
    "beside",
    "build_in",
    "checked",
    "expected",
    "number",
    "problems",
    "read_structure",
    "read_toml",
]
