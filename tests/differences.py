"""Derivatives of runs by differences of runs with other numbers."""

import math
from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

import rockflex as rf
from random_runs import RandomRun
from rockflex.models._label import parse_model
from rockflex.studies._parameters import Subject
from rockflex.studies._prepared_case import RunOptions

WEIGHTS = {-3: -1 / 60, -2: 9 / 60, -1: -45 / 60, 1: 45 / 60, 2: -9 / 60, 3: 1 / 60}
PEAKS = ("max_rotation", "max_top_displacement", "max_base_moment", "max_horizontal_reaction", "min_vertical_reaction")
STEPS = (1e-3, 1e-4, 3e-5, 1e-5)  # of the logarithm of a parameter
FINER = (*STEPS, 3e-6, 1e-6, 3e-7)
SURE = 2.5e-9  # of the larger of slope and peak: differences of two steps that are as close as this

Results = tuple[np.ndarray, tuple[object, ...]]


def difference(
    function: Callable[[float], Results], steps: Sequence[float] = STEPS
) -> tuple[np.ndarray, np.ndarray] | None:
    """The derivative of a function at 0 by differences, and how much two steps differ; None where it is not smooth."""
    found = []
    for h in steps:
        values = {k: function(k * h) for k in WEIGHTS}
        if len({counts for _, counts in values.values()}) == 1:
            found.append(sum(WEIGHTS[k] * value for k, (value, _) in values.items()) / h)
    if len(found) < 3:
        return None
    apart = np.abs(np.diff(found, axis=0))
    doubt = np.maximum(apart[1:], apart[:-1])
    best, at = doubt.argmin(axis=0), np.arange(doubt.shape[1])
    return np.array(found)[1:-1][best, at], doubt[best, at]


def slopes_as_differences(run: RandomRun, names: Sequence[str] = (), steps: Sequence[float] = STEPS) -> int:
    """Compare derivatives by the scale and by parameters with differences where these are sure; return how many are."""
    structure, options, sure = run.structure(), {k: v for k, v in run.options.items() if k != "output"}, 0
    found = rf.gradient(structure, run.motion, run.model, names, **options)
    subject, model = Subject(structure, replace(RunOptions.of(**options), all_yield=True)), parse_model(run.model)
    own = subject.case(model)

    def results(name: str, by: float) -> Results:
        if name == "scale":
            response = own.run(run.motion, math.exp(by))
        else:
            response = subject.changed(subject.place_of(name), by).case(model).run(run.motion)
        counts = response.status, response.n_uplifts, response.n_impacts
        return np.array([getattr(response, peak) for peak in PEAKS]), counts

    for place, name in enumerate(("scale", *names)):
        try:
            expected = difference(lambda by, name=name: results(name, by), steps)
        except rf.InputError:  # the end of its range
            continue
        if expected is None:  # an event appears or vanishes nearby
            continue
        for peak, slope, doubt, size in zip(PEAKS, *expected, results(name, 0.0)[0], strict=True):
            bound, slopes = max(abs(slope), abs(size)), found.logarithmic[peak]
            if doubt <= SURE * bound and not np.isnan(slopes[place]):  # at a kink there is no derivative
                sure += 1
                assert abs(slopes[place] - slope) <= 1e-8 * bound + 4.0 * doubt, (name, peak)
    return sure
