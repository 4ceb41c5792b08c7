"""The Structure tab: the structure, its modes, its cross-section, and the ground under it."""

import json
import math
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from rockflex.engine.stops import check_interruption
from rockflex.foundation.errors import InputError
from rockflex.foundation.json import as_json_value
from rockflex.foundation.language import translated
from rockflex.structure._adequacy import adequacy
from rockflex.structure._attachment import PLACE
from rockflex.structure._from_matrices import DegreesOfFreedom
from rockflex.structure._ground import Ground
from rockflex.structure._outline import StructureOutline, has_shapes, structure_outline
from rockflex.structure._pivot import Pivot
from rockflex.structure._rocking import RockingProperties
from rockflex.structure._structure import Structure, structure_warnings
from rockflex.structure._uplifted import uplifted_modes
from rockflex.structure.file._structure_entry import StructureEntry
from rockflex.structure.file._structure_tables import MatricesTable, ModesTable, StructureTable
from rockflex.structure.file._toml_table import TomlTable
from rockflex.studies._ground_tables import GroundTable
from rockflex.web._refusal import Refusal, errors_as_refusals

SLICED = ("cantilever", "beam", "tapered_tower", "wall_frame")  # kinds whose floors are slices of what is continuous
MAX_SPRINGS_DRAWN = 9  # springs of a drawing, at most


def ground_under_page_structure(table: GroundTable | None, p: RockingProperties) -> Ground | None:
    """Return the ground under a structure, None if it is rigid and the base cannot slide."""
    try:
        return None if table is None else table.under(p)
    except InputError as error:
        raise Refusal({error.field or "ground": error.said}) from error


def ground_view(ground: Ground | None, p: RockingProperties) -> dict[str, Any] | None:
    """Return where the springs of a drawing are, how far the base settles, and the ground's stiffness and damping."""
    if ground is None:
        return None
    view: dict[str, Any] = {"slides": ground.slides, "springs": [], "facts": []}
    if ground.springs is None:
        return view
    springs = ground.springs
    kept = np.unique(np.linspace(0, springs.n - 1, min(springs.n, MAX_SPRINGS_DRAWN)).round().astype(int))
    settlement = p.resting_reaction / springs.total_stiffness
    ratio = 0.5 * springs.total_damping / math.sqrt(springs.total_stiffness * p.m_tot)
    return view | {
        "springs": springs.positions[kept],
        "facts": [
            _fact("w", settlement, "m", "settlement of the axis under the weight") | {"quantity": "displacement"},
            _fact("Σk", springs.total_stiffness, "N/m", "vertical stiffness of all springs"),
            _fact("Σkx²", springs.rotational_stiffness, "N m/rad", "rotational stiffness of all springs"),
            _fact("ζ_z", ratio, "", "damping of the heave mode, as a share of critical"),
            _fact("I_b", ground.base_inertia, "kg m²", "rotary inertia of base and floors"),
        ],
    }


def _fact(symbol: str, value: float | None, unit: str, said: str) -> dict[str, Any]:
    return {"symbol": symbol, "value": value, "unit": unit, "help": said}


def section_facts(table: TomlTable) -> list[dict[str, Any]]:
    """Return area, second moment, stiffness and mass of the cross-section of a structure; none without one."""
    given: Any = getattr(table, "section", None)
    if given is None:
        return []
    section = given.build()
    one = given.shape != "composite"
    return [
        _fact("A", section.area, "m²", "area" if one else "area, in the material of the first part"),
        _fact("I", section.second_moment, "m⁴", "second moment of area" if one else "second moment of area, likewise"),
        _fact("EI", section.bending_stiffness, "N m²", "effective bending stiffness"),
        _fact("m", section.mass_per_length, "kg/m", "mass per metre of height"),
    ]


MAX_MODES_DRAWN = 6  # modes drawn
RECENTRING_HELP = (
    "moment of weight and prestress over that of the dissipators; above 1 the base closes by itself; at θ → 0"
)


@dataclass(frozen=True, eq=False)
class BuiltStructure:
    """A structure that can be simulated and drawn.

    Attributes
    ----------
    structure
        The structure itself.
    properties
        Its parameters with all modes.
    outline
        Its lines at rest.
    """

    structure: Structure | RockingProperties
    properties: RockingProperties
    outline: StructureOutline


