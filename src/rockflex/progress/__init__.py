"""How far a study is: told to a function, or shown as a bar in a terminal, a table in a notebook, or lines in a log."""

from rockflex.progress._bar import bar
from rockflex.progress._duration import duration
from rockflex.progress._parts import PartProgress, Progress, check_part_progress, pace, telling_parts
from rockflex.progress._steps import ProgressChoice, counter, telling

__all__ = [
    "PartProgress",
    "Progress",
    "ProgressChoice",
    "bar",
    "check_part_progress",
    "counter",
    "duration",
    "pace",
    "telling",
    "telling_parts",
]
