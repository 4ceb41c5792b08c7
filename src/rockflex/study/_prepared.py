"""Cases that `simulate` prepared, kept for its next calls with the same structure."""

from collections import OrderedDict
from collections.abc import Hashable
from threading import Lock

from rockflex.modal import RockingProperties
from rockflex.models import (
    Model,
    Restitution,
    SidedRestitution,
    VVELComplete,
    VVELSimplified,
)
from rockflex.motion import GroundMotion
from rockflex.response import Response
from rockflex.study._case import Case
from rockflex.study._run_options import RunOptions

MOST = 32  # cases kept
LARGEST, TOGETHER = 64_000_000, 256_000_000  # bytes of the tables of a case, and of all
FIXED = (VVELSimplified, VVELComplete, Restitution, SidedRestitution)  # impact laws that cannot change

_kept: OrderedDict[Hashable, tuple[Case, RockingProperties, RunOptions]] = OrderedDict()
_lock = Lock()


def run_prepared(
    model: Model,
    properties: RockingProperties,
    options: RunOptions,
    motion: GroundMotion,
    *,
    history: bool,
) -> Response:
    """Run a motion on a structure, with the case of an earlier run if everything but the motion is the same.

    The structure and the ground are the same only if they are the same objects, which cannot change; a user-defined
    impact law can. A case is kept only for the time step of its run, and not if its run failed or its tables are
    expensive, so that no run depends on those before it.

    Raises
    ------
    InputError
        If the model does not apply to the structure, its numbers overflow, or the run exceeds its work limit.
    SolverError
        If the run cannot be solved.
    """
    rest = (options.bouc_wen, options.free_vibration, options.work_limit, history, motion.dt)
    key = (id(properties), id(options.ground), id(options.initial), model, options.impact, *rest)
    keeps = options.impact is None or type(options.impact) in FIXED
    case = _known(key) if keeps else None
    if case is not None:
        return case.run(motion)
    case = options.case(model, properties, history=history, floors=history)
    response = case.run(motion)
    if keeps and case.engine.size <= LARGEST:
        with _lock:
            # What a key identifies is kept with it, so that no later object can have its place in memory.
            _kept[key] = case, properties, options
            while len(_kept) > MOST or sum(each.engine.size for each, *_ in _kept.values()) > TOGETHER:
                _kept.popitem(last=False)
    return response


def _known(key: Hashable) -> Case | None:
    with _lock:
        found = _kept.get(key)
        if found is None:
            return None
        _kept.move_to_end(key)
        return found[0]
