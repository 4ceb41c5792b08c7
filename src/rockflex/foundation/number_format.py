"""Numbers with their units as figures, reports and tables show them."""

import math

_PREFIXES = ((1e9, "G"), (1e6, "M"), (1e3, "k"))
_THIN_SPACE = "\u202f"  # between groups of three digits


def unit_with_prefix(largest: float, unit: str) -> tuple[float, str]:
    """Divisor and name of the largest prefix, G, M, k or none, for which `largest` is at least 1."""
    for factor, prefix in _PREFIXES:
        if abs(largest) >= factor:
            return factor, prefix + unit
    return 1.0, unit


def short_number(value: float) -> str:
    """Three significant digits without trailing zeros, and without an exponent from 1e-4 up to a million."""
    return f"{float(f'{value:.3g}'):g}".replace("-", "−")


def rounded_number(value: float | None, digits: int = 3) -> str:
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
    return text.replace("-", "−").replace(",", "" if abs(kept) < 1e4 else _THIN_SPACE)
