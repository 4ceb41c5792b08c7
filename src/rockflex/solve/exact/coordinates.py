"""From the coordinates of a phase to the state, and back."""

from rockflex._kernel import kernel
from rockflex._vectors import set_products
from rockflex.solve.layout import INTO, NOW, OUT, PARTS, TOTALS, Motion, Progress, System


@kernel
def to_state(system: System, at: Progress, ground: float, motion: Motion) -> None:
    """Compute the state from the coordinates of the present phase."""
    p, slope, w, still = at.phase, at.slope, motion.w[NOW], motion.still
    by_ground, by_slope = system.forced[p, 0], system.forced[p, 1]
    state, parts = motion.beyond[TOTALS], motion.beyond[PARTS]
    for k in range(w.size):
        parts[k] = w[k] + (by_ground[k] * ground + by_slope[k] * slope) + still[k]
    set_products(state, system.basis[p, OUT], parts, w.size, 1)
    for i in range(w.size):
        motion.state[i] = state[i]


@kernel
def to_coordinates(system: System, at: Progress, ground: float, motion: Motion) -> None:
    """Compute the coordinates of the present phase from the state."""
    p, slope, w, still = at.phase, at.slope, motion.w[NOW], motion.still
    by_ground, by_slope, found = system.forced[p, 0], system.forced[p, 1], motion.beyond[TOTALS]
    set_products(found, system.basis[p, INTO], motion.state, w.size, 1)
    for k in range(w.size):
        w[k] = found[k] - (by_ground[k] * ground + by_slope[k] * slope) - still[k]
