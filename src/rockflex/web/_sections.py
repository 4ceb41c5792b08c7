"""What the page shows of a cross-section."""

from typing import Any

from rockflex.structure.file import Table


def section_facts(table: Table) -> list[dict[str, Any]]:
    """Return area, second moment, stiffness and mass of the cross-section of a structure; none without one."""
    given: Any = getattr(table, "section", None)
    if given is None:
        return []
    section = given.build()
    composite = given.shape == "composite"
    of_first = ", in the material of the first part" if composite else ""
    return [
        {"symbol": "A", "value": section.area, "unit": "m²", "help": f"area{of_first}"},
        {"symbol": "I", "value": section.second_moment, "unit": "m⁴", "help": f"second moment of area{of_first}"},
        {"symbol": "EI", "value": section.bending_stiffness, "unit": "N m²", "help": "effective bending stiffness"},
        {"symbol": "m", "value": section.mass_per_length, "unit": "kg/m", "help": "mass per metre of height"},
    ]
