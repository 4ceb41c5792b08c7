"""Times in words."""


def duration(seconds: float) -> str:
    """Write a time as 0.8 s, 45 s, 12 min or 3.4 h."""
    if seconds < 90.0:
        return f"{seconds:.1f} s" if seconds < 10.0 else f"{seconds:.0f} s"
    return f"{seconds / 60.0:.0f} min" if seconds < 5400.0 else f"{seconds / 3600.0:.1f} h"
