"""
How sure is a risk number?
==========================

Four questions about one pier on rigid ground: which of its numbers matters,
whether the records or the structure scatter more, what makes its annual rate
uncertain, and how rare it is that it falls.
"""

import math

import matplotlib.pyplot as plt
import numpy as np

import rockflex as rf

pier = rf.CantileverWithTipMass(
    height=12.0,
    tip_mass=400e3,
    bending_stiffness=9e9,
    mass_per_length=6e3,
    base_mass=150e3,
    half_width=1.6,
    damping_ratio=0.03,
)
drawing = rf.plot_structure(pier)
suite = rf.load_suite("fema-p695-far-field")

# %%
# **What matters?** The median of the largest rotation under 44 records, with
# each number at the ends of its range.
bars = rf.tornado(
    pier,
    suite,
    parameters={
        "half_width": 0.05,
        "bending_stiffness": 0.3,
        "tip_mass": 0.1,
        "damping_ratio": (0.5, 2.0),
        "scale": 0.1,
    },
)
tornado = rf.plot_tornado(bars)

# %%
# **Who scatters?** Six piers, drawn with a dispersion of 0.4 in their
# stiffness and 0.1 in their width, under all records, by two models. The law
# of total variance splits ln θ.
draw = np.random.default_rng(1)
piers = [
    rf.CantileverWithTipMass(
        height=12.0,
        tip_mass=400e3,
        bending_stiffness=9e9 * math.exp(0.4 * draw.normal()),
        mass_per_length=6e3,
        base_mass=150e3,
        half_width=1.6 * math.exp(0.1 * draw.normal()),
        damping_ratio=0.03,
    )
    for _ in range(6)
]
runs = rf.simulate_many(piers, suite, ["MDOF-S", "2DOF-C"], scales=2.0)
rocks = runs[(runs["status"] != "overturned") & (runs["max_rotation"] > 0)]
shares = rf.variance_shares(
    np.log(rocks["max_rotation"]),
    {
        "records": rocks["motion"],
        "structure": rocks["structure"],
        "model": rocks["model"],
    },
)
print(shares["share"].round(3).to_string())

split, axes = plt.subplots(figsize=(6, 2.6), layout="constrained")
axes.barh(shares.index, 100 * shares["share"])
axes.set_xlabel("share of the variance of ln θ [%]")
axes.invert_yaxis()

# %%
# **And the rate?** What the records leave open of each fit, two piers, two
# models, and a hazard with a dispersion of 0.5: shares of the variance of the
# annual rate of rotations beyond 0.01 rad, alone and with all interactions.
levels_run = rf.run_cloud(
    {"drawn": piers[0], "nominal": pier},
    suite,
    ["MDOF-S", "2DOF-S"],
    scales=[0.5, 1.0, 2.0, 4.0],
)
mean = rf.HazardCurve(
    im=[0.05, 0.1, 0.2, 0.4, 0.8, 1.6, 3.2],
    rate=[6e-2, 2e-2, 5e-3, 9e-4, 1.2e-4, 8e-6, 4e-7],
)
rate = rf.rate_shares(
    rf.HazardBranches.lognormal(mean, dispersion=0.5),
    {
        (fit.structure, fit.model): fit.outcomes.curve(0.01)
        for fit in rf.fit_clouds(levels_run, "pgv")
    },
)
print(rate)

of_rate, axes = plt.subplots(figsize=(6, 2.6), layout="constrained")
sources = rate.shares.drop("interactions")
axes.barh(sources.index, 100 * sources["total"], color="0.8", label="in all")
axes.barh(sources.index, 100 * sources["share"], height=0.5, label="alone")
axes.set_xlabel("share of the variance of the annual rate [%]")
axes.legend()
axes.invert_yaxis()

# %%
# **How rare is it?** A pulse of random amplitude and period: the probability
# that a block under it rotates by more than a limit, down to some 1e-6. Each
# level of subset simulation takes 500 runs; plain sampling with 4000 runs
# sees little below 1e-3.
block = rf.rigid_block(slenderness=0.25, half_diagonal=3.0)


def rotations(u):
    """Return the largest rotation of each pulse, for variables u."""
    pulses = [
        rf.one_sine_pulse(
            amplitude=2.4 * math.exp(0.2 * x), period=0.8 * math.exp(0.1 * y)
        )
        for x, y in u
    ]
    found = rf.simulate_many(block, pulses, "rigid")
    return found["max_rotation"].to_numpy()


plain = rotations(np.random.default_rng(2).normal(size=(4_000, 2)))
limits = [0.02, 0.04, 0.06, 0.08]
found = [rf.subset_simulation(rotations, 2, each, n=500) for each in limits]

rare, axes = plt.subplots(figsize=(6, 4), layout="constrained")
levels = np.geomspace(0.005, limits[-1], 60)
beyond = [(plain > each).mean() for each in levels]
axes.plot(
    levels, np.where(np.array(beyond) > 0, beyond, np.nan), label="4000 runs"
)
axes.errorbar(
    limits,
    [each.probability for each in found],
    yerr=[each.probability * each.variation for each in found],
    fmt="o",
    capsize=3,
    label="subset simulation",
)
axes.set(
    xscale="log",
    yscale="log",
    xlabel="rotation θ [rad]",
    ylabel="P(largest θ > θ)",
)
axes.legend()
for limit, each in zip(limits, found, strict=True):
    print(limit, f"{each.probability:.2g} ± {100 * each.variation:.0f} %")
