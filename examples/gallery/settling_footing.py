"""
A footing that settles
======================

A pier whose footing carries a third of what the soil bears, or two thirds.
The soil yields under the edges as it rocks, and the pier is left lower and
at an angle.
"""

import numpy as np
from matplotlib.figure import Figure

import rockflex as rf

pier = rf.CantileverWithTipMass(
    height=12.0,
    tip_mass=400e3,
    bending_stiffness=9e9,
    mass_per_length=6e3,
    base_mass=150e3,
    half_width=3.0,
    damping_ratio=0.03,
)
weight, area = pier.rocking().m_tot * 9.81, 6.0 * 5.0


def soil(share: float | None) -> rf.Ground:
    """A bed whose strength is the weight over `share`; None: elastic."""
    strength = None if share is None else weight / share / area
    springs = rf.winkler_bed(3.0, 5.0, 30e6, n=24, bearing_capacity=strength)
    springs = springs.damped(0.2, pier.rocking().m_tot)
    return rf.Ground(springs=springs, base_inertia=150e3 * 36.0 / 12.0)


drawing = rf.plot_structure(pier, ground=soil(0.33))

# %%
# The static moment has a plateau, N B (1 - N/N_ult), less the moment of the
# weight that leans.
figure = Figure(figsize=(5.5, 3.2), layout="constrained")
axes = figure.add_subplot(xlabel="θ [mrad]", ylabel="moment [MN m]")
for share in (None, 0.33, 0.67):
    path = rf.moment_rotation(pier, [0.02, -0.02, 0.02], ground=soil(share))
    name = "elastic" if share is None else f"N = {share:g} N_ult"
    axes.plot(1e3 * path.rotation, path.moment / 1e6, label=name)
    if share is not None:
        springs = soil(share).springs
        top = springs.moment_capacity(weight) / (weight * 3.0)
        print(f"{name}: {top:.3f} N B")
_ = axes.legend()

# %%
# Under a record.
record = rf.load_suite("fema-p695-near-field-pulse")["NFP-9-a"]
for share in (None, 0.33, 0.67):
    run = rf.simulate(
        pier,
        record,
        ground=soil(share),
        output="history",
        free_vibration=20.0,
    )
    print(
        f"{share}: {1e3 * run.max_rotation:.1f} mrad, left "
        f"{1e3 * run.residual_rotation:.1f} mrad and "
        f"{1e3 * run.max_permanent_settlement:.0f} mm at an edge"
    )
settled = Figure(figsize=(5.5, 2.6), layout="constrained")
under = settled.add_subplot(xlabel="x [m]", ylabel="w_p [mm]")
under.plot(
    np.linspace(-3, 3, 24), 1e3 * run.permanent_settlement[-1], marker="."
)
under.invert_yaxis()
