"""
A pier held by a tendon
=======================

A bridge pier whose footing can rock, free and held down by an unbonded tendon
in its axis. The tendon raises the moment at which the base uplifts, and
reduces the negative stiffness.
"""

import rockflex as rf

pier = rf.CantileverWithTipMass(
    height=12.0,
    tip_mass=500e3,
    mass_per_length=10e3,
    bending_stiffness=4.0e10,
    base_mass=120e3,
    half_width=1.5,
    damping_ratio=0.03,
    n_modes=3,
)
held = rf.Restrained(
    pier, rf.Tendon(initial_force=2.0e6, stiffness=25e6, yield_force=4.2e6)
)
drawing = rf.plot_structure(held)

# %%
motion = rf.load_suite("fema-p695-far-field")["FF-2-a"]
responses = [
    rf.simulate(structure, motion, "MDOF-S", free_vibration=5.0)
    for structure in (pier, held)
]
history = rf.plot_history(
    responses, labels=("free", "with tendon"), title=motion.name
)
print(f"tendon at {responses[1].tendon_utilisation:.0%} of its yield force")
