"""The structure file of the command line: a structure, and what `rockflex run` is to assume of it."""

from rockflex.structure.file import StructureEntry
from rockflex.study.assumed import Assumed


class StructureFile(Assumed, StructureEntry):
    """A structure file: one structure, perhaps a name and tendons, and what `rockflex run` is to assume of it."""
