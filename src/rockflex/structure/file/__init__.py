"""Structures in TOML files."""

from rockflex.structure.file._object_entries import entry_of_object_table
from rockflex.structure.file._object_tables import (
    CLASS,
    arguments_in_table,
    object_from_table,
    object_table,
    structure_from_table,
)
from rockflex.structure.file._structure_entry import (
    ELEMENTS,
    KINDS,
    ElementTable,
    StructureEntry,
    TendonTable,
    build_structure_in_file,
    read_structure,
    read_toml_file,
)
from rockflex.structure.file._structure_tables import Built, PartTable, Structure, StructureTable
from rockflex.structure.file._toml_table import (
    TomlTable,
    first_table_in_annotation,
    members_of_annotation,
    parse_toml_table,
    schema_key_of_field,
    toml_key_label,
    toml_problem_place,
    toml_problem_sentences,
    valid_value_description,
)

__all__ = [
    "CLASS",
    "ELEMENTS",
    "KINDS",
    "Built",
    "ElementTable",
    "PartTable",
    "Structure",
    "StructureEntry",
    "StructureTable",
    "TendonTable",
    "TomlTable",
    "arguments_in_table",
    "build_structure_in_file",
    "entry_of_object_table",
    "first_table_in_annotation",
    "members_of_annotation",
    "object_from_table",
    "object_table",
    "parse_toml_table",
    "read_structure",
    "read_toml_file",
    "schema_key_of_field",
    "structure_from_table",
    "toml_key_label",
    "toml_problem_place",
    "toml_problem_sentences",
    "valid_value_description",
]
