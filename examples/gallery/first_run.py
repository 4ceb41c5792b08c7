"""
A first run
===========

A five-story shear building under El Centro 1940, its base free to lift.
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
motion = rf.load_suite("el-centro-1940")[0].scaled(1.5)
response = rf.simulate(frame, motion, "MDOF-S", free_vibration=5.0)
print(response)

# %%
# Shaded is the time off the ground. While the base rocks, its moment is nearly constant: that limits the forces.
history = rf.plot_history(response)

# %%
# Where the energy of the motion went.
energy = rf.plot_energy(response)
