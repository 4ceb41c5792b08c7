"""The inputs of the page's reports in words: the fields of the structure, and the records' target."""

import math
from collections.abc import Iterator
from typing import Any

from rockflex.foundation.language import translated
from rockflex.foundation.number_format import rounded_number
from rockflex.foundation.shown import shortened
from rockflex.foundation.units import QUANTITIES, UnitSystem
from rockflex.web._forms import forms_of_structures, material_name
from rockflex.web._selection import SELECTED, target_spectrum_of_choice
from rockflex.web._state import PageState
from rockflex.web._structure import build_page_structure

MOST = 600  # letters of the fields of a structure: reports have room for some more
_OF_UNIT = {"m": "length", "N/m²": "elastic modulus", "Pa": "stress"}  # of several that have it in SI
_QUANTITIES = {names[2]: quantity for quantity, names in reversed([*QUANTITIES.items()])} | _OF_UNIT


def input_notes(state: PageState, *, of_set: bool = False) -> list[str]:
    """Return the fields of the structure with their units, and for a set of records their target, a text each."""
    units, entry = UnitSystem(state.units), state.structure
    form = forms_of_structures()["kinds"][entry.kind]
    given = entry.model_dump(exclude_none=True)[entry.kind]
    fields = ", ".join(_field_texts(form["fields"], given, units))
    found = [shortened(f"{translated('Input')}: {translated(form['title'])}: {fields}.", MOST)]
    if of_set and state.record_set.suites == [SELECTED]:
        p = build_page_structure(entry).properties
        first = f"; T_1 = {rounded_number(2.0 * math.pi / float(p.omega[0]))} s" if p.n_modes else ""
        choice = state.target
        periods = f"{rounded_number(choice.shortest)}–{rounded_number(choice.longest)} s"
        found.append(f"{translated('Target')}: {target_spectrum_of_choice(choice).name}, {periods}{first}.")
    return found


def _field_texts(specs: list[dict[str, Any]], given: dict[str, Any], units: UnitSystem) -> Iterator[str]:
    """Yield each field that is given as its label and its value, and before them the material that they make."""
    if material := material_name(given):
        yield translated(material)
    for spec in specs:
        value, label = given.get(spec["name"]), translated(spec["label"])
        label = label[:1].lower() + label[1:]
        if spec["name"] == "shape" or value == 0:
            continue
        if isinstance(value, dict):
            shape = [translated(value["shape"])] if "shape" in value else []
            inner = [*shape, *_field_texts(spec.get("fields", []), value, units), *_part_texts(value, units)]
            yield f"{label} ({', '.join(inner)})"
        elif value is not None and not isinstance(value, bool):
            yield f"{label} {_value_text(value, spec.get('unit', ''), units)}"


def _part_texts(section: dict[str, Any], units: UnitSystem) -> Iterator[str]:
    """Yield each part of a composite cross-section."""
    specs = forms_of_structures()["section_part"]
    for part in section.get("parts", ()):
        yield f"({', '.join([translated(part['shape']), *_field_texts(specs, part, units)])})"


def _value_text(value: Any, si: str, units: UnitSystem) -> str:
    size, name = units.of(_QUANTITIES[si]) if si in _QUANTITIES else (1.0, si)
    if isinstance(value, list):
        texts = [_value_text(each, "", units) if isinstance(each, list) else _rounded(each, size) for each in value]
        return f"{' '.join(texts)} {name}".strip()
    return f"{_rounded(value, size)} {name}".strip()


def _rounded(value: Any, size: float) -> str:
    if not isinstance(value, int | float):
        return str(value)
    text = rounded_number(value / size, 6)
    return text.rstrip("0").rstrip(".") if "." in text else text
