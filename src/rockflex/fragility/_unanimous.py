"""Runs with one common outcome, which give only a one-sided bound."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from rockflex._arrays import Array
from rockflex.fragility._arguments import checked_confidence, log_at


@dataclass(frozen=True)
class UnanimousOutcome:
    """An outcome that happened in every run, or in none; it replaces a curve that cannot be fitted.

    Attributes
    ----------
    outcome : bool
        Whether it happened in all runs, or in none.
    n : int
        Number of runs.
    n_groups : int
        Number of recordings, each of which counts once in a bound; 0 if the runs are taken as independent.

    Examples
    --------
    >>> import rockflex as rf
    >>> never = rf.UnanimousOutcome(outcome=False, n=44)
    >>> print(f"{never.bound(0.95):.3g}")
    0.0658
    """

    outcome: bool
    n: int
    n_groups: int = 0

    @property
    def note(self) -> str:
        """The conclusion in words."""
        side = "above" if self.outcome else "below"
        return (
            f"This gives only a bound: with 95 % confidence the probability, averaged over these runs, is {side} "
            f"{100.0 * self.bound(0.95):.3g} %."
        )

    def bound(self, confidence: float = 0.95) -> float:
        """Exact one-sided bound of the probability averaged over the runs, with the given confidence.

        An upper bound, 1 - (1 - confidence)^(1/m), if it never happened; a lower one, (1 - confidence)^(1/m), if it
        always did (Clopper & Pearson 1934, Biometrika 26(4), 404-413). m is the number of recordings, or of independent
        runs.
        """
        root = (1.0 - checked_confidence(confidence)) ** (1.0 / (self.n_groups or self.n))
        return root if self.outcome else 1.0 - root

    def probability(self, im: ArrayLike) -> Array:
        """1 or 0 as observed, of the shape of `im`."""
        return np.full_like(log_at(im), 1.0 if self.outcome else 0.0)

    def band(self, im: ArrayLike, confidence: float = 0.9) -> tuple[Array, Array]:
        """Observed value and its one-sided bound with the given confidence, the same at every `im`."""
        seen, bound = self.probability(im), np.full_like(log_at(im), self.bound(confidence))
        return (bound, seen) if self.outcome else (seen, bound)
