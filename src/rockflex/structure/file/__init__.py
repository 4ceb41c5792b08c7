"""Structures in TOML files."""

from rockflex.structure.file._structure_file import read_structure

__all__ = [
    "read_structure",
]
