"""From the coordinates of a phase to the state, and back."""

from rockflex._kernel import kernel
from rockflex.solve.layout import INTO, NOW, OUT, Motion, Progress, System


@kernel
def to_state(system: System, at: Progress, ground: float, motion: Motion) -> None:
    """Compute the state from the coordinates of the present phase."""
    p, size = at.phase, motion.w.shape[1]
    for i in range(size):
        motion.state[i] = 0.0
    for k in range(size):
        forced = system.forced[p, 0, k] * ground + system.forced[p, 1, k] * at.slope
        value = motion.w[NOW, k] + forced + motion.still[k]
        for i in range(size):
            motion.state[i] += system.basis[p, OUT, k, i] * value


@kernel
def to_coordinates(system: System, at: Progress, ground: float, motion: Motion) -> None:
    """Compute the coordinates of the present phase from the state."""
    p, size = at.phase, motion.w.shape[1]
    for k in range(size):
        forced = system.forced[p, 0, k] * ground + system.forced[p, 1, k] * at.slope
        motion.w[NOW, k] = -forced - motion.still[k]
    for i in range(size):
        for k in range(size):
            motion.w[NOW, k] += system.basis[p, INTO, i, k] * motion.state[i]
