"""
Incremental analysis, with resurrections
========================================

Every record is scaled up until it overturns the frame, and beyond: a
structure that overturns under a motion may survive a stronger one. A search
that stops at the first overturning would miss this.
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
runs = rf.run_incremental(
    {"#1": frame},
    suite[:16],
    "2DOF-S",
    smallest_scale=0.5,
    largest_scale=20.0,
    growth=1.1,
)
curves = rf.plot_ida(runs, measure="pgv")

# %%
# Capacities of single records, and the lognormal curve through them.
capacities = rf.incremental_capacities(runs, measure="pgv")
back = int((capacities["resurrections"] > 0).sum())
print(
    f"{back} of {len(capacities)} records: the frame survives a larger scale "
    "than one that overturns it"
)
fit = rf.fit_capacities(capacities["capacity"], capacities["censored"])
print(f"median capacity {fit.median:.2f} m/s, dispersion {fit.beta:.2f}")
