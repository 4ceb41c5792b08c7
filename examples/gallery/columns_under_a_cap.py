"""
Columns under a cap
===================

Four columns of a temple that carry a cap and rock together. A heavier cap
makes them more stable, against intuition (Makris & Vassiliou 2013).
"""

import numpy as np
from matplotlib.figure import Figure

import rockflex as rf


def temple(cap_mass: float) -> rf.RockingProperties:
    """Four columns of 60 t under a cap, in kg."""
    return rf.rocking_frame(
        n_columns=4,
        column_width=1.6,
        column_height=9.6,
        column_mass=60e3,
        cap_mass=cap_mass,
    )


drawing = rf.plot_structure(temple(240e3))

# %%
# The same record with caps of several masses.
record = rf.load_suite("fema-p695-near-field-pulse")["NFP-4-a"]
caps = (0.0, 240e3, 1800e3)
runs = [rf.simulate(temple(cap), record, "rigid-C") for cap in caps]
history = rf.plot_history(
    runs,
    labels=["no cap", "cap of 240 t", "cap of 1800 t"],
    panels=["rotation"],
)

# %%
# Pulses of several periods: the amplitude that overturns the columns.
periods = np.array([0.8, 1.2, 1.8, 2.4])
figure = Figure(figsize=(6.3, 3.0), layout="constrained")
axes = figure.add_subplot(
    xlabel="period of a sine pulse [s]", ylabel="overturning amplitude [g]"
)
for cap in caps:
    columns = temple(cap)
    p = float(np.sqrt(columns.l0r * 9.81 / columns.i_theta))
    falls = rf.overturning_spectrum(
        columns, rf.one_sine_pulse, 2.0 * np.pi / periods / p, tolerance=1e-3
    )
    axes.plot(
        falls["period"],
        falls["amplitude"] / 9.81,
        marker="o",
        label=f"{cap / 1e3:g} t",
    )
_ = axes.legend(title="cap")
