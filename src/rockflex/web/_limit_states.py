"""The limit states of the page, with their labels."""

from typing import Annotated, Any, NamedTuple

from rockflex.fragility import LIMIT_STATES, NOMINAL, OVERTURNING, ROCKED, ROCKING, LimitState, beyond
from rockflex.web._names import among


class Asked(NamedTuple):
    """The labels of a limit state."""

    name: str
    clause: str  # in the list "Limit state"
    noun: str  # in the design tab; empty if it does not offer this limit


LIMIT = f"the nominal limit {NOMINAL.label.replace('_1', '₁')}"
ROTATION = "rotation"  # whose size the visitor chooses
ASKED = (
    Asked(ROCKING.name, f"it rocks (uplift with θ > {1e3 * ROCKED:g} mrad)", ""),
    Asked(ROTATION, "the rotation exceeds …", "a rotation"),
    Asked(NOMINAL.name, LIMIT, LIMIT),
    Asked(OVERTURNING.name, "it overturns", OVERTURNING.label),
)


LimitName = Annotated[str, among(lambda: [each.name for each in ASKED])]
DesignLimit = Annotated[str, among(lambda: [each.name for each in ASKED if each.noun])]


def limit_state(name: str, rotation: float) -> LimitState:
    """Return a limit by its name on the page; `rotation` in rad is that of "rotation"."""
    return beyond(rotation) if name == ROTATION else LIMIT_STATES[name]


def limit_states() -> list[dict[str, Any]]:
    """Return the labels of all limit states."""
    return [each._asdict() for each in ASKED]
