"""A population of random structures: a structure with formulas in place of numbers."""

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, cast

from rockflex._constants import GRAVITY
from rockflex._errors import InputError
from rockflex.modal import Ground, RockingProperties
from rockflex.structure.file import StructureEntry, Table, checked, label_of
from rockflex.study._arguments import properties_of
from rockflex.study._option_tables import GroundTable
from rockflex.study.monte_carlo._formula import is_formula, names_of, value_of
from rockflex.study.monte_carlo._variables import Variables, check_known

HELD = ("tendons", "elements")
FACTS = {
    "weight": "the weight m_tot g of the structure in N",
    "weight_moment": "the moment m_tot g B of the weight in N m",
    "half_width": "the half width B of the base in m",
    "l0r_g": "the moment L_0^r g of the weight, a radian, in N m",
}
"""What formulas of tendons, elements and the ground may use besides the variables."""

Place = tuple[str | int, ...]


class _Holder(Table):
    structure: StructureEntry


class _GroundHolder(Table):
    ground: GroundTable


class Population:
    """Structures that differ in the values of variables.

    Parameters
    ----------
    variables
        The variables.
    structure
        A structure as a file describes it, with formulas such as "= 0.3 * weight" in place of some numbers.
    folder
        Where relative paths of files of numbers start.
    ground
        The ground as a file describes it, with formulas in place of some numbers; None for rigid ground.

    Raises
    ------
    InputError
        If a formula cannot be read, or refers to unknown names.
    """

    def __init__(
        self, variables: Variables, structure: Mapping[str, Any], folder: Path, ground: Mapping[str, Any] | None = None
    ) -> None:
        self.variables, self._structure, self._folder, self._ground = variables, structure, folder, ground
        for place, formula in (*_formulas(structure, ("structure",)), *_formulas(ground, ("ground",))):
            label, held = label_of(place), place[0] == "ground" or place[1] in HELD
            try:
                needed = names_of(formula)
            except InputError as error:
                raise InputError(f"{label}: {error}") from error
            if not held and (early := sorted(needed & FACTS.keys())):
                raise InputError(
                    f"{label}: {early[0]} is known only after the structure is built, so only formulas of elements, "
                    "tendons and the ground may use it."
                )
            check_known(label, needed, variables.kinds | (FACTS if held else {}))

    def entry(self, values: Mapping[str, float]) -> StructureEntry:
        """Return the structure without tendons and elements for values of the variables.

        Raises
        ------
        InputError
            If a formula has no value, or a key is unknown, missing, or of the wrong kind.
        """
        return _checked({key: value for key, value in self._structure.items() if key not in HELD}, values)

    def build(self, values: Mapping[str, float]) -> RockingProperties:
        """Return the structure for values of the variables.

        Raises
        ------
        InputError
            As `entry`, or if a value is out of range or values contradict each other.
        """
        free = properties_of(self.entry(values).build(self._folder))
        if not any(self._structure.get(key) for key in HELD):
            return free
        return properties_of(_checked(self._structure, {**values, **facts_of(free)}).hold(free))

    def ground_under(self, properties: RockingProperties, values: Mapping[str, float]) -> Ground | None:
        """Return the ground under a structure for values of the variables.

        Raises
        ------
        InputError
            If a formula has no value, a key is unknown, missing, or of the wrong kind, or a value is out of range.
        """
        if self._ground is None:
            return None
        content = _filled(self._ground, {**values, **facts_of(properties)}, ("ground",))
        return checked(_GroundHolder, {"ground": content}).ground.under(properties)


def facts_of(properties: RockingProperties) -> dict[str, float]:
    """Return the values of `FACTS`."""
    weight = properties.m_tot * GRAVITY
    return {
        "weight": weight,
        "weight_moment": weight * properties.half_width,
        "half_width": properties.half_width,
        "l0r_g": properties.l0r * GRAVITY,
    }


def _checked(content: Mapping[str, Any], values: Mapping[str, float]) -> StructureEntry:
    return checked(_Holder, {"structure": _filled(content, values, ("structure",))}).structure


def _formulas(content: object, place: Place) -> Iterator[tuple[Place, str]]:
    if is_formula(content):
        yield place, str(content)
    for key, each in _items(content):
        yield from _formulas(each, (*place, key))


def _filled(content: Any, values: Mapping[str, float], place: Place) -> Any:
    """Return the content with the values of its formulas."""
    if is_formula(content):
        try:
            return value_of(content, values)
        except InputError as error:
            raise InputError(f"{label_of(place)}: {error}") from error
    filled = ((key, _filled(each, values, (*place, key))) for key, each in _items(content))
    if isinstance(content, Mapping):
        return dict(filled)
    return [each for _, each in filled] if isinstance(content, list) else content


def _items(content: object) -> Iterator[tuple[str | int, Any]]:
    if isinstance(content, Mapping):
        yield from cast("Mapping[str, Any]", content).items()
    elif isinstance(content, list):
        yield from enumerate(cast("list[Any]", content))
