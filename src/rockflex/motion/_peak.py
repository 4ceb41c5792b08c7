"""The peak that a header states against the samples."""

import numpy as np

from rockflex.motion._ground_motion import GroundMotion

CLOSE = 0.01  # relative difference that the printing of a header explains
PRINTED = 1e-5  # m/s², the last digit of peaks in K-NET headers, 0.001 gal
FAR = 0.2  # relative difference that only a wrong scale or another record explains


def disagreement(motion: GroundMotion) -> tuple[float, str]:
    """Return by how much the peak of a motion differs from that stated in its header, relative to the larger one.

    The text says both peaks, and whether they agree when the mean is subtracted; it is empty if they agree, or none is
    stated. For a mean that explains the difference, the first value is at most `FAR`.
    """
    stated = None if motion.metadata is None else motion.metadata.stated_pga
    if not stated:
        return 0.0, ""
    difference = _apart(motion.pga, stated)
    if difference <= CLOSE:
        return difference, ""
    without = float(np.max(np.abs(motion.acceleration - motion.acceleration.mean())))
    done = motion.metadata is not None and motion.metadata.processing
    text = f"the header states a PGA of {stated:.6g} m/s², but the samples reach {motion.pga:.6g} m/s²"
    if done:
        return difference, f"{text} ({done})"
    if _apart(without, stated) <= CLOSE:
        return min(difference, FAR), (
            f"{text}, and {without:.6g} m/s² when their mean is subtracted, which was not done: "
            "motion.baseline_corrected(0) is close to it"
        )
    return difference, f"{text}, and {without:.6g} m/s² when their mean is subtracted"


def _apart(one: float, other: float) -> float:
    return 0.0 if abs(one - other) <= PRINTED else abs(one - other) / max(one, other)
