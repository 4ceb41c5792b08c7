"""Answers do not hang on the tolerance: what does would have been missed, not rounded."""

import numpy as np
import pytest

from builders import make_frame
from rockflex import BoucWen, load_suite
from rockflex.models import parse_model
from rockflex.response import asked_of
from rockflex.solve import Engine

FRAME = make_frame()


@pytest.mark.parametrize(
    ("label", "spring"),
    [
        ("2DOF-C-BW", BoucWen(0.04)),  # the spring turns twice within one step of 0.01 s
        ("2DOF-S-BW", BoucWen(0.04)),
        ("1DOF-fixed-BW", BoucWen(0.04)),
        ("2DOF-C", None),
        ("MDOF-C", None),
    ],
)
def test_peaks_do_not_depend_on_it(label, spring):
    motion = load_suite("fema-p695-far-field")["FF-1-a"].scaled(1.5)
    model = parse_model(label).of(FRAME.rocking(), None, spring)
    runs = [
        Engine(model, asked_of(model), tolerance=tolerance).run(motion.acceleration, motion.dt)
        for tolerance in (1e-7, 1e-12)
    ]
    assert runs[0].n_impacts == runs[1].n_impacts
    np.testing.assert_allclose(runs[0].peaks, runs[1].peaks, rtol=2e-7)
