"""Moving pictures of responses."""

from rockflex.plot.animation._animate import animate
from rockflex.plot.animation._files import file_of

__all__ = ["animate", "file_of"]
