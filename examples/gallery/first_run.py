"""
A first run
===========

A five-story shear building under El Centro 1940, on a base that can uplift.
"""

import math

import rockflex as rf

frame = rf.Frame(
    n_stories=5,
    story_height=3.0,  # m
    story_mass=40e3,  # kg
    base_mass=40e3,
    stiffness_ratio=math.inf,  # a shear building
    period=1.0,  # s
    aspect_ratio=10.0,
    damping_ratio=0.02,
)
drawing = rf.plot_structure(frame)

# %%
motion = rf.load_suite("el-centro-1940")[0].scaled(1.5)
response = rf.simulate(frame, motion, "MDOF-S", free_vibration=5.0)
print(response)

# %%
# The base is uplifted in the shaded intervals. While it rocks, its moment is
# nearly constant: that limits the forces.
history = rf.plot_history(response)

# %%
# At the largest rotation it stands on one edge.
moved = rf.plot_structure(frame, response=response)

# %%
# The energy balance: where the input energy goes.
energy = rf.plot_energy(response)
