"""Units that make the numbers of a figure short."""

_PREFIXES = ((1e9, "G"), (1e6, "M"), (1e3, "k"))


def readable(largest: float, unit: str) -> tuple[float, str]:
    """Divisor and name of the largest prefix, G, M, k or none, for which `largest` is at least 1."""
    for factor, prefix in _PREFIXES:
        if abs(largest) >= factor:
            return factor, prefix + unit
    return 1.0, unit


def short(value: float) -> str:
    """Three significant digits, without an exponent from 1e-4 up to a million."""
    return f"{float(f'{value:.3g}'):g}".replace("-", "−")
