"""
Controlled rocking: flag and loops
==================================

A wall on a base that can rock, held down by an unbonded tendon, with a fuse
of mild steel to each side of it. First the base is pushed slowly to and fro,
then an earthquake shakes it.
"""

import rockflex as rf

wall = rf.WallFrame(
    height=20.0,
    mass=400e3,
    stiffness_parameter=0.0,
    base_mass=40e3,
    period=0.6,
    aspect_ratio=5.0,
    damping_ratio=0.02,
    n_modes=4,
)
tendon = rf.Tendon(
    initial_force=1.8e6,
    stiffness=40e6,
    yield_force=4.0e6,
    post_yield_ratio=0.02,
)
fuses = [
    rf.YieldingDissipator(
        stiffness=400e6, yield_force=0.9e6, post_yield_ratio=0.02, position=x
    )
    for x in (-0.8, 0.8)
]
hybrid = rf.Restrained(wall, [tendon, *fuses])
drawing = rf.plot_structure(hybrid)

# %%
curve = rf.moment_rotation(
    hybrid, [0.005, -0.005, 0.01, -0.01, 0.02, -0.02, 0.03, -0.03, 0.0]
)
flag = rf.plot_loops(curve)
print(f"re-centring ratio {hybrid.rocking().recentring_ratio:.2f}")
print(
    f"prestress left {curve.element_force[-1, 0] / 1e3:.0f} kN of "
    f"{tendon.initial_force / 1e3:.0f} kN"
)

# %%
# Weight and tendon make the spine of the flag, the fuses its loops. Beyond
# 0.019 rad the tendon yields too: it loses prestress, and the base lifts
# earlier from then on. The same wall in an earthquake, with all of its modes:
motion = rf.load_suite("fema-p695-far-field")["FF-2-a"].scaled(2.0)
held = rf.simulate(hybrid, motion, "MDOF-S", free_vibration="settle")
loops = rf.plot_loops(held)
print(f"residual rotation {held.residual_rotation:g} rad")
print(
    "energy dissipated by the elements [kJ]:",
    (held.element_energy / 1e3).round(1),
)

# %%
# Against the free wall, the elements keep the rotation small at a somewhat
# larger moment. The moment of the elastic forces follows the moment that
# resists the rotation; the difference is inertia.
free = rf.simulate(wall, motion, "MDOF-S", free_vibration=5.0)
moments = rf.plot_moment_rotation([free, held], labels=("free", "hybrid"))

# %%
# Fuses that outdo the weight and the prestress hold the base open.
strong = [
    rf.YieldingDissipator(
        stiffness=1.6e9, yield_force=4.0e6, post_yield_ratio=0.02, position=x
    )
    for x in (-0.8, 0.8)
]
stiff = rf.Restrained(wall, [tendon, *strong])
pushed = rf.moment_rotation(stiff, [0.01, 0.0, -0.01, 0.0])
open_flag = rf.plot_loops(pushed)
print(f"re-centring ratio {stiff.rocking().recentring_ratio:.2f}")
print("residual rotations [rad]:", pushed.residual_rotations.round(4))
