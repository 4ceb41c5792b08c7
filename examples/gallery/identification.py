"""
What was the restitution?
=========================

A stocky block is tilted and let go, and its rotation is measured with noise.
`identify` finds the restitution that explains it best, and how sure that is.
Repeating the test shows whether the interval keeps its promise.
"""

import matplotlib.pyplot as plt
import numpy as np

import rockflex as rf

block = rf.rigid_block(slenderness=0.2, half_diagonal=3.0)
drawing = rf.plot_structure(block)
still = rf.quiet_motion(duration=8.0, dt=0.01)
start = rf.InitialState(rotation=0.1)
TRUE, NOISE = 0.9, 2e-3

# %%
# **The test**, as it would be without noise.
test = rf.simulate(
    block, still, "rigid", impact=rf.AngularMomentum(TRUE), initial=start
)
exact = test.resample(still.dt).rotation


def found_from(measured):
    """Return the fit, which begins at a restitution of 0.93."""
    return rf.identify(
        block,
        still,
        measured,
        ["impact.restitution"],
        "rigid",
        impact=rf.AngularMomentum(0.93),
        initial=start,
    )


# %%
# **Twenty times**, each with noise of 2 mrad, and the interval that has the
# true value with a probability of 90 %.
random = np.random.default_rng(1)
noise = NOISE * random.normal(size=(20, exact.size))
fits = [found_from(exact + each) for each in noise]
values = np.array([fit.values[0] for fit in fits])
low, high = np.array([fit.interval(0.9)[:, 0] for fit in fits]).T
right = (low <= TRUE) & (high >= TRUE)
print(f"{right.sum()} of {right.size} intervals have the true value")

# %%
fit = rf.simulate(
    block, still, "rigid", impact=rf.AngularMomentum(values[0]), initial=start
)
figure, (left, beside) = plt.subplots(
    1, 2, figsize=(9, 3.6), layout="constrained", width_ratios=[3, 2]
)
t = np.arange(exact.size) * still.dt
left.plot(
    t, exact + noise[0], ".", markersize=2, color="0.6", label="measured"
)
left.plot(t, fit.resample(still.dt).rotation, label="best fit")
left.set(xlabel="time [s]", ylabel="rotation [rad]")
left.legend()
beside.axvline(TRUE, color="0.6")
for k, good in enumerate(right):
    color = "C0" if good else "C3"
    beside.plot([low[k], high[k]], [k + 1, k + 1], color=color)
    beside.plot(values[k], k + 1, "o", markersize=4, color=color)
beside.set(xlabel="coefficient of restitution", ylabel="test")
beside.ticklabel_format(useOffset=False)
beside.locator_params(axis="x", nbins=4)
beside.set_yticks([1, 5, 10, 15, 20])