def build_page_structure(entry: StructureEntry) -> BuiltStructure:
    """Build a structure, or return it from the cache."""
    try:
        return _build_structure_from_json(json.dumps(entry.model_dump(exclude_none=True)))
    except InputError as error:
        raise Refusal({_form_field_path(entry, error.field): error.said}) from error
    except (ArithmeticError, MemoryError, RuntimeError, ValueError) as error:  # of linear algebra, at absurd numbers
        message = "the modes cannot be computed from these numbers; check their sizes and units."
        raise Refusal({"structure": message}) from error


@lru_cache(maxsize=64)
def _build_structure_from_json(text: str) -> BuiltStructure:
    entry = StructureEntry.model_validate(json.loads(text))
    structure = entry.build()
    properties = structure.rocking()
    return BuiltStructure(structure, properties, structure_outline(properties, structure))


def structure_view(entry: StructureEntry, table: GroundTable | None = None, *, quick: bool = False) -> dict[str, Any]:
    """Return the outline of a structure and the ground under it; not `quick`, its parameters and modes as well."""
    check_interruption()
    built = build_page_structure(entry)
    p = built.properties
    drawn = structure_outline_view(entry, built, ground_under_page_structure(table, p))
    if quick:
        return as_json_value(drawn)
    with errors_as_refusals("structure"):
        check_interruption()
        modes = _mode_facts(built)
        check_interruption()
        judged = _mode_adequacy_view(entry, p)
    return as_json_value(
        {
            **drawn,
            "name": entry.name,
            "shapes": built.outline.shapes[:, :MAX_MODES_DRAWN].T,
            "properties": _rocking_parameter_facts(p),
            "freedoms": _freedoms_of_matrices_text(entry.table),
            "section": section_facts(entry.table),
            "warnings": structure_warnings(built.structure),
            "modes": modes,
            "adequacy": judged,
        }
    )


def structure_outline_view(entry: StructureEntry, built: BuiltStructure, ground: Ground | None) -> dict[str, Any]:
    """Return the data of the drawing of a structure and of the ground under it."""
    p, outline, drawn = built.properties, built.outline, built.outline.elements
    points = np.concatenate([*(each.points for each in outline.strokes), *(ends for _, ends in drawn)])
    return {
        "kind": entry.kind,
        "heights": outline.heights,
        "shapes_known": has_shapes(built.structure),
        "mass": p.m_tot,  # whose weight stands on the base
        "period": 2.0 * np.pi / p.omega[0] if p.n_modes else None,
        "half_width": p.half_width,
        "eccentricity": p.eccentricity,
        "reach": float(np.abs(points[:, 0]).max()),
        "turning": outline.turning if math.isfinite(outline.turning) else None,
        "strokes": [each._asdict() for each in outline.strokes],
        "elements": [
            {name: getattr(table, name) for name in ("kind", *PLACE)} | {"symbol": symbol, "ends": ends}
            for table, (symbol, ends) in zip(entry.elements or [], drawn, strict=True)
        ],
        "ground": ground_view(ground, p),
    }


def _freedoms_of_matrices_text(table: StructureTable) -> str:
    """Describe the degrees of freedom of given matrices; empty for other structures."""
    if not isinstance(table, MatricesTable | ModesTable):
        return ""
    given = table.arguments(Path())
    mass = np.asarray(given["mass"])
    size = len(mass)
    found = DegreesOfFreedom.of(given["heights"], given.get("rotations", ()), size)
    others = size - found.translates.size - found.rotates.size
    sideways, rotational = found.translates.size, found.rotates.size
    kinds = [translated("{n} sideways", n=sideways)] * bool(sideways)
    kinds += [translated("{n} rotational", n=rotational)] * bool(rotational)
    kinds += [translated("{n} other", n=others)] * bool(others)
    told = translated("Degrees of freedom: {kinds}.", kinds=", ".join(kinds))
    bare = size - int(np.count_nonzero(mass.any(axis=1) if mass.ndim == 2 else mass))
    condensed = bare and isinstance(table, MatricesTable)
    return f"{told} {translated('Without mass, and condensed out: {n}.', n=bare)}" if condensed else told


