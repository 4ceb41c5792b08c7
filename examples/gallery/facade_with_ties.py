"""
A flexible façade with ties that yield
======================================

A masonry façade bends as it leans outwards from its transverse walls. Ties
below the roof hold it: loose, prestressed, or yielding.
"""

import rockflex as rf

masonry = rf.Beam(
    height=12.0,
    mass=0.6 * 1800.0 * 1.0,
    bending_stiffness=0.6**3 / 12.0 * 1.5e9,
    base_mass=500.0,
    half_width=0.3,
    damping_ratio=0.04,
)
facade = rf.OneSided(masonry, restitution="sorrentino")
ties = {
    "none": [],
    "loose": [
        rf.YieldingDissipator(
            stiffness=1e6, yield_force=8e3, height=11.0, tension_only=True
        )
    ],
    "prestressed": [
        rf.Tendon(
            initial_force=3e3,
            stiffness=1e6,
            yield_force=8e3,
            post_yield_ratio=0.02,
            height=11.0,
        )
    ],
}
walls = {name: rf.Restrained(facade, held) for name, held in ties.items()}
drawing = rf.plot_structure(walls["loose"])

# %%
# Linear kinematics: with weights W, half the thickness b, the centre at h and
# a tie force T at z, the wall opens at a/g = (W b + T z)/(W h).
weight, arm, centre = masonry.rocking().m_tot * 9.81, 0.3, 6.0
for force in (0.0, 3e3, 8e3):
    lifts = (weight * arm + force * 11.0) / (weight * centre)
    print(f"a tie of {force / 1e3:.0f} kN: opens at {lifts:.3f} g")

# %%
# A record, for the wall as it bends, with four modes.
record = rf.load_suite("fema-p695-near-field-pulse")["NFP-9-a"].scaled(0.25)
runs = {
    name: rf.simulate(wall, record, "5DOF-S", output="history")
    for name, wall in walls.items()
}
for name, run in runs.items():
    force = run.max_element_force[0] / 1e3 if ties[name] else 0.0
    print(
        f"{name}: {run.status}, {1e3 * run.max_rotation:.1f} mrad, "
        f"{run.n_impacts} impacts, tie {force:.1f} kN"
    )
history = rf.plot_history(
    runs.values(),
    labels=list(runs),
    panels=["rotation", "top_displacement"],
)
