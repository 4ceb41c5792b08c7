"""
Models compared
===============

One, two and all modes on a rocking base, compared with the same building on a
fixed base. Rocking reduces base moment and base shear, at the price of a
rotation.
"""

import math

import rockflex as rf

frame = rf.Frame(
    n_stories=5,
    story_height=3.0,
    story_mass=40e3,
    base_mass=40e3,
    stiffness_ratio=math.inf,
    period=1.0,
    aspect_ratio=10.0,
    damping_ratio=0.02,
)
drawing = rf.plot_structure(frame)

# %%
motion = rf.load_suite("el-centro-1940")[0].scaled(1.5)
models = ("fixed", "2DOF-S", "3DOF-S", "MDOF-S")
responses = [
    rf.simulate(frame, motion, model, free_vibration="settle")
    for model in models
]
history = rf.plot_history(responses, title="Structure #1, El Centro ×1.5")

# %%
# The base moment over the rotation: it varies at θ = 0 in contact, and is
# limited while the base rocks.
loops = rf.plot_moment_rotation(responses[1:])

# %%
# The complete model has the full trigonometry of large rotations; here it
# hardly matters.
complete = rf.simulate(frame, motion, "2DOF-C", free_vibration="settle")
print(
    "θ_max of 2DOF-C over that of 2DOF-S: "
    f"{complete.max_rotation / responses[1].max_rotation:.3f}"
)
