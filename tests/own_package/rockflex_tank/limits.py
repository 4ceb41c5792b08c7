"""A limit state: the pipe to the tank breaks."""

from rockflex.fragility import OVERTURNING, LimitState

STROKE = 0.04  # m

PIPE_BREAK = LimitState(
    name="pipe_break",
    label="break of the pipe",
    symbol="break of the pipe",
    exceeded=lambda runs: (runs["max_total_top_displacement"] > STROKE) | OVERTURNING.exceeded(runs),
)
