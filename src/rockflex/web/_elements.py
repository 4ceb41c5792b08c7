"""The elements between the base and the ground in a response: their peaks, and what closes the base."""

from typing import Any

from rockflex.modal import RockingProperties, Tendon, YieldingDissipator
from rockflex.response import Response


def chosen_element(asked: object, p: RockingProperties) -> int | None:
    """Return the element whose loop is drawn: the one asked for, or the first; None if there are none."""
    if not p.elements:
        return None
    return asked if type(asked) is int and 0 <= asked < len(p.elements) else 0


def elements_view(p: RockingProperties, response: Response, *, energies: bool) -> dict[str, Any]:
    """Return the peaks of every element in a model that lifts; their energies, which take longer, if wanted."""
    dissipated = response.element_energy.tolist() if energies else [None] * len(p.elements)
    prestress = iter(response.remaining_prestress.tolist())
    columns = (response.max_element_force, response.max_element_elongation, response.element_yielded)
    rows = [
        {
            "force": force,
            "elongation": elongation,
            "energy": energy,
            "yielded": yielded,
            "broken": _breaks_at(element) <= elongation,
            "prestress": next(prestress) if isinstance(element, Tendon) else None,
        }
        for element, force, elongation, yielded, energy in zip(
            p.elements, *(column.tolist() for column in columns), dissipated, strict=True
        )
    ]
    return {"label": response.model, "rows": rows}


def _breaks_at(element: object) -> float:
    """Return the elongation in m at which an element breaks; infinite if it never does."""
    found = element.rupture_elongation if isinstance(element, Tendon | YieldingDissipator) else None
    return float("inf") if found is None else found


def self_centring(p: RockingProperties, rotation: float) -> list[dict[str, Any]]:
    """Return whether weight and prestress close the base about each edge, where dissipators keep it open.

    `ratio` is λ at a vanishing rotation, and `at` that at a rotation in rad, the smaller of both edges.
    """
    at = p.recentring_ratio_at(rotation) if rotation > 0.0 and p.elements else None
    return [
        {"side": pivot.side, "closes": pivot.self_centring, "ratio": pivot.recentring_ratio, "at": at}
        for pivot in p.pivots
        if pivot.dissipator_moment > 0.0
    ]
