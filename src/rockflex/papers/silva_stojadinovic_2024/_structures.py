"""The structures of the paper."""

import math

import rockflex as rf

BEHAVIOURS = {"shear": math.inf, "flexure": 0.0}
STRUCTURES = {
    "#1": (1.0, 10.0, "shear"),
    "#2": (1.0, 10.0, "flexure"),
    "#3": (0.5, 10.0, "shear"),
    "#4": (0.5, 10.0, "flexure"),
    "#5": (1.0, 5.0, "shear"),
    "#6": (1.0, 5.0, "flexure"),
}
"""Period in s, h*_1/B and behaviour of the structures of Table 1."""

MODELS = ("MDOF-S", "2DOF-C", "2DOF-S")  # of Section 3.2
MARK = 10.0  # h*_1/B of the gray line of Fig. 10

TOWER = rf.TaperedTower(
    height=200.0, base_radius=8.0, top_radius=4.0, wall=1.0, density=2400.0, elastic_modulus=25e9,
    damping_ratio=0.02,
)  # fmt: skip
"""The chimney of Section 4.1.1."""


def frame_of(name: str) -> rf.Frame:
    """Return a structure of Table 1."""
    period, aspect_ratio, behaviour = STRUCTURES[name]
    return rf.Frame(
        n_stories=5, story_height=3.0, story_mass=40e3, base_mass=40e3, stiffness_ratio=BEHAVIOURS[behaviour],
        period=period, aspect_ratio=aspect_ratio, damping_ratio=0.02,
    )  # fmt: skip


def tall_frame(behaviour: str, aspect_ratio: float = MARK) -> rf.Frame:
    """Return the 15-story building of Section 3.4; its period and base mass are assumed."""
    return rf.Frame(
        n_stories=15, story_height=3.0, story_mass=40e3, base_mass=40e3, stiffness_ratio=BEHAVIOURS[behaviour],
        period=1.0, aspect_ratio=aspect_ratio, damping_ratio=0.02,
    )  # fmt: skip
