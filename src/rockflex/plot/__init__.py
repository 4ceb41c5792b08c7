"""Figures of results; matplotlib is imported here and nowhere else."""

from rockflex.plot._energy import plot_energy
from rockflex.plot._history import plot_history
from rockflex.plot._mode_shapes import plot_mode_shapes
from rockflex.plot._moment_rotation import plot_moment_rotation
from rockflex.plot._motion import plot_motion
from rockflex.plot._rocking_spectra import plot_overturning_spectrum, plot_rocking_spectrum
from rockflex.plot._save import save_figure
from rockflex.plot._spread import plot_spread
from rockflex.plot._yielding import plot_hysteresis, plot_yielding

__all__ = [
    "plot_energy",
    "plot_history",
    "plot_hysteresis",
    "plot_mode_shapes",
    "plot_moment_rotation",
    "plot_motion",
    "plot_overturning_spectrum",
    "plot_rocking_spectrum",
    "plot_spread",
    "plot_yielding",
    "save_figure",
]
