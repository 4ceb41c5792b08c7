"""Moving pictures of responses."""

from rockflex.plot.animation._animate import animate
from rockflex.plot.animation._files import animation_path_and_suffix

__all__ = ["animate", "animation_path_and_suffix"]
