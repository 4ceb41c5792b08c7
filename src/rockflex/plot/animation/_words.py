"""What a structure does at an instant, in words."""

from rockflex.plot._curves import Curve
from rockflex.plot._style import BLUE, GRAY, RED
from rockflex.plot.animation._poses import Poses

BLOW = "#b3261e"


def state_of(curve: Curve, poses: Poses, frame: int, time: float) -> tuple[str, str]:
    """Return the state of a structure in a frame, such as "uplifted", and the colour of the words."""
    end = float(curve.history.time[-1])
    if curve.overturned and time >= end:
        return f"overturned at {end:.2f} s", BLOW
    if curve.falls and time >= float(curve.history.time[curve.before_fall][-1]):
        return "falling", BLOW
    if time > end:
        return f"ends at {end:.2f} s", GRAY
    if not poses.lifts:
        return "fixed base", GRAY
    if poses.sprung and poses.rise[frame].min() > 0.0:
        return "off the ground", BLUE
    if poses.impact[frame] and not poses.uplifted[frame]:
        return "impact", RED
    words = [word for word, holds in (("uplifted", poses.uplifted[frame]), ("sliding", poses.sliding[frame])) if holds]
    return (", ".join(words), BLUE) if words else ("in contact", GRAY)
