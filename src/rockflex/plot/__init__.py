"""Figures of results; matplotlib is imported here and nowhere else."""

from rockflex.plot._energy import plot_energy
from rockflex.plot._history import plot_history
from rockflex.plot._mode_shapes import plot_mode_shapes
from rockflex.plot._moment_rotation import plot_moment_rotation
from rockflex.plot._motion import plot_motion
from rockflex.plot._save import save_figure

__all__ = [
    "plot_energy",
    "plot_history",
    "plot_mode_shapes",
    "plot_moment_rotation",
    "plot_motion",
    "save_figure",
]
