"""
Will a cabinet overturn?
========================

A cabinet of 2 m under every record of FEMA P-695 far field, until it falls.
"""

import rockflex as rf

cabinet = rf.rigid_block(width=0.6, height=2.0, mass=250.0)
drawing = rf.plot_structure(cabinet)

# %%
# It lifts at the ground acceleration g times width over height. Whether it
# falls is another question: here under one record and under twice of it.
suite = rf.load_suite("fema-p695-far-field")
record = suite["FF-2-a"]
runs = [
    rf.simulate(cabinet, record.scaled(scale), "rigid-C") for scale in (1, 2)
]
history = rf.plot_history(
    runs, labels=["FF-2-a", "FF-2-a × 2"], panels=["rotation"]
)

# %%
# Every record is scaled until the cabinet falls.
ladder = rf.run_incremental(
    {"cabinet": cabinet},
    suite,
    "rigid-C",
    smallest_scale=0.5,
    largest_scale=8.0,
    growth=1.2,
)
found = rf.incremental_capacities(ladder, "pgv")
fit = rf.fit_capacities(found["capacity"], found["censored"], found["group"])
print(f"one of two falls at PGV = {fit.median:.2f} m/s, β = {fit.beta:.2f}")
curves = rf.plot_ida(ladder, "pgv")
