"""Cases prepared for `simulate`, kept for its next calls with the same structure."""

from collections import OrderedDict
from collections.abc import Hashable
from threading import Lock
from typing import Any

from rockflex.modal import Ground, RockingProperties
from rockflex.models import BoucWen, ImpactLaw, Model, Restitution, SidedRestitution, VVELComplete, VVELSimplified
from rockflex.study._case import Case

MOST = 32  # cases kept
LARGEST = 8_000_000  # bytes of the tables of one of them
FIXED = (VVELSimplified, VVELComplete, Restitution, SidedRestitution)  # impact laws that cannot change

_kept: OrderedDict[Hashable, tuple[Case, RockingProperties, Ground | None]] = OrderedDict()
_lock = Lock()


def prepared(
    model: Model,
    properties: RockingProperties,
    impact: ImpactLaw | None,
    bouc_wen: BoucWen | None,
    ground: Ground | None,
    options: dict[str, Any],
) -> Case:
    """Return the case of a model and a structure, the same one as before if all arguments are the same.

    The structure and the ground are the same only if they are the same objects, which cannot change. A user-defined
    impact law can, so that its cases are not kept.

    Raises
    ------
    InputError
        If the model does not apply to the structure, or its numbers overflow.
    """
    if impact is not None and type(impact) not in FIXED:
        return Case(model.of(properties, impact, bouc_wen, ground), **options)
    initial = options["initial"]
    rest = (model, impact, bouc_wen, options["free_vibration"], options["work_limit"], options["history"])
    key = (id(properties), id(ground), id(initial), *rest)
    with _lock:
        found = _kept.get(key)
        if found is not None:
            _kept.move_to_end(key)
            return found[0]
    case = Case(model.of(properties, impact, bouc_wen, ground), **options)
    with _lock:
        # What a key identifies is kept with it, so that no later object can have its place in memory.
        _kept[key] = case, properties, ground
        while len(_kept) > MOST:
            _kept.popitem(last=False)
    return case
