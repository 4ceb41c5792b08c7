"""Observed fractions: groups of neighbours, against a loop over them."""

import numpy as np
import pytest

from rockflex.fragility import observed_fractions


@pytest.mark.parametrize("groups", [1, 3, 7, 40])
def test_against_a_loop(groups):
    rng = np.random.default_rng(3)
    im, exceeded = rng.lognormal(size=23), rng.random(23) < 0.4
    found = observed_fractions(im, exceeded, groups)
    runs = sorted(zip(im, exceeded, strict=True))
    sizes = [23 // groups + (place < 23 % groups) for place in range(groups)]
    ends = np.cumsum(sizes)
    parts = [runs[end - size : end] for size, end in zip(sizes, ends, strict=True) if size]
    expected = [
        (np.prod([m for m, _ in part]) ** (1 / len(part)), sum(e for _, e in part) / len(part)) for part in parts
    ]
    np.testing.assert_allclose(found, expected, rtol=1e-12)
