"""What a block begins to do from rest on ground with friction, at random points of Shenton's map."""

import numpy as np
from hypothesis import assume, given
from hypothesis import strategies as st

import rockflex as rf
from twins.ground_answers import GRAVITY, homogeneous

ASIDE = 1e-3  # relative distance from every boundary


@given(
    slenderness=st.floats(0.75, 8.0),
    friction=st.floats(0.01, 3.0),
    acceleration=st.floats(0.01, 4.0),
    sign=st.sampled_from([1.0, -1.0]),
)
def test_a_block_begins_as_shenton_says(slenderness, friction, acceleration, sign):
    formula, a = homogeneous(1.0, slenderness), acceleration * GRAVITY
    boundaries = [friction / acceleration, friction * slenderness, acceleration * slenderness]
    if a > formula.rocks_above():
        boundaries.append(formula.friction_to_rock(a) / friction)
    assume(min(abs(ratio - 1.0) for ratio in boundaries) > ASIDE)
    block = rf.rigid_block(np.arctan(1.0 / slenderness), np.hypot(1.0, slenderness))
    pulse = rf.GroundMotion(np.full(3, sign * a), 1e-4)
    run = rf.simulate(block, pulse, "rigid", ground=rf.Ground(friction=friction))
    modes = {(0, 0): "rest", (0, 1): "slide", (1, 0): "rock", (1, 1): "slide-rock"}
    begins = modes[run.n_uplifts, int(run.max_slip > 0.0)]
    assert begins == formula.begins(friction, a)
    assert sign * run.slip[-1] <= 0.0  # it is left behind
    if "rock" in begins:
        assert sign * run.rotation[-1] < 0.0
