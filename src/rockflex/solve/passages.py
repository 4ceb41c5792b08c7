"""From one phase to the next: what is known of the motion as a phase is entered."""

import numpy as np

from rockflex._kernel import inlined_kernel, kernel
from rockflex.models import CHANGES, LANDS, OVERTURNS, SLIPS, STICKS, TURNS, Impact, may_pass
from rockflex.solve.adaptive.layout import Integrator
from rockflex.solve.carrier import free_inertia
from rockflex.solve.exits import INSIDE, LIFTED, TOUCHED
from rockflex.solve.layout import (
    BESIDE,
    CHANGED,
    FOLLOWING,
    FOLLOWS,
    KIND,
    LOW,
    SETS,
    TURNED,
    TURNING,
    Motion,
    Progress,
    System,
    unit_of,
)
from rockflex.solve.memory import recollect
from rockflex.solve.peaks import row_at


@kernel
def enter(system: System, at: Progress, phase: int, motion: Motion) -> None:
    """Continue in another phase from the present state; in a linear phase the grid is resumed at `at.place`."""
    at.phase, at.tuned, at.stated = phase, False, True
    levels = system.phases[phase].levels
    at.place = min(int(at.begun / unit_of(system, levels)), (1 << levels) - 1)
    recollect(system, phase, motion)


@inlined_kernel
def set_off(system: System, steps: Integrator | None, at: Progress, bound: int, excess: float, motion: Motion) -> None:
    """Continue with a base that begins to rotate because the moment exceeds a limit."""
    enter(system, at, system.links[at.phase, FOLLOWS + bound], motion)
    inertia = free_inertia(system, steps, at.phase, motion.state)
    at.lift = (1.0 if bound == LOW else -1.0) * excess / inertia


@kernel
def start_crossing(at: Progress, fresh_rows: bool) -> None:
    """Start advancing event by event; with `fresh_rows` it is not known which rows may have a peak."""
    at.crossing, at.fresh_rows, at.onset, at.lift, at.resume = True, fresh_rows, INSIDE, np.nan, 0.0
    at.slip_onset, at.slide = INSIDE, np.nan


@inlined_kernel
def pass_fence(system: System, at: Progress, fence: int, stop: float, motion: Motion) -> None:
    """Continue in the phase beyond a fence."""
    p, layout = at.phase, system.layout
    event, memory = system.fence_kinds[p, fence, KIND], system.fence_kinds[p, fence, SETS]
    if memory >= 0:
        value = row_at(system.fence_values, p, fence, 0.0, motion.state)
        motion.state[layout.memory + memory] = value
    if event == STICKS:
        motion.state[layout.slip + 1] = 0.0
    # A slip grows like t³ from the instant at which the friction is just used up, like t² if it never sufficed.
    at.slip_onset = (TOUCHED if stop > 0.0 else LIFTED) if event == SLIPS else INSIDE
    at.slide = 0.0 if event == SLIPS and stop > 0.0 else np.nan
    if at.onset >= LIFTED:  # an uplift at this instant continues with the forces of the next phase
        at.onset, at.lift = LIFTED, np.nan
    enter(system, at, system.links[p, system.fenced + fence], motion)


@kernel
def beside(side: float) -> int:
    """Return the offset from `BESIDE` of the phase with the base on a side."""
    return 0 if side == 0.0 else (1 if side > 0.0 else 2)


@kernel
def lacks(system: System, at: Progress, event: int, bound: int, owner: int, fence: int, impact: Impact) -> int:
    """Return the place of a phase needed after an event but not yet compiled; -1 if there is none."""
    p = at.phase
    if fence >= 0:
        place = system.fenced + fence
        return TURNING + 1 + place - CHANGED if system.links[p, place] < 0 else -1
    if event == TURNS:
        return TURNING if system.links[p, TURNED] < 0 else -1
    if event == CHANGES:
        return TURNING + 1 + owner if system.links[p, CHANGED + owner] < 0 else -1
    if event == LANDS:
        for place in range(3):
            needed = place == 0 or (may_pass(impact) and place != beside(system.phases[p].side))
            if needed and system.links[p, BESIDE + place] < 0:
                return place
    elif event != OVERTURNS and system.links[p, FOLLOWS + bound] < 0:
        return FOLLOWING + bound
    return -1
