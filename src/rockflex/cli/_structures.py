"""A structure from a TOML file or from the flags of a frame."""

import math
import tomllib
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from pydantic import ValidationError

from rockflex._errors import InputError
from rockflex.cli._schema import FrameTable, PropertiesTable, StructureFile, Table, problems
from rockflex.modal import RockingProperties
from rockflex.structure import Frame, LumpedStructure

__all__ = ["LoadedStructure", "describe_properties", "load_structure", "split_arguments"]

FLAGS = {"n_stories": "--stories"}  # the others are named after their argument
ASSUMED = {"impact", "restitution", "bouc_wen"}
KINDS: dict[str, type[Frame | LumpedStructure | RockingProperties]] = {
    "frame": Frame,
    "lumped": LumpedStructure,
    "properties": RockingProperties,
}


@dataclass(frozen=True)
class LoadedStructure:
    """A structure, and what it was made of."""

    name: str
    kind: str
    values: dict[str, Any]
    built: Frame | LumpedStructure | RockingProperties
    assumed: dict[str, Any] = field(default_factory=dict[str, Any])
    """What the file says beside: `impact`, `restitution` and `bouc_wen`, each where it is there."""

    @property
    def properties(self) -> RockingProperties:
        """Parameters of the rocking structure with all its modes."""
        return self.built if isinstance(self.built, RockingProperties) else self.built.rocking()

    @property
    def reference_mass(self) -> float:
        """Mass above the base in kg, which all modes share; the total mass where only properties are known."""
        if isinstance(self.built, RockingProperties):
            return self.built.m_tot
        lumped = self.built.lumped if isinstance(self.built, Frame) else self.built
        return float(np.sum(lumped.masses))

    @property
    def title(self) -> str:
        """One line for the head of a table."""
        p = self.properties
        modes = "1 mode" if p.n_modes == 1 else f"{p.n_modes} modes"
        slenderness = p.effective_height[0] / p.half_width
        period = 2.0 * math.pi / p.omega[0]
        return f"{self.name}: {modes}, T_1 = {period:.4g} s, h*_1/B = {slenderness:.4g}, ζ_1 = {p.zeta[0]:.4g}"

    def describe(self) -> dict[str, Any]:
        """Return what it was made of, for a document."""
        return {"name": self.name, "kind": self.kind, **self.values, **self.assumed}


def split_arguments(option: Path | None, arguments: Sequence[str]) -> tuple[Path | None, list[str]]:
    """Take the structure file, given by --structure or as the first argument, from the arguments of a command.

    Raises
    ------
    InputError
        If it was given in both ways.
    """
    if not arguments or not arguments[0].lower().endswith(".toml"):
        return option, list(arguments)
    if option is not None:
        message = f"Two structures were given, {option} and {arguments[0]}. Give one at a time."
        raise InputError(message)
    return Path(arguments[0]), list(arguments[1:])


def load_structure(file: Path | None, flags: dict[str, Any]) -> LoadedStructure:
    """Build a structure from a TOML file, or from flags (None where not given) named as the arguments of `Frame`.

    Raises
    ------
    InputError
        If there is no structure or more than one, the file cannot be read, or a key or value in it is wrong; the
        message names the file and the key.
    """
    given = {name: value for name, value in flags.items() if value is not None}
    if file is None:
        return _from_flags(given, [name for name in flags if name not in given])
    if given:
        message = f"The structure was given by {file} and by {_flags(given)}. Give one or the other."
        raise InputError(message)
    document = _read(file)
    kind = next(kind for kind in KINDS if getattr(document, kind) is not None)
    table: Table = getattr(document, kind)
    values = table.model_dump(exclude_none=True)
    try:
        built = KINDS[kind](**values)
    except InputError as error:
        message = f"{file}, [{kind}]: {error}"
        raise InputError(message) from error
    assumed = document.model_dump(include=ASSUMED, exclude_none=True)
    return LoadedStructure(document.name or file.stem, kind, values, built, assumed)


def describe_properties(properties: RockingProperties) -> dict[str, Any]:
    """Return every parameter of a rocking structure by its name, for a document."""
    names = (*PropertiesTable.model_fields, "resisting_moment", "nominal_overturning_rotation")
    return {name: getattr(properties, name) for name in names}


def _from_flags(given: dict[str, Any], missing: list[str]) -> LoadedStructure:
    if missing:
        lack = "No structure was given." if not given else f"The frame lacks {_flags(missing)}."
        needed = _flags(FrameTable.model_fields)
        message = f"{lack} Give a structure file, such as structure.toml, or all the flags of a frame: {needed}."
        raise InputError(message)
    frame = Frame(**given)
    return LoadedStructure(f"{frame.n_stories}-story frame", "frame", given, frame)


def _flags(names: Iterable[str]) -> str:
    return ", ".join(FLAGS.get(name, "--" + name.replace("_", "-")) for name in names)


def _read(file: Path) -> StructureFile:
    try:
        content = tomllib.loads(file.read_text("utf-8"))
    except FileNotFoundError as error:
        message = f"The structure file {file} does not exist (working directory: {Path.cwd()})."
        raise InputError(message) from error
    except OSError as error:
        message = f"The structure file {file} cannot be read: {error.strerror}."
        raise InputError(message) from error
    except ValueError as error:  # not TOML, or not UTF-8
        message = f"{file} is not a valid TOML file: {error}."
        raise InputError(message) from error
    try:
        document = StructureFile.model_validate(content)
    except ValidationError as error:
        message = f"{file}: {' '.join(problems(error, content))}"
        raise InputError(message) from error
    tables = [kind for kind in KINDS if kind in content]
    if len(tables) != 1:
        found = " and ".join(f"[{kind}]" for kind in tables) or "none"
        message = f"{file} must hold one structure, [frame], [lumped] or [properties], but {found} was found."
        raise InputError(message)
    return document
