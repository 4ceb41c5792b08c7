"""Moving pictures of responses."""

from rockflex.plot.animation._animate import animate

__all__ = [
    "animate",
]
