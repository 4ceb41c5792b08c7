"""Numbers as an engineer writes them: three significant digits, in a unit that suits their size."""

import math

_THIN = "\u202f"  # between groups of three digits
_MOMENTS = ((1e6, "MN m"), (1e3, "kN m"))


def rounded(value: float | None, digits: int = 3) -> str:
    """Write a value with some significant digits and without exponent, if it has a usual size.

    Digits before the point are kept: 12 347 is "12 350" with four digits, and "12 300" with three. Unknown values,
    None and NaN, are a dash.
    """
    if value is None or math.isnan(value):
        return "–"
    if math.isinf(value):
        return "∞" if value > 0.0 else "−∞"
    kept = float(f"{value:.{digits - 1}e}")
    if kept == 0.0:
        return "0"
    size = math.floor(math.log10(abs(kept)))
    if not -5 <= size <= 8:
        return f"{kept:.{digits - 1}e}".replace("-", "−")
    text = f"{kept:,.{max(digits - 1 - size, 0)}f}"
    return text.replace("-", "−").replace(",", "" if abs(kept) < 1e4 else _THIN)


def moment_unit(largest: float) -> tuple[float, str]:
    """Return the divisor and the name of a unit for moments up to `largest` N m: MN m above 100 MN m, else kN m."""
    return _MOMENTS[0] if largest >= 1e8 else _MOMENTS[1]
