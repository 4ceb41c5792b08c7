"""The simplified models on springs that cannot pull: the base rotates, heaves and, with friction, slides."""

from dataclasses import dataclass

import numpy as np

from rockflex._arrays import Array
from rockflex._constants import GRAVITY
from rockflex.models._branch_code import code_of
from rockflex.models._elements import CLOSED, memories
from rockflex.models._phase import OVERTURNS, Exit, Guard, Key, Phase
from rockflex.models._pulls import SUMS
from rockflex.models._rest_on_springs import heave_at
from rockflex.models._rocking_phase import QUARTER_TURN
from rockflex.models._spring_fences import fences_of
from rockflex.models._spring_forces import LIFTED, LOADED, RECEDING, STICK, SpringForces


@dataclass(frozen=True, eq=False)
class SpringModel(SpringForces):
    """N modes on a base on springs and dashpots that cannot pull: no impact law, and flight as one more phase.

    Its parameters are those of `SpringForces`.
    """

    def initial(self, state: Array | None) -> tuple[Key, Array]:
        """Return the branches and the state at the start of a run, from [D.., D'.., θ, θ'] or at rest.

        The rotation of a state counts from the base at rest. The base heaves as the weight on its springs demands, and
        the elements as built are brought to this position.
        """
        layout, springs = self.layout, self.springs
        start = np.zeros(layout.size)
        rotation, heave = self.rest
        if state is not None:
            start[: state.size] = state
            rotation += start[layout.rotation]
            heave = heave_at(springs, rotation, self._weight)
        start[layout.rotation], start[layout.heave] = rotation, heave
        depth = heave - springs.positions * rotation
        pressed = np.where(depth < 0.0, springs.stiffness, 0.0)
        spin = start[layout.spin]
        start[layout.heave + 1] = pressed @ springs.positions / pressed.sum() * spin if spin else 0.0
        speed = start[layout.heave + 1] - springs.positions * spin
        force = -springs.stiffness * depth - springs.damping * speed
        branches = np.where(depth >= 0.0, LIFTED, np.where(force > 0.0, LOADED, RECEDING))
        known, kept, of_elements = memories(self.elements), list[float](), list[int]()
        for place, each in enumerate(self.elements):
            stretch = self.stretch(each)
            elongation = float(stretch[-1] + stretch[layout.rotation] * rotation + stretch[layout.heave] * heave)
            memory = each.memory_at(elongation)
            of_elements.append(int(each.branch_at(np.array([elongation]), np.array([memory]))[0]))
            kept += [memory] if place in known else []
        key = (CLOSED, *(int(branch) for branch in branches), STICK, *of_elements)
        start[layout.memory :] = (*kept, *code_of(key[1:]))
        return key, start

    @property
    def _weight(self) -> float:
        """Weight with the initial tensions of the elements, N."""
        return self.properties.m_tot * GRAVITY + sum(each.pull(each.branches[0]).force for each in self.elements)

    def phase(self, key: Key) -> Phase:
        """Return one phase: the equations of motion on these branches, and the conditions that end it."""
        count = self.layout.remembered
        first = len(memories(self.elements))
        row = np.zeros(self.layout.columns)
        row[self.layout.rotation] = 1.0
        tips = Exit(OVERTURNS, key)
        return Phase(
            key=key,
            side=CLOSED,
            arrow=self.arrow(key),
            guard=Guard(row, -QUARTER_TURN, QUARTER_TURN, tips, tips, np.zeros((2, count))),
            pulls=np.zeros((SUMS, 1 + count)),
            changes=(),
            turned=key,
            beside=(key, key, key),
            free=True,
            fences=fences_of(self, key),
            marks=tuple((first + k, code) for k, code in enumerate(code_of(key[1:]))),
        )
