"""The bases of linear models as hybrid systems: on springs, with joints above them, and which one a model has."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from rockflex.engine.system import Event
from rockflex.foundation.arrays import Array
from rockflex.models._base_motion import horizontal_reaction
from rockflex.models._elements import CLOSED, LEFT, QUARTER_TURN, RIGHT, rate_of_elongation_row
from rockflex.models._jointed_model import JointedModel
from rockflex.models._linear_system import TINY, LinearOnRigidGround, LinearSliding, LinearSystemBase
from rockflex.models._phase import Key
from rockflex.models._quantities import Quantities
from rockflex.models._rocking_model import RockingModel
from rockflex.models._sliding import STICK
from rockflex.models._spring_model import LIFTED, LOADED, RECEDING, YIELDING, SpringModel

AT_ONCE = 1e-15  # s before θ = 0 at which a joint lands, so that one that moves inwards from there does so at once


def linear_system_base(
    model: RockingModel, quantities: Quantities, extremes: Quantities, *, shaken: bool = False
) -> "LinearSystemBase":
    """Return the base of a linear model, on rigid ground or on springs; `shaken` where the ground moves vertically."""
    return _base_on_ground_of(model)(model, quantities, extremes, shaken)


def _base_on_ground_of(model: RockingModel) -> "type[LinearSystemBase]":
    if model.springs is not None:
        return LinearOnSprings
    if model.layout.n_joints:
        return LinearJointed
    return LinearSliding if model.slip_marks else LinearOnRigidGround


@dataclass(frozen=True, eq=False)
class LinearJointed(LinearSystemBase):
    """A base that rocks about its edges, with joints above it that do.

    Where several closed joints would open at once, that one does of which the demand exceeds the capacity by most; the
    others are then looked at again.
    """

    model: JointedModel  # pyright: ignore[reportIncompatibleVariableOverride]

    def events(self, key: Key) -> list[Event]:
        """The events that end a phase: a joint opens or lands, the base overturns, or an element leaves its branch."""
        model, found = self.model, list[Event]()
        for joint, side in enumerate(model.stance(key)):
            if side != CLOSED:
                found += (self.landing(key, joint, side), self.overturning(joint, side))
            elif model.lifts and model.weights[joint] > 0.0:
                found += (self.opening(key, joint, each) for each in (RIGHT, LEFT))
        for place in model.moving_places:
            found += self.element_events(place, key)
        return found

    def opening(self, key: Key, joint: int, side: int) -> Event:
        """A joint opens when the forces on it would turn it."""
        model = self.model
        row = -side * self.taken(model.opening(key, joint, side), key)
        scale = model.gravity * float(model.weights[joint] * model.arm(joint, side))
        return self.event("uplift", row, model.with_side(key, joint, side), scale)

    def overturning(self, joint: int, side: int) -> Event:
        """The end of the run at a rotation of π/2."""
        row = -side * self.unit(self.model.layout.rotations[joint])
        row[-1] = QUARTER_TURN
        return self.event("overturning", row, None, QUARTER_TURN)

    def landing(self, key: Key, joint: int, side: int) -> Event:
        """A joint lands: an impulse on its rotation alone stops it, which other open joints feel.

        One that moves inwards from θ = 0, as others let it by landing at that instant, does so before any opens: it
        would otherwise take turns with them without end.
        """
        model, place = self.model, self.model.layout.rotations[joint]
        jump, system = self.without(place, place + 1), model.bordered_system(key)
        N, spins = model.properties.n_modes, [each + 1 for each in model.layout.rotations]
        shares = system.flexibility[:, joint] / system.flexibility[joint, joint]
        shares[joint] = 0.0
        jump[spins, place + 1] -= shares
        shares[joint] = 1.0
        jump[N : 2 * N, place + 1] = model.couplings.T @ shares
        row = side * (self.unit(place) + AT_ONCE * self.unit(place + 1))
        return self.event("impact", row, model.with_side(key, joint, CLOSED), TINY, jump)


@dataclass(frozen=True, eq=False)
class LinearOnSprings(LinearSystemBase):
    """A base on springs that cannot pull: it rotates, heaves and may slide."""

    model: SpringModel  # pyright: ignore[reportIncompatibleVariableOverride]

    @cached_property
    def soil(self) -> dict[int, int]:
        """The place in the states of the elastic compression of each spring that can yield, by its own place."""
        return {place: self.model.layout.core + len(self.bars) + k for k, place in enumerate(self.model.soft)}

    @cached_property
    def _soil_columns(self) -> list[int]:
        return [self.model.crushed(place) for place in self.model.soft]

    def compression(self, place: int) -> Array:
        """The whole compression of a spring under the base: a row."""
        found = -self.model.depths[place][self.columns]
        found[list(self.soil.values())] = 0.0
        return found

    def state_of(self, key: Key, state: Array) -> Array:
        """The states from the state of the model, with the elastic compression of springs that can yield."""
        found, springs = super().state_of(key, state), self.model.springs
        for place, at in self.soil.items():
            assert springs.capacity is not None
            whole = float(self.compression(place) @ np.append(found, (0.0, 1.0)))
            yields = key[1 + place] == YIELDING
            held = float(springs.capacity[place] / springs.stiffness[place])
            found[at] = held if yields else whole - state[self.model.crushed(place)]
        return found

    def rates(self, key: Key) -> Array:
        """The rates of the states; a spring that yields keeps its elastic compression."""
        found = super().rates(key)
        for place, at in self.soil.items():
            if key[1 + place] != YIELDING:
                found[at] = rate_of_elongation_row(-self.model.depths[place], self.model.layout)[self.columns]
        return found

    @cached_property
    def heave_scale(self) -> float:
        """The settlement of the springs under the weight, m."""
        return self.weight / float(self.model.springs.stiffness.sum())

    @property
    def weight(self) -> float:
        """m_tot g, N."""
        return self.model.properties.m_tot * self.model.gravity

    def events(self, key: Key) -> list[Event]:
        """The events that end a phase: springs that unload, lift or land; the slip; elements; overturning."""
        turned = self.unit(self.model.layout.rotation)
        tips = [way * turned for way in (-1.0, 1.0)]
        for row in tips:
            row[-1] = QUARTER_TURN
        found = [self.event("overturning", row, None, QUARTER_TURN) for row in tips]
        of_elements = [each for place in range(len(self.model.elements)) for each in self.element_events(place, key)]
        return [*self.of_springs(key), *self.of_slip(key), *of_elements, *found]

    def of_springs(self, key: Key) -> list[Event]:
        """A spring unloads, yields, the base leaves it, or comes back to it."""
        model, found, last = self.model, list[Event](), self.model.springs.n - 1
        for j, branch in enumerate(key[1 : model.springs.n + 1]):
            depth, push = model.depths[j][self.columns], self.taken(model.pushes[j], key)
            if j in self.soil:
                depth = -self.unit(self.soil[j])
            edge, damped, place = j in (0, last), model.springs.damping[j] > 0.0, 1 + j
            opens, closes = ("uplift", "impact") if edge else ("change", "change")
            if branch == YIELDING:
                row = rate_of_elongation_row(-model.depths[j], model.layout)[self.columns]
                found.append(self.event("turn", row, _with(key, place, LOADED), 1.0))
                continue
            if branch == LOADED and j in self.soil:
                assert model.springs.capacity is not None
                row = depth.copy()
                row[-1] = model.springs.capacity[j] / model.springs.stiffness[j]
                found.append(self.event("yield", row, _with(key, place, YIELDING), self.heave_scale))
            if branch == LOADED:
                following = _with(key, place, RECEDING if damped else LIFTED)
                found.append(self.event("change" if damped else opens, push, following, self.weight))
            elif branch == LIFTED:
                found.append(self.event(closes, depth, _with(key, place, LOADED), self.heave_scale))
            else:
                found.append(self.event("change", -push, _with(key, place, LOADED), self.weight))
                found.append(self.event(opens, -depth, _with(key, place, LIFTED), self.heave_scale))
        return found

    def of_slip(self, key: Key) -> list[Event]:
        """The base begins to slide, or ends it."""
        model = self.model
        if model.friction is None:
            return []
        place, rate = model.springs.n + 1, model.layout.slip + 1
        if key[place] != STICK:
            row = key[place] * self.unit(rate)
            return [self.event("stick", row, _with(key, place, STICK), 1.0, self.without(rate))]
        held, grip = horizontal_reaction(model, key), model.grip(key)
        scale = float(model.friction.max()) * self.weight
        # The ground pushes to the right on a base that would slide to the left.
        return [
            self.event("slip", self.taken(grip + way * held, key), _with(key, place, way), scale) for way in (-1, 1)
        ]

    @property
    def least_elongation(self) -> float:
        """The settlement of the springs under the weight, m."""
        return self.heave_scale


def _with(key: Key, place: int, branch: int) -> Key:
    return (*key[:place], branch, *key[place + 1 :])
