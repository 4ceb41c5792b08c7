"""Small hybrid systems with known answers; the engine knows none of them."""

import numpy as np

from rockflex.engine import Event, LinearPhase, Rest, StateLayout, System

GRAVITY = 9.81


def ball(restitution: float, rests_below: float | None = None) -> System:
    """A ball that falls on a floor; it stays there once it is slower than `rests_below`."""
    layout = StateLayout(height=1, speed=1)
    rest = None if rests_below is None else Rest(np.array([0.0, 1.0]), "rests", -rests_below)
    bounce = np.array([[0.0, 0.0], [0.0, -restitution]])

    def phase(key: str) -> LinearPhase:
        flies = key == "flies"
        A, c = np.zeros((2, 2)), np.array([0.0, -GRAVITY * flies])
        A[0, 1] = flies
        events = (Event("bounce", np.array([1.0, 0.0]), "flies", jump=bounce, rest=rest),) if flies else ()
        return LinearPhase(A, np.zeros(2), c, np.eye(2), np.zeros(2), np.zeros(2), events)

    return System(layout, ("height", "speed"), phase, "flies")


def bilinear(omega: float, damping: float, ratio: float, yields: float) -> System:
    """x'' + 2 ζ ω x' + ω² ((1 - r) (x - p) + r x) = -a, with |x - p| <= x_y; p is an internal variable."""
    layout = StateLayout(displacement=1, velocity=1, plastic=1)
    stretch = np.array([1.0, 0.0, -1.0])

    def phase(key: int) -> LinearPhase:
        A = np.zeros((3, 3))
        A[0, 1], A[1] = 1.0, (-(omega**2), -2.0 * damping * omega, (1.0 - ratio) * omega**2)
        A[2, 1] = abs(key)
        events = (
            (Event("unloading", np.array([0.0, key, 0.0]), 0),)
            if key
            else tuple(Event("yielding", -s * stretch, s, yields, scale=yields) for s in (1, -1))
        )
        force = omega**2 * np.array([1.0, 0.0, ratio - 1.0])
        return LinearPhase(
            A,
            np.array([0.0, -1.0, 0.0]),
            np.zeros(3),
            np.stack((layout.unit("displacement"), force)),
            np.zeros(2),
            np.zeros(2),
            events,
        )

    return System(layout, ("displacement", "force"), phase, 0)


def blocks(gap: float, size: float, restitution: float, friction: tuple[float, float]) -> System:
    """Two equal blocks in a row on a floor with friction: the first slides against the second."""
    layout = StateLayout(place=2, velocity=2)
    hit = np.eye(4)
    hit[2:, 2:] = 0.5 * np.array([[1.0 - restitution, 1.0 + restitution], [1.0 + restitution, 1.0 - restitution]])
    apart = np.array([-1.0, 1.0, 0.0, 0.0])

    def phase(slides: tuple[bool, bool]) -> LinearPhase:
        A, c = np.zeros((4, 4)), np.zeros(4)
        events = [Event("impact", apart, (True, True), -size, jump=hit)] if slides[0] else []
        for k in range(2):
            A[k, 2 + k], c[2 + k] = slides[k], -friction[k] * GRAVITY * slides[k]
            if slides[k]:
                stops = np.eye(4)
                stops[2 + k, 2 + k] = 0.0
                follows = tuple(moves and j != k for j, moves in enumerate(slides))
                events.append(Event("stop", np.eye(4)[2 + k], follows, jump=stops))
        return LinearPhase(A, np.zeros(4), c, np.eye(4), np.zeros(4), np.zeros(4), tuple(events))

    return System(layout, ("first", "second", "speed", "speed of the second"), phase, (True, False))
