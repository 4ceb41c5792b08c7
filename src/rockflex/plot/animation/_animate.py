"""Responses as a moving picture: the structures that rock, and their histories with a cursor."""

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

from rockflex.foundation.checks import checked_positive, checked_whole_number
from rockflex.foundation.errors import InputError
from rockflex.foundation.shown import shown
from rockflex.plot._history import ResponseCurve, default_panels, panel_quantities, response_curves
from rockflex.plot.animation._files import GIF, MP4, animation_path_and_suffix, write_gif, write_video
from rockflex.plot.animation._poses import default_amplification, frame_timing, outline_of_response, structure_poses
from rockflex.plot.animation._scene import AnimatedFigure
from rockflex.response._response import Response
from rockflex.studies.progress import ProgressChoice, reporting_progress

MIN_WIDTH, MAX_WIDTH = 320, 3840  # pixels
MAX_RESPONSES = 6
_DEFAULT_PANELS = (
    "rotation",
    "total_top_displacement",
    "top_displacement",
    "base_moment",
    "joint_rotation",
    "slip",
    "edge_uplift",
)
_WRITERS = {GIF: write_gif, MP4: write_video}


def animate(
    responses: Response | Iterable[Response],
    path: str | Path,
    labels: Sequence[str] | None = None,
    *,
    structure: Any | Sequence[Any] | None = None,
    speed: float = 1.0,
    frames_per_second: float = 25.0,
    amplification: float | None = None,
    start: float | None = None,
    stop: float | None = None,
    panels: Sequence[str] | None = None,
    title: str | None = None,
    width: int = 960,
    progress: ProgressChoice = None,
) -> Path:
    """Write a moving picture of one response or several as GIF or MP4, by the suffix of `path`.

    The structures rock on their ground, each in the colour of its curve, with what holds them and the springs under
    them. Beside them, or below three and more, are their histories with a cursor. Everything is relative to the ground.
    The times during which the base of the most detailed model is uplifted are shaded; circles at the edges of a base
    mark its impacts. What displacements were enlarged by, and the speed, stand in the picture. The last picture stays
    for a second.

    A GIF needs nothing else to be shown, and repeats. MP4 (H.264) is sharper and smaller, and needs the extra
    ``rockflex[video]``. The file is written completely or not at all; missing folders are created.

    Parameters
    ----------
    responses
        One response or several, up to six, each with its history, of one structure or of several.
    path
        Path of the file, ending in .gif or .mp4; an existing file is replaced.
    labels
        A name for each response. Default: the models, with the motions if a model occurs twice.
    structure
        The structure, or one for each response. Only its shape is taken from it: a tower, a pier or a wall is drawn as
        a bent line rather than with floors. Default: floors where the properties of the response have them, otherwise
        a straight line to the top.
    speed
        Seconds of the response per second of the animation; 0.5 is slow motion.
    frames_per_second
        From 1 to 50 for GIF, which knows hundredths of a second, and to 120 for MP4.
    amplification
        Factor on the displacements and rotations that are drawn, at least 0.01; rotations end at π/2. Default: the
        largest round number with which nothing moves by more than 0.15 of its size; 1 if a structure falls.
    start, stop
        Times of the response in s, at which the animation begins and ends. Default: all of it.
    panels
        Which of the quantities of `plot_history`, from the top. Default: the rotation, the displacement of the top and
        the base moment, with the slip if a base can slide and the edges if one is on springs; no rotation if no base
        can lift, and no moment of rigid blocks.
    title
        Default: the name of the motion, if there is only one.
    width
        Width in pixels, from 320 to 3840; odd numbers lose one. The height follows from the panels.
    progress
        ``"bar"`` for a bar in a terminal or a notebook; or a function ``progress(done, total)`` of the frames that are
        done and of all, called first with 0. What it raises ends the drawing, and leaves no file.

    Returns
    -------
    Path
        The file written.

    Raises
    ------
    InputError
        If there are no responses or too many, one has no history, the number of labels or structures differs, the
        suffix or a panel is unknown, a number is out of range, or MP4 is asked for without the extra.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> import rockflex as rf
    >>> frame = rf.Frame(n_stories=3, story_height=3.0, story_mass=40e3,
    ...     base_mass=40e3, stiffness_ratio=1e9,
    ...               period=0.6, aspect_ratio=6.0, damping_ratio=0.02)
    >>> response = rf.simulate(frame, rf.ricker_pulse(4.0, 0.6), "2DOF-S")
    >>> file = Path(tempfile.mkdtemp()) / "pulse.gif"
    >>> rf.animate(response, file, frames_per_second=10, width=480).name
    'pulse.gif'
    """
    target, suffix = animation_path_and_suffix(path)
    curves = response_curves(responses, labels)
    if len(curves) > MAX_RESPONSES:
        raise InputError(
            f"An animation shows up to {MAX_RESPONSES} responses, but {len(curves)} were given. Show fewer at a time."
        )
    quantities = panel_quantities(_default_animation_panels(curves) if panels is None else panels)
    timing = frame_timing(curves, suffix, speed, frames_per_second, start, stop)
    pixels = checked_whole_number("width", width, MIN_WIDTH, MAX_WIDTH)
    structures = _animated_structures(structure, len(curves))
    outlines = [
        outline_of_response(curve.history, each, i)
        for i, (curve, each) in enumerate(zip(curves, structures, strict=True))
    ]
    poses = [structure_poses(curve, o, timing.times, timing.speed) for curve, o in zip(curves, outlines, strict=True)]
    factor = default_amplification(curves, poses) if amplification is None else _checked_amplification(amplification)
    with reporting_progress(progress, timing.times.size, "frames") as advance:
        picture = AnimatedFigure(curves, poses, quantities, timing, factor, title, pixels)
        try:
            return _WRITERS[suffix](target, picture, timing, advance)
        except OSError as error:
            reason = error.strerror or str(error)
            raise InputError(f"{target} cannot be written ({reason}). Give another path.", field="path") from error


def _animated_structures(given: Any | Sequence[Any] | None, count: int) -> list[Any]:
    if not isinstance(given, list | tuple):
        return [given] * count
    if len(given) != count:
        raise InputError(
            f"structure must be one structure, or one for each of the {count} responses, but {len(given)} were given.",
            field="structure",
        )
    return list(given)


def _checked_amplification(given: float) -> float:
    factor = checked_positive("amplification", given, "")
    if not 0.01 <= factor <= 1e4:
        raise InputError(
            f"amplification must be from 0.01 to 10000, but {shown(given)} was given. Leave it out for one that suits.",
            field="amplification",
        )
    return factor


def _default_animation_panels(curves: list[ResponseCurve]) -> list[str]:
    """Return a few of the panels of a history; the total displacement of the top rather than the relative one."""
    available = default_panels(curves)
    left_out = {"top_displacement"} if "total_top_displacement" in available else set[str]()
    if not any(curve.lifts for curve in curves):
        left_out.add("rotation")
    if not any(curve.history.model.properties.n_modes for curve in curves):
        left_out.add("base_moment")  # of elastic forces, which a rigid block does not have
    return [name for name in _DEFAULT_PANELS if name in available and name not in left_out]
