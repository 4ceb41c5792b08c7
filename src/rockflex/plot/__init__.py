"""Figures of results; matplotlib is imported here and nowhere else."""

from rockflex.plot._comparison import plot_comparison
from rockflex.plot._design import plot_design, plot_design_search
from rockflex.plot._drawing import plot_structure
from rockflex.plot._figures import figure_style, save_figure
from rockflex.plot._fragility import plot_clouds, plot_fragility, plot_ida, plot_stripes
from rockflex.plot._history import plot_energy, plot_footing, plot_history, plot_spread
from rockflex.plot._loops import (
    plot_hysteresis,
    plot_loops,
    plot_moment_rotation,
    plot_moment_rotation_laws,
    plot_yielding,
)
from rockflex.plot._motion import plot_motion, plot_overturning_spectrum, plot_rocking_spectrum, plot_selection
from rockflex.plot._pushover import plot_pushover
from rockflex.plot._record_set import plot_set
from rockflex.plot._structure import plot_frequency_equation, plot_frequency_ratios, plot_mode_shapes, plot_tower
from rockflex.plot._tornado import plot_tornado
from rockflex.plot.animation import animate

__all__ = [
    "animate",
    "figure_style",
    "plot_clouds",
    "plot_comparison",
    "plot_design",
    "plot_design_search",
    "plot_energy",
    "plot_footing",
    "plot_fragility",
    "plot_frequency_equation",
    "plot_frequency_ratios",
    "plot_history",
    "plot_hysteresis",
    "plot_ida",
    "plot_loops",
    "plot_mode_shapes",
    "plot_moment_rotation",
    "plot_moment_rotation_laws",
    "plot_motion",
    "plot_overturning_spectrum",
    "plot_pushover",
    "plot_rocking_spectrum",
    "plot_selection",
    "plot_set",
    "plot_spread",
    "plot_stripes",
    "plot_structure",
    "plot_tornado",
    "plot_tower",
    "plot_yielding",
    "save_figure",
]
