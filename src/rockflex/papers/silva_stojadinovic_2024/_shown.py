"""Numbers as text, with the digits that a comparison with print needs."""

import math

from rockflex.papers.silva_stojadinovic_2024._printed import Range


def digits_of(wanted: Range, ours: float) -> int:
    """Return two decimals more than printed, or none if both are integers."""
    decimals = max(0, round(-math.log10(wanted.step)))
    return 0 if decimals == 0 and ours.is_integer() else decimals + 2


def percent(relative: float) -> str:
    """Write a ratio in per cent, with its sign."""
    found = 100.0 * relative
    return f"{found:+.0f} %" if abs(found) >= 10.0 else f"{found:+.2g} %"


def shown(value: float, digits: int) -> str:
    """Write a value with a number of decimals, or with an exponent if they are too few."""
    if not math.isfinite(value):
        return "∞" if value > 0.0 else "−∞" if value < 0.0 else "none"
    if value != 0.0 and abs(value) < 0.5 * 10.0**-digits:
        return f"{value:.1e}".replace("-", "−")
    return f"{value:.{digits}f}".replace("-", "−")
