"""What most tests begin with: the paper's structure #1 and changes of it, and records."""

import math
from typing import Any

import numpy as np

import rockflex as rf
from rockflex.models._elements import element_force_sums
from rockflex.models._field_numbers import field_numbers
from rockflex.models._fields import RockingField

# Structure #1 of Table 1 of Silva & Stojadinović (2024): five stories that shear, T_1 = 1 s, h*_1/B = 10.
STRUCTURE_1: dict[str, Any] = {
    "n_stories": 5,
    "story_height": 3.0,
    "story_mass": 40e3,
    "base_mass": 40e3,
    "stiffness_ratio": math.inf,
    "period": 1.0,
    "aspect_ratio": 10.0,
    "damping_ratio": 0.02,
}

# What a RockingProperties is made of: two modes of a finite element program.
PROPERTIES = {
    "omega": [6.0, 18.0],
    "effective_mass": [170e3, 20e3],
    "effective_height": [10.5, -3.6],
    "top_ordinate": [1.25, -0.36],
    "i_theta": 20e6,
    "l0r": 1.8e6,
    "m_tot": 240e3,
    "half_width": 1.0,
    "zeta": 0.02,
}

# The same of a base for which moments are easily known by hand: M g = 240e3 * 9.81 N, B = 1.2 m, L_0^r = 1.8e6 kg m.
BY_HAND = {
    "omega": [6.0, 25.0],
    "effective_mass": [150e3, 30e3],
    "effective_height": [11.0, 3.0],
    "top_ordinate": [1.3, -0.5],
    "i_theta": 24e6,
    "l0r": 1.8e6,
    "m_tot": 240e3,
    "half_width": 1.2,
    "zeta": 0.02,
}

# In place of the modes of a structure, to make it a rigid block.
NO_MODES = dict.fromkeys(("omega", "effective_mass", "effective_height", "top_ordinate", "zeta"), ())


def frame_values(**changes: Any) -> dict[str, Any]:
    """Arguments of structure #1, changed."""
    return STRUCTURE_1 | changes


def make_frame(**changes: Any) -> rf.Frame:
    """Structure #1, changed."""
    return rf.Frame(**frame_values(**changes))


def vector_field(model, side, branch=1, kinds=(), levers=None):
    """The compiled vector field of a nonlinear model on one side, with all elements on their first branches."""
    pulls = element_force_sums(model.properties, model.elements, model.start(side))
    return RockingField(field_numbers(model, kinds, levers), side, branch, pulls, [])


def fuse_branches(bar):
    """The branches of a fuse that a user writes as a law, with `stiffness`, `yield_force` and `ratio`."""
    k, a, reach = bar.stiffness, bar.ratio, bar.yield_force / bar.stiffness
    ends = [rf.BranchEnd(name, s * reach, s > 0, internal=1.0) for name, s in (("up", 1.0), ("down", -1.0))]
    found = {"elastic": rf.Branch(k, internal=-(1.0 - a) * k, ends=ends)}
    for name, s in (("up", 1), ("down", -1)):
        found[name] = rf.Branch(a * k, s * (1.0 - a) * k * reach, yields=s, offset=s * reach, turns_to="elastic")
    return found


def fuse_energy(bar, elongation, internal, share=1.0):
    """What it stores: F²/2k, and a share of α (1 - α) k m²/2."""
    k, a = bar.stiffness, bar.ratio
    force = k * elongation - (1.0 - a) * k * internal
    return force**2 / (2.0 * k) + share * 0.5 * a * (1.0 - a) * k * internal**2


def random_shaking(seed, strength, seconds, dt):
    """Sines of random periods and phases under an envelope; begins and ends away from zero."""
    chance = np.random.default_rng(seed)
    t = dt * np.arange(int(seconds / dt) + 1)
    rates, phases = 2.0 * np.pi / chance.uniform(0.15, 2.0, 6), chance.uniform(0.0, 6.0, 6)
    return strength * np.sin(np.pi * (t + 0.2) / (seconds + 0.5)) * np.sin(np.outer(t, rates) + phases).mean(axis=1)


def finer(motion):
    """The same motion, with two samples for one."""
    places = np.arange(2 * motion.acceleration.size - 1) / 2.0

    def between(values):
        return None if values is None else np.interp(places, np.arange(values.size), values)

    vertical = between(motion.vertical)
    return rf.GroundMotion(between(motion.acceleration), motion.dt / 2.0, name=motion.name, vertical=vertical)
