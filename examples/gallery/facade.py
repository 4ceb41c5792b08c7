"""
A façade that a tie holds
=========================

A façade in front of transverse walls can only fall outwards. A tie near its
top holds it, until it breaks.
"""

import rockflex as rf

wall = rf.rigid_block(width=0.6, height=6.0, mass=7e3)
facade = rf.OneSided(wall, restitution="sorrentino", side="right")
tie = rf.Tendon(
    initial_force=0.0, stiffness=2e6, height=5.8, rupture_elongation=0.02
)
tied = rf.Restrained(facade, tie)
drawing = rf.plot_structure(tied)

# %%
# Half of a record near a fault topples the free façade; the tie is stretched
# by a few millimetres.
record = rf.load_suite("fema-p695-near-field-pulse")["NFP-9-a"].scaled(0.5)
free, held = (rf.simulate(each, record, "rigid") for each in (facade, tied))
print(free)
print(held)
force, stretched = held.max_element_force[0], held.max_element_elongation[0]
print(f"the tie: {force / 1e3:.1f} kN, {1e3 * stretched:.1f} mm")
history = rf.plot_history(
    [free, held], labels=["free", "tied"], panels=["rotation"]
)

# %%
# How strong must the tie be? It breaks at 20 mm, so its strength grows with
# its stiffness. The record acts in both directions, since a façade has a weak
# one.
for stiffness in (1e5, 2e5, 4e5, 8e5):
    tie = rf.Tendon(
        initial_force=0.0,
        stiffness=stiffness,
        height=5.8,
        rupture_elongation=0.02,
    )
    held = rf.Restrained(facade, tie)
    statuses = [
        rf.simulate(held, record.scaled(sign), "rigid").status
        for sign in (1, -1)
    ]
    print(f"tie of {0.02 * stiffness / 1e3:4.0f} kN:", *statuses)
