"""Derivatives of random runs of every kind of linear model, element and ground, against differences of runs."""

import numpy as np
import pytest

import rockflex as rf
from differences import FINER, slopes_as_differences
from random_runs import FURTHER, LINEAR, further_run, linear_run


@pytest.mark.slow
@pytest.mark.parametrize("kind", LINEAR + FURTHER)
def test_random_parameters_of_random_runs(kind):
    sure = 0
    for seed in (30, 31, 33):
        run = (linear_run if kind in LINEAR else further_run)(kind, seed, shaken=seed % 4 == 3)
        options = {k: v for k, v in run.options.items() if k != "output"}
        names = rf.parameter_names(run.structure(), **options)
        drawn = np.random.default_rng(seed).choice(names, 2, replace=False)
        sure += slopes_as_differences(run, [str(name) for name in drawn], FINER)
    assert sure > 15
