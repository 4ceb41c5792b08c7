"""Fits in a few words."""

import math

from rockflex.fragility._cloud import CloudFit
from rockflex.fragility._logistic import LogisticFit
from rockflex.fragility._unanimous import UnanimousOutcome


def curve_words(curve: LogisticFit | UnanimousOutcome) -> str:
    """Write the median and the dispersion of a curve, or why it has none."""
    if isinstance(curve, UnanimousOutcome):
        return f"in {'all' if curve.outcome else 'none'} of {curve.n} runs"
    if curve.b1 <= 0.0:
        return f"does not rise (b1 = {curve.b1:.4g})"
    return f"median {curve.median:.4g}, dispersion {curve.dispersion:.4g}"


def power_law(fit: CloudFit, unit: str) -> str:
    """Write a line through logarithms as the power law that it is."""
    return f"{math.exp(fit.c1):.4g} {unit} · IM^{fit.c2:.4g}, dispersion {fit.dispersion:.4g}, R² {fit.r2:.4g}"
