"""Structures in TOML files."""

from rockflex.structure.file._entry import (
    ELEMENTS,
    KINDS,
    ElementTable,
    StructureEntry,
    TendonTable,
    build_in,
    read_structure,
    read_toml,
)
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
from rockflex.structure.file._tables import Built, PartTable, Structure, StructureTable

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
