"""The Response tab as a moving picture."""

from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory

from rockflex.web._refusal import Refusal, refusing
from rockflex.web._response import responses
from rockflex.web._state import State
from rockflex.web._uploads import Uploads

RATES = ((60.0, 25.0), (120.0, 12.5))
"""Longest animation in s, and its frames per second: at most 1500 frames, which take some 20 s to draw."""
WIDTH = 800  # pixels


def animation(state: State, uploads: Uploads, told: Callable[[int, int], None]) -> tuple[str, bytes]:
    """Return the name and the content of a GIF of the models that are shown, at their true speed.

    `told` is called with the number of frames drawn and that of all.

    Raises
    ------
    Refusal
        If a run cannot be made, or the animation would be too long.
    """
    from rockflex.plot import animate
    from rockflex.plot._style import literal

    built, motion, found = responses(state, uploads)
    seconds = max(response.end_time for response in found)
    rate = next((rate for longest, rate in RATES if seconds <= longest), None)
    if rate is None:
        message = (
            f"the animation would last {seconds:.4g} s, but the page draws {RATES[-1][0]:g} s at most. Choose a "
            "shorter record or less free vibration, or take Python lines and add rf.animate(..., start=, stop=)."
        )
        raise Refusal({"free_vibration": message})
    title = None if state.scale == 1.0 else f"{literal(motion.name)} × {state.scale:g}"
    with TemporaryDirectory() as folder, refusing("models"):
        file = animate(
            found, Path(folder) / "animation.gif", structure=built.structure, frames_per_second=rate, title=title,
            width=WIDTH, progress=told,
        )  # fmt: skip
        return file.name, file.read_bytes()
