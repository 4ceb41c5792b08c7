"""Structures in TOML files."""

from rockflex.structure.file._element_tables import ELEMENTS, ElementTable, TendonTable
from rockflex.structure.file._entry import KINDS, StructureEntry
from rockflex.structure.file._read import build_in, read_structure, read_toml
from rockflex.structure.file._section_table import PartTable
from rockflex.structure.file._table import (
    Table,
    checked,
    expected,
    inner_table,
    key_of,
    label_of,
    parts,
    problems,
    spot_of,
)
from rockflex.structure.file._tables import Built, Structure, StructureTable

__all__ = [
    "ELEMENTS",
    "KINDS",
    "Built",
    "ElementTable",
    "PartTable",
    "Structure",
    "StructureEntry",
    "StructureTable",
    "Table",
    "TendonTable",
    "build_in",
    "checked",
    "expected",
    "inner_table",
    "key_of",
    "label_of",
    "parts",
    "problems",
    "read_structure",
    "read_toml",
    "spot_of",
]
