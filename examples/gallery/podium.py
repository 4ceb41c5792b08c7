"""
A building on a rocking podium
==============================

Columns of the ground floor that rock together keep the forces out of the
building above, at the price of a slab that moves.
"""

import rockflex as rf

building = rf.Frame(
    n_stories=4,
    story_height=3.0,
    story_mass=120e3,
    base_mass=180e3,
    stiffness_ratio=0.5,
    period=0.5,
    aspect_ratio=2.0,
    damping_ratio=0.03,
)
podium = rf.Podium(
    building,
    n_columns=4,
    column_width=0.9,
    column_height=4.5,
    column_mass=9e3,
    column_spacing=5.0,
)
drawing = rf.plot_structure(podium)

# %%
# The podium opens at g b/h, and keeps a share of its rotation at each impact
# that the mass of the building lowers.
found = podium.rocking()
print(
    f"opens at {found.uplift_acceleration / 9.81:.3f} g, "
    f"keeps {found.restitution:.3f}"
)
record = rf.load_suite("fema-p695-near-field-pulse")["NFP-3-b"]
runs = [
    rf.simulate(podium, record, model, output="history", free_vibration=5.0)
    for model in ("fixed", "MDOF-S")
]
for name, run in zip(("held", "rocking"), runs, strict=True):
    print(
        f"{name}: base shear {run.max_base_shear / 1e6:.2f} MN, "
        f"{run.n_impacts} impacts, slab "
        f"{1e3 * 4.5 * run.max_rotation:.0f} mm, outer columns at "
        f"{run.column_pull:.2f} of lifting off"
    )
history = rf.plot_history(
    runs,
    labels=["columns held", "columns rock"],
    panels=["rotation", "top_displacement", "base_shear"],
)