def _mode_adequacy_view(entry: StructureEntry, p: RockingProperties) -> dict[str, Any] | None:
    """How many modes are enough, and why."""
    if not p.n_modes:
        return None
    base = getattr(entry.table, "base_mass", None)
    try:
        found = adequacy(p, base_mass=base)
    except InputError:  # a mass of the base that contradicts the rest
        found = adequacy(p)
    return {"reason": found.reason}


def _rocking_parameter_facts(p: RockingProperties) -> list[dict[str, Any]]:
    """Return the parameters with symbols, units and meaning, for each edge of the base where the two differ."""
    moved = _fact("e", p.eccentricity, "m", "masses to the right of the base's middle")
    leaning = _fact("Σ l", p.leaning_mass, "kg", "mass on other columns; {share} % of the weight is on the base")
    base = [
        _fact("B", p.half_width, "m", "half the width of the base"),
        *([moved] if p.eccentricity else []),
        *(
            []
            if p.restitution is None
            else [_fact("η", p.restitution, "", "velocity after an impact over that before")]
        ),
        _fact("m_tot", p.m_tot, "kg", "total mass with the base"),
        *([leaning | {"share": round(100 * p.weight_share)}] if p.leaning_mass else []),
    ]
    arm = _fact("L₀ʳ", p.l0r, "kg m", "sum of mass times height")
    if p.symmetric:
        lifting, *rest = _pivot_parameter_facts(p, p.pivot(1))
        return [*base, lifting, arm, *rest]
    return [*base, arm, *(each for pivot in p.pivots for each in _pivot_parameter_facts(p, pivot))]


def _pivot_parameter_facts(p: RockingProperties, pivot: Pivot) -> list[dict[str, Any]]:
    alpha = pivot.balance_rotation if math.isfinite(pivot.balance_rotation) else None
    limit = pivot.nominal_overturning_rotation
    turned = {"quantity": "rotation"}
    facts = [
        _fact("M_r", pivot.resisting_moment, "N m", "moment at which the base lifts"),
        _fact("I_θ", pivot.i_theta, "kg m²", "inertia about the pivot"),
        _fact("a_lift", pivot.uplift_acceleration, "m/s²", "slow ground acceleration that lifts the base"),
        *(
            [_fact("α", alpha, "rad", "rotation beyond which it does not return to the upright position") | turned]
            * (p.n_modes > 0)
        ),
        *([_fact("λ", pivot.recentring_ratio, "", RECENTRING_HELP)] if pivot.dissipator_moment > 0.0 else []),
        (
            _fact("θ_nom", limit, "rad", "nominal limit 0.7 atan(B/h*₁)")
            if p.symmetric
            else _fact("θ_nom", limit, "rad", "nominal limit 0.7 atan(b/h*₁), b to this edge")
        )
        | turned,
    ]
    none = {"none": "the tendons always bring it back"}
    edge = {} if p.symmetric else {"edge": pivot.side}
    return [fact | edge | (none if fact["value"] is None else {}) for fact in facts]


def _mode_facts(built: BuiltStructure) -> list[dict[str, Any]]:
    p = built.properties
    if not p.n_modes:
        return []
    lifted = [uplifted_modes(p, side=pivot.side) for pivot in p.pivots]
    return [
        {
            "period": 2.0 * np.pi / p.omega[n],
            "effective_mass": p.effective_mass[n],
            "mass_share": p.effective_mass[n] / p.horizontal_mass,
            "effective_height": p.effective_height[n],
            "damping": p.zeta[n],
            "uplifted": [
                {
                    "period": 2.0 * np.pi / each.omega[n] if each.omega[n] > 0.0 else None,
                    "damping": each.damping_ratio[n],
                }
                for each in lifted
            ],
        }
        for n in range(p.n_modes)
    ]


def _form_field_path(entry: StructureEntry, name: str | None) -> str:
    """Return the path of a field of the form, or of the whole form if it has no such field."""
    if name in type(entry.table).model_fields:
        return f"structure.{entry.kind}.{name}"
    own = name is not None and name.partition(".")[0] in type(entry).model_fields
    return f"structure.{name}" if own else "structure"
