"""Impact laws in the form used by kernels (Silva & Stojadinović 2024, Section 2.1.1)."""

import ctypes
from typing import Any, NamedTuple

import numpy as np

from rockflex._arrays import Array
from rockflex._checks import finite, finite_vector
from rockflex._errors import InputError
from rockflex._kernel import Callback, kernel
from rockflex._shown import shown
from rockflex.modal import RockingProperties
from rockflex.models._impact import ImpactLaw, Restitution, SidedRestitution, VVELComplete, VVELSimplified

SHARED, SCALED, CALLED = 0, 1, 2  # kinds of law: Eq. 25 or a restitution; scaled to Eq. 19; user-defined


SHORTEST = 1e-4  # s: the default of `Restitution`
WITHOUT = Restitution(0.0, SHORTEST)


class Impact(NamedTuple):
    """An impact law for one model."""

    kind: int
    right: float  # restitution after a rotation about the right edge
    left: float  # and about the left edge
    shortest: float  # shortest excursion that counts as a rotation, s
    mass: Array  # m*
    height: Array  # h*
    unseen: float  # Σ m_i h_i² - Σ m* h*²
    callback: Callback


NO_CALLBACK = Callback(lambda _address, _count: 1)


def impact_of(law: ImpactLaw, properties: RockingProperties) -> tuple[Impact, list[BaseException]]:
    """Return a law in the form for kernels, and a list that will collect the exceptions that it raises."""
    own = None
    if not isinstance(law, VVELSimplified | VVELComplete | Restitution | SidedRestitution):
        own = OwnLaw(law, properties)
    right = left = WITHOUT
    if isinstance(law, SidedRestitution):
        right, left = law.right, law.left
    elif isinstance(law, Restitution):
        right = left = law
    mass, height = properties.effective_mass.copy(), properties.effective_height.copy()
    impact = Impact(
        kind=CALLED if own else SCALED if isinstance(law, VVELComplete) else SHARED,
        right=right.e,
        left=left.e,
        shortest=right.shortest_excursion,
        mass=mass,
        height=height,
        unseen=properties.translational_inertia - float(mass @ height**2),
        callback=own.callback if own else NO_CALLBACK,
    )
    return impact, own.failures if own else []


@kernel
def strike(impact: Impact, state: Array) -> bool:
    """Replace the velocities before an impact by those after it; return False if a user-defined law failed."""
    n = impact.mass.size
    if impact.kind == CALLED:
        return impact.callback(state.ctypes.data, n) == 0
    spin = state[2 * n + 1]
    passed = (impact.right if spin < 0.0 else impact.left) * spin
    moving = 0.0
    for i in range(n):
        state[n + i] += impact.height[i] * (spin - passed)
        moving += impact.mass[i] * state[n + i] * state[n + i]
    if impact.kind == SCALED and moving > 0.0:
        scale = np.sqrt(1.0 + impact.unseen * spin * spin / moving)
        for i in range(n):
            state[n + i] *= scale
    state[2 * n + 1] = passed
    return True


@kernel
def may_pass(impact: Impact) -> bool:
    """Return whether rocking may continue after an impact without contact in between."""
    return impact.kind == CALLED or impact.right != 0.0 or impact.left != 0.0


@kernel
def stick(impact: Impact, state: Array) -> None:
    """End the rotation: its remaining velocity is transferred to the modes (Eq. 25)."""
    n = impact.mass.size
    for i in range(n):
        state[n + i] += impact.height[i] * state[2 * n + 1]
    state[2 * n + 1] = 0.0


@kernel
def kinetic_energy(impact: Impact, free_inertia: float, state: Array) -> float:
    """Return the kinetic energy at θ = 0, without the inertia terms of D: ½ I_f θ'² + ½ Σ m* (D' + h* θ')²."""
    n = impact.mass.size
    spin = state[2 * n + 1]
    energy = 0.5 * free_inertia * spin * spin
    for i in range(n):
        velocity = state[n + i] + impact.height[i] * spin
        energy += 0.5 * impact.mass[i] * velocity * velocity
    return energy


class OwnLaw:
    """A user-defined law that kernels can call; exceptions are stored, because kernels cannot propagate them."""

    def __init__(self, law: ImpactLaw, properties: RockingProperties) -> None:
        self._law = law
        self._properties = properties
        self.failures: list[BaseException] = []
        self.callback = Callback(self._after)

    def after(self, velocity: Array, spin: float) -> tuple[Array, float]:
        """Return the velocities after an impact, checked."""
        found, turn = _pair(self._law.after(self._properties, velocity.copy(), spin))
        checked = finite_vector("the modal velocity after an impact", found, "m/s")
        if checked.size != velocity.size:
            raise InputError(
                f"The modal velocity after an impact must have {velocity.size} values, but {checked.size} were "
                "returned."
            )
        return checked, finite("the rotation velocity after an impact", turn, "rad/s")

    def _after(self, address: int, n: int) -> int:
        try:
            state = np.ctypeslib.as_array(ctypes.cast(address, ctypes.POINTER(ctypes.c_double)), (2 * n + 2,))
            state[n : 2 * n], state[-1] = self.after(state[n : 2 * n], float(state[-1]))
        except BaseException as error:  # Ctrl-C, too, which ctypes would drop
            self.failures.append(error)
            return 1
        return 0


def _pair(returned: Any) -> tuple[Any, Any]:
    """Return the two things that a law returned."""
    try:
        velocity, spin = returned
    except (TypeError, ValueError):
        raise InputError(
            "after must return the modal velocities in m/s and the rotation velocity in rad/s, but it returned "
            f"{shown(returned)}."
        ) from None
    return velocity, spin
