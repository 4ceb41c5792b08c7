"""Which of many spectra have the mean that fits a target best: greedy, then by exchange."""

from collections import Counter
from collections.abc import Hashable, Sequence
from dataclasses import dataclass

import numpy as np

from rockflex._arrays import Array

Caps = tuple[tuple[Sequence[Hashable | None], int], ...]
"""For each limit the group of every record, None for a group of its own, and the most of one group."""

SEEDS = 20  # sets that grow from one record each
_GAIN = 1e-12  # relative improvement below which an exchange is left alone


@dataclass(frozen=True, eq=False)
class Choice:
    """What is chosen from, and how sets are compared.

    Parameters
    ----------
    spectra
        Scaled spectra, divided by the target, shape (n_records, m).
    record_weight
        Weight of the mean of the squared misfits of the records; the rest is that of the squared misfit of their mean.
    caps
        Limits of records of one group.
    """

    spectra: Array
    record_weight: float
    caps: Caps

    @property
    def misfits(self) -> Array:
        """Root mean square of ln(spectrum/target) of each record, shape (n_records,)."""
        return misfit(self.spectra)

    def badness(self, total: Array, squares: Array, count: int) -> Array:
        """Return what is minimised, for sets of `count` spectra with the given sums, along the first axis."""
        return (1.0 - self.record_weight) * misfit(total / count) ** 2 + self.record_weight * squares / count

    def of(self, chosen: Sequence[int]) -> float:
        """Return what is minimised, for one set."""
        rows = list(chosen)
        total, squares = self.spectra[rows].sum(axis=0), np.sum(self.misfits[rows] ** 2)
        return float(self.badness(total[None], np.array([squares]), len(rows))[0])

    def allowed(self, chosen: Sequence[int]) -> np.ndarray:
        """Return which records may be added to a set, shape (n_records,)."""
        free = np.ones(len(self.spectra), dtype=bool)
        free[list(chosen)] = False
        for groups, most in self.caps:
            count = Counter(groups[i] for i in chosen)
            free &= [group is None or count[group] < most for group in groups]
        return free


def misfit(ratios: Array) -> Array:
    """Root mean square of the logarithms along the last axis."""
    return np.sqrt(np.mean(np.log(ratios) ** 2, axis=-1))


def best_set(choice: Choice, n: int) -> list[int]:
    """Return the best of some sets of `n` records, in order: each is improved by exchanges until none helps.

    One set starts from the records with the least misfits; the others grow, each from one of these records, by the
    record that helps the mean most. The list is shorter than `n` where the caps leave too few records.
    """
    seeds = np.argsort(choice.misfits, kind="stable")[:SEEDS]
    starts = [_ranked(choice, n), *(_greedy(choice, n, int(seed)) for seed in seeds)]
    longest = max(map(len, starts))
    sets = [_exchanged(choice, start) for start in starts if len(start) == longest]
    return sorted(min(sets, key=choice.of))


def _ranked(choice: Choice, n: int) -> list[int]:
    chosen: list[int] = []
    for i in np.argsort(choice.misfits, kind="stable"):
        if len(chosen) < n and choice.allowed(chosen)[i]:
            chosen.append(int(i))
    return chosen


def _greedy(choice: Choice, n: int, seed: int) -> list[int]:
    own = choice.misfits**2
    chosen, total, squares = [seed], choice.spectra[seed], own[seed]
    while len(chosen) < n and (free := choice.allowed(chosen)).any():
        badness = choice.badness(total + choice.spectra, squares + own, len(chosen) + 1)
        i = int(np.argmin(np.where(free, badness, np.inf)))
        chosen.append(i)
        total, squares = total + choice.spectra[i], squares + own[i]
    return chosen


def _exchanged(choice: Choice, chosen: list[int]) -> list[int]:
    """Replace one record at a time, always by the exchange that helps most."""
    own, present = choice.misfits**2, choice.of(chosen)
    while True:
        best, exchange = present, None
        for place in range(len(chosen)):
            rest = chosen[:place] + chosen[place + 1 :]
            total, squares = choice.spectra[rest].sum(axis=0), own[rest].sum()
            badness = choice.badness(total + choice.spectra, squares + own, len(chosen))
            badness[~choice.allowed(rest)] = np.inf
            other = int(np.argmin(badness))
            if badness[other] < best * (1.0 - _GAIN):
                best, exchange = float(badness[other]), (place, other)
        if exchange is None:
            return chosen
        chosen = [*chosen[: exchange[0]], exchange[1], *chosen[exchange[0] + 1 :]]
        present = best
