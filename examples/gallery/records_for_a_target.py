"""
Records for a target spectrum
=============================

Seven records, each of another earthquake and scaled by one factor, whose mean
spectrum fits an elastic spectrum of Eurocode 8. Gray are the records, blue
their mean and the band of one standard deviation.
"""

import rockflex as rf

suite = rf.load_suite("fema-p695-far-field")
target = rf.ec8_spectrum(2.5, ground="C")
chosen = suite.select(target, 7, (0.2, 2.0), per_event=1, least_ratio=0.9)
spectra = rf.plot_selection(chosen)
print(
    chosen.table()[["record", "event", "factor", "misfit"]]
    .round(2)
    .to_string(index=False)
)
