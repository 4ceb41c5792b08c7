"""Quantities of the complete models that are not linear in the motion (Silva & Stojadinović 2024, Eqs. 3-22).

In contact, and always in the simplified models, every quantity is a linear row over the motion. While a complete model
rocks, displacements are nonlinear in the rotation, and forces depend on accelerations.
"""

import math
from typing import NamedTuple

from rockflex._arrays import Array
from rockflex._kernel import kernel, python_kernel
from rockflex.models._field import ARM, MASS, PULLS, Field, pivot_at, take_pulls
from rockflex.models._pulls import DRAG, FORCE, PULL
from rockflex.models._sines import sine_and_cosine

LINEAR = 0  # the row itself
SWAY = 1  # horizontal displacement of a point at the height levers[0]; the row gives its u (Eq. 3)
LEFT_OUT = 2  # the row and the masses left out: levers[0] is Σ m_i or Σ m_i h_i, levers[1] Σ m_i h_i or Σ m_i h_i²
SWING = 3  # rate of the elongation of an element per unit distance from the pivot; the row gives θ'
HORIZONTAL = 4  # Σ F_x (Eq. 21) including the forces of elements
VERTICAL = 5  # Σ F_z (Eq. 22 with the sign of the weight corrected) including the forces of elements


class Posture(NamedTuple):
    """Values common to all quantities at one instant of rocking."""

    sine: float
    cosine: float
    shift: float  # s B (1 - cos θ), horizontal displacement of the middle of the base
    drive: float  # a cos θ - (g + a_v) sin θ + s B θ'^2, acceleration of the masses along the base
    turn: float  # θ''
    horizontal: float  # Σ F_x
    vertical: float  # Σ F_z


@kernel
def posture_of(field: Field, side: float, acceleration: float, rise: float, motion: Array, rates: Array) -> Posture:
    """Return the posture of a motion while rocking; `rates` contains D'' and θ''."""
    n = field.modes.shape[1]
    gravity = field.gravity + rise
    spin, turn = motion[2 * n + 1], float(rates[2 * n + 1])
    sine, cosine = sine_and_cosine(float(motion[2 * n]))
    pivot = pivot_at(side)
    offset = side * field.pivots[pivot, ARM]
    across = field.total_mass * offset  # Σ m_i (s B - u_i)
    speed = push = 0.0
    for i in range(n):
        across -= field.modes[MASS, i] * motion[i]
        speed += field.modes[MASS, i] * motion[n + i]
        push += field.modes[MASS, i] * rates[n + i]
    along, beside = across * cosine - field.weight_arm * sine, across * sine + field.weight_arm * cosine
    # An element points from its present anchor on the base to its position in contact: at θ/2 from the vertical.
    aside = upwards = 0.0  # forces of the elements
    force, stiffness, drag = (
        field.pivots[pivot, PULLS + FORCE],
        field.pivots[pivot, PULLS + PULL],
        field.pivots[pivot, PULLS + DRAG],
    )
    if force != 0.0 or stiffness != 0.0 or drag != 0.0:
        upright = math.sqrt(0.5 + 0.5 * cosine)  # cos θ/2
        half = 0.5 * sine / upright
        pull = force + 2.0 * stiffness * abs(half) + drag * upright * side * spin
        aside, upwards = pull * half, pull * upright
    square, coriolis = spin * spin, 2.0 * spin * speed
    return Posture(
        sine=sine,
        cosine=cosine,
        shift=offset * sine * sine / (1.0 + cosine),  # without the cancellation of 1 - cos θ
        drive=acceleration * cosine - gravity * sine + square * offset,
        turn=turn,
        horizontal=field.total_mass * acceleration
        + (turn * beside + push * cosine - coriolis * sine + square * along + aside),
        vertical=field.total_mass * field.gravity
        + (turn * along - push * sine - coriolis * cosine - square * beside + upwards)
        + field.total_mass * rise,
    )


@kernel
def observe(kind: int, value: float, near: float, far: float, posture: Posture) -> float:
    """Return one quantity of a posture from the value of its row and its two levers."""
    if kind == SWAY:
        return posture.shift + near * posture.sine + value * posture.cosine
    if kind == LEFT_OUT:
        return value - near * posture.drive - far * posture.turn
    if kind == SWING:
        return value * math.sqrt(0.5 + 0.5 * posture.cosine)
    if kind == HORIZONTAL:
        return posture.horizontal
    if kind == VERTICAL:
        return posture.vertical
    return value


@python_kernel
def observe_all(
    field: Field,
    pulls: Array,
    kind: int,
    values: Array,
    near: float,
    far: float,
    side: Array,
    acceleration: Array,
    rise: Array,
    motion: Array,
    rates: Array,
) -> None:
    """Replace the `values` (n,) of a row by the quantity at many instants.

    `pulls` has the shape (n, 7); `rise` is the vertical acceleration of the ground; `motion` and `rates` have 2N + 2
    columns or more.
    """
    for k in range(side.size):
        take_pulls(field.pivots, side[k], pulls[k])
        posture = posture_of(field, side[k], acceleration[k], rise[k], motion[k], rates[k])
        values[k] = observe(kind, values[k], near, far, posture)
