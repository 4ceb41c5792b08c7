"""The phases of a base that rocks about the edges of its base: what ends them, and what follows."""

from typing import TYPE_CHECKING

import numpy as np

from rockflex.models._elements import CLOSED, LEFT, RIGHT, border_of, changes_of, marks_of, set_off, turnings_of
from rockflex.models._phase import LANDS, LIFTS, OVERTURNS, RELEASES, Arrow, Exit, Guard, Key, Phase
from rockflex.models._pulls import pulls_of

if TYPE_CHECKING:
    from rockflex.models._modal_model import ModalModel

QUARTER_TURN = 0.5 * np.pi


def phase_of(model: "ModalModel", key: Key, arrow: Arrow | None) -> Phase:
    """Return a phase with its equations of motion; None if they are not linear."""
    p, elements, rest = model.properties, model.elements, key[1:]
    contact, right, left = (set_off(p, elements, (side, *rest), side) for side in (CLOSED, RIGHT, LEFT))
    free = model.is_free(key)
    turns, turnings = turnings_of(p, elements, key) if free else (0, ())
    return Phase(
        key=key,
        side=key[0],
        arrow=arrow,
        guard=guard_of(model, key),
        pulls=pulls_of(p, elements, key),
        changes=changes_of(p, elements, key) if free else (),
        turned=set_off(p, elements, key, 0),
        beside=(contact, right, left),
        free=free,
        turns=turns,
        turnings=turnings,
        marks=marks_of(elements, key),
    )


def guard_of(model: "ModalModel", key: Key) -> Guard:
    """Return the guard of a phase: impact and overturning while rocking, otherwise the overturning moment.

    In contact the moment ends the phase by uplift (Eqs. 16 and 24), at a rotation held by friction by a release.
    """
    if model.is_free(key):
        return _rotation_guard(model, key)
    if not model.lifts:
        unchanged = np.zeros((2, model.layout.remembered))
        return Guard(model.overturning_moment(), -np.inf, np.inf, None, None, unchanged)
    # The base starts to rotate when the forces of the following phase would turn it.
    p, (side, *rest) = model.properties, key
    following = [set_off(p, model.elements, (side or turn, *rest), turn) for turn in (1, -1)]
    borders = [border_of(p, model.elements, each, model.gravity) for each in following]
    low, high = (float(each.constant[0]) for each in borders)
    recall = np.stack([each.recall[0] for each in borders])
    below, above = (Exit(LIFTS if side == CLOSED else RELEASES, each) for each in following)
    turn = 0.0 if side == CLOSED else -float(borders[0].stiffness[0, 0])
    return Guard(model.overturning_moment(), low, high, below, above, recall, turn)


def _rotation_guard(model: "ModalModel", key: Key) -> Guard:
    row = np.zeros(model.layout.columns)
    row[model.layout.rotation] = 1.0
    unchanged = np.zeros((2, model.layout.remembered))
    lands = Exit(LANDS, set_off(model.properties, model.elements, (CLOSED, *key[1:]), 0))
    tips = Exit(OVERTURNS, key)
    if key[0] == RIGHT:
        return Guard(row, 0.0, QUARTER_TURN, lands, tips, unchanged)
    return Guard(row, -QUARTER_TURN, 0.0, tips, lands, unchanged)
