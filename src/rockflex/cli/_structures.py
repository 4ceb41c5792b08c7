"""A structure from a TOML file or flags, and the tables and documents that describe it."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rockflex.cli import _console as console
from rockflex.cli._options import flags_of_tables, naming_flags_in_errors
from rockflex.foundation.errors import InputError
from rockflex.foundation.schema import FrameFlags, FrameSchema
from rockflex.foundation.shown import number_with_noun
from rockflex.foundation.units import UnitSystem
from rockflex.structure._attachment import element_parameters
from rockflex.structure._base_element import BaseElement
from rockflex.structure._frames import Frame
from rockflex.structure._outline import has_shapes, innermost_structure
from rockflex.structure._rocking import RockingProperties
from rockflex.structure._structure import Eccentric, structure_warnings
from rockflex.structure.file._element_tables import ELEMENTS
from rockflex.structure.file._object_tables import CLASS, structure_from_table
from rockflex.structure.file._structure_entry import KINDS
from rockflex.structure.file._structure_file import build_structure_in_file, read_toml_file
from rockflex.structure.file._structure_tables import Built
from rockflex.structure.file._toml_table import parse_toml_table
from rockflex.studies._case_keys import RunOptionKeys, StructureFile

if TYPE_CHECKING:
    from rich.table import Table


ELEMENT_UNITS = {
    "position": "m",
    "initial_force": "N",
    "stiffness": "N/m",
    "yield_force": "N",
    "rupture_elongation": "m",
    "coefficient": "N s/m",
    "force": "N",
}
_ELEMENT_COLUMNS = (  # symbol, the parameters that it may be, quantity and unit
    ("x", ("position",), "length"),
    ("k", ("stiffness",), "stiffness", "kN/m"),
    ("c", ("coefficient",), "damping"),
    ("F_0", ("initial_force",), "force"),
    ("strength", ("yield_force", "force"), "force"),
    ("α", ("post_yield_ratio",), "ratio"),
    ("breaks at", ("rupture_elongation",), "displacement", "m"),
)
_WORDS = 2  # columns of words


def describe_elements(elements: Sequence[BaseElement]) -> list[dict[str, Any]]:
    """Return the kind and the values of each element, for a document."""
    return [{"kind": _element_kind(each), **element_parameters(each)} for each in elements]


def elements_table(elements: Sequence[BaseElement], units: UnitSystem) -> "Table":
    """Return the table of elements, without the columns that none of them needs."""
    columns = [(symbol, units.of(*quantity)) for symbol, _, *quantity in _ELEMENT_COLUMNS]
    headings = ["no.", "element", *(unit.heading(symbol) for symbol, unit in columns)]
    sizes = [unit.size for _, unit in columns]
    rows = [(str(place), *_element_row(each, sizes)) for place, each in enumerate(elements, start=1)]
    kept = [k for k in range(len(headings)) if k < _WORDS or any(row[k] != "-" for row in rows)]
    return console.table([headings[k] for k in kept], ([row[k] for k in kept] for row in rows), _WORDS)


def _element_row(element: BaseElement, sizes: Sequence[float]) -> tuple[str, ...]:
    given = element_parameters(element) | {"position": element.place}
    if not element.rate_dependent:
        given.pop("coefficient", None)  # of a law that damps nothing it is something else
    values = {name: value for name, value in given.items() if isinstance(value, float)}
    cells = [
        console.number(next((values[name] / size for name in names if name in values), None))
        for (_, names, *_), size in zip(_ELEMENT_COLUMNS, sizes, strict=True)
    ]
    place = element.where if element.attached else cells[0]
    only = ", tension only" if given.get("tension_only") else ""
    return (_element_kind(element).replace("_", " ") + only, place, *cells[1:])


def _element_kind(element: BaseElement) -> str:
    return next((kind for kind, table in ELEMENTS.items() if table.makes is type(element)), type(element).__name__)


FLAGS = flags_of_tables(FrameFlags)


@dataclass(frozen=True)
class LoadedStructure:
    """A structure, and the values that it was built from."""

    name: str
    kind: str
    values: dict[str, Any]
    built: Built
    run_options: dict[str, Any] = field(default_factory=dict[str, Any])
    """`impact`, `restitution`, `bouc_wen` and `ground`, as far as the file has them."""
    file: Path | None = None
    report: dict[str, Any] = field(default_factory=dict[str, Any])
    """The values of ``[report]``."""

    @property
    def properties(self) -> RockingProperties:
        """Parameters of the rocking structure with all its modes."""
        return self.built.rocking()

    @property
    def base_mass(self) -> float | None:
        """Mass of the base in kg; None where only properties are known."""
        if not has_shapes(self.built):
            return None
        return float(getattr(innermost_structure(self.built), "base_mass", 0.0))

    @property
    def reference_mass(self) -> float:
        """Mass above the base in kg; the total mass where only properties are known."""
        return self.properties.horizontal_mass - (self.base_mass or 0.0)

    @property
    def title(self) -> str:
        """Title of a table, in one line."""
        p = self.properties
        shift = f", e = {p.eccentricity:.4g} m" if p.eccentricity else ""
        if p.n_modes == 0:
            return f"{self.name}: rigid, B/h = {p.half_width * p.m_tot / p.l0r:.4g}{shift}"
        modes = number_with_noun(p.n_modes, "mode")
        slenderness = p.effective_height[0] / p.half_width
        period = 2.0 * math.pi / p.omega[0]
        return f"{self.name}: {modes}, T_1 = {period:.4g} s, h*_1/B = {slenderness:.4g}, ζ_1 = {p.zeta[0]:.4g}{shift}"

    @property
    def warnings(self) -> tuple[str, ...]:
        """Warnings about values that may be in another unit."""
        return structure_warnings(self.built)

    def describe(self) -> dict[str, Any]:
        """Return the values that it was built from, for a document."""
        return {"name": self.name, "kind": self.kind, **self.values, **self.run_options}


def split_structure_file_argument(option: Path | None, arguments: Sequence[str]) -> tuple[Path | None, list[str]]:
    """Return the structure file, given by --structure or as the first argument, and the remaining arguments."""
    if not arguments or not arguments[0].lower().endswith(".toml"):
        return option, list(arguments)
    if option is not None:
        raise InputError(f"Two structures were given, {option} and {arguments[0]}. Give one at a time.")
    return Path(arguments[0]), list(arguments[1:])


def load_structure(file: Path | None, flags: dict[str, Any]) -> LoadedStructure:
    """Build a structure from a TOML file, or from flags named as in `FrameFlags`."""
    if file is None:
        return _frame_from_flags(flags)
    if flags:
        raise InputError(f"The structure was given by {file} and by {_flag_names_text(flags)}. Give one or the other.")
    content = read_toml_file(file, "structure")
    if "study" in content:
        raise _study_in_place_of_structure(file, content["study"])
    if "structures" in content:
        raise InputError(f"{file} is a case, but the file of one structure is expected. Use rockflex run {file}.")
    if CLASS in content:
        return LoadedStructure(file.stem, str(content[CLASS]), content, structure_from_table(content, str(file)))
    document = parse_toml_table(StructureFile, content, str(file))
    run_options = document.model_dump(include=set(RunOptionKeys.model_fields), exclude_unset=True)
    built = build_structure_in_file(file, document)
    head = {} if document.report is None else document.report.model_dump(exclude_none=True)
    name = document.name or file.stem
    return LoadedStructure(name, document.kind, document.describe(), built, run_options, file, head)


def _study_in_place_of_structure(file: Path, name: object) -> InputError:
    """Return the error for the file of a study in place of one of a structure."""
    from rockflex.studies._study_kind import KINDS

    known = isinstance(name, str) and name in KINDS
    remedy = f"Use rockflex {KINDS[str(name)].command} {file}." if known else "rockflex --help lists the studies."
    return InputError(f"{file} is the file of a study, but one of a structure is expected. {remedy}")


def describe_rocking_properties(properties: RockingProperties) -> dict[str, Any]:
    """Return every parameter of a rocking structure by name, for a document; `pivots` where the two differ."""
    names = (
        *KINDS["properties"].model_fields,
        "resisting_moment",
        "nominal_overturning_rotation",
        "uplift_acceleration",
    )
    tendons = ("tendons", "prestress", "tendon_stiffness") if properties.tendons else ()
    held = ("self_centring", "recentring_ratio") if properties.elements else ()
    described = {name: getattr(properties, name) for name in (*names, *tendons, *held)}
    if properties.elements:
        described["elements"] = describe_elements(properties.elements)
    if properties.opens != "both":
        described["opens"] = properties.opens
    if properties.symmetric:
        return described
    pivots = [asdict(each) | {"resisting_moment": each.resisting_moment} for each in properties.pivots]
    return described | {"eccentricity": properties.eccentricity, "pivots": pivots}


def _frame_from_flags(given: dict[str, Any]) -> LoadedStructure:
    needed = flags_of_tables(FrameSchema)
    missing = [name for name in needed if name not in given]
    if missing:
        lack = f"The frame lacks {_flag_names_text(missing)}." if given else "No structure was given."
        raise InputError(
            f"{lack} Give a structure file, such as structure.toml, or all the flags of a frame: "
            f"{_flag_names_text(needed)}."
        )
    with naming_flags_in_errors(FLAGS):
        frame = Frame(**{name: value for name, value in given.items() if name in needed})
        built = Eccentric(frame, given["eccentricity"]) if "eccentricity" in given else frame
    return LoadedStructure(f"{frame.n_stories}-story frame", "frame", given, built)


def _flag_names_text(names: Iterable[str]) -> str:
    return ", ".join(FLAGS[name] for name in names)
