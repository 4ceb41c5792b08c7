"""
Rest, slide, rock: Shenton's map
================================

What a free-standing rigid block begins to do when its base is suddenly
accelerated: it rests, slides, rocks, or does both at once. The map shows
Shenton's boundaries for Coulomb friction over runs of the model that slides
and rocks, one for each point of a grid.

Shenton H. W. (1996). Criteria for initiation of slide, rock, and slide-rock
rigid-body modes. *Journal of Engineering Mechanics* 122(7), 690-693.
"""

import math

import numpy as np
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure

import rockflex as rf

MODES = ("rest", "slide", "rock", "slide-rock")
GRAVITY = 9.81
SLENDERNESS = 2.0  # γ = H/B, height over width
block = rf.rigid_block(
    slenderness=math.atan(1.0 / SLENDERNESS), half_diagonal=1.5
)
drawing = rf.plot_structure(block, rf.Ground(friction=0.4))


frictions = np.arange(0.01, 1.2, 0.02)
accelerations = np.arange(0.015, 1.6, 0.03)  # in g
pulse = rf.GroundMotion(
    np.full(3, GRAVITY),
    dt=0.001,
    name="two milliseconds of a rectangular pulse of 1 g",
)
columns = []
for friction in frictions:
    ground = rf.Ground(friction=friction)
    runs = rf.simulate_many(
        block, pulse, "rigid", scales=accelerations, ground=ground, workers=1
    )
    columns.append(2 * (runs["n_uplifts"] > 0) + (runs["max_slip"] > 0.0))
found = np.array(columns).T  # the place in MODES of what the block does

# %%
# The formulas, with :math:`A = a/g` and :math:`\gamma = H/B`. The block rests
# if friction holds it, :math:`A < \mu`, and the weight does, :math:`A <
# 1/\gamma`. The friction of a block that slides cannot tilt it if :math:`\mu
# < 1/\gamma`. Otherwise it rocks, without sliding only if
#
# .. math::
#
#    \mu \ge \frac{(4 + \gamma^2) A + 3 \gamma}{3 \gamma A + 1 + 4 \gamma^2} .
#
# This boundary begins where :math:`A = \mu = 1/\gamma`, and asks for more
# friction the stronger the pulse is: the horizontal force grows with the
# acceleration, while the weight does not. Until Shenton it was thought that a
# block with :math:`\mu > 1/\gamma` rocks without sliding.
tilts = 1.0 / SLENDERNESS


def friction_to_rock(a: np.ndarray) -> np.ndarray:
    """Least friction with which a tilting block sticks, over a in g."""
    return ((4.0 + SLENDERNESS**2) * a + 3.0 * SLENDERNESS) / (
        3.0 * SLENDERNESS * a + 1.0 + 4.0 * SLENDERNESS**2
    )


strong = np.linspace(tilts, accelerations[-1], 100)
boundaries = {
    "rest or slide": ([0.0, tilts], [0.0, tilts]),
    "slide or slide-rock": ([tilts, tilts], [tilts, strong[-1]]),
    "rest or rock": ([tilts, frictions[-1]], [tilts, tilts]),
    "rock or slide-rock": (friction_to_rock(strong), strong),
}
figure = Figure(figsize=(6.0, 4.4), layout="constrained")
axes = figure.add_subplot()
colors = ListedColormap(["#e9edf2", "#f0e442", "#56b4e9", "#009e73"])
axes.pcolormesh(
    frictions,
    accelerations,
    found,
    cmap=colors,
    vmin=-0.5,
    vmax=3.5,
    alpha=0.75,
)
for friction, acceleration in boundaries.values():
    axes.plot(friction, acceleration, color="black", linewidth=1.6)
for name, at in zip(
    MODES,
    ((0.85, 0.25), (0.22, 0.95), (0.9, 0.95), (0.58, 1.35)),
    strict=True,
):
    axes.annotate(name.replace("-", "-\n"), at, ha="center", va="center")
axes.set(
    xlabel="friction μ",
    ylabel="acceleration of the ground A = a/g",
    xlim=(0.0, frictions[-1]),
    ylim=(0.0, accelerations[-1]),
    title=f"γ = H/B = {SLENDERNESS:g}: {found.size} runs, Shenton's borders",
)

# %%
# Point by point, the runs against the formulas:
mu, a = np.meshgrid(frictions, accelerations)
rests = a < np.minimum(mu, tilts)
expected = np.select(
    [rests, mu < tilts, mu > friction_to_rock(a)], [0, 1, 2], default=3
)
print(
    f"{(expected != found).sum()} of {found.size} runs differ from the "
    "formulas"
)
for k, name in enumerate(MODES):
    print(f"{name}: {(found == k).mean():.0%} of the map")
