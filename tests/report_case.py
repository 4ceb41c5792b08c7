"""Runs of which reports are written in tests."""

import numpy as np

import rockflex as rf

FRAME = rf.Frame(
    n_stories=2,
    story_height=3.0,
    story_mass=40e3,
    base_mass=40e3,
    stiffness_ratio=1e9,
    period=0.6,
    aspect_ratio=6.0,
    damping_ratio=0.02,
)
PULSE = rf.ricker_pulse(4.0, 0.6)
PIER = rf.CantileverWithTipMass(
    height=12.0,
    tip_mass=300e3,
    mass_per_length=6e3,
    bending_stiffness=8e9,
    base_mass=120e3,
    half_width=1.8,
    damping_ratio=0.03,
)
HELD = rf.Restrained(
    PIER,
    [
        rf.Tendon(800e3, 20e6, yield_force=1400e3),
        *(rf.YieldingDissipator(60e6, 150e3, 0.02, x) for x in (-1.5, 1.5)),
        *(rf.ViscousDamper(300e3, x) for x in (-1.6, -1.2, 1.2, 1.6)),
    ],
)
SPRINGS = rf.Ground(
    friction=0.4, springs=rf.Springs(np.linspace(-1.8, 1.8, 12), stiffness=1.2e8, damping=4e5), base_inertia=5e5
)


def runs(structure, motion, models, **options):
    """The responses of a structure by several models, with their histories."""
    return [rf.simulate(structure, motion, model, output="history", **options) for model in models]
