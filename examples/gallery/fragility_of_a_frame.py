"""
Fragility of a frame
====================

One frame under 44 recorded components at four scales, with one mode and with
all modes: the probabilities of rocking and overturning, and the rotations in
between.
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
suite = rf.load_suite("fema-p695-far-field")
runs = rf.run_cloud(
    {"#1": frame},
    suite,
    ["2DOF-S", "MDOF-S"],
    scales=(0.5, 1.0, 2.0, 4.0),
    free_vibration="settle",
)
curves = rf.plot_fragility(runs, confidence=0.9, overturning=True)

# %%
# The rotations of the runs that rocked without overturning; crosses at the
# top overturned.
clouds = rf.plot_clouds(runs)

# %%
# The probabilities of overturning and of exceeding a limit.
for fits in rf.fit_clouds(runs, measure="pgv"):
    p = fits.outcomes.probabilities(0.8)
    limit = fits.outcomes.exceedance(0.8, 0.02)
    print(
        f"{fits.model} at 0.8 m/s: overturning {p.overturning:.2f}, θ > 0.02 "
        f"rad {limit:.2f}"
    )
