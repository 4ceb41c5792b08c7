"""What a study of objects takes from a module of the user's own, which workers can import."""

import math
from collections.abc import Mapping
from dataclasses import dataclass

import rockflex as rf

FRAME = {"n_stories": 3, "story_height": 3.0, "story_mass": 40e3, "base_mass": 40e3, "stiffness_ratio": math.inf}
FRAME |= {"period": 0.6, "aspect_ratio": 6.0, "damping_ratio": 0.03}


def roof(response: rf.Response) -> float:
    """Largest acceleration of the roof."""
    return abs(response.floor_acceleration[:, -1]).max()


def random_frame(values: Mapping[str, float]) -> rf.YieldingStories:
    """A frame whose stories yield."""
    return rf.YieldingStories(rf.Frame(**FRAME), values["strength"] * 200e3, 0.05)


def own_ground(properties: rf.RockingProperties) -> rf.Ground:
    """Ground with friction."""
    return rf.Ground(friction=0.2 + 0.01 * properties.half_width)


@dataclass(frozen=True)
class OwnBar(rf.GapBar):
    """An element of another package."""


class Tower:
    """A structure of another package."""

    def __init__(self, period: float) -> None:
        self.frame = rf.Frame(**FRAME | {"period": period})

    def rocking(self, n_modes: int | None = None) -> rf.RockingProperties:
        """Return the properties."""
        return self.frame.rocking(n_modes)
