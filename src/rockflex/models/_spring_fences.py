"""What ends a phase of a base on springs: springs that unload, lift or land, a slip that begins or ends, elements."""

import numpy as np

from rockflex.models._based import horizontal_reaction
from rockflex.models._elements import memories
from rockflex.models._phase import CHANGES, CLOSES, OPENS, SLIPS, STICKS, Fence, Key
from rockflex.models._spring_forces import LIFTED, LOADED, RECEDING, STICK, SpringForces


def fences_of(model: SpringForces, key: Key) -> tuple[Fence, ...]:
    """Return the fences of a phase: those of the springs, of the slip and of the elements."""
    return (*_of_springs(model, key), *_of_slip(model, key), *_of_elements(model, key))


def _of_springs(model: SpringForces, key: Key) -> list[Fence]:
    found, last = list[Fence](), model.springs.n - 1
    for j, branch in enumerate(key[1 : model.springs.n + 1]):
        depth, push, edge = model.depths[j], model.pushes[j], j in (0, last)
        damped = model.springs.damping[j] > 0.0
        if branch == LOADED:
            following = RECEDING if damped else LIFTED
            event = OPENS if edge and not damped else CHANGES
            found.append(Fence(push, event, _with(key, 1 + j, following)))
        elif branch == LIFTED:
            found.append(Fence(depth, CLOSES if edge else CHANGES, _with(key, 1 + j, LOADED)))
        else:
            found.append(Fence(-push, CHANGES, _with(key, 1 + j, LOADED)))
            found.append(Fence(-depth, OPENS if edge else CHANGES, _with(key, 1 + j, LIFTED)))
    return found


def _of_slip(model: SpringForces, key: Key) -> list[Fence]:
    if model.friction is None:
        return []
    place = model.springs.n + 1
    if key[place] == STICK:
        held, grip = horizontal_reaction(model, model.accelerations(key)), model.grip(key)
        # The ground pushes to the right on a base that would slide to the left.
        return [Fence(grip - held, SLIPS, _with(key, place, -1)), Fence(grip + held, SLIPS, _with(key, place, 1))]
    going = np.zeros(model.layout.columns)
    going[model.layout.slip + 1] = key[place]
    return [Fence(going, STICKS, _with(key, place, STICK))]


def _of_elements(model: SpringForces, key: Key) -> list[Fence]:
    found, known = list[Fence](), memories(model.elements)
    for k, each in enumerate(model.elements):
        place = model.springs.n + 2 + k
        branch, stretch = key[place], model.stretch(each)
        offset, value = each.turning(branch), None
        if offset is not None:
            value = stretch.copy()
            value[-1] -= offset
        memory = known[k] if value is not None else -1
        for stop in each.stops(branch):
            row = -stretch
            row[-1] += stop.place
            if k in known:
                row[model.layout.memory + known[k]] += stop.recall
            way = 1.0 if stop.upper else -1.0
            found.append(Fence(way * row, CHANGES, _with(key, place, stop.branch), memory, value))
        if each.direction(branch) != 0:
            row = each.direction(branch) * model.risen(each.position)[1]
            found.append(Fence(row, CHANGES, _with(key, place, each.stopped(branch)), memory, value))
    return found


def _with(key: Key, place: int, branch: int) -> Key:
    return (*key[:place], branch, *key[place + 1 :])
