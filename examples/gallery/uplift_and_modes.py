"""
Modes while uplifted
====================

An uplifted base is a hinge. The frequencies about the pivot are far above
those of the same structure on a fixed base, and approach those of a pinned
beam for slender structures. With one mode they are overestimated.
"""

import math

import numpy as np

import rockflex as rf


def building(stiffness_ratio: float) -> rf.Frame:
    """Fifteen stories with a first period of one second."""
    return rf.Frame(
        n_stories=15,
        story_height=3.0,
        story_mass=40e3,
        base_mass=40e3,
        stiffness_ratio=stiffness_ratio,
        period=1.0,
        aspect_ratio=10.0,
        damping_ratio=0.02,
    )


frames = {"shear": building(math.inf), "flexure": building(0.0)}
drawing = rf.plot_structure(frames["shear"])

# %%
aspect_ratios = np.geomspace(0.1, 1000.0, 101)
tables = {
    name: rf.frequency_ratios(frame, aspect_ratios)
    for name, frame in frames.items()
}
ratios = rf.plot_frequency_ratios(
    tables, {name: rf.pinned_beam(name) for name in frames}, mark=10.0
)

# %%
# The values at the gray line, an aspect ratio of ten.
for name, frame in frames.items():
    modes = rf.uplifted_modes(frame.rocking())
    print(
        f"{name}: ω*₁/ω₁ = {modes.ratio[0]:.3f}, ω*₂/ω₂ = "
        f"{modes.ratio[1]:.3f}"
    )

# %%
# How many modes are needed, explained in words.
print(rf.adequacy(frames["shear"].rocking(), base_mass=40e3).reason)
