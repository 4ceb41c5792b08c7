"""The fast path of the adaptive engine: step after step, sample after sample, as long as nothing can hide in them."""

from rockflex._kernel import kernel
from rockflex.solve.adaptive.glance import nothing_hides
from rockflex.solve.adaptive.layout import Flow, Stages
from rockflex.solve.adaptive.step import FAILED, step_over, take_step
from rockflex.solve.exact.history import append
from rockflex.solve.exact.layout import Array, Log

__all__ = ["glide"]


@kernel
def glide(
    flow: Flow,
    record: Array,
    dt: float,
    first: int,
    offset: int,
    side: float,
    log: Log,
    stages: Stages,
    nodes: Array,
    count: int,
) -> tuple[int, float, int]:
    """Carry the motion over samples from `first` on; stop before a step that needs a closer look, or at the end.

    `offset` is the number of samples before this record. Returns the sample reached, how far into it, and the count of
    nodes.
    """
    rate = 1.0 / dt
    for i in range(first, record.size - 1):
        slope = (record[i + 1] - record[i]) * rate
        done = 0.0
        while done < dt:
            here, longest = record[i] + slope * done, dt - done
            step = take_step(flow, side, here, slope, longest, stages)
            clear = step != FAILED
            if not (clear and nothing_hides(flow, side, here, slope, step, (offset + i) * dt + done, log, stages)):
                return i, done, count
            step_over(stages)
            done = dt if step == longest else done + step
        if nodes.shape[0] > 0:
            count = append(nodes, count, (offset + i + 1) * dt, side, record[i + 1], stages.motion)
    return record.size - 1, 0.0, count
