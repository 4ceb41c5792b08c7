"""How often 90 % bands hold the truth where runs share recordings: the table of docs/theory/checked.md.

`python benchmarks/band_coverage.py 2000` simulates 2000 suites of 22 recordings with 2 components and 4 scales or
levels each in some minutes. Every scatter is a normal score: a half of its variance belongs to the recording, a quarter
to the component and a quarter to the run. So runs of one recording are correlated, while every run by itself follows
the true curve exactly.
"""

import math
import os
import sys
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor

import numpy as np
from scipy.special import expit, ndtr

import rockflex as rf

RECORDINGS, COMPONENTS, SCALES = 22, 2, np.array([0.5, 1.0, 2.0, 4.0])
SHARES = np.array([0.5, 0.25, 0.25])  # of the variance: recording, component, run
AT = np.array([0.1, 0.2, 0.4, 0.8, 1.6])  # m/s
LIMIT = 0.02  # rad
FALLS, ROCKS, LINE, SPREAD = (-1.5, 2.5), (5.0, 3.0), (math.log(0.03), 1.3), 0.6
MEDIAN, BETA, HIGHEST = 0.4, 0.5, 0.6
HAZARD = rf.HazardCurve([0.02, 0.05, 0.1, 0.2, 0.4, 0.8, 1.6], [2e-1, 6e-2, 2e-2, 5e-3, 9e-4, 1.2e-4, 8e-6])
Case = tuple[str, np.ndarray, np.ndarray, tuple[np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]]


def score(rng, per_component=SCALES.size):
    """Standard normal scores of all runs, a component's runs side by side, and a recording's components."""
    n = RECORDINGS * COMPONENTS
    sizes = RECORDINGS, n, n * per_component
    parts = (np.repeat(rng.normal(size=size), sizes[-1] // size) for size in sizes)
    return sum(math.sqrt(share) * part for share, part in zip(SHARES, parts, strict=True))


def groups(per_component=SCALES.size):
    return np.repeat(np.arange(RECORDINGS), COMPONENTS * per_component)


def curve(b, im):
    return expit(b[0] + b[1] * np.log(im))


def line(im):
    return np.exp(LINE[0] + LINE[1] * np.log(im))


def exceeds(im):
    beyond = ndtr(np.log(line(im) / LIMIT) / SPREAD)
    return curve(FALLS, im) + (1.0 - curve(FALLS, im)) * curve(ROCKS, im) * beyond


def clouds(rng) -> Iterator[Case]:
    """Bands of the fits of a cloud: name, levels, truth, band over recordings, band of independent runs."""
    n = RECORDINGS * COMPONENTS
    pgv = 0.3 * np.exp(np.repeat(0.4 * rng.normal(size=RECORDINGS), COMPONENTS) + 0.2 * rng.normal(size=n))
    im = np.outer(pgv, SCALES).ravel()
    fell, rocked = (ndtr(score(rng)) < curve(b, im) for b in (FALLS, ROCKS))
    rotation = np.where(
        fell, 0.5 * np.pi, np.where(rocked, np.maximum(line(im) * np.exp(SPREAD * score(rng)), 1.1e-4), 0.0)
    )
    fits = [rf.fit_outcomes(im, np.minimum(rotation, 0.5 * np.pi), fell, of) for of in (groups(), None)]

    def bands(part):
        return tuple(getattr(fit, part).band(AT) for fit in fits)

    yield "median rotation", AT, line(AT), *bands("rotation")
    yield "P(overturning)", AT, curve(FALLS, AT), *bands("overturning")
    yield "P(rocking, no overturning)", AT, curve(ROCKS, AT), *bands("rocking")
    yield f"P(θ > {LIMIT} rad)", AT, exceeds(AT), *(fit.curve(LIMIT).band(AT) for fit in fits)
    for name, truth, part in (
        ("rate of overturning", lambda at: curve(FALLS, at), lambda fit: fit.overturning),
        (f"rate of θ > {LIMIT} rad", exceeds, lambda fit: fit.curve(LIMIT)),
    ):
        found = (rf.annual_rate(HAZARD, part(fit), confidence=0.9) for fit in fits)
        ends = (tuple(np.array([end]) for end in (each.low, each.high)) for each in found)
        yield name, np.array([np.nan]), np.array([rf.annual_rate(HAZARD, truth).rate]), *ends


def stripes(rng) -> Iterator[Case]:
    """Bands of stripes, for single runs."""
    levels = np.tile(AT[:-1], RECORDINGS * COMPONENTS)
    truth = rf.LognormalFragility(MEDIAN, BETA)
    exceeded = score(rng) < np.log(levels / MEDIAN) / BETA
    try:
        fits = [rf.fit_stripes(levels, exceeded, np.ones(levels.size), of) for of in (groups(), None)]
    except rf.InputError:  # a level separates the runs: no suite in a thousand
        return
    yield "stripes", AT[:-1], truth.probability(AT[:-1]), *(fit.band(AT[:-1]) for fit in fits)


def capacities(rng) -> Iterator[Case]:
    """Bands of capacities, of which all are known, or those above a level are not."""
    capacity, truth = MEDIAN * np.exp(BETA * score(rng, 1)), rf.LognormalFragility(MEDIAN, BETA)
    for name, highest in (("capacities", np.inf), (f"capacities known up to {HIGHEST} m/s", HIGHEST)):
        known = np.minimum(capacity, highest), capacity > highest
        fits = [rf.fit_capacities(*known, of) for of in (groups(1), None)]
        yield name, AT[:-1], truth.probability(AT[:-1]), *(fit.band(AT[:-1]) for fit in fits)


def suites(first, last, seed=1, kinds=(clouds, stripes, capacities)):
    """Which bands of each suite hold the truth, lie below it and above it: over recordings, and of independent runs."""
    found = {}
    for place in range(first, last):
        for kind in kinds:
            rng = np.random.default_rng((seed, place, len(kind.__name__)))
            for name, at, truth, *bands in kind(rng):
                cells = [
                    of for low, high in bands for of in ((low <= truth) & (truth <= high), truth > high, truth < low)
                ]
                found.setdefault(name, (at, []))[1].append(cells)
    return found


def covered(parts):
    """Rows of the table from the suites of some processes."""
    for name, (at, _) in parts[0].items():
        shares = np.mean([cells for part in parts for cells in part[name][1]], axis=0)
        for level, (hold, below, above, blind, *_) in zip(at, shares.T, strict=True):
            yield name, float(level), hold, below, above, blind


def main():
    n = int(sys.argv[1]) if len(sys.argv) > 1 else 2000
    edges = np.linspace(0, n, 4 * (os.cpu_count() or 1) + 1).astype(int)
    with ProcessPoolExecutor() as pool:
        parts = list(pool.map(suites, edges[:-1], edges[1:]))
    print("| quantity | level [m/s] | holds the truth | truth above | truth below | as if independent |")
    print("| --- | --- | --- | --- | --- | --- |")
    for name, level, *shares in covered(parts):
        cells = [name, "" if math.isnan(level) else f"{level:g}", *(f"{100 * each:.1f} %" for each in shares)]
        print("|", " | ".join(cells), "|")


if __name__ == "__main__":
    main()
